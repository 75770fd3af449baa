// A report in an element: values at the pointer, the finger and the cursor keys, and a check list
// that is kept. It is complete without this.
function report(root, model) {
  "use strict";
  const [low, high] = model.throttle;

  const digits = (x, n) => (x === 0 ? "0" : Number(x.toPrecision(n)).toString()).replace("-", "\u2212");
  const fixed = (x, n) => x.toFixed(n).replace(/^-(?=0\.?0*$)/, "").replace("-", "\u2212");
  const plane = ([f, q]) => [fixed(f, 3), fixed(q, 4)];

  // What is read of a pair: its texts by kind of picture.
  const pairs = model.pairs.map(({ terms, scale, errors }) => {
    // The pair's forward map and its Jacobian, in double precision.
    function efforts(u, l) {
      let f = 0, q = 0, fu = 0, fl = 0, qu = 0, ql = 0;
      for (const [i, j, a, b] of terms) {
        const m = Math.pow(u, i) * Math.pow(l, j);
        const mu = i ? i * Math.pow(u, i - 1) * Math.pow(l, j) : 0;
        const ml = j ? j * Math.pow(u, i) * Math.pow(l, j - 1) : 0;
        f += a * m; q += b * m; fu += a * mu; fl += a * ml; qu += b * mu; ql += b * ml;
      }
      return { f, q, fu, fl, qu, ql };
    }

    // Throttles for (f, Q) by Newton's method within the box; null outside the attainable set.
    function invert(f, q) {
      const clamp = (x) => Math.min(high, Math.max(low, x));
      let u = 0.5 * (low + high), l = u;
      for (let step = 0; step < 60; step += 1) {
        const e = efforts(u, l), det = e.fu * e.ql - e.fl * e.qu;
        const df = f - e.f, dq = q - e.q;
        if (Math.abs(df) < 1e-9 * scale[0] && Math.abs(dq) < 1e-9 * scale[1]) return [u, l];
        u = clamp(u + (df * e.ql - dq * e.fl) / det);
        l = clamp(l + (dq * e.fu - df * e.qu) / det);
      }
      return null;
    }

    // The value of a grid of thousandths of its largest value at the node next to (u, l).
    function nearest(grid, u, l) {
      const node = (x) => Math.round((x - low) / (high - low) * (grid.side - 1));
      return grid.thousandths[node(l) * grid.side + node(u)] * grid.largest / 1000;
    }

    // Texts of the read-out at a place of a picture; what is missing is not attainable.
    const kinds = {
      plane,
      forward([u, l]) {
        const throttles = [fixed(u, 3), fixed(l, 3)];
        if (u < low || u > high || l < low || l > high) return throttles;
        const e = efforts(u, l);
        return [...throttles, fixed(e.f, 3), fixed(e.q, 4)];
      },
      inverse([f, q]) {
        const found = invert(f, q) || [];
        return [...plane([f, q]), ...found.map((throttle) => fixed(throttle, 4))];
      },
      "error-thrust": (at) => error(at, errors[0]),
      "error-torque": (at) => error(at, errors[1]),
    };
    function error(at, grid) {
      const found = invert(...at);
      return [...plane(at), ...(found ? [digits(nearest(grid, ...found), 2)] : [])];
    }
    return kinds;
  });

  const clamp = (x, from, to) => Math.min(to, Math.max(from, x));
  const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  const ring = ([x, y]) => `M${x - 4} ${y}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0`;

  for (const svg of root.querySelectorAll("svg[data-hover]")) {
    const kind = svg.dataset.hover;
    const outputs = [...svg.parentNode.querySelectorAll("output")];
    const [left, top, width, height] = svg.dataset.box.split(" ").map(Number);
    const [rangeX, rangeY] = [svg.dataset.x, svg.dataset.y].map((range) => range.split(" ").map(Number));
    const toX = (px) => rangeX[0] + (px - left) / width * (rangeX[1] - rangeX[0]);
    const toY = (py) => rangeY[1] - (py - top) / height * (rangeY[1] - rangeY[0]);
    // Curves are drawn to a tenth of a pixel: no more digits than that.
    const decimals = (range, size) => Math.max(0, -Math.floor(Math.log10((range[1] - range[0]) / size / 10)) - 1);
    const [decimalsX, decimalsY] = [decimals(rangeX, width), decimals(rangeY, height)];
    // Curves as drawn, back in pixels; a break begins with a move, and every other step is from the last point.
    const curves = [...svg.querySelectorAll("path[data-name]")].map((path) => {
      let [x, y] = [0, 0];
      return path.getAttribute("d").replace("Z", "").split(/(?=[Ml])/).map((part) => {
        const [dx, dy] = part.slice(1).split(" ").map(Number), begins = part[0] === "M";
        [x, y] = begins ? [dx, dy] : [x + dx, y + dy];
        return [x, y, begins];
      });
    });
    const dots = [...svg.querySelectorAll("circle[data-values]")].map((circle) => ({
      at: [Number(circle.getAttribute("cx")), Number(circle.getAttribute("cy"))],
      texts: circle.dataset.values.split("|"),
    }));
    const cross = document.createElementNS("http://www.w3.org/2000/svg", "path");
    cross.setAttribute("class", "cross");
    svg.append(cross);
    let cursor = [0, 0];

    // Where a curve is at px; null where it is not.
    function heightAt(points, px) {
      for (let k = 1; k < points.length; k += 1) {
        const [a, b] = [points[k - 1], points[k]];
        if (!b[2] && a[0] <= px && px <= b[0] && b[0] > a[0]) return a[1] + (b[1] - a[1]) * (px - a[0]) / (b[0] - a[0]);
      }
      return null;
    }

    function show(place) {
      cursor = [clamp(place[0], left, left + width), clamp(place[1], top, top + height)];
      let texts, rings = [];
      if (kind === "curves") {
        const heights = curves.map((points) => heightAt(points, cursor[0]));
        texts = [fixed(toX(cursor[0]), decimalsX), ...heights.map((y) => y === null ? null : fixed(toY(y), decimalsY))];
        rings = heights.filter((y) => y !== null).map((y) => [cursor[0], y]);
      } else if (kind === "dots") {
        const dot = dots.reduce((a, b) => distance(b.at, cursor) < distance(a.at, cursor) ? b : a);
        [cursor, texts] = [dot.at, dot.texts];
      } else {
        texts = pairs[svg.closest("[data-pair]").dataset.pair][kind]([toX(cursor[0]), toY(cursor[1])]);
      }
      if (kind !== "curves") rings = [cursor];
      outputs.forEach((output, k) => { output.textContent = texts[k] ?? "\u2013"; });
      const across = kind === "curves" ? "" : `M${left} ${cursor[1]}h${width}`;
      cross.setAttribute("d", `M${cursor[0]} ${top}v${height}${across}${rings.map(ring).join("")}`);
    }

    // One step by a cursor key: along the curve that has the focus, to the next dot, or in the plane.
    function step(target, dx, dy) {
      if (target.dataset.name) {
        const length = target.getTotalLength();
        const at = (share) => { const p = target.getPointAtLength(share * length); return [p.x, p.y]; };
        let share = 0;
        for (let k = 1; k <= 240; k += 1) if (distance(at(k / 240), cursor) < distance(at(share), cursor)) share = k / 240;
        show(at(clamp(share + (dx - dy) / 60, 0, 1)));
      } else if (kind === "dots") {
        const here = dots.findIndex((dot) => dot.at === cursor);
        show(dots[clamp(here + dx - dy, 0, dots.length - 1)].at);
      } else {
        show([cursor[0] + dx * width / 60, cursor[1] + dy * height / 60]);
      }
    }

    function point(event) {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      const inside = at.x >= left && at.x <= left + width && at.y >= top && at.y <= top + height;
      if (inside) show([at.x, at.y]);
    }
    svg.addEventListener("pointerdown", point);
    svg.addEventListener("pointermove", point);
    svg.addEventListener("focusin", (event) => {
      svg.parentNode.querySelector(".readout").setAttribute("aria-live", "polite");
      if (event.target.matches(":focus-visible")) step(event.target, 0, 0);
    });
    svg.addEventListener("keydown", (event) => {
      const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!move) return;
      event.preventDefault();
      step(event.target, ...move);
    });
    const [startX, startY] = svg.dataset.at.split(" ").map(Number);
    show([left + (startX - rangeX[0]) / (rangeX[1] - rangeX[0]) * width,
      top + (rangeY[1] - startY) / (rangeY[1] - rangeY[0]) * height]);
  }

  checks(root);

  // Ticks are kept by the airframe's name and by what a row says: one that says something else is open again.
  function checks(root) {
    const key = `checks of ${root.querySelector("h1").textContent}`;
    // Some origins have no storage, and what is in it may be another's.
    const guarded = (action, otherwise) => { try { return action(); } catch { return otherwise; } };
    const kept = guarded(() => new Set(JSON.parse(localStorage.getItem(key) ?? "[]")), new Set());
    for (const row of root.querySelectorAll("tr.check")) {
      const said = [...row.cells].filter((cell) => !cell.matches(".drive, .seen")).map((cell) => cell.textContent).join(", ");
      const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: kept.has(said) });
      box.setAttribute("aria-label", `seen: ${said}`);
      box.addEventListener("change", () => {
        kept[box.checked ? "add" : "delete"](said);
        guarded(() => localStorage.setItem(key, JSON.stringify([...kept])));
      });
      row.querySelector(".seen").replaceChildren(box);
    }
    for (const line of root.querySelectorAll("code.line")) {
      const button = Object.assign(document.createElement("button"), { type: "button", className: "copy", textContent: "copy" });
      button.setAttribute("aria-label", `copy ${line.textContent}`);
      button.addEventListener("click", async () => {
        // Where nothing may be copied, the line is selected for the keyboard.
        getSelection().selectAllChildren(line);
        try {
          await navigator.clipboard.writeText(line.textContent);
          button.textContent = "copied";
        } catch {
          button.textContent = "selected";
        }
      });
      line.after(" ", button);
    }
  }
}
