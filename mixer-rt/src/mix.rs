//! From setpoint and conditions to throttles and the achieved wrench.

use crate::allocate::allocate;
use crate::allocate::closed_form::{AllocationMethod, Asked, Attained, ClosedForm, Efforts};
use crate::allocate::power_bias::add_power_bias;
use crate::allocate::priorities::{REQUEST_LIMIT, is_bounded, limited};
use crate::allocate::unit::UnitState;
use crate::conditions::{Conditions, Correction};
use crate::layout::Tables;
use crate::pair::rotors::Rotors;
use crate::pair::{Inverse, Kinds, PairKind};
use crate::{Axis, Health, Saturation, SetpointError, Wrench};
use crate::{divided, rolled};

/// What a mix gives.
///
/// ```
/// # use mixer_rt::Mix;
/// /// Commands of a speed controller that takes pulses of 1000 to 2000 microseconds.
/// fn pulses_us(mix: &Mix<8>) -> [u16; 8] {
///     mix.throttle.map(|throttle| (1000.0 + 1000.0 * throttle) as u16)
/// }
/// assert_eq!(pulses_us(&Mix::default()), [1000; 8]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Mix<const CHANNELS: usize> {
    /// Throttle per output channel, each within the airframe's range; 0 for a failed rotor.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub throttle: [f32; CHANNELS],
    /// The wrench that these throttles give, by the airframe's model under the given conditions.
    pub achieved: Wrench,
    /// What could not be delivered.
    pub saturation: Saturation,
}

/// All rotors off, nothing achieved: what firmware holds before its first mix.
impl<const CHANNELS: usize> Default for Mix<CHANNELS> {
    #[inline]
    fn default() -> Self {
        Mix {
            throttle: [0.0; CHANNELS],
            achieved: Wrench::default(),
            saturation: Saturation::NONE,
        }
    }
}

impl<const CHANNELS: usize> Mix<CHANNELS> {
    /// The part of `setpoint` that was not delivered, per axis; zero where the axis is not flagged.
    /// An anti-windup that works by amount takes this (PX4: `unallocated_torque`), one that works
    /// by direction takes [`Mix::saturation`].
    ///
    /// ```
    /// # use mixer_rt::{Mix, Saturation, Wrench};
    /// let setpoint = Wrench { roll_nm: 1.0, yaw_nm: 0.5, ..Wrench::default() };
    /// let mut mix = Mix::<8>::default();
    /// mix.achieved = Wrench { roll_nm: 0.9999, yaw_nm: 0.2, ..Wrench::default() };
    /// mix.saturation = Saturation::from_bits(1 << 4);
    /// assert_eq!(mix.unallocated(&setpoint).to_array(), [0.0, 0.0, 0.3, 0.0]);
    /// ```
    #[inline]
    #[must_use]
    pub fn unallocated(&self, setpoint: &Wrench) -> Wrench {
        let (asked, given) = (setpoint.to_array(), self.achieved.to_array());
        Wrench::from_array(Axis::ALL.map(|axis| {
            if self.saturation.is_flagged(axis) {
                asked[axis as usize] - given[axis as usize]
            } else {
                0.0
            }
        }))
    }
}

/// Mixes for an airframe of n units: `CHANNELS` = 2 n rotors, `UNITS` = n. The rotors that `health`
/// names are out: the others give what can be given, and the achieved wrench tells how much. Any
/// finite setpoint is mixed; what conditions are outside the airframe's ranges is said at
/// [`Conditions`]. Links the interior point method for every frame unless `health` is the constant
/// [`Health::GOOD`].
///
/// # Errors
/// A setpoint or voltage that is infinite or NaN: see [`SetpointError`].
#[inline(always)]
pub fn mix<const UNITS: usize, const CHANNELS: usize, K: Kinds, S: AllocationMethod>(
    tables: &Tables<'_, K, S>,
    setpoint: &Wrench,
    conditions: Conditions,
    health: Health,
) -> Result<Mix<CHANNELS>, SetpointError> {
    let mut throttle = [tables.throttle.min; CHANNELS];
    let states = || [UnitState::default(); UNITS];
    let (achieved, saturation) = mix_into(
        tables,
        setpoint,
        conditions,
        health,
        states,
        &mut by_channel(&mut throttle),
    )?;
    Ok(Mix {
        throttle,
        achieved,
        saturation,
    })
}

/// [`mix`] into buffers, for layouts whose size is known only at run time: `states` makes one element
/// per unit where the closed form does not serve, `take` what each unit is given. Units or channels beyond a buffer's end are
/// left out.
///
/// # Errors
/// As [`mix`]; nothing is taken then.
#[inline(always)]
pub fn mix_into<K: Kinds, S: AllocationMethod, W: AsMut<[UnitState]>>(
    tables: &Tables<'_, K, S>,
    setpoint: &Wrench,
    conditions: Conditions,
    health: Health,
    states: impl FnOnce() -> W,
    take: &mut impl Take,
) -> Result<(Wrench, Saturation), SetpointError> {
    match mix_in_closed_form(tables, setpoint, conditions, health, take) {
        Some(mixed) => mixed,
        None => mix_in_general(tables, setpoint, conditions, health, states().as_mut(), take),
    }
}

/// Takes what a mix gives a unit, by index: its channels, the rotors that turn, its throttles `[u, l]` and their thrust, N at
/// the reference voltage. A unit may come again, as a request is cut; the last time counts.
pub trait Take: FnMut(usize, [u8; 2], Rotors, [f32; 2], f32) {}

impl<T: FnMut(usize, [u8; 2], Rotors, [f32; 2], f32)> Take for T {}

/// Takes throttles by channel.
#[inline(always)]
pub fn by_channel(outputs: &mut [f32]) -> impl Take {
    |_, channels, _, throttles, _| {
        for (channel, value) in channels.iter().zip(throttles) {
            if let Some(slot) = outputs.get_mut(usize::from(*channel)) {
                *slot = value;
            }
        }
    }
}

/// An achieved wrench and what was not delivered.
type Mixed = Result<(Wrench, Saturation), SetpointError>;

/// [`mix_into`] without a closed form, or with rotors out.
#[inline(always)]
fn mix_in_general<K: Kinds, S: AllocationMethod>(
    tables: &Tables<'_, K, S>,
    setpoint: &Wrench,
    conditions: Conditions,
    health: Health,
    states: &mut [UnitState],
    take: &mut impl Take,
) -> Mixed {
    let (request, bounded) = bounded(setpoint)?;
    let Correction { factors, clamped } =
        Correction::at(tables.voltage.as_ref(), tables.air.as_ref(), conditions)?;
    let units = tables.units.get(..states.len()).unwrap_or(tables.units);
    let states = states.get_mut(..units.len()).unwrap_or_default();
    // With a closed form, rotors are out. So the compiler leaves out what only whole frames need.
    let mut is_whole = tables.closed_form.closed_form().is_none();
    for (index, (unit, state)) in units.iter().zip(states.iter_mut()).enumerate() {
        state.rotors = Rotors::of(unit.channels, health);
        is_whole &= state.rotors.are_both();
        if tables.is_single(index) {
            state.rotors = state.rotors.without_lower();
        }
    }
    let is_least_norm = if tables.is_vertical {
        allocate::<_, _, true>(tables, &bounded, factors, states, is_whole)
    } else {
        allocate::<_, _, false>(tables, &bounded, factors, states, is_whole)
    };
    if is_least_norm && tables.power_bias_nm_per_n != 0.0 {
        add_power_bias(tables, &bounded, factors, states);
    }
    let mut achieved = [0.0; 4];
    for (index, (unit, state)) in rolled(units.iter().zip(states).enumerate()) {
        take(
            index,
            unit.channels,
            state.rotors,
            state.throttles,
            state.efforts[0],
        );
        unit.add_wrench(state.efforts, factors, &mut achieved);
    }
    let saturation = Saturation::between(&request, &achieved, &tables.tolerance.wrench);
    Ok((Wrench::from_array(achieved), saturation.with(clamped)))
}

/// [`mix_into`] in closed form; `None` where there is none, or a rotor is out.
#[inline(always)]
fn mix_in_closed_form<K: Kinds, S: AllocationMethod>(
    tables: &Tables<'_, K, S>,
    setpoint: &Wrench,
    conditions: Conditions,
    health: Health,
    take: &mut impl Take,
) -> Option<Mixed> {
    let is_good = health.is_good_below(2 * tables.units.len());
    let closed_form = tables.closed_form.closed_form().filter(|_| is_good)?;
    let kind = tables.kinds.pair(0)?;
    Some(mix_by(closed_form, kind, tables, setpoint, conditions, take))
}

/// Mixes in closed form, with all rotors. Efforts next to the border ([`Attained::Perhaps`])
/// are tried: where the inverse map misses them, the request is desaturated and inverted again. All
/// other efforts are attainable, so by the compiler's proof each unit gives them within the
/// tolerance.
#[inline(always)]
fn mix_by<K: Kinds, S>(
    closed_form: &ClosedForm<'_>,
    kind: &PairKind<K::Quantity, K::Inverse>,
    tables: &Tables<'_, K, S>,
    setpoint: &Wrench,
    conditions: Conditions,
    take: &mut impl Take,
) -> Mixed {
    let (request, bounded) = bounded(setpoint)?;
    let Correction { factors, clamped } =
        Correction::at(tables.voltage.as_ref(), tables.air.as_ref(), conditions)?;
    // Factors are positive, which the compiler has proven for all conditions within the ranges.
    let per_factor = factors.map(|factor| divided(1.0, factor));
    let at_reference = at_reference(bounded, per_factor);
    let airmode = tables.priorities.airmode;
    let reserve = tables.priorities.yaw_reserve_nm;
    let desaturate = |efforts: &mut Efforts| {
        if reserve > 0.0 {
            closed_form.desaturate::<true>(airmode, &at_reference, reserve * per_factor[1], efforts);
        } else {
            closed_form.desaturate::<false>(airmode, &at_reference, 0.0, efforts);
        }
    };
    let mut efforts = Efforts::default();
    let power_bias = tables.power_bias_nm_per_n;
    let (mut attained, room) = closed_form.least_norm(&at_reference, &mut efforts);
    if attained == Attained::No {
        desaturate(&mut efforts);
    } else if attained == Attained::Yes && power_bias != 0.0 {
        closed_form.add_power_bias(power_bias, room, &mut efforts);
    }
    loop {
        let mut is_near = true;
        for (index, (unit, effort)) in closed_form.units.iter().zip(&mut efforts).enumerate() {
            let wanted = [effort.thrust, effort.torque];
            let throttles = kind.inverse.throttles(&kind.pair, &tables.throttle, wanted);
            [effort.thrust, effort.torque] = kind.pair.efforts(throttles);
            take(index, unit.channels, Rotors::BOTH, throttles, effort.thrust);
            if attained == Attained::Perhaps {
                is_near &= tables.tolerance.allows([effort.thrust, effort.torque], wanted);
            }
        }
        if is_near {
            break;
        }
        attained = Attained::No;
        desaturate(&mut efforts);
    }
    let achieved = closed_form.wrench(&efforts, factors);
    let mut saturation = Saturation::NONE;
    if attained == Attained::No || !closed_form.complete {
        saturation = Saturation::between(&request, &achieved.to_array(), &tables.tolerance.wrench);
    }
    Ok((achieved, saturation.with(clamped)))
}

/// The setpoint as `[roll, pitch, yaw, thrust]`, and the same limited so that no product overflows.
#[inline(always)]
fn bounded(setpoint: &Wrench) -> Result<([f32; 4], [f32; 4]), SetpointError> {
    let request = setpoint.to_array();
    if is_bounded(&request) {
        return Ok((request, request));
    }
    const LIMIT: f32 = REQUEST_LIMIT;
    Ok((request, limited(finite(setpoint)?, LIMIT, LIMIT, [-LIMIT, LIMIT])))
}

/// The setpoint as `[roll, pitch, yaw, thrust]`.
#[inline(always)]
fn finite(setpoint: &Wrench) -> Result<[f32; 4], SetpointError> {
    let request = setpoint.to_array();
    for (value, axis) in request.iter().zip(Axis::ALL) {
        if !value.is_finite() {
            return Err(SetpointError::NonFinite(axis));
        }
    }
    Ok(request)
}

/// `request` at the reference voltage, by `[1 / k_f, 1 / k_Q]`: with vertical axes roll, pitch and
/// thrust come from the thrusts alone and yaw from the torques alone.
#[inline(always)]
fn at_reference([roll, pitch, yaw, thrust]: [f32; 4], [per_thrust, per_torque]: [f32; 2]) -> Asked {
    Asked {
        roll: roll * per_thrust,
        pitch: pitch * per_thrust,
        yaw: yaw * per_torque,
        thrust: thrust * per_thrust,
    }
}

/// Contents of a [`Mix`], for code that is generic over airframes and does not know the number of
/// channels.
///
/// ```
/// # use mixer_rt::{Mix, Outputs};
/// fn is_idle(outputs: &impl Outputs) -> bool {
///     outputs.throttle().iter().all(|&throttle| throttle == 0.0)
/// }
/// assert!(is_idle(&Mix::<8>::default()));
/// ```
pub trait Outputs: Sealed {
    /// [`Mix::throttle`], one per channel.
    fn throttle(&self) -> &[f32];
    /// [`Mix::achieved`].
    fn achieved(&self) -> Wrench;
    /// [`Mix::saturation`].
    fn saturation(&self) -> Saturation;
}

impl<const CHANNELS: usize> Sealed for Mix<CHANNELS> {}

impl<const CHANNELS: usize> Outputs for Mix<CHANNELS> {
    #[inline]
    fn throttle(&self) -> &[f32] {
        &self.throttle
    }

    #[inline]
    fn achieved(&self) -> Wrench {
        self.achieved
    }

    #[inline]
    fn saturation(&self) -> Saturation {
        self.saturation
    }
}

/// Of types that this project makes alone, so that its traits can grow.
pub trait Sealed {}

/// An airframe's mixer as a type, for code that is generic over airframes. The compiler implements
/// it.
///
/// ```
/// # use mixer_rt::{Airframe, Outputs, SetpointError, Wrench};
/// fn largest_throttle<A: Airframe>(setpoint: &Wrench, voltage_v: f32) -> Result<f32, SetpointError> {
///     let mix = A::mix(setpoint, voltage_v)?;
///     Ok(mix.throttle().iter().copied().fold(0.0, f32::max))
/// }
/// ```
pub trait Airframe: Sealed {
    /// The name in the airframe file.
    const NAME: &'static str;
    /// Number of units, pairs and single rotors.
    const UNITS: usize;
    /// Number of output channels, one per rotor.
    const CHANNELS: usize;
    /// Least throttle of a rotor that is not out, the idle, and the largest.
    const THROTTLE: [f32; 2];
    /// Least and highest voltage of the file's range, V; 0 where the voltage is ignored.
    const VOLTAGES: [f32; 2];
    /// Voltage of the bench, V: what to pass before one is measured. 0 where it is ignored.
    const REFERENCE_V: f32;
    /// Density of the bench's air, kg/m^3, likewise.
    const REFERENCE_DENSITY_KG_M3: f32;
    /// The wrench that one unit of a normalised setpoint asks for: see [`Wrench::from_normalised`].
    const SCALE: Wrench;
    /// The same for ArduPilot's inputs.
    const ARDUPILOT_SCALE: Wrench;
    /// Torques of PID sums of 1000 in Betaflight, and the thrust of its full throttle stick.
    const BETAFLIGHT_SCALE: Wrench;
    /// [`Mix`] for the airframe's number of channels.
    type Mix: Outputs;

    /// Throttles of all channels for a setpoint under the present [`Conditions`], or at a battery's
    /// voltage, V, in the bench's air.
    ///
    /// # Errors
    /// A setpoint or voltage that is infinite or NaN: see [`SetpointError`].
    fn mix(setpoint: &Wrench, conditions: impl Into<Conditions>) -> Result<Self::Mix, SetpointError>;

    /// [`mix`](Self::mix) with the rotors out that `health` names.
    ///
    /// # Errors
    /// As [`mix`](Self::mix).
    fn mix_with_health(
        setpoint: &Wrench,
        conditions: impl Into<Conditions>,
        health: Health,
    ) -> Result<Self::Mix, SetpointError>;
}
