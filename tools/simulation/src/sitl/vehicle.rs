//! The vehicle that flies: an airframe file, and what the flags say of it.

use std::path::Path;

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::atmosphere;
use mixer_compiler::flywheel::Flywheel;
use nalgebra::{SVector, Vector3};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

use super::arguments::Arguments;
use crate::air::normal;
use crate::battery::Battery;
use crate::plant::Plant;
use crate::vehicle::{Body, GRAVITY_M_S2};

/// Most rotors: the channels of ArduPilot's larger packet.
pub const MOST_ROTORS: usize = 32;

/// A throttle per channel.
pub type Throttles = SVector<f64, MOST_ROTORS>;

/// The throttle, 0 to 1, of a pulse between those of throttle 0 and 1, us.
pub fn throttle(pulse_us: f64, [low, high]: [f64; 2]) -> f64 {
    ((pulse_us - low) / (high - low)).clamp(0.0, 1.0)
}

/// Share of the mass at the units where the file has no inertia: so the paper's X8 has its own
/// within 8 %.
const MASS_AT_UNITS: f64 = 0.25;

/// Least radius of gyration, m: what a single unit, all of it in the middle, is given.
const LEAST_GYRATION_M: f64 = 0.05;

/// Time constants of rotors, s: faster ones need finer steps.
const LAGS_S: [f64; 2] = [0.005, 1.0];

/// Power in hover per mass where the file has no `[pair.power]`, W/kg: as the paper's vehicle.
const HOVER_W_PER_KG: f64 = 80.0;

/// Share of its voltage by which a pack falls over its capacity, without load: 4.2 V to 3.54 V per
/// cell.
const FALL_OVER_CAPACITY: f64 = 0.157;

/// Altitude of home over the sea, m, where neither a flag nor `[air]` has one.
const HOME_M: f64 = 488.0;

/// Voltage where neither the file nor a flag has one, V.
const ANY_VOLTAGE_V: f64 = 16.0;

/// The vehicle.
#[derive(Clone, Debug)]
pub struct Vehicle {
    /// Its name.
    pub name: String,
    /// Rotors of all units: channels 0 to `rotors` - 1.
    pub rotors: usize,
    /// The plant.
    pub plant: Plant<MOST_ROTORS>,
    /// A rotor in hover at the reference.
    pub rotor: Flywheel,
    /// Mass, kg.
    pub mass_kg: f64,
    /// The battery.
    pub battery: Battery,
    /// Charge of the full pack, A h; `None` where its voltage does not fall.
    pub capacity_ah: Option<f64>,
    /// Altitude of home over the sea, m.
    pub altitude_m: f64,
    /// Throttle of all rotors that carries the weight, by the map that is flown at the voltage of the start.
    pub hover_throttle: f64,
}

impl Vehicle {
    /// The vehicle of the airframe file and of the flags.
    ///
    /// # Errors
    /// A file that cannot be read or is refused; a mass that nobody states or that is too much.
    pub fn new(arguments: &Arguments) -> Result<Vehicle, String> {
        let own = read(&arguments.airframe)?;
        let flown = match &arguments.map {
            Some(path) => with_map(&own, path)?,
            None => own.clone(),
        };
        let rotors = own.rotors();
        if rotors > MOST_ROTORS {
            return Err(format!(
                "{rotors} rotors: the stacks have outputs for {MOST_ROTORS}"
            ));
        }
        let path = arguments.airframe.display();
        let stated = own.vehicle.as_ref();
        let mass_kg = arguments.mass_kg.or(stated.map(|vehicle| vehicle.mass_kg));
        let mass_kg =
            mass_kg.ok_or_else(|| format!("{path} has no [vehicle] mass_kg: add it, or give --mass-kg"))?;
        let too_heavy = || {
            let weight = mass_kg * GRAVITY_M_S2;
            format!(
                "{path}: the vehicle weighs {weight:.1} N, which the rotors do not lift: a smaller mass, or other rotors"
            )
        };
        let rotor_inertia = || stated?.rotor_inertia_kg_m2;
        let kinds = Flywheel::of_mass(&flown, mass_kg, arguments.rotor_inertia.or_else(rotor_inertia));
        let kinds: Vec<Flywheel> = kinds.into_iter().flatten().collect();
        let rotor = match kinds.as_slice() {
            [] => return Err(too_heavy()),
            [rotor] => *rotor,
            // The plant has one lag for all.
            [rotor, ..] => {
                rotor.with_lag(kinds.iter().map(Flywheel::lag_s).sum::<f64>() / kinds.len() as f64)
            }
        };
        let stated_s = || stated?.rotor_lag_s.filter(|_| arguments.rotor_inertia.is_none());
        let rotor = with_lag(rotor, arguments.rotor_lag.or_else(stated_s))
            .map_err(|reason| format!("{path}: {reason}"))?;
        let moments = arguments.inertia.or_else(|| stated?.inertia_kg_m2);
        let body = Body {
            mass_kg,
            inertia_kg_m2: moments.map_or_else(|| inertia(&own, mass_kg), Vector3::from),
            rotor_lag_s: rotor.lag_s(),
        };
        let battery = unloaded(&own, arguments);
        let mismatch = spread(arguments.spread, arguments.seed, rotors);
        let mut plant = Plant::new(&flown, body, battery, mismatch).scaled(arguments.thrust_scale);
        let thin_m = arguments.density_altitude.or(arguments.altitude);
        if let Some(altitude_m) = thin_m {
            let thin = plant.in_air(atmosphere::density_at(altitude_m));
            plant = thin.map_err(|reason| format!("{path}: {reason}"))?;
        }
        // Without load first: the throttle in hover sets the current.
        let hover_throttle = plant.hover_throttle().ok_or_else(too_heavy)?;
        let power_w = flown.power_w(&vec![hover_throttle; rotors]);
        let power_w = power_w.unwrap_or(HOVER_W_PER_KG * mass_kg);
        let of_full_throttle = plant.current_a(&plant.alike(hover_throttle));
        let battery = Battery {
            resistance_ohm: arguments.resistance,
            full_throttle_a: power_w / (battery.full_v * of_full_throttle),
            ..battery
        };
        let plant = plant.on(battery);
        let hover_throttle = plant.hover_throttle().ok_or_else(too_heavy)?;
        let bench_m = own.air.as_ref().map(|air| atmosphere::altitude_of(air.reference));
        Ok(Vehicle {
            name: own.name,
            rotors,
            plant,
            rotor,
            mass_kg,
            battery,
            capacity_ah: arguments.capacity,
            altitude_m: thin_m.or(bench_m).unwrap_or(HOME_M),
            hover_throttle,
        })
    }

    /// Weight, N.
    pub fn weight_n(&self) -> f64 {
        self.mass_kg * GRAVITY_M_S2
    }
}

fn read(path: &Path) -> Result<Airframe, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    Airframe::read(&Source::new(path.display().to_string(), text)).map_err(|faults| faults.to_string())
}

/// The airframe with the pair of another file. The battery is the vehicle's, what a voltage does to the pair is the
/// other file's.
fn with_map(own: &Airframe, path: &Path) -> Result<Airframe, String> {
    let other = read(path)?;
    if own.is_unlike() || other.is_unlike() {
        return Err(format!(
            "--map {}: with units of several kinds, or single rotors, the map that is flown cannot be another file's",
            path.display()
        ));
    }
    let mut flown = own.clone();
    flown.pairs = other.pairs;
    flown.throttle = other.throttle;
    flown.voltage = other.voltage;
    flown.air = other.air;
    Ok(flown)
}

/// The rotor with the lag of the flag, if there is one; one that the plant's steps can follow.
fn with_lag(rotor: Flywheel, lag_s: Option<f64>) -> Result<Flywheel, String> {
    let rotor = lag_s.map_or(rotor, |lag_s| rotor.with_lag(lag_s));
    let (lag_s, [least, most]) = (rotor.lag_s(), LAGS_S);
    if (least..=most).contains(&lag_s) {
        return Ok(rotor);
    }
    Err(format!(
        "rotors with a lag of {lag_s:.4} s, beyond {least} to {most} s: give another --rotor-inertia or --rotor-lag"
    ))
}

/// The battery of the flags without resistance, each rotor's current at full throttle 1 A.
fn unloaded(own: &Airframe, arguments: &Arguments) -> Battery {
    let reference_v = own.voltage.as_ref().map(|voltage| voltage.reference);
    let full_v = arguments.volts.or(reference_v).unwrap_or(ANY_VOLTAGE_V);
    let fall_v = FALL_OVER_CAPACITY * full_v;
    Battery {
        full_v,
        slope_v_per_ah: arguments.capacity.map_or(0.0, |capacity| fall_v / capacity),
        resistance_ohm: 0.0,
        full_throttle_a: 1.0,
    }
}

/// Moments of inertia with [`MASS_AT_UNITS`] of the mass as points at the units.
fn inertia(airframe: &Airframe, mass_kg: f64) -> Vector3<f64> {
    let each = MASS_AT_UNITS * mass_kg / airframe.units.len() as f64;
    let at_units = airframe.units.iter().map(|unit| {
        let [x, y, z] = unit.position_m;
        Vector3::new(y * y + z * z, x * x + z * z, x * x + y * y) * each
    });
    let least = mass_kg * LEAST_GYRATION_M * LEAST_GYRATION_M;
    at_units.sum::<Vector3<f64>>().map(|moment| moment.max(least))
}

/// Each rotor's relative deviation of the effective throttle.
fn spread(size: f64, seed: u64, rotors: usize) -> Throttles {
    let mut source = Pcg64Mcg::seed_from_u64(seed);
    Throttles::from_fn(|rotor, _| {
        let deviate = normal(&mut source);
        if rotor < rotors { size * deviate } else { 0.0 }
    })
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::vehicle::{INERTIA_KG_M2, MASS_KG};

    fn vehicle(file: &Path, more: &[&str]) -> Result<Vehicle, String> {
        let file = file.to_str().unwrap();
        let arguments = ["sitl", file, "--px4"].into_iter().chain(more.iter().copied());
        Vehicle::new(&Arguments::try_parse_from(arguments).unwrap())
    }

    fn airframes() -> impl Iterator<Item = std::path::PathBuf> {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../airframes");
        let files = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path());
        files.filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
    }

    #[test]
    fn every_airframe_hovers_at_its_throttle() {
        for file in airframes() {
            let vehicle = vehicle(&file, &["--mass-kg", "1.5"]).unwrap();
            let (force, torque) = wrench(&vehicle, vehicle.hover_throttle);
            assert!(
                (-force.z / vehicle.weight_n() - 1.0).abs() < 1e-9,
                "{file:?}: {force}"
            );
            // One throttle for all rotors, which tilts a frame of several pairs.
            let is_alike = !std::fs::read_to_string(&file).unwrap().contains("[[pair]]");
            let level = torque.xy().norm() / vehicle.weight_n();
            assert!(!is_alike || level < 1e-3, "{file:?}: {torque}");
        }
        assert!(airframes().count() >= 10);
    }

    #[test]
    fn thin_air_takes_more_throttle() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");
        let at = |flags: &[&str]| vehicle(Path::new(file), flags).unwrap();
        let (plain, sea) = (at(&[]), at(&["--altitude", "0"]));
        assert_eq!((plain.altitude_m, sea.altitude_m), (488.0, 0.0));
        // At the reference the motors' model is the map.
        assert_eq!(plain.hover_throttle, sea.hover_throttle);
        let thin = [["--altitude", "3000"], ["--density", "0.9091"]].map(|flags| at(&flags));
        for vehicle in &thin {
            assert!(
                (vehicle.altitude_m - 3000.0).abs() < 2.0,
                "{}",
                vehicle.altitude_m
            );
            // Thrust falls by sigma^0.8 and goes with the throttle's power 1.9.
            let more = vehicle.hover_throttle / sea.hover_throttle;
            assert!((1.10..1.17).contains(&more), "{more}");
        }
    }

    /// Force and torque of all rotors at one throttle.
    fn wrench(vehicle: &Vehicle, throttle: f64) -> (Vector3<f64>, Vector3<f64>) {
        vehicle
            .plant
            .rotor_wrench(&vehicle.plant.alike(throttle), &SVector::zeros())
    }

    #[test]
    fn a_scale_multiplies_thrust_and_torque() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");
        let [plain, scaled] =
            [&[][..], &["--thrust-scale", "1.07"]].map(|flags| vehicle(Path::new(file), flags).unwrap());
        // Below idle, too.
        for throttle in [0.1, 0.3, 0.9] {
            let [(force, torque), (more, turned)] =
                [&plain, &scaled].map(|vehicle| wrench(vehicle, throttle));
            assert!((more - force * 1.07).norm() < 1e-9, "{force} {more}");
            assert!((turned - torque * 1.07).norm() < 1e-9, "{torque} {turned}");
        }
        assert!(scaled.hover_throttle < 0.98 * plain.hover_throttle);
    }

    #[test]
    fn a_map_of_another_file_keeps_its_own_reference() {
        let file = |name: &str| format!("{}/../../{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let [own, other] = ["examples/simulator/x8", "airframes/isae-x8"].map(file);
        for more in [&["--volts", "16"][..], &["--volts", "13.5", "--altitude", "2000"]] {
            let flags = [&["--mass-kg", "3"], more].concat();
            let mapped = vehicle(Path::new(&own), &[&flags[..], &["--map", &other]].concat()).unwrap();
            let plain = vehicle(Path::new(&other), &flags).unwrap();
            for throttle in [0.3, 0.9] {
                let [(force, _), (same, _)] = [&plain, &mapped].map(|vehicle| wrench(vehicle, throttle));
                assert!((force - same).norm() < 1e-9, "{force} {same}");
            }
        }
    }

    #[test]
    fn lag_and_inertia_of_a_rotor_are_one_number() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");
        let of = |flags: &[&str]| {
            vehicle(Path::new(file), flags).map(|vehicle| [vehicle.rotor.lead_s, vehicle.rotor.lag_s()])
        };
        let [lead_s, lag_s] = of(&["--rotor-inertia", "4e-4"]).unwrap();
        // In hover an exponent of 1.75 at a throttle of 0.8 is some 1.8.
        assert!((lead_s / lag_s - 5.3).abs() < 0.2, "{lead_s} {lag_s}");
        for (flags, factor) in [
            (["--rotor-inertia", "8e-4"], 2.0),
            (["--rotor-lag", &lag_s.to_string()], 1.0),
        ] {
            let found = of(&flags).unwrap();
            assert!(
                (found[0] / lead_s - factor).abs() < 1e-9 && (found[1] / lag_s - factor).abs() < 1e-9,
                "{found:?}"
            );
        }
        // 16.2 inch.
        let [estimated_s, _] = of(&[]).unwrap();
        assert!((0.8..1.3).contains(&(estimated_s / lead_s)), "{estimated_s}");
        let refusal = of(&["--rotor-inertia", "1e-6"]).unwrap_err();
        assert!(refusal.contains("--rotor-lag"), "{refusal}");
    }

    #[test]
    fn an_inertia_that_is_not_stated_is_estimated() {
        let airframe = crate::vehicle::airframe().unwrap();
        let estimated = inertia(&airframe, MASS_KG).component_div(&INERTIA_KG_M2);
        assert!(
            estimated.iter().all(|ratio| (ratio - 1.0).abs() < 0.08),
            "{estimated}"
        );
    }

    #[test]
    fn the_battery_sags_and_falls() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../airframes/isae-x8.toml");
        let flags = [
            "--mass-kg",
            "3.2",
            "--volts",
            "16.6",
            "--resistance",
            "0.025",
            "--capacity",
            "5",
        ];
        let vehicle = vehicle(Path::new(file), &flags).unwrap();
        let mut state = vehicle.plant.alike(vehicle.hover_throttle);
        // 80 W/kg: some 15.4 A, which take 0.39 V.
        let sag = 16.6 - vehicle.plant.voltage_v(&state);
        assert!((0.38..0.45).contains(&sag), "{sag}");
        state.charge_ah = 5.0;
        let empty = vehicle.plant.voltage_v(&state);
        assert!((16.6 - sag - empty - 0.157 * 16.6).abs() < 1e-9, "{empty}");
    }

    #[test]
    fn a_mass_must_be_stated() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../airframes/isae-x8.toml");
        let refusal = vehicle(Path::new(file), &[]).unwrap_err();
        assert!(
            refusal.contains("no [vehicle] mass_kg") && refusal.contains("--mass-kg"),
            "{refusal}"
        );
    }
}
