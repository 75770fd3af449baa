//! What Betaflight sends, motors, and what it reads, state and sticks: packets of `src/platform/SIMULATOR/sitl.c`.

use crate::sitl::pilot::Channels;
use crate::sitl::sensors::Sensors;
use crate::sitl::vehicle::{MOST_ROTORS, Throttles, throttle};
use crate::sitl::world::World;

/// `servo_packet_raw`: their number, two bytes between, and single-precision pulse widths, us.
pub fn motors(bytes: &[u8], range: [f64; 2]) -> Option<Throttles> {
    let pulses = bytes.get(4..)?.chunks_exact(4);
    let mut throttles = Throttles::zeros();
    for (channel, pulse) in throttles.iter_mut().zip(pulses).take(MOST_ROTORS) {
        let pulse = f32::from_le_bytes(pulse.try_into().ok()?);
        *channel = throttle(pulse.into(), range);
    }
    Some(throttles)
}

/// Betaflight runs its clock by the ratio of two packets' times and the time between their arrivals, unless the times are equal:
/// two that come in a burst would put it forward, until it takes its receiver for lost.
const NO_TIME: f64 = 0.0;

/// `fdm_packet`: time, angular rate with yaw negated, specific force, attitude, velocity, longitude, latitude and altitude, all of
/// the body's and the world's axes forward or north, right or east, down, and the pressure, Pa.
pub fn state(world: &World, sensors: &mut Sensors) -> Vec<u8> {
    let ([force, rate], q) = (sensors.inertial(world), world.state.attitude);
    let altitude_m = world.vehicle.altitude_m - world.state.position.z;
    let values = [
        &[NO_TIME, rate.x, rate.y, -rate.z][..],
        force.as_slice(),
        &[q.w, q.i, q.j, q.k],
        world.state.velocity.as_slice(),
        &[0.0, 0.0, altitude_m, 100.0 * sensors.air(world)[0]],
    ];
    values
        .concat()
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

/// `rc_packet`: time, s, and 16 pulse widths, us.
pub fn channels(time_s: f64, channels: &Channels) -> Vec<u8> {
    let widths = channels.iter().flat_map(|width| width.to_le_bytes());
    time_s.to_le_bytes().into_iter().chain(widths).collect()
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::sitl::arguments::Arguments;
    use crate::sitl::vehicle::Vehicle;

    #[test]
    fn packets_are_those_of_betaflight() {
        let mut packet = vec![8, 0, 0, 0];
        packet.extend(
            [1000f32, 1500.0, 2000.0, 2500.0]
                .iter()
                .flat_map(|pulse| pulse.to_le_bytes()),
        );
        let throttles = motors(&packet, [1000.0, 2000.0]).unwrap();
        assert_eq!(throttles.as_slice()[..5], [0.0, 0.5, 1.0, 1.0, 0.0]);
        assert_eq!(motors(&packet[..3], [1000.0, 2000.0]), None);
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");
        let arguments = Arguments::try_parse_from(["sitl", file, "--betaflight"]).unwrap();
        let mut world = World::new(Vehicle::new(&arguments).unwrap());
        world.state.rate = nalgebra::Vector3::new(0.1, 0.2, 0.3);
        let bytes = state(&world, &mut Sensors::new(0.0, 1));
        let values: Vec<f64> = bytes
            .chunks(8)
            .map(|value| f64::from_le_bytes(value.try_into().unwrap()))
            .collect();
        assert_eq!(values.len(), 18);
        assert_eq!(values[..4], [NO_TIME, 0.1, 0.2, -0.3]);
        assert!(
            (values[6] + 9.80665).abs() < 1e-9 && values[7] == 1.0,
            "{values:?}"
        );
        let bytes = channels(4.5, &[1500; 16]);
        assert_eq!((bytes.len(), &bytes[8..10]), (40, &[0xdc, 0x05][..]));
    }
}
