//! Speed and yaw along a lap: do they, or their slopes, jump? A formula's functions are analytic where they are defined, but
//! `atan2` has a branch, and `sqrt(x^2)` a kink.

use super::lap::{Lap, Node};
use super::probe::{Frame, profile};
use super::refusal::{Reason, Refusal};
use super::walk::node;
use controller::{Path, Real};
use std::f64::consts::TAU;

/// A change between points a millionth of a step apart of this part of the quantity's size over the lap is a jump.
const JUMP: f64 = 0.01;
/// How far the stretch between two nodes is halved.
const SMALLEST: f64 = 1e-6;

/// v_d and ψ_d at a point, and their derivatives by arc length.
type Profile = [[f64; 2]; 2];

/// Looks between the nodes for jumps, halving towards the larger change: of what is continuous it falls, of a jump it stays.
///
/// # Errors
/// [`Refusal`] with the place of one.
pub fn continuous<P: Path<f64> + ?Sized>(path: &mut P, lap: &Lap) -> Result<(), Refusal> {
    let nodes = lap.nodes();
    path.engage(&nodes[0].position());
    let profiles: Vec<Profile> = nodes.iter().map(|node| profile(path, &node.motion)).collect();
    // A turn of a radian, or all of the speed, within a radian of a circle of this length: or more where there is more.
    let natural = TAU / lap.length();
    let most = |what: usize, order: usize, least: f64| {
        profiles.iter().map(|profile| profile[what][order].abs()).fold(least, f64::max)
    };
    let speed = most(0, 0, f64::MIN_POSITIVE);
    let scales = [[speed, most(0, 1, speed * natural)], [1.0, most(1, 1, natural)]];

    for ([from, to], [first, second]) in nodes.array_windows().zip(profiles.array_windows()) {
        let (mut from, mut to, mut first, mut second) = (*from, *to, *first, *second);
        let least = SMALLEST * (to.arc - from.arc);
        loop {
            let whole = changes(&scales, (&from, &first), (&to, &second));
            let Some((reason, _)) = whole.into_iter().find(|(_, size)| *size > JUMP) else { break };
            if to.arc - from.arc < least {
                return Err(reason.at(from.place()));
            }
            let half = 0.5 * (to.arc - from.arc);
            let ahead = from.position() + from.tangent() * half;
            let Some(frame) = Frame::on_curve(path, ahead, half) else { break };
            let middle = node(path, &frame, from.arc + half)?;
            let between = profile(path, &middle.motion);
            let before = largest(&changes(&scales, (&from, &first), (&middle, &between)));
            let after = largest(&changes(&scales, (&middle, &between), (&to, &second)));
            if before > after { (to, second) = (middle, between) } else { (from, first) = (middle, between) }
        }
    }
    Ok(())
}

/// What changes from one point to the next and its slope does not foretell, as parts of `scales`; values first, since where they jump
/// their slopes say nothing. A yaw may change by a turn, which the law takes for none.
fn changes(
    scales: &[[f64; 2]; 2],
    (from, first): (&Node, &Profile),
    (to, second): (&Node, &Profile),
) -> [(Reason, f64); 4] {
    let way = to.arc - from.arc;
    let value = |what: usize| second[what][0] - first[what][0] - first[what][1] * way;
    let slope = |what: usize| second[what][1] - first[what][1];
    [
        (Reason::SpeedJumps { order: 0 }, value(0).abs() / scales[0][0]),
        (Reason::YawJumps { order: 0 }, value(1).wrap_angle().abs() / scales[1][0]),
        (Reason::SpeedJumps { order: 1 }, slope(0).abs() / scales[0][1]),
        (Reason::YawJumps { order: 1 }, slope(1).abs() / scales[1][1]),
    ]
}

fn largest(changes: &[(Reason, f64)]) -> f64 {
    changes.iter().map(|(_, size)| *size).fold(0.0, f64::max)
}
