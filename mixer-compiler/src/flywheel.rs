//! Rotors as flywheels: what a step of yaw begins with, and how fast rotors follow.
//!
//! Of a motor's voltage the share s is lost in its resistance where the rotor turns, the rest is back-EMF. At a
//! step of the throttle the speed stays and the current jumps; the motor's torque, whose reaction turns the
//! frame, begins with r times the change that it ends with, and follows the speed down to it with the lag tau. With J the
//! inertia of a rotor, w its speed and Q its torque:
//!
//! ```text
//! r = (1 + s) / (2 s),   T = r tau = J w / (2 Q)
//! ```
//!
//! Thrust follows the voltage by the power 2 / (1 + s). As w and w^2 share the voltage d (d throttle),
//! s / (1 - s)^2 is proportional to d: the power falls from 2 at low throttle.
//!
//! w and J are not in an airframe file, or need not be. Both follow from the largest thrust of a rotor, since
//! propellers of multirotors are alike: their tips run at `TIP_M_S` at full throttle and they carry `LOADING_N_M2` there.

use serde::Serialize;

use crate::airframe::{Airframe, GRAVITY, Kind, TYPICAL_EXPONENT};
use crate::model::{PairMap, equal_throttle, maps};
use crate::view::View;

/// Throttle at which a motor has the voltage's exponent that least squares over a bench's map finds: large thrusts weigh
/// most there. Found on maps of ten systems at two voltages, one after the other simulated.
const EXPONENT_THROTTLE: f64 = 0.8;

/// Exponents of motors, and those that are taken for them: nearer to the ends one would be all resistance, or without any.
const MOTORS: [f64; 2] = [1.0, 2.0];
const TAKEN: [f64; 2] = [1.05, 1.95];

/// Speed of the tips at full throttle, m/s: 108, 133, 139 and 123 on four systems of 11, 15, 16.2 and 22 inch (Coaxial-Benchmarking-Platform,
/// Buzzatto and Liarokapis 2022).
const TIP_M_S: f64 = 125.0;

/// Thrust of one rotor alone at full throttle over the square of its diameter, N/m2: 146, 158, 148 and 120 there.
const LOADING_N_M2: f64 = 140.0;

/// Thrust of a pair at full throttle over that of one of its rotors alone: 1.54 to 1.64 there.
const PAIR_OVER_ALONE: f64 = 1.6;

/// Mass of a propeller over the square of its diameter, kg/m2: makers state 12 g for 10 inch (APC 10x4.7), 24 and 25 g for
/// 15 and 16 inch (T-Motor MF1503, P16x5.4), and for 28 inch 59 g (NS28x9.2) and, folding, 128 g (FA28.2x9.2).
const MASS_KG_M2: f64 = 0.16;

/// Inertia over mass and square of the diameter, a rod's. Blades taper, which takes off some
/// tenths; the motor's bell adds about one.
const ROD: f64 = 1.0 / 12.0;

/// A rotor in hover, at the reference voltage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Flywheel {
    /// J, of a rotor and its motor's bell, kg m2.
    pub inertia_kg_m2: f64,
    /// The propeller's diameter that J is estimated from, m; `None` where J is given.
    pub estimated_diameter_m: Option<f64>,
    /// Throttle of all rotors.
    pub hover_throttle: f64,
    /// w, rad/s, estimated from the largest thrust, within some 15 %.
    pub speed_rad_s: f64,
    /// Q, N m: of a pair by the slope of its torque as one rotor turns faster and the other slower.
    pub torque_nm: f64,
    /// T, s.
    pub lead_s: f64,
    /// r: torque on the frame at first over that of the end, in a step of yaw.
    pub first_over_steady: f64,
}

impl Flywheel {
    /// A rotor of each kind of unit of an airframe of a mass, kg, of an inertia, kg m2, if that is known; `None` where the
    /// vehicle does not hover.
    pub fn of_mass(airframe: &Airframe, mass_kg: f64, inertia_kg_m2: Option<f64>) -> Vec<Option<Flywheel>> {
        let hover = equal_throttle(airframe, &maps(airframe), mass_kg * GRAVITY);
        let of_kind = |view: View<'_, Kind<'_>>| Flywheel::at(&view, hover?, inertia_kg_m2);
        airframe.views().map(of_kind).collect()
    }

    /// Those of the file's `[vehicle]`; `None` without.
    pub fn of(airframe: &Airframe) -> Vec<Option<Flywheel>> {
        match &airframe.vehicle {
            Some(vehicle) => {
                let rotors =
                    Flywheel::of_mass(airframe, vehicle.mass_kg, vehicle.rotor_inertia_kg_m2).into_iter();
                let stated =
                    |rotor: Flywheel| vehicle.rotor_lag_s.map_or(rotor, |lag_s| rotor.with_lag(lag_s));
                rotors.map(|rotor| rotor.map(stated)).collect()
            }
            None => vec![None; airframe.views().count()],
        }
    }

    /// A rotor of a kind at the throttle of hover.
    fn at(view: &View<'_, Kind<'_>>, hover: f64, inertia_kg_m2: Option<f64>) -> Option<Flywheel> {
        let map = PairMap::of_kind(view.of, &view.throttle);
        let [hover_n, single_nm] = map.efforts([hover; 2]);
        let [full_n, _] = map.efforts([view.throttle.max; 2]);
        let [_, [by_upper, by_lower]] = map.jacobian([hover; 2]);
        let share = ohmic_share(exponent(view), hover);
        // The torque of a rotor, and the thrust of a unit over that of a rotor alone. Of a pair the slope of the torque is
        // known: Q goes with w^2, and w with the power 1 / (1 + s) of the throttle.
        let (torque_nm, over_alone) = match view.of {
            Kind::Pair(_) => (
                0.25 * (by_lower - by_upper) * hover * (1.0 + share),
                PAIR_OVER_ALONE,
            ),
            Kind::SingleRotor(_) => (single_nm, 1.0),
        };
        let diameter_m = (full_n / over_alone / LOADING_N_M2).sqrt();
        let speed_rad_s = 2.0 * TIP_M_S / diameter_m * (hover_n / full_n).sqrt();
        let mass_kg = MASS_KG_M2 * diameter_m * diameter_m;
        let estimated = ROD * mass_kg * diameter_m * diameter_m;
        let inertia = inertia_kg_m2.unwrap_or(estimated);
        let first_over_steady = (1.0 + share) / (2.0 * share);
        let lead_s = inertia * speed_rad_s / (2.0 * torque_nm);
        (lead_s > 0.0).then_some(Flywheel {
            inertia_kg_m2: inertia,
            estimated_diameter_m: inertia_kg_m2.is_none().then_some(diameter_m),
            hover_throttle: hover,
            speed_rad_s,
            torque_nm,
            lead_s,
            first_over_steady,
        })
    }

    /// The same rotor of the inertia that a lag, s, implies.
    #[must_use]
    pub fn with_lag(self, lag_s: f64) -> Flywheel {
        let lead_s = lag_s * self.first_over_steady;
        Flywheel {
            inertia_kg_m2: self.inertia_kg_m2 * lead_s / self.lead_s,
            estimated_diameter_m: None,
            lead_s,
            ..self
        }
    }

    /// The lag tau of a rotor, s.
    pub fn lag_s(&self) -> f64 {
        self.lead_s / self.first_over_steady
    }
}

/// Power of the voltage that the airframe's thrust follows, a usual one without `[voltage]`.
pub fn exponent(airframe: &Airframe) -> f64 {
    let voltage = airframe.voltage.as_ref();
    voltage.map_or(TYPICAL_EXPONENT, |voltage| voltage.exponents()[0])
}

/// Whether an exponent is that of motors; else a controller holds a speed or a current, or it is measured wrong.
pub fn is_of_motors(exponent: f64) -> bool {
    (MOTORS[0]..=MOTORS[1]).contains(&exponent)
}

/// The share s of a motor's voltage that its resistance takes at a throttle; that of a usual one where the exponent is not a motor's.
pub fn ohmic_share(exponent: f64, throttle: f64) -> f64 {
    let [least, most] = TAKEN;
    let taken = if is_of_motors(exponent) {
        exponent.clamp(least, most)
    } else {
        TYPICAL_EXPONENT
    };
    let share = 2.0 / taken - 1.0;
    let c = throttle / EXPONENT_THROTTLE * share / ((1.0 - share) * (1.0 - share));
    2.0 * c / (2.0 * c + 1.0 + (4.0 * c + 1.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Source;

    fn airframe(name: &str) -> Airframe {
        let path = format!("{}/../airframes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap();
        Airframe::read(&Source::new(path, text)).unwrap()
    }

    #[test]
    fn the_largest_thrust_tells_the_diameter() {
        for (name, mass_kg, inch) in [
            ("x8-11in-cubic", 3.0, 11.0),
            ("x8-11in-least-power", 3.0, 11.0),
            ("x8-16in-quartic", 6.5, 16.2),
            ("x8-22in-cubic", 10.0, 22.0),
        ] {
            let [rotor] = Flywheel::of_mass(&airframe(name), mass_kg, None)[..] else {
                panic!("one kind");
            };
            let rotor = rotor.unwrap();
            let found = rotor.estimated_diameter_m.unwrap() / (0.0254 * inch);
            assert!((found - 1.0).abs() < 0.09, "{name}: {found}");
            assert!((0.2..0.6).contains(&rotor.lead_s), "{name}: {rotor:?}");
        }
    }

    #[test]
    fn of_inertia_and_lag_one_gives_the_other() {
        let of = |inertia| Flywheel::of_mass(&airframe("x8-16in-quartic"), 6.5, Some(inertia))[0].unwrap();
        let (rotor, heavy) = (of(3e-4), of(6e-4));
        assert!((heavy.lead_s / rotor.lead_s - 2.0).abs() < 1e-12);
        let same = rotor.with_lag(heavy.lag_s());
        assert!(
            (same.inertia_kg_m2 / 6e-4 - 1.0).abs() < 1e-12
                && (same.lead_s / heavy.lead_s - 1.0).abs() < 1e-12
        );
        // J w / (2 Q), with the torque of isolated rotors of the same thrust within a third: the lower one works harder.
        let of_thrust_nm = 0.05 * 0.0254 * 16.2 * 6.5 * 9.8 / 8.0;
        assert!(
            (1.0..1.34).contains(&(rotor.torque_nm / of_thrust_nm)),
            "{rotor:?}"
        );
        assert_eq!(
            Flywheel::of_mass(&airframe("x8-16in-quartic"), 40.0, None),
            [None]
        );
    }

    #[test]
    fn the_share_is_that_of_the_exponent_where_it_holds() {
        for (exponent, share) in [(1.6, 0.25), (1.75, 1.0 / 7.0), (1.9, 1.0 / 19.0)] {
            assert!((ohmic_share(exponent, 0.8) - share).abs() < 1e-12);
            assert!(ohmic_share(exponent, 0.4) < share);
        }
        // Of a speed that is held nothing is known of the motor.
        assert_eq!(ohmic_share(0.0, 0.5), ohmic_share(TYPICAL_EXPONENT, 0.5));
    }
}
