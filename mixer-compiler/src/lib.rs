//! Compiler from an airframe file to the tables of a coaxial multirotor mixer.
//!
//! Text in, tables or diagnostics out; files, the environment and macros are the business of its
//! three front ends: `mixer-macros`, [`build_script`] and `cargo mixer`. [`compile`] shows the
//! pipeline.

pub mod airframe;
mod allocation;
pub mod bounds;
#[cfg(feature = "format")]
pub mod build_script;
mod compiled;
pub mod diagnostic;
mod inverse;
pub mod model;
mod output;
mod plausible;
mod probe;
mod proof;
mod selection;
pub mod spec;
pub mod tables;

use airframe::Airframe;
use allocation::{closed_form, thrust_range};
use diagnostic::{Diagnostic, Diagnostics};
use model::PairMap;
use model::effectiveness::Effectiveness;
use model::injectivity;
use model::voltage;
use output::{emit, scale};
use probe::Probe;
use proc_macro2::TokenStream;
use tables::{MixerTables, Parts, VoltageTable};

pub use compiled::Compiled;
pub use diagnostic::source::Source;
pub use inverse::evaluator;
pub use output::{alternatives, checklist, cost, hover, power, report};
pub use plausible::ARDUPILOT_MOST_SPIN_MIN;
pub use proof::Certificate;
pub use proof::residual::Residual;

/// Compiles an airframe file: source -> airframe -> effectiveness -> injectivity -> voltage ->
/// proven inverse -> closed form -> tables -> range of thrust -> probes -> warnings.
///
/// # Errors
/// All faults that were found, and with faults of later stages the warnings, one of which may be
/// why. Faults of the file itself end the compilation; later stages report together. Warnings are
/// no faults: they are in [`Compiled::warnings`].
pub fn compile(source: &Source) -> Result<Compiled, Diagnostics> {
    let airframe = Airframe::read(source)?;
    compile_airframe(source, airframe.clone()).map_err(|mut faults| {
        faults.extend(plausible::warnings_of_refused(&airframe));
        Diagnostics::new(source.clone(), faults)
    })
}

fn compile_airframe(source: &Source, airframe: Airframe) -> Result<Compiled, Vec<Diagnostic>> {
    let mut faults = Vec::new();
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    let effectiveness = keep(Effectiveness::new(&airframe), &mut faults);
    let authority = effectiveness
        .as_ref()
        .and_then(|effectiveness| keep(plausible::authority(&airframe, effectiveness, &pair), &mut faults));
    let invertible = keep(injectivity::prove(&airframe), &mut faults);
    let voltage = keep(voltage::tabulate(&airframe), &mut faults);
    let tolerances = keep(plausible::tolerances(&airframe, &pair), &mut faults);
    let (Some(effectiveness), Some(()), Some((injectivity, least_idle)), Some(voltage), Some(())) =
        (effectiveness, authority, invertible, voltage, tolerances)
    else {
        return Err(faults);
    };
    let voltage = VoltageTable::new(&airframe, voltage.as_ref());
    let voltage = voltage.as_ref();
    let selected = selection::select(&airframe, &pair, voltage)?;
    let parts = Parts {
        airframe: &airframe,
        effectiveness: &effectiveness,
        pair: &pair,
        voltage,
        map: &selected.map,
        tolerance: selection::tolerance(&airframe, &effectiveness, &pair, voltage, &selected),
    };
    let (closed_form, lost_between_sides) = closed_form::table(&airframe, &effectiveness, &pair).unzip();
    let mut tables = MixerTables::new(&parts, closed_form);
    tables.level_n = thrust_range::level(&airframe, &tables);
    let thrust_range_n = thrust_range::thrust_range(&airframe, &tables)?;
    let probe = Probe {
        airframe: &airframe,
        effectiveness: &effectiveness,
        pair: &pair,
        tables: &tables,
        thrust_range_n,
        lost_between_sides,
    };
    probe.run()?;
    let mut warnings = plausible::warnings(&airframe, &effectiveness, &pair, thrust_range_n);
    let mut compiled = Compiled {
        source_name: source.file_name(),
        warnings: Diagnostics::new(source.clone(), Vec::new()),
        airframe,
        effectiveness,
        pair,
        injectivity,
        least_idle,
        evaluator: selected.evaluator,
        residual: selected.residual,
        thrust_range_n,
        certificate: selected.certificate,
        lost_between_sides,
        tables,
    };
    warnings.extend(hover::warnings(&compiled));
    warnings.extend(power::warnings(&compiled));
    compiled.warnings = Diagnostics::new(source.clone(), warnings);
    Ok(compiled)
}

/// The value, or its faults added to the others.
fn keep<T>(result: Result<T, Vec<Diagnostic>>, faults: &mut Vec<Diagnostic>) -> Option<T> {
    result.map_err(|found| faults.extend(found)).ok()
}

/// The first line of generated Rust: reviews and linters leave out files that have it.
#[cfg(feature = "format")]
const GENERATED: &str = "// @generated from an airframe file by mixer-compiler; do not edit.\n";

impl Compiled {
    /// Wrench that one unit of PX4's normalised setpoints asks for at the reference voltage: `SCALE`
    /// of the generated module.
    pub fn scale(&self) -> mixer_rt::Wrench {
        self.rotors(self.airframe.reference_v()).px4()
    }

    /// Wrench that one unit of ArduPilot's inputs asks for at the highest voltage of the range, as
    /// there with `MOT_BAT_VOLT_MAX` set to it: `ARDUPILOT_SCALE` of the generated module.
    pub fn ardupilot_scale(&self) -> mixer_rt::Wrench {
        self.rotors(self.highest_v()).ardupilot()
    }

    /// What ArduPilot multiplies roll, pitch and yaw by for each motor, 0.5 at most, by channel: its
    /// frame of the same geometry has these factors.
    pub fn ardupilot_factors(&self) -> Vec<[f64; 3]> {
        self.rotors(self.airframe.reference_v()).ardupilot_factors()
    }

    /// The highest voltage of the range, V; 0 where the airframe has no correction.
    pub fn highest_v(&self) -> f64 {
        let voltage = self.airframe.voltage.as_ref();
        voltage.map_or(0.0, |voltage| voltage.range_v[1])
    }

    /// Thrust (N) and torque (N m) of one rotor per unit of its share of the largest thrust, as
    /// flight stacks take it, at the reference voltage. The torque is that of its slope in hover
    /// where the mass is known, else half of the pair's largest.
    pub fn per_rotor(&self) -> [f64; 2] {
        self.rotors(self.airframe.reference_v()).per_rotor()
    }

    /// Throttle of all rotors alike that carries the weight at the reference voltage; `None` without
    /// `[vehicle] mass_kg`, or where none does.
    pub fn equal_hover_throttle(&self) -> Option<f64> {
        self.rotors(self.airframe.reference_v()).hover_throttle()
    }

    fn rotors(&self, voltage_v: f64) -> scale::Rotors<'_> {
        scale::Rotors {
            airframe: &self.airframe,
            effectiveness: &self.effectiveness,
            pair: &self.pair,
            voltage_v,
        }
    }

    /// The generated Rust as tokens: one module.
    pub fn tokens(&self) -> TokenStream {
        emit::module(self)
    }

    /// The generated Rust, formatted.
    #[cfg(feature = "format")]
    pub fn rust(&self) -> String {
        match syn::parse2(self.tokens()) {
            Ok(file) => format!("{GENERATED}{}", prettyplease::unparse(&file)),
            // Unformatted Rust is still Rust; the tests keep this from happening.
            Err(_) => self.tokens().to_string(),
        }
    }
}
