//! A flight log as numbers over time, whichever stack wrote it.

use std::collections::BTreeMap;

/// A topic, and fields of it that are read together.
pub(crate) type Channel = (&'static str, &'static [&'static str]);

/// Values of one or more fields over time.
#[derive(Clone, Debug, Default)]
pub struct Series {
    time_s: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl Series {
    /// Adds values at a time, s, which is not before the last one, as many as there were before.
    pub fn push(&mut self, time_s: f64, values: Vec<f64>) {
        // Damaged rows, and a clock that runs back, are of no use.
        let is_alike = self.values.last().is_none_or(|last| last.len() == values.len());
        let is_later = self.time_s.last().is_none_or(|last| *last <= time_s);
        if time_s.is_finite() && is_alike && is_later {
            self.time_s.push(time_s);
            self.values.push(values);
        }
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

    /// Means over the times from `from` to `to`, s; the values that hold at `to` where there are none between.
    pub fn mean(&self, from: f64, to: f64) -> Option<Vec<f64>> {
        let [first, end] = [from, to].map(|limit| self.time_s.partition_point(|time| *time <= limit));
        let between = &self.values[first..end];
        let Some(width) = between.first().map(Vec::len) else {
            return self.at(to).map(<[f64]>::to_vec);
        };
        let mean = |k: usize| between.iter().map(|row| row[k]).sum::<f64>() / between.len() as f64;
        Some((0..width).map(mean).collect())
    }

    /// The same times with other values.
    pub(crate) fn map(&self, values: impl Fn(&[f64]) -> Vec<f64>) -> Series {
        Series {
            time_s: self.time_s.clone(),
            values: self.values.iter().map(|row| values(row)).collect(),
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
        self.channels.remove(&(channel, instance))
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
