//! The classical fourth-order Runge-Kutta step.
//!
//! Integrator crates keep a trajectory, choose the step or own the loop; here a controller with its
//! own clock holds the throttles between 5 ms samples, so that one step is all that is needed.

use crate::state::State;

/// The state after `step` seconds of dx/dt = `derivative(x)`. The local error is of the fifth order
/// in the step.
pub fn runge_kutta<const R: usize>(
    state: &State<R>,
    step: f64,
    derivative: impl Fn(&State<R>) -> State<R>,
) -> State<R> {
    let k1 = derivative(state);
    let k2 = derivative(&state.plus(0.5 * step, &k1));
    let k3 = derivative(&state.plus(0.5 * step, &k2));
    let k4 = derivative(&state.plus(step, &k3));
    state.plus(step / 6.0, &k1.plus(2.0, &k2.plus(1.0, &k3)).plus(1.0, &k4))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    #[test]
    fn halving_the_step_divides_the_error_by_sixteen() {
        let error = |steps: u32| {
            let step = 1.0 / f64::from(steps);
            let start = State::<1>::level(Vector3::x(), 0.0);
            let nothing = State {
                attitude: start.attitude * 0.0,
                ..State::level(Vector3::zeros(), 0.0)
            };
            let decay = |x: &State<1>| {
                nothing.plus(
                    -1.0,
                    &State {
                        attitude: nothing.attitude,
                        ..*x
                    },
                )
            };
            let end = (0..steps).fold(start, |x, _| runge_kutta(&x, step, decay));
            (end.position.x - libm::exp(-1.0)).abs()
        };
        let ratio = error(10) / error(20);
        assert!((15.0..18.0).contains(&ratio), "{ratio}");
    }
}
