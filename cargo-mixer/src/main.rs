//! `cargo mixer`.
fn main() {
    let path = std::env::args().nth(1).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let t = std::time::Instant::now();
    match mixer_compiler::compile(&mixer_compiler::Source::new(path, text)) {
        Ok(c) => {
            eprintln!("{:?}", t.elapsed());
            println!("{}", mixer_compiler::report::Report(&c));
            println!("{}", c.rust());
        }
        Err(e) => println!("{e}"),
    }
}
