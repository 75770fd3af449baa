//! The page in headless Chromium: no console message, and values under the pointer.
//!
//! Without a browser this prints that it did not run; it fails where `MIXER_BROWSER=1` or `CI=true`
//! asks for it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use mixer_compiler::Compiled;
use mixer_files::report::page::page;
use mixer_files::report::study::Study;

use super::{compiled, root, scratch};

/// Moves the pointer over every picture that answers, and lists what it says in the page's own
/// text.
const POINTER: &str = r#"<script>
for (const svg of document.querySelectorAll("svg[data-hover]")) {
  const [left, top, width, height] = svg.dataset.box.split(" ").map(Number);
  const at = new DOMPoint(left + 0.42 * width, top + 0.48 * height).matrixTransform(svg.getScreenCTM());
  svg.dispatchEvent(new PointerEvent("pointerdown", { clientX: at.x, clientY: at.y }));
}
</script></body>"#;

/// Ticks the third box, shows the same content anew in an element that is made for it, and lists
/// which boxes are ticked there, pictures with more than one cross, what a copy button selects, and
/// selectors of the report's style that do not begin at it.
const AGAIN: &str = r#"<script>
const model = JSON.parse(document.getElementById("model").textContent);
const main = document.querySelector("main");
document.querySelectorAll(".seen input")[2].click();
const fresh = document.createElement("div");
fresh.className = "report";
fresh.innerHTML = main.innerHTML;
for (const made of fresh.querySelectorAll(".copy, .cross")) made.remove();
main.replaceWith(fresh);
report(fresh, model);
const boxes = [...fresh.querySelectorAll(".seen input")];
fresh.querySelector(".copy").click();
const rules = (list) => [...list].flatMap((rule) => rule.media ? rules(rule.cssRules) : rule.selectorText.split(", "));
const outside = rules(document.styleSheets[0].cssRules).filter((selector) => !/^(svg\.figure|\.report$|:root$)/.test(selector));
addEventListener("load", () => setTimeout(() => {
  const ticked = boxes.flatMap((box, k) => box.checked ? [k] : []);
  const rows = fresh.querySelectorAll("tr.check").length;
  const crosses = fresh.querySelectorAll("svg[data-hover] .cross").length - fresh.querySelectorAll("svg[data-hover]").length;
  document.body.textContent = [ticked, boxes.length === rows, crosses, getSelection().toString(),
    fresh.querySelector(".copy").textContent !== "copy", document.styleSheets.length, outside].join("; ");
}, 500));
</script></body>"#;

/// A page in a window WIDTH px wide, what of it is wider than that, and the height of the smallest
/// type in its pictures, px.
const FRAMED: &str = r#"<iframe src="PAGE" style="width:WIDTHpx;height:30000px;border:0"></iframe><script>
addEventListener("load", () => {
  const page = document.querySelector("iframe").contentDocument;
  const wide = [...page.querySelectorAll(".wide")].filter((box) => box.scrollWidth > box.clientWidth);
  const names = wide.map((box) => box.closest("section").querySelector("h2").textContent);
  const type = [...page.querySelectorAll("svg.figure text")].map((text) =>
    parseFloat(page.defaultView.getComputedStyle(text).fontSize) * Math.sqrt(Math.abs(text.getScreenCTM().a ** 2 + text.getScreenCTM().b ** 2)));
  const root = page.documentElement;
  document.body.textContent = `${root.scrollWidth} of ${root.clientWidth}: ${[...new Set(names)].join("; ")}, ${Math.min(...type)}`;
});
</script>"#;

fn browser() -> Option<PathBuf> {
    let named = env::var_os("MIXER_CHROMIUM").map(PathBuf::from);
    let folders = env::var_os("PATH").unwrap_or_default();
    let installed = env::split_paths(&folders)
        .flat_map(|folder| ["chromium", "chromium-browser", "google-chrome"].map(|name| folder.join(name)))
        .find(|path| path.is_file());
    named.or(installed)
}

/// The browser; without one the test says that it did not run, or fails where it was asked for.
fn wanted_browser() -> Option<PathBuf> {
    let found = browser();
    if found.is_none() {
        let asked =
            env::var("MIXER_BROWSER").is_ok_and(|x| x == "1") || env::var("CI").is_ok_and(|x| x == "true");
        let hint = "no chromium in PATH or MIXER_CHROMIUM: apt-get install chromium";
        assert!(!asked, "{hint}");
        println!("NOT RUN: {hint}");
    }
    found
}

/// Opens a page; its DOM after the scripts ran, and the messages on its console.
fn open(browser: &Path, page: &Path) -> (String, Vec<String>) {
    let profile = page.with_extension("profile");
    let mut command = Command::new(browser);
    command.args([
        "--headless=new",
        "--disable-gpu",
        "--no-first-run",
        "--window-size=1300,900",
    ]);
    // A container has neither the privileges of the sandbox nor the shared memory.
    command.args(["--no-sandbox", "--disable-dev-shm-usage"]);
    command.args([
        "--enable-logging=stderr",
        "--virtual-time-budget=4000",
        "--allow-file-access-from-files",
        "--dump-dom",
    ]);
    command.arg(format!("--user-data-dir={}", profile.display()));
    let address = format!("file://{}", page.canonicalize().unwrap().display());
    let output = command.arg(address).output().unwrap();
    let _ = fs::remove_dir_all(&profile);
    let messages = String::from_utf8_lossy(&output.stderr)
        .lines()
        .filter(|line| line.contains("CONSOLE"))
        .map(str::to_owned)
        .collect();
    (String::from_utf8_lossy(&output.stdout).into_owned(), messages)
}

/// One unit, four and six, with a mass and power and without, and two pairs.
fn shown() -> Vec<Compiled> {
    let names = [
        "single-pair",
        "isae-x8",
        "px4-x12",
        "x8-11in-least-power",
        "x8-22-16in",
    ];
    names
        .map(|name| compiled(&root().join(format!("airframes/{name}.toml"))))
        .into()
}

#[test]
fn pages_open_without_errors_and_show_values() {
    let Some(browser) = wanted_browser() else {
        return;
    };
    for compiled in shown() {
        let name = compiled.airframe.name.clone();
        let study = Study::new(&compiled, None);
        let html = page(&study, None, None);
        let path = scratch(&format!("{name}.html"));
        fs::write(&path, html.replace("</body>", POINTER)).unwrap();
        let (dom, messages) = open(&browser, &path);
        assert!(messages.is_empty(), "{name}: {messages:#?}");
        let answers: Vec<&str> = dom
            .split("<div class=\"readout\">")
            .skip(1)
            .map(|rest| rest.split("</div>").next().unwrap_or_default())
            .collect();
        assert!(answers.len() >= 10, "{name}: {answers:?}");
        for answer in &answers {
            let values = answer.split("<output>").skip(1);
            let values: Vec<&str> = values
                .map(|rest| rest.split('<').next().unwrap_or_default())
                .collect();
            // A tap fills the values, at least that of the place itself.
            assert!(
                values.len() >= 2 && values[0] != "\u{2013}",
                "{name}: {answers:#?}"
            );
            assert!(!answer.contains("NaN"), "{name}: {answers:#?}");
        }
        assert!(
            answers.iter().any(|text| text.contains("error about")),
            "{name}: {answers:#?}"
        );
        // The first picture is read off where it is drawn, to a pixel of 200.
        let mut read = answers[0].split("<output>").skip(1);
        let mut next = || -> f64 { read.next().unwrap().split('<').next().unwrap().parse().unwrap() };
        let thrust_n = next();
        for (volts, _) in study.voltages() {
            let (throttles, delivered) = study.mix([0.0, 0.0, 0.0, thrust_n], &study.at(volts));
            let pairs = study.by_unit(&throttles);
            let upper = pairs.iter().map(|pair| pair[0]).sum::<f64>() / pairs.len() as f64;
            let shown = next();
            assert!(delivered, "{name}: {thrust_n} N at {volts:?} V");
            assert!(
                (shown - upper).abs() < 0.005,
                "{name}: {shown} at {thrust_n} N and {volts:?} V, {upper}"
            );
        }
    }

    // The test can fail: a broken script and a reference to outside are both told.
    let broken = scratch("broken.html");
    let html = page(&Study::new(&shown()[0], None), None, None);
    fs::write(
        &broken,
        html.replace("document.getElementById(\"model\")", "document.nothing.there"),
    )
    .unwrap();
    let (_, messages) = open(&browser, &broken);
    assert!(
        messages.iter().any(|text| text.contains("TypeError")),
        "{messages:#?}"
    );
    let outside = "<script src=\"https://example.org/x.js\"></script></body>";
    fs::write(&broken, html.replace("</body>", outside)).unwrap();
    let (_, messages) = open(&browser, &broken);
    assert!(
        messages
            .iter()
            .any(|text| text.contains("Content Security Policy")),
        "{messages:#?}"
    );
}

#[test]
fn a_check_is_kept_where_the_content_is_shown_again() {
    let Some(browser) = wanted_browser() else {
        return;
    };
    let compiled = compiled(&root().join("airframes/isae-x8.toml"));
    let html = page(&Study::new(&compiled, None), None, None);
    let path = scratch("again.html");
    fs::write(&path, html.replace("</body>", AGAIN)).unwrap();
    let (dom, messages) = open(&browser, &path);
    assert!(messages.is_empty(), "{messages:#?}");
    let (_, told) = dom.split_once("<body>").expect("a body");
    let told = told.split("</body>").next().unwrap_or_default();
    assert_eq!(
        told.trim(),
        "2; true; 0; actuator_test set -m 1 -v 0.15 -t 2; true; 2;"
    );
}

/// On a phone and on a desk no table is cut, and the type of pictures is 12 px at least.
#[test]
fn pages_fit_their_window_with_type_that_can_be_read() {
    let Some(browser) = wanted_browser() else {
        return;
    };
    let digest = "0123456789abcdef".repeat(4);
    for compiled in shown() {
        let name = compiled.airframe.name.clone();
        let path = scratch(&format!("{name}-framed.html"));
        fs::write(&path, page(&Study::new(&compiled, None), None, Some(&digest))).unwrap();
        let framed = path.file_name().unwrap().to_string_lossy();
        for width in ["390", "1400"] {
            let frame = scratch(&format!("{name}-{width}.html"));
            fs::write(&frame, FRAMED.replace("PAGE", &framed).replace("WIDTH", width)).unwrap();
            let (dom, _) = open(&browser, &frame);
            let (_, told) = dom.split_once("<body>").expect("a body");
            let told = told.split("</body>").next().unwrap_or_default().trim();
            let (fits, smallest) = told.rsplit_once(", ").expect("what was measured");
            assert_eq!(fits, format!("{width} of {width}: "), "{name}");
            let smallest: f64 = smallest.parse().unwrap();
            assert!(
                smallest >= 12.0,
                "{name}: {smallest} px in a window of {width} px"
            );
        }
    }
}
