//! Two mixers that take every rotor as isolated, on the tables of one frame.
//!
//! ```text
//! thrust of a rotor     F = f(d, 0), the pair's map with the other rotor at rest
//! torque                kappa F against its spin
//! wrench                u = B F with B = [.. M_f,i -/+ kappa M_Q,i ..], 4 x 2n (upper -, lower +)
//! ```
//!
//! so u is linear in the 2n thrusts, and each throttle follows from its rotor's thrust alone.
//! [`IsolatedRotors::conventional`] is the paper's comparison (section V): F = B+ u, every throttle
//! clipped. [`IsolatedRotors::sequential`] desaturates F as PX4 does before it clips.

use mixer_rt::tables::{Airmode, Law, ThrottleRange, sqrt};
use mixer_rt::{Axis, SetpointError, Wrench};

/// One rotor's share of the allocation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IsolatedRotor {
    /// Its row of B+: thrust, N, per `[roll, pitch, yaw, thrust]` asked.
    pub allocation: [f32; 4],
    /// The same row with every column divided by PX4's scale for it: the shares in which
    /// desaturation changes the thrusts of all rotors, the largest of them about 1.
    pub direction: [f32; 4],
}

/// Thrust of a rotor by its throttle d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThrustCurve {
    /// F = (d + shift)2 / per_n - shift2 / per_n, from a d2 + b d with per_n = 1 / a and shift = b
    /// / 2a.
    Parabola {
        /// 1/N.
        per_n: f32,
        /// Of the throttle.
        shift: f32,
    },
    /// F = (((c0 d + c1) d + c2) d + c3) d, N, growing over the range.
    Polynomial([f32; 4]),
}

impl ThrustCurve {
    /// The throttle within `range` at which a rotor has the thrust `thrust_n`, or the nearest end.
    #[inline(always)]
    fn throttle(&self, thrust_n: f32, range: &ThrottleRange) -> f32 {
        match *self {
            ThrustCurve::Parabola { per_n, shift } => {
                let radicand = thrust_n * per_n + shift * shift;
                let root = sqrt(if radicand > 0.0 { radicand } else { 0.0 });
                range.clamp(root - shift)
            }
            ThrustCurve::Polynomial([c0, c1, c2, c3]) => {
                let (mut low, mut high) = (range.min, range.max);
                for _ in 0..HALVINGS {
                    let d = 0.5 * (low + high);
                    if (((c0 * d + c1) * d + c2) * d + c3) * d < thrust_n {
                        low = d;
                    } else {
                        high = d;
                    }
                }
                0.5 * (low + high)
            }
        }
    }
}

/// Halvings of the throttle range: to the last bit of a float.
const HALVINGS: u32 = 24;

/// The tables of a frame of isolated rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IsolatedRotors<'a> {
    /// The rotors by output channel.
    pub rotors: &'a [IsolatedRotor],
    /// The thrust of every rotor.
    pub curve: ThrustCurve,
    /// Least and largest thrust of a rotor, N at the reference voltage.
    pub thrust_n: [f32; 2],
    /// The allowed throttles.
    pub throttle: ThrottleRange,
    /// The voltage correction; its torque factor is not used, since kappa is one number.
    pub voltage: Option<Law<'a>>,
}

/// Rotors with a smaller share than this are left alone by desaturation (PX4: "weak
/// effectiveness").
const WEAK: f32 = 0.2;

/// What yaw may take beyond the largest thrust, as a share of the range (PX4:
/// `MINIMUM_YAW_MARGIN`).
const YAW_MARGIN: f32 = 0.15;

impl IsolatedRotors<'_> {
    /// The paper's conventional mixer: least norm, every throttle clipped. Writes a throttle per
    /// channel; true if none had to be clipped.
    ///
    /// # Errors
    /// A setpoint or voltage that is infinite or NaN; the buffer is then as it was.
    #[inline(always)]
    pub fn conventional(
        &self,
        setpoint: &Wrench,
        voltage_v: f32,
        throttle: &mut [f32],
    ) -> Result<bool, SetpointError> {
        let request = self.at_reference(setpoint, voltage_v)?;
        self.mix(request, throttle);
        Ok(self.throttles(throttle))
    }

    /// Sequential desaturation by the rules of PX4's `ControlAllocationSequentialDesaturation` with
    /// the parameter `MC_AIRMODE` (PX4 1.13 to 1.16), then clipped. As
    /// [`IsolatedRotors::conventional`].
    ///
    /// # Errors
    /// As [`IsolatedRotors::conventional`].
    #[inline(always)]
    pub fn sequential(
        &self,
        airmode: Airmode,
        setpoint: &Wrench,
        voltage_v: f32,
        throttle: &mut [f32],
    ) -> Result<bool, SetpointError> {
        let request = self.at_reference(setpoint, voltage_v)?;
        let [roll, pitch, yaw, thrust] = request;
        let bounds = self.thrust_n;
        match airmode {
            Airmode::Disabled => {
                self.mix([roll, pitch, 0.0, thrust], throttle);
                self.slide(Axis::Thrust, Way::Down, bounds, throttle);
                self.slide(Axis::Roll, Way::Both, bounds, throttle);
                self.slide(Axis::Pitch, Way::Both, bounds, throttle);
                self.add_yaw(yaw, throttle);
            }
            Airmode::RollPitch => {
                self.mix([roll, pitch, 0.0, thrust], throttle);
                self.slide(Axis::Thrust, Way::Both, bounds, throttle);
                self.add_yaw(yaw, throttle);
            }
            Airmode::RollPitchYaw => {
                self.mix(request, throttle);
                self.slide(Axis::Thrust, Way::Both, bounds, throttle);
                self.slide(Axis::Yaw, Way::Both, bounds, throttle);
            }
        }
        Ok(self.throttles(throttle))
    }

    /// The request over k_f.
    #[inline(always)]
    fn at_reference(&self, setpoint: &Wrench, voltage_v: f32) -> Result<[f32; 4], SetpointError> {
        let request = setpoint.to_array();
        for (value, axis) in request.iter().zip(Axis::ALL) {
            if !value.is_finite() {
                return Err(SetpointError::NonFinite(axis));
            }
        }
        let factor = match &self.voltage {
            None => 1.0,
            Some(_) if !voltage_v.is_finite() => return Err(SetpointError::NonFiniteVoltage),
            Some(law) => law.factors(limited(voltage_v, law.range))[0],
        };
        let per_factor = 1.0 / factor;
        Ok(request.map(|value| value * per_factor))
    }

    /// B+ u, N per rotor.
    #[inline(always)]
    fn mix(&self, [roll, pitch, yaw, thrust]: [f32; 4], thrusts: &mut [f32]) {
        for (rotor, value) in self.rotors.iter().zip(thrusts) {
            let [by_roll, by_pitch, by_yaw, by_thrust] = rotor.allocation;
            *value = (by_roll * roll + by_pitch * pitch) + (by_yaw * yaw + by_thrust * thrust);
        }
    }

    /// Yaw last: a margin above the range for it, and what it then takes too much is taken from
    /// thrust.
    #[inline(always)]
    fn add_yaw(&self, yaw: f32, thrusts: &mut [f32]) {
        for (rotor, value) in self.rotors.iter().zip(thrusts.iter_mut()) {
            *value += rotor.allocation[Axis::Yaw as usize] * yaw;
        }
        let [low, high] = self.thrust_n;
        self.slide(
            Axis::Yaw,
            Way::Both,
            [low, high + YAW_MARGIN * (high - low)],
            thrusts,
        );
        self.slide(Axis::Thrust, Way::Down, [low, high], thrusts);
    }

    /// Changes one axis so that the worst excesses on both sides come out equal; then by half of
    /// what is left.
    #[inline(never)]
    fn slide(&self, axis: Axis, way: Way, bounds: [f32; 2], thrusts: &mut [f32]) {
        let first = self.gain(axis, bounds, thrusts);
        if way == Way::Down && first > 0.0 {
            return;
        }
        self.change(axis, first, thrusts);
        let second = self.gain(axis, bounds, thrusts);
        self.change(axis, 0.5 * second, thrusts);
    }

    #[inline(always)]
    fn gain(&self, axis: Axis, bounds: [f32; 2], thrusts: &[f32]) -> f32 {
        let (mut least, mut most) = (0.0, 0.0);
        for (rotor, value) in self.rotors.iter().zip(thrusts) {
            let share = rotor.direction.get(axis as usize).copied().unwrap_or(0.0);
            if share.abs() < WEAK {
                continue;
            }
            let bound = limited(*value, bounds);
            if bound != *value {
                let gain = (bound - value) / share;
                least = if gain < least { gain } else { least };
                most = if gain > most { gain } else { most };
            }
        }
        least + most
    }

    #[inline(always)]
    fn change(&self, axis: Axis, gain: f32, thrusts: &mut [f32]) {
        for (rotor, value) in self.rotors.iter().zip(thrusts) {
            *value += gain * rotor.direction.get(axis as usize).copied().unwrap_or(0.0);
        }
    }

    /// Replaces the thrusts by throttles; true if none was out of range.
    #[inline(always)]
    fn throttles(&self, thrusts: &mut [f32]) -> bool {
        let [low, high] = self.thrust_n;
        let mut within = true;
        for value in thrusts.iter_mut().take(self.rotors.len()) {
            within &= *value >= low && *value <= high;
            *value = self.curve.throttle(*value, &self.throttle);
        }
        within
    }
}

/// `x` within bounds. (`f32::clamp` has a panic path.)
#[inline(always)]
fn limited(x: f32, [low, high]: [f32; 2]) -> f32 {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}

/// Which way desaturation may change an axis.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Down,
    Both,
}
