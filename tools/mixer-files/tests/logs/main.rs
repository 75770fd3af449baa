//! Logs of both stacks' formats, of a flight whose answers are known: a hover with a slow heave, a centre of gravity
//! off the file's, thrust off the model's.
#![allow(missing_docs)]

mod writers;

use std::fs;
use std::path::Path;

use mixer_compiler::airframe::GRAVITY;
use mixer_compiler::{Compiled, Source};
use mixer_files::review::{Flight, Options, Review, scaled};
use mixer_rt::{Health, Wrench};
use writers::{Message, Rows, Topic, dataflash, ulog};

const MASS_KG: f64 = 6.5;
const SECONDS: f64 = 30.0;
const VOLTS: f64 = 23.0;

/// The model gives more than the vehicle by this.
const SCALE: f64 = 1.06;

/// The centre of gravity, forward and right of the file's, m.
const CENTRE_M: [f64; 2] = [0.012, -0.007];

fn compiled() -> Compiled {
    let text = include_str!("../../../../examples/simulator/x8.toml");
    mixer_compiler::compile(&Source::new("x8.toml", text)).unwrap()
}

/// Upward acceleration, m/s2, and velocity, m/s.
fn heave(time_s: f64) -> [f64; 2] {
    [0.4 * libm::sin(2.0 * time_s), -0.2 * libm::cos(2.0 * time_s)]
}

/// The throttles of a vehicle that flies so: what this mixer gives.
fn throttles(compiled: &Compiled, time_s: f64) -> Vec<f32> {
    if !(2.0..SECONDS - 2.0).contains(&time_s) {
        return vec![0.0; 8];
    }
    let thrust = SCALE * MASS_KG * (GRAVITY + heave(time_s)[0]);
    let [x, y] = CENTRE_M;
    let setpoint = Wrench {
        roll_nm: (-y * thrust) as f32,
        pitch_nm: (x * thrust) as f32,
        yaw_nm: 0.05,
        thrust_n: thrust as f32,
    };
    let mixed = compiled.tables.mix(&setpoint, VOLTS as f32).unwrap();
    assert!(!mixed.2.any_axis());
    mixed.0
}

fn force(time_s: f64) -> Vec<f32> {
    vec![0.0, 0.0, -(GRAVITY + heave(time_s)[0] + 0.1) as f32]
}

fn landed(time_s: f64) -> bool {
    !(2.5..SECONDS - 2.5).contains(&time_s)
}

fn parameters(pairs: &[(&str, f64)]) -> Vec<(String, f64)> {
    pairs
        .iter()
        .map(|(name, value)| ((*name).to_owned(), *value))
        .collect()
}

/// What PX4 has of the frame, by the airframe.
fn px4_frame(compiled: &Compiled) -> Vec<(String, f64)> {
    let mut all = parameters(&[("CA_ROTOR_COUNT", 8.0), ("THR_MDL_FAC", 0.0)]);
    for unit in &compiled.airframe.units {
        for (channel, spin) in unit.channels().zip([1.0, -1.0]) {
            let sign = if unit.upper_spin.name() == "ccw" {
                spin
            } else {
                -spin
            };
            let of = |key: &str| format!("CA_ROTOR{channel}_{key}");
            all.push((of("PX"), unit.position_m[0]));
            all.push((of("PY"), unit.position_m[1]));
            all.push((of("KM"), 0.05 * sign));
        }
    }
    all
}

fn px4_log(compiled: &Compiled, parameters: &[(String, f64)]) -> Vec<u8> {
    px4_log_of(parameters, &|time_s| throttles(compiled, time_s))
}

fn px4_log_of(parameters: &[(String, f64)], motors: Rows<'_>) -> Vec<u8> {
    px4_log_with(parameters, motors, Vec::new())
}

/// The log with more topics, or others of the same name.
fn px4_log_with<'a>(parameters: &[(String, f64)], motors: Rows<'a>, more: Vec<Topic<'a>>) -> Vec<u8> {
    let topics = [
        Topic {
            name: "actuator_motors",
            fields: "float[8] control;",
            period_s: 0.1,
            rows: motors,
        },
        Topic {
            name: "sensor_combined",
            fields: "float[3] accelerometer_m_s2;",
            period_s: 0.004,
            rows: &force,
        },
        Topic {
            name: "vehicle_attitude",
            fields: "float[4] q;",
            period_s: 0.02,
            rows: &|_| vec![0.8, 0.0, 0.0, 0.6],
        },
        Topic {
            name: "vehicle_local_position",
            fields: "float vx;float vy;float vz;",
            period_s: 0.1,
            rows: &|time_s| vec![0.0, 0.0, -heave(time_s)[1] as f32],
        },
        Topic {
            name: "vehicle_land_detected",
            fields: "float landed;",
            period_s: 0.5,
            rows: &|time_s| vec![f32::from(u8::from(landed(time_s)))],
        },
        Topic {
            name: "battery_status",
            fields: "float voltage_v;float connected;",
            period_s: 0.2,
            rows: &|_| vec![VOLTS as f32, 1.0],
        },
    ];
    let is_other = |topic: &Topic<'_>| more.iter().all(|other| other.name != topic.name);
    let mut topics: Vec<Topic<'_>> = topics.into_iter().filter(is_other).collect();
    topics.extend(more);
    ulog(parameters, &topics, SECONDS)
}

/// ArduPilot's octaquad X: of the example's numbering.
fn ardupilot_frame() -> Vec<(String, f64)> {
    let mut all = parameters(&[("FRAME_CLASS", 4.0), ("FRAME_TYPE", 1.0), ("MOT_PWM_MIN", 1000.0)]);
    all.extend((1..=8).map(|pin| (format!("SERVO{pin}_FUNCTION"), f64::from(32 + pin))));
    all
}

fn ardupilot_log(compiled: &Compiled, parameters: &[(String, f64)]) -> Vec<u8> {
    let pulses = |time_s: f64| {
        throttles(compiled, time_s)
            .iter()
            .map(|x| 1000.0 + 1000.0 * x)
            .collect()
    };
    let messages = [
        Message {
            name: "RCOU",
            labels: "C1,C2,C3,C4,C5,C6,C7,C8",
            period_s: 0.1,
            rows: &pulses,
        },
        Message {
            name: "IMU",
            labels: "AccX,AccY,AccZ",
            period_s: 0.04,
            rows: &force,
        },
        Message {
            name: "ATT",
            labels: "Roll,Pitch",
            period_s: 0.1,
            rows: &|_| vec![0.0, 0.0],
        },
        Message {
            name: "XKF1",
            labels: "VN,VE,VD",
            period_s: 0.1,
            rows: &|time_s| vec![0.0, 0.0, -heave(time_s)[1] as f32],
        },
        Message {
            name: "EV",
            labels: "Id",
            period_s: 0.5,
            rows: &|time_s| vec![if landed(time_s) { 18.0 } else { 28.0 }],
        },
        Message {
            name: "BAT",
            labels: "Volt",
            period_s: 0.1,
            rows: &|_| vec![VOLTS as f32],
        },
    ];
    dataflash(parameters, &messages, SECONDS)
}

fn review(log: &[u8]) -> Result<Review, String> {
    Review::new("a.log", log, &compiled(), &Options::default())
}

/// The logs of the example, by stack.
fn logs() -> [Vec<u8>; 2] {
    let compiled = compiled();
    [
        px4_log(&compiled, &px4_frame(&compiled)),
        ardupilot_log(&compiled, &ardupilot_frame()),
    ]
}

/// The command line's transcripts of `review` have both logs, PX4's with fewer rows; `MIXER_BLESS=1` writes them.
#[test]
fn the_logs_of_the_transcripts_are_these() {
    let compiled = compiled();
    let thinned = vec![
        Topic {
            name: "sensor_combined",
            fields: "float[3] accelerometer_m_s2;",
            period_s: 0.04,
            rows: &force,
        },
        Topic {
            name: "vehicle_attitude",
            fields: "float[4] q;",
            period_s: 0.1,
            rows: &|_| vec![0.8, 0.0, 0.0, 0.6],
        },
    ];
    let px4 = px4_log_with(
        &px4_frame(&compiled),
        &|time_s| throttles(&compiled, time_s),
        thinned,
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cargo-mixer/tests/cases/files");
    for (name, log) in [
        ("x8.ulg", px4),
        ("x8.bin", ardupilot_log(&compiled, &ardupilot_frame())),
    ] {
        let file = folder.join(name);
        if std::env::var_os("MIXER_BLESS").is_some_and(|value| value == "1") {
            fs::write(&file, &log).unwrap();
        }
        assert!(
            fs::read(&file).unwrap() == log,
            "{name}: MIXER_BLESS=1 writes it anew"
        );
    }
}

#[test]
fn both_stacks_logs_tell_what_was_flown() {
    for log in logs() {
        let review = review(&log).unwrap();
        let off = review.thrust.scale.unwrap() / SCALE - 1.0;
        assert!(off.abs() < 2e-3, "{off}\n{review}");
        let [low, high] = review.thrust.interval;
        assert!(
            low < SCALE && SCALE < high && high - low < 0.025,
            "{low} to {high}"
        );
        let hover = &review.hover;
        for (found, put) in hover.centre_m.unwrap().into_iter().zip(CENTRE_M) {
            assert!((found - put).abs() < 2e-4, "{found} {put}");
        }
        assert!((hover.yaw_nm.unwrap() - 0.05).abs() < 2e-3, "{hover:?}");
        // It hovers higher on the throttle than the model, which gives more.
        let [upper, lower] = hover.model.unwrap();
        assert!(
            hover.upper.unwrap() > upper + 0.005 && hover.lower.unwrap() > lower + 0.005,
            "{hover:?}"
        );
        let voltage = review.voltage.as_ref().unwrap();
        assert_eq!(
            [voltage.least, voltage.largest, voltage.outside],
            [VOLTS, VOLTS, 0.0]
        );
        assert!(review.stopped.is_empty(), "{review}");
        let told = review.to_string();
        assert!(told.lines().count() <= 30, "{told}");
        for what in ["6.0 % more thrust", "12 mm forward and 7 mm left"] {
            assert!(told.contains(what), "{told}");
        }
    }
}

#[test]
fn a_scaled_file_gives_the_measured_thrust() {
    let [log, _] = logs();
    let compiled = compiled();
    let review = review(&log).unwrap();
    let text = scaled(&compiled.source.text, &review, "a.ulg").unwrap();
    assert!(text.contains("cargo mixer review a.ulg"), "{text}");
    let scaled = mixer_compiler::compile(&Source::new("x8.toml", text)).unwrap();
    let wrench = |compiled: &Compiled| {
        let physics = compiled.physics();
        physics.wrench(&[0.6; 8], [1.0, 1.0], Health::GOOD)
    };
    let [before, after] = [&compiled, &scaled].map(wrench);
    // Intervals in comments follow.
    let commented = "[pair]\nthrust_n = [\n  10.6,   # u2   +- 2.120e0\n  5.3,  # l2   +- 1.070e-1\n]\n";
    let divided = mixer_files::review::scaled(commented, &review, "a.ulg").unwrap();
    for half in ["# u2   +- 2.000e0\n", "# l2   +- 1.009e-1\n"] {
        assert!(divided.contains(half), "{divided}");
    }
    assert!(
        (before[3] / after[3] / review.thrust.scale.unwrap() - 1.0).abs() < 1e-6,
        "{before:?} {after:?}"
    );
    assert_eq!(before[2], after[2]);
    let again = Review::new("a.log", &log, &scaled, &Options::default()).unwrap();
    assert!((again.thrust.scale.unwrap() - 1.0).abs() < 1e-3, "{again}");
    assert!(
        again.warnings.iter().all(|warning| !warning.contains("-o")),
        "{again}"
    );
}

#[test]
fn a_rotor_that_stops_is_told() {
    let compiled = compiled();
    let stops = |time_s: f64| {
        let mut throttles = throttles(&compiled, time_s);
        if time_s > 20.0 {
            throttles[3] = f32::NAN;
        }
        throttles
    };
    let review = review(&px4_log_of(&px4_frame(&compiled), &stops)).unwrap();
    let stopped = &review.stopped[..];
    assert!(
        matches!(stopped, [one] if one.output == 3 && (20.0..20.3).contains(&one.time_s)),
        "{stopped:?}"
    );
    // What follows is not hover.
    assert!(
        (review.thrust.scale.unwrap() / SCALE - 1.0).abs() < 2e-3,
        "{review}"
    );
    assert!((15.0..18.0).contains(&review.seconds[2]), "{review}");
}

/// Share of its throttle that the weak rotor lacks.
const WEAK: f32 = 0.06;

/// A topic that others name as the format of their fields has no rows.
fn nothing(_: f64) -> Vec<f32> {
    Vec::new()
}

/// PX4's speeds of the rotors, with a time of eight bytes, a speed and the function of the output for each of them.
fn speeds(rows: Rows<'_>) -> Vec<Topic<'_>> {
    let format = Topic {
        name: "esc_report",
        fields: "float esc_rpm;float actuator_function;",
        period_s: f64::INFINITY,
        rows: &nothing,
    };
    let escs = Topic {
        name: "esc_status",
        fields: "float esc_online_flags;esc_report[8] esc;",
        period_s: 0.1,
        rows,
    };
    vec![format, escs]
}

/// A throttle and a speed per rotor as PX4 logs them: online, and of each a time, the speed and who it is.
fn esc_row(speed: &[f32]) -> Vec<f32> {
    let each = speed.iter().zip(101u8..);
    let each = each.flat_map(|(speed, function)| [0.0, 0.0, *speed, f32::from(function)]);
    [255.0].into_iter().chain(each).collect()
}

#[test]
fn a_weak_rotor_is_told_from_a_moved_centre() {
    let compiled = compiled();
    // What turns the rotors, with the speed that it gives them: output 2 has less of it where it is weak.
    let logged = |is_weak: bool, stops_s: f64| {
        let of = |time_s: f64| -> Vec<[f32; 2]> {
            let throttles = throttles(&compiled, time_s).into_iter().enumerate();
            let both = throttles.map(|(rotor, turns)| match rotor {
                2 if is_weak => [turns / (1.0 - WEAK), turns],
                _ => [turns; 2],
            });
            let speed = |rotor: usize, turns: f32| match rotor == 5 && time_s > stops_s {
                true => 0.0,
                false => 6000.0 * libm::powf(turns, 0.9),
            };
            both.enumerate()
                .map(|(rotor, [told, turns])| [told, speed(rotor, turns)])
                .collect()
        };
        let motors = |time_s: f64| of(time_s).iter().map(|[told, _]| *told).collect();
        let escs = |time_s: f64| esc_row(&of(time_s).iter().map(|[_, speed]| *speed).collect::<Vec<_>>());
        review(&px4_log_with(&px4_frame(&compiled), &motors, speeds(&escs))).unwrap()
    };
    let has = |review: &Review, words: &str| review.warnings.iter().any(|warning| warning.contains(words));
    let moved = logged(false, SECONDS);
    assert_eq!(moved.speeds.len(), 8, "{moved}");
    assert!(
        has(&moved, "the centre of gravity is 12 mm forward and 7 mm left"),
        "{moved}"
    );
    assert!(
        has(&moved, "speeds are alike") && !has(&moved, "turns"),
        "{moved}"
    );
    let [[low, high], _] = moved.hover.centre_interval_m.unwrap();
    assert!(
        low < CENTRE_M[0] && CENTRE_M[0] < high && high - low < 0.02,
        "{low} to {high}"
    );
    let weak = logged(true, SECONDS);
    assert!(
        has(&weak, "the rotor of output 2 turns") && has(&weak, "slower"),
        "{weak}"
    );
    assert!(!has(&weak, "centre of gravity"), "{weak}");
    // Its output goes on, its speed does not.
    let stopped = logged(false, 20.0).stopped;
    assert!(
        matches!(&stopped[..], [one] if one.output == 5 && (20.0..20.3).contains(&one.time_s)),
        "{stopped:?}"
    );
}

/// Throttles that a controller moves at several frequencies, and rotors that follow them with a lag.
#[test]
fn rotors_lag_is_found_where_speeds_are_logged() {
    const LAG_S: f64 = 0.07;
    let compiled = compiled();
    let wander = |rotor: usize, time_s: f64, lag_s: f64| {
        let of = |(k, w): (usize, f64)| {
            let phase = w * time_s + (3 * rotor + 5 * k) as f64 - libm::atan(w * lag_s);
            0.01 * libm::sin(phase) / libm::hypot(1.0, w * lag_s)
        };
        [3.0, 7.0, 13.0, 19.0, 29.0]
            .into_iter()
            .enumerate()
            .map(of)
            .sum::<f64>() as f32
    };
    let given = |time_s: f64, lag_s: f64| -> Vec<f32> {
        let steady = throttles(&compiled, time_s).into_iter().enumerate();
        steady
            .map(|(rotor, of)| {
                if of > 0.0 {
                    of + wander(rotor, time_s, lag_s)
                } else {
                    of
                }
            })
            .collect()
    };
    let logged = |period_s: f64| {
        let motors = |time_s: f64| given(time_s, 0.0);
        let escs = |time_s: f64| {
            esc_row(
                &given(time_s, LAG_S)
                    .iter()
                    .map(|x| 6000.0 * libm::powf(*x, 0.9))
                    .collect::<Vec<_>>(),
            )
        };
        let mut topics = speeds(&escs);
        topics[1].period_s = period_s;
        topics.push(Topic {
            name: "actuator_motors",
            fields: "float[8] control;",
            period_s,
            rows: &motors,
        });
        review(&px4_log_with(&px4_frame(&compiled), &motors, topics)).unwrap()
    };
    let told = logged(0.04);
    let lag = told.lag.unwrap_or_else(|| panic!("{told}"));
    assert!((lag.lag_s / LAG_S - 1.0).abs() < 0.15, "{lag:?}");
    assert!(
        told.to_string()
            .contains("`rotor_lag_s` of `[vehicle]`; `mix_dynamic` takes"),
        "{told}"
    );
    assert!(logged(0.1).lag.is_none());
}

/// The battery's power over the model's, and what is left of its charge.
#[test]
fn power_has_a_scale() {
    let compiled = compiled();
    let power_w = |time_s: f64| {
        let throttle: Vec<f64> = throttles(&compiled, time_s).into_iter().map(f64::from).collect();
        let voltage = compiled.airframe.voltage_factors(VOLTS)[0];
        compiled.airframe.power_w(&throttle).unwrap() * libm::pow(voltage, 1.5)
    };
    let battery = Topic {
        name: "battery_status",
        fields: "float voltage_v;float connected;float current_a;float discharged_mah;",
        period_s: 0.1,
        rows: &|time_s| vec![VOLTS as f32, 1.0, (1.1 * power_w(time_s) / VOLTS) as f32, 3000.0],
    };
    let mut frame = px4_frame(&compiled);
    frame.push(("BAT1_CAPACITY".to_owned(), 8000.0));
    let motors = |time_s: f64| throttles(&compiled, time_s);
    let log = px4_log_with(&frame, &motors, vec![battery]);
    let power = Review::new("a.log", &log, &compiled, &Options::default())
        .unwrap()
        .power
        .unwrap();
    assert!((power.scale * 1.1 - 1.0).abs() < 0.01, "{power:?}");
    let left_s = 3.6 * 5000.0 * VOLTS / power.measured_w;
    assert!(
        (power.hover_left_s.unwrap() / left_s - 1.0).abs() < 0.01,
        "{power:?}"
    );
}

/// Two logs in one file: the first is read, and the second is told; what PX4 appends after a crash likewise.
#[test]
fn what_follows_a_log_is_left_out_and_told() {
    for log in logs() {
        let twice = [&log[..], &log].concat();
        let both = review(&twice).unwrap();
        assert_eq!(both.seconds, review(&log).unwrap().seconds);
        let told = format!("a second log begins at byte {} of the file", log.len());
        assert!(
            both.warnings.iter().any(|warning| warning.contains(&told)),
            "{both}"
        );
    }
    let [log, _] = logs();
    let offset = log.len() as u64 - 7 + 43;
    let flags = [
        &[40, 0, b'B'][..],
        &[0; 8],
        &[1],
        &[0; 7],
        &offset.to_le_bytes(),
        &[0; 16],
    ]
    .concat();
    let crashed = [&log[..16], &flags, &log[16..log.len() - 7], &[9, 0, b'I', 1, 2]].concat();
    let review = review(&crashed).unwrap();
    assert!(
        review
            .warnings
            .iter()
            .any(|warning| warning.contains("(a crash dump) are left out")),
        "{review}"
    );
}

#[test]
fn what_is_no_log_of_this_vehicle_is_refused_by_name() {
    let compiled = compiled();
    let with = |name: &str, value: f64| {
        let mut frame = px4_frame(&compiled);
        frame.retain(|(of, _)| of != name);
        frame.push((name.to_owned(), value));
        px4_log(&compiled, &frame)
    };
    let spin = px4_frame(&compiled)
        .iter()
        .find(|(name, _)| name == "CA_ROTOR3_KM")
        .unwrap()
        .1;
    let place = px4_frame(&compiled)
        .iter()
        .find(|(name, _)| name == "CA_ROTOR3_PX")
        .unwrap()
        .1;
    let mut quad = px4_frame(&compiled);
    quad.retain(|(name, _)| {
        !["4", "5", "6", "7", "COUNT"]
            .iter()
            .any(|k| name.starts_with(&format!("CA_ROTOR{k}_")))
    });
    quad.retain(|(name, _)| name != "CA_ROTOR_COUNT");
    quad.push(("CA_ROTOR_COUNT".to_owned(), 4.0));
    let frame_y6 = parameters(&[("FRAME_CLASS", 5.0), ("FRAME_TYPE", 10.0)]);
    let no_outputs = ulog(
        &px4_frame(&compiled),
        &[Topic {
            name: "sensor_combined",
            fields: "float[3] accelerometer_m_s2;",
            period_s: 0.01,
            rows: &force,
        }],
        SECONDS,
    );
    let short = ardupilot_log(&compiled, &ardupilot_frame());
    for (log, message) in [
        (with("CA_ROTOR3_KM", -spin), "motor 4 turns"),
        (with("CA_ROTOR3_PX", -place), "motor 4 is"),
        (px4_log(&compiled, &quad), "it has 4 motors, x8 8 rotors"),
        (ardupilot_log(&compiled, &frame_y6), "it has 6 motors"),
        (no_outputs, "`actuator_motors`"),
        (px4_log(&compiled, &[]), "no parameters"),
        (b"\xfd7zXZ\0".to_vec(), "xz -dk"),
        (b"FMT, 128, 89, FMT".to_vec(), ".bin"),
        (b"hello".to_vec(), "neither PX4's ULog"),
        (Vec::new(), "the file is empty"),
        (b"ULogEnc\x01".to_vec(), "an encrypted log"),
        (
            b"\0\x05\x9f\xd6\x3a\x4c\0\0\xfd\x09".to_vec(),
            "a telemetry log (.tlog)",
        ),
        (b"\xfe\x09".to_vec(), "a telemetry log (.tlog)"),
        (short[..2000].to_vec(), "no accelerometer (`IMU`)"),
    ] {
        let error = review(&log).unwrap_err();
        assert!(
            error.starts_with("a.log: ") && error.contains(message),
            "{message}: {error}"
        );
    }
}

/// The upper and the lower outputs of the file exchanged, with the spins that the log has.
#[test]
fn exchanged_layers_are_another_vehicle() {
    let text = compiled().source.text;
    let exchanged = text
        .replace(
            "[[0, 5], [3, 6], [2, 7], [1, 4]]",
            "[[5, 0], [6, 3], [7, 2], [4, 1]]",
        )
        .replace("first_spin = \"ccw\"", "first_spin = \"cw\"");
    let exchanged = mixer_compiler::compile(&Source::new("x8.toml", exchanged)).unwrap();
    let mut frame = px4_frame(&compiled());
    for unit in &compiled().airframe.units {
        let layers = unit.channels().zip([-0.05, 0.05]);
        frame.extend(layers.map(|(channel, at)| (format!("CA_ROTOR{channel}_PZ"), at)));
    }
    for log in [
        px4_log(&compiled(), &frame),
        ardupilot_log(&compiled(), &ardupilot_frame()),
    ] {
        review(&log).unwrap();
        let refused = Flight::read("a.log", &log, &exchanged.airframe, None).unwrap_err();
        assert!(
            refused.contains("with the layers exchanged: motor 1 is the upper rotor there"),
            "{refused}"
        );
    }
}

#[test]
fn a_log_of_the_ground_is_refused() {
    let compiled = compiled();
    let topics = [
        Topic {
            name: "actuator_motors",
            fields: "float[8] control;",
            period_s: 0.1,
            rows: &|_| vec![0.2; 8],
        },
        Topic {
            name: "sensor_combined",
            fields: "float[3] accelerometer_m_s2;",
            period_s: 0.01,
            rows: &|_| vec![0.0, 0.0, -9.81],
        },
    ];
    let error = review(&ulog(&px4_frame(&compiled), &topics, SECONDS)).unwrap_err();
    assert!(error.contains("a log of the ground: 30 s"), "{error}");
}

/// Damages drawn of each log; `MIXER_DRAWS` draws more.
const DRAWS: usize = 60;

/// Where the definitions of both logs end, in bytes.
const DEFINITIONS: usize = 4000;

/// A damaged log is read as far as it goes, or refused; nothing panics, and an interval that misses the whole
/// log's scale has a word of damage.
#[test]
fn damaged_logs_do_no_harm() {
    for (format, log) in ["ULog", "DataFlash"].into_iter().zip(logs()) {
        let whole = review(&log).unwrap().thrust.scale.unwrap();
        let mut state = 1u64;
        let mut next = |below: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        };
        let draws = std::env::var("MIXER_DRAWS").map_or(DRAWS, |draws| draws.parse().expect("a number"));
        let (mut drawn, mut refused, mut told, mut sound) = ([0; 5], [0; 5], [0; 5], [0; 5]);
        let mut silent: [Vec<String>; 5] = Default::default();
        for draw in 0..draws {
            let kind = draw % 5;
            // Formats, parameters and subscriptions stand at the beginning: half of the damages are there.
            let end = [log.len(), DEFINITIONS][next(2)];
            let mut damaged = log.clone();
            match kind {
                0 => damaged.truncate(next(end)),
                _ => (0..1 + next(20)).for_each(|_| {
                    let at = next(end.min(damaged.len()));
                    match kind {
                        1 => damaged[at] ^= 1 << next(8),
                        2 => damaged[at] = [0, 1, 2, 0x7f, 0xff][next(5)],
                        3 => drop(damaged.remove(at)),
                        _ => damaged.insert(at, damaged[at / 2]),
                    }
                }),
            }
            drawn[kind] += 1;
            let Ok(review) = review(&damaged) else {
                refused[kind] += 1;
                continue;
            };
            let words = ["damage", "is missing", "cannot be", "left out"];
            let is_told = review
                .warnings
                .iter()
                .any(|text| words.iter().any(|word| text.contains(word)));
            let [low, high] = review.thrust.interval;
            match (is_told, (low..=high).contains(&whole)) {
                (true, _) => told[kind] += 1,
                (false, true) => sound[kind] += 1,
                (false, false) => {
                    silent[kind].push(format!("{draw}: {low:.3} to {high:.3} {:?}", review.warnings))
                }
            }
        }
        println!(
            "{format}: damage, drawn, refused, told, scale in the interval without a word, scale missed without a word"
        );
        for (kind, name) in ["cut off", "a bit", "a byte", "bytes missing", "bytes too many"]
            .iter()
            .enumerate()
        {
            let missed = silent[kind].len();
            println!(
                "| {name} | {} | {} | {} | {} | {missed} |",
                drawn[kind], refused[kind], told[kind], sound[kind]
            );
        }
        // A parameter or a format with another sound value is no damage that anything shows.
        let silent = silent.concat();
        assert!(500 * silent.len() <= draws, "{silent:#?}");
    }
    let [log, _] = logs();
    let cut = review(&log[..log.len() - 5]).unwrap();
    assert!(
        cut.warnings
            .iter()
            .any(|warning| warning.contains("ends within a message")),
        "{cut}"
    );
}

/// Messages shorter than what their own lengths say, on which decoders index: the file is named with what
/// is wrong.
#[test]
fn lengths_are_checked_before_they_are_believed() {
    let compiled = compiled();
    let ulog = |kind: u8, payload: &[u8]| {
        let mut bytes = b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0".to_vec();
        bytes.extend((payload.len() as u16).to_le_bytes());
        bytes.push(kind);
        bytes.extend(payload);
        bytes.extend([0; 60]);
        bytes
    };
    let short_format = [&[0xa3, 0x95, 0x80, 0x81, 2][..], &[b'B'; 200]].concat();
    let cases = [
        (ulog(b'P', &[]), "a parameter shorter than its name at byte 16"),
        (
            ulog(b'P', b"\xc8int32_t A1234"),
            "a parameter shorter than its name at byte 16",
        ),
        (ulog(b'A', &[]), "a subscription without a name at byte 16"),
        (ulog(b'A', &[0, 1]), "a subscription without a name at byte 16"),
        (ulog(b'F', b"a:"), "a format without a size at byte 16"),
        (ulog(b'F', b"a:b[0] c;"), "a format without a size at byte 16"),
        (short_format, "a format shorter than its header"),
    ];
    for (log, wanted) in cases {
        let refused = Flight::read("my.log", &log, &compiled.airframe, None).unwrap_err();
        assert!(
            refused.starts_with("my.log: the log is damaged") && refused.contains(wanted),
            "{refused}"
        );
    }
}
