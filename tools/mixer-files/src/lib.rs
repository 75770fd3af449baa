//! Files about an airframe, as texts: new ones of regular frames, ones from a flight stack's
//! parameters, parameters for a flight stack, the JSON schema, golden outputs, the report page, what a
//! flight log says of the model, C libraries.
//!
//! Texts in, texts and notes out. Only [`library`] touches the disk: it runs the Rust compiler in a folder of
//! its own.
//!
//! ```
//! use mixer_compiler::Source;
//! use mixer_files::frame::{Frame, NewFrame};
//! use mixer_files::params::{Options, params};
//! use mixer_files::params::Stack;
//!
//! let frame = NewFrame { arm_m: Some(0.45), ..NewFrame::of(Frame::X8) };
//! let text = mixer_files::new::new(&frame, None).unwrap();
//! let compiled = mixer_compiler::compile(&Source::new("my-x8.toml", text)).unwrap();
//! let made = params(&compiled, "my-x8.toml", &Options::of(Stack::Px4)).unwrap();
//! assert!(made.text.contains("CA_ROTOR_COUNT\t8"));
//! ```

pub mod frame;
pub mod golden;
pub mod import;
pub mod kind;
pub mod library;
pub mod new;
pub mod params;
pub mod report;
pub mod review;
pub mod schema;
mod stacks;
pub mod vectors;
