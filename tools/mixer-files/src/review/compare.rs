//! A flight held against the model.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Correction, GRAVITY};
use mixer_rt::{Conditions, Health, Wrench};

use crate::review::flight::Flight;
use crate::review::log::{Series, median};
use crate::review::result::{Hover, Options, Power, Range, Review};
use crate::review::rotors;
use crate::review::rows::{Row, Rows};
use crate::review::saturated::Saturated;
use crate::review::thrust::{Thrust, blocks, error, student};
use crate::review::warnings::{WarningInputs, warnings};

/// Points of the map that are kept.
const POINTS: usize = 400;

/// Standard deviation of one rotor's thrust from its fellows' of the same kind, as a share.
const ROTOR_OFF: f64 = 0.02;

/// Height of the drag over the centre of gravity, as a share of the mean arm, that is not known: tilted against a wind
/// the vehicle carries its moment.
const DRAG_HEIGHT: f64 = 0.5;

/// Coulombs of a mA h.
const MAH: f64 = 3.6;

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
        // The thrust at the ends of the range over that at the reference, of what nobody knows.
        let unknown = |series: &Option<Series>, law: &Option<Correction>| match (series, law) {
            (None, Some(law)) => law.range.map(|end| law.factors(end)[0]),
            _ => [1.0; 2],
        };
        let of_voltage = unknown(&flight.voltage, &compiled.airframe.voltage);
        let of_air = unknown(&flight.density, &compiled.airframe.air);
        let unknown = [0, 1].map(|end| of_voltage[end] * of_air[end]);
        let (thrust, is_short) = Thrust::new(&rows, mass_kg, unknown).ok_or_else(|| {
            format!(
                "a log of the ground: {:.0} s, of which the vehicle is in the air with all rotors for {:.1} s; some seconds of hover are \
                 the least",
                rows.seconds,
                rows.seconds_of(whole)
            )
        })?;
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
                .and_then(|(_, law)| Range::new(&rows, Some(law.range), |row| row.conditions[0].into())),
            density: flight.density.as_ref().and_then(|density| {
                let range = compiled.airframe.air.as_ref().map(|law| law.range);
                Range::new(&rows, range, |row| {
                    density.at(row.time_s).map_or(f64::NAN, |density| density[0])
                })
            }),
            power: Power::new(&rows, flight, compiled),
            saturated: Saturated::new(&rows, flight, compiled),
            speeds: rotors::speeds(&rows, compiled),
            lag: rotors::Lag::of(&rows, compiled),
            stopped: rotors::stopped(&rows),
            warnings: Vec::new(),
            flown: flown(&rows, compiled),
        };
        review.warnings = warnings(&WarningInputs {
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
        let mean = |throttle: &[f32], k: usize| {
            let channels = units.iter().filter_map(|unit| unit.channels().nth(k));
            let count = channels.clone().count() as f64;
            channels.map(|channel| f64::from(throttle[channel])).sum::<f64>() / count
        };
        let straight = |number: &dyn Fn(&Row) -> f64| rows.median(|row| row.is_straight, number);
        let [upper, lower] = [0, 1].map(|k| straight(&|row| mean(&row.throttle, k)));
        let [roll_nm, pitch_nm, yaw_nm] = [0, 1, 2].map(|k| straight(&|row| row.model[k]));
        let volts = straight(&|row| row.conditions[0].into());
        let density = straight(&|row| row.conditions[1].into());
        let model = volts.zip(density).and_then(|(voltage_v, density_kg_m3)| {
            let weight = Wrench {
                thrust_n: (mass_kg * GRAVITY) as f32,
                ..Wrench::default()
            };
            let conditions = Conditions::at_voltage(voltage_v as f32).in_air(density_kg_m3 as f32);
            let mixed = compiled
                .tables
                .mix_with_health(&weight, conditions, Health::GOOD)
                .ok();
            let mixed = mixed.filter(|(_, _, saturation)| !saturation.any_axis());
            mixed.map(|(throttle, _, _)| [0, 1].map(|k| mean(&throttle, k)))
        });
        let centre = centre(rows, compiled, mass_kg);
        Hover {
            upper,
            lower,
            model,
            roll_nm,
            pitch_nm,
            yaw_nm,
            centre_m: centre.map(|axes| axes.map(|[at, _]| at)),
            centre_interval_m: centre.map(|axes| axes.map(|[at, half]| [at - half, at + half])),
        }
    }
}

/// Where the thrust acts in a straight hover, forward and right of the file's centre of gravity, with half of the interval, m.
/// The interval has the scatter, rotors of one kind that differ, and the moment of a drag.
fn centre(rows: &Rows, compiled: &Compiled, mass_kg: f64) -> Option<[[f64; 2]; 2]> {
    let units = &compiled.airframe.units;
    let blocks = blocks(rows, mass_kg, |row| row.is_straight);
    (!blocks.is_empty()).then(|| {
        [0, 1].map(|axis| {
            let places: Vec<f64> = blocks.iter().map(|block| block.centre_m[axis]).collect();
            let levers = units
                .iter()
                .map(|unit| unit.position_m[axis] * unit.position_m[axis])
                .sum::<f64>();
            let alike = ROTOR_OFF * (2.0 * levers).sqrt() / (2 * units.len()) as f64;
            let tilt = rows
                .median(|row| row.is_straight, |row| row.down[axis])
                .unwrap_or_default();
            let arm = (2.0 * levers / units.len() as f64).sqrt();
            let off = student(blocks.len()) * libm::hypot(error(&places), alike);
            let at = median(places.iter().copied());
            [at, libm::hypot(off, DRAG_HEIGHT * arm * tilt)]
        })
    })
}

impl Power {
    /// `None` without current and voltage, or without `[pair.power]`.
    fn new(rows: &Rows, flight: &Flight, compiled: &Compiled) -> Option<Power> {
        let airframe = &compiled.airframe;
        // The power of a rotor follows the cube of its speed, where its thrust follows the square; and the density.
        let model = |row: &Row| {
            let throttle: Vec<f64> = row.throttle.iter().copied().map(f64::from).collect();
            let [volts, density] = row.conditions.map(f64::from);
            let voltage = airframe.voltage_factors(volts)[0];
            let factors = airframe.factors(volts, density);
            airframe
                .power_w(&throttle)
                .map(|power_w| power_w * voltage.sqrt() * factors[0])
        };
        let measured = |row: &Row| Some(row.current_a? * f64::from(row.conditions[0]));
        let is_of = |row: &Row| row.hovers && row.current_a.is_some_and(|current_a| current_a > 0.0);
        let mean =
            |number: &dyn Fn(&Row) -> Option<f64>| rows.median(is_of, |row| number(row).unwrap_or(f64::NAN));
        let [model_w, measured_w] = [mean(&model)?, mean(&measured)?];
        let (_, current_a) = (flight.voltage.as_ref()?, mean(&|row| row.current_a)?);
        let used_mah = flight
            .current
            .as_ref()
            .and_then(|current| Some(current.rows().last()?.1[1]));
        let capacity_mah = flight.capacity_mah.filter(|capacity_mah| *capacity_mah > 0.0);
        let left =
            |(capacity_mah, used_mah): (f64, f64)| MAH * (capacity_mah - used_mah).max(0.0) / current_a;
        model_w.is_finite().then(|| Power {
            scale: model_w / measured_w,
            measured_w,
            hover_left_s: capacity_mah.zip(used_mah).map(left),
        })
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

/// Where on the pair's map the vehicle flew.
fn flown(rows: &Rows, compiled: &Compiled) -> Vec<(usize, [f64; 2])> {
    let units = &compiled.airframe.units;
    let whole: Vec<&Row> = rows
        .rows
        .iter()
        .filter(|row| row.health == Health::GOOD)
        .collect();
    let every = (whole.len() * units.len()).div_ceil(POINTS).max(1);
    let points = whole.iter().flat_map(|row| {
        let pairs = units.iter().filter(|unit| unit.lower_channel.is_some());
        pairs.map(move |unit| (unit.kind, unit.throttles(&row.throttle)))
    });
    points.step_by(every).collect()
}
