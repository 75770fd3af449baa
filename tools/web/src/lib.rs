//! What the page of `tools/web/page` calls: files and words of the command line in, JSON out.
//!
//! ```text
//! files dropped -> make::kind      what each one is
//!               -> make::make      `identify`, `predict`, `import` or `new`, by their own arguments
//! airframe file -> desk::check     faults and warnings by line, verdict
//!               -> desk::report    the report of `cargo mixer report`
//!               -> desk::output    parameters, generated Rust, golden outputs
//!               -> hand::scene, hand::mix    the mixer under the sliders
//! ```
//!
//! Every result is that of the command line to the byte: it is the same function.

use wasm_bindgen::prelude::wasm_bindgen;

pub mod desk;
pub mod edit;
pub mod hand;
pub mod make;

use desk::Checked;
use make::Files;

/// Everything that the page's worker calls. Results are JSON.
#[wasm_bindgen]
#[derive(Default)]
pub struct Desk {
    /// The airframe that compiled last.
    checked: Option<Checked>,
}

#[wasm_bindgen]
impl Desk {
    /// Without an airframe.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Desk {
        Desk::default()
    }

    /// What a file is, by its bytes: see [`make::kind`].
    pub fn kind(&self, name: &str, bytes: &[u8], options: Vec<String>) -> String {
        json(&make::kind(name, bytes, &options))
    }

    /// Runs a command that makes a pair or an airframe: see [`make::make`]. `names` and `texts` are the
    /// files that the words name.
    pub fn make(&self, words: Vec<String>, names: Vec<String>, texts: Vec<String>) -> String {
        json(&make::make(&words, &Files::new(names, texts)))
    }

    /// A line of the command line as words: see [`make::words`].
    pub fn words(&self, line: &str) -> String {
        json(&make::words(line))
    }

    /// The options of a command, as `--help` tells them.
    pub fn help(&self, command: &str) -> String {
        json(&make::help(command))
    }

    /// Compiles an airframe file and keeps it: see [`desk::check`].
    pub fn check(&mut self, name: &str, text: &str) -> String {
        let (checked, outcome) = desk::check(name, text);
        self.checked = checked;
        json(&outcome)
    }

    /// The file with a key of a table set, as `allocation`, `airmode`, `"roll-pitch"`.
    pub fn set(&self, text: &str, table: &str, key: &str, value: &str) -> String {
        json(&edit::set(text, table, key, value))
    }

    /// The report, and what of the bench files could not be shown in it: see [`Checked::report`].
    pub fn report(&self, names: Vec<String>, texts: Vec<String>) -> String {
        json(&self.ask(|checked| Ok(checked.report(&Files::new(names, texts)))))
    }

    /// The report as a whole page: see [`Checked::page`].
    pub fn page(&self, names: Vec<String>, texts: Vec<String>) -> String {
        json(&self.ask(|checked| Ok(checked.page(&Files::new(names, texts)))))
    }

    /// A file to save: see [`Checked::output`].
    pub fn output(&self, what: &str, pulses: &str) -> String {
        json(&self.ask(|checked| checked.output(what, pulses)))
    }

    /// What is drawn of the airframe: see [`hand::scene`].
    pub fn scene(&self) -> String {
        json(&self.ask(|checked| Ok(hand::scene(checked))))
    }

    /// One mix: see [`hand::mix`].
    pub fn mix(&self, wrench: Vec<f32>, volts: f32, density: f32, failed: Vec<u8>) -> String {
        json(&self.ask(|checked| hand::mix(checked, &wrench, volts, density, &failed)))
    }

    fn ask<T>(&self, ask: impl FnOnce(&Checked) -> Result<T, String>) -> Result<T, String> {
        self.checked
            .as_ref()
            .ok_or("there is no airframe yet".to_owned())
            .and_then(ask)
    }
}

/// `{"Ok": ..}` or `{"Err": ..}` of a result. Nothing here has keys that are no text.
fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
