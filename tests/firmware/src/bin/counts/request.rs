//! A request, and how it is varied.

use core::fmt;

use mixer_rt::Health;
use mixer_setpoints::{Random, RotorsOut};

use crate::subject::{self, airframe::CHANNELS};

/// Where the sequence of the rotors that are out starts.
const SEED: u64 = 9;

/// A wrench, which rotors are out, and the battery's voltage.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Request {
    /// Roll, pitch, yaw (N m), thrust (N).
    pub(crate) wrench: [f32; 4],
    pub(crate) health: Health,
    /// V.
    pub(crate) voltage_v: f32,
}

impl Request {
    /// Asks for nothing.
    pub(crate) const NOTHING: Request = Request {
        wrench: [0.0; 4],
        health: Health::GOOD,
        voltage_v: 0.0,
    };

    pub(crate) fn is_finite(&self) -> bool {
        self.voltage_v.is_finite() && self.wrench.iter().all(|value| value.is_finite())
    }
}

/// f32 bits, and the channels that are out as a bit each.
impl fmt::Display for Request {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for value in self.wrench.iter().chain([&self.voltage_v]) {
            write!(f, "{:08x},", value.to_bits())?;
        }
        let out = (0..64).filter(|channel| self.health.has_failed(*channel as u8));
        write!(f, "{:016x}", out.fold(0u64, |bits, channel| bits | 1 << channel))
    }
}

/// Requests as the build script has written them, to as many rotors less as the subject is asked
/// with.
pub(crate) fn requests(bytes: &'static [u8]) -> impl Iterator<Item = Request> {
    let healths = RotorsOut::new(SEED, CHANNELS, subject::ROTORS_OUT);
    bytes.chunks_exact(20).zip(healths).map(|(row, health)| {
        let mut values = [0.0; 5];
        for (value, bytes) in values.iter_mut().zip(row.chunks_exact(4)) {
            let mut word = [0; 4];
            word.copy_from_slice(bytes);
            *value = f32::from_le_bytes(word);
        }
        let [roll, pitch, yaw, thrust, voltage_v] = values;
        Request {
            wrench: [roll, pitch, yaw, thrust],
            health,
            voltage_v,
        }
    })
}

/// Steps of 2^-0 to 2^-23 of a value.
const HALVINGS: u32 = 24;
const SIGNED: [f32; 2] = [-1.0, 1.0];

/// A child of `request`: one or two of its properties changed, some of them towards `other` or by
/// its distance from `third`. May be not finite.
pub(crate) fn vary(random: &mut Random, request: Request, other: Request, third: Request) -> Request {
    let mut child = vary_once(random, request, other, third);
    while random.index(3) == 0 {
        child = vary_once(random, child, other, third);
    }
    child
}

fn vary_once(random: &mut Random, mut child: Request, other: Request, third: Request) -> Request {
    let mut size = 1.0;
    for _ in 0..random.index(HALVINGS) {
        size *= 0.5;
    }
    let axis = random.below(4);
    let before = child;
    match random.index(11) {
        // One axis, all of them each by itself, all of them alike.
        0 | 1 => child.wrench[axis] *= 1.0 + size * random.between(SIGNED),
        2 => child
            .wrench
            .iter_mut()
            .for_each(|value| *value *= 1.0 + size * random.between(SIGNED)),
        3 => {
            let by = 1.0 + size * random.between(SIGNED);
            child.wrench.iter_mut().for_each(|value| *value *= by);
        }
        4 => child.voltage_v *= 1.0 + 0.1 * size * random.between(SIGNED),
        // To the other side; roll for pitch.
        5 => match random.index(2) {
            0 => child.wrench[axis] = -child.wrench[axis],
            _ => child.wrench.swap(0, 1),
        },
        // An axis of another request, or by a share of any of its axes: zero does not stay zero.
        6 => child.wrench[axis] = other.wrench[axis],
        7 => child.wrench[axis] += size * random.between(SIGNED) * other.wrench[random.below(4)],
        // Along the line through two requests, or in parallel to it.
        8 => step(&mut child, random.between([-1.0, 2.0]), other, before),
        9 => step(&mut child, size * random.between(SIGNED), other, third),
        _ => child.health = health(random, child.health, other.health),
    }
    child
}

/// Moves `child` by as much of the way from `from` to `to`.
fn step(child: &mut Request, by: f32, to: Request, from: Request) {
    for (value, (to, from)) in child.wrench.iter_mut().zip(to.wrench.iter().zip(from.wrench)) {
        *value += by * (to - from);
    }
    child.voltage_v += by * (to.voltage_v - from.voltage_v);
}

/// Another rotor in the place of one that is out, or the health of another request.
fn health(random: &mut Random, health: Health, other: Health) -> Health {
    if subject::ROTORS_OUT == 0 || random.index(4) == 0 {
        return other;
    }
    let channels = CHANNELS as u32;
    let [back, out] = loop {
        let [back, out] = [0; 2].map(|_: i32| random.index(channels) as u8);
        if health.has_failed(back) && !health.has_failed(out) {
            break [back, out];
        }
    };
    (0..CHANNELS as u8)
        .filter(|channel| *channel == out || *channel != back && health.has_failed(*channel))
        .fold(Health::GOOD, Health::with_failed)
}
