//! The points of all files together: brought to one voltage, with those that stand out.

use mixer_compiler::airframe::Basis;

use crate::bench::{Bench, Point, mean_voltage};
use crate::fit::basis::ThrottleBox;
use crate::fit::robust::{self, Outlier};
use crate::fit::voltage::Voltage;
use crate::fit::wishes::FitOptions;
use crate::fit::{Design, hundredths};
use crate::refusal::Refusal;
use crate::statistics::{extent, greatest};

/// A point and the file it comes from.
#[derive(Clone, Copy)]
pub(super) struct Placed<'a> {
    pub(super) point: &'a Point,
    pub(super) file: &'a str,
    pub(super) thrust: f64,
    pub(super) torque: f64,
    /// [`Point::cells`], brought to one voltage as both channels are.
    pub(super) cells: [f64; 4],
}

pub(super) fn places(points: &[Placed]) -> Vec<[f64; 2]> {
    points.iter().map(|p| [p.point.u, p.point.l]).collect()
}

pub(super) fn channels(points: &[Placed]) -> [Vec<f64>; 2] {
    [
        points.iter().map(|p| p.thrust).collect(),
        points.iter().map(|p| p.torque).collect(),
    ]
}

/// The points of all benches, brought to the reference voltage where sound exponents allow it.
pub(super) fn at_reference<'a>(
    benches: &[&'a Bench],
    voltage: Option<&Voltage>,
    wishes: &FitOptions,
) -> Result<(Vec<Placed<'a>>, Option<f64>), Refusal> {
    let sound = voltage.and_then(Voltage::exponents);
    let volts = |b: &Bench| mean_voltage(&b.points).and_then(|(mean, all)| all.then_some(mean));
    let means: Vec<f64> = benches.iter().filter_map(|b| volts(b)).collect();
    let all = means.len() == benches.len();
    let [low, high] = extent(means.iter().copied());
    if sound.is_none() && high > 1.03 * low {
        return Err(Refusal::general(
            format!(
                "the files were measured at different voltages ({low:.2} and {high:.2} V), but the exponents that \
                 would bring them together cannot be identified"
            ),
            "files at one voltage, or the same throttles at voltages at least 8 % apart",
        ));
    }
    let reference = wishes
        .reference_v
        .unwrap_or_else(|| hundredths(means.iter().sum::<f64>() / means.len() as f64));
    let exponents = sound.filter(|_| all);
    if let (Some(_), false) = (wishes.voltage_exponent, all) {
        let without = benches.iter().find(|b| volts(b).is_none());
        return Err(Refusal::of(
            without.map_or("", |b| b.file.as_str()),
            "rows without a voltage cannot be brought to the reference by --voltage-exponent",
            "the supply voltage of every row, in a column of its own (--column voltage=HEADER)",
        ));
    }
    let place = |bench: &&'a Bench, point: &'a Point| {
        let at = exponents.map_or(*point, |k| point.at_voltage(point.voltage, reference, k));
        Placed {
            point,
            file: &bench.file,
            thrust: at.thrust,
            torque: at.torque,
            cells: at.cells,
        }
    };
    let rows = benches.iter().flat_map(|b| b.points.iter().map(move |p| (b, p)));
    let points = rows.map(|(bench, point)| place(bench, point)).collect();
    Ok((points, exponents.map(|_| reference)))
}

/// The points that are not marked.
pub(super) fn without<'a>(points: &[Placed<'a>], out: &[bool]) -> Vec<Placed<'a>> {
    let kept = points.iter().zip(out).filter(|(_, out)| !**out);
    kept.map(|(p, _)| *p).collect()
}

/// Which rows stand out of a robust fit of either channel. None if the points do not determine the
/// basis: the reason follows when one is chosen.
pub(super) fn suspects(basis: Basis, points: &[Placed], throttle_box: ThrottleBox) -> Vec<bool> {
    let Ok(design) = Design::new(basis, &places(points), throttle_box) else {
        return vec![false; points.len()];
    };
    let judged = channels(points).map(|y| robust::judge(&design, &y));
    (0..points.len()).map(|i| judged.iter().any(|j| j[i])).collect()
}

/// The suspects that also stand out of the fit of `basis` to the other rows, `clean`.
pub(super) fn confirmed(
    basis: Basis,
    points: &[Placed],
    suspects: &[bool],
    clean: &[Placed],
    throttle_box: ThrottleBox,
) -> Vec<Outlier> {
    let marked = points.iter().zip(suspects).filter(|(_, marked)| **marked);
    let accused: Vec<&Placed> = marked.map(|(p, _)| p).collect();
    let Ok(design) = Design::new(basis, &places(clean), throttle_box) else {
        return Vec::new();
    };
    let [thrust, torque] = channels(clean);
    let against = |y: &[f64], of: fn(&Placed) -> f64| {
        let rows: Vec<_> = accused.iter().map(|p| ([p.point.u, p.point.l], of(p))).collect();
        robust::against_the_others(&design, y, &rows)
    };
    let (of_thrust, of_torque) = (against(&thrust, |p| p.thrust), against(&torque, |p| p.torque));
    let channels = of_thrust.into_iter().zip(of_torque);
    let outliers = accused.iter().zip(channels).map(|(p, (f, q))| Outlier {
        file: p.file.to_string(),
        line: p.point.line,
        u: p.point.u,
        l: p.point.l,
        thrust_residual: f.0,
        thrust_deviations: f.1,
        torque_residual: q.0,
        torque_deviations: q.1,
    });
    let scales = [&thrust, &torque].map(|y| greatest(y));
    let stands_out = |o: &Outlier| {
        robust::stands_out(o.thrust_residual, o.thrust_deviations, scales[0])
            || robust::stands_out(o.torque_residual, o.torque_deviations, scales[1])
    };
    outliers.filter(stands_out).collect()
}
