//! Tables of the mixers that airframes are compared with, as Rust.

use isolated_rotors::{IsolatedRotor, IsolatedTables, ThrustCurve};
use mixer_compiler::Compiled;
use quote::quote;

/// `ISOLATED`, the tables of `isolated_rotors`, and B with its size for `wls-alloc`.
pub(crate) fn tables(compiled: &Compiled) -> String {
    let IsolatedTables {
        rotors,
        curve,
        thrust_n: [low, high],
        effectiveness,
        ..
    } = IsolatedTables::new(compiled);
    let count = rotors.len();
    let rotors = rotors.iter().map(|rotor| {
        let IsolatedRotor {
            allocation,
            direction,
        } = rotor;
        quote!(::isolated_rotors::IsolatedRotor {
            allocation: [#(#allocation),*],
            direction: [#(#direction),*],
        })
    });
    let curve = match &curve {
        ThrustCurve::Parabola { per_n, shift } => quote!(Parabola { per_n: #per_n, shift: #shift }),
        ThrustCurve::Polynomial(coefficients) => quote!(Polynomial([#(#coefficients),*])),
    };
    let rows = effectiveness.row_iter().map(|row| {
        let shares = row.iter().map(|share| *share as f32);
        quote!([#(#shares),*])
    });
    quote! {
        #[cfg(all(baseline, not(baseline = "c-interface")))]
        pub(crate) static ISOLATED: ::isolated_rotors::IsolatedRotors<'static> =
            ::isolated_rotors::IsolatedRotors {
                rotors: &[#(#rotors),*],
                curve: ::isolated_rotors::ThrustCurve::#curve,
                thrust_n: [#low, #high],
                throttle: airframe::TABLES.throttle,
                voltage: airframe::TABLES.voltage,
            };
        #[cfg(baseline = "wls")]
        pub(crate) static EFFECTIVENESS: [[f32; #count]; 4] = [#(#rows),*];
        #[cfg(baseline = "wls")]
        pub(crate) const ROTORS: usize = #count;
        #[cfg(baseline = "wls")]
        pub(crate) const ROWS: usize = #count + 4;
    }
    .to_string()
}
