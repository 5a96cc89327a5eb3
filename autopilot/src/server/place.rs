//! Where the vehicle is and how it stands, for ground stations to draw.

use controller::{Real, Uav};
use link::MavMessage;
use link::dialect::*;

use super::Server;
use crate::control::Autopilot;
use crate::report::number;

/// Time from one round of messages to the next, ns.
const EVERY_NS: u64 = 100_000_000;

/// The round of messages that is being told.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// When the next round is due, ns.
    due_ns: u64,
    /// The next message of this one.
    next: u8,
}

impl Place {
    pub const fn new() -> Self {
        Self { due_ns: 0, next: 0 }
    }
}

impl Server {
    /// The next message of a round, if it is time for one and the UAV is known.
    pub(super) fn place_news(&mut self, time_ns: u64, autopilot: &Autopilot) -> Option<MavMessage> {
        let uav = autopilot.uav()?;
        if time_ns < self.place.due_ns {
            return None;
        }
        let now = Now { uav, autopilot, time_boot_ms: (time_ns / 1_000_000) as u32 };
        // Without a home there is no place on the earth.
        for next in self.place.next..4 {
            let message = match next {
                0 => Some(now.attitude()),
                1 => Some(now.local()),
                2 => now.global(),
                _ => Some(now.hud()),
            };
            if message.is_some() {
                self.place.next = next + 1;
                return message;
            }
        }
        self.place = Place { due_ns: time_ns + EVERY_NS, next: 0 };
        None
    }

    /// What it has to fly by, once a second.
    #[must_use]
    pub fn system_status(autopilot: &Autopilot) -> MavMessage {
        use MavSysStatusSensor as Sensor;
        let all = Sensor::all();
        let mut health = all;
        let is_known = autopilot.uav().is_some();
        health.set(Sensor::MAV_SYS_STATUS_SENSOR_3D_GYRO, is_known);
        health.set(Sensor::MAV_SYS_STATUS_SENSOR_3D_ACCEL, is_known);
        health.set(Sensor::MAV_SYS_STATUS_SENSOR_3D_MAG, is_known);
        health.set(Sensor::MAV_SYS_STATUS_AHRS, is_known);
        health.set(Sensor::MAV_SYS_STATUS_SENSOR_GPS, is_known && autopilot.mission().home().is_some());
        health.set(Sensor::MAV_SYS_STATUS_PREARM_CHECK, autopilot.is_ready());
        MavMessage::SYS_STATUS(SYS_STATUS_DATA {
            onboard_control_sensors_present: all.bits(),
            onboard_control_sensors_enabled: all.bits(),
            onboard_control_sensors_health: health.bits(),
            voltage_battery: u16::MAX,
            current_battery: -1,
            battery_remaining: autopilot.battery().unwrap_or(-1),
            ..SYS_STATUS_DATA::DEFAULT
        })
    }
}

/// The UAV as it is told of.
struct Now<'a> {
    uav: &'a Uav<f32>,
    autopilot: &'a Autopilot,
    time_boot_ms: u32,
}

impl Now<'_> {
    /// From n1 toward n2, rad, within (−π, π].
    fn yaw(&self) -> f32 {
        Real::atan2(self.uav.attitude.m21, self.uav.attitude.m11)
    }

    /// The same from 0 up to 360°.
    fn heading_degrees(&self) -> f32 {
        let degrees = self.yaw().to_degrees();
        if degrees < 0.0 { degrees + 360.0 } else { degrees }
    }

    fn attitude(&self) -> MavMessage {
        let Uav { attitude, body_rate, .. } = self.uav;
        let level = Real::sqrt(attitude.m32 * attitude.m32 + attitude.m33 * attitude.m33);
        MavMessage::ATTITUDE(ATTITUDE_DATA {
            time_boot_ms: self.time_boot_ms,
            roll: number(Real::atan2(attitude.m32, attitude.m33)),
            pitch: number(Real::atan2(-attitude.m31, level)),
            yaw: number(self.yaw()),
            rollspeed: body_rate.x,
            pitchspeed: body_rate.y,
            yawspeed: body_rate.z,
        })
    }

    fn local(&self) -> MavMessage {
        let Uav { position, velocity, .. } = self.uav;
        MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA {
            time_boot_ms: self.time_boot_ms,
            x: position.x,
            y: position.y,
            z: position.z,
            vx: velocity.x,
            vy: velocity.y,
            vz: velocity.z,
        })
    }

    fn global(&self) -> Option<MavMessage> {
        let Uav { position, velocity, .. } = self.uav;
        let home = self.autopilot.mission().home()?;
        let [lat, lon] = home.place([position.x, position.y]);
        // Where a number does not fit, the cast takes the nearest that does.
        let [vx, vy, vz] = [velocity.x, velocity.y, velocity.z].map(|speed| (speed * 100.0) as i16);
        let relative_alt = (-position.z * 1e3) as i32;
        Some(MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
            time_boot_ms: self.time_boot_ms,
            lat,
            lon,
            alt: ((home.altitude * 1e3) as i32).saturating_add(relative_alt),
            relative_alt,
            vx,
            vy,
            vz,
            hdg: (self.heading_degrees() * 100.0) as u16,
        }))
    }

    fn hud(&self) -> MavMessage {
        let Uav { position, velocity, .. } = self.uav;
        let speed = Real::sqrt(velocity.x * velocity.x + velocity.y * velocity.y);
        let ground = self.autopilot.mission().home().map_or(0.0, |home| home.altitude as f32);
        MavMessage::VFR_HUD(VFR_HUD_DATA {
            airspeed: speed,
            groundspeed: speed,
            alt: ground - position.z,
            climb: -velocity.z,
            heading: self.heading_degrees() as i16,
            throttle: (self.autopilot.throttle() * 100.0) as u16,
        })
    }
}
