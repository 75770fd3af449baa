//! What is done where the budget of pivots has ended first: the answer is drawn towards level flight, which keeps all bounds.

use super::shortage;
use super::simplex::{Budget, Simplex, Slot};
use super::unit::{Place, Scratch, positive};
use crate::tables::Level;
use crate::{clamp, rolled};

/// Pivots and flips at most for the programme of level flight.
const BUDGET: Budget = Budget { pivots: 8, flips: 32 };

/// Rows that artificial slots may miss.
const MISSED: f32 = 1e-3;

impl Simplex<'_> {
    /// Draws the units' scaled efforts towards level flight at a thrust in rows, as little as puts all units into their polygons
    /// and all shortages between nothing and all that was asked for.
    #[cold]
    #[inline(never)]
    pub(super) fn retreat(&mut self, level: Option<&Level<'_>>, thrust: f32, scale: [f32; 2]) {
        let mut share = self.beyond_shortages();
        match level {
            Some(level) => level.write(thrust, scale, self.units),
            None => self.solve_level(thrust),
        }
        for unit in self.units.iter() {
            rolled();
            let set = self.sets[unit.rotors as usize & 3];
            for corner in set {
                rolled();
                let out = corner.beyond(unit.efforts);
                if set.len() > 2 && out > 0.0 {
                    let room = positive(-corner.beyond(unit.level));
                    share = larger(share, out / (out + room));
                }
            }
            if let [low, high] = set
                && !(low.at[0]..=high.at[0]).contains(&unit.efforts[0])
            {
                share = 1.0;
            }
        }
        for unit in self.units.iter_mut() {
            rolled();
            unit.efforts = [0, 1].map(|k| unit.efforts[k] + share * (unit.level[k] - unit.efforts[k]));
        }
    }

    /// The share of the way to level flight at which no shortage is negative: there they are 1.
    fn beyond_shortages(&self) -> f32 {
        let mut share = 0.0;
        for (slot, value) in self.slots.iter().zip(self.values) {
            rolled();
            share = match slot {
                Slot::Column(_) if value < 0.0 => larger(share, -value / (1.0 - value)),
                Slot::Column(_) if value > 1.0 => 1.0,
                Slot::Artificial if value.abs() > MISSED => 1.0,
                _ => share,
            };
        }
        share
    }

    /// Gives units their level efforts by the programme for thrust alone, in rows. Where not even that is solved, as with too few
    /// rotors, they are what its budget leads to.
    fn solve_level(&mut self, thrust: f32) {
        for unit in self.units.iter_mut() {
            rolled();
            (unit.place, unit.bend) = (Place::Corner, 0.0);
            unit.level = unit.efforts;
        }
        self.budget = BUDGET;
        self.start(&[0.0, 0.0, 0.0, thrust], [0.0; 4]);
        self.add_columns(shortage::LEVEL);
        self.solve();
        self.place_units();
        for unit in self.units.iter_mut() {
            rolled();
            (unit.efforts, unit.level) = (unit.level, unit.efforts);
        }
    }
}

impl Level<'_> {
    /// Gives units their scaled level efforts at a thrust in rows, as far as it is between the least and the middle. With tilted
    /// axes they are level at the reference voltage; at others k_f and k_Q hardly differ.
    fn write(&self, thrust: f32, scale: [f32; 2], units: &mut [Scratch]) {
        let [least, middle] = self.thrust;
        let share = clamp((thrust - least) / (middle - least), 0.0, 1.0);
        for (unit, [least, middle]) in units.iter_mut().zip(self.efforts) {
            rolled();
            unit.level = [0, 1].map(|k| (least[k] + share * (middle[k] - least[k])) / scale[k]);
        }
    }
}

fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
