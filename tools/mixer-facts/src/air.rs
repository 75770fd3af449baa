//! The vehicle in thin air: what the standard atmosphere leaves of its thrust.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Airframe, Law};
use mixer_compiler::atmosphere::{SEA_LEVEL_KG_M3, TOP_M, altitude_of, density_at};
use mixer_rt::Wrench;
use serde::Serialize;

/// Altitudes at which the vehicle is looked at, m.
pub const ALTITUDES_M: [f64; 3] = [0.0, 1500.0, 3000.0];

/// Thrust over weight at the ceiling: what is above 1 climbs, ends a descent and turns.
pub const LEAST_THRUST_OVER_WEIGHT: f64 = 1.3;

/// Exponents of the density that ordinary speed controllers have: others are not concluded from the
/// voltage's.
const ORDINARY: std::ops::RangeInclusive<f64> = 0.4..=1.05;

/// The law that thrust and torque follow in the air's density, and the vehicle by it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Air {
    /// Density of the bench, kg/m^3; without `[air]` that of the standard atmosphere at the sea.
    pub reference_density_kg_m3: f64,
    /// Density in flight, kg/m^3; `None` without `[air]`: the mixer then corrects for none.
    pub range_kg_m3: Option<[f64; 2]>,
    /// Powers of the density that thrust and torque follow.
    pub exponents: [f64; 2],
    /// Where each comes from, in words.
    pub exponents_from: [&'static str; 2],
    /// The vehicle at [`ALTITUDES_M`]; empty where the file has no mass.
    pub altitudes: Vec<AtAltitude>,
    /// Altitude of the standard atmosphere at which thrust over weight falls to
    /// [`LEAST_THRUST_OVER_WEIGHT`], m; `None` where that is below the sea or above [`TOP_M`], or where
    /// the file has no mass.
    pub ceiling_m: Option<f64>,
}

/// The vehicle at an altitude of the standard atmosphere and the reference voltage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtAltitude {
    /// Above the sea, m.
    pub altitude_m: f64,
    /// Density there, kg/m^3.
    pub density_kg_m3: f64,
    /// Mean throttle of all rotors that carries the weight; `None` where none does.
    pub hover_throttle: Option<f64>,
    /// Largest bare thrust over weight.
    pub thrust_over_weight: f64,
}

impl Air {
    /// The law of a compiled airframe; `None` where the file has neither `[air]` nor a `[voltage]` from
    /// which it follows.
    pub fn new(compiled: &Compiled) -> Option<Air> {
        let airframe = &compiled.airframe;
        let by_voltage = || {
            let exponents = airframe.voltage.as_ref()?.exponents().map(|k| k - 1.0);
            let is_ordinary = exponents.iter().all(|e| ORDINARY.contains(e));
            is_ordinary.then_some((SEA_LEVEL_KG_M3, None, exponents))
        };
        let (reference_density_kg_m3, range_kg_m3, exponents) = match &airframe.air {
            Some(air) => (air.reference, Some(air.range), air.exponents()),
            None => by_voltage()?,
        };
        let mut air = Air {
            reference_density_kg_m3,
            range_kg_m3,
            exponents,
            exponents_from: sources(airframe),
            altitudes: Vec::new(),
            ceiling_m: None,
        };
        if let Some(weight_n) = airframe.weight_n() {
            let most = f64::from(compiled.thrust_range_n[1]) / weight_n;
            let at = ALTITUDES_M.map(|altitude| air.at(compiled, altitude, [weight_n, most]));
            air.altitudes = at.to_vec();
            // Thrust over weight is `most` times a power of the density.
            let share = libm::pow(LEAST_THRUST_OVER_WEIGHT / most, 1.0 / air.exponents[0]);
            let ceiling = altitude_of(share * air.reference_density_kg_m3);
            air.ceiling_m = Some(ceiling).filter(|ceiling| (0.0..=TOP_M).contains(ceiling));
        }
        Some(air)
    }

    /// Thrust at a density over that at the reference.
    pub fn thrust_factor(&self, density_kg_m3: f64) -> f64 {
        libm::pow(density_kg_m3 / self.reference_density_kg_m3, self.exponents[0])
    }

    /// A vehicle of a weight, N, and of a thrust over weight at the reference.
    fn at(&self, compiled: &Compiled, altitude_m: f64, [weight_n, most]: [f64; 2]) -> AtAltitude {
        let density_kg_m3 = density_at(altitude_m);
        let factor = self.thrust_factor(density_kg_m3);
        // By the reference's tables: the mixer's own law ends with its range.
        let setpoint = Wrench {
            thrust_n: (weight_n / factor) as f32,
            ..Wrench::default()
        };
        let volts = compiled.airframe.reference_v() as f32;
        let mixed = compiled.tables.mix(&setpoint, volts).ok();
        let delivered = mixed.filter(|(.., saturation)| !saturation.any_axis());
        let mean =
            |throttle: Vec<f32>| throttle.iter().copied().map(f64::from).sum::<f64>() / throttle.len() as f64;
        AtAltitude {
            altitude_m,
            density_kg_m3,
            hover_throttle: delivered.map(|(throttle, ..)| mean(throttle)),
            thrust_over_weight: factor * most,
        }
    }
}

/// Where the exponents of thrust and torque come from.
fn sources(airframe: &Airframe) -> [&'static str; 2] {
    let voltage = airframe.voltage.as_ref();
    let source = |key: &str, law: Option<&Law>| match law {
        Some(Law::Exponent(_)) if !airframe.states(key) => "the voltage's less 1",
        Some(Law::Points(_)) if !airframe.states(key) => "least squares of the voltage's points less 1",
        _ => "declared",
    };
    [
        source("air.thrust_exponent", voltage.map(|voltage| &voltage.thrust)),
        source("air.torque_exponent", voltage.map(|voltage| &voltage.torque)),
    ]
}
