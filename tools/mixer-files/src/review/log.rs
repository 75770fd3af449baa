//! A flight log as numbers over time, whichever stack wrote it.

use std::collections::BTreeMap;

/// A topic, and fields of it that are read together.
pub(crate) type Channel = (&'static str, &'static [&'static str]);

/// Values of one or more fields over time.
#[derive(Clone, Debug, Default)]
pub struct Series {
    time_s: Vec<f64>,
    values: Vec<Vec<f64>>,
    /// Rows that were left out.
    dropped: usize,
}

/// The longest choice of times, none before the one ahead of it, by their indices: one damaged time stamp is
/// left out, not what stands behind it.
fn going_on(times: &[f64]) -> Vec<usize> {
    // Ends of the best choices of each length, and what stands before each index in its best choice.
    let (mut ends, mut before): (Vec<usize>, Vec<Option<usize>>) = Default::default();
    for (k, time) in times.iter().enumerate() {
        let length = ends.partition_point(|end| times[*end] <= *time);
        before.push(length.checked_sub(1).map(|at| ends[at]));
        match ends.get_mut(length) {
            Some(end) => *end = k,
            None => ends.push(k),
        }
    }
    let mut chosen: Vec<usize> = std::iter::successors(ends.last().copied(), |k| before[*k]).collect();
    chosen.reverse();
    chosen
}

/// The middle value; of none NaN.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

impl Series {
    /// Adds values at a time, s. A row before the last one, or with fewer values, is left out when the flight is
    /// reviewed.
    pub fn push(&mut self, time_s: f64, values: Vec<f64>) {
        self.time_s.push(time_s);
        self.values.push(values);
    }

    /// The rows that are whole and sound, in times that go on; the others are counted.
    pub(crate) fn believed(&self, is_sound: impl Fn(&[f64]) -> bool) -> Series {
        let width = self.values.iter().map(Vec::len).max().unwrap_or_default();
        let is_whole = |k: &usize| {
            let row = &self.values[*k];
            self.time_s[*k].is_finite() && row.len() == width && is_sound(row)
        };
        let whole: Vec<usize> = (0..self.time_s.len()).filter(is_whole).collect();
        let times: Vec<f64> = whole.iter().map(|k| self.time_s[*k]).collect();
        let kept: Vec<usize> = going_on(&times).into_iter().map(|at| whole[at]).collect();
        Series {
            time_s: kept.iter().map(|k| self.time_s[*k]).collect(),
            values: kept.iter().map(|k| self.values[*k].clone()).collect(),
            dropped: self.dropped + self.time_s.len() - kept.len(),
        }
    }

    /// Rows that were left out, and rows in all.
    pub(crate) fn dropped(&self) -> [usize; 2] {
        [self.dropped, self.dropped + self.time_s.len()]
    }

    /// Whether it has no values.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Times, s, and values, in the order of time.
    pub fn rows(&self) -> impl Iterator<Item = (f64, &[f64])> {
        self.time_s
            .iter()
            .copied()
            .zip(self.values.iter().map(Vec::as_slice))
    }

    /// The values that hold at a time, s: the last ones, or the first of all.
    pub fn at(&self, time_s: f64) -> Option<&[f64]> {
        let after = self.time_s.partition_point(|time| *time <= time_s);
        self.values.get(after.saturating_sub(1)).map(Vec::as_slice)
    }

    /// The values that hold at a time, s, where they are no older than `age_s`.
    pub(crate) fn fresh(&self, time_s: f64, age_s: f64) -> Option<&[f64]> {
        let after = self.time_s.partition_point(|time| *time <= time_s);
        let last = after.checked_sub(1)?;
        (time_s - self.time_s[last] <= age_s).then(|| self.values[last].as_slice())
    }

    /// The values nearest to a time, s, where they are nearer than `within_s`.
    pub fn nearest(&self, time_s: f64, within_s: f64) -> Option<&[f64]> {
        let after = self.time_s.partition_point(|time| *time < time_s);
        let distance = |at: &usize| (self.time_s[*at] - time_s).abs();
        let candidates = [after.saturating_sub(1), after]
            .into_iter()
            .filter(|at| *at < self.time_s.len());
        let nearest = candidates.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        (distance(&nearest) <= within_s).then(|| self.values[nearest].as_slice())
    }

    /// The values at times from `from` on, before `to`, s.
    pub(crate) fn within(&self, from: f64, to: f64) -> &[Vec<f64>] {
        let [first, end] = [from, to].map(|limit| self.time_s.partition_point(|time| *time < limit));
        &self.values[first..end]
    }

    /// Means over the times from `from` to `to`, s; the values that hold at `to` where there are none between, no
    /// older than `age_s`.
    pub(crate) fn mean(&self, from: f64, to: f64, age_s: f64) -> Option<Vec<f64>> {
        let [first, end] = [from, to].map(|limit| self.time_s.partition_point(|time| *time <= limit));
        let between = &self.values[first..end];
        let Some(width) = between.first().map(Vec::len) else {
            return self.fresh(to, age_s).map(<[f64]>::to_vec);
        };
        let mean = |k: usize| between.iter().map(|row| row[k]).sum::<f64>() / between.len() as f64;
        Some((0..width).map(mean).collect())
    }

    /// Its rows, with those of another behind them that hold at their times.
    pub(crate) fn with(&self, other: &Series) -> Series {
        let mut all = Series::default();
        for (time_s, row) in self.rows() {
            let values = other.at(time_s).map(|more| [row, more].concat());
            values.into_iter().for_each(|values| all.push(time_s, values));
        }
        all
    }

    /// The same times with other values.
    pub(crate) fn map(&self, values: impl Fn(&[f64]) -> Vec<f64>) -> Series {
        Series {
            time_s: self.time_s.clone(),
            values: self.values.iter().map(|row| values(row)).collect(),
            dropped: self.dropped,
        }
    }
}

/// A log's wanted channels and its parameters.
#[derive(Debug, Default)]
pub(crate) struct Log {
    /// Of each instance of a topic.
    channels: BTreeMap<(Channel, u8), Series>,
    /// By name, the last value of each.
    pub(crate) parameters: BTreeMap<String, f64>,
    /// What is missing of a log that is damaged or cut off.
    pub(crate) damage: Option<String>,
}

impl Log {
    /// Adds a message: its fields up to the first that it lacks.
    pub(crate) fn push(
        &mut self,
        channel: Channel,
        instance: u8,
        time_s: f64,
        value: impl Fn(&str) -> Option<f64>,
    ) {
        let values: Vec<f64> = channel.1.iter().map_while(|field| value(field)).collect();
        if !values.is_empty() {
            self.channels
                .entry((channel, instance))
                .or_default()
                .push(time_s, values);
        }
    }

    /// Takes a channel with the fields that the log has of it.
    pub(crate) fn some(&mut self, channel: Channel, instance: u8) -> Option<Series> {
        let series = self.channels.remove(&(channel, instance))?.believed(|_| true);
        (!series.is_empty()).then_some(series)
    }

    /// Takes a channel; `None` where the log lacks one of its fields.
    pub(crate) fn series(&mut self, channel: Channel, instance: u8) -> Option<Series> {
        let is_whole = |series: &Series| {
            series
                .values
                .first()
                .is_some_and(|row| row.len() == channel.1.len())
        };
        self.some(channel, instance).filter(is_whole)
    }

    /// A parameter, or its default.
    pub(crate) fn parameter(&self, name: &str, default: f64) -> f64 {
        self.parameters.get(name).copied().unwrap_or(default)
    }
}
