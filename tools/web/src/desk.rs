//! The airframe on the desk: what `check`, `report`, `params`, `expand` and `golden` give of it.

use cargo_mixer::bench_args::pwm_range;
use cargo_mixer::commands::report::{bench_points, sha256};
use isolated_rotors::IsolatedTables;
use mixer_compiler::airframe::Axis;
use mixer_compiler::diagnostic::Record;
use mixer_compiler::hover::HoverAt;
use mixer_compiler::power::LevelPower;
use mixer_compiler::{Compiled, Source};
use mixer_facts::hover::Hover;
use mixer_files::golden;
use mixer_files::params::Stack;
use mixer_files::params::{Options, params};
use mixer_files::report::bench::BenchPoints;
use mixer_files::report::page;
use mixer_files::report::study::Study;
use mixer_identify::identified::Settings;
use serde::Serialize;

use crate::make::Files;

/// An airframe that compiled.
pub struct Checked {
    /// What came of it.
    pub compiled: Compiled,
    /// The mixer that takes its rotors for isolated.
    pub isolated: IsolatedTables,
}

/// What came of an airframe file.
#[derive(Debug, Default, Serialize)]
pub struct Outcome {
    /// Why it does not compile.
    pub errors: Vec<Record>,
    /// What is probably a mistake in it.
    pub warnings: Vec<Record>,
    /// The verdict of `cargo mixer check`; empty where it does not compile.
    pub verdict: String,
    /// The airframe's name, likewise.
    pub name: String,
    /// What a builder looks at first, likewise.
    pub numbers: Option<Numbers>,
}

/// Whether a vehicle flies well, in few numbers at the reference voltage. Those of hover are `None` without a mass,
/// and where the weight is not carried.
#[derive(Debug, Serialize)]
pub struct Numbers {
    /// Voltage, V; `None` where it has no effect.
    pub volts: Option<f64>,
    /// Layers of rotors, each with its least and greatest throttle in hover; empty without hover.
    pub hover: Vec<(&'static str, [f64; 2])>,
    /// Throttles at which this airframe gives a usual share of its largest bare thrust.
    pub usual_hover: Option<[f64; 2]>,
    /// Largest bare thrust over weight.
    pub over_weight: Option<f64>,
    /// Yaw left in hover in its weaker sense, N m.
    pub yaw_nm: Option<f64>,
    /// The same over the roll that is left.
    pub yaw_over_roll: Option<f64>,
    /// Electrical power of all rotors, W.
    pub power_w: Option<f64>,
}

/// Shares of the largest bare thrust at which frames hover, as the warning MIX342 has them.
const USUAL: [f64; 2] = [0.3, 0.6];

impl Numbers {
    fn new(compiled: &Compiled) -> Self {
        let hover = Hover::new(compiled);
        let volts = compiled
            .airframe
            .voltage
            .as_ref()
            .map(|voltage| voltage.reference);
        let ceiling = f64::from(compiled.thrust_range_n[1]);
        let throttles =
            |hover: &HoverAt| -> Vec<_> { hover.layers.iter().map(|of| (of.layer, of.throttle)).collect() };
        let usual = USUAL.map(|share| throttles(&HoverAt::new(compiled, share * ceiling, volts)));
        let [least, most] = &usual;
        let usual = (!least.is_empty() && !most.is_empty()).then(|| {
            let least = least
                .iter()
                .map(|(_, ends)| ends[0])
                .fold(f64::INFINITY, f64::min);
            [least, most.iter().map(|(_, ends)| ends[1]).fold(0.0, f64::max)]
        });
        let at = hover.as_ref().and_then(|hover| hover.at.last());
        let left = |axis: Axis| {
            let mut margins = at?.margins.iter();
            let margin = margins.find(|margin| margin.axis == axis.name())?;
            let [least, most] = margin.torque_nm;
            Some(most.min(-least))
        };
        let (roll_nm, yaw_nm) = (left(Axis::Roll), left(Axis::Yaw));
        Numbers {
            volts,
            hover: at.map_or_else(Vec::new, throttles),
            usual_hover: usual,
            over_weight: hover.as_ref().map(|hover| hover.thrust_over_weight),
            yaw_nm,
            yaw_over_roll: yaw_nm
                .zip(roll_nm)
                .map(|(yaw, roll)| yaw / roll)
                .filter(|share| share.is_finite()),
            power_w: hover.and(LevelPower::new(compiled)).map(|level| level.power_w),
        }
    }
}

/// Compiles an airframe file.
pub fn check(name: &str, text: &str) -> (Option<Checked>, Outcome) {
    match mixer_facts::check(&Source::new(name, text)) {
        Ok(checked) => {
            let outcome = Outcome {
                warnings: checked.warnings.records(),
                verdict: checked.verdict(),
                name: checked.compiled.airframe.name.clone(),
                numbers: Some(Numbers::new(&checked.compiled)),
                ..Outcome::default()
            };
            let isolated = IsolatedTables::new(&checked.compiled);
            let compiled = checked.compiled;
            (Some(Checked { compiled, isolated }), outcome)
        }
        Err(faults) => {
            let outcome = Outcome {
                errors: faults.records(),
                ..Outcome::default()
            };
            (None, outcome)
        }
    }
}

/// A report to be shown.
#[derive(Debug, Serialize)]
pub struct Report {
    /// The markup of the page's body.
    pub body: String,
    /// What its script needs, JSON.
    pub model: String,
    /// Why the bench files are not shown; empty where they are.
    pub refused: String,
}

/// A file to save.
#[derive(Debug, Serialize)]
pub struct Output {
    /// Its name.
    pub name: String,
    /// Its content.
    pub text: String,
    /// What its user has to know.
    pub notes: Vec<String>,
}

impl Checked {
    /// The report with bench files of the pair, read as `identify` read them, as markup to show.
    pub fn report(&self, bench: &Files) -> Report {
        self.draw(bench, |study, bench, digest, refused| {
            let page::Content { body, model } = page::content(study, bench, digest);
            Report { body, model, refused }
        })
    }

    /// The same as a whole page, as `cargo mixer report` writes it.
    pub fn page(&self, bench: &Files) -> String {
        self.draw(bench, |study, bench, digest, _| page::page(study, bench, digest))
    }

    fn draw<T>(
        &self,
        bench: &Files,
        draw: impl FnOnce(&Study<'_>, Option<&BenchPoints>, Option<&str>, String) -> T,
    ) -> T {
        let texts = bench.texts();
        let study = Study::new(&self.compiled, None);
        let shown = match texts.as_slice() {
            [] => Ok(None),
            texts => bench_points(&study, texts, Settings::default()).map(Some),
        };
        let (bench, refused) = match shown {
            Ok(bench) => (bench, String::new()),
            Err(refused) => (None, refused),
        };
        let digest = sha256(self.compiled.source.text.as_bytes());
        draw(&study, bench.as_ref(), Some(&digest), refused)
    }

    /// A file: `px4`, `ardupilot` or `betaflight`, parameters for this mixer, with `-own` those for the stack's own;
    /// `rs`, `report.txt`, `vectors.csv` or `rotors-out.csv`, a golden output. `pulses` are pulse widths
    /// of throttle 0 and 1, as `1000,2000`, or empty.
    ///
    /// # Errors
    /// Parameters that cannot be, and a word that is none of these.
    pub fn output(&self, what: &str, pulses: &str) -> Result<Output, String> {
        let file = self.compiled.source.file_name();
        let name = &self.compiled.airframe.name;
        let (stack, own) = match what.strip_suffix("-own") {
            Some(stack) => (stack, true),
            None => (what, false),
        };
        if let Some(&(stack, ..)) = Stack::ALL.iter().find(|(_, word, _)| *word == stack) {
            let pulses_us = match pulses.trim() {
                "" => None,
                given => Some(pwm_range(given)?),
            };
            let options = Options {
                own,
                pulses_us,
                ..Options::of(stack)
            };
            let made = params(&self.compiled, &file, &options)?;
            let ending = ["params", "parm", "txt"][stack as usize];
            return Ok(Output {
                name: format!("{name}{}.{ending}", if own { "-own" } else { "" }),
                text: made.text,
                notes: made.notes,
            });
        }
        let mut outputs = golden::outputs(&self.compiled).into_iter();
        let found = outputs.find(|(file, _)| file.strip_prefix(&format!("{name}.")) == Some(what));
        let (name, text) = found.ok_or_else(|| format!("there is no output {what}"))?;
        Ok(Output {
            name,
            text,
            notes: Vec::new(),
        })
    }
}
