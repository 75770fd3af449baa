//! Wind, and the drag of the vehicle in it.
//!
//! The wind is a steady one, horizontal, from a drawn direction, plus gusts by Dryden's model at 5 m over the ground
//! (MIL-F-8785C, 3.7.3): each component is a Gauss-Markov process, which is Dryden's longitudinal spectrum, carried past
//! the vehicle by the steady wind.
//!
//! With v the vehicle's velocity through the air, in the body, drag over mass is
//!
//! ```text
//! a = -M (v_x, v_y, 0) - rho |v| v / (2 B)
//! ```
//!
//! the momentum drag of rotors, in their plane, and that of a bluff body: the model by which PX4 and ArduPilot estimate the
//! wind of a multirotor. M and B are PX4's defaults (`EKF2_MCOEF`, `EKF2_BCOEF_X`). It acts on the centre of gravity.

use nalgebra::Vector3;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

use simulation::air::{gauss_markov, normal};
use simulation::sitl::vehicle::MOST_ROTORS;
use simulation::state::State;

/// Momentum drag, M, 1/s.
const MOMENTUM_1_S: f64 = 0.15;

/// Ballistic coefficient, B: mass over the drag area, kg/m2.
const BALLISTIC_KG_M2: f64 = 100.0;

/// Standard deviation of the gusts over the steady wind, and their length, m; along the horizontal axes and the vertical
/// one.
const GUST: Vector3<f64> = Vector3::new(0.2, 0.2, 0.1);
const LENGTH_M: Vector3<f64> = Vector3::new(36.0, 36.0, 5.0);

/// The wind at the vehicle.
#[derive(Clone, Debug)]
pub(crate) struct Wind {
    speed_m_s: f64,
    density_kg_m3: f64,
    source: Pcg64Mcg,
    steady: Vector3<f64>,
    gust: Vector3<f64>,
}

impl Wind {
    /// A steady speed in air of a density; equal seeds give equal directions and gusts.
    pub(crate) fn new(speed_m_s: f64, density_kg_m3: f64, seed: u64) -> Wind {
        // Another sequence than those of spread and noise.
        let mut source = Pcg64Mcg::seed_from_u64(seed ^ 0x0a_17);
        // Two equal normal deviates have no preferred direction.
        let [x, y] = [(); 2].map(|()| normal(&mut source));
        let steady = Vector3::new(x, y, 0.0).normalize() * speed_m_s;
        let gust = GUST.map(|size| size * speed_m_s * normal(&mut source));
        Wind {
            speed_m_s,
            density_kg_m3,
            source,
            steady,
            gust,
        }
    }

    /// Velocity of the air in the world, m/s.
    pub(crate) fn velocity(&self) -> Vector3<f64> {
        self.steady + self.gust
    }

    /// Lets the gusts go on by `step` seconds.
    pub(crate) fn advance(&mut self, step: f64) {
        for axis in 0..3 {
            let steps = step * self.speed_m_s / LENGTH_M[axis];
            let size = GUST[axis] * self.speed_m_s;
            self.gust[axis] = gauss_markov(self.gust[axis], size, steps, &mut self.source);
        }
    }

    /// Drag over mass in the body, m/s2.
    pub(crate) fn drag(&self, state: &State<MOST_ROTORS>) -> Vector3<f64> {
        let v = state.rotation().inverse() * (state.velocity - self.velocity());
        let bluff = v * (0.5 * self.density_kg_m3 * v.norm() / BALLISTIC_KG_M2);
        -(Vector3::new(v.x, v.y, 0.0) * MOMENTUM_1_S + bluff)
    }
}

mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;

    #[test]
    fn gusts_have_the_stated_size_and_length() {
        let mut wind = Wind::new(8.0, 1.2, 1);
        let step = 0.01;
        let along: Vec<Vector3<f64>> = (0..400_000)
            .map(|_| {
                wind.advance(step);
                wind.velocity() - wind.steady
            })
            .collect();
        for axis in 0..3 {
            let of = |k: usize| along[k][axis];
            let count = along.len();
            let square = (0..count).map(|k| of(k) * of(k)).sum::<f64>() / count as f64;
            // 4000 s at 8 m/s hold some 900 independent gusts of 36 m.
            let size = square.sqrt() / (8.0 * GUST[axis]);
            assert!((0.93..1.07).contains(&size), "axis {axis}: {size}");
            let later = (LENGTH_M[axis] / 8.0 / step).round() as usize;
            let product = (later..count).map(|k| of(k) * of(k - later)).sum::<f64>() / count as f64;
            let kept = product / square;
            assert!((kept - libm::exp(-1.0)).abs() < 0.1, "axis {axis}: {kept}");
        }
    }

    #[test]
    fn seeds_draw_the_direction_and_not_the_speed() {
        let steady = [1, 1, 2].map(|seed| Wind::new(5.0, 1.2, seed).steady);
        assert!(steady[0] == steady[1] && (steady[0] - steady[2]).norm() > 0.1);
        for wind in steady {
            assert!((wind.norm() - 5.0).abs() < 1e-12 && wind.z == 0.0, "{wind}");
        }
    }

    #[test]
    fn drag_is_against_the_motion_through_the_air() {
        let still = Wind::new(0.0, 1.2, 1);
        let mut state = State::level(Vector3::zeros(), 0.0);
        state.velocity = Vector3::new(10.0, 0.0, 0.0);
        // 0.15 * 10 + 1.2 * 100 / 200.
        let drag = still.drag(&state);
        assert!((drag - Vector3::new(-2.1, 0.0, 0.0)).norm() < 1e-12, "{drag}");
        // Nose down by 90 degrees the motion is along the rotors' axis: no momentum drag.
        state.attitude = UnitQuaternion::from_euler_angles(0.0, -90f64.to_radians(), 0.0).into_inner();
        let drag = still.drag(&state);
        assert!((drag.norm() - 0.6).abs() < 1e-12, "{drag}");
        // At rest in wind it is carried along.
        let wind = Wind::new(5.0, 1.2, 1);
        let drag = wind.drag(&State::level(Vector3::zeros(), 0.0));
        assert!(drag.dot(&wind.velocity()) > 0.0, "{drag}");
    }
}
