//! The generated Rust: the tables as constants and one inline mixer function.

use mixer_rt::{Wrench, tables};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

use crate::compiled::Compiled;
use crate::tables::{MixerTables, Part, identifier};

/// The module of an airframe.
pub(crate) fn module(compiled: &Compiled) -> TokenStream {
    let module = identifier(&compiled.airframe.module_name());
    let module_doc = doc(&module_lines(compiled));
    let mixer = mixer_type(compiled);
    let functions = functions();
    let dynamics = dynamics(&compiled.tables.lags);
    let tables = tables_of(&compiled.tables);
    let units = Literal::usize_unsuffixed(compiled.tables.units.len());
    let channels = Literal::usize_unsuffixed(compiled.tables.channels());
    let scale = wrench(compiled.scale());
    let ardupilot_scale = wrench(compiled.ardupilot_scale());
    let betaflight_scale = wrench(compiled.betaflight_scale());
    let airframe = &compiled.airframe;
    let [min_v, max_v] = airframe
        .voltage
        .as_ref()
        .map_or([0.0; 2], |voltage| voltage.range);
    let limits = constants(&[
        (
            "THROTTLE_MIN",
            airframe.throttle.min,
            "Least throttle of a rotor that is not out: the idle.",
        ),
        ("THROTTLE_MAX", airframe.throttle.max, "Largest throttle."),
        (
            "MIN_V",
            min_v,
            "The least voltage of `range_v`, V: below it the voltage is clamped and flagged. 0 where it is ignored.",
        ),
        ("MAX_V", max_v, "The highest voltage of `range_v`, V, likewise."),
        (
            "REFERENCE_V",
            airframe.reference_v(),
            "Voltage of the bench, V: what to pass before one is measured. 0 where it is ignored.",
        ),
        (
            "REFERENCE_DENSITY_KG_M3",
            airframe.reference_density(),
            "Density of the bench's air, kg/m^3: what to pass before one is measured. 0 where it is ignored.",
        ),
    ]);
    let betaflight_expo = Literal::f32_unsuffixed(compiled.betaflight_expo() as f32);
    let [units_doc, channels_doc] = match compiled.tables.single_rotors.as_slice() {
        [] => [
            " Number of coaxial units.",
            " Number of output channels, two per unit.",
        ],
        _ => [" Number of units.", " Number of output channels, one per rotor."],
    };
    let format = mixer_rt::tables::FORMAT;
    let ardupilot_doc = doc(&[match &compiled.airframe.voltage {
        Some(voltage) => format!(
            " The same for ArduPilot's inputs, at {:?} V as `MOT_BAT_VOLT_MAX`.",
            voltage.range[1]
        ),
        None => " The same for ArduPilot's inputs.".to_owned(),
    }]);
    quote! {
        #module_doc
        #[allow(dead_code, unreachable_pub)]
        pub mod #module {
            use ::mixer_rt::{self as rt, tables};

            const _: () = ::core::assert!(
                tables::FORMAT == #format,
                "generated for another version of mixer-rt: use mixer-compiler or mixer-macros of its version, and generate the file anew"
            );

            #[doc = #units_doc]
            pub const UNITS: usize = #units;
            #[doc = #channels_doc]
            pub const CHANNELS: usize = #channels;
            #limits
            /// What one unit of PX4's normalised setpoints asks for: see
            /// `mixer_rt::Wrench::from_normalised`.
            pub const SCALE: rt::Wrench = #scale;
            #ardupilot_doc
            pub const ARDUPILOT_SCALE: rt::Wrench = #ardupilot_scale;
            /// Torques of PID sums of 1000 in Betaflight, and the thrust of its full throttle stick.
            pub const BETAFLIGHT_SCALE: rt::Wrench = #betaflight_scale;
            /// e of Betaflight's throttle stick: (1 - e) throttle + e throttle^2 of that thrust, above 1
            /// (2 - e) throttle^2 + (e - 1) throttle^3.
            pub const BETAFLIGHT_EXPO: f32 = #betaflight_expo;

            #mixer

            #functions

            #dynamics

            #tables
        }
    }
}

/// Constants in f32, with what is said of each: those that the C header has.
fn constants(constants: &[(&str, f64, &str)]) -> TokenStream {
    let constants = constants.iter().map(|(name, value, said)| {
        let (name, doc) = (identifier(name), doc(&[format!(" {said}")]));
        let value = Literal::f32_unsuffixed(*value as f32);
        quote! {
            #doc
            pub const #name: f32 = #value;
        }
    });
    constants.collect()
}

/// The mixer as a type, for code that is generic over airframes.
fn mixer_type(compiled: &Compiled) -> TokenStream {
    let mixer = identifier(&compiled.airframe.type_name());
    let name = &compiled.airframe.name;
    let mixer_doc = doc(&[format!(
        " The mixer of `{name}` as a type, for code that is generic over airframes."
    )]);
    quote! {
        #mixer_doc
        #[derive(Clone, Copy, Debug, Default)]
        pub struct #mixer;

        impl rt::tables::Sealed for #mixer {}
        impl rt::Airframe for #mixer {
            const NAME: &'static str = #name;
            const UNITS: usize = UNITS;
            const CHANNELS: usize = CHANNELS;
            const THROTTLE: [f32; 2] = [THROTTLE_MIN, THROTTLE_MAX];
            const VOLTAGES: [f32; 2] = [MIN_V, MAX_V];
            const REFERENCE_V: f32 = REFERENCE_V;
            const REFERENCE_DENSITY_KG_M3: f32 = REFERENCE_DENSITY_KG_M3;
            const SCALE: rt::Wrench = SCALE;
            const ARDUPILOT_SCALE: rt::Wrench = ARDUPILOT_SCALE;
            const BETAFLIGHT_SCALE: rt::Wrench = BETAFLIGHT_SCALE;
            type Mix = rt::Mix<CHANNELS>;
            #[inline]
            fn mix(
                setpoint: &rt::Wrench,
                conditions: impl ::core::convert::Into<rt::Conditions>,
            ) -> ::core::result::Result<Self::Mix, rt::SetpointError> {
                mix(setpoint, conditions)
            }
            #[inline]
            fn mix_with_health(
                setpoint: &rt::Wrench,
                conditions: impl ::core::convert::Into<rt::Conditions>,
                health: rt::Health,
            ) -> ::core::result::Result<Self::Mix, rt::SetpointError> {
                mix_with_health(setpoint, conditions, health)
            }
        }
    }
}

/// The functions that firmware calls: the same for all airframes.
fn functions() -> TokenStream {
    quote! {
        /// Throttles of all channels for a setpoint (N m, N; FRD) at the battery's present voltage
        /// (V) in the bench's air, or under `mixer_rt::Conditions` that have the air's density.
        ///
        /// # Errors
        /// A setpoint that is infinite or NaN, or such a voltage where the airframe has a
        /// correction.
        #[inline]
        pub fn mix(
            setpoint: &rt::Wrench,
            conditions: impl ::core::convert::Into<rt::Conditions>,
        ) -> ::core::result::Result<rt::Mix<CHANNELS>, rt::SetpointError> {
            tables::mix::<UNITS, CHANNELS, _, _>(&TABLES, setpoint, conditions.into(), rt::Health::GOOD)
        }

        /// [`mix`] with the rotors out that `health` names by channel.
        ///
        /// # Errors
        /// As [`mix`].
        #[inline]
        pub fn mix_with_health(
            setpoint: &rt::Wrench,
            conditions: impl ::core::convert::Into<rt::Conditions>,
            health: rt::Health,
        ) -> ::core::result::Result<rt::Mix<CHANNELS>, rt::SetpointError> {
            tables::mix::<UNITS, CHANNELS, _, _>(&TABLES, setpoint, conditions.into(), health)
        }
    }
}

/// What mixes with rotors under way; nothing where the airframe has no lags.
fn dynamics(lags: &[tables::Lag]) -> TokenStream {
    if lags.is_empty() {
        return TokenStream::new();
    }
    let (count, lags) = (Literal::usize_unsuffixed(lags.len()), lags.tokens());
    quote! {
        /// How the rotors of each kind of unit follow their throttles.
        #[doc(hidden)]
        pub static LAGS: [tables::Lag; #count] = #lags;

        /// The rotors under way.
        pub type State = rt::RotorState<CHANNELS>;

        /// [`mix`] for rotors that are under way: throttles that are held for `held_s` seconds, and
        /// whose thrust follows the request while the rotors change their speeds. `state` moves on with
        /// them. A time below 0, or NaN, is 0. `achieved` and `saturation` are those of [`mix`].
        ///
        /// # Errors
        /// As [`mix`]; `state` is then as it was.
        #[inline]
        pub fn mix_dynamic(
            state: &mut State,
            setpoint: &rt::Wrench,
            conditions: impl ::core::convert::Into<rt::Conditions>,
            held_s: f32,
        ) -> ::core::result::Result<rt::Mix<CHANNELS>, rt::SetpointError> {
            tables::mix_dynamic::<UNITS, CHANNELS, false, _, _>(
                &TABLES, &LAGS, state, setpoint, conditions.into(), rt::Health::GOOD, held_s,
            )
        }

        /// [`mix_dynamic`] with the rotors out that `health` names by channel.
        ///
        /// # Errors
        /// As [`mix_dynamic`].
        #[inline]
        pub fn mix_dynamic_with_health(
            state: &mut State,
            setpoint: &rt::Wrench,
            conditions: impl ::core::convert::Into<rt::Conditions>,
            health: rt::Health,
            held_s: f32,
        ) -> ::core::result::Result<rt::Mix<CHANNELS>, rt::SetpointError> {
            tables::mix_dynamic::<UNITS, CHANNELS, true, _, _>(
                &TABLES, &LAGS, state, setpoint, conditions.into(), health, held_s,
            )
        }

        /// Moves `state` on as rotors do that are `given` these throttles for `held_s` seconds: for a host that
        /// gives others than [`mix_dynamic`] did, with the state from before it.
        #[inline]
        pub fn follow(state: &mut State, given: &[f32; CHANNELS], held_s: f32) {
            tables::follow_given(&TABLES, &LAGS, state, given, held_s);
        }
    }
}

/// What the module's documentation says.
fn module_lines(compiled: &Compiled) -> Vec<String> {
    let airframe = &compiled.airframe;
    let mut lines = Vec::new();
    lines.push(if airframe.description.is_empty() {
        format!(" Mixer of `{}`.", airframe.name)
    } else {
        format!(" {}.", airframe.description.trim_end_matches('.'))
    });
    lines.push(String::new());
    if let Some(told) = airframe.borrowed() {
        lines.extend([format!(" Beware: {told}."), String::new()]);
    }
    lines.push(format!(
        " Generated by mixer-compiler {} from `{}`.",
        env!("CARGO_PKG_VERSION"),
        compiled.source.file_name()
    ));
    lines.push(" Body frame FRD, torques in N m, thrust in N upwards, throttles in [0, 1].".to_owned());
    lines.push(String::new());
    for (index, unit) in airframe.units.iter().enumerate() {
        let [x, y, z] = unit.position_m;
        let rotors = unit.in_words();
        lines.push(format!(
            " * unit {index} at ({x:?}, {y:?}, {z:?}) m, {rotors}{}",
            airframe.named_kind(unit)
        ));
    }
    lines.push(String::new());
    let [f, q] = compiled.stated.map(crate::diagnostic::rounded_up);
    let Some(of_pairs) = compiled.of_all_pairs() else {
        lines.push(" Every mix checks that thrust and torque of each rotor are within".to_owned());
        lines.push(format!(
            " {f} N and {q} N m of what is asked; else it says what is not delivered."
        ));
        return lines;
    };
    lines.push(format!(" Inverse map: {}.", of_pairs.evaluator.description()));
    lines.push(format!(
        " Proven: each unit's thrust and torque are within {f} N and {q} N m of what is asked, at every"
    ));
    lines.push(format!(
        " voltage and density and everywhere in the attainable set, rounding in f32 included ({} cells).",
        of_pairs.certificate.cells
    ));
    let [f, q] = of_pairs.residual.efforts.map(crate::diagnostic::rounded_up);
    lines.push(format!(
        " Largest residual observed over {} efforts at the reference voltage: {f} N, {q} N m.",
        of_pairs.residual.points
    ));
    lines
}

/// The tables: a constant per part, and the static that `mixer-rt` reads.
fn tables_of(tables: &MixerTables) -> TokenStream {
    let view = tables.view();
    let units = (*view.units).tokens();
    let (throttle, rows) = (view.throttle.tokens(), view.row_scale.tokens());
    let (voltage, air, level) = (view.voltage.tokens(), view.air.tokens(), view.level_n.tokens());
    let (priorities, is_vertical) = (view.priorities.tokens(), view.is_vertical);
    let (power_bias, tolerance) = (view.power_bias_nm_per_n.tokens(), view.tolerance.tokens());
    let [basis, inverse] = match tables.pairs.first() {
        Some(pair) => [pair.pair.thrust.type_tokens(), pair.inverse.type_tokens()],
        // No pair: any will do.
        None => [
            quote!(tables::Cubic),
            quote!(tables::PolynomialInverse<[f32; 1], 0>),
        ],
    };
    let has_single_rotors = !tables.single_rotors.is_empty();
    let (kinds, kinds_type) = match tables.pair_of_all() {
        Some(pair) => (pair.tokens(), quote!(tables::PairKind<#basis, #inverse>)),
        None => (
            view.kinds.tokens(),
            quote!(tables::Unlike<'static, #basis, #inverse, #has_single_rotors>),
        ),
    };
    let (closed_form, closed_form_type) = match view.closed_form.as_ref() {
        Some(table) => (Part::tokens(&table), quote!(&tables::ClosedForm<'static>)),
        None => (quote!(tables::NoClosedForm), quote!(tables::NoClosedForm)),
    };
    quote! {
        /// The units: rows of M+, columns of M, output channels.
        const UNIT_TABLES: [tables::Unit; UNITS] = #units;
        type Kinds = #kinds_type;
        /// What the units give: forward maps, rotors alone, inverse maps.
        const KINDS: Kinds = #kinds;
        /// How thrust and torque follow the battery's voltage, V.
        const VOLTAGE: ::core::option::Option<tables::Law<'static>> = #voltage;
        /// How they follow the air's density, kg/m3.
        const AIR: ::core::option::Option<tables::Law<'static>> = #air;
        /// The closed form of allocation, where there is one.
        const CLOSED_FORM: #closed_form_type = #closed_form;

        /// All tables; see `mixer_rt::tables` for their meaning and units.
        #[doc(hidden)]
        pub static TABLES: tables::Tables<'static, Kinds, #closed_form_type> = tables::Tables {
            units: &UNIT_TABLES,
            kinds: KINDS,
            throttle: #throttle,
            voltage: VOLTAGE,
            air: AIR,
            row_scale: #rows,
            level_n: #level,
            is_vertical: #is_vertical,
            priorities: #priorities,
            power_bias_nm_per_n: #power_bias,
            closed_form: CLOSED_FORM,
            tolerance: #tolerance,
        };
    }
}

fn wrench(wrench: Wrench) -> TokenStream {
    let [roll, pitch, yaw, thrust] = wrench.to_array().map(|x| x.tokens());
    quote! {
        rt::Wrench {
            roll_nm: #roll,
            pitch_nm: #pitch,
            yaw_nm: #yaw,
            thrust_n: #thrust,
        }
    }
}

fn doc(lines: &[String]) -> TokenStream {
    quote!(#(#[doc = #lines])*)
}
