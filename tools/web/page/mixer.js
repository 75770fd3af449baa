// The mixer under sliders: draws what Desk.scene and Desk.mix answer.
"use strict";
const AXES = [["roll", "N m"], ["pitch", "N m"], ["yaw", "N m"], ["thrust", "N"]];
const SATURATED = { "+": (axis) => `less ${axis} than asked`, "-": (axis) => `more ${axis} than asked` };

function drawn(name, attributes = {}, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}

const short = (x, least = 1e-9) => (Math.abs(x) < least ? "0" : Number(x.toPrecision(4)).toString());
const ofThrottle = (x) => (x === 0 ? "0" : x.toFixed(3));
// What people write behind a number, in the units that the labels of fields have.
const UNITS = {
  m: { m: 1, cm: 0.01, mm: 0.001, in: 0.0254, inch: 0.0254, '"': 0.0254 }, kg: { kg: 1, g: 0.001, lb: 0.45359237, oz: 0.028349523125 },
  V: { V: 1, mV: 0.001 }, "cells in series": { S: 1, s: 1, cells: 1 }, mAh: { mAh: 1, Ah: 1000 }, N: { N: 1 }, g: { g: 1, gf: 1, kg: 1000, N: 1000 / 9.80665, lb: 453.59237, oz: 28.349523125 }, "N m": { "N m": 1, Nm: 1 }, "N m/N": { "N m/N": 1, "Nm/N": 1, m: 1 },
  "kg/m\u00b3": { "kg/m\u00b3": 1, "kg/m3": 1 },
};

// The number that was typed into a field with a label as `Arm, m`: `4,5`, `1 200` and `450 mm` are read. Of `1,500` nobody knows
// which it is.
function number(label, typed) {
  const [, name, unit] = label.match(/^(.*), (.*)$/);
  const [, digits, behind] = typed.trim().replace(/(?<=\d)[\s\u00a0\u202f](?=\d{3}(?!\d))/g, "").match(/^([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:e[+-]?\d+)?)\s*(.*)$/i) ?? [];
  const by = behind ? UNITS[unit]?.[behind] : 1;
  if (digits === undefined || by === undefined) throw new Refused(`${name}: ${typed} is no number in ${unit}, as 4.5 or 4,5 is`);
  if (/^[+-]?[1-9]\d{0,2},\d{3}$/.test(digits)) throw new Refused(`${name}: ${typed} may mean two numbers; write ${digits.replace(",", ".")} or ${digits.replace(",", "")}`);
  const plain = digits.replace(",", ".");
  return by === 1 && /^-?\d+(\.\d+)?$/.test(plain) ? plain : String(Number((plain * by).toPrecision(12)));
}
const labelOf = (field) => field.labels[0].firstChild.textContent.trim();

// The number of a rotor as the chosen stack counts its motors, from 1; code and airframe file count outputs from 0.
const isByOutput = () => document.getElementById("stack").value === "own";
const motor = (channel) => (isByOutput() ? channel : channel + 1);

// The frame seen from above, with a ring for every rotor as long as its throttle.
class FromAbove {
  constructor(svg) {
    this.svg = svg;
  }

  // What does not move: `units` are those of Desk.scene.
  // A known diameter (m) is drawn to scale.
  frame(units, diameter) {
    const { svg } = this;
    const far = Math.max(1e-9, ...units.map(({ place_m }) => Math.hypot(...place_m)));
    const place = ({ place_m: [x, y] }) => [150 + 98 * y / far, 150 - 98 * x / far];
    const apart = units.flatMap((a, k) => units.slice(k + 1).map((b) => Math.hypot(place(a)[0] - place(b)[0], place(a)[1] - place(b)[1])));
    const radius = Math.min(52, 0.46 * Math.min(...apart, 300));
    svg.setAttribute("viewBox", "0 0 300 300");
    svg.replaceChildren(...units.map((unit) => drawn("path", { class: "arm", d: `M150 150L${place(unit)}` })),
      drawn("path", { class: "forward", d: "M150 128v-26m-7 9l7 -9l7 9" }));
    this.rings = [];
    for (const unit of units) {
      const [x, y] = place(unit), size = Math.min(13, radius / (units.length > 4 ? 4.4 : 3.6));
      svg.append(drawn("circle", { class: "disk", cx: x, cy: y, r: diameter ? Math.min(70, 49 * diameter / far) : radius }));
      unit.channels.forEach((channel, layer) => {
        const at = { cx: x, cy: y, r: radius - 16 + 10 * layer, pathLength: 1 };
        const clockwise = (unit.upper_spin === "cw") === (layer === 0);
        const turn = `rotate(-90 ${x} ${y})${clockwise ? "" : ` matrix(1 0 0 -1 0 ${2 * y})`}`;
        const ring = drawn("circle", { ...at, class: layer ? "ring lower" : "ring", transform: turn });
        const text = drawn("text", { class: "middle", x, y: y + (layer ? 1.2 : -0.3) * size, "font-size": size });
        svg.append(drawn("circle", { ...at, class: "track" }), ring, text);
        this.rings[channel] = { ring, text, spin: clockwise ? "\u21bb" : "\u21ba" };
      });
    }
  }

  // Throttles by output; those of `failed` are out.
  turn(throttles, failed) {
    throttles.forEach((throttle, channel) => {
      const { ring, text, spin } = this.rings[channel], out = failed.includes(channel);
      ring.classList.toggle("out", out);
      ring.setAttribute("stroke-dasharray", out ? ".02 .02" : `${throttle ?? 0} 1`);
      text.textContent = out ? `${motor(channel)} out` : `${motor(channel)}${spin} ${throttle === null ? "" : Math.round(100 * throttle)}`;
    });
  }
}

// A pair seen from the side, with what "Arm", "Diameter" and "Spacing" are: to scale as far as they are known, in m.
function drawSide(svg, { arm, diameter, spacing }) {
  const scale = Math.min(130 / (arm || 0.45), 120 / (diameter || 0.3)), [x, y] = [30 + scale * (arm || 0.45), 72];
  const half = scale * (diameter || 0.3) / 2, high = Math.max(14, Math.min(44, scale * (spacing || 0.08)));
  const line = (kind, d, known = true) => drawn("path", { class: known ? kind : `${kind} unsaid`, d });
  const text = (x, y, kind, word, value) => drawn("text", { class: kind, x, y, "font-size": 12 }, value ? `${word} ${short(value)} m` : word);
  svg.replaceChildren(line("arm", `M30 ${y}H${x}V${y - high}`), drawn("circle", { class: "disk", cx: 30, cy: y, r: 9 }),
    line("rotor", `M${x - half} ${y - high}h${2 * half}`, diameter), line("rotor lower", `M${x - half} ${y}h${2 * half}`, diameter),
    line("measure", `M30 ${y + 18}v8m0 -4H${x}m0 -4v8`), text((30 + x) / 2, y + 40, "middle", "Arm", arm),
    line("measure", `M${x - half} ${y - high - 14}v8m0 -4h${2 * half}m0 -4v8`), text(x, y - high - 18, "middle", "Diameter", diameter),
    line("measure", `M${x + half + 6} ${y - high}h8m-4 0v${high}m-4 0h8`), text(Math.min(x + half + 18, 222), y + 14, "", "Spacing", spacing));
}

class Hand {
  // `moved` is told of every new position.
  constructor(ask, moved) {
    Object.assign(this, { ask, moved, busy: false, stale: false, frames: 0, top: new FromAbove(document.getElementById("top")) });
    document.getElementById("hover").addEventListener("click", () => this.put({ wrench: [0, 0, 0, this.scene.hover_n] }));
  }

  // Uses the number that was typed into a field; what is none is said at the flags.
  typed(label, text, use) {
    try {
      if (text.trim()) use(number(label, text));
    } catch ({ message }) {
      this.flag(message, true);
    }
  }

  // The airframe of a name; `at` is the position { name, wrench, volts, density, failed } of the one before, or null. One of
  // another name begins in hover.
  show(scene, name, before) {
    const at = before?.name === name ? before : null;
    this.scene = { ...scene, hover_n: Number(scene.hover_n.toPrecision(4)) };
    this.scene.largest = this.scene.largest.map((x) => Number(x.toPrecision(4)));
    const { largest, hover_n, volts, density, units } = this.scene;
    const within = (x, ends) => (ends ? Math.min(ends[2], Math.max(ends[0], x ?? ends[1])) : 0);
    const limit = (x, k) => (k === 3 ? Math.min(largest[3], Math.max(0, x)) : Math.min(largest[k], Math.max(-largest[k], x)));
    this.at = {
      name,
      wrench: (at?.wrench ?? [0, 0, 0, hover_n]).map(limit),
      volts: within(at?.volts, volts),
      density: within(at?.density, density),
      failed: (at?.failed ?? []).filter((channel) => units.some(({ channels }) => channels.includes(channel))),
    };
    document.getElementById("rings").hidden = units.every(({ channels }) => channels.length === 1);
    this.sliders();
    this.rotors();
    this.frame();
    this.put({});
  }

  sliders() {
    const { largest, volts, density } = this.scene;
    const one = (id, label, low, high, get, put) => {
      const step = 10 ** Math.floor(Math.log10((high - low) / 400));
      const range = element("input", { type: "range", id, min: low, max: high, step: "any", value: get() });
      const field = element("input", { inputMode: "decimal", id: `${id}-number`, value: get(), "aria-label": label });
      range.addEventListener("input", () => put(Math.min(high, Math.max(low, Number((Math.round(range.value / step) * step).toPrecision(12))))));
      field.addEventListener("change", () => this.typed(label, field.value, (value) => put(Number(value))));
      range.addEventListener("keydown", (event) => {
        const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -20, PageUp: 20 }[event.key];
        if (!by) return;
        event.preventDefault();
        put(Math.min(high, Math.max(low, Number((get() + by * step).toPrecision(12)))));
      });
      this.shown.push(() => { range.value = get(); if (document.activeElement !== field) field.value = get(); });
      return element("label", {}, element("span", { textContent: label }), range, field);
    };
    this.shown = [];
    const axis = ([name, unit], k) => one(name, `${name}, ${unit}`, k === 3 ? 0 : -largest[k], largest[k],
      () => this.at.wrench[k], (x) => this.put({ wrench: this.at.wrench.map((of, axis) => (axis === k ? x : of)) }));
    const condition = (key, label, ends) => one(key, label, ends[0], ends[2], () => this.at[key], (x) => this.put({ [key]: x }));
    document.getElementById("sliders").replaceChildren(
      ...AXES.map((name, k) => largest[k] > 0 && axis(name, k)).filter(Boolean),
      ...[volts && condition("volts", "voltage, V", volts), density && condition("density", "density, kg/m\u00b3", density)].filter(Boolean));
  }

  // Every rotor as { channel, layer (0 upper, 1 lower), unit }, by output.
  all() {
    const rotors = this.scene.units.flatMap((unit) => unit.channels.map((channel, layer) => ({ channel, layer, unit })));
    return rotors.sort((a, b) => a.channel - b.channel);
  }

  rotors() {
    const arrow = ({ channels }, layer) => (channels.length > 1 ? `${"\u2191\u2193"[layer]} ` : "");
    const word = isByOutput() ? "output" : "motor";
    const label = ({ channel, layer, unit }) => `${word} ${motor(channel)} ${arrow(unit, layer)}${unit.place}`;
    document.getElementById("rotors").replaceChildren(...this.all().map((rotor) => {
      const button = element("button", { type: "button", textContent: label(rotor) });
      button.dataset.output = rotor.channel;
      button.addEventListener("click", () => {
        const { failed } = this.at, { channel } = rotor;
        this.put({ failed: failed.includes(channel) ? failed.filter((other) => other !== channel) : [...failed, channel] });
      });
      this.shown.push(() => button.setAttribute("aria-pressed", this.at.failed.includes(rotor.channel)));
      return button;
    }));
    const row = (head, cells) => element("tr", {}, element("th", { scope: "row", textContent: head }), ...cells.map(() => element("td")));
    document.querySelector("#throttles tbody").replaceChildren(...this.all().map((rotor) => row(label(rotor), [0, 1])));
    document.querySelector("#wrench tbody").replaceChildren(...AXES.map(([name, unit]) => row(`${name}, ${unit}`, [0, 1, 2])));
  }

  // What does not move: the frame from above and the axes of the attainable set.
  frame() {
    const { units, box_n_nm: [[low_n, high_n], [low_nm, high_nm]] } = this.scene, set = document.getElementById("set");
    this.top.frame(units);
    set.setAttribute("viewBox", "0 0 320 230");
    this.toX = (n) => 56 + 250 * (n - low_n) / (high_n - low_n || 1);
    this.toY = (nm) => 190 - 176 * (nm - low_nm) / (high_nm - low_nm || 1);
    const [left, right, bottom, above] = [56, 306, 190, 14];
    this.border = drawn("path", { class: "fill-1 border" });
    const dots = (kind) => units.map(() => drawn("circle", { class: kind, r: 5 }));
    this.dots = [dots("unit-dot"), dots("unit-hollow")];
    set.replaceChildren(this.border, drawn("path", { class: "frame", d: `M${left} ${above}V${bottom}H${right}` }),
      drawn("path", { class: "grid", d: `M${left} ${this.toY(0)}H${right}` }),
      ...[low_n, high_n].map((n, k) => drawn("text", { class: k ? "tick end" : "tick middle", x: this.toX(n), y: 206 }, short(n))),
      ...[low_nm, 0, high_nm].map((nm) => drawn("text", { class: "tick end", x: 50, y: this.toY(nm) + 4 }, short(nm))),
      drawn("text", { class: "middle", x: 181, y: 222 }, "thrust, N"), drawn("text", { x: 60, y: 24 }, "torque, N m"),
      ...this.dots.flat());
  }

  // A new position: at most one mix is under way, and the newest waits.
  put(change) {
    Object.assign(this.at, change);
    this.moved(this.at);
    for (const show of this.shown) show();
    this.stale = true;
    if (!this.busy) this.run();
  }

  async run() {
    this.busy = true;
    while (this.stale) {
      this.stale = false;
      const { wrench, volts, density, failed } = this.at;
      try {
        const mixed = await this.ask("mix", wrench, volts, density, failed);
        await new Promise(requestAnimationFrame);
        this.draw(mixed);
      } catch (error) {
        this.flag(String(error.message), true);
      }
    }
    this.busy = false;
  }

  flag(text, wrong) {
    const flags = document.getElementById("flags");
    flags.textContent = text;
    flags.classList.toggle("error", wrong);
  }

  draw({ throttles, achieved, saturation: [bits, words], factors: [byThrust, byTorque], efforts, isolated }) {
    this.frames += 1;
    const told = words.split(" ").map((word) => SATURATED[word.at(-1)]?.(word.slice(0, -1)) ?? `${word} outside its range and clamped`);
    this.flag(bits === 0 ? "Delivered in full" : told.join(", "), bits !== 0);
    document.getElementById("flags").dataset.bits = bits;
    const fill = (table, rows) => document.querySelectorAll(`#${table} tbody tr`).forEach((row, k) =>
      // All the digits that the command line prints are there for who looks.
      row.querySelectorAll("td").forEach((cell, column) => { [cell.textContent, cell.dataset.exact] = rows[k][column]; }));
    fill("throttles", throttles.map((throttle, channel) => [throttle, isolated.throttles[channel]].map((x) => [ofThrottle(x), x])));
    fill("wrench", AXES.map((_, k) => [this.at.wrench[k], achieved[k], isolated.given[k]].map((x) => [short(x, 1e-4 * this.scene.largest[k]), x])));
    this.top.turn(throttles, this.at.failed);
    const corner = ([n, nm]) => `${this.toX(byThrust * n).toFixed(1)} ${this.toY(byTorque * nm).toFixed(1)}`;
    this.border.setAttribute("d", this.scene.borders.map((border) => `M${border.map(corner).join("L")}Z`).join(""));
    [efforts, isolated.efforts].forEach((of, kind) => of.forEach(([n, nm], unit) => {
      this.dots[kind][unit].setAttribute("cx", this.toX(n));
      this.dots[kind][unit].setAttribute("cy", this.toY(nm));
    }));
  }
}
