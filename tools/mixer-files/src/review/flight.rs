//! What a flight log says, in one form for both stacks.

use mixer_compiler::airframe::Airframe;

use crate::import::rotors::Stated;
use crate::review::log::{Log, Series};
use crate::stacks::stack::Stack;

/// A stack's log.
pub(crate) struct Form {
    /// How a file begins.
    pub magic: &'static [u8],
    /// How each of several logs in one file begins.
    pub begin: &'static [u8],
    /// The channels that a review needs, of a file's bytes.
    pub log: fn(&[u8]) -> Log,
    /// The flight; the pulse widths are those of throttle 0 and 1 on the bench, microseconds.
    ///
    /// # Errors
    /// What the log lacks.
    pub flight: fn(Log, &Stated, [f64; 2]) -> Result<Flight, String>,
}

/// Least and largest value that a row may have. The throttle of an output that is off may be below 0; force in m/s2 per
/// axis, velocity in m/s, rate in rad/s, voltage in V where the airframe has no `[voltage]`, density in kg/m3; current in A beside charge in mA h;
/// speeds of rotors in rpm; the parts of a unit vector.
const THROTTLE: [f64; 2] = [-2.0, 2.0];
const FORCE: [f64; 2] = [-100.0, 100.0];
const VELOCITY: [f64; 2] = [-100.0, 100.0];
const RATE: [f64; 2] = [-40.0, 40.0];
const VOLTS: [f64; 2] = [2.0, 120.0];
const DENSITY: [f64; 2] = [0.3, 1.7];
const SETPOINT: [f64; 2] = [-100.0, 100.0];
const AMPERES: [f64; 2] = [-10.0, 1e5];
const RPM: [f64; 2] = [0.0, 1e6];
const UNIT: [f64; 2] = [-1.01, 1.01];

/// Of the range of `[voltage]`, the lowest and the highest voltage that its pack can have.
const PACK: [f64; 2] = [0.5, 2.0];

/// Rows, and their share, up to which it is not told that they are left out.
const FEW: usize = 3;
const FEW_SHARE: f64 = 0.01;

/// A flight: SI units, body axes and the earth's forward or north, right or east, down. Whatever the
/// log lacks is `None` or empty.
#[derive(Clone, Debug, Default)]
pub struct Flight {
    /// Who wrote it.
    pub stack: Stack,
    /// Throttle of each output; not finite where the output is off.
    pub throttle: Series,
    /// Specific force of the accelerometer, m/s2, three axes: about -9.81 down in hover.
    pub force: Series,
    /// The earth's downward direction in body axes, a unit vector.
    pub down: Option<Series>,
    /// Velocity, m/s: north, east, down.
    pub velocity: Option<Series>,
    /// Rates about the body axes, rad/s.
    pub rates: Option<Series>,
    /// 1 where the vehicle stands on the ground, else 0.
    pub landed: Option<Series>,
    /// Of the battery, V.
    pub voltage: Option<Series>,
    /// Of the battery: the current, A, and the charge that was taken, mA h.
    pub current: Option<Series>,
    /// The battery's charge, mA h.
    pub capacity_mah: Option<f64>,
    /// Of the air, kg/m3.
    pub density: Option<Series>,
    /// Speed of each output's rotor, rpm; of some or of none.
    pub speeds: Vec<Series>,
    /// Normalised setpoints of roll, pitch, yaw and thrust (upward), in PX4's units.
    pub setpoint: Option<Series>,
    /// Whether the stack itself says that it cuts roll, pitch, yaw and thrust: not 0.
    pub cut: Option<Series>,
    /// Mask of the rotors that the stack has found dead.
    pub failed: Option<Series>,
    /// What is missing of a log that is damaged or cut off.
    pub damage: Option<String>,
}

impl Flight {
    /// A flight of which only the outputs and the accelerometer are known.
    pub fn new(stack: Stack, throttle: Series, force: Series) -> Flight {
        Flight {
            stack,
            throttle,
            force,
            ..Flight::default()
        }
    }

    /// The flight without rows that are damaged: of times that do not go on, and of values that the quantity cannot
    /// have. Where they are more than a few, `damage` says so.
    pub(crate) fn believed(&self, airframe: &Airframe) -> Flight {
        let pack = airframe
            .voltage
            .as_ref()
            .map_or(VOLTS, |law| [0, 1].map(|k| PACK[k] * law.range[k]));
        let mut damage: Vec<String> = self.damage.iter().cloned().collect();
        let mut keep = |what: &str, series: &Series, [low, high]: [f64; 2], off: fn(f64) -> bool| {
            let kept = series.believed(|row| row.iter().all(|x| off(*x) || (low..=high).contains(x)));
            let [dropped, all] = kept.dropped();
            if dropped > FEW && dropped as f64 > FEW_SHARE * all as f64 {
                damage.push(format!(
                    "{dropped} of {all} rows of the {what} cannot be (outside {low} to {high}, or of another time) and are left out"
                ));
            }
            kept
        };
        let never = |_| false;
        let throttle = keep("outputs", &self.throttle, THROTTLE, f64::is_nan);
        let force = keep("accelerometer", &self.force, FORCE, never);
        // A controller that never reports a speed has none to tell.
        let turns = |speeds: &Series| speeds.rows().any(|(_, row)| row[0] > 0.0);
        let speeds = self
            .speeds
            .iter()
            .map(|speeds| keep("rotors' speeds", speeds, RPM, never));
        let speeds = speeds.map(|speeds| if turns(&speeds) { speeds } else { Series::default() });
        let speeds = speeds.collect();
        let mut some = |what, series: &Option<Series>, range| {
            let kept = keep(what, series.as_ref()?, range, never);
            (!kept.is_empty()).then_some(kept)
        };
        Flight {
            stack: self.stack,
            throttle,
            force,
            down: some("attitude", &self.down, UNIT),
            velocity: some("velocity", &self.velocity, VELOCITY),
            rates: some("rates", &self.rates, RATE),
            voltage: some("voltage", &self.voltage, pack),
            current: some("current", &self.current, AMPERES),
            density: some("density", &self.density, DENSITY),
            setpoint: some("setpoint", &self.setpoint, SETPOINT),
            cut: self.cut.clone(),
            landed: self.landed.clone(),
            failed: self.failed.clone(),
            capacity_mah: self.capacity_mah,
            speeds,
            damage: (!damage.is_empty()).then(|| damage.join("; ")),
        }
    }
}
