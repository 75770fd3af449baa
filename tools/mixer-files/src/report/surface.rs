//! A forward map as a surface over both throttles, in parallel projection, with the bench points
//! and how far each is off (Fig. 3 of the paper).
//!
//! The eye is above the corner of least throttles. With a and b the shares of u and l of their
//! range and c that of the quantity, a point is drawn at x = W (a - b), y = D (a + b) + H c, y
//! upwards; patches are painted from the far corner (large a + b) to the near one.

use std::fmt::Write as _;

use crate::report::bench::BenchPoints;
use crate::report::colour::Scale;
use crate::report::effort::Effort;
use crate::report::figure::{WIDTH, path};
use crate::report::number::{Ticks, escaped, fixed, range};
use crate::report::study::Study;

/// Patches per side.
const PATCHES: usize = 16;

/// Half the width of the box, px.
const W: f64 = 134.0;

/// Half the height of its floor, px.
const D: f64 = 48.0;

/// Its height, px.
const H: f64 = 150.0;

/// The middle of the near corner, px.
const ORIGIN: [f64; 2] = [194.0, 276.0];

struct View {
    throttle: [f64; 2],
    quantity: [f64; 2],
}

impl View {
    fn at(&self, [u, l]: [f64; 2], z: f64) -> [f64; 2] {
        let share = |x: f64, [low, high]: [f64; 2]| (x - low) / (high - low);
        let (a, b) = (share(u, self.throttle), share(l, self.throttle));
        [
            ORIGIN[0] + W * (a - b),
            ORIGIN[1] - D * (a + b) - H * share(z, self.quantity),
        ]
    }
}

/// Thrust or torque of one unit as SVG.
pub fn surface(study: &Study<'_>, effort: Effort, bench: Option<&BenchPoints>) -> String {
    let at = |throttles: [f64; 2]| study.pair.efforts(throttles)[effort as usize];
    let points = bench.map_or(&[][..], |bench| &bench.points);
    let corner = |k: usize| k as f64 / PATCHES as f64;
    let nodes = (0..=PATCHES).flat_map(|i| (0..=PATCHES).map(move |j| [corner(i), corner(j)]));
    let model = range(nodes.map(|square| at(study.throttles(square))));
    let measured = points.iter().map(|point| point.measured[effort as usize]);
    let quantity = range(measured.chain(model));
    let throttle = study.pair.range();
    let view = View { throttle, quantity };
    let scale = match effort {
        Effort::Thrust => Scale::sequential(model),
        Effort::Torque => Scale::signed(model),
    };
    let title = format!("{} of one unit as a surface", effort.name());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"figure\" viewBox=\"0 0 {WIDTH} 312\" role=\"img\" aria-label=\"{title}\">\n"
    );
    axes(&mut svg, &view, effort);

    let patches = (0..PATCHES).flat_map(|i| (0..PATCHES).map(move |j| [i, j]));
    let mut patches: Vec<[usize; 2]> = patches.collect();
    patches.sort_by_key(|[i, j]| std::cmp::Reverse(i + j));
    svg.push_str("<g class=\"surface\">\n");
    for [i, j] in patches {
        let node = |di: usize, dj: usize| {
            let throttles = study.throttles([corner(i + di), corner(j + dj)]);
            view.at(throttles, at(throttles))
        };
        let middle = [i, j].map(|k| corner(k) + 0.5 / PATCHES as f64);
        let fill = scale.hex(at(study.throttles(middle)));
        let ring = path::data(&[node(0, 0), node(1, 0), node(1, 1), node(0, 1)], true);
        let _ = writeln!(svg, "<path fill=\"{fill}\" d=\"{ring}\"/>");
    }
    svg.push_str("</g>\n");
    svg.push_str("<g class=\"bench-dot\">\n");
    for point in points {
        let (measured, model) = (point.measured[effort as usize], point.model[effort as usize]);
        let [[x, y], [_, foot]] = [measured, model].map(|effort| view.at(point.throttles, effort));
        let _ = writeln!(
            svg,
            "<path d=\"M{x:.1} {y:.1}V{foot:.1}\"/><circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2\"/>"
        );
    }
    svg.push_str("</g>\n</svg>\n");
    svg
}

/// The floor with the throttles' ticks and the quantity's axis at the left corner.
fn axes(svg: &mut String, view: &View, effort: Effort) {
    let ([low, high], [floor, ceiling]) = (view.throttle, view.quantity);
    let corners =
        [[low, low], [high, low], [high, high], [low, high]].map(|throttles| view.at(throttles, floor));
    let top = view.at([low, high], ceiling);
    let mut lines = String::new();
    for (index, [x, y]) in corners.iter().enumerate() {
        let _ = write!(lines, "{}{x:.1} {y:.1}", if index == 0 { 'M' } else { 'L' });
    }
    let _ = write!(lines, "ZM{:.1} {:.1}V{:.1}", top[0], corners[3][1], top[1]);
    let mut words = String::new();
    let ticks = Ticks::within(view.throttle, 5);
    for &value in &ticks.values {
        for (throttles, dx, anchor) in [([value, low], 6.0, "start"), ([low, value], -6.0, "end")] {
            let [x, y] = view.at(throttles, floor);
            let _ = write!(lines, "M{x:.1} {y:.1}l{dx:.1} 3");
            let _ = writeln!(
                words,
                "<text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>",
                x + 1.4 * dx,
                y + 12.0,
                ticks.text(value)
            );
        }
    }
    let ticks = Ticks::within(view.quantity, 5);
    for &value in &ticks.values {
        let [x, y] = view.at([low, high], value);
        let _ = write!(lines, "M{x:.1} {y:.1}h-6");
        let _ = writeln!(
            words,
            "<text class=\"tick\" x=\"{:.1}\" y=\"{y:.1}\" dy=\".35em\" text-anchor=\"end\">{}</text>",
            x - 9.0,
            ticks.text(value)
        );
    }
    let middle = 0.5 * (low + high);
    let ([ux, uy], [lx, ly]) = (view.at([middle, low], floor), view.at([low, middle], floor));
    let (zx, zy) = (top[0] - 44.0, 0.5 * (top[1] + corners[3][1]));
    let slope = fixed(libm::atan2(D, W).to_degrees(), 1);
    let _ = writeln!(
        svg,
        "<path class=\"frame\" d=\"{lines}\"/>\n{words}\
         <text class=\"label\" transform=\"translate({:.1} {:.1}) rotate(-{slope})\" text-anchor=\"middle\">upper throttle u</text>\n\
         <text class=\"label\" transform=\"translate({:.1} {:.1}) rotate({slope})\" text-anchor=\"middle\">lower throttle l</text>\n\
         <text class=\"label\" transform=\"translate({zx:.1} {zy:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        ux + 18.0,
        uy + 36.0,
        lx - 18.0,
        ly + 36.0,
        escaped(effort.label())
    );
}
