//! Wrenches that random throttles give are delivered.

use mixer_rt::Health;
use mixer_tests::frames::{self, Options};
use mixer_tests::random::Random;
use mixer_tests::request::{Frame, Request};

use crate::regular_frames;

#[test]
fn attainable_wrenches_are_delivered_at_any_voltage_and_order_of_channels() {
    const COUNT: usize = 2000;
    let mut random = Random(1);
    for (name, places) in regular_frames() {
        let mut channels: Vec<usize> = (0..2 * places.len()).collect();
        random.shuffle(&mut channels);
        let text = frames::toml(&places, &channels, Options::default());
        let frame = Frame::new(frames::compile_text(&text).expect(name));
        let mut delivered = 0;
        for _ in 0..COUNT {
            let volts = frame.draw_volts(&mut random);
            let shares: Vec<f64> = channels.iter().map(|_| random.between(0.0, 1.0)).collect();
            let throttles = frame.physics.throttles(shares.into_iter(), Health::GOOD);
            let request = Request {
                wrench: frame.physics.wrench(&throttles, volts).map(|x| x as f32),
                volts,
                health: Health::GOOD,
            };
            let answer = request.mix(&frame).expect("finite");
            delivered += usize::from(!answer.saturation.any_axis());
        }
        println!("{name}: {delivered} of {COUNT} delivered");
        assert_eq!(delivered, COUNT, "{name}");
    }
}
