//! What the outputs of a flight stack send, and to which motor.

use mixer_compiler::model::PairMap;

use super::parameters::Parameters;
use super::rotors::Pulses;

/// Most outputs of a bank.
const MOST_PINS: usize = 32;

/// Pulse widths of throttle 0 and 1 as benches have them, microseconds.
pub(super) const USUAL_US: [f64; 2] = [1000.0, 2000.0];

/// Outputs of a board; pins count from 1.
pub(super) struct Bank {
    /// The parameter of a pin's function.
    pub(super) function: fn(usize) -> String,
    /// The motor, from 0, of a function.
    pub(super) motor: fn(usize) -> Option<usize>,
    /// The parameter of a pin's least (`MIN`) or largest (`MAX`) pulse.
    pub(super) end: fn(usize, &str) -> String,
}

impl Bank {
    /// The pins that drive a motor, each with the motor.
    pub(super) fn motors(&self, parameters: &Parameters) -> Vec<(usize, usize)> {
        let motor = |pin| (self.motor)(parameters.whole(&(self.function)(pin))?);
        (1..=MOST_PINS)
            .filter_map(|pin| Some((pin, motor(pin)?)))
            .collect()
    }

    /// That pins are not motors, where they are in another order.
    pub(super) fn order(&self, parameters: &Parameters) -> Option<String> {
        let motors = self.motors(parameters);
        let (pin, motor) = motors.iter().find(|(pin, motor)| pin - 1 != *motor)?;
        Some(format!(
            "`channels` counts the stack's motors, from 0, not pins: {} has motor {}, which is channel {motor}",
            (self.function)(*pin),
            motor + 1
        ))
    }

    /// The parameters of an end of these pins' pulses.
    pub(super) fn ends(&self, pins: impl Iterator<Item = usize>, end: &str) -> Vec<String> {
        pins.map(|pin| (self.end)(pin, end)).collect()
    }
}

/// The pulse widths that `names` has of `MIN` and `MAX`: of several those furthest from the usual.
pub(super) fn pulses(parameters: &Parameters, names: impl Fn(&str) -> Vec<String>) -> Option<Pulses> {
    let ends = ["MIN", "MAX"].map(|end| {
        let values = names(end)
            .into_iter()
            .filter_map(|name| Some((parameters.get(&name)?, name)));
        let usual = USUAL_US[usize::from(end == "MAX")];
        values.max_by(|(a, _), (b, _)| (a - usual).abs().total_cmp(&(b - usual).abs()))
    });
    ends.iter().any(Option::is_some).then_some(Pulses { ends })
}

/// Difference of throttles that does not matter: a microsecond or two.
const SAME_THROTTLE: f64 = 0.0025;

/// Throttles at which thrusts are compared.
const POINTS: u32 = 20;

impl Pulses {
    /// What it means that the vehicle's pulses of throttle 0 and 1 are not the bench's.
    pub(super) fn told(&self, bench_us: [f64; 2], map: Option<&PairMap>) -> Option<String> {
        let us: [f64; 2] = std::array::from_fn(|k| self.ends[k].as_ref().map_or(bench_us[k], |(us, _)| *us));
        let on_bench =
            |throttle: f64| (us[0] + throttle * (us[1] - us[0]) - bench_us[0]) / (bench_us[1] - bench_us[0]);
        if [0.0, 1.0]
            .iter()
            .all(|t| (on_bench(*t) - t).abs() < SAME_THROTTLE)
        {
            return None;
        }
        let off = map.map_or_else(String::new, |map| {
            let [min, max] = map.range();
            let thrust = |throttle: f64| map.efforts([throttle, throttle])[0];
            let throttles = (0..=POINTS).map(|k| min + (max - min) * f64::from(k) / f64::from(POINTS));
            let differences = throttles.map(|t| thrust(on_bench(t)) - thrust(t));
            let most = differences.fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most });
            format!(
                ": up to {:+.0} % of the largest thrust",
                100.0 * most / thrust(max)
            )
        });
        let said: Vec<String> = self
            .ends
            .iter()
            .flatten()
            .map(|(us, name)| format!("{name} is {us}"))
            .collect();
        let mends = self.ends.iter().zip(bench_us).filter_map(|(end, us)| {
            let (_, name) = end.as_ref().filter(|(own, _)| *own != us)?;
            Some(format!("{name} to {us}"))
        });
        Some(format!(
            "{}: throttle 0 to 1 is {:.3} to {:.3} of a bench's {} to {} us (--pwm-range){off}; set {}, unless the speed \
             controllers are calibrated to the vehicle's pulses",
            said.join(", "),
            on_bench(0.0),
            on_bench(1.0),
            bench_us[0],
            bench_us[1],
            mends.collect::<Vec<_>>().join(" and ")
        ))
    }
}

/// The length of the arms, which `whose` file does not have.
pub(super) fn arm(arm: Option<f64>, whose: &str) -> Result<f64, String> {
    match arm {
        Some(arm) if arm > 0.0 && arm.is_finite() => Ok(arm),
        Some(arm) => Err(format!("--arm {arm}: metres from the centre to a pair, above 0")),
        None => Err(format!(
            "{whose} do not have the length of the arms: --arm METRES, from the centre to a pair"
        )),
    }
}
