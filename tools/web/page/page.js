// The page: files and forms in, one airframe on the desk, what came of it out. Everything is computed by the worker.
"use strict";
const $ = (id) => document.getElementById(id);
const KEY = "coaxial-mixer";
const SHEET = ["diameter", "spacing", "cells"];
const FIELDS = ["frame", "arm", "name", "outputs", "options", "pulses", ...SHEET];
const KINDS = { map: "bench file of a pair", run: "run of one rotor", pair: "pair's tables", parameters: "vehicle's parameters" };
// From this many points on a pair's bench file needs no prediction to stand on (cargo mixer identify --prior).
const ENOUGH = 16;
// Bytes of a file, beyond which an editor and the browser's storage are the wrong place for it.
const LARGEST = 4 << 20;
const OUTPUTS = [
  ["airframe", "Airframe file"], ["pair", "Pair's tables"], ["report", "Report page"], ["px4", "PX4 parameters"],
  ["ardupilot", "ArduPilot parameters"], ["px4-own", "PX4, its own mixer"], ["ardupilot-own", "ArduPilot, its own mixer"],
  ["betaflight", "Betaflight's CLI lines"], ["betaflight-own", "Betaflight, its own mixer"],
  ["rs", "Generated Rust"], ["vectors.csv", "Golden outputs"], ["rotors-out.csv", "Golden, rotors out"], ["report.txt", "Every number"],
];

const EXAMPLES = {
  identify: "--cells 6 --pwm-range 1000,2000 --unit thrust=gf", predict: "--reference-voltage 22.2 --unit thrust=gf",
  import: "--upper 0,1,2,3", new: "",
};

const later = (wait, run) => { let timer; return (...words) => { clearTimeout(timer); timer = setTimeout(run, wait, ...words); }; };
const quoted = (word) => (/^[\w./,=:+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

// --- the worker

class Refused extends Error {
  constructor(why) {
    super(typeof why === "string" ? why : why.map(({ message }) => message).join("; "));
    this.faults = typeof why === "string" ? [{ file: "", message: why, help: "" }] : why;
  }
}
const waiting = new Map();
let asked = 0;
const worker = new Worker(URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" })));
worker.onmessage = ({ data: { id, value, error } }) => {
  const [resolve, reject] = waiting.get(id);
  waiting.delete(id);
  if (error) reject(new Error(`the compiler stopped: ${error}; reload the page, which keeps your files`));
  else if (value?.Err !== undefined) reject(new Refused(value.Err));
  else resolve(value?.Ok ?? value);
};
const ask = (method, ...words) => new Promise((...both) => {
  waiting.set(asked += 1, both);
  worker.postMessage({ id: asked, method, words });
});
const loaded = ask("open", Uint8Array.from(atob($("module").textContent.trim()), (c) => c.charCodeAt(0)));
$("module").remove();

// --- the state, which a reload keeps

// `made` is the text that files and form gave last, `keys` are the keys that fields set in it.
const fresh = () => ({ files: [], keys: {}, form: Object.fromEntries(FIELDS.map((key) => [key, key === "frame" ? "x8" : ""])), airframe: null, made: "", before: null, tab: "", hand: null });
let state = kept();
// `built` is the airframe of files, form and keys now; `told` is what came of the text `checked`.
let pair = null, built = null, commands = [], refused = [], benchFaults = [], told = null, checked = null;

function keep() {
  try {
    localStorage.setItem(KEY, JSON.stringify(state));
  } catch {
    say("The files are too large for the browser to keep them over a reload.", true);
  }
}
const keepSoon = later(200, keep);
addEventListener("pagehide", keep);

// What was kept; a fresh state where that is another version's, or cannot be read.
function kept() {
  const isText = (text) => typeof text === "string", isFile = (file) => isText(file?.name) && isText(file?.text);
  try {
    const state = JSON.parse(localStorage.getItem(KEY)), { files, airframe, made, before, tab, hand } = state;
    const form = { ...(isText(state.form.arm) && fresh().form), ...state.form }, { keys = {} } = state; // of a version without some
    const sound = [made, tab, ...FIELDS.map((key) => form[key]), ...Object.values(keys)].every(isText) && files.every(isFile)
      && [airframe, before].every((file) => file === null || isFile(file)) && (hand === null || hand.wrench.length === 4 && Array.isArray(hand.failed));
    if (sound) return { ...state, form, keys };
  } catch {}
  return fresh();
}

function say(text, wrong = false) {
  $("status").textContent = text;
  $("status").classList.toggle("error", wrong);
}

async function packed(text, stream) {
  return new Uint8Array(await new Response(new Blob([text]).stream().pipeThrough(stream)).arrayBuffer());
}
async function link() {
  const bytes = await packed(JSON.stringify(state.airframe), new CompressionStream("deflate-raw"));
  const text = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return `${location.href.split("#")[0]}#airframe=${text}`;
}
async function linked() {
  const found = location.hash.match(/^#airframe=([\w-]+)$/);
  if (!found) return;
  history.replaceState(null, "", location.href.split("#")[0]);
  try {
    const bytes = Uint8Array.from(atob(found[1].replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
    const { name, text } = JSON.parse(new TextDecoder().decode(await packed(bytes, new DecompressionStream("deflate-raw"))));
    receive({ name: String(name), text: String(text) });
  } catch {
    refused = [{ severity: "error", file: "", message: "the link holds no whole airframe", help: "copy all of it" }];
  }
}

// --- files

async function drop(files) {
  refused = [];
  for (const file of files) {
    try {
      if (file.size > LARGEST) throw new Error("above 4 MB, as no bench file is: flight logs are read by cargo mixer review");
      const text = decoded(new Uint8Array(await file.arrayBuffer()));
      if (text === null) throw new Error("this is no text: flight logs are read by cargo mixer review, spreadsheets are saved as CSV");
      if ((await ask("kind", file.name, text, [])).kind === "airframe") receive({ name: file.name, text });
      else {
        state.files = [...state.files.filter(({ name }) => name !== file.name), { name: file.name, text, chosen: "" }];
        state.tab = file.name;
      }
    } catch ({ message }) {
      refused.push({ severity: "error", file: file.name, message, help: "" });
    }
  }
  await remake();
}

// The text of a file, in the encodings that the command line reads; null of what is none.
function decoded(bytes) {
  const encodings = bytes[0] === 0xff && bytes[1] === 0xfe ? ["utf-16le"] : bytes[0] === 0xfe && bytes[1] === 0xff ? ["utf-16be"] : ["utf-8", "latin1"];
  for (const encoding of encodings) {
    try {
      const text = new TextDecoder(encoding, { fatal: true, ignoreBOM: encoding === "utf-8" }).decode(bytes);
      return text.includes("\0") ? null : text;
    } catch {
      // The next encoding.
    }
  }
  return null;
}

const of = (kind) => state.files.filter((file) => file.kind === kind);
const named = (files) => [files.map(({ name }) => name), files.map(({ text }) => text)];

// The command that makes the pair of the bench files; null without any.
function pairCommand() {
  const [maps, runs] = ["map", "run"].map((kind) => of(kind).map(({ name }) => name));
  const [run, lower] = runs;
  const beside = lower ? ["--lower-single", lower] : [];
  if (!maps.length) return run ? ["predict", run, ...beside] : null;
  const few = of("map").reduce((sum, { points }) => sum + points, 0) < ENOUGH;
  return few && run ? ["identify", ...maps, "--prior", run, ...beside] : ["identify", ...maps, ...runs];
}

const isFramed = () => Boolean(state.form.arm || state.form.frame === "single");
const commandName = () => pairCommand()?.[0] ?? (of("parameters").length ? "import" : isFramed() ? "new" : "identify");
// A number of the form as an option; none where the field is empty.
const option = (id) => (state.form[id] ? [`--${id}`, number(labelOf($(id)), state.form[id])] : []);

// The command that makes the airframe, and its file; null where the frame is not told.
function airframeCommand(tables) {
  const { frame, name, outputs } = state.form, [parameters] = of("parameters");
  const file = `${name || `my-${parameters ? "airframe" : frame}`}.toml`;
  const more = [...(tables ? ["--pair", tables.name] : []), ...option("arm"), ...(name ? ["--name", name] : [])];
  if (parameters) return [file, ["import", parameters.name, ...more, "-o", file]];
  if (!isFramed()) return null;
  return [file, ["new", "--frame", frame, ...more, ...(outputs ? ["--outputs", outputs] : []), "-o", file]];
}

let turn = 0;
async function remake() {
  const mine = turn += 1, lines = [];
  const run = async (words, more) => {
    lines.push(["cargo mixer", ...words, ...more].map((word, k) => (k ? quoted(word) : word)).join(" "));
    return ask("make", [...words, ...more], ...named([...state.files, ...(tables ? [tables] : [])]));
  };
  let report = "", notes = [], made = null, faults = refused, tables;
  try {
    const options = await ask("words", state.form.options);
    for (const file of state.files) {
      const { kind, points } = await ask("kind", file.name, file.text, options);
      Object.assign(file, { kind: file.chosen || kind, points });
    }
    [tables] = of("pair");
    const command = pairCommand();
    if (command) {
      const sheet = command[0] === "predict" ? SHEET.flatMap(option) : [];
      const answer = await run(command, ["-o", "pair.toml", ...sheet, ...options]);
      [tables, report, notes] = [{ name: "pair.toml", text: answer.toml }, answer.report, answer.notes];
    }
    const airframe = airframeCommand(tables);
    if (airframe) {
      const answer = await run(airframe[1], command ? [] : options);
      made = { name: airframe[0], text: answer.toml };
      notes = [...notes, ...answer.notes];
      for (const [key, value] of Object.entries(state.keys)) made.text = await ask("set", made.text, KEYS[key], key, value);
    }
  } catch (error) {
    if (!(error instanceof Refused)) return say(error.message, true);
    made = null;
    faults = [...refused, ...error.faults.map((fault) => ({ severity: "error", ...fault }))];
  }
  if (mine !== turn) return;
  pair = tables;
  // Notes about rows name them as errors do.
  benchFaults = [...faults, ...notes.map((note) => {
    const { name = "" } = state.files.find(({ name }) => note.includes(`${name}:`)) ?? {};
    const [, line, message] = note.split(`${name}:`).slice(1).join(`${name}:`).match(/^(\d+): (.*)/s) ?? [];
    return { severity: "warning", file: name, line: line && Number(line), message: message ?? note, help: "" };
  })];
  const command = commandName();
  $("command-name").textContent = command;
  $("sheet").hidden = command !== "predict";
  $("options").placeholder = EXAMPLES[command];
  $("help").textContent = await ask("help", command);
  const keys = Object.entries(state.keys).filter(([, value]) => value).map(([key, value]) => `${key} = ${value} in [${KEYS[key]}]`);
  $("command").textContent = lines.join(" && ") + (made && keys.length ? `  # then ${keys.join(", ")}` : "");
  fill($("pair-report"), report);
  $("pair-report").hidden = !report;
  [built, commands] = [made, lines];
  const tab = document.activeElement === editor.area ? state.tab : "";
  const isOwn = !state.airframe || state.airframe.text === state.made;
  if (made && isOwn && made.text !== state.airframe?.text) await adopt(made, made.text, tab);
  else show();
  sum();
}
const remakeSoon = later(250, remake);

// --- the airframe

function adopt(airframe, made, tab = "") {
  if (state.airframe && state.airframe.text !== state.made && state.airframe.text !== airframe.text) state.before = state.airframe;
  [state.airframe, state.made, state.tab] = [{ ...airframe }, made, tab];
  show();
  return check();
}
// An airframe file from outside, which has its own keys.
function receive(airframe) {
  state.keys = {};
  return adopt(airframe, "");
}
const differs = () => Boolean(state.airframe && built && state.airframe.text !== built.text);

let checking = 0, spent = 0, latest;
// One that is overtaken ends with the one that overtook it.
const check = () => (latest = checkOnce());
async function checkOnce() {
  if (!state.airframe) return;
  const mine = checking += 1, began = performance.now();
  const { name, text } = state.airframe;
  let answer;
  try {
    answer = await ask("check", name, text);
  } catch (error) {
    return say(error.message, true);
  }
  if (mine !== checking) return latest;
  [told, checked] = [answer, text];
  show();
  spent = Math.round(performance.now() - began);
  sum();
  if (told.errors.length) return;
  await hand.show(told.name, state.hand);
  reportSoon();
}
const checkSoon = later(250, check);

const reportSoon = later(400, async () => {
  const mine = checking;
  const answer = await ask("report", ...named(of("map"))).catch((error) => ({ body: "", refused: error.message }));
  if (mine !== checking) return;
  $("report").innerHTML = answer.body;
  if (answer.refused) $("report").prepend(element("p", { className: "warnings", textContent: `Bench files are not shown: ${answer.refused}` }));
  if (answer.model) report($("report"), JSON.parse(answer.model));
});

const editor = new Editor($("editor"), (text) => {
  const file = state.files.find(({ name }) => name === state.tab);
  if (file) {
    file.text = text;
    remakeSoon();
  } else {
    state.airframe ??= { name: "airframe.toml", text: "" };
    state.airframe.text = text;
    checkSoon();
  }
  keepSoon();
});

const hand = new Hand(ask, (at) => { state.hand = at; keepSoon(); }, async (key, value) => {
  const { text } = state.airframe;
  try {
    state.airframe.text = await ask("set", text, KEYS[key], key, value);
  } catch (error) {
    return say(error.message, true);
  }
  if (text === state.made) state.made = state.airframe.text;
  if (text === built?.text) built.text = state.airframe.text;
  state.keys[key] = value;
  state.tab = "";
  await check();
  await remake();
}, say);

// --- what is shown of the state

// The sum of it all, which a screen reader says.
function sum() {
  const count = (n, word) => `${n || "no"} ${word}${n === 1 ? "" : "s"}`;
  const errors = benchFaults.filter(({ severity }) => severity === "error");
  const bench = errors.length ? [`${count(errors.length, "error")} in ${errors[0].file || "what the files say"}`] : [];
  const airframe = told && state.airframe ? [told.errors.length ? `${count(told.errors.length, "error")} in ${state.airframe.name}`
    : `${told.name} compiles: ${count(told.warnings.length, "warning")}, ${spent} ms`] : pair ? ["The pair is ready: the airframe needs its frame and arm"] : [];
  const other = differs() ? ["the airframe is not the one of files and form"] : [];
  say([...bench, ...airframe, ...other].join("; ") || "Ready: drop a file, or begin with a frame.", Boolean(errors.length || told?.errors.length));
}

// Lines of a word and what it means, some of them continued below; a line above them all is the caption.
function fill(table, text) {
  const above = [], rows = [];
  for (const line of text.trimEnd().split("\n")) {
    const [, head, rest] = line.match(/^(\S.*?)\s{2,}(.*)$/) ?? [];
    if (head) rows.push([head, rest]);
    else if (rows.length) rows.at(-1)[1] += /^\s*\*/.test(line) ? `\n${line.trim()}` : ` ${line.trim()}`;
    else above.push(line);
  }
  const cells = ([head, rest]) => [element("th", { scope: "row", textContent: head }), element("td", {}, ...rest.split("\n").flatMap((line) => [line, element("br")]).slice(0, -1))];
  table.replaceChildren(element("caption", { textContent: above.join(" "), hidden: above.join("") === "" }), element("tbody", {}, ...rows.map((row) => element("tr", {}, ...cells(row)))));
}

function show() {
  keepSoon();
  const edited = [...state.files, ...(state.airframe ? [{ name: "", label: state.airframe.name, text: state.airframe.text }] : [])];
  if (!edited.some(({ name }) => name === state.tab)) state.tab = state.airframe ? "" : (edited[0]?.name ?? "");
  $("tabs").replaceChildren(...edited.map(({ name, label }) => {
    const tab = element("button", { type: "button", ariaPressed: String(name === state.tab), textContent: label ?? name });
    tab.addEventListener("click", () => { state.tab = name; show(); });
    return tab;
  }));
  const records = ["error", "warning"].flatMap((severity) => (told?.[`${severity}s`] ?? []).map((record) => ({ severity, ...record })));
  const faults = [...benchFaults, ...(state.airframe ? records : [])].sort((a, b) => (a.severity < b.severity ? -1 : a.severity > b.severity ? 1 : 0));
  editor.text = edited.find(({ name }) => name === state.tab)?.text ?? "";
  editor.mark(faults.filter(({ file }) => file === (state.tab || state.airframe?.name)));
  $("faults").replaceChildren(...faults.map(({ severity, code, file, line, column, message, help }) => {
    const item = element("li", { className: severity }, element("b", { textContent: `${severity}${code ? ` ${code}` : ""} ` }));
    if (line) {
      const place = element("button", { type: "button", className: "place", textContent: `${file}:${line}` });
      place.addEventListener("click", () => { state.tab = file === state.airframe?.name ? "" : file; show(); editor.go(line, column ?? 1); });
      item.append(place, " ");
    } else if (file) item.append(`${file} `);
    item.append(message, ...(help ? [element("br"), `Mend: ${help}`] : []));
    return item;
  }));
  $("dropped").replaceChildren(...state.files.map((file) => {
    const kinds = element("select", { ariaLabel: `What ${file.name} is` }, ...Object.entries(KINDS).map(([value, textContent]) => element("option", { value, textContent })));
    kinds.value = file.kind;
    kinds.addEventListener("change", () => { file.chosen = kinds.value; remake(); });
    const remove = element("button", { type: "button", textContent: "Remove", ariaLabel: `Remove ${file.name}` });
    remove.addEventListener("click", () => { state.files = state.files.filter((other) => other !== file); remake(); });
    return element("li", {}, element("b", { textContent: file.name }), kinds, remove);
  }));
  const compiles = Boolean(state.airframe && told?.verdict);
  fill($("verdict"), compiles ? told.verdict : "");
  for (const id of ["verdict", "hand", "save"]) $(id).hidden = !compiles;
  if (!compiles) $("report").replaceChildren();
  $("differs").hidden = !differs();
  $("made-by").hidden = !commands.length || differs();
  $("back").hidden = !state.before;
  for (const key of FIELDS) if (document.activeElement !== $(key)) $(key).value = state.form[key];
  const file = state.airframe?.name ?? "airframe.toml";
  $("library").textContent = `cargo mixer library ${quoted(file)} --target thumbv7em-none-eabihf -o lib`;
  $("downloads").querySelector("[data-output=pair]").hidden = !pair;
}

// --- saving

async function saved(what) {
  if (what === "airframe") return state.airframe;
  if (what === "pair") return pair;
  if (checked !== state.airframe.text) await check();
  if (checked !== state.airframe.text || told.errors.length) throw new Error(`${state.airframe.name} does not compile: nothing was saved`);
  if (what === "report") return { name: `${told.name}.html`, text: await ask("page", ...named(of("map"))) };
  return ask("output", what, state.form.pulses);
}
async function save(what) {
  const note = (className, textContent) => element("li", { className, textContent });
  try {
    const { name, text, notes = [] } = await saved(what);
    const url = URL.createObjectURL(new Blob([text], { type: "application/octet-stream" }));
    element("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
    $("notes").replaceChildren(...notes.map((text) => note("warning", `${name}: ${text}`)));
  } catch (error) {
    $("notes").replaceChildren(note("error", error.message));
  }
}

// --- events

$("downloads").append(...OUTPUTS.map(([what, label]) => {
  const button = element("button", { type: "button", textContent: label });
  button.dataset.output = what;
  button.addEventListener("click", () => save(what));
  return element("li", {}, button);
}));
$("choose").addEventListener("change", () => { drop([...$("choose").files]); $("choose").value = ""; });
for (const kind of ["dragover", "dragleave", "drop"]) {
  addEventListener(kind, (event) => {
    event.preventDefault();
    $("drop").classList.toggle("over", kind === "dragover");
    if (kind === "drop") drop([...event.dataTransfer.files]);
  });
}
for (const key of FIELDS) {
  $(key).addEventListener("input", () => { state.form[key] = $(key).value.trim(); keepSoon(); if (key !== "pulses") remakeSoon(); });
}
$("frame-form").addEventListener("submit", (event) => event.preventDefault());
$("example").addEventListener("click", () => { Object.assign(state.form, { frame: "x8", arm: "0.45" }); remake(); });
$("example-sheet").addEventListener("click", () => {
  state.files = [{ name: "rotor.csv", text: $("sample-sheet").textContent, chosen: "" }];
  Object.assign(state.form, { frame: "x8", arm: "0.4", diameter: "0.305", spacing: "0.08" });
  remake();
});
$("replace").addEventListener("click", () => adopt(built, built.text));
$("back").addEventListener("click", () => { const { before } = state; state.before = null; adopt(before, ""); });
$("share").addEventListener("click", async () => {
  const text = await link();
  $("link").value = text;
  $("linked").hidden = false;
  $("link").select();
  await navigator.clipboard?.writeText(text).catch(() => {});
});
$("forget").addEventListener("click", () => {
  try {
    for (const key of Object.keys(localStorage)) if (key === KEY || key.startsWith("checks of ")) localStorage.removeItem(key);
  } catch {
    // Where the browser keeps nothing there is nothing to forget.
  }
  [state, told, checked, refused] = [fresh(), null, null, []];
  remake();
});

(async () => {
  try {
    await loaded;
  } catch (error) {
    return say(error.message, true);
  }
  await linked();
  await check();
  await remake();
  if (location.protocol.startsWith("http")) navigator.serviceWorker?.register("sw.js").catch(() => {});
})();
