//! `cargo page -o FOLDER`: the page of `tools/web` as static files.
//!
//! ```text
//! tools/web/src -> WebAssembly -> without what only the glue needs, packed by gzip, in base64
//! tools/web/page + glue + module -> FOLDER/index.html, one file that needs no other; FOLDER/sw.js, which
//!                                   keeps it for the next visit without a network
//! ```
//!
//! The page's content policy names its scripts and its style by their digests and allows no request.

use std::error::Error;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use sha2::{Digest as _, Sha256};
use wasm_bindgen_cli_support::Bindgen;

/// The style and the script of a report, which the page shows and saves.
const REPORT: [&str; 3] = [
    "tools/mixer-files/src/report/style.css",
    "tools/mixer-files/src/report/report.css",
    "tools/mixer-files/src/report/report.js",
];

const TARGET: &str = "wasm32-unknown-unknown";

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let ["-o", folder] = words.iter().map(String::as_str).collect::<Vec<_>>()[..] else {
        eprintln!("usage: cargo page -o FOLDER");
        return ExitCode::from(2);
    };
    match bundle(Path::new(folder)) {
        Ok(told) => {
            println!("{told}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn bundle(folder: &Path) -> Result<String, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let read = |path: &str| {
        let path = root.join(path);
        fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
    };
    let mut output = Bindgen::new()
        .input_path(module(&root)?)
        .no_modules(true)?
        .typescript(false)
        .omit_default_module_path(true)
        .remove_name_section(true)
        .remove_producers_section(true)
        .generate_output()?;
    let module = packed(&output.wasm_mut().emit_wasm())?;
    let [figures, report, report_script] = REPORT;
    let style = [figures, report, "tools/web/page/page.css"].map(read);
    let style = style.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
    let parts = [
        "tools/web/page/editor.js",
        "tools/web/page/mixer.js",
        "tools/web/page/page.js",
    ];
    let script = [report_script].into_iter().chain(parts).map(read);
    let script = script.collect::<Result<Vec<_>, _>>()?.concat();
    let worker = [output.js(), &read("tools/web/page/worker.js")?].concat();
    let watch = read("tools/web/page/watch.js")?;
    let policy = format!(
        "default-src 'none'; script-src '{}' '{}' 'wasm-unsafe-eval'; style-src '{}'; worker-src blob: 'self'; img-src data:; \
         base-uri 'none'; form-action 'none'",
        digest(&watch),
        digest(&script),
        digest(&style)
    );
    let page = read("tools/web/page/index.html")?;
    let page = [
        ("{{policy}}", policy.as_str()),
        ("{{style}}", &style),
        ("{{watch}}", &watch),
        ("{{script}}", &script),
        ("{{worker}}", &worker),
        ("{{sheet}}", &read("examples/no-bench/rotor.csv")?),
        ("{{module}}", &BASE64_STANDARD.encode(module)),
    ]
    .into_iter()
    .fold(page, |page, (place, text)| page.replacen(place, text, 1));
    fs::create_dir_all(folder)?;
    let sizes = [page.len(), packed(page.as_bytes())?.len()].map(|bytes| bytes.div_ceil(1000));
    fs::write(folder.join("index.html"), page)?;
    fs::write(folder.join("sw.js"), read("tools/web/page/sw.js")?)?;
    Ok(format!(
        "{}: {} kB, {} kB compressed",
        folder.join("index.html").display(),
        sizes[0],
        sizes[1]
    ))
}

/// Compiles the module; its path.
fn module(root: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    // Of one crate type: cargo optimises at link time only then (`lto` of the profile `page`).
    let build = [
        "rustc",
        "--locked",
        "--profile=page",
        "-p",
        "mixer-web",
        "--lib",
        "--crate-type=cdylib",
        "--target",
        TARGET,
    ];
    let built = Command::new(cargo).args(build).current_dir(root).status()?;
    if !built.success() {
        return Err(
            format!("no module; a missing target is installed by `rustup target add {TARGET}`").into(),
        );
    }
    let target =
        env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), |folder| root.join(folder));
    Ok(target.join(TARGET).join("page/mixer_web.wasm"))
}

fn packed(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut gzip = GzEncoder::new(Vec::new(), Compression::best());
    gzip.write_all(bytes)?;
    gzip.finish()
}

/// As a content policy names it.
fn digest(text: &str) -> String {
    format!("sha256-{}", BASE64_STANDARD.encode(Sha256::digest(text)))
}
