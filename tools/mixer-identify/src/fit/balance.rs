//! Rotors with a supply each, which sag apart, brought to one.
//!
//! A speed controller applies the throttle's share of its voltage to the motor, so that a rotor at
//! throttle u and voltage V turns as one at u V / V0 and V0 does. With V0 the mean of both rotors'
//! voltages, what was measured at (u, l) belongs to the throttles (u Vu / V0, l Vl / V0) at one
//! voltage V0, and a polynomial through the points brings it back to (u, l). That holds for the
//! pair with its wake, and needs no thrust of either rotor.
//!
//! To correct each rotor's own thrust and torque by (Vi / V0)^k leaves out what the other one's
//! wake does. On 53 maps with both voltages and both thrusts its leave-one-out errors are 0.81 % of
//! thrust and 2.12 % of torque against 0.80 and 2.13 % here; on simulated pairs, where the truth is
//! known, it is 0.55 and 0.58 % off, rms, against 0.13 and 0.17 %.

use mixer_compiler::airframe::Basis;

use crate::bench::{Bench, BenchKind, Point};
use crate::fit::Design;
use crate::fit::polynomial::Polynomial;

type Channel = fn(&mut Point) -> &mut f64;

const CHANNELS: [Channel; 3] = [|p| &mut p.thrust, |p| &mut p.torque, |p| &mut p.power_w];

/// The bench with both rotors of every point at their mean voltage.
#[must_use]
pub fn balanced(bench: &Bench) -> Bench {
    let mut bench = bench.clone();
    if bench.kind == BenchKind::Pair && bench.points.iter().any(|p| p.imbalance != 0.0) {
        for channel in CHANNELS {
            bring(&mut bench.points, channel);
        }
        bench.points.iter_mut().for_each(|p| p.imbalance = 0.0);
    }
    bench
}

/// Throttles that amount to the point's at one voltage.
pub fn throttles(p: &Point) -> [f64; 2] {
    [p.u * (1.0 + p.imbalance), p.l * (1.0 - p.imbalance)]
}

/// Brings one channel, where enough points have it for any fit of the pair.
fn bring(points: &mut [Point], channel: Channel) {
    let measured = points.iter_mut().filter_map(|p| {
        let y = *channel(p);
        y.is_finite().then(|| (throttles(p), y))
    });
    let (places, y): (Vec<[f64; 2]>, Vec<f64>) = measured.unzip();
    let designs = [Basis::Cubic, Basis::Biquadratic].into_iter();
    let mut designs =
        designs.filter_map(|basis| Some((basis, Design::within_its_points(basis, &places).ok()?)));
    let Some((basis, design)) = designs.next() else {
        return;
    };
    let map = Polynomial::of(basis, &design.coefficients(&design.coordinates(&y)));
    for p in points {
        let [u, l] = throttles(p);
        let moved = map.at(p.u, p.l) - map.at(u, l);
        *channel(p) += moved;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::{Preparation, prepare, read};

    /// A pair by similarity: speeds follow throttle times voltage, the lower rotor works in the
    /// upper one's wake.
    fn pair([u, l]: [f64; 2], [upper, lower]: [f64; 2]) -> [f64; 2] {
        let [a, b] = [u * upper, l * lower].map(|x| libm::pow(x / 20.0, 1.6));
        [12.0 * a + 12.0 * b * b / (b + 0.4 * a), 0.25 * b - 0.22 * a]
    }

    #[test]
    fn a_supply_of_each_rotor_is_brought_to_one() {
        let mut csv = String::from("upper,lower,thrust_n,torque_nm,upper_voltage_v,lower_voltage_v\n");
        let levels = || (1..=8).map(|k| 0.12 * f64::from(k));
        for (u, l) in levels().flat_map(|u| levels().map(move |l| (u, l))) {
            let volts = [21.0 - 1.6 * u * u, 20.8 - 1.4 * l * l];
            let [f, q] = pair([u, l], volts);
            csv += &format!("{u},{l},{f},{q},{},{}\n", volts[0], volts[1]);
        }
        let log = read::read("map.csv", csv.as_bytes(), &read::Reading::default()).expect("a log");
        let bench = prepare(log, &Preparation::default()).expect("a bench");
        let missed = |bench: &Bench| {
            let missed = bench.points.iter().map(|p| {
                let [f, q] = pair([p.u, p.l], [p.voltage; 2]);
                [(p.thrust - f).abs() / 24.0, (p.torque - q).abs() / 0.25]
            });
            missed.fold([0.0_f64; 2], |[a, b], [f, q]| [a.max(f), b.max(q)])
        };
        let ([f, q], [f0, q0]) = (missed(&balanced(&bench)), missed(&bench));
        assert!(f0 > 0.02 && q0 > 0.03, "{f0} {q0}");
        assert!(f < 0.003 && q < 0.005, "{f} {q}");
        assert!((bench.points[7].voltage - 20.24336).abs() < 1e-9);
        assert!(balanced(&bench).points.iter().all(|p| p.imbalance == 0.0));
    }
}
