//! Arguments of regular frames.

use std::path::Path;

use mixer_files::frame::{Frame, NewFrame};
use mixer_files::params::Stack;

use crate::bench_args::{quantity, words};

/// `--frame`, `--arm`, `--name`, `--outputs`.
#[derive(clap::Args, Clone, Debug)]
pub struct FrameArgs {
    /// The frame
    // Not required by itself: `identify` writes the tables alone without it, `new` misses it all
    // the same.
    #[arg(long, value_parser = words(&Frame::ALL), required = false)]
    pub frame: Frame,
    /// Distance of every pair from the centre of gravity, m; not for a single pair
    #[arg(long, value_name = "METRE", value_parser = arm, requires = "frame")]
    pub arm: Option<f64>,
    /// Name of the airframe [default: that of the output file]
    #[arg(long, requires = "frame")]
    pub name: Option<String>,
    /// Outputs in the motor order of a flight stack, which has this frame; else the upper rotors
    /// first, clockwise
    #[arg(long, value_parser = words(&Stack::ALL), value_name = "STACK", requires = "frame")]
    pub outputs: Option<Stack>,
}

/// `0.45`, or with its unit, as `45cm`.
fn arm(text: &str) -> Result<f64, String> {
    let mut units = [("mm", 1e3), ("cm", 1e2), ("m", 1.0)].into_iter();
    let found = units.find_map(|(unit, per)| Some((text.strip_suffix(unit)?, per)));
    let (number, per) = found.unwrap_or((text, 1.0));
    quantity(number, "metres").map(|x| x / per)
}

impl FrameArgs {
    /// The frame of an airframe that is written to `output`.
    pub fn frame<'a>(&'a self, output: Option<&'a Path>) -> NewFrame<'a> {
        NewFrame {
            frame: self.frame,
            arm_m: self.arm,
            name: self.name.as_deref(),
            file: output.and_then(Path::file_stem).and_then(|stem| stem.to_str()),
            outputs: self.outputs,
            pairs: Vec::new(),
        }
    }
}
