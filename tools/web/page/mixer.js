// The mixer under sliders: draws what Desk.scene and Desk.mix answer.
"use strict";
const AXES = [["roll", "N m"], ["pitch", "N m"], ["yaw", "N m"], ["thrust", "N"]];
const SATURATED = { "+": "less", "-": "more" };

function drawn(name, attributes = {}, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}

const short = (x, least = 1e-9) => (Math.abs(x) < least ? "0" : String(rounded(x)));
const ofThrottle = (x) => (x === 0 ? "0" : x.toFixed(3));
const rounded = (x) => Number(x.toPrecision(4));
const clamped = (x, low, high) => Math.min(high, Math.max(low, x));
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
const isByOutput = () => $("stack").value === "own";
const motor = (channel) => (isByOutput() ? channel : channel + 1);

const farthest = (units) => Math.max(...units.map(({ place_m }) => Math.hypot(...place_m)));

// The frame seen from above, with a ring for every rotor as long as its throttle.
class FromAbove {
  constructor(svg) {
    this.svg = svg;
  }

  // What does not move: `units` are those of Desk.scene.
  // A known diameter (m) is drawn to scale.
  frame(units, diameter) {
    const { svg } = this;
    const far = farthest(units) || 1e-9;
    const place = ({ place_m: [x, y] }) => [150 + 98 * y / far, 150 - 98 * x / far];
    const apart = units.flatMap((a, k) => units.slice(k + 1).map((b) => Math.hypot(place(a)[0] - place(b)[0], place(a)[1] - place(b)[1])));
    const radius = Math.min(52, 0.46 * Math.min(...apart, 300));
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

  // Throttles by output, none where they are not known; those of `failed` are out.
  turn(throttles = this.rings.map(() => null), failed = []) {
    throttles.forEach((throttle, channel) => {
      const { ring, text, spin } = this.rings[channel], out = failed.includes(channel);
      ring.classList.toggle("out", out);
      ring.setAttribute("stroke-dasharray", `${throttle ?? 0} 1`);
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
    Object.assign(this, { ask, moved, busy: false, stale: false, frames: 0, top: new FromAbove($("top")) });
    $("hover").onclick = () => this.put({ wrench: [0, 0, 0, this.scene.hover_n] });
  }

  // The airframe of a name; `at` is the position { name, wrench, volts, density, failed } of the one before, or null. One of
  // another name begins in hover.
  show(scene, name, before) {
    const at = before?.name === name ? before : {};
    const [hover_n, largest] = [rounded(scene.hover_n), scene.largest.map(rounded)];
    this.scene = { ...scene, hover_n, largest, least: largest.map((most, k) => (k === 3 ? 0 : -most)) };
    const { least, volts, density, units } = this.scene;
    const within = (x, ends) => (ends ? clamped(x ?? ends[1], ends[0], ends[2]) : 0);
    this.at = {
      name,
      wrench: (at.wrench ?? [0, 0, 0, hover_n]).map((x, k) => clamped(x, least[k], largest[k])),
      volts: within(at.volts, volts),
      density: within(at.density, density),
      failed: (at.failed ?? []).filter((channel) => units.some(({ channels }) => channels.includes(channel))),
    };
    $("rings").hidden = units.every(({ channels }) => channels.length === 1);
    this.sliders();
    this.rotors();
    this.frame();
    this.put({});
  }

  sliders() {
    const { least, largest, volts, density } = this.scene;
    const one = (id, label, low, high, get, put) => {
      const step = 10 ** Math.floor(Math.log10((high - low) / 400));
      const move = (x) => put(clamped(Number(x.toPrecision(12)), low, high));
      const range = element("input", { type: "range", id, min: low, max: high, step: "any" });
      const field = element("input", { inputMode: "decimal", id: `${id}-number`, "aria-label": label });
      range.oninput = () => move(Math.round(range.value / step) * step);
      range.onkeydown = (event) => {
        const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -20, PageUp: 20 }[event.key];
        if (!by) return;
        event.preventDefault();
        move(get() + by * step);
      };
      // What is no number is said at the flags.
      field.onchange = () => {
        try {
          if (field.value.trim()) put(Number(number(label, field.value)));
        } catch ({ message }) {
          say(message, true, $("flags"));
        }
      };
      this.shown.push(() => { range.value = get(); if (document.activeElement !== field) field.value = get(); });
      return element("label", {}, element("span", { textContent: label }), range, field);
    };
    this.shown = [];
    const axis = ([name, unit], k) => one(name, `${name}, ${unit}`, least[k], largest[k],
      () => this.at.wrench[k], (x) => this.put({ wrench: this.at.wrench.map((of, axis) => (axis === k ? x : of)) }));
    const condition = (key, label, ends) => one(key, label, ends[0], ends[2], () => this.at[key], (x) => this.put({ [key]: x }));
    $("sliders").replaceChildren(...[...AXES.map((name, k) => largest[k] > 0 && axis(name, k)),
      volts && condition("volts", "voltage, V", volts), density && condition("density", "density, kg/m\u00b3", density)].filter(Boolean));
  }

  rotors() {
    // Every rotor as { channel, layer (0 upper, 1 lower), unit }, by output.
    const rotors = this.scene.units.flatMap((unit) => unit.channels.map((channel, layer) => ({ channel, layer, unit })));
    rotors.sort((a, b) => a.channel - b.channel);
    const arrow = ({ channels }, layer) => (channels.length > 1 ? `${"\u2191\u2193"[layer]} ` : "");
    const word = isByOutput() ? "output" : "motor";
    const label = ({ channel, layer, unit }) => `${word} ${motor(channel)} ${arrow(unit, layer)}${unit.place}`;
    $("rotors").replaceChildren(...rotors.map((rotor) => {
      const { channel } = rotor;
      const out = button(label(rotor), () => {
        const { failed } = this.at;
        this.put({ failed: failed.includes(channel) ? failed.filter((other) => other !== channel) : [...failed, channel] });
      }, { "data-output": channel });
      this.shown.push(() => out.setAttribute("aria-pressed", this.at.failed.includes(channel)));
      return out;
    }));
    document.querySelector("#throttles tbody").replaceChildren(...rotors.map((rotor) => row(label(rotor), "", "")));
    document.querySelector("#wrench tbody").replaceChildren(...AXES.map(([name, unit]) => row(`${name}, ${unit}`, "", "", "")));
  }

  // What does not move: the frame from above and the axes of the attainable set.
  frame() {
    const { units, box_n_nm: [[low_n, high_n], [low_nm, high_nm]] } = this.scene;
    this.top.frame(units);
    this.toX = (n) => 56 + 250 * (n - low_n) / (high_n - low_n || 1);
    this.toY = (nm) => 190 - 176 * (nm - low_nm) / (high_nm - low_nm || 1);
    this.border = drawn("path", { class: "fill-1 border" });
    const dots = (kind) => units.map(() => drawn("circle", { class: kind, r: 5 }));
    this.dots = [dots("unit-dot"), dots("unit-hollow")];
    $("set").replaceChildren(this.border, drawn("path", { class: "frame", d: "M56 14V190H306" }),
      drawn("path", { class: "grid", d: `M56 ${this.toY(0)}H306` }),
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
        say(error.message, true, $("flags"));
      }
    }
    this.busy = false;
  }

  draw({ throttles, achieved, saturation: [bits, words], factors: [byThrust, byTorque], efforts, isolated }) {
    this.frames += 1;
    const told = words.split(" ").map((word) => {
      const given = SATURATED[word.at(-1)];
      return given ? `${given} ${word.slice(0, -1)} than asked` : `${word} outside its range and clamped`;
    });
    say(bits === 0 ? "Delivered in full" : told.join(", "), bits !== 0, $("flags"));
    $("flags").dataset.bits = bits;
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
