//! Probes of what is emitted: the tables are run through `mixer-rt` and compared with the physics of
//! the airframe file in f64.
//!
//! The proof holds for the inverse map of one unit. M+, the sides of the closed form, channels and
//! signs come after it. A fault of the compiler in any of these gives an airframe that
//! compiles and flies wrong, so the whole mixer is tried before the compiler says yes:
//!
//! ```text
//! sides       points on the sides of the closed form are attainable; no more area is lost than stated
//! wrenches    each axis both ways and mixtures, small and large, at three thrusts, and at the ends of
//!             the voltage range
//! rotors out  every rotor alone, and pairs of rotors: level flight and torques from there
//! ```
//!
//! A wrench is delivered, or flagged and, with one rotor out at most, sound: no torque reversed or exceeded, the direction of
//! (roll, pitch) kept, and with airmode disabled and all rotors no more thrust than asked. It has to be delivered
//! where the throttles of least norm are well inside their range. The physics ([`physics`])
//! know nothing of M: they add forces and torques unit by unit.

mod physics;
mod sides;

use mixer_rt::tables::Airmode;
use mixer_rt::{Axis, Health, Wrench};

use crate::airframe::Airframe;
use crate::diagnostic::{Code, Diagnostic};
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::tables::MixerTables;
use physics::Physics;

/// Share of an axis' authority by which a flagged wrench may be exceeded, reversed or off its
/// direction. Faults of the tables are off by more. Curves of single rotors, and level flight of tilted
/// axes at voltages beside the reference, are met to a few tenths of a percent.
const SOUND: f64 = 1e-2;

/// Thrusts that are probed, as shares of the range of level flight.
const THRUSTS: [f64; 3] = [0.2, 0.5, 0.8];

/// Sizes of the torques, as shares of the authority: one that most frames deliver, one that none
/// does.
const SIZES: [f64; 2] = [0.2, 1.0];

/// Signs of roll, pitch and yaw: each axis both ways, then mixtures.
const DIRECTIONS: [[f64; 3]; 14] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, 1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [-1.0, -1.0, -1.0],
];

/// Distance from idle and from the ceiling, as a share of the range, from which a throttle is well
/// inside.
const INSIDE: f32 = 0.05;

/// Most pairs of rotors out that are probed, taken evenly from all.
const MOST_PAIRS: usize = 28;

/// The emitted tables with what they are judged by.
pub(crate) struct Probe<'a> {
    /// The airframe.
    pub(crate) airframe: &'a Airframe,
    /// M and M+.
    pub(crate) effectiveness: &'a Effectiveness,
    /// The map of every unit in f64.
    pub(crate) pair: &'a PairMap,
    /// What is emitted.
    pub(crate) tables: &'a MixerTables,
    /// Least and largest thrust of level flight at the reference voltage, N.
    pub(crate) thrust_range_n: [f32; 2],
    /// Share of the attainable set's area that the sides of the closed form lose.
    pub(crate) lost_between_sides: Option<f64>,
}

/// The map of every unit in f64.
struct UnitModel<'a> {
    map: &'a PairMap,
    /// Its largest thrust, N, and torque, N m: [`PairMap::scale`], which looks along the whole border.
    scale: [f64; 2],
}

impl Probe<'_> {
    /// Runs the probes.
    ///
    /// # Errors
    /// The first one that fails: a fault of the compiler.
    pub(crate) fn run(&self) -> Result<(), Vec<Diagnostic>> {
        let unit = &UnitModel {
            map: self.pair,
            scale: self.pair.scale(),
        };
        self.sides(unit)
            .and_then(|()| self.whole(unit))
            .and_then(|()| self.rotors_out(unit))
            .map_err(|message| {
                vec![self.airframe.diagnostic(
                    Code::Probe,
                    "name",
                    message,
                    "",
                    "this is a fault of the compiler, not of the file: please report it with the file",
                )]
            })
    }

    /// Wrenches with all rotors.
    fn whole(&self, unit: &UnitModel<'_>) -> Result<(), String> {
        for (volts, thrusts) in self.points() {
            let at = At::new(self, unit, volts, Health::GOOD);
            for &share in thrusts {
                let thrust = at.thrust(share);
                at.probe([0.0, 0.0, 0.0, thrust])?;
                for (size, direction) in SIZES.iter().flat_map(|size| DIRECTIONS.map(|d| (size, d))) {
                    let [roll, pitch, yaw] =
                        [0, 1, 2].map(|axis| size * direction[axis] * at.authority[axis]);
                    at.probe([roll, pitch, yaw, thrust])?;
                }
            }
        }
        Ok(())
    }

    /// Wrenches with one and with two rotors out, where the others keep the frame level.
    fn rotors_out(&self, unit: &UnitModel<'_>) -> Result<(), String> {
        let rotors = self.airframe.rotors() as u8;
        let singles = (0..rotors).map(|rotor| Health::GOOD.with_failed(rotor));
        let pairs: Vec<Health> = (0..rotors)
            .flat_map(|first| (first + 1..rotors).map(move |second| (first, second)))
            .map(|(first, second)| Health::GOOD.with_failed(first).with_failed(second))
            .collect();
        let step = pairs.len().div_ceil(MOST_PAIRS).max(1);
        for health in singles.chain(pairs.into_iter().step_by(step)) {
            let at = At::new(self, unit, self.airframe.reference_v(), health);
            let level = [0.0, 0.0, 0.0, at.thrust(0.4)];
            if !at.probe(level)? {
                continue;
            }
            for [roll, pitch, yaw] in [[1.0, -1.0, 1.0], [0.0, 0.0, -1.0]] {
                let [p, q, r, _] = at.authority;
                at.probe([0.2 * roll * p, 0.2 * pitch * q, 0.2 * yaw * r, level[3]])?;
            }
        }
        Ok(())
    }

    /// Voltages (V) with the thrusts that are probed there: all in the middle of the range, one at its
    /// ends.
    fn points(&self) -> Vec<(f64, &'static [f64])> {
        let range = self.airframe.voltage.as_ref().map(|voltage| voltage.range_v);
        range.map_or(vec![(0.0, &THRUSTS[..])], |[low, high]| {
            vec![
                (low, &THRUSTS[1..2]),
                (0.5 * (low + high), &THRUSTS),
                (high, &THRUSTS[1..2]),
            ]
        })
    }
}

/// The mixer at one voltage with some rotors out.
struct At<'a> {
    probe: &'a Probe<'a>,
    physics: Physics<'a>,
    volts: f64,
    health: Health,
    /// `[k_f, k_Q]`.
    factors: [f64; 2],
    /// The most of each axis with all rotors, N m and N.
    authority: [f64; 4],
}

impl<'a> At<'a> {
    fn new(probe: &'a Probe<'a>, unit: &'a UnitModel, volts: f64, health: Health) -> Self {
        let factors = probe.airframe.voltage_factors(volts);
        let efforts = [0, 1].map(|k| factors[k] * unit.scale[k]);
        At {
            probe,
            physics: Physics {
                airframe: probe.airframe,
                map: unit.map,
            },
            volts,
            health,
            factors,
            authority: [0, 1, 2, 3].map(|axis| probe.effectiveness.largest(axis, efforts)),
        }
    }

    /// The thrust at a share of the range of level flight, N.
    fn thrust(&self, share: f64) -> f64 {
        let [least, most] = self.probe.thrust_range_n.map(f64::from);
        self.factors[0] * (least + share * (most - least))
    }

    /// Mixes a wrench `[roll, pitch, yaw, thrust]`, N m and N. True where it is delivered.
    ///
    /// # Errors
    /// What is wrong with the answer.
    fn probe(&self, asked: [f64; 4]) -> Result<bool, String> {
        let Probe { airframe, tables, .. } = self.probe;
        let asked = asked.map(|x| x as f32);
        let setpoint = Wrench::from_array(asked);
        let fault = |what: String| {
            let mut out = String::new();
            for channel in self.failed() {
                out += &format!(", rotor {channel} out");
            }
            let volts = if airframe.voltage.is_some() {
                format!(" at {:.2} V", self.volts)
            } else {
                String::new()
            };
            format!(
                "the emitted mixer fails a probe: asked {}{volts}{out}, {what}",
                words(&asked.map(f64::from))
            )
        };
        let (throttle, achieved, saturation) = tables
            .mix_with_health(&setpoint, self.volts as f32, self.health)
            .map_err(|error| fault(error.to_string()))?;
        for (channel, &throttle) in throttle.iter().enumerate() {
            let allowed = if self.health.has_failed(channel as u8) {
                throttle == 0.0
            } else {
                (tables.throttle.min..=tables.throttle.max).contains(&throttle)
            };
            if !allowed {
                return Err(fault(format!("output {channel} gets {throttle}")));
            }
        }
        let given = self.physics.wrench(&throttle, self.factors, self.health);
        let (asked, achieved) = (asked.map(f64::from), achieved.to_array().map(f64::from));
        let tolerance = tables.tolerance.wrench.map(f64::from);
        let served = || {
            Axis::ALL
                .into_iter()
                .filter(|axis| airframe.allocation.controls(*axis))
        };
        let is_inside = self.health.is_good() && self.is_inside(setpoint);
        let mut is_level = true;
        for axis in served() {
            let k = axis as usize;
            let is_true = (given[k] - achieved[k]).abs() <= tolerance[k];
            if !is_true {
                return Err(fault(format!(
                    "reported {}, given {}",
                    words(&achieved),
                    words(&given)
                )));
            }
            let is_flagged = saturation.is_flagged(axis);
            is_level &= !is_flagged;
            if !is_flagged && (given[k] - asked[k]).abs() > 2.0 * tolerance[k] {
                return Err(fault(format!("given {} without a flag on {axis}", words(&given))));
            }
            if is_flagged && is_inside {
                return Err(fault(format!(
                    "given {}, although all units could",
                    words(&given)
                )));
            }
        }
        // With one rotor out torques are sound where level flight at the thrust asked is attainable; the
        // caller goes on from there. With two they are all but always, which is no proof of a fault.
        let is_promised = self.health.is_good() || is_level || asked[..3] != [0.0; 3];
        if is_promised
            && self.failed().count() <= 1
            && let Some(axis) = self.unsound(&asked, &given)
        {
            return Err(fault(format!(
                "given {}: {axis} is exceeded, reversed or off its direction",
                words(&given)
            )));
        }
        Ok(is_level)
    }

    /// Outputs of the rotors that are out.
    fn failed(&self) -> impl Iterator<Item = u8> {
        let rotors = 0..self.probe.airframe.rotors() as u8;
        rotors.filter(|&channel| self.health.has_failed(channel))
    }

    /// True where the throttles of least norm are well inside their range: such a wrench is delivered.
    fn is_inside(&self, setpoint: Wrench) -> bool {
        let tables = self.probe.tables;
        let range = &tables.throttle;
        let margin = INSIDE * (range.max - range.min);
        let inside = range.min + margin..=range.max - margin;
        let throttles = tables.least_norm(setpoint.to_array(), self.factors);
        throttles.is_some_and(|units| {
            units
                .as_flattened()
                .iter()
                .all(|throttle| inside.contains(throttle))
        })
    }

    /// An axis on which a wrench is not within what was asked.
    fn unsound(&self, asked: &[f64; 4], given: &[f64; 4]) -> Option<Axis> {
        let allocation = &self.probe.airframe.allocation;
        let is_whole = self.health.is_good();
        let room = |axis: Axis| {
            let tolerance = self.probe.tables.tolerance.wrench[axis as usize];
            f64::from(tolerance) + SOUND * self.authority[axis as usize]
        };
        let is_beyond = |axis: &Axis| {
            let (asked, given) = (asked[*axis as usize], given[*axis as usize]);
            if *axis == Axis::Thrust {
                // Level flight with rotors out may need more thrust than is asked.
                let may_rise = allocation.airmode != Airmode::Disabled || !is_whole;
                return !may_rise && given > asked + room(*axis);
            }
            given > asked.max(0.0) + room(*axis) || given < asked.min(0.0) - room(*axis)
        };
        let served = |axis: &Axis| allocation.controls(*axis);
        if let Some(axis) = Axis::ALL.into_iter().filter(served).find(is_beyond) {
            return Some(axis);
        }
        let [roll, pitch] = [Axis::Roll, Axis::Pitch];
        let size = libm::hypot(asked[0], asked[1]);
        let across = (asked[0] * given[1] - asked[1] * given[0]).abs();
        let is_off = served(&roll) && served(&pitch) && across > size * room(roll).max(room(pitch));
        is_off.then_some(roll)
    }
}

/// A wrench in words.
fn words([roll, pitch, yaw, thrust]: &[f64; 4]) -> String {
    format!("roll {roll:.4} N m, pitch {pitch:.4} N m, yaw {yaw:.4} N m, thrust {thrust:.3} N")
}

#[cfg(test)]
mod tests;
