//! Effectiveness M and its pseudo-inverse M+.
//!
//! A unit at r with unit thrust axis a gives the force f a and, about the centre of gravity, the
//! torque r x (f a); the reaction of its rotors adds -s Q a (for a = (0, 0, -1): s Q about z,
//! clockwise positive). Thrust counts upwards, T = -f a_z. With eta = [f_1 .. f_n, Q_1 .. Q_n] this
//! is u = M eta, M being 4 x 2n (eq. (5)); for vertical axes its rows are eq. (4). The least-norm
//! solution is eta = M+ u (eq. (7), (8)).
//!
//! An airframe may leave axes out: their rows are dropped before inversion and their columns of M+
//! are zero.

use nalgebra::{DMatrix, Matrix4xX, MatrixXx4};

use crate::airframe::{Airframe, Axis};
use crate::diagnostic::{Code, Diagnostic};

/// M and M+ with what is known about them.
#[derive(Clone, Debug, PartialEq)]
pub struct Effectiveness {
    /// M, 4 x 2n: `[roll, pitch, yaw (N m), thrust (N)]` per `[f_1.. (N), Q_1.. (N m)]`.
    pub matrix: Matrix4xX<f64>,
    /// M+, 2n x 4.
    pub pseudo_inverse: MatrixXx4<f64>,
    /// Rank of M's rows that are served.
    pub rank: usize,
    /// Largest over smallest singular value of those rows.
    pub condition: f64,
}

/// Singular values below this share of the largest count as zero: geometry is known to a millimetre
/// in a metre.
const RANK_TOLERANCE: f64 = 1e-6;

impl Effectiveness {
    /// M of the layout and M+ over the axes that the airframe serves.
    ///
    /// # Errors
    /// A served axis that the layout cannot produce independently of the others, by name.
    pub fn new(airframe: &Airframe) -> Result<Self, Vec<Diagnostic>> {
        let matrix = matrix(airframe);
        let served: Vec<usize> = Axis::ALL
            .into_iter()
            .filter(|&axis| airframe.allocation.controls(axis))
            .map(|axis| axis as usize)
            .collect();
        let rows = matrix.select_rows(&served).transpose();
        let rows = DMatrix::from_columns(&rows.column_iter().collect::<Vec<_>>()).transpose();
        let svd = rows.clone().svd(true, true);
        let (largest, smallest) = (svd.singular_values.max(), svd.singular_values.min());
        let threshold = RANK_TOLERANCE * largest;
        let rank = svd.rank(threshold);
        if rank < served.len() {
            return Err(vec![deficiency(airframe, &matrix, threshold)]);
        }
        let inverse = svd.pseudo_inverse(threshold).map_err(|reason| {
            let message = format!("no pseudo-inverse: {reason}");
            vec![airframe.diagnostic(
                Code::RankDeficient,
                "unit",
                message,
                "",
                "check the positions of the units",
            )]
        })?;
        let mut pseudo_inverse = MatrixXx4::zeros(matrix.ncols());
        for (column, &axis) in served.iter().enumerate() {
            pseudo_inverse.set_column(axis, &inverse.column(column).map(|x| clean(x, inverse.amax())));
        }
        Ok(Effectiveness {
            matrix,
            pseudo_inverse,
            rank,
            condition: largest / smallest,
        })
    }

    /// The most that units with efforts up to these sizes (N, N m) give on an axis, N m or N.
    pub(crate) fn largest(&self, axis: usize, [f, q]: [f64; 2]) -> f64 {
        let row = self.matrix.row(axis);
        let n = self.matrix.ncols() / 2;
        (0..n).map(|i| row[i].abs() * f + row[n + i].abs() * q).sum()
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

/// M of the layout.
fn matrix(airframe: &Airframe) -> Matrix4xX<f64> {
    let n = airframe.units.len();
    let mut matrix = Matrix4xX::zeros(2 * n);
    for (i, unit) in airframe.units.iter().enumerate() {
        let ([x, y, z], [ax, ay, az]) = (unit.position_m, unit.axis);
        let sign = unit.spin_sign(airframe.pair.upper_spin);
        let by_thrust = [y * az - z * ay, z * ax - x * az, x * ay - y * ax, -az];
        let by_torque = [-sign * ax, -sign * ay, -sign * az, 0.0];
        for axis in 0..4 {
            matrix[(axis, i)] = by_thrust[axis] + 0.0; // no negative zeros in reports and tables
            matrix[(axis, n + i)] = by_torque[axis] + 0.0;
        }
    }
    matrix
}

/// Rounding residues of the SVD (a few units in the last place of the largest entry) become the
/// zeros they stand for: symmetric frames then have sparse tables.
fn clean(x: f64, largest: f64) -> f64 {
    if x.abs() < 1e-14 * largest { 0.0 } else { x }
}

/// The order in which axes claim the layout: what comes later is what a deficient layout cannot
/// produce.
const CLAIMS: [Axis; 4] = [Axis::Thrust, Axis::Roll, Axis::Pitch, Axis::Yaw];

/// Names the axes that cannot be produced: those whose row adds nothing to the rows before it.
fn deficiency(airframe: &Airframe, matrix: &Matrix4xX<f64>, threshold: f64) -> Diagnostic {
    let (mut kept, mut lost): (Vec<Axis>, Vec<Axis>) = (Vec::new(), Vec::new());
    for axis in CLAIMS
        .into_iter()
        .filter(|&axis| airframe.allocation.controls(axis))
    {
        let rows: Vec<usize> = kept.iter().chain([&axis]).map(|&axis| axis as usize).collect();
        let rank = DMatrix::from_fn(rows.len(), matrix.ncols(), |i, j| matrix[(rows[i], j)]).rank(threshold);
        if rank == rows.len() {
            kept.push(axis)
        } else {
            lost.push(axis)
        }
    }
    kept.sort();
    lost.sort();
    let names = |axes: &[Axis]| {
        axes.iter()
            .map(|axis| axis.name())
            .collect::<Vec<_>>()
            .join(" and ")
    };
    let list: Vec<String> = kept.iter().map(|axis| format!("\"{}\"", axis.name())).collect();
    let (served, lost) = (airframe.allocation.axes.len(), names(&lost));
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
            list.join(", ")
        ),
    )
}
