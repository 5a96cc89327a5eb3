//! Navigation of our own: it begins level by the accelerometer, at the first fix, by the magnetic
//! field or the receiver's heading.

use controller::{Matrix3, Vector3};
use estimator::{Fix, Imu, Motion, OutOfRange, attitude_at_rest};

use super::{Unseen, params};
use crate::seen::Navigation;
use crate::settings::Settings;

/// Share of a period's reading in what is averaged before the start: over some 0.2 s at 500 Hz.
const SHARE: f32 = 0.01;
/// Periods of the IMU before the start.
const LEVELLING: u16 = 250;

/// The navigation filter, and what it is to begin with.
#[derive(Clone, Debug)]
pub struct Own {
    filter: Option<estimator::Navigation<f32>>,
    /// Means of specific force and field, body axes.
    level: Vector3<f32>,
    field: Option<Vector3<f32>>,
    heading: Option<f32>,
    levelled: u16,
    period_s: f32,
}

impl Own {
    /// Nothing known yet.
    ///
    /// # Errors
    /// A number that the filter refuses.
    pub fn new(settings: &Settings) -> Result<Self, OutOfRange<f32>> {
        let told = params::navigation(settings);
        let period_s = told.period;
        estimator::Navigation::new(told, &Motion::at_rest(Vector3::zeros(), told.gravity), [1.0; 2])?;
        Ok(Self { filter: None, level: Vector3::zeros(), field: None, heading: None, levelled: 0, period_s })
    }

    /// A control period.
    ///
    /// # Errors
    /// Why the motion is not known.
    pub fn step(&mut self, settings: &Settings, navigation: &mut Navigation) -> Result<Motion<f32>, Unseen> {
        let inertial = navigation.inertial();
        let imu = inertial.and_then(|inertial| {
            Some(Imu { body_rate: inertial.body_rate?, specific_force: inertial.specific_force })
        });
        let instruments = navigation.instruments_mut();
        let age = params::fix_age_s(settings);
        let fix = instruments.take_fix().map(|fix| Fix { age, ..fix });
        let heading = instruments.take_heading();
        let (field, height) = instruments.take_slow(self.period_s);
        let Some(filter) = &mut self.filter else {
            return self.begin(settings, imu, fix, field, heading);
        };
        // What is refused leaves the filter as it was: the age of its last fix tells.
        if let Some(fix) = &fix {
            let _ = filter.fix(fix);
        }
        if let Some(heading) = heading {
            let _ = filter.heading(heading);
        }
        if let Some(field) = &field {
            let _ = filter.magnetic_field(field);
        }
        if let Some(height) = height {
            let _ = filter.height(height);
        }
        let motion = filter.step(imu.as_ref());
        let health = filter.health();
        if health.is_blind {
            Err(Unseen::Imu)
        } else if health.fix_age > params::outage_s(settings) {
            Err(Unseen::Fix)
        } else {
            Ok(motion)
        }
    }

    /// Since the last fix, s; for ever before the first.
    pub fn fix_age_s(&self) -> f32 {
        self.filter.as_ref().map_or(f32::INFINITY, |filter| filter.health().fix_age)
    }

    /// Averages until there is all that it takes to begin.
    fn begin(
        &mut self,
        settings: &Settings,
        imu: Option<Imu<f32>>,
        fix: Option<Fix<f32>>,
        field: Option<Vector3<f32>>,
        heading: Option<f32>,
    ) -> Result<Motion<f32>, Unseen> {
        let imu = imu.ok_or(Unseen::Imu)?;
        self.levelled = self.levelled.saturating_add(1);
        let share = if self.levelled == 1 { 1.0 } else { SHARE };
        self.level += (imu.specific_force - self.level) * share;
        self.field = field.or(self.field);
        self.heading = heading.or(self.heading);
        let fix = fix.filter(|_| self.levelled > LEVELLING).ok_or(Unseen::Fix)?;
        let parameters = params::navigation(settings);
        let attitude = self.attitude(parameters.declination).ok_or(Unseen::Heading)?;
        let place = fix.position.ok_or(Unseen::Fix)? - attitude * parameters.antenna;
        let motion = Motion {
            position: place,
            velocity: fix.velocity.unwrap_or_else(Vector3::zeros),
            attitude,
            body_rate: imu.body_rate,
            specific_force: imu.specific_force,
        };
        let [across, down] = fix.position_accuracy;
        let [least, _] = parameters.noise.position;
        let deviations = [2.0 * across.max(down).max(least), 0.3];
        self.filter = estimator::Navigation::new(parameters, &motion, deviations).ok();
        if self.filter.is_some() { Ok(motion) } else { Err(Unseen::Fix) }
    }

    /// Down is where the specific force is not, and north where the field is, or the receiver says.
    fn attitude(&self, declination: f32) -> Option<Matrix3<f32>> {
        let (ahead, heading) = match (self.field, self.heading) {
            // b1 across the vertical has the receiver's heading.
            (_, Some(heading)) => (Vector3::x(), heading),
            // And the field the declination.
            (Some(field), None) => (field, declination),
            (None, None) => return None,
        };
        attitude_at_rest(&self.level, &ahead, heading)
    }
}
