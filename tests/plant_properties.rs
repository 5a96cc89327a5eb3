//! What holds for the plant whatever the state (balances of energy and momentum, symmetry) and for
//! the integrators (their orders).

use hil_sim::world::integrate::{self, Tolerance};
use proptest::prelude::*;
use std::cell::Cell;
use witness::jet::Dual;
use witness::plant::{self, Input, STATES, VehicleParameters};

type State = [f64; STATES];

/// States and inputs away from the chart's ends, rates up to 2 rad/s and speeds up to 5 m/s.
fn state() -> impl Strategy<Value = State> {
    let span = |half: f64| -half..half;
    (
        [span(10.0), span(10.0), span(10.0)],
        [span(1.0), span(1.0)],
        [span(1.0), span(1.0), span(3.0)],
        [span(5.0), span(5.0), span(5.0)],
        [span(2.0), span(2.0)],
        [span(2.0), span(2.0), span(2.0)],
    )
        .prop_map(|(p, rod, attitude, v, rod_rate, omega)| {
            let mut x = [0.0; STATES];
            for (slot, value) in
                x.iter_mut().zip(p.into_iter().chain(rod).chain(attitude).chain(v).chain(rod_rate).chain(omega))
            {
                *slot = value;
            }
            x
        })
}

fn input() -> impl Strategy<Value = Input> {
    (0.0..60.0, [-3.0..3.0, -3.0..3.0, -3.0..3.0]).prop_map(|(thrust, torque)| Input { thrust, torque })
}

fn vehicle() -> impl Strategy<Value = VehicleParameters> {
    (0.1..2.0, 1.0..4.0, 0.5..3.0, [0.01..0.1, 0.01..0.1, 0.01..0.1], 9.7..9.9).prop_map(
        |(payload_mass, uav_mass, rod_length, inertia, gravity)| VehicleParameters {
            payload_mass,
            uav_mass,
            rod_length,
            inertia,
            gravity,
        },
    )
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn norm(a: &[f64]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A state moving as the plant says it does, so that a function of it carries its exact time
/// derivative.
fn moving(vehicle: &VehicleParameters, x: &State, input: &Input) -> [Dual<f64, 1>; STATES] {
    let rate = plant::derivative(vehicle, x, input);
    std::array::from_fn(|i| Dual { value: x[i], parts: [rate[i]] })
}

proptest! {
    // A failing case is printed; it belongs in a test of its own, not in a file beside this one.
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Newton and Euler, from the definitions of energy and momentum alone: power in is energy
    /// gained, force is momentum gained, torque is angular momentum gained. With the charts'
    /// kinematics this is all of the model (2.8).
    #[test]
    fn inputs_and_gravity_account_for_energy_and_momentum(
        vehicle in vehicle(), x in state(), input in input(),
    ) {
        let moving = moving(&vehicle, &x, &input);
        let [b1, b2, b3] = plant::attitude(&x);
        let omega = [x[13], x[14], x[15]];
        let force = b3.map(|b| -b * input.thrust);
        let weight = vehicle.total_mass() * vehicle.gravity;
        let external = [force[0], force[1], force[2] + weight];
        // Rounding, a few hundred operations deep, of terms as large as those compared here.
        let close = |got: f64, expected: f64, scale: f64| (got - expected).abs() <= 1e-12 * scale;

        let power = dot(force, plant::uav_velocity(&vehicle, &x)) + dot(input.torque, omega);
        let gained = plant::energy(&vehicle, &moving).parts[0];
        prop_assert!(close(gained, power, 1e3), "energy: {gained} {power}");

        let gained = plant::momentum(&vehicle, &moving).map(|m| m.parts[0]);
        for axis in 0..3 {
            prop_assert!(close(gained[axis], external[axis], 1e2), "momentum {axis}");
        }

        let [t1, t2, t3] = input.torque;
        let torque: [f64; 3] = std::array::from_fn(|i| b1[i] * t1 + b2[i] * t2 + b3[i] * t3);
        let gained = plant::spin_momentum(&vehicle, &moving).map(|m| m.parts[0]);
        for axis in 0..3 {
            prop_assert!(close(gained[axis], torque[axis], 1e2), "spin {axis}");
        }

        // Moment of the thrust at the UAV and of each weight at its body.
        let (p, uav) = ([x[0], x[1], x[2]], plant::uav_position(&vehicle, &x));
        let cross = |a: [f64; 3], b: [f64; 3]| [
            a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
        ];
        let thrust_moment = cross(uav, force);
        let payload_moment = cross(p, [0.0, 0.0, vehicle.payload_mass * vehicle.gravity]);
        let uav_moment = cross(uav, [0.0, 0.0, vehicle.uav_mass * vehicle.gravity]);
        let gained = plant::orbital_momentum(&vehicle, &moving).map(|m| m.parts[0]);
        for axis in 0..3 {
            let expected = thrust_moment[axis] + payload_moment[axis] + uav_moment[axis];
            prop_assert!(close(gained[axis], expected, 1e3), "orbit {axis}");
        }
    }

    /// The chart's rates are those of the directions: q̇ by the chart is the derivative of q, and
    /// Ṙ = R ω^.
    #[test]
    fn chart_rates_turn_rod_and_body(vehicle in vehicle(), x in state(), input in input()) {
        let moving = moving(&vehicle, &x, &input);
        let (rod, rod_rate) = (plant::rod(&moving), plant::rod_rate(&x));
        for axis in 0..3 {
            prop_assert!((rod[axis].parts[0] - rod_rate[axis]).abs() <= 1e-14 * 10.0);
        }
        let columns = plant::attitude(&x);
        let turning = plant::attitude(&moving);
        let [w1, w2, w3] = [x[13], x[14], x[15]];
        // Columns of R ω^, ω^ being the cross-product matrix.
        let hat = [[0.0, w3, -w2], [-w3, 0.0, w1], [w2, -w1, 0.0]];
        for column in 0..3 {
            for axis in 0..3 {
                let expected: f64 = (0..3).map(|k| columns[k][axis] * hat[column][k]).sum();
                // 1/cos φ, up to 2 here, multiplies the rounding of terms up to 3.
                prop_assert!((turning[column][axis].parts[0] - expected).abs() <= 1e-13);
            }
        }
    }

    /// No direction in the horizontal plane is special: a scene turned about n3 moves as the scene
    /// does, turned.
    #[test]
    fn turning_about_n3_turns_the_motion(
        vehicle in vehicle(), x in state(), input in input(), angle in -3.0..3.0,
    ) {
        let start = Scene::of(&x);
        let turned = start.turned(angle);
        let straight = Scene::rate(&vehicle, &x, &input).turned(angle);
        let other = Scene::rate(&vehicle, &turned.chart(), &input);
        for (index, (a, b)) in straight.flat().into_iter().zip(other.flat()).enumerate() {
            // The chart of the turned scene may come near its end, cos β or cos φ small.
            let chart = turned.chart();
            let margin = chart[4].cos().min(chart[5].cos());
            prop_assume!(margin > 0.05);
            prop_assert!((a - b).abs() <= 1e-11 * (1.0 + a.abs()) / margin, "{index}: {a} {b}");
        }
    }
}

/// A state, or its rate, without charts: vectors in N, and ω in body axes.
#[derive(Clone, Copy, Debug)]
struct Scene {
    vectors: [[f64; 3]; 7],
    omega: [f64; 3],
}

impl Scene {
    fn of(x: &State) -> Self {
        let [b1, b2, b3] = plant::attitude(x);
        Self {
            vectors: [[x[0], x[1], x[2]], [x[8], x[9], x[10]], plant::rod(x), plant::rod_rate(x), b1, b2, b3],
            omega: [x[13], x[14], x[15]],
        }
    }

    fn rate(vehicle: &VehicleParameters, x: &State, input: &Input) -> Self {
        let moving = moving(vehicle, x, input);
        let part = |v: [Dual<f64, 1>; 3]| v.map(|component| component.parts[0]);
        let [b1, b2, b3] = plant::attitude(&moving);
        let group = |first: usize| [moving[first], moving[first + 1], moving[first + 2]];
        Self {
            vectors: [
                part(group(0)),
                part(group(8)),
                part(plant::rod(&moving)),
                part(plant::rod_rate(&moving)),
                part(b1),
                part(b2),
                part(b3),
            ],
            omega: part(group(13)),
        }
    }

    fn turned(&self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { vectors: self.vectors.map(|[a, b, c]| [cos * a - sin * b, sin * a + cos * b, c]), omega: self.omega }
    }

    /// The paper's coordinates, from the definitions q = Rx(α) Ry(β) e3 and R = Ry(θ) Rx(φ) Rz(ψ).
    fn chart(&self) -> State {
        let [p, v, q, q_rate, b1, b2, b3] = self.vectors;
        let (alpha, beta) = ((-q[1]).atan2(q[2]), q[0].asin());
        let (sin_alpha, cos_alpha) = alpha.sin_cos();
        // ∂q/∂α has length cos β along −(0, cos α, sin α); ∂q/∂β is a unit vector.
        let alpha_dot = -(cos_alpha * q_rate[1] + sin_alpha * q_rate[2]) / beta.cos();
        let beta_dot = q_rate[0] / beta.cos();
        let mut x = [0.0; STATES];
        x[..3].copy_from_slice(&p);
        x[3] = alpha;
        x[4] = beta;
        x[5] = (-b3[1]).asin();
        x[6] = b3[0].atan2(b3[2]);
        // The middle row of R is cos φ (sin ψ, cos ψ, ·).
        x[7] = b1[1].atan2(b2[1]);
        x[8..11].copy_from_slice(&v);
        x[11] = alpha_dot;
        x[12] = beta_dot;
        x[13..].copy_from_slice(&self.omega);
        x
    }

    fn flat(&self) -> Vec<f64> {
        self.vectors.iter().flatten().chain(&self.omega).copied().collect()
    }
}

/// A swinging, spinning start with all motions of order one, far from the chart's ends for the two
/// seconds flown.
const TUMBLING: State = [1.0, -2.0, -10.0, 0.3, -0.2, 0.2, -0.1, 0.5, 0.5, -0.4, 0.3, 0.6, -0.5, 0.4, -0.3, 0.7];
const DURATION: f64 = 2.0;

fn unforced(_: f64, x: &State) -> State {
    plant::drift(&VehicleParameters::default(), x)
}

/// What the unforced motion keeps: energy; linear momentum, less what the weight adds; the n3
/// component of the moment of momentum, about which no weight turns; the body's angular momentum.
fn invariants(t: f64, x: &State) -> [f64; 8] {
    let vehicle = VehicleParameters::default();
    let [p1, p2, p3] = plant::momentum(&vehicle, x);
    let [s1, s2, s3] = plant::spin_momentum(&vehicle, x);
    [
        plant::energy(&vehicle, x),
        p1,
        p2,
        p3 - vehicle.total_mass() * vehicle.gravity * t,
        plant::orbital_momentum(&vehicle, x)[2],
        s1,
        s2,
        s3,
    ]
}

/// Orders observed when the step is halved repeatedly: log2 of the ratios of successive errors.
fn observed_orders(error: impl Fn(u32) -> f64) -> Vec<f64> {
    let errors: Vec<f64> = [50, 100, 200, 400].map(error).to_vec();
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

fn reference() -> State {
    // Near the least a chain of f64 steps can reach.
    let tolerance = Tolerance { absolute: 1e-14, relative: 1e-14 };
    integrate::adaptive(unforced, [0.0, DURATION], &TUMBLING, tolerance).expect("a smooth flight")
}

#[test]
fn rk4_is_of_fourth_order() {
    let end = reference();
    let orders = observed_orders(|steps| {
        let x = integrate::rk4(unforced, 0.0, &TUMBLING, DURATION, steps);
        norm(&std::array::from_fn::<f64, STATES, _>(|i| x[i] - end[i]))
    });
    println!("RK4, observed order of the state: {orders:.3?}");
    // The next term of the error makes the order approach 4 by a part proportional to the step.
    for order in orders {
        assert!((order - 4.0).abs() < 0.15, "{order}");
    }
}

#[test]
fn unforced_plant_conserves_energy_and_momentum_to_the_order_of_rk4() {
    let start = invariants(0.0, &TUMBLING);
    let names = ["energy", "momentum 1", "momentum 2", "momentum 3", "orbit 3", "spin 1", "spin 2", "spin 3"];
    for (which, name) in names.into_iter().enumerate() {
        let orders = observed_orders(|steps| {
            let x = integrate::rk4(unforced, 0.0, &TUMBLING, DURATION, steps);
            (invariants(DURATION, &x)[which] - start[which]).abs()
        });
        println!("RK4, observed order of {name}: {orders:.3?}");
        // At least the method's: an invariant may be kept better than the state is.
        for order in orders {
            assert!(order > 3.8, "{name}: {order}");
        }
    }
}

#[test]
fn adaptive_integration_conserves_energy_and_momentum() {
    let (start, end) = (invariants(0.0, &TUMBLING), invariants(DURATION, &reference()));
    for (before, after) in start.into_iter().zip(end) {
        // Some tens of steps, each within 1e-14 of coordinates of the order of 10, and energies of
        // some hundred joules.
        assert!((after - before).abs() < 1e-11 * before.abs().max(1.0), "{before} {after}");
    }
}

/// The error of an adaptive method of order p costs evaluations in proportion to its (−1/p)-th
/// power.
#[test]
fn adaptive_integration_is_of_high_order() {
    let end = reference();
    let fly = |relative: f64| {
        let evaluations = Cell::new(0_u32);
        let tolerance = Tolerance { absolute: relative, relative };
        let counted = |t: f64, x: &State| {
            evaluations.set(evaluations.get() + 1);
            unforced(t, x)
        };
        let x = integrate::adaptive(counted, [0.0, DURATION], &TUMBLING, tolerance).expect("a smooth flight");
        let error = norm(&std::array::from_fn::<f64, STATES, _>(|i| x[i] - end[i]));
        (error, f64::from(evaluations.get()))
    };
    let ((coarse, few), (fine, many)) = (fly(1e-5), fly(1e-11));
    let order = (coarse / fine).ln() / (many / few).ln();
    println!("adaptive: error {coarse:.1e} in {few}, {fine:.1e} in {many} evaluations: order {order:.2}");
    // Of order 8 once the steps are many; at so few of them the step control, cautious at first,
    // shows as more.
    assert!(order > 7.0, "{order}");
    assert!(fine < 1e-9, "{fine}");
}

/// ẋ = x cos t has the solution e^(sin t): a system that depends on time keeps both methods'
/// orders.
#[test]
fn integrators_keep_their_order_when_time_enters() {
    let f = |t: f64, x: &[f64; 1]| [x[0] * t.cos()];
    let exact = DURATION.sin().exp();
    let orders = observed_orders(|steps| (integrate::rk4(f, 0.0, &[1.0], DURATION, steps)[0] - exact).abs());
    println!("RK4, observed order with time: {orders:.3?}");
    for order in orders {
        assert!((order - 4.0).abs() < 0.15, "{order}");
    }
    let tolerance = Tolerance { absolute: 1e-12, relative: 1e-12 };
    let evaluations = Cell::new(0);
    let counted = |t: f64, x: &[f64; 1]| {
        evaluations.set(evaluations.get() + 1);
        f(t, x)
    };
    let x = integrate::adaptive(counted, [0.0, DURATION], &[1.0], tolerance).expect("a smooth solution");
    println!("adaptive with time: error {:.1e} in {} evaluations", x[0] - exact, evaluations.get());
    // A handful of steps, each within the tolerance.
    assert!((x[0] - exact).abs() < 1e-11, "{}", x[0] - exact);
    // At order 8 the tolerance takes about ten steps of twelve evaluations; a wrong stage time
    // takes thousands.
    assert!(evaluations.get() < 500, "{}", evaluations.get());
}

/// A solution that leaves every bound in finite time is reported, not returned.
#[test]
fn adaptive_integration_reports_a_blow_up() {
    let tolerance = Tolerance { absolute: 1e-9, relative: 1e-9 };
    let result = integrate::adaptive(|_, x: &[f64; 1]| [x[0] * x[0]], [0.0, 2.0], &[1.0], tolerance);
    assert!(result.is_err(), "{result:?}");
    let nowhere = integrate::adaptive(|_, _: &[f64; 1]| [f64::NAN], [0.0, 1.0], &[1.0], tolerance);
    assert!(nowhere.is_err(), "{nowhere:?}");
}

#[test]
fn distance_to_the_circle_is_metric() {
    let d = |p| plant::distance_to_circle(p, 5.0, -10.0);
    assert_eq!(d([0.0, 5.0, -10.0]), 0.0);
    assert_eq!(d([0.0, 9.0, -13.0]), 5.0);
    assert_eq!(d([0.0, 0.0, -10.0]), 5.0);
}
