//! A flight log as numbers over time, whichever stack wrote it.

use std::collections::BTreeMap;

/// Topics, each with the fields that are read of it.
pub(crate) type Wanted = [(&'static str, &'static [&'static str])];

/// Values of one or more fields over time.
#[derive(Clone, Debug, Default)]
pub struct Series {
    time_s: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl Series {
    /// Adds values at a time, s, which is not before the last one.
    pub fn push(&mut self, time_s: f64, values: Vec<f64>) {
        // A clock that runs back would break every search: such rows are of no use.
        if time_s.is_finite() && self.time_s.last().is_none_or(|last| *last <= time_s) {
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

/// What was read of one instance of a topic.
#[derive(Debug, Default)]
struct Topic {
    fields: Vec<&'static str>,
    series: Series,
}

/// A log's wanted topics and its parameters.
#[derive(Debug, Default)]
pub(crate) struct Log {
    topics: BTreeMap<(&'static str, u8), Topic>,
    /// By name, the last value of each.
    pub(crate) parameters: BTreeMap<String, f64>,
    /// What is missing of a log that is damaged or cut off.
    pub(crate) damage: Option<String>,
}

impl Log {
    /// Adds a message: those of the fields that it has.
    pub(crate) fn push(
        &mut self,
        (topic, fields): (&'static str, &[&'static str]),
        instance: u8,
        time_s: f64,
        value: impl Fn(&str) -> Option<f64>,
    ) {
        let found = fields.iter().filter_map(|field| Some((*field, value(field)?)));
        let (fields, values): (Vec<&str>, Vec<f64>) = found.unzip();
        let topic = self.topics.entry((topic, instance)).or_insert_with(|| Topic {
            fields: fields.clone(),
            series: Series::default(),
        });
        if topic.fields == fields {
            topic.series.push(time_s, values);
        }
    }

    /// Fields of one instance of a topic; `None` where the log lacks one of them.
    pub(crate) fn series(&self, topic: &'static str, instance: u8, fields: &[&str]) -> Option<Series> {
        let topic = self
            .topics
            .get(&(topic, instance))
            .filter(|topic| !topic.series.is_empty())?;
        let column = |field: &&str| topic.fields.iter().position(|of| of == field);
        let columns: Vec<usize> = fields.iter().map(column).collect::<Option<_>>()?;
        Some(
            topic
                .series
                .map(|row| columns.iter().map(|at| row[*at]).collect()),
        )
    }

    /// How many of numbered fields, `{}` being the number from `first` on, a topic has.
    pub(crate) fn numbered(&self, topic: &'static str, name: &str, first: usize) -> Vec<String> {
        let Some(topic) = self.topics.get(&(topic, 0)) else {
            return Vec::new();
        };
        let names = (first..).map(|number| name.replace("{}", &number.to_string()));
        names
            .take_while(|name| topic.fields.contains(&name.as_str()))
            .collect()
    }

    /// A parameter, or its default.
    pub(crate) fn parameter(&self, name: &str, default: f64) -> f64 {
        self.parameters.get(name).copied().unwrap_or(default)
    }
}
