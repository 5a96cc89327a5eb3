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
#[error("{what} {}: {distance:.2} m from it where {margin:.2} m are to be kept, {}",
    if *.is_inside { "leaves the fence" } else { "enters a keep-out" }, self.whereabouts())]
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
    /// It is on the way to the path.
    pub is_before: bool,
    /// Where the load is then; on the way to a route with the leg that is joined.
    pub place: Place,
}

impl Breach {
    fn whereabouts(&self) -> String {
        let Self { place: place @ Place { position: p, leg, .. }, .. } = self;
        if !self.is_before {
            return format!("at {place}");
        }
        let to = leg.map_or("the path".to_owned(), |leg| format!("leg {leg}"));
        format!("on the way to {to}, the load at ({:.3}, {:.3}, {:.3}) m", p.x, p.y, p.z)
    }
}

/// Load and UAV.
pub(super) type Ends = [Vector3<f64>; 2];

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
        let mut worst = Vec::new();
        let nodes = report.lap.nodes();
        for (index, (node, uav)) in nodes.iter().zip(&report.uavs).enumerate() {
            let (next, next_uav) = nodes.get(index + 1).map_or((node, uav), |next| (next, &report.uavs[index + 1]));
            self.look(&[[node.position(), *uav], [next.position(), *next_uav]], node.place(), false, &mut worst);
        }
        worst
    }

    /// Looks at the straight ways of load and UAV `from` one place `to` another, and at the cable
    /// between them on its way; keeps the worst of each region and of the leg of `place`.
    pub(super) fn look(&self, [from, to]: &[Ends; 2], place: Place, is_before: bool, worst: &mut Vec<Breach>) {
        // The cable goes sideways.
        let steps = (length(&(to[0] - from[0])) / STEP).ceil().max(1.0);
        let cable = |step: u32| [0, 1].map(|end| from[end] + (to[end] - from[end]) * (f64::from(step) / steps));
        let cables = (0..steps as u32).map(|step| ("the cable", cable(step)));
        let bodies = [("the load", [from[0], to[0]]), ("the UAV", [from[1], to[1]])];
        let ways: Vec<_> = bodies.into_iter().chain(cables).collect();
        let inside = self.inside.iter().map(|region| (true, region)).enumerate();
        for (region, (is_inside, shape)) in
            inside.chain(self.outside.iter().map(|region| (false, region)).enumerate())
        {
            let shape = shape.as_flown(is_inside);
            for &(what, way) in &ways {
                // On the edge is over it.
                let Some(distance) = shape.breach(&way, self.margin_m) else { continue };
                let breach = Breach { what, is_inside, region, distance, margin: self.margin_m, is_before, place };
                let same = |other: &&mut Breach| {
                    (other.is_inside, other.region, other.is_before, other.place.leg)
                        == (is_inside, region, is_before, place.leg)
                };
                match worst.iter_mut().find(same) {
                    Some(known) if known.distance <= distance => {}
                    Some(known) => *known = breach,
                    None => worst.push(breach),
                }
            }
        }
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
