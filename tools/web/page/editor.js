// An editor of one text with marks at its lines: a text area as large as its text, on which the marks lie, in a box that
// scrolls both.
"use strict";
function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  // Names with a hyphen are attributes: browsers of 2023 have no properties for those of ARIA.
  for (const [key, value] of Object.entries(properties)) key.includes("-") ? made.setAttribute(key, value) : made[key] = value;
  made.append(...children);
  return made;
}
const button = (textContent, onclick, properties) => element("button", { type: "button", textContent, onclick, ...properties });
const row = (head, ...texts) => element("tr", {}, element("th", { scope: "row", textContent: head }), ...texts.map((textContent) => element("td", { textContent })));

class Editor {
  constructor(box, changed) {
    this.box = box;
    this.gutter = element("pre", { className: "gutter", "aria-hidden": "true" });
    this.area = element("textarea", { spellcheck: false, autocapitalize: "off", autocomplete: "off", wrap: "off", "aria-label": "Text of the file", "aria-describedby": "faults" });
    this.layer = element("div", { className: "marks", "aria-hidden": "true" });
    box.append(this.gutter, element("div", { className: "sheet" }, this.area, this.layer));
    this.area.addEventListener("input", () => { this.measure(); changed(this.area.value); });
  }

  set text(text) {
    if (text === this.area.value) return;
    this.area.value = text;
    this.measure();
  }

  measure() {
    const lines = this.area.value.split("\n");
    this.area.rows = lines.length;
    this.area.cols = lines.reduce((longest, line) => Math.max(longest, line.length), 40) + 2;
    this.gutter.textContent = lines.map((_, k) => k + 1).join("\n");
    this.layer.replaceChildren();
  }

  // Marks are { line, column, severity, message }; line and column from 1.
  mark(marks) {
    const lines = this.area.value.split("\n");
    const byLine = new Map();
    for (const mark of marks) if (mark.line && mark.line <= lines.length) byLine.set(mark.line, [...byLine.get(mark.line) ?? [], mark]);
    this.layer.replaceChildren(...[...byLine].flatMap(([line, marks]) => {
      const [{ severity, column }] = marks, text = lines[line - 1], from = (column ?? 1) - 1;
      const word = column ? text.slice(from).match(/^\S*/)[0].length : text.length;
      const under = element("i", { className: severity });
      const note = element("span", { className: severity, textContent: marks.map(({ message }) => message).join("; ") });
      for (const [part, left] of [[under, from], [note, text.length + 2]]) {
        part.style.top = `calc(${line - 1} * var(--line))`;
        part.style.left = `${left}ch`;
      }
      under.style.width = `${Math.max(1, word)}ch`;
      return [under, note];
    }));
  }

  // Puts the cursor at a line and shows it.
  go(line, column = 1) {
    const before = this.area.value.split("\n").slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0);
    this.area.focus({ preventScroll: true });
    this.area.setSelectionRange(before + column - 1, before + column - 1);
    this.box.scrollTo({ top: Math.max(0, (line - 4) * this.area.clientHeight / this.area.rows), left: 0 });
    this.box.scrollIntoView({ block: "nearest" });
  }
}
