//! The battery, of which PX4's simulator is told by a message.

use mavlink::dialects::common::{BATTERY_STATUS_DATA, MavBatteryFunction, MavBatteryType, MavMessage};

use crate::sitl::world::World;

/// Number of a battery's component.
pub const BATTERY: u8 = 180;

/// Cells of a pack by its voltage, at most as many as the message holds.
fn cells(volts: f64) -> usize {
    (volts / 4.25).ceil().clamp(1.0, 10.0) as usize
}

/// The battery's state.
pub fn battery(world: &World) -> MavMessage {
    let (volts, charge_ah) = (world.voltage_v(), world.state.charge_ah);
    let cells = cells(world.vehicle.battery.full_v);
    let mut voltages = [u16::MAX; 10];
    voltages[..cells].fill((1e3 * volts / cells as f64).round() as u16);
    let left = |capacity_ah: f64| (1.0 - charge_ah / capacity_ah).max(0.0);
    let left = world.vehicle.capacity_ah.map_or(1.0, left);
    MavMessage::BATTERY_STATUS(BATTERY_STATUS_DATA {
        current_consumed: (1e3 * charge_ah) as i32,
        energy_consumed: -1,
        temperature: 2500,
        voltages,
        current_battery: (100.0 * world.current_a()) as i16,
        id: 0,
        battery_function: MavBatteryFunction::MAV_BATTERY_FUNCTION_ALL,
        mavtype: MavBatteryType::MAV_BATTERY_TYPE_LIPO,
        battery_remaining: (100.0 * left) as i8,
        ..BATTERY_STATUS_DATA::DEFAULT
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pack_has_as_many_cells_as_its_voltage_tells() {
        let packs = [(4.2, 1), (14.8, 4), (16.8, 4), (21.87, 6), (25.2, 6), (50.4, 10)];
        for (volts, count) in packs {
            assert_eq!(cells(volts), count, "{volts} V");
        }
    }
}
