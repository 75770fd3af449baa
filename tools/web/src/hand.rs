//! The mixer under sliders: setpoint, voltage, density and rotors out in; throttles, wrenches and the
//! units' efforts out, beside those of a mixer that takes the rotors for isolated.

use cargo_mixer::rows;
use mixer_compiler::airframe::{Axis, Correction, Unit};
use mixer_compiler::model::scales;
use mixer_facts::checklist::Checklist;
use mixer_files::report::study::Study;
use mixer_rt::{Conditions, Wrench};
use serde::Serialize;

use crate::desk::Checked;

/// What is drawn of an airframe, and how far its sliders go.
#[derive(Debug, Serialize)]
pub struct Scene {
    /// The units in the order of the file.
    pub units: Vec<Drawn>,
    /// Border of the attainable set of each kind of unit `[N, N m]` at the reference voltage and density;
    /// [`Mixed::factors`] bring it to others.
    pub borders: Vec<Vec<[f64; 2]>>,
    /// Ends of the border at the highest voltage and density, `[[low, high] of N, of N m]`.
    pub box_n_nm: [[f64; 2]; 2],
    /// Largest of each torque (N m), 0 where the axis is not served, and of thrust (N).
    pub largest: [f64; 4],
    /// Weight, N; else 40 % of the largest bare thrust.
    pub hover_n: f64,
    /// Lowest, reference and highest voltage, V; `None` without a correction.
    pub volts: Option<[f64; 3]>,
    /// The same of the density, kg/m3.
    pub density: Option<[f64; 3]>,
    /// `mass_kg`.
    pub mass_kg: Option<f64>,
    /// The word of `[allocation] airmode`.
    pub airmode: &'static str,
    /// `yaw_reserve_nm`.
    pub yaw_reserve_nm: f64,
    /// `power_bias_nm_per_n`.
    pub power_bias_nm_per_n: f64,
}

/// A unit seen from above.
#[derive(Debug, Serialize)]
pub struct Drawn {
    /// Place, m: forward and to the right.
    pub place_m: [f64; 2],
    /// In words, as `front right`.
    pub place: String,
    /// Outputs of its rotors, the upper one first.
    pub channels: Vec<usize>,
    /// How the upper rotor turns, `cw` or `ccw`.
    pub upper_spin: &'static str,
}

/// The scene of an airframe.
pub fn scene(checked: &Checked) -> Scene {
    let compiled = &checked.compiled;
    let airframe = &compiled.airframe;
    let study = Study::new(compiled, None);
    let borders: Vec<Vec<[f64; 2]>> = study.of_each().iter().map(Study::border_efforts).collect();
    let mut extent = [[0.0, 0.0]; 2];
    let [top_v, top_density] =
        [&airframe.voltage, &airframe.air].map(|of| of.as_ref().map_or(0.0, |of| of.range[1]));
    let top = airframe.factors(top_v, top_density);
    for point in borders.iter().flatten() {
        for (k, [low, high]) in extent.iter_mut().enumerate() {
            *low = f64::min(*low, top[k] * point[k]);
            *high = f64::max(*high, top[k] * point[k]);
        }
    }
    let list = Checklist(compiled);
    let drawn = |unit: &Unit| Drawn {
        place_m: [unit.position_m[0], unit.position_m[1]],
        place: list.place(unit),
        channels: unit.channels().collect(),
        upper_spin: unit.upper_spin.name(),
    };
    let largest = Axis::ALL.map(|axis| match axis {
        Axis::Thrust => f64::from(compiled.thrust_range_n[1]),
        axis if !airframe.allocation.controls(axis) => 0.0,
        axis => compiled
            .effectiveness
            .largest(axis as usize, &scales(airframe, [1.0; 2])),
    });
    let of = |correction: &Correction| {
        let [low, high] = correction.range;
        [low, correction.reference, high]
    };
    Scene {
        units: airframe.units.iter().map(drawn).collect(),
        borders,
        box_n_nm: extent,
        largest,
        hover_n: study.thrust_n,
        volts: airframe.voltage.as_ref().map(of),
        density: airframe.air.as_ref().map(of),
        mass_kg: airframe.vehicle.as_ref().map(|vehicle| vehicle.mass_kg),
        airmode: ["disabled", "roll-pitch", "roll-pitch-yaw"][airframe.allocation.airmode as usize],
        yaw_reserve_nm: airframe.allocation.yaw_reserve_nm,
        power_bias_nm_per_n: airframe.allocation.power_bias_nm_per_n,
    }
}

/// What came of a setpoint.
#[derive(Debug, Serialize)]
pub struct Mixed {
    /// Throttles by output, as `cargo mixer mix` prints them.
    pub throttles: Vec<f32>,
    /// Roll, pitch, yaw (N m) and thrust (N) by the mixer's own word, likewise.
    pub achieved: [f32; 4],
    /// The flags, likewise, and in words.
    pub saturation: (u16, String),
    /// `[k_f, k_Q]` at the voltage and the density.
    pub factors: [f64; 2],
    /// `[N, N m]` of every unit by the airframe's physics.
    pub efforts: Vec<[f64; 2]>,
    /// The same of a mixer that takes the rotors for isolated, whose rotors that are out give nothing.
    pub isolated: Isolated,
}

/// What a mixer for isolated rotors makes of the setpoint.
#[derive(Debug, Serialize)]
pub struct Isolated {
    /// Throttles by output.
    pub throttles: Vec<f32>,
    /// Roll, pitch, yaw (N m) and thrust (N) by the airframe's physics.
    pub given: [f64; 4],
    /// `[N, N m]` of every unit.
    pub efforts: Vec<[f64; 2]>,
}

/// Mixes `[roll, pitch, yaw (N m), thrust (N)]` at a voltage (V) and a density (kg/m3) with the rotors
/// at the outputs `failed` out.
///
/// # Errors
/// A setpoint, voltage or density that is no number, an output that the airframe does not have.
pub fn mix(
    checked: &Checked,
    wrench: &[f32],
    volts: f32,
    density: f32,
    failed: &[u8],
) -> Result<Mixed, String> {
    let compiled = &checked.compiled;
    let airframe = &compiled.airframe;
    let setpoint = <[f32; 4]>::try_from(wrench).map_err(|_| "a setpoint has four numbers")?;
    let setpoint = Wrench::from_array(setpoint);
    let health = rows::health(airframe, failed.iter().copied().map(usize::from))?;
    let conditions = Conditions::at_voltage(volts).in_air(density);
    let mixed = compiled.tables.mix_with_health(&setpoint, conditions, health);
    let (throttles, achieved, saturation) = mixed.map_err(|error| error.to_string())?;
    let isolated = checked.isolated.conventional(&setpoint, volts);
    let (isolated, _) = isolated.map_err(|error| error.to_string())?;
    let physics = compiled.physics();
    let factors = airframe.factors(f64::from(volts), f64::from(density));
    let efforts = |throttles: &[f32]| -> Vec<[f64; 2]> {
        let of = |unit| physics.efforts(unit, throttles, health);
        let at = |[f, q]: [f64; 2]| [factors[0] * f, factors[1] * q];
        (0..airframe.units.len()).map(of).map(at).collect()
    };
    Ok(Mixed {
        factors,
        efforts: efforts(&throttles),
        isolated: Isolated {
            given: physics.wrench(&isolated, factors, health),
            efforts: efforts(&isolated),
            throttles: isolated,
        },
        achieved: achieved.to_array(),
        saturation: (saturation.bits(), saturation.to_string()),
        throttles,
    })
}
