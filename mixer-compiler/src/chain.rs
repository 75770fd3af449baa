//! Chains of chords: what draws a border with few corners.

/// The chains from the first corner to the last that lose least, one of each number of chords.
pub(crate) struct Chains {
    last: usize,
    /// What the chain of 1, 2, .. chords loses.
    pub(crate) lost: Vec<f64>,
    /// Per number of chords, the corner before each corner.
    origins: Vec<Vec<usize>>,
}

impl Chains {
    /// Chains of `most` chords and fewer, up to the first that loses no more than `enough`. `chords` are, per corner where
    /// they start, those where they end and what they lose.
    pub(crate) fn new(chords: &[Vec<(usize, f64)>], last: usize, enough: f64, most: usize) -> Chains {
        let mut chains = Chains {
            last,
            lost: Vec::new(),
            origins: Vec::new(),
        };
        let count = chords.len().max(last + 1);
        // What it takes to come to each corner.
        let mut least = vec![f64::INFINITY; count];
        least[0] = 0.0;
        while least[last] > enough && chains.lost.len() < most {
            let mut next = vec![f64::INFINITY; count];
            let mut from = vec![0; count];
            for (start, chords) in chords.iter().enumerate() {
                if least[start] == f64::INFINITY {
                    continue;
                }
                for &(end, lost) in chords {
                    let sum = least[start] + lost;
                    if sum < next[end] {
                        next[end] = sum;
                        from[end] = start;
                    }
                }
            }
            least = next;
            chains.lost.push(least[last]);
            chains.origins.push(from);
        }
        chains
    }

    /// The corners of the chain at `index`, the first and the last among them; `None` where there is none of so many chords.
    pub(crate) fn corners(&self, index: usize) -> Option<Vec<usize>> {
        if !self.lost.get(index)?.is_finite() {
            return None;
        }
        let mut at = self.last;
        let mut corners = vec![at];
        for from in self.origins[..=index].iter().rev() {
            at = from[at];
            corners.push(at);
        }
        corners.reverse();
        Some(corners)
    }
}
