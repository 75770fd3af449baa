//! The four rows roll and pitch along the request, across it, yaw, thrust: their columns and the
//! symmetric system of their multipliers.

use crate::larger;

/// Added to the diagonal: keeps the system regular where a row is not served.
const REGULAR: f32 = 1e-6;

/// A pivot is at least this share of its diagonal element: what rounding leaves of it.
const ROUNDING: f32 = 1e-6;

/// A unit's columns: rows per N of thrust and per N m of torque.
pub(super) type Columns = [[f32; 4]; 2];

/// A symmetric 4 by 4 matrix, the upper triangle by rows.
pub(super) type Matrix = [f32; 10];

/// Products with a unit's columns B. With vertical axes thrusts give no yaw and torques nothing else,
/// which halves them.
pub(super) struct Products<const VERTICAL: bool>;

impl<const VERTICAL: bool> Products<VERTICAL> {
    /// B^T r: what more of `[f, Q]` is worth.
    #[inline(always)]
    pub(super) fn gains([thrust, torque]: &Columns, r: &[f32; 4]) -> [f32; 2] {
        if VERTICAL {
            return [
                thrust[0] * r[0] + thrust[1] * r[1] + thrust[3] * r[3],
                torque[2] * r[2],
            ];
        }
        let dot = |c: &[f32; 4]| (c[0] * r[0] + c[1] * r[1]) + (c[2] * r[2] + c[3] * r[3]);
        [dot(thrust), dot(torque)]
    }

    /// Takes B y from rows.
    #[inline(always)]
    pub(super) fn subtract([thrust, torque]: &Columns, [f, q]: [f32; 2], rows: &mut [f32; 4]) {
        if VERTICAL {
            rows[0] -= thrust[0] * f;
            rows[1] -= thrust[1] * f;
            rows[2] -= torque[2] * q;
            rows[3] -= thrust[3] * f;
            return;
        }
        for axis in 0..4 {
            rows[axis] -= thrust[axis] * f + torque[axis] * q;
        }
    }

    /// Adds B G B^T for the symmetric G = [[a, b], [b, c]].
    #[inline(always)]
    pub(super) fn add([thrust, torque]: &Columns, [a, b, c]: [f32; 3], matrix: &mut Matrix) {
        let [t0, t1, t2, t3] = *thrust;
        let [r0, r1, r2, r3] = *torque;
        if VERTICAL {
            let (a0, a1, a3, b2) = (a * t0, a * t1, a * t3, b * r2);
            matrix[0] += a0 * t0;
            matrix[1] += a0 * t1;
            matrix[2] += b2 * t0;
            matrix[3] += a0 * t3;
            matrix[4] += a1 * t1;
            matrix[5] += b2 * t1;
            matrix[6] += a1 * t3;
            matrix[7] += c * r2 * r2;
            matrix[8] += b2 * t3;
            matrix[9] += a3 * t3;
            return;
        }
        let [f0, f1, f2, f3] = [a * t0 + b * r0, a * t1 + b * r1, a * t2 + b * r2, a * t3 + b * r3];
        let [q0, q1, q2, q3] = [b * t0 + c * r0, b * t1 + c * r1, b * t2 + c * r2, b * t3 + c * r3];
        matrix[0] += f0 * t0 + q0 * r0;
        matrix[1] += f0 * t1 + q0 * r1;
        matrix[2] += f0 * t2 + q0 * r2;
        matrix[3] += f0 * t3 + q0 * r3;
        matrix[4] += f1 * t1 + q1 * r1;
        matrix[5] += f1 * t2 + q1 * r2;
        matrix[6] += f1 * t3 + q1 * r3;
        matrix[7] += f2 * t2 + q2 * r2;
        matrix[8] += f2 * t3 + q2 * r3;
        matrix[9] += f3 * t3 + q3 * r3;
    }
}

/// L D L^T of a matrix: 1 / D and L below its diagonal by columns.
#[derive(Clone, Copy)]
pub(super) struct Factors {
    per_pivot: [f32; 4],
    lower: [f32; 6],
}

impl Factors {
    /// Of nothing.
    pub(super) const NONE: Factors = Factors {
        per_pivot: [0.0; 4],
        lower: [0.0; 6],
    };

    /// Factorises a matrix that is positive semidefinite but for rounding.
    #[inline(always)]
    pub(super) fn of(matrix: &Matrix) -> Self {
        let [m00, m01, m02, m03, m11, m12, m13, m22, m23, m33] = *matrix;
        let per_pivot = |left: f32, whole: f32| 1.0 / larger(left + REGULAR, ROUNDING * whole + REGULAR);
        let p0 = per_pivot(m00, m00);
        let (l01, l02, l03) = (m01 * p0, m02 * p0, m03 * p0);
        let (e11, e12, e13) = (m11 - l01 * m01, m12 - l01 * m02, m13 - l01 * m03);
        let p1 = per_pivot(e11, m11);
        let (l12, l13) = (e12 * p1, e13 * p1);
        let (e22, e23) = (m22 - l02 * m02 - l12 * e12, m23 - l02 * m03 - l12 * e13);
        let p2 = per_pivot(e22, m22);
        let l23 = e23 * p2;
        let p3 = per_pivot(m33 - l03 * m03 - l13 * e13 - l23 * e23, m33);
        Factors {
            per_pivot: [p0, p1, p2, p3],
            lower: [l01, l02, l03, l12, l13, l23],
        }
    }

    /// The multipliers for a right-hand side.
    #[inline(always)]
    pub(super) fn solve(&self, [mut a, mut b, mut c, mut d]: [f32; 4]) -> [f32; 4] {
        let [l01, l02, l03, l12, l13, l23] = self.lower;
        let [p0, p1, p2, p3] = self.per_pivot;
        b -= l01 * a;
        c -= l02 * a + l12 * b;
        d -= l03 * a + l13 * b + l23 * c;
        d *= p3;
        c = c * p2 - l23 * d;
        b = b * p1 - l12 * c - l13 * d;
        a = a * p0 - l01 * b - l02 * c - l03 * d;
        [a, b, c, d]
    }
}
