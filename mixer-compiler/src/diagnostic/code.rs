//! The catalogue of faults and warnings.

use std::fmt;

macro_rules! catalogue {
    ($(#[doc = $meaning:literal] $code:ident = $number:literal,)+) => {
        /// Every kind of fault that the compiler reports. A code keeps its number and its meaning
        /// for good, so that it can be searched for and scripts can rely on it.
        ///
        /// Below 100: the file is not in the form of an airframe file. From 100: a value cannot be
        /// an airframe's. From 200: the airframe is sound in itself, but no mixer can be made of
        /// it. From 300: warnings; the airframe compiles, but a value is probably a mistake.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $(#[doc = $meaning] $code = $number,)+
        }

        impl Code {
            /// All codes, in the order of their numbers.
            pub const ALL: &[Code] = &[$(Code::$code),+];

            /// What the code means, in one sentence.
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Code::$code => $meaning.trim_ascii_start(),)+
                }
            }
        }
    };
}

/// What a diagnostic means for the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Severity {
    /// The file is refused.
    Error,
    /// The file is compiled, but a value is probably a mistake.
    Warning,
}

catalogue! {
    /// The text is not TOML.
    Syntax = 1,
    /// A key that airframe files do not have.
    UnknownKey = 2,
    /// A key or table that must be there is not.
    MissingKey = 3,
    /// A value of another type than the key takes.
    WrongType = 4,
    /// An array with more or fewer elements than it must have.
    WrongLength = 5,
    /// A number that is infinite or not a number.
    NotFinite = 6,
    /// A word that is not among those that the key takes.
    UnknownWord = 7,
    /// A number outside the range that the key allows.
    OutOfRange = 8,
    /// Keys or tables that exclude one another.
    Conflict = 9,
    /// A string with a character that does not show as itself: a control character, or one that turns text around.
    NotPlain = 10,

    /// A name that cannot become a Rust module, a Rust type and a file.
    Name = 100,
    /// Throttle limits that leave no range inside [0, 1].
    ThrottleRange = 101,
    /// A range of voltage or density that is empty or lacks the reference.
    ConditionRange = 102,
    /// A law of voltage or density that leaves no thrust or torque somewhere in its range.
    FactorNotPositive = 103,
    /// A law of voltage or density that is not 1 at the reference.
    FactorNotOne = 104,
    /// Voltage points that do not ascend or do not cover the voltage range.
    VoltagePoints = 105,
    /// A law of voltage or density that multiplies thrust or torque beyond any pack or air.
    FactorTooLarge = 106,
    /// Kinds of units that were measured at unlike voltages or densities, and no law brings them together.
    References = 107,
    /// An output channel that two rotors share.
    DuplicateChannel = 110,
    /// An output channel beyond the number of rotors, which leaves another without a rotor.
    ChannelRange = 111,
    /// Two units in one place.
    SamePlace = 112,
    /// A unit implausibly far from the centre of gravity.
    FarUnit = 113,
    /// A thrust axis that is not a unit vector.
    AxisLength = 114,
    /// A thrust axis that does not point upward.
    AxisNotUpward = 115,
    /// More units than a mixer takes.
    TooManyUnits = 116,
    /// Control axes that are repeated or lack the thrust.
    ControlAxes = 120,
    /// A yaw reserve where yaw is not controlled.
    YawReserve = 121,
    /// A power bias where yaw is not controlled.
    PowerBias = 122,

    /// A single rotor's curve that no rotor has: thrust that does not grow, or torque of the other rotor's sign.
    RotorAlone = 130,
    /// A power map that no pair has: power that is not positive, or that does not grow with the throttles.
    PowerMap = 131,

    /// The units cannot produce an axis: the effectiveness matrix has not the rank that the axes ask for.
    RankDeficient = 200,
    /// The pair's map folds inside the throttle range: det J falls to zero or below.
    Fold = 201,
    /// The pair's map is not proven injective: two throttle pairs may give one thrust and torque.
    NotInjective = 202,
    /// No evaluator of the inverse meets the tolerances.
    Tolerance = 203,
    /// The airframe cannot hover: no thrust is attainable without roll, pitch and yaw.
    Hover = 204,
    /// A tolerance above a tenth of a unit's largest effort.
    ToleranceAbsurd = 206,
    /// The pseudo-inverse M+ is not accurate: the layout hardly tells its axes apart.
    PseudoInverse = 207,
    /// The emitted mixer does not give what the airframe's physics demand: a fault of the compiler.
    Probe = 208,
    /// An axis of which the rotors give more than requests are limited to.
    Authority = 209,
    /// A lag of the rotors for which `mix_dynamic` is not proven: thrust may fall where throttles rise.
    RotorLag = 210,

    /// Thrust and torque in a ratio that no propeller has: one of them is in another unit.
    PairUnits = 300,
    /// The upper and the lower rotor look exchanged.
    RotorsExchanged = 301,
    /// Both rotors together give more thrust than the sum of each alone, which no coaxial pair does.
    NotCoaxial = 302,
    /// An idle at which a large share of the thrust is always on.
    HighIdle = 303,
    /// Power that no pair of this thrust takes: in another unit, or with a coefficient that is off.
    PowerUnits = 304,
    /// One rotor of the pair gives several times what the other gives.
    LopsidedPair = 305,
    /// A rotor alone that gives several times more or less than in its pair.
    RotorAloneScale = 306,
    /// An idle above the largest with which ArduPilot arms.
    SpinMin = 307,
    /// A map whose growth with the throttles, or whose rotors' hold on one another, no pair has.
    PairShape = 308,
    /// A pair that is another vehicle's and stands in for the airframe's own.
    BorrowedPair = 309,
    /// An arm far longer than the thrust makes plausible.
    LongArm = 310,
    /// An angle that looks like radians.
    Radians = 311,
    /// A centre of gravity so far off that most of the thrust cannot be used.
    CentreOfGravity = 312,
    /// More units than the counted costs are of.
    ManyUnits = 313,
    /// Arms so short that the rotors would overlap.
    ShortArm = 314,
    /// A place that breaks the symmetry of all other units.
    OddPlace = 315,
    /// A supply of one cell for rotors that need more.
    SingleCell = 320,
    /// A law whose power of voltage or density no propeller follows.
    ConditionExponent = 321,
    /// A law of voltage or density that leaves little of thrust or torque, or multiplies it, within its range.
    ConditionFactor = 322,
    /// No `[voltage]`: thrust is taken to be the same at any voltage of the pack.
    NoVoltage = 323,
    /// A `[voltage]` beside a pair whose rows have the sag of their own supply.
    SagTwice = 324,
    /// A kind of unit whose own law of voltage or density is not the frame's.
    UnlikeLaw = 325,
    /// A tolerance above a hundredth of a unit's largest effort.
    WideTolerance = 330,
    /// A yaw reserve that the units cannot hold at any thrust.
    YawReserveBeyond = 331,
    /// A power bias that the pair cannot give at half of its thrust.
    PowerBiasBeyond = 332,
    /// A power bias that saves nothing, as no upper rotors turn against each other.
    PowerBiasIdle = 333,
    /// A power bias that costs power at the vehicle's weight.
    PowerBiasCosts = 335,
    /// Yaw that comes before thrust: the thrust changes while the vehicle yaws.
    YawBeforeThrust = 336,
    /// A vehicle that is too heavy to hover.
    TooHeavy = 340,
    /// A vehicle that rises at idle.
    FloatsAtIdle = 341,
    /// A vehicle that hovers with little thrust left.
    HoversHigh = 342,
    /// Hover leaves less of an axis than the pair may be off by.
    MarginBelowBand = 343,
    /// A vehicle of far less weight than its rotors lift.
    TooLight = 344,
    /// A rotor that hovers next to a limit of its throttle.
    HoverAtLimit = 345,
    /// An inertia of a rotor that no propeller of such a thrust has.
    RotorInertia = 346,
}

impl Code {
    /// Whether the code refuses the file or warns of it.
    pub fn severity(self) -> Severity {
        if self.number() < 300 {
            Severity::Error
        } else {
            Severity::Warning
        }
    }

    /// Place in the order of harm: errors, values with which the mixer is that of another vehicle, those that leave the vehicle
    /// little, and those that only cost.
    pub(crate) fn harm(self) -> u8 {
        match self.number() {
            0..300 => 0,
            // High idles, a rotor alone, arming, voltage, hover near a limit.
            303 | 306 | 307 | 323 | 331 | 336 | 342 | 343 | 345 | 346 => 2,
            304 | 313 | 330..340 => 3,
            _ => 1,
        }
    }

    /// The number in `MIX014`.
    pub fn number(self) -> u16 {
        self as u16
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "MIX{:03}", self.number())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_distinct_ordered_and_explained() {
        assert!(
            Code::ALL
                .windows(2)
                .all(|pair| pair[0].number() < pair[1].number())
        );
        for code in Code::ALL {
            assert!(
                code.meaning().ends_with('.') && code.meaning().len() > 15,
                "{code}: {:?}",
                code.meaning()
            );
        }
        assert_eq!(Code::Syntax.to_string(), "MIX001");
    }
}
