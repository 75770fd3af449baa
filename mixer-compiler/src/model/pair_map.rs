//! The forward map of one unit in f64, with its Jacobian: what inverses are fitted to and checked
//! against.

use crate::airframe::{Airframe, Basis, Kind, POWERS, Pair, RotorAlone, Throttle, Unit};
use crate::bounds::bisected;

/// Thrust and torque of one unit at the reference voltage (eq. (1)).
#[derive(Clone, Debug)]
pub struct PairMap {
    /// Coefficients in thrust (N) and in torque (N m), by exponents of u and of l.
    coefficients: [[[f64; 2]; POWERS]; POWERS],
    /// How many of each row are in use, and how many rows.
    widths: [usize; POWERS],
    rows: usize,
    range: [f64; 2],
}

/// A value and its derivatives by u and by l, of thrust and of torque.
#[derive(Clone, Copy, Default)]
struct Slopes {
    value: [f64; 2],
    by_u: [f64; 2],
    by_l: [f64; 2],
}

/// The forward map of each unit.
pub fn maps(airframe: &Airframe) -> Vec<PairMap> {
    let kinds: Vec<PairMap> = airframe
        .views()
        .map(|view| PairMap::of_kind(view.of, &view.throttle))
        .collect();
    airframe
        .units
        .iter()
        .map(|unit| kinds[unit.kind].clone())
        .collect()
}

/// The mean map of the units that are pairs, of the single rotors where none is: what a mixer has that takes rotors for
/// alike. `maps` are those of the units.
pub fn mean(airframe: &Airframe, maps: &[PairMap]) -> PairMap {
    let units = airframe.units.iter().zip(maps);
    let is_meant = |unit: &Unit| airframe.pairs.is_empty() || unit.lower_channel.is_some();
    let meant: Vec<(&Unit, &PairMap)> = units.filter(|(unit, _)| is_meant(unit)).collect();
    let (first, count) = (meant[0], meant.len() as f64);
    let mut mean = first.1.clone();
    if meant.iter().any(|(unit, _)| unit.kind != first.0.kind) {
        for (i, j, k) in (0..POWERS * POWERS * 2).map(|at| (at / (2 * POWERS), at / 2 % POWERS, at % 2)) {
            let values = meant.iter().map(|(_, map)| map.coefficients[i][j][k]);
            mean.coefficients[i][j][k] = values.sum::<f64>() / count;
        }
    }
    mean
}

/// The throttle of all rotors alike at which units of these maps lift `thrust_n` N at the reference voltage, from 0 on; `None`
/// where none does.
pub fn equal_throttle(airframe: &Airframe, maps: &[PairMap], thrust_n: f64) -> Option<f64> {
    let lift = |throttle: f64| -> f64 {
        let units = airframe.units.iter().zip(maps);
        units
            .map(|(unit, map)| -unit.axis[2] * map.efforts([throttle; 2])[0])
            .sum()
    };
    let max = airframe.throttle.max;
    (thrust_n < lift(max)).then(|| bisected([0.0, max], |throttle| lift(throttle) >= thrust_n))
}

/// The largest thrust (N) and torque (N m) of each unit at `[k_f, k_Q]`.
pub fn scales(airframe: &Airframe, factors: [f64; 2]) -> Vec<[f64; 2]> {
    let scales = airframe
        .views()
        .map(|view| PairMap::of_kind(view.of, &view.throttle).scale());
    let scales: Vec<[f64; 2]> = scales.collect();
    let units = airframe.units.iter();
    units
        .map(|unit| [0, 1].map(|k| factors[k] * scales[unit.kind][k]))
        .collect()
}

impl PairMap {
    /// The map of a pair over the allowed throttles.
    pub fn new(pair: &Pair, throttle: &Throttle) -> Self {
        let range = [throttle.min, throttle.max];
        Self::of(pair.basis, &pair.thrust_n, &pair.torque_nm, range)
    }

    /// The map of a unit over the allowed throttles: that of a single rotor is constant along the lower throttle.
    pub fn of_kind(kind: Kind<'_>, throttle: &Throttle) -> Self {
        let RotorAlone { thrust_n, torque_nm } = match kind {
            Kind::Pair(pair) => return PairMap::new(pair, throttle),
            Kind::SingleRotor(rotor) => &rotor.alone,
        };
        let [thrust_n, torque_nm] = [*thrust_n, *torque_nm].map(RotorAlone::in_cubic_terms);
        let range = [throttle.min, throttle.max];
        Self::of(Basis::Cubic, &thrust_n, &torque_nm, range)
    }

    /// The map of these coefficients, N and N m, one per term of the basis, over a range of throttle.
    pub fn of(basis: Basis, thrust_n: &[f64], torque_nm: &[f64], range: [f64; 2]) -> Self {
        let mut map = PairMap {
            coefficients: [[[0.0; 2]; POWERS]; POWERS],
            widths: [0; POWERS],
            rows: 0,
            range,
        };
        let coefficients = thrust_n.iter().zip(torque_nm);
        for (&exponents, (&f, &q)) in basis.exponents().iter().zip(coefficients) {
            let (i, j) = (usize::from(exponents.0), usize::from(exponents.1));
            map.coefficients[i][j] = [f, q];
            map.widths[i] = map.widths[i].max(j + 1);
            map.rows = map.rows.max(i + 1);
        }
        map
    }

    /// The terms in the throttle of the upper (0) or of the lower (1) rotor alone, from the fourth power down to the first,
    /// N and N m.
    pub fn along(&self, side: usize) -> [[f64; 2]; 4] {
        let term = |power: usize| [self.coefficients[power][0], self.coefficients[0][power]][side];
        [4, 3, 2, 1].map(term)
    }

    /// Least and largest throttle.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Efforts `[f, Q]` at throttles `[u, l]`, N and N m.
    pub fn efforts(&self, [u, l]: [f64; 2]) -> [f64; 2] {
        // Plain loops, here and below: fits in builds without optimisation spend half of their time
        // here.
        let (mut f, mut q) = (0.0, 0.0);
        let mut i = self.rows;
        while i > 0 {
            i -= 1;
            let row = &self.coefficients[i];
            let (mut row_f, mut row_q) = (0.0, 0.0);
            let mut j = self.widths[i];
            while j > 0 {
                j -= 1;
                row_f = row_f * l + row[j][0];
                row_q = row_q * l + row[j][1];
            }
            f = f * u + row_f;
            q = q * u + row_q;
        }
        [f, q]
    }

    /// Horner's rule in both throttles, with derivatives.
    fn slopes(&self, [u, l]: [f64; 2]) -> Slopes {
        let mut sum = Slopes::default();
        let mut k = 0;
        while k < 2 {
            let (mut value, mut by_u, mut by_l) = (0.0, 0.0, 0.0);
            let mut i = self.rows;
            while i > 0 {
                i -= 1;
                let row = &self.coefficients[i];
                let (mut inner, mut inner_by_l) = (0.0, 0.0);
                let mut j = self.widths[i];
                while j > 0 {
                    j -= 1;
                    inner_by_l = inner_by_l * l + inner;
                    inner = inner * l + row[j][k];
                }
                by_u = by_u * u + value;
                value = value * u + inner;
                by_l = by_l * u + inner_by_l;
            }
            sum.value[k] = value;
            sum.by_u[k] = by_u;
            sum.by_l[k] = by_l;
            k += 1;
        }
        sum
    }

    /// Jacobian `[[f_u, f_l], [Q_u, Q_l]]` at throttles `[u, l]`.
    pub fn jacobian(&self, throttles: [f64; 2]) -> [[f64; 2]; 2] {
        let Slopes { by_u, by_l, .. } = self.slopes(throttles);
        [[by_u[0], by_l[0]], [by_u[1], by_l[1]]]
    }

    /// One Newton step from `throttles` towards `efforts`, clamped to the range as `mixer-rt` does.
    pub fn newton(&self, [u, l]: [f64; 2], [f, q]: [f64; 2]) -> [f64; 2] {
        let Slopes {
            value: given,
            by_u: [f_u, q_u],
            by_l: [f_l, q_l],
        } = self.slopes([u, l]);
        let determinant = f_u * q_l - f_l * q_u;
        let (missing_f, missing_q) = (f - given[0], q - given[1]);
        [
            self.clamp(u + (missing_f * q_l - missing_q * f_l) / determinant),
            self.clamp(l + (missing_q * f_u - missing_f * q_u) / determinant),
        ]
    }

    /// The throttles that give `efforts`, by Newton's method from `start`; `None` where no throttles within the
    /// range do.
    pub fn inverse(&self, start: [f64; 2], efforts: [f64; 2]) -> Option<[f64; 2]> {
        const CLOSE: f64 = 1e-9;
        let exact = (0..50).fold(start, |throttles, _| self.newton(throttles, efforts));
        let (given, scale) = (self.efforts(exact), self.scale());
        let close = (0..2).all(|k| (given[k] - efforts[k]).abs() < CLOSE * scale[k]);
        close.then_some(exact)
    }

    /// A throttle limited to the range.
    pub(crate) fn clamp(&self, throttle: f64) -> f64 {
        throttle.clamp(self.range[0], self.range[1])
    }

    /// Throttles on a `points` x `points` grid over the range that is denser towards the edges
    /// (Chebyshev's extrema), corners included.
    pub(crate) fn grid(&self, points: usize) -> Vec<[f64; 2]> {
        squared(&self.nodes(points))
    }

    /// [`PairMap::grid`] with two more lines along every edge of the box: next to a fold an inverse
    /// bends within less than the grid's first step.
    pub(crate) fn edge_grid(&self, points: usize) -> Vec<[f64; 2]> {
        let [low, high] = self.range;
        let mut nodes = self.nodes(points);
        let step = nodes[1] - low;
        for share in [0.25, 0.0625] {
            nodes.extend([low + share * step, high - share * step]);
        }
        nodes.sort_by(f64::total_cmp);
        squared(&nodes)
    }

    fn nodes(&self, points: usize) -> Vec<f64> {
        let [low, high] = self.range;
        let node = |k: usize| {
            let share = 0.5 - 0.5 * libm::cos(std::f64::consts::PI * k as f64 / (points - 1) as f64);
            if k + 1 == points {
                high
            } else {
                low + (high - low) * share
            }
        };
        (0..points).map(node).collect()
    }

    /// `points` throttles along the border of the box, anticlockwise in the plane of (f, Q): since
    /// det J > 0 the map keeps the sense of rotation. Starts at idle, corners included once each;
    /// `points` is per edge.
    pub fn border(&self, points: usize) -> Vec<[f64; 2]> {
        let [low, high] = self.range;
        let at = |k: usize| low + (high - low) * k as f64 / points as f64;
        let mut border = Vec::with_capacity(4 * points);
        border.extend((0..points).map(|k| [at(k), low]));
        border.extend((0..points).map(|k| [high, at(k)]));
        border.extend((0..points).map(|k| [high - (at(k) - low), high]));
        border.extend((0..points).map(|k| [low, high - (at(k) - low)]));
        border
    }

    /// The efforts `[f, Q]` along the border of the attainable set, over [`PairMap::scale`]; points
    /// as in [`PairMap::border`].
    pub(crate) fn scaled_border(&self, points: usize) -> Vec<[f64; 2]> {
        let scale = self.scale();
        let scaled = |throttles| {
            let [f, q] = self.efforts(throttles);
            [f / scale[0], q / scale[1]]
        };
        self.border(points).into_iter().map(scaled).collect()
    }

    /// The efforts `[f, Q]` on the box's diagonal, which runs through the attainable set from its
    /// idle corner to its full one, in `steps` steps.
    pub(crate) fn diagonal(&self, steps: usize) -> impl Iterator<Item = [f64; 2]> {
        let [low, high] = self.range;
        (0..=steps).map(move |k| self.efforts([low + (high - low) * k as f64 / steps as f64; 2]))
    }

    /// Means over the box of f_u^2 + f_l^2 (N^2) and of Q_u^2 + Q_l^2 (N^2 m^2): what a throttle changes.
    pub(crate) fn mean_square_slopes(&self) -> [f64; 2] {
        const POINTS: usize = 16;
        let [low, high] = self.range;
        let at = |k: usize| low + (high - low) * (k as f64 + 0.5) / POINTS as f64;
        let mut spread = [0.0; 2];
        for (i, j) in (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (i, j))) {
            for (spread, [by_u, by_l]) in spread.iter_mut().zip(self.jacobian([at(i), at(j)])) {
                *spread += (by_u * by_u + by_l * by_l) / (POINTS * POINTS) as f64;
            }
        }
        spread
    }

    /// Largest thrust (N) and largest absolute torque (N m) over the box: the sizes of the efforts.
    pub fn scale(&self) -> [f64; 2] {
        let mut scale = [0.0f64; 2];
        for throttles in self.border(32) {
            let [f, q] = self.efforts(throttles);
            scale = [scale[0].max(f.abs()), scale[1].max(q.abs())];
        }
        scale
    }
}

fn squared(nodes: &[f64]) -> Vec<[f64; 2]> {
    nodes
        .iter()
        .flat_map(|&u| nodes.iter().map(move |&l| [u, l]))
        .collect()
}
