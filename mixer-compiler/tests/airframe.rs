//! Airframe files that are sound, and what becomes of them.

use std::path::Path;

use mixer_compiler::Source;
use mixer_compiler::airframe::{
    Airframe, Airmode, Axis, Basis, EXPONENT_DEVIATION, Law, Method, Spin, by_voltage,
};
use mixer_compiler::diagnostic::{Code, Diagnostics};

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

fn read(text: &str) -> Airframe {
    Airframe::read(&Source::new("test.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

/// A sound file: `PAIR` and what a test adds.
const PAIR: &str = r#"
name = "test-y6"
[throttle]
min = 0
max = 1
[pair]
basis = "cubic"
thrust_n = [0, 0, 0, 0, 5, 1, 4, 0.5, 0.25]
torque_nm = [0, 0, 0, 0, -0.1, 0, 0.1, 0, 0]
upper_spin = "cw"
"#;

#[test]
fn every_airframe_of_the_project_reads() {
    let mut read = 0;
    for entry in std::fs::read_dir(workspace().join("airframes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let source = Source::new(
            path.display().to_string(),
            std::fs::read_to_string(&path).unwrap(),
        );
        let airframe = Airframe::read(&source).unwrap_or_else(|faults| panic!("{faults}"));
        assert_eq!(
            Some(airframe.name.as_str()),
            path.file_stem().and_then(|stem| stem.to_str())
        );
        read += 1;
    }
    assert!(read > 0);
}

#[test]
fn isae_x8_is_as_in_the_paper() {
    let path = workspace().join("airframes/isae-x8.toml");
    let airframe = read(&std::fs::read_to_string(path).unwrap());
    assert_eq!(airframe.module_name(), "isae_x8");
    assert_eq!(airframe.type_name(), "IsaeX8");
    assert_eq!((airframe.throttle.min, airframe.throttle.max), (0.1, 1.0));
    assert_eq!(airframe.pairs[0].basis, Basis::Biquadratic);
    assert_eq!(airframe.pairs[0].thrust_n[0], 5.2075);
    assert_eq!(airframe.pairs[0].torque_nm[7], 0.0720);
    assert_eq!(airframe.rotors(), 8);
    let signs: Vec<_> = airframe
        .units
        .iter()
        .map(|unit| airframe.spin_sign(unit))
        .collect();
    assert_eq!(signs, [1.0, -1.0, 1.0, -1.0]);
    assert_eq!(airframe.units[1].position_m, [0.3182, -0.3182, 0.0]);
    assert_eq!(airframe.units[1].axis, [0.0, 0.0, -1.0]);
    assert_eq!(
        (airframe.units[3].upper_channel, airframe.units[3].lower_channel),
        (3, Some(7))
    );
    let voltage = airframe.voltage.unwrap();
    assert_eq!(voltage.thrust, Law::Exponent(1.75));
    assert_eq!(voltage.thrust_factor(14.8), 1.0);
    assert!((voltage.torque_factor(16.8) - libm::pow(16.8 / 14.8, 1.75)).abs() < 1e-15);
    assert_eq!(airframe.inverse.method, Method::Auto);
    assert_eq!(airframe.allocation.airmode, Airmode::Disabled);
    assert_eq!(airframe.allocation.axes, Axis::ALL);
}

/// `docs/firmware.md` against PX4's `octa_cox`: motors from 1, FRD.
#[test]
fn the_guide_s_units_are_those_of_px4() {
    let guide = std::fs::read_to_string(workspace().join("docs/firmware.md")).unwrap();
    let tables: Vec<&str> = guide
        .split("```toml\n")
        .filter_map(|block| block.split("```").next())
        .filter(|block| block.starts_with("[[unit]]") || block.starts_with("[allocation]"))
        .collect();
    assert_eq!(tables.len(), 2);
    let airframe = read(&format!("{PAIR}{}", tables.concat()));
    let units: Vec<_> = airframe
        .units
        .iter()
        .map(|unit| {
            let [x, y, _] = unit.position_m.map(f64::signum);
            (
                x,
                y,
                unit.upper_spin,
                unit.upper_channel + 1,
                unit.lower_channel.unwrap() + 1,
            )
        })
        .collect();
    assert_eq!(
        units,
        [
            (1.0, 1.0, Spin::Ccw, 1, 6),
            (1.0, -1.0, Spin::Cw, 2, 5),
            (-1.0, -1.0, Spin::Ccw, 3, 8),
            (-1.0, 1.0, Spin::Cw, 4, 7)
        ]
    );
    assert_eq!(airframe.allocation.airmode, Airmode::RollPitch);
    assert_eq!(airframe.allocation.yaw_reserve_nm, 0.1);
}

#[test]
fn layout_expands_to_units_clockwise_from_the_nose() {
    let airframe = read(&format!(
        "{PAIR}[layout]\narm_m = 0.5\nunits = 4\nfirst_angle_deg = 0\n"
    ));
    let positions: Vec<_> = airframe.units.iter().map(|unit| unit.position_m).collect();
    // Exact zeros, though cos(90 degrees) is not.
    assert_eq!(
        positions,
        [
            [0.5, 0.0, 0.0],
            [0.0, 0.5, 0.0],
            [-0.5, 0.0, 0.0],
            [0.0, -0.5, 0.0]
        ]
    );
    assert!(
        positions
            .iter()
            .flatten()
            .all(|x| *x != 0.0 || x.is_sign_positive())
    );
    let spins: Vec<_> = airframe.units.iter().map(|unit| unit.upper_spin).collect();
    assert_eq!(spins, [Spin::Cw, Spin::Ccw, Spin::Cw, Spin::Ccw]);
    let channels: Vec<_> = airframe
        .units
        .iter()
        .map(|unit| unit.channels().collect::<Vec<_>>())
        .collect();
    assert_eq!(channels, [[0, 4], [1, 5], [2, 6], [3, 7]]);
}

#[test]
fn layout_equals_the_units_that_it_stands_for() {
    let short = read(&format!(
        "{PAIR}[layout]\narm_m = 0.5\nunits = 3\nfirst_angle_deg = 60\nchannels = [[0, 1], [2, 3], [4, 5]]\n"
    ));
    // PX4's hexa_cox: front right, rear, front left; on odd counts all upper rotors turn alike.
    let long = read(&format!(
        "{PAIR}[[unit]]\nposition_m = [0.25, 0.4330127018922193, 0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n\
         [[unit]]\nposition_m = [-0.5, 0, 0]\nupper_spin = \"cw\"\nchannels = [2, 3]\n\
         [[unit]]\nposition_m = [0.25, -0.4330127018922193, 0]\nupper_spin = \"cw\"\nchannels = [4, 5]\n"
    ));
    for (short, long) in short.units.iter().zip(&long.units) {
        for (a, b) in short.position_m.iter().zip(long.position_m) {
            assert!((a - b).abs() < 1e-15, "{short:?} {long:?}");
        }
        assert_eq!((short.upper_spin, short.axis), (long.upper_spin, long.axis));
        assert_eq!(
            (short.upper_channel, short.lower_channel),
            (long.upper_channel, long.lower_channel)
        );
    }
    assert_eq!(short.units.len(), 3);
}

#[test]
fn layout_takes_spins_and_first_spin() {
    let layout = |more: &str| {
        let text = format!("{PAIR}[layout]\narm_m = 0.5\nunits = 2\nfirst_angle_deg = 90\n{more}\n");
        read(&text)
            .units
            .iter()
            .map(|unit| unit.upper_spin)
            .collect::<Vec<_>>()
    };
    assert_eq!(layout("first_spin = \"ccw\""), [Spin::Ccw, Spin::Cw]);
    assert_eq!(layout("spins = [\"ccw\", \"ccw\"]"), [Spin::Ccw, Spin::Ccw]);
}

#[test]
fn axes_are_normalised_and_ordered() {
    let airframe = read(&format!(
        "{PAIR}[[unit]]\nposition_m = [0, 0, -0.1]\nupper_spin = \"ccw\"\nchannels = [1, 0]\naxis = [0.26, 0, -0.966]\n\
         [allocation]\naxes = [\"thrust\", \"yaw\"]\nairmode = \"roll-pitch-yaw\"\nyaw_reserve_nm = 0.01\n\
         [inverse]\nmethod = \"polynomial\"\ndegree = 9\n"
    ));
    let [x, y, z] = airframe.units[0].axis;
    assert!((x * x + y * y + z * z - 1.0).abs() < 1e-15);
    assert_eq!(airframe.allocation.axes, [Axis::Yaw, Axis::Thrust]);
    assert!(airframe.allocation.controls(Axis::Yaw) && !airframe.allocation.controls(Axis::Roll));
    assert_eq!(airframe.inverse.method, Method::Polynomial { degree: 9 });
    assert_eq!(airframe.spin_sign(&airframe.units[0]), -1.0);
}

#[test]
fn later_stages_point_at_the_nearest_key() {
    let text = format!("{PAIR}[[unit]]\nposition_m = [0, 0, 0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n");
    let source = Source::new("test.toml", text.as_str());
    let airframe = Airframe::read(&source).unwrap();
    let pointed = |key: &str| airframe.place(key).map(|span| &text[span]);
    assert_eq!(pointed("throttle.min"), Some("0"));
    assert_eq!(pointed("pair.thrust_n"), Some("thrust_n"));
    assert_eq!(pointed("pair.thrust_n[6]"), Some("4"));
    assert_eq!(pointed("unit[0].channels[1]"), Some("1"));
    assert_eq!(pointed("unit[0].axis"), Some("[[unit]]"));
    assert_eq!(pointed("unit[7].axis"), Some("unit"));
    assert_eq!(pointed("inverse.thrust_tolerance_n"), Some("\"test-y6\""));

    let fault = airframe.diagnostic(
        Code::Fold,
        "throttle.min",
        "det J falls to -2.1",
        "",
        "min = 0.094 would do",
    );
    let faults = Diagnostics::new(source, vec![fault]);
    let record = &faults.records()[0];
    assert_eq!(
        (record.line, record.column, record.code.as_str()),
        (Some(4), Some(7), "MIX201")
    );
}

#[test]
fn later_stages_point_at_the_layout_for_its_units() {
    let text = format!("{PAIR}[layout]\narm_m = 0.5\nunits = 3\nfirst_angle_deg = 0\n");
    let airframe = read(&text);
    assert_eq!(
        airframe.place("unit[2].position_m").map(|span| &text[span]),
        Some("[layout]")
    );
}

#[test]
fn the_optional_keys_of_the_pair_and_of_the_vehicle_are_kept() {
    let units = "[layout]\narm_m = 0.3\nunits = 3\nfirst_angle_deg = 0\n";
    let bare = read(&format!("{PAIR}{units}[vehicle]\nmass_kg = 3.2\n"));
    assert_eq!(bare.vehicle.unwrap().inertia_kg_m2, None);
    assert_eq!(bare.pairs[0].measured.uncertainty, None);
    let full = read(&format!(
        "{PAIR}[pair.uncertainty]\nthrust_percent = 1.5\ntorque_percent = 100\n{units}\
         [vehicle]\nmass_kg = 3.2\ninertia_kg_m2 = [0.080, 0.087, 0.160]\n"
    ));
    assert_eq!(full.vehicle.unwrap().inertia_kg_m2, Some([0.080, 0.087, 0.160]));
    let uncertainty = full.pairs[0].measured.uncertainty.unwrap();
    assert_eq!(
        (uncertainty.thrust_percent, uncertainty.torque_percent),
        (1.5, 100.0)
    );
}

/// What was measured at another voltage and in other air is what it is at the frame's references: the same frame, whichever of
/// its kinds gives them.
#[test]
fn kinds_are_brought_to_the_frame_s_references() {
    let voltage = |reference: f64| {
        format!(
            "reference_v = {reference}\nrange_v = [12.0, 17.0]\nthrust_exponent = 1.75\ntorque_exponent = 1.8\n"
        )
    };
    let air = |reference: f64| {
        format!(
            "reference_density_kg_m3 = {reference}\nrange_kg_m3 = [0.7, 1.4]\nthrust_exponent = 0.75\ntorque_exponent = 0.8\n"
        )
    };
    let pair = |own: &str| {
        format!(
            "[[pair]]\nname = \"front\"\nbasis = \"biquadratic\"\nupper_spin = \"cw\"\n\
             thrust_n = [5.2, -2.2, 12.4, -10.2, 4.4, 2.8, 12.2, 0.24]\ntorque_nm = [-0.07, -0.06, -0.13, 0.1, 0.04, -0.09, 0.14, 0.07]\n{own}\
             [pair.lower_out]\nthrust_n = [0.2, 14.1, -1.7]\ntorque_nm = [-0.01, -0.2, 0.02]\n\
             [pair.power]\npower_w = [0, 0, 0, 0, 0, 620, 90, 40, 560, 160, -60, 150, 8, 6, 5]\n\
             [pair.uncertainty]\nthrust_percent = 1.5\ntorque_percent = 3.7\n"
        )
    };
    let rotor = |own: &str| {
        format!(
            "[[rotor]]\nname = \"rear\"\nthrust_n = [0.2, 14.1, -1.7]\ntorque_nm = [0.01, 0.2, -0.02]\n{own}"
        )
    };
    let units = "[[unit]]\nposition_m = [0.3, 0.0, 0.0]\nupper_spin = \"cw\"\npair = \"front\"\nchannels = [0, 1]\n\
                 [[unit]]\nposition_m = [-0.3, 0.0, 0.0]\nupper_spin = \"cw\"\nrotor = \"rear\"\nchannels = [2]\n";
    let frame = |pair: &str, rotor: &str, volts: f64, density: f64| {
        read(&format!(
            "name = \"two\"\n[throttle]\nmin = 0.1\nmax = 1.0\n{pair}{rotor}[voltage]\n{}[air]\n{}{units}",
            voltage(volts),
            air(density)
        ))
    };
    let own = |of: &str, volts: f64, density: f64| {
        format!("[{of}.voltage]\n{}[{of}.air]\n{}", voltage(volts), air(density))
    };
    let one = frame(&pair(""), &rotor(&own("rotor", 15.5, 1.1)), 14.0, 1.2);
    let other = frame(&pair(&own("pair", 14.0, 1.2)), &rotor(""), 15.5, 1.1);
    let by = [(1.75, 0.75), (1.8, 0.8)].map(|(v, rho)| libm::pow(14.0 / 15.5, v) * libm::pow(1.2 / 1.1, rho));
    let same = |found: &[f64], wanted: &[f64], factor: f64| {
        for (found, wanted) in found.iter().zip(wanted) {
            assert!(
                (found - factor * wanted).abs() < 1e-12 * wanted.abs().max(1.0),
                "{found} {wanted} {factor}"
            );
        }
    };
    let (a, b) = (&one.pairs[0], &other.pairs[0]);
    same(&a.thrust_n, &b.thrust_n, by[0]);
    same(&a.torque_nm, &b.torque_nm, by[1]);
    let [alone_a, alone_b] = [a, b].map(|pair| pair.lower_out.clone().unwrap());
    same(&alone_a.thrust_n, &alone_b.thrust_n, by[0]);
    same(&alone_a.torque_nm, &alone_b.torque_nm, by[1]);
    let [rotor_a, rotor_b] = [&one, &other].map(|frame| frame.single_rotors[0].alone.clone());
    same(&rotor_a.thrust_n, &rotor_b.thrust_n, by[0]);
    same(&rotor_a.torque_nm, &rotor_b.torque_nm, by[1]);
    // Power is torque times speed, and the thrust is as the density times the speed squared.
    let [power_a, power_b] = [a, b].map(|pair| pair.power.clone().unwrap().power_w);
    same(&power_a, &power_b, by[1] * (by[0] / (1.2 / 1.1)).sqrt());
    // At any voltage and in any air both give the same.
    for (volts, density) in [(12.0, 0.7), (14.8, 1.2), (17.0, 1.4)] {
        let [k, l] = [&one, &other].map(|frame| frame.factors(volts, density));
        assert!((k[0] * by[0] / l[0] - 1.0).abs() < 1e-12 && (k[1] * by[1] / l[1] - 1.0).abs() < 1e-12);
    }
    // What the exponent may be off widens the uncertainty, in tenths, up.
    let off = libm::hypot(
        by_voltage(EXPONENT_DEVIATION, 14.0, 15.5),
        by_voltage(EXPONENT_DEVIATION, 1.2, 1.1),
    );
    let [own, brought] = [a, b].map(|pair| pair.measured.uncertainty.unwrap().thrust_percent);
    assert_eq!(
        [own, brought],
        [1.5, (10.0 * libm::hypot(off, 1.5)).ceil() / 10.0]
    );
    assert!(off > 0.4, "{off}");
}
