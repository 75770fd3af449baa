//! Golden vectors on the target: rows of the tables that `cargo mixer golden` writes. Copy this
//! file.

use mixer_rt::{Conditions, Health, Mix, SetpointError, Wrench};

/// What a mixer returns.
type Mixed<const CHANNELS: usize> = Result<Mix<CHANNELS>, SetpointError>;

/// How many rows of `NAME.vectors.csv` `mix` gives other bits for.
#[allow(dead_code)] // The golden image, which counts instructions, goes through the rows itself.
pub(crate) fn differing<const CHANNELS: usize>(
    table: &str,
    mix: impl Fn(&Wrench, Conditions) -> Mixed<CHANNELS>,
) -> usize {
    let agrees = |row: &&str| {
        let (setpoint, conditions) = request(row, CHANNELS)?;
        Some(agrees(row, &mix(&setpoint, conditions)))
    };
    rows(table).filter(|row| agrees(row) != Some(true)).count()
}

/// How many rows of `NAME.rotors-out.csv` `mix` gives other bits for with the rotors out that it is
/// given.
pub(crate) fn differing_with_rotors_out<const CHANNELS: usize>(
    table: &str,
    mix: impl Fn(&Wrench, Conditions, Health) -> Mixed<CHANNELS>,
) -> usize {
    let agrees = |row: &&str| {
        let (failed, row) = row.split_once(',')?;
        let (setpoint, conditions) = request(row, CHANNELS)?;
        let mut health = Health::GOOD;
        for channel in failed.split('+') {
            health = health.with_failed(channel.parse().ok()?);
        }
        Some(agrees(row, &mix(&setpoint, conditions, health)))
    };
    rows(table).filter(|row| agrees(row) != Some(true)).count()
}

/// The rows of a table, without its header.
pub(crate) fn rows(table: &str) -> impl Iterator<Item = &str> + Clone {
    table.lines().skip(1)
}

/// How many cells of a row are the request: four axes, the voltage and, of an airframe with `[air]`, the
/// density. Behind them are the throttles, the achieved wrench and the saturation.
fn inputs(row: &str, channels: usize) -> usize {
    cells(row).count().saturating_sub(channels + 5)
}

/// The setpoint and the conditions of a row of an airframe with as many channels; `None` of a row that
/// is too short.
pub(crate) fn request(row: &str, channels: usize) -> Option<(Wrench, Conditions)> {
    let cells = cells(row).take(inputs(row, channels));
    let mut cells = cells.map(|cell| cell.map(f32::from_bits));
    let mut next = || cells.next().flatten();
    let wrench = [next()?, next()?, next()?, next()?];
    let conditions = Conditions::at_voltage(next()?).in_air(next().unwrap_or(0.0));
    Some((Wrench::from_array(wrench), conditions))
}

/// Whether what a mixer gives has the bits of a row.
pub(crate) fn agrees<const CHANNELS: usize>(row: &str, mixed: &Mixed<CHANNELS>) -> bool {
    mixed.as_ref().is_ok_and(|mix| {
        let floats = mix.throttle.into_iter().chain(mix.achieved.to_array());
        let given = floats.map(f32::to_bits).chain([mix.saturation.bits().into()]);
        given.map(Some).eq(cells(row).skip(inputs(row, CHANNELS)))
    })
}

/// The numbers of a row: bits of floats, as `0x3dcccccd`, and counts.
fn cells(row: &str) -> impl Iterator<Item = Option<u32>> {
    row.split(',').map(|cell| match cell.strip_prefix("0x") {
        Some(bits) => u32::from_str_radix(bits, 16).ok(),
        None => cell.parse().ok(),
    })
}
