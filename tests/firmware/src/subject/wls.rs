//! Isolated rotors with the allocator of the crate `wls-alloc`: weighted least squares within the
//! bounds, by an active-set method that starts from its last solution, as in its documentation.
//!
//! Thrusts are shares of a rotor's range, axes shares of their authority. Weights: roll and pitch
//! before thrust before yaw. The voltage correction and the thrust curve are those of
//! `isolated_rotors`.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;

use isolated_rotors::ThrustCurve;
use mixer_rt::{Health, SetpointError, Wrench, tables::sqrt};
use wls_alloc::wls::ControlAllocator;
use wls_alloc::{ExitCode, MatA, VecN};

use super::{EFFECTIVENESS, ISOLATED, ROTORS, ROWS, airframe};

/// Throttles, and whether the solver converged.
pub(crate) type Mixed = Result<([f32; ROTORS], bool), SetpointError>;

/// Weights of roll, pitch, yaw and thrust.
const WEIGHTS: [f32; 4] = [10.0, 10.0, 1.0, 5.0];
/// Weight of the least norm and bound of the condition, as in the crate's documentation.
const THETA: f32 = 2e-9;
const CONDITION: f32 = 4e5;
/// Steps of the solver at most, likewise.
const STEPS: usize = 100;

struct State {
    allocator: ControlAllocator<ROTORS, 4, ROWS>,
    /// Per axis: what all rotors at their least thrust give, and 1 / authority.
    offset: [f32; 4],
    per_authority: [f32; 4],
}

struct Cell(UnsafeCell<MaybeUninit<State>>);

// SAFETY: the images have one thread and no interrupt that mixes.
unsafe impl Sync for Cell {}

static STATE: Cell = Cell(UnsafeCell::new(MaybeUninit::uninit()));

/// Sets the allocator up; before the first [`mix`].
pub(crate) fn prepare() {
    let [low, high] = ISOLATED.thrust_n;
    let mut matrix = MatA::<4, ROTORS>::zeros();
    let (mut offset, mut per_authority) = ([0.0; 4], [1.0; 4]);
    for (axis, row) in EFFECTIVENESS.iter().enumerate() {
        let authority: f32 = row.iter().map(|share| share.abs() * (high - low)).sum();
        offset[axis] = row.iter().map(|share| share * low).sum();
        per_authority[axis] = if authority > 0.0 { 1.0 / authority } else { 0.0 };
        for (rotor, share) in row.iter().enumerate() {
            matrix[(axis, rotor)] = share * (high - low) * per_authority[axis];
        }
    }
    let weights = VecN::<4>::from_column_slice(&WEIGHTS);
    let allocator = ControlAllocator::new(&matrix, &weights, VecN::<ROTORS>::repeat(1.0), THETA, CONDITION);
    // SAFETY: nothing else has the cell.
    unsafe {
        (*STATE.0.get()).write(State {
            allocator,
            offset,
            per_authority,
        });
    }
}

#[inline(always)]
pub(crate) fn mix(setpoint: &Wrench, voltage_v: f32, _: Health) -> Mixed {
    // SAFETY: prepared before the first mix; one thread.
    let State {
        allocator,
        offset,
        per_authority,
    } = unsafe { (*STATE.0.get()).assume_init_mut() };
    let mut factor = 1.0;
    if let Some(voltage) = &airframe::TABLES.voltage {
        let [low, high] = voltage.range;
        factor = voltage.factors(voltage_v.max(low).min(high))[0];
    }
    let per_factor = 1.0 / factor;
    let mut request = VecN::<4>::zeros();
    for (axis, value) in setpoint.to_array().into_iter().enumerate() {
        request[axis] = (value * per_factor - offset[axis]) * per_authority[axis];
    }
    let (zeros, ones) = (VecN::<ROTORS>::zeros(), VecN::<ROTORS>::repeat(1.0));
    let stats = allocator.solve(&request, &zeros, &zeros, &ones, STEPS);
    let [low, high] = ISOLATED.thrust_n;
    let mut throttle = [0.0; ROTORS];
    for (throttle, share) in throttle.iter_mut().zip(allocator.solution().iter()) {
        let thrust_n = low + share * (high - low);
        if let ThrustCurve::Parabola { per_n, shift } = ISOLATED.curve {
            let radicand = thrust_n * per_n + shift * shift;
            let root = sqrt(if radicand > 0.0 { radicand } else { 0.0 });
            *throttle = ISOLATED.throttle.clamp(root - shift);
        }
    }
    Ok((throttle, matches!(stats.exit_code, ExitCode::Success)))
}
