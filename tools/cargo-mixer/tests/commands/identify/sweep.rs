//! Synthetic pairs with known truth, written as each bench tool writes its files.

use std::fmt::Write as _;

use mixer_compiler::airframe::Basis;
use mixer_identify::bench::read;
use mixer_identify::bench::{self, Bench};
use mixer_identify::fit::polynomial::Polynomial;
use mixer_identify::identified::Settings;
use mixer_identify::refusal::Refusal;
use mixer_setpoints::Random;

use mixer_identify::paper::{THRUST, TORQUE};

/// Normal numbers from a seed, by Box and Muller.
pub(crate) struct Normal(Random);

impl Normal {
    pub(crate) fn new(seed: u64) -> Self {
        Normal(Random::new(seed))
    }

    /// In (0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        ((self.0.bits() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    pub(crate) fn next(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        radius * libm::cos(2.0 * std::f64::consts::PI * self.uniform())
    }
}

/// One row of a sweep in SI units. The rotors' parts add up to the whole.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    pub(crate) u: f64,
    pub(crate) l: f64,
    pub(crate) thrust: [f64; 2],
    pub(crate) torque: [f64; 2],
    pub(crate) voltage: f64,
}

/// A 10 x 10 sweep of Table I's pair with normal errors of 0.1 N and 1 mN m on the totals.
pub(crate) fn rows(seed: u64) -> Vec<Row> {
    let mut normal = Normal::new(seed);
    let [f, q] = [&THRUST, &TORQUE].map(|c| Polynomial::of(Basis::Biquadratic, c));
    let level = |k: usize| 0.1 + 0.1 * k as f64;
    let row = |k: usize| {
        let (u, l) = (level(k / 10), level(k % 10));
        let thrust = f.at(u, l) + 0.1 * normal.next();
        let torque = q.at(u, l) + 0.001 * normal.next();
        // Any split serves, as long as signs are those of a pair: upper torque below zero, lower
        // above.
        let lower = torque.max(0.0) + 0.05 + 0.1 * l;
        Row {
            u,
            l,
            thrust: [0.6 * thrust, 0.4 * thrust],
            torque: [torque - lower, lower],
            voltage: 14.8,
        }
    };
    (0..100).map(row).collect()
}

fn us(throttle: f64) -> f64 {
    1000.0 + 1000.0 * throttle
}

const G: f64 = 9.80665;

/// Writes a sweep as the bytes of a file.
type Write = fn(&[Row]) -> Vec<u8>;

/// Every format, by name.
pub(crate) const FORMATS: [(&str, Write); 7] = [
    ("plain", plain),
    ("coaxial map", coaxial_map),
    ("RCbenchmark 1780", dual),
    ("Flight Stand", flight_stand),
    ("semicolons, Latin-1, CR", semicolons),
    ("tabs, percent, ounces", tabs),
    ("streaming", streaming),
];

pub(crate) fn plain(rows: &[Row]) -> Vec<u8> {
    let mut text = "upper,lower,thrust_n,torque_nm,voltage_v\n".to_string();
    for r in rows {
        let (f, q) = (r.thrust[0] + r.thrust[1], r.torque[0] + r.torque[1]);
        writeln!(text, "{:?},{:?},{f:?},{q:?},{:?}", r.u, r.l, r.voltage).expect("a string");
    }
    text.into_bytes()
}

/// newdexterity: CR LF, grams, blanks behind headers, two start rows and a stop row with spin-down
/// thrust.
fn coaxial_map(rows: &[Row]) -> Vec<u8> {
    let mut text = "PWM Left,PWM Right,Dxl 1 Pos ,Thrust Left [g],Torque Left [Nm],Thrust Right [g],\
                    Torque Right [Nm],Thrust Centre [g],Voltage Left [V],Voltage Right [V],Speed Left [rpm],\
                    Total Thrust [g],Total Torque [Nm],Time [s]\r\n"
        .to_string();
    let stop = Row {
        u: 0.0,
        l: 0.0,
        thrust: [0.3, 0.3],
        torque: [0.0; 2],
        voltage: 14.8,
    };
    let rest = Row {
        thrust: [0.0; 2],
        ..stop
    };
    let all = [&[stop, rest], rows, &[stop]].concat();
    for (k, r) in all.iter().enumerate() {
        let [f0, f1] = r.thrust.map(|f| f / G * 1000.0);
        let [q0, q1] = r.torque;
        write!(
            text,
            "{:.8},{:.8},0.0,{f0:?},{q0:?},{f1:?},{q1:?},-0.0,{:?},{:?},3000,{:?},{:?},{k}\r\n",
            us(r.u),
            us(r.l),
            r.voltage,
            r.voltage + 0.2,
            f0 + f1,
            q0 + q1
        )
        .expect("a string");
    }
    text.into_bytes()
}

/// RCbenchmark 1780: BOM, a trailing comma, both rotors' torque and the lower one's thrust with the
/// mounting's sign.
fn dual(rows: &[Row]) -> Vec<u8> {
    let mut text =
        "\u{feff}Time (s),ESC A (µs),ESC B (µs),Torque A (N·m),Torque B (N·m),Thrust A (kgf),Thrust B (kgf),\
                    Voltage A (V),Current A (A),App message,\n"
            .to_string();
    for (k, r) in rows.iter().enumerate() {
        writeln!(
            text,
            "{k},{:?},{:?},{:?},{:?},{:?},{:?},{:?},1.0,\"hello, world\",",
            us(r.u),
            us(r.l),
            -r.torque[0],
            r.torque[1],
            r.thrust[0] / G,
            -r.thrust[1] / G,
            r.voltage
        )
        .expect("a string");
    }
    text.into_bytes()
}

/// Tyto Flight Stand: other micro and dot signs, edited prefixes.
fn flight_stand(rows: &[Row]) -> Vec<u8> {
    let mut text = "Time (s),Top motor - ESC throttle (μs),Top motor - force Fz (thrust) (N),\
                    Top motor - torque MZ (torque) (N⋅m),Top motor - voltage (V),Top motor - efficiency (gf/W),\
                    Bottom motor - ESC throttle (μs),Bottom motor - force Fz (thrust) (N),\
                    Bottom motor - torque MZ (torque) (N⋅m),Bottom motor - rotation speed (rpm)\n"
        .to_string();
    for (k, r) in rows.iter().enumerate() {
        let ([f0, f1], [q0, q1]) = (r.thrust, r.torque);
        let (u, l) = (us(r.u), us(r.l));
        writeln!(
            text,
            "{k},{u:?},{f0:?},{q0:?},{:?},1,{l:?},{f1:?},{q1:?},3000",
            r.voltage
        )
        .expect("a string");
    }
    text.into_bytes()
}

/// A spreadsheet in a country of decimal commas, saved on an old Mac.
fn semicolons(rows: &[Row]) -> Vec<u8> {
    let mut text = "ESC A (\u{b5}s);ESC B (\u{b5}s);Thrust (gf);Torque (N\u{b7}m);Voltage (V);\r".to_string();
    for r in rows {
        let (f, q) = (
            (r.thrust[0] + r.thrust[1]) / G * 1000.0,
            r.torque[0] + r.torque[1],
        );
        let line = format!("{:?};{:?};{f:?};{q:?};{:?};\r", us(r.u), us(r.l), r.voltage);
        text.push_str(&line.replace('.', ","));
    }
    text.chars()
        .map(|c| u8::try_from(u32::from(c)).expect("Latin-1"))
        .collect()
}

fn tabs(rows: &[Row]) -> Vec<u8> {
    let (pound, inch) = (0.453_592_37 * G, 0.0254);
    let mut text = "upper throttle (%)\tlower throttle (%)\tthrust (lbf)\ttorque (ozf-in)\n".to_string();
    for r in rows {
        let f = (r.thrust[0] + r.thrust[1]) / pound;
        let q = (r.torque[0] + r.torque[1]) / (pound / 16.0 * inch);
        writeln!(text, "{:?}\t{:?}\t{f:?}\t{q:?}", 100.0 * r.u, 100.0 * r.l).expect("a string");
    }
    text.into_bytes()
}

/// A streaming log: 16 rows per command, blank torque and thrust in most, a rotor that takes four
/// rows to speed up.
fn streaming(rows: &[Row]) -> Vec<u8> {
    let mut text = "Time (s),ESC A (µs),ESC B (µs),Torque (N·m),Thrust (N),Voltage (V)\n".to_string();
    let mut before = [0.0, 0.0];
    for (k, r) in rows.iter().enumerate() {
        let now = [r.torque[0] + r.torque[1], r.thrust[0] + r.thrust[1]];
        for step in 0..16 {
            let settled = (f64::from(step) / 4.0).min(1.0);
            let value = |c: usize| before[c] + settled * (now[c] - before[c]);
            let torque = if step % 3 == 0 {
                String::new()
            } else {
                format!("{:?}", value(0))
            };
            let thrust = if step % 4 == 1 {
                String::new()
            } else {
                format!("{:?}", value(1))
            };
            let time = k as f64 + 0.06 * f64::from(step);
            writeln!(
                text,
                "{time},{:?},{:?},{torque},{thrust},{:?}",
                us(r.u),
                us(r.l),
                r.voltage
            )
            .expect("a string");
        }
        before = now;
    }
    text.into_bytes()
}

pub(crate) fn settings(basis: Option<Basis>) -> Settings {
    let mut settings = Settings::default();
    settings.wishes.basis = basis;
    settings
}

/// Reads bytes as a file of this name.
pub(crate) fn bench(name: &str, bytes: &[u8], settings: &Settings) -> Result<Bench, Refusal> {
    let log = read::read(name, bytes, &settings.reading)?;
    bench::prepare(log, &settings.preparation)
}
