//! MAVLink frames out of a stream of bytes.

use mavlink::dialects::common::MavMessage;
use mavlink::{MAVLinkMessageRaw, MAVLinkV1MessageRaw, MAVLinkV2MessageRaw, MavHeader, Message};

const V1: u8 = 0xfe;
const V2: u8 = 0xfd;

/// Bytes of a frame of the second version around its payload, and of the first.
const AROUND_V2: usize = 12;
const AROUND_V1: usize = 8;
const SIGNATURE: usize = 13;

/// Flag of a signed frame.
const SIGNED: u8 = 1;

/// Bytes that have come, and how many pieces of them were no frame.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    bytes: Vec<u8>,
    /// Pieces that were skipped: no frame, or one with a wrong checksum.
    pub malformed: u64,
    skipping: bool,
}

impl Frames {
    /// Takes what has come.
    pub fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// Passes over bytes; those that follow each other count once.
    fn skip(&mut self, count: usize) {
        self.bytes.drain(..count);
        if self.malformed == 0 {
            eprintln!("what has come is no MAVLink: passed over");
        }
        self.malformed += u64::from(!self.skipping);
        self.skipping = true;
    }

    /// Whether the frame at the start is one that this cannot read, or none.
    fn has_unknown_flags(&self) -> Option<bool> {
        let flags = *self.bytes.get(2)?;
        Some(self.bytes[0] == V2 && flags & !SIGNED != 0)
    }

    /// Length of the frame at the start.
    fn length(&self) -> Option<usize> {
        let payload = usize::from(*self.bytes.get(1)?);
        if self.bytes[0] == V1 {
            return Some(payload + AROUND_V1);
        }
        let is_signed = self.bytes.get(2)? & SIGNED != 0;
        Some(payload + AROUND_V2 + if is_signed { SIGNATURE } else { 0 })
    }
}

/// The messages of the common dialect in what has come, `None` until more comes. Those of other
/// dialects are passed over.
impl Iterator for Frames {
    type Item = (MavHeader, MavMessage);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let marker = self.bytes.iter().position(|byte| matches!(*byte, V1 | V2));
            let start = marker.unwrap_or(self.bytes.len());
            if start > 0 {
                self.skip(start);
            }
            if self.has_unknown_flags()? {
                self.skip(1);
                continue;
            }
            let length = self.length()?;
            if self.bytes.len() < length {
                return None;
            }
            let Some(frame) = parse(&self.bytes[..length]) else {
                self.skip(1);
                continue;
            };
            self.bytes.drain(..length);
            self.skipping = false;
            if let Some(frame) = frame {
                return Some(frame);
            }
        }
    }
}

/// `None` of bytes that are no frame; otherwise its message, where the dialect has it.
fn parse(bytes: &[u8]) -> Option<Option<(MavHeader, MavMessage)>> {
    let (raw, is_whole) = if bytes[0] == V1 {
        let mut raw = MAVLinkV1MessageRaw::new();
        raw.as_mut_slice()[..bytes.len()].copy_from_slice(bytes);
        (MAVLinkMessageRaw::V1(raw), raw.has_valid_crc::<MavMessage>())
    } else {
        let mut raw = MAVLinkV2MessageRaw::new();
        raw.as_mut_slice()[..bytes.len()].copy_from_slice(bytes);
        (MAVLinkMessageRaw::V2(raw), raw.has_valid_crc::<MavMessage>())
    };
    let id = raw.message_id();
    if !is_whole && MavMessage::default_message_from_id(id).is_some() {
        return None;
    }
    let header = MavHeader {
        system_id: raw.system_id(),
        component_id: raw.component_id(),
        sequence: raw.sequence(),
    };
    // A value that the dialect does not have, say a command, makes a message unreadable.
    let message = is_whole.then(|| MavMessage::parse(raw.version(), id, raw.payload()).ok());
    Some(message.flatten().map(|message| (header, message)))
}

/// A frame of the second version, of a system and component, and its number, which goes on.
pub fn frame(sequence: &mut u8, [system_id, component_id]: [u8; 2], message: &MavMessage) -> Vec<u8> {
    let header = MavHeader {
        system_id: system_id.into(),
        component_id,
        sequence: *sequence,
    };
    *sequence = sequence.wrapping_add(1);
    let mut raw = MAVLinkV2MessageRaw::new();
    raw.serialize_message(header, message);
    raw.raw_bytes().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sitl::messages::heartbeat;

    #[test]
    fn frames_come_in_any_pieces_and_versions() {
        let header = MavHeader {
            system_id: 7,
            component_id: 1,
            sequence: 3,
        };
        let mut bytes = frame(&mut 3, [7, 1], &heartbeat());
        let mut old = MAVLinkV1MessageRaw::new();
        old.serialize_message(header, &heartbeat());
        bytes.extend(old.raw_bytes());
        let mut frames = Frames::default();
        let mut found = 0;
        for byte in bytes {
            frames.push(&[byte]);
            for (from, message) in frames.by_ref() {
                assert_eq!((from, message), (header, heartbeat()));
                found += 1;
            }
        }
        assert_eq!((found, frames.malformed), (2, 0));
    }

    #[test]
    fn messages_of_other_dialects_are_passed_over_and_junk_is_counted() {
        let mut frames = Frames::default();
        // Number 9999 is in no dialect that this reads: its checksum cannot be told.
        frames.push(&[0xfd, 1, 0, 0, 0, 1, 1, 0x0f, 0x27, 0, 42, 0, 0]);
        frames.push(&frame(&mut 0, [1, 1], &heartbeat()));
        assert_eq!(frames.by_ref().count(), 1);
        assert_eq!(frames.malformed, 0);
        let mut corrupt = frame(&mut 0, [1, 1], &heartbeat());
        corrupt[12] ^= 1;
        frames.push(&corrupt);
        frames.push(b"and more");
        frames.push(&frame(&mut 0, [1, 1], &heartbeat()));
        assert_eq!(frames.by_ref().count(), 1);
        assert_eq!(frames.malformed, 1);
    }
}
