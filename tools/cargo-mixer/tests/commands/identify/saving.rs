//! Saving of recorded power by the power bias of a compiled X8 with the pairs of real full-range
//! maps: level, over drawn requests, and over the setpoints of real flights.

use std::fmt::Write as _;
use std::path::Path;

use mixer_compiler::tables::MixerTables;
use mixer_compiler::{Compiled, Source};
use mixer_files::frame::{Frame, NewFrame};
use mixer_identify::fragment;
use mixer_rt::Wrench;

use super::bench_data::{fitted, full_range_maps};
use super::sweep::Normal;
use crate::bench_data;
use crate::measured;

/// An X8 with the pairs of a map, and its mixer with the bias that was identified.
struct X8 {
    compiled: Compiled,
    with: MixerTables,
    /// All rotors at full throttle, N.
    full_n: f64,
    /// N m per unit of a normalised setpoint: roll, pitch, yaw.
    scale_nm: [f64; 3],
}

impl X8 {
    fn of(map: &Path) -> Self {
        let found = fitted(map, None, false);
        let frame = NewFrame {
            arm_m: Some(0.45),
            name: Some("x8"),
            ..NewFrame::of(Frame::X8)
        };
        let text = frame.airframe(&fragment::tables(&found), found.power_bias());
        let source = Source::new("x8.toml", text.expect("a frame"));
        let compiled = mixer_compiler::compile(&source).unwrap_or_else(|faults| panic!("{faults}"));
        let bias = found.power_bias().unwrap_or_else(|| panic!("{}", map.display()));
        let with = compiled.tables.with_power_bias(bias as f32);
        let full_n = f64::from(compiled.thrust_range_n[1]);
        let [roll, pitch, yaw, _] = compiled.scale().to_array().map(f64::from);
        X8 {
            compiled,
            with,
            full_n,
            scale_nm: [roll, pitch, yaw],
        }
    }

    /// Power with the bias and without of a normalised setpoint, and whether an axis falls short.
    fn watts(&self, torques: [f64; 3], thrust: f64) -> ([f64; 2], bool) {
        let [roll, pitch, yaw] = [0, 1, 2].map(|k| (torques[k] * self.scale_nm[k]) as f32);
        let setpoint = Wrench::from_array([roll, pitch, yaw, (thrust * self.full_n) as f32]);
        let reference_v = self.compiled.airframe.reference_v() as f32;
        let of = |tables: &MixerTables| {
            let (throttle, _, saturation) = tables.mix(&setpoint, reference_v).expect("finite");
            let throttle: Vec<f64> = throttle.into_iter().map(f64::from).collect();
            let watts = self.compiled.airframe.power_w(&throttle).expect("a power map");
            (watts, saturation.any_axis())
        };
        let ((with, short), (without, _)) = (of(&self.with), of(&self.compiled.tables));
        ([with, without], short)
    }
}

fn mean(of: &[f64]) -> f64 {
    of.iter().sum::<f64>() / of.len() as f64
}

fn saving_percent([with, without]: [f64; 2]) -> f64 {
    100.0 * (1.0 - with / without)
}

/// Level from 0.3 to 0.7 of full thrust, and over drawn requests about these.
#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn the_mixer_saves_what_is_identified() {
    const BRISK: [f64; 2] = [0.05, 0.1];
    let data = bench_data();
    let (mut level, mut brisk) = (Vec::new(), [Vec::new(), Vec::new()]);
    for path in full_range_maps(&data) {
        let x8 = X8::of(&path);
        let shares = (0..9).map(|k| 0.3 + 0.05 * f64::from(k));
        // As a level thrust may be beneath what the idle leaves.
        let saved: Vec<f64> = shares
            .map(|share| x8.watts([0.0; 3], share))
            .filter_map(|(watts, short)| (!short).then_some(saving_percent(watts)))
            .collect();
        assert!(saved.len() >= 8, "{saved:?}");
        assert!(
            saved.iter().all(|saved| *saved >= 0.0),
            "{}: {saved:?}",
            path.display()
        );
        level.push(mean(&saved));
        // Roll and pitch up to this share of a normalised setpoint, yaw up to twice the share,
        // thrust by a fifth.
        for (share, brisk) in BRISK.into_iter().zip(&mut brisk) {
            let mut normal = Normal::new(3);
            let mut energy = [0.0; 2];
            for k in 0..2000 {
                let mut draw = || normal.next().clamp(-2.0, 2.0) / 2.0;
                let thrust = (0.3 + 0.4 * f64::from(k) / 2000.0) * (1.0 + 0.2 * draw());
                let torques = [share, share, 2.0 * share].map(|share| share * draw());
                let (watts, short) = x8.watts(torques, thrust);
                if !short {
                    energy = [energy[0] + watts[0], energy[1] + watts[1]];
                }
            }
            brisk.push(saving_percent(energy));
        }
        let last = |of: &[f64]| of[of.len() - 1];
        println!(
            "{}: level {:.2} %, brisk {:.2} and {:.2} %",
            path.display(),
            last(&level),
            last(&brisk[0]),
            last(&brisk[1])
        );
    }
    let [moderate, hard] = [&brisk[0], &brisk[1]].map(|of| mean(of));
    println!(
        "mean: level {:.2} %, brisk {moderate:.2} and {hard:.2} %",
        mean(&level)
    );
    assert!(
        mean(&level) >= 2.4 && moderate >= 2.2 && hard >= 1.9,
        "{level:?} {brisk:?}"
    );
}

/// A row of a logged flight of an X8.
struct Row {
    height_m: f64,
    speed_m_s: f64,
    tilt_deg: f64,
    /// Thrust (N), roll, pitch, yaw (N m), as the controller asked for them.
    asked: [f64; 4],
    /// Thrust (N) and normalised command of every rotor.
    rotors: [[f64; 2]; 8],
}

fn rows(log: &Path) -> Vec<Row> {
    let mut reader = csv::Reader::from_path(log).unwrap_or_else(|e| panic!("{}: {e}", log.display()));
    let headers = reader.headers().expect("a header").clone();
    let column = |name: &str| {
        let found = headers.iter().position(|header| header == name);
        found.unwrap_or_else(|| panic!("no {name:?} in {}", log.display()))
    };
    let motion = ["Velocity x [m/s]", "Velocity y [m/s]", "Velocity z [m/s]"].map(column);
    let [down, roll, pitch] = ["Position z [m]", "Roll [rad]", "Pitch [rad]"].map(column);
    let asked = ["U1 [N]", "U2 [Nm]", "U3 [Nm]", "U4 [Nm]"].map(|u| column(&format!("U control input {u}")));
    let rotors = [1, 2, 3, 4, 5, 6, 7, 8].map(|k| {
        [
            column(&format!("Thrust motors X8COPTER T{k} [N]")),
            column(&format!("Thrust motors normalized X8COPTER T{k} [-]")),
        ]
    });
    let row = |record: Result<csv::StringRecord, csv::Error>| {
        let record = record.expect("a row");
        let cell = |at: usize| record[at].parse::<f64>().expect("a number");
        Row {
            height_m: -cell(down),
            speed_m_s: motion.iter().map(|at| cell(*at) * cell(*at)).sum::<f64>().sqrt(),
            tilt_deg: libm::acos(libm::cos(cell(roll)) * libm::cos(cell(pitch))).to_degrees(),
            asked: asked.map(cell),
            rotors: rotors.map(|at| at.map(cell)),
        }
    };
    reader.into_records().map(row).collect()
}

/// What one unit of a normalised setpoint is on that vehicle: N of thrust, N m of roll, pitch and
/// yaw, in PX4's manner.
///
/// The logs have each rotor's thrust command T and its normalised command n, up to 0.88. T = a n +
/// b n2 through those above half gives the thrust at n = 1; the yaw torque that is asked for, over
/// the thrusts by the sense of their rotors, a rotor's torque.
fn units(flights: &[Vec<Row>]) -> [f64; 4] {
    // The shorter arm: the two axes have one unit.
    const ARM_M: f64 = 0.0881;
    let (mut normal, mut right) = ([0.0; 3], [0.0; 2]);
    let (mut yaw, mut squares) = (0.0, 0.0);
    for row in flights.iter().flatten() {
        let mut turning = 0.0;
        for (k, [thrust, n]) in row.rotors.into_iter().enumerate() {
            if n > 0.5 {
                let n2 = n * n;
                normal = [normal[0] + n2, normal[1] + n * n2, normal[2] + n2 * n2];
                right = [right[0] + n * thrust, right[1] + n2 * thrust];
            }
            turning += if k % 2 == 0 { thrust } else { -thrust };
        }
        yaw += row.asked[3] * turning;
        squares += turning * turning;
    }
    let [n2, n3, n4] = normal;
    let determinant = n2 * n4 - n3 * n3;
    let a = (right[0] * n4 - right[1] * n3) / determinant;
    let b = (right[1] * n2 - right[0] * n3) / determinant;
    let full = 8.0 * (a + b);
    let roll_pitch = full * ARM_M / core::f64::consts::SQRT_2;
    println!("a rotor at full: {:.2} N, {:.4} N m per N", a + b, yaw / squares);
    [full, roll_pitch, roll_pitch, full * yaw / squares]
}

/// Three flights of another group's X8 with tilts of 24 and of 45 degrees, mixed by the pairs of
/// the maps on an X8 frame. Torques are as the flight's in normalised setpoints. The mean thrust in
/// the air is 0.3 to 0.7 of full thrust, as when level.
#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn the_mixer_saves_over_logged_flights() {
    const FLIGHTS: [(&str, &str); 3] = [
        ("2024-06-13 11:56", "log_20240613_115633.csv"),
        ("2024-06-21 10:38", "log_20240621_103807.csv"),
        ("2024-06-13 12:18", "log_20240613_121802.csv"),
    ];
    let data = bench_data();
    let logs = FLIGHTS.map(|(_, name)| rows(&data.join("acsl").join(name)));
    let units = units(&logs);
    let frames: Vec<X8> = full_range_maps(&data).iter().map(|map| X8::of(map)).collect();
    let mut text = String::from(
        "flight,tilt_deg,speed_m_s,roll_percent,pitch_percent,yaw_percent,least_thrust,most_thrust,saved_percent\n",
    );
    let mut saved = Vec::new();
    for ((flight, _), log) in FLIGHTS.iter().zip(&logs) {
        let air: Vec<&Row> = log.iter().filter(|row| row.height_m > 0.4).collect();
        let of = |value: fn(&Row) -> f64| air.iter().map(|row| value(row)).collect::<Vec<f64>>();
        let most = |of: &[f64]| of.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let thrusts = of(|row| row.asked[0]);
        let hover = mean(&thrusts);
        let normalised: Vec<[f64; 3]> = air
            .iter()
            .map(|row| [1, 2, 3].map(|k| row.asked[k] / units[k]))
            .collect();
        let rms = [0, 1, 2].map(|k| {
            let squares: Vec<f64> = normalised.iter().map(|n| n[k] * n[k]).collect();
            100.0 * mean(&squares).sqrt()
        });
        let mut by_frame_and_level = Vec::new();
        for x8 in &frames {
            for level in [0.3, 0.4, 0.5, 0.6, 0.7] {
                let watts = normalised
                    .iter()
                    .zip(&thrusts)
                    .map(|(torques, thrust)| x8.watts(*torques, level * thrust / hover).0);
                let energy = watts.fold([0.0; 2], |sum, watts| [sum[0] + watts[0], sum[1] + watts[1]]);
                by_frame_and_level.push(saving_percent(energy));
            }
        }
        assert!(
            by_frame_and_level.iter().all(|saved| *saved > 0.0),
            "{flight}: {by_frame_and_level:?}"
        );
        saved.push(mean(&by_frame_and_level));
        let least = thrusts.iter().copied().fold(f64::INFINITY, f64::min);
        let [roll, pitch, yaw] = rms;
        writeln!(
            text,
            "{flight},{:.0},{:.1},{roll:.1},{pitch:.1},{yaw:.1},{:.2},{:.2},{:.2}",
            most(&of(|row| row.tilt_deg)),
            most(&of(|row| row.speed_m_s)),
            least / hover,
            most(&thrusts) / hover,
            mean(&by_frame_and_level)
        )
        .expect("a string");
    }
    println!("{text}mean {:.2} %", mean(&saved));
    assert!(
        saved
            .iter()
            .zip([2.2, 2.2, 2.0])
            .all(|(saved, least)| *saved >= least),
        "{saved:?}"
    );
    measured::hold("logged-saving.csv", &text);
}
