//! ArduPilot's frames with coaxial pairs: the motors' table of each `FRAME_CLASS` and `FRAME_TYPE`
//! (`AP_MotorsMatrix`).

use std::f64::consts::FRAC_1_SQRT_2;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Spin;

use Layer::{Lower, Single, Upper};
use Spin::{Ccw, Cw};

/// `FRAME_CLASS` of this mixer, `MOTOR_FRAME_COAXIAL_MIXER` of `examples/ardupilot`.
pub(crate) const COAXIAL_MIXER: i32 = 100;

/// Of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Layer {
    /// In free air.
    Upper,
    /// In the wake.
    Lower,
    /// Of no pair.
    Single,
}

/// Half the distance of two layers, m: any will do, the units lie between them.
pub(crate) const LAYER_M: f64 = 0.05;

/// A motor of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motor {
    /// Clockwise from the nose.
    pub angle_deg: f64,
    /// Seen from above.
    pub spin: Spin,
    /// In its pair.
    pub layer: Layer,
    /// Distance from the centre of gravity over that of the farthest motor.
    pub reach: f64,
}

/// The name and the motors of a `FRAME_CLASS` and `FRAME_TYPE`, from motor 1 on.
#[rustfmt::skip]
pub(crate) fn motors(class: usize, kind: usize) -> Option<(&'static str, Vec<Motor>)> {
    let cross = |first: f64, spins: [Spin; 2]| {
        let [a, b] = spins;
        vec![
            (first, a, Upper), (first - 90.0, b, Upper), (first + 180.0, a, Upper), (first + 90.0, b, Upper),
            (first - 90.0, a, Lower), (first, b, Lower), (first + 90.0, a, Lower), (first + 180.0, b, Lower),
        ]
    };
    let betaflight = |a: Spin, b: Spin| vec![
        (135.0, a, Upper), (45.0, b, Upper), (-135.0, b, Upper), (-45.0, a, Upper),
        (135.0, b, Lower), (45.0, a, Lower), (-135.0, a, Lower), (-45.0, b, Lower),
    ];
    let around = |first: f64, step: f64, spins: &[Spin]| {
        let arms = spins.iter().zip(0..);
        arms.flat_map(|(spin, arm)| {
            let angle = first + step * f64::from(arm);
            [(angle, *spin, Upper), (angle, spin.reversed(), Lower)]
        })
        .collect::<Vec<_>>()
    };
    // `MOTOR_FRAME_TYPE_Y4`: the rear pair is as far behind as the front rotors are ahead and to the sides.
    if (class, kind) == (1, 19) {
        let motor = |angle_deg, spin, layer, reach| Motor { angle_deg, spin, layer, reach };
        return Some(("Y4", vec![
            motor(45.0, Ccw, Single, 1.0), motor(180.0, Cw, Upper, FRAC_1_SQRT_2),
            motor(180.0, Ccw, Lower, FRAC_1_SQRT_2), motor(-45.0, Cw, Single, 1.0),
        ]));
    }
    let found = match (class, kind) {
        (4, 0) => ("octaquad plus", cross(0.0, [Ccw, Cw])),
        (4, 1) => ("octaquad X", cross(45.0, [Ccw, Cw])),
        (4, 2) => ("octaquad V", cross(45.0, [Ccw, Cw])),
        (4, 3) => ("octaquad H", cross(45.0, [Cw, Ccw])),
        (4, 12) => ("octaquad X, Betaflight's order", betaflight(Cw, Ccw)),
        (4, 14) => ("octaquad X, clockwise order", around(45.0, 90.0, &[Ccw, Cw, Ccw, Cw])),
        (4, 18) => ("octaquad X, Betaflight's order, reversed", betaflight(Ccw, Cw)),
        (5, 10) => ("Y6B", around(60.0, 120.0, &[Cw, Cw, Cw])),
        (5, 11) => ("Y6F", vec![
            (180.0, Ccw, Upper), (60.0, Ccw, Upper), (-60.0, Ccw, Upper),
            (180.0, Cw, Lower), (60.0, Cw, Lower), (-60.0, Cw, Lower),
        ]),
        // Every other type is the default.
        (5, _) => ("Y6A", vec![
            (60.0, Ccw, Lower), (-60.0, Cw, Upper), (-60.0, Ccw, Lower),
            (180.0, Cw, Lower), (60.0, Cw, Upper), (180.0, Ccw, Upper),
        ]),
        (12, 0) => ("dodecahexa plus", around(0.0, 60.0, &[Ccw, Cw, Ccw, Cw, Ccw, Cw])),
        (12, 1) => ("dodecahexa X", around(30.0, 60.0, &[Ccw, Cw, Ccw, Cw, Ccw, Cw])),
        _ => return None,
    };
    let (name, motors) = found;
    let motor = |(angle_deg, spin, layer)| Motor { angle_deg, spin, layer, reach: 1.0 };
    Some((name, motors.into_iter().map(motor).collect()))
}

/// `FRAME_CLASS` and `FRAME_TYPE` of all frames that differ for a mixer, the usual ones first.
#[rustfmt::skip]
const FRAMES: &[(usize, usize)] = &[
    (4, 1), (4, 0), (4, 3), (4, 12), (4, 14), (4, 18), (5, 10), (5, 1), (5, 11), (12, 1), (12, 0), (1, 19),
];

/// Factors that differ by less are one: a motor that is a few degrees off.
const SAME_FACTOR: f64 = 0.05;

/// The frame whose motors are an airframe's rotors by place, spin and layer, channel 0 being motor
/// 1: `FRAME_CLASS`, `FRAME_TYPE` and its name.
pub(crate) fn find(compiled: &Compiled) -> Option<(usize, usize, &'static str)> {
    let own = compiled.ardupilot_factors();
    let mut rotors: Vec<(usize, Spin, Layer)> = Vec::new();
    for unit in &compiled.airframe.units {
        let layers = if unit.lower_channel.is_some() {
            [Upper, Lower]
        } else {
            [Single; 2]
        };
        rotors.extend(
            unit.rotors()
                .zip(layers)
                .map(|(rotor, layer)| (rotor.channel, rotor.spin, layer)),
        );
    }
    rotors.sort_by_key(|(channel, ..)| *channel);
    FRAMES.iter().find_map(|&(class, kind)| {
        let (name, motors) = motors(class, kind)?;
        let factors = factors(&motors);
        let of_frame = motors.iter().zip(0..);
        let of_frame = of_frame.map(|(motor, channel)| (channel, motor.spin, motor.layer));
        let mut differences = own
            .iter()
            .zip(&factors)
            .flat_map(|(a, b)| [a[0] - b[0], a[1] - b[1]]);
        let is_same = of_frame.eq(rotors.iter().copied()) && differences.all(|x| x.abs() < SAME_FACTOR);
        is_same.then_some((class, kind, name))
    })
}

/// Of roll and pitch, 0.5 where largest (`AP_MotorsMatrix::add_motor`, `normalise_rpy_factors`).
fn factors(motors: &[Motor]) -> Vec<[f64; 2]> {
    let raw = motors.iter().map(|motor| {
        let angle = motor.angle_deg.to_radians();
        [-libm::sin(angle), libm::cos(angle)].map(|factor| motor.reach * factor)
    });
    let raw: Vec<[f64; 2]> = raw.collect();
    let largest = [0, 1].map(|axis| {
        raw.iter()
            .fold(0.0, |most: f64, factors| most.max(factors[axis].abs()))
    });
    raw.iter()
        .map(|factors| [0, 1].map(|axis| 0.5 * factors[axis] / largest[axis]))
        .collect()
}
