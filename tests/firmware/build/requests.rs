//! The requests of the `counts` image. The host draws them: on the target the generator would share
//! functions with the mixer, and the compiler would inline them differently than in a user's image.

use std::fs;
use std::path::Path;

use mixer_setpoints::{RequestKind, Requests};

use crate::Measured;

/// Requests of each kind.
const COUNT: usize = 2_000;
const SEED: u64 = 8;

/// Writes `<name>.attainable` and `<name>.saturated` to `out`: roll, pitch, yaw, thrust and voltage
/// as little-endian f32, request by request.
pub(crate) fn write(measured: &Measured, out: &Path) -> Result<(), String> {
    let Measured { name, path, compiled } = measured;
    println!("cargo::rerun-if-changed={}", path.display());
    let tables = compiled.tables.view();
    for (kind, extension) in [
        (RequestKind::Attainable, "attainable"),
        (RequestKind::Saturated, "saturated"),
    ] {
        let bytes: Vec<u8> = Requests::new(&tables, kind, SEED)
            .take(COUNT)
            .flat_map(|request| {
                let [roll, pitch, yaw, thrust] = request.wrench;
                [roll, pitch, yaw, thrust, request.voltage_v]
            })
            .flat_map(f32::to_le_bytes)
            .collect();
        let path = out.join(format!("{name}.{extension}"));
        fs::write(&path, bytes).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(())
}
