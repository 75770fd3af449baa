//! The air at the bench, which thrust and torque follow.
//!
//! rho = p / (287.05 T), dry. With ordinary speed controllers a rotor in thin air acts like one at a
//! lower voltage: T(u; V, s rho) = T(u; s V, rho) / s by similarity of motor and propeller, so that
//! thrust and torque follow the density to the power k - 1 where they follow the voltage to the power
//! k. A speed that the controller holds gives 1. Electrical power is V I, so that it follows s^2 less
//! than at the voltage s V.

use mixer_compiler::airframe::TYPICAL_EXPONENT;
use mixer_compiler::atmosphere::altitude_of;
use serde::Serialize;

use crate::bench::Bench;
use crate::bench::air::BenchAir;
use crate::statistics::extent;

/// Densities in flight, kg/m3, where nothing else is known, and what they are.
const IN_FLIGHT: [f64; 2] = [0.75, 1.4];
const OF_FLIGHT: &str = "in flight: 3,000 m at 40 C to sea level at -20 C";

/// Density altitude, m, from which it is asked about: 760 mm of mercury taken for hPa are the air of 2,400 m.
pub(crate) const THIN_M: f64 = 1500.0;

/// Exponent of the density where that of the voltage is the usual one.
pub const DENSITY_EXPONENT: f64 = TYPICAL_EXPONENT - 1.0;

/// The air of an identification.
#[derive(Debug, Clone, Serialize)]
pub struct Air {
    /// At the bench, or in the mean of the files, to which their rows are brought, kg/m3; none where
    /// it is not known.
    pub density_kg_m3: Option<f64>,
    /// Where it comes from.
    pub from: String,
    /// Least and greatest of the files, kg/m3.
    pub range_kg_m3: Option<[f64; 2]>,
    /// Exponents of thrust and of torque.
    pub exponents: [f64; 2],
}

impl Air {
    /// The air of files whose thrust and torque follow it by `exponents`.
    pub fn of<'a>(benches: impl IntoIterator<Item = &'a Bench>, exponents: [f64; 2]) -> Air {
        let known: Vec<&BenchAir> = benches.into_iter().filter_map(|b| b.air.as_ref()).collect();
        let densities = || known.iter().map(|k| k.density_kg_m3);
        let mean = densities().sum::<f64>() / known.len() as f64;
        let mut from: Vec<&str> = known.iter().map(|k| k.from.as_str()).collect();
        from.dedup();
        Air {
            density_kg_m3: (!known.is_empty()).then(|| (1e4 * mean).round() / 1e4),
            from: from.join(", "),
            range_kg_m3: (!known.is_empty()).then(|| extent(densities())),
            exponents,
        }
    }

    /// A question where few benches are as high: other units make such an air.
    pub(crate) fn doubt(&self) -> Option<String> {
        let altitude_m = altitude_of(self.density_kg_m3?);
        (altitude_m > THIN_M).then(|| {
            format!(
                "the air of {} is that of {altitude_m:.0} m: where the bench is not so high, a pressure in mm of mercury is 1.333 times as \
                 many hPa (--unit pressure=mmHg for a column), and a temperature may be a motor's",
                self.from
            )
        })
    }

    /// Brings the rows of a file to this density.
    pub(crate) fn bring(&self, bench: &mut Bench) {
        let own = bench.air.as_ref().map(|own| own.density_kg_m3);
        if let Some((own, reference)) = own.zip(self.density_kg_m3) {
            let [f, q] = self.exponents;
            for p in &mut bench.points {
                *p = p.divided(own / reference, [f, q, 1.5 * f - 0.5]);
            }
        }
    }

    /// `[air]`, in comments where the density is not known; with exponents where `[voltage]` has
    /// none.
    pub fn table(&self, voltage_has_exponents: bool) -> String {
        let [low, high] = IN_FLIGHT;
        let reference = self.density_kg_m3;
        let [low, high] = [
            reference.map_or(low, |r| low.min(r)),
            reference.map_or(high, |r| high.max(r)),
        ];
        let mut lines = vec![
            "[air]".to_owned(),
            match reference {
                Some(density) => {
                    let line = format!("reference_density_kg_m3 = {density:?}");
                    format!("{line:<38} # of the bench: {}", self.from)
                }
                None => format!(
                    "{:<38} # of the bench: p / (287.05 T)",
                    "reference_density_kg_m3 = ?"
                ),
            },
            format!(
                "{:<38} # {OF_FLIGHT}",
                format!("range_kg_m3 = [{low:?}, {high:?}]")
            ),
        ];
        if !voltage_has_exponents {
            let why = match self.exponents == [1.0; 2] {
                true => "the speed controllers hold a speed",
                false => "of the voltage less 1; 1 where the controllers hold a speed",
            };
            let names = ["thrust_exponent", "torque_exponent"].into_iter();
            lines.extend(names.zip(self.exponents).map(|(name, e)| {
                let line = format!("{name} = {:?}", (1e3 * e).round() / 1e3);
                format!("{line:<38} # {why}")
            }));
        }
        match reference {
            Some(_) => lines
                .iter()
                .fold("\n".to_owned(), |text, line| text + line + "\n"),
            None => lines
                .iter()
                .fold(TO_FILL_IN.to_owned(), |text, line| text + "# " + line + "\n"),
        }
    }
}

impl Default for Air {
    /// Not known, with the usual exponents.
    fn default() -> Air {
        Air::of([], [DENSITY_EXPONENT; 2])
    }
}

const TO_FILL_IN: &str = "\n# No [air]: the mixer takes the bench's air at any altitude and temperature; at 3,000 m thrust is 20 % short.\n\
                          # To follow it, fill in what is open and uncomment: p is the pressure at the place, Pa, not that reduced\n\
                          # to sea level, T in K. (--temperature and --pressure of `identify` and `predict` do it.)\n";
