//! `[pair]`: the model of one pair, total thrust and torque as polynomials of the two throttles.

use toml::Spanned;

use super::basis::Basis;
use super::correction;
use super::limits;
use super::measured::{self, Measured};
use super::power::{self, Power};
use super::rotor_alone::{self, RotorAlone};
use super::throttle::Throttle;
use super::uncertainty;
use crate::spec::keys::{Key, ValueKind, keys};
use crate::spec::{Fields, Numbers};

/// Words of `stronger`: whether it is the lower rotor.
const STRONGER_WORDS: [&str; 2] = ["upper", "lower"];

/// Terms of the smallest and of the largest basis.
const TERMS: [usize; 2] = [8, 14];

keys! { TABLE = "[pair]":
    NAME "name" = "\"front\"", ValueKind::Text,
        "With several `[[pair]]`: the name by which a unit has it.";
    BASIS "basis" = "\"biquadratic\"", ValueKind::Word(&Basis::WORDS),
        "Terms of the polynomials in the upper throttle u and the lower throttle l. biquadratic: u2l2, u2l, u2, ul2, ul, u, l2, l; cubic: u3, u2l, ul2, l3, u2, ul, l2, u, l; quartic: u4, u3l, u2l2, ul3, l4, then as cubic.".required();
    THRUST_N "thrust_n" = "[5.2075, -2.1892, ..]", ValueKind::Numbers(TERMS),
        "Coefficients of the total thrust, N, in the order of the basis.".required();
    TORQUE_NM "torque_nm" = "[-0.0673, -0.0606, ..]", ValueKind::Numbers(TERMS),
        "Coefficients of the total torque, N m, positive where the lower rotor outweighs the upper.".required();
    UPPER_SPIN "upper_spin" = "\"cw\"", ValueKind::Word(&Spin::WORDS),
        "How the upper rotor turned on the bench, seen from above.".required();
    STRONGER "stronger" = "\"lower\"", ValueKind::Word(&STRONGER_WORDS),
        "The rotor of more pitch, KV or diameter, where they differ: a lower rotor that is the stronger one looks like rotors that were exchanged (MIX301).";
    LOWER_OUT "lower_out" = "", ValueKind::Table(&rotor_alone::LOWER_OUT),
        "What the upper rotor gives alone, the lower one at rest: used while the lower one is out.";
    UPPER_OUT "upper_out" = "", ValueKind::Table(&rotor_alone::UPPER_OUT),
        "What the lower rotor gives alone, the upper one at rest: used while the upper one is out.";
    POWER "power" = "", ValueKind::Table(&power::TABLE),
        "Electrical power, for what `check` and the report say of least power.";
    UNCERTAINTY "uncertainty" = "", ValueKind::Table(&uncertainty::TABLE),
        "How far the model of the pair may be from the pair.";
    VOLTAGE "voltage" = "", ValueKind::Table(&correction::VOLTAGE_TABLE),
        "Law of its own bench, which brings it to the frame's reference.";
    AIR "air" = "", ValueKind::Table(&correction::AIR_TABLE),
        "Likewise of the density.";
    BORROWED_FROM "borrowed_from" = "\"the X8 of Chebbi et al. 2020\"", ValueKind::Text,
        "The vehicle whose pair this is, where it stands in for one that was not measured yet: a warning (MIX309), the verdict and saved files say so.";
    BENCH_OPTIONS "bench_options" = "[\"--swap\", \"--unit\", \"thrust=gf\"]", ValueKind::Texts,
        "Options of `cargo mixer identify` that the bench files needed to be read: `report --bench` reads them so, too.";
    BENCH_V "bench_v" = "[13.96, 14.9]", ValueKind::Numbers([2, 2]),
        "Least and greatest voltage of the bench's rows, V, where they were not brought to one: the pair has their sag, which [voltage] would count again (MIX324).";
}

/// Sense of rotation of a unit's upper rotor, seen from above. The lower rotor turns the other way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spin {
    /// Clockwise.
    Cw,
    /// Counter-clockwise.
    Ccw,
}

impl Pair {
    /// Whose pair it is, where it is not the airframe's own, as a line of saved files says it.
    pub fn borrowed(&self) -> Option<String> {
        let from = &self.borrowed_from;
        let pair = match self.name.as_str() {
            "" => "pair".to_owned(),
            name => format!("pair \"{name}\""),
        };
        (!from.is_empty()).then(|| format!("the {pair} is that of {from}, not of this vehicle"))
    }
}

impl Spin {
    /// Both, as [`Spin::WORDS`] has them.
    pub(crate) const ALL: [Spin; 2] = [Spin::Cw, Spin::Ccw];

    /// The words in the file.
    pub(crate) const WORDS: [&'static str; 2] = ["cw", "ccw"];

    /// The word in the file.
    pub fn name(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// The sense in words.
    pub fn in_words(self) -> &'static str {
        match self {
            Spin::Cw => "clockwise",
            Spin::Ccw => "counter-clockwise",
        }
    }

    /// The other sense.
    #[must_use]
    pub fn reversed(self) -> Spin {
        match self {
            Spin::Cw => Spin::Ccw,
            Spin::Ccw => Spin::Cw,
        }
    }
}

/// Total thrust and torque of one pair at the reference voltage, as measured on the bench.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pair {
    /// The name by which units have it; empty where the file has none.
    pub name: String,
    /// Terms of both polynomials.
    pub basis: Basis,
    /// Coefficients of the thrust, N, one per term of [`Basis::exponents`], each within 1e6.
    pub thrust_n: Vec<f64>,
    /// Coefficients of the torque, N m, one per term, signed as on the bench, each within 1e6.
    pub torque_nm: Vec<f64>,
    /// Spin of the upper rotor on the bench.
    pub upper_spin: Spin,
    /// Whether the lower rotor is the stronger one, as the file says.
    pub lower_is_stronger: bool,
    /// The upper rotor alone; `None` where the polynomials at l = 0 stand for it.
    pub lower_out: Option<RotorAlone>,
    /// The lower rotor alone; `None` where the polynomials at u = 0 stand for it.
    pub upper_out: Option<RotorAlone>,
    /// Electrical power; `None` where the file has no `[pair.power]`.
    pub power: Option<Power>,
    /// How it was measured.
    pub measured: Measured,
    /// The vehicle whose pair stands in for one that was not measured yet; empty where it is the
    /// airframe's own.
    pub borrowed_from: String,
    /// Options of `cargo mixer identify` that the bench files needed to be read; empty where the file
    /// has none.
    pub bench_options: Vec<String>,
}

/// The pair, and its bench's spin also where other keys are at fault.
pub(super) fn read(table: &mut Fields<'_, '_>, throttle: Option<&Throttle>) -> (Option<Pair>, Option<Spin>) {
    let name = table.read::<String>(&NAME).map(Spanned::into_inner);
    let basis = table.word(&BASIS, &Basis::ALL);
    let [thrust_n, torque_nm] = [&THRUST_N, &TORQUE_NM].map(|key| coefficients(table, key, basis));
    let upper_spin = table.word(&UPPER_SPIN, &Spin::ALL);
    let lower_is_stronger = table.word(&STRONGER, &[false, true]);
    let lower_out = table.table(&LOWER_OUT, |table| {
        rotor_alone::read(table, &rotor_alone::UPPER, throttle)
    });
    let upper_out = table.table(&UPPER_OUT, |table| {
        rotor_alone::read(table, &rotor_alone::LOWER, throttle)
    });
    let power = table.table(&POWER, |table| power::read(table, throttle));
    let borrowed_from = table.read::<String>(&BORROWED_FROM);
    let bench_options = table.read::<Vec<Spanned<String>>>(&BENCH_OPTIONS);
    let bench_options = bench_options.map_or(Vec::new(), Spanned::into_inner);
    let measured = measured::read(table, [&UNCERTAINTY, &BENCH_V, &VOLTAGE, &AIR]);
    let pair = || {
        Some(Pair {
            name: name.unwrap_or_default(),
            basis: basis?,
            thrust_n: thrust_n?,
            torque_nm: torque_nm?,
            upper_spin: upper_spin?,
            lower_is_stronger: lower_is_stronger.unwrap_or_default(),
            lower_out: lower_out.flatten(),
            upper_out: upper_out.flatten(),
            power: power.flatten(),
            measured,
            borrowed_from: borrowed_from.map(Spanned::into_inner).unwrap_or_default(),
            bench_options: bench_options.into_iter().map(Spanned::into_inner).collect(),
        })
    };
    (pair(), upper_spin)
}

/// Writes all pairs in one basis: that of all, or the quartic, which has the terms of the others.
pub(super) fn unite(pairs: &mut [Pair]) {
    if pairs.windows(2).all(|two| two[0].basis == two[1].basis) {
        return;
    }
    for pair in pairs {
        let written = pair.basis.exponents();
        for terms in [&mut pair.thrust_n, &mut pair.torque_nm] {
            let value = |exponents| {
                let at = written.iter().position(|known| known == exponents);
                at.map_or(0.0, |at| terms[at])
            };
            *terms = Basis::Quartic.exponents().iter().map(value).collect();
        }
        pair.basis = Basis::Quartic;
    }
}

fn coefficients(table: &mut Fields<'_, '_>, key: &'static Key, basis: Option<Basis>) -> Option<Vec<f64>> {
    // Faults of its shape are told whatever the basis.
    let Some(basis) = basis else {
        table.read::<Numbers>(key);
        return None;
    };
    let what = format!("basis \"{}\"", basis.name());
    let terms = basis.exponents().len();
    limits::coefficients(table, key, (&what, terms), |found| {
        let mut others = Basis::ALL.into_iter();
        match others.find(|other| other.exponents().len() == found) {
            Some(other) => format!("{found} coefficients are those of basis = \"{}\"", other.name()),
            None => format!(
                "the terms are {}, in this order; a term that is not needed is 0",
                basis.terms()
            ),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_follow_the_contract() {
        let exponents = Basis::ALL.iter().flat_map(|basis| basis.exponents());
        let highest = exponents.map(|&(i, j)| i.max(j)).max().unwrap();
        assert_eq!(usize::from(highest) + 1, crate::airframe::POWERS);
        assert_eq!(Basis::Biquadratic.terms(), "u2l2, u2l, u2, ul2, ul, u, l2, l");
        assert_eq!(Basis::Cubic.terms(), "u3, u2l, ul2, l3, u2, ul, l2, u, l");
        assert_eq!(
            Basis::Quartic.terms(),
            "u4, u3l, u2l2, ul3, l4, u3, u2l, ul2, l3, u2, ul, l2, u, l"
        );
    }
}
