//! PX4's ULog, read by PX4's own crate.

use std::collections::HashMap;

use px4_ulog::stream_parser::model::{FlattenedFieldType as Type, FlattenedFormat};
use px4_ulog::stream_parser::{DataMessage, LittleEndianParser, LogParser, ParameterMessage};

use crate::review::log::{Channel, Log};

/// The first bytes of a ULog.
pub(crate) const MAGIC: &[u8] = b"ULog\x01\x12\x35";

/// A field's value; `None` where the message ends before it.
fn value(kind: &Type, bytes: &[u8]) -> Option<f64> {
    fn of<T: LittleEndianParser>(bytes: &[u8]) -> Option<T> {
        (bytes.len() >= size_of::<T>()).then(|| T::parse(bytes))
    }
    Some(match kind {
        Type::Int8 => of::<i8>(bytes)?.into(),
        Type::UInt8 | Type::Char => of::<u8>(bytes)?.into(),
        Type::Int16 => of::<i16>(bytes)?.into(),
        Type::UInt16 => of::<u16>(bytes)?.into(),
        Type::Int32 => of::<i32>(bytes)?.into(),
        Type::UInt32 => of::<u32>(bytes)?.into(),
        Type::Int64 => of::<i64>(bytes)? as f64,
        Type::UInt64 => of::<u64>(bytes)? as f64,
        Type::Float => of::<f32>(bytes)?.into(),
        Type::Double => of::<f64>(bytes)?,
        Type::Bool => f64::from(u8::from(of::<bool>(bytes)?)),
    })
}

/// Where a format has the fields.
type Places = HashMap<String, (usize, Type)>;

fn places(format: &FlattenedFormat) -> Places {
    let place = |field: &px4_ulog::stream_parser::model::FlattenedField| {
        let at = (usize::from(field.offset), field.field_type.clone());
        (field.flattened_field_name.clone(), at)
    };
    format.field_iter().map(place).collect()
}

/// Bytes of the header, and of a message before its payload: length and kind.
const HEADER: usize = 16;
const HEAD: usize = 3;

/// More formats than any vehicle logs; the decoder's stack grows with those that stand in one another.
const MOST_FORMATS: usize = 500;

/// Where data are appended to a log (a crash dump), by the flags of its first message: what is before may end within a
/// message.
fn appended(bytes: &[u8]) -> Option<usize> {
    let first = bytes
        .get(HEADER..HEADER + HEAD + 24)
        .filter(|first| first[2] == b'B' && first[HEAD + 8] & 1 == 1)?;
    let offset = u64::from_le_bytes(first[HEAD + 16..].try_into().ok()?);
    usize::try_from(offset)
        .ok()
        .filter(|offset| (HEADER..bytes.len()).contains(offset))
}

/// How many of the bytes the decoder can be given, and what is wrong with the message behind them. It
/// indexes subscriptions and parameters by lengths that it does not check, and loops over arrays without
/// a size.
fn sound(bytes: &[u8]) -> (usize, Option<&'static str>) {
    let (mut at, mut formats) = (HEADER, 0);
    while let Some(&[low, high, kind]) = bytes.get(at..at + HEAD) {
        let end = at + HEAD + usize::from(u16::from_le_bytes([low, high]));
        let Some(payload) = bytes.get(at + HEAD..end) else {
            break;
        };
        let wrong = match kind {
            b'A' if payload.len() < 4 => "a subscription without a name",
            b'P' if payload
                .first()
                .is_none_or(|key| payload.len() < 1 + usize::from(*key)) =>
            {
                "a parameter shorter than its name"
            }
            b'F' if payload.ends_with(b":") || payload.windows(2).any(|two| two == b"[0" || two == b"[-") => {
                "a format without a size"
            }
            b'F' if formats == MOST_FORMATS => "more formats than any vehicle has",
            _ => {
                formats += usize::from(kind == b'F');
                at = end;
                continue;
            }
        };
        return (at, Some(wrong));
    }
    (bytes.len(), None)
}

/// The wanted channels of a ULog. A log that breaks off keeps what is before.
pub(crate) fn read(bytes: &[u8], wanted: &[Channel]) -> Log {
    let mut log = Log::default();
    let mut parameters = Vec::new();
    let mut formats: HashMap<u16, Places> = HashMap::new();
    let mut on_data = |message: &DataMessage<'_>| {
        let name = message.flattened_format.message_name();
        let mut channels = wanted.iter().filter(|(topic, _)| *topic == name).peekable();
        if channels.peek().is_none() {
            return;
        }
        let places = formats
            .entry(message.msg_id)
            .or_insert_with(|| places(message.flattened_format));
        let value = |field: &str| {
            let (at, kind) = places.get(field)?;
            value(kind, message.data.get(*at..)?)
        };
        if let Some(time_us) = value("timestamp") {
            channels.for_each(|channel| log.push(*channel, message.multi_id.value(), 1e-6 * time_us, value));
        }
    };
    let mut on_parameter = |message: &ParameterMessage<'_>| match message {
        ParameterMessage::Float(name, value, _) => parameters.push(((*name).to_owned(), f64::from(*value))),
        ParameterMessage::Int32(name, value, _) => parameters.push(((*name).to_owned(), f64::from(*value))),
    };
    let mut parser = LogParser::default();
    parser.set_data_message_callback(&mut on_data);
    parser.set_parameter_message_callback(&mut on_parameter);
    let appended = appended(bytes);
    let bytes = &bytes[..appended.unwrap_or(bytes.len())];
    let (end, wrong) = sound(bytes);
    let read = parser.consume_bytes(&bytes[..end]);
    let is_cut = parser.has_leftover();
    drop(parser);
    log.parameters = parameters.into_iter().collect();
    let damaged = |what: String| Some(format!("the log is damaged: {what}; what stands before is used"));
    log.damage = match (read, wrong) {
        (Err(error), _) => damaged(error.to_string()),
        (Ok(()), Some(wrong)) => damaged(format!("{wrong} at byte {end}")),
        (Ok(()), None) if appended.is_some() => {
            Some("data that are appended to the log (a crash dump) are left out".to_owned())
        }
        (Ok(()), None) if is_cut => Some("the log ends within a message: its end is missing".to_owned()),
        (Ok(()), None) => None,
    };
    log
}
