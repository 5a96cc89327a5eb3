//! What the columns of a table of waypoints are, by its line of names.

use super::map::{Height, Spot};

use controller::Vector3;
use std::fmt;

/// One column: an axis of N, or one of the three that say where on the earth, its unit, and which
/// way it counts.
#[derive(Clone, Debug, PartialEq)]
struct Column {
    /// As the file has it.
    name: String,
    axis: usize,
    kind: Kind,
    /// m along n1, n2, n3 for 1 in the table; degrees of an angle.
    scale: f64,
}

/// What a column's numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A length from the origin of N.
    Length,
    /// Latitude or longitude.
    Angle,
    /// A height above the home.
    Relative,
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

/// Names of latitude and longitude, which stand for the axes that they lead along.
const ANGLES: [(&[&str], usize); 2] = [(&["lat", "latitude"], 0), (&["lon", "lng", "long", "longitude"], 1)];

/// Names of angles' units, degrees.
const ANGLE_UNITS: [(&[&str], f64); 2] =
    [(&["deg", "degree", "degrees"], 1.0), (&["rad", "radian", "radians"], 180.0 / std::f64::consts::PI)];

/// What is added to a height's name: of one above the sea, and of one above the home.
const AMSL: [&str; 3] = ["amsl", "msl", "asl"];
const RELATIVE: [&str; 3] = ["rel", "relative", "home"];

impl Columns {
    /// x, y, z of N in metres, as a table without names has them.
    pub(super) fn plain() -> Self {
        Self(["x", "y", "z"].map(String::from).map(|name| Column {
            axis: AXES.iter().find(|(names, ..)| names.contains(&name.as_str())).map_or(0, |(_, axis, _)| *axis),
            name,
            kind: Kind::Length,
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
        let angles = columns.iter().filter(|column| column.kind == Kind::Angle).count();
        if angles == 1 {
            return Err((None, "latitude and longitude go together".to_owned()));
        }
        Ok(Self(columns))
    }

    /// Puts the value of the column `index` into a point of N, m.
    pub(super) fn place(&self, point: &mut Vector3<f64>, index: usize, value: f64) {
        let Column { axis, scale, .. } = &self.0[index];
        // Not −0, which would be printed.
        point[*axis] = value * scale + 0.0;
    }

    /// The first column that is an angle: its number, from 1, and its name.
    #[must_use]
    pub fn angle(&self) -> Option<(usize, &str)> {
        let index = self.0.iter().position(|column| column.kind == Kind::Angle)?;
        Some((index + 1, self.0[index].name.as_str()))
    }

    /// Where a `point` that was placed is: in N, or on the earth, its third number then the height
    /// with its sign turned.
    pub(super) fn spot(&self, point: &Vector3<f64>) -> (Spot, Height) {
        let [first, second, down] = (*point).into();
        if self.angle().is_none() {
            return (Spot::Local([first, second]), Height::Relative(-down));
        }
        let is_relative = self.0.iter().any(|column| column.kind == Kind::Relative);
        let height = if is_relative { Height::Relative(-down) } else { Height::Amsl(-down) };
        (Spot::Earth([first, second]), height)
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
    if let Some((_, axis)) = ANGLES.iter().find(|(names, _)| words.iter().any(|word| names.contains(word))) {
        let is_name = |word: &&&str| !ANGLES[*axis].0.contains(*word);
        let mut scale = 1.0;
        for word in words.iter().filter(is_name) {
            let unit = ANGLE_UNITS.iter().find(|(names, _)| names.contains(word));
            scale = unit.ok_or_else(|| format!("\"{name}\": \"{word}\" is no unit of an angle: deg or rad"))?.1;
        }
        return Ok(Column { name: name.to_owned(), axis: *axis, kind: Kind::Angle, scale });
    }
    let (mut axis, mut unit, mut kind) = (None, None, Kind::Length);
    for word in &words {
        if AMSL.contains(word) || RELATIVE.contains(word) {
            if RELATIVE.contains(word) {
                kind = Kind::Relative;
            }
            continue;
        }
        let named = AXES.iter().find(|(names, ..)| names.contains(word));
        let length = UNITS.iter().find(|(names, _)| names.contains(word));
        match (named, length, axis) {
            (Some((_, number, sign)), _, None) => axis = Some((*number, *sign)),
            // As in "z_up" and "x north": which way the axis counts.
            (Some((_, number, sign)), _, Some((known, _))) if *number == known => axis = Some((known, *sign)),
            (_, Some((_, metres)), Some(_)) if unit.is_none() => unit = Some(*metres),
            _ if ANGLE_UNITS.iter().any(|(names, _)| names.contains(word)) => {
                return Err(format!("\"{name}\": {word} is the unit of an angle, and this is a length"));
            }
            _ => return Err(format!("\"{name}\": \"{word}\" is not known; {}", known())),
        }
    }
    let (axis, sign) = axis.ok_or_else(|| format!("\"{name}\" names no axis; {}", known()))?;
    Ok(Column { name: name.to_owned(), axis, kind, scale: sign * unit.unwrap_or(1.0) })
}

/// What names may say.
fn known() -> &'static str {
    "known are x, y, z (down), north, east, south, west, up, down, alt, each with m, mm, cm, km, ft or in, and lat, lon \
     with deg or rad"
}

impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, Column { name, axis, kind, scale }) in self.0.iter().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            let sign = if *scale < 0.0 { "-" } else { "" };
            match kind {
                Kind::Angle => write!(f, "{comma}{name} is an angle along n{}", axis + 1)?,
                Kind::Length | Kind::Relative => write!(f, "{comma}{name} is {sign}n{}", axis + 1)?,
            }
            if *kind == Kind::Angle {
                write!(f, " in degrees")?;
            } else if scale.abs() != 1.0 {
                write!(f, " in {} m", scale.abs())?;
            }
        }
        Ok(())
    }
}
