//! A client that speaks as ArduPilot does.

use std::io::ErrorKind;
use std::net::UdpSocket;
use std::time::Duration;

use serde_json::Value;

use crate::server::Server;
use crate::{Client, ROTORS, Truth};

/// How often an answer is waited for, and for how long.
const PATIENCE: usize = 20;
const WAIT: Duration = Duration::from_millis(250);

pub(crate) struct Ardupilot {
    socket: UdpSocket,
    /// Number of the packet that is next.
    pub(crate) count: u32,
    /// 16 or 32
    pub(crate) channels: usize,
}

impl Ardupilot {
    pub(crate) fn connect(server: &Server) -> Ardupilot {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.connect(("127.0.0.1", server.port)).unwrap();
        socket.set_read_timeout(Some(WAIT)).unwrap();
        Ardupilot {
            socket,
            count: 0,
            channels: 16,
        }
    }

    pub(crate) fn send_raw(&self, bytes: &[u8]) {
        self.socket.send(bytes).unwrap();
    }

    /// The answer to a packet; `None` if there is none in time.
    fn exchange(&self, throttles: &[f64; ROTORS]) -> Option<String> {
        let magic: u16 = if self.channels == 16 { 18_458 } else { 29_569 };
        let mut packet = magic.to_le_bytes().to_vec();
        packet.extend(400u16.to_le_bytes());
        packet.extend(self.count.to_le_bytes());
        for channel in 0..self.channels {
            let throttle = throttles.get(channel).copied().unwrap_or(0.0);
            packet.extend(((1000.0 + 1000.0 * throttle).round() as u16).to_le_bytes());
        }
        let mut bytes = [0; 2048];
        for _ in 0..PATIENCE {
            self.socket.send(&packet).ok()?;
            match self.socket.recv(&mut bytes) {
                Ok(count) => return Some(String::from_utf8(bytes[..count].to_vec()).unwrap()),
                // Repeats itself, as ArduPilot does.
                Err(error) if error.kind() == ErrorKind::WouldBlock => {}
                Err(_) => return None,
            }
        }
        panic!("the simulator says nothing");
    }

    pub(crate) fn send_and_receive(&self, throttles: &[f64; ROTORS]) -> String {
        self.exchange(throttles).unwrap()
    }

    /// A step; `None` if the simulator has ended.
    pub(crate) fn try_step(&mut self, throttles: &[f64; ROTORS]) -> Option<Truth> {
        self.count += 1;
        let answer = self.exchange(throttles)?;
        assert!(
            answer.starts_with('\n') && answer.ends_with('\n') && !answer.contains(": "),
            "{answer}"
        );
        let json: Value = serde_json::from_str(&answer).unwrap();
        let number = |value: &Value| value.as_f64().unwrap();
        let three = |value: &Value| [0, 1, 2].map(|k: usize| number(&value[k]));
        let volts = number(&json["battery"]["voltage"]);
        assert!((volts - 21.87).abs() < 0.1, "{answer}");
        Some(Truth {
            time_us: (1e6 * number(&json["timestamp"])).round() as u64,
            position: three(&json["position"]),
            velocity: three(&json["velocity"]),
            quaternion: [0, 1, 2, 3].map(|k: usize| number(&json["quaternion"][k])),
            rate: three(&json["imu"]["gyro"]),
            acceleration: three(&json["imu"]["accel_body"]),
        })
    }
}

impl Client for Ardupilot {
    fn step(&mut self, throttles: &[f64; ROTORS]) -> Truth {
        self.try_step(throttles).unwrap()
    }
}
