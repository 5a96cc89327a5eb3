//! What the columns of a table of waypoints are, by its line of names.

use controller::Vector3;
use std::fmt;

/// One column: an axis of N, how many metres its unit is, and which way it counts.
#[derive(Clone, Debug, PartialEq)]
struct Column {
    /// As the file has it.
    name: String,
    axis: usize,
    /// m along n1, n2, n3 for 1 in the table.
    scale: f64,
}

/// The columns in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns([Column; 3]);

/// Names of the axes of N and of their opposites.
const AXES: [(&[&str], usize, f64); 6] = [
    (&["x", "n1", "p1", "north", "n", "northing"], 0, 1.0),
    (&["y", "n2", "p2", "east", "e", "easting"], 1, 1.0),
    (&["z", "n3", "p3", "down", "d", "depth"], 2, 1.0),
    (&["south", "s"], 0, -1.0),
    (&["west", "w"], 1, -1.0),
    (&["up", "u", "alt", "altitude", "height", "h"], 2, -1.0),
];

/// Names of lengths, m.
const UNITS: [(&[&str], f64); 6] = [
    (&["m", "metre", "metres", "meter", "meters"], 1.0),
    (&["mm"], 1e-3),
    (&["cm"], 1e-2),
    (&["km"], 1e3),
    (&["ft", "foot", "feet"], 0.3048),
    (&["in", "inch", "inches"], 0.0254),
];

/// Names of angles.
const ANGLES: [&str; 9] = ["lat", "latitude", "lon", "lng", "long", "longitude", "deg", "degree", "degrees"];

impl Columns {
    /// x, y, z of N in metres, as a table without names has them.
    pub(super) fn plain() -> Self {
        Self(["x", "y", "z"].map(String::from).map(|name| Column {
            axis: AXES.iter().find(|(names, ..)| names.contains(&name.as_str())).map_or(0, |(_, axis, _)| *axis),
            name,
            scale: 1.0,
        }))
    }

    /// The columns of a line of names.
    ///
    /// # Errors
    /// The number of the column (from 1) that is at fault, if it is one, and what is wrong.
    pub(super) fn read<'a>(names: impl Iterator<Item = &'a str>) -> Result<Self, (Option<usize>, String)> {
        let columns: Vec<Column> = names
            .enumerate()
            .map(|(index, name)| column(name).map_err(|message| (Some(index + 1), message)))
            .collect::<Result<_, _>>()?;
        let count = columns.len();
        let columns: [Column; 3] =
            columns.try_into().map_err(|_| (None, format!("{count} names where three coordinates are 3")))?;
        for axis in 0..3 {
            if !columns.iter().any(|column| column.axis == axis) {
                return Err((None, format!("no column is along n{}", axis + 1)));
            }
        }
        Ok(Self(columns))
    }

    /// Puts the value of the column `index` into a point of N, m.
    pub(super) fn place(&self, point: &mut Vector3<f64>, index: usize, value: f64) {
        let Column { axis, scale, .. } = &self.0[index];
        // Not −0, which would be printed.
        point[*axis] = value * scale + 0.0;
    }

    /// Metres of 1 in the column `index`.
    pub(super) fn unit(&self, index: usize) -> f64 {
        self.0[index].scale.abs()
    }
}

/// A column by its name: words that say axis, direction and unit.
fn column(name: &str) -> Result<Column, String> {
    let lower = name.to_lowercase();
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    if let Some(angle) = words.iter().find(|word| ANGLES.contains(word)) {
        return Err(format!(
            "\"{name}\": {angle} is an angle; waypoints are lengths from the origin of the vehicle's own position"
        ));
    }
    let (mut axis, mut unit) = (None, None);
    for word in &words {
        let named = AXES.iter().find(|(names, ..)| names.contains(word));
        let length = UNITS.iter().find(|(names, _)| names.contains(word));
        match (named, length, axis) {
            (Some((_, number, sign)), _, None) => axis = Some((*number, *sign)),
            // As in "z_up" and "x north": which way the axis counts.
            (Some((_, number, sign)), _, Some((known, _))) if *number == known => axis = Some((known, *sign)),
            (_, Some((_, metres)), Some(_)) if unit.is_none() => unit = Some(*metres),
            _ => return Err(format!("\"{name}\": \"{word}\" is not known; {}", known())),
        }
    }
    let (axis, sign) = axis.ok_or_else(|| format!("\"{name}\" names no axis; {}", known()))?;
    Ok(Column { name: name.to_owned(), axis, scale: sign * unit.unwrap_or(1.0) })
}

/// What names may say.
fn known() -> &'static str {
    "known are x, y, z (down), north, east, south, west, up, down, alt, each with m, mm, cm, km, ft or in"
}

impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, Column { name, axis, scale }) in self.0.iter().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            let sign = if *scale < 0.0 { "-" } else { "" };
            write!(f, "{comma}{name} is {sign}n{}", axis + 1)?;
            if scale.abs() != 1.0 {
                write!(f, " in {} m", scale.abs())?;
            }
        }
        Ok(())
    }
}
