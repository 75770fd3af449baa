//! The data of the figures as CSV, with units in the header.

use mixer_compiler::airframe::{Axis, Rotor};

use crate::report::authority;
use crate::report::bench::BenchPoints;
use crate::report::comparison::Comparison;
use crate::report::effort::Effort;
use crate::report::level;
use crate::report::maps::ERROR_SIDE;
use crate::report::number::{cell, line, range};
use crate::report::study::Study;

/// Yaw commands of the comparison; the table shows every third.
pub const YAW_COMMANDS: usize = 25;

/// Thrusts at which authority is found.
pub const THRUSTS: usize = 61;

/// A figure whose data can be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Data {
    /// Places, spins and outputs of the units.
    Layout,
    /// Throttles and power in level flight against thrust.
    Level,
    /// Throttles in hover against voltage.
    Hover,
    /// Yaw sweep at constant thrust.
    Yaw,
    /// Attainable set against voltage.
    Attainable,
    /// Authority against thrust.
    Authority,
    /// Forward maps.
    Forward,
    /// Inverse maps.
    Inverse,
    /// Error of the inverse.
    Error,
}

impl Data {
    /// Every figure in its order, with its word and with what its columns hold.
    #[rustfmt::skip]
    pub const ALL: [(Data, &str, &str); 9] = [
        (Data::Layout, "layout", "Place, spin and output channels of every unit"),
        (Data::Level, "level", "Throttles and power in level flight, against thrust and voltage"),
        (Data::Hover, "hover", "Throttles in hover against voltage; needs [vehicle] and [voltage]"),
        (Data::Yaw, "yaw", "What every unit gives over yaw at constant thrust, by both mixers"),
        (Data::Attainable, "attainable", "Border of a pair's attainable set against voltage"),
        (Data::Authority, "authority", "Largest torque about each served axis against thrust"),
        (Data::Forward, "forward", "Thrust, torque and det J of a pair over both throttles"),
        (Data::Inverse, "inverse", "Throttles over the attainable set, by the emitted tables"),
        (Data::Error, "error", "What the emitted inverse misses over the attainable set"),
    ];

    /// Whether it is of a pair's map.
    pub(crate) fn is_of_pair(self) -> bool {
        use Data::{Attainable, Error, Forward, Inverse};
        matches!(self, Attainable | Forward | Inverse | Error)
    }

    /// Its word on the command line.
    pub(crate) fn word(self) -> &'static str {
        Data::ALL[self as usize].1
    }
}

/// Points per side of the maps.
const SIDE: usize = 31;

/// The data of `figure` as CSV with a header.
///
/// # Errors
/// A yaw sweep of an airframe that does not serve yaw, or at a thrust that leaves no room for it;
/// hover without a mass or without an effect of voltage; maps of a pair where no unit is one.
pub fn sweep(study: &Study<'_>, figure: Data) -> Result<String, String> {
    if figure.is_of_pair() && study.of_pair().is_none() {
        let (name, word) = (&study.compiled.airframe.name, figure.word());
        return Err(format!(
            "no unit of {name} is a pair, whose {word} data these are"
        ));
    }
    let lines = match figure {
        Data::Yaw => yaw(
            study,
            &Comparison::sweep(study, YAW_COMMANDS).ok_or_else(|| no_yaw(study))?,
        ),
        Data::Layout => layout(study),
        Data::Level => level_lines(study),
        Data::Hover => hover(study)?,
        Data::Attainable => attainable(study),
        Data::Authority => authority_lines(study),
        Data::Forward => forward(study),
        Data::Inverse => inverse(study),
        Data::Error => error(study),
    };
    Ok(lines.join("\n") + "\n")
}

pub(crate) fn no_yaw(study: &Study<'_>) -> String {
    let name = &study.compiled.airframe.name;
    if study.serves(Axis::Yaw) {
        let ([floor, ceiling], thrust_n) = (study.compiled.thrust_range_n, study.thrust_n);
        format!(
            "at {thrust_n:?} N {name} has no yaw to sweep; its bare thrust is {floor:.1} to {ceiling:.1} N"
        )
    } else {
        format!("{name} does not serve yaw (allocation.axes)")
    }
}

fn yaw(study: &Study<'_>, comparison: &Comparison) -> Vec<String> {
    let all = &study.compiled.airframe.units;
    let given = "roll_given_nm,pitch_given_nm,yaw_given_nm,thrust_given_n";
    let mut header = format!("mixer,yaw_asked_nm,throttle_limited,{given}");
    for (index, unit) in all.iter().enumerate() {
        for rotor in unit.rotors() {
            header.push_str(&format!(",unit_{index}_{}_throttle", rotor.layer));
        }
        header.push_str(&format!(",unit_{index}_thrust_n,unit_{index}_torque_nm"));
    }
    let mut lines = vec![header];
    for row in &comparison.rows {
        for (mixer, answer) in comparison
            .names
            .into_iter()
            .zip([&row.coaxial, &row.conventional])
        {
            let units = answer.throttles.iter().zip(&answer.efforts).zip(all);
            let units = units.flat_map(|((throttles, efforts), unit)| {
                throttles
                    .iter()
                    .take(unit.rotors().count())
                    .chain(efforts)
                    .copied()
            });
            let values = answer.wrench.into_iter().chain(units);
            let limited = u8::from(!answer.within);
            lines.push(format!("{mixer},{},{limited},{}", cell(row.yaw_nm), line(values)));
        }
    }
    lines
}

fn layout(study: &Study<'_>) -> Vec<String> {
    let mut lines = vec!["unit,x_m,y_m,z_m,layer,spin,channel".to_owned()];
    for (index, unit) in study.compiled.airframe.units.iter().enumerate() {
        let place = line(unit.position_m);
        let of = |rotor: Rotor| {
            format!(
                "{index},{place},{},{},{}",
                rotor.layer,
                rotor.spin.name(),
                rotor.channel
            )
        };
        lines.extend(unit.rotors().map(of));
    }
    lines
}

/// Columns of the layers' throttles.
fn throttles(study: &Study<'_>) -> String {
    let layers = study.compiled.airframe.layers();
    layers.map(|(layer, _)| format!(",{layer}_throttle")).collect()
}

/// Their cells.
fn cells(level: &level::Level) -> String {
    let throttles = level.throttles.iter();
    throttles
        .map(|throttle| format!(",{}", or_empty(*throttle)))
        .collect()
}

/// A number, or nothing where there is none.
fn or_empty(x: f64) -> String {
    if x.is_finite() { cell(x) } else { String::new() }
}

fn level_lines(study: &Study<'_>) -> Vec<String> {
    let mut lines = vec![format!("voltage_v,thrust_n{},power_w", throttles(study))];
    let reference_v = study.compiled.airframe.reference_v();
    for (volts, _) in study.voltages() {
        let text = volts.map_or(String::new(), cell);
        for level in level::against_thrust(study, volts, THRUSTS) {
            let throttles = cells(&level);
            // The file's map of power holds at the reference voltage.
            let holds = volts.is_none_or(|volts| volts == reference_v);
            let power = or_empty(if holds { level.power_w } else { f64::NAN });
            lines.push(format!("{text},{}{throttles},{power}", cell(level.at)));
        }
    }
    lines
}

fn hover(study: &Study<'_>) -> Result<Vec<String>, String> {
    let levels = level::against_voltage(study);
    if levels.is_empty() {
        return Err(format!(
            "{} has no [vehicle] mass_kg or no [voltage]: both are needed for hover against voltage",
            study.compiled.airframe.name
        ));
    }
    let mut lines = vec![format!("voltage_v{}", throttles(study))];
    for level in levels {
        lines.push(format!("{}{}", cell(level.at), cells(&level)));
    }
    Ok(lines)
}

/// One effort of the bench points beside the model's, those outside the throttle range last.
pub(crate) fn bench(bench: &BenchPoints, effort: Effort) -> String {
    let column = ["thrust_n", "torque_nm"][effort as usize];
    let mut csv = format!("file_index,line,upper_throttle,lower_throttle,measured_{column},model_{column}\n");
    for point in bench.points.iter().chain(&bench.outside) {
        let [u, l] = point.throttles;
        let [measured, model] = [point.measured, point.model].map(|efforts| efforts[effort as usize]);
        let values = line([u, l, measured, model]);
        csv.push_str(&format!("{},{},{values}\n", point.file, point.line));
    }
    csv
}

fn attainable(study: &Study<'_>) -> Vec<String> {
    let mut lines = vec!["voltage_v,upper_throttle,lower_throttle,thrust_n,torque_nm".to_owned()];
    for (volts, k) in study.voltages() {
        let volts = volts.map_or(String::new(), cell);
        for [u, l] in study.border() {
            let [f, q] = study.pair.efforts([u, l]);
            lines.push(format!("{volts},{}", line([u, l, f * k[0], q * k[1]])));
        }
    }
    lines
}

fn authority_lines(study: &Study<'_>) -> Vec<String> {
    let axes = study.torque_axes();
    let columns = axes
        .iter()
        .map(|axis| format!(",{0}_least_nm,{0}_largest_nm", axis.name()));
    let mut lines = vec!["thrust_n".to_owned() + &columns.collect::<String>()];
    for at in authority::against_thrust(study, &study.reference(), THRUSTS) {
        let torques = axes.iter().flat_map(|&axis| at.torque_nm[axis as usize]);
        lines.push(line([at.thrust_n].into_iter().chain(torques)));
    }
    lines
}

/// Points `[s, t]` of the unit square, the first coordinate slowest.
fn square(side: usize) -> impl Iterator<Item = [f64; 2]> {
    let share = move |k: usize| k as f64 / (side - 1) as f64;
    (0..side * side).map(move |k| [share(k / side), share(k % side)])
}

fn forward(study: &Study<'_>) -> Vec<String> {
    let mut lines = vec!["upper_throttle,lower_throttle,thrust_n,torque_nm,det_j_n_nm".to_owned()];
    lines.extend(square(SIDE).map(|point| {
        let [u, l] = study.throttles(point);
        let [f, q] = study.pair.efforts([u, l]);
        let [[f_u, f_l], [q_u, q_l]] = study.pair.jacobian([u, l]);
        line([u, l, f, q, f_u * q_l - f_l * q_u])
    }));
    lines
}

fn inverse(study: &Study<'_>) -> Vec<String> {
    let mut lines = vec!["thrust_n,torque_nm,upper_throttle,lower_throttle".to_owned()];
    let border = study.border_efforts();
    let extent = |k: usize| range(border.iter().map(|efforts| efforts[k]));
    let ranges = [extent(0), extent(1)];
    lines.extend(square(SIDE).filter_map(|point| {
        let efforts = [0, 1].map(|k| ranges[k][0] + (ranges[k][1] - ranges[k][0]) * point[k]);
        let [u, l] = study.inverse(efforts)?;
        Some(line([efforts[0], efforts[1], u, l]))
    }));
    lines
}

fn error(study: &Study<'_>) -> Vec<String> {
    let header = "thrust_n,torque_nm,upper_throttle,lower_throttle,thrust_error_n,torque_error_nm";
    let mut lines = vec![header.to_owned()];
    // Every third node of the figure's grid.
    lines.extend(square(ERROR_SIDE / 3 + 1).map(|point| {
        let [u, l] = study.throttles(point);
        let [f, q] = study.pair.efforts([u, l]);
        let [error_f, error_q] = study.error([u, l]);
        line([f, q, u, l, error_f, error_q])
    }));
    lines
}
