//! A client that speaks as PX4 does.

use std::io::Write;
use std::net::TcpStream;
use std::time::Duration;

use mavlink::dialects::common::{
    HIL_ACTUATOR_CONTROLS_DATA, HilActuatorControlsFlags, MavMessage, MavModeFlag,
};
use mavlink::{MAVLinkV2MessageRaw, MavHeader, MavlinkReader, MavlinkVersion};

use crate::server::Server;
use crate::{Client, ROTORS, Truth};

pub(crate) struct Px4 {
    stream: TcpStream,
    reader: MavlinkReader<TcpStream>,
    time_us: u64,
}

impl Px4 {
    pub(crate) fn connect(server: &Server) -> Px4 {
        let stream = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
        stream.set_nodelay(true).unwrap();
        let mut px4 = Px4 {
            reader: MavlinkReader::new(stream.try_clone().unwrap()),
            stream,
            time_us: 0,
        };
        let first = px4
            .reader
            .read_message::<MavMessage>(MavlinkVersion::V2)
            .unwrap()
            .1;
        assert!(matches!(first, MavMessage::HEARTBEAT(_)), "{first:?}");
        px4.receive(Duration::from_secs(5)).unwrap();
        px4
    }

    /// The next sample; `None` if there is none in time, or the simulator has ended.
    pub(crate) fn receive(&mut self, patience: Duration) -> Option<Truth> {
        self.stream.set_read_timeout(Some(patience)).unwrap();
        let mut truth = None;
        loop {
            let (_, message) = self.reader.read_message::<MavMessage>(MavlinkVersion::V2).ok()?;
            match message {
                MavMessage::HIL_STATE_QUATERNION(state) => {
                    let metres = |degrees: f64| degrees.to_radians() * 6_371_000.0;
                    let north = metres(f64::from(state.lat) * 1e-7 - 47.397_742);
                    let east = metres(f64::from(state.lon) * 1e-7 - 8.545_594)
                        * libm::cos(47.397_742f64.to_radians());
                    // The message has 1e-7 degrees: a centimetre.
                    let position = [north, east, 488.0 - f64::from(state.alt) * 1e-3];
                    truth = Some(Truth {
                        time_us: state.time_usec,
                        position: position.map(|x| if x.abs() < 0.02 { 0.0 } else { x }),
                        velocity: [state.vx, state.vy, state.vz].map(|speed| f64::from(speed) * 0.01),
                        quaternion: state.attitude_quaternion.map(f64::from),
                        rate: [state.rollspeed, state.pitchspeed, state.yawspeed].map(f64::from),
                        acceleration: [0.0; 3],
                    });
                }
                MavMessage::HIL_SENSOR(sensor) => {
                    let mut truth = truth?;
                    assert_eq!(truth.time_us, sensor.time_usec);
                    truth.acceleration = [sensor.xacc, sensor.yacc, sensor.zacc].map(f64::from);
                    self.time_us = sensor.time_usec;
                    return Some(truth);
                }
                _ => {}
            }
        }
    }

    /// Outputs in answer to the last sample.
    pub(crate) fn answer(&mut self, throttles: &[f64; ROTORS]) {
        let frame = self.frame(throttles);
        // The simulator may have ended.
        let _ = self.stream.write_all(&frame);
    }

    fn frame(&self, throttles: &[f64; ROTORS]) -> Vec<u8> {
        let mut controls = [0.0; 16];
        for (control, throttle) in controls.iter_mut().zip(throttles) {
            *control = *throttle as f32;
        }
        let message = MavMessage::HIL_ACTUATOR_CONTROLS(HIL_ACTUATOR_CONTROLS_DATA {
            time_usec: self.time_us,
            flags: HilActuatorControlsFlags::HIL_ACTUATOR_CONTROLS_FLAGS_LOCKSTEP,
            controls,
            mode: MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED | MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
        });
        let mut raw = MAVLinkV2MessageRaw::new();
        raw.serialize_message(MavHeader::default(), &message);
        raw.raw_bytes().to_vec()
    }

    pub(crate) fn send_raw(&mut self, bytes: &[u8]) {
        self.stream.write_all(bytes).unwrap();
    }

    /// An answer with a wrong byte.
    pub(crate) fn send_corrupt(&mut self) {
        let mut frame = self.frame(&[1.0; ROTORS]);
        frame[30] ^= 0x10;
        self.send_raw(&frame);
    }
}

impl Client for Px4 {
    fn step(&mut self, throttles: &[f64; ROTORS]) -> Truth {
        self.answer(throttles);
        self.receive(Duration::from_secs(5)).unwrap()
    }
}
