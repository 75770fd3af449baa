//! Two frames of constant tables, drawn requests, and what throttles give in double precision.
//! The X8 is the golden output of `airframes/isae-x8.toml`; `tests/tables/tilted.toml` says how the tables
//! of the other are made again.
#![allow(clippy::module_inception, dead_code, missing_docs, unreachable_pub)]

use std::fmt::Debug;

use mixer_rt::tables::{Airmode, Kinds, LawPiece, Priorities, RotorAlone, Tables, mix};
use mixer_rt::{Conditions, Health, Saturation, SetpointError, Wrench};

#[rustfmt::skip]
#[path = "../tables/tilted.rs"]
mod tilted;
#[rustfmt::skip]
#[path = "../../../tests/golden/isae-x8.rs"]
pub mod x8;

pub const AIRMODES: [Airmode; 3] = [Airmode::Disabled, Airmode::RollPitch, Airmode::RollPitchYaw];

/// Share of an axis' authority by which it may be reversed or exceeded, beside the mixer's tolerance.
pub const SLACK: f64 = 3e-3;

/// Numbers that arithmetic treats in its own way, and some about the mixer's own limit.
const WILD: [f32; 14] = [
    0.0, 1e-45, 1.1e-38, 1.2e-38, 1e-30, 1e-20, 1e-12, 1e-6, 1.0, 30.0, 1e5, 1.000_01e5, 1e20, 3.4e38,
];

/// xorshift64*
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed ^ 0x9e37_79b9_7f4a_7c15)
    }

    /// A whole number below `end`.
    pub fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32;
        ((high * u64::from(end)) >> 32) as u32
    }

    /// From `low` to `high`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.below(1 << 24) as f32 / (1 << 24) as f32)
    }

    /// One of [`WILD`] with either sign, or any finite number.
    pub fn wild(&mut self) -> f32 {
        let any = f32::from_bits(self.below(u32::MAX));
        let wild = WILD[self.below(WILD.len() as u32) as usize];
        match self.below(3) {
            0 if any.is_finite() => any,
            1 => -wild,
            _ => wild,
        }
    }
}

/// What is asked of a mixer.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// Roll, pitch, yaw, N m; thrust, N.
    pub wrench: [f32; 4],
    pub volts: f32,
    /// The air's density, kg/m3.
    pub density: f32,
    pub health: Health,
}

impl Request {
    /// Voltage and density.
    pub fn conditions(&self) -> Conditions {
        Conditions::at_voltage(self.volts).in_air(self.density)
    }
}

/// What it answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub throttle: Vec<f32>,
    pub achieved: [f32; 4],
    pub saturation: Saturation,
}

/// A frame, without the types of its tables.
#[derive(Clone)]
pub struct Frame {
    pub name: &'static str,
    /// Tables but for the pair, the inverse and the closed form. Priorities and the power bias may be changed.
    pub tables: Tables<'static, (), ()>,
    /// Coefficients of thrust and torque of a pair, and the products of throttles that they are of.
    pair: [Vec<f32>; 2],
    terms: &'static str,
    /// What the upper and the lower rotor of a pair give alone.
    alone: [RotorAlone; 2],
    mix: fn(Priorities, f32, &Request) -> Result<Answer, SetpointError>,
    /// Throttles for efforts, and the efforts that they give.
    invert: fn([f32; 2]) -> [[f32; 2]; 2],
}

/// `tables` without those whose types differ between frames.
fn common<K, S>(tables: &Tables<'static, K, S>) -> Tables<'static, (), ()> {
    Tables {
        units: tables.units,
        kinds: (),
        throttle: tables.throttle,
        voltage: tables.voltage,
        air: tables.air,
        row_scale: tables.row_scale,
        level_n: tables.level_n,
        is_vertical: tables.is_vertical,
        priorities: tables.priorities,
        power_bias_nm_per_n: tables.power_bias_nm_per_n,
        closed_form: (),
        tolerance: tables.tolerance,
    }
}

fn invert<K: Kinds, S>(tables: &Tables<'_, K, S>, efforts: [f32; 2]) -> [[f32; 2]; 2] {
    let throttles = tables.throttles_of(0, efforts);
    [throttles, tables.efforts_of(0, throttles)]
}

macro_rules! frame {
    ($file:ident :: $module:ident, $terms:literal) => {{
        use $file::$module::{CHANNELS, TABLES, UNITS};
        Frame {
            name: stringify!($module),
            tables: common(&TABLES),
            pair: [TABLES.kinds.pair.thrust, TABLES.kinds.pair.torque].map(|quantity| quantity.0.to_vec()),
            terms: $terms,
            alone: TABLES.kinds.alone,
            mix: |priorities, power_bias_nm_per_n, request| {
                let tables = Tables {
                    priorities,
                    power_bias_nm_per_n,
                    ..TABLES
                };
                let wrench = Wrench::from_array(request.wrench);
                let (conditions, health) = (request.conditions(), request.health);
                let mix = mix::<UNITS, CHANNELS, _, _>(&tables, &wrench, conditions, health)?;
                Ok(Answer {
                    throttle: mix.throttle.to_vec(),
                    achieved: mix.achieved.to_array(),
                    saturation: mix.saturation,
                })
            },
            invert: |efforts| invert(&TABLES, efforts),
        }
    }};
}

/// Four vertical units, in closed form while all rotors turn.
pub fn x8() -> Frame {
    frame!(x8::isae_x8, "uull uul uu ull ul u ll l")
}

/// Six tilted units.
pub fn tilted() -> Frame {
    frame!(tilted::tilted, "uuu uul ull lll uu ul ll u l")
}

impl Frame {
    /// The same frame with other priorities.
    pub fn with(&self, airmode: Airmode, yaw_reserve_nm: f32) -> Frame {
        let mut frame = self.clone();
        frame.tables.priorities = Priorities {
            airmode,
            yaw_reserve_nm,
        };
        frame
    }

    pub fn try_mix(&self, request: &Request) -> Result<Answer, SetpointError> {
        (self.mix)(self.tables.priorities, self.tables.power_bias_nm_per_n, request)
    }

    pub fn mix(&self, request: &Request) -> Answer {
        let answer = self.try_mix(request);
        answer.unwrap_or_else(|error| panic!("{}: {error}: {request:?}", self.name))
    }

    pub fn channels(&self) -> u32 {
        2 * self.tables.units.len() as u32
    }

    /// The most of each axis at the reference voltage, N m and N.
    pub fn authority(&self) -> [f32; 4] {
        self.tables
            .row_scale
            .map(|row| self.tables.units.len() as f32 / row)
    }

    /// What an axis may be off without a fault, N m and N.
    pub fn slack(&self) -> [f64; 4] {
        let (authority, tolerance) = (self.authority(), self.tables.tolerance.wrench);
        [0, 1, 2, 3].map(|axis| SLACK * f64::from(authority[axis]) + f64::from(tolerance[axis]))
    }

    /// Health with `out` rotors out.
    pub fn failed(&self, random: &mut Random, out: usize) -> Health {
        let (mut health, mut failed) = (Health::GOOD, 0);
        while failed < out {
            let channel = random.below(self.channels()) as u8;
            failed += usize::from(!health.has_failed(channel));
            health = health.with_failed(channel);
        }
        health
    }

    /// A request of any size, from a fiftieth of the authority to four times as much, at a voltage of
    /// the range or beyond, with `out` rotors out.
    pub fn draw(&self, random: &mut Random, out: usize) -> Request {
        let size = [0.02, 0.1, 0.3, 1.0, 1.5, 4.0][random.below(6) as usize];
        let [low, high] = self.tables.voltage.expect("both frames have it").range;
        let share = [size, size, size, 0.0].map(|size| random.between(-size, size));
        let thrust = random.between(-0.05, 1.1);
        Request {
            wrench: [0, 1, 2, 3].map(|axis| {
                let share = if axis == 3 { thrust } else { share[axis] };
                share * self.authority()[axis]
            }),
            volts: random.between(low - 1.0, high + 1.0),
            density: random.between(0.6, 1.5),
            health: self.failed(random, out),
        }
    }

    /// A request of [`WILD`] numbers.
    pub fn draw_wild(&self, random: &mut Random, out: usize) -> Request {
        Request {
            wrench: [(); 4].map(|()| random.wild()),
            volts: random.wild(),
            density: random.wild(),
            health: self.failed(random, out),
        }
    }

    /// The least-norm efforts of `request` at the reference voltage, unit by unit, with the throttles
    /// for them; `None` where a unit cannot give its efforts.
    pub fn least_norm(&self, request: &Request) -> Option<Vec<f32>> {
        let factors = self.factors(request);
        let mut throttle = vec![0.0; self.channels() as usize];
        for unit in self.tables.units {
            let efforts = [0, 1].map(|row| {
                let terms = unit.allocation[row].iter().zip(request.wrench);
                let effort: f64 = terms.map(|(a, b)| f64::from(*a) * f64::from(b)).sum();
                (effort / factors[row]) as f32
            });
            let [throttles, given] = (self.invert)(efforts);
            // A little less than what the mixer allows: it rounds otherwise.
            let tolerance = self.tables.tolerance.efforts;
            if (0..2).any(|row| (given[row] - efforts[row]).abs() > 0.9 * tolerance[row]) {
                return None;
            }
            for (channel, value) in unit.channels.iter().zip(throttles) {
                throttle[usize::from(*channel)] = value;
            }
        }
        Some(throttle)
    }

    /// `[k_f, k_Q]` under the conditions of a request.
    pub fn factors(&self, request: &Request) -> [f64; 2] {
        let is_measured = request.density > 0.0 && request.density.is_finite();
        let laws = [
            (&self.tables.voltage, Some(request.volts)),
            (&self.tables.air, is_measured.then_some(request.density)),
        ];
        let of = laws.map(|(law, x)| {
            let Some(law) = law else { return [1.0; 2] };
            let x = f64::from(x.unwrap_or(law.reference).clamp(law.range[0], law.range[1]));
            let before = |piece: &&LawPiece| f64::from(piece.start) <= x;
            let piece = law.pieces.iter().rfind(before).expect("a range");
            let along = x - f64::from(piece.start);
            let value =
                |polynomial: [f32; 5]| polynomial.iter().fold(0.0, |sum, c| sum * along + f64::from(*c));
            [piece.thrust, piece.torque].map(value)
        });
        [of[0][0] * of[1][0], of[0][1] * of[1][1]]
    }

    /// The wrench of throttles, in double precision.
    pub fn given(&self, request: &Request, throttle: &[f32]) -> [f64; 4] {
        let factors = self.factors(request);
        let mut wrench = [0.0; 4];
        for unit in self.tables.units {
            let turns = unit.channels.map(|channel| !request.health.has_failed(channel));
            let throttles = unit
                .channels
                .map(|channel| f64::from(throttle[usize::from(channel)]));
            let efforts = [0, 1].map(|row| match turns {
                [true, true] => sum(&self.pair[row], self.terms, throttles),
                [false, false] => 0.0,
                [upper, _] => {
                    let rotor = &self.alone[usize::from(!upper)];
                    let coefficients = [&rotor.thrust, &rotor.torque][row];
                    sum(
                        coefficients,
                        if upper { "uuuu uuu uu u" } else { "llll lll ll l" },
                        throttles,
                    )
                }
            });
            for (row, effort) in efforts.into_iter().enumerate() {
                for (wrench, effect) in wrench.iter_mut().zip(unit.effectiveness[row]) {
                    *wrench += f64::from(effect) * factors[row] * effort;
                }
            }
        }
        wrench
    }

    /// Whether level flight at the thrust asked is delivered.
    pub fn has_level(&self, request: &Request) -> bool {
        let wrench = [0.0, 0.0, 0.0, request.wrench[3]];
        !self.mix(&Request { wrench, ..*request }).saturation.any_axis()
    }

    /// By how much (roll, pitch) is off its direction, N m, and what may be.
    pub fn turned(&self, request: &Request, answer: &Answer) -> [f64; 2] {
        let [asked, got] = [request.wrench, answer.achieved].map(|wrench| wrench.map(f64::from));
        let slack = self.slack();
        let across = (got[0] * asked[1] - got[1] * asked[0]).abs() / length(asked);
        [across, length(slack)]
    }

    /// Roll and pitch achieved along those asked, as a share of the authority.
    pub fn along(&self, request: &Request, answer: &Answer) -> f64 {
        let authority = self.authority();
        let [asked, got] = [request.wrench, answer.achieved]
            .map(|wrench| [0, 1, 2, 3].map(|axis| f64::from(wrench[axis] / authority[axis])));
        (asked[0] * got[0] + asked[1] * got[1]) / length(asked)
    }
}

/// Of roll and pitch.
fn length([roll, pitch, ..]: [f64; 4]) -> f64 {
    (roll * roll + pitch * pitch).sqrt()
}

/// The sum of coefficients times products of throttles, u and l by their letters.
fn sum(coefficients: &[f32], terms: &str, [u, l]: [f64; 2]) -> f64 {
    let factor = |letter| if letter == 'u' { u } else { l };
    let products = terms
        .split(' ')
        .map(|term| term.chars().map(factor).product::<f64>());
    let terms = products
        .zip(coefficients)
        .map(|(product, c)| product * f64::from(*c));
    terms.sum()
}

/// Fails with the number of faults and the first of them.
#[track_caller]
pub fn assert_none<F: Debug>(what: &str, cases: usize, faults: &[F]) {
    let first = &faults[..faults.len().min(4)];
    assert!(
        faults.is_empty(),
        "{what}: {} of {cases}, first {first:#?}",
        faults.len()
    );
}
