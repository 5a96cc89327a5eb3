//! The fence of a mission: before a flight along the whole route, and in flight.

use controller::{FenceEdge, FenceRegion, Real, Route, Run, Table, Vector3};
use link::Home;

use super::item::{CIRCLE_INSIDE, CIRCLE_OUTSIDE, Item, Kind, POLYGON_INSIDE, POLYGON_OUTSIDE, Refusal};
use super::{ITEMS, lay};

/// What of the vehicle is where it may not be.
const WHAT: [&str; 3] = ["the load", "the UAV", "the cable"];

/// A region, with its corners' or its centre's place in the list of places.
#[derive(Clone, Copy, Debug)]
struct Area {
    is_inside: bool,
    first: u16,
    /// 0: a circle.
    corners: u16,
    radius: f32,
}

/// Regions in N.
#[derive(Clone, Debug)]
pub struct Fence {
    areas: heapless::Vec<Area, ITEMS>,
    places: heapless::Vec<[f32; 2], ITEMS>,
}

/// What is kept from a fence, m, and between which heights above home.
#[derive(Clone, Copy, Debug)]
pub struct Keeping {
    pub margin: f32,
    pub up: [f32; 2],
}

impl Fence {
    pub const fn new() -> Self {
        Self { areas: heapless::Vec::new(), places: heapless::Vec::new() }
    }

    /// Makes the regions of `items` about `home`.
    pub fn lay(&mut self, items: &[Item], home: Option<&Home>) -> Result<(), Refusal> {
        self.areas.clear();
        self.places.clear();
        let mut number = 0;
        while let Some(item) = items.get(number) {
            item.check(Kind::Fence, number)?;
            let is_inside = matches!(item.command, POLYGON_INSIDE | CIRCLE_INSIDE);
            let [first, ..] = item.params;
            let is_polygon = matches!(item.command, POLYGON_INSIDE | POLYGON_OUTSIDE);
            let corners = if is_polygon { first as usize } else { 1 };
            let radius = if matches!(item.command, CIRCLE_INSIDE | CIRCLE_OUTSIDE) { first } else { 0.0 };
            let of = items.get(number..number.saturating_add(corners)).unwrap_or_default();
            let is_whole = of.iter().all(|other| other.command == item.command) && of.len() == corners;
            if !is_whole || is_polygon && corners < 3 {
                return Err(Refusal::invalid(format_args!("fence item {number}: not {first} corners in a row")));
            }
            let area = Area {
                is_inside,
                first: self.places.len() as u16,
                corners: if is_polygon { corners as u16 } else { 0 },
                radius,
            };
            for (offset, corner) in of.iter().enumerate() {
                let corner = Item { z: 0.0, ..*corner };
                let [n1, n2, _] = lay::place(&corner, Kind::Fence, number.saturating_add(offset), home, [0.0; 3])?;
                let _ = self.places.push([n1, n2]);
            }
            let _ = self.areas.push(area);
            number = number.saturating_add(corners);
        }
        Ok(())
    }

    fn regions(&self, up: [f32; 2]) -> impl Iterator<Item = FenceRegion<'_, f32>> {
        self.areas.iter().filter_map(move |area| {
            let first = usize::from(area.first);
            let edge = if area.corners > 0 {
                FenceEdge::Polygon(self.places.get(first..first.saturating_add(usize::from(area.corners)))?)
            } else {
                FenceEdge::Circle(*self.places.get(first)?, area.radius)
            };
            // Heights bound what is to be stayed in: a keep-out is one at any height.
            let up = if area.is_inside { up } else { [f32::NEG_INFINITY, f32::INFINITY] };
            Some(FenceRegion { is_inside: area.is_inside, edge, up })
        })
    }

    /// Whether a straight way keeps the margin from all regions.
    pub fn keeps(&self, way: &[Vector3<f32>; 2], keeping: &Keeping) -> bool {
        self.regions(keeping.up).all(|region| region.breach(way, keeping.margin).is_none())
    }

    /// Where `route`, flown as it is laid by a load on a cable of `length` m, first does not keep
    /// the margin: its run and span, and what does not.
    pub fn breach<S: Table<f32>>(
        &self,
        route: &mut Route<f32, S>,
        length: f32,
        gravity: f32,
        keeping: &Keeping,
    ) -> Option<(usize, usize, &'static str)> {
        if self.areas.is_empty() {
            return None;
        }
        let runs = route.table().runs().len();
        for run in 0..runs {
            let flown = route.table().runs().get(run).map_or(0..0, Run::flown);
            let end = flown.end;
            let mut last: Option<[Vector3<f32>; 2]> = None;
            for span in flown {
                for part in 0..=PARTS {
                    if part == PARTS && span.saturating_add(1) < end {
                        continue;
                    }
                    route.go_to(run, span as f32 + part as f32 / PARTS as f32);
                    let now = bodies(route, length, gravity);
                    let [load, uav] = last.unwrap_or(now);
                    for (what, way) in WHAT.into_iter().zip([[load, now[0]], [uav, now[1]], now]) {
                        if !self.keeps(&way, keeping) {
                            return Some((run, span, what));
                        }
                    }
                    last = Some(now);
                }
            }
        }
        None
    }
}

/// Looks at the vehicle for each span.
const PARTS: usize = 2;

/// The load at the route's place, and the UAV above it, whose cable carries the load's
/// acceleration.
fn bodies<S: Table<f32>>(route: &Route<f32, S>, length: f32, gravity: f32) -> [Vector3<f32>; 2] {
    let (load, acceleration) = (route.point(), route.acceleration());
    let pull = acceleration - Vector3::new(0.0, 0.0, gravity);
    let size = Real::sqrt(pull.dot(&pull)).max(f32::MIN_POSITIVE);
    [load, load + pull * (length / size)]
}
