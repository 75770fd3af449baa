// Values under the pointer. The page is complete without this.
"use strict";
(function () {
  const model = JSON.parse(document.getElementById("model").textContent);
  const [low, high] = model.throttle;

  // The pair's forward map and its Jacobian, in double precision.
  function efforts(u, l) {
    let f = 0, q = 0, fu = 0, fl = 0, qu = 0, ql = 0;
    for (const [i, j, a, b] of model.terms) {
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
      if (Math.abs(df) < 1e-9 * model.scale[0] && Math.abs(dq) < 1e-9 * model.scale[1]) return [u, l];
      u = clamp(u + (df * e.ql - dq * e.fl) / det);
      l = clamp(l + (dq * e.fu - df * e.qu) / det);
    }
    return null;
  }

  const digits = (x, n) => (x === 0 ? "0" : Number(x.toPrecision(n)).toString()).replace("-", "\u2212");
  const fixed = (x, n) => x.toFixed(n).replace(/^-(?=0\.?0*$)/, "").replace("-", "\u2212");

  // The value of a grid of thousandths of its largest value at the node next to (u, l).
  function nearest(grid, u, l) {
    const node = (x) => Math.round((x - low) / (high - low) * (grid.side - 1));
    return grid.thousandths[node(l) * grid.side + node(u)] * grid.largest / 1000;
  }

  const kinds = {
    forward([u, l]) {
      if (u < low || u > high || l < low || l > high) return "outside the throttle range";
      const e = efforts(u, l);
      return `u ${fixed(u, 3)}, l ${fixed(l, 3)}: f ${fixed(e.f, 3)} N, Q ${fixed(e.q, 4)} N m`;
    },
    inverse([f, q]) {
      const found = invert(f, q);
      const where = `f ${fixed(f, 3)} N, Q ${fixed(q, 4)} N m: `;
      return where + (found ? `u ${fixed(found[0], 4)}, l ${fixed(found[1], 4)}` : "not attainable");
    },
    plane([f, q]) { return `f ${fixed(f, 3)} N, Q ${fixed(q, 4)} N m`; },
    "error-thrust": (at) => error(at, model.errors[0], "N"),
    "error-torque": (at) => error(at, model.errors[1], "N m"),
  };
  function error([f, q], grid, unit) {
    const found = invert(f, q);
    const where = `f ${fixed(f, 3)} N, Q ${fixed(q, 4)} N m: `;
    return where + (found ? `misses about ${digits(nearest(grid, found[0], found[1]), 2)} ${unit}` : "not attainable");
  }

  for (const svg of document.querySelectorAll("svg[data-hover]")) {
    const kind = svg.dataset.hover;
    if (!kind) continue;
    const readout = svg.parentNode.querySelector(".readout");
    const [left, top, width, height] = svg.dataset.box.split(" ").map(Number);
    const axes = [svg.dataset.x, svg.dataset.y].map((range) => range.split(" ").map(Number));
    const labels = svg.dataset.labels.split("|");
    const toX = (px) => axes[0][0] + (px - left) / width * (axes[0][1] - axes[0][0]);
    const toY = (py) => axes[1][1] - (py - top) / height * (axes[1][1] - axes[1][0]);
    const cross = document.createElementNS("http://www.w3.org/2000/svg", "path");
    cross.setAttribute("class", "cross");
    svg.append(cross);
    // Curves as drawn, back in pixels: breaks are kept apart.
    const curves = [...svg.querySelectorAll("path[data-name]")].map((path) => ({
      name: path.dataset.name,
      points: path.getAttribute("d").split(/[ML]/).slice(1).map((pair) => pair.split(" ").map(Number)),
    })).filter((curve) => curve.name);

    // Curves are drawn to a tenth of a pixel: no more digits than that.
    const decimals = (range, size) => Math.max(0, -Math.floor(Math.log10((range[1] - range[0]) / size / 10)) - 1);
    const [decimalsX, decimalsY] = [decimals(axes[0], width), decimals(axes[1], height)];

    function valuesAt(px) {
      const texts = [`${labels[0]} ${fixed(toX(px), decimalsX)}`];
      for (const { name, points } of curves) {
        for (let k = 1; k < points.length; k += 1) {
          const [a, b] = [points[k - 1], points[k]];
          if (a[0] <= px && px <= b[0] && b[0] > a[0]) {
            const y = a[1] + (b[1] - a[1]) * (px - a[0]) / (b[0] - a[0]);
            texts.push(`${name} ${fixed(toY(y), decimalsY)}`);
            break;
          }
        }
      }
      return texts.join("; ");
    }

    svg.addEventListener("pointermove", (event) => {
      const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      const inside = point.x >= left && point.x <= left + width && point.y >= top && point.y <= top + height;
      if (!inside) { clear(); return; }
      if (kind === "curves") {
        cross.setAttribute("d", `M${point.x} ${top}v${height}`);
        readout.textContent = valuesAt(point.x);
      } else {
        cross.setAttribute("d", `M${point.x} ${top}v${height}M${left} ${point.y}h${width}`);
        readout.textContent = kinds[kind]([toX(point.x), toY(point.y)]);
      }
    });
    function clear() { cross.setAttribute("d", ""); readout.textContent = ""; }
    svg.addEventListener("pointerleave", clear);
  }
})();
