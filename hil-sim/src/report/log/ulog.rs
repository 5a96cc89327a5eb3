//! ULog, version 1: the published format of PX4's logs. Beside the table's own topics it has the
//! UAV's under PX4's names, which is what Flight Review plots.

use super::table::{Column, Table, Values};

/// The declaration of a field of PX4's, and the columns that make it.
type Field = (&'static str, &'static [&'static str]);

/// How a file begins, before its version.
pub const MAGIC: [u8; 7] = *b"ULog\x01\x12\x35";

/// PX4's topics and fields for columns of this table: both are NED, SI, and body axes
/// forward-right-down.
pub const PX4: [(&str, &[Field]); 4] = [
    (
        "vehicle_local_position",
        &[
            ("float x", &["uav_p1"]),
            ("float y", &["uav_p2"]),
            ("float z", &["uav_p3"]),
            ("float vx", &["uav_v1"]),
            ("float vy", &["uav_v2"]),
            ("float vz", &["uav_v3"]),
        ],
    ),
    ("vehicle_attitude", &[("float[4] q", &["att_w", "att_x", "att_y", "att_z"])]),
    ("vehicle_angular_velocity", &[("float[3] xyz", &["omega1", "omega2", "omega3"])]),
    ("vehicle_acceleration", &[("float[3] xyz", &["f1", "f2", "f3"])]),
];

/// PX4's topics that are read besides: the IMU at its full rate, and thrust as a share of the full
/// one, in three forms. Not written: shares need to know what is full.
pub const PX4_READ: [(&str, &[Field]); 4] = [
    (
        "sensor_combined",
        &[
            ("float[3] gyro_rad", &["raw_omega1", "raw_omega2", "raw_omega3"]),
            ("float[3] accelerometer_m_s2", &["raw_f1", "raw_f2", "raw_f3"]),
        ],
    ),
    ("vehicle_thrust_setpoint", &[("float[3] xyz", &["thrust_share1", "thrust_share2", "thrust_share3"])]),
    ("actuator_motors", &[("float[12] control", &MOTORS)]),
    ("actuator_outputs", &[("float[16] output", &OUTPUTS)]),
];

/// Shares of full thrust of up to eight motors; NaN where there is none.
pub const MOTORS: [&str; 8] = ["motor1", "motor2", "motor3", "motor4", "motor5", "motor6", "motor7", "motor8"];

/// Outputs of as many, µs of a pulse from 1000 to 2000; 0 where there is none.
pub const OUTPUTS: [&str; 8] =
    ["output1", "output2", "output3", "output4", "output5", "output6", "output7", "output8"];

/// The log as ULog.
pub fn encode(table: &Table) -> Vec<u8> {
    let mut file = Writer::new();
    file.message(b'B', &[&[0; 40]]);
    let mut topics: Vec<Topic<'_>> = table.topics().map(|(name, columns)| Topic::ours(name, columns)).collect();
    topics.extend(PX4.iter().filter_map(|(name, fields)| Topic::px4(table, name, fields)));
    for topic in &topics {
        file.message(b'F', &[topic.format.as_bytes()]);
    }
    file.message(b'F', &[b"vehicle_status:uint64_t timestamp;uint8_t nav_state;uint8_t arming_state;"]);
    file.information("sys_name", "hil-sim");
    file.information("ver_sw", env!("CARGO_PKG_VERSION"));
    file.information("flight", &table.name);
    file.information("title", &table.title);
    for column in &table.columns {
        let key = format!("{}.{}", column.topic, column.name);
        file.information(&format!("about:{key}"), column.about);
        match &column.values {
            Values::Numbers(_) => file.information(&format!("unit:{key}"), column.unit),
            // The words by their numbers from 0.
            Values::Words { list, .. } => file.information(&format!("words:{key}"), &list.join(";")),
        }
    }
    let status = topics.len() as u16;
    for (id, topic) in (0..).zip(&topics) {
        file.subscribe(id, topic.name);
    }
    file.subscribe(status, "vehicle_status");

    let words: Vec<&Column> =
        table.columns.iter().filter(|column| matches!(column.values, Values::Words { .. })).collect();
    let mut said = vec![None; words.len()];
    let mut state = None;
    for row in 0..table.t_s.len() {
        let time = table.microseconds(row).to_le_bytes();
        for (column, said) in words.iter().zip(&mut said) {
            let word = column.word(row);
            if word != *said {
                *said = word;
                let text = format!("{}: {}", column.name, word.filter(|word| !word.is_empty()).unwrap_or("none"));
                // A kernel's levels: 4 is a warning, 6 is for information.
                let level =
                    if column.name == "fault" && word.is_some_and(|word| !word.is_empty()) { b'4' } else { b'6' };
                file.message(b'L', &[&[level], &time, text.as_bytes()]);
            }
        }
        let mode = words.iter().find(|column| column.name == "mode").and_then(|column| column.word(row));
        let now = nav_state(mode);
        if state != Some(now) {
            state = Some(now);
            file.message(b'D', &[&status.to_le_bytes(), &time, &[now, ARMED]]);
        }
        for (id, topic) in (0_u16..).zip(&topics) {
            if topic.columns.iter().any(|column| column.has(row)) {
                let mut fields = Vec::with_capacity(4 * topic.columns.len());
                for column in &topic.columns {
                    match &column.values {
                        Values::Numbers(numbers) => fields.extend(numbers[row].to_le_bytes()),
                        Values::Words { index, .. } => fields.push(index[row]),
                    }
                }
                file.message(b'D', &[&id.to_le_bytes(), &time, &fields]);
            }
        }
    }
    file.0
}

/// PX4's `ARMING_STATE_ARMED`.
const ARMED: u8 = 2;

/// PX4's `nav_state` that is nearest to a mode; without one a law flies, as in offboard.
fn nav_state(mode: Option<&str>) -> u8 {
    match mode {
        // Manual: nothing flies by itself.
        Some("off" | "idle") => 0,
        Some("hold") => 4,
        // Mission: on the way.
        Some("engage" | "join") => 3,
        Some("land") => 18,
        // Descend.
        Some("fault") => 12,
        _ => 14,
    }
}

/// A topic on its way into the file.
struct Topic<'a> {
    name: &'a str,
    format: String,
    columns: Vec<&'a Column>,
}

impl<'a> Topic<'a> {
    fn ours(name: &'a str, columns: &'a [Column]) -> Self {
        let fields = columns.iter().map(|column| match column.values {
            Values::Numbers(_) => format!("float {};", column.name),
            Values::Words { .. } => format!("uint8_t {};", column.name),
        });
        let format = format!("{name}:uint64_t timestamp;{}", fields.collect::<String>());
        Self { name, format, columns: columns.iter().collect() }
    }

    /// None where the table lacks a column.
    fn px4(table: &'a Table, name: &'a str, fields: &[Field]) -> Option<Self> {
        let names = fields.iter().flat_map(|(_, columns)| columns.iter());
        let columns = names.map(|name| table.columns.iter().find(|column| column.name == *name));
        let declared = fields.iter().map(|(field, _)| format!("{field};")).collect::<String>();
        let format = format!("{name}:uint64_t timestamp;{declared}");
        Some(Self { name, format, columns: columns.collect::<Option<_>>()? })
    }
}

/// Bytes of a file.
struct Writer(Vec<u8>);

impl Writer {
    /// The header: magic, version 1, and that the log begins at time 0.
    fn new() -> Self {
        let mut bytes = MAGIC.to_vec();
        bytes.push(1);
        bytes.extend(0_u64.to_le_bytes());
        Self(bytes)
    }

    /// A message: its length, type and parts. Texts are cut where they would be longer than a
    /// message can be.
    fn message(&mut self, kind: u8, parts: &[&[u8]]) {
        let body = parts.concat();
        let length = body.len().min(usize::from(u16::MAX));
        self.0.extend((length as u16).to_le_bytes());
        self.0.push(kind);
        self.0.extend(&body[..length]);
    }

    fn information(&mut self, key: &str, value: &str) {
        let key = format!("char[{}] {key}", value.len());
        self.message(b'I', &[&[key.len().min(255) as u8], key.as_bytes(), value.as_bytes()]);
    }

    /// Data with this number are of the topic.
    fn subscribe(&mut self, id: u16, topic: &str) {
        self.message(b'A', &[&[0], &id.to_le_bytes(), topic.as_bytes()]);
    }
}
