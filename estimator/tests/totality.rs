//! Whatever comes in, numbers come out: every bit pattern, missing inputs, late and impossible
//! measurements; and a filter that has seen them finds back.

use estimator::{
    Cable, Fix, Imu, LoadMeasurement, Matrix3, Motion, Navigation, NavigationParams, Payload, PayloadParams, Refused,
    Validity, Vector3,
};
use model::{Uav, VehicleParams};

const PERIOD: f32 = 0.002;
const G: f32 = 9.81;
const HOVER: f32 = 3.0 * G;

/// Marsaglia's xorshift64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Any float: NaNs, infinities and subnormal numbers among them.
    fn float(&mut self) -> f32 {
        match self.bits() % 8 {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => f32::MAX,
            3 => 0.0,
            _ => f32::from_bits((self.bits() >> 32) as u32),
        }
    }

    fn vector(&mut self) -> Vector3<f32> {
        Vector3::from_fn(|_, _| self.float())
    }

    fn matrix(&mut self) -> Matrix3<f32> {
        Matrix3::from_fn(|_, _| self.float())
    }
}

fn payload() -> Payload<f32> {
    Payload::new(PayloadParams::of(&VehicleParams::paper(), PERIOD)).unwrap()
}

fn hover() -> Motion<f32> {
    // The pull of a hanging load and the thrust: in all, gravity.
    Motion::at_rest(Vector3::new(0.0, 0.0, -10.0), G)
}

fn assert_sound(filter: &Payload<f32>) {
    let p = filter.covariance();
    for (i, row) in p.iter().enumerate() {
        assert!(row[i] > 0.0 && row[i].is_finite(), "{i}: {}", row[i]);
        for (j, entry) in row.iter().enumerate() {
            assert!(entry.to_bits() == p[j][i].to_bits() || *entry == p[j][i], "{i} {j}");
            // Cauchy and Schwarz, to within rounding.
            assert!(entry * entry <= row[i] * p[j][j] * 1.001, "{i} {j}");
        }
    }
    let rod = filter.nominal().rod;
    assert!((rod.dot(&rod) - 1.0).abs() < 1e-4 && rod.z > 0.0, "{rod}");
}

#[test]
fn any_bits_leave_the_payload_filter_sound() {
    let mut random = Random(5);
    let mut filter = payload();
    for step in 0..200_000 {
        let mut motion = hover();
        match random.bits() % 12 {
            0 => motion.position = random.vector(),
            1 => motion.velocity = random.vector(),
            2 => motion.attitude = random.matrix(),
            3 => motion.body_rate = random.vector(),
            4 => motion.specific_force = random.vector(),
            _ => {}
        }
        let thrust = if random.bits().is_multiple_of(3) { random.float() } else { HOVER };
        let any = random.vector();
        let measurement = match random.bits() % 4 {
            0 => LoadMeasurement::Direction(any, random.float()),
            1 => LoadMeasurement::Position(any, random.float()),
            2 => LoadMeasurement::Pair([any, random.vector()], random.float()),
            _ => LoadMeasurement::Velocity(any, random.float()),
        };
        if random.bits().is_multiple_of(50) {
            filter.observe(&measurement, random.float());
        }
        let motion = (!random.bits().is_multiple_of(10)).then_some(motion);
        let estimate = filter.step(motion.as_ref(), Some(thrust));
        assert!(estimate.state.check().is_ok(), "{step}: {:?}", estimate.state);
        assert!(estimate.tension.is_finite() && estimate.health.rod_deviation.is_finite(), "{step}");
        assert_sound(&filter);
    }
    // And it comes to rest when the world does.
    for _ in 0..60 * 500 {
        filter.step(Some(&hover()), Some(HOVER));
    }
    let estimate = filter.step(Some(&hover()), Some(HOVER));
    assert_eq!(estimate.cable, Cable::Taut);
    assert!(estimate.state.rod.z > 0.999, "{}", estimate.state.rod);
}

#[test]
fn silence_is_said_and_ends() {
    let mut filter = payload();
    for _ in 0..5000 {
        filter.step(Some(&hover()), Some(HOVER));
    }
    assert_eq!(filter.step(Some(&hover()), Some(HOVER)).health.validity, Validity::Valid);
    let known = filter.step(None, None).health.rod_deviation;
    for _ in 0..100 {
        filter.step(None, Some(HOVER));
    }
    let blind = filter.step(None, None).health;
    assert_eq!(blind.validity, Validity::Blind);
    assert!(blind.rod_deviation > known, "{} {known}", blind.rod_deviation);
    filter.step(Some(&hover()), Some(HOVER));
    assert_ne!(filter.step(Some(&hover()), Some(HOVER)).health.validity, Validity::Blind);
}

#[test]
fn any_bits_leave_navigation_sound() {
    let mut random = Random(9);
    let mut filter = Navigation::new(NavigationParams::every(PERIOD), &hover(), [0.1, 0.1]).unwrap();
    let rest = Imu { body_rate: Vector3::zeros(), specific_force: Vector3::new(0.0, 0.0, -G) };
    let good = Fix {
        position: Some(Vector3::new(0.0, 0.0, -10.0)),
        velocity: Some(Vector3::zeros()),
        position_accuracy: [0.01, 0.02],
        velocity_accuracy: [0.03, 0.05],
        age: 0.1,
    };
    for step in 0..200_000 {
        let imu = match random.bits() % 20 {
            0 => Some(Imu { body_rate: random.vector(), ..rest }),
            1 => Some(Imu { specific_force: random.vector(), ..rest }),
            2 => None,
            _ => Some(rest),
        };
        match random.bits() % 400 {
            0 => {
                let _ = filter.fix(&Fix { position: Some(random.vector()), ..good });
            }
            1 => {
                let _ = filter.fix(&Fix { velocity: Some(random.vector()), ..good });
            }
            2 => {
                let _ = filter.fix(&Fix { position_accuracy: [random.float(); 2], age: random.float(), ..good });
            }
            3 => {
                let _ = filter.pose(&good, Some((&random.matrix(), random.float())));
            }
            4 => {
                let _ = filter.height(random.float());
            }
            5 => {
                let _ = filter.heading(random.float());
            }
            6 => {
                let _ = filter.magnetic_field(&random.vector());
            }
            7..20 => {
                let _ = filter.fix(&good);
            }
            _ => {}
        }
        let motion = filter.step(imu.as_ref());
        assert!(motion.is_usable(), "{step}: {motion:?}");
        for (i, row) in filter.covariance().iter().enumerate() {
            assert!(row[i] > 0.0 && row[i].is_finite(), "{step} {i}: {}", row[i]);
        }
    }
}

#[test]
fn navigation_says_why_it_refuses_and_starts_anew_from_a_receiver_that_insists() {
    let mut filter = Navigation::new(NavigationParams::every(PERIOD), &hover(), [0.01, 0.1]).unwrap();
    let rest = Imu { body_rate: Vector3::zeros(), specific_force: Vector3::new(0.0, 0.0, -G) };
    let mut fix = Fix {
        position: Some(Vector3::new(0.0, 0.0, -10.0)),
        velocity: Some(Vector3::zeros()),
        position_accuracy: [0.01, 0.02],
        velocity_accuracy: [0.03, 0.05],
        age: 0.1,
    };
    let fly = |filter: &mut Navigation<f32>, fix: &Fix<f32>| {
        for _ in 0..50 {
            filter.step(Some(&rest));
        }
        filter.fix(fix)
    };
    for _ in 0..20 {
        fly(&mut filter, &fix).unwrap();
    }
    assert_eq!(filter.fix(&Fix { age: 0.5, ..fix }), Err(Refused::Age));
    assert_eq!(filter.fix(&Fix { age: -0.1, ..fix }), Err(Refused::Age));
    assert_eq!(filter.fix(&Fix { position: Some(Vector3::new(f32::NAN, 0.0, 0.0)), ..fix }), Err(Refused::NotUsable));
    fix.position = Some(Vector3::new(30.0, 0.0, -10.0));
    let mut refused = 0;
    while fly(&mut filter, &fix) == Err(Refused::Outlier) {
        refused += 1;
        assert!(refused < 20);
    }
    assert_eq!(filter.health().resets, 1);
    let motion = filter.step(Some(&rest));
    assert!((motion.position.x - 30.0).abs() < 0.1, "{}", motion.position);
}

/// After a jump of navigation the line from the UAV to the load stays the cable: the UAV that a law
/// is told beside the state glides along.
#[test]
fn the_uav_glides_beside_its_load() {
    let params = PayloadParams::of(&VehicleParams::<f64>::paper(), 0.002);
    let (length, gravity) = (params.cable_length, params.gravity);
    let hover = (params.uav_mass + params.payload_mass) * gravity;
    let mut filter = Payload::new(params).unwrap();
    let mut motion = Motion::at_rest(Vector3::zeros(), gravity);
    for step in 0..600 {
        if step == 500 {
            motion.position.x += 1.5;
        }
        let estimate = filter.step(Some(&motion), Some(hover));
        let Motion { position, velocity, attitude, body_rate, .. } = motion;
        let uav = estimate.beside(&Uav { position, velocity, attitude, body_rate });
        let line = estimate.state.position - uav.position;
        assert!((line - estimate.state.rod * length).amax() < 1e-12, "{line}");
        assert!(step != 500 || uav.position.x < 0.01, "{}", uav.position);
    }
}
