//! The static comparison of the paper's section V-A: yaw commands over the available range at
//! constant total thrust, through the compiled mixer and through the conventional one, and what
//! each unit then really gives.

use mixer_compiler::airframe::Axis;
use mixer_rt::Wrench;

use crate::report::authority;
use crate::report::number::fixed;
use crate::report::study::Study;
use isolated_rotors::IsolatedTables;

/// What one mixer makes of one yaw command.
#[derive(Clone, Debug, PartialEq)]
pub struct YawResponse {
    /// Throttles `[u, l]` of every unit.
    pub throttles: Vec<[f64; 2]>,
    /// Thrust and torque `[f (N), Q (N m)]` that these throttles give by the unit's map, per unit.
    pub efforts: Vec<[f64; 2]>,
    /// The wrench of all units: roll, pitch, yaw (N m), thrust (N).
    pub wrench: [f64; 4],
    /// False where a throttle was limited or the request was cut.
    pub within: bool,
}

/// One yaw command.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Yaw asked, N m.
    pub yaw_nm: f64,
    /// The compiled mixer.
    pub coaxial: YawResponse,
    /// The conventional mixer.
    pub conventional: YawResponse,
}

/// The whole sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The compiled mixer and the conventional one in a word: `coaxial` where a unit is a pair.
    pub names: [&'static str; 2],
    /// Total thrust asked, N.
    pub thrust_n: f64,
    /// Thrust of each unit in the least-norm efforts for that thrust alone, N: T / n on vertical
    /// axes alike.
    pub share_n: Vec<f64>,
    /// Torque per thrust that the conventional mixer assumes, m.
    pub kappa_m: f64,
    /// By ascending yaw.
    pub rows: Vec<Row>,
}

/// A unit's efforts to the digits of the table.
pub(super) fn rounded([f, q]: [f64; 2]) -> [String; 2] {
    [fixed(f, 2), fixed(q, 3)]
}

impl Comparison {
    /// `count` yaw commands from the least to the largest that the compiled mixer delivers at the
    /// study's thrust; `None` where the airframe does not serve yaw, or the thrust leaves no room
    /// for any.
    pub fn sweep(study: &Study<'_>, count: usize) -> Option<Self> {
        if !study.serves(Axis::Yaw) {
            return None;
        }
        let [low, high] =
            authority::at(study, &study.reference(), study.thrust_n).torque_nm[Axis::Yaw as usize];
        if low.is_nan() || low >= high || count < 2 {
            return None;
        }
        let conventional = IsolatedTables::new(study.compiled);
        let m_plus = &study.compiled.effectiveness.pseudo_inverse;
        let share = |unit: usize| m_plus[(unit, Axis::Thrust as usize)] * study.thrust_n;
        let rows = (0..count)
            .map(|k| {
                // From both ends, so that a symmetric range has its zero exactly.
                let share = k as f64 / (count - 1) as f64;
                let yaw_nm = low * (1.0 - share) + high * share;
                let wrench = [0.0, 0.0, yaw_nm, study.thrust_n];
                Row {
                    yaw_nm,
                    coaxial: answer(study, study.mix(wrench, &study.reference())),
                    conventional: answer(study, throttles(study, &conventional, wrench)),
                }
            })
            .collect();
        let is_coaxial = !study.compiled.airframe.pairs.is_empty();
        Some(Comparison {
            names: [if is_coaxial { "coaxial" } else { "this" }, "conventional"],
            thrust_n: study.thrust_n,
            share_n: (0..study.compiled.airframe.units.len()).map(share).collect(),
            kappa_m: conventional.kappa_m,
            rows,
        })
    }
}

impl Comparison {
    /// Units by what both mixers make of them: those that always give the same as one another, to the digits of the table,
    /// share their columns and curves.
    pub(super) fn alike(&self) -> Vec<Vec<usize>> {
        let same = |a: usize, b: usize| {
            self.rows.iter().all(|row| {
                [&row.coaxial, &row.conventional].into_iter().all(|answer| {
                    let [a, b] = [answer.efforts[a], answer.efforts[b]].map(rounded);
                    a == b
                })
            })
        };
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for unit in 0..self.share_n.len() {
            match groups.iter_mut().find(|group| same(group[0], unit)) {
                Some(group) => group.push(unit),
                None => groups.push(vec![unit]),
            }
        }
        groups
    }
}

/// Throttles by output of the conventional mixer at the reference voltage, and whether
/// none was limited.
pub fn throttles(study: &Study<'_>, conventional: &IsolatedTables, wrench: [f64; 4]) -> (Vec<f32>, bool) {
    let reference_v = study.compiled.airframe.reference_v() as f32;
    let setpoint = Wrench::from_array(wrench.map(|x| x as f32));
    // A study's wrenches are finite.
    conventional
        .conventional(&setpoint, reference_v)
        .unwrap_or_default()
}

fn answer(study: &Study<'_>, (channels, within): (Vec<f32>, bool)) -> YawResponse {
    let throttles = study.by_unit(&channels);
    let efforts: Vec<[f64; 2]> = study.efforts_of(&throttles);
    YawResponse {
        wrench: study.wrench(&efforts),
        throttles,
        efforts,
        within,
    }
}
