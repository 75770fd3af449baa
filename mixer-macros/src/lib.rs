//! `airframe!`: compiles an airframe file into const tables and an inline mixer.
//!
//! A thin shell over `mixer-compiler`: it finds the file, has it compiled and hands on the tokens.

use std::path::{Path, PathBuf};
use std::{env, fs};

use mixer_compiler::airframe::Airframe;
use mixer_compiler::{Compiled, Source};
use proc_macro::TokenStream;
use proc_macro2::{Ident, Span};
use quote::{quote, quote_spanned};
use syn::LitStr;

/// Compiles the airframe file at the given path into a module that is named after the airframe:
/// `mix`, `mix_with_health` for rotors that are out, the constants `UNITS`, `CHANNELS`, `THROTTLE_MIN`,
/// `THROTTLE_MAX`, `MIN_V`, `MAX_V`, `REFERENCE_V`, `REFERENCE_DENSITY_KG_M3`, `SCALE`, `ARDUPILOT_SCALE`,
/// `BETAFLIGHT_SCALE` and `BETAFLIGHT_EXPO`, and the mixer as a type.
///
/// The path is taken relative to the package (`CARGO_MANIFEST_DIR`) or, where there is no such
/// file, to the folder of the calling file. The crate that calls the macro depends on `mixer-rt`
/// too.
///
/// ```
/// use mixer_rt::{Airframe, Health, SetpointError, Wrench};
///
/// mixer_macros::airframe!("airframes/isae-x8.toml");
///
/// # fn main() -> Result<(), SetpointError> {
/// let setpoint = Wrench { roll_nm: 0.5, pitch_nm: 0.0, yaw_nm: 0.1, thrust_n: 31.0 };
/// let mix = isae_x8::mix(&setpoint, 15.2)?;
/// assert!(!mix.saturation.any_axis());
/// assert!((mix.achieved.roll_nm - setpoint.roll_nm).abs() < 0.01);
///
/// // The same as a type, for code that serves any airframe.
/// fn mix_all<A: Airframe>(setpoints: &[Wrench], voltage_v: f32) -> Result<Vec<A::Mix>, SetpointError> {
///     setpoints.iter().map(|setpoint| A::mix(setpoint, voltage_v)).collect()
/// }
/// assert_eq!(mix_all::<isae_x8::IsaeX8>(&[setpoint], 15.2)?, [mix]);
///
/// // With the rotor on channel 3 out; its throttle is zero.
/// let health = Health::GOOD.with_failed(3);
/// let limped = isae_x8::IsaeX8::mix_with_health(&setpoint, 15.2, health)?;
/// assert_eq!(limped.throttle[3], 0.0);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// A file that cannot be read or is refused becomes a `compile_error!` at the path, with every
/// fault at its place in the file. Editing the file rebuilds, whether it was refused or not.
///
/// # Warnings
/// What `cargo mixer check` warns of is a warning at the path, in the form of a deprecation. It breaks no build, also none
/// that denies warnings; `#[allow(deprecated)]` above the macro silences it.
#[proc_macro]
pub fn airframe(input: TokenStream) -> TokenStream {
    match syn::parse::<LitStr>(input) {
        Ok(path) => expand(&path).into(),
        Err(error) => error.into_compile_error().into(),
    }
}

fn expand(literal: &LitStr) -> proc_macro2::TokenStream {
    let refused = |source: &Source, message: String| refusal(source, &message, literal.span());
    let given = Source::new(literal.value(), "");
    let path = match find(Path::new(&given.name), literal.span()) {
        Ok(path) => path,
        Err(message) => return refused(&given, message),
    };
    let tokens = match fs::read(&path) {
        Err(error) => refused(&given, format!("{}: {error}", path.display())),
        Ok(bytes) => Source::from_bytes(literal.value(), bytes)
            .and_then(|source| mixer_compiler::compile(&source))
            .map_or_else(
                |faults| refused(faults.source(), faults.compile_error()),
                |compiled| {
                    let (tokens, warned) = (compiled.tokens(), warned(&compiled, literal.span()));
                    quote!(#tokens #warned)
                },
            ),
    };
    // Makes the file an input of the build: rustc compiles again when it changes, from a refusal as
    // well.
    let tracked = path.to_string_lossy();
    quote! {
        #tokens
        const _: &[u8] = ::core::include_bytes!(#tracked);
    }
}

/// The airframe's warnings at the path literal. A macro cannot warn, but the use of something deprecated does. It stays a
/// warning in builds that deny them, as those of `cargo mixer check` leave the status 0, and `allow(deprecated)` around
/// the macro switches it off.
fn warned(compiled: &Compiled, span: Span) -> proc_macro2::TokenStream {
    let warnings = mixer_compiler::lint(compiled).lines().join("\n");
    if warnings.is_empty() {
        return proc_macro2::TokenStream::new();
    }
    quote_spanned! { span =>
        const _: () = {
            #[deprecated(note = #warnings)]
            const WARNINGS_OF_THE_AIRFRAME: () = ();
            #[warn(warnings)]
            const _: () = WARNINGS_OF_THE_AIRFRAME;
        };
    }
}

/// The absolute path of the file.
fn find(given: &Path, span: Span) -> Result<PathBuf, String> {
    let package = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let caller = span
        .unwrap()
        .local_file()
        .and_then(|file| file.parent().map(Path::to_owned));
    let folders = [package, caller];
    let candidates = folders.iter().flatten().map(|folder| folder.join(given));
    for candidate in candidates {
        if candidate.is_file() {
            return candidate
                .canonicalize()
                .map_err(|error| format!("{}: {error}", candidate.display()));
        }
    }
    // The compiler prints the calling file below; absolute paths would differ from machine to
    // machine.
    Err(format!(
        "no airframe file `{}`: neither in the package's folder nor in the folder of this source file",
        given.display()
    ))
}

/// The error at the path literal, and a module of the expected name so that no further errors hide
/// it.
fn refusal(source: &Source, message: &str, span: Span) -> proc_macro2::TokenStream {
    let [module, mixer] = Airframe::names_if_refused(source).map(|name| Ident::new(&name, Span::call_site()));
    let result = quote!(::core::result::Result<::mixer_rt::Mix<CHANNELS>, ::mixer_rt::SetpointError>);
    let functions = |visibility: proc_macro2::TokenStream| {
        let conditions = quote!(impl ::core::convert::Into<::mixer_rt::Conditions>);
        let forms = [
            ("mix", conditions.clone()),
            ("mix_with_health", quote!(#conditions, _: ::mixer_rt::Health)),
        ];
        let functions = forms.map(|(name, parameters)| {
            let name = Ident::new(name, Span::call_site());
            quote! {
                #visibility fn #name(_: &::mixer_rt::Wrench, _: #parameters) -> #result {
                    ::core::unreachable!()
                }
            }
        });
        quote!(#(#functions)*)
    };
    let (of_type, of_module) = (functions(quote!()), functions(quote!(pub)));
    let skeleton = quote! {
        pub mod #module {
            pub const UNITS: usize = 0;
            pub const CHANNELS: usize = 0;
            pub const THROTTLE_MIN: f32 = 0.0;
            pub const THROTTLE_MAX: f32 = 1.0;
            pub const MIN_V: f32 = 0.0;
            pub const MAX_V: f32 = 0.0;
            pub const REFERENCE_V: f32 = 0.0;
            pub const REFERENCE_DENSITY_KG_M3: f32 = 0.0;
            pub const SCALE: ::mixer_rt::Wrench = ::mixer_rt::Wrench::from_array([0.0; 4]);
            pub const ARDUPILOT_SCALE: ::mixer_rt::Wrench = SCALE;
            pub const BETAFLIGHT_SCALE: ::mixer_rt::Wrench = SCALE;
            pub const BETAFLIGHT_EXPO: f32 = 0.0;
            pub struct #mixer;
            impl ::mixer_rt::tables::Sealed for #mixer {}
            impl ::mixer_rt::Airframe for #mixer {
                const NAME: &'static str = "";
                const UNITS: usize = UNITS;
                const CHANNELS: usize = CHANNELS;
                const THROTTLE: [f32; 2] = [THROTTLE_MIN, THROTTLE_MAX];
                const VOLTAGES: [f32; 2] = [MIN_V, MAX_V];
                const REFERENCE_V: f32 = REFERENCE_V;
                const REFERENCE_DENSITY_KG_M3: f32 = REFERENCE_DENSITY_KG_M3;
                const SCALE: ::mixer_rt::Wrench = SCALE;
                const ARDUPILOT_SCALE: ::mixer_rt::Wrench = SCALE;
                const BETAFLIGHT_SCALE: ::mixer_rt::Wrench = SCALE;
                type Mix = ::mixer_rt::Mix<CHANNELS>;
                #of_type
            }
            #of_module
        }
    };
    quote_spanned! { span => ::core::compile_error!(#message); #skeleton }
}
