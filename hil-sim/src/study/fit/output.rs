//! A fit as a report, as a path for scenario files, and as a constant for firmware.

use super::Fit;
use std::fmt::{self, Write};

impl fmt::Display for Fit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sharpest = self.lap.sharpest();
        let (worst, index) = self.worst;
        writeln!(
            f,
            "harmonics            {} (largest: number {} with {:.4} m; highest: {:.2e} m)",
            self.count, self.largest.0, self.largest.1, self.highest
        )?;
        writeln!(f, "waypoints to curve   {worst:.4} m at most (waypoint {}), {:.4} m rms", index + 1, self.rms)?;
        writeln!(f, "curve to polygon     {:.4} m at most", self.strays)?;
        writeln!(f, "length               {:.4} m", self.lap.length())?;
        writeln!(
            f,
            "largest curvature    {:.4} 1/m (radius {:.4} m), at {}",
            sharpest.curvature(),
            1.0 / sharpest.curvature(),
            sharpest.place()
        )?;
        match &self.branches {
            Some(found) => writeln!(
                f,
                "closest branches     {:.4} m, between {} and {:.3} m",
                found.distance, found.here, found.there.arc
            )?,
            None => writeln!(f, "closest branches     none")?,
        }
        let [x, y, z] = self.harmonics.reference;
        writeln!(
            f,
            "reference direction  ({x:.4}, {y:.4}, {z:.4}), {:.1} degrees from the nearest tangent",
            self.reference_angle.to_degrees()
        )
    }
}

/// The path as a table for a scenario file, flown at 1 m/s with yaw 0.
#[must_use]
pub fn toml(fit: &Fit, source: &str) -> String {
    let harmonics = &fit.harmonics;
    let row = |row: &[f64; 3]| {
        let [x, y, z] = row.map(to_nanometres);
        format!("[{x:?}, {y:?}, {z:?}]")
    };
    let rows = |rows: &[[f64; 3]]| rows.iter().map(|each| format!("\n    {},", row(each))).collect::<String>();
    format!(
        "# Fitted to {source}: {} harmonics, waypoints within {:.4} m, length {:.3} m, least radius {:.3} m.\n\
         [path]\nkind = \"fourier\"\nspeed = 1.0\nyaw = 0.0\ncenter = {}\ncos = [{}\n]\nsin = [{}\n]\nreference = {}\n",
        fit.count,
        fit.worst.0,
        fit.lap.length(),
        1.0 / fit.lap.sharpest().curvature(),
        row(&harmonics.center),
        rows(&harmonics.cos[..fit.count]),
        rows(&harmonics.sin[..fit.count]),
        row(&harmonics.reference),
    )
}

/// Rounded, so that zeros look like zeros; never −0.
fn to_nanometres(value: f64) -> f64 {
    (1e9 * value).round() / 1e9 + 0.0
}

/// The curve as a constant of the controller's type, in `f32`.
#[must_use]
pub fn rust(fit: &Fit, source: &str) -> String {
    let harmonics = &fit.harmonics;
    let row = |row: &[f64; 3]| {
        let [x, y, z] = row.map(|value| to_nanometres(value) as f32);
        format!("[{x:?}, {y:?}, {z:?}]")
    };
    let mut text = String::new();
    // Writing to a String does not fail.
    let _ = writeln!(
        text,
        "/// Fitted to {source}: waypoints within {:.4} m, length {:.3} m, least radius {:.3} m. In N, m.",
        fit.worst.0,
        fit.lap.length(),
        1.0 / fit.lap.sharpest().curvature()
    );
    let _ = writeln!(text, "const PATH: controller::Harmonics<f32, {}> = controller::Harmonics {{", fit.count);
    let _ = writeln!(text, "    center: {},", row(&harmonics.center));
    for (name, rows) in [("cos", &harmonics.cos), ("sin", &harmonics.sin)] {
        let _ = writeln!(text, "    {name}: [");
        for each in &rows[..fit.count] {
            let _ = writeln!(text, "        {},", row(each));
        }
        let _ = writeln!(text, "    ],");
    }
    let _ = writeln!(text, "    reference: {},", row(&harmonics.reference));
    text.push_str("};\n");
    text
}
