//! Messages of the pilot's link.

use mavlink::dialects::common::{
    AttitudeTargetTypemask, HEARTBEAT_DATA, MavAutopilot, MavFrame, MavMessage, MavModeFlag, MavState,
    MavType, PositionTargetTypemask, SET_ATTITUDE_TARGET_DATA, SET_POSITION_TARGET_LOCAL_NED_DATA,
    STATUSTEXT_DATA,
};

use nalgebra::UnitQuaternion;

use super::plan::Target;

/// A text that comes in pieces.
#[derive(Clone, Debug, Default)]
pub struct Texts {
    id: u16,
    begun: String,
}

impl Texts {
    /// The text with its last piece: those of one number, but for 0, belong together, and only the
    /// last is not full.
    pub fn join(&mut self, piece: &STATUSTEXT_DATA) -> Option<String> {
        let is_full = !piece.text.contains(&0);
        let text = piece.text.to_str().unwrap_or_default();
        if piece.id != self.id || piece.id == 0 {
            self.begun.clear();
        }
        self.id = piece.id;
        self.begun += text;
        if piece.id != 0 && is_full {
            return None;
        }
        Some(std::mem::take(&mut self.begun).trim().to_owned())
    }
}

/// Of a ground station.
pub fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype: MavType::MAV_TYPE_GCS,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    })
}

/// Asks for a position and a heading.
pub fn position(target: Target, height_m: f64, [system, component]: [u8; 2], time_s: f64) -> MavMessage {
    use PositionTargetTypemask as Mask;
    let wanted = Mask::POSITION_TARGET_TYPEMASK_X_IGNORE
        | Mask::POSITION_TARGET_TYPEMASK_Y_IGNORE
        | Mask::POSITION_TARGET_TYPEMASK_Z_IGNORE
        | Mask::POSITION_TARGET_TYPEMASK_YAW_IGNORE
        | Mask::POSITION_TARGET_TYPEMASK_FORCE_SET;
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        time_boot_ms: (time_s * 1e3) as u32,
        x: target.offset.x as f32,
        y: target.offset.y as f32,
        z: -(height_m + target.offset.z) as f32,
        yaw: target.yaw_deg.to_radians() as f32,
        type_mask: Mask::all().difference(wanted),
        target_system: system,
        target_component: component,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::DEFAULT
    })
}

/// Asks for roll and heading, at a thrust from 0 to 1.
pub fn attitude(target: Target, thrust: f32, [system, component]: [u8; 2], time_s: f64) -> MavMessage {
    use AttitudeTargetTypemask as Mask;
    let [roll, yaw] = [target.roll_deg, target.yaw_deg].map(f64::to_radians);
    let q = UnitQuaternion::from_euler_angles(roll, 0.0, yaw);
    MavMessage::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
        time_boot_ms: (time_s * 1e3) as u32,
        q: [q.w as f32, q.i as f32, q.j as f32, q.k as f32],
        thrust,
        type_mask: Mask::ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE
            | Mask::ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE
            | Mask::ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE,
        target_system: system,
        target_component: component,
        ..SET_ATTITUDE_TARGET_DATA::DEFAULT
    })
}

#[cfg(test)]
mod tests {
    use mavlink::dialects::common::MavSeverity;

    use super::*;

    #[test]
    fn texts_are_joined() {
        let piece = |id, chunk_seq, text: &str| STATUSTEXT_DATA {
            severity: MavSeverity::MAV_SEVERITY_INFO,
            text: text.into(),
            id,
            chunk_seq,
        };
        let mut texts = Texts::default();
        let long = "Arm: Motors: check frame class and type, channels and outputs";
        assert_eq!(texts.join(&piece(7, 0, &long[..50])), None);
        assert_eq!(texts.join(&piece(7, 1, &long[50..])).as_deref(), Some(long));
        // One that stays without its end gives way to the next.
        assert_eq!(texts.join(&piece(8, 0, &long[..50])), None);
        assert_eq!(texts.join(&piece(0, 0, "short ")).as_deref(), Some("short"));
        // A single piece may be full.
        assert_eq!(
            texts.join(&piece(0, 0, &long[..50])).as_deref(),
            Some(long[..50].trim())
        );
    }
}
