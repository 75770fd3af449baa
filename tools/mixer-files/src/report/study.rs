//! An airframe under study: what all figures are drawn from.

use mixer_compiler::airframe::{Axis, Pair};
use mixer_compiler::model::PairMap;
use mixer_compiler::{Compiled, OfPair};
use mixer_rt::{Health, Wrench};

use crate::report::number::round_half_digit;

/// A compiled airframe with what its figures share.
#[derive(Clone, Debug)]
pub struct Study<'a> {
    /// The airframe.
    pub compiled: &'a Compiled,
    /// The kind of unit that is drawn: where it stands among the airframe's pairs, or past these among its single rotors.
    pub index: usize,
    /// Its forward map in f64.
    pub pair: PairMap,
    /// Total thrust of the comparisons at constant thrust, N.
    pub thrust_n: f64,
    /// A flight of the vehicle, to be shown beside the model.
    pub flown: Option<Flown>,
}

/// A flight held against the model.
#[derive(Clone, Debug)]
pub struct Flown {
    /// The log's name.
    pub log: String,
    /// What it says: names and texts.
    pub lines: Vec<(&'static str, String)>,
    /// Throttles `[u, l]` of pairs in the air.
    pub throttles: Vec<[f64; 2]>,
}

/// The map of a kind of unit.
fn map_of(compiled: &Compiled, kind: usize) -> PairMap {
    let mut units = compiled.airframe.units.iter();
    let unit = units.position(|unit| unit.kind == kind);
    compiled.maps[unit.unwrap_or_default()].clone()
}

/// What a mixer meets in flight.
#[derive(Clone, Copy, Debug)]
pub struct Condition {
    /// Of the battery, V; any where the airframe ignores it.
    pub voltage_v: f32,
    /// Which rotors are out.
    pub health: Health,
}

/// Share of the largest bare thrust that stands for the weight of a vehicle.
const HOVER_SHARE: f64 = 0.4;

impl<'a> Study<'a> {
    /// A study at `thrust_n` N in all; without it at the weight, or where that is not known or not
    /// carried at about 40 % of the ceiling, a round number.
    pub fn new(compiled: &'a Compiled, thrust_n: Option<f64>) -> Self {
        let mut study = Study {
            compiled,
            index: 0,
            pair: map_of(compiled, 0),
            thrust_n: round_half_digit(HOVER_SHARE * f64::from(compiled.thrust_range_n[1])),
            flown: None,
        };
        if let Some(thrust_n) = thrust_n.or_else(|| study.hover_n()) {
            study.thrust_n = thrust_n;
        }
        study
    }

    /// The same study with the maps of the pair of this name; the first one without.
    ///
    /// # Errors
    /// A name that no pair has.
    pub fn of(mut self, name: Option<&str>) -> Result<Self, String> {
        let Some(name) = name else { return Ok(self) };
        let pairs = &self.compiled.airframe.pairs;
        let names: Vec<&str> = pairs.iter().map(|pair| pair.name.as_str()).collect();
        let found = names.iter().position(|known| *known == name);
        let index = found.ok_or_else(|| match names.as_slice() {
            [] => format!("--pair {name}: no unit of the airframe is a pair; leave --pair out"),
            [_] => format!("--pair {name}: the airframe has one pair; leave --pair out"),
            names => format!("--pair {name}: the airframe's pairs are {}", names.join(", ")),
        })?;
        self.index = index;
        self.pair = map_of(self.compiled, index);
        Ok(self)
    }

    /// The same study of each kind of unit; the flight is that of one.
    pub fn of_each(&self) -> Vec<Study<'a>> {
        let of = |index: usize| Study {
            index,
            pair: map_of(self.compiled, index),
            flown: self.flown.clone().filter(|_| index == self.index),
            ..*self
        };
        (0..self.compiled.airframe.views().count()).map(of).collect()
    }

    /// Name of the kind; empty where a file of one pair has none.
    pub fn name(&self) -> &'a str {
        let view = self.compiled.airframe.views().nth(self.index);
        view.map_or("", |view| view.of.name().1)
    }

    /// The weight, N; `None` where the file has no mass, or the weight is not carried at the
    /// reference voltage.
    pub fn hover_n(&self) -> Option<f64> {
        let weight_n = self.compiled.airframe.weight_n()?;
        let (_, delivered) = self.mix([0.0, 0.0, 0.0, weight_n], &self.reference());
        delivered.then_some(weight_n)
    }

    /// Throttles `[u, l]` of the pair in hover at the reference voltage, those of units that differ; empty
    /// where there is no hover.
    pub fn hover_throttles(&self) -> Vec<[f64; 2]> {
        let Some(weight_n) = self.hover_n() else {
            return Vec::new();
        };
        let (throttles, _) = self.mix([0.0, 0.0, 0.0, weight_n], &self.reference());
        let mut distinct: Vec<[f64; 2]> = Vec::new();
        let units = self.compiled.airframe.units.iter().zip(self.by_unit(&throttles));
        for (_, pair) in units.filter(|(unit, _)| unit.kind == self.index) {
            let same = |other: &[f64; 2]| (0..2).all(|k| (other[k] - pair[k]).abs() < 1e-3);
            if !distinct.iter().any(same) {
                distinct.push(pair);
            }
        }
        distinct
    }

    /// The words ` at 14.8 V` with the reference voltage; none where voltage has no effect.
    pub fn at_reference(&self) -> String {
        let voltage = self.compiled.airframe.voltage.as_ref();
        voltage.map_or_else(String::new, |voltage| format!(" at {} V", voltage.reference))
    }

    /// What units give at throttles `[u, l]` each, N and N m at the reference voltage.
    pub fn efforts_of(&self, throttles: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let units = self.compiled.maps.iter().zip(throttles);
        units.map(|(map, at)| map.efforts(*at)).collect()
    }

    /// Throttles `[u, l]` from `[s, t]` in the unit square.
    pub fn throttles(&self, [s, t]: [f64; 2]) -> [f64; 2] {
        let [low, high] = self.pair.range();
        [s, t].map(|share| low + (high - low) * share)
    }

    /// Efforts `[f (N), Q (N m)]` from `[s, t]` in the unit square.
    pub fn efforts(&self, square: [f64; 2]) -> [f64; 2] {
        self.pair.efforts(self.throttles(square))
    }

    /// Throttles `[u, l]` that the emitted inverse gives for attainable `[f (N), Q (N m)]`; `None`
    /// where they are not.
    pub fn inverse(&self, efforts: [f64; 2]) -> Option<[f64; 2]> {
        let asked = efforts.map(|effort| effort as f32);
        let found = self.compiled.tables.throttles(self.index, asked)?.map(f64::from);
        self.pair.inverse(found, efforts).and(Some(found))
    }

    /// What the emitted inverse, run in f32 by `mixer-rt`, misses of the efforts at `throttles`,
    /// signed, N and N m; nothing where no unit is a pair.
    pub fn error(&self, throttles: [f64; 2]) -> [f64; 2] {
        let efforts = self.pair.efforts(throttles);
        let asked = efforts.map(|effort| effort as f32);
        let Some(found) = self.compiled.tables.throttles(self.index, asked) else {
            return [0.0; 2];
        };
        let given = self.pair.efforts(found.map(f64::from));
        [given[0] - efforts[0], given[1] - efforts[1]]
    }

    /// The pair whose maps are drawn, and what is known of it; `None` where no unit is one.
    pub fn of_pair(&self) -> Option<(&'a Pair, &'a OfPair)> {
        let pair = self.compiled.airframe.pairs.get(self.index)?;
        Some((pair, self.compiled.of_pairs.get(self.index)?))
    }

    /// The border of the attainable set at the reference voltage: throttles, closed.
    pub fn border(&self) -> Vec<[f64; 2]> {
        let mut border = self.pair.border(48);
        border.extend(border.first().copied());
        border
    }

    /// The same as efforts `[f (N), Q (N m)]`.
    pub fn border_efforts(&self) -> Vec<[f64; 2]> {
        let border = self.border().into_iter();
        border.map(|throttles| self.pair.efforts(throttles)).collect()
    }

    /// Efforts `[f (N), Q (N m)]` of the units in hover at the reference voltage, as
    /// [`Study::hover_throttles`].
    pub fn hover_efforts(&self) -> Vec<[f64; 2]> {
        let throttles = self.hover_throttles().into_iter();
        throttles.map(|throttles| self.pair.efforts(throttles)).collect()
    }

    /// The voltages to show with k_f and k_Q: lowest, reference, highest; `None` where voltage has
    /// no effect.
    pub fn voltages(&self) -> Vec<(Option<f64>, [f64; 2])> {
        let Some(voltage) = &self.compiled.airframe.voltage else {
            return vec![(None, [1.0, 1.0])];
        };
        let mut volts = vec![voltage.range[0], voltage.reference, voltage.range[1]];
        volts.dedup();
        volts.into_iter().map(|v| (Some(v), voltage.factors(v))).collect()
    }

    /// All rotors at the reference voltage.
    pub fn reference(&self) -> Condition {
        self.at(Some(self.compiled.airframe.reference_v()))
    }

    /// All rotors at a voltage, V; any where voltage has no effect.
    pub fn at(&self, voltage_v: Option<f64>) -> Condition {
        Condition {
            voltage_v: voltage_v.unwrap_or(0.0) as f32,
            health: Health::GOOD,
        }
    }

    /// `count` thrusts from the floor to the ceiling of the reference voltage, N.
    pub fn thrusts(&self, count: usize) -> impl Iterator<Item = f64> {
        let [low, high] = self.compiled.thrust_range_n.map(f64::from);
        (0..count).map(move |k| low + (high - low) * k as f64 / (count - 1) as f64)
    }

    /// The served axes of roll, pitch and yaw.
    pub fn torque_axes(&self) -> Vec<Axis> {
        let mut axes = vec![Axis::Roll, Axis::Pitch, Axis::Yaw];
        axes.retain(|&axis| self.serves(axis));
        axes
    }

    /// Whether the airframe serves an axis.
    pub fn serves(&self, axis: Axis) -> bool {
        self.compiled.airframe.allocation.controls(axis)
    }

    /// The compiled mixer's throttles by output for `[roll, pitch, yaw (N m), thrust
    /// (N)]`, and whether all of it is delivered.
    pub fn mix(&self, wrench: [f64; 4], condition: &Condition) -> (Vec<f32>, bool) {
        let tables = &self.compiled.tables;
        let setpoint = Wrench::from_array(wrench.map(|x| x as f32));
        match tables.mix_with_health(&setpoint, condition.voltage_v, condition.health) {
            Ok((throttle, _, saturation)) => (throttle, !saturation.any_axis()),
            // No figure asks for what is not finite.
            Err(_) => (vec![f32::NAN; self.compiled.airframe.rotors()], false),
        }
    }

    /// Throttles `[u, l]` of every unit from those of the channels; 0 of the lower rotor that a single one does not have.
    pub fn by_unit(&self, channels: &[f32]) -> Vec<[f64; 2]> {
        let units = self.compiled.airframe.units.iter();
        units.map(|unit| unit.throttles(channels)).collect()
    }

    /// The wrench `[roll, pitch, yaw (N m), thrust (N)]` of all units' efforts.
    pub fn wrench(&self, efforts: &[[f64; 2]]) -> [f64; 4] {
        let m = &self.compiled.effectiveness.matrix;
        let n = efforts.len();
        std::array::from_fn(|axis| {
            let units = efforts.iter().enumerate();
            units
                .map(|(i, [f, q])| m[(axis, i)] * f + m[(axis, n + i)] * q)
                .sum()
        })
    }
}
