//! From a setpoint to the motors, once per cycle of the control loop.

use mixer_rt::{Mix, Saturation, SetpointError, Wrench};

/// The speed controllers of all rotors, in the order of the airframe's output channels.
pub(crate) trait EscOutputs<const CHANNELS: usize> {
    /// Commands every rotor, throttle in [0, 1]. The rotors keep it until the next call.
    fn write(&mut self, throttle: &[f32; CHANNELS]);

    /// Stops every rotor.
    fn disarm(&mut self);
}

/// The battery monitor.
pub(crate) trait Battery {
    /// Filtered voltage under load, V.
    fn voltage_v(&mut self) -> f32;
}

/// What one cycle did.
#[derive(Clone, Copy)]
pub(crate) enum Cycle {
    /// Mixed and written: the wrench that the rotors give, and the axes that are saturated, on
    /// which the rate controller stops integrating.
    Mixed {
        achieved: Wrench,
        saturation: Saturation,
    },
    /// The setpoint was not finite: the rotors keep the last throttles.
    Held,
    /// Too many such setpoints in a row, now or earlier: the rotors are stopped.
    Disarmed,
}

/// Mixes and drives the rotors; stops them when the setpoint stays unusable.
pub(crate) struct MotorControl<const CHANNELS: usize, Outputs, Monitor> {
    mix: fn(&Wrench, f32) -> Result<Mix<CHANNELS>, SetpointError>,
    outputs: Outputs,
    battery: Monitor,
    /// Cycles in a row that may go without a usable setpoint.
    patience: u32,
    /// Cycles in a row that did.
    missed: u32,
}

impl<const CHANNELS: usize, Outputs, Monitor> MotorControl<CHANNELS, Outputs, Monitor>
where
    Outputs: EscOutputs<CHANNELS>,
    Monitor: Battery,
{
    /// `patience`: for how many cycles in a row the last throttles are held before the rotors are
    /// stopped.
    pub(crate) fn new(
        mix: fn(&Wrench, f32) -> Result<Mix<CHANNELS>, SetpointError>,
        outputs: Outputs,
        battery: Monitor,
        patience: u32,
    ) -> Self {
        MotorControl {
            mix,
            outputs,
            battery,
            patience,
            missed: 0,
        }
    }

    /// One cycle. Once disarmed it stays so: arming again is the pilot's decision.
    pub(crate) fn cycle(&mut self, setpoint: &Wrench) -> Cycle {
        if self.missed > self.patience {
            return Cycle::Disarmed;
        }
        match (self.mix)(setpoint, self.battery.voltage_v()) {
            Ok(mix) => {
                self.missed = 0;
                self.outputs.write(&mix.throttle);
                Cycle::Mixed {
                    achieved: mix.achieved,
                    saturation: mix.saturation,
                }
            }
            Err(_) => {
                self.missed += 1;
                if self.missed > self.patience {
                    self.outputs.disarm();
                    return Cycle::Disarmed;
                }
                Cycle::Held
            }
        }
    }

    /// The speed controllers, to read back what they were told.
    pub(crate) fn outputs(&self) -> &Outputs {
        &self.outputs
    }
}
