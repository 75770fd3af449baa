//! What the example has in place of a flight controller's peripherals: QEMU's MPS2 board has
//! neither speed controllers nor a battery. A port to a real board replaces this file.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

use crate::control::{Battery, EscOutputs};

/// Frequency of the core and of SysTick, Hz.
const CORE_HZ: u32 = 25_000_000;

/// Interrupts `rate_hz` times a second.
pub(crate) fn pace(mut systick: SYST, rate_hz: u32) {
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(CORE_HZ / rate_hz - 1);
    systick.clear_current();
    systick.enable_counter();
    systick.enable_interrupt();
}

/// Pulse widths as a timer's compare registers would hold them, microseconds.
pub(crate) struct Pulses<const CHANNELS: usize> {
    pub(crate) width_us: [u16; CHANNELS],
}

impl<const CHANNELS: usize> Pulses<CHANNELS> {
    /// Below the range of throttle: the speed controller stops its motor.
    const DISARMED_US: u16 = 900;

    pub(crate) fn new() -> Self {
        Pulses {
            width_us: [Self::DISARMED_US; CHANNELS],
        }
    }
}

impl<const CHANNELS: usize> EscOutputs<CHANNELS> for Pulses<CHANNELS> {
    /// 1000 us to 2000 us for throttle 0 to 1.
    fn write(&mut self, throttle: &[f32; CHANNELS]) {
        self.width_us = throttle.map(|throttle| (1000.0 + 1000.0 * throttle + 0.5) as u16);
    }

    fn disarm(&mut self) {
        self.width_us = [Self::DISARMED_US; CHANNELS];
    }
}

/// A pack that loses a little voltage with every reading.
pub(crate) struct DischargingPack {
    voltage_v: f32,
}

impl DischargingPack {
    pub(crate) fn full() -> Self {
        DischargingPack { voltage_v: 16.8 }
    }
}

impl Battery for DischargingPack {
    fn voltage_v(&mut self) -> f32 {
        self.voltage_v -= 0.002;
        self.voltage_v
    }
}
