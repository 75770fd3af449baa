//! Requests that an earlier mixer answered badly: `regressions.toml` has each with its frame and
//! what is expected.

use mixer_compiler::Compiled;
use mixer_rt::Health;
use mixer_tests::frames::{self, AIRMODES, BENT, Options, Place};
use mixer_tests::golden;
use mixer_tests::optimum::Oracle;
use mixer_tests::request::{Frame, Request};
use mixer_tests::shortfall::{ALLOWED, Shortfall};
use mixer_tests::soundness;
use toml::{Table, Value};

use crate::{compile, compile_with_pair, out, place};

const CASES: &str = include_str!("regressions.toml");

fn tables<'a>(table: &'a Table, key: &str) -> impl Iterator<Item = &'a Table> {
    let list = table[key].as_array().expect("a list");
    list.iter().map(|item| item.as_table().expect("a table"))
}

fn word<'a>(table: &'a Table, key: &str) -> &'a str {
    table[key].as_str().expect("a word")
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let list = value.as_array().expect("a list").iter();
    let numbers: Vec<f64> = list.map(|item| item.as_float().expect("a number")).collect();
    numbers.try_into().expect("as many numbers")
}

fn unit(unit: &Table) -> Place {
    let clockwise = match word(unit, "upper_spin") {
        "cw" => true,
        "ccw" => false,
        other => panic!("no spin: {other}"),
    };
    place(numbers(&unit["position_m"]), numbers(&unit["tilt"]), clockwise)
}

/// The case's airframe file, with the airmode of the case where it states one.
fn shipped(case: &Table) -> Result<Compiled, String> {
    let text = golden::text(word(case, "airframe"))?;
    let Some(airmode) = case.get("airmode") else {
        return frames::compile_text(&text);
    };
    let mut file: Table = text.parse().map_err(|error| format!("{error}"))?;
    let allocation = file.entry("allocation").or_insert(Table::new().into());
    let allocation = allocation.as_table_mut().expect("a table");
    allocation.insert("airmode".to_owned(), airmode.clone());
    frames::compile_text(&file.to_string())
}

fn frame(case: &Table) -> Frame {
    if case.contains_key("airframe") {
        return Frame::new(shipped(case).expect("compiles"));
    }
    let units: Vec<Place> = match case.get("frame") {
        None => tables(case, "units").map(unit).collect(),
        Some(_) => named(frames::regular_frames(), word(case, "frame")),
    };
    let airmode = named(AIRMODES.map(|mode| (mode, mode)), word(case, "airmode"));
    let reserve = case["yaw_reserve_nm"].as_float().expect("a number");
    if !case.contains_key("pair") {
        return compile(&units, airmode, reserve);
    }
    let options = Options {
        airmode,
        yaw_reserve_nm: reserve,
        ..Options::default()
    };
    let pair = named(BENT, word(case, "pair"));
    compile_with_pair(pair, &units, options)
}

fn named<T>(all: impl IntoIterator<Item = (&'static str, T)>, name: &str) -> T {
    let found = all.into_iter().find(|(own, _)| *own == name);
    found.unwrap_or_else(|| panic!("nothing is named {name}")).1
}

/// The case's wrenches: a list, a sweep in steps, or what throttles give.
fn wrenches(case: &Table, frame: &Frame, volts: f32) -> Vec<[f32; 4]> {
    let wrenches: Vec<[f64; 4]> = match (case.get("sweep"), case.get("throttles")) {
        (None, None) => {
            let requests = case["requests"].as_array().expect("a list").iter();
            requests.map(numbers).collect()
        }
        (None, Some(throttles)) => {
            let shares = throttles.as_array().expect("a list").iter();
            let shares = shares.map(|share| share.as_float().expect("a number"));
            let throttles = frame.physics.throttles(shares, Health::GOOD);
            vec![frame.physics.wrench(&throttles, volts)]
        }
        (Some(sweep), _) => {
            let [from, to] = ["from", "to"].map(|end| numbers::<4>(&sweep[end]));
            let steps = sweep["steps"].as_integer().expect("a number of steps");
            let along = |step: i64| step as f64 / steps as f64;
            let at = |share: f64| std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]));
            (0..=steps).map(|step| at(along(step))).collect()
        }
    };
    wrenches
        .into_iter()
        .map(|wrench| wrench.map(|x| x as f32))
        .collect()
}

/// No throttle moves by more than 0.02 between the two.
fn assert_is_steady(frame: &Frame, [request, next]: [&Request; 2]) {
    let [answer, moved] = [request, next].map(|request| request.mix(frame).expect("finite"));
    let change = answer.change(&moved);
    assert!(change <= 0.02, "{change}: {answer:?}, then {moved:?}");
}

/// Yaw changes by no more than 1 % of its authority between the two.
fn assert_yaw_is_steady(frame: &Frame, [request, next]: [&Request; 2]) {
    let [answer, next] = [request, next].map(|request| request.mix(frame).expect("finite"));
    let change = (answer.achieved[2] - next.achieved[2]).abs();
    assert!(
        change <= 0.01 * frame.authority[2],
        "{request:?}: {:?} and {:?}",
        answer.achieved,
        next.achieved
    );
}

/// Each request with the next one: of the list, or with 1e-4 more on the case's axis.
fn neighbours(case: &Table, requests: &[Request]) -> Vec<[Request; 2]> {
    let Some(axis) = case.get("neighbour") else {
        assert!(requests.len() > 1, "a neighbour is missing");
        return requests.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    };
    let axes = ["roll", "pitch", "yaw", "thrust"];
    let axis = axes.iter().position(|name| axis.as_str() == Some(name));
    let axis = axis.expect("an axis");
    let next = |request: &Request| {
        let mut next = *request;
        next.wrench[axis] *= 1.0 + 1e-4;
        [*request, next]
    };
    requests.iter().map(next).collect()
}

/// No axis is reversed or exceeded.
fn assert_is_sound(frame: &Frame, request: &Request) {
    let answer = request.mix(frame).expect("finite");
    let fault = soundness::fault(frame, request, &answer).expect("solved");
    assert_eq!(fault, None, "{request:?} -> {answer:?}");
}

/// The answer is sound and as good as the optimum.
fn assert_is_optimal(frame: &Frame, request: &Request) {
    assert_is_sound(frame, request);
    let answer = request.mix(frame).expect("finite");
    let factors = request.factors(frame);
    let oracle = |build: fn(&_, &_, _, _) -> Oracle| {
        build(&frame.physics, frame.allocation(), factors, request.health)
    };
    let shortfall = Shortfall::beyond_hulls(&answer, request, frame, ALLOWED, &oracle(Oracle::new), || {
        oracle(Oracle::exact)
    });
    let shortfall = shortfall.expect("solved");
    assert!(
        shortfall.is_some_and(|shortfall| !shortfall.misses()),
        "{shortfall:?}: {request:?} -> {answer:?}"
    );
}

/// The guard, where the interior point method does not converge: half of roll and pitch at least, at the thrust asked.
fn assert_attitude_is_kept(frame: &Frame, request: &Request) {
    assert_is_sound(frame, request);
    let answer = request.mix(frame).expect("finite");
    let missed: Vec<f64> = (0..4)
        .map(|axis| (f64::from(request.wrench[axis]) - answer.achieved[axis]).abs())
        .collect();
    let is_kept = |axis: usize| {
        missed[axis] <= 0.501 * f64::from(request.wrench[axis].abs()) + 0.003 * frame.size(axis)
    };
    assert!(
        is_kept(0) && is_kept(1) && missed[3] < 0.002 * frame.size(3),
        "{request:?} -> {answer:?}"
    );
}

#[test]
fn what_was_answered_badly_once_is_answered_well() {
    let file: Table = CASES.parse().expect("TOML");
    let mut count = 0;
    for case in tables(&file, "case") {
        println!("{}: {}", word(case, "name"), word(case, "why"));
        let frame = frame(case);
        let volts = case["voltage_v"].as_float().expect("a number") as f32;
        let failed: Vec<u8> = case.get("failed_rotors").map_or(Vec::new(), |failed| {
            let channels = failed.as_array().expect("a list").iter();
            channels
                .map(|channel| channel.as_integer().expect("a channel") as u8)
                .collect()
        });
        let health: Health = out(&failed);
        let requests: Vec<Request> = wrenches(case, &frame, volts)
            .into_iter()
            .map(|wrench| Request {
                wrench,
                volts,
                density: None,
                health,
            })
            .collect();
        match word(case, "expect") {
            "steady" => neighbours(case, &requests)
                .iter()
                .for_each(|[request, next]| assert_is_steady(&frame, [request, next])),
            "steady-yaw" => neighbours(case, &requests)
                .iter()
                .for_each(|[request, next]| assert_yaw_is_steady(&frame, [request, next])),
            "sound" => requests
                .iter()
                .for_each(|request| assert_is_sound(&frame, request)),
            "kept" => requests
                .iter()
                .for_each(|request| assert_attitude_is_kept(&frame, request)),
            "optimal" => requests
                .iter()
                .for_each(|request| assert_is_optimal(&frame, request)),
            other => panic!("nothing is {other}"),
        }
        count += 1;
    }
    assert!(count >= 32, "{count} cases");
}
