//! No floating-point exception: a host's flight stack may trap them (ArduPilot's simulator does).

use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use super::program::{Golden, source};
use super::{Folder, library, root, run};

/// Setpoints per airframe and airmode.
const SETPOINTS: usize = 40_000;

const AIRMODES: [&str; 3] = ["disabled", "roll-pitch", "roll-pitch-yaw"];

/// Frames in every airmode: a closed form of four and of three units, and none. The others are in the first.
const FRAMES: [&str; 3] = ["isae-x8", "px4-y6", "px4-x12"];

/// An airframe's file with this airmode, and another name.
fn with_airmode(text: &str, name: &str, airmode: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with("airmode"));
    let mut text: String = lines.flat_map(|line| [line, "\n"]).collect();
    if !text.contains("[allocation]\n") {
        text += "\n[allocation]\n";
    }
    let key = format!("[allocation]\nairmode = \"{airmode}\"\n");
    let quoted = |name: &str| format!("name = \"{name}\"");
    text.replacen("[allocation]\n", &key, 1)
        .replacen(&quoted(name), &quoted(&format!("{name}-{airmode}")), 1)
}

/// Mixes in every airframe, with all rotors and with some out: nothing is trapped, and no division is by a
/// vector.
#[test]
fn no_mix_raises_an_exception() {
    let folder = Folder::new("exceptions");
    let (mut files, mut headers, mut list) = (Vec::new(), String::new(), String::new());
    for module in Golden::new().modules {
        let name = module.replace('_', "-");
        let text = fs::read_to_string(root().join(format!("airframes/{name}.toml"))).unwrap();
        let airmodes = match FRAMES.contains(&name.as_str()) {
            true => &AIRMODES[..],
            false => &AIRMODES[..1],
        };
        for airmode in airmodes {
            let file = folder.join(&format!("{name}-{airmode}.toml"));
            fs::write(&file, with_airmode(&text, &name, airmode)).unwrap();
            files.push(file.display().to_string());
            let module = format!("{module}_{}", airmode.replace('-', "_"));
            let _ = writeln!(headers, "#include \"{module}.h\"");
            let _ = write!(list, " X({module}, {})", module.to_uppercase());
        }
    }
    let arguments: Vec<&str> = files.iter().map(String::as_str).chain(["--health"]).collect();
    run(&mut library(&arguments, &folder.0));
    fs::write(
        folder.join("airframes.h"),
        format!("{headers}#define AIRFRAMES(X){list}\n"),
    )
    .unwrap();
    let archives = folder.names().into_iter().filter(|name| name.ends_with(".a"));
    let archives: Vec<_> = archives.map(|name| folder.join(&name)).collect();
    let program = folder.join("exceptions");
    let mut compiler = Command::new("gcc");
    compiler.args(["-std=c11", "-O2", "-Wall", "-Wextra", "-Werror"]);
    compiler
        .arg("-I")
        .arg(&folder.0)
        .arg(source("exceptions.c"))
        .args(&archives);
    run(compiler.args(["-lm", "-o"]).arg(&program));
    let output = run(Command::new(&program).arg(SETPOINTS.to_string()));
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.matches(": no exception\n").count(), files.len(), "{text}");

    // Exceptions of idle lanes depend on what is in them: there must be none of these instructions.
    let code = run(Command::new("objdump").arg("-d").args(&archives)).stdout;
    let code = String::from_utf8_lossy(&code);
    assert!(code.contains("divss"), "{} bytes of no code", code.len());
    for packed in ["divps", "divpd", "sqrtps", "sqrtpd"] {
        assert!(!code.contains(packed), "{packed}");
    }
}
