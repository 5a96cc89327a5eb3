//! The answer as text.

use super::demand::Line;
use super::{Excess, Fastest, Report};
use std::fmt;

impl fmt::Display for Excess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, value, limit, place } = self;
        let (value, limit, unit) = match *quantity {
            "thrust" => (*value, *limit, "N"),
            "rod angle" | "tilt" => (value.to_degrees(), limit.to_degrees(), "°"),
            "body rate" => (*value, *limit, "rad/s"),
            "torque" => (*value, *limit, "N·m"),
            _ => (*value, *limit, "of the payload's weight"),
        };
        write!(f, "{quantity} {value:.3} against a limit of {limit:.3} {unit}, at {place}")
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sharpest = self.lap.sharpest();
        writeln!(f, "curve: closed, smooth and regular")?;
        writeln!(f, "  length            {:.4} m", self.lap.length())?;
        writeln!(f, "  smallest radius   {:.4} m, at {}", 1.0 / sharpest.curvature(), sharpest.place())?;
        match &self.branches {
            Some(branches) => writeln!(
                f,
                "  closest branches  {:.4} m, between {} and {:.3} m",
                branches.distance, branches.here, branches.there.arc
            )?,
            None => writeln!(f, "  closest branches  none")?,
        }
        line(f, &Line { name: "|∇h1 × ∇h2|", range: &self.regularity, unit: ("", 1.0) })?;
        writeln!(f, "lap at the given speed: {:.3} s", self.lap_time)?;
        for quantity in self.demand.lines() {
            line(f, &quantity)?;
        }
        match &self.fastest {
            Some(Fastest { speed, then: Some(excess) }) => {
                writeln!(f, "highest constant speed within the limits: {speed:.3} m/s; beyond it {excess}")?;
            }
            Some(Fastest { speed, then: None }) => {
                writeln!(f, "highest constant speed within the limits: {speed:.3} m/s, where the search ends")?;
            }
            None => writeln!(f, "no constant speed keeps to the limits")?,
        }
        for excess in &self.excesses {
            writeln!(f, "exceeded: {excess}")?;
        }
        Ok(())
    }
}

fn line(f: &mut fmt::Formatter<'_>, Line { name, range, unit: (unit, per_si) }: &Line<'_>) -> fmt::Result {
    let (min, max) = (range.min * per_si, range.max * per_si);
    writeln!(f, "  {name:<17} {min:.4} to {max:.4} {unit} (most at {:.2} m along)", range.max_at.arc)
}
