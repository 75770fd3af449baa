//! The setpoint and the achieved wrench.

use core::fmt;

/// A wrench in the body frame FRD: what the controller asks for, or what the rotors deliver.
///
/// ```
/// # use mixer_rt::Wrench;
/// let hover = Wrench { thrust_n: 54.0, ..Wrench::default() };
/// assert_eq!(hover.to_array(), [0.0, 0.0, 0.0, 54.0]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Wrench {
    /// Torque about x (forward), N m; positive lowers the right side.
    pub roll_nm: f32,
    /// Torque about y (right), N m; positive raises the nose.
    pub pitch_nm: f32,
    /// Torque about z (down), N m; positive turns clockwise seen from above.
    pub yaw_nm: f32,
    /// Thrust along -z, N; positive upwards.
    pub thrust_n: f32,
}

impl Wrench {
    /// `[roll, pitch, yaw, thrust]`: the order of the paper's u (section II).
    #[inline]
    pub const fn to_array(self) -> [f32; 4] {
        [self.roll_nm, self.pitch_nm, self.yaw_nm, self.thrust_n]
    }

    /// The inverse of [`Wrench::to_array`].
    #[inline]
    pub const fn from_array([roll_nm, pitch_nm, yaw_nm, thrust_n]: [f32; 4]) -> Self {
        Self {
            roll_nm,
            pitch_nm,
            yaw_nm,
            thrust_n,
        }
    }

    /// The wrench of a flight stack's normalised setpoint `[roll, pitch, yaw, thrust]`, torques in
    /// [-1, 1] and thrust in [0, 1], positive as in [`Wrench`]. `scale` is the `SCALE` of the
    /// generated module: thrust 1 is all rotors at full throttle, a torque of 1 what PX4's
    /// normalised effectiveness makes of it on this frame.
    ///
    /// ```
    /// # use mixer_rt::Wrench;
    /// const SCALE: Wrench = Wrench { roll_nm: 22.0, pitch_nm: 22.0, yaw_nm: 1.7, thrust_n: 99.0 };
    /// let hover = Wrench::from_normalised([0.0, 0.5, 0.0, 0.5], &SCALE);
    /// assert_eq!((hover.pitch_nm, hover.thrust_n), (11.0, 49.5));
    /// ```
    #[inline]
    #[must_use]
    pub fn from_normalised([roll, pitch, yaw, thrust]: [f32; 4], scale: &Wrench) -> Self {
        Self {
            roll_nm: roll * scale.roll_nm,
            pitch_nm: pitch * scale.pitch_nm,
            yaw_nm: yaw * scale.yaw_nm,
            thrust_n: thrust * scale.thrust_n,
        }
    }
}

/// An axis of the [`Wrench`].
///
/// ```
/// # use mixer_rt::{Axis, Wrench};
/// let wrench = Wrench { yaw_nm: 0.3, ..Wrench::default() };
/// assert_eq!(wrench.to_array()[Axis::Yaw as usize], 0.3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Axis {
    /// Torque about x.
    Roll,
    /// Torque about y.
    Pitch,
    /// Torque about z.
    Yaw,
    /// Thrust along -z.
    Thrust,
}

impl Axis {
    /// All axes, in the order of [`Wrench::to_array`].
    pub const ALL: [Axis; 4] = [Axis::Roll, Axis::Pitch, Axis::Yaw, Axis::Thrust];

    /// The name used in airframe files, CSV columns and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Axis::Roll => "roll",
            Axis::Pitch => "pitch",
            Axis::Yaw => "yaw",
            Axis::Thrust => "thrust",
        }
    }
}

/// [`Axis::name`].
impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Why a mix was refused. The caller keeps its last outputs or disarms; no throttle is ever made of
/// a NaN.
///
/// ```
/// # use mixer_rt::{Mix, SetpointError};
/// /// The outputs to command: those of the last good mix where there is no new one.
/// fn commanded(new: Result<Mix<8>, SetpointError>, last: &mut Mix<8>) -> [f32; 8] {
///     if let Ok(mix) = new {
///         *last = mix;
///     }
///     last.throttle
/// }
/// assert_eq!(commanded(Err(SetpointError::NonFiniteVoltage), &mut Mix::default()), [0.0; 8]);
/// ```
// Of whole words, as a mix is: copying a `Result` of other parts takes hundreds of instructions on
// a Cortex-M.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
#[repr(align(4))]
pub enum SetpointError {
    /// The setpoint is infinite or NaN on this axis (the first such axis is named).
    NonFinite(Axis),
    /// The voltage is infinite or NaN, and the airframe has a voltage correction.
    NonFiniteVoltage,
}

impl SetpointError {
    /// The status that the C library returns: 1 to 4 for an axis in the order of [`Axis::ALL`], 5 for
    /// the voltage.
    #[inline]
    pub const fn status(self) -> u8 {
        match self {
            SetpointError::NonFinite(axis) => 1 + axis as u8,
            SetpointError::NonFiniteVoltage => 5,
        }
    }
}

impl fmt::Display for SetpointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SetpointError::NonFinite(axis) => {
                write!(f, "the {axis} setpoint is not finite")
            }
            SetpointError::NonFiniteVoltage => f.write_str("the voltage is not finite"),
        }
    }
}

impl core::error::Error for SetpointError {}
