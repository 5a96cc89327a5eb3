//! Where a flight stays, and what it keeps out of: load, UAV and the cable between them.

use controller::{FenceEdge, FenceRegion, Vector3};
use serde::Deserialize;

use super::probe::length;
use super::{Place, Report};
use crate::describe::input::{Invalid, all_within, join, within};

/// Regions with the distance that is kept from their edges.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Fence {
    /// m.
    #[serde(default = "one_metre")]
    pub margin_m: f64,
    /// To stay in, each of them.
    #[serde(default)]
    pub inside: Vec<Region>,
    /// To keep out of.
    #[serde(default)]
    pub outside: Vec<Region>,
}

/// From one look at the cable to the next, m: what it passes between them is 0.3 mm nearer, at 1 m.
const STEP: f64 = 0.05;

/// For what the law leaves of gusts, and somewhat more.
fn one_metre() -> f64 {
    1.0
}

/// A polygon or a cylinder, from one height to another.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Corners, n1 and n2, m, in either order.
    polygon: Option<Vec<[f64; 2]>>,
    /// Of a cylinder, n1 and n2, m.
    center: Option<[f64; 2]>,
    /// Of a cylinder, m.
    radius: Option<f64>,
    /// From and to, above the origin of N, m; all heights if left out.
    up_m: Option<[f64; 2]>,
}

/// A place where the fence is not kept.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{what} {}: {distance:.2} m from it where {margin:.2} m are to be kept, at {place}", if *.is_inside { "leaves the fence" } else { "enters a keep-out" })]
pub struct Breach {
    /// The load, the UAV or the cable.
    pub what: &'static str,
    /// Of a region to stay in.
    pub is_inside: bool,
    /// Which, counted from 0.
    pub region: usize,
    /// How far inside, or outside, of it, m; negative beyond its edge.
    pub distance: f64,
    /// What was to be kept, m.
    pub margin: f64,
    /// Where the load is then.
    pub place: Place,
}

impl Fence {
    /// Checks the numbers; `at` is the field's name.
    ///
    /// # Errors
    /// [`Invalid`] names the field that is out of range.
    pub fn check(&self, at: &str) -> Result<(), Invalid> {
        within(&join(at, "margin_m"), self.margin_m, 0.0..=1e3)?;
        for (name, regions) in [("inside", &self.inside), ("outside", &self.outside)] {
            for (index, region) in regions.iter().enumerate() {
                region.check(&join(at, &format!("{name}[{index}]")))?;
            }
        }
        Ok(())
    }

    /// The worst place of each leg and region where load, UAV or cable are nearer to its edge than
    /// the margin.
    #[must_use]
    pub fn breaches(&self, report: &Report) -> Vec<Breach> {
        let mut worst: Vec<Breach> = Vec::new();
        let nodes = report.lap.nodes();
        let pairs = nodes.iter().zip(&report.uavs);
        for (index, (node, uav)) in pairs.enumerate() {
            let (next, next_uav) = nodes.get(index + 1).map_or((node, uav), |next| (next, &report.uavs[index + 1]));
            // The two bodies' ways are as good as straight between nodes; the cable goes sideways.
            let steps = (length(&(next.position() - node.position())) / STEP).ceil().max(1.0);
            let between =
                |from: &Vector3<f64>, to: &Vector3<f64>, step: u32| from + (to - from) * (f64::from(step) / steps);
            let cables = (0..steps as u32).map(|step| {
                ("the cable", [between(&node.position(), &next.position(), step), between(uav, next_uav, step)])
            });
            let bodies = [("the load", [node.position(), next.position()]), ("the UAV", [*uav, *next_uav])];
            let ways: Vec<_> = bodies.into_iter().chain(cables).collect();
            let regions = self.inside.iter().map(|region| (true, region)).enumerate();
            for (region, (is_inside, shape)) in
                regions.chain(self.outside.iter().map(|region| (false, region)).enumerate())
            {
                let shape = shape.as_flown(is_inside);
                for &(what, way) in &ways {
                    // On the edge is over it.
                    let Some(distance) = shape.breach(&way, self.margin_m) else { continue };
                    let breach =
                        Breach { what, is_inside, region, distance, margin: self.margin_m, place: node.place() };
                    let same = |other: &&mut Breach| {
                        (other.is_inside, other.region, other.place.leg) == (is_inside, region, node.leg)
                    };
                    match worst.iter_mut().find(same) {
                        Some(known) if known.distance <= distance => {}
                        Some(known) => *known = breach,
                        None => worst.push(breach),
                    }
                }
            }
        }
        worst
    }
}

impl Region {
    fn check(&self, at: &str) -> Result<(), Invalid> {
        match (&self.polygon, self.center, self.radius) {
            (Some(corners), None, None) => {
                within(&join(at, "polygon.len"), corners.len(), 3..=10_000)?;
                for (index, corner) in corners.iter().enumerate() {
                    all_within(&join(at, &format!("polygon[{index}]")), *corner, 1e5)?;
                }
            }
            (None, Some(center), Some(radius)) => {
                all_within(&join(at, "center"), center, 1e5)?;
                within(&join(at, "radius"), radius, 0.01..=1e5)?;
            }
            _ => return Err(Invalid::new(at, "give either polygon, or center and radius")),
        }
        if let Some([low, high]) = self.up_m {
            within(&join(at, "up_m[0]"), low, -1e5..=1e5)?;
            within(&join(at, "up_m[1]"), high, low..=1e5)?;
        }
        Ok(())
    }

    /// As the controller has it.
    fn as_flown(&self, is_inside: bool) -> FenceRegion<'_, f64> {
        let edge = match (&self.polygon, self.center, self.radius) {
            (Some(corners), ..) => FenceEdge::Polygon(corners),
            (None, Some(center), Some(radius)) => FenceEdge::Circle(center, radius),
            // Refused where it was read.
            _ => FenceEdge::Polygon(&[]),
        };
        FenceRegion { is_inside, edge, up: self.up_m.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]) }
    }
}
