// Runs in the worker, below the glue of wasm-bindgen. The first message is the packed module; every other one is
// { id, method, words }, its answer { id, value } or { id, error }.
"use strict";
let desk;
onmessage = async ({ data: packed }) => {
  const bytes = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  await wasm_bindgen({ module_or_path: bytes });
  desk = new wasm_bindgen.Desk();
  onmessage = answer;
  postMessage({ id: 0 });
};
function answer({ data: { id, method, words } }) {
  try {
    postMessage({ id, value: JSON.parse(desk[method](...words)) });
  } catch (error) {
    // Nothing in the module panics; what does all the same must not look like a page that waits.
    postMessage({ id, error: String(error) });
  }
}
