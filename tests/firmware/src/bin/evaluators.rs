//! Counts the instructions of every evaluator of the inverse map, for one unit, in every basis.
//!
//! Prints a line per evaluator and basis: its name in airframe files (a polynomial's with its
//! degree), the basis, and the mean over efforts all over the attainable set, rounded. A stretch in
//! which the efforts are merely copied is subtracted. What an evaluator costs does not depend on
//! the numbers in its tables, so these are arbitrary, but for the forward map, which is the paper's
//! in all bases.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;
use mixer_rt::{
    Wrench,
    tables::{
        BilinearSeed, Biquadratic, Cubic, CubicSeed, Inverse, Pair, PolynomialInverse, QuadraticSeed,
        Quartic, RootCoordinates, Seeded, ThrottleRange,
    },
};
use probe::{Counter, Mixer};

static RANGE: ThrottleRange = ThrottleRange { min: 0.1, max: 1.0 };

static BIQUADRATIC: Pair<Biquadratic> = Pair {
    thrust: Biquadratic([
        5.2075, -2.1892, 12.3604, -10.2432, 4.4427, 2.7640, 12.2092, 0.2363,
    ]),
    torque: Biquadratic([-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.0720]),
};
// The quadratic part of the paper's map, with small higher terms.
static CUBIC: Pair<Cubic> = Pair {
    thrust: Cubic([0.1, 0.2, -0.1, 0.15, 12.3604, 4.4427, 12.2092, 2.7640, 0.2363]),
    torque: Cubic([
        0.001, 0.002, -0.001, 0.0015, -0.1312, 0.0364, 0.1441, -0.0907, 0.0720,
    ]),
};
static QUARTIC: Pair<Quartic> = Pair {
    thrust: Quartic([
        0.1, 0.2, -0.1, 0.15, 0.1, 0.12, 0.2, -0.12, 0.11, 12.3604, 4.4427, 12.2092, 2.7640, 0.2363,
    ]),
    torque: Quartic([
        0.001, 0.002, -0.001, 0.0015, 0.001, 0.0012, 0.002, -0.0012, 0.0011, -0.1312, 0.0364, 0.1441,
        -0.0907, 0.0720,
    ]),
};

const COORDINATES: RootCoordinates = RootCoordinates {
    x: [0.0403, -2.52, 0.0533],
    y: [0.0403, 3.10, 0.0764],
};

/// Numbers that are neither zero, one nor equal.
const fn numbers<const COUNT: usize>(first: f32) -> [f32; COUNT] {
    let mut numbers = [first; COUNT];
    let mut k = 1;
    while k < COUNT {
        numbers[k] = numbers[k - 1] * -0.83 + 0.011;
        k += 1;
    }
    numbers
}

static TERMS: [f32; 21] = numbers(0.71);
static OTHER_TERMS: [f32; 21] = numbers(0.67);

macro_rules! polynomial {
    ($degree:literal, $terms:literal) => {
        PolynomialInverse {
            thrust: [0.083, -1.01],
            torque: [4.6, 0.012],
            degree: $degree,
            upper: TERMS.first_chunk::<$terms>().unwrap(),
            lower: OTHER_TERMS.first_chunk::<$terms>().unwrap(),
        }
    };
}

/// Counts one evaluator with the three forward maps.
macro_rules! count {
    ($counter:ident, $name:literal, $type:ty, $evaluator:expr) => {
        count!(
            $counter,
            $name,
            "biquadratic",
            BIQUADRATIC,
            $type,
            $evaluator
        );
        count!($counter, $name, "cubic", CUBIC, $type, $evaluator);
        count!($counter, $name, "quartic", QUARTIC, $type, $evaluator);
    };
    ($counter:ident, $name:literal, $basis:literal, $pair:ident, $type:ty, $evaluator:expr) => {{
        /// # Safety
        ///
        /// `efforts` is valid to read, `output` to write a pair of throttles.
        unsafe extern "C" fn inverted(efforts: *const Wrench, output: *mut (), _: f32) {
            static EVALUATOR: $type = $evaluator;
            // SAFETY: the caller's promise.
            unsafe {
                let efforts = [(*efforts).thrust_n, (*efforts).yaw_nm];
                output
                    .cast::<[f32; 2]>()
                    .write(EVALUATOR.throttles(&$pair, &RANGE, efforts));
            }
        }
        hprintln!("{} {} {}", $name, $basis, $counter.mean(inverted));
    }};
}

/// A seed with one and with two Newton steps.
macro_rules! count_seed {
    ($counter:ident, $seed:ident, $newton:literal, $newton2:literal) => {
        count_seed!($counter, $seed, $newton, Seeded<$seed, 1>);
        count_seed!($counter, $seed, $newton2, Seeded<$seed, 2>);
    };
    ($counter:ident, $seed:ident, $name:literal, $type:ty) => {
        count!(
            $counter,
            $name,
            $type,
            Seeded {
                coordinates: COORDINATES,
                seed: $seed {
                    upper: numbers(0.41),
                    lower: numbers(0.37),
                }
            }
        );
    };
}

struct Count {
    counter: Counter,
    copying: u32,
}

/// # Safety
///
/// `efforts` is valid to read, `output` to write a pair of throttles.
unsafe extern "C" fn copied(efforts: *const Wrench, output: *mut (), _: f32) {
    // SAFETY: the caller's promise.
    unsafe {
        output
            .cast::<[f32; 2]>()
            .write([(*efforts).thrust_n, (*efforts).yaw_nm])
    }
}

impl Count {
    fn new(counter: Counter) -> Self {
        let mut count = Count { counter, copying: 0 };
        count.copying = count.mean(copied);
        count
    }

    /// Instructions per unit, rounded.
    fn mean(&self, inverted: Mixer) -> u32 {
        const SIDE: u16 = 12;
        let mut sum = 0;
        for i in 0..SIDE {
            for j in 0..SIDE {
                let [u, l] = [i, j].map(|k| 0.1 + 0.9 * f32::from(k) / f32::from(SIDE - 1));
                let [thrust_n, yaw_nm] = BIQUADRATIC.efforts([u, l]);
                let efforts = Wrench {
                    roll_nm: 0.0,
                    pitch_nm: 0.0,
                    yaw_nm,
                    thrust_n,
                };
                let mut output = [0.0f32; 2];
                // SAFETY: the output is of the type that is written.
                sum += unsafe {
                    self.counter
                        .count(inverted, &efforts, (&raw mut output).cast(), 0.0)
                };
            }
        }
        let count = u32::from(SIDE * SIDE);
        (sum + count / 2) / count - self.copying
    }
}

#[entry]
fn main() -> ! {
    probe::exit(probe::with_counter(|counter| {
        print(&Count::new(counter));
        true
    }))
}

fn print(count: &Count) {
    count!(
        count,
        "polynomial-2",
        PolynomialInverse<'static>,
        polynomial!(2, 6)
    );
    count!(
        count,
        "polynomial-3",
        PolynomialInverse<'static>,
        polynomial!(3, 10)
    );
    count!(
        count,
        "polynomial-5",
        PolynomialInverse<'static>,
        polynomial!(5, 21)
    );
    count_seed!(count, BilinearSeed, "bilinear-newton", "bilinear-newton2");
    count_seed!(count, QuadraticSeed, "quadratic-newton", "quadratic-newton2");
    count_seed!(count, CubicSeed, "cubic-newton", "cubic-newton2");
}
