//! What the outputs of a flight stack send, and to which motor.

use mixer_compiler::model::PairMap;

use super::parameters::Parameters;
use super::rotors::Pulses;

/// Most outputs of a bank.
const MOST_PINS: usize = 32;

/// Pulse widths of throttle 0 and 1, microseconds: the defaults of both stacks, and of a bench.
pub const USUAL_US: [f64; 2] = [1000.0, 2000.0];

/// The outputs of a board: the parameter of what pin `#` drives, the values of it for motors, from
/// motor 1 on, as firsts and lasts, and the parameter of a pin's pulses, `{}` being MIN or MAX.
type Bank = (&'static str, &'static [[usize; 2]], &'static str);

/// Of ArduPilot's servos pulses do not count: the motors have their own.
const BANKS: [Bank; 3] = [
    ("SERVO#_FUNCTION", &[[33, 40], [82, 85]], ""),
    ("PWM_MAIN_FUNC#", &[[101, 112]], "PWM_MAIN_{}#"),
    ("PWM_AUX_FUNC#", &[[101, 112]], "PWM_AUX_{}#"),
];

/// The pulses of all motors, PX4's before 1.13, and those of ArduPilot.
const OF_ALL: [&str; 5] = ["PWM_{}", "PWM_MAIN_{}", "PWM_AUX_{}", "MOT_PWM_{}", "Q_M_PWM_{}"];

fn numbered(name: &str, pin: usize) -> String {
    name.replace('#', &pin.to_string())
}

/// The pins of a bank that drive a motor, from 1, each with the motor, from 0.
fn motors((function, motors, _): Bank, parameters: &Parameters) -> Vec<(usize, usize)> {
    let motor = |pin: usize| {
        let function = parameters.whole(&numbered(function, pin))?;
        let mut functions = motors.iter().flat_map(|[first, last]| *first..=*last);
        Some((pin, functions.position(|of_motor| of_motor == function)?))
    };
    (1..=MOST_PINS).filter_map(motor).collect()
}

/// The pins of ArduPilot's board that drive a motor, from 1, each with the motor, from 0.
pub(super) fn servos(parameters: &Parameters) -> Vec<(usize, usize)> {
    motors(BANKS[0], parameters)
}

/// That pins are not motors, where they are in another order.
pub(super) fn order(parameters: &Parameters) -> Option<String> {
    BANKS.into_iter().find_map(|bank| {
        let motors = motors(bank, parameters);
        let (pin, motor) = motors.iter().find(|(pin, motor)| pin - 1 != *motor)?;
        Some(format!(
            "`channels` counts the stack's motors, from 0, not pins: {} has motor {}, which is channel {motor}",
            numbered(bank.0, *pin),
            motor + 1
        ))
    })
}

/// Motors, from 0, whose pins have pulses of their own, each with the widths of throttle 0 and 1, us.
pub(super) fn own_pulses(parameters: &Parameters) -> Vec<(usize, [f64; 2])> {
    let banks = BANKS.into_iter().filter(|bank| !bank.2.is_empty());
    let pins = banks.flat_map(|bank| motors(bank, parameters).into_iter().map(move |of| (bank.2, of)));
    pins.map(|(name, (pin, motor))| {
        let name = numbered(name, pin);
        let end = |end: &str, usual: f64| parameters.or(&name.replace("{}", end), usual);
        (motor, [end("MIN", USUAL_US[0]), end("MAX", USUAL_US[1])])
    })
    .collect()
}

/// Whether a parameter says that the motors are driven by DShot: ArduPilot's `MOT_PWM_TYPE` of 4 and more,
/// PX4's `PWM_MAIN_TIMn` of -2 and less.
pub(super) fn is_dshot(name: &str, value: f64) -> bool {
    let is_timer = name.starts_with("PWM_") && name.contains("_TIM");
    (name.ends_with("PWM_TYPE") && value >= 4.0) || (is_timer && value < -1.0)
}

/// The pulse widths of throttle 0 and 1, of several that a file has those furthest from the usual;
/// of all pins where no function is said. DShot has none. Those that other parameters say are not looked at, and
/// are `Err`, a note (`AP_MotorsMulticopter::get_pwm_output_min`, `update_throttle_range`).
pub(super) fn pulses(parameters: &Parameters) -> Result<Option<Pulses>, String> {
    for name in parameters.names() {
        let value = parameters.or(name, 0.0);
        let is_type = name.ends_with("PWM_TYPE");
        let is_end = name.ends_with("PWM_MIN") || name.ends_with("PWM_MAX");
        if (is_type && value == 8.0) || (is_end && value == 0.0) {
            return Err(format!(
                "{name} is {value}: the pulses are those of other parameters, of the throttle stick (RC3_MIN, RC3_MAX) or the \
                 servos (SERVOn_MIN, SERVOn_MAX); compare them with the bench's"
            ));
        }
        if is_dshot(name, value) {
            return Ok(None);
        }
    }
    let of_pins = |is_of_motor: bool| {
        BANKS.into_iter().flat_map(move |bank| {
            let motors = motors(bank, parameters);
            let pins =
                (1..=MOST_PINS).filter(move |pin| !is_of_motor || motors.iter().any(|(of, _)| of == pin));
            pins.map(move |pin| numbered(bank.2, pin))
        })
    };
    let is_said = of_pins(true).next().is_some();
    let names = OF_ALL.into_iter().map(str::to_owned).chain(of_pins(is_said));
    let names: Vec<String> = names.collect();
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
    Ok((!pulses.said.is_empty()).then_some(pulses))
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
            "{}: throttle 0 to 1 is {:.3} to {:.3} of a bench's {low} to {high} us (--pwm-range){off}; set the pulses to {low} and {high}, \
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
