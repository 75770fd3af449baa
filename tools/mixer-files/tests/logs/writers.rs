//! Writers of both stacks' logs, as little as the readers need.

/// A flight: time, s, and values.
pub(crate) type Rows<'a> = &'a dyn Fn(f64) -> Vec<f32>;

/// A topic of PX4: its name, its fields as ULog declares them, its period, s, and its values.
pub(crate) struct Topic<'a> {
    pub(crate) name: &'a str,
    pub(crate) fields: &'a str,
    pub(crate) period_s: f64,
    pub(crate) rows: Rows<'a>,
}

fn message(kind: u8, payload: &[u8], bytes: &mut Vec<u8>) {
    bytes.extend((payload.len() as u16).to_le_bytes());
    bytes.push(kind);
    bytes.extend(payload);
}

/// A ULog of `seconds` with these parameters, whole numbers where they are.
pub(crate) fn ulog(parameters: &[(String, f64)], topics: &[Topic<'_>], seconds: f64) -> Vec<u8> {
    let mut bytes = b"ULog\x01\x12\x35\x01".to_vec();
    bytes.extend(0u64.to_le_bytes());
    for Topic { name, fields, .. } in topics {
        message(
            b'F',
            format!("{name}:uint64_t timestamp;{fields}").as_bytes(),
            &mut bytes,
        );
    }
    for (name, value) in parameters {
        let (kind, value) = match value.fract() == 0.0 {
            true => ("int32_t", (*value as i32).to_le_bytes()),
            false => ("float", (*value as f32).to_le_bytes()),
        };
        let key = format!("{kind} {name}");
        let payload = [&[key.len() as u8], key.as_bytes(), &value].concat();
        message(b'P', &payload, &mut bytes);
    }
    for (id, Topic { name, .. }) in topics.iter().enumerate() {
        let payload = [&[0], &(id as u16).to_le_bytes()[..], name.as_bytes()].concat();
        message(b'A', &payload, &mut bytes);
    }
    for (id, topic) in topics.iter().enumerate() {
        for k in 0..(seconds / topic.period_s) as usize {
            let time_s = k as f64 * topic.period_s;
            let mut payload = (id as u16).to_le_bytes().to_vec();
            payload.extend(((1e6 * time_s) as u64).to_le_bytes());
            payload.extend((topic.rows)(time_s).iter().flat_map(|value| value.to_le_bytes()));
            message(b'D', &payload, &mut bytes);
        }
    }
    bytes
}

/// A message of ArduPilot: its name, the names of its fields, of which each is a float, its period, s, and its values.
pub(crate) struct Message<'a> {
    pub(crate) name: &'a str,
    pub(crate) labels: &'a str,
    pub(crate) period_s: f64,
    pub(crate) rows: Rows<'a>,
}

fn padded(text: &str, length: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(length, 0);
    bytes
}

fn format_of(id: u8, length: usize, name: &str, format: &str, labels: &str, bytes: &mut Vec<u8>) {
    bytes.extend([0xa3, 0x95, 0x80, id, length as u8]);
    bytes.extend(padded(name, 4));
    bytes.extend(padded(format, 16));
    bytes.extend(padded(labels, 64));
}

/// A DataFlash log of `seconds` with these parameters.
pub(crate) fn dataflash(parameters: &[(String, f64)], messages: &[Message<'_>], seconds: f64) -> Vec<u8> {
    const PARM: u8 = 64;
    let mut bytes = Vec::new();
    format_of(
        0x80,
        89,
        "FMT",
        "BBnNZ",
        "Type,Length,Name,Format,Columns",
        &mut bytes,
    );
    format_of(
        PARM,
        3 + 8 + 16 + 4,
        "PARM",
        "QNf",
        "TimeUS,Name,Value",
        &mut bytes,
    );
    for (name, value) in parameters {
        bytes.extend([0xa3, 0x95, PARM]);
        bytes.extend(0u64.to_le_bytes());
        bytes.extend(padded(name, 16));
        bytes.extend((*value as f32).to_le_bytes());
    }
    for (id, message) in (PARM + 1..).zip(messages) {
        let width = message.labels.split(',').count();
        let format = format!("Q{}", "f".repeat(width));
        let labels = format!("TimeUS,{}", message.labels);
        format_of(id, 3 + 8 + 4 * width, message.name, &format, &labels, &mut bytes);
        for k in 0..(seconds / message.period_s) as usize {
            let time_s = k as f64 * message.period_s;
            bytes.extend([0xa3, 0x95, id]);
            bytes.extend(((1e6 * time_s) as u64).to_le_bytes());
            bytes.extend(
                (message.rows)(time_s)
                    .iter()
                    .flat_map(|value| value.to_le_bytes()),
            );
        }
    }
    bytes
}
