// Runs before everything else: what goes wrong while the page starts is said in the status line, in place of `Loading ..`.
"use strict";
function failed(why) {
  const status = document.getElementById("status");
  status.textContent = `The page does not start here: ${why}. It needs Chrome or Edge 103, Firefox 113, Safari 16.4, or later.`;
  status.classList.add("error");
}
function early({ message, reason }) { failed(message || String(reason)); }
addEventListener("error", early);
addEventListener("unhandledrejection", early);
