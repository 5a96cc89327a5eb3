//! A closed curve as walked once: its points by arc length, the nearest of them to any point, and
//! its distance from itself.

use super::probe::{Frame, Motion, length, unit_speed};
use super::refusal::{Place, Reason, Refusal};
use controller::{Path, Vector3};

/// Branches closer than this part of the smallest radius of curvature are one point up to the
/// walk's accuracy.
const SAME_POINT: f64 = 1e-6;
/// Nodes above which not each is compared with each other.
const MANY: usize = 4096;

/// A point of a lap.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Arc length from the lap's start, m.
    pub arc: f64,
    /// Taylor coefficients of the curve by arc length.
    pub motion: Motion,
    /// |∇h1 × ∇h2|.
    pub regularity: f64,
    /// Of a route, the leg.
    pub leg: Option<usize>,
}

impl Node {
    /// The point of `frame`, with the curve's derivatives there.
    ///
    /// # Errors
    /// [`Refusal`] if it has none.
    pub(super) fn at<P: Path<f64> + ?Sized>(path: &mut P, frame: &Frame, arc: f64) -> Result<Self, Refusal> {
        let place = Place::of_curve(frame.position, arc);
        let motion = unit_speed(path, frame).ok_or_else(|| Reason::NotSmooth.at(place))?;
        Ok(Self { arc, motion, regularity: frame.regularity(), leg: None })
    }

    /// The point, in N, m.
    #[must_use]
    pub fn position(&self) -> Vector3<f64> {
        self.motion[0]
    }
    /// ρ.
    #[must_use]
    pub fn tangent(&self) -> Vector3<f64> {
        self.motion[1]
    }
    /// 1/m.
    #[must_use]
    pub fn curvature(&self) -> f64 {
        2.0 * length(&self.motion[2])
    }
    /// Where it is.
    #[must_use]
    pub fn place(&self) -> Place {
        Place { position: self.position(), arc: self.arc, leg: self.leg }
    }
}

/// A curve walked once, round or from end to end. Never empty; the last node of a closed one is the
/// first again, one length on.
#[derive(Clone, Debug)]
pub struct Lap {
    nodes: Vec<Node>,
    is_closed: bool,
    blocks: Vec<Block>,
}

/// Segments in a block.
const BLOCK: usize = 32;

/// A ball that holds the chords of [`BLOCK`] segments in a row.
#[derive(Clone, Copy, Debug)]
struct Block {
    center: Vector3<f64>,
    radius: f64,
}

impl Block {
    fn of(nodes: &[Node]) -> Self {
        let center = nodes.iter().map(Node::position).sum::<Vector3<f64>>() / nodes.len() as f64;
        let radius = nodes.iter().map(|node| length(&(node.position() - center))).fold(0.0, f64::max);
        Self { center, radius }
    }
}

/// A curve's nearest point to a given one.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// d_C, m.
    pub distance: f64,
    /// The point and its arc length.
    pub place: Place,
    /// ρ there.
    pub tangent: Vector3<f64>,
}

/// Two branches of a curve at their closest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// m.
    pub distance: f64,
    /// One.
    pub here: Place,
    /// The other.
    pub there: Place,
}

impl Lap {
    pub(super) fn new(nodes: Vec<Node>, is_closed: bool) -> Self {
        let ends = (0..nodes.len() - 1).step_by(BLOCK);
        let blocks = ends.map(|from| Block::of(&nodes[from..(from + BLOCK + 1).min(nodes.len())])).collect();
        Self { nodes, is_closed, blocks }
    }

    /// Whether it ends where it began.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Its points in order, the last equal to the first.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// m.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.nodes.last().map_or(0.0, |node| node.arc)
    }

    /// The node with the largest curvature.
    #[must_use]
    pub fn sharpest(&self) -> &Node {
        self.nodes
            .iter()
            .fold(&self.nodes[0], |best, node| if node.curvature() > best.curvature() { node } else { best })
    }

    /// The point at an arc length, modulo that of a closed curve, within that of an open one.
    #[must_use]
    pub fn at(&self, arc: f64) -> Place {
        let arc = if self.is_closed { arc.rem_euclid(self.length()) } else { arc.clamp(0.0, self.length()) };
        let after = self.nodes.partition_point(|node| node.arc <= arc).clamp(1, self.nodes.len() - 1);
        let (from, to) = (&self.nodes[after - 1], &self.nodes[after]);
        let segment = Segment::between(from, to);
        Place { position: segment.point((arc - from.arc) / segment.length), arc, leg: from.leg }
    }

    /// The curve's nearest point, over the whole of it.
    #[must_use]
    pub fn nearest(&self, position: Vector3<f64>) -> Nearest {
        // Whose ball's far side is nearer than another's near side holds the nearest point.
        let reach = |block: &Block| (length(&(position - block.center)), block.radius);
        let far = self.blocks.iter().map(reach).map(|(away, radius)| away + radius).fold(f64::INFINITY, f64::min);
        let (mut best, mut least) = (0, f64::INFINITY);
        for (index, block) in self.blocks.iter().enumerate() {
            let (away, radius) = reach(block);
            if away - radius > far {
                continue;
            }
            let first = index * BLOCK;
            for (offset, [from, to]) in self.nodes[first..].array_windows().take(BLOCK).enumerate() {
                let distance = squared_distance(position, from.position(), to.position());
                if distance < least {
                    (best, least) = (first + offset, distance);
                }
            }
        }
        // A segment leaves its chord by little: one beside the nearest chord may be nearer.
        let last = self.nodes.len() - 2;
        let before = if best > 0 { Some(best - 1) } else { self.is_closed.then_some(last) };
        let after = if best < last { Some(best + 1) } else { self.is_closed.then_some(0) };
        let mut nearest = self.segment(best).nearest(position);
        for index in before.into_iter().chain(after) {
            let beside = self.segment(index).nearest(position);
            if beside.distance < nearest.distance {
                nearest = beside;
            }
        }
        nearest
    }

    fn segment(&self, index: usize) -> Segment {
        Segment::between(&self.nodes[index], &self.nodes[index + 1])
    }

    /// The two branches that come closest: points whose join is normal to the curve at both, which
    /// neighbours on a bend are not. `None` for a curve without such a pair.
    #[must_use]
    pub fn closest_branches(&self) -> Option<Approach> {
        let mut closest: Option<Approach> = None;
        // Of very many nodes every few: between two of them the curve turns by a third of a radian
        // at most, and no branch is missed.
        let stride = (self.nodes.len() / MANY).clamp(1, 16);
        let mut before = self.branch_feet(0, stride);
        let ends = (0..self.nodes.len() - 1).step_by(stride);
        for (i, next) in ends.clone().zip(ends.skip(1).chain([self.nodes.len() - 1])) {
            let after = self.branch_feet(next, stride);
            let step = self.nodes[next].arc - self.nodes[i].arc;
            for from in &before {
                // The same branch from the next node, and the join passes through the normal
                // between the two.
                let to = after.iter().find(|to| self.apart(from.foot.place.arc, to.foot.place.arc) < 4.0 * step);
                if to.is_some_and(|to| from.along * to.along <= 0.0)
                    && closest.is_none_or(|closest| from.foot.distance < closest.distance + step)
                {
                    let found = self.squarely_between(i, next, from);
                    if closest.is_none_or(|closest| found.distance < closest.distance) {
                        closest = Some(found);
                    }
                }
            }
            before = after;
        }
        closest
    }

    /// The feet on other branches from a node, looked for in steps of `stride` nodes.
    fn branch_feet(&self, i: usize, stride: usize) -> Vec<BranchFoot> {
        let count = self.nodes.len() - 1;
        let squared = |offset: usize| self.squared(i, i + offset);
        (2 * stride..count - stride)
            .step_by(stride)
            .filter(|&offset| {
                squared(offset) <= squared(offset - stride) && squared(offset) < squared(offset + stride)
            })
            .map(|offset| self.foot_from(i, (i + offset) % count))
            .collect()
    }

    /// The foot from the node `i` on the branch that passes near the node `from`.
    fn foot_from(&self, i: usize, from: usize) -> BranchFoot {
        let (count, here) = (self.nodes.len() - 1, &self.nodes[i]);
        let mut node = from;
        while let Some(nearer) =
            [node + count - 1, node + 1].into_iter().find(|&other| self.squared(i, other) < self.squared(i, node))
        {
            node = nearer % count;
        }
        let foot = self.nearest_on(node, here.position());
        BranchFoot { node, along: (foot.place.position - here.position()).dot(&here.tangent()), foot }
    }

    /// Squared distance of two nodes, counted on round the lap, m².
    fn squared(&self, one: usize, other: usize) -> f64 {
        let count = self.nodes.len() - 1;
        let join = self.nodes[other % count].position() - self.nodes[one % count].position();
        join.dot(&join)
    }

    /// [`squarely`](Self::squarely), of the two neighbouring nodes from `i` to `end` between which
    /// it lies.
    fn squarely_between(&self, i: usize, end: usize, from: &BranchFoot) -> Approach {
        let (mut at, mut before) = (i, *from);
        for next in i + 1..end {
            let after = self.foot_from(next, before.node);
            if before.along * after.along <= 0.0 {
                break;
            }
            (at, before) = (next, after);
        }
        self.squarely(at, &before)
    }

    /// The join between the nodes `i` and `i` + 1 and the branch of `from` that is normal to both,
    /// by halving.
    fn squarely(&self, i: usize, from: &BranchFoot) -> Approach {
        let segment = Segment::between(&self.nodes[i], &self.nodes[i + 1]);
        let (mut low, mut high) = (0.0, 1.0);
        let (mut here, mut there) = (self.nodes[i].place(), from.foot);
        // Down to rounding.
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let (position, slope) = (segment.point(middle), segment.slope(middle));
            here = segment.place(middle);
            // The branch passes within a step of its node.
            there = self.nearest_on(from.node, position);
            let along = (there.place.position - position).dot(&slope);
            if along * from.along > 0.0 { low = middle } else { high = middle }
        }
        Approach { distance: there.distance, here, there: there.place }
    }

    /// Distance of two arc lengths along the closed curve.
    fn apart(&self, one: f64, other: f64) -> f64 {
        let way = (one - other).rem_euclid(self.length());
        way.min(self.length() - way)
    }

    /// [`closest_branches`](Self::closest_branches), refused if they meet.
    ///
    /// # Errors
    /// [`Refusal`] with the crossing's place.
    pub fn branches(&self) -> Result<Option<Approach>, Refusal> {
        let branches = self.closest_branches();
        match branches {
            Some(Approach { distance, here, there }) if distance < SAME_POINT / self.sharpest().curvature() => {
                Err(Reason::Crossing { other: there.arc }.at(here))
            }
            _ => Ok(branches),
        }
    }

    /// The nearest point within the segments on both sides of the node `index`, which is not the
    /// last, of a closed curve.
    fn nearest_on(&self, index: usize, position: Vector3<f64>) -> Nearest {
        let before = if index == 0 { self.nodes.len() - 2 } else { index - 1 };
        let (left, right) = (self.segment(before).nearest(position), self.segment(index).nearest(position));
        if left.distance < right.distance { left } else { right }
    }
}

/// Squared distance of `position` from the chord between two points, m².
fn squared_distance(position: Vector3<f64>, from: Vector3<f64>, to: Vector3<f64>) -> f64 {
    let (chord, way) = (to - from, position - from);
    let square = chord.dot(&chord);
    let along = if square > 0.0 { (way.dot(&chord) / square).clamp(0.0, 1.0) } else { 0.0 };
    let away = way - chord * along;
    away.dot(&away)
}

/// The foot on another branch of the curve, from a node.
#[derive(Clone, Copy)]
struct BranchFoot {
    /// The node next to the foot.
    node: usize,
    foot: Nearest,
    /// The join's part along the curve at the node it is from, m.
    along: f64,
}

/// The cubic with the positions and tangents of two neighbouring nodes, over a parameter from 0
/// to 1.
struct Segment {
    arc: f64,
    leg: Option<usize>,
    length: f64,
    coefficients: [Vector3<f64>; 4],
}

impl Segment {
    fn between(from: &Node, to: &Node) -> Self {
        let length = to.arc - from.arc;
        let (p, q) = (from.position(), to.position());
        let (u, v) = (from.tangent() * length, to.tangent() * length);
        let join = q - p;
        Self {
            arc: from.arc,
            leg: from.leg,
            length,
            coefficients: [p, u, join * 3.0 - u * 2.0 - v, u + v - join * 2.0],
        }
    }

    fn point(&self, t: f64) -> Vector3<f64> {
        let [c0, c1, c2, c3] = self.coefficients;
        c0 + (c1 + (c2 + c3 * t) * t) * t
    }

    fn place(&self, t: f64) -> Place {
        Place { position: self.point(t), arc: self.arc + t * self.length, leg: self.leg }
    }

    /// Derivative by the parameter.
    fn slope(&self, t: f64) -> Vector3<f64> {
        let [_, c1, c2, c3] = self.coefficients;
        c1 + (c2 * 2.0 + c3 * (3.0 * t)) * t
    }

    /// Newton's method for the foot of the perpendicular, kept within the segment.
    fn nearest(&self, position: Vector3<f64>) -> Nearest {
        let [_, _, c2, c3] = self.coefficients;
        let mut t = 0.5_f64;
        let at = |t: f64| (self.point(t), self.slope(t));
        // The segment bends by 0.02 rad at most: three steps reach rounding from its middle.
        for _ in 0..4 {
            let (point, slope) = at(t);
            let bend = c2 * 2.0 + c3 * (6.0 * t);
            let away = position - point;
            let change = slope.dot(&slope) - away.dot(&bend);
            // Beyond the centre of curvature there is no foot; an end is nearest.
            let step = if change > 0.0 { away.dot(&slope) / change } else { away.dot(&slope).signum() };
            t = (t + step).clamp(0.0, 1.0);
        }
        let (point, slope) = at(t);
        // A route stops between two nodes at the same place, which are no segment.
        let is_none = self.length == 0.0;
        Nearest {
            distance: if is_none { f64::INFINITY } else { length(&(position - point)) },
            place: self.place(t),
            tangent: slope / length(&slope),
        }
    }
}
