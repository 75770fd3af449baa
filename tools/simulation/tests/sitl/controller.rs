//! What stands behind the client's link: the modes and the arming that the pilot looks at, a plain
//! position and attitude controller, and the airframe's mixer.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};

use mavlink::dialects::common::{
    ATTITUDE_TARGET_DATA, AttitudeTargetTypemask, HEARTBEAT_DATA, MavAutopilot, MavCmd, MavMessage,
    MavModeFlag, MavSeverity, MavState, MavType, STATUSTEXT_DATA,
};
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use mixer_compiler::{Compiled, Source};
use mixer_rt::Wrench;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use simulation::sitl::frames::Frames;

use crate::{ROTORS, Truth, WEIGHT_N};

const MASS_KG: f64 = 6.5;
const INERTIA_KG_M2: [f64; 3] = [0.165, 0.165, 0.329];

/// Guided mode.
const GUIDED: u32 = 4;

pub(crate) struct Controller {
    listener: TcpListener,
    stream: Option<TcpStream>,
    frames: Frames,
    mixer: Compiled,
    pub(crate) armed: bool,
    pub(crate) mode: u32,
    /// North, east, down, m, and heading, rad.
    target: Option<([f64; 3], f64)>,
    steps: u64,
}

impl Controller {
    pub(crate) fn new() -> Controller {
        let text = include_str!("../../../../examples/simulator/x8.toml");
        Controller {
            listener: TcpListener::bind("127.0.0.1:0").unwrap(),
            stream: None,
            frames: Frames::default(),
            mixer: mixer_compiler::compile(&Source::new("x8.toml", text)).unwrap(),
            armed: false,
            mode: 0,
            target: None,
            steps: 0,
        }
    }

    pub(crate) fn port(&self) -> u16 {
        self.listener.local_addr().unwrap().port()
    }

    /// The pilot connects before the first packet, as ArduPilot waits for.
    pub(crate) fn accept(&mut self) {
        let (stream, _) = self.listener.accept().unwrap();
        stream.set_nonblocking(true).unwrap();
        self.stream = Some(stream);
    }

    pub(crate) fn update(&mut self, truth: &Truth) -> [f64; ROTORS] {
        self.hear(truth);
        self.steps += 1;
        let Some((target, yaw)) = self.target.filter(|_| self.armed) else {
            self.report(0.0);
            return [0.0; ROTORS];
        };
        let [position, velocity, rate] = [truth.position, truth.velocity, truth.rate].map(Vector3::from);
        let [w, x, y, z] = truth.quaternion;
        let attitude = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
        let error = (Vector3::from(target) - position).cap_magnitude(2.0);
        let demanded = error * 2.0 - velocity * 2.4;
        let (sin, cos) = libm::sincos(attitude.euler_angles().2);
        // Nose down to the front, right side down to the right.
        let [front, right] = [
            demanded.x * cos + demanded.y * sin,
            demanded.y * cos - demanded.x * sin,
        ];
        let wanted = UnitQuaternion::from_euler_angles(
            (right / 9.8).clamp(-0.3, 0.3),
            (-front / 9.8).clamp(-0.3, 0.3),
            yaw,
        );
        let turn = (attitude.inverse() * wanted).scaled_axis();
        let gains = [[60.0, 12.0], [60.0, 12.0], [4.0, 3.5]];
        let torque = |axis: usize| {
            let [stiffness, damping] = gains[axis];
            let turn = turn[axis].clamp(-1.0, 1.0);
            (INERTIA_KG_M2[axis] * (stiffness * turn - damping * rate[axis])) as f32
        };
        let level = (attitude * Vector3::z()).z.max(0.5);
        let thrust = MASS_KG * (9.806_65 - demanded.z).max(1.0) / level;
        self.report(thrust);
        let setpoint = Wrench {
            roll_nm: torque(0),
            pitch_nm: torque(1),
            yaw_nm: torque(2),
            thrust_n: thrust as f32,
        };
        let (throttles, ..) = self.mixer.tables.mix(&setpoint, 21.87).unwrap();
        std::array::from_fn(|output| f64::from(throttles[output]))
    }

    fn hear(&mut self, truth: &Truth) {
        let mut bytes = [0; 4096];
        while let Ok(count @ 1..) = self.stream.as_mut().unwrap().read(&mut bytes) {
            self.frames.push(&bytes[..count]);
        }
        for (_, message) in self.frames.by_ref() {
            match message {
                MavMessage::COMMAND_LONG(command) => match command.command {
                    MavCmd::MAV_CMD_DO_SET_MODE => self.mode = command.param2 as u32,
                    MavCmd::MAV_CMD_COMPONENT_ARM_DISARM if self.mode == GUIDED => self.armed = true,
                    MavCmd::MAV_CMD_NAV_TAKEOFF if self.armed => {
                        let [north, east, _] = truth.position;
                        self.target = Some(([north, east, -f64::from(command.param7)], 0.0));
                    }
                    _ => {}
                },
                MavMessage::SET_POSITION_TARGET_LOCAL_NED(target) => {
                    let place = [target.x, target.y, target.z].map(f64::from);
                    self.target = Some((place, target.yaw.into()));
                }
                _ => {}
            }
        }
    }

    /// Heartbeats, and the thrust over that of all rotors at full throttle.
    fn report(&mut self, thrust_n: f64) {
        let armed = MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED;
        let heartbeat = MavMessage::HEARTBEAT(HEARTBEAT_DATA {
            custom_mode: self.mode,
            mavtype: MavType::MAV_TYPE_OCTOROTOR,
            autopilot: MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA,
            base_mode: if self.armed { armed } else { MavModeFlag::empty() },
            system_status: MavState::MAV_STATE_ACTIVE,
            mavlink_version: 3,
        });
        let full_n = WEIGHT_N * 2.7;
        let attitude = MavMessage::ATTITUDE_TARGET(ATTITUDE_TARGET_DATA {
            time_boot_ms: 0,
            q: [1.0, 0.0, 0.0, 0.0],
            body_roll_rate: 0.0,
            body_pitch_rate: 0.0,
            body_yaw_rate: 0.0,
            thrust: (thrust_n / full_n) as f32,
            type_mask: AttitudeTargetTypemask::empty(),
        });
        let text = MavMessage::STATUSTEXT(STATUSTEXT_DATA {
            severity: MavSeverity::MAV_SEVERITY_INFO,
            text: "EKF3 IMU0 is using GPS".into(),
            id: 0,
            chunk_seq: 0,
        });
        for (message, every) in [(heartbeat, 100u64), (attitude, 8), (text, 1000)] {
            if self.steps.is_multiple_of(every) {
                let mut raw = MAVLinkV2MessageRaw::new();
                let header = MavHeader {
                    system_id: 1,
                    component_id: 1,
                    sequence: 0,
                };
                raw.serialize_message(header, &message);
                // The simulator may have ended.
                let _ = self.stream.as_mut().unwrap().write_all(raw.raw_bytes());
            }
        }
    }
}
