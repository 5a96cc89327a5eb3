//! An item of a mission or fence, as MAVLink has it, and whether a route can have it.

use link::dialect::{MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMissionResult, MavMissionType};

use crate::report::Text;

pub const WAYPOINT: u16 = MavCmd::MAV_CMD_NAV_WAYPOINT as u16;
pub const LOITER_UNLIMITED: u16 = MavCmd::MAV_CMD_NAV_LOITER_UNLIM as u16;
pub const LOITER_TIME: u16 = MavCmd::MAV_CMD_NAV_LOITER_TIME as u16;
pub const RETURN_TO_LAUNCH: u16 = MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH as u16;
pub const LAND: u16 = MavCmd::MAV_CMD_NAV_LAND as u16;
pub const TAKE_OFF: u16 = MavCmd::MAV_CMD_NAV_TAKEOFF as u16;
pub const SPLINE_WAYPOINT: u16 = MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT as u16;
pub const DELAY: u16 = MavCmd::MAV_CMD_NAV_DELAY as u16;
pub const JUMP: u16 = MavCmd::MAV_CMD_DO_JUMP as u16;
pub const CHANGE_SPEED: u16 = MavCmd::MAV_CMD_DO_CHANGE_SPEED as u16;
pub const POLYGON_INSIDE: u16 = MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION as u16;
pub const POLYGON_OUTSIDE: u16 = MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION as u16;
pub const CIRCLE_INSIDE: u16 = MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION as u16;
pub const CIRCLE_OUTSIDE: u16 = MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION as u16;

/// Commands to cameras and their mounts, of which there are none aboard: surveys of ground stations
/// are full of them, and where the load goes does not depend on them.
const CAMERA: [u16; 13] = [203, 204, 205, 206, 214, 530, 531, 532, 1000, 2000, 2001, 2500, 2501];

const GLOBAL: u8 = MavFrame::MAV_FRAME_GLOBAL as u8;
const GLOBAL_INT: u8 = MavFrame::MAV_FRAME_GLOBAL_INT as u8;
const RELATIVE: u8 = MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT as u8;
const RELATIVE_INT: u8 = MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT as u8;
const LOCAL: u8 = MavFrame::MAV_FRAME_LOCAL_NED as u8;

/// Degrees of a step of an item's x and y, where they are latitude and longitude.
pub const DEGREES: f64 = 1e-7;
/// Steps of a degree.
const STEPS: u32 = 10_000_000;
/// m of a step of x and y, where they are n1 and n2.
pub const METRES: f64 = 1e-4;

/// Longest rest, s, which is most jumps, too; and largest corner, m.
const LONGEST: f32 = 1e5;
const LARGEST: f32 = 1e3;

/// What is transferred.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The route.
    Mission,
    /// The fence.
    Fence,
}

impl Kind {
    /// All.
    pub const ALL: [Self; 2] = [Self::Mission, Self::Fence];

    /// Of a MAV_MISSION_TYPE.
    pub fn of(mission_type: u8) -> Option<Self> {
        const MISSION: u8 = MavMissionType::MAV_MISSION_TYPE_MISSION as u8;
        const FENCE: u8 = MavMissionType::MAV_MISSION_TYPE_FENCE as u8;
        match mission_type {
            MISSION => Some(Self::Mission),
            FENCE => Some(Self::Fence),
            _ => None,
        }
    }

    /// What its items are called.
    #[must_use]
    pub fn item(self) -> &'static str {
        match self {
            Self::Mission => "item",
            Self::Fence => "fence item",
        }
    }

    /// As a MAV_MISSION_TYPE.
    pub fn number(self) -> u8 {
        match self {
            Self::Mission => MavMissionType::MAV_MISSION_TYPE_MISSION as u8,
            Self::Fence => MavMissionType::MAV_MISSION_TYPE_FENCE as u8,
        }
    }
}

/// Why items are refused: for the station's program, and, displayed, for its pilot.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// A MAV_MISSION_RESULT.
    pub result: MavMissionResult,
    /// The item that is at fault, counted from 0, if it is one.
    pub item: Option<(Kind, u16)>,
    /// What is wrong with it.
    pub text: Text,
}

impl Refusal {
    pub(crate) fn new(result: MavMissionResult, what: core::fmt::Arguments<'_>) -> Self {
        Self { result, item: None, text: crate::report::cut(what) }
    }

    pub(crate) fn invalid(what: core::fmt::Arguments<'_>) -> Self {
        Self::new(MavMissionResult::MAV_MISSION_INVALID, what)
    }

    pub(crate) fn no_space(what: core::fmt::Arguments<'_>) -> Self {
        Self::new(MavMissionResult::MAV_MISSION_NO_SPACE, what)
    }

    /// Of the `number`-th item of its kind.
    pub(crate) fn at(self, kind: Kind, number: usize) -> Self {
        Self { item: Some((kind, number as u16)), ..self }
    }
}

impl core::fmt::Display for Refusal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        if let Some((kind, number)) = self.item {
            write!(f, "{} {number}: ", kind.item())?;
        }
        f.write_str(&self.text)
    }
}

/// Numbers of 32 bits that hold an item.
pub(crate) const WORDS: usize = 9;

/// An item as it was sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Item {
    /// A MAV_CMD.
    pub command: u16,
    /// A MAV_FRAME.
    pub frame: u8,
    /// Kept for the station.
    pub current: u8,
    /// Kept for the station.
    pub autocontinue: u8,
    /// The command's first four parameters.
    pub params: [f32; 4],
    /// Latitude in 1e-7 degrees, or n1 in 1e-4 m.
    pub x: i32,
    /// Longitude in 1e-7 degrees, or n2 in 1e-4 m.
    pub y: i32,
    /// Height, or n3, m.
    pub z: f32,
}

impl Item {
    /// The commands of a mission that say where the load goes, or how.
    pub const COMMANDS: [u16; 10] = [
        WAYPOINT,
        LOITER_UNLIMITED,
        LOITER_TIME,
        RETURN_TO_LAUNCH,
        LAND,
        TAKE_OFF,
        SPLINE_WAYPOINT,
        DELAY,
        JUMP,
        CHANGE_SPEED,
    ];
    /// The frames that a place can be in.
    pub const FRAMES: [u8; 5] = [GLOBAL, LOCAL, RELATIVE, GLOBAL_INT, RELATIVE_INT];

    /// Of a message.
    pub fn of(item: &MISSION_ITEM_INT_DATA) -> Self {
        let &MISSION_ITEM_INT_DATA { command, frame, current, autocontinue, x, y, z, .. } = item;
        let params = [item.param1, item.param2, item.param3, item.param4];
        Self { command, frame, current, autocontinue, params, x, y, z }
    }

    /// As a message.
    pub fn message(&self, seq: u16, kind: Kind, target: link::Address) -> MISSION_ITEM_INT_DATA {
        let Self { command, frame, current, autocontinue, params, x, y, z } = *self;
        let [param1, param2, param3, param4] = params;
        let (target_system, target_component) = target;
        MISSION_ITEM_INT_DATA {
            param1,
            param2,
            param3,
            param4,
            x,
            y,
            z,
            seq,
            command,
            target_system,
            target_component,
            frame,
            current,
            autocontinue,
            mission_type: kind.number(),
        }
    }

    /// As numbers of 32 bits.
    pub(crate) fn words(&self) -> [u32; WORDS] {
        let Self { command, frame, current, autocontinue, params: [p1, p2, p3, p4], x, y, z } = *self;
        let first = u32::from(command) | u32::from(frame) << 16 | u32::from(current) << 24;
        let [p1, p2, p3, p4] = [p1, p2, p3, p4].map(f32::to_bits);
        [first, autocontinue.into(), p1, p2, p3, p4, x.cast_unsigned(), y.cast_unsigned(), z.to_bits()]
    }

    /// The same again.
    pub(crate) fn of_words([first, second, p1, p2, p3, p4, x, y, z]: [u32; WORDS]) -> Self {
        Self {
            command: first as u16,
            frame: (first >> 16) as u8,
            current: (first >> 24) as u8,
            autocontinue: second as u8,
            params: [p1, p2, p3, p4].map(f32::from_bits),
            x: x.cast_signed(),
            y: y.cast_signed(),
            z: f32::from_bits(z),
        }
    }

    /// Whether a mission or fence can have it.
    pub(super) fn check(&self, kind: Kind) -> Result<(), Refusal> {
        use MavMissionResult as R;
        let Self { command, params: [first, second, ..], z, .. } = *self;
        let within = |what: &str, value: f32, most: f32, result| {
            if (0.0..=most).contains(&value) {
                return Ok(());
            }
            Err(Refusal::new(result, format_args!("{what} {value} not in 0 to {most}")))
        };
        let is_known = match kind {
            Kind::Mission => Self::COMMANDS.contains(&command) || self.is_for_camera(),
            Kind::Fence => [POLYGON_INSIDE, POLYGON_OUTSIDE, CIRCLE_INSIDE, CIRCLE_OUTSIDE].contains(&command),
        };
        if !is_known {
            return Err(Refusal::new(R::MAV_MISSION_UNSUPPORTED, format_args!("command {command} not supported")));
        }
        match command {
            WAYPOINT | SPLINE_WAYPOINT | LOITER_UNLIMITED | LOITER_TIME | TAKE_OFF | LAND => {
                self.check_place()?;
                if command != LAND && (z.is_nan() || z.abs() > 1e5) {
                    return Err(Refusal::new(
                        R::MAV_MISSION_INVALID_PARAM7,
                        format_args!("height {z} not in -1e5 to 1e5"),
                    ));
                }
                if matches!(command, WAYPOINT | SPLINE_WAYPOINT | LOITER_TIME) {
                    within("rest", first, LONGEST, R::MAV_MISSION_INVALID_PARAM1)?;
                }
                if command == WAYPOINT {
                    within("radius", second, LARGEST, R::MAV_MISSION_INVALID_PARAM2)?;
                }
                Ok(())
            }
            DELAY => within("rest", first, LONGEST, R::MAV_MISSION_INVALID_PARAM1),
            // -1: as it is, -2: the usual one.
            CHANGE_SPEED if second <= 0.0 => Ok(()),
            CHANGE_SPEED => within("speed", second, 100.0, R::MAV_MISSION_INVALID_PARAM2),
            // -1: without end.
            JUMP if second < 0.0 => within("jump to", first, LONGEST, R::MAV_MISSION_INVALID_PARAM1),
            JUMP => {
                within("jump to", first, LONGEST, R::MAV_MISSION_INVALID_PARAM1)?;
                within("jumps", second, LONGEST, R::MAV_MISSION_INVALID_PARAM2)
            }
            POLYGON_INSIDE | POLYGON_OUTSIDE => {
                self.check_place()?;
                within("corners", first, 1e3, R::MAV_MISSION_INVALID_PARAM1)
            }
            CIRCLE_INSIDE | CIRCLE_OUTSIDE => {
                self.check_place()?;
                within("radius", first, 1e5, R::MAV_MISSION_INVALID_PARAM1)
            }
            _ => Ok(()),
        }
    }

    fn check_place(&self) -> Result<(), Refusal> {
        use MavMissionResult as R;
        let Self { frame, .. } = *self;
        if !Self::FRAMES.contains(&frame) {
            return Err(Refusal::new(R::MAV_MISSION_UNSUPPORTED_FRAME, format_args!("frame {frame} not supported")));
        }
        if self.is_local() || !self.is_placed() {
            return Ok(());
        }
        let far = |name, value: i32, most: u32, result| {
            if value.unsigned_abs() <= STEPS.saturating_mul(most) {
                return Ok(());
            }
            let degrees = f64::from(value) * DEGREES;
            Err(Refusal::new(result, format_args!("{name} {degrees:.1} not in -{most} to {most}")))
        };
        far("latitude", self.x, 90, R::MAV_MISSION_INVALID_PARAM5_X)?;
        far("longitude", self.y, 180, R::MAV_MISSION_INVALID_PARAM6_Y)
    }

    /// It says nothing of where the load goes.
    #[must_use]
    pub fn is_for_camera(&self) -> bool {
        CAMERA.contains(&self.command)
    }

    /// Its place is in N.
    pub fn is_local(&self) -> bool {
        self.frame == LOCAL
    }

    /// It says where on the earth: zeros and the largest number are none.
    pub fn is_placed(&self) -> bool {
        (self.x, self.y) != (0, 0) && self.x != i32::MAX && self.y != i32::MAX
    }

    /// Its height is above the sea.
    pub fn is_above_sea(&self) -> bool {
        matches!(self.frame, GLOBAL | GLOBAL_INT)
    }
}
