//! How throttles move from a request to its neighbour, and whether they must.

use microlp::Error;

use crate::optimum::change;
use crate::request::{Frame, Request};

/// The largest change of a throttle where nothing forces more.
pub const JUMP: f32 = 0.02;

/// Times what the priorities force a throttle may move.
const FORCED: f64 = 2.0;

/// How throttles move from a request to its neighbour.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// By no more than [`JUMP`].
    Small,
    /// By no more than `FORCED` times what the priorities themselves force.
    Forced,
    /// From one optimum to another that is apart from it, as any choice of the best must:
    /// [`change::parted`].
    Parted,
    /// In no such way; said in words.
    Jump(String),
}

impl Motion {
    /// From `request` to `near`.
    ///
    /// # Errors
    /// The oracle's solver gave up.
    pub fn between(frame: &Frame, request: &Request, near: &Request) -> Result<Motion, Error> {
        let requests = [request, near];
        let [answer, moved] = requests.map(|request| request.mix(frame).expect("finite"));
        let change = answer.change(&moved);
        if change <= JUMP {
            return Ok(Motion::Small);
        }
        let forced = change::forced(frame, requests, &answer)?;
        if forced.is_some_and(|forced| f64::from(change) <= FORCED * forced) {
            return Ok(Motion::Forced);
        }
        if change::parted(frame, requests, [&answer, &moved])? {
            return Ok(Motion::Parted);
        }
        Ok(Motion::Jump(format!(
            "{change}, {forced:?} of it forced: {request:?} -> {answer:?}, then {near:?} -> {moved:?}"
        )))
    }
}
