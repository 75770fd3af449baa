//! Counts steps of the throttles along lines of requests: `cargo jumps --seed 7`.

use std::process::ExitCode;

use clap::Parser;
use mixer_setpoints::Random;
use mixer_tests::frames;
use mixer_tests::soak::jumps::{CLASSES, FRAMES, Jumps};

/// Draws frames class by class and goes along lines of requests. A table: steps of a throttle by more than 0.02 for 1e-4 of the
/// request in 10,000 pairs, how many of them jump and are not just steep, the largest, and of how many.
#[derive(Parser)]
struct Arguments {
    /// Of frames and lines
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Lines of 1,200 requests through every frame
    #[arg(long, default_value_t = 20)]
    lines: usize,
    /// Lines along the limits in place of lines between requests
    #[arg(long)]
    along_limits: bool,
    /// Every step with its requests
    #[arg(long)]
    verbose: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let pairs = match frames::real_pairs(None) {
        Ok(pairs) => pairs,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::FAILURE;
        }
    };
    println!("| class | steps in 10,000 | of them jumps | most | steps |");
    println!("|---|---:|---:|---:|---:|");
    for (class, index) in CLASSES.iter().zip(1..) {
        let mut random = Random::new(Random::new(arguments.seed).bits() ^ index);
        let mut jumps = Jumps::default();
        for number in 0..FRAMES {
            let (frame, health) = class.draw(&mut random, &pairs);
            for _ in 0..arguments.lines {
                let seen = |step: f32, [before, after]: [[f32; 4]; 2]| {
                    if arguments.verbose {
                        println!("frame {number}, {health:?}: {step:.3} from {before:?} to {after:?}");
                    }
                };
                jumps.follow(&frame, health, &mut random, arguments.along_limits, seen);
            }
        }
        println!("| {} | {jumps} |", class.name);
    }
    ExitCode::SUCCESS
}
