//! A zoo of frames as vehicles have them, each with one coordinate that is wrong.

use super::{Mend, mends};

/// Numbers in [0, 1), the same ones every time.
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn index(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }
}

type Places = Vec<[f64; 3]>;

fn round(places: Places, digits: i32) -> Places {
    let unit = libm::pow(10.0, f64::from(digits));
    let rounded = |x: f64| (x * unit).round() / unit + 0.0;
    places.into_iter().map(|place| place.map(rounded)).collect()
}

fn polygon(units: usize, arm: f64, first_deg: f64) -> Places {
    let angle = |k: usize| (first_deg + 360.0 * k as f64 / units as f64).to_radians();
    (0..units)
        .map(|k| [arm * libm::cos(angle(k)), arm * libm::sin(angle(k)), 0.0])
        .collect()
}

/// What is symmetric by intent: regular, rectangles, H, dead cats, V, with the centre of gravity in
/// front, behind or beside.
fn frame(draws: &mut Draws) -> Places {
    let (a, b) = (draws.within(0.15, 0.8), draws.within(0.15, 0.8));
    let (c, d) = (draws.within(0.15, 0.8), draws.within(0.15, 0.8));
    let places = match draws.index(8) {
        0 => polygon(4, a, 45.0),
        1 => polygon(3, a, 60.0),
        2 => polygon(6, a, 30.0),
        3 => polygon(6, a, 0.0),
        4 => polygon(4, a, 0.0),
        5 => vec![[a, b, 0.0], [a, -b, 0.0], [-a, -b, 0.0], [-a, b, 0.0]],
        6 => vec![[a, b, 0.0], [a, -b, 0.0], [-c, -d, 0.0], [-c, d, 0.0]],
        _ => vec![
            [a, b, 0.0],
            [a, -b, 0.0],
            [0.0, d, 0.0],
            [0.0, -d, 0.0],
            [-a, -b, 0.0],
            [-a, b, 0.0],
        ],
    };
    let [x, y] = match draws.index(6) {
        0 => [draws.within(-0.05, 0.05), 0.0],
        1 if places.len() > 3 => [draws.within(-0.05, 0.05), draws.within(-0.02, 0.02)],
        _ => [0.0, 0.0],
    };
    let places = places
        .into_iter()
        .map(|[px, py, pz]| [px + x, py + y, pz])
        .collect();
    let digits = [2, 3, 4, 9][draws.index(4)];
    round(places, digits)
}

/// Two neighbouring digits exchanged.
fn transposed(x: f64, at: usize) -> f64 {
    let mut digits: Vec<char> = format!("{:.4}", x.abs()).chars().collect();
    digits.swap(2 + at % 3, 3 + at % 3);
    let text: String = digits.into_iter().collect();
    text.parse::<f64>().unwrap_or(x) * x.signum()
}

#[test]
fn frames_as_they_are_meant_say_nothing() {
    let mut draws = Draws(1);
    for _ in 0..500 {
        let places = frame(&mut draws);
        assert_eq!(mends(&places), [], "{places:?}");
    }
    // Without any symmetry, of a few digits.
    for _ in 0..1000 {
        let count = 2 + draws.index(6);
        let digits = 3 + draws.index(3) as i32;
        let mut place = || [draws.within(-0.6, 0.6), draws.within(-0.6, 0.6), 0.0];
        let places = round((0..count).map(|_| place()).collect(), digits);
        assert_eq!(mends(&places), [], "{places:?}");
    }
    // A longer tail, a nose that is further out, two arms of another length.
    for places in [
        vec![[0.225, 0.39, 0.0], [0.225, -0.39, 0.0], [-0.6, 0.0, 0.0]],
        vec![
            [0.5, 0.0, 0.0],
            [-0.1, 0.45, 0.0],
            [-0.55, 0.0, 0.0],
            [-0.1, -0.45, 0.0],
        ],
        vec![
            [0.433, 0.25, 0.0],
            [-0.433_012_7, 0.25, 0.0],
            [-0.433, -0.25, 0.0],
            [0.433_01, -0.25, 0.0],
        ],
        vec![[0.3, 0.2, 0.0], [0.3, -0.2, 0.0]],
    ] {
        assert_eq!(mends(&places), [], "{places:?}");
    }
}

#[test]
fn single_wrong_coordinates_are_told() {
    let mut draws = Draws(2);
    let (mut told, mut drawn) = ([0; 5], [0; 5]);
    let (mut hit, mut silent) = (0, Vec::new());
    while drawn.iter().sum::<usize>() < 1000 {
        let meant = frame(&mut draws);
        let (unit, k, kind) = (draws.index(meant.len()), draws.index(2), draws.index(5));
        let mut places = meant.clone();
        let x = places[unit][k];
        places[unit][k] = match kind {
            0 => 10.0 * x,
            1 => 0.1 * x,
            2 => -x,
            3 => transposed(x, draws.index(3)),
            _ => x + 0.089,
        };
        let reach = meant.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        if (places[unit][k] - x).abs() < 0.011 {
            continue;
        }
        drawn[kind] += 1;
        let found = mends(&places);
        told[kind] += usize::from(!found.is_empty());
        let is_mended = |mend: &Mend| mend.unit == unit && (mend.expected[k] - x).abs() < 0.02 * reach;
        hit += usize::from(found.iter().any(is_mended));
        if found.is_empty() {
            silent.push((meant, unit, k, kind));
        }
    }
    for case in silent.iter().take(20) {
        println!("{case:?}");
    }
    let shares: Vec<f64> = told
        .iter()
        .zip(drawn)
        .map(|(a, b)| *a as f64 / b as f64)
        .collect();
    println!("{shares:?}, the right one among them {hit}");
    assert!(told.iter().sum::<usize>() >= 950, "{told:?} of {drawn:?}");
}
