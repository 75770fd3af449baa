//! Compiles the airframes of this product line: `<name>.toml` to `OUT_DIR/<name>.rs`.

fn main() {
    mixer_compiler::build_script::compile("../../airframes/isae-x8.toml");
    mixer_compiler::build_script::compile("../../airframes/px4-y6.toml");
}
