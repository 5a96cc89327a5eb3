//! The fence of a mission: before a flight along the whole route, and in flight.

use controller::{FenceEdge, FenceRegion, Real, Route, Run, Table, Vector3};
use link::Home;
use rig::parameter;

use super::ITEMS;
use super::item::{CIRCLE_INSIDE, CIRCLE_OUTSIDE, Item, Kind, POLYGON_INSIDE, POLYGON_OUTSIDE, Refusal};
use super::lay::{Mark, spot};
use crate::settings::{Setting, Settings};

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

/// Regions in N of at most `N` items.
#[derive(Clone, Debug)]
pub struct Fence<const N: usize = ITEMS> {
    areas: heapless::Vec<Area, N>,
    places: heapless::Vec<[f32; 2], N>,
}

/// What is kept from a fence, m, and between which heights above home.
#[derive(Clone, Copy, Debug)]
pub(super) struct Keeping {
    pub margin: f32,
    pub up: [f32; 2],
}

impl Keeping {
    /// As the settings have it, with a `share` of their margin.
    pub fn of(settings: &Settings, share: f32) -> Self {
        Self {
            margin: settings.get(Setting::FENCE_MARGIN) * share,
            up: [settings.get(Setting::FENCE_LOW), settings.get(Setting::FENCE_HIGH)],
        }
    }
}

impl<const N: usize> Default for Fence<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Fence<N> {
    /// Without regions.
    #[must_use]
    pub const fn new() -> Self {
        Self { areas: heapless::Vec::new(), places: heapless::Vec::new() }
    }

    /// Makes the regions of `items` about `home`.
    ///
    /// # Errors
    /// [`Refusal`] of the first item that no fence can have; with MAV_MISSION_ERROR where only the
    /// home is missing.
    pub fn lay(&mut self, items: &[Item], home: Option<&Home>) -> Result<(), Refusal> {
        self.areas.clear();
        self.places.clear();
        let mut number = 0;
        while let Some(item) = items.get(number) {
            let at = |refusal: Refusal| refusal.at(Kind::Fence, number);
            item.check(Kind::Fence).map_err(at)?;
            let is_inside = matches!(item.command, POLYGON_INSIDE | CIRCLE_INSIDE);
            let [first, ..] = item.params;
            let is_polygon = matches!(item.command, POLYGON_INSIDE | POLYGON_OUTSIDE);
            let corners = if is_polygon { first as usize } else { 1 };
            let radius = if matches!(item.command, CIRCLE_INSIDE | CIRCLE_OUTSIDE) { first } else { 0.0 };
            let of = items.get(number..number.saturating_add(corners)).unwrap_or_default();
            let is_whole = of.iter().all(|other| other.command == item.command) && of.len() == corners;
            if !is_whole || is_polygon && corners < 3 {
                return Err(at(Refusal::invalid(format_args!("not {first} corners in a row"))));
            }
            let area = Area {
                is_inside,
                first: self.places.len() as u16,
                corners: if is_polygon { corners as u16 } else { 0 },
                radius,
            };
            let full = |_| Refusal::no_space(format_args!("fence: more than {N} items"));
            for (corner, number) in of.iter().zip(number..) {
                let at = |refusal: Refusal| refusal.at(Kind::Fence, number);
                corner.check(Kind::Fence).map_err(at)?;
                self.places.push(spot(corner, 0.0, home, [0.0; 2]).map_err(at)?).map_err(full)?;
            }
            self.areas.push(area).map_err(|_| full([0.0; 2]))?;
            number = number.saturating_add(corners);
        }
        Ok(())
    }

    /// Its regions; those to be stayed in between two heights.
    fn between(&self, up: [f32; 2]) -> impl Iterator<Item = FenceRegion<'_, f32>> {
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

    /// Its regions, at the heights that the settings have.
    pub fn regions(&self, settings: &Settings) -> impl Iterator<Item = FenceRegion<'_, f32>> {
        self.between(Keeping::of(settings, 1.0).up)
    }

    /// Whether load, UAV and cable keep the settings' margin along a mission's whole `route`, which
    /// passes its items as the `marks` say.
    ///
    /// # Errors
    /// [`Refusal`] by the item that the first leg leads to which does not.
    pub fn allows<S: Table<f32>>(
        &self,
        route: &mut Route<f32, S>,
        marks: &[Mark],
        settings: &Settings,
    ) -> Result<(), Refusal> {
        let rig = settings.rig();
        let [length, gravity] = [parameter!("VEH_ROD"), parameter!("VEH_G")].map(|number| rig.get(number));
        let Some((run, span, what)) = self.breach(route, length, gravity, &Keeping::of(settings, 1.0)) else {
            return Ok(());
        };
        // The leg is named by the item that it leads to.
        let is_ahead = |mark: &&Mark| (mark.at.run, mark.at.span) > (run, span);
        let item = marks.iter().find(is_ahead).or(marks.last()).map_or(0, |mark| mark.item);
        Err(Refusal::invalid(format_args!("{what} too near the fence")).at(Kind::Mission, item.into()))
    }

    /// Whether a straight way keeps the margin from all regions.
    pub(super) fn keeps(&self, way: &[Vector3<f32>; 2], keeping: &Keeping) -> bool {
        self.between(keeping.up).all(|region| region.breach(way, keeping.margin).is_none())
    }

    /// Where `route`, flown as it is laid by a load on a cable of `length` m, first does not keep
    /// the margin: its run and span, and what does not.
    fn breach<S: Table<f32>>(
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
