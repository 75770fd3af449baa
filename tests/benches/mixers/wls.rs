//! Isolated rotors with the allocator of the crate `wls-alloc`, set up as for the firmware's
//! counts.

use isolated_rotors::{IsolatedRotors, IsolatedTables, ThrustCurve};
use mixer_rt::{
    Wrench,
    tables::{Law, sqrt},
};
use wls_alloc::wls::ControlAllocator;
use wls_alloc::{ExitCode, MatA, VecN};

/// Weights of roll, pitch, yaw and thrust.
const WEIGHTS: [f32; 4] = [10.0, 10.0, 1.0, 5.0];
/// Weight of the least norm and bound of the condition, as in the crate's documentation.
const THETA: f32 = 2e-9;
const CONDITION: f32 = 4e5;
/// Steps of the solver at most, likewise.
const STEPS: usize = 100;

/// The crate's allocator of a number of rotors.
pub(crate) trait Allocate<const ROTORS: usize> {
    /// From the effectiveness in shares of each axis's authority.
    fn new(matrix: &MatA<4, ROTORS>) -> Self;

    /// Thrusts as shares of a rotor's range, and whether the solver converged. It starts from its
    /// last solution.
    fn solve(&mut self, request: &VecN<4>) -> ([f32; ROTORS], bool);
}

/// The crate's bounds cannot be stated without its version of nalgebra.
macro_rules! allocator {
    ($rotors:literal) => {
        impl Allocate<$rotors> for ControlAllocator<$rotors, 4, { $rotors + 4 }> {
            fn new(matrix: &MatA<4, $rotors>) -> Self {
                let weights = VecN::<4>::from_column_slice(&WEIGHTS);
                ControlAllocator::new(
                    matrix,
                    &weights,
                    VecN::<$rotors>::repeat(1.0),
                    THETA,
                    CONDITION,
                )
            }

            fn solve(&mut self, request: &VecN<4>) -> ([f32; $rotors], bool) {
                let (zeros, ones) = (VecN::<$rotors>::zeros(), VecN::<$rotors>::repeat(1.0));
                let stats = ControlAllocator::solve(self, request, &zeros, &zeros, &ones, STEPS);
                (
                    (*self.solution()).into(),
                    matches!(stats.exit_code, ExitCode::Success),
                )
            }
        }
    };
}

allocator!(6);
allocator!(8);
allocator!(12);

/// An airframe's mixer.
pub(crate) struct WeightedLeastSquares<'a, A, const ROTORS: usize> {
    allocator: A,
    isolated: IsolatedRotors<'a>,
    voltage: Option<&'a Law<'a>>,
    /// Per axis: what all rotors at their least thrust give, and 1 / authority.
    offset: [f32; 4],
    per_authority: [f32; 4],
}

impl<'a, A: Allocate<ROTORS>, const ROTORS: usize> WeightedLeastSquares<'a, A, ROTORS> {
    /// The mixer of isolated rotors with an allocator.
    pub(crate) fn new(tables: &'a IsolatedTables, voltage: Option<&'a Law<'a>>) -> Self {
        let isolated = tables.view();
        let [low, high] = isolated.thrust_n;
        let mut matrix = MatA::<4, ROTORS>::zeros();
        let (mut offset, mut per_authority) = ([0.0; 4], [1.0; 4]);
        for (axis, row) in tables.effectiveness.row_iter().enumerate() {
            let authority: f32 = row.iter().map(|share| (*share as f32).abs() * (high - low)).sum();
            offset[axis] = row.iter().map(|share| *share as f32 * low).sum();
            per_authority[axis] = if authority > 0.0 { 1.0 / authority } else { 0.0 };
            for (rotor, share) in row.iter().enumerate() {
                matrix[(axis, rotor)] = *share as f32 * (high - low) * per_authority[axis];
            }
        }
        WeightedLeastSquares {
            allocator: A::new(&matrix),
            isolated,
            voltage,
            offset,
            per_authority,
        }
    }

    /// Throttles, and whether the solver converged.
    pub(crate) fn mix(&mut self, setpoint: &Wrench, voltage_v: f32) -> ([f32; ROTORS], bool) {
        let mut factor = 1.0;
        if let Some(voltage) = self.voltage {
            let [low, high] = voltage.range;
            factor = voltage.factors(voltage_v.max(low).min(high))[0];
        }
        let per_factor = 1.0 / factor;
        let mut request = VecN::<4>::zeros();
        for (axis, value) in setpoint.to_array().into_iter().enumerate() {
            request[axis] = (value * per_factor - self.offset[axis]) * self.per_authority[axis];
        }
        let (shares, converged) = self.allocator.solve(&request);
        let [low, high] = self.isolated.thrust_n;
        let mut throttle = [0.0; ROTORS];
        for (throttle, share) in throttle.iter_mut().zip(shares) {
            let thrust_n = low + share * (high - low);
            if let ThrustCurve::Parabola { per_n, shift } = self.isolated.curve {
                let radicand = thrust_n * per_n + shift * shift;
                let root = sqrt(if radicand > 0.0 { radicand } else { 0.0 });
                *throttle = self.isolated.throttle.clamp(root - shift);
            }
        }
        (throttle, converged)
    }
}
