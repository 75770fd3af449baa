//! Wrenches that throttles give are delivered.

use mixer_rt::Health;
use mixer_setpoints::Random;
use mixer_tests::frames;
use mixer_tests::request::Request;

/// Pairs of the airframes: the paper's, and those identified from bench maps.
pub(crate) const PAIRS: [&str; 5] = [
    "isae-x8",
    "x8-11in-cubic",
    "x8-16in-biquadratic",
    "x8-16in-quartic",
    "x8-22in-cubic",
];

/// Wrenches of throttles every second of which is at an end of its range: the border of what is
/// attainable, on frames of the zoo of three to eight units.
#[test]
fn wrenches_of_throttles_at_their_limits_are_delivered_to_a_percent() {
    const FRAMES: usize = 60;
    const COUNT: usize = 60;
    const ALLOWED: f64 = 0.01;
    let zoo = frames::zoo(5).expect("airframes/");
    let mut random = Random::new(5);
    let (mut asked, mut missed) = (0, 0);
    let mut worst: f64 = 0.0;
    let frames = frames::frames(&zoo).map(|(_, frame)| frame);
    let frames = frames.filter(|frame| (3..=8).contains(&frame.physics.units()));
    for frame in frames.take(FRAMES) {
        for _ in 0..COUNT {
            let shares = (0..2 * frame.physics.units()).map(|_| match random.below(4) {
                0 => 0.0,
                1 => 1.0,
                _ => random.uniform(0.0, 1.0),
            });
            let shares: Vec<f64> = shares.collect();
            let throttles = frame.physics.throttles(shares.into_iter(), Health::GOOD);
            let volts = frame.draw_volts(&mut random);
            let request = Request {
                wrench: frame.physics.wrench(&throttles, volts).map(|x| x as f32),
                volts,
                health: Health::GOOD,
            };
            let answer = request.mix(&frame).expect("finite");
            let short = (0..4)
                .filter(|&axis| frame.served()[axis])
                .map(|axis| (request.asked()[axis] - answer.achieved[axis]).abs() / frame.size(axis));
            let short = short.fold(0.0, f64::max);
            asked += 1;
            missed += usize::from(short > ALLOWED);
            worst = worst.max(short);
        }
    }
    println!(
        "{missed} of {asked} are missed by more than 1 %, at worst by {:.2} %",
        100.0 * worst
    );
    assert!(asked >= 3000);
    assert!(missed * 40 <= asked, "{missed} of {asked}");
}

/// `[throttle]` and `[pair]` of an airframe.
pub(crate) fn pair_of(airframe: &str) -> String {
    let file = mixer_tests::root().join(format!("airframes/{airframe}.toml"));
    let text = std::fs::read_to_string(file).expect("an airframe");
    section(&text, "throttle") + &section(&text, "pair")
}

/// A table of an airframe file with its header.
fn section(text: &str, name: &str) -> String {
    let header = format!("[{name}]");
    let from = text.find(&header).unwrap_or_else(|| panic!("{header}"));
    let length = text[from + 1..]
        .find("\n[")
        .map_or(text.len() - from, |end| end + 2);
    text[from..from + length].to_owned()
}
