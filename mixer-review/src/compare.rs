//! A flight held against the model.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::GRAVITY;
use mixer_rt::{Conditions, Health, Wrench};

use crate::flight::Flight;
use crate::review::{Hover, Options, Range, Review, Stopped};
use crate::rows::{Row, Rows};
use crate::saturated::{Margin, Saturated};
use crate::thrust::Thrust;
use crate::warnings::{Seen, warnings};

/// Points of the map that are kept.
const POINTS: usize = 400;

/// How long a rotor is off that has stopped, s.
const STOPPED_S: f64 = 1.0;

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
        let flight = &flight.believed(&compiled.airframe);
        if flight.throttle.is_empty() || flight.force.is_empty() {
            return Err("the log has no row of outputs or of the accelerometer that can be".to_owned());
        }
        let rows = Rows::new(flight, compiled, mass_kg);
        let whole = |row: &Row| row.health == Health::GOOD;
        // The thrust at the ends of the pack over that at its reference, where nobody knows the voltage.
        let unknown = match (&flight.voltage, &compiled.airframe.voltage) {
            (None, Some(law)) => law.range.map(|volts| law.factors(volts)[0]),
            _ => [1.0, 1.0],
        };
        let (thrust, is_short) = Thrust::new(&rows, mass_kg, unknown).ok_or_else(|| {
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
        if let (Some(density), None) = (&review.density, &compiled.airframe.air) {
            review.not_told.push(format!(
                "the air's part: {:.3} kg/m3 in this flight, and without [air] the scale has it in it",
                0.5 * (density.least + density.largest)
            ));
        }
        review.warnings = warnings(&Seen {
            review: &review,
            flight,
            compiled,
            is_short,
            has_velocity: rows.offset.is_some(),
        });
        Ok(review)
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
            let conditions = Conditions {
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
