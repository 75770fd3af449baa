use super::*;

fn find(line: &str) -> Columns {
    find_by_hand(line, &ByHand::default()).expect("a header that serves")
}

fn find_by_hand(line: &str, by_hand: &ByHand) -> Result<Columns, Refusal> {
    let headings: Vec<Heading> = line.split(',').map(Heading::of).collect();
    Columns::find("bench.csv:1", &headings, by_hand)
}

fn at(column: &Option<Column>) -> Option<usize> {
    column.as_ref().map(|c| c.index)
}

#[test]
fn coaxial_map() {
    let c = find(
        "PWM Left,PWM Right,Dxl 1 Pos ,Dxl 2 Pos ,Thrust Left [g],Torque Left [Nm],Thrust Right [g],\
         Torque Right [Nm],Thrust Centre [g],Torque Centre [Nm],Voltage Left [V],Voltage Right [V],\
         Current Left [A],Current Right [A],Speed Left [rpm],Speed Right [rpm],Total Thrust [g],\
         Total Torque [Nm],Time [s]",
    );
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1])
        ),
        (Some(0), Some(1))
    );
    assert_eq!(
        (
            at(&c[Quantity::Thrust].whole),
            at(&c[Quantity::Torque].whole),
            at(&c[Quantity::Voltage].rotors[0])
        ),
        (Some(16), Some(17), Some(10))
    );
    assert_eq!(c[Quantity::Thrust].rotors.each_ref().map(at), [Some(4), Some(6)]);
    assert_eq!(
        c[Quantity::Throttle].rotors[0].clone().expect("upper").scale,
        Scale::Pulse(1.0)
    );
    assert!(c.sides_named);
}

#[test]
fn rcbenchmark_single() {
    let c = find(
        "Time (s),ESC signal (µs),Servo 1 (µs),AccX (g),Torque (N·m),Thrust (gf),Voltage (V),Current (A),\
         Motor Electrical Speed (RPM),Electrical Power (W),Propeller Mech. Efficiency (gf/W),App message,",
    );
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1]),
            at(&c[Quantity::Torque].whole),
            at(&c[Quantity::Thrust].whole)
        ),
        (Some(1), None, Some(4), Some(5))
    );
    assert_eq!(at(&c[Quantity::Time].whole), Some(0));
}

#[test]
fn rcbenchmark_dual() {
    let c = find(
        "Time (s),ESC A (us),Torque A (N-m),Thrust A (N),Voltage A (V),ESC B (us),Torque B (N-m),Thrust B (N)",
    );
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1]),
            at(&c[Quantity::Thrust].whole)
        ),
        (Some(1), Some(5), None)
    );
    assert_eq!(c[Quantity::Torque].rotors.each_ref().map(at), [Some(2), Some(6)]);
    assert!(!c.sides_named, "A and B do not say which is above");
}

#[test]
fn flight_stand_with_edited_prefixes() {
    let c = find(
        "Time (s),Rear - ESC throttle (μs),Rear - force Fz (thrust) (kgf),Rear - torque MZ (torque) (N⋅m),\
         Rear - voltage (V),Front - ESC throttle (μs),Front - force Fz (thrust) (kgf),\
         Front - torque MZ (torque) (N⋅m),Front - voltage (V),Front - propeller efficiency (gf/W)",
    );
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1]),
            at(&c[Quantity::Voltage].rotors[0])
        ),
        (Some(1), Some(5), Some(4))
    );
    assert_eq!(c[Quantity::Thrust].rotors.each_ref().map(at), [Some(2), Some(6)]);
    assert_eq!(
        c[Quantity::Thrust].rotors[0].as_ref().expect("thrust").scale,
        Scale::Factor(9.80665)
    );
    let c = find("Bottom motor - ESC throttle (%),Top motor - ESC throttle (%),thrust_n");
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1]),
            c.sides_named
        ),
        (Some(1), Some(0), true)
    );
    // One prefix only: a single rotor on the stand.
    let c = find("Powertrain 1 - ESC throttle (μs),Powertrain 1 - force Fz (thrust) (N)");
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1]),
            at(&c[Quantity::Thrust].whole)
        ),
        (Some(0), None, Some(1))
    );
}

#[test]
fn plain() {
    let c = find("upper,lower,thrust_n,torque_nm,voltage_v");
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1]),
            at(&c[Quantity::Thrust].whole),
            at(&c[Quantity::Torque].whole)
        ),
        (Some(0), Some(1), Some(2), Some(3))
    );
    assert_eq!(
        c[Quantity::Throttle].rotors[0].clone().expect("upper").scale,
        Scale::Factor(1.0)
    );
    let c = find("upper,lower,thrust_gf,torque_ozf-in");
    assert_eq!(
        c[Quantity::Thrust].whole.as_ref().expect("thrust").scale,
        Scale::Factor(0.00980665)
    );
}

#[test]
fn by_hand() {
    let hand = ByHand {
        columns: vec![
            ("upper".into(), "cmd one".into()),
            ("lower".into(), "#2".into()),
            ("thrust".into(), "F".into()),
            ("torque".into(), "M (N·m)".into()),
        ],
        units: vec![("thrust".into(), "kgf".into())],
        ..ByHand::default()
    };
    let c = find_by_hand("cmd_one,x,F,M (N⋅m)", &hand).expect("mapped");
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1]),
            at(&c[Quantity::Thrust].whole),
            at(&c[Quantity::Torque].whole)
        ),
        (Some(0), Some(1), Some(2), Some(3))
    );
    let error = find_by_hand("a,b", &hand).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("no column \"cmd one\" for the role upper"),
        "{error}"
    );
}

#[test]
fn swap_exchanges_the_rotors() {
    let hand = ByHand {
        swap: true,
        ..ByHand::default()
    };
    let c = find_by_hand("ESC A (us),ESC B (us),Thrust A (N),Thrust B (N)", &hand).expect("a header");
    assert_eq!(
        (
            at(&c[Quantity::Throttle].rotors[0]),
            at(&c[Quantity::Throttle].rotors[1])
        ),
        (Some(1), Some(0))
    );
    assert_eq!(c[Quantity::Thrust].rotors.each_ref().map(at), [Some(3), Some(2)]);
}

#[test]
fn missing_and_unknown_units_and_doubles() {
    let none = ByHand::default();
    let error = find_by_hand("upper,lower,Thrust", &none).unwrap_err().to_string();
    assert!(
        error.contains("has no unit") && error.contains("--unit thrust="),
        "{error}"
    );
    let error = find_by_hand("upper,lower,Thrust (furlong)", &none)
        .unwrap_err()
        .to_string();
    assert!(error.contains("furlong"), "{error}");
    let error = find_by_hand("upper,lower,Thrust (N),Thrust raw (N)", &none)
        .unwrap_err()
        .to_string();
    assert!(error.contains("both look like the thrust"), "{error}");
}

#[test]
fn sides_by_words_of_three_languages_and_in_the_airs_way() {
    for (upper, lower, is_above) in [
        ("top", "bottom", true),
        ("Gas oben (%)", "Gas unten (%)", true),
        ("Gaz haut (%)", "Gaz bas (%)", true),
        ("front", "rear", false),
        ("Gas vorn (%)", "Gas hinten (%)", false),
        ("Gaz avant (%)", "Gaz arri\u{e8}re (%)", false),
    ] {
        for [first, second] in [[upper, lower], [lower, upper]] {
            let columns = find(&format!("{first},{second},thrust_n,Moment (Nm)"));
            let throttles = columns[Quantity::Throttle].rotors.each_ref();
            let names = throttles.map(|column| column.as_ref().map(|column| column.name.as_str()));
            assert_eq!(names, [Some(upper), Some(lower)]);
            assert_eq!(columns.sides_named, is_above, "{upper}");
        }
    }
    // A side that no word says: the mend names no column for it.
    let refused = find_by_hand("gas nord,gas sud,thrust_n,torque_nm", &ByHand::default()).unwrap_err();
    assert_eq!(
        refused.needed,
        "--column throttle=\"gas sud\" of one rotor; of two --column upper=HEADER and --column lower=HEADER"
    );
}

/// Columns of one name are told by their numbers, and a name that two have is refused.
#[test]
fn columns_of_one_name() {
    const HEADER: &str = "Throttle (%),Thrust (N),Thrust (N),Torque (Nm)";
    let refused = |columns: &[(&str, &str)]| {
        let columns = columns
            .iter()
            .map(|(role, name)| ((*role).to_owned(), (*name).to_owned()));
        let by_hand = ByHand {
            columns: columns.collect(),
            ..ByHand::default()
        };
        find_by_hand(HEADER, &by_hand).map_err(|refusal| refusal.to_string())
    };
    for columns in [&[][..], &[("thrust", "Thrust")]] {
        let told = refused(columns).unwrap_err();
        assert!(
            told.contains("--column thrust=#2 or --column thrust=#3"),
            "{told}"
        );
    }
    let found = refused(&[("thrust", "#3")]).expect("a column by its number");
    assert_eq!(at(&found[Quantity::Thrust].whole), Some(2));
}

/// Roles of single rotors say which is the upper one; of both throttles they say it for good.
#[test]
fn sides_by_hand() {
    let by_hand = |columns: &[(&str, &str)]| ByHand {
        columns: columns
            .iter()
            .map(|(role, name)| ((*role).to_owned(), (*name).to_owned()))
            .collect(),
        ..ByHand::default()
    };
    const HEADER: &str = "a,b,Thrust (N),Torque (Nm),f a (N),f b (N)";
    let throttles = [("upper", "a"), ("lower", "b")];
    let found = find_by_hand(HEADER, &by_hand(&throttles)).expect("a map");
    assert!(found.sides_named && found.sides_by_hand);
    let found = find_by_hand(
        "ESC A (us),ESC B (us),x (N),y (N),Torque (Nm)",
        &by_hand(&[("upper_thrust", "x"), ("lower_thrust", "y")]),
    );
    let found = found.expect("a map");
    assert!(found.sides_named && !found.sides_by_hand);
}
