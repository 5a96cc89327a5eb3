//! Speed and yaw along a lap: do they, or their slopes, jump? A formula's functions are analytic
//! where they are defined, but `atan2` has a branch, and `sqrt(x^2)` a kink.

use super::jumps::{Point, jump};
use super::lap::Lap;
use super::probe::{Profile, profile};
use super::refusal::{Reason, Refusal};
use controller::{Path, Real};
use std::f64::consts::TAU;

/// Looks for jumps along the lap.
///
/// # Errors
/// [`Refusal`] with the place of one.
pub fn continuous<P: Path<f64> + ?Sized>(path: &mut P, lap: &Lap) -> Result<(), Refusal> {
    path.search(&lap.nodes()[0].position());
    let points: Vec<Point<Profile>> = lap.nodes().iter().map(|node| (*node, profile(path, &node.motion))).collect();
    let most = |quantity: fn(&Profile) -> f64, least: f64| {
        points.iter().map(|(_, profile)| quantity(profile).abs()).fold(least, f64::max)
    };
    // All of the speed, or a radian, within a radian of a circle of this length; or more where
    // there is more.
    let natural = TAU / lap.length();
    let speed = most(|profile| profile.speed, f64::MIN_POSITIVE);
    let speed_slope = most(|profile| profile.speed_slope, speed * natural);
    let yaw_slope = most(|profile| profile.yaw_slope, natural);

    // Values first, since where they jump their slopes say nothing. A yaw may change by whole
    // turns, which the law takes for none.
    let errors = |(from, before): &Point<Profile>, (to, after): &Point<Profile>| {
        let way = to.arc - from.arc;
        [
            (after.speed - before.speed - before.speed_slope * way).abs() / speed,
            (after.yaw - before.yaw - before.yaw_slope * way).wrap_angle().abs(),
            (after.speed_slope - before.speed_slope).abs() / speed_slope,
            (after.yaw_slope - before.yaw_slope).abs() / yaw_slope,
        ]
    };
    let reasons = [
        Reason::SpeedJumps { order: 0 },
        Reason::YawJumps { order: 0 },
        Reason::SpeedJumps { order: 1 },
        Reason::YawJumps { order: 1 },
    ];
    match jump(path, &points, |path, node| profile(path, &node.motion), errors)? {
        Some((which, place)) => Err(reasons[which].at(place)),
        None => Ok(()),
    }
}
