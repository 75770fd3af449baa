// Runs in the worker, below the glue of wasm-bindgen. A message is { id, method, words }, its answer { id, value } or
// { id, error }. The first one opens the packed module; those that come meanwhile wait for it.
"use strict";
let opened;
async function open(packed) {
  const bytes = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  await wasm_bindgen({ module_or_path: bytes });
  return new wasm_bindgen.Desk();
}
onmessage = async ({ data: { id, method, words } }) => {
  try {
    opened ??= open(...words);
    const desk = await opened;
    postMessage({ id, value: method === "open" ? null : JSON.parse(desk[method](...words)) });
  } catch (error) {
    // Nothing in the module panics; what does all the same must not look like a page that waits.
    postMessage({ id, error: String(error) });
  }
};
