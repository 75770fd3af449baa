//! Compiler from an airframe file to the tables of a coaxial multirotor mixer.
//!
//! Text in, tables or diagnostics out; files, the environment and macros are the business of its
//! three front ends: `mixer-macros`, [`build_script`] and `cargo mixer`. [`compile`] shows the
//! pipeline.
//!
//! Versions keep their promise for what is public without the feature `unstable`. With it the project's own packages
//! see the rest, which changes without notice.
#![cfg_attr(not(feature = "unstable"), allow(dead_code, unreachable_pub, unused_imports))]

/// Modules that the feature `unstable` shows.
#[path = "."]
mod modules {
    pub mod airframe;
    pub mod atmosphere;
    pub mod diagnostic;
    pub mod dynamics;
    pub mod flywheel;
    pub mod hover;
    pub mod model;
    pub mod power;
    pub mod quantity;
    pub mod spec;
    pub mod tables;
    pub mod view;
}

mod allocation;
mod bounds;
#[cfg(feature = "format")]
pub mod build_script;
mod compiled;
mod emit;
mod inverse;
mod plausible;
mod probe;
mod proof;
mod scale;
mod selection;

#[cfg(not(feature = "unstable"))]
use modules::*;
#[cfg(feature = "unstable")]
pub use modules::*;

use airframe::{Airframe, Pair};
use allocation::{closed_form, thrust_range};
use dynamics::Dynamics;
use model::PairMap;
use model::effectiveness::Effectiveness;
use model::injectivity::{self, Injectivity};
use model::law::CorrectionTables;
use proc_macro2::TokenStream;
use selection::Selected;
use tables::{MixerTables, Parts};
use view::View;

pub use crate::diagnostic::source::Source;
pub use crate::diagnostic::{Code, Diagnostic, Diagnostics, Record, Severity};
pub use compiled::Compiled;
#[cfg(not(feature = "unstable"))]
use compiled::OfPair;
#[cfg(feature = "unstable")]
pub use {
    bounds::bisected,
    compiled::OfPair,
    inverse::evaluator,
    plausible::{ARDUPILOT_MOST_SPIN_MIN, symmetry},
    proof::{Certificate, residual::Residual},
};

/// Compiles an airframe file: source -> airframe -> model (effectiveness, injectivity, corrections) ->
/// proven inverse -> tables with the closed form -> range of thrust -> probes.
///
/// # Errors
/// All faults that were found, and with faults of later stages the warnings, one of which may be
/// why. Faults of the file itself end the compilation, and so do those of each later stage.
pub fn compile(source: &Source) -> Result<Compiled, Diagnostics> {
    let mut airframe = Airframe::read(source)?;
    airframe.fit_tolerances(&model::scales(&airframe, [1.0; 2]));
    compile_airframe(source, airframe.clone()).map_err(|mut faults| {
        faults.extend(plausible::warnings_of_refused(&airframe));
        Diagnostics::new(source.clone(), faults)
    })
}

fn compile_airframe(source: &Source, airframe: Airframe) -> Result<Compiled, Vec<Diagnostic>> {
    let model = Model::new(airframe)?;
    let views: Vec<_> = model.airframe.pair_views().collect();
    let selected = selection::select(&views, &model.corrections)?;
    let (mut tables, stated, lost_outside_border) = model.tables(&views, &selected);
    let thrust_range_n = thrust_range::thrust_range(&model.airframe, &tables)?;
    thrust_range::check_ends(&model.airframe, &tables, thrust_range_n)?;
    drop(views);
    let of_pairs = model.invertible.into_iter().zip(selected);
    let of_pairs = of_pairs.map(|((injectivity, least_idle), selected)| OfPair {
        injectivity,
        least_idle,
        evaluator: selected.map.inverse.evaluator,
        residual: selected.residual,
        certificate: selected.certificate,
    });
    let dynamics = Dynamics::of(&model.airframe, thrust_range_n[1].into())?;
    tables.lags = dynamics.iter().flatten().map(|of| of.lag).collect();
    let compiled = Compiled {
        source: source.clone(),
        maps: model.maps,
        airframe: model.airframe,
        effectiveness: model.effectiveness,
        of_pairs: of_pairs.collect(),
        thrust_range_n,
        stated,
        lost_outside_border,
        dynamics,
        tables,
    };
    probe::run(&compiled)?;
    Ok(compiled)
}

/// Warnings of a compiled airframe: values that compile and are probably mistakes.
pub fn lint(compiled: &Compiled) -> Diagnostics {
    let mut warnings = plausible::warnings(compiled);
    let of_hover = hover::warnings(compiled, &warnings);
    warnings.extend(of_hover);
    warnings.extend(power::warnings(compiled));
    Diagnostics::new(compiled.source.clone(), warnings)
}

/// The mathematics of an airframe: what is known before an inverse is fitted.
struct Model {
    airframe: Airframe,
    /// The forward map of each unit.
    maps: Vec<PairMap>,
    effectiveness: Effectiveness,
    /// Of each pair the proof that it can be inverted, and the least idle.
    invertible: Vec<(Injectivity, f64)>,
    corrections: CorrectionTables,
}

impl Model {
    fn new(airframe: Airframe) -> Result<Model, Vec<Diagnostic>> {
        let effectiveness = Effectiveness::new(&airframe).and_then(|effectiveness| {
            plausible::check_authority(&airframe, &effectiveness)?;
            Ok(effectiveness)
        });
        let (mut invertible, mut tolerances) = (Ok(Vec::new()), Ok(()));
        for view in airframe.pair_views() {
            let proven = injectivity::prove(&view);
            invertible = gather(invertible, proven, Ok(())).map(|(mut all, proven, ())| {
                all.push(proven);
                all
            });
        }
        for view in airframe.views() {
            tolerances = gather(tolerances, plausible::check_tolerances(&view), Ok(())).map(|_| ());
        }
        let (effectiveness, invertible, ()) = gather(effectiveness, invertible, tolerances)?;
        Ok(Model {
            corrections: CorrectionTables::new(&airframe),
            maps: model::maps(&airframe),
            airframe,
            effectiveness,
            invertible,
        })
    }

    /// The tables, what thrust and torque of a unit may miss, N and N m, and the share of the attainable set's area that the
    /// sides of the closed form lose, or why there is none.
    fn tables(
        &self,
        views: &[View<'_, &Pair>],
        selected: &[Selected],
    ) -> (MixerTables, [f64; 2], Result<f64, &'static str>) {
        let Model {
            airframe,
            effectiveness,
            corrections,
            ..
        } = self;
        let (tolerance, stated) = selection::tolerance(airframe, effectiveness, corrections, views, selected);
        let parts = Parts {
            airframe,
            effectiveness,
            corrections,
            maps: selected.iter().map(|selected| &selected.map).collect(),
            tolerance,
        };
        let (closed_form, lost_outside_border) = match closed_form::table(airframe, effectiveness, &self.maps)
        {
            Ok((table, lost)) => (Some(table), Ok(lost)),
            Err(reason) => (None, Err(reason)),
        };
        let mut tables = MixerTables::new(&parts, closed_form);
        tables.level_n = thrust_range::level(airframe, &tables);
        (tables, stated, lost_outside_border)
    }
}

/// All three values, or the faults of all.
fn gather<A, B, C>(
    a: Result<A, Vec<Diagnostic>>,
    b: Result<B, Vec<Diagnostic>>,
    c: Result<C, Vec<Diagnostic>>,
) -> Result<(A, B, C), Vec<Diagnostic>> {
    match (a, b, c) {
        (Ok(a), Ok(b), Ok(c)) => Ok((a, b, c)),
        (a, b, c) => {
            let faults = [a.err(), b.err(), c.err()];
            Err(faults.into_iter().flatten().flatten().collect())
        }
    }
}

/// The first line of generated Rust: reviews and linters leave out files that have it.
#[cfg(feature = "format")]
const GENERATED: &str = "// @generated from an airframe file by mixer-compiler; do not edit.\n";

impl Compiled {
    pub(crate) fn rotors(&self, voltage_v: f64) -> scale::Rotors<'_> {
        scale::Rotors {
            airframe: &self.airframe,
            effectiveness: &self.effectiveness,
            maps: &self.maps,
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
