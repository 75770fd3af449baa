//! The keys of the airframe file, version 1: what the parser knows, advice shows, and the schema
//! for editors says.

/// A key or a table of the file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name as written in the file.
    pub name: &'static str,
    /// The line, or the header, that a user could add.
    pub example: &'static str,
    /// Whether its table must have it.
    pub required: bool,
    /// What it holds.
    pub kind: Kind,
    /// What it means, in a sentence.
    pub meaning: &'static str,
}

/// What a key holds.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Any text.
    Text,
    /// The name of a Rust module: lower-case letters and digits in parts joined by single `-` or
    /// `_`.
    Name,
    /// One of these words.
    Word(&'static [&'static str]),
    /// Some of these words.
    Words(&'static [&'static str]),
    /// A number.
    Number,
    /// A number above 0.
    Positive,
    /// A number from 0 on.
    NotNegative,
    /// A number from 0 to 1.
    Share,
    /// A number above 0 and at most 100.
    Percent,
    /// A whole number in this range.
    Count([usize; 2]),
    /// Numbers, as many as in this range.
    Numbers([usize; 2]),
    /// Pairs of a voltage and its factor.
    Points,
    /// Outputs of the upper and of the lower rotor.
    Channels,
    /// Those of several units.
    ListOfChannels,
    /// A table.
    Table(&'static Shape),
    /// A list of tables.
    Tables(&'static Shape),
}

/// A table of the file.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Header with its brackets; empty for the top of the file.
    pub header: &'static str,
    /// Its keys, in the order of the documentation.
    pub keys: &'static [Key],
}

impl Shape {
    /// The key called `name`.
    pub(crate) fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }
}

/// Any number of coefficients; how many is the compiler's to judge.
const ANY: [usize; 2] = [1, 64];

/// Terms of the smallest and of the largest basis.
const TERMS: [usize; 2] = [8, 14];

/// Most units of an airframe.
pub(crate) const MOST_UNITS: usize = 32;

/// Highest degree of the paper's polynomial in (f, Q): 136 terms per throttle.
pub(crate) const HIGHEST_INVERSE_DEGREE: usize = 15;

/// What `inverse.method` can be: a choice, the paper's polynomials, then the evaluators.
const METHODS: &[&str] = &[
    "auto",
    "polynomial",
    "bilinear-newton",
    "quadratic-newton",
    "cubic-newton",
    "bilinear-newton2",
    "quadratic-newton2",
    "cubic-newton2",
];

/// Names of the evaluators that a file can ask for.
pub(crate) const EVALUATORS: &[&str] = METHODS.split_at(2).1;

const SPINS: &[&str] = &["cw", "ccw"];

macro_rules! shape {
    (@required) => { false };
    (@required required) => { true };
    ($header:literal: $($name:literal $($required:ident)? => $example:literal, $kind:expr, $meaning:literal;)+) => {
        Shape {
            header: $header,
            keys: &[$(Key {
                name: $name,
                example: $example,
                required: shape!(@required $($required)?),
                kind: $kind,
                meaning: $meaning,
            }),+],
        }
    };
}

/// The top of the file.
pub const FILE: Shape = shape! { "":
    "name" required => "name = \"my-x8\"", Kind::Name,
        "Name of the airframe; becomes the Rust module and type.";
    "description" => "description = \"X8 with 15 inch propellers\"", Kind::Text,
        "Free text.";
    "throttle" required => "[throttle]", Kind::Table(&THROTTLE),
        "The range of every rotor's throttle.";
    "pair" required => "[pair]", Kind::Table(&PAIR),
        "Total thrust and torque of one unit at the reference voltage, from the bench.";
    "voltage" => "[voltage]", Kind::Table(&VOLTAGE),
        "How thrust and torque follow the battery's voltage; without it they do not.";
    "layout" => "[layout]", Kind::Table(&LAYOUT),
        "A regular frame, instead of [[unit]].";
    "unit" => "[[unit]]", Kind::Tables(&UNIT),
        "One for each pair of rotors.";
    "inverse" => "[inverse]", Kind::Table(&INVERSE),
        "How truly, and how, the pair's map is inverted.";
    "allocation" => "[allocation]", Kind::Table(&ALLOCATION),
        "Which axes are served, and what gives way when not all can be had.";
    "vehicle" => "[vehicle]", Kind::Table(&VEHICLE),
        "The vehicle, for what `check` and the report say of hover.";
};

/// `[throttle]`
pub(crate) const THROTTLE: Shape = shape! { "[throttle]":
    "min" required => "min = 0.10", Kind::Share,
        "Idle: no rotor is ever commanded below. Below some idle the map of every pair folds; the compiler names the least that works.";
    "max" required => "max = 1.0", Kind::Share,
        "No rotor is ever commanded above.";
};

/// `[pair]`
pub(crate) const PAIR: Shape = shape! { "[pair]":
    "basis" required => "basis = \"biquadratic\"", Kind::Word(&["biquadratic", "cubic", "quartic"]),
        "Terms of the polynomials in the upper throttle u and the lower throttle l. biquadratic: u2l2, u2l, u2, ul2, ul, u, l2, l; cubic: u3, u2l, ul2, l3, u2, ul, l2, u, l; quartic: u4, u3l, u2l2, ul3, l4, then as cubic.";
    "thrust_n" required => "thrust_n = [5.2075, -2.1892, ..]", Kind::Numbers(TERMS),
        "Coefficients of the total thrust, N, in the order of the basis.";
    "torque_nm" required => "torque_nm = [-0.0673, -0.0606, ..]", Kind::Numbers(TERMS),
        "Coefficients of the total torque, N m, positive where the lower rotor outweighs the upper.";
    "upper_spin" required => "upper_spin = \"cw\"", Kind::Word(SPINS),
        "How the upper rotor turned on the bench, seen from above.";
    "lower_out" => "[pair.lower_out]", Kind::Table(&LOWER_OUT),
        "What the upper rotor gives alone, the lower one at rest: used while the lower one is out.";
    "upper_out" => "[pair.upper_out]", Kind::Table(&UPPER_OUT),
        "What the lower rotor gives alone, the upper one at rest: used while the upper one is out.";
    "power" => "[pair.power]", Kind::Table(&POWER),
        "Electrical power, for what `check` and the report say of least power.";
    "uncertainty" => "[pair.uncertainty]", Kind::Table(&UNCERTAINTY),
        "How far the model of the pair may be from the pair.";
};

/// `[pair.uncertainty]`
pub(crate) const UNCERTAINTY: Shape = shape! { "[pair.uncertainty]":
    "thrust_percent" required => "thrust_percent = 1.5", Kind::Percent,
        "Standard deviation of the thrust, % of the thrust at full throttle.";
    "torque_percent" required => "torque_percent = 3.7", Kind::Percent,
        "Standard deviation of the torque, % of the largest torque.";
};

/// `[pair.lower_out]`
pub(crate) const LOWER_OUT: Shape = shape! { "[pair.lower_out]":
    "thrust_n" required => "thrust_n = [0.2, 14.1, -1.7]", Kind::Numbers([3, 3]),
        "Thrust of the upper rotor alone, N: a1, a2, a3 of a1 x + a2 x2 + a3 x3.";
    "torque_nm" required => "torque_nm = [-0.01, -0.2, 0.02]", Kind::Numbers([3, 3]),
        "Its torque, N m, signed as that of the pair.";
};

/// `[pair.upper_out]`
pub(crate) const UPPER_OUT: Shape = shape! { "[pair.upper_out]":
    "thrust_n" required => "thrust_n = [0.2, 14.1, -1.7]", Kind::Numbers([3, 3]),
        "Thrust of the lower rotor alone, N: a1, a2, a3 of a1 x + a2 x2 + a3 x3.";
    "torque_nm" required => "torque_nm = [0.01, 0.2, -0.02]", Kind::Numbers([3, 3]),
        "Its torque, N m, signed as that of the pair.";
};

/// Coefficients of a power map: the quartic's and a constant.
pub(crate) const POWER_TERMS: usize = 15;

/// `[pair.power]`
pub(crate) const POWER: Shape = shape! { "[pair.power]":
    "power_w" required => "power_w = [0, 0, 0, 0, 0, 620, 90, 40, 560, 160, -60, 150, 8, 6, 5]", Kind::Numbers([POWER_TERMS, POWER_TERMS]),
        "Electrical power of both rotors, W: the quartic's coefficients and a constant; `identify` writes it.";
};

/// `[voltage]`
pub(crate) const VOLTAGE: Shape = shape! { "[voltage]":
    "reference_v" required => "reference_v = 14.8", Kind::Positive,
        "Voltage of the bench, V.";
    "range_v" required => "range_v = [12.8, 16.8]", Kind::Numbers([2, 2]),
        "Lowest and highest voltage in flight, V; outside it is clamped and flagged.";
    "thrust_exponent" => "thrust_exponent = 1.75", Kind::Number,
        "Thrust is multiplied by (V / reference)^exponent.";
    "thrust_polynomial" => "thrust_polynomial = [-0.7, 1.7]", Kind::Numbers(ANY),
        "Thrust is multiplied by c0 + c1 x + .., x = V / reference.";
    "thrust_points" => "thrust_points = [[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]", Kind::Points,
        "Thrust is multiplied by a factor between these points [V, factor].";
    "torque_exponent" => "torque_exponent = 1.75", Kind::Number,
        "Torque is multiplied by (V / reference)^exponent.";
    "torque_polynomial" => "torque_polynomial = [-0.7, 1.7]", Kind::Numbers(ANY),
        "Torque is multiplied by c0 + c1 x + .., x = V / reference.";
    "torque_points" => "torque_points = [[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]", Kind::Points,
        "Torque is multiplied by a factor between these points [V, factor].";
};

/// `[layout]`
pub(crate) const LAYOUT: Shape = shape! { "[layout]":
    "arm_m" required => "arm_m = 0.45", Kind::Positive,
        "From the centre of gravity to each mast, m.";
    "units" required => "units = 4", Kind::Count([1, MOST_UNITS]),
        "Pairs of rotors.";
    "first_angle_deg" required => "first_angle_deg = 45", Kind::Number,
        "Of the first unit, degrees clockwise from the nose as seen from above.";
    "first_spin" => "first_spin = \"cw\"", Kind::Word(SPINS),
        "Of the first unit's upper rotor. They alternate for an even number of units and turn alike for an odd one.";
    "spins" => "spins = [\"cw\", \"ccw\", \"cw\", \"ccw\"]", Kind::Words(SPINS),
        "Of every unit's upper rotor, instead of first_spin.";
    "channels" => "channels = [[0, 4], [1, 5], [2, 6], [3, 7]]", Kind::ListOfChannels,
        "Outputs of the upper and of the lower rotor of every unit; k and n + k without it.";
};

/// `[[unit]]`
pub(crate) const UNIT: Shape = shape! { "[[unit]]":
    "position_m" required => "position_m = [0.3182, 0.3182, 0.0]", Kind::Numbers([3, 3]),
        "Forward, right and down from the centre of gravity, m.";
    "upper_spin" required => "upper_spin = \"cw\"", Kind::Word(SPINS),
        "How this unit's upper rotor turns, seen from above.";
    "channels" required => "channels = [0, 4]", Kind::Channels,
        "Outputs of the upper and of the lower rotor; all units together have 0 to 2n - 1.";
    "axis" => "axis = [0.0, 0.0, -1.0]", Kind::Numbers([3, 3]),
        "Unit vector of the thrust, straight up without it.";
};

/// `[inverse]`
pub(crate) const INVERSE: Shape = shape! { "[inverse]":
    "thrust_tolerance_n" => "thrust_tolerance_n = 0.01", Kind::Positive,
        "What a unit's thrust may miss at any voltage, N; 0.01 without it.";
    "torque_tolerance_nm" => "torque_tolerance_nm = 1e-4", Kind::Positive,
        "What a unit's torque may miss at any voltage, N m; 0.0001 without it.";
    "method" => "method = \"auto\"", Kind::Word(METHODS),
        "auto: the cheapest evaluator that is proven to meet the tolerances; polynomial: the paper's, with a degree; or one by name.";
    "degree" => "degree = 7", Kind::Count([1, HIGHEST_INVERSE_DEGREE]),
        "Total degree of method = \"polynomial\".";
};

/// `[allocation]`
pub(crate) const ALLOCATION: Shape = shape! { "[allocation]":
    "airmode" => "airmode = \"disabled\"", Kind::Word(&["disabled", "roll-pitch", "roll-pitch-yaw"]),
        "For which torques the thrust may rise, with PX4's meaning; disabled without it.";
    "axes" => "axes = [\"roll\", \"pitch\", \"yaw\", \"thrust\"]", Kind::Words(&["roll", "pitch", "yaw", "thrust"]),
        "The served axes, all four without it; fewer for one or two units, which cannot produce all.";
    "yaw_reserve_nm" => "yaw_reserve_nm = 0.05", Kind::NotNegative,
        "Yaw torque that is kept available before roll and pitch, N m; 0 without it.";
    "power_bias_nm_per_n" => "power_bias_nm_per_n = 0.005", Kind::Number,
        "Least power: torque per thrust of every unit while none is near its limits, N m per N; 0 without it.";
};

/// `[vehicle]`
pub(crate) const VEHICLE: Shape = shape! { "[vehicle]":
    "mass_kg" required => "mass_kg = 3.2", Kind::Positive,
        "Take-off mass, kg.";
    "inertia_kg_m2" => "inertia_kg_m2 = [0.080, 0.087, 0.160]", Kind::Numbers([3, 3]),
        "Moments of inertia about the forward, right and down axes, kg m2, for simulators.";
};

/// Every table, to tell where a misplaced key belongs.
pub(crate) const ALL: &[Shape] = &[
    FILE,
    THROTTLE,
    PAIR,
    LOWER_OUT,
    UPPER_OUT,
    POWER,
    UNCERTAINTY,
    VOLTAGE,
    LAYOUT,
    UNIT,
    INVERSE,
    ALLOCATION,
    VEHICLE,
];
