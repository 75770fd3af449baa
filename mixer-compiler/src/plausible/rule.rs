//! The form of a rule, and the facts that rules read.

use crate::airframe::{Airframe, Axis, Kind};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::view::View;

/// Points per edge of the throttle box at which a unit's efforts are looked at.
const POINTS: usize = 128;

/// A value of an airframe with what is said where it is not plausible.
pub(super) struct Rule {
    pub(super) code: Code,
    key: String,
    is_plausible: bool,
    message: String,
    label: String,
    help: String,
    /// Warnings that may be the reason: where one of them is found, this one is left out.
    reasons: &'static [Code],
}

impl Rule {
    /// The rule that something holds.
    pub(super) fn holds(code: Code, key: impl Into<String>, is_plausible: bool) -> Rule {
        Rule {
            code,
            key: key.into(),
            is_plausible,
            message: String::new(),
            label: String::new(),
            help: String::new(),
            reasons: &[],
        }
    }

    /// The rule that a value is within a range.
    pub(super) fn within(code: Code, key: impl Into<String>, value: f64, [least, most]: [f64; 2]) -> Rule {
        Rule::holds(code, key, (least..=most).contains(&value))
    }

    /// The rule that a value is not above a limit.
    pub(super) fn at_most(code: Code, key: impl Into<String>, value: f64, most: f64) -> Rule {
        Rule::holds(code, key, value <= most)
    }

    /// The same rule with what is said where it is broken: message, label and help.
    pub(super) fn says(
        mut self,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> Rule {
        (self.message, self.label, self.help) = (message.into(), label.into(), help.into());
        self
    }

    /// The same rule, silent where one of these explains it.
    pub(super) fn unless_explained(self, reasons: &'static [Code]) -> Rule {
        Rule { reasons, ..self }
    }

    /// Whether a warning may be the reason of this rule's.
    pub(super) fn explains(&self, told: &Diagnostic) -> bool {
        self.reasons.contains(&told.code)
    }

    /// The warning, where the rule is broken.
    pub(super) fn told(self, airframe: &Airframe) -> Option<Diagnostic> {
        let is_broken = !self.is_plausible;
        is_broken.then(|| airframe.diagnostic(self.code, &self.key, self.message, self.label, self.help))
    }

    /// The warning of a kind of unit.
    pub(super) fn told_of(self, view: &View<'_, Kind<'_>>) -> Option<Diagnostic> {
        let is_broken = !self.is_plausible;
        is_broken.then(|| view.diagnostic(self.code, &self.key, self.message, self.label, self.help))
    }
}

/// A kind of unit and what was found out about it. Efforts are `[f, Q]` of one unit at the reference voltage, N and N m.
pub(super) struct KindFacts<'a> {
    pub(super) view: View<'a, Kind<'a>>,
    pub(super) is_refused: bool,
    pub(super) map: PairMap,
    /// Largest thrust and largest absolute torque.
    pub(super) scale: [f64; 2],
    /// Efforts at idle, of the upper and of the lower rotor at full throttle with the other at idle,
    /// and at full throttle.
    pub(super) idle: [f64; 2],
    pub(super) upper: [f64; 2],
    pub(super) lower: [f64; 2],
    pub(super) full: [f64; 2],
    /// Efforts along the border of the attainable set, of a single rotor along its curve.
    pub(super) border: Vec<[f64; 2]>,
}

impl<'a> KindFacts<'a> {
    pub(super) fn new(view: View<'a, Kind<'a>>, is_refused: bool) -> KindFacts<'a> {
        let map = PairMap::of_kind(view.of, &view.throttle);
        let [low, high] = map.range();
        KindFacts {
            view,
            is_refused,
            scale: map.scale(),
            idle: map.efforts([low, low]),
            upper: map.efforts([high, low]),
            lower: map.efforts([low, high]),
            full: map.efforts([high, high]),
            border: map.border(POINTS).into_iter().map(|at| map.efforts(at)).collect(),
            map,
        }
    }
}

/// An airframe and what was found out about it.
pub(super) struct Facts<'a> {
    pub(super) airframe: &'a Airframe,
    /// Those of its kinds of units.
    pub(super) kinds: &'a [KindFacts<'a>],
    /// `None` where the airframe is refused.
    pub(super) effectiveness: Option<&'a Effectiveness>,
    /// Largest thrust and largest absolute torque, of any unit, at the reference voltage, N and N m.
    pub(super) scale: [f64; 2],
    /// Least and largest bare thrust at the reference voltage, N; `None` where the airframe is
    /// refused.
    pub(super) thrust_range_n: Option<[f64; 2]>,
}

impl<'a> Facts<'a> {
    pub(super) fn new(
        airframe: &'a Airframe,
        kinds: &'a [KindFacts<'a>],
        compiled: Option<(&'a Effectiveness, [f64; 2])>,
    ) -> Facts<'a> {
        let most = |k: usize| kinds.iter().fold(0.0, |most: f64, of| most.max(of.scale[k]));
        Facts {
            airframe,
            kinds,
            effectiveness: compiled.map(|(effectiveness, _)| effectiveness),
            scale: [most(0), most(1)],
            thrust_range_n: compiled.map(|(_, range)| range),
        }
    }

    pub(super) fn controls(&self, axis: Axis) -> bool {
        self.airframe.allocation.controls(axis)
    }

    /// The key to point at for a unit: that of the layout, where the file has it.
    pub(super) fn place(&self, in_layout: &str, of_unit: String) -> String {
        match self.airframe.states(in_layout) {
            true => in_layout.to_owned(),
            false => of_unit,
        }
    }
}
