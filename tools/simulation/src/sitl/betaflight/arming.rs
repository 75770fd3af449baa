//! Asks Betaflight by MSP what keeps it from arming.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::time::Duration;

/// MSP's port.
const MSP: u16 = 5761;

/// `MSP_STATUS_EX`, and where in its answer the bytes of flight modes are counted.
const STATUS: u8 = 150;
const MODES: usize = 15;

/// Reasons of `armingDisableFlagNames`, in its order; older versions have fewer, and in a build with the coaxial mixer one more comes
/// before the last, `ARM_SWITCH`.
const REASONS: [&str; 29] = [
    "NOGYRO",
    "FAILSAFE",
    "RXLOSS",
    "NOT_DISARMED",
    "BOXFAILSAFE",
    "RUNAWAY",
    "CRASH",
    "THROTTLE",
    "ANGLE",
    "BOOTGRACE",
    "NOPREARM",
    "LOAD",
    "CALIB",
    "CLI",
    "CMS",
    "BST",
    "MSP",
    "PARALYZE",
    "GPS",
    "RESCUE_SW",
    "DSHOT_TELEM",
    "REBOOT_REQD",
    "DSHOT_BBANG",
    "NO_ACC_CAL",
    "MOTOR_PROTO",
    "FLIP_SWITCH",
    "ALT_HOLD_SW",
    "POS_HOLD_SW",
    "AUTOPILOT_SW",
];

/// Betaflight's reasons not to arm, as the end of an error message; `None` without an answer.
pub fn reasons() -> Option<String> {
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, MSP)).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(1))).ok()?;
    stream.write_all(&[b'$', b'M', b'<', 0, STATUS, STATUS]).ok()?;
    let mut bytes = Vec::new();
    // The answer is all that comes within the time.
    let _ = stream.take(64).read_to_end(&mut bytes);
    let at = bytes.windows(3).position(|head| head == b"$M>")?;
    let data = bytes.get(at + 5..)?;
    let at = MODES + 1 + usize::from(*data.get(MODES)?);
    let (count, flags) = (usize::from(*data.get(at)?), data.get(at + 1..at + 5)?);
    let flags = u32::from_le_bytes(flags.try_into().ok()?);
    Some(format!("; Betaflight says: {}", held(count, flags)))
}

/// Names of the `flags` of `count`. The last is the switch, which says that another holds.
fn held(count: usize, flags: u32) -> String {
    const COAXIAL: &str = "the coaxial mixer (`status` of the CLI says why)";
    let name = |bit: usize| match REASONS.get(bit) {
        // A name in a build without the coaxial mixer.
        Some(reason) if bit + 2 == count => format!("{reason} or {COAXIAL}"),
        Some(reason) => (*reason).to_owned(),
        None => COAXIAL.to_owned(),
    };
    let bits = (0..count.saturating_sub(1)).filter(|bit| flags >> bit & 1 == 1);
    itertools::join(bits.map(name), ", ")
}

#[cfg(test)]
mod tests {
    use super::held;

    #[test]
    fn reasons_are_those_of_the_version() {
        let of_master = held(31, 1 << 29 | 1 << 30 | 1 << 7);
        assert_eq!(
            of_master,
            "THROTTLE, the coaxial mixer (`status` of the CLI says why)"
        );
        let of_4_5 = held(27, 1 << 25 | 1 << 26);
        assert!(of_4_5.starts_with("FLIP_SWITCH or the coaxial mixer"), "{of_4_5}");
        assert_eq!(held(26, 1 << 2 | 1 << 25), "RXLOSS");
    }
}
