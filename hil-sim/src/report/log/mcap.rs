//! MCAP: a channel a topic, JSON with a JSON Schema that has units and meanings.

use mcap::records::MessageHeader;
use mcap::{Compression, McapResult, WriteOptions};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::io::Cursor;

use super::table::{Column, Table, Values};

/// The log as MCAP.
pub fn encode(table: &Table) -> McapResult<Vec<u8>> {
    let options = WriteOptions::new()
        .compression(Some(Compression::Lz4))
        .library(concat!("hil-sim ", env!("CARGO_PKG_VERSION")));
    let mut writer = options.create(Cursor::new(Vec::new()))?;
    let about = BTreeMap::from([("name".to_owned(), table.name.clone()), ("title".to_owned(), table.title.clone())]);
    writer.write_metadata(&mcap::records::Metadata { name: "flight".to_owned(), metadata: about })?;
    let mut channels = Vec::new();
    for (topic, columns) in table.topics() {
        let schema = writer.add_schema(&format!("hil-sim.{topic}"), "jsonschema", &schema(topic, columns))?;
        channels.push((writer.add_channel(schema, &format!("/{topic}"), "json", &BTreeMap::new())?, columns));
    }
    for row in 0..table.t_s.len() {
        let time = 1000 * table.microseconds(row);
        for &(channel_id, columns) in &channels {
            if columns.iter().any(|column| column.has(row)) {
                let header = MessageHeader { channel_id, sequence: row as u32, log_time: time, publish_time: time };
                writer.write_to_known_channel(&header, &message(columns, row))?;
            }
        }
    }
    writer.finish()?;
    Ok(writer.into_inner().into_inner())
}

fn schema(topic: &str, columns: &[Column]) -> Vec<u8> {
    let property = |column: &Column| match column.values {
        Values::Numbers(_) => json!({ "type": "number", "description": column.about, "unit": column.unit }),
        Values::Words { .. } => json!({ "type": "string", "description": column.about }),
    };
    let properties: Map<String, Value> =
        columns.iter().map(|column| (column.name.to_owned(), property(column))).collect();
    json!({ "title": topic, "type": "object", "properties": properties }).to_string().into_bytes()
}

/// A row of a topic; JSON has no NaN and no infinity: such a value is left out.
fn message(columns: &[Column], row: usize) -> Vec<u8> {
    let mut text = String::from("{");
    for column in columns {
        let value = match &column.values {
            Values::Numbers(numbers) if numbers[row].is_finite() => super::csv::shortest(numbers[row]),
            Values::Numbers(_) => continue,
            Values::Words { .. } => match column.word(row) {
                Some(word) => Value::from(word).to_string(),
                None => continue,
            },
        };
        let comma = if text.len() > 1 { "," } else { "" };
        text += &format!("{comma}\"{}\":{value}", column.name);
    }
    text.push('}');
    text.into_bytes()
}
