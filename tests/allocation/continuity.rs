//! Requests next to each other are answered alike: those near which throttles or what is delivered
//! once jumped, or which were answered wrongly there.

use mixer_rt::Health;
use mixer_tests::frames::Place;
use mixer_tests::golden;
use mixer_tests::request::{Frame, Request};
use mixer_tests::soundness;

use crate::{REFERENCE_V, compile};

pub(crate) fn place(position: [f64; 3], axis: [f64; 2], clockwise: bool) -> Place {
    Place {
        position,
        axis: [axis[0], axis[1], -1.0],
        clockwise,
    }
}

pub(crate) fn all_rotors(wrench: [f32; 4], volts: f32) -> Request {
    Request {
        wrench,
        volts,
        health: Health::GOOD,
    }
}

/// Changes one axis by 1e-4 of it: no throttle moves by more than 0.02.
pub(crate) fn stays(frame: &Frame, wrench: [f32; 4], volts: f32, axis: usize) {
    let mut near = wrench;
    near[axis] *= 1.0 + 1e-4;
    stays_from(frame, [wrench, near], volts);
}

/// No throttle moves by more than 0.02 between the two.
pub(crate) fn stays_from(frame: &Frame, wrenches: [[f32; 4]; 2], volts: f32) {
    let [request, near] = wrenches.map(|wrench| all_rotors(wrench, volts));
    let [answer, moved] = [request, near].map(|request| request.mix(frame).expect("finite"));
    let change = answer.change(&moved);
    assert!(change <= 0.02, "{change}: {answer:?}, then {moved:?}");
}

/// No axis is reversed or exceeded.
pub(crate) fn is_sound(frame: &Frame, wrench: [f32; 4], volts: f32) {
    let request = all_rotors(wrench, volts);
    let answer = request.mix(frame).expect("finite");
    let fault = soundness::fault(frame, &request, &answer).expect("solved");
    assert_eq!(fault, None, "{request:?} -> {answer:?}");
}

/// Little less than all is attainable, and all but the last bit of it without crossing an edge.
#[test]
fn the_last_bit_comes_gradually() {
    let places = [
        place([0.02875, -0.53661, -0.0130], [-0.04819, 0.07345], true),
        place([0.62633, 0.32506, -0.0500], [-0.14330, -0.07641], false),
        place([-0.37419, 0.15251, -0.0465], [-0.03352, -0.09509], false),
    ];
    let frame = compile(&places, "roll-pitch-yaw", 0.0);
    let mut asked = [4.6543736, -4.008832, 0.22767107, 0.0];
    for step in 0..200 {
        asked[3] = 26.0 + 1e-3 * step as f32;
        stays(&frame, asked, 15.425033, 3);
    }
}

/// Where roll and pitch leave the thrusts no room at all, rounding leaves them less; the reserve of
/// yaw is kept.
#[test]
fn a_reserve_is_kept_where_thrusts_have_no_room() {
    let vertical = [0.0, 0.0];
    let places = [
        place([-0.003970421513648438, 0.27762963756311904, 0.0], vertical, true),
        place([-0.19671269978719483, 0.03611251503887493, 0.0], vertical, false),
        place([0.0018966751448836689, -0.3358674052841479, 0.0], vertical, false),
        place([0.6250584676096459, -0.11655371243145435, 0.0], vertical, false),
    ];
    let reserve = 0.04606133174454187;
    let frame = compile(&places, "disabled", reserve);
    let mut request = all_rotors([3.3156884, 15.232795, 0.10576367, 65.15473], 13.748151);
    for _ in 0..200 {
        request.wrench[0] += 1e-5;
        let answer = request.mix(&frame).expect("finite");
        assert!(answer.achieved[2] > reserve - 1e-3, "{request:?}: {answer:?}");
    }
}

/// Where roll and pitch end, a yaw of zero is held by a multiplier whose sign may turn.
#[test]
fn no_yaw_comes_of_a_multiplier_that_changes_its_sign() {
    let places = [
        place([0.51137, 0.41291, -0.00849], [-0.03014, 0.03591], true),
        place([-0.48622, 0.23022, 0.04425], [0.0482, 0.09915], false),
        place([-0.47662, -0.70176, 0.00073], [-0.11483, -0.12257], false),
    ];
    let frame = compile(&places, "disabled", 0.0);
    for step in 0..20 {
        let share = 0.9 + 0.01 * step as f32;
        is_sound(
            &frame,
            [-20.005146 * share, 8.351562 * share, 0.0, 79.428024],
            13.1143055,
        );
    }
}

/// Less thrust is asked than roll = pitch = 0 needs: from the least thrust on roll and pitch may
/// lower it further.
#[test]
fn roll_and_pitch_leave_the_least_thrust_gradually() {
    let vertical = [0.0, 0.0];
    let places = [
        place([0.16093, 0.15869, 0.0], vertical, true),
        place([-0.44923, 1.40134, 0.0], vertical, false),
        place([-0.22687, -0.09005, 0.0], vertical, true),
        place([-0.10206, -0.57566, 0.0], vertical, true),
        place([0.26025, -0.09398, 0.0], vertical, false),
    ];
    let frame = compile(&places, "disabled", 0.0);
    for step in 0..20 {
        let roll = -15.0 - 0.01 * step as f32;
        stays(&frame, [roll, -2.0694668, 0.0, -3.577923], 14.53794, 1);
    }
}

/// What has been reached of roll and pitch stays while thrust and yaw are served, also where yaw is
/// at a bound for it.
#[test]
fn the_end_of_roll_and_pitch_is_not_left_again() {
    let places = [
        place([-0.17419, -0.64779, 0.00889], [-0.00864, -0.10697], true),
        place([0.20049, -0.42659, 0.04158], [-0.04631, -0.05953], false),
        place([0.59067, -0.06508, 0.03416], [-0.07605, -0.06419], true),
        place([0.63327, 1.24553, -0.01237], [-0.04589, -0.03004], true),
        place([-0.2197, 0.60197, -0.00758], [0.09128, 0.00678], false),
        place([-0.37616, 0.02635, -0.00119], [0.07888, 0.14556], true),
    ];
    let frame = compile(&places, "roll-pitch", 0.0);
    for step in 0..20 {
        let roll = 56.0 + 0.5 * step as f32;
        is_sound(&frame, [roll, -0.2 * roll, 0.06 * roll, 23.349098], 14.487578);
    }
}

/// As above, of the throttles.
#[test]
fn throttles_at_the_end_of_roll_and_pitch_are_those_of_the_neighbours() {
    let places = [
        place([0.27205, 0.50885, 0.01737], [-0.11316, -0.09298], true),
        place([-0.21457, 0.3554, -0.03487], [0.06081, -0.12542], false),
        place([-0.52398, 0.03499, 0.04099], [-0.14085, 0.00763], false),
        place([-0.04802, -0.29801, 0.03362], [0.01176, -0.01905], false),
        place([0.51903, -0.03374, 0.00749], [-0.12123, -0.02557], false),
    ];
    let frame = compile(&places, "disabled", 0.0);
    for step in 0..200 {
        let roll = 87.2 + 1e-3 * step as f32;
        stays(&frame, [roll, -17.55998, -1.6618167, 135.81146], 13.898152, 0);
    }
}

/// Multipliers are large where edges are almost dependent; they hide no bound that yaw comes to.
#[test]
fn yaw_stops_at_its_bound_where_multipliers_are_large() {
    let places = [
        place([-0.58976, 0.33756, -0.02149], [0.04897, -0.07405], true),
        place([-0.24209, -0.08837, -0.02695], [-0.07673, 0.12759], false),
        place([-0.07176, -0.22972, 0.01505], [-0.08158, -0.1288], true),
        place([0.38354, -0.40016, 0.02289], [0.14891, -0.07865], true),
        place([0.67099, 0.16758, 0.00309], [0.07278, 0.02166], true),
        place([0.26093, 1.46868, 0.0118], [0.14351, 0.08169], false),
    ];
    let frame = compile(&places, "disabled", 0.0);
    for step in 0..20 {
        let roll = 3.0 + 0.005 * step as f32;
        is_sound(&frame, [roll, 0.0, -0.18544011, 135.13426], 15.278095);
    }
}

/// At the least thrust two units in the middle of their sets can together give roll, pitch and
/// thrust in almost the same proportions only. Multipliers of 1e13 told them apart, whose rounding
/// errors were larger than the way.
#[test]
fn almost_dependent_units_at_the_least_thrust_do_not_turn_over() {
    let places = [
        place([-0.99745, 0.64098, 0.01165], [0.0, 0.0], true),
        place([-0.56068, -0.22889, 0.0], [0.0, 0.0], false),
        place([0.13261, -0.35474, -0.02534], [0.06676, -0.00454], false),
        place([0.61207, -0.03359, 0.0], [0.02284, -0.0339], false),
        place([0.26615, 0.47837, -0.0182], [0.14203, -0.099], false),
    ];
    let frame = compile(&places, "disabled", 0.0);
    for step in 0..40 {
        let scale = 1.0 + 1e-4 * step as f32;
        let wrench = [60.52357, 178.06795, -6.6948543, 18.819588].map(|value| scale * value);
        stays(&frame, wrench, 14.734208, 3);
    }
}

/// Yaw's reach is almost level about its top. The best of a few thrusts tried was now here and now
/// there.
#[test]
fn thrusts_at_the_top_of_yaw_follow_the_request() {
    let places = [
        place([-0.1732779045895687, 0.46704046144175365, 0.0], [0.0, 0.0], true),
        place([-0.2661062996467052, -0.2863855747353017, 0.0], [0.0, 0.0], false),
        place([0.4090537239210572, -0.25784271204337017, 0.0], [0.0, 0.0], false),
        place([0.16683821645627267, 0.14408695824634213, 0.0], [0.0, 0.0], true),
    ];
    let frame = compile(&places, "roll-pitch", 0.0);
    for step in 0..200 {
        let thrust = 57.75 + 5e-4 * step as f32;
        stays(&frame, [-2.2284427, 0.60011536, -0.7385575, thrust], 14.414714, 3);
    }
}

/// At the end of roll and pitch rounding errors of the wrench cannot be made up for: trying to
/// turned two units to and fro until the pieces ran out, and what was left of yaw was lost.
#[test]
fn yaw_at_the_end_of_roll_and_pitch_is_that_of_the_neighbours() {
    let frame = Frame::new(golden::compile("px4-x12").expect("compiles"));
    for (wrench, next) in [
        (
            [-32.299_454, 27.726_133, 0.449_855_57, 92.303_925],
            [-32.303_703, 27.729_778, 0.449_914_72, 92.303_764],
        ),
        (
            [35.324_436, -22.486_635, -0.488_017_98, -56.112_247],
            [35.328_583, -22.489_275, -0.488_075_3, -56.125_774],
        ),
    ] {
        let [answer, next] =
            [wrench, next].map(|wrench| all_rotors(wrench, REFERENCE_V).mix(&frame).expect("finite"));
        let change = (answer.achieved[2] - next.achieved[2]).abs();
        assert!(
            change <= 0.01 * frame.authority[2],
            "{wrench:?}: {:?} and {:?}",
            answer.achieved,
            next.achieved
        );
    }
}
