//! The classical fourth-order Runge-Kutta step.
//!
//! Integrator crates keep a trajectory, choose the step or own the loop; here a controller with its
//! own clock holds the throttles between 5 ms samples, so that one step is all that is needed.

use std::ops::{Add, Mul};

/// The state after `step` seconds of dx/dt = `derivative(x)`. The local error is of the fifth order
/// in the step.
pub fn runge_kutta<S>(state: S, step: f64, derivative: impl Fn(&S) -> S) -> S
where
    S: Copy + Add<Output = S> + Mul<f64, Output = S>,
{
    let k1 = derivative(&state);
    let k2 = derivative(&(state + k1 * (0.5 * step)));
    let k3 = derivative(&(state + k2 * (0.5 * step)));
    let k4 = derivative(&(state + k3 * step));
    state + (k1 + (k2 + k3) * 2.0 + k4) * (step / 6.0)
}

#[cfg(test)]
mod tests {
    use super::runge_kutta;

    #[test]
    fn halving_the_step_divides_the_error_by_sixteen() {
        let error = |steps: u32| {
            let step = 1.0 / f64::from(steps);
            let end = (0..steps).fold(1.0, |x, _| runge_kutta(x, step, |x| -x));
            (end - libm::exp(-1.0)).abs()
        };
        let ratio = error(10) / error(20);
        assert!((15.0..18.0).contains(&ratio), "{ratio}");
    }
}
