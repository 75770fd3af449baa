//! PX4's parameters.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Correction, Spin, Unit};

use crate::params::parameter::{OwnCurve, Parameter, Parameters, STEADIEST, Value, gains_note};
use crate::params::writer::Back::{Moot, Stays, Written, WrittenOrNoted};
use crate::params::writer::{Format, Options, Read, Writer};

/// See [`Writer`].
pub(crate) const WRITER: Writer = Writer {
    geometry: |compiled, _, all| geometry(compiled, all),
    settings,
    own,
    pulses,
    pulse_names: "PWM_MAIN_MINn and PWM_MAIN_MAXn (PWM_AUX_MINn, PWM_AUX_MAXn)",
    frame: ["#\n# Vehicle-Id Component-Id Name Value Type\n", ""],
    line: ground_station,
    unit: ("A setpoint of 1", Compiled::scale),
    read: READ,
};

/// What becomes of the parameters that `import` reads.
#[rustfmt::skip]
const READ: &[Read] = &[
    (Written, &[
        "CA_AIRFRAME", "CA_ROTOR_COUNT", "CA_R_REV", "CA_ROTOR#_PX", "CA_ROTOR#_PY", "CA_ROTOR#_PZ", "CA_ROTOR#_AX", "CA_ROTOR#_AY",
        "CA_ROTOR#_AZ", "CA_ROTOR#_CT", "CA_ROTOR#_KM",
    ]),
    (WrittenOrNoted, &["PWM_MAIN_MIN#", "PWM_MAIN_MAX#", "PWM_AUX_MIN#", "PWM_AUX_MAX#"]),
    // Tilts, which a multirotor has none of; pulses before 1.13.
    (Moot, &["CA_ROTOR#_TILT", "PWM_MIN", "PWM_MAX", "PWM_MAIN_MIN", "PWM_MAIN_MAX", "PWM_AUX_MIN", "PWM_AUX_MAX"]),
    (Stays, &["*_FUNC#", "PWM_MAIN_TIM#", "PWM_AUX_TIM#", "BAT1_N_CELLS", "BAT1_V_EMPTY", "BAT1_V_CHARGED"]),
];

/// Most rotors that PX4 has parameters for.
const MOST_ROTORS: usize = 12;

/// PX4's own `MPC_THR_MIN` and `MPC_MANTHR_MIN`.
const LEAST_THRUST: f64 = 0.12;
const LEAST_MANUAL_THRUST: f64 = 0.08;

/// Largest of PX4's `FD_ACT_MOT_C2T` and `FD_ACT_HIGH_OFF`, A.
const MOST_SLOPE: f64 = 50.0;
const MOST_OFFSET: f64 = 30.0;

/// PX4's parameters where this mixer puts out the throttles.
fn settings(compiled: &Compiled, options: &Options, all: &mut Parameters) {
    let airframe = &compiled.airframe;
    all.because("The mixer inverts the rotors' curve; the outputs would bend the throttles once more.")
        .real("THR_MDL_FAC", 0.0);
    if options.format == Format::GroundStation {
        all.because("With DShot: throttle 0 is that of the bench's pulses; PX4's default lifts all throttles by up to 0.055.")
            .real("DSHOT_MIN", 0.0);
    }
    if airframe.voltage.is_some() {
        all.because(
            "The mixer follows the battery's voltage; the rate controller would scale by it once more.",
        )
        .whole("MC_BAT_SCALE_EN", 0);
    }
    let full_n = f64::from(compiled.scale().thrust_n);
    let hover = airframe.weight_n().map(|weight| weight / full_n);
    let why = "Weight over the thrust of all rotors at full throttle.";
    all.hover("MPC_THR_HOVER", hover, why);
    all.because(MIDDLE).whole("MPC_THR_CURVE", 0);
    // Idle lifts most at the highest voltage, in the densest air.
    let most = |law: &Option<Correction>| law.as_ref().map_or(1.0, |law| law.thrust_factor(law.range[1]));
    let rise = most(&airframe.voltage) * most(&airframe.air);
    let idle = rise * f64::from(compiled.thrust_range_n[0].max(0.0)) / full_n;
    let idle = libm::ceil(100.0 * idle) / 100.0;
    all.because("Thrust of all rotors at idle, or PX4's default where that is more: less is not to be had.")
        .real("MPC_THR_MIN", idle.max(LEAST_THRUST))
        .real("MPC_MANTHR_MIN", idle.max(LEAST_MANUAL_THRUST));
    if hover.is_some_and(|hover| idle >= hover) {
        all.note("all rotors at idle lift the vehicle: MPC_THR_MIN is above MPC_THR_HOVER");
    }
    failure_detection(compiled, options, all);
    if airframe.air.is_some() {
        all.note(DENSITY);
    }
    all.note(gains(compiled));
}

/// Accuracy of PX4's density.
const DENSITY: &str = "vehicle_air_data.rho goes by 15 C where no airspeed sensor and no external barometer has the air's temperature: \
                       thrust is then 7 % too high at -10 C, 6 % too low at 40 C (docs/air.md)";

/// Why PX4's throttle curve is straight.
const MIDDLE: &str = "Throttle stick in the middle is hover thrust.";

/// PX4's parameters where its own allocator puts out the throttles.
fn own(compiled: &Compiled, options: &Options, all: &mut Parameters) {
    let curve = OwnCurve::parabola(RANGE);
    let factor = curve.steadiest(compiled);
    all.because(STEADIEST).real("THR_MDL_FAC", factor);
    let hover = curve.hover(compiled, factor);
    let why = "THR_MDL_FAC's curve at the throttle that carries the weight at the reference voltage.";
    all.hover("MPC_THR_HOVER", hover, why);
    all.because(MIDDLE).whole("MPC_THR_CURVE", 0);
    failure_detection(compiled, options, all);
}

/// The rotors for PX4's own allocator, which takes each as isolated and both of a pair as alike.
///
/// # Errors
/// More rotors than PX4 has parameters for.
fn geometry(compiled: &Compiled, all: &mut Parameters) -> Result<(), String> {
    let airframe = &compiled.airframe;
    let count = airframe.rotors();
    if count > MOST_ROTORS {
        return Err(format!("{count} rotors: PX4 has parameters for {MOST_ROTORS}"));
    }
    all.because("A multirotor.")
        .whole("CA_AIRFRAME", 0)
        .whole("CA_ROTOR_COUNT", i32::try_from(count).unwrap_or_default());
    all.because("No rotor turns backwards.").whole("CA_R_REV", 0);
    for (channel, values) in compiled.px4_rotors().into_iter().enumerate() {
        let mut rotors = airframe.units.iter().flat_map(Unit::rotors);
        let layer = rotors
            .find(|rotor| rotor.channel == channel)
            .map_or("", |rotor| rotor.layer);
        let spin = if values[7] > 0.0 { Spin::Ccw } else { Spin::Cw };
        let why = format!("Motor {}: {layer} rotor, turns {}.", channel + 1, spin.name());
        for (key, value) in ["PX", "PY", "PZ", "AX", "AY", "AZ", "CT", "KM"]
            .iter()
            .zip(values)
        {
            all.because(&why).real(format!("CA_ROTOR{channel}_{key}"), value);
        }
    }
    Ok(())
}

/// PX4's parameters for a simulator that sends the battery, too: which output drives which motor,
/// and what it can fail.
pub(crate) fn simulated(compiled: &Compiled, all: &mut Parameters) {
    for motor in 1..=compiled.airframe.rotors() {
        let function = 100 + i32::try_from(motor).unwrap_or_default();
        all.because("Motor n on the simulator's output n.")
            .whole(format!("PWM_MAIN_FUNC{motor}"), function);
    }
    all.because(
        "Failures can be injected: `failure motor stuck -i 1` takes away motor 1's telemetry, and the detector finds it dead.",
    )
    .whole("SYS_FAILURE_EN", 1);
    all.because("The simulator sends the battery's state; 1 where it does not.")
        .whole("SIM_BAT_ENABLE", 0);
}

/// Pulse widths of throttle 0 and 1, microseconds.
fn pulses(compiled: &Compiled, [low, high]: [f64; 2], all: &mut Parameters) {
    let why = "Pulse widths of throttle 0 and 1 on the bench; a board whose motors are on AUX has PWM_AUX_..";
    for motor in 1..=compiled.airframe.rotors() {
        all.because(why)
            .whole(format!("PWM_MAIN_MIN{motor}"), low as i32)
            .whole(format!("PWM_MAIN_MAX{motor}"), high as i32);
    }
}

/// A motor is found out where it draws too little current for its throttle: below `FD_ACT_MOT_C2T`
/// times throttle less `FD_ACT_LOW_OFF`. Half of the tangent to the current in hover lies below the
/// current everywhere, as that is convex in the throttle, and above zero around hover.
fn failure_detection(compiled: &Compiled, options: &Options, all: &mut Parameters) {
    all.because("Motors that the failure detector finds out are left out of the mix.")
        .whole("CA_FAILURE_MODE", 1);
    if options.format == Format::Simulator {
        all.because("PX4's simulator reports 1 A + 15 A x output of every motor, failed or not.")
            .whole("FD_ACT_EN", 1)
            .real("FD_ACT_MOT_C2T", 15.0)
            .real("FD_ACT_LOW_OFF", 3.0)
            .real("FD_ACT_HIGH_OFF", MOST_OFFSET);
        return;
    }
    let Some([slope, offset]) = current_tangent(compiled) else {
        all.because("Without the motors' currents a healthy motor would be found out.")
            .whole("FD_ACT_EN", 0);
        all.note(match compiled.airframe.single_units() {
            0 => {
                "FD_ACT_EN is off: `[pair.power]`, `[voltage]` and `[vehicle] mass_kg` of the airframe file would give \
                 FD_ACT_MOT_C2T and FD_ACT_LOW_OFF"
            }
            _ => "FD_ACT_EN is off: the currents of single rotors are not known",
        });
        return;
    };
    let why = "Half of the tangent to a motor's current over its throttle in hover, from [pair.power]; needs ESCs that \
               report their current.";
    all.because(why)
        .whole("FD_ACT_EN", 1)
        .real("FD_ACT_MOT_C2T", (0.5 * slope).min(MOST_SLOPE))
        .real("FD_ACT_LOW_OFF", (0.5 * offset).clamp(0.0, MOST_OFFSET));
    all.because("As far as PX4 allows: a blocked motor is not looked for.")
        .real("FD_ACT_HIGH_OFF", MOST_OFFSET);
}

/// Step of the throttle for a slope.
const STEP: f64 = 1e-3;

/// Slope (A) and offset (A) of the tangent to a motor's current over its throttle in hover.
fn current_tangent(compiled: &Compiled) -> Option<[f64; 2]> {
    let airframe = &compiled.airframe;
    let throttle = compiled.equal_hover_throttle()?;
    let voltage_v = airframe.voltage.as_ref()?.reference;
    let most = airframe.rotors();
    let current = |throttle: f64| {
        let power_w = airframe.power_w(&vec![throttle; most])?;
        Some(power_w / (airframe.rotors() as f64 * voltage_v))
    };
    let slope = (current(throttle + STEP)? - current(throttle - STEP)?) / (2.0 * STEP);
    Some([slope, slope * throttle - current(throttle)?])
}

/// Throttles of an output of 0 and of 1: PX4's allocator idles at 0.
const RANGE: [f64; 2] = [0.0, 1.0];

/// The note on gains of a vehicle that was tuned with PX4's allocator.
fn gains(compiled: &Compiled) -> String {
    let curve = OwnCurve::parabola(RANGE);
    let slopes = [0.0, curve.steadiest(compiled)].map(|factor| curve.slope_in_hover(compiled, factor));
    gains_note(
        "MC_ROLLRATE_K, MC_PITCHRATE_K, MC_YAWRATE_K",
        "THR_MDL_FAC 0",
        slopes,
    )
}

/// QGroundControl's line: vehicle, component, name, value, MAV_PARAM_TYPE.
fn ground_station(parameter: &Parameter) -> String {
    let Parameter { name, value, .. } = parameter;
    let kind = match value {
        Value::Whole(_) | Value::Line => 6,
        Value::Real(_) => 9,
    };
    format!("1\t1\t{name}\t{value}\t{kind}")
}
