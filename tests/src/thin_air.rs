//! Level thrust in other air through the whole mixer, judged by motors that know nothing of its laws.
//!
//! Ten pairs: measured rotors on motors with the no-load current of 3 % of their full one, in balance
//! with a speed controller that sets a duty, and an interaction over speeds. A bench of two voltages
//! at one density makes an airframe of each; what its mixer commands is given back to the motors in
//! air of other densities.

use mixer_compiler::airframe::Basis;
use mixer_compiler::{Source, atmosphere, compile};
use mixer_rt::{Conditions, Health, Wrench};
use nalgebra::{DMatrix, DVector};

/// Density of the bench, kg/m3.
const BENCH: f64 = 1.225;

/// No-load current over that at full throttle.
const NO_LOAD: f64 = 0.03;

/// Constants of the interaction (Buzzatto's maps): see [`System::efforts`].
const B: f64 = 4.28;
const TORQUE: [f64; 2] = [0.154, 0.045];
/// Shares of the interaction at the spacing of 0.25 diameters: h = 1 - z / sqrt(1 + z^2), z = 0.5.
const H: f64 = 0.552_786_405;
const MU: f64 = 0.219 - 0.038 * H;
const NU: f64 = 0.050 * H;

/// A bench's row near full throttle: voltage, duty, speed (1/min), thrust (N), torque (N m), ohmic
/// share of the applied voltage. The first five are of X8 size, by the power balance; the others of
/// 5 inch, by fits to speed, voltage and current.
const ROWS: [(&str, [f64; 6]); 10] = [
    ("15 in U5 400 kv", [21.47, 0.95, 6461.0, 22.2, 0.417, 0.141]),
    ("16.2 in U5 400 kv", [21.39, 0.95, 6267.0, 24.6, 0.468, 0.152]),
    ("16.2 in MN4014 400 kv", [21.34, 0.95, 6331.0, 25.3, 0.490, 0.156]),
    ("11 in 910 kv", [10.24, 0.95, 7188.0, 10.45, 0.180, 0.106]),
    ("22 in MN501S 240 kv", [24.04, 0.95, 4079.0, 36.6, 0.952, 0.174]),
    ("5 in RS2205S 2600 kv", [7.14, 1.0, 14943.0, 2.872, 0.0346, 0.126]),
    ("5 in MX2206 2450 kv", [7.17, 1.0, 14877.0, 2.911, 0.0326, 0.157]),
    ("5 in RX2206 2000 kv", [7.31, 1.0, 11445.0, 1.641, 0.0175, 0.142]),
    ("5 in F30 2300 kv", [7.22, 1.0, 12956.0, 2.085, 0.0219, 0.219]),
    ("5 in F40III 2400 kv", [7.17, 1.0, 14199.0, 2.640, 0.0325, 0.104]),
];

/// Altitude (m) and temperature (degrees Celsius) of the flights between 0.7 and 1.15 of the bench's
/// density.
const FLIGHTS: [[f64; 2]; 7] = [
    [0.0, -10.0],
    [0.0, 15.0],
    [0.0, 40.0],
    [1500.0, -10.0],
    [1500.0, 15.0],
    [1500.0, 40.0],
    [3000.0, -10.0],
];

/// Thrust asked for, over that of all rotors at full throttle in the same air.
const ASKED: [f64; 4] = [0.25, 0.4, 0.55, 0.7];

/// Two equal rotors, one above the other.
struct System {
    /// Voltage at full throttle, V.
    volts: f64,
    motor_constant: f64,
    resistance_ohm: f64,
    no_load_a: f64,
    /// Thrust and torque over the square of the speed at the bench's density.
    thrust: f64,
    torque: f64,
}

impl System {
    fn new([volts, duty, rpm, thrust_n, torque_nm, ohmic]: [f64; 6]) -> System {
        let speed = rpm * std::f64::consts::PI / 30.0;
        let motor_constant = duty * volts * (1.0 - ohmic) / speed;
        let current_a = torque_nm / motor_constant / (1.0 - NO_LOAD);
        System {
            volts: volts / 0.96,
            motor_constant,
            resistance_ohm: ohmic * duty * volts / current_a,
            no_load_a: NO_LOAD * current_a,
            thrust: thrust_n / (speed * speed),
            torque: torque_nm / (speed * speed),
        }
    }

    /// Speed, 1/s, at which the motor's torque K (I - I0), R I = d V - K w, is the propeller's times
    /// `load` of the square of the speed.
    fn speed(&self, applied_v: f64, sigma: f64, load: impl Fn(f64) -> f64) -> f64 {
        let k = self.motor_constant;
        let (mut low, mut high) = (0.0, 1.2 * applied_v / k);
        for _ in 0..50 {
            let speed = 0.5 * (low + high);
            let square = speed * speed;
            let current_a = (applied_v - k * speed) / self.resistance_ohm;
            let drives = k * (current_a - self.no_load_a) > sigma * self.torque * square * load(square);
            (low, high) = if drives { (speed, high) } else { (low, speed) };
        }
        0.5 * (low + high)
    }

    /// `[f, Q]`, N and N m, the torque counted in the sense of the lower rotor's. Each rotor's
    /// thrust falls by the root of 1 + mu T_u / T_l0 (the lower one's) or nu T_l / T_u0, and the lower one's
    /// torque by its own inflow.
    fn efforts(&self, [upper, lower]: [f64; 2], volts: f64, sigma: f64) -> [f64; 2] {
        let isolated = self.speed(upper * volts, sigma, |_| 1.0);
        let upper_square = isolated * isolated;
        let mut upper_n = sigma * self.thrust * upper_square;
        let [alone_n, mut lower_n, mut lower_nm] = [upper_n, 0.0, 0.0];
        for _ in 0..4 {
            let ratio = |own_n: f64| (upper_n.max(0.0) / own_n.max(1e-12)).min(36.0);
            let load = |square: f64| {
                let squared = ratio(sigma * self.thrust * square);
                let inflow = squared * squared.sqrt();
                1.0 - TORQUE[0] * inflow / (1.0 + TORQUE[1] * inflow)
            };
            let speed = self.speed(lower * volts, sigma, load);
            let own_n = sigma * self.thrust * speed * speed;
            lower_n = own_n * (1.0 + B - B * (1.0 + MU * ratio(own_n)).sqrt());
            lower_nm = sigma * self.torque * speed * speed * load(speed * speed);
            upper_n = alone_n * (1.0 + B - B * (1.0 + NU * lower_n.max(0.0) / alone_n).sqrt());
        }
        [upper_n + lower_n, lower_nm - sigma * self.torque * upper_square]
    }

    /// The map over a grid of throttles: one row of `[f, Q]` each.
    fn map(&self, volts: f64) -> (Vec<[f64; 2]>, Vec<[f64; 2]>) {
        let level = |k: u32| 0.2 + 0.1 * f64::from(k);
        let grid: Vec<[f64; 2]> = (0..81).map(|k| [level(k / 9), level(k % 9)]).collect();
        let efforts = grid.iter().map(|&at| self.efforts(at, volts, 1.0)).collect();
        (grid, efforts)
    }

    /// An X8 of the pair as a bench of two voltages, 15 % apart, finds it.
    fn airframe(&self) -> Result<String, String> {
        let (grid, full) = self.map(self.volts);
        let (_, low) = self.map(0.85 * self.volts);
        let exponents = [0, 1].map(|k| {
            let products: f64 = full.iter().zip(&low).map(|(a, b)| a[k] * b[k]).sum();
            let squares: f64 = full.iter().map(|a| a[k] * a[k]).sum();
            libm::log(products / squares) / libm::log(0.85)
        });
        let powers = Basis::Cubic.exponents();
        let terms = DMatrix::from_fn(grid.len(), powers.len(), |row, term| {
            let ([u, l], (i, j)) = (grid[row], powers[term]);
            let power = |x: f64, times: u8| (0..times).fold(1.0, |product, _| product * x);
            power(u, i) * power(l, j)
        });
        let svd = terms.svd(true, true);
        let fit = |k: usize| -> Result<Vec<f64>, String> {
            let values = DVector::from_iterator(full.len(), full.iter().map(|efforts| efforts[k]));
            let solution = svd.solve(&values, 1e-12).map_err(str::to_owned)?;
            Ok(solution.iter().copied().collect())
        };
        let volts = self.volts;
        Ok(format!(
            "name = \"thin-air\"\n[throttle]\nmin = 0.25\nmax = 1.0\n\
             [pair]\nbasis = \"cubic\"\nupper_spin = \"cw\"\nthrust_n = {:?}\ntorque_nm = {:?}\n\
             [voltage]\nreference_v = {volts:?}\nrange_v = [{:?}, {:?}]\nthrust_exponent = {:?}\ntorque_exponent = {:?}\n\
             [air]\nreference_density_kg_m3 = {BENCH:?}\nrange_kg_m3 = [{:?}, {:?}]\n\
             [layout]\narm_m = 0.5\nunits = 4\nfirst_angle_deg = 45.0\n",
            fit(0)?,
            fit(1)?,
            0.75 * volts,
            1.1 * volts,
            exponents[0],
            exponents[1],
            0.65 * BENCH,
            1.2 * BENCH,
        ))
    }
}

/// Thrust given over that asked for less 1, %, in one air: of all pairs and thrusts.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Density over that of the bench.
    pub sigma: f64,
    /// Where that is, if it is at an altitude of the flights.
    pub place: Option<[f64; 2]>,
    /// At the reference density, as the mixer without `[air]`.
    pub without: Vec<f64>,
    /// With the density passed.
    pub with: Vec<f64>,
}

/// Flies all pairs in all air.
///
/// # Errors
/// An airframe that is refused, or a setpoint.
pub fn fly() -> Result<Vec<Flight>, String> {
    let flights = FLIGHTS.map(|[altitude_m, celsius]| {
        let density = atmosphere::density(atmosphere::pressure_at(altitude_m), celsius + 273.15);
        (density / BENCH, Some([altitude_m, celsius]))
    });
    let ends = [0.7, 1.15].map(|sigma| (sigma, None));
    let mut flights: Vec<Flight> = flights
        .into_iter()
        .chain(ends)
        .map(|(sigma, place)| Flight {
            sigma,
            place,
            without: Vec::new(),
            with: Vec::new(),
        })
        .collect();
    flights.sort_by(|a, b| b.sigma.total_cmp(&a.sigma));
    for (name, row) in ROWS {
        let system = System::new(row);
        let source = Source::new(name, system.airframe()?);
        let compiled = compile(&source).map_err(|faults| format!("{name}: {faults}"))?;
        for flight in &mut flights {
            let given = |thrust_n: f64, density: f64| -> Result<f64, String> {
                let conditions = Conditions::at_voltage(system.volts as f32).in_air(density as f32);
                let setpoint = Wrench {
                    thrust_n: thrust_n as f32,
                    ..Wrench::default()
                };
                let mixed = compiled
                    .tables
                    .mix_with_health(&setpoint, conditions, Health::GOOD);
                let (throttles, ..) = mixed.map_err(|error| format!("{name}: {error}"))?;
                let units = compiled.airframe.units.iter();
                let thrusts = units
                    .map(|unit| system.efforts(unit.throttles(&throttles), system.volts, flight.sigma)[0]);
                Ok(100.0 * (thrusts.sum::<f64>() / thrust_n - 1.0))
            };
            let units = compiled.airframe.units.len() as f64;
            let full_n = units * system.efforts([1.0; 2], system.volts, flight.sigma)[0];
            for share in ASKED {
                flight.without.push(given(share * full_n, BENCH)?);
                flight.with.push(given(share * full_n, BENCH * flight.sigma)?);
            }
        }
    }
    Ok(flights)
}

/// Mean and largest of magnitudes.
pub fn size(errors: &[f64]) -> [f64; 2] {
    let magnitudes = errors.iter().map(|error| error.abs());
    let sum: f64 = magnitudes.clone().sum();
    [sum / errors.len() as f64, magnitudes.fold(0.0, f64::max)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_thrust_in_other_air() {
        let flights = fly().unwrap();
        let all =
            |of: fn(&Flight) -> &Vec<f64>| -> Vec<f64> { flights.iter().flat_map(of).copied().collect() };
        let ([mean, worst], [mean_without, worst_without]) = (
            size(&all(|flight| &flight.with)),
            size(&all(|flight| &flight.without)),
        );
        assert!(mean < 2.0 && worst < 5.0, "{mean} {worst}");
        assert!(
            mean_without > 8.0 && worst_without > 24.0,
            "{mean_without} {worst_without}"
        );
        assert_eq!(flights[0].with.len(), ROWS.len() * ASKED.len());
        // Without a no-load current, thin air acts exactly like a lower voltage.
        for (_, row) in ROWS {
            let motor = System {
                no_load_a: 0.0,
                ..System::new(row)
            };
            for sigma in [0.7, 1.15] {
                let thin = motor.efforts([0.5, 0.7], motor.volts, sigma);
                let low = motor
                    .efforts([0.5, 0.7], sigma * motor.volts, 1.0)
                    .map(|effort| effort / sigma);
                let off = [0, 1].map(|k| (thin[k] / low[k] - 1.0).abs());
                assert!(off.iter().all(|off| *off < 1e-9), "{off:?}");
            }
        }
    }
}
