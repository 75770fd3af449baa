//! What `check` prints and golden reports hold: the compiled airframe in numbers with units.

use std::fmt;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Uncertainty;
use mixer_compiler::diagnostic::rounded_up;
use mixer_compiler::power::LevelPower;
use serde::Serialize;

use crate::cost::Cost;
use crate::hover::Hover;

/// Border points per edge of the throttle box at which the largest efforts are looked for.
const SAMPLES: usize = 64;

/// `cargo mixer check --json`, but for the time taken.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Name of the airframe.
    pub name: String,
    /// Number of coaxial units.
    pub units: usize,
    /// Number of rotors.
    pub rotors: usize,
    /// Name of the evaluator as in `inverse.method`.
    pub evaluator: String,
    /// The evaluator with its parameters.
    pub evaluator_description: String,
    /// Proven bound of one unit's thrust residual at every voltage, N.
    pub proven_thrust_n: f64,
    /// Proven bound of one unit's torque residual at every voltage, N m.
    pub proven_torque_nm: f64,
    /// What else there is to say of the proof.
    pub certificate: CertificateSummary,
    /// Largest thrust residual of one unit that was observed at the reference voltage, N.
    pub observed_thrust_n: f64,
    /// Largest torque residual of one unit that was observed at the reference voltage, N m.
    pub observed_torque_nm: f64,
    /// Efforts at which the residual was observed.
    pub observed_points: usize,
    /// Bytes of the tables.
    pub table_bytes: usize,
    /// Least idle at which the forward map is proven injective.
    pub min_idle: f64,
    /// Proven lower bound of det J over the throttle box, N N m.
    pub least_det_j: f64,
    /// Rank of M over the served axes.
    pub rank: usize,
    /// Condition number of M over the served axes.
    pub condition: f64,
    /// Served axes.
    pub axes: Vec<&'static str>,
    /// Share of the attainable set's area that the sides of the closed form lose; `None` without a
    /// closed form.
    pub attainable_area_lost_in_closed_form: Option<f64>,
    /// Bare thrust `[least, largest]` that is attainable at the reference voltage with no torque,
    /// N.
    pub thrust_range_n: [f32; 2],
    /// How far the model of the pair may be off; null where the file does not say.
    pub uncertainty: Option<UncertaintySummary>,
    /// The vehicle in hover; null where the file has no mass.
    pub hover: Option<Hover>,
    /// The torque per thrust at which units start for the least power, N m per N.
    pub power_bias_nm_per_n: f64,
    /// Electrical power in level flight; null where the file has no power map.
    pub power: Option<LevelPower>,
    /// What a unit with one rotor left is taken to give.
    pub rotor_out: RotorOut,
    /// What it costs on the target.
    pub cost: Cost,
}

/// How far the model of the pair may be from the pair, for people.
pub fn in_words(uncertainty: &Uncertainty) -> String {
    format!(
        "{}: +- {} % of the largest thrust, {} % of the largest torque (one standard deviation)",
        uncertainty.source(),
        uncertainty.thrust_percent,
        uncertainty.torque_percent
    )
}

/// `[pair.uncertainty]` in `cargo mixer check --json`.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct UncertaintySummary {
    /// `measured` or `predicted`.
    pub source: &'static str,
    /// One standard deviation of the thrust, % of full scale.
    pub thrust_percent: f64,
    /// Of the torque, likewise.
    pub torque_percent: f64,
}

impl UncertaintySummary {
    fn new(uncertainty: &Uncertainty) -> Self {
        UncertaintySummary {
            source: uncertainty.source(),
            thrust_percent: uncertainty.thrust_percent,
            torque_percent: uncertainty.torque_percent,
        }
    }
}

/// What a unit with one rotor left is taken to give, by the rotor that is out.
#[derive(Clone, Debug, Serialize)]
pub struct RotorOut {
    /// The upper rotor turns.
    pub lower_out: RotorAloneSource,
    /// The lower rotor turns.
    pub upper_out: RotorAloneSource,
}

/// Where that comes from.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case", tag = "by")]
pub enum RotorAloneSource {
    /// The file's `[pair.lower_out]` or `[pair.upper_out]`.
    Declared,
    /// The pair's polynomials at a throttle of zero of the rotor that is out.
    Extrapolated {
        /// From here, the idle, down to zero.
        from_throttle: f64,
    },
}

impl RotorAloneSource {
    fn new(is_declared: bool, idle: f64) -> Self {
        if is_declared {
            RotorAloneSource::Declared
        } else {
            RotorAloneSource::Extrapolated { from_throttle: idle }
        }
    }

    fn in_words(&self) -> String {
        match self {
            RotorAloneSource::Declared => "as declared in the file".to_owned(),
            RotorAloneSource::Extrapolated { from_throttle } => {
                format!("by the pair's polynomials, extrapolated from {from_throttle:?} to 0")
            }
        }
    }
}

/// The certificate in `cargo mixer check --json`.
#[derive(Clone, Debug, Serialize)]
pub struct CertificateSummary {
    /// Proven bounds at every voltage, `[N, N m]`.
    pub bound: [f64; 2],
    /// Proven bounds at the reference voltage, `[N, N m]`, comparable with the observed residuals.
    pub bound_at_reference: [f64; 2],
    /// Bounds at the reference voltage over observed residuals, of thrust and of torque.
    pub over_observed: [f64; 2],
    /// Share of the tolerance that the bounds leave, the lesser of thrust and torque.
    pub margin: f64,
    /// Cells of the throttle box that the proof took.
    pub cells: usize,
}

impl CertificateSummary {
    fn new(compiled: &Compiled) -> Self {
        let certificate = &compiled.certificate;
        CertificateSummary {
            bound: certificate.stated,
            bound_at_reference: certificate.reference,
            over_observed: certificate.over_observed(&compiled.residual),
            margin: certificate.margin(),
            cells: certificate.cells,
        }
    }
}

impl Summary {
    /// The summary of a compiled airframe.
    pub fn new(compiled: &Compiled) -> Self {
        let airframe = &compiled.airframe;
        Summary {
            name: airframe.name.clone(),
            units: airframe.units.len(),
            rotors: airframe.rotors(),
            evaluator: compiled.evaluator.name().to_owned(),
            evaluator_description: compiled.evaluator.description(),
            proven_thrust_n: compiled.certificate.stated[0],
            proven_torque_nm: compiled.certificate.stated[1],
            certificate: CertificateSummary::new(compiled),
            observed_thrust_n: compiled.residual.efforts[0],
            observed_torque_nm: compiled.residual.efforts[1],
            observed_points: compiled.residual.points,
            table_bytes: compiled.tables.bytes(),
            min_idle: compiled.least_idle,
            least_det_j: compiled.injectivity.least_determinant,
            rank: compiled.effectiveness.rank,
            condition: compiled.effectiveness.condition,
            axes: airframe.allocation.axes.iter().map(|axis| axis.name()).collect(),
            attainable_area_lost_in_closed_form: compiled.lost_between_sides.ok(),
            thrust_range_n: compiled.thrust_range_n,
            uncertainty: compiled
                .airframe
                .pair
                .uncertainty
                .as_ref()
                .map(UncertaintySummary::new),
            hover: Hover::new(compiled),
            power_bias_nm_per_n: airframe.allocation.power_bias_nm_per_n,
            power: LevelPower::new(compiled),
            rotor_out: RotorOut {
                lower_out: RotorAloneSource::new(airframe.pair.lower_out.is_some(), airframe.throttle.min),
                upper_out: RotorAloneSource::new(airframe.pair.upper_out.is_some(), airframe.throttle.min),
            },
            cost: Cost::new(compiled),
        }
    }
}

/// The report of a compiled airframe; its `Display` is the text.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a>(pub &'a Compiled);

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let compiled = self.0;
        let airframe = &compiled.airframe;
        let summary = Summary::new(compiled);
        match airframe.description.as_str() {
            "" => writeln!(f, "{}", airframe.name)?,
            description => writeln!(f, "{}: {description}", airframe.name)?,
        }
        writeln!(
            f,
            "{} coaxial units, {} rotors; FRD, SI units",
            summary.units, summary.rotors
        )?;
        writeln!(f)?;
        self.units(f)?;
        self.matrices(f)?;
        writeln!(
            f,
            "rank            {} of {} served axes ({})",
            summary.rank,
            summary.axes.len(),
            summary.axes.join(", ")
        )?;
        writeln!(f, "condition       {:.4}", summary.condition)?;
        writeln!(f)?;
        self.domain(f, &summary)?;
        self.flight(f, &summary)?;
        self.voltage(f)?;
        let [thrust, torque] = compiled.residual.efforts;
        writeln!(
            f,
            "evaluator       {} ({})",
            summary.evaluator_description, summary.evaluator
        )?;
        writeln!(
            f,
            "tolerance       {:?} N, {:?} N m per unit, at every voltage",
            airframe.inverse.thrust_tolerance_n, airframe.inverse.torque_tolerance_nm
        )?;
        let [proven_f, proven_q] = compiled.certificate.stated.map(rounded_up);
        writeln!(
            f,
            "proven          {proven_f} N, {proven_q} N m at every voltage; {:.1} % of the tolerance left, {} cells",
            100.0 * compiled.certificate.margin(),
            compiled.certificate.cells
        )?;
        writeln!(
            f,
            "residual        {} N, {} N m: largest of {} efforts, f32 tables, reference voltage",
            rounded_up(thrust),
            rounded_up(torque),
            summary.observed_points
        )?;
        let linked = match summary.attainable_area_lost_in_closed_form {
            Some(_) => "; without `mix_with_health` only what the closed form reads is linked",
            None => "",
        };
        writeln!(f, "tables          {} bytes{linked}", summary.table_bytes)
    }
}

impl Report<'_> {
    fn units(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "unit   x (m)    y (m)    z (m)    upper spin  upper channel  lower channel"
        )?;
        for (index, unit) in self.0.airframe.units.iter().enumerate() {
            let [x, y, z] = unit.position_m;
            writeln!(
                f,
                "{index:<4}  {x:>7.4}  {y:>7.4}  {z:>7.4}    {:<10}  {:<13}  {}",
                unit.upper_spin.name(),
                unit.upper_channel,
                unit.lower_channel
            )?;
        }
        writeln!(f)
    }

    fn matrices(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let n = self.0.airframe.units.len();
        let efforts: Vec<String> = (0..n)
            .map(|i| format!("f{i}"))
            .chain((0..n).map(|i| format!("Q{i}")))
            .collect();
        let axes = ["roll", "pitch", "yaw", "thrust"];
        let m = &self.0.effectiveness.matrix;
        writeln!(f, "M: wrench (N m, N m, N m, N) = M efforts (f in N, Q in N m)")?;
        header(f, &efforts)?;
        for (row, axis) in axes.iter().enumerate() {
            line(f, axis, m.row(row).iter())?;
        }
        writeln!(f)?;
        let inverse = &self.0.effectiveness.pseudo_inverse;
        writeln!(f, "M+: least-norm efforts = M+ wrench")?;
        header(f, &axes.map(str::to_owned))?;
        for (row, effort) in efforts.iter().enumerate() {
            line(f, effort, inverse.row(row).iter())?;
        }
        writeln!(f)
    }

    /// The ranges of throttles and efforts, and how desaturation brings requests within them.
    fn domain(&self, f: &mut fmt::Formatter<'_>, summary: &Summary) -> fmt::Result {
        let airframe = &self.0.airframe;
        let tables = &self.0.tables;
        let border = self.0.pair.border(SAMPLES);
        let efforts: Vec<[f64; 2]> = border.into_iter().map(|at| self.0.pair.efforts(at)).collect();
        let extent = |index: usize| {
            let values = efforts.iter().map(|efforts| efforts[index]);
            (
                values.clone().fold(f64::INFINITY, f64::min),
                values.fold(f64::NEG_INFINITY, f64::max),
            )
        };
        let ((f_low, f_high), (q_low, q_high)) = (extent(0), extent(1));
        writeln!(
            f,
            "throttle        {:?} to {:?}",
            airframe.throttle.min, airframe.throttle.max
        )?;
        writeln!(
            f,
            "invertible      proven: det J >= {:.4e} N N m and injective; least idle {}",
            summary.least_det_j, summary.min_idle
        )?;
        writeln!(
            f,
            "attainable set  f {f_low:.3} to {f_high:.3} N, Q {q_low:.4} to {q_high:.4} N m per unit",
        )?;
        match self.0.lost_between_sides {
            Ok(lost) => {
                let cells = tables
                    .closed_form
                    .as_ref()
                    .map_or(0, |table| table.border.cells.len() - 1);
                writeln!(
                    f,
                    "desaturation    in closed form between sides of {cells} cells, which leave out {:.3} % of its area; \
                     rotors out on the throttles",
                    100.0 * lost
                )?;
            }
            Err(reason) => writeln!(
                f,
                "desaturation    on the throttles, over the whole set: no closed form, as {reason}"
            )?,
        }
        let [floor, ceiling] = summary.thrust_range_n;
        writeln!(f, "bare thrust     {floor:.3} to {ceiling:.3} N (no torque)")?;
        if let Some(uncertainty) = &self.0.airframe.pair.uncertainty {
            writeln!(f, "pair            {}", in_words(uncertainty))?;
        }
        Ok(())
    }

    /// Rotors out, hover and power.
    fn flight(&self, f: &mut fmt::Formatter<'_>, summary: &Summary) -> fmt::Result {
        let [lower, upper] =
            [&summary.rotor_out.lower_out, &summary.rotor_out.upper_out].map(RotorAloneSource::in_words);
        if lower == upper {
            writeln!(f, "rotor out       the other one {lower}")?;
        } else {
            writeln!(f, "lower rotor out the upper one {lower}")?;
            writeln!(f, "upper rotor out the lower one {upper}")?;
        }
        if let Some(hover) = &summary.hover {
            write!(f, "{hover}")?;
        }
        if summary.power_bias_nm_per_n != 0.0 {
            writeln!(
                f,
                "least power     torques start at {:?} N m per N of thrust; {:.0} % of a pair's saving is left to this frame",
                summary.power_bias_nm_per_n,
                100.0 * self.0.airframe.power_bias_share()
            )?;
        }
        if let Some(power) = &summary.power {
            in_level_flight(f, power)?;
        }
        Ok(())
    }

    fn voltage(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0.airframe.voltage {
            None => writeln!(f, "voltage         no correction"),
            Some(voltage) => {
                let [low, high] = voltage.range_v;
                writeln!(
                    f,
                    "voltage         {low:?} to {high:?} V, reference {:?} V; k_f {:.4} to {:.4}, k_Q {:.4} to {:.4}",
                    voltage.reference_v,
                    voltage.thrust_factor(low),
                    voltage.thrust_factor(high),
                    voltage.torque_factor(low),
                    voltage.torque_factor(high)
                )
            }
        }
    }
}

fn header(f: &mut fmt::Formatter<'_>, columns: &[String]) -> fmt::Result {
    write!(f, "{:8}", "")?;
    for column in columns {
        write!(f, "{column:>9}")?;
    }
    writeln!(f)
}

fn line<'a>(f: &mut fmt::Formatter<'_>, name: &str, values: impl Iterator<Item = &'a f64>) -> fmt::Result {
    write!(f, "{name:<8}")?;
    for value in values {
        write!(f, "{value:>9.4}")?;
    }
    writeln!(f)
}

fn in_level_flight(f: &mut fmt::Formatter<'_>, power: &LevelPower) -> fmt::Result {
    let LevelPower {
        thrust_n,
        power_w,
        without_bias_w,
        saving_percent,
        flight_time_percent,
        is_hover,
    } = power;
    let what = if *is_hover {
        "in hover"
    } else {
        "half of the largest bare thrust"
    };
    write!(f, "power           {power_w:.1} W at {thrust_n:.2} N ({what})")?;
    if power_w == without_bias_w {
        return writeln!(f, "; no power bias");
    }
    writeln!(
        f,
        ", {without_bias_w:.1} W at Q = 0: saves {saving_percent:.2} %, flight time {flight_time_percent:+.2} %"
    )
}
