//! `cargo mixer schema`: the JSON schema of the airframe file.

use std::path::PathBuf;

use mixer_files::schema;

use crate::Done;

/// Prints the JSON schema of the airframe file, by which editors complete and check it
///
/// Beside an airframe that begins with `#:schema ./airframe.schema.json`, as those of `cargo mixer
/// new` do, editors with a TOML language server (Even Better TOML, Taplo, Tombi) find it by
/// themselves.
#[derive(clap::Args, Debug)]
pub struct SchemaArgs {
    /// The file to write [default: stdout]
    #[arg(short, long, value_name = "SCHEMA.json")]
    output: Option<PathBuf>,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
}

/// Runs the command.
pub fn run(args: &SchemaArgs) -> Done {
    crate::deliver(args.output.as_deref(), args.force, &schema::text())
}
