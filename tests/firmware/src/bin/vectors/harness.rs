//! Golden vectors on the target. Copy this file, and the `NAME.vectors.rs` that `cargo mixer
//! golden` writes.

use mixer_rt::{Mix, SetpointError, Wrench};

/// How many rows of a table `mix` gives other bits for.
pub(crate) fn differing<const COLUMNS: usize, const CHANNELS: usize>(
    rows: &[[u32; COLUMNS]],
    mix: impl Fn(&Wrench, f32) -> Result<Mix<CHANNELS>, SetpointError>,
) -> usize {
    rows.iter()
        .map(|row| row.as_slice())
        .filter(|row| {
            request(row).is_none_or(|(setpoint, voltage_v)| !agrees(row, &mix(&setpoint, voltage_v)))
        })
        .count()
}

/// The setpoint and the voltage of a row; `None` of a row that is too short.
pub(crate) fn request(row: &[u32]) -> Option<(Wrench, f32)> {
    let (input, _) = row.split_first_chunk::<5>()?;
    let [roll, pitch, yaw, thrust, voltage_v] = input.map(f32::from_bits);
    Some((Wrench::from_array([roll, pitch, yaw, thrust]), voltage_v))
}

/// Whether what a mixer gives has the bits of a row.
pub(crate) fn agrees<const CHANNELS: usize>(
    row: &[u32],
    mixed: &Result<Mix<CHANNELS>, SetpointError>,
) -> bool {
    mixed.as_ref().is_ok_and(|mix| {
        let floats = mix.throttle.into_iter().chain(mix.achieved.to_array());
        let given = floats.map(f32::to_bits).chain([mix.saturation.bits().into()]);
        given.eq(row.iter().skip(5).copied())
    })
}
