//! What the outputs of a flight stack send, and to which motor.

use mixer_compiler::model::PairMap;

use super::parameters::Parameters;
use super::rotors::Pulses;

/// Most outputs of a bank.
const MOST_PINS: usize = 32;

/// Pulse widths of throttle 0 and 1, microseconds: the defaults of both stacks, and of a bench.
pub const USUAL_US: [f64; 2] = [1000.0, 2000.0];

/// An output that drives a motor.
struct Output {
    /// What its parameters begin with: `SERVO`, `PWM_MAIN`, `UAVCAN_EC`.
    bank: String,
    /// From 1.
    pin: usize,
    /// From 0.
    motor: usize,
    /// The parameter that says so.
    name: String,
}

/// Values of ArduPilot's `SERVOn_FUNCTION` for motors, from motor 1 on, as firsts and lasts; those of PX4's outputs,
/// which are `PREFIX_FUNCn` for every driver (`PWM_MAIN`, `UAVCAN_EC`, `VOXL_ESC`).
const ARDUPILOT_MOTORS: &[[usize; 2]] = &[[33, 40], [82, 85]];
const PX4_MOTORS: &[[usize; 2]] = &[[101, 112]];

/// The pulses of all motors, PX4's before 1.13, and those of ArduPilot; of ArduPilot's servos they do not count.
const OF_ALL: [&str; 5] = ["PWM_{}", "PWM_MAIN_{}", "PWM_AUX_{}", "MOT_PWM_{}", "Q_M_PWM_{}"];

/// The outputs that drive motors, by bank and pin.
fn outputs(parameters: &Parameters) -> Vec<Output> {
    let output = |name: &str| {
        let ardupilot = name
            .strip_prefix("SERVO")
            .and_then(|rest| rest.strip_suffix("_FUNCTION"));
        let (bank, pin, motors) = match (ardupilot, name.split_once("_FUNC")) {
            (Some(pin), _) => ("SERVO", pin, ARDUPILOT_MOTORS),
            (None, Some((bank, pin))) => (bank, pin, PX4_MOTORS),
            (None, None) => return None,
        };
        let (bank, pin) = (bank.to_owned(), pin.parse().ok().filter(|_| is_number(pin))?);
        let function = parameters.whole(name)?;
        let mut functions = motors.iter().flat_map(|[first, last]| *first..=*last);
        let motor = functions.position(|of_motor| of_motor == function)?;
        let name = name.to_owned();
        Some(Output {
            bank,
            pin,
            motor,
            name,
        })
    };
    let mut outputs: Vec<Output> = parameters.names().filter_map(output).collect();
    outputs.sort_by(|a, b| (&a.bank, a.pin).cmp(&(&b.bank, b.pin)));
    outputs
}

/// The pins of ArduPilot's board that drive a motor, from 1, each with the motor, from 0.
pub(crate) fn servos(parameters: &Parameters) -> Vec<(usize, usize)> {
    let outputs = outputs(parameters).into_iter();
    let servos = outputs.filter(|output| output.bank == "SERVO");
    servos.map(|output| (output.pin, output.motor)).collect()
}

/// That pins are not motors, where they are in another order.
pub(crate) fn order(parameters: &Parameters) -> Option<String> {
    let outputs = outputs(parameters);
    let Output { motor, name, .. } = outputs.iter().find(|output| output.pin != output.motor + 1)?;
    Some(format!(
        "`channels` counts the stack's motors, from 0, not outputs: {name} has motor {}, which is channel {motor}",
        motor + 1
    ))
}

/// Motors, from 0, whose pins have pulses of their own, each with the widths of throttle 0 and 1, us.
pub(crate) fn own_pulses(parameters: &Parameters) -> Vec<(usize, [f64; 2])> {
    let outputs = outputs(parameters).into_iter();
    let pins = outputs.filter(|output| output.bank.starts_with(PULSED));
    pins.map(|Output { bank, pin, motor, .. }| {
        let end = |end: &str, usual: f64| parameters.or(&format!("{bank}_{end}{pin}"), usual);
        (motor, [end("MIN", USUAL_US[0]), end("MAX", USUAL_US[1])])
    })
    .collect()
}

/// What the banks of PX4 begin with whose `MINn` and `MAXn` are pulses; those of others are what the bus counts.
const PULSED: &str = "PWM_";

/// What ArduPilot's names begin with of the motors of a Copter and of a QuadPlane.
const MOTORS: [&str; 2] = ["MOT_", "Q_M_"];

/// Whether the motors are driven by DShot: ArduPilot's `MOT_PWM_TYPE` of 4 and more, PX4's `PWM_MAIN_TIMn` of -2 and
/// less.
pub(crate) fn is_dshot(parameters: &Parameters) -> bool {
    let is_timer = |name: &&str| {
        let mut numbers = ["PWM_MAIN_TIM", "PWM_AUX_TIM"]
            .into_iter()
            .filter_map(|bank| name.strip_prefix(bank));
        numbers.any(is_number)
    };
    let types = MOTORS.map(|motors| parameters.or(&format!("{motors}PWM_TYPE"), 0.0));
    types.into_iter().any(|of_motors| of_motors >= 4.0)
        || parameters
            .names()
            .filter(is_timer)
            .any(|name| parameters.or(name, 0.0) < -1.0)
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_digit())
}

/// The pulse widths of throttle 0 and 1, of several that a file has those furthest from the usual;
/// of all pins where no function is said. DShot has none. Those that other parameters say are not looked at, and
/// are `Err`, a note (`AP_MotorsMulticopter::get_pwm_output_min`, `update_throttle_range`).
pub(crate) fn pulses(parameters: &Parameters) -> Result<Option<Pulses>, String> {
    for motors in MOTORS {
        for (end, elsewhere) in [("TYPE", 8.0), ("MAX", 0.0), ("MIN", 0.0)] {
            let name = format!("{motors}PWM_{end}");
            if parameters.get(&name) == Some(elsewhere) {
                return Err(format!(
                    "{name} is {elsewhere}: the pulses are those of other parameters, of the throttle stick (RC3_MIN, RC3_MAX) or the \
                     servos (SERVOn_MIN, SERVOn_MAX); compare them with the bench's"
                ));
            }
        }
    }
    if is_dshot(parameters) {
        return Ok(None);
    }
    let outputs = outputs(parameters);
    let of_pins: Vec<String> = match outputs.is_empty() {
        true => {
            let banks = ["PWM_MAIN", "PWM_AUX"].into_iter();
            banks
                .flat_map(|bank| (1..=MOST_PINS).map(move |pin| format!("{bank}_{{}}{pin}")))
                .collect()
        }
        false => {
            let pulsed = outputs.iter().filter(|output| output.bank.starts_with(PULSED));
            pulsed
                .map(|Output { bank, pin, .. }| format!("{bank}_{{}}{pin}"))
                .collect()
        }
    };
    let names: Vec<String> = OF_ALL.into_iter().map(str::to_owned).chain(of_pins).collect();
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
    pub(crate) fn mismatch(&self, bench_us: [f64; 2], map: Option<&PairMap>) -> Option<String> {
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
pub(crate) fn arm(arm: Option<f64>, whose: &str) -> Result<f64, String> {
    match arm {
        Some(arm) if arm > 0.0 && arm.is_finite() => Ok(arm),
        Some(arm) => Err(format!("--arm {arm}: metres from the centre to a pair, above 0")),
        None => Err(format!(
            "{whose} do not have the length of the arms: --arm METRES, from the centre to a pair"
        )),
    }
}
