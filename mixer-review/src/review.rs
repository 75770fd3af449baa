//! What a flight says of the model.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Axis;
use mixer_compiler::airframe::GRAVITY;
use mixer_compiler::diagnostic::rounded;
use mixer_compiler::hover::band;
use mixer_rt::{Health, Wrench};
use serde::Serialize;

use crate::flight::{Flight, Stack};
use crate::rows::{Row, Rows};
use crate::saturated::{Margin, Saturated};
use crate::thrust::Thrust;

/// What the log does not have.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Mass in this flight, kg; without it that of the airframe file.
    pub mass_kg: Option<f64>,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds; without them those that the airframe
    /// file remembers, else 1000 and 2000.
    pub bench_us: Option<[f64; 2]>,
}

/// A log over a model.
#[derive(Clone, Debug, Serialize)]
pub struct Review {
    /// Name of the airframe.
    pub airframe: String,
    /// The stack that wrote the log.
    pub stack: Stack,
    /// Times, s: of the log, in the air away from the ground, and in hover with all rotors.
    pub seconds: [f64; 3],
    /// Mass that the measured thrust is of, kg.
    pub mass_kg: f64,
    /// The model's thrust over the measured one.
    pub thrust: Thrust,
    /// Hover.
    pub hover: Hover,
    /// The battery's voltage, V; `None` where it was not logged, or the airframe ignores it.
    pub voltage: Option<Range>,
    /// The air's density, kg/m3; `None` where it was not logged.
    pub density: Option<Range>,
    /// Who was cut, and how often.
    pub saturated: Saturated,
    /// The least that was left to a rotor.
    pub margin: Margin,
    /// Rotors that stopped in the air.
    pub stopped: Vec<Stopped>,
    /// What deserves a look, a sentence each.
    pub warnings: Vec<String>,
    /// What no log, or not this one, tells.
    pub not_told: Vec<String>,
    /// Throttles `[upper, lower]` of all pairs in the air, some hundreds of them.
    #[serde(skip)]
    pub flown: Vec<[f64; 2]>,
}

/// Hover by the log, all rotors turning; `None` where it does not hover.
#[derive(Clone, Debug, Serialize)]
pub struct Hover {
    /// Mean throttle of the upper rotors.
    pub upper: Option<f64>,
    /// Mean throttle of the lower rotors.
    pub lower: Option<f64>,
    /// Both by the model, for the mass and the voltage of the log; `None` where it carries no such weight.
    pub model: Option<[f64; 2]>,
    /// Torque that the model leaves in a straight hover, where there is none, N m.
    pub roll_nm: Option<f64>,
    /// Likewise.
    pub pitch_nm: Option<f64>,
    /// Likewise.
    pub yaw_nm: Option<f64>,
    /// Where the centre of gravity is for that, forward and right of the file's, m.
    pub centre_m: Option<[f64; 2]>,
}

/// A measured quantity in the air.
#[derive(Clone, Debug, Serialize)]
pub struct Range {
    /// Least.
    pub least: f64,
    /// Largest.
    pub largest: f64,
    /// The range in the airframe file; `None` where it has none.
    pub range: Option<[f64; 2]>,
    /// Share of the time outside of it.
    pub outside: f64,
}

/// A rotor that stopped.
#[derive(Clone, Debug, Serialize)]
pub struct Stopped {
    /// Its output.
    pub output: usize,
    /// When, s of the log.
    pub time_s: f64,
}

/// Points of the map that are kept.
const POINTS: usize = 400;

/// Share of the scale by which parts of one flight may differ.
const PARTS_OFF: f64 = 0.04;

/// Distance of the centre of gravity that is worth a word, m, and the torque in yaw, as a share of the
/// pair's largest over all units.
const CENTRE_M: f64 = 0.01;
const YAW_LEFT: f64 = 0.03;

/// How long a rotor is off that has stopped, s.
const STOPPED_S: f64 = 1.0;

/// Share of the time that is worth a word.
const OFTEN: f64 = 0.01;

impl Review {
    /// Reads a log and holds it against the model.
    ///
    /// # Errors
    /// A log that is none of this vehicle or has no flight, or an airframe without a mass: what and
    /// the way out.
    pub fn new(name: &str, log: &[u8], compiled: &Compiled, options: &Options) -> Result<Review, String> {
        let flight = Flight::read(name, log, &compiled.airframe, options.bench_us)?;
        Review::of(&flight, compiled, options.mass_kg).map_err(|error| format!("{name}: {error}"))
    }

    /// Holds a flight against the model; `mass_kg` in place of the file's.
    ///
    /// # Errors
    /// As [`Review::new`].
    pub fn of(flight: &Flight, compiled: &Compiled, mass_kg: Option<f64>) -> Result<Review, String> {
        let of_file = compiled.airframe.vehicle.as_ref().map(|vehicle| vehicle.mass_kg);
        let mass_kg = mass_kg.or(of_file).ok_or(
            "the accelerometer measures thrust over mass: write `[vehicle] mass_kg` in the airframe file, or give --mass KG",
        )?;
        if flight.throttle.is_empty() || flight.force.is_empty() {
            return Err("the log has no outputs or no accelerometer".to_owned());
        }
        let rows = Rows::new(flight, compiled, mass_kg);
        let whole = |row: &Row| row.health == Health::GOOD;
        let (thrust, is_short) = Thrust::new(&rows, mass_kg).ok_or_else(|| {
            format!(
                "a log of the ground: {:.0} s, of which the vehicle is in the air with all rotors for {:.1} s; some seconds of hover are \
                 the least",
                rows.seconds,
                rows.seconds_of(whole)
            )
        })?;
        let margin = Margin::new(&rows, compiled).ok_or("no rotor turns in the air")?;
        let mut review = Review {
            airframe: compiled.airframe.name.clone(),
            stack: flight.stack,
            seconds: [
                rows.seconds,
                rows.seconds_of(|_| true),
                rows.seconds_of(|row| row.hovers),
            ],
            mass_kg,
            thrust,
            hover: Hover::new(&rows, compiled, mass_kg),
            voltage: flight
                .voltage
                .as_ref()
                .zip(compiled.airframe.voltage.as_ref())
                .and_then(|(_, law)| {
                    Range::new(&rows, Some(law.range), |row| row.conditions.voltage_v.into())
                }),
            density: flight.density.as_ref().and_then(|density| {
                let range = compiled.airframe.air.as_ref().map(|law| law.range);
                Range::new(&rows, range, |row| {
                    density.at(row.time_s).map_or(f64::NAN, |density| density[0])
                })
            }),
            saturated: Saturated::new(&rows, flight, compiled),
            margin,
            stopped: stopped(&rows),
            warnings: Vec::new(),
            not_told: vec![
                "the shape of the map: in flight both rotors of a pair move together".to_owned(),
                "the scale of the torque: it takes fast yaw and a known inertia".to_owned(),
            ],
            flown: flown(&rows, compiled),
        };
        review.warn(flight, compiled, &rows, is_short);
        Ok(review)
    }

    fn warn(&mut self, flight: &Flight, compiled: &Compiled, rows: &Rows, is_short: bool) {
        let mut warnings: Vec<String> = flight.damage.clone().into_iter().collect();
        let Thrust {
            scale,
            interval: [low, high],
            ..
        } = self.thrust;
        if is_short {
            warnings.push(format!(
                "only {:.1} s of hover: the scale is that of all {:.0} s in the air, with their climbs and speeds in it",
                self.seconds[2], self.seconds[1]
            ));
        }
        if low > 1.0 || high < 1.0 {
            let airframe = &compiled.airframe;
            let volts = airframe.voltage.as_ref().map(|law| law.reference);
            let percent = 100.0 * (scale - 1.0);
            let of_model = band(compiled, Axis::Thrust, volts).zip(airframe.weight_n());
            let expected = of_model.map_or(String::new(), |(band, weight)| {
                format!(
                    "; the model's own standard deviation is {:.1} %",
                    100.0 * band / weight
                )
            });
            warnings.push(format!(
                "the model gives {:.1} % {} thrust than the vehicle{expected}: -o writes the file with the scale in it. Other reasons: the \
                 mass, where the voltage is measured, the air's density, another propeller",
                percent.abs(),
                if percent > 0.0 { "more" } else { "less" },
            ));
        }
        for (parts, what) in [
            (&self.thrust.by_voltage, "voltage"),
            (&self.thrust.by_thrust, "thrust"),
        ] {
            let scales = parts.iter().map(|part| part.scale);
            let (least, most) = scales.fold((f64::MAX, 0.0f64), |(low, high), scale| {
                (low.min(scale), high.max(scale))
            });
            if most > (1.0 + PARTS_OFF) * least {
                warnings.push(format!(
                    "the scale is {least:.3} to {most:.3} by {what}: one scale does not mend the model; {}",
                    match what {
                        "voltage" => "look at [voltage], and at where the voltage is measured",
                        _ => "measure the pair on the bench (docs/bench.md)",
                    }
                ));
            }
        }
        let off = self
            .hover
            .centre_m
            .filter(|[x, y]| libm::hypot(*x, *y) > CENTRE_M);
        if let Some(centre) = off {
            warnings.push(format!(
                "the centre of gravity is {} of the file's: move the pack, or the units' position_m",
                beside(centre)
            ));
        }
        let all_yaw = compiled.pair.scale()[1] * compiled.airframe.units.len() as f64;
        if let Some(yaw) = self.hover.yaw_nm.filter(|yaw| yaw.abs() > YAW_LEFT * all_yaw) {
            warnings.push(format!(
                "the model has {} N m of yaw in a straight hover, where there is none: the pair's torque is off, or motor mounts are twisted",
                rounded(yaw)
            ));
        }
        if flight.voltage.is_none() && compiled.airframe.voltage.is_some() {
            warnings.push(format!(
                "the battery's voltage is not logged: the scale is that at {} V",
                compiled.airframe.reference_v()
            ));
        }
        let ranges = [
            (&self.voltage, "range_v", "V"),
            (&self.density, "range_kg_m3", "kg/m3"),
        ];
        for (range, key, unit) in ranges {
            let Some(Range {
                least,
                largest,
                range: Some([low, high]),
                outside,
            }) = range
            else {
                continue;
            };
            if *outside > 0.0 {
                warnings.push(format!(
                    "{key} is {low} to {high} {unit}, and the flight had {least:.2} to {largest:.2}: outside the mixer holds the range's end"
                ));
            }
        }
        if let (Some(density), None) = (&self.density, &compiled.airframe.air) {
            self.not_told.push(format!(
                "the air's part: {:.3} kg/m3 in this flight, and without [air] the scale has it in it",
                0.5 * (density.least + density.largest)
            ));
        }
        if rows.offset.is_none() {
            warnings.push(
                "no velocity is logged: the accelerometer's offset is in the scale's interval, 1 %"
                    .to_owned(),
            );
        }
        for Stopped { output, time_s } in &self.stopped {
            warnings.push(format!("the rotor on output {output} stops at {time_s:.1} s"));
        }
        let often = [("roll", self.saturated.roll), ("pitch", self.saturated.pitch)];
        for (axis, share) in often {
            if let Some(share) = share.filter(|share| *share > OFTEN) {
                warnings.push(format!("{axis} is cut for {:.1} % of the time", 100.0 * share));
            }
        }
        self.warnings = warnings;
    }
}

impl Hover {
    fn new(rows: &Rows, compiled: &Compiled, mass_kg: f64) -> Hover {
        let units = &compiled.airframe.units;
        let mean_of = |throttle: &[f32], channels: [usize; 2], k: usize| f64::from(throttle[channels[k]]);
        let mean = |throttle: &[f32], k: usize| {
            let each = units
                .iter()
                .map(|unit| mean_of(throttle, [unit.upper_channel, unit.lower_channel], k));
            each.sum::<f64>() / units.len() as f64
        };
        let hovers = |row: &Row| row.is_straight;
        let [upper, lower] = [0, 1].map(|k| rows.mean(hovers, |row| mean(&row.throttle, k)));
        let straight = |k: usize| rows.mean(|row| row.is_straight, |row| row.model[k]);
        let [roll_nm, pitch_nm, yaw_nm, thrust] = [0, 1, 2, 3].map(straight);
        let volts = rows.mean(hovers, |row| row.conditions.voltage_v.into());
        let density = rows.mean(hovers, |row| row.conditions.density_kg_m3.into());
        let model = volts.zip(density).and_then(|(voltage_v, density_kg_m3)| {
            let weight = Wrench {
                thrust_n: (mass_kg * GRAVITY) as f32,
                ..Wrench::default()
            };
            let conditions = mixer_rt::Conditions {
                voltage_v: voltage_v as f32,
                density_kg_m3: density_kg_m3 as f32,
            };
            let mixed = compiled.tables.mix_in(&weight, conditions, Health::GOOD).ok();
            let mixed = mixed.filter(|(_, _, saturation)| !saturation.any_axis());
            mixed.map(|(throttle, _, _)| [0, 1].map(|k| mean(&throttle, k)))
        });
        Hover {
            upper,
            lower,
            model,
            roll_nm,
            pitch_nm,
            yaw_nm,
            // Roll is -y f and pitch x f: both vanish about the centre of gravity.
            centre_m: roll_nm
                .zip(pitch_nm)
                .zip(thrust)
                .map(|((roll, pitch), thrust)| [pitch / thrust, -roll / thrust]),
        }
    }
}

impl Range {
    fn new(rows: &Rows, range: Option<[f64; 2]>, value: impl Fn(&Row) -> f64) -> Option<Range> {
        let values = rows.rows.iter().map(&value).filter(|value| value.is_finite());
        let (least, largest) = values.fold((f64::MAX, f64::MIN), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let is_outside = |row: &Row| range.is_some_and(|[low, high]| !(low..=high).contains(&value(row)));
        (least <= largest).then(|| Range {
            least,
            largest,
            range,
            outside: rows.share(is_outside),
        })
    }
}

/// Where a point is, m: `12 mm forward and 7 mm left`.
pub(crate) fn beside([x, y]: [f64; 2]) -> String {
    format!(
        "{:.0} mm {} and {:.0} mm {}",
        1e3 * x.abs(),
        if x < 0.0 { "back" } else { "forward" },
        1e3 * y.abs(),
        if y < 0.0 { "left" } else { "right" }
    )
}

/// Rotors that are off for [`STOPPED_S`] in the air: stock allocators take the throttle of one away for
/// shorter.
fn stopped(rows: &Rows) -> Vec<Stopped> {
    let outputs = rows.rows.first().map_or(0, |row| row.throttle.len());
    let first = |output: usize| {
        let mut since = None;
        rows.rows.iter().find_map(|row| {
            since = row
                .health
                .has_failed(output as u8)
                .then(|| since.unwrap_or(row.time_s));
            let time_s = since.filter(|since| row.time_s - since >= STOPPED_S)?;
            Some(Stopped { output, time_s })
        })
    };
    (0..outputs).filter_map(first).collect()
}

/// Where on the pair's map the vehicle flew.
fn flown(rows: &Rows, compiled: &Compiled) -> Vec<[f64; 2]> {
    let units = &compiled.airframe.units;
    let whole: Vec<&Row> = rows
        .rows
        .iter()
        .filter(|row| row.health == Health::GOOD)
        .collect();
    let every = (whole.len() * units.len()).div_ceil(POINTS).max(1);
    let points = whole.iter().flat_map(|row| {
        let of = |channel: usize| f64::from(row.throttle[channel]);
        units
            .iter()
            .map(move |unit| [of(unit.upper_channel), of(unit.lower_channel)])
    });
    points.step_by(every).collect()
}
