//! The range of thrust without torques, by the mixer itself: a frame that cannot hover is refused.

use mixer_rt::{Conditions, Wrench};

use crate::airframe::{Airframe, Spin};
use crate::diagnostic::{Code, Diagnostic};
use crate::tables::MixerTables;

/// Halvings of the thrusts between one that is delivered and one that is not.
const HALVINGS: usize = 20;

/// Thrusts that are tried, from 0 to more than all units give.
const STEPS: usize = 128;

/// Least and largest thrust without roll, pitch and yaw, N at the reference voltage, that the tables
/// deliver.
///
/// # Errors
/// A layout that cannot hover: at no thrust the served torques vanish.
pub(crate) fn thrust_range(airframe: &Airframe, tables: &MixerTables) -> Result<[f32; 2], Vec<Diagnostic>> {
    let volts = airframe.reference_v() as f32;
    let is_delivered = |thrust_n: f32| is_level(airframe, tables, thrust_n, Conditions::at_voltage(volts));
    longest_run(tables, &is_delivered).ok_or_else(|| vec![no_hover(airframe)])
}

/// Whether a thrust is delivered without torques.
fn is_level(airframe: &Airframe, tables: &MixerTables, thrust_n: f32, conditions: Conditions) -> bool {
    let mixed = tables.mix(&Wrench::from_array([0.0, 0.0, 0.0, thrust_n]), conditions);
    let mut axes = airframe.allocation.axes.iter();
    mixed.is_ok_and(|(_, _, saturation)| axes.all(|axis| !saturation.is_flagged(*axis)))
}

/// The fault of a frame that cannot hover: nothing balances the torque of single rotors of which more turn one way.
fn no_hover(airframe: &Airframe) -> Diagnostic {
    let message = "no thrust is attainable without roll, pitch or yaw";
    for spin in Spin::ALL {
        let of = |spin| {
            let units = airframe.units.iter().enumerate();
            units.filter(move |(_, unit)| unit.lower_channel.is_none() && unit.upper_spin == spin)
        };
        if let Some((last, _)) = of(spin).skip(of(spin.reversed()).count() + 1).last() {
            let outputs: Vec<String> = of(spin).map(|(_, unit)| unit.upper_channel.to_string()).collect();
            return airframe.diagnostic(
                Code::Hover,
                &format!("unit[{last}].upper_spin"),
                format!(
                    "{message}: the single rotors on outputs {} turn {}",
                    outputs.join(", "),
                    spin.in_words()
                ),
                "",
                format!(
                    "write `upper_spin = \"{}\"` in one of their units",
                    spin.reversed().name()
                ),
            );
        }
    }
    airframe.diagnostic(
        Code::Hover,
        "unit",
        message,
        "",
        "check positions, spins and thrust axes: the units must balance each other, each with a torque near zero",
    )
}

/// Level flight at both ends of the ranges of voltage and density: where thrust and torque follow these by other powers,
/// a frame that is balanced on the bench may not be there. `level_n` is the range at the reference.
///
/// # Errors
/// No thrust is delivered without torques at an end.
pub(crate) fn check_ends(
    airframe: &Airframe,
    tables: &MixerTables,
    level_n: [f32; 2],
) -> Result<(), Vec<Diagnostic>> {
    let middle_n = 0.5 * (level_n[0] + level_n[1]);
    for end in [0, 1] {
        let [volts, density] = [&airframe.voltage, &airframe.air].map(|correction| {
            correction
                .as_ref()
                .map_or(0.0, |correction| correction.range[end])
        });
        let conditions = Conditions::at_voltage(volts as f32).in_air(density as f32);
        let factor = airframe.factors(volts, density)[0] as f32;
        let is_delivered = |thrust_n: f32| is_level(airframe, tables, factor * thrust_n, conditions);
        if is_delivered(middle_n) || longest_run(tables, &is_delivered).is_some() {
            continue;
        }
        let at = [(&airframe.voltage, volts, "V"), (&airframe.air, density, "kg/m3")]
            .into_iter()
            .filter(|(correction, ..)| correction.is_some())
            .map(|(_, value, unit)| format!("{value} {unit}"));
        let at: Vec<String> = at.collect();
        return Err(vec![airframe.diagnostic(
            Code::Hover,
            if airframe.voltage.is_some() { "voltage.range_v" } else { "air.range_kg_m3" },
            format!("at {} no thrust is attainable without roll, pitch or yaw", at.join(" and ")),
            "an end of the ranges",
            "thrust and torque follow voltage and density by other powers, and the units no longer balance each other there: \
             narrow the ranges, or check exponents, spins and thrust axes",
        )]);
    }
    Ok(())
}

/// Least and largest thrust without torques, N at the bench's voltage and density, that least norm
/// delivers under all conditions. Both are 0 where there is none.
pub(crate) fn level(airframe: &Airframe, tables: &MixerTables) -> [f32; 2] {
    let conditions = airframe.conditions();
    let factors: Vec<[f64; 2]> = conditions
        .iter()
        .map(|[v, rho]| airframe.factors(*v, *rho))
        .collect();
    let is_delivered = |thrust_n: f32| {
        factors.iter().all(|factors| {
            let wrench = [0.0, 0.0, 0.0, factors[0] as f32 * thrust_n];
            tables.least_norm(wrench, *factors).is_some()
        })
    };
    longest_run(tables, &is_delivered).unwrap_or_default()
}

/// The ends of the longest run of thrusts that are delivered, N.
fn longest_run(tables: &MixerTables, is_delivered: &dyn Fn(f32) -> bool) -> Option<[f32; 2]> {
    let full = |unit| tables.efforts_of(unit, [tables.throttle.max; 2])[0];
    let units = tables.units.iter().enumerate();
    let most: f32 = units
        .map(|(index, unit)| unit.effectiveness[0][3] * full(index))
        .sum();
    let at = |step: usize| most * step as f32 / STEPS as f32;
    let mut best = 0..0;
    let mut first = 0;
    for step in 0..=STEPS {
        if !is_delivered(at(step)) {
            first = step + 1;
        } else if step + 1 - first > best.len() {
            best = first..step + 1;
        }
    }
    let last = best.end.checked_sub(1)?;
    let end = |mut inside: f32, mut outside: f32| {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if is_delivered(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        inside
    };
    Some([
        end(at(best.start), at(best.start) - at(1)),
        end(at(last), at(best.end)),
    ])
}
