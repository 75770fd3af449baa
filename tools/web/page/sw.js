// Keeps the page for visits without a network. With one, the page is always the server's.
"use strict";
const NAME = "coaxial-mixer";
addEventListener("install", (event) => {
  event.waitUntil(caches.open(NAME).then((cache) => cache.add("./")).then(() => skipWaiting()));
});
addEventListener("activate", (event) => event.waitUntil(clients.claim()));
addEventListener("fetch", (event) => {
  if (event.request.mode !== "navigate") return;
  event.respondWith(fetch(event.request).then((answer) => {
    const copy = answer.clone();
    if (answer.ok) event.waitUntil(caches.open(NAME).then((cache) => cache.put("./", copy)));
    return answer;
  }, () => caches.match("./")));
});
