//! How far an answer falls short of the optimum.

use microlp::Error;
use mixer_rt::tables::Airmode;

use crate::optimum::{Optimum, Oracle};
use crate::request::{Answer, Frame, Request};

/// Share of the authority by which an answer may fall short.
pub const ALLOWED: f64 = 0.01;

/// Shortfalls against the optimum, as shares of the authority; negative where more was given than
/// the optimum has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shortfall {
    /// Of (roll, pitch) along the direction asked.
    pub torque: f64,
    /// Of yaw: how much further from the request.
    pub yaw: f64,
    /// Of thrust, likewise.
    pub thrust: f64,
}

impl Shortfall {
    /// True where any priority falls short by more than [`ALLOWED`].
    pub fn misses(&self) -> bool {
        self.largest() > ALLOWED
    }

    /// Of the priority that falls shortest.
    pub fn largest(&self) -> f64 {
        self.torque.max(self.yaw).max(self.thrust)
    }

    /// The larger of each.
    pub fn max(self, other: Shortfall) -> Shortfall {
        Shortfall {
            torque: self.torque.max(other.torque),
            yaw: self.yaw.max(other.yaw),
            thrust: self.thrust.max(other.thrust),
        }
    }

    /// The shortfall of an answer; `None` where the request has no optimum, since not even roll =
    /// pitch = 0 is attainable.
    ///
    /// A higher priority may be short by a little, or over, and what that buys or costs the lower
    /// ones is more than it is itself. So a lower priority is short only if it is against both: the
    /// optimum, and the best that the answer's own higher priorities leave.
    ///
    /// # Errors
    /// The solver of the oracle gave up.
    pub fn of(
        answer: &Answer,
        request: &Request,
        frame: &Frame,
        oracle: &Oracle,
    ) -> Result<Option<Shortfall>, Error> {
        let (served, authority) = (frame.served(), frame.authority);
        let mut asked = request.asked();
        for (asked, _) in asked.iter_mut().zip(served).filter(|(_, served)| !served) {
            *asked = 0.0;
        }
        let Some(optimum) = oracle.optimum(asked)? else {
            return Ok(None);
        };
        let torque = (asked[0] * asked[0] + asked[1] * asked[1]).sqrt();
        let share = if torque > 0.0 {
            (answer.achieved[0] * asked[0] + answer.achieved[1] * asked[1]) / (torque * torque)
        } else {
            0.0
        };
        let size = (0..2)
            .filter(|&axis| served[axis])
            .map(|axis| authority[axis])
            .fold(f64::INFINITY, f64::min);
        let against = |optimum: &Optimum| {
            let missed = |axis: usize, best: f64| {
                let missed = (answer.achieved[axis] - asked[axis]).abs() - (best - asked[axis]).abs();
                if served[axis] {
                    missed / authority[axis]
                } else {
                    0.0
                }
            };
            Shortfall {
                torque: (optimum.share - share) * torque / size,
                yaw: missed(2, optimum.yaw_nm),
                thrust: missed(3, optimum.thrust_n),
            }
        };
        let mut shortfall = against(&optimum);
        if shortfall.misses() {
            let yaw_first = frame.allocation().airmode == Airmode::RollPitchYaw;
            let given = |second: Option<f64>| -> Result<Shortfall, Error> {
                let optimum = oracle.optimum_given(asked, Some((share, second)))?;
                Ok(optimum.map_or(shortfall, |optimum| against(&optimum)))
            };
            let second = given(None)?;
            let third = given(Some(answer.achieved[if yaw_first { 2 } else { 3 }]))?;
            let (yaw, thrust) = if yaw_first {
                (second.yaw, third.thrust)
            } else {
                (third.yaw, second.thrust)
            };
            shortfall.yaw = shortfall.yaw.min(yaw);
            shortfall.thrust = shortfall.thrust.min(thrust);
        }
        Ok(Some(shortfall))
    }

    /// [`Shortfall::of`] against `hulls`, and where that is more than `allowed` against `sets`:
    /// what is missing may be what only the convex hulls of the sets have.
    ///
    /// # Errors
    /// As [`Shortfall::of`].
    pub fn beyond_hulls(
        answer: &Answer,
        request: &Request,
        frame: &Frame,
        allowed: f64,
        hulls: &Oracle,
        sets: impl FnOnce() -> Oracle,
    ) -> Result<Option<Shortfall>, Error> {
        let of_hulls = Shortfall::of(answer, request, frame, hulls)?;
        if of_hulls.is_none_or(|shortfall| shortfall.largest() <= allowed) {
            return Ok(of_hulls);
        }
        Ok(Shortfall::of(answer, request, frame, &sets())?.or(of_hulls))
    }
}
