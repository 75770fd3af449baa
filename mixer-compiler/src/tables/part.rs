//! The parts of `mixer-rt`'s tables as the generated Rust writes them, and what they take in flash.
//! The fields of each type are named once, below.

use mixer_rt::tables::{
    Airmode, Border, Cell, ClosedForm, ClosedFormUnit, Facets, Grid, Knot, Lag, Law, LawPiece, Outline, Pair,
    PairKind, Priorities, RotorAlone, Steep, ThrottleRange, Tolerance, Unit, Unlike,
};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{ToTokens, quote};

use super::quantity::QuantityTable;
use crate::inverse::table::InverseTable;

/// A part of the tables.
pub(crate) trait Part {
    /// The expression that gives it, and its bytes in flash: four per number, one per channel. Of
    /// addresses, only that of the border's cells is counted.
    fn written(&self) -> (TokenStream, usize);

    /// The expression that gives it.
    fn tokens(&self) -> TokenStream {
        self.written().0
    }

    /// Its bytes in flash.
    fn bytes(&self) -> usize {
        self.written().1
    }
}

impl Part for f32 {
    /// A literal that reads back to the same bits.
    fn written(&self) -> (TokenStream, usize) {
        let magnitude = Literal::f32_unsuffixed(self.abs());
        let sign = (*self < 0.0).then(|| quote!(-));
        (quote!(#sign #magnitude), 4)
    }
}

impl Part for u8 {
    fn written(&self) -> (TokenStream, usize) {
        (Literal::u8_unsuffixed(*self).into_token_stream(), 1)
    }
}

impl Part for bool {
    fn written(&self) -> (TokenStream, usize) {
        (quote!(#self), 0)
    }
}

impl Part for Airmode {
    fn written(&self) -> (TokenStream, usize) {
        let name = identifier(&format!("{self:?}"));
        (quote!(tables::Airmode::#name), 0)
    }
}

impl<T: Part> Part for [T] {
    fn written(&self) -> (TokenStream, usize) {
        let (items, bytes): (Vec<_>, Vec<usize>) = self.iter().map(Part::written).unzip();
        (quote!([#(#items),*]), bytes.iter().sum())
    }
}

impl<T: Part, const N: usize> Part for [T; N] {
    fn written(&self) -> (TokenStream, usize) {
        self.as_slice().written()
    }
}

impl<T: Part + ?Sized> Part for &T {
    fn written(&self) -> (TokenStream, usize) {
        let (referenced, bytes) = (**self).written();
        (quote!(&#referenced), bytes)
    }
}

impl<T: Part> Part for Option<T> {
    fn written(&self) -> (TokenStream, usize) {
        let Some((part, bytes)) = self.as_ref().map(Part::written) else {
            return (quote!(::core::option::Option::None), 0);
        };
        (quote!(::core::option::Option::Some(#part)), bytes)
    }
}

/// Structures of `mixer-rt` by their fields, with the bytes that alignment or an address adds.
macro_rules! parts {
    ($($name:ident $(<$($generic:tt),+>)? { $($field:ident),+ } $(+ $more:literal)?;)+) => {$(
        impl Part for $name $(<$($generic),+>)? {
            fn written(&self) -> (TokenStream, usize) {
                // By the field's own type: a method call would look through references.
                $(let $field = Part::written(&self.$field);)+
                let bytes = 0 $(+ $field.1)+ $(+ $more)?;
                $(let $field = $field.0;)+
                (quote!(tables::$name { $($field: #$field),+ }), bytes)
            }
        }
    )+};
}

parts! {
    Unit { allocation, effectiveness, channels, kind };
    Pair<QuantityTable> { thrust, torque };
    RotorAlone { thrust, torque };
    PairKind<QuantityTable, InverseTable> { pair, alone, inverse, mean_square_slopes };
    Unlike<'_, QuantityTable, InverseTable, true> { pairs, single_rotors };
    ThrottleRange { min, max };
    Law<'_> { reference, range, pieces };
    LawPiece { start, thrust, torque };
    Priorities { airmode, yaw_reserve_nm };
    ClosedForm<'_> {
        units, complete, thrust_n, border, slopes, walls, steep, torque_share, thrust_floor_n, thrust_middle_n,
        yaw_rounding_nm
    };
    ClosedFormUnit { allocation, arms, spin, null, per_null, ends, channels };
    Border<'_> { corners_n, grids, cells, outlines, lost_nm } + 8;
    Grid { offset, per_n };
    Cell { middle, half };
    Outline { slope, knots };
    Knot { thrust_n, drop };
    Facets { normal, bounds };
    Steep { facets, thrusts_n };
    Tolerance { efforts, wrench };
    Lag { base, rise, coast };
}

impl Part for QuantityTable {
    fn written(&self) -> (TokenStream, usize) {
        let (basis, (coefficients, bytes)) = (self.type_tokens(), self.coefficients().written());
        (quote!(#basis(#coefficients)), bytes)
    }
}

impl QuantityTable {
    /// The type in `mixer-rt`.
    pub(crate) fn type_tokens(&self) -> TokenStream {
        match self {
            QuantityTable::Biquadratic(_) => quote!(tables::Biquadratic),
            QuantityTable::Cubic(_) => quote!(tables::Cubic),
            QuantityTable::Quartic(_) => quote!(tables::Quartic),
        }
    }
}

impl Part for InverseTable {
    fn written(&self) -> (TokenStream, usize) {
        let (forms, of_forms) = self.forms.written();
        let [(upper, of_upper), (lower, of_lower)] =
            self.coefficients.each_ref().map(|c| c.as_slice().written());
        let inverse = quote!(tables::PolynomialInverse { forms: #forms, upper: #upper, lower: #lower });
        (inverse, of_forms + of_upper + of_lower)
    }
}

impl InverseTable {
    /// The type in `mixer-rt`.
    pub(crate) fn type_tokens(&self) -> TokenStream {
        let terms = Literal::usize_unsuffixed(self.coefficients[0].len());
        let steps = Literal::u8_unsuffixed(self.evaluator.steps());
        quote!(tables::PolynomialInverse<[f32; #terms], #steps>)
    }
}

pub(crate) fn identifier(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}
