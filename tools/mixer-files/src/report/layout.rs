//! The layout from above: units, spins of both rotors, motors, and where forward is.

use std::fmt::Write as _;

use mixer_compiler::airframe::{Airframe, Spin, Unit};

use crate::report::figure::Figure;
use crate::report::number::fixed;

/// The airframe seen from above, forward up.
pub fn layout(airframe: &Airframe) -> Figure {
    // Body y (right) runs to the right, body x (forward) upwards.
    let places = airframe
        .units
        .iter()
        .map(|unit| [unit.position_m[1], unit.position_m[0]]);
    let places: Vec<[f64; 2]> = places.collect();
    let radius = disk_radius(&places);
    // Where rotors cover the centre, as on a vehicle of one unit, the arrow stands in front of
    // them.
    let covered = places.iter().any(|p| libm::hypot(p[0], p[1]) < radius);
    let margin = radius * if covered { 1.45 } else { 1.2 };
    let extent = |k: usize| {
        // The centre of gravity is always in view.
        let [low, high] = places.iter().fold([0.0f64; 2], |[low, high], place| {
            [low.min(place[k]), high.max(place[k])]
        });
        [low - margin, high + margin]
    };
    let mut figure = Figure::new(
        "Layout seen from above: units, spins and motors",
        ("y, right (m)", extent(0)),
        ("x, forward (m)", extent(1)),
    )
    .high(280.0)
    .equal_scales();

    let [cx, cy] = figure.at([0.0, 0.0]);
    for &place in &places {
        let arm = figure.path(&[[0.0, 0.0], place], false);
        figure.raw(&format!("<path class=\"arm\" d=\"{arm}\"/>"));
    }
    let per_metre = figure.at([1.0, 0.0])[0] - cx;
    for (index, (unit, &place)) in airframe.units.iter().zip(&places).enumerate() {
        let [x, y] = figure.at(place);
        let covers_centre = libm::hypot(place[0], place[1]) < radius;
        let crowded = covers_centre || tilted(unit);
        figure.raw(&drawn(unit, index, [x, y], radius * per_metre, crowded));
    }
    let (start, length) = if covered {
        (1.06 * radius * per_metre, 0.3 * radius * per_metre)
    } else {
        (0.0, (0.55 * radius * per_metre).max(22.0))
    };
    figure.raw(&format!(
        "<circle class=\"centre\" cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"3\"><title>centre of gravity</title></circle>\
         <path class=\"forward\" d=\"M{cx:.1} {:.1}v{:.1}m-6 9l6 -11l6 11\"/>",
        cy - start,
        -length
    ));
    for (layer, _) in airframe.layers() {
        let (class, arrow) = match layer {
            "upper" => ("upper-spin", " \u{2191}"),
            "lower" => ("lower-spin", " \u{2193}"),
            _ => ("upper-spin", ""),
        };
        figure.entry(class, &format!("{layer} rotor{arrow}"));
    }
    figure.entry("forward", "forward");
    figure
}

/// A rotor's radius in the drawing, m: neighbours do not touch. (The file does not know the true
/// one.)
fn disk_radius(places: &[[f64; 2]]) -> f64 {
    let mut nearest = f64::INFINITY;
    for (index, a) in places.iter().enumerate() {
        for b in &places[..index] {
            nearest = nearest.min(libm::hypot(a[0] - b[0], a[1] - b[1]));
        }
    }
    // Units above one another have no distance from above.
    if nearest.is_finite() && nearest > 0.02 {
        0.44 * nearest
    } else {
        0.15
    }
}

/// One unit as SVG: two rings with arrows, its number and those of its motors, apart where something else is
/// drawn between them.
fn drawn(unit: &Unit, index: usize, [x, y]: [f64; 2], radius: f64, crowded: bool) -> String {
    let gap = if crowded { 7.0 } else { 0.0 };
    let mut svg = String::new();
    let [px, py, pz] = unit.position_m;
    let _ = write!(
        svg,
        "<g><title>unit {index}: x {} m, y {} m, z {} m; {}</title>\
         <circle class=\"disk\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\"/>",
        fixed(px, 4),
        fixed(py, 4),
        fixed(pz, 4),
        unit.in_words()
    );
    let rings = [("upper-spin", 1.0), ("lower-spin", 0.78)];
    for (rotor, (class, share)) in unit.rotors().zip(rings) {
        svg.push_str(&spin_arc(class, rotor.spin, [x, y], share * radius));
    }
    let [ax, ay, _] = unit.axis;
    if tilted(unit) {
        // The horizontal part of a unit thrust, at the drawing's scale of one radius.
        let _ = write!(
            svg,
            "<path class=\"tilt\" d=\"M{x:.1} {y:.1}l{:.1} {:.1}\"><title>thrust axis {} {} {}</title></path>",
            ay * radius,
            -ax * radius,
            fixed(ax, 4),
            fixed(ay, 4),
            fixed(unit.axis[2], 4)
        );
    }
    let _ = write!(
        svg,
        "<text class=\"unit\" x=\"{x:.1}\" y=\"{:.1}\">unit {index}</text>\
         <text class=\"channel\" x=\"{x:.1}\" y=\"{:.1}\">{}</text></g>",
        y - 3.0 - gap,
        y + 13.0 + gap,
        match unit.lower_channel {
            Some(lower) => format!("\u{2191}{}  \u{2193}{}", unit.upper_channel + 1, lower + 1),
            None => (unit.upper_channel + 1).to_string(),
        }
    );
    svg
}

/// Whether the thrust axis has a horizontal part.
fn tilted(unit: &Unit) -> bool {
    libm::hypot(unit.axis[0], unit.axis[1]) > 1e-6
}

/// Two thirds of a circle with an arrow head.
fn spin_arc(class: &str, spin: Spin, [x, y]: [f64; 2], radius: f64) -> String {
    // Degrees clockwise on the screen from the right.
    let (start, end, sweep) = match spin {
        Spin::Cw => (-200.0, 40.0, 1),
        Spin::Ccw => (20.0, -220.0, 0),
    };
    let point = |degrees: f64, r: f64| {
        let (sin, cos) = libm::sincos(f64::to_radians(degrees));
        [x + r * cos, y + r * sin]
    };
    let ([sx, sy], [ex, ey]) = (point(start, radius), point(end, radius));
    let forwards = if sweep == 1 { 1.0 } else { -1.0 };
    let back = end - forwards * (8.0f64 / radius).to_degrees();
    let ([ix, iy], [ox, oy]) = (point(back, radius - 5.0), point(back, radius + 5.0));
    format!(
        "<path class=\"line {class}\" d=\"M{sx:.1} {sy:.1}A{radius:.1} {radius:.1} 0 1 {sweep} {ex:.1} {ey:.1}\
         M{ix:.1} {iy:.1}L{ex:.1} {ey:.1}L{ox:.1} {oy:.1}\"/>"
    )
}
