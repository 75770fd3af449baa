//! What ArduPilot sends, pulse widths in bytes, and what it reads, the state as JSON.

use nalgebra::Vector3;

use crate::sitl::sensors::Sensors;
use crate::sitl::vehicle::{MOST_ROTORS, Throttles, throttle};
use crate::sitl::world::World;

/// First two bytes of a packet of 16, and of 32 channels.
const MAGIC_16: u16 = 18_458;
const MAGIC_32: u16 = 29_569;

/// Bytes before the channels.
const HEAD: usize = 8;

/// Steps per second that are taken; ArduPilot takes no step of 0.1 s or more.
const RATE_HZ: std::ops::RangeInclusive<u16> = 50..=10_000;

/// A packet of ArduPilot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Packet {
    /// Steps per second.
    pub rate_hz: u16,
    /// Its number.
    pub count: u32,
    /// A throttle per channel.
    pub throttles: Throttles,
}

/// A packet with pulse widths between those of throttle 0 and 1, us; `None` of anything else.
pub fn packet(bytes: &[u8], pulses: [f64; 2]) -> Option<Packet> {
    let word = |at: usize| Some(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?));
    let channels = match word(0)? {
        MAGIC_16 => 16,
        MAGIC_32 => 32,
        _ => return None,
    };
    if bytes.len() != HEAD + 2 * channels {
        return None;
    }
    let mut throttles = Throttles::zeros();
    for channel in 0..channels.min(MOST_ROTORS) {
        let pulse = f64::from(word(HEAD + 2 * channel)?);
        // 0 is no pulse.
        throttles[channel] = throttle(pulse, pulses);
    }
    Some(Packet {
        rate_hz: word(2).filter(|rate_hz| RATE_HZ.contains(rate_hz))?,
        count: u32::from_le_bytes(bytes.get(4..8)?.try_into().ok()?),
        throttles,
    })
}

/// A line. ArduPilot looks for `"key":` and takes what follows: no blanks. The first newline is for
/// the first line: ArduPilot looks for a line between two of them.
pub fn answer(world: &World, sensors: &mut Sensors) -> String {
    let state = &world.state;
    let [acceleration, rate] = sensors.inertial(world);
    let q = state.attitude;
    let list = |vector: &Vector3<f64>| format!("[{:.9},{:.9},{:.9}]", vector.x, vector.y, vector.z);
    format!(
        "\n{{\"timestamp\":{:.6},\"imu\":{{\"gyro\":{},\"accel_body\":{}}},\"position\":{},\
         \"quaternion\":[{:.9},{:.9},{:.9},{:.9}],\"velocity\":{},\"battery\":{{\"voltage\":{:.4},\"current\":{:.4}}},\
         \"no_time_sync\":1}}\n",
        world.time_s(),
        list(&rate),
        list(&acceleration),
        list(&state.position),
        q.w,
        q.i,
        q.j,
        q.k,
        list(&state.velocity),
        world.voltage_v(),
        world.current_a(),
    )
}
