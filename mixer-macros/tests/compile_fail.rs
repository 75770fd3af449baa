//! What the macro says of input it cannot use: `ui/<case>.rs` and the expected `.stderr` beside it.
//! After a change that is meant, `TRYBUILD=overwrite cargo test -p mixer-macros --test
//! compile_fail` writes them anew.

#[test]
fn refusals_of_the_macro() {
    trybuild::TestCases::new().compile_fail("tests/ui/*.rs");
}
