use super::*;

const fn edge(start: [f32; 2], along: [f32; 2], length: f32) -> Edge {
    Edge { start, along, length }
}

const SQUARE: AttainableSet<'static> = AttainableSet {
    scale: [1.0, 1.0],
    centre: [1.0, 1.0],
    edges: &[
        edge([0.0, 0.0], [1.0, 0.0], 2.0),
        edge([2.0, 0.0], [0.0, 1.0], 2.0),
        edge([2.0, 2.0], [-1.0, 0.0], 2.0),
        edge([0.0, 2.0], [0.0, -1.0], 2.0),
    ],
};
const CHORD: AttainableSet<'static> = AttainableSet {
    scale: [1.0, 1.0],
    centre: [1.0, 0.0],
    edges: &[edge([0.0, 0.0], [1.0, 0.0], 2.0)],
};

/// A square with a notch in its right side, which turns inwards at (1.9, 1).
const NOTCHED: AttainableSet<'static> = AttainableSet {
    scale: [1.0, 1.0],
    centre: [1.0, 1.0],
    edges: &[
        edge([0.0, 0.0], [1.0, 0.0], 2.0),
        edge([2.0, 0.0], [-0.099_503_72, 0.995_037_2], 1.004_987_6),
        edge([1.9, 1.0], [0.099_503_72, 0.995_037_2], 1.004_987_6),
        edge([2.0, 2.0], [-1.0, 0.0], 2.0),
        edge([0.0, 2.0], [0.0, -1.0], 2.0),
    ],
};

/// A square with a hollow in its right side, whose ground is the edge of index 2.
const HOLLOWED: AttainableSet<'static> = AttainableSet {
    scale: [1.0, 1.0],
    centre: [1.0, 1.0],
    edges: &[
        edge([0.0, 0.0], [1.0, 0.0], 2.0),
        edge([2.0, 0.0], [-0.196_116_14, 0.980_580_7], 0.509_902),
        edge([1.9, 0.5], [0.0, 1.0], 1.0),
        edge([1.9, 1.5], [0.196_116_14, 0.980_580_7], 0.509_902),
        edge([2.0, 2.0], [-1.0, 0.0], 2.0),
        edge([0.0, 2.0], [0.0, -1.0], 2.0),
    ],
};

#[test]
fn a_point_drawn_out_of_a_hollow_is_told_its_ends() {
    let hollow = |towards: [f32; 2], direction| {
        let ends = HOLLOWED.hollow(&HOLLOWED.locate(towards), direction);
        ends.map(|end| end.map(|above| above.get() - 1))
    };
    assert_eq!(hollow([2.0, 0.9], [1.0, 0.0]), [Some(1), Some(4)]);
    assert_eq!(hollow([2.0, 0.3], [5.0, 1.0]), [None, Some(4)]);
    assert_eq!(hollow([2.5, 2.5], [1.0, 0.1]), [None; 2]);
    assert_eq!(hollow([-1.0, 0.5], [-3.0, 0.0]), [None; 2]);
}

/// Goes from the centre to `target` face by face.
fn walk(set: &AttainableSet<'_>, target: [f32; 2]) -> Point {
    let mut point = set.locate(set.centre);
    let mut left = [target[0] - set.centre[0], target[1] - set.centre[1]];
    for _ in 0..8 {
        let velocity = set.velocity(&point, left);
        let share = match set.crossing(&mut point, velocity, 1.0, [0.0; 2], None) {
            Some(crossing) => {
                set.shift(&mut point, velocity.map(|v| crossing.share * v));
                set.cross(&mut point, crossing);
                crossing.share
            }
            None => {
                set.shift(&mut point, velocity);
                break;
            }
        };
        left = left.map(|left| (1.0 - share) * left);
    }
    point
}

fn check(set: &AttainableSet<'_>, target: [f32; 2], face: Face, projection: [f32; 2]) {
    for point in [walk(set, target), set.locate(target)] {
        assert_eq!(
            (point.face, set.project(&point)),
            (face, projection),
            "{target:?}"
        );
    }
}

#[test]
fn projections_onto_a_square() {
    check(&SQUARE, [1.5, 0.5], Face::Interior, [1.5, 0.5]);
    check(&SQUARE, [1.5, -1.0], Face::Edge, [1.5, 0.0]);
    check(&SQUARE, [3.0, 0.5], Face::Edge, [2.0, 0.5]);
    check(&SQUARE, [3.0, 5.0], Face::Corner, [2.0, 2.0]);
    check(&SQUARE, [-3.0, -5.0], Face::Corner, [0.0, 0.0]);
    check(&SQUARE, [-1.0, 1.5], Face::Edge, [0.0, 1.5]);
}

#[test]
fn projections_onto_a_notched_square() {
    check(&NOTCHED, [1.85, 1.1], Face::Interior, [1.85, 1.1]);
    check(&NOTCHED, [1.5, -1.0], Face::Edge, [1.5, 0.0]);
    check(&NOTCHED, [3.0, 5.0], Face::Corner, [2.0, 2.0]);
    for (target, index) in [([2.5, 0.5], 1), ([2.5, 1.5], 2)] {
        for point in [walk(&NOTCHED, target), NOTCHED.locate(target)] {
            assert_eq!(point.region(), (Face::Edge, index), "{target:?}");
        }
    }
}

/// From one edge of the notch to the other and back, at the same distance from the border, and where both lead to each
/// other, inside.
#[test]
fn a_projection_goes_on_around_a_notch() {
    let mut point = NOTCHED.locate([2.5, 0.5]);
    let [s, away] = point.at;
    let velocity = [2.0, 0.0];
    let crossing = NOTCHED
        .crossing(&mut point, velocity, 1.0, [0.0; 2], None)
        .unwrap();
    NOTCHED.shift(&mut point, velocity.map(|v| crossing.share * v));
    assert!(s + crossing.share * velocity[0] - 1.004_987_6 < 1e-6);
    NOTCHED.cross(&mut point, crossing);
    assert_eq!((point.region(), point.at), ((Face::Edge, 2), [0.0, away]));

    let velocity = [-2.0, 0.0];
    let mut back = point;
    let crossing = NOTCHED
        .crossing(&mut back, velocity, 1.0, [0.0; 2], None)
        .unwrap();
    NOTCHED.cross(&mut back, crossing);
    assert_eq!(back.region(), (Face::Edge, 1));

    let barred = Some((Face::Edge, 1));
    let crossing = NOTCHED
        .crossing(&mut point, velocity, 1.0, [0.0; 2], barred)
        .unwrap();
    NOTCHED.cross(&mut point, crossing);
    assert_eq!((point.face, point.at), (Face::Interior, [1.9, 1.0]));
}

/// A way inside that would cut across the notch stops at it.
#[test]
fn a_way_across_a_notch_leaves_the_set() {
    let from = [1.96, 0.3];
    let mut point = NOTCHED.locate(from);
    assert_eq!(point.face, Face::Interior);
    let velocity = [0.0, 1.4];
    let crossing = NOTCHED
        .crossing(&mut point, velocity, 1.0, [0.0; 2], None)
        .unwrap();
    assert!((crossing.share - 0.1 / 1.4).abs() < 1e-6, "{crossing:?}");
}

#[test]
fn projections_onto_a_chord() {
    check(&CHORD, [1.5, -1.0], Face::Edge, [1.5, 0.0]);
    check(&CHORD, [-1.0, 3.0], Face::Corner, [0.0, 0.0]);
    check(&CHORD, [4.0, 3.0], Face::Corner, [2.0, 0.0]);
}

/// A corner at which the border turns by little: its two heights say little of the distance.
#[test]
fn the_distance_is_that_of_the_projection() {
    const FLAT: AttainableSet<'static> = AttainableSet {
        scale: [1.0, 1.0],
        centre: [0.0, 1.0],
        edges: &[
            edge([-4.8, 1.4], [0.96, -0.28], 5.0),
            edge([0.0, 0.0], [0.96, 0.28], 5.0),
            edge([4.8, 1.4], [-1.0, 0.0], 9.6),
        ],
    };
    for (set, point, distance) in [
        (&SQUARE, [1.5, 0.5], 0.0),
        (&SQUARE, [1.5, -1.0], 1.0),
        (&SQUARE, [5.0, 6.0], 5.0),
        (&FLAT, [0.0, -1.0], 1.0),
        (&FLAT, [0.28, -0.96], 1.0),
        (&FLAT, [2.68, -0.26], 1.0),
        (&CHORD, [5.0, 4.0], 5.0),
    ] {
        let found = set.distance(point);
        assert!(
            (found - distance).abs() < 1e-6,
            "{point:?}: {found}, not {distance}"
        );
    }
}
