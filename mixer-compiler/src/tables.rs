//! The emitted tables, as values. All numbers become f32 here but those of the closed form:
//! `allocation` rounds as it goes, since facets follow from thrusts that are rounded inwards, and
//! the range of level thrust is found by `mixer-rt`'s look-up in the rounded table.
//!
//! [`MixerTables`] holds the numbers of one airframe whatever its basis, evaluator and size; the
//! generated Rust holds the same numbers in `mixer-rt`'s static types. [`MixerTables::mix`] runs
//! `mixer-rt` itself on them.

mod alone;
mod part;
mod quantity;
mod rows;

use mixer_rt::{
    Conditions, Health, RotorState, Saturation, SetpointError, Wrench,
    tables::{
        Border, Cell, ClosedForm, ClosedFormUnit, Facets, Inverse, Lag, NO_CHANNEL, Pair, PairKind,
        Priorities, RotorAlone, Steep, Tables, ThrottleRange, Tolerance, Unit, UnitState, Unlike,
    },
};

use crate::airframe::{self, Airframe};
use crate::inverse::table::InverseTable;
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::model::law::{CorrectionTables, LawTable};
use crate::view::View;

use alone::{curve_table, rotors_alone};
pub(crate) use part::{Part, identifier};
pub use quantity::QuantityTable;
use rows::rows;

/// The tables of one airframe.
#[derive(Clone, Debug, PartialEq)]
pub struct MixerTables {
    /// Shares of M and M+.
    pub units: Vec<Unit>,
    /// What each pair gives, in the order of the file.
    pub pairs: Vec<PairKind<QuantityTable, InverseTable>>,
    /// Thrust and torque of each kind of single rotor.
    pub single_rotors: Vec<RotorAlone>,
    /// The allowed throttles.
    pub throttle: ThrottleRange,
    /// The corrections of voltage and density.
    pub corrections: CorrectionTables,
    /// Rows per N m and N: [`mixer_rt::tables::Tables::row_scale`].
    pub row_scale: [f32; 4],
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
    /// Largest errors of the mixer.
    pub tolerance: Tolerance,
    /// How the rotors of each kind of unit follow; empty where the airframe has no `mix_dynamic`.
    pub lags: Vec<Lag>,
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
    /// Rounds the pair's map beside an inverse of it.
    pub(crate) fn new(view: &View<'_, &airframe::Pair>, inverse: InverseTable) -> Self {
        let airframe::Pair {
            basis,
            thrust_n,
            torque_nm,
            ..
        } = view.of;
        let [thrust, torque] = [thrust_n, torque_nm].map(|terms| QuantityTable::new(*basis, terms));
        UnitMap {
            pair: Pair { thrust, torque },
            inverse,
            throttle: throttle_table(view),
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
    /// The corrections of voltage and density.
    pub(crate) corrections: &'a CorrectionTables,
    /// The map of each pair and its inverse.
    pub(crate) maps: Vec<&'a UnitMap>,
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

/// Channels of the largest frame.
const MOST_CHANNELS: usize = 64;

/// The rotors of any frame under way.
pub type AnyState = RotorState<MOST_CHANNELS>;

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
        let pairs = airframe.pairs.iter().zip(&parts.maps);
        let kind = |(pair, unit): (&airframe::Pair, &&UnitMap)| {
            let map = PairMap::new(pair, &airframe.throttle);
            PairKind {
                pair: unit.pair,
                alone: rotors_alone(pair, &map),
                inverse: unit.inverse.clone(),
                mean_square_slopes: map.mean_square_slopes().map(|mean| mean as f32),
            }
        };
        MixerTables {
            is_vertical: effectiveness.is_vertical(),
            units: unit_tables(airframe, effectiveness),
            pairs: pairs.map(kind).collect(),
            throttle: throttle_table(airframe),
            corrections: parts.corrections.clone(),
            row_scale: rows(airframe, effectiveness),
            level_n: [0.0; 2],
            priorities: Priorities {
                airmode: allocation.airmode,
                yaw_reserve_nm: allocation.yaw_reserve_nm as f32,
            },
            power_bias_nm_per_n: allocation.power_bias_nm_per_n as f32,
            closed_form,
            single_rotors: {
                let rotors = airframe.single_rotors.iter();
                rotors.map(|rotor| curve_table(&rotor.alone)).collect()
            },
            tolerance: parts.tolerance,
            lags: Vec::new(),
        }
    }

    /// The map of a unit alone.
    #[cfg(test)]
    pub(crate) fn map(&self) -> UnitMap {
        UnitMap {
            pair: self.pairs[0].pair,
            inverse: self.pairs[0].inverse.clone(),
            throttle: self.throttle,
        }
    }

    /// The tables as `mixer-rt` reads them.
    pub fn view(&self) -> Tables<'_, Unlike<'_, QuantityTable, InverseTable, true>, Option<ClosedForm<'_>>> {
        Tables {
            units: &self.units,
            kinds: Unlike {
                pairs: &self.pairs,
                single_rotors: &self.single_rotors,
            },
            throttle: self.throttle,
            voltage: self.corrections.voltage.as_ref().map(LawTable::view),
            air: self.corrections.air.as_ref().map(LawTable::view),
            row_scale: self.row_scale,
            level_n: self.level_n,
            is_vertical: self.is_vertical,
            priorities: self.priorities,
            power_bias_nm_per_n: self.power_bias_nm_per_n,
            closed_form: self.closed_form.as_ref().map(ClosedFormTable::view),
            tolerance: self.tolerance,
        }
    }

    /// The pair that all units are; `None` where they differ.
    pub(crate) fn pair_of_all(&self) -> Option<&PairKind<QuantityTable, InverseTable>> {
        match self.pairs.as_slice() {
            [pair] if self.single_rotors.is_empty() => Some(pair),
            _ => None,
        }
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

    /// Throttles `[u, l]` of a pair, by index, for its `efforts` (N, N m at the reference voltage), by the emitted inverse;
    /// `None` where there is no such pair.
    pub fn throttles(&self, pair: usize, efforts: [f32; 2]) -> Option<[f32; 2]> {
        let PairKind { pair, inverse, .. } = self.pairs.get(pair)?;
        Some(inverse.throttles(pair, &self.throttle, efforts))
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
            &mut mixer_rt::tables::by_channel(&mut throttle),
        )?;
        Ok((throttle, achieved, saturation))
    }

    /// [`mixer_rt::tables::mix_dynamic`], operation by operation as the generated mixer does.
    ///
    /// # Errors
    /// As [`mixer_rt::tables::mix`].
    pub fn mix_dynamic(
        &self,
        state: &mut AnyState,
        setpoint: &Wrench,
        conditions: impl Into<Conditions>,
        health: Health,
        held_s: f32,
    ) -> Result<AnyMix, SetpointError> {
        let (tables, conditions) = (self.view(), conditions.into());
        let mix = mixer_rt::tables::mix_dynamic::<{ MOST_CHANNELS / 2 }, MOST_CHANNELS, true, _, _>(
            &tables, &self.lags, state, setpoint, conditions, health, held_s,
        )?;
        let throttle = mix.throttle.into_iter().take(self.channels());
        Ok((throttle.collect(), mix.achieved, mix.saturation))
    }

    /// Throttles `[u, l]` of the units for the efforts of least norm at `[k_f, k_Q]`; `None` where some
    /// unit cannot give them.
    pub(crate) fn least_norm(&self, wrench: [f32; 4], factors: [f64; 2]) -> Option<Vec<[f32; 2]>> {
        let mut states = vec![UnitState::default(); self.units.len()];
        let factors = factors.map(|k| k as f32);
        mixer_rt::tables::least_norm(&self.view(), &wrench, factors, &mut states)
            .then(|| states.iter().map(UnitState::throttles).collect())
    }

    /// Bytes of the tables in flash.
    pub fn bytes(&self) -> usize {
        let view = self.view();
        let kinds: &dyn Part = match self.pair_of_all() {
            Some(pair) => pair,
            None => &view.kinds,
        };
        let parts: [&dyn Part; 11] = [
            &view.units,
            kinds,
            &view.throttle,
            &view.voltage,
            &view.air,
            &view.row_scale,
            &view.level_n,
            &view.priorities,
            &view.power_bias_nm_per_n,
            &view.closed_form,
            &view.tolerance,
        ];
        parts.into_iter().map(Part::bytes).sum()
    }

    /// Bytes of the inverse map's own constants.
    pub fn inverse_bytes(&self) -> usize {
        self.pairs.iter().map(|pair| pair.inverse.bytes()).sum()
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
            kind: unit.kind as u8,
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
