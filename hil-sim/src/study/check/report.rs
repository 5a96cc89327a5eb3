//! The answer as text.

use super::demand::Line;
use super::route::{Leg, Legs};
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
        match &self.legs {
            None => writeln!(f, "curve: closed, smooth and regular")?,
            Some(Legs { legs, .. }) if self.lap.is_closed() => writeln!(f, "route: closed, {} legs", legs.len())?,
            Some(Legs { legs, .. }) => writeln!(f, "route: {} legs", legs.len())?,
        }
        writeln!(f, "  length            {:.4} m", self.lap.length())?;
        let radius = 1.0 / sharpest.curvature();
        if radius < STRAIGHT {
            writeln!(f, "  smallest radius   {radius:.4} m, at {}", sharpest.place())?;
        } else {
            writeln!(f, "  smallest radius   none: straight")?;
        }
        match (&self.branches, &self.legs) {
            (Some(branches), _) => writeln!(
                f,
                "  closest branches  {:.4} m, between {} and {:.3} m",
                branches.distance, branches.here, branches.there.arc
            )?,
            (None, None) => writeln!(f, "  closest branches  none")?,
            (None, Some(_)) => {}
        }
        line(f, &Line { name: "|∇h1 × ∇h2|", range: &self.regularity, unit: ("", 1.0) })?;
        match &self.legs {
            None => writeln!(f, "lap at the given speed: {:.3} s", self.lap_time)?,
            Some(legs) => legs.times(f, self.lap_time)?,
        }
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
            None if self.legs.is_none() => writeln!(f, "no constant speed keeps to the limits")?,
            None => {}
        }
        if let Some(legs) = &self.legs {
            write!(f, "{legs}")?;
        }
        for excess in &self.excesses {
            writeln!(f, "exceeded: {excess}")?;
        }
        Ok(())
    }
}

impl Legs {
    fn times(&self, f: &mut fmt::Formatter<'_>, time: f64) -> fmt::Result {
        let Self { dwell, told, hovering, .. } = self;
        write!(f, "time of flight: {time:.1} s")?;
        match (*dwell > 0.0, told) {
            (false, 0) => {}
            (true, 0) => write!(f, ", {dwell:.1} s of it at stops")?,
            (_, told) => write!(f, ", {dwell:.1} s of it at stops, and as long as it takes to be told at {told}")?,
        }
        writeln!(f, "\nenergy: as much as hovering for {hovering:.1} s takes")
    }
}

/// A radius above this is rounding, m.
const STRAIGHT: f64 = 1e7;
/// Legs that are printed; of more, those with the least room.
const SHOWN: usize = 60;

impl fmt::Display for Legs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown: Vec<&Leg> = self.legs.iter().collect();
        if shown.len() > SHOWN {
            writeln!(f, "the {SHOWN} legs with the least room, of {}:", shown.len())?;
            shown.sort_by(|a, b| a.factor.total_cmp(&b.factor));
            shown.truncate(SHOWN);
            shown.sort_by_key(|leg| leg.from);
        }
        writeln!(f, "  leg from to   length, m  time, s  m/s at most  thrust, N      tilt, °  could be flown")?;
        for Leg { from, to, length, time, demand, factor } in shown {
            let room =
                if *factor < 4.0 { format!("{factor:.2} times as fast") } else { "4 times as fast".to_owned() };
            writeln!(
                f,
                "  {from:>8} {to:<4} {length:>9.2} {time:>8.1} {:>12.2}  {:>5.1} to {:<5.1} {:>6.1}  {room}",
                demand.speed.max,
                demand.thrust.min,
                demand.thrust.max,
                demand.tilt.max.to_degrees()
            )?;
        }
        Ok(())
    }
}

fn line(f: &mut fmt::Formatter<'_>, Line { name, range, unit: (unit, per_si) }: &Line<'_>) -> fmt::Result {
    let (min, max) = (range.min * per_si, range.max * per_si);
    writeln!(f, "  {name:<17} {min:.4} to {max:.4} {unit} (most at {:.2} m along)", range.max_at.arc)
}
