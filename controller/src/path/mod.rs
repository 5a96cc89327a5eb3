//! Paths: curves in space with a speed and a yaw prescribed along them.
//!
//! A curve is the common zero of two functions, C = {h1(p) = 0, h2(p) = 0}, and runs along the unit
//! tangent ρ, which is (∇h1 × ∇h2)/|∇h1 × ∇h2| or its opposite: **a curve states its
//! direction**. The law sees a path only through its outputs (3.3), evaluated on the payload's
//! Taylor series, so every derivative that the law needs comes from ordinary series arithmetic.
//!
//! [`Profiled`] composes a [`Curve`] with a [`SpeedProfile`] and a [`YawProfile`] into a [`Path`].
//! A curve of one's own is a [`Formula`], two lines of ordinary arithmetic; so is a profile.

/// Repeats a block for each order, which is a constant in it: the compiler unrolls loops over
/// orders only while they are few, and a coefficient's loop has its bounds then.
macro_rules! for_each_order {
    ($order:ident in [$($number:literal)*] $block:block) => {
        $({
            const $order: usize = $number;
            $block
        })*
    };
}

mod bent;
mod circle;
mod curve;
mod draped;
mod ellipse;
mod field;
mod fourier;
mod harmonics;
mod implicit;
mod nearest;
pub(crate) mod route;
mod speed;
mod spline;
mod superellipse;
mod tilted;
mod yaw;

pub use bent::Bent;
pub use circle::Circle;
pub use curve::{Curve, Curved, Located};
pub use ellipse::Ellipse;
pub use field::{Linear, PointingAt, ScalarField};
pub use fourier::{FourierPath, NEWTON_STEPS};
pub use harmonics::Harmonics;
pub use implicit::{Formula, Implicit};
pub use route::build::{
    Built, Passage, RouteError, RoutePace, SHORTEST_LEG, Waypoint, build_route, build_route_passing,
};
pub use route::{End, Knot, Route, RouteTable, Run, Table};
pub use speed::{ConstantSpeed, CurvatureLimited, SpeedProfile};
pub use superellipse::Superellipse;
pub use tilted::Tilted;
pub use yaw::{AlongTangent, FixedYaw, YawProfile};

use model::{Real, Series};
use nalgebra::Vector3;

/// The payload's coordinates p1, p2, p3 as series of order 6 in time. The sixth coefficient is
/// zero: that order holds the input, which outputs see only through their gradients.
pub type PositionSeries<T> = [Series<T, 7>; 3];

/// The outputs (3.3) along the payload's series, with the input's contribution to the highest
/// orders left out.
#[derive(Clone, Copy, Debug)]
pub struct Outputs<T> {
    /// h1 and h2, orders 0 to 6. Their unit is the curve's choice (the paper's circle: m² and m).
    pub surfaces: [Series<T, 7>; 2],
    /// ∇h1 and ∇h2 now, in N.
    pub gradients: [Vector3<T>; 2],
    /// ρ now, in N.
    pub tangent: Vector3<T>,
    /// h3 = ρ·v − v_d, m/s, orders 0 to 5.
    pub speed_error: Series<T, 6>,
    /// v_d alone, m/s along ρ, orders 0 to 5.
    pub prescribed: Series<T, 6>,
    /// ψ_d, rad, orders 0 to 2. Any representative modulo 2π: the law wraps the difference.
    pub yaw: Series<T, 3>,
    /// What is left of the curve's reach, see [`Located::reach_margin`].
    pub reach_margin: T,
}

impl<T: Real> Outputs<T> {
    /// Of a path that has no point: all zeros.
    pub(crate) fn none() -> Self {
        let (zero, vector) = (T::zero(), Vector3::zeros());
        Self {
            surfaces: [Series::constant(zero); 2],
            gradients: [vector; 2],
            tangent: vector,
            speed_error: Series::constant(zero),
            prescribed: Series::constant(zero),
            yaw: Series::constant(zero),
            reach_margin: zero,
        }
    }

    /// The vector (5.6) whose products with ∇h1, ∇h2 and ρ are `products`, and the determinant (∇h1
    /// × ∇h2)·ρ of this system; infinite or NaN where that is zero.
    #[inline(always)]
    pub fn solve(&self, products: [T; 3]) -> (Vector3<T>, T) {
        let ([g1, g2], rho) = (&self.gradients, &self.tangent);
        let [r1, r2, r3] = products;
        // The inverse's columns are the rows' cross products.
        let c1 = g2.cross(rho);
        let determinant = g1.dot(&c1);
        let solution = (c1 * r1 + rho.cross(g1) * r2 + g1.cross(g2) * r3) * (T::one() / determinant);
        (solution, determinant)
    }
}

/// A curve with speed and yaw along it.
pub trait Path<T: Real> {
    /// Evaluates the outputs (3.3) along `position`, each number where it stays. Takes `&mut self`
    /// for paths that remember their nearest point.
    fn evaluate(&mut self, position: &PositionSeries<T>, outputs: &mut Outputs<T>);

    /// The outputs along `position`.
    fn outputs(&mut self, position: &PositionSeries<T>) -> Outputs<T> {
        let mut outputs = Outputs::none();
        self.evaluate(position, &mut outputs);
        outputs
    }

    /// Looks for the point of the whole curve that is nearest to the payload at `position` (N, m),
    /// as far as one control period has time for: called once a period when a controller starts,
    /// until it is `true`. A curve that knows no nearest point has nothing to do.
    fn search(&mut self, _position: &Vector3<T>) -> bool {
        true
    }

    /// How long the payload is to rest at the stop it is led to, s; infinite: until it is told to
    /// go on. `None`: there is no stop.
    fn dwell(&self) -> Option<T> {
        None
    }

    /// Goes on from that stop, where the payload is at rest. `false` if nothing comes after it.
    fn go_on(&mut self) -> bool {
        false
    }

    /// Turns v_d round, or back, at a moment when none is flown. `false` if the path has no speed
    /// of its own for the way back: then it does nothing, and minus v_d is flown.
    fn set_backward(&mut self, _is_backward: bool) -> bool {
        false
    }
}

impl<T: Real, P: Path<T> + ?Sized> Path<T> for &mut P {
    #[inline]
    fn evaluate(&mut self, position: &PositionSeries<T>, outputs: &mut Outputs<T>) {
        (**self).evaluate(position, outputs);
    }

    fn search(&mut self, position: &Vector3<T>) -> bool {
        (**self).search(position)
    }

    fn dwell(&self) -> Option<T> {
        (**self).dwell()
    }

    fn go_on(&mut self) -> bool {
        (**self).go_on()
    }

    fn set_backward(&mut self, is_backward: bool) -> bool {
        (**self).set_backward(is_backward)
    }
}

/// A curve with its speed and yaw profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profiled<C, S, Y> {
    /// The curve.
    pub curve: C,
    /// v_d along it.
    pub speed: S,
    /// ψ_d along it.
    pub yaw: Y,
}

impl<C, S, Y> Profiled<C, S, Y> {
    /// The same with another `yaw`.
    pub fn with_yaw<Z>(self, yaw: Z) -> Profiled<C, S, Z> {
        Profiled { curve: self.curve, speed: self.speed, yaw }
    }
}

impl<T, C, S, Y> Path<T> for Profiled<C, S, Y>
where
    T: Real,
    C: Curve<T>,
    S: SpeedProfile<T, C>,
    Y: YawProfile<T>,
{
    #[inline(never)]
    fn evaluate(&mut self, position: &PositionSeries<T>, outputs: &mut Outputs<T>) {
        let located = self.curve.locate(position);
        let prescribed = self.speed.speed(&self.curve, position, &located);
        // One by one: all of it would be copied by a call.
        outputs.surfaces = located.surfaces;
        outputs.gradients = located.gradients;
        outputs.tangent = located.tangent();
        outputs.speed_error = located.speed - prescribed;
        outputs.prescribed = prescribed;
        outputs.yaw = self.yaw.yaw(position, &located);
        outputs.reach_margin = located.reach_margin;
    }

    fn search(&mut self, position: &Vector3<T>) -> bool {
        self.curve.search(position)
    }
}
