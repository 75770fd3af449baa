// The page. What a user put in is one value, `state`; what comes of exactly that is another, `view`, which `settle` makes anew
// after every change and `render` shows. Nothing else changes what is seen of an airframe.
//
//   state: files, form and keys, an airframe of one's own    kept over a reload
//     -> settle: files and form -> pair -> airframe -> keys -> check      by the worker
//     -> view: the airframe on the desk and what it is, its verdict, refusals by field, warnings
//     -> render, then files to take along, sliders, report
//
// What is refused changes nothing on the desk: the airframe there is then the last one, and the page says so.
"use strict";
const $ = (id) => document.getElementById(id);
const KEY = "coaxial-mixer";
// Numbers of the data sheet of one rotor: its file has a row for each throttle that has a thrust.
const SHEET = [50, 65, 75, 85, 100];
const SHEET_NAME = "data-sheet.csv";
// Fields whose number is an option of the same name, with the commands that have it.
const NUMBERS = { arm: ["new", "import"], cells: ["identify", "predict"], diameter: ["predict"], spacing: ["predict"], "run-voltage": ["predict"] };
// Fields whose text is an option of the same name of the commands that read bench files.
const TEXTS = ["pwm-range", "voltage-exponent"];
const THRUSTS = SHEET.map((percent) => `thrust-${percent}`);
const FIELDS = ["frame", "name", "stack", "chemistry", "unit-thrust", "unit-throttle", "tare", "options", "pulses", ...Object.keys(NUMBERS), ...TEXTS, ...THRUSTS];
// Fields of keys of the airframe file.
const KEYS = { mass_kg: "vehicle.mass_kg", airmode: "allocation.airmode", yaw_reserve_nm: "allocation.yaw_reserve_nm", power_bias_nm_per_n: "allocation.power_bias_nm_per_n" };
const KINDS = { map: "bench file of a pair", run: "run of one rotor", pair: "pair's tables", parameters: "vehicle's parameters" };
// From this many points on a pair's bench file needs no prediction to stand on (cargo mixer identify --prior).
const ENOUGH = 16;
// Bytes of a file, beyond which an editor and the browser's storage are the wrong place for it.
const LARGEST = 4 << 20;
const EXAMPLES = {
  identify: "--basis cubic --temperature 18 --pressure 950", predict: "--kappa 0.015",
  import: "--upper 0,1,2,3", new: "",
};

// Files to take along: what Desk.output and the page call them, a name, and where they go.
const OUTPUTS = {
  airframe: ["Airframe file", "Keep it: everything else is made of it, here or by `cargo mixer`."],
  sheet: ["Data sheet", "What was typed in, as the file that the command line reads."],
  pair: ["Pair's tables", "The model of the pair alone, for other airframes with the same rotors."],
  report: ["Report page", "All pictures, and the check list for the bench: tick it with the propellers off."],
  "px4-own": ["PX4 parameters", "For PX4 as it is, with its own mixer: QGroundControl, Vehicle Setup, Parameters, Tools, Load from file."],
  px4: ["PX4 parameters, coaxial mixer", "For PX4 with the module of examples/px4 in its firmware: load it the same way."],
  "ardupilot-own": ["ArduPilot parameters", "For ArduPilot as it is, with its own mixer: Mission Planner, Config, Full Parameter List, Load from file."],
  ardupilot: ["ArduPilot parameters, coaxial mixer", "For ArduPilot with the motors class of examples/ardupilot: load it the same way."],
  "betaflight-own": ["Betaflight CLI lines", "For Betaflight as it is, with its own mixer: paste them into the CLI of its app."],
  betaflight: ["Betaflight CLI lines, coaxial mixer", "For Betaflight with the patch of examples/betaflight: paste them the same way."],
  rs: ["Generated Rust", "The mixer as a module for firmware in Rust, beside the package mixer-rt."],
  "vectors.csv": ["Golden outputs", "Setpoints and throttles to the bit, for the tests of your firmware."],
  "rotors-out.csv": ["Golden outputs, rotors out", "The same with rotors that have failed."],
  "report.txt": ["Every number", "The text of `cargo mixer check --verbose`."],
};
const OF_STACK = {
  px4: ["px4-own", "report", "airframe", "px4"], ardupilot: ["ardupilot-own", "report", "airframe", "ardupilot"],
  betaflight: ["betaflight-own", "report", "airframe", "betaflight"], own: ["rs", "vectors.csv", "report", "airframe"],
};

const quoted = (word) => (/^[\w./,=:+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
const isText = (text) => typeof text === "string";
const plural = (n, word) => `${n || "no"} ${word}${n === 1 ? "" : "s"}`;

// --- the worker

// What the compiler has against an input: faults of files, or the sentence at a field.
class Refused extends Error {
  constructor(why, field = "") {
    super(isText(why) ? why : why.map(({ message }) => message).join("; "));
    this.faults = isText(why) ? [{ file: "", message: why, help: "", mends: [] }] : why;
    this.field = field;
  }
}
const waiting = new Map();
let asked = 0;
const worker = new Worker(URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" })));
worker.onerror = ({ message }) => failed(message || "its worker is refused");
worker.onmessage = ({ data: { id, value, error } }) => {
  const [resolve, reject] = waiting.get(id);
  waiting.delete(id);
  if (error) reject(new Error(error));
  else if (value?.Err !== undefined) reject(new Refused(value.Err));
  else resolve(value?.Ok ?? value);
};
const ask = (method, ...words) => new Promise((...both) => {
  waiting.set(asked += 1, both);
  worker.postMessage({ id: asked, method, words });
});
const loaded = ask("open", Uint8Array.from(atob($("module").textContent.trim()), (c) => c.charCodeAt(0)));
$("module").remove();

// --- the state

// `own` is an airframe that was edited or dropped, with the keys that fields are to set in it; `made` the last one that files and
// form gave; `aside` texts that something else took the place of; `dropped` the airframes of which one is to be chosen.
const fresh = () => ({
  files: [], form: Object.fromEntries(FIELDS.map((key) => [key, { frame: "x8", stack: "px4" }[key] ?? ""])), keys: {},
  own: null, made: null, aside: [], tab: "", hand: null,
});
let state = kept();
// Of the last action alone: files that could not be read.
let refusedFiles = [];

// The example stands in as long as nothing is put in.
const EXAMPLE = { ...fresh(), form: { ...fresh().form, arm: "0.45", name: "example-x8" }, keys: { "vehicle.mass_kg": "4.5" } };
const isPristine = () => !state.own && !state.files.length && !Object.keys(state.keys).length
  && FIELDS.every((key) => key === "stack" || state.form[key] === fresh().form[key]);

function keep() {
  let told = "Files, fields and edits are kept in this browser until you forget them.";
  try {
    localStorage.setItem(KEY, JSON.stringify(state));
  } catch ({ name }) {
    told = name === "QuotaExceededError" ? "The files are too large for the browser to keep: a reload begins afresh."
      : "This browser lets the page keep nothing: a reload begins afresh.";
  }
  $("kept").textContent = told;
}
addEventListener("pagehide", keep);

// What was kept; a fresh state where that is another version's, or cannot be read.
function kept() {
  const isFile = (file) => isText(file?.name) && isText(file?.text), areTexts = (of) => Object.values(of).every(isText);
  try {
    const { files, form, keys, own, made, aside, tab, hand } = JSON.parse(localStorage.getItem(KEY));
    const state = { ...fresh(), files, keys, own, made, aside, tab, hand, form: { ...fresh().form, ...form } };
    if (files.every(isFile) && aside.every(isFile) && [own, made].every((of) => of === null || isFile(of)) && areTexts(keys) && areTexts(own?.keys ?? {})
      && areTexts(state.form) && isText(tab) && (hand === null || hand.wrench.length === 4 && Array.isArray(hand.failed))) return state;
  } catch {}
  return fresh();
}

function say(text, wrong = false) {
  $("status").textContent = text;
  $("status").classList.toggle("error", wrong);
}

// --- files and airframes from outside

// Puts aside what stands in the place of a newer text, unless it is the same.
function putAside(file) {
  if (!file || state.aside.some(({ text }) => text === file.text)) return;
  state.aside.push({ name: file.name, text: file.text });
}
function receive({ name, text }) {
  if (state.own?.text !== text) putAside(state.own);
  state.aside = state.aside.filter((file) => file.text !== text);
  [state.own, state.tab] = [{ name, text, keys: {} }, ""];
  // A field that somebody was in shows what this airframe has.
  document.activeElement?.blur();
}
// One more file of those that make an airframe; the newest of a name counts.
function add(file) {
  const before = state.files.find(({ name }) => name === file.name);
  if (before?.edited && before.text !== file.text) putAside(before);
  state.files = [...state.files.filter((other) => other !== before), file];
  state.tab = file.name;
}
// What a text is, and the points of a bench file with options of `identify`.
async function kindOf({ name, text }, options) {
  const { kind, points } = await ask("kind", name, new TextEncoder().encode(text), options);
  return { kind: ["px4", "ardupilot", "betaflight"].includes(kind) ? "parameters" : kind, points };
}
// Takes a text for what it is.
async function take({ name, text }) {
  const { kind } = await kindOf({ name, text }, []);
  if (kind === "airframe") receive({ name, text });
  else add({ name, text, chosen: "" });
}

async function drop(files) {
  const airframes = [];
  refusedFiles = [];
  reading += 1;
  withdraw();
  for (const file of files) {
    try {
      if (file.size > LARGEST) throw new Error("above 4 MB, as no bench file is: flight logs are read by cargo mixer review");
      const { kind, text } = await ask("kind", file.name, new Uint8Array(await file.arrayBuffer()), []);
      if (kind === "airframe") airframes.push({ name: file.name, text });
      else add({ name: file.name, text, chosen: "" });
    } catch ({ message }) {
      refusedFiles.push({ name: file.name, message });
    }
  }
  reading -= 1;
  if (airframes.length > 1) airframes.forEach(putAside);
  else airframes.forEach(receive);
  changed({ asks: airframes.length > 1 });
}

async function packed(text, stream) {
  return new Uint8Array(await new Response(new Blob([text]).stream().pipeThrough(stream)).arrayBuffer());
}
async function link({ name, text }) {
  const bytes = await packed(JSON.stringify({ name, text }), new CompressionStream("deflate-raw"));
  const packedText = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return `${location.href.split("#")[0]}#airframe=${packedText}`;
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
    refusedFiles = [{ name: "The link", message: "it holds no whole airframe: copy all of it" }];
  }
}

// --- from the state to what is seen

const named = (files) => [files.map(({ name }) => name), files.map(({ text }) => text)];
// The number of a field, in the unit of its label; empty where the field is.
function numberOf(id, text) {
  try {
    return text.trim() && number(labelOf($(id)), text);
  } catch ({ message }) {
    throw new Refused(message, id);
  }
}

// The data sheet that was typed in, as a file; none without a thrust.
function typedSheet(form) {
  const rows = SHEET.map((percent) => [percent, numberOf(`thrust-${percent}`, form[`thrust-${percent}`])]).filter(([, thrust]) => thrust);
  return rows.length ? [{ name: SHEET_NAME, text: `Throttle (%),Thrust (gf)\n${rows.map((row) => `${row}\n`).join("")}`, chosen: "run" }] : [];
}

// What files and form give: the files with what they are, the command lines, the pair, notes, the airframe (null without a frame).
async function build({ files, form }) {
  const built = { files: [], commands: [], command: "identify", pair: null, report: "", notes: [], airframe: null, faults: [], refusals: {} };
  try {
    await assemble(built, files, form);
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    for (const fault of error.faults) {
      // What is said of an option stands at its field.
      const option = fault.message.match(/'?--([\w-]+)/)?.[1];
      const field = error.field || (option in NUMBERS || TEXTS.includes(option) ? option : "");
      if (field) built.refusals[field] = [fault.message.replace(/^invalid value '.*?' for '--[^']*': /, ""), fault.help].filter(Boolean).join("; ");
      else built.faults.push({ severity: "error", ...fault });
    }
    Object.assign(built, { commands: [], airframe: null });
  }
  return built;
}

// An option with its value, which may begin with a minus; none without a value.
const option = (name, value) => (!value ? [] : value.startsWith("-") ? [`--${name}=${value}`] : [`--${name}`, value]);

async function assemble(built, files, form) {
  const options = await ask("words", form.options);
  const how = [
    ...(form["unit-thrust"] ? ["--unit", `thrust=${form["unit-thrust"]}`] : []),
    ...TEXTS.flatMap((id) => option(id, form[id])), ...(form.tare ? ["--tare"] : []),
  ];
  const unit = (...roles) => (form["unit-throttle"] ? roles.flatMap((role) => ["--unit", `${role}=${form["unit-throttle"]}`]) : []);
  const all = { identify: [...how, ...unit("upper", "lower"), ...options], predict: [...how, ...unit("throttle"), ...options] };
  built.files = [...files.map((file) => ({ ...file })), ...typedSheet(form)];
  for (const file of built.files) {
    const told = await kindOf(file, all.identify).catch(({ message }) => {
      if (file.chosen) return { points: 0 };
      throw new Refused([{ file: file.name, message, help: "", mends: [] }]);
    });
    Object.assign(file, told, file.chosen && { kind: file.chosen });
  }
  const of = (kind) => built.files.filter((file) => file.kind === kind).map(({ name }) => name);
  const [maps, [run, lower], [parameters]] = [of("map"), of("run"), of("parameters")];
  // The command that makes the pair of the bench files.
  const beside = lower ? ["--lower-single", lower] : [];
  const points = built.files.reduce((sum, file) => sum + (file.kind === "map" ? file.points : 0), 0);
  const bench = maps.length ? ["identify", ...maps, ...(run && points < ENOUGH ? ["--prior", run, ...beside] : of("run"))]
    : run ? ["predict", run, ...beside] : null;
  const isFramed = Boolean(parameters || form.arm || form.frame === "single");
  built.command = bench?.[0] ?? (parameters ? "import" : form.arm ? "new" : "identify");

  const run_ = async (words, tables) => {
    try {
      const made = await ask("make", words, ...named([...built.files, ...(tables ? [tables] : [])]));
      built.commands.push(["cargo mixer", ...words].map((word, k) => (k ? quoted(word) : word)).join(" "));
      return made;
    } catch (error) {
      // A field without effect on these files is left out, which is said.
      const unused = error instanceof Refused && error.faults.find(({ message }) => message.includes("has nothing to work on"));
      const name = unused && unused.message.match(/--([\w-]+)/)[1];
      if (!(name in NUMBERS) || !words.includes(`--${name}`)) throw error;
      built.notes.push(unused);
      const gone = [name, ...(name === "cells" ? ["chemistry"] : [])].map((name) => words.indexOf(`--${name}`)).filter((at) => at >= 0);
      return run_(words.filter((_, k) => !gone.some((at) => k === at || k === at + 1)), tables);
    }
  };
  const numbers = (command) => Object.keys(NUMBERS).filter((id) => NUMBERS[id].includes(command)).flatMap((id) => {
    const value = numberOf(id, form[id]);
    return option(id, value);
  });
  let tables = built.files.find(({ kind }) => kind === "pair");
  if (bench) {
    const [command] = bench, chemistry = form.cells && form.chemistry ? ["--chemistry", form.chemistry] : [];
    const answer = await run_([...bench, "-o", "pair.toml", ...numbers(command), ...chemistry, ...all[command]]);
    tables = { name: "pair.toml", text: answer.toml };
    Object.assign(built, { pair: tables, report: answer.report, notes: [...built.notes, ...answer.notes] });
  }
  if (!isFramed) return;
  const { frame, name } = form, file = `${name || `my-${parameters ? "airframe" : frame}`}.toml`;
  // Files of several pairs, each by the name of its file; `new` puts front and rear where they belong.
  const pairs = bench || of("pair").length < 2 ? [] : of("pair").map((file) => `${file.replace(/\.\w+$/, "")}=${file}`);
  const borne = pairs.length ? pairs : tables ? [tables.name] : [];
  const more = [...borne.flatMap((pair) => ["--pair", pair]), ...numbers("new"), ...(name ? ["--name", name] : [])];
  const rare = bench ? [] : options;
  const words = parameters ? ["import", parameters, ...more, "-o", file, ...rare]
    : ["new", "--frame", frame, ...more, ...await order(frame, form.stack), "-o", file, ...rare];
  const answer = await run_(words, tables);
  built.notes = [...built.notes, ...answer.notes];
  built.airframe = { name: file, text: answer.toml };
}

// The option of a stack's motor order, where the stack has the frame.
async function order(frame, stack) {
  const words = ["--outputs", stack];
  return ask("make", ["new", "--frame", frame, "--arm", "1", ...words, "-o", "a.toml"], [], []).then(() => words, () => []);
}

// The airframe with keys set in it.
async function withKeys({ name, text }, keys) {
  const labels = Object.fromEntries(Object.entries(KEYS).map(([id, path]) => [path, id]));
  for (const [path, typed] of Object.entries(keys)) {
    const id = labels[path], [table, key] = path.split(".");
    const value = id === "airmode" ? typed && JSON.stringify(typed) : id ? numberOf(id, typed) : typed;
    text = await ask("set", text, table, key, value);
  }
  return { name, text };
}

// What came of the text that was checked last.
let checked = null;
async function check({ name, text }) {
  if (checked?.name !== name || checked.text !== text) {
    const began = performance.now();
    checked = null;
    const told = await ask("check", name, text);
    checked = { name, text, told: { ...told, scene: told.verdict ? await ask("scene") : null, ms: Math.round(performance.now() - began) } };
  }
  return checked.told;
}

// Sets keys in an airframe and checks it; null where a key is refused, with the sentence at its field or among the faults.
async function tried(airframe, keys, built) {
  try {
    const made = await withKeys(airframe, keys), told = await check(made);
    const wrong = told.errors.filter(({ key }) => key in keys);
    if (!wrong.length) return { made, told };
    for (const { key, message, help } of wrong) refuse(built, key, `${message}; ${help}`);
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    if (error.field) built.refusals[error.field] = error.message;
    else Object.keys(keys).forEach((key) => refuse(built, key, error.message));
  }
  return null;
}
function refuse(built, key, message) {
  const id = Object.keys(KEYS).find((id) => KEYS[id] === key);
  if (id) built.refusals[id] = message.replace(/^`[^`]*` = /, "");
  else built.faults.push({ severity: "error", file: "", message, help: "", mends: [] });
}

async function settle() {
  const isExample = isPristine(), { own } = state;
  const inputs = isExample ? EXAMPLE : state, built = await build(inputs);
  let told = null, desk = null;
  if (own) {
    const found = Object.keys(own.keys).length ? await tried(own, own.keys, built) : null;
    if (found && !stale) Object.assign(own, found.made, { keys: {} });
    desk = { name: own.name, text: own.text };
    if (built.airframe) {
      built.airframe = await withKeys(built.airframe, inputs.keys).catch(() => null);
      // Edited back to what files and form give, it is theirs again.
      if (!stale && built.airframe?.text === own.text && !Object.keys(own.keys).length) [state.own, state.made] = [null, built.airframe];
    }
  } else {
    const found = built.airframe && await tried(built.airframe, inputs.keys, built);
    built.airframe = found && found.made;
    if (stale) return null;
    if (built.airframe) {
      // A new airframe is looked at, unless somebody types in a file of it.
      if (built.airframe.text !== state.made?.text && document.activeElement !== editor.area) state.tab = "";
      state.made = { ...built.airframe, isExample };
    }
    if (!built.airframe && state.made?.isExample && !isExample) state.made = null;
    desk = state.made;
  }
  told = desk && await check(desk);
  const isTheirs = Boolean(desk && built.airframe && desk.text === built.airframe.text);
  return { ...built, help: await ask("help", built.command), isExample, desk, told, isTheirs, keys: inputs.keys };
}

// --- one change after the other

let view = null, reading = 0, busy = false, stale = false, timer = 0, asks = false;
// Whether everything that is shown is of what was put in; tests wait for it.
const isSettled = () => Boolean(view) && !reading && !busy && !stale && waiting.size === 0;

// Something was put in: what can be saved is not of it until it has settled. `wait` is that of someone who types.
function changed({ wait = 0, asks: newAsks = false } = {}) {
  [stale, asks] = [true, newAsks];
  clearTimeout(timer);
  timer = setTimeout(run, wait);
  withdraw();
}
async function run() {
  clearTimeout(timer);
  if (busy) return;
  busy = true;
  try {
    while (stale) {
      stale = false;
      const settled = await settle();
      if (stale) continue;
      view = settled;
      render();
      await show();
    }
  } catch (error) {
    say(`The compiler stopped: ${error.message}. Reload the page, which keeps your files.`, true);
  }
  busy = false;
}

// What takes longer than the verdict, each step for as long as nothing newer was put in.
async function show() {
  const steps = [() => hover(), ...shownOutputs().map((what) => () => prepare(what)), () => drawReport()];
  for (const step of steps) {
    if (stale) return;
    await step();
  }
}

let sceneShown = null, reportShown = "";
async function hover() {
  const { told } = view, scene = told?.scene;
  if (!scene || scene === sceneShown) return;
  sceneShown = scene;
  hand.show(scene, told.name, state.hand);
  const at = [scene.volts?.[1] ?? 0, scene.density?.[1] ?? 0];
  const { throttles } = await ask("mix", [0, 0, 0, scene.hover_n], ...at, []);
  hovering.frame(scene.units);
  hovering.turn(throttles, []);
}

async function drawReport() {
  const main = $("report");
  if (!view.told?.verdict) return;
  const maps = view.files.filter(({ kind }) => kind === "map"), of = JSON.stringify([checked.name, checked.text, maps]);
  if (of === reportShown) return;
  const answer = await ask("report", ...named(maps));
  if (stale) return;
  reportShown = of;
  main.innerHTML = answer.body;
  document.body.className = "with-report";
  if (answer.refused) main.prepend(element("p", { className: "warnings", textContent: `Bench files are not shown: ${answer.refused}` }));
  if (answer.model) report(main, JSON.parse(answer.model));
}

const editor = new Editor($("editor"), (text) => {
  const file = state.files.find(({ name }) => name === state.tab);
  if (file) Object.assign(file, { text, edited: true });
  else if (state.own) state.own.text = text;
  else state.own = { name: state.made?.name ?? "airframe.toml", text, keys: {} };
  changed({ wait: 250 });
});
const hand = new Hand(ask, (at) => { state.hand = at; keepSoon(); });
const hovering = new FromAbove($("hovering"));
let keepTimer = 0;
function keepSoon() {
  clearTimeout(keepTimer);
  keepTimer = setTimeout(keep, 200);
}

// --- what is shown of the view

// Why the airframe on the desk is not that of files and form; empty where it is.
function apart() {
  const { desk, isTheirs, isExample, airframe, refusals, faults } = view;
  if (!desk || isTheirs) return "";
  if (state.own && airframe) return "The airframe below is not the one of files and form: it was edited, or is a file of its own.";
  if (state.own) return "The airframe below is a file of its own, or was edited; files and form do not change it.";
  const why = Object.keys(refusals).length || faults.length ? "what was put in last is refused" : "the form has no arm yet";
  return `The airframe below is not the one of files and form: ${why}, and this is the last one before.`;
}

// The sum of it all, which a screen reader says.
function sum() {
  const { desk, told, faults, refusals, isExample, isTheirs, pair } = view;
  const errors = faults.filter(({ severity }) => severity === "error");
  const names = Object.keys(refusals).map((id) => labelOf($(id)).split(",")[0].replace(/^at /, "Thrust at "));
  const parts = [
    ...refusedFiles.map(({ name }) => `${name} is refused`),
    ...names.map((name) => `${name} is refused`),
    ...(errors.length ? [`${plural(errors.length, "error")} in ${errors[0].file || "what the files say"}`] : []),
    ...(asks ? ["Several airframes were dropped: choose one of those put aside"] : []),
    ...(!desk ? [pair ? "The pair is ready: the vehicle needs its frame and arm" : "The vehicle needs its frame and arm"]
      : told.errors.length ? [`${plural(told.errors.length, "error")} in ${desk.name}`]
        : [`${told.name} compiles: ${plural((isTheirs ? warnings() : records("warning")).length, "warning")}, ${told.ms} ms`]),
    ...(apart() && desk ? ["the airframe is not the one of files and form"] : []),
  ];
  say((isExample ? "Ready. An example is shown: drop your files, or fill in your vehicle. " : "") + parts.join("; "),
    Boolean(refusedFiles.length || names.length || errors.length || told?.errors.length));
}

const records = (severity) => (view.told?.[`${severity}s`] ?? []).map((record) => ({ severity, mends: [], ...record }));
const notes = () => view.notes.map((note) => ({ severity: "warning", ...placed(note) }));
const warnings = () => [...notes(), ...records("warning")];
// A note about a row names it as errors do.
function placed(note) {
  const file = view.files.find(({ name }) => note.message.includes(`${name}:`));
  if (!file) return note;
  const [, line, message] = note.message.split(`${file.name}:`).slice(1).join(`${file.name}:`).match(/^(\d+): (.*)/s) ?? [];
  return line ? { ...note, file: file.name, line: Number(line), message } : note;
}

// Buttons that apply what a fault's own help names: options as they stand, and values of the key at fault.
function mendsOf({ key = "", help, mends = [], code }) {
  const options = mends.filter((line) => !state.form.options.includes(line)).map((line) => [`Add ${line}`, () => {
    state.form.options = `${state.form.options} ${line}`.trim();
  }]);
  const value = help.match(new RegExp(`(?:^|[ .])(${key.split(".").pop()}) = (-?[\\d.]+(?:e-?\\d+)?|"[\\w-]+")(?=[ ,;]|$)`));
  const writes = /^[a-z]+\.[a-z_]+$/.test(key) && value ? [[`Write ${value[1]} = ${value[2]}`, () => write(key, value[2])]] : [];
  const corrects = code === "MIX323" && view.pair && !state.own ? [["Take 1.75 as the exponent of the voltage", () => { state.form["voltage-exponent"] = "1.75"; }]] : [];
  const measures = code === "MIX309" ? [["Choose a bench file", () => $("choose").click()]] : [];
  return [...options, ...writes, ...corrects, ...measures];
}
// Writes a value of a key: into its field where it has one, else into the file.
function write(key, value) {
  const plain = value.replace(/^"|"$/g, "");
  if (key === "layout.arm_m" && !state.own) state.form.arm = plain;
  else (state.own ?? state).keys[key] = Object.values(KEYS).includes(key) ? plain : value;
}

function faultItem({ severity, code, file, line, column, message, help, ...more }) {
  const item = element("li", { className: severity }, element("b", { textContent: `${severity}${code ? ` ${code}` : ""} ` }));
  if (line) {
    const place = element("button", { type: "button", className: "place", textContent: `${file}:${line}` });
    place.addEventListener("click", () => { state.tab = file === view.desk?.name ? "" : file; renderEditor(); editor.go(line, column ?? 1); });
    item.append(place, " ");
  } else if (file) item.append(`${file} `);
  const needsPair = code === "MIX003" && more.key === "pair";
  item.append(needsPair ? "The vehicle is read; its pair of rotors is not known yet" : message);
  if (help) item.append(element("br"), `Mend: ${needsPair ? "drop the bench file or the data sheet of the pair above" : help}`);
  for (const [textContent, apply] of mendsOf({ code, help: help ?? "", ...more })) {
    const button = element("button", { type: "button", className: "mend", textContent });
    button.addEventListener("click", () => { apply(); changed(); });
    item.append(" ", button);
  }
  return item;
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

// Whether the frame is that of a file, and no choice of the form has a part in it.
const isOfFile = () => Boolean(view.told?.verdict) && state.form.frame === fresh().form.frame
  && (state.own ? !view.airframe : view.files.some(({ kind }) => kind === "parameters"));
const rotorsInWords = () => view.told.verdict.match(/^rotors +(.*?)(, arms.*)?$/m)[1];
function renderFields() {
  const { scene } = view.told ?? {};
  for (const id of [...FIELDS, ...Object.keys(KEYS)]) {
    const field = $(id), path = KEYS[id], refusal = view.refusals[id];
    let typed = path ? (state.own ?? state).keys[path] ?? (view.isExample ? "" : scene?.[id] ?? "") : state.form[id];
    if (id === "frame" && isOfFile()) [typed, field.lastElementChild.textContent] = ["file", `of the file: ${rotorsInWords()}`];
    if (document.activeElement !== field || field.tagName === "SELECT") field.value = typed;
    field.setAttribute("aria-invalid", Boolean(refusal));
    let note = $(`${id}-refused`);
    if (refusal && !note) {
      note = element("small", { id: `${id}-refused`, className: "refused" });
      field.closest("label").append(note);
      field.setAttribute("aria-describedby", note.id);
    }
    if (note) note.textContent = refusal ?? "";
    if (refusal) for (let box = field.closest("details"); box; box = box.parentElement.closest("details")) box.open = true;
  }
}

function renderFiles() {
  const remove = (name, textContent, label, act) => {
    const button = element("button", { type: "button", textContent, "aria-label": `${label} ${name}` });
    button.addEventListener("click", () => { act(); changed(); });
    return button;
  };
  $("dropped").replaceChildren(...state.files.map((file) => {
    const kinds = element("select", { "aria-label": `What ${file.name} is` }, ...Object.entries(KINDS).map(([value, textContent]) => element("option", { value, textContent })));
    kinds.value = view.files.find(({ name }) => name === file.name)?.kind ?? file.chosen;
    kinds.addEventListener("change", () => { file.chosen = kinds.value; changed(); });
    return element("li", {}, element("b", { textContent: file.name }), kinds, remove(file.name, "Remove", "Remove", () => { state.files = state.files.filter((other) => other !== file); }));
  }), ...refusedFiles.map((file) => element("li", { className: "error" }, element("b", { textContent: file.name }), ` ${file.message} `,
    remove(file.name, "Dismiss", "Dismiss", () => { refusedFiles = refusedFiles.filter((other) => other !== file); }))));
  $("aside").replaceChildren(...state.aside.map((file) => element("li", {}, element("b", { textContent: file.name }), " put aside",
    (() => {
      const back = element("button", { type: "button", className: "back", textContent: "Work on it", "aria-label": `Work on ${file.name}` });
      back.addEventListener("click", async () => { state.aside = state.aside.filter((other) => other !== file); await take(file); changed(); });
      return back;
    })(),
    remove(file.name, "Throw away", "Throw away", () => { state.aside = state.aside.filter((other) => other !== file); }))));
  const { files, pair, report: told } = view;
  const bench = files.filter(({ kind }) => kind === "map" || kind === "run" || kind === "pair").map(({ name, kind, points }) => `${name}: ${KINDS[kind]}${points ? `, ${plural(points, "point")}` : ""}`);
  const [, measured, predicted] = told.match(/^(?:model error\s+(.*?largest torque)|to trust\s+(.*?full scale))/ms)?.map((part) => part?.replace(/\s+/g, " ")) ?? [];
  const trust = measured ? `known within ${measured}` : predicted ? `predicted: ${predicted}` : "known";
  $("read").hidden = !bench.length;
  $("read").textContent = `${bench.join("; ")}. ${pair ? `The pair is ${trust}` : "No pair was made of it yet"}.`;
  const maps = files.filter(({ kind }) => kind === "map").map(({ name }) => name);
  if (maps.length > 1) $("read").append(` ${maps.join(" and ")} are read as benches of one pair. Of two pairs, save the tables of each as front.toml and rear.toml, and drop both.`);
  fill($("pair-report"), told);
  $("pair-report").closest("details").hidden = !told;
}

function renderEditor() {
  const { desk } = view;
  const edited = [...state.files, ...(desk ? [{ name: "", label: desk.name, text: desk.text }] : [])];
  if (!edited.some(({ name }) => name === state.tab)) state.tab = desk ? "" : (edited[0]?.name ?? "");
  $("tabs").replaceChildren(...edited.map(({ name, label }) => {
    const tab = element("button", { type: "button", "aria-pressed": String(name === state.tab), textContent: label ?? name });
    tab.addEventListener("click", () => { state.tab = name; renderEditor(); });
    return tab;
  }));
  editor.text = edited.find(({ name }) => name === state.tab)?.text ?? "";
  editor.mark(faults().filter(({ file }) => file === (state.tab || desk?.name)));
}
const faults = () => [...view.faults, ...(view.desk ? records("error") : []), ...warnings()].map((fault) => ({ ...fault }));

const percent = (x) => `${(100 * x).toFixed(0)} %`;
const span = ([least, most]) => (percent(least) === percent(most) ? percent(least) : `${percent(least).slice(0, -2)} to ${percent(most)}`);
// The three numbers that say whether a vehicle flies well, each with what is usual.
function renderNumbers() {
  const numbers = view.told?.numbers;
  const { volts, hover: throttles, usual_hover: usual, over_weight: ratio, yaw_nm: yaw, yaw_over_roll: share, mass_kg: mass } = numbers ?? {};
  const lack = !numbers ? "no airframe yet" : mass === null ? "needs the mass" : "the weight is not carried";
  const at = volts ? ` at ${volts} V` : "";
  const rows = [
    ["Hover throttle", throttles?.map(([layer, ends]) => span(ends) + (throttles.length > 1 ? ` ${layer}` : "")).join(", "),
      usual ? `usual: ${span(usual)}${at}, where these rotors give 30 to 60 % of their largest thrust` : "usual: 30 to 60 % of the largest thrust"],
    ["Thrust over weight", ratio && ratio.toFixed(2), `usual: 1.7 to 3.3${at}`],
    ["Yaw left in hover", yaw && `${short(yaw)} N m${share ? `, ${percent(share)} of the roll` : ""}`, "usual: 2 to 10 % of the roll"],
  ];
  $("numbers").replaceChildren(...rows.map(([name, value, hint]) => element("div", {}, element("dt", { textContent: name }),
    element("dd", {}, element("b", { textContent: value || lack }), element("small", { textContent: hint })))));
}

function render() {
  const { desk, told, command, commands, isTheirs, isExample, keys } = view, { form } = state;
  const compiles = Boolean(told?.verdict), reason = apart();
  renderFields();
  renderFiles();
  renderNumbers();
  renderEditor();
  $("faults").replaceChildren(...faults().map(faultItem));
  fill($("verdict"), compiles ? told.verdict : "");
  $("hand").hidden = !compiles;
  $("hovering").closest("figure").hidden = !compiles;
  $("hovering-caption").textContent = compiles ? `${told.name} from above in hover, nose up; throttles in percent.` : "";
  if (!compiles) {
    reportShown = "";
    $("report").replaceChildren();
    document.body.className = "";
  }
  const notice = isExample ? "This is an example, for you to look around: an X8 with the rotors of a published one. Your own takes its place." : reason;
  $("differs").hidden = !notice;
  $("differs").querySelector("span").textContent = notice;
  $("replace").hidden = !(state.own && view.airframe && !isTheirs);
  const set = !isTheirs ? [] : Object.entries(keys).filter(([, value]) => value).map(([path, value]) => {
    const [table, key] = path.split("."), id = Object.keys(KEYS).find((id) => KEYS[id] === path);
    return `${key} = ${id && id !== "airmode" ? numberOf(id, value) : value} in [${table}]`;
  });
  const shown = commands.length && (isTheirs || !desk) ? commands.join(" && ") + (set.length && isTheirs ? `  # then ${set.join(", ")}` : "") : "";
  $("made-by").hidden = !shown;
  $("command").textContent = shown;
  $("command-name").textContent = command;
  $("options").placeholder = EXAMPLES[command];
  $("help").textContent = view.help;
  $("vehicle-note").textContent = form.cells && !["identify", "predict"].includes(command)
    ? "Cells and chemistry count with a bench file or a data sheet; this pair has the voltages of its own bench." : "";
  $("library").textContent = `cargo mixer library ${quoted(desk?.name ?? "airframe.toml")} --target thumbv7em-none-eabihf -o lib`;
  $("nothing").textContent = compiles ? "Files in the order of their use." : desk ? `${desk.name} does not compile: only the file itself can be saved.` : "There is no airframe yet.";
  arrange();
  keep();
  sum();
}

// --- files to take along

const sheet = () => view.files.find(({ name }) => name === SHEET_NAME);
// Each output has one entry, which moves between the two lists: its link holds the file once it is made.
const entries = Object.fromEntries(Object.entries(OUTPUTS).map(([what, [name, where]]) => {
  const save = element("a", { className: "save", textContent: name }), notes = element("ul", { className: "list" });
  save.dataset.output = what;
  const item = element("li", {}, save, element("span", { textContent: ` ${where}` }), notes);
  return [what, { item, save, notes, url: "" }];
}));
function arrange() {
  const first = OF_STACK[state.form.stack] ?? [], compiles = Boolean(view.told?.verdict);
  const has = (what) => (what === "airframe" ? view.desk : what === "pair" ? view.pair : what === "sheet" ? sheet() : compiles);
  const place = (list, all) => list.replaceChildren(...all.filter(has).map((what) => entries[what].item));
  place($("files"), first);
  place($("others"), Object.keys(OUTPUTS).filter((what) => !first.includes(what)));
}
const shownOutputs = () => [...document.querySelectorAll(`#files a.save${$("more").open ? ", #others a.save" : ""}`)].map((save) => save.dataset.output);

// Takes the files back that are not of what was put in.
function withdraw() {
  for (const entry of Object.values(entries)) {
    if (entry.url) URL.revokeObjectURL(entry.url);
    entry.url = "";
    entry.save.removeAttribute("href");
    entry.notes.replaceChildren();
  }
}

async function made(what) {
  if (what === "airframe") return view.desk;
  if (what === "pair") return view.pair;
  if (what === "sheet") return sheet();
  if (what === "report") return { name: `${view.told.name}.html`, text: await ask("page", ...named(view.files.filter(({ kind }) => kind === "map"))) };
  return ask("output", what, state.form.pulses);
}
// Makes a file, so that its link needs nothing more than a click: a browser drops what a page saves long after one.
async function prepare(what) {
  const entry = entries[what];
  if (entry.url) return;
  const note = (className, textContent) => element("li", { className, textContent });
  try {
    const { name, text, notes = [] } = await made(what);
    if (stale) return;
    entry.url = URL.createObjectURL(new Blob([text], { type: "application/octet-stream" }));
    Object.assign(entry.save, { href: entry.url, download: name });
    entry.notes.replaceChildren(...notes.map((text) => note("warning", text)));
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    entry.notes.replaceChildren(note("error", error.message));
  }
}

// --- events

$("choose").addEventListener("change", async () => { await drop([...$("choose").files]); $("choose").value = ""; });
for (const kind of ["dragover", "dragleave", "drop"]) {
  addEventListener(kind, (event) => {
    event.preventDefault();
    $("drop").classList.toggle("over", kind === "dragover");
    if (kind === "drop") drop([...event.dataTransfer.files]);
  });
}
for (const id of [...FIELDS, ...Object.keys(KEYS)]) {
  $(id).addEventListener("input", () => {
    const typed = $(id).value.trim(), path = KEYS[id];
    if (!path) state.form[id] = typed;
    else if (typed || state.own) (state.own ?? state).keys[path] = typed;
    else delete state.keys[path];
    refusedFiles = [];
    changed({ wait: 250 });
  });
}
$("frame-form").addEventListener("submit", (event) => event.preventDefault());
$("example-sheet").addEventListener("click", () => {
  add({ name: "rotor.csv", text: $("sample-sheet").textContent, chosen: "" });
  Object.assign(state.form, { diameter: "0.305", spacing: "0.08", arm: state.form.arm || "0.4" });
  changed();
});
$("replace").addEventListener("click", () => { putAside(state.own); state.own = null; document.activeElement?.blur(); changed(); });
$("more").addEventListener("toggle", () => { if ($("more").open && view) changed(); });
$("share").addEventListener("click", async () => {
  if (!view?.desk) return;
  const text = await link(view.desk);
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
  [state, refusedFiles, checked] = [fresh(), [], null];
  $("linked").hidden = true;
  $("link").value = "";
  document.activeElement?.blur();
  changed();
});

(async () => {
  await loaded;
  await linked();
  removeEventListener("error", early);
  removeEventListener("unhandledrejection", early);
  changed();
  if (location.protocol.startsWith("http")) navigator.serviceWorker?.register("sw.js").catch(() => {});
})();
