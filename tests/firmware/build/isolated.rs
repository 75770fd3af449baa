//! Tables of the mixers that airframes are compared with, as Rust.

use mixer_compiler::Compiled;
use mixer_compiler::isolated::IsolatedTables;
use quote::quote;

/// `ISOLATED`, the tables of `mixer_rt::baselines`, and B with its size for `wls-alloc`.
pub(crate) fn tables(compiled: &Compiled) -> String {
    let tables = IsolatedTables::new(compiled);
    let isolated = tables.tokens(&quote!(airframe::TABLES.voltage));
    let rows = tables.effectiveness.row_iter().map(|row| {
        let shares = row.iter().map(|share| *share as f32);
        quote!([#(#shares),*])
    });
    let rotors = tables.rotors.len();
    quote! {
        #[cfg(all(baseline, not(baseline = "c-interface")))]
        pub(crate) static ISOLATED: ::mixer_rt::baselines::IsolatedRotors<'static> = #isolated;
        #[cfg(baseline = "wls")]
        pub(crate) static EFFECTIVENESS: [[f32; #rotors]; 4] = [#(#rows),*];
        #[cfg(baseline = "wls")]
        pub(crate) const ROTORS: usize = #rotors;
        #[cfg(baseline = "wls")]
        pub(crate) const ROWS: usize = #rotors + 4;
    }
    .to_string()
}
