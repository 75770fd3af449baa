//! The short form for regular frames: units on a circle, expanded to the `[[unit]]` tables that it
//! stands for.
//!
//! Unit k stands at the angle first + k 360/n degrees, clockwise from the nose as seen from above,
//! so at x = arm cos, y = arm sin. Upper rotors alternate from `first_spin` on where the count is
//! even; where it is odd, two neighbours would have to agree, and all turn like the first, as on a
//! Y6. `spins` says otherwise. Outputs are k for the upper and n + k for the lower rotor unless
//! `channels` says otherwise.

use std::f64::consts::PI;
use std::ops::Range;

use toml::Spanned;

use super::check::word;
use super::pair::Spin;
use super::unit::FARTHEST_M;
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::spec::keys::MOST_UNITS;
use crate::spec::{Channels, Layout, Unit};

/// Coordinates below this share of the arm are the rounding of sin and cos at multiples of 90
/// degrees.
const ROUNDING: f64 = 1e-12;

/// Nearest neighbours on the circle, m.
const NEAREST_M: f64 = 1e-3;

/// The units of a layout, or `None` after noting why there are none. `bench_spin` is the default of
/// `first_spin`.
pub(crate) fn expand(
    layout: &Layout,
    bench_spin: Option<Spin>,
    faults: &mut Vec<Diagnostic>,
) -> Option<Vec<Unit>> {
    let units = layout.units.as_ref().and_then(|field| count(field, faults));
    let arm_m = layout.arm_m.as_ref().and_then(|field| arm(field, units, faults));
    let first_deg = layout
        .first_angle_deg
        .as_ref()
        .and_then(|field| angle(field, faults));
    let spins = spins(layout, units, bench_spin, faults);
    let channels = channels(layout, units, faults);

    let (count, arm_m, first_deg) = (units?, arm_m?, first_deg?);
    let units = (0..count)
        .zip(spins?)
        .zip(channels?)
        .map(|((k, spin), channels)| {
            let place = layout.place.clone();
            let [x, y] = on_circle(arm_m, first_deg + 360.0 * k as f64 / count as f64);
            Unit {
                path: format!("unit[{k}]"),
                position_m: Some(Spanned::new(
                    layout.arm_m.as_ref().map_or(place.clone(), Spanned::span),
                    [x, y, 0.0].map(|x| Spanned::new(place.clone(), x)),
                )),
                upper_spin: Some(Spanned::new(place.clone(), spin.name().to_string())),
                channels: Some(channels),
                axis: None,
                place,
            }
        });
    Some(units.collect())
}

/// x forward and y right of a point on a circle, m, from its angle clockwise from the nose.
fn on_circle(arm_m: f64, angle_deg: f64) -> [f64; 2] {
    let angle = (angle_deg % 360.0) * (PI / 180.0);
    [libm::cos(angle), libm::sin(angle)].map(|x| if x.abs() < ROUNDING { 0.0 } else { arm_m * x })
}

fn fault(code: Code, key: &str, place: Range<usize>, message: String) -> Diagnostic {
    Diagnostic::new(code, format!("layout.{key}"), place, message)
}

fn count(field: &Spanned<usize>, faults: &mut Vec<Diagnostic>) -> Option<usize> {
    let count = *field.get_ref();
    if (1..=MOST_UNITS).contains(&count) {
        return Some(count);
    }
    let code = if count == 0 {
        Code::OutOfRange
    } else {
        Code::TooManyUnits
    };
    faults.push(
        fault(
            code,
            "units",
            field.span(),
            format!("`layout.units` = {count} is not between 1 and {MOST_UNITS}"),
        )
        .label("number of pairs")
        .help("a unit is one pair of rotors: an X8 has 4, a Y6 has 3"),
    );
    None
}

fn arm(field: &Spanned<f64>, units: Option<usize>, faults: &mut Vec<Diagnostic>) -> Option<f64> {
    let arm_m = *field.get_ref();
    let bad = |code, message| fault(code, "arm_m", field.span(), message);
    if arm_m <= 0.0 {
        faults.push(
            bad(
                Code::OutOfRange,
                format!("`layout.arm_m` = {} is not positive", number(arm_m)),
            )
            .label("must be above 0")
            .help("the distance of every unit from the centre of gravity, in metres"),
        );
        return None;
    }
    if arm_m > FARTHEST_M {
        faults.push(
            bad(
                Code::FarUnit,
                format!("the units are {} m from the centre of gravity", number(arm_m)),
            )
            .label(format!("expected metres, at most {FARTHEST_M}"))
            .help(format!(
                "if millimetres were meant, write {}",
                number(arm_m / 1000.0)
            )),
        );
        return None;
    }
    let units = units?;
    let apart_m = 2.0 * arm_m * libm::sin(PI / units as f64);
    if units > 1 && apart_m < NEAREST_M {
        let apart = rounded(apart_m * 1000.0);
        faults.push(
            bad(
                Code::SamePlace,
                format!("neighbouring units are {apart} mm apart"),
            )
            .label("all units are in one place")
            .help("the distance of every unit from the centre of gravity, in metres"),
        );
        return None;
    }
    Some(arm_m)
}

fn angle(field: &Spanned<f64>, faults: &mut Vec<Diagnostic>) -> Option<f64> {
    let angle = *field.get_ref();
    if angle.abs() <= 360.0 {
        return Some(angle);
    }
    faults.push(
        fault(
            Code::OutOfRange,
            "first_angle_deg",
            field.span(),
            format!("`layout.first_angle_deg` = {} is more than a turn", number(angle)),
        )
        .label("expected -360 to 360")
        .help("degrees clockwise from the nose, seen from above"),
    );
    None
}

fn spins(
    layout: &Layout,
    units: Option<usize>,
    bench_spin: Option<Spin>,
    faults: &mut Vec<Diagnostic>,
) -> Option<Vec<Spin>> {
    let first = match &layout.first_spin {
        Some(field) => word(field, "layout.first_spin", &Spin::WORDS, faults),
        None => bench_spin,
    };
    let Some(field) = &layout.spins else {
        let (units, first) = (units?, first?);
        let alternates = units % 2 == 0;
        let spin = |k| {
            if alternates && k % 2 == 1 {
                first.reversed()
            } else {
                first
            }
        };
        return Some((0..units).map(spin).collect());
    };
    if let Some(first) = &layout.first_spin {
        let message = "`first_spin` and `spins` both say how the first unit turns".to_string();
        faults.push(
            fault(Code::Conflict, "first_spin", first.span(), message)
                .label("`spins` says it too")
                .help("remove `first_spin`: `spins` names every unit's upper rotor"),
        );
    }
    let spins: Vec<_> = field
        .get_ref()
        .iter()
        .map(|spin| word(spin, "layout.spins", &Spin::WORDS, faults))
        .collect();
    same_count("spins", field.get_ref().len(), field.span(), units, faults)?;
    spins.into_iter().collect()
}

fn channels(
    layout: &Layout,
    units: Option<usize>,
    faults: &mut Vec<Diagnostic>,
) -> Option<Vec<Spanned<Channels>>> {
    let Some(field) = &layout.channels else {
        let (units, place) = (units?, layout.place.clone());
        let channel = |output| Spanned::new(place.clone(), output);
        return Some(
            (0..units)
                .map(|k| Spanned::new(place.clone(), [channel(k), channel(units + k)]))
                .collect(),
        );
    };
    same_count("channels", field.get_ref().len(), field.span(), units, faults)?;
    Some(field.get_ref().clone())
}

fn same_count(
    key: &str,
    found: usize,
    place: Range<usize>,
    units: Option<usize>,
    faults: &mut Vec<Diagnostic>,
) -> Option<()> {
    let units = units?;
    if found == units {
        return Some(());
    }
    faults.push(
        fault(
            Code::WrongLength,
            key,
            place,
            format!("`layout.{key}` has {found} entries, `layout.units` is {units}"),
        )
        .label(format!("expected {units} entries"))
        .help("one entry for each unit, clockwise from the first"),
    );
    None
}
