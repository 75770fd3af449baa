// Runs before everything else: what goes wrong while the page starts is said in the status line, in place of `Loading ..`.
"use strict";
const $ = (id) => document.getElementById(id);
function say(text, wrong = false, place = $("status")) {
  place.textContent = text;
  place.classList.toggle("error", wrong);
}
function failed(why) {
  say(`The page does not start here: ${why}. It needs Chrome or Edge 103, Firefox 113, Safari 16.4, or later.`, true);
}
function early({ message, reason }) { failed(message || String(reason)); }
addEventListener("error", early);
addEventListener("unhandledrejection", early);
