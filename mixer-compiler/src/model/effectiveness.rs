//! Effectiveness M and its pseudo-inverse M+.
//!
//! A unit at r with unit thrust axis a gives the force f a and, about the centre of gravity, the
//! torque r x (f a); the reaction of its rotors adds -s Q a (for a = (0, 0, -1): s Q about z,
//! clockwise positive). Thrust counts upwards, T = -f a_z. With eta = [f_1 .. f_n, Q_1 .. Q_n] this
//! is u = M eta, M being 4 x 2n (eq. (5)); for vertical axes its rows are eq. (4). The least-norm
//! solution is eta = M+ u (eq. (7), (8)).
//!
//! M+ is of least norm in shares of the largest thrust and torque of a unit ([`PseudoInverse`]). Where
//! all axes are vertical, thrusts give no yaw and torques nothing else, so this is plain M+. Where
//! axes are tilted, plain M+ weighs a newton as a newton metre and asks for torques that no pair has.
//!
//! A single rotor is one effort, not two. With kappa the ratio of its torque and thrust at half of its largest thrust its
//! column is M_f + kappa M_Q, and its rows of M+ are p and kappa p: what its torque differs from kappa f by, the mixer
//! makes up for along the rotor's curve (`allocate/rotors_alone.rs` of `mixer-rt`).
//!
//! An airframe may leave axes out: their rows are dropped before inversion and their columns of M+
//! are zero.

use nalgebra::{DMatrix, Matrix4xX, MatrixXx4};

use super::pair_map::scales;
use super::pseudo_inverse::PseudoInverse;
use crate::airframe::{Airframe, Axis, Kind};
use crate::diagnostic::{Code, Diagnostic};

/// M and M+ with what is known about them.
#[derive(Clone, Debug, PartialEq)]
pub struct Effectiveness {
    /// M, 4 x 2n: `[roll, pitch, yaw (N m), thrust (N)]` per `[f_1.. (N), Q_1.. (N m)]`.
    pub matrix: Matrix4xX<f64>,
    /// M+, 2n x 4.
    pub pseudo_inverse: MatrixXx4<f64>,
    /// Number of rows of M that are served, all of them independent.
    pub rank: usize,
    /// [`PseudoInverse::condition`] of these rows: 1 where no served axis disturbs another.
    pub condition: f64,
}

/// Largest error of M M+, row-scaled: some thousand roundings of f64.
const LARGEST_RESIDUAL: f64 = 1e-12;

/// Levers below this count as none, m or 1: a micrometre, or a tilt of as little.
const LEAST_LEVER: f64 = 1e-6;

/// The order in which axes claim the layout: what comes later is what a deficient layout cannot
/// produce.
const CLAIMS: [Axis; 4] = [Axis::Thrust, Axis::Roll, Axis::Pitch, Axis::Yaw];

impl Effectiveness {
    /// M of the layout and M+ over the axes that the airframe serves.
    ///
    /// # Errors
    /// Served axes that the layout cannot produce independently of the others, by name.
    pub fn new(airframe: &Airframe) -> Result<Self, Vec<Diagnostic>> {
        let matrix = matrix(airframe);
        let (n, served) = (airframe.units.len(), served(airframe));
        let kappas = kappas(airframe);
        let rows = DMatrix::from_fn(served.len(), 2 * n, |row, column| {
            let entry = |column: usize| matrix[(served[row] as usize, column)];
            match kappas[column % n] {
                None => entry(column),
                Some(kappa) if column < n => entry(column) + kappa * entry(n + column),
                Some(_) => 0.0,
            }
        });
        let scales = scales(airframe, [1.0; 2]);
        // A map without thrust or torque is refused elsewhere.
        let size = |k: usize| {
            scales
                .iter()
                .map(move |scale| if scale[k] > 0.0 { scale[k] } else { 1.0 })
        };
        let sizes: Vec<f64> = size(0).chain(size(1)).collect();
        let inverse =
            PseudoInverse::new(&rows, &sizes).map_err(|lost| vec![deficiency(airframe, &served, &lost)])?;
        let is_accurate = inverse.residual <= LARGEST_RESIDUAL;
        if !is_accurate {
            return Err(vec![inaccuracy(airframe, &inverse)]);
        }
        let mut pseudo_inverse = MatrixXx4::zeros(2 * n);
        for (column, axis) in inverse.matrix.column_iter().zip(&served) {
            pseudo_inverse.set_column(*axis as usize, &column);
        }
        for (i, kappa) in kappas.iter().enumerate() {
            if let Some(kappa) = kappa {
                let by_thrust = pseudo_inverse.row(i) * *kappa;
                pseudo_inverse.set_row(n + i, &by_thrust);
            }
        }
        Ok(Effectiveness {
            matrix,
            pseudo_inverse,
            rank: served.len(),
            condition: inverse.condition,
        })
    }

    /// The most that units with efforts up to these sizes each (N, N m) give on an axis, N m or N.
    pub fn largest(&self, axis: usize, sizes: &[[f64; 2]]) -> f64 {
        let row = self.matrix.row(axis);
        let n = self.matrix.ncols() / 2;
        let most = |(i, [f, q]): (usize, &[f64; 2])| row[i].abs() * f + row[n + i].abs() * q;
        sizes.iter().enumerate().map(most).sum()
    }

    /// True where all axes are vertical: thrusts give no yaw, torques nothing else.
    pub fn is_vertical(&self) -> bool {
        let n = self.matrix.ncols() / 2;
        let matrix = &self.matrix;
        (0..n).all(|i| {
            matrix[(2, i)] == 0.0
                && matrix[(3, i)] == 1.0
                && matrix[(0, n + i)] == 0.0
                && matrix[(1, n + i)] == 0.0
                && matrix[(2, n + i)].abs() == 1.0
                && matrix[(3, n + i)] == 0.0
        })
    }
}

/// Torque over thrust of the units that are single rotors, m, at half of the largest thrust.
fn kappas(airframe: &Airframe) -> Vec<Option<f64>> {
    let kappa = |unit| match airframe.kind_of(unit) {
        Kind::Pair(_) => None,
        Kind::SingleRotor(rotor) => Some(rotor.alone.torque_per_thrust(&airframe.throttle)),
    };
    airframe.units.iter().map(kappa).collect()
}

/// M of the layout.
fn matrix(airframe: &Airframe) -> Matrix4xX<f64> {
    let n = airframe.units.len();
    let mut matrix = Matrix4xX::zeros(2 * n);
    for (i, unit) in airframe.units.iter().enumerate() {
        let ([x, y, z], [ax, ay, az]) = (unit.position_m, unit.axis);
        let sign = airframe.spin_sign(unit);
        let by_thrust = [y * az - z * ay, z * ax - x * az, x * ay - y * ax, -az];
        let by_torque = [-sign * ax, -sign * ay, -sign * az, 0.0];
        for axis in 0..4 {
            matrix[(axis, i)] = lever(by_thrust[axis]);
            matrix[(axis, n + i)] = lever(by_torque[axis]);
        }
    }
    matrix
}

/// An entry of M; 0 where it is the rounding of none, as of cos 90 degrees.
fn lever(entry: f64) -> f64 {
    // Without the sum there would be negative zeros in reports and tables.
    if entry.abs() < LEAST_LEVER {
        0.0
    } else {
        entry + 0.0
    }
}

/// The served axes in the order of [`CLAIMS`].
fn served(airframe: &Airframe) -> Vec<Axis> {
    let served = |axis: &Axis| airframe.allocation.controls(*axis);
    CLAIMS.into_iter().filter(served).collect()
}

/// Names the axes that cannot be produced: those of `served`, by index, whose row adds nothing to
/// the rows before it.
fn deficiency(airframe: &Airframe, served: &[Axis], lost: &[usize]) -> Diagnostic {
    let names = |wanted: bool| {
        let is_lost = |axis: &Axis| lost.iter().any(|&row| served[row] == *axis);
        let axes = Axis::ALL.into_iter().filter(|axis| served.contains(axis));
        axes.filter(move |axis| is_lost(axis) == wanted).map(Axis::name)
    };
    let lost = names(true).collect::<Vec<_>>().join(" and ");
    let kept: Vec<String> = names(false).map(|name| format!("\"{name}\"")).collect();
    let served = served.len();
    let key = if airframe.states("allocation.axes") {
        "allocation.axes"
    } else {
        "unit[0].position_m"
    };
    let label = match airframe.units.len() {
        1 => "the only unit".to_owned(),
        units => format!("one of {units} units"),
    };
    airframe.diagnostic(
        Code::RankDeficient,
        key,
        format!("rank {} of {served}: {lost} cannot be produced by this layout", kept.len()),
        if key == "allocation.axes" { String::new() } else { label },
        format!(
            "move the units so that they have a lever arm for {lost}, or serve what is left: [allocation] axes = [{}]",
            kept.join(", ")
        ),
    )
}

/// Refuses a pseudo-inverse that is not one, whatever the reason.
fn inaccuracy(airframe: &Airframe, inverse: &PseudoInverse) -> Diagnostic {
    airframe.diagnostic(
        Code::PseudoInverse,
        "unit",
        format!(
            "M M+ differs from 1 by {:.1e}, row-scaled; {LARGEST_RESIDUAL:.0e} is allowed",
            inverse.residual
        ),
        "",
        format!(
            "the layout hardly tells its axes apart (condition {:.0}): move the units, or serve fewer axes",
            inverse.condition
        ),
    )
}
