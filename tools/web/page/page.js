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
const KEY = "coaxial-mixer";
// Numbers of the data sheet of one rotor: its file has a row for each throttle that has a thrust.
const SHEET = [50, 65, 75, 85, 100];
const SHEET_NAME = "data-sheet.csv";
// Fields whose number is an option of the same name, by the commands that have it; `import` has that of `new`.
const NUMBERS = { new: ["arm"], identify: ["cells"], predict: ["cells", "diameter", "spacing", "run-voltage"] };
// Fields whose text is an option of the same name of the commands that read bench files.
const TEXTS = ["pwm-range", "voltage-exponent", "temperature", "pressure", "reference-voltage"];
const THRUSTS = SHEET.map((percent) => `thrust-${percent}`);
const FIELDS = ["frame", "name", "stack", "chemistry", "capacity", "unit-thrust", "unit-throttle", "tare", "swap", "options", "pulses", "arm", ...NUMBERS.predict, ...TEXTS, ...THRUSTS];
// Fields of keys of the airframe file: those that are set in it after it is made, and those that it is made with.
const KEYS = { mass_kg: "vehicle.mass_kg", airmode: "allocation.airmode", yaw_reserve_nm: "allocation.yaw_reserve_nm", power_bias_nm_per_n: "allocation.power_bias_nm_per_n" };
const FIELD_OF = { ...Object.fromEntries(Object.entries(KEYS).map(([id, path]) => [path, id])), "layout.arm_m": "arm", name: "name" };
const KINDS = { map: "bench file of a pair", run: "run of one rotor", pair: "pair's tables", parameters: "vehicle's parameters" };
// From this many points on a pair's bench file needs no prediction to stand on (cargo mixer identify --prior).
const ENOUGH = 16;
// Bytes of a file, beyond which an editor and the browser's storage are the wrong place for it.
const LARGEST = 4 << 20;

// Files to take along: what Desk.output and the page call them, a name, and where they go.
const OUTPUTS = {
  airframe: ["Airframe file", "Keep it: everything else is made of it."],
  sheet: ["Data sheet", "What was typed in, as a file."],
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
  "report.txt": ["Every number", "All that is known of the airframe, as text."],
};
const ofStack = (stack) => (stack === "own" ? ["rs", "vectors.csv", "report", "airframe"] : [`${stack}-own`, "report", "airframe", stack]);

const quoted = (word) => (/^[\w./,=:+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
const isText = (text) => typeof text === "string";
const plural = (n, word) => `${n || "no"} ${word}${n === 1 ? "" : "s"}`;

// --- the worker

// What the compiler has against an input: faults of files, or the sentence at a field.
class Refused extends Error {
  constructor(why, field = "") {
    const faults = isText(why) ? [{ message: why }] : why;
    super(faults.map(({ message }) => message).join("; "));
    Object.assign(this, { faults, field });
  }
}
const waiting = new Map();
let asked = 0, worker, loaded;
const ask = (method, ...words) => new Promise((...both) => {
  if (!waiting.size) since = performance.now();
  step = (STEPS[method] ?? "") + (method === "kind" ? words[0] : "") || step;
  waiting.set(asked += 1, both);
  worker.postMessage({ id: asked, method, words });
});
const program = URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" }));
const packedModule = Uint8Array.from(atob($("module").textContent.trim()), (c) => c.charCodeAt(0));
$("module").remove();
function begin() {
  worker = new Worker(program);
  worker.onerror = ({ message }) => failed(message || "its worker is refused");
  worker.onmessage = ({ data: { id, value, error } }) => {
    const [resolve, reject] = waiting.get(id);
    waiting.delete(id);
    if (error) reject(new Error(error));
    else if (value?.Err !== undefined) reject(new Refused(value.Err));
    else resolve(value?.Ok ?? value);
  };
  loaded = ask("open", packedModule);
}

// What is under way, from 300 ms on, with a way to stop it: what was put in since the last time that all was done is taken back.
const STEPS = { kind: "Reading ", make: "Making the model", check: "Compiling", report: "Drawing the report", output: "Writing the files" };
let since = 0, step = "";
setInterval(() => {
  const seconds = (performance.now() - since) / 1000;
  $("work").hidden = isSettled() || !view || seconds < 0.3;
  $("work").querySelector("span").textContent = `${step}, ${seconds.toFixed(0)} s`;
}, 100);
class Stopped extends Error {}
let done = "";
function stop() {
  worker.terminate();
  for (const [, reject] of waiting.values()) reject(new Stopped());
  waiting.clear();
  begin();
  restart(done ? JSON.parse(done) : fresh());
}
// Goes on with another state, of which everything is made anew.
function restart(of) {
  [state, refusedFiles, checked, reportShown] = [of, [], null, ""];
  changed();
}

// --- the state

// `own` is an airframe that was edited or dropped, with the keys that fields are to set in it; `made` the last one that files and
// form gave; `last` what was taken last of fields without a part in the airframe; `drawn` the units that were drawn last; `aside` texts that something else took the place of; `dropped` the airframes of which one is to be chosen.
const fresh = () => ({
  files: [], form: { ...Object.fromEntries(FIELDS.map((key) => [key, ""])), frame: "x8", stack: "px4" }, keys: {},
  last: { pulses: "", capacity: "" }, drawn: null, own: null, made: null, aside: [], tab: "", hand: null,
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
    const read = JSON.parse(localStorage.getItem(KEY)), { files, keys, own, made, aside, tab, hand } = read;
    const state = { ...fresh(), ...read, form: { ...fresh().form, ...read.form } };
    if ([...files, ...aside, ...[own, made].filter((of) => of !== null)].every(isFile) && [keys, own?.keys ?? {}, state.form, state.last, [tab]].every(areTexts)
      && (hand === null || hand.wrench.length === 4 && Array.isArray(hand.failed))) return state;
  } catch {}
  return fresh();
}

// --- files and airframes from outside

// Puts aside what stands in the place of a newer text, unless it is the same.
function putAside(file) {
  if (file && !state.aside.some(({ text }) => text === file.text)) state.aside.push({ name: file.name, text: file.text });
}
function receive({ name, text }) {
  putAside(state.own);
  state.aside = state.aside.filter((file) => file.text !== text);
  [state.own, state.tab] = [{ name, text, keys: {} }, ""];
  // A field that somebody was in shows what this airframe has.
  document.activeElement?.blur();
}
// One more file of those that make an airframe; the newest of a name counts.
function add({ name, text }) {
  const before = state.files.find((file) => file.name === name);
  if (before?.edited && before.text !== text) putAside(before);
  state.files = [...state.files.filter((file) => file !== before), { name, text, chosen: "" }];
  state.tab = name;
}
// What a text is, and the points of a bench file with options of `identify`. A long file is read once.
let kinds = [];
async function kindOf({ name, text }, options) {
  const words = options.join("\n"), same = (of) => of.name === name && of.words === words && of.text === text;
  const known = kinds.find(same) ?? { name, words, text, told: await ask("kind", name, new TextEncoder().encode(text), options) };
  kinds = [known, ...kinds.filter((of) => of !== known)].slice(0, 20);
  const { kind, points } = known.told;
  return { kind: ["px4", "ardupilot", "betaflight"].includes(kind) ? "parameters" : kind, points };
}
// Takes a text for what it is.
async function take(file) {
  const { kind } = await kindOf(file, []);
  if (kind === "airframe") receive(file);
  else add(file);
}

async function drop(files) {
  const airframes = [];
  refusedFiles = [];
  reading += 1;
  withdraw();
  for (const file of files) {
    try {
      if (file.size > LARGEST) throw new Error("above 4 MB, as no bench file is: flight logs are read by cargo mixer review");
      const told = await ask("kind", file.name, new Uint8Array(await file.arrayBuffer()), []), { kind, text } = told;
      kinds.unshift({ name: file.name, words: "", text, told });
      if (kind === "airframe") airframes.push({ name: file.name, text });
      else add({ name: file.name, text });
    } catch (error) {
      if (error instanceof Stopped) {
        reading -= 1;
        return;
      }
      refusedFiles.push({ name: file.name, message: error.message });
    }
  }
  reading -= 1;
  if (airframes.length > 1) airframes.forEach(putAside);
  else airframes.forEach(receive);
  changed({ isAsked: airframes.length > 1 });
}

const passed = (content, stream) => new Response(new Blob([content]).stream().pipeThrough(stream));
async function link({ name, text }) {
  const bytes = new Uint8Array(await passed(JSON.stringify({ name, text }), new CompressionStream("deflate-raw")).arrayBuffer());
  const packedText = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return `${location.href.split("#")[0]}#airframe=${packedText}`;
}
async function linked() {
  const found = location.hash.match(/^#airframe=([\w-]+)$/);
  if (!found) return;
  history.replaceState(null, "", location.href.split("#")[0]);
  try {
    const bytes = Uint8Array.from(atob(found[1].replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
    const { name, text } = await passed(bytes, new DecompressionStream("deflate-raw")).json();
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

// A name as files have it, made of what was typed: `My X8` is `my-x8`.
function nameOf(typed) {
  const plain = typed.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase().replace(/[^a-z0-9_]+/g, "-").replace(/^[-_]+|[-_]+$/g, "");
  if (typed && !plain) throw new Refused(`${typed} has no letter from a to z`, "name");
  return /^\d/.test(plain) ? `x-${plain}` : plain;
}
// Pulse widths of throttle 0 and 1, for the parameters.
function pulsesOf(typed) {
  const [, low, high] = typed.match(/^(\d+(?:\.\d+)?)\s*[,;]\s*(\d+(?:\.\d+)?)$/) ?? [];
  if (typed && !(Number(low) < Number(high))) throw new Refused(`${typed} is not two widths, the one of throttle 0 first, as 1000,2000`, "pulses");
  return typed && `${low},${high}`;
}

// The data sheet that was typed in, as a file; none without a thrust.
function typedSheet(form) {
  const rows = SHEET.map((percent, k) => [percent, numberOf(THRUSTS[k], form[THRUSTS[k]])]).filter(([, thrust]) => thrust);
  return rows.length ? [{ name: SHEET_NAME, text: `Throttle (%),Thrust (gf)\n${rows.map((row) => `${row}\n`).join("")}`, chosen: "run" }] : [];
}

// What files and form give: the files with what they are, the command lines, the pair, notes, the airframe (null without a frame).
async function build({ files, form }) {
  const built = { files: [], commands: [], command: "identify", pair: null, report: "", warnings: [], notes: [], airframe: null, faults: [], refusals: {} };
  try {
    await assemble(built, files, form);
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    for (const fault of error.faults) {
      // What is said of an option stands at its field, or where it was typed.
      const named = [...`${fault.message} ${fault.help ?? ""}`.matchAll(/--([\w-]+)/g)].map(([, option]) => option);
      const field = error.field || named.find((option) => FIELDS.includes(option)) || (named.some((option) => form.options.includes(`--${option}`)) ? "options" : "");
      refuse(built, field, fault);
    }
    Object.assign(built, { commands: [], airframe: null });
  }
  return built;
}

// An option with its value, which may begin with a minus; none without a value.
const option = (name, value) => (!value ? [] : value.startsWith("-") ? [`--${name}=${value}`] : [`--${name}`, value]);

async function assemble(built, files, form) {
  const options = await ask("words", form.options);
  const unit = (id, ...roles) => (form[id] ? roles.flatMap((role) => ["--unit", `${role}=${form[id]}`]) : []);
  const how = [...unit("unit-thrust", "thrust"), ...TEXTS.flatMap((id) => option(id, form[id])), ...["tare", "swap"].flatMap((id) => (form[id] ? [`--${id}`] : []))];
  const all = { identify: [...how, ...unit("unit-throttle", "upper", "lower"), ...options], predict: [...how, ...unit("unit-throttle", "throttle"), ...options] };
  built.files = [...files.map((file) => ({ ...file })), ...typedSheet(form)];
  for (const file of built.files) {
    const told = await kindOf(file, all.identify).catch(({ message }) => {
      if (file.chosen) return { points: 0 };
      throw new Refused([{ file: file.name, message }]);
    });
    Object.assign(file, told, file.chosen && { kind: file.chosen });
  }
  const of = (kind) => built.files.filter((file) => file.kind === kind).map(({ name }) => name);
  const [maps, [run, lower], [parameters]] = [of("map"), of("run"), of("parameters")];
  // The command that makes the pair of the bench files.
  const beside = option("lower-single", lower);
  const points = built.files.reduce((sum, file) => sum + (file.kind === "map" ? file.points : 0), 0);
  const bench = maps.length ? ["identify", ...maps, ...(run && points < ENOUGH ? ["--prior", run, ...beside] : of("run"))]
    : run ? ["predict", run, ...beside] : null;
  const isFramed = Boolean(parameters || form.arm || form.frame === "single");
  built.command = bench?.[0] ?? (parameters ? "import" : form.arm ? "new" : "identify");

  const run_ = async (words) => {
    try {
      const made = await ask("make", words, ...named([...built.files, ...(built.pair ? [built.pair] : [])]));
      built.commands.push(`cargo mixer ${words.map(quoted).join(" ")}`);
      return made;
    } catch (error) {
      // A field without effect on these files is left out, which is said.
      const unused = error.faults?.find(({ message }) => message.includes("has nothing to work on"));
      const name = unused?.message.match(/--([\w-]+)/)[1];
      if (!Object.values(NUMBERS).flat().includes(name) || !words.includes(`--${name}`)) throw error;
      built.notes.push(unused);
      const gone = [`--${name}`, ...(name === "cells" ? ["--chemistry"] : [])];
      return run_(words.filter((word, k) => !gone.includes(word) && !gone.includes(words[k - 1])));
    }
  };
  const heed = ({ warnings, notes }) => {
    built.warnings.push(...warnings);
    built.notes.push(...notes);
  };
  const numbers = (command) => NUMBERS[command].flatMap((id) => option(id, numberOf(id, form[id])));
  if (bench) {
    const [command] = bench, chemistry = option("chemistry", form.cells && form.chemistry);
    const answer = await run_([...bench, "-o", "pair.toml", ...numbers(command), ...chemistry, ...all[command]]);
    Object.assign(built, { pair: { name: "pair.toml", text: answer.toml }, report: answer.report });
    heed(answer);
  }
  if (!isFramed) return;
  const { frame } = form, name = nameOf(form.name), file = `${name || `my-${parameters ? "airframe" : frame}`}.toml`;
  // Files of several pairs, each by the name of its file; `new` puts front and rear where they belong.
  const pairs = built.pair ? [built.pair.name] : of("pair"), isOne = pairs.length === 1;
  const borne = pairs.flatMap((file) => ["--pair", isOne ? file : `${file.replace(/\.\w+$/, "")}=${file}`]);
  const more = [...borne, ...numbers("new"), ...option("name", name)];
  const words = parameters ? ["import", parameters, ...more] : ["new", "--frame", frame, ...more, ...await order(frame, form.stack)];
  const answer = await run_([...words, "-o", file, ...(bench ? [] : options)]);
  heed(answer);
  built.airframe = { name: file, text: answer.toml };
}

// The option of a stack's motor order, where the stack has the frame.
async function order(frame, stack) {
  const words = ["--outputs", stack];
  return ask("make", ["new", "--frame", frame, "--arm", "1", ...words, "-o", "a.toml"], [], []).then(() => words, () => []);
}

const valueOf = (path, typed) => (path in FIELD_OF && FIELD_OF[path] !== "airmode" ? numberOf(FIELD_OF[path], typed) : typed);
// The airframe with keys set in it.
async function withKeys({ name, text }, keys) {
  for (const [path, typed] of Object.entries(keys)) {
    const value = valueOf(path, typed);
    text = await ask("set", text, ...path.split("."), FIELD_OF[path] === "airmode" && value ? JSON.stringify(value) : value);
  }
  return { name, text };
}

// What came of the text that was checked last.
let checked = null, reportShown = "";
async function check({ name, text }) {
  if (checked?.name !== name || checked.text !== text) {
    const began = performance.now();
    checked = null;
    const told = await ask("check", name, text);
    checked = { name, text, told: { ...told, scene: told.verdict ? await ask("scene") : null, ms: Math.round(performance.now() - began) } };
  }
  return checked.told;
}

// Sets keys in an airframe and checks it; null where that is refused, with the sentence at its field or among the faults. Of an
// airframe of one's own, errors elsewhere are its own; of files and form's any refuses it, at the field that was typed in last
// where no other is to blame, unless no airframe is there that could stay.
async function tried(airframe, keys, built) {
  try {
    const made = await withKeys(airframe, keys), told = await check(made);
    const wrong = told.errors.filter(({ key }) => key in keys || !state.own && (key in FIELD_OF || blamed || lastMade()));
    if (!wrong.length) return { made, told };
    // Its lines are not those of the airframe that stays.
    for (const fault of wrong) refuse(built, FIELD_OF[fault.key] ?? (state.own ? "" : blamed), { ...fault, file: "", line: null });
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    const fields = error.field ? [error.field] : Object.keys(keys).map((key) => FIELD_OF[key]);
    for (const field of fields) refuse(built, field, error.faults[0]);
  }
  return null;
}
// At a field the sentence needs no name of what it is about.
function refuse(built, field, fault) {
  if (field) built.refusals[field] ??= { ...fault, message: fault.message.replace(/^(`[^`]*` = |invalid value '.*?' for '--[^']*': )/, "") };
  else built.faults.push({ severity: "error", ...fault });
}
// The airframe that files and form gave last; null of the example.
const lastMade = () => (state.made?.isExample ? null : state.made);

async function settle() {
  const isExample = isPristine(), { own } = state;
  const inputs = isExample ? EXAMPLE : state, built = await build(inputs);
  let desk = null;
  for (const [id, read] of [["pulses", pulsesOf], ["capacity", (typed) => numberOf("capacity", typed)]]) {
    try {
      state.last[id] = read(state.form[id]);
    } catch (error) {
      refuse(built, id, error.faults[0]);
    }
  }
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
  const told = desk && await check(desk);
  const isTheirs = Boolean(desk && built.airframe && desk.text === built.airframe.text);
  return { ...built, help: await ask("help", built.command), isExample, desk, told, isTheirs, keys: inputs.keys };
}

// --- one change after the other

let view = null, reading = 0, busy = false, stale = false, timer = 0, asks = false;
// The field that was typed in last, as long as nothing else changed an airframe that compiled before.
let blamed = "";
// Whether everything that is shown is of what was put in; tests wait for it.
const isSettled = () => Boolean(view) && !reading && !busy && !stale && waiting.size === 0;

// Something was put in: what can be saved is not of it until it has settled. `wait` is that of someone who types.
function changed({ wait = 0, isAsked = false, field = "" } = {}) {
  [stale, asks, blamed] = [true, isAsked, field];
  clearTimeout(timer);
  timer = setTimeout(run, wait);
  withdraw();
}
async function run() {
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
      if (!stale) done = JSON.stringify(state);
    }
  } catch (error) {
    if (!(error instanceof Stopped)) say(`The compiler stopped: ${error.message}. Reload the page, which keeps your files.`, true);
  }
  busy = false;
}

// What takes longer than the verdict, each step for as long as nothing newer was put in.
async function show() {
  const steps = [hover, ...shownOutputs().map((what) => () => prepare(what)), drawReport];
  for (const step of steps) {
    if (stale) return;
    await step();
  }
}

let sceneShown = [];
async function hover() {
  const { told } = view, scene = told?.scene, shown = [scene, isByOutput(), state.form.diameter];
  if (!scene || shown.every((of, k) => of === sceneShown[k])) return;
  sceneShown = shown;
  state.drawn = scene.units;
  hand.show(scene, told.name, state.hand);
  const { throttles } = await ask("mix", [0, 0, 0, scene.hover_n], scene.volts?.[1] ?? 0, scene.density?.[1] ?? 0, []);
  sketch(throttles);
}

// Bench files of the pair.
const maps = () => view.files.filter(({ kind }) => kind === "map");
async function drawReport() {
  const main = $("report");
  if (!view.told?.verdict) return;
  const of = JSON.stringify([checked.name, checked.text, maps()]);
  if (of === reportShown) return;
  const answer = await ask("report", ...named(maps()));
  if (stale) return;
  reportShown = of;
  main.innerHTML = answer.body;
  document.body.className = "with-report";
  if (answer.refused) main.prepend(element("p", { className: "warnings", textContent: `Bench files are not shown: ${answer.refused}` }));
  for (const { lastChild } of main.querySelectorAll(".warnings li")) lastChild.textContent = plain(lastChild.textContent);
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

// The frame of the airframe; before there is one, what was drawn last, else the example.
const EXAMPLE_UNITS = [[1, 1, [0, 5], "ccw"], [-1, 1, [3, 6], "cw"], [-1, -1, [2, 7], "ccw"], [1, -1, [1, 4], "cw"]]
  .map(([x, y, channels, upper_spin]) => ({ place_m: [0.3182 * x, 0.3182 * y], channels, upper_spin }));
const units = () => state.drawn ?? EXAMPLE_UNITS;
function sketch(throttles) {
  measure();
  hovering.frame(units(), measured.diameter);
  hovering.turn(throttles);
}
// Arm, diameter and spacing as they are typed; of what is no number the last one stays. Without an arm in the form it is the scene's.
const measured = {};
function measure() {
  for (const id of ["arm", "diameter", "spacing"]) {
    try {
      measured[id] = Number(numberOf(id, state.form[id]));
    } catch {}
  }
  drawSide($("side"), { ...measured, arm: measured.arm || farthest(units()) });
}
let keepTimer = 0;
function keepSoon() {
  clearTimeout(keepTimer);
  keepTimer = setTimeout(keep, 200);
}

// --- what is shown of the view

const isRefused = () => view.faults.length > 0 || Object.keys(view.refusals).length > 0;
// Why the airframe on the desk is not that of files and form; empty where it is.
function apart() {
  const { desk, isTheirs, airframe } = view;
  if (!desk || isTheirs) return "";
  if (state.own && airframe) return "The airframe below is not the one of files and form: it was edited, or is a file of its own.";
  if (state.own) return "The airframe below is a file of its own, or was edited; files and form do not change it.";
  const why = isRefused() ? "what was put in last is refused" : "the form has no arm yet";
  return `The airframe below is not the one of files and form: ${why}, and this is the last one before.`;
}

// The sum of it all, which a screen reader says.
function sum() {
  const { desk, told, faults, refusals, isExample, isTheirs, pair } = view;
  const fields = Object.keys(refusals).map((id) => labelOf($(id)).split(",")[0].replace(/^(?=\d)/, "Thrust at "));
  const refused = [...refusedFiles.map(({ name }) => name), ...fields];
  const parts = [
    ...refused.map((name) => `${name} is refused`),
    faults.length && `${plural(faults.length, "error")} in ${faults[0].file || "what the files say"}`,
    asks && "Several airframes were dropped: choose one of those put aside",
    !desk ? (pair ? "The pair is ready: the vehicle needs its frame and arm" : "The vehicle needs its frame and arm")
      : told.errors.length ? `${plural(told.errors.length, "error")} in ${desk.name}`
        : `${told.name} compiles: ${plural((isTheirs ? warnings() : records("warning")).length, "warning")}, ${isTheirs && notes().length ? `${plural(notes().length, "note")}, ` : ""}${told.ms} ms`,
    apart() && "the airframe is not the one of files and form",
  ];
  say((isExample ? "Ready. An example is shown: drop your files, or fill in your vehicle. " : "") + parts.filter(Boolean).join("; "),
    Boolean(refused.length || faults.length || told?.errors.length));
}

const records = (severity) => (view.told?.[`${severity}s`] ?? []).map((record) => ({ severity, ...record }));
const notes = () => view.notes.map((note) => ({ severity: "note", ...placed(note) }));
const warnings = () => [...records("warning"), ...view.warnings.map((warning) => ({ severity: "warning", ...placed(warning) }))];
// A note about a row names it as errors do.
function placed(note) {
  const [, before, line, message] = note.message.match(/^(.*?):(\d+): (.*)/s) ?? [];
  const file = view.files.find(({ name }) => before?.endsWith(name));
  return file ? { ...note, file: file.name, line: Number(line), message } : note;
}

// The field of an option of the command line, or none; one of `unit` by what it is the unit of.
const fieldOf = (name, value = "") => {
  const id = name !== "unit" ? name : /^thrust=/.test(value) ? "unit-thrust" : /^(upper|lower|throttle)=/.test(value) ? "unit-throttle" : "";
  return id === "pwm-range" && view.desk && !view.files.length ? "pulses" : FIELDS.includes(id) ? id : "";
};
const shownIn = (id, value) => [...($(id).options ?? [])].find((of) => of.value === value)?.textContent ?? value;
const shortLabel = (id) => labelOf($(id)).replace(/, [^,]*$/, "");
// A sentence of the command line as the page says it: options are fields by their labels, or what stands under other options.
const OPTION = /`?--([a-z][\w-]*)(?:[= ]((?:[a-z_]+=)[^\s;)`]*[^\s,.;)`]|[A-Z][A-Z_]*(?:[,=][A-Z]+)*(?:\.\w+)?(?![a-z])|-?\d[\d.,]*\d|\d))?`?/g;
const plain = (text) => text
  .replace(/`cargo mixer identify` makes \[pair\] of .*|replace \[pair\] by what `cargo mixer identify` .* of a data sheet/, "drop its bench file, or its data sheet")
  .replace(/`?cargo mixer identify`?( again)?( with)?/g, "the page$2").replace(/run identify again with/g, "set")
  .replace(OPTION, (_, name, value = "") => {
    const id = fieldOf(name, value), worth = value.replace(/^.*=/, "");
    if (!id) return `the option \u201c${`${name} ${value}`.trim()}\u201d`;
    return `\u201c${shortLabel(id)}\u201d${/^([A-Z]*$|[A-Z]+[,=.])/.test(worth) ? "" : ` ${shownIn(id, worth)}`}`;
  });

// What mends a fault, by what it names itself: [text of the button, the field, its value, or what is to be done]. One mend has one.
function mendsOf({ key = "", message, help, mends = [], code }, field) {
  const meant = field && `${message}; ${help}`.match(/(?:write (?:\w+ = )?|(?:mm|cm|inches) it is )(\d[\d.]*)(?=[ ,;]|$)/)?.[1];
  if (meant) return [fills(field, meant)];
  const value = help.match(new RegExp(`(?:^|[ .])(${key.split(".").pop()}) = (-?[\\d.]+(?:e-?\\d+)?|"[\\w-]+")(?=[ ,;]|$)`));
  const [own, bare] = [FIELD_OF[key], value?.[2].replace(/^"|"$/g, "")];
  const options = mends.map((line) => {
    const [, name, worth = ""] = line.match(/^--(\S+)(?:[ =](.*))?$/), id = fieldOf(name, worth);
    const typed = worth.replace(/^.*=/, "") || "yes";
    if (id) return state.form[id] !== typed && fills(id, typed);
    return !state.form.options.includes(line) && [`Take the option \u201c${line.slice(2)}\u201d`, () => fillIn("options", `${state.form.options} ${line}`.trim())];
  });
  return [
    ...new Map(options.filter(Boolean).map((mend) => [mend[0], mend])).values(),
    ...(value && own && (own in KEYS || !state.own) ? [fills(own, bare)]
      : value && /^[a-z]+\.[a-z_]+$/.test(key) ? [[`Write ${value[1]} = ${value[2]}`, () => { (state.own ?? state).keys[key] = value[2]; }]] : []),
    ...(code === "MIX323" && view.pair && !state.own ? [fills("voltage-exponent", "1.75")] : []),
    ...(code === "MIX309" ? [["Choose a bench file", () => $("choose").click()]] : []),
  ];
}
// A button that writes a value into a field.
const fills = (id, value) => [`Set ${shortLabel(id)} to ${shownIn(id, value)}`, () => fillIn(id, value)];
// Puts a value into a field, as if it was typed, and shows it.
function fillIn(id, value) {
  put(id, value);
  reveal(id);
}
function put(id, value) {
  const path = KEYS[id];
  if (!path) state.form[id] = value;
  else if (value || state.own) (state.own ?? state).keys[path] = value;
  else delete state.keys[path];
}
// Opens what a field is folded in.
function reveal(id) {
  for (let box = $(id); box; box = box.parentElement) if (box.tagName === "DETAILS") box.open = true;
  $(id).scrollIntoView({ block: "nearest" });
}

// The sentence of a fault, what mends it, and buttons that do.
function sentence({ message, help = "", ...more }, field = "") {
  const needsPair = more.code === "MIX003" && more.key === "pair";
  const said = needsPair ? "The vehicle is read; its pair of rotors is not known yet" : plain(message);
  const mend = needsPair ? "drop the bench file or the data sheet of the pair above" : plain(help);
  return [said, ...(mend ? [element("br"), `Mend: ${mend}`] : []), ...mendsOf({ message, help, ...more }, field).flatMap(([textContent, apply]) => {
    return [" ", button(textContent, () => { apply(); changed(); }, { className: "mend" })];
  })];
}

function faultItem(fault) {
  const { severity, code, file, line, column } = fault;
  const item = element("li", { className: severity }, element("b", { textContent: `${severity[0].toUpperCase()}${severity.slice(1)}: ` }));
  if (code) item.dataset.code = code;
  if (line) {
    const show = () => { state.tab = file === view.desk?.name ? "" : file; renderEditor(); editor.go(line, column ?? 1); };
    item.append(button(`${file}:${line}`, show, { className: "place" }), " ");
  } else if (file) item.append(`${file} `);
  item.append(...sentence(fault));
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
  table.replaceChildren(element("caption", { textContent: above.join(" "), hidden: !above.join("") }), element("tbody", {}, ...rows.map((words) => row(...words))));
}

// Whether the frame is that of a file, and no choice of the form has a part in it.
const isOfFile = () => Boolean(view.told?.verdict) && state.form.frame === fresh().form.frame
  && (state.own ? !view.airframe : view.files.some(({ kind }) => kind === "parameters"));
const rotorsInWords = () => view.told.verdict.match(/^rotors +(.*?)(, arms.*)?$/m)[1];
function renderFields() {
  const { scene } = view.told ?? {};
  const { name } = state.form;
  $("name-made").textContent = name && !view.refusals.name && nameOf(name) !== name ? `in files ${nameOf(name)}` : "";
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
    note?.replaceChildren(...(refusal ? sentence(refusal, id) : []));
    if (refusal) reveal(id);
  }
}

function renderFiles() {
  const item = ({ name, message }, ...parts) => element("li", { className: message ? "error" : "" }, element("b", { textContent: name }), ...parts);
  const act = ({ name }, word, action, more) => button(word, async () => { await action(); changed(); }, { "aria-label": `${word} ${name}`, ...more });
  const without = (files, file) => files.filter((other) => other !== file);
  const throwAway = (file) => { state.aside = without(state.aside, file); };
  $("dropped").replaceChildren(...state.files.map((file) => {
    const kinds = element("select", { "aria-label": `What ${file.name} is` }, ...Object.entries(KINDS).map(([value, textContent]) => element("option", { value, textContent })));
    kinds.value = view.files.find(({ name }) => name === file.name)?.kind ?? file.chosen;
    kinds.onchange = () => { file.chosen = kinds.value; changed(); };
    return item(file, kinds, act(file, "Remove", () => { state.files = without(state.files, file); }));
  }), ...refusedFiles.map((file) => item(file, ` ${file.message} `, act(file, "Dismiss", () => { refusedFiles = without(refusedFiles, file); }))));
  $("aside").replaceChildren(...state.aside.map((file) => item(file, " put aside",
    act(file, "Work on it", () => { throwAway(file); return take(file); }, { className: "back", "aria-label": `Work on ${file.name}` }),
    act(file, "Throw away", () => throwAway(file)))));
  const { files, pair, report: told } = view;
  const bench = files.filter(({ kind }) => ["map", "run", "pair"].includes(kind)).map(({ name, kind, points }) => `${name}: ${KINDS[kind]}${points ? `, ${plural(points, "point")}` : ""}`);
  const [, measured, predicted] = told.match(/^(?:model error\s+(.*?largest torque)|to trust\s+(.*?full scale))/ms)?.map((part) => part?.replace(/\s+/g, " ")) ?? [];
  const trust = measured ? `known within ${measured}` : predicted ? `predicted: ${predicted}` : "known";
  $("read").hidden = !bench.length;
  $("read").textContent = `${bench.join("; ")}. ${pair ? `The pair is ${trust}` : "No pair was made of it yet"}.`;
  const [names] = named(maps());
  if (names.length > 1) $("read").append(` ${names.join(" and ")} are read as benches of one pair. Of two pairs, save the tables of each as front.toml and rear.toml, and drop both.`);
  fill($("pair-report"), told);
  $("pair-report").closest("details").hidden = !told;
}

function renderEditor() {
  const { desk } = view;
  const edited = [...state.files, ...(desk ? [{ name: "", label: desk.name, text: desk.text }] : [])];
  const shown = edited.find(({ name }) => name === state.tab) ?? edited.at(desk ? -1 : 0);
  state.tab = shown?.name ?? "";
  $("tabs").replaceChildren(...edited.map(({ name, label = name }) =>
    button(label, () => { state.tab = name; renderEditor(); }, { "aria-pressed": name === state.tab })));
  editor.text = shown?.text ?? "";
  editor.mark(faults().filter(({ file }) => file === (state.tab || desk?.name)));
}
const faults = () => [...view.faults, ...records("error"), ...warnings()];

const percent = (x) => `${(100 * x).toFixed(0)} %`;
const span = ([least, most]) => (percent(least) === percent(most) ? percent(least) : `${percent(least).slice(0, -2)} to ${percent(most)}`);
// Share of a pack that is used.
const USED = 0.8;
// The numbers that say whether a vehicle flies well, each with what is usual.
function renderNumbers() {
  const numbers = view.told?.numbers;
  const { volts, hover: throttles, usual_hover: usual, over_weight: ratio, yaw_nm: yaw, yaw_over_roll: share, power_w: watts } = numbers ?? {};
  const lack = !numbers ? "no airframe yet" : view.told.scene?.mass_kg === null ? "needs the mass" : throttles.length ? "" : "the weight is not carried";
  const at = volts ? ` at ${volts} V` : "";
  const capacity = Number(state.last.capacity), minutes = 60 * USED * capacity / 1000 * volts / watts;
  const rows = [
    ["Hover throttle", throttles?.map(([layer, ends]) => span(ends) + (throttles.length > 1 ? ` ${layer}` : "")).join(", "),
      usual ? `usual: ${span(usual)}${at}, where these rotors give 30 to 60 % of their largest thrust` : "usual: 30 to 60 % of the largest thrust"],
    ["Thrust over weight", ratio && ratio.toFixed(2), `usual: 1.7 to 3.3${at}`],
    ["Yaw left in hover", yaw && `${short(yaw)} N m${share ? `, ${percent(share)} of the roll` : ""}`, "usual: 2 to 10 % of the roll"],
    ["Time in hover", minutes > 0 && Number.isFinite(minutes) ? `${Number(minutes.toPrecision(2))} min` : lack || "not known",
      watts && volts ? capacity ? `${percent(USED)} of ${capacity} mAh${at}, ${Number(watts.toPrecision(3))} W` : "needs the capacity of the pack" : "needs a bench file with the power, or current and voltage"],
  ];
  $("numbers").replaceChildren(...rows.map(([name, value, hint]) => element("div", {}, element("dt", { textContent: name }),
    element("dd", {}, element("b", { textContent: value || lack }), element("small", { textContent: hint })))));
}

function render() {
  const { desk, told, command, commands, isTheirs, isExample, keys } = view;
  const compiles = Boolean(told?.verdict), reason = apart();
  renderFields();
  renderFiles();
  renderNumbers();
  renderEditor();
  $("faults").replaceChildren(...faults().map(faultItem));
  $("notes").replaceChildren(...notes().map(faultItem));
  $("noted").hidden = !notes().length;
  $("noted").firstElementChild.textContent = plural(notes().length, "note");
  fill($("verdict"), compiles ? told.verdict : "");
  $("hand").hidden = !compiles;
  const stack = $("stack").selectedOptions[0].textContent;
  for (const part of document.querySelectorAll(".counted")) part.textContent = isByOutput() ? "Outputs as code and airframe file count them, from 0." : `Motors as ${stack} counts them: motor 1 is output 0 of code and airframe file.`;
  $("counted").textContent = isByOutput() ? "output" : "motor";
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
    const [table, key] = path.split(".");
    return `${key} = ${valueOf(path, value)} in [${table}]`;
  });
  const shown = commands.length && (isTheirs || !desk) ? commands.join(" && ") + (set.length ? `  # then ${set.join(", ")}` : "") : "";
  $("made-by").hidden = !shown;
  $("command").textContent = shown;
  $("command-name").textContent = command;
  $("help").textContent = view.help;
  $("nothing").textContent = compiles ? "Files in the order of their use." : desk ? `${desk.name} does not compile: only the file itself can be saved.` : "There is no airframe yet.";
  arrange();
  keep();
  sum();
}

// --- files to take along

// Each output has one entry, which moves between the two lists: its link holds the file once it is made.
const entries = Object.fromEntries(Object.entries(OUTPUTS).map(([what, [name, where]]) => {
  const save = element("a", { className: "save", textContent: name, "data-output": what }), notes = element("ul", { className: "list" });
  return [what, { item: element("li", {}, save, element("span", { textContent: ` ${where}` }), notes), save, notes }];
}));
// Files that are there before they are asked for.
const there = () => ({ airframe: view.desk, pair: view.pair, sheet: view.files.find(({ name }) => name === SHEET_NAME) });
function arrange() {
  const first = ofStack(state.form.stack), files = there();
  const has = (what) => (what in files ? files[what] : view.told?.verdict);
  const place = (list, all) => list.replaceChildren(...all.filter(has).map((what) => entries[what].item));
  place($("files"), first);
  place($("others"), Object.keys(OUTPUTS).filter((what) => !first.includes(what)));
}
const shownOutputs = () => [...document.querySelectorAll(`#files a.save${$("more").open ? ", #others a.save" : ""}`)].map((save) => save.dataset.output);

// Takes the files back that are not of what was put in.
function withdraw() {
  for (const { save, notes } of Object.values(entries)) {
    URL.revokeObjectURL(save.href);
    save.removeAttribute("href");
    notes.replaceChildren();
  }
}

async function made(what) {
  if (what in there()) return there()[what];
  if (what === "report") return { name: `${view.told.name}.html`, text: await ask("page", ...named(maps())) };
  return ask("output", what, state.last.pulses);
}
// Makes a file, so that its link needs nothing more than a click: a browser drops what a page saves long after one.
async function prepare(what) {
  const entry = entries[what];
  if (entry.save.href) return;
  const note = (className, textContent) => element("li", { className, textContent });
  try {
    const { name, text, notes = [] } = await made(what);
    if (stale) return;
    const href = URL.createObjectURL(new Blob([text], { type: "application/octet-stream" }));
    Object.assign(entry.save, { href, download: name });
    entry.notes.replaceChildren(...notes.map((text) => note("note", plain(text))));
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    entry.notes.replaceChildren(note("error", plain(error.message)));
  }
}

// --- events

$("choose").onchange = async () => { await drop([...$("choose").files]); $("choose").value = ""; };
for (const kind of ["dragover", "dragleave", "drop"]) {
  addEventListener(kind, (event) => {
    event.preventDefault();
    $("drop").classList.toggle("over", kind === "dragover");
    if (kind === "drop") drop([...event.dataTransfer.files]);
  });
}
for (const id of [...FIELDS, ...Object.keys(KEYS)]) {
  $(id).oninput = () => {
    put(id, $(id).value.trim());
    refusedFiles = [];
    const isBlamed = id === blamed || view?.told?.verdict && !isRefused();
    measure();
    changed({ wait: 250, field: isBlamed ? id : "" });
  };
}
// A row of a table that is pasted into the data sheet goes over its fields.
$("rows").onpaste = (event) => {
  const cells = event.clipboardData.getData("text").trim().split(/[\t\n;]+/), at = THRUSTS.indexOf(event.target.id);
  if (cells.length < 2) return;
  event.preventDefault();
  cells.slice(0, THRUSTS.length - at).forEach((cell, k) => { state.form[THRUSTS[at + k]] = cell.trim(); });
  event.target.blur();
  changed();
};
$("example-sheet").onclick = () => {
  add({ name: "rotor.csv", text: $("sample-sheet").textContent });
  Object.assign(state.form, { diameter: "0.305", spacing: "0.08", arm: state.form.arm || "0.4" });
  changed();
};
$("replace").onclick = () => { putAside(state.own); state.own = null; document.activeElement?.blur(); changed(); };
$("more").ontoggle = () => { if ($("more").open && view) changed(); };
$("share").onclick = async () => {
  if (!view?.desk) return;
  const text = await link(view.desk);
  $("link").value = text;
  $("linked").hidden = false;
  $("link").select();
  await navigator.clipboard?.writeText(text).catch(() => {});
};
$("stop").onclick = stop;
$("forget").onclick = () => {
  // What was forgotten, until the page is left: the state and the ticks.
  const forgotten = state;
  let ticks = {};
  $("unforget").hidden = false;
  $("unforget").onclick = () => {
    try {
      Object.assign(localStorage, ticks);
    } catch {}
    $("unforget").hidden = true;
    restart(forgotten);
  };
  try {
    ticks = { ...localStorage };
    for (const key of Object.keys(localStorage)) if (key === KEY || key.startsWith("checks of ")) localStorage.removeItem(key);
  } catch {
    // Where the browser keeps nothing there is nothing to forget.
  }
  $("linked").hidden = true;
  $("link").value = "";
  document.activeElement?.blur();
  restart(fresh());
};

begin();
try {
  sketch();
} catch {
  // What another version kept.
  state.drawn = null;
  sketch();
}
(async () => {
  await loaded;
  await linked();
  removeEventListener("error", early);
  removeEventListener("unhandledrejection", early);
  changed();
  if (location.protocol.startsWith("http")) navigator.serviceWorker?.register("sw.js").catch(() => {});
})();
