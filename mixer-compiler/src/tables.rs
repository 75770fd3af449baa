//! The emitted tables, as values. All numbers become f32 here but those of the closed form:
//! `allocation` rounds as it goes, since facets follow from thrusts that are rounded inwards, and
//! the range of level thrust is found by `mixer-rt`'s look-up in the rounded table.
//!
//! [`MixerTables`] holds the numbers of one airframe whatever its basis, evaluator and size; the
//! generated Rust holds the same numbers in `mixer-rt`'s static types. [`MixerTables::mix`] runs
//! `mixer-rt` itself on them.

mod part;
mod quantity;
mod rows;
mod single;

use mixer_rt::{
    Conditions, Health, Saturation, SetpointError, Wrench,
    tables::{
        AllocationMethod, Border, Cell, ClosedForm, ClosedFormUnit, Facets, Inverse, Kind, NO_CHANNEL, Pair,
        Priorities, SingleRotor, Steep, Tables, ThrottleRange, Tolerance, Unit, UnitState, Unlike,
    },
};

use crate::airframe::Airframe;
use crate::inverse::table::InverseTable;
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::model::law::{CorrectionTables, LawTable};

pub(crate) use part::{Part, identifier};
pub use quantity::QuantityTable;
use rows::rows;
use single::{curve_table, single_tables};

/// The tables of one airframe.
#[derive(Clone, Debug, PartialEq)]
pub struct MixerTables {
    /// Shares of M and M+.
    pub units: Vec<Unit>,
    /// The forward map.
    pub pair: Pair<QuantityTable>,
    /// What the upper and the lower rotor of a unit give alone.
    pub singles: [SingleRotor; 2],
    /// The inverse map.
    pub inverse: InverseTable,
    /// The allowed throttles.
    pub throttle: ThrottleRange,
    /// The corrections of voltage and density.
    pub corrections: CorrectionTables,
    /// Rows per N m and N: [`mixer_rt::tables::Tables::row_scale`].
    pub row_scale: [f32; 4],
    /// [`mixer_rt::tables::Tables::mean_square_slopes`].
    pub mean_square_slopes: [f32; 2],
    /// [`mixer_rt::tables::Tables::level_n`].
    pub level_n: [f32; 2],
    /// [`mixer_rt::tables::Tables::is_vertical`].
    pub is_vertical: bool,
    /// Priorities of allocation.
    pub priorities: Priorities,
    /// Least power: [`mixer_rt::tables::Tables::power_bias_nm_per_n`].
    pub power_bias_nm_per_n: f32,
    /// The closed form of allocation, where the layout allows one.
    pub closed_form: Option<ClosedFormTable>,
    /// The forward map, the inverse map and the rotors alone of each pair but the first, in the order of the file.
    pub kinds: Vec<Kind<QuantityTable, InverseTable>>,
    /// Thrust and torque of each kind of single rotor.
    pub single_rotors: Vec<[SingleRotor; 2]>,
    /// Passes of least norm over them.
    pub passes: u8,
    /// Which kind each unit is, where they differ: those of `kinds`, then the single rotors; 255 the first pair.
    pub kind_of: Vec<u8>,
    /// Largest errors of the mixer.
    pub tolerance: Tolerance,
}

/// The ways of allocation that an airframe may have.
#[derive(Clone, Debug, PartialEq)]
pub struct AnyMethod<'a> {
    closed_form: Option<ClosedForm<'a>>,
    unlike: Option<Unlike<'a, QuantityTable, InverseTable>>,
    single_rotors: &'a [[SingleRotor; 2]],
    passes: u8,
}

impl AllocationMethod<QuantityTable> for AnyMethod<'_> {
    type Inverse = InverseTable;

    const MAY_HAVE_SINGLE_ROTORS: bool = true;

    fn closed_form(&self) -> Option<&ClosedForm<'_>> {
        self.closed_form.as_ref()
    }

    fn unlike(&self) -> Option<&Unlike<'_, QuantityTable, InverseTable>> {
        self.unlike.as_ref()
    }

    fn single_rotors(&self) -> &[[SingleRotor; 2]] {
        self.single_rotors
    }

    fn passes(&self) -> u8 {
        self.passes
    }
}

/// What is fitted and proven: the map of a unit, its inverse, and the throttles that it may give.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct UnitMap {
    /// The forward map.
    pub(crate) pair: Pair<QuantityTable>,
    /// The inverse map.
    pub(crate) inverse: InverseTable,
    /// The allowed throttles.
    pub(crate) throttle: ThrottleRange,
}

impl UnitMap {
    /// Rounds the airframe's map beside an inverse of it.
    pub(crate) fn new(airframe: &Airframe, inverse: InverseTable) -> Self {
        UnitMap {
            pair: pair_table(airframe),
            inverse,
            throttle: throttle_table(airframe),
        }
    }

    /// Throttles `[u, l]` that give `efforts` (N, N m at the reference voltage), by `mixer-rt`.
    pub(crate) fn throttles(&self, efforts: [f32; 2]) -> [f32; 2] {
        self.inverse.throttles(&self.pair, &self.throttle, efforts)
    }
}

/// Sources of the tables, but for the closed form.
pub(crate) struct Parts<'a> {
    /// The airframe.
    pub(crate) airframe: &'a Airframe,
    /// M and M+.
    pub(crate) effectiveness: &'a Effectiveness,
    /// The airframe of each pair.
    pub(crate) airframes: &'a [Airframe],
    /// The corrections of voltage and density.
    pub(crate) corrections: &'a CorrectionTables,
    /// The map of each pair and its inverse.
    pub(crate) maps: Vec<&'a UnitMap>,
    /// Passes of least norm over single rotors.
    pub(crate) passes: u8,
    /// What the mixer may miss.
    pub(crate) tolerance: Tolerance,
}

/// The closed form for vertical axes, with the lists that it refers to.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedFormTable {
    /// All but the lists, which are empty here: [`ClosedFormTable::view`] has them.
    pub(crate) numbers: ClosedForm<'static>,
    /// Shares of C and C+.
    pub units: Vec<ClosedFormUnit>,
    /// Cells of the border of a unit's attainable torques.
    pub cells: Vec<Cell>,
    /// Facets of the attainable (roll, pitch, thrust) whose normals have the thrust component 1.
    pub slopes: Vec<Facets>,
    /// Facets whose normals have no thrust component.
    pub walls: Vec<Facets>,
    /// Slopes that are walls at the thrust asked.
    pub steep: Vec<Steep>,
}

impl ClosedFormTable {
    /// The table as `mixer-rt` reads it.
    pub fn view(&self) -> ClosedForm<'_> {
        let border = Border {
            cells: &self.cells,
            ..self.numbers.border
        };
        ClosedForm {
            units: &self.units,
            border,
            slopes: &self.slopes,
            walls: &self.walls,
            steep: &self.steep,
            ..self.numbers
        }
    }
}

/// What [`MixerTables::mix`] gives: throttle per channel, achieved wrench, saturation.
pub type AnyMix = (Vec<f32>, Wrench, Saturation);

impl MixerTables {
    /// The tables of an airframe, with a closed form where it has one. The range of level thrust is
    /// found by them and still missing.
    pub(crate) fn new(parts: &Parts<'_>, closed_form: Option<ClosedFormTable>) -> Self {
        let &Parts {
            airframe,
            effectiveness,
            ..
        } = parts;
        let allocation = &airframe.allocation;
        let (airframes, maps) = (parts.airframes.iter(), parts.maps.iter());
        let mut kinds: Vec<_> = airframes
            .zip(maps)
            .map(|(airframe, map)| kind(airframe, map))
            .collect();
        let first = kinds.remove(0);
        MixerTables {
            is_vertical: effectiveness.is_vertical(),
            units: unit_tables(airframe, effectiveness),
            pair: first.pair,
            singles: first.singles,
            inverse: first.inverse,
            throttle: throttle_table(airframe),
            corrections: parts.corrections.clone(),
            row_scale: rows(airframe, effectiveness),
            mean_square_slopes: first.mean_square_slopes,
            level_n: [0.0; 2],
            priorities: Priorities {
                airmode: allocation.airmode,
                yaw_reserve_nm: allocation.yaw_reserve_nm as f32,
            },
            power_bias_nm_per_n: allocation.power_bias_nm_per_n as f32,
            closed_form,
            kind_of: match airframe.is_unlike() {
                true => {
                    let units = airframe.units.iter();
                    units.map(|unit| (unit.pair as u8).wrapping_sub(1)).collect()
                }
                false => Vec::new(),
            },
            kinds,
            single_rotors: {
                let curves = airframe
                    .single_rotors
                    .iter()
                    .filter_map(|rotor| rotor.lower_out.as_ref());
                curves.map(|curve| [curve_table(curve); 2]).collect()
            },
            passes: parts.passes,
            tolerance: parts.tolerance,
        }
    }

    /// The map of a unit alone.
    #[cfg(test)]
    pub(crate) fn map(&self) -> UnitMap {
        UnitMap {
            pair: self.pair,
            inverse: self.inverse.clone(),
            throttle: self.throttle,
        }
    }

    /// The tables as `mixer-rt` reads them.
    pub fn view(&self) -> Tables<'_, QuantityTable, &InverseTable, AnyMethod<'_>> {
        Tables {
            units: &self.units,
            pair: self.pair,
            singles: self.singles,
            inverse: &self.inverse,
            throttle: self.throttle,
            voltage: self.corrections.voltage.as_ref().map(LawTable::view),
            air: self.corrections.air.as_ref().map(LawTable::view),
            row_scale: self.row_scale,
            mean_square_slopes: self.mean_square_slopes,
            level_n: self.level_n,
            is_vertical: self.is_vertical,
            priorities: self.priorities,
            power_bias_nm_per_n: self.power_bias_nm_per_n,
            closed_form: AnyMethod {
                closed_form: self.closed_form.as_ref().map(ClosedFormTable::view),
                unlike: self.unlike(),
                single_rotors: &self.single_rotors,
                passes: self.passes,
            },
            tolerance: self.tolerance,
        }
    }

    /// The kinds of units as `mixer-rt` reads them.
    pub(crate) fn unlike(&self) -> Option<Unlike<'_, QuantityTable, InverseTable>> {
        let (kinds, of) = (self.kinds.as_slice(), self.kind_of.as_slice());
        (!of.is_empty()).then_some(Unlike { kinds, of })
    }

    /// The same tables where all units have this one of the pairs.
    pub(crate) fn of_pair(&self, pair: usize) -> Self {
        let mut alike = MixerTables {
            kinds: Vec::new(),
            single_rotors: Vec::new(),
            kind_of: Vec::new(),
            ..self.clone()
        };
        if let Some(kind) = pair.checked_sub(1).and_then(|other| self.kinds.get(other)) {
            alike.pair = kind.pair;
            alike.singles = kind.singles;
            alike.inverse = kind.inverse.clone();
            alike.mean_square_slopes = kind.mean_square_slopes;
        }
        alike
    }

    /// Number of output channels.
    pub fn channels(&self) -> usize {
        let channels = self.units.iter().flat_map(|unit| unit.channels);
        channels.filter(|channel| *channel != NO_CHANNEL).count()
    }

    /// Efforts `[f, Q]` of a unit, by index, at throttles `[u, l]`, N and N m at the reference voltage.
    pub(crate) fn efforts_of(&self, unit: usize, throttles: [f32; 2]) -> [f32; 2] {
        self.view().efforts_of(unit, throttles)
    }

    /// The same tables with another power bias, to compare with.
    #[must_use]
    pub fn with_power_bias(&self, power_bias_nm_per_n: f32) -> Self {
        MixerTables {
            power_bias_nm_per_n,
            ..self.clone()
        }
    }

    /// Throttles `[u, l]` of a unit of the first pair for its `efforts` (N, N m at the reference voltage), by the emitted
    /// inverse.
    pub fn throttles(&self, efforts: [f32; 2]) -> [f32; 2] {
        self.inverse.throttles(&self.pair, &self.throttle, efforts)
    }

    /// Mixes with `mixer-rt`, operation by operation as the generated mixer does.
    ///
    /// # Errors
    /// As [`mixer_rt::tables::mix`].
    pub fn mix(&self, setpoint: &Wrench, conditions: impl Into<Conditions>) -> Result<AnyMix, SetpointError> {
        self.mix_with_health(setpoint, conditions, Health::GOOD)
    }

    /// [`MixerTables::mix`] with some rotors out.
    ///
    /// # Errors
    /// As [`mixer_rt::tables::mix`].
    pub fn mix_with_health(
        &self,
        setpoint: &Wrench,
        conditions: impl Into<Conditions>,
        health: Health,
    ) -> Result<AnyMix, SetpointError> {
        let states = || vec![UnitState::default(); self.units.len()];
        let mut throttle = vec![self.throttle.min; self.channels()];
        let (achieved, saturation) = mixer_rt::tables::mix_into(
            &self.view(),
            setpoint,
            conditions.into(),
            health,
            states,
            &mut throttle,
        )?;
        Ok((throttle, achieved, saturation))
    }

    /// Throttles `[u, l]` of the units for the efforts of least norm at `[k_f, k_Q]`; `None` where some
    /// unit cannot give them.
    pub(crate) fn least_norm(&self, wrench: [f32; 4], factors: [f64; 2]) -> Option<Vec<[f32; 2]>> {
        let view = self.view();
        let effort = |unit: &Unit, asked: [f32; 4], k: usize| -> f32 {
            let parts = unit.allocation[k].iter().zip(asked);
            parts.map(|(share, asked)| share * asked).sum::<f32>() / factors[k] as f32
        };
        // The wrench less what the torques of single rotors differ from their share in M+ by.
        let mut asked = wrench;
        for _ in 0..self.passes {
            let mut next = wrench;
            for (index, unit) in self.units.iter().enumerate() {
                let Some(curve) = view.curve_of(index) else {
                    continue;
                };
                let [f, q] = [0, 1].map(|k| effort(unit, asked, k));
                let [_, given] = curve.efforts(curve.throttle(&self.throttle, f));
                for (next, effect) in next.iter_mut().zip(unit.effectiveness[1]) {
                    *next -= effect * factors[1] as f32 * (given - q);
                }
            }
            asked = next;
        }
        let one = |(index, unit): (usize, &Unit)| {
            let wanted = [0, 1].map(|k| effort(unit, asked, k));
            let throttles = view.throttles_of(index, wanted);
            let given = view.efforts_of(index, throttles);
            let gives = |k: usize| (given[k] - wanted[k]).abs() <= self.tolerance.efforts[k];
            // The torque of a single rotor was fed back.
            (gives(0) && (gives(1) || view.curve_of(index).is_some())).then_some(throttles)
        };
        self.units.iter().enumerate().map(one).collect()
    }

    /// Bytes of the tables in flash.
    pub fn bytes(&self) -> usize {
        let view = self.view();
        let passes = (!self.single_rotors.is_empty()).then_some(self.passes);
        let parts: [&dyn Part; 17] = [
            &view.units,
            &view.pair,
            &view.singles,
            &view.inverse,
            &view.throttle,
            &view.voltage,
            &view.air,
            &view.row_scale,
            &view.mean_square_slopes,
            &view.level_n,
            &view.priorities,
            &view.power_bias_nm_per_n,
            &view.closed_form.closed_form,
            &view.closed_form.unlike,
            &view.closed_form.single_rotors,
            &passes,
            &view.tolerance,
        ];
        parts.into_iter().map(Part::bytes).sum()
    }

    /// Bytes of the inverse map's own constants.
    pub fn inverse_bytes(&self) -> usize {
        let others = self.kinds.iter().map(|kind| kind.inverse.bytes());
        self.inverse.bytes() + others.sum::<usize>()
    }
}

/// Rounds the forward map.
fn pair_table(airframe: &Airframe) -> Pair<QuantityTable> {
    let pair = &airframe.pair;
    Pair {
        thrust: QuantityTable::new(pair.basis, &pair.thrust_n),
        torque: QuantityTable::new(pair.basis, &pair.torque_nm),
    }
}

/// What a unit of an airframe of one pair gives.
fn kind(airframe: &Airframe, map: &UnitMap) -> Kind<QuantityTable, InverseTable> {
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    Kind {
        pair: map.pair,
        singles: single_tables(airframe),
        inverse: map.inverse.clone(),
        mean_square_slopes: pair.mean_square_slopes().map(|mean| mean as f32),
    }
}

/// Rounds the allowed throttles, never outwards: an idle that f32 cannot represent becomes the next
/// larger one.
pub fn throttle_table(airframe: &Airframe) -> ThrottleRange {
    let (min, max) = (airframe.throttle.min as f32, airframe.throttle.max as f32);
    ThrottleRange {
        min: if f64::from(min) < airframe.throttle.min {
            min.next_up()
        } else {
            min
        },
        max: if f64::from(max) > airframe.throttle.max {
            max.next_down()
        } else {
            max
        },
    }
}

/// Rounds M and M+, unit by unit.
fn unit_tables(airframe: &Airframe, effectiveness: &Effectiveness) -> Vec<Unit> {
    let n = airframe.units.len();
    let row = |index: usize| -> [f32; 4] {
        std::array::from_fn(|axis| effectiveness.pseudo_inverse[(index, axis)] as f32)
    };
    let column =
        |index: usize| -> [f32; 4] { std::array::from_fn(|axis| effectiveness.matrix[(axis, index)] as f32) };
    let units = airframe.units.iter().enumerate();
    units
        .map(|(i, unit)| Unit {
            allocation: [row(i), row(n + i)],
            effectiveness: [column(i), column(n + i)],
            channels: unit.channel_table(),
        })
        .collect()
}

/// Rounds tolerances, those of the efforts upwards.
pub(crate) fn tolerance_table(efforts: [f64; 2], wrench: [f64; 4]) -> Tolerance {
    Tolerance {
        efforts: efforts.map(|effort| (effort as f32).next_up()),
        wrench: wrench.map(|x| x as f32),
    }
}
