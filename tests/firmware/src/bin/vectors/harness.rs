//! Golden vectors on the target: rows of the tables that `cargo mixer golden` writes. Copy this
//! file.

use mixer_rt::{Mix, SetpointError, Wrench};

/// What a mixer returns.
type Mixed<const CHANNELS: usize> = Result<Mix<CHANNELS>, SetpointError>;

/// How many rows of `NAME.vectors.csv` `mix` gives other bits for.
#[allow(dead_code)] // The golden image, which counts instructions, goes through the rows itself.
pub(crate) fn differing<const CHANNELS: usize>(
    table: &str,
    mix: impl Fn(&Wrench, f32) -> Mixed<CHANNELS>,
) -> usize {
    let agrees = |row: &&str| {
        request(row).is_some_and(|(setpoint, voltage_v)| agrees(row, &mix(&setpoint, voltage_v)))
    };
    rows(table).filter(|row| !agrees(row)).count()
}

/// How many rows of `NAME.rotors-out.csv` `mix` gives other bits for with the rotor out that it is
/// given.
pub(crate) fn differing_with_rotors_out<const CHANNELS: usize>(
    table: &str,
    mix: impl Fn(&Wrench, f32, u8) -> Mixed<CHANNELS>,
) -> usize {
    let agrees = |row: &&str| {
        let (failed, row) = row.split_once(',')?;
        let (failed, (setpoint, voltage_v)) = (failed.parse().ok()?, request(row)?);
        Some(agrees(row, &mix(&setpoint, voltage_v, failed)))
    };
    rows(table).filter(|row| agrees(row) != Some(true)).count()
}

/// The rows of a table, without its header.
pub(crate) fn rows(table: &str) -> impl Iterator<Item = &str> + Clone {
    table.lines().skip(1)
}

/// The setpoint and the voltage of a row; `None` of a row that has none.
pub(crate) fn request(row: &str) -> Option<(Wrench, f32)> {
    let mut cells = cells(row).map(|cell| cell.map(f32::from_bits));
    let mut next = || cells.next().flatten();
    let wrench = [next()?, next()?, next()?, next()?];
    Some((Wrench::from_array(wrench), next()?))
}

/// Whether what a mixer gives has the bits of a row.
pub(crate) fn agrees<const CHANNELS: usize>(row: &str, mixed: &Mixed<CHANNELS>) -> bool {
    mixed.as_ref().is_ok_and(|mix| {
        let floats = mix.throttle.into_iter().chain(mix.achieved.to_array());
        let given = floats.map(f32::to_bits).chain([mix.saturation.bits().into()]);
        given.map(Some).eq(cells(row).skip(5))
    })
}

/// The numbers of a row: bits of floats, as `0x3dcccccd`, and counts.
fn cells(row: &str) -> impl Iterator<Item = Option<u32>> {
    row.split(',').map(|cell| match cell.strip_prefix("0x") {
        Some(bits) => u32::from_str_radix(bits, 16).ok(),
        None => cell.parse().ok(),
    })
}
