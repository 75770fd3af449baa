//! Where the fitted map folds, and the least idle that avoids it.
//!
//! The mixer inverts (u, l) -> (f, Q). Where det J = f_u Q_l - f_l Q_u <= 0 two commands give one
//! effort: the map folds. Whether it does over a box, and from which idle on it does not, is the
//! compiler's proof of [`injectivity`], so that `check` accepts what is identified here.

use mixer_compiler::airframe::Basis;
use mixer_compiler::model::PairMap;
use mixer_compiler::model::injectivity::{self, EnclosedPairMap};
use serde::Serialize;

use crate::fit::basis::ThrottleBox;

/// The report on a map's fold.
#[derive(Debug, Clone, Serialize)]
pub struct Fold {
    /// The box that was examined.
    pub commanded: ThrottleBox,
    /// Whether the map folds inside it: det J is not proven positive there.
    pub folds: bool,
    /// Whether the map is proven injective on it, which takes more than det J > 0: `check` refuses
    /// a map that is not.
    pub injective: bool,
    /// Least det J on a grid of the box, N * N m per throttle squared.
    pub least_det: f64,
    /// Where, (u, l).
    pub least_det_at: [f64; 2],
    /// The least idle of both rotors, at or above the box's, from which on the map is proven
    /// injective; none if there is none below 0.9 of the box.
    pub least_idle: Option<f64>,
}

/// The least idle of both rotors from the box's on, rounded up to 1e-5, from which on the map is
/// proven injective; none if there is none below 0.9 of the box.
pub fn least_idle(map: &EnclosedPairMap, throttle_box: ThrottleBox) -> Option<f64> {
    let ThrottleBox { min, max } = throttle_box;
    if map.prove_injective(throttle_box.into()).is_ok() {
        return Some(min);
    }
    let idle = map.least_idle(max)?.max(min);
    (idle <= min + 0.9 * (max - min)).then_some(idle)
}

/// An idle to command, in steps of 0.005: the first from `least` on that is itself proven to do up
/// to `max`.
pub fn round_idle(map: &EnclosedPairMap, least: f64, max: f64) -> Option<f64> {
    const PER_UNIT: f64 = 200.0;
    let first = (least * PER_UNIT - 1e-9).ceil();
    let idles = (0..).map(|k| (first + f64::from(k)) / PER_UNIT);
    let is_proven = |min: &f64| map.prove_injective(ThrottleBox { min: *min, max }.into()).is_ok();
    idles.take_while(|min| *min < max).find(is_proven)
}

/// Greatest throttles below that of a box, in steps of 0.05, that leave a range to fly with.
pub(crate) fn lower_ends(ThrottleBox { min, max }: ThrottleBox) -> impl Iterator<Item = f64> {
    let ends = (1..).map(move |k| (1e4 * (max - 0.05 * f64::from(k))).round() / 1e4);
    ends.take_while(move |end| *end > min + FLOWN)
}

/// Least range of throttle to fly with.
const FLOWN: f64 = 0.3;

/// The largest such range, cut off above, over which the map is proven injective from an idle on.
pub(crate) fn within(map: &EnclosedPairMap, throttle_box: ThrottleBox) -> Option<ThrottleBox> {
    lower_ends(throttle_box).find_map(|max| {
        let least = (CLEAR * map.least_idle(max)?).max(throttle_box.min);
        let min = round_idle(map, least, max)?;
        (min + FLOWN < max).then_some(ThrottleBox { min, max })
    })
}

/// The idle over the least one at which the map can be inverted. Right at that the inverse bends
/// without bound, and no tolerance is met.
pub(crate) const CLEAR: f64 = 1.03;

/// Steps of the grid on which the least det J is sought.
const STEPS: usize = 200;

/// The report for a map on a box.
pub fn examine(basis: Basis, thrust: &[f64], torque: &[f64], commanded: ThrottleBox) -> Fold {
    let map = EnclosedPairMap::of(basis, thrust, torque);
    let proof = map.prove_injective(commanded.into());
    let pair = PairMap::of(basis, thrust, torque, [commanded.min, commanded.max]);
    let det = |place| {
        let [[f_u, f_l], [q_u, q_l]] = pair.jacobian(place);
        f_u * q_l - f_l * q_u
    };
    let grid: Vec<f64> = commanded.grid(STEPS).collect();
    let values: Vec<f64> = commanded.square(STEPS).map(det).collect();
    let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
    let least = (0..values.len()).min_by(by_value).unwrap_or(0);
    let place = |k: usize| [grid[k / grid.len()], grid[k % grid.len()]];
    Fold {
        commanded,
        folds: !matches!(proof, Ok(_) | Err(injectivity::Fold::NotGlobal)),
        injective: proof.is_ok(),
        least_det: values[least],
        least_det_at: place(least),
        least_idle: least_idle(&map, commanded),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::{THRUST, TORQUE};

    #[test]
    fn the_papers_model_folds_below_an_idle_of_0_08875() {
        let b = Basis::Biquadratic;
        let whole = ThrottleBox { min: 0.0, max: 1.0 };
        let fold = examine(b, &THRUST, &TORQUE, whole);
        assert!(fold.folds && fold.least_det < 0.0);
        assert!(
            (fold.least_idle.expect("an idle") - 0.08875).abs() < 1e-5,
            "{:?}",
            fold.least_idle
        );
        let [u, l] = fold.least_det_at;
        assert!(u < 0.09 && l > 0.79, "{u} {l}");
        let map = EnclosedPairMap::of(b, &THRUST, &TORQUE);
        let proven = |min: f64| map.prove_injective(ThrottleBox { min, max: 1.0 }.into()).is_ok();
        assert!(proven(0.0888) && !proven(0.0887));
        let idle = round_idle(&map, fold.least_idle.expect("an idle"), 1.0);
        assert_eq!(idle, Some(0.09));
        assert_eq!(
            round_idle(&map, 0.05, 1.0),
            Some(0.09),
            "the idle itself is proven"
        );
    }

    #[test]
    fn a_positive_determinant_is_not_enough() {
        // f = -u, Q = -l: det J = 1, but a thrust that falls with the throttle is no map that the
        // compiler takes.
        let minus = |term: &str| {
            let names = Basis::Biquadratic.term_names();
            names
                .iter()
                .map(|n| -f64::from(u8::from(n == term)))
                .collect::<Vec<_>>()
        };
        let whole = ThrottleBox { min: 0.0, max: 1.0 };
        let fold = examine(Basis::Biquadratic, &minus("u"), &minus("l"), whole);
        assert!(!fold.folds && !fold.injective);
        assert_eq!((fold.least_det, fold.least_idle), (1.0, None));
    }

    #[test]
    fn a_constant_map_and_nan_are_no_proof() {
        let b = Basis::Biquadratic;
        let whole = ThrottleBox { min: 0.1, max: 1.0 };
        for (thrust, torque) in [([0.0; 8], [0.0; 8]), ([f64::NAN; 8], TORQUE), (THRUST, THRUST)] {
            let fold = examine(b, &thrust, &torque, whole);
            assert!(fold.folds && !fold.injective, "{thrust:?}");
            assert_eq!(fold.least_idle, None);
        }
    }
}
