//! What the outputs of a flight stack send, and to which motor.

use mixer_compiler::model::PairMap;

use super::parameters::Parameters;
use super::rotors::Pulses;

/// Most outputs of a bank.
const MOST_PINS: usize = 32;

/// Pulse widths of throttle 0 and 1, microseconds: the defaults of both stacks, and of a bench.
pub(super) const USUAL_US: [f64; 2] = [1000.0, 2000.0];

/// Parameters of the outputs of a board; `#` is the number of a pin, from 1.
pub(super) struct Bank {
    /// What a pin drives.
    pub(super) function: &'static str,
    /// The values of it for motors, from motor 1 on: firsts and lasts.
    pub(super) motors: &'static [[usize; 2]],
}

impl Bank {
    /// The pins that drive a motor, from 1, each with the motor, from 0.
    pub(super) fn motors(&self, parameters: &Parameters) -> Vec<(usize, usize)> {
        let motor = |pin: usize| {
            let function = parameters.whole(&numbered(self.function, pin))?;
            let mut functions = self.motors.iter().flat_map(|[first, last]| *first..=*last);
            Some((pin, functions.position(|of_motor| of_motor == function)?))
        };
        (1..=MOST_PINS).filter_map(motor).collect()
    }

    /// That pins are not motors, where they are in another order.
    pub(super) fn order(&self, parameters: &Parameters) -> Option<String> {
        let motors = self.motors(parameters);
        let (pin, motor) = motors.iter().find(|(pin, motor)| pin - 1 != *motor)?;
        Some(format!(
            "`channels` counts the stack's motors, from 0, not pins: {} has motor {}, which is channel {motor}",
            numbered(self.function, *pin),
            motor + 1
        ))
    }
}

/// The parameter of a pin.
pub(super) fn numbered(name: &str, pin: usize) -> String {
    name.replace('#', &pin.to_string())
}

/// The pulse widths of throttle 0 and 1 by parameters named `MIN` and `MAX` in place of `{}`; of
/// several that a file has those furthest from the usual.
pub(super) fn pulses(parameters: &Parameters, names: &[String]) -> Option<Pulses> {
    let mut pulses = Pulses {
        us: USUAL_US,
        said: Vec::new(),
    };
    for (us, end) in pulses.us.iter_mut().zip(["MIN", "MAX"]) {
        let usual = *us;
        let named = names.iter().map(|name| name.replace("{}", end));
        let values = named.filter_map(|name| Some((parameters.get(&name)?, name)));
        if let Some((value, name)) =
            values.max_by(|(a, _), (b, _)| (a - usual).abs().total_cmp(&(b - usual).abs()))
        {
            *us = value;
            pulses.said.push(format!("{name} is {value}"));
        }
    }
    (!pulses.said.is_empty()).then_some(pulses)
}

/// Difference of throttles that does not matter: a microsecond or two.
const SAME_THROTTLE: f64 = 0.0025;

/// Throttles at which thrusts are compared.
const POINTS: u32 = 20;

impl Pulses {
    /// What it means that the vehicle's pulses of throttle 0 and 1 are not the bench's.
    pub(super) fn told(&self, bench_us: [f64; 2], map: Option<&PairMap>) -> Option<String> {
        let [low, high] = bench_us;
        let on_bench =
            |throttle: f64| (self.us[0] + throttle * (self.us[1] - self.us[0]) - low) / (high - low);
        let ends = [0.0, 1.0].map(on_bench);
        if ends[0].abs() < SAME_THROTTLE && (ends[1] - 1.0).abs() < SAME_THROTTLE {
            return None;
        }
        let off = map.map_or_else(String::new, |map| {
            let [min, max] = map.range();
            let thrust = |throttle: f64| map.efforts([throttle, throttle])[0];
            let throttles = (0..=POINTS).map(|k| min + (max - min) * f64::from(k) / f64::from(POINTS));
            let differences = throttles.map(|t| thrust(on_bench(t)) - thrust(t));
            let most = differences.max_by(|a, b| a.abs().total_cmp(&b.abs()));
            let share = 100.0 * most.unwrap_or_default() / thrust(max);
            format!(": up to {share:+.0} % of the largest thrust")
        });
        Some(format!(
            "{}: throttle 0 to 1 is {:.3} to {:.3} of a bench's {low} to {high} us (--pwm-range){off}; set {low} and {high}, \
             unless the speed controllers are calibrated to the vehicle's pulses",
            self.said.join(", "),
            ends[0],
            ends[1],
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
