//! The simulator as a process.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Output, Stdio};

pub(crate) const AIRFRAME: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");

/// A simulator that serves a free port as fast as it can.
pub(crate) struct Server {
    child: Child,
    stderr: BufReader<ChildStderr>,
    /// Where it listens.
    pub(crate) port: u16,
    /// Throttle in hover, as it predicts.
    pub(crate) hover: f64,
    said: String,
    flight: PathBuf,
}

/// How it ended.
#[derive(Debug)]
pub(crate) struct End {
    pub(crate) status: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
    pub(crate) flight: PathBuf,
}

fn sitl(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sitl"));
    command.arg(AIRFRAME).args(arguments);
    command
}

/// Runs it to its end.
pub(crate) fn run(arguments: &[&str]) -> Output {
    sitl(arguments).output().unwrap()
}

impl Server {
    pub(crate) fn start(name: &str, arguments: &[&str]) -> Server {
        let flight = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.csv"));
        let mut child = sitl(arguments)
            .args(["--port", "0", "--speed", "0", "-o"])
            .arg(&flight)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut stderr = BufReader::new(child.stderr.take().unwrap());
        let mut said = String::new();
        while !said.contains("waiting for") {
            assert!(stderr.read_line(&mut said).unwrap() > 0, "{said}");
        }
        let last = |line: &str| line.split_whitespace().last().unwrap().to_owned();
        let mut lines = said.lines();
        let hover = last(lines.next().unwrap()).parse().unwrap();
        let port = last(lines.next().unwrap()).parse().unwrap();
        Server {
            child,
            stderr,
            port,
            hover,
            said,
            flight,
        }
    }

    /// Waits for its end.
    pub(crate) fn end(mut self) -> End {
        let mut stdout = String::new();
        self.child
            .stdout
            .take()
            .unwrap()
            .read_to_string(&mut stdout)
            .unwrap();
        let mut stderr = std::mem::take(&mut self.said);
        self.stderr.read_to_string(&mut stderr).unwrap();
        let status = self.child.wait().unwrap().code();
        End {
            status,
            stdout,
            stderr,
            flight: self.flight.clone(),
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It has ended, or its client has.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Rows of a CSV file, the header first.
pub(crate) fn csv_rows(path: &Path) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_path(path)
        .unwrap();
    let rows = reader
        .records()
        .map(|row| row.unwrap().iter().map(str::to_owned).collect());
    rows.collect()
}
