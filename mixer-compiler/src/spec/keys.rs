//! The keys of the airframe file, version 1, each with an example for advice.

/// A key or a table of the file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    /// Name as written in the file.
    pub(crate) name: &'static str,
    /// The line, or the header, that a user could add.
    pub(crate) example: &'static str,
}

/// A table of the file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    /// Header with its brackets; empty for the top of the file.
    pub(crate) header: &'static str,
    /// Its keys, in the order of the documentation.
    pub(crate) keys: &'static [Key],
}

impl Shape {
    /// The key called `name`.
    pub(crate) fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }
}

macro_rules! shape {
    ($header:literal: $($name:literal => $example:literal,)+) => {
        Shape { header: $header, keys: &[$(Key { name: $name, example: $example }),+] }
    };
}

pub(crate) const FILE: Shape = shape! { "":
    "name" => "name = \"my-x8\"",
    "description" => "description = \"X8 with 15 inch propellers\"",
    "throttle" => "[throttle]",
    "pair" => "[pair]",
    "voltage" => "[voltage]",
    "layout" => "[layout]",
    "unit" => "[[unit]]",
    "inverse" => "[inverse]",
    "allocation" => "[allocation]",
    "vehicle" => "[vehicle]",
};

pub(crate) const THROTTLE: Shape = shape! { "[throttle]":
    "min" => "min = 0.10",
    "max" => "max = 1.0",
};

pub(crate) const PAIR: Shape = shape! { "[pair]":
    "basis" => "basis = \"biquadratic\"",
    "thrust_n" => "thrust_n = [5.2075, -2.1892, ..]",
    "torque_nm" => "torque_nm = [-0.0673, -0.0606, ..]",
    "upper_spin" => "upper_spin = \"cw\"",
    "lower_out" => "[pair.lower_out]",
    "upper_out" => "[pair.upper_out]",
};

pub(crate) const LOWER_OUT: Shape = shape! { "[pair.lower_out]":
    "thrust_n" => "thrust_n = [0.2, 14.1, -1.7]",
    "torque_nm" => "torque_nm = [-0.01, -0.2, 0.02]",
};

pub(crate) const UPPER_OUT: Shape = shape! { "[pair.upper_out]":
    "thrust_n" => "thrust_n = [0.2, 14.1, -1.7]",
    "torque_nm" => "torque_nm = [0.01, 0.2, -0.02]",
};

pub(crate) const VOLTAGE: Shape = shape! { "[voltage]":
    "reference_v" => "reference_v = 14.8",
    "range_v" => "range_v = [12.8, 16.8]",
    "thrust_exponent" => "thrust_exponent = 1.75",
    "thrust_polynomial" => "thrust_polynomial = [-0.7, 1.7]",
    "thrust_points" => "thrust_points = [[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]",
    "torque_exponent" => "torque_exponent = 1.75",
    "torque_polynomial" => "torque_polynomial = [-0.7, 1.7]",
    "torque_points" => "torque_points = [[12.8, 0.78], [14.8, 1.0], [16.8, 1.25]]",
};

pub(crate) const LAYOUT: Shape = shape! { "[layout]":
    "arm_m" => "arm_m = 0.45",
    "units" => "units = 4",
    "first_angle_deg" => "first_angle_deg = 45",
    "first_spin" => "first_spin = \"cw\"",
    "spins" => "spins = [\"cw\", \"ccw\", \"cw\", \"ccw\"]",
    "channels" => "channels = [[0, 4], [1, 5], [2, 6], [3, 7]]",
};

pub(crate) const UNIT: Shape = shape! { "[[unit]]":
    "position_m" => "position_m = [0.3182, 0.3182, 0.0]",
    "upper_spin" => "upper_spin = \"cw\"",
    "channels" => "channels = [0, 4]",
    "axis" => "axis = [0.0, 0.0, -1.0]",
};

pub(crate) const INVERSE: Shape = shape! { "[inverse]":
    "thrust_tolerance_n" => "thrust_tolerance_n = 0.01",
    "torque_tolerance_nm" => "torque_tolerance_nm = 1e-4",
    "method" => "method = \"auto\"",
    "degree" => "degree = 7",
};

pub(crate) const ALLOCATION: Shape = shape! { "[allocation]":
    "airmode" => "airmode = \"disabled\"",
    "axes" => "axes = [\"roll\", \"pitch\", \"yaw\", \"thrust\"]",
    "yaw_reserve_nm" => "yaw_reserve_nm = 0.05",
};

pub(crate) const VEHICLE: Shape = shape! { "[vehicle]":
    "mass_kg" => "mass_kg = 3.2",
};

/// Every table, to tell where a misplaced key belongs.
pub(crate) const ALL: &[Shape] = &[
    FILE, THROTTLE, PAIR, LOWER_OUT, UPPER_OUT, VOLTAGE, LAYOUT, UNIT, INVERSE, ALLOCATION, VEHICLE,
];
