//! The shape of `airframe!` until the macro is there.
#![no_std]

#[macro_export]
macro_rules! airframe {
    ($path:literal) => {
        pub mod isae_x8 {
            pub struct IsaeX8;
            pub const CHANNELS: usize = 8;
            static TABLE: [[f32; 4]; CHANNELS] = [
                [-0.5, 0.5, 0.25, 0.125],
                [0.5, 0.5, -0.25, 0.125],
                [0.5, -0.5, 0.25, 0.125],
                [-0.5, -0.5, -0.25, 0.125],
                [-0.5, 0.5, -0.25, 0.15],
                [0.5, 0.5, 0.25, 0.15],
                [0.5, -0.5, -0.25, 0.15],
                [-0.5, -0.5, 0.25, 0.15],
            ];
            #[inline]
            pub fn mix(
                setpoint: &mixer_rt::Wrench,
                voltage_v: f32,
            ) -> Result<mixer_rt::Mix<CHANNELS>, mixer_rt::SetpointError> {
                mixer_rt::mix(&TABLE, setpoint, voltage_v)
            }
        }
    };
}
