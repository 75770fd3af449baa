//! What PX4 has at the other end of the MAVLink that the pilot and the battery use.

use std::net::UdpSocket;

use mavlink::dialects::common::{HEARTBEAT_DATA, MavAutopilot, MavMessage, MavModeFlag, MavState, MavType};
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use simulation::sitl::frames::Frames;

pub(crate) struct Station {
    socket: UdpSocket,
    /// Of the simulator.
    pub(crate) port: u16,
}

impl Station {
    /// With a port for the simulator that is free.
    pub(crate) fn new() -> Station {
        let free = UdpSocket::bind("127.0.0.1:0").unwrap();
        let port = free.local_addr().unwrap().port();
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_nonblocking(true).unwrap();
        Station { socket, port }
    }

    pub(crate) fn send_heartbeat(&self) {
        let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA {
            custom_mode: 0,
            mavtype: MavType::MAV_TYPE_OCTOROTOR,
            autopilot: MavAutopilot::MAV_AUTOPILOT_PX4,
            base_mode: MavModeFlag::empty(),
            system_status: MavState::MAV_STATE_ACTIVE,
            mavlink_version: 3,
        });
        let header = MavHeader {
            system_id: 3,
            component_id: 1,
            sequence: 0,
        };
        let mut raw = MAVLinkV2MessageRaw::new();
        raw.serialize_message(header, &message);
        self.socket
            .send_to(raw.raw_bytes(), ("127.0.0.1", self.port))
            .unwrap();
    }

    /// What has come: from which system and component.
    pub(crate) fn receive(&self) -> Vec<([u32; 2], MavMessage)> {
        let mut frames = Frames::default();
        let mut bytes = [0; 2048];
        while let Ok(count) = self.socket.recv(&mut bytes) {
            frames.push(&bytes[..count]);
        }
        let from = |header: MavHeader| [header.system_id, header.component_id.into()];
        frames.map(|(header, message)| (from(header), message)).collect()
    }
}
