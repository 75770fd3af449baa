//! Bench points beside the model, compared at the voltage at which they were measured.

use crate::report::effort::Effort;
use crate::report::number::significant;
use crate::report::study::Study;

/// One bench point with what the model says.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchPoint {
    /// Index of its file in [`BenchPoints::files`].
    pub file: usize,
    /// Line of the file.
    pub line: u64,
    /// Throttles `[u, l]`.
    pub throttles: [f64; 2],
    /// Thrust (N) and torque (N m) brought to the reference voltage.
    pub measured: [f64; 2],
    /// The model's.
    pub model: [f64; 2],
}

impl BenchPoint {
    /// Model less measured, N or N m.
    pub fn residual(&self, effort: Effort) -> f64 {
        self.model[effort as usize] - self.measured[effort as usize]
    }
}

/// Bench points of one pair.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BenchPoints {
    /// Names of the files.
    pub files: Vec<String>,
    /// The points within the airframe's throttle range.
    pub points: Vec<BenchPoint>,
    /// Points outside of it, where the model is not used: its polynomials all the same.
    pub outside: Vec<BenchPoint>,
    /// Rows that were refused, as `file:line: reason`.
    pub refused: Vec<String>,
    /// Whether the points were brought to the reference voltage.
    pub corrected: bool,
    /// Points that were measured at voltages outside the airframe's range.
    pub outside_voltage: usize,
}

/// Largest misfit of a bench of the airframe's own pair, rms over the model's largest effort, of
/// thrust and of torque. Maps of the pair itself have up to 0.03 and 0.08, those of other pairs 0.1
/// and more of one of them.
const LARGEST_MISFIT: [f64; 2] = [0.06, 0.12];

/// What remains between model and points.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// Root of the mean square of model less measured.
    pub rms: f64,
    /// Largest absolute difference.
    pub largest: f64,
    /// The point that has it.
    pub at: BenchPoint,
    /// Share of the variance that the model explains.
    pub r_squared: f64,
}

impl BenchPoints {
    /// Adds a point of the file that is read now, the next of [`BenchPoints::files`]: throttles
    /// `[u, l]`, measured thrust (N) and torque (N m), and the voltage at which they were measured,
    /// V, where it is known.
    pub fn add(
        &mut self,
        study: &Study<'_>,
        line: u64,
        throttles: [f64; 2],
        measured: [f64; 2],
        voltage_v: Option<f64>,
    ) {
        let (airframe, pair) = (&study.compiled.airframe, &study.pair);
        let [low, high] = pair.range();
        let within = throttles.iter().all(|t| (low - 1e-9..=high + 1e-9).contains(t));
        let k = match (&airframe.voltage, voltage_v) {
            (Some(voltage), Some(volts)) => {
                self.corrected = true;
                let [lowest, highest] = voltage.range;
                if within && !(lowest..=highest).contains(&volts) {
                    self.outside_voltage += 1;
                }
                voltage.factors(volts)
            }
            _ => [1.0, 1.0],
        };
        let lists = [&mut self.outside, &mut self.points];
        lists[usize::from(within)].push(BenchPoint {
            file: self.files.len(),
            line,
            throttles,
            measured: [measured[0] / k[0], measured[1] / k[1]],
            model: pair.efforts(throttles),
        });
    }

    /// Why these files may not be of the airframe's pair; empty where nothing speaks against them.
    pub fn doubts(&self, study: &Study<'_>) -> Vec<String> {
        let airframe = &study.compiled.airframe;
        let scale = study.pair.scale();
        let mut doubts = Vec::new();
        for (effort, largest) in Effort::BOTH.into_iter().zip(LARGEST_MISFIT) {
            let Some(misfit) = self.misfit(effort) else {
                continue;
            };
            let share = misfit.rms / scale[effort as usize];
            if share > largest {
                doubts.push(format!(
                    "the model misses the bench\u{2019}s {} by {} {} rms, {:.0} % of its largest: the bench is of another \
                     pair, or upper and lower are exchanged",
                    effort.word(),
                    significant(misfit.rms, 3),
                    effort.unit(),
                    100.0 * share
                ));
            }
        }
        if let (true, Some(voltage)) = (self.outside_voltage > 0, &airframe.voltage) {
            let [low, high] = voltage.range;
            doubts.push(format!(
                "{} of {} bench points were measured outside the airframe\u{2019}s {low} to {high} V",
                self.outside_voltage,
                self.points.len()
            ));
        }
        doubts
    }

    /// Where a point was read: `line 12`, with the file where there are several.
    pub fn place(&self, point: &BenchPoint) -> String {
        match self.files.get(point.file) {
            Some(file) if self.files.len() > 1 => format!("{file}, line {}", point.line),
            _ => format!("line {}", point.line),
        }
    }

    /// What remains in thrust or in torque; `None` without points.
    pub fn misfit(&self, effort: Effort) -> Option<Misfit> {
        let count = self.points.len() as f64;
        let size = |point: &&BenchPoint| point.residual(effort).abs();
        let at = self.points.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
        let measured = || self.points.iter().map(|point| point.measured[effort as usize]);
        let mean = measured().sum::<f64>() / count;
        let variance: f64 = measured().map(|x| (x - mean) * (x - mean)).sum();
        let residuals = self.points.iter().map(|point| point.residual(effort));
        let squares: f64 = residuals.map(|x| x * x).sum();
        Some(Misfit {
            rms: (squares / count).sqrt(),
            largest: size(&at),
            at: at.clone(),
            r_squared: 1.0 - squares / variance,
        })
    }
}
