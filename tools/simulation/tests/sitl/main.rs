//! The outside simulator, served to clients of our own that speak both protocols: no flight stack is
//! needed.

mod ardupilot;
mod controller;
mod px4;
mod server;
mod station;

use std::time::{Duration, Instant};

use ardupilot::Ardupilot;
use controller::Controller;
use mavlink::dialects::common::{MavCmd, MavMessage};
use px4::Px4;
use server::{Server, csv_rows};
use station::Station;

/// Rotors of `examples/simulator/x8.toml`.
const ROTORS: usize = 8;

/// Weight of its 6.5 kg, N.
const WEIGHT_N: f64 = 6.5 * 9.806_65;

/// What a client knows after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Truth {
    time_us: u64,
    /// North, east, down, m and m/s.
    position: [f64; 3],
    velocity: [f64; 3],
    /// w, x, y, z
    quaternion: [f64; 4],
    /// About forward, right, down, rad/s.
    rate: [f64; 3],
    /// Specific force, m/s2.
    acceleration: [f64; 3],
}

/// What a simulator sees of a flight stack.
trait Client {
    /// One step under throttles; the state after it.
    fn step(&mut self, throttles: &[f64; ROTORS]) -> Truth;

    /// Steps for so long.
    fn run(&mut self, throttles: &[f64; ROTORS], seconds: f64) -> Truth {
        let first = self.step(throttles);
        let mut last = first;
        while (last.time_us - first.time_us) as f64 * 1e-6 < seconds {
            last = self.step(throttles);
        }
        last
    }
}

fn alike(throttle: f64) -> [f64; ROTORS] {
    [throttle; ROTORS]
}

/// Takes off on all rotors alike, then hovers at the throttle that the simulator has predicted.
fn take_off_and_hover<C: Client>(client: &mut C, hover: f64) {
    let still = client.run(&alike(0.98 * hover), 1.0);
    assert_eq!(still.position, [0.0; 3], "the ground holds it: {still:?}");
    assert!((still.acceleration[2] + 9.806_65).abs() < 1e-6, "{still:?}");
    let climbing = client.run(&alike(1.05 * hover), 1.0);
    assert!(climbing.velocity[2] < -0.3, "{climbing:?}");
    // The rotors come down to hover within their lag.
    let before = client.run(&alike(hover), 0.5);
    let after = client.run(&alike(hover), 1.0);
    let gained = after.velocity[2] - before.velocity[2];
    // PX4's message has centimetres per second.
    assert!(gained.abs() < 0.02, "{gained} m/s within a second: {after:?}");
    assert!(after.rate.iter().all(|rate| rate.abs() < 1e-6), "{after:?}");
    assert!(after.position[2] < before.position[2], "{after:?}");
}

/// Raises the outputs that `cargo mixer check` names and looks at the sign of the rate.
fn signs_of_all_axes<C: Client>(client: &mut C, hover: f64) {
    let axes = [[1, 2, 4, 7], [0, 1, 4, 5], [0, 2, 4, 6]];
    client.run(&alike(1.1 * hover), 2.0);
    for (axis, outputs) in axes.iter().enumerate() {
        let before = client.run(&alike(hover), 0.3);
        let mut throttles = alike(0.98 * hover);
        for output in outputs {
            throttles[*output] = 1.02 * hover;
        }
        let after = client.run(&throttles, 0.15);
        let gained: Vec<f64> = after.rate.iter().zip(before.rate).map(|(a, b)| a - b).collect();
        let largest = gained.iter().fold(0.0f64, |most, rate| most.max(rate.abs()));
        assert!(
            gained[axis] > 0.01 && gained[axis] == largest,
            "axis {axis}: {gained:?}"
        );
        // And back, so that it does not tip over.
        let mirrored = throttles.map(|throttle| 2.0 * hover - throttle);
        client.run(&mirrored, 0.15);
    }
}

/// The rotors of output 0 are in front on the right: without one, right side and nose go down.
fn a_rotor_out<C: Client>(client: &mut C, hover: f64) {
    client.run(&alike(1.05 * hover), 0.9);
    let before = client.run(&alike(hover), 0.05);
    let after = client.run(&alike(hover), 0.3);
    assert!(before.rate.iter().all(|rate| rate.abs() < 1e-6), "{before:?}");
    assert!(after.rate[0] > 0.2 && after.rate[1] < -0.2, "{after:?}");
    assert!(after.velocity[2] > before.velocity[2], "{after:?}");
}

#[test]
fn px4_takes_off_hovers_and_turns_the_right_way() {
    for fly in [take_off_and_hover::<Px4>, signs_of_all_axes::<Px4>] {
        let server = Server::start("px4-axes", &["--px4", "--link", "0", "--noise", "0"]);
        fly(&mut Px4::connect(&server), server.hover);
    }
}

#[test]
fn ardupilot_takes_off_hovers_and_turns_the_right_way() {
    for fly in [take_off_and_hover::<Ardupilot>, signs_of_all_axes::<Ardupilot>] {
        let server = Server::start("ardupilot-axes", &["--ardupilot", "--noise", "0"]);
        fly(&mut Ardupilot::connect(&server), server.hover);
    }
}

#[test]
fn a_rotor_stops_when_it_is_told_to() {
    let fail = ["--fail", "0@1.02", "--noise", "0"];
    let server = Server::start("px4-fail", &[&["--px4", "--link", "0"][..], &fail].concat());
    a_rotor_out(&mut Px4::connect(&server), server.hover);
    let server = Server::start("ardupilot-fail", &[&["--ardupilot"][..], &fail].concat());
    a_rotor_out(&mut Ardupilot::connect(&server), server.hover);
}

#[test]
fn px4_hears_of_its_battery_and_of_a_rotor_that_stops() {
    let station = Station::new();
    let link = station.port.to_string();
    let server = Server::start(
        "px4-battery",
        &[
            "--px4",
            "--link",
            &link,
            "--fail",
            "2@0.3",
            "--resistance",
            "0.05",
        ],
    );
    let mut px4 = Px4::connect(&server);
    let (mut volts, mut motors) = (Vec::new(), Vec::new());
    for step in 0..200 {
        if step % 50 == 0 {
            station.send_heartbeat();
        }
        px4.step(&alike(if step < 100 { 0.0 } else { 0.5 }));
        for (from, message) in station.receive() {
            match message {
                MavMessage::BATTERY_STATUS(battery) => {
                    // The system of the heartbeat, another component than the autopilot.
                    assert_eq!(from, [3, 180]);
                    let cells = battery.voltages.iter().take_while(|cell| **cell != u16::MAX);
                    volts.push(cells.map(|cell| f64::from(*cell) * 1e-3).sum::<f64>());
                }
                MavMessage::COMMAND_LONG(command) if command.command == MavCmd::MAV_CMD_INJECT_FAILURE => {
                    assert_eq!([command.param1, command.param2], [101.0, 2.0]);
                    motors.push(command.param3);
                }
                _ => {}
            }
        }
    }
    assert!((volts[0] - 21.86).abs() < 0.01, "{volts:?}");
    let loaded = volts.last().unwrap();
    assert!((20.0..21.8).contains(loaded), "{volts:?}");
    // Motors count from 1.
    assert_eq!(motors, [3.0]);
}

#[test]
fn lockstep_waits_for_px4() {
    let server = Server::start("px4-lockstep", &["--px4", "--link", "0"]);
    let mut px4 = Px4::connect(&server);
    let first = px4.step(&alike(0.0));
    // No answer, so no further sample.
    assert_eq!(px4.receive(Duration::from_millis(300)), None);
    let next = px4.step(&alike(0.0));
    assert_eq!(next.time_us, first.time_us + 4000);
}

#[test]
fn equal_seeds_measure_alike_and_others_do_not() {
    let measured = |seed: &str| {
        let server = Server::start("px4-seed", &["--px4", "--link", "0", "--seed", seed]);
        let mut px4 = Px4::connect(&server);
        (0..50)
            .map(|_| px4.step(&alike(0.0)).acceleration)
            .collect::<Vec<_>>()
    };
    let [first, again, other] = ["1", "1", "2"].map(measured);
    assert!(first == again && first != other);
}

#[test]
fn ardupilot_repeats_itself_and_gets_the_same_answer() {
    let server = Server::start("ardupilot-repeat", &["--ardupilot"]);
    let mut ardupilot = Ardupilot::connect(&server);
    ardupilot.step(&alike(1.0));
    let first = ardupilot.send_and_receive(&alike(1.0));
    assert_eq!(ardupilot.send_and_receive(&alike(1.0)), first);
    ardupilot.count += 1;
    assert_ne!(ardupilot.send_and_receive(&alike(1.0)), first);
    // ArduPilot starts anew: the vehicle is back on the ground, time goes on.
    let flown = ardupilot.run(&alike(1.0), 1.0);
    assert!(flown.position[2] < -1.0, "{flown:?}");
    ardupilot.count = 0;
    let anew = ardupilot.step(&alike(0.0));
    assert!(
        anew.position == [0.0; 3] && anew.time_us > flown.time_us,
        "{anew:?}"
    );
}

#[test]
fn ardupilot_with_32_channels() {
    let server = Server::start("ardupilot-32", &["--ardupilot", "--noise", "0"]);
    let mut ardupilot = Ardupilot::connect(&server);
    ardupilot.channels = 32;
    take_off_and_hover(&mut ardupilot, server.hover);
}

#[test]
fn a_client_that_vanishes_leaves_an_error_and_its_flight() {
    let server = Server::start("px4-vanishes", &["--px4", "--link", "0"]);
    let mut px4 = Px4::connect(&server);
    px4.run(&alike(0.3), 0.5);
    drop(px4);
    let end = server.end();
    assert_eq!(end.status, Some(1), "{end:?}");
    assert!(end.stderr.contains("error: PX4 has"), "{end:?}");
    assert!(end.stderr.contains("wrote "), "{end:?}");
    // 20 ms from row to row.
    let rows = csv_rows(&end.flight).len();
    assert!((20..30).contains(&rows), "{rows}");
}

#[test]
fn what_is_malformed_is_passed_over_and_counted() {
    let server = Server::start("px4-malformed", &["--px4", "--link", "0", "--seconds", "0.5"]);
    let mut px4 = Px4::connect(&server);
    px4.step(&alike(0.0));
    px4.send_raw(&[0x00, 0xfd, 0xff, 0x55, 0x01]);
    px4.send_corrupt();
    px4.send_raw(&[0x55; 300]);
    px4.answer(&alike(0.0));
    while px4.receive(Duration::from_secs(5)).is_some() {
        px4.answer(&alike(0.0));
    }
    let end = server.end();
    assert_eq!(end.status, Some(0), "{end:?}");
    assert!(!end.stdout.contains("without an answer"), "{end:?}");
    let counted = end
        .stdout
        .lines()
        .find_map(|line| line.strip_prefix("malformed pieces: "));
    assert!(counted.unwrap().parse::<u64>().unwrap() >= 1, "{end:?}");
    assert_eq!(end.stderr.matches("no MAVLink").count(), 1, "{end:?}");

    let server = Server::start("ardupilot-malformed", &["--ardupilot", "--seconds", "0.5"]);
    let mut ardupilot = Ardupilot::connect(&server);
    ardupilot.step(&alike(0.0));
    for junk in [&b""[..], b"x", &[0x1a; 40], &[0xff; 400]] {
        ardupilot.send_raw(junk);
    }
    while ardupilot.try_step(&alike(0.0)).is_some() {}
    let end = server.end();
    assert_eq!(end.status, Some(0), "{end:?}");
    assert!(end.stdout.contains("malformed packets: 4\n"), "{end:?}");
    assert_eq!(end.stderr.matches("is not ArduPilot's").count(), 1, "{end:?}");
}

#[test]
fn a_crash_is_an_error() {
    let server = Server::start("ardupilot-crash", &["--ardupilot", "--noise", "0"]);
    let mut ardupilot = Ardupilot::connect(&server);
    ardupilot.run(&alike(1.0), 1.0);
    let begun = Instant::now();
    while ardupilot.try_step(&alike(0.0)).is_some() {
        assert!(begun.elapsed() < Duration::from_secs(20), "it never comes down");
    }
    let end = server.end();
    assert_eq!(end.status, Some(1), "{end:?}");
    assert!(
        end.stderr.contains("error: the vehicle hit the ground at"),
        "{end:?}"
    );
}

/// The pilot of ArduPilot flies our mixer, with a controller of the test's own behind it.
#[test]
fn a_yaw_manoeuvre_is_flown_and_measured() {
    let mut controller = Controller::new();
    let port = controller.port().to_string();
    let server = Server::start(
        "ardupilot-yaw",
        &["--ardupilot", "--noise", "0", "--fly", "yaw", "--link", &port],
    );
    let mut ardupilot = Ardupilot::connect(&server);
    controller.accept();
    let mut throttles = alike(0.0);
    while let Some(truth) = ardupilot.try_step(&throttles) {
        throttles = controller.update(&truth);
    }
    let end = server.end();
    assert_eq!(end.status, Some(0), "{end:?}");
    let rows: Vec<Vec<&str>> = end
        .stdout
        .lines()
        .filter(|line| line.contains("deg in yaw"))
        .map(|line| line.split('|').map(str::trim).collect())
        .collect();
    let names: Vec<&str> = rows.iter().map(|row| row[1]).collect();
    assert_eq!(names, ["90 deg in yaw", "175 deg in yaw"], "{end:?}");
    for row in &rows {
        assert_eq!(row[2], "4", "{row:?}");
        let [rise_s, overshoot, height_m] =
            [3, 4, 5].map(|column: usize| row[column].parse::<f64>().unwrap());
        assert!((0.2..4.0).contains(&rise_s) && overshoot < 30.0, "{row:?}");
        // The mixer holds the thrust while it yaws.
        assert!(height_m < 0.05, "{row:?}");
    }
    let hover = end.stdout.lines().find(|line| line.starts_with("hover:"));
    assert!(
        hover.is_some_and(|hover| hover.contains("thrust setpoint 0.3")),
        "{end:?}"
    );
    let rows = csv_rows(&end.flight);
    let column = |name: &str| rows[0].iter().position(|header| header == name).unwrap();
    let [thrust, manoeuvre] = ["thrust_n", "manoeuvre_s"].map(column);
    let flown: Vec<f64> = rows[1..]
        .iter()
        .filter(|row| !row[manoeuvre].is_empty())
        .map(|row| row[thrust].parse().unwrap())
        .collect();
    let mean = flown.iter().sum::<f64>() / flown.len() as f64;
    assert!((mean / WEIGHT_N - 1.0).abs() < 0.01, "{mean}");
}

/// Who flies a manoeuvre differently from what the pilot asks for.
type Wilful = fn(&mut Controller, &mut [f64; ROTORS], f64);

#[test]
fn a_manoeuvre_that_the_stack_gives_up_is_an_error() {
    let failsafe: Wilful = |controller, _, _| controller.mode = 9;
    let disarmed: Wilful = |controller, _, _| controller.armed = false;
    let sinks: Wilful = |_, throttles, hover| *throttles = alike(0.95 * hover);
    for (name, wilful, said) in [
        (
            "failsafe",
            failsafe,
            "the stack has left mode 4, which the pilot flies in, for 9 at",
        ),
        ("disarmed", disarmed, "the stack has disarmed at"),
        ("sinks", sinks, "the vehicle has landed by itself at"),
    ] {
        let mut controller = Controller::new();
        let port = controller.port().to_string();
        let arguments = ["--ardupilot", "--noise", "0", "--fly", "steps", "--link", &port];
        let server = Server::start(&format!("ardupilot-{name}"), &arguments);
        let mut ardupilot = Ardupilot::connect(&server);
        controller.accept();
        let (mut throttles, mut hovered) = (alike(0.0), 0);
        while let Some(truth) = ardupilot.try_step(&throttles) {
            throttles = controller.update(&truth);
            hovered += usize::from(truth.position[2] < -4.5);
            // In the first step of the manoeuvre, which is 20 s later.
            if hovered > 10_200 {
                wilful(&mut controller, &mut throttles, server.hover);
            }
        }
        let end = server.end();
        assert_eq!(end.status, Some(1), "{end:?}");
        assert!(end.stderr.contains(&format!("error: {said}")), "{end:?}");
        assert!(
            end.stderr.contains("; it said last: EKF3 IMU0 is using GPS"),
            "{end:?}"
        );
        assert!(
            end.stdout.starts_with("hover:") && !end.stdout.contains("| step"),
            "{end:?}"
        );
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let busy = server::run(&["--px4", "--link", "0", "--port", &port]);
    assert_eq!(busy.status.code(), Some(1), "{busy:?}");
    let text = String::from_utf8_lossy(&busy.stderr).into_owned();
    assert!(text.contains(&port) && text.contains("--port"), "{text}");
    let free = ["--px4", "--port", "0", "--link", "0"];
    for (arguments, said) in [
        (&["--px4", "--fail", "8@1"][..], "no output 8"),
        (&["--ardupilot", "--mass-kg", "40"], "the vehicle weighs 392.3 N"),
        (&["--px4", "--map", "nowhere.toml"], "nowhere.toml"),
        (
            &[&free[..], &["-o", "no/such/folder.csv"]].concat(),
            "no/such/folder.csv",
        ),
        (
            &[&free[..], &["-o", server::AIRFRAME]].concat(),
            "give -o another name",
        ),
    ] {
        let run = server::run(arguments);
        assert_eq!(run.status.code(), Some(1), "{run:?}");
        let text = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(text.contains(said), "{said}: {text}");
    }
    for arguments in [
        &[][..],
        &["--px4", "--ardupilot"],
        &["--px4", "--inertia", "1,2"],
        &["--px4", "--density", "5"],
        &["--px4", "--rotor-lag", "0.05", "--rotor-inertia", "3e-4"],
        &["--px4", "--density", "0.9", "--altitude", "3000"],
    ] {
        assert_eq!(server::run(arguments).status.code(), Some(2), "{arguments:?}");
    }
}
