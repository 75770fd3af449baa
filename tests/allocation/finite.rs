//! No operation on the way from a finite setpoint to the throttles is invalid, divides by zero or
//! overflows: flight stacks trap these, and the last step, which limits throttles by comparing bits,
//! would take a NaN to one end of the range or to the other by its sign.

use mixer_compiler::tables::MixerTables;
use mixer_rt::{Health, Wrench};
use mixer_setpoints::Random;
use mixer_tests::frames::{self, AIRMODES, Options};

use crate::degenerate::{NUMBERS, degenerate_frames};

/// The sticky flags of SSE in MXCSR: invalid, divide by zero, overflow (Intel SDM, volume 1, 10.2.3).
const FLAGS: u32 = 1 << 0 | 1 << 2 | 1 << 3;

/// The flags that `work` raises, and what it gives.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
fn raised<T>(work: impl FnOnce() -> T) -> (u32, T) {
    use std::arch::asm;
    let mut control = 0u32;
    // SAFETY: both instructions read and write the control register and this variable only.
    unsafe {
        asm!("stmxcsr [{}]", in(reg) &raw mut control);
        control &= !FLAGS;
        asm!("ldmxcsr [{}]", in(reg) &raw const control);
    }
    let result = work();
    // SAFETY: as above.
    unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut control) };
    (control & FLAGS, result)
}

fn check(tables: &MixerTables, setpoint: [f32; 4], volts: f32, health: Health, frame: &str) {
    let wrench = Wrench::from_array(setpoint);
    let (flags, mixed) = raised(|| tables.mix_with_health(&wrench, volts, health));
    let (_, achieved, _) = mixed.expect("finite");
    assert_eq!(flags, 0, "{frame}: {setpoint:?} {volts} V {health:?}");
    assert!(
        achieved.to_array().iter().all(|x| x.is_finite()),
        "{frame}: {wrench:?} -> {achieved:?}"
    );
}

#[test]
fn no_operation_raises_an_exception() {
    let mut random = Random::new(11);
    for (name, places) in degenerate_frames() {
        let cases = [
            (0, 0.0, 0.0),
            (1, 0.02, 0.0),
            (2, 0.0, 0.0),
            (0, 0.0, 0.004),
            (2, 0.0, -0.004),
        ];
        for (mode, yaw_reserve_nm, power_bias_nm_per_n) in cases {
            let airmode = AIRMODES[mode];
            let options = Options {
                airmode,
                yaw_reserve_nm,
                power_bias_nm_per_n,
            };
            let compiled = frames::compile(&places, options).expect("a frame");
            for _ in 0..400 {
                let setpoint = std::array::from_fn(|_| NUMBERS[random.below(NUMBERS.len())]);
                let volts = NUMBERS[random.below(NUMBERS.len())];
                let health = match random.below(2) {
                    0 => Health::GOOD,
                    _ => Health::GOOD.with_failed(random.below(2 * places.len()) as u8),
                };
                check(
                    &compiled.tables,
                    setpoint,
                    volts,
                    health,
                    &format!("{name} {airmode}"),
                );
            }
        }
    }
}

#[test]
fn inverses_raise_no_exception_far_outside_the_attainable_set() {
    let file = mixer_tests::root().join("airframes/isae-x8.toml");
    let text = std::fs::read_to_string(file).expect("an airframe");
    let numbers = [0.0, 1e-45, 1e-30, 1e-6, 0.1, 1.0, 12.0, 30.0, 1e3, 1e6, 1e8];
    let numbers: Vec<f32> = numbers.into_iter().flat_map(|x| [x, -x]).collect();
    let polynomial = "\n[inverse]\nmethod = \"polynomial\"\ndegree = 9\nthrust_tolerance_n = 2.0\ntorque_tolerance_nm = 0.02\n";
    let fine = "\n[inverse]\nthrust_tolerance_n = 0.001\ntorque_tolerance_nm = 1e-5\n";
    for inverse in ["", fine, polynomial] {
        let mut airframe: toml::Table = text.parse().expect("TOML");
        airframe.remove("inverse");
        let compiled = frames::compile_text(&format!("{airframe}{inverse}")).expect(inverse);
        for &f in &numbers {
            for &q in &numbers {
                let (flags, throttles) = raised(|| compiled.tables.throttles(0, [f, q]));
                assert_eq!(flags, 0, "{inverse} at {f} {q}: {throttles:?}");
            }
        }
    }
}
