//! M+ of many frames, without the rest of the compiler: it inverts M, and it is of least norm in
//! shares of what a unit can give.

use mixer_compiler::Source;
use mixer_compiler::airframe::{Airframe, Axis, Spin, Unit};
use mixer_compiler::diagnostic::Code;
use mixer_compiler::model::PairMap;
use mixer_compiler::model::effectiveness::Effectiveness;
use mixer_rt::Wrench;
use mixer_setpoints::Random;
use mixer_tests::physics::Physics;

/// How the places of a frame are drawn.
#[derive(Clone, Copy, Debug)]
enum Shape {
    /// On a circle, from an angle in degrees on.
    Regular(f64),
    /// Two rows abreast, as long as wide or up to ten times longer.
    Rows,
    /// A circle, each place off by up to a tenth of the arm.
    Jittered,
    /// A circle, each axis tilted by up to 20 degrees.
    Tilted,
}

/// The paper's airframe: every frame here has its pair.
fn paper() -> Airframe {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../airframes/isae-x8.toml"));
    Airframe::read(&Source::new("isae-x8.toml", text.unwrap())).unwrap()
}

/// The paper's airframe with the units of a drawn frame.
#[allow(
    clippy::disallowed_methods,
    reason = "places are drawn; no bit of theirs is emitted"
)]
fn frame(paper: &Airframe, units: usize, arm_m: f64, shape: Shape, random: &mut Random) -> Airframe {
    let unit = |k: usize, random: &mut Random| -> Unit {
        let angle = |first_deg: f64| (first_deg + 360.0 * k as f64 / units as f64).to_radians();
        let circle = |angle: f64| [arm_m * angle.cos(), arm_m * angle.sin(), 0.0];
        let mut unit = paper.units[0].clone();
        unit.position_m = match shape {
            Shape::Regular(first_deg) => circle(angle(first_deg)),
            Shape::Rows => {
                let step = arm_m * random.uniform(0.2, 2.0);
                [
                    step * ((k / 2) as f64 - 0.25 * (units as f64 - 2.0)),
                    arm_m * [-1.0, 1.0][k % 2],
                    0.0,
                ]
            }
            Shape::Jittered => circle(angle(0.0)).map(|x| x + arm_m * random.uniform(-0.1, 0.1)),
            Shape::Tilted => circle(angle(45.0)),
        };
        if matches!(shape, Shape::Tilted) {
            let (tilt, towards) = (random.uniform(0.0, 0.35), random.uniform(0.0, 6.3));
            unit.axis = [
                tilt.sin() * towards.cos(),
                tilt.sin() * towards.sin(),
                -tilt.cos(),
            ];
        }
        let alternate = [Spin::Cw, Spin::Ccw][k % 2];
        unit.upper_spin = if random.below(8) == 0 { Spin::Cw } else { alternate };
        unit
    };
    let mut frame = paper.clone();
    frame.units = (0..units).map(|k| unit(k, random)).collect();
    frame
}

/// Largest entry of |M M+ - I| over the served axes, row i over that of row i's size and column j
/// over that of column j's: what 1 N m or 1 N asked gives elsewhere, in shares of authority.
fn error(airframe: &Airframe, effectiveness: &Effectiveness, sizes: &[f64]) -> f64 {
    let lengths: Vec<f64> = (0..4)
        .map(|axis| {
            let row = effectiveness.matrix.row(axis);
            row.iter()
                .zip(sizes)
                .map(|(entry, size)| (entry * size) * (entry * size))
                .sum::<f64>()
                .sqrt()
        })
        .collect();
    let product = &effectiveness.matrix * &effectiveness.pseudo_inverse;
    let served = |axis: &usize| airframe.allocation.controls(Axis::ALL[*axis]);
    let mut largest = 0.0f64;
    for i in (0..4).filter(served) {
        for j in (0..4).filter(served) {
            let identity = f64::from(u8::from(i == j));
            largest = largest.max((product[(i, j)] - identity).abs() * lengths[j] / lengths[i]);
        }
    }
    largest
}

/// Largest difference of D^-1 M+ M D from its transpose: 0 where M+ is of least norm in shares.
fn asymmetry(effectiveness: &Effectiveness, sizes: &[f64]) -> f64 {
    let mut projection = &effectiveness.pseudo_inverse * &effectiveness.matrix;
    for (i, row) in sizes.iter().enumerate() {
        for (j, column) in sizes.iter().enumerate() {
            projection[(i, j)] *= column / row;
        }
    }
    (&projection - projection.transpose()).amax()
}

/// 30,000 frames of 1 to 32 units, arms from 0.03 to 3 m in steps of a millimetre: every one that is
/// not refused for its rank has an accurate M+. A singular value decomposition that stops early gave
/// errors of 1e-2 to 1.5 on one frame in a hundred, the regular ones with short arms.
#[test]
fn every_frame_has_an_accurate_pseudo_inverse() {
    let paper = paper();
    let mut random = Random::new(7);
    let (mut accurate, mut deficient) = (0, 0);
    for k in 0..30_000 {
        let units = 1 + random.below(32);
        let arm_m = 1e-3 * (30 + k % 2971) as f64;
        let shapes = [
            Shape::Regular(0.0),
            Shape::Regular(180.0 / units as f64),
            Shape::Regular(360.0 / units as f64),
            Shape::Rows,
            Shape::Jittered,
            Shape::Tilted,
        ];
        let shape = shapes[random.below(shapes.len())];
        let mut airframe = frame(&paper, units, arm_m, shape, &mut random);
        if units < 3 || random.below(8) == 0 {
            // As frames of few units have them, and others by choice.
            let axes = [
                vec![Axis::Yaw, Axis::Thrust],
                vec![Axis::Roll, Axis::Yaw, Axis::Thrust],
            ];
            airframe.allocation.axes = axes[random.below(2).min(units - 1)].clone();
        }
        let [thrust, torque] = PairMap::new(&airframe.pairs[0], &airframe.throttle).scale();
        let sizes = [vec![thrust; units], vec![torque; units]].concat();
        match Effectiveness::new(&airframe) {
            Ok(effectiveness) => {
                accurate += 1;
                let error = error(&airframe, &effectiveness, &sizes);
                assert!(error <= 1e-12, "{error:e}: {units} units, {arm_m} m, {shape:?}");
                let asymmetry = asymmetry(&effectiveness, &sizes);
                assert!(
                    asymmetry <= 1e-10,
                    "{asymmetry:e}: {units} units, {arm_m} m, {shape:?}"
                );
            }
            Err(faults) => {
                deficient += 1;
                assert!(
                    faults.iter().all(|fault| fault.code == Code::RankDeficient),
                    "{faults:?}"
                );
            }
        }
    }
    // Pairs one behind the other have no lever arm for roll.
    assert!(
        accurate > 29_500 && deficient > 10,
        "{accurate} accurate, {deficient} without the rank"
    );
}

/// An X12 and a Y6 whose M+ was wrong: the X12 gave -0.893 N m of yaw, the Y6 37.36 N.
#[test]
fn frames_with_short_arms_give_the_wrench_asked_for() {
    let file = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../airframes/isae-x8.toml"));
    let file = file.unwrap();
    let (head, _) = file.split_once("[[unit]]").unwrap();
    for (units, first_angle_deg, arm_m, asked) in [
        (6, 30.0, 0.138, [0.0, 0.838, 0.0, 74.2]),
        (3, 60.0, 0.22, [0.0, 0.0, 0.0, 37.01]),
    ] {
        let layout = format!("arm_m = {arm_m:?}\nunits = {units}\nfirst_angle_deg = {first_angle_deg:?}\n");
        let source = Source::new("short.toml", format!("{head}[layout]\n{layout}"));
        let compiled = mixer_compiler::compile(&source).unwrap();
        let volts = compiled.airframe.reference_v() as f32;
        let setpoint = Wrench::from_array(asked);
        let (throttle, _, saturation) = compiled.tables.mix(&setpoint, volts).unwrap();
        assert!(!saturation.any_axis(), "{units} units: {saturation}");
        let given = Physics::new(&compiled).wrench(&throttle, volts);
        for (axis, tolerance) in compiled.tables.tolerance.wrench.into_iter().enumerate() {
            let missed = (given[axis] - f64::from(asked[axis])).abs();
            assert!(missed <= 2.0 * f64::from(tolerance), "{units} units: {given:?}");
        }
    }
}
