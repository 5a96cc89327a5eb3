//! CSV with a sidecar: a table that every program reads, and beside it, in the form of the W3C's
//! CSV on the Web, what its columns are.

use serde_json::{Value, json};

use super::table::{Table, Values};

/// Shortest digits from which the number is read back, without the ".0" of whole ones.
pub fn shortest(value: f32) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// The table: empty where there is no value.
pub fn encode(table: &Table) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let names = std::iter::once("t_s").chain(table.columns.iter().map(|column| column.name));
    writer.write_record(names).expect("plain names into memory");
    for (row, t_s) in table.t_s.iter().enumerate() {
        let cells = table.columns.iter().map(|column| match &column.values {
            Values::Numbers(numbers) if numbers[row].is_nan() => String::new(),
            Values::Numbers(numbers) => shortest(numbers[row]),
            Values::Words { .. } => column.word(row).unwrap_or_default().to_owned(),
        });
        let line = std::iter::once(t_s.to_string()).chain(cells);
        writer.write_record(line).expect("lines as long as the heading, into memory");
    }
    writer.into_inner().expect("a vector can be flushed")
}

/// What the columns of NAME.csv are, for NAME.csv-metadata.json.
pub fn metadata(table: &Table) -> Vec<u8> {
    let time = json!({ "name": "t_s", "datatype": "number", "dc:description": "Time", "schema:unitText": "s" });
    let columns = table.columns.iter().map(|column| match &column.values {
        Values::Numbers(_) => json!({
            "name": column.name, "datatype": "number", "dc:description": column.about, "schema:unitText": column.unit
        }),
        Values::Words { .. } => {
            json!({ "name": column.name, "datatype": "string", "dc:description": column.about })
        }
    });
    let columns: Vec<Value> = std::iter::once(time).chain(columns).collect();
    let whole = json!({
        "@context": "http://www.w3.org/ns/csvw",
        "url": format!("{}.csv", table.name),
        "dc:title": table.title,
        "tableSchema": { "columns": columns },
    });
    let mut text = serde_json::to_vec_pretty(&whole).expect("plain numbers and strings");
    text.push(b'\n');
    text
}
