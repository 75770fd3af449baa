//! Tables of the mixers that take every rotor of a coaxial frame as isolated: what
//! [`IsolatedRotors`] runs on.
//!
//! Its thrust is the upper rotor's alone, f(d, 0); kappa of its torque is by least squares of |Q(d,
//! 0)| = kappa f(d, 0) over the throttle range. Rotor k of unit i contributes the column M_f,i -/+
//! kappa M_Q,i to the wrench (upper -, lower +: a pair's torque is positive where the lower rotor
//! outweighs the upper), a 4 x 2n matrix B.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::model::effectiveness::Effectiveness;
use mixer_compiler::model::law::LawTable;
use mixer_compiler::model::pseudo_inverse::PseudoInverse;
use mixer_compiler::model::{self, PairMap};
use mixer_compiler::tables;
use mixer_rt::tables::{Airmode, ThrottleRange};
use mixer_rt::{SetpointError, Wrench};
use nalgebra::DMatrix;

use crate::rotors::{IsolatedRotor, IsolatedRotors, ThrustCurve};

/// Throttles at which kappa is fitted.
const POINTS: u32 = 51;

/// Below this a rotor has no share in an axis, N per N m or N.
const NO_SHARE: f64 = 1e-9;

/// The tables of one airframe's isolated rotors.
#[derive(Clone, Debug, PartialEq)]
pub struct IsolatedTables {
    /// The rotors by output channel.
    pub rotors: Vec<IsolatedRotor>,
    /// The thrust of every rotor.
    pub curve: ThrustCurve,
    /// Least and largest thrust of a rotor, N at the reference voltage.
    pub thrust_n: [f32; 2],
    /// The allowed throttles.
    pub throttle: ThrottleRange,
    /// The voltage correction.
    pub voltage: Option<LawTable>,
    /// kappa = Q / f of one rotor, m.
    pub kappa_m: f64,
    /// B, 4 x 2n: `[roll, pitch, yaw, thrust]` per N of the rotor at an output channel. Axes that
    /// are not served are zero.
    pub effectiveness: DMatrix<f64>,
}

impl IsolatedTables {
    /// The tables of a compiled airframe.
    pub fn new(compiled: &Compiled) -> Self {
        let Compiled {
            airframe,
            effectiveness,
            tables,
            ..
        } = compiled;
        IsolatedTables::of(airframe, effectiveness, tables.corrections.voltage.clone())
    }

    /// The tables of `airframe` with effectiveness M.
    pub fn of(airframe: &Airframe, effectiveness: &Effectiveness, voltage: Option<LawTable>) -> Self {
        // Where units differ, all rotors are those of the mean pair.
        let map = model::mean(airframe, &model::maps(airframe));
        let kappa_m = torque_per_thrust(&map);
        let columns = rotor_columns(airframe, effectiveness, kappa_m);
        let allocation = pseudo_inverse(airframe, &columns);
        let scale = desaturation_scale(&allocation);
        let rotors = (0..airframe.rotors()).map(|rotor| {
            let row: [f64; 4] = std::array::from_fn(|axis| allocation[(rotor, axis)]);
            IsolatedRotor {
                allocation: row.map(|share| share as f32),
                direction: std::array::from_fn(|axis| (row[axis] / scale[axis]) as f32),
            }
        });
        let [low, high] = map.range().map(|throttle| map.efforts([throttle, 0.0])[0] as f32);
        IsolatedTables {
            rotors: rotors.collect(),
            curve: curve(&map),
            thrust_n: [low, high],
            throttle: tables::throttle_table(airframe),
            voltage,
            kappa_m,
            effectiveness: columns,
        }
    }

    /// The tables as `mixer-rt` reads them.
    pub fn view(&self) -> IsolatedRotors<'_> {
        IsolatedRotors {
            rotors: &self.rotors,
            curve: self.curve,
            thrust_n: self.thrust_n,
            throttle: self.throttle,
            voltage: self.voltage.as_ref().map(LawTable::view),
        }
    }

    /// Throttle per channel by [`IsolatedRotors::conventional`], and whether none was clipped.
    ///
    /// # Errors
    /// A setpoint or voltage that is infinite or NaN.
    pub fn conventional(&self, setpoint: &Wrench, voltage_v: f32) -> Result<(Vec<f32>, bool), SetpointError> {
        let mut throttle = vec![0.0; self.rotors.len()];
        let within = self.view().conventional(setpoint, voltage_v, &mut throttle)?;
        Ok((throttle, within))
    }

    /// Throttle per channel by [`IsolatedRotors::sequential`], and whether none was clipped.
    ///
    /// # Errors
    /// A setpoint or voltage that is infinite or NaN.
    pub fn sequential(
        &self,
        airmode: Airmode,
        setpoint: &Wrench,
        voltage_v: f32,
    ) -> Result<(Vec<f32>, bool), SetpointError> {
        let mut throttle = vec![0.0; self.rotors.len()];
        let within = self
            .view()
            .sequential(airmode, setpoint, voltage_v, &mut throttle)?;
        Ok((throttle, within))
    }
}

/// kappa of an isolated rotor, m.
fn torque_per_thrust(map: &PairMap) -> f64 {
    let [low, high] = map.range();
    let (mut products, mut squares) = (0.0, 0.0);
    for k in 0..POINTS {
        let throttle = low + (high - low) * f64::from(k) / f64::from(POINTS - 1);
        let [f, q] = map.efforts([throttle, 0.0]);
        products += q.abs() * f;
        squares += f * f;
    }
    products / squares
}

/// B by output channel.
fn rotor_columns(airframe: &Airframe, effectiveness: &Effectiveness, kappa_m: f64) -> DMatrix<f64> {
    let n = airframe.units.len();
    let mut columns = DMatrix::zeros(4, airframe.rotors());
    for (i, unit) in airframe.units.iter().enumerate() {
        for axis in &airframe.allocation.axes {
            let axis = *axis as usize;
            let by_thrust = effectiveness.matrix[(axis, i)];
            let by_torque = kappa_m * effectiveness.matrix[(axis, n + i)];
            // The torque of a single rotor counts positive, that of an upper one negative.
            let last = unit.lower_channel.unwrap_or(unit.upper_channel);
            columns[(axis, unit.upper_channel)] = by_thrust - by_torque;
            columns[(axis, last)] = by_thrust + by_torque;
        }
    }
    columns
}

/// B+, 2n x 4: 0 for axes that are not served.
fn pseudo_inverse(airframe: &Airframe, columns: &DMatrix<f64>) -> DMatrix<f64> {
    let served: Vec<usize> = airframe
        .allocation
        .axes
        .iter()
        .map(|axis| *axis as usize)
        .collect();
    let mut allocation = DMatrix::zeros(columns.ncols(), columns.nrows());
    // The rotors' columns are combinations of those of M, which has full rank.
    if let Ok(inverse) = PseudoInverse::new(&columns.select_rows(&served), &vec![1.0; columns.ncols()]) {
        for (column, axis) in inverse.matrix.column_iter().zip(served) {
            allocation.set_column(axis, &column);
        }
    }
    allocation
}

/// What PX4 divides the columns of B+ by (`updateControlAllocationMatrixScale`): roll and pitch by
/// the larger of their root mean squares times sqrt 2, yaw by its largest share, thrust by its
/// mean. 1 for a column of zeros.
fn desaturation_scale(allocation: &DMatrix<f64>) -> [f64; 4] {
    let column = |axis: usize| -> Vec<f64> {
        let shares = (0..allocation.nrows()).map(|rotor| allocation[(rotor, axis)].abs());
        shares.filter(|share| *share > NO_SHARE).collect()
    };
    let torque = |axis| {
        let shares = column(axis);
        (shares.iter().map(|share| share * share).sum::<f64>() / (0.5 * shares.len() as f64)).sqrt()
    };
    let roll_pitch = [torque(0), torque(1)].into_iter().fold(0.0, f64::max);
    let yaw = column(2).into_iter().fold(0.0, f64::max);
    let shares = column(3);
    let thrust = shares.iter().sum::<f64>() / shares.len() as f64;
    [roll_pitch, roll_pitch, yaw, thrust].map(|scale| if scale > 0.0 { scale } else { 1.0 })
}

/// f(d, 0) from the terms in u alone.
fn curve(map: &PairMap) -> ThrustCurve {
    match map.along(0).map(|[f, _]| f) {
        [0.0, 0.0, a, b] if a > 0.0 => ThrustCurve::Parabola {
            per_n: (1.0 / a) as f32,
            shift: (0.5 * b / a) as f32,
        },
        coefficients => ThrustCurve::Polynomial(coefficients.map(|c| c as f32)),
    }
}
