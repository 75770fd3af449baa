//! The compiled coaxial mixer with rotors under way.

use core::cell::UnsafeCell;

use mixer_rt::{Health, RotorState, SetpointError, Wrench};

use super::airframe;

/// Throttles, and whether no axis is saturated.
pub(crate) type Mixed = Result<([f32; airframe::CHANNELS], bool), SetpointError>;

/// Time for which throttles are held, s.
const HELD_S: f32 = 0.004;

struct Cell(UnsafeCell<airframe::State>);

// SAFETY: the images have one thread and no interrupt that mixes.
unsafe impl Sync for Cell {}

static STATE: Cell = Cell(UnsafeCell::new(RotorState {
    worth: [0.5; airframe::CHANNELS],
}));

/// All rotors turn.
pub(crate) fn prepare() {
    // SAFETY: nothing else has the cell.
    unsafe { (*STATE.0.get()).worth = [0.5; airframe::CHANNELS] };
}

#[inline(always)]
pub(crate) fn mix(setpoint: &Wrench, voltage_v: f32, _: Health) -> Mixed {
    // SAFETY: as above.
    let state = unsafe { &mut *STATE.0.get() };
    let mix = airframe::mix_dynamic(state, setpoint, voltage_v, HELD_S)?;
    Ok((mix.throttle, !mix.saturation.any_axis()))
}
