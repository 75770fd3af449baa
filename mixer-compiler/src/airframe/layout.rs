//! The short form for regular frames: units on a circle, expanded to the `[[unit]]` tables that it
//! stands for.
//!
//! Unit k stands at the angle first + k 360/n degrees, clockwise from the nose as seen from above,
//! so at x = arm cos, y = arm sin. Upper rotors alternate from `first_spin` on where the count is
//! even; where it is odd, two neighbours would have to agree, and all turn like the first, as on a
//! Y6. `spins` says otherwise. Outputs are k for the upper and n + k for the lower rotor unless
//! `channels` says otherwise.

use std::f64::consts::PI;
use std::ops;

use super::pair::Spin;
use super::unit::{self, FARTHEST_M, MOST_UNITS};
use crate::diagnostic::{Code, number, rounded};
use crate::spec::keys::{Key, Range, ValueKind, keys};
use crate::spec::{Fields, Spanned};

const ARM: &str = "the distance of every unit from the centre of gravity, in metres";

keys! { TABLE = "[layout]":
    ARM_M "arm_m" = "0.45", ValueKind::Number(Range::Positive),
        "From the centre of gravity to each mast, m.".required()
        .refusing("must be above 0", ARM);
    UNITS "units" = "4", ValueKind::Count([1, MOST_UNITS]),
        "Pairs of rotors.".required();
    FIRST_ANGLE_DEG "first_angle_deg" = "45", ValueKind::Number(Range::Within([-360.0, 360.0])),
        "Of the first unit, degrees clockwise from the nose as seen from above.".required()
        .refusing("more than a turn", "degrees clockwise from the nose, seen from above");
    FIRST_SPIN "first_spin" = "\"cw\"", ValueKind::Word(&Spin::WORDS),
        "Of the first unit's upper rotor. They alternate for an even number of units and turn alike for an odd one.";
    SPINS "spins" = "[\"cw\", \"ccw\", \"cw\", \"ccw\"]", ValueKind::Words(&Spin::WORDS),
        "Of every unit's upper rotor, instead of first_spin.";
    PAIRS "pairs" = "[\"front\", \"rear\", \"rear\", \"front\"]", ValueKind::Texts,
        "With several `[[pair]]`: the name of every unit's.";
    CHANNELS "channels" = "[[0, 4], [1, 5], [2, 6], [3, 7]]", ValueKind::ListOfChannels,
        "Outputs of the upper and of the lower rotor of every unit; k and n + k without it.";
}

/// Coordinates below this share of the arm are the rounding of sin and cos at multiples of 90
/// degrees.
const ROUNDING: f64 = 1e-12;

/// Nearest neighbours on the circle, m.
const NEAREST_M: f64 = 1e-3;

/// What a layout says.
pub(super) struct Layout {
    /// Place of the header.
    pub(super) place: ops::Range<usize>,
    pub(super) first_angle_deg: Option<f64>,
    /// The units that it stands for; `None` where it was refused.
    pub(super) units: Option<Vec<unit::Written>>,
}

/// Reads `[layout]`; `bench_spin` is the default of `first_spin`.
pub(super) fn read(table: &mut Fields<'_, '_>, bench_spin: Option<Spin>) -> Layout {
    let units = count(table);
    let arm_m = arm(table, units);
    let first_angle_deg = table.number(&FIRST_ANGLE_DEG);
    let spins = spins(table, units, bench_spin);
    let channels = channels(table, units);
    let pairs = pairs(table, units);
    let expanded = || {
        let (count, arm_m, first_deg) = (units?, arm_m?, first_angle_deg?);
        let units = (0..count).zip(spins?).zip(channels?).zip(pairs?);
        let units = units.map(|(((k, spin), channels), pair)| {
            let [x, y] = on_circle(arm_m, first_deg + 360.0 * k as f64 / count as f64);
            unit::Written {
                position_m: Some([x, y, 0.0]),
                axis: Some(unit::UPWARD),
                upper_spin: Some(spin),
                channels: Some((channels[0], Some(channels[1]))),
                pair,
                rotor: None,
            }
        });
        Some(units.collect())
    };
    Layout {
        units: expanded(),
        first_angle_deg,
        place: table.place(),
    }
}

/// x forward and y right of a point on a circle, m, from its angle clockwise from the nose.
fn on_circle(arm_m: f64, angle_deg: f64) -> [f64; 2] {
    let angle = (angle_deg % 360.0) * (PI / 180.0);
    [libm::cos(angle), libm::sin(angle)].map(|x| if x.abs() < ROUNDING { 0.0 } else { arm_m * x })
}

fn count(table: &mut Fields<'_, '_>) -> Option<usize> {
    let count = *table.read::<usize>(&UNITS)?.get_ref();
    if (1..=MOST_UNITS).contains(&count) {
        return Some(count);
    }
    let code = if count == 0 {
        Code::OutOfRange
    } else {
        Code::TooManyUnits
    };
    let message = format!("`layout.units` = {count} is not between 1 and {MOST_UNITS}");
    let help = "a unit is one pair of rotors: an X8 has 4, a Y6 has 3";
    table.refuse(&UNITS, code, message, "number of pairs", help)
}

fn arm(table: &mut Fields<'_, '_>, units: Option<usize>) -> Option<f64> {
    let arm_m = table.number(&ARM_M)?;
    if arm_m > FARTHEST_M {
        let message = format!("the units are {} m from the centre of gravity", number(arm_m));
        let label = format!("expected metres, at most {FARTHEST_M}");
        let help = format!("if millimetres were meant, write {}", number(arm_m / 1000.0));
        return table.refuse(&ARM_M, Code::FarUnit, message, label, help);
    }
    let units = units?;
    let apart_m = 2.0 * arm_m * libm::sin(PI / units as f64);
    if units > 1 && apart_m < NEAREST_M {
        let message = format!("neighbouring units are {} mm apart", rounded(apart_m * 1000.0));
        return table.refuse(
            &ARM_M,
            Code::SamePlace,
            message,
            "all units are in one place",
            ARM,
        );
    }
    Some(arm_m)
}

fn spins(table: &mut Fields<'_, '_>, units: Option<usize>, bench_spin: Option<Spin>) -> Option<Vec<Spin>> {
    let written = table.read::<String>(&FIRST_SPIN);
    let first = match &written {
        Some(field) => table.meaning(&FIRST_SPIN, field, &Spin::ALL),
        None => bench_spin,
    };
    let Some(field) = table.read::<Vec<Spanned<String>>>(&SPINS) else {
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
    if written.is_some() {
        let message = "`first_spin` and `spins` both say how the first unit turns".to_string();
        let help = "remove `first_spin`: `spins` names every unit's upper rotor";
        table.refuse::<()>(&FIRST_SPIN, Code::Conflict, message, "`spins` says it too", help);
    }
    let spins: Vec<_> = field
        .get_ref()
        .iter()
        .map(|spin| table.meaning(&SPINS, spin, &Spin::ALL))
        .collect();
    same_count(table, &SPINS, spins.len(), units)?;
    spins.into_iter().collect()
}

fn channels(table: &mut Fields<'_, '_>, units: Option<usize>) -> Option<Vec<[usize; 2]>> {
    let Some(field) = table.read::<Vec<Spanned<[Spanned<usize>; 2]>>>(&CHANNELS) else {
        let units = units?;
        return Some((0..units).map(|k| [k, units + k]).collect());
    };
    same_count(table, &CHANNELS, field.get_ref().len(), units)?;
    let written = field.into_inner().into_iter();
    Some(
        written
            .map(|pair| pair.into_inner().map(Spanned::into_inner))
            .collect(),
    )
}

fn pairs(table: &mut Fields<'_, '_>, units: Option<usize>) -> Option<Vec<Option<String>>> {
    let Some(field) = table.read::<Vec<Spanned<String>>>(&PAIRS) else {
        return Some(vec![None; units?]);
    };
    same_count(table, &PAIRS, field.get_ref().len(), units)?;
    let names = field.into_inner().into_iter();
    Some(names.map(|name| Some(name.into_inner())).collect())
}

fn same_count(
    table: &mut Fields<'_, '_>,
    key: &'static Key,
    found: usize,
    units: Option<usize>,
) -> Option<()> {
    let units = units?;
    if found == units {
        return Some(());
    }
    let message = format!(
        "`layout.{}` has {found} entries, `layout.units` is {units}",
        key.name
    );
    let label = format!("expected {units} entries");
    table.refuse(
        key,
        Code::WrongLength,
        message,
        label,
        "one entry for each unit, clockwise from the first",
    )
}
