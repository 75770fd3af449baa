//! The setpoints of an airframe's golden vectors: always the same for one airframe, all finite.
//!
//! They depend on the airframe and not on the mixer, so that a mixer that changes is asked the same as before.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Axis;
use mixer_compiler::model::PairMap;
use mixer_rt::Wrench;

/// A setpoint with a rotor out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorsOut {
    /// The output of the rotor that is out.
    pub failed: u8,
    /// What is asked.
    pub setpoint: Wrench,
    /// Supply voltage, V.
    pub voltage_v: f32,
}

/// Wrenches of random throttles.
const ATTAINABLE: usize = 120;

/// Wrenches of throttles that are all at idle or full, and a little inside and outside of these.
const BORDER: usize = 40;

/// Inside, on and outside of the border, as shares about the middle of the throttles.
const SHARES: [f64; 3] = [0.98, 1.0, 1.02];

/// Random wrenches of up to three times what there is.
const BEYOND: usize = 80;

/// Setpoints for every rotor that is out: every so many of the others.
const ROTORS_OUT: usize = 12;

/// Setpoints with all rotors: attainable, on the border, saturated, by hand, at voltages in and beyond the range.
pub fn healthy(compiled: &Compiled) -> Vec<(Wrench, f32)> {
    let mut draw = Draw::new(compiled);
    let mut vectors = by_hand(&draw);
    vectors.extend((0..ATTAINABLE).map(|_| draw.attainable()));
    for _ in 0..BORDER {
        vectors.extend(draw.border());
    }
    vectors.extend((0..BEYOND).map(|_| draw.beyond()));
    vectors
}

/// For every output its rotor out, a choice of the setpoints each.
pub fn rotors_out(compiled: &Compiled, vectors: &[(Wrench, f32)]) -> Vec<RotorsOut> {
    let rotors = compiled.airframe.rotors();
    let mut list = Vec::new();
    for channel in 0..rotors {
        let Ok(failed) = u8::try_from(channel) else {
            continue;
        };
        // Another choice for every rotor.
        let chosen = (0..ROTORS_OUT).map(|k| (k * rotors + channel) * vectors.len() / (ROTORS_OUT * rotors));
        list.extend(
            chosen
                .filter_map(|k| vectors.get(k))
                .map(|&(setpoint, voltage_v)| RotorsOut {
                    failed,
                    setpoint,
                    voltage_v,
                }),
        );
    }
    list
}

/// Zero, thrusts to beyond the ceiling at voltages to beyond the range, each axis alone on both sides.
fn by_hand(draw: &Draw<'_>) -> Vec<(Wrench, f32)> {
    let [low, reference, high] = draw.volts;
    let size = draw.size;
    let wrench = |shares: [f64; 4]| Wrench::from_array(std::array::from_fn(|k| (shares[k] * size[k]) as f32));
    let mut list = vec![(Wrench::default(), reference as f32)];
    for thrust in [0.02, 0.3, 0.6, 0.95, 1.2] {
        for volts in [low - 1.0, low, reference, high, high + 1.0] {
            list.push((wrench([0.0, 0.0, 0.0, thrust]), volts as f32));
        }
        for axis in 0..3 {
            for torque in [-20.0, -1.0, -0.1, 0.1, 1.0, 20.0] {
                let mut shares = [0.0, 0.0, 0.0, thrust];
                shares[axis] = torque;
                list.push((wrench(shares), reference as f32));
            }
        }
    }
    list
}

/// Random setpoints of one airframe.
struct Draw<'a> {
    compiled: &'a Compiled,
    pair: PairMap,
    /// Largest wrench on each axis: all units at their best, whatever the others lose.
    size: [f64; 4],
    /// Lowest, reference and highest voltage; any where the airframe ignores it.
    volts: [f64; 3],
    state: u64,
}

impl<'a> Draw<'a> {
    fn new(compiled: &'a Compiled) -> Self {
        let airframe = &compiled.airframe;
        let pair = PairMap::new(&airframe.pair, &airframe.throttle);
        let [f, q] = pair.scale();
        let n = airframe.units.len();
        let matrix = &compiled.effectiveness.matrix;
        let size = Axis::ALL.map(|axis| {
            let row = matrix.row(axis as usize);
            (0..n).map(|i| row[i].abs() * f + row[n + i].abs() * q).sum()
        });
        let volts = airframe.voltage.as_ref().map_or([12.0, 14.0, 16.0], |voltage| {
            let [low, high] = voltage.range_v;
            [low, voltage.reference_v, high]
        });
        Draw {
            compiled,
            pair,
            size,
            volts,
            state: 0x9e37_79b9_7f4a_7c15,
        }
    }

    /// A number in [0, 1): xorshift64*, of which the upper 32 bits are used.
    fn share(&mut self) -> f64 {
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        let bits = self.state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32;
        bits as f64 / 4_294_967_296.0
    }

    fn volts(&mut self) -> f64 {
        let [low, _, high] = self.volts;
        low + (high - low) * self.share()
    }

    /// The wrench of the units' throttles, given in shares of the range.
    fn wrench(&self, shares: &[[f64; 2]], volts: f64) -> Wrench {
        let [low, high] = self.pair.range();
        let (k_f, k_q) = self
            .compiled
            .airframe
            .voltage
            .as_ref()
            .map_or((1.0, 1.0), |v| (v.thrust_factor(volts), v.torque_factor(volts)));
        let matrix = &self.compiled.effectiveness.matrix;
        let n = shares.len();
        let mut wrench = [0.0; 4];
        for (i, shares) in shares.iter().enumerate() {
            let [f, q] = self.pair.efforts(shares.map(|share| low + (high - low) * share));
            for (axis, sum) in wrench.iter_mut().enumerate() {
                *sum += matrix[(axis, i)] * k_f * f + matrix[(axis, n + i)] * k_q * q;
            }
        }
        Wrench::from_array(wrench.map(|x| x as f32))
    }

    fn attainable(&mut self) -> (Wrench, f32) {
        let volts = self.volts();
        let units = self.compiled.airframe.units.len();
        let shares: Vec<[f64; 2]> = (0..units).map(|_| [self.share(), self.share()]).collect();
        (self.wrench(&shares, volts), volts as f32)
    }

    fn border(&mut self) -> [(Wrench, f32); 3] {
        let [low, _, high] = self.volts;
        let volts = if self.share() < 0.5 { low } else { high };
        let units = self.compiled.airframe.units.len();
        let ends: Vec<[f64; 2]> = (0..units)
            .map(|_| [self.share(), self.share()].map(|share| if share < 0.5 { 0.0 } else { 1.0 }))
            .collect();
        let [inside, on, outside] = SHARES;
        [inside, on, outside].map(|share| {
            let about_middle = |end: f64| 0.5 + share * (end - 0.5);
            let shares: Vec<[f64; 2]> = ends.iter().map(|ends| ends.map(about_middle)).collect();
            (self.wrench(&shares, volts), volts as f32)
        })
    }

    fn beyond(&mut self) -> (Wrench, f32) {
        let [roll, pitch, yaw] = [(); 3].map(|()| 6.0 * self.share() - 3.0);
        let shares = [roll, pitch, yaw, 1.7 * self.share() - 0.2];
        let size = self.size;
        let wrench = std::array::from_fn(|axis| (shares[axis] * size[axis]) as f32);
        (Wrench::from_array(wrench), self.volts() as f32)
    }
}
