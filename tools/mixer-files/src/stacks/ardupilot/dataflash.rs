//! ArduPilot's DataFlash log in its binary form.

use std::borrow::Cow;
use std::io::Cursor;

use ardupilot_binlog::{Entry, Reader};

use crate::review::log::{Channel, Log};

/// The first bytes of a DataFlash log: a message that describes a format.
pub(crate) const MAGIC: &[u8] = &[0xa3, 0x95, 0x80];

/// The first bytes of a whole DataFlash log: the format of formats.
pub(crate) const BEGIN: &[u8] = b"\xa3\x95\x80\x80\x59FMT\0";

/// Fields that number the sensors of a kind.
const INSTANCES: [&str; 4] = ["I", "Inst", "Instance", "C"];

/// The bytes without formats whose messages would be shorter than their header of three bytes, which the
/// reader subtracts unchecked: without its mark it passes them over as any damage.
fn sound(bytes: &[u8]) -> Cow<'_, [u8]> {
    let is_short = |at: &usize| matches!(bytes[*at..], [0xa3, 0x95, 0x80, _, length, ..] if length < 3);
    let mut sound = Cow::Borrowed(bytes);
    for at in (0..bytes.len()).filter(is_short) {
        sound.to_mut()[at] = 0;
    }
    sound
}

/// The wanted channels of a log. Damaged messages are passed over.
pub(crate) fn read(bytes: &[u8], wanted: &[Channel]) -> Log {
    let mut log = Log::default();
    let sound = sound(bytes);
    let mut input = Cursor::new(&sound[..]);
    let mut failed = None;
    for entry in Reader::new(&mut input) {
        match entry {
            Ok(entry) => take(&mut log, wanted, &entry),
            Err(error) => {
                failed = Some(error.to_string());
                break;
            }
        }
    }
    // The reader gives up without a word where too much is damaged.
    let missing = bytes.len() as u64 - input.position();
    log.damage = match failed {
        Some(error) => Some(format!("the log is damaged: {error}; what stands before is used")),
        None if matches!(sound, Cow::Owned(_)) => {
            Some("the log is damaged: a format shorter than its header is passed over".to_owned())
        }
        None if missing > 0 => Some(format!(
            "the log is damaged: its last {missing} bytes are not read"
        )),
        None => None,
    };
    log
}

fn take(log: &mut Log, wanted: &[Channel], entry: &Entry) {
    if entry.name == "PARM" {
        if let (Some(name), Some(value)) = (entry.get_str("Name"), entry.get_f64("Value")) {
            log.parameters.insert(name.to_owned(), value);
        }
        return;
    }
    let Some(time_us) = entry.timestamp_usec else {
        return;
    };
    let instance = INSTANCES
        .iter()
        .find_map(|field| entry.get_f64(field))
        .unwrap_or(0.0);
    for channel in wanted.iter().filter(|(topic, _)| *topic == entry.name) {
        log.push(*channel, instance as u8, 1e-6 * time_us as f64, |field| {
            entry.get_f64(field)
        });
    }
}
