//! The macro, the build-script function and the library give the same mixer: of alike pairs, of unlike ones, and of pairs with single
//! rotors.

use std::fs;

use mixer_compiler::Source;
use mixer_rt::{Airframe, Wrench};

/// For each airframe: the modules of both ways, and a test that compares them.
macro_rules! airframes {
    ($($test:ident: $path:literal, $stem:literal, $module:ident :: $mixer:ident;)+) => {
        /// Mixers by the macro.
        pub mod by_macro {
            $(mixer_macros::airframe!($path);)+
        }

        /// Mixers by the build script.
        pub mod by_build_script {
            $(include!(concat!(env!("OUT_DIR"), "/", $stem, ".rs"));)+
        }

        $(
            #[test]
            fn $test() {
                assert_eq!(by_macro::$module::TABLES, by_build_script::$module::TABLES);
                assert_same_mixes::<by_macro::$module::$mixer, by_build_script::$module::$mixer>();
                assert_same_text($path, include_str!(concat!(env!("OUT_DIR"), "/", $stem, ".rs")));
            }
        )+
    };
}

airframes! {
    hexa_stacked: "../airframes/hexa-stacked.toml", "hexa-stacked", hexa_stacked::HexaStacked;
    isae_x8: "../airframes/isae-x8.toml", "isae-x8", isae_x8::IsaeX8;
    x8_22_16in: "../airframes/x8-22-16in.toml", "x8-22-16in", x8_22_16in::X8_22_16in;
}

/// The functions that stand beside the tables, on setpoints within and beyond the attainable ones.
fn assert_same_mixes<A, B>()
where
    A: Airframe,
    B: Airframe<Mix = A::Mix>,
    A::Mix: PartialEq + std::fmt::Debug,
{
    assert_eq!(A::NAME, B::NAME);
    for thrust_n in [0.0, 12.0, 60.0, f32::NAN] {
        for torque_nm in [0.0, 0.1, -3.0] {
            for voltage_v in [11.0, 15.3] {
                let setpoint = Wrench::from_array([torque_nm, -torque_nm, torque_nm, thrust_n]);
                assert_eq!(A::mix(&setpoint, voltage_v), B::mix(&setpoint, voltage_v));
            }
        }
    }
}

/// The file of the build script is what the library generates, byte for byte. `cargo mixer expand`
/// prints the same: see `tools/cargo-mixer/tests/cases/expand`.
fn assert_same_text(path: &str, by_build_script: &str) {
    // The working directory of tests is that of their package, as it is for build scripts.
    let text = fs::read_to_string(path).unwrap();
    let compiled = mixer_compiler::compile(&Source::new(path, text)).unwrap();
    assert_eq!(compiled.rust(), by_build_script);
}
