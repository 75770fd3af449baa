//! The requests of the `counts` image. The host draws them: on the target the generator would share functions
//! with the mixer, and the compiler would inline them differently than in a user's image.

use std::fs;
use std::path::Path;

use mixer_compiler::Source;
use mixer_setpoints::{Kind, Requests};

/// Requests of each kind.
const COUNT: usize = 4_000;
const SEED: u64 = 8;

/// Writes `<name>.attainable` and `<name>.saturated` to `out`: roll, pitch, yaw, thrust and voltage as
/// little-endian f32, request by request.
pub(crate) fn write(name: &str, airframe: &Path, out: &Path) -> Result<(), String> {
    println!("cargo::rerun-if-changed={}", airframe.display());
    let text = fs::read_to_string(airframe).map_err(|e| format!("{}: {e}", airframe.display()))?;
    let source = Source::new(airframe.display().to_string(), text);
    let compiled = mixer_compiler::compile(&source).map_err(|faults| faults.to_string())?;
    let tables = compiled.tables.view();
    for (kind, extension) in [(Kind::Attainable, "attainable"), (Kind::Saturated, "saturated")] {
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
