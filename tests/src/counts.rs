//! What a mix costs on the target, counted to the instruction by the `counts` image of `examples/firmware`.

use std::fmt;

use crate::firmware::Toolchain;

/// What the requests of one set cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Count {
    /// `attainable`, `saturated` or `searched`.
    pub set: String,
    /// How many requests.
    pub requests: u64,
    /// Instructions of all of them.
    pub sum: u64,
    /// Instructions of the dearest.
    pub worst: u64,
    /// Deepest stack, bytes.
    pub stack: u64,
    /// The dearest: roll, pitch, yaw (N m), thrust (N), voltage (V).
    pub dearest: [f32; 5],
}

impl Count {
    /// Instructions per request.
    pub fn mean(&self) -> f64 {
        self.sum as f64 / self.requests as f64
    }

    fn parse(line: &str) -> Option<Count> {
        let cells: Vec<&str> = line.split_whitespace().collect();
        let [set, requests, sum, worst, stack, dearest] = cells[..] else {
            return None;
        };
        let bits: Result<Vec<u32>, _> = dearest
            .split(',')
            .map(|word| u32::from_str_radix(word, 16))
            .collect();
        Some(Count {
            set: set.to_owned(),
            requests: requests.parse().ok()?,
            sum: sum.parse().ok()?,
            worst: worst.parse().ok()?,
            stack: stack.parse().ok()?,
            dearest: <[u32; 5]>::try_from(bits.ok()?).ok()?.map(f32::from_bits),
        })
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:<10} {:>8} {:>10.1} {:>8} {:>8}",
            self.set,
            self.requests,
            self.mean(),
            self.worst,
            self.stack
        )
    }
}

/// Counts the mixer of one airframe alone in its image.
///
/// # Errors
/// As [`Toolchain::run`], or if the image prints something else.
pub fn mixer(toolchain: &Toolchain, airframe: &str) -> Result<Vec<Count>, String> {
    let text = toolchain.run("counts", &["airframe".into(), format!("airframe={airframe:?}")])?;
    let counts: Option<Vec<Count>> = text.lines().map(Count::parse).collect();
    counts
        .filter(|counts| !counts.is_empty())
        .ok_or_else(|| format!("{airframe}: not counts:\n{text}"))
}
