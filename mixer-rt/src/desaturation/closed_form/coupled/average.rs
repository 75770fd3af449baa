//! The last step of a climb, so that neighbouring requests whose programs end with other tangents
//! end near each other.
//!
//! Where Y is smooth the corner of the last tangents may be far from the best point although Y is
//! within CLOSE of them: for a quadratic Y, the tangents at two points meet in the middle between
//! these, wherever the best point is. The average of the tangents' points, each weighted by what
//! its row is worth, is then the best point: there the slopes are those that the program asks for.
//! Where Y has an edge the corner is the best point. So the step goes from the corner towards the
//! average as far as Y rises, and gains no more than there is between Y and the tangents.

use super::super::TorqueLimit;
use super::super::program::Corner;
use super::{Climb, Program, Tangent};

/// What the tangents are worth together where yaw is not capped, but for rounding: the cap takes
/// the rest of one.
const UNCAPPED: f32 = 0.999;

impl<S: TorqueLimit> Climb<'_, '_, S> {
    /// Moves `best` from the corner, where Y has the tangent `here` and is `gap` below the corner's
    /// tangents, towards the average of their points.
    #[inline(never)]
    pub(super) fn approach_average(
        &mut self,
        corner: &Corner,
        program: &Program,
        here: &Tangent,
        gap: f32,
        best: &mut ([f32; 3], f32),
    ) {
        let Some((average, worth)) = corner.average(program.price) else {
            return;
        };
        let ([lean, thrust, z], yaw) = *best;
        let mut way = [average[0] - lean, average[1] - thrust, average[2] - z];
        // How fast the goal grows but for Y, in yaw.
        let mut goal = 0.0;
        if program.level.is_some() {
            goal = (way[0] - program.price * way[1]) / worth;
        } else if worth < UNCAPPED {
            // The cap says where the thrust is.
            way[1] = 0.0;
        } else {
            goal = -program.price * way[1];
        }
        let rise = |tangent: &Tangent| {
            let [by_lean, by_thrust, by_z] = tangent.slopes;
            ((by_lean * way[0] + by_thrust * way[1]) + by_z * way[2]) + goal
        };
        let at = |step: f32| [lean + step * way[0], thrust + step * way[1], z + step * way[2]];
        let start = rise(here);
        // Also where it is not a number.
        if !(start > 0.0 && gap > 0.0) {
            return;
        }
        // Between limits lies nothing that breaks them.
        self.go(at(1.0));
        let there = self.tangent();
        let turn = start - rise(&there);
        let mut step = if start < turn { start / turn } else { 1.0 };
        let gain = 0.5 * start * step;
        if gain > gap {
            step *= gap / gain;
        }
        *best = (at(step), yaw + step * (there.yaw - yaw));
    }
}
