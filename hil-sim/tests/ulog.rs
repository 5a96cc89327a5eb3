//! ULog as PX4 writes it, read by the columns' own names.

use hil_sim::report::log::{ReadError, read};

fn message(kind: u8, parts: &[&[u8]]) -> Vec<u8> {
    let body = parts.concat();
    [&(body.len() as u16).to_le_bytes()[..], &[kind], &body].concat()
}

fn datum(topic: u16, time: u64, fields: &[u8]) -> Vec<u8> {
    message(b'D', &[&topic.to_le_bytes(), &time.to_le_bytes(), fields])
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// Attitude at 100 Hz from a time that is not 0, and position at half of it, as PX4 declares them:
/// a second sample time, padding, other types and other topics between.
fn px4() -> Vec<u8> {
    let mut file = b"ULog\x01\x12\x35\x01".to_vec();
    file.extend(7_u64.to_le_bytes());
    for format in [
        "vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;uint8_t quat_reset_counter;uint8_t[7] _padding0;",
        "part:uint16_t[2] counts;bool is_there;",
        "vehicle_local_position:uint64_t timestamp;part[2] parts;float x;float y;float z;float[2] delta_xy;double ref_lat;float vx;",
    ] {
        file.extend(message(b'F', &[format.as_bytes()]));
    }
    for (instance, topic, name) in
        [(0, 3_u16, "vehicle_attitude"), (0, 5, "vehicle_local_position"), (1, 6, "vehicle_attitude")]
    {
        file.extend(message(b'A', &[&[instance], &topic.to_le_bytes(), name.as_bytes()]));
    }
    for k in 0..4_u8 {
        let time = 1_000_000 + 10_000 * u64::from(k);
        let attitude = |w: f32| [&[9; 8][..], &floats(&[w, 0.25, 0.5, 0.75]), &[1; 8]].concat();
        file.extend(datum(3, time, &attitude(f32::from(k))));
        file.extend(datum(6, time, &attitude(99.0)));
        file.extend(message(b'L', &[b"6", &time.to_le_bytes(), b"a word"]));
        if k % 2 == 0 {
            let position = floats(&[10.0 + f32::from(k), 20.0, -30.0, 0.0, 0.0]);
            // The same instant, later in the file.
            file.extend(datum(5, time, &[&[0; 10][..], &position, &[0; 8], &floats(&[1.5])].concat()));
        }
    }
    file
}

#[test]
fn px4s_topics_are_read_by_the_columns_names() {
    let rows = read(&px4(), ["att_w", "att_z", "uav_p1", "uav_v1"]).unwrap();
    let expected: Vec<(f64, [f64; 4])> = [(0, 10.0), (1, 10.0), (2, 12.0), (3, 12.0)]
        .map(|(k, x)| (1e-6 * f64::from(1_000_000 + 10_000 * k), [f64::from(k), 0.75, x, 1.5]))
        .to_vec();
    assert_eq!(rows, expected);
    assert_eq!(read(&px4(), ["att_w", "thrust"]), Err(ReadError::Missing("thrust")));
}

/// What a loss of power or a bad card leaves is read as far as it goes or refused, and never more.
#[test]
fn a_torn_or_spoilt_log_is_read_as_far_as_it_goes() {
    let file = px4();
    let whole = read(&file, ["att_w", "uav_p1"]).unwrap();
    for end in 0..file.len() {
        if let Ok(rows) = read(&file[..end], ["att_w", "uav_p1"]) {
            // But for the last row, whose other topics may be what is torn off.
            let known = rows.len().saturating_sub(1);
            assert_eq!(rows[..known], whole[..known], "{end} bytes");
        }
        for byte in [0, 1, b'[', b']', 0xff] {
            let mut spoilt = file.clone();
            spoilt[end] = byte;
            let _ = read(&spoilt, ["att_w", "uav_p1"]);
        }
    }
    let endless = String::from_utf8_lossy(&file).contains("part[2]").then(|| {
        let mut file = file.clone();
        let at = file.windows(4).position(|bytes| bytes == b"bool").unwrap();
        file[at..at + 4].copy_from_slice(b"part");
        read(&file, ["att_w", "uav_p1"])
    });
    let error = endless.unwrap().unwrap_err().to_string();
    assert!(error.contains("part is not declared"), "{error}");
}
