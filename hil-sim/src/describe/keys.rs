//! Every key of a scenario file: its unit, range, default and meaning, as `hil-sim keys` prints
//! them and `docs/scenario.md` holds them.
//!
//! Tests hold this table to what reads the files: each key that is read stands here, each range is
//! the one that is refused beyond, and each default the value that is taken.

use std::fmt::Write as _;

/// What a key may be.
#[derive(Clone, Copy, Debug)]
pub enum Values {
    /// A number in a range.
    Number(f64, f64),
    /// A whole number in a range.
    Whole(u64, u64),
    /// So many numbers, each in a range.
    Each(usize, f64, f64),
    /// One of these words.
    Word(&'static [&'static str]),
    /// As the text says.
    Other(&'static str),
}

/// A key.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name in its table.
    pub name: &'static str,
    /// Of its numbers.
    pub unit: &'static str,
    /// What it may be.
    pub values: Values,
    /// As TOML, or in brackets what goes for one that is left out; empty for one that must be
    /// given.
    pub default: &'static str,
    /// What it is.
    pub meaning: &'static str,
}

/// A table of a scenario file.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Its name, empty for the keys before all tables.
    pub table: &'static str,
    /// What it is about.
    pub about: &'static str,
    /// A scenario in which the table is as short as it can be, but for what may be left out.
    pub least: &'static str,
    /// Its keys.
    pub keys: &'static [Key],
}

const fn key(
    name: &'static str,
    unit: &'static str,
    values: Values,
    default: &'static str,
    meaning: &'static str,
) -> Key {
    Key { name, unit, values, default, meaning }
}

use Values::{Each, Number, Other, Whole, Word};

const SPEED: Key = key(
    "speed",
    "m/s",
    Other("-100 to 100, a formula, or { max, acceleration }"),
    "",
    "v_d along the curve; with max and acceleration slower where the curve bends.",
);
const YAW: Key = key(
    "yaw",
    "rad",
    Other("-1000 to 1000, a formula, \"tangent\", or { x, y }"),
    "0.0",
    "ψ_d; with x and y the nose points to a vertical line.",
);
const CONSTANTS: Key = key("constants", "", Other("{ name = number, … }"), "{}", "Names for numbers in formulas.");
const A: Key = key("a", "m", Number(0.01, 1e5), "", "Half axis along n1.");
const B: Key = key("b", "m", Number(0.01, 1e5), "", "Half axis along n2.");
const C0: Key = key("c0", "m", Number(-1e5, 1e5), "", "Height at p1 = 0; negative is above the origin.");
const C1: Key = key("c1", "", Number(-100.0, 100.0), "0.0", "Slope of the height along n1.");
const KIND: Key = key("kind", "", Other("as above"), "", "Which curve.");

const MASSES: &[Key] = &[
    key("payload_mass", "kg", Number(1e-3, 1e3), "0.5", "m_L."),
    key("uav_mass", "kg", Number(0.01, 1e3), "2.5", "m_Q, without the payload."),
    key("rod_length", "m", Number(0.05, 100.0), "2.0", "L, from the UAV's centre of mass to the payload."),
    key("inertia", "kg m²", Each(3, 1e-6, 1e3), "[0.03, 0.03, 0.05]", "J about the body axes."),
    key("gravity", "m/s²", Number(0.1, 30.0), "9.81", "g."),
];

const CHANNEL: &[Key] = &[
    key("noise", "the channel's", Number(0.0, 100.0), "0.0", "Standard deviation per sample and axis, white."),
    key("bias", "the channel's", Each(3, -100.0, 100.0), "[0.0, 0.0, 0.0]", "Constant error."),
    key("quantum", "the channel's", Number(0.0, 100.0), "0.0", "Step of the reading."),
    key("jitter_s", "s", Other("0 to one control period"), "0.0", "Largest age of a reading."),
    key("freeze", "s", Other("{ at_s, for_s }, 0 to 100000 each"), "(never)", "The reading stands still."),
    key("drop_out", "s", Other("{ at_s, for_s }, 0 to 100000 each"), "(never)", "The driver gives zeros."),
    key("nan", "s", Other("{ at_s, for_s }, 0 to 100000 each"), "(never)", "The driver gives NaN."),
];

/// All tables of a scenario file, in the order of the page.
pub const SECTIONS: &[Section] = &[
    Section {
        table: "",
        about: "The flight.",
        least: "",
        keys: &[
            key("title", "", Other("text"), "\"\"", "A caption."),
            key(
                "figure",
                "",
                Other("text"),
                "(none)",
                "The paper's figure and panel that the flight belongs to, as \"3a\".",
            ),
            key("duration_s", "s", Number(0.01, 1e5), "10.0", "Length of the flight."),
            key("substeps", "", Whole(1, 1000), "4", "Runge-Kutta steps of the plant in one control period."),
            key(
                "log_period_s",
                "s",
                Number(1e-4, 10.0),
                "0.01",
                "Period of the log, to the flight's length; metrics see every sample.",
            ),
            key(
                "steady_from_s",
                "s",
                Number(0.0, 10.0),
                "(never)",
                "From here to the end steady errors are measured.",
            ),
            key("seed", "", Whole(0, 1 << 53), "0", "Of all random numbers."),
            key("run", "", Whole(0, 1 << 53), "0", "The flight's number among those of the seed, as a campaign's."),
            key(
                "take_over",
                "",
                Other("true or false"),
                "false",
                "The controller takes over from a hover, without a bump, in place of starting from ζ.",
            ),
            key(
                "ground_p3",
                "m",
                Number(-1e5, 1e5),
                "(none)",
                "Where a body that comes to it has crashed; without a [ground] to stand on.",
            ),
            key("vehicle", "", Other("table"), "(the paper's)", "What flies."),
            key("controller", "", Other("table"), "(the paper's)", "What steers it."),
            key("path", "", Other("table"), "(the paper's circle)", "What the law \"follow\" follows."),
            key("reference", "", Other("table"), "(the paper's)", "What the law \"track\" tracks."),
            key(
                "initial",
                "",
                Other("table, or \"steady\""),
                "(Fig. 3's)",
                "The state at the start; \"steady\": on the course, as if always there.",
            ),
            key("obstacle", "", Other("table"), "(none)", "Fig. 2's: stops the vehicle."),
            key(
                "cable",
                "",
                Other("table"),
                "(a rod)",
                "What joins UAV and payload, in place of a massless rigid rod; over ground always a cable.",
            ),
            key("ground", "", Other("table"), "(none)", "What payload and UAV can stand on."),
            key("request", "", Other("tables"), "(follow)", "What is asked for, and when."),
            key("environment", "", Other("table"), "(still)", "Forces, air, another payload."),
            key("sensors", "", Other("table"), "(ideal)", "What the controller sees of the state."),
            key(
                "estimator",
                "",
                Other("table"),
                "(none)",
                "Flies on what the filters find from the instruments in `sensors`.",
            ),
            key("actuators", "", Other("table"), "(ideal)", "What becomes of its commands."),
            key("timing", "", Other("table"), "(regular)", "The control loop's clock."),
            key(
                "limits",
                "",
                Other("table"),
                "(by the vehicle)",
                "What the vehicle may be asked for, by `check` and `run`.",
            ),
            key(
                "fence",
                "",
                Other("table"),
                "(none)",
                "Where the path stays and the way to it, in calm, by `check` and `run`.",
            ),
        ],
    },
    Section {
        table: "vehicle",
        about: "What flies; the law is told the same unless `controller.vehicle` says otherwise.",
        least: "",
        keys: MASSES,
    },
    Section {
        table: "controller",
        about: "The law and what it knows.",
        least: "",
        keys: &[
            key(
                "law",
                "",
                Word(&["follow", "track"]),
                "\"follow\"",
                "Path following, or trajectory tracking; \"track\" if there is a reference.",
            ),
            key("rate_hz", "Hz", Number(5.0, 10_000.0), "1000.0", "Control rate."),
            key(
                "look_ahead",
                "",
                Word(&["true", "false"]),
                "true",
                "Evaluate the law for the middle of the coming hold.",
            ),
            key(
                "poles",
                "1/s",
                Other("4 rows of 6, 6, 5, 2 (tracking 6, 6, 6, 2)"),
                "(Fig. 3's)",
                "A row an output; a pair is [re, im].",
            ),
            key(
                "k",
                "1/sʲ",
                Other("4 rows of 6, 6, 5, 2 (tracking 6, 6, 6, 2)"),
                "(by poles)",
                "Gains in place of poles, low order first.",
            ),
            key(
                "k_integral",
                "1/sʲ",
                Other("3 numbers from 0 to what is stable"),
                "[0.0, 0.0, 0.0]",
                "Integral action (15); path following only.",
            ),
            key("zeta", "m/s²⁺ᵏ", Each(4, -1e4, 1e4), "(0, or the steady motion's)", "ζ at the start."),
            key(
                "vehicle",
                "",
                Other("table as `vehicle`"),
                "(what flies)",
                "What the law is told, where it differs.",
            ),
            key("latency_s", "s", Number(0.0, 0.5), "0.0", "Latency that the law knows of."),
            key("rotor_lag_s", "s", Number(0.0, 0.5), "0.0", "Rotor lag that the law knows of."),
            key(
                "rate_loop_s",
                "s",
                Other("3 numbers, each 0 to 5"),
                "(those of `actuators.rate_loop`)",
                "Time constants of the vehicle's rate loop, as the law knows them.",
            ),
            key("observer", "", Other("table"), "(off)", "Disturbance observers."),
            key("limits", "", Other("table"), "(none)", "On what the law commands."),
            key(
                "supervised",
                "",
                Word(&["true", "false"]),
                "(true with a request or parameters)",
                "With a flight's envelope, approach and policy; otherwise the widest envelope, so that the law flies alone.",
            ),
            key(
                "parameters",
                "",
                Other("{ NAME = number, … }, ENV_*, APP_* and POL_*"),
                "{}",
                "Envelope, approach and policy by the controller's parameters, as a board has them.",
            ),
        ],
    },
    Section {
        table: "controller.observer",
        about: "Bandwidths of the disturbance observers; 0 is off.",
        least: "",
        keys: &[
            key("payload", "rad/s", Number(0.0, 100.0), "0.0", "Of the force on the payload."),
            key("along", "rad/s", Number(0.0, 100.0), "0.0", "Of that along the rod, where it is less; 0: the same."),
            key(
                "cable_stiffness",
                "N",
                Number(0.0, 1e8),
                "0.0",
                "EA of the cable as the law knows it, which bounds the bandwidth along it; 0: it does not stretch.",
            ),
            key("rod", "rad/s", Number(0.0, 100.0), "0.0", "Of the force across the rod."),
            key("torque", "rad/s", Number(0.0, 100.0), "0.0", "Of the torque on the UAV."),
        ],
    },
    Section {
        table: "controller.limits",
        about: "Limits of the law's commands.",
        least: "[controller.limits]\nthrust = [0.0, 100.0]\ntorque = [1.0, 1.0, 1.0]\n",
        keys: &[
            key("thrust", "N", Other("[least, most], 0 to 1000000"), "", "Of the thrust."),
            key("torque", "N m", Each(3, 0.0, 1e6), "", "Of the torque about each body axis, either way."),
        ],
    },
    Section {
        table: "path",
        about: "A closed curve: `kind` is \"circle\", \"ellipse\", \"bent\", \"superellipse\", \"tilted\", \"fourier\" or \"implicit\", and these keys are of all of them. Or a \"route\", whose keys stand below.",
        least: "[path]\nkind = \"circle\"\nradius = 5.0\np3 = -10.0\nspeed = 1.0\n",
        keys: &[KIND, SPEED, YAW, CONSTANTS],
    },
    Section {
        table: "path, kind = \"circle\"",
        about: "The paper's horizontal circle about n3 (16).",
        least: "[path]\nkind = \"circle\"\nradius = 5.0\np3 = -10.0\nspeed = 1.0\n",
        keys: &[
            key("radius", "m", Number(0.01, 1e5), "", "d1."),
            key("p3", "m", Number(-1e5, 1e5), "", "d2; negative is above the origin."),
        ],
    },
    Section {
        table: "path, kind = \"ellipse\"",
        about: "(p1/a)² + (p2/b)² = 1 on p3 = c0 + c1 p1; yaw along the tangent if left out.",
        least: "[path]\nkind = \"ellipse\"\na = 5.0\nb = 4.0\nc0 = -10.0\nc1 = 0.0\nspeed = 1.0\n",
        keys: &[A, B, C0, C1],
    },
    Section {
        table: "path, kind = \"bent\"",
        about: "(p1/a)⁴ + (p2/b)⁴ = 1 on p3 = c0 + ½ sin(p1/2); yaw 0.2 p1 if left out.",
        least: "[path]\nkind = \"bent\"\na = 5.0\nb = 4.0\nc0 = -10.0\nspeed = 1.0\n",
        keys: &[
            key("a", "m", Number(0.01, 1e3), "", "Half width along n1."),
            key("b", "m", Number(0.01, 1e3), "", "Half width along n2."),
            C0,
            key("v0", "m/s", Other("-100 to 100"), "(speed)", "With v1 in place of speed: v_d = v0 + v1 p1/a."),
            key("v1", "m/s", Other("-100 to 100"), "(speed)", "With v0 in place of speed."),
        ],
    },
    Section {
        table: "path, kind = \"superellipse\"",
        about: "(p1/a)ⁿ + (p2/b)ⁿ = 1 on p3 = c0 + c1 p1.",
        least: "[path]\nkind = \"superellipse\"\na = 5.0\nb = 4.0\nhalf_exponent = 2\nc0 = -10.0\nspeed = 1.0\n",
        keys: &[A, B, key("half_exponent", "", Whole(1, 10), "", "n/2."), C0, C1],
    },
    Section {
        table: "path, kind = \"tilted\"",
        about: "An ellipse in any plane, right-handed about its normal.",
        least: "[path]\nkind = \"tilted\"\ncenter = [0.0, 0.0, -10.0]\nnormal = [0.0, 0.0, 1.0]\nmajor = [1.0, 0.0, 0.0]\na = 5.0\nb = 4.0\nspeed = 1.0\n",
        keys: &[
            key("center", "m", Each(3, -1e5, 1e5), "", "In N."),
            key("normal", "", Other("3 numbers, any length"), "", "Across the plane."),
            key("major", "", Other("3 numbers, any length"), "", "Direction of the half axis a."),
            key("a", "m", Number(0.01, 1e5), "", "Half axis along `major`."),
            key("b", "m", Number(0.01, 1e5), "", "Half axis across it."),
        ],
    },
    Section {
        table: "path, kind = \"fourier\"",
        about: "c(σ) = center + Σ cos_k cos kσ + sin_k sin kσ, as `hil-sim fit` writes it; up to 16 harmonics.",
        least: "[path]\nkind = \"fourier\"\ncenter = [0.0, 0.0, -10.0]\ncos = [[5.0, 0.0, 0.0]]\nsin = [[0.0, 5.0, 0.0]]\nreference = [0.0, 0.0, 1.0]\nspeed = 1.0\n",
        keys: &[
            key("center", "m", Other("3 numbers, each -100000 to 100000"), "", "In N."),
            key("cos", "m", Other("1 to 16 rows of 3"), "", "A row a harmonic."),
            key("sin", "m", Other("as many rows"), "", "A row a harmonic."),
            key(
                "reference",
                "",
                Other("3 numbers"),
                "",
                "A direction along no tangent, from which normals are counted.",
            ),
        ],
    },
    Section {
        table: "path, kind = \"implicit\"",
        about: "h1 = 0 and h2 = 0 by formulas in x, y, z (m in N, z down): + - * / ^, sqrt exp ln sin cos tanh atan2, pi and constants.",
        least: "[path]\nkind = \"implicit\"\nh1 = \"x^2 + y^2 - 25\"\nh2 = \"z + 10\"\nspeed = 1.0\n",
        keys: &[
            key("h1", "", Other("formula"), "", "First surface."),
            key("h2", "", Other("formula"), "", "Second surface."),
        ],
    },
    Section {
        table: "path, kind = \"route\"",
        about: "Through waypoints, open or closed, crossing itself or not, with straight legs, blended corners and stops.",
        least: "[path]\nkind = \"route\"\npoints = [[0.0, 0.0, -10.0], [40.0, 0.0, -10.0], [40.0, 30.0, -12.0]]\nspeed = 2.0\n",
        keys: &[
            KIND,
            key(
                "points",
                "m",
                Other("2 to 100000 points of 3 numbers, each -100000 to 100000; closed from 3"),
                "",
                "Waypoints in N, at least 0.05 m apart.",
            ),
            key("closed", "", Word(&["true", "false"]), "false", "The last waypoint leads back to the first."),
            key(
                "corner_m",
                "m",
                Other("0.02 to 1000, \"smooth\", or a list of these, one each"),
                "2.0",
                "How far from a waypoint its corner's blend begins, at most half of either leg. Smooth: the curve passes through it, by itself or among evenly spaced others.",
            ),
            key(
                "speed",
                "m/s",
                Other("0.05 to 100, or a list, one each"),
                "",
                "Of the leg that begins there; less in bends and before stops.",
            ),
            key(
                "yaw",
                "rad",
                Other("-1000 to 1000, \"tangent\", a list of these, one each, or { x, y }"),
                "0.0",
                "ψ_d, changing evenly from waypoint to waypoint; with x and y the nose points to a vertical line.",
            ),
            key(
                "stops",
                "",
                Other("list of { index, dwell_s }"),
                "[]",
                "Waypoints, counted from 0, at which the payload rests for so long; without dwell_s until it is told to go on. An open route ends at rest.",
            ),
            key("acceleration", "m/s²", Number(0.05, 20.0), "1.0", "Along the route and across it."),
            key(
                "end",
                "",
                Other("\"hover\", \"land\", { back = times }, { again = times }"),
                "\"hover\"",
                "What is done after the last waypoint: stay there, land there, fly the way back and forth, or the same again.",
            ),
        ],
    },
    Section {
        table: "reference",
        about: "Section V's circle in time, for the law \"track\": (r sin Ωt, r cos Ωt, p3).",
        least: "[reference]\nkind = \"circle\"\nradius = 5.0\np3 = -10.0\nrate = 0.001\n",
        keys: &[
            key("kind", "", Word(&["circle"]), "", "Which course."),
            key("radius", "m", Number(0.01, 1e5), "", "r."),
            key("p3", "m", Number(-1e5, 1e5), "", "Negative is above the origin."),
            key("rate", "rad/s", Other("up to 1000 m/s along the circle"), "", "Ω, positive from n2 to n1."),
        ],
    },
    Section {
        table: "initial",
        about: "The state at the start, in the paper's coordinates.",
        least: "",
        keys: &[
            key("position", "m", Each(3, -1e5, 1e5), "[0.0, 9.0, -10.0]", "Of the payload in N."),
            key("alpha", "rad", Number(-std::f64::consts::PI, std::f64::consts::PI), "0.0", "Rod, about n1."),
            key("beta", "rad", Number(-1.57, 1.57), "0.0", "Rod, about n2."),
            key("phi", "rad", Number(-1.57, 1.57), "0.0", "Roll."),
            key("theta", "rad", Number(-std::f64::consts::PI, std::f64::consts::PI), "0.0", "Pitch."),
            key("psi", "rad", Number(-std::f64::consts::PI, std::f64::consts::PI), "0.0", "Yaw."),
            key("velocity", "m/s", Each(3, -1e3, 1e3), "[0.0, 0.0, 0.0]", "Of the payload in N."),
            key("alpha_dot", "rad/s", Number(-1e3, 1e3), "0.0", "Rate of alpha."),
            key("beta_dot", "rad/s", Number(-1e3, 1e3), "0.0", "Rate of beta."),
            key("body_rate", "rad/s", Each(3, -1e3, 1e3), "(by euler_rates)", "ω in body axes."),
            key(
                "euler_rates",
                "rad/s",
                Each(3, -1e3, 1e3),
                "[0.0, 0.0, 0.0]",
                "Rates of phi, theta, psi, in place of body_rate.",
            ),
            key(
                "uav_position",
                "m",
                Other("3 numbers, each -100000 to 100000, in the cable's reach"),
                "(by the rod)",
                "Of the UAV in N, on a cable that may be slack.",
            ),
            key("uav_velocity", "m/s", Each(3, -1e3, 1e3), "[0.0, 0.0, 0.0]", "Of the UAV in N, with its position."),
            key(
                "standing",
                "",
                Other("true or false"),
                "false",
                "Both start on the ground, whatever p3 their positions have.",
            ),
        ],
    },
    Section {
        table: "cable",
        about: "A cable that pulls and does not push. `vehicle.rod_length` is its length.",
        least: "[cable]\n",
        keys: &[
            key("hook", "m", Each(3, -10.0, 10.0), "[0.0, 0.0, 0.0]", "r_h, where it hangs, in body axes."),
            key(
                "ea",
                "N",
                Number(1.0, 1e8),
                "(does not stretch)",
                "EA: the force that would double its length; 3 mm of polyamide have 5 kN.",
            ),
            key("damping", "N s/m", Number(0.0, 1e5), "0.0", "Of one that stretches."),
            key(
                "restitution",
                "",
                Number(0.0, 1.0),
                "0.0",
                "Of one that does not: the share of the speed with which its ends come back when it becomes taut.",
            ),
            key(
                "hooked",
                "s",
                Other("{ at_s, for_s }, 0 to 100000 each"),
                "(always)",
                "When it holds the payload: picked up once in reach, and dropped.",
            ),
            key(
                "snagged",
                "s",
                Other("{ at_s, for_s }, 0 to 100000 each"),
                "(never)",
                "When the payload is caught and stays where it then is.",
            ),
        ],
    },
    Section {
        table: "ground",
        about: "A plane: a spring and a damper that do not pull, and Coulomb's friction.",
        least: "[ground]\n",
        keys: &[
            key("p3", "m", Number(-1e5, 1e5), "0.0", "Where it is at p1 = p2 = 0; negative is above the origin."),
            key("slope", "", Each(2, -1.0, 1.0), "[0.0, 0.0]", "By how much its p3 grows along p1 and p2."),
            key(
                "box_height",
                "m",
                Number(-100.0, 100.0),
                "0.0",
                "Of a box on which the payload comes to stand; negative: a pit. The UAV stands beside it.",
            ),
            key("sink", "m", Number(1e-5, 0.1), "0.002", "How far a body sinks in by its own weight."),
            key("damping_ratio", "", Number(0.0, 2.0), "0.5", "Of a body on it."),
            key("friction", "", Number(0.0, 2.0), "0.5", "μ."),
            key("payload_height", "m", Number(0.0, 10.0), "0.05", "From the payload's centre to its foot."),
            key(
                "feet_below",
                "m",
                Number(0.0, 10.0),
                "0.15",
                "From the UAV's centre of mass down to the plane of its four feet.",
            ),
            key("feet_apart", "m", Number(0.0, 10.0), "0.2", "From the middle of that plane to each foot."),
            key(
                "crash_speed",
                "m/s",
                Number(0.0, 100.0),
                "2.0",
                "A UAV that comes to the ground faster has crashed, as has one that tips over on it.",
            ),
        ],
    },
    Section {
        table: "obstacle",
        about: "Sets all velocities and tilts to zero and holds the vehicle; then the law starts again from ζ = 0.",
        least: "[obstacle]\nat_s = 0.0\n",
        keys: &[
            key("at_s", "s", Number(0.0, 10.0), "", "When, up to the flight's length."),
            key("hold_s", "s", Number(0.0, 10.0), "0.0", "How long, up to what is left of the flight."),
        ],
    },
    Section {
        table: "fence",
        about: "Regions for load, UAV and cable, over the whole path before it is flown. A region is { polygon = [[n1, n2], …] } or { center = [n1, n2], radius }, each with up_m = [from, to] above the origin if it does not have all heights.",
        least: "[fence]\n",
        keys: &[
            key("margin_m", "m", Number(0.0, 1e3), "1.0", "What is kept from every edge."),
            key("inside", "m", Other("list of regions"), "[]", "To stay in, each of them."),
            key("outside", "m", Other("list of regions"), "[]", "To keep out of."),
        ],
    },
    Section {
        table: "request",
        about: "What is asked for from a time on, `[[request]]` each; without any, to follow from the start. A vehicle that stands takes off when it is asked to hold, and `hold` before `land` lets the payload come to rest. A flight whose last request is `land` ends once both bodies stand with the rotors off.",
        least: "[[request]]\nat_s = 1.0\ndo = \"hold\"\n",
        keys: &[
            key("at_s", "s", Number(0.0, 10.0), "", "When, from the last request's to the flight's length."),
            key(
                "do",
                "",
                Word(&["off", "idle", "hold", "follow", "land"]),
                "(as before)",
                "What the vehicle is to do.",
            ),
            key(
                "speed_factor",
                "",
                Number(-2.0, 2.0),
                "(as before)",
                "Factor of the path's speed, which changes smoothly: 0 stops, 1 goes on, less than 0 goes back.",
            ),
        ],
    },
    Section {
        table: "limits",
        about: "What a vehicle may be asked for on its path. `check` and `run` refuse a path that asks for more; actuators that give less thrust lower the limit.",
        least: "",
        keys: &[
            key("min_thrust", "N", Other("0 to max_thrust"), "(0.2 of hover)", "Least thrust."),
            key("max_thrust", "N", Number(0.0, 1e6), "(twice hover)", "Largest thrust."),
            key("rod_angle_deg", "°", Number(0.0, 90.0), "45.0", "Angle of the rod from straight down."),
            key("tilt_deg", "°", Number(0.0, 90.0), "45.0", "Angle of the thrust axis from the vertical."),
            key("body_rate", "rad/s", Number(0.0, 1e3), "4.0", "|ω|."),
            key("torque", "N m", Number(0.0, 1e6), "(0.034 m of hover's thrust)", "About each body axis."),
            key(
                "tension",
                "",
                Number(0.0, 1.0),
                "0.2",
                "Least tension of the cable, a part of the payload's weight.",
            ),
        ],
    },
    Section {
        table: "environment",
        about: "Forces and torques that the law does not know of.",
        least: "",
        keys: &[
            key("payload_force", "N", Each(3, -1e3, 1e3), "[0.0, 0.0, 0.0]", "On the payload, in N."),
            key("uav_force", "N", Each(3, -1e3, 1e3), "[0.0, 0.0, 0.0]", "On the UAV, in N."),
            key("torque", "N m", Each(3, -100.0, 100.0), "[0.0, 0.0, 0.0]", "On the UAV, in body axes."),
            key("air", "", Other("table"), "(none)", "Air that drags at both bodies."),
            key("payload_step", "", Other("table"), "(none)", "A payload picked up or dropped in flight."),
        ],
    },
    Section {
        table: "environment.air",
        about: "Wind, gusts and drag.",
        least: "[environment.air]\n",
        keys: &[
            key(
                "wind",
                "m/s",
                Each(3, -50.0, 50.0),
                "[0.0, 0.0, 0.0]",
                "Mean velocity of the air in N: where it goes.",
            ),
            key("gusts", "", Other("table"), "(none)", "Dryden turbulence about the mean."),
            key("density", "kg/m³", Number(0.0, 2.0), "1.225", "ρ."),
            key("payload_drag_area", "m²", Number(0.0, 10.0), "0.01", "C_d A of the payload."),
            key("uav_drag_area", "m²", Number(0.0, 10.0), "0.05", "C_d A of the UAV."),
        ],
    },
    Section {
        table: "environment.air.gusts",
        about: "MIL-F-8785C's low-altitude Dryden model.",
        least: "[environment.air.gusts]\nspeed_at_6m = 5.0\n",
        keys: &[
            key("speed_at_6m", "m/s", Number(0.0, 50.0), "", "Mean wind 6 m above ground: the intensity."),
            key("height", "m", Number(3.0, 300.0), "10.0", "Height above ground."),
        ],
    },
    Section {
        table: "environment.payload_step",
        about: "Another payload from a time on.",
        least: "[environment.payload_step]\nat_s = 5.0\nmass = 1.5\n",
        keys: &[
            key("at_s", "s", Number(0.0, 1e5), "", "When."),
            key("mass", "kg", Number(1e-3, 1e3), "", "Mass from then on; dropped, that of the hook."),
            key("drag_area", "m²", Number(0.0, 10.0), "(as before)", "C_d A from then on."),
        ],
    },
    Section {
        table: "sensors",
        about: "What the controller is given. A state can be made unusable by a channel's `nan`.",
        least: "",
        keys: &[
            key(
                "uav",
                "",
                Word(&["true", "false"]),
                "(true with a cable or ground)",
                "The UAV's own position and velocity beside the state: what hold, take-off and landing fly by, and what tells a slack cable.",
            ),
            key(
                "accelerometer",
                "",
                Word(&["true", "false"]),
                "(true with a cable or ground)",
                "The UAV's specific force beside the state.",
            ),
            key("position", "", Other("table"), "(ideal)", "Of the payload."),
            key("velocity", "", Other("table"), "(ideal)", "Of the payload."),
            key("rod", "", Other("table"), "(ideal)", "Direction of the line from UAV to payload."),
            key("rod_rate", "", Other("table"), "(ideal)", "Its rate."),
            key("attitude", "", Other("table"), "(ideal)", "Of the UAV."),
            key("body_rate", "", Other("table"), "(ideal)", "Of the UAV."),
            key("uav_position", "", Other("table"), "(ideal)", "Of the UAV's own navigation."),
            key("uav_velocity", "", Other("table"), "(ideal)", "Of the UAV's own navigation."),
            key("specific_force", "", Other("table"), "(ideal)", "Of the accelerometer, in body axes."),
            key("imu", "", Other("table"), "(in flight)", "For an estimator, as what follows."),
            key("gnss", "", Other("table"), "(none)", "Satellite receiver."),
            key("barometer", "", Other("table"), "(none)", "Height by pressure."),
            key("magnetometer", "", Other("table"), "(none)", "Direction of the earth's field."),
            key("esc", "", Other("table"), "(none)", "Speeds of the rotors."),
            key("mocap", "", Other("table"), "(none)", "Motion capture."),
        ],
    },
    Section {
        table: "sensors.position",
        about: "Errors of a channel. The same keys for `sensors.velocity` (m/s), `.rod` (rad), `.rod_rate` (1/s), `.attitude` (rad), `.body_rate` (rad/s), `.uav_position` (m), `.uav_velocity` (m/s) and `.specific_force` (m/s²).",
        least: "",
        keys: CHANNEL,
    },
    Section {
        table: "sensors.imu",
        about: "An IMU on the UAV. What is left out is its part's, or that of a MEMS IMU in flight.",
        least: "",
        keys: &[
            key(
                "part",
                "",
                Other("a part's name"),
                "(in flight)",
                "A part by its data sheet, at rest: `bmi088`, `icm42688-p`, `mpu6000`.",
            ),
            key("accelerometer_noise", "m/s²/√Hz", Number(0.0, 1.0), "(its part's)", "White noise."),
            key("gyro_noise", "rad/s/√Hz", Number(0.0, 0.1), "(its part's)", "White noise."),
            key(
                "accelerometer_bias",
                "m/s²",
                Number(0.0, 5.0),
                "(its part's)",
                "Standard deviation of the bias at the start.",
            ),
            key(
                "gyro_bias",
                "rad/s",
                Number(0.0, 1.0),
                "(its part's)",
                "Standard deviation of the bias at the start.",
            ),
            key("accelerometer_walk", "m/s²/√s", Number(0.0, 0.1), "(its part's)", "Random walk of the bias."),
            key("gyro_walk", "rad/s/√s", Number(0.0, 0.1), "(its part's)", "Random walk of the bias."),
            key("scale", "", Number(0.0, 0.1), "(its part's)", "Standard deviation of the scale errors."),
            key(
                "misalignment",
                "rad",
                Number(0.0, 0.1),
                "(its part's)",
                "Standard deviation of the axes' misalignment.",
            ),
            key(
                "vibration",
                "m/s²",
                Each(2, 0.0, 200.0),
                "(none)",
                "Amplitudes of the lines at once and twice the rotors' speed.",
            ),
            key("hover_hz", "Hz", Number(5.0, 500.0), "(90)", "Rotor speed at hover."),
            key(
                "sample_hz",
                "Hz",
                Number(100.0, 32_000.0),
                "(2000)",
                "The sensor's own rate: lines above half of it alias.",
            ),
            key("range", "m/s²", Number(10.0, 2000.0), "(its part's)", "Where the accelerometer clips."),
            key("lever", "m", Each(3, -2.0, 2.0), "(none)", "Place from the centre of mass, body axes."),
        ],
    },
    Section {
        table: "sensors.gnss",
        about: "A receiver. What is left out is its part's.",
        least: "",
        keys: &[
            key(
                "part",
                "",
                Word(&["rtk", "plain", "zed-f9p-rtk", "zed-f9p", "neo-m9n"]),
                "\"rtk\"",
                "A receiver and what it solves for, by its data sheet.",
            ),
            key("rate_hz", "Hz", Number(0.1, 50.0), "(its part's)", "Fixes a second."),
            key("delay_s", "s", Number(0.0, 0.3), "(its part's)", "From a fix's time to its coming."),
            key("untold_delay_s", "s", Number(-0.1, 0.1), "0.0", "What the delay is beyond what is told."),
            key("position_noise", "m", Each(2, 0.0, 100.0), "(its part's)", "White noise, horizontal and down."),
            key("velocity_noise", "m/s", Each(2, 0.0, 10.0), "(its part's)", "White noise, horizontal and down."),
            key("slow", "m", Each(2, 0.0, 100.0), "(its part's)", "Slow error, horizontal and down."),
            key("slow_time_s", "s", Number(1.0, 1e4), "(its part's)", "Its time constant."),
            key("drop_out", "", Other("{ at_s, for_s }"), "(none)", "A time without fixes."),
            key(
                "float",
                "",
                Other("{ at_s, for_s }"),
                "(none)",
                "A time with a float solution: errors and stated accuracy thirty times as large.",
            ),
            key(
                "lever",
                "m",
                Each(3, -2.0, 2.0),
                "[0.0, 0.0, 0.0]",
                "The antenna from the centre of mass, body axes.",
            ),
        ],
    },
    Section {
        table: "sensors.barometer",
        about: "A barometer as a height.",
        least: "[sensors.barometer]\n",
        keys: &[
            key("rate_hz", "Hz", Number(1.0, 200.0), "25.0", "Readings a second."),
            key("noise", "m", Number(0.0, 100.0), "0.1", "White noise."),
            key("offset", "m", Number(0.0, 1000.0), "5.0", "Standard deviation of the constant error."),
            key("slow", "m", Number(0.0, 100.0), "0.66", "Standard deviation of the slow error."),
            key("slow_time_s", "s", Number(1.0, 1e4), "120.0", "Its time constant."),
        ],
    },
    Section {
        table: "sensors.magnetometer",
        about: "A magnetometer.",
        least: "[sensors.magnetometer]\n",
        keys: &[
            key("rate_hz", "Hz", Number(1.0, 200.0), "20.0", "Readings a second."),
            key("noise", "", Number(0.0, 1.0), "0.01", "White noise, as a share of the field."),
            key(
                "hard_iron",
                "",
                Number(0.0, 1.0),
                "0.02",
                "Standard deviation of the constant error of an axis, likewise.",
            ),
            key("inclination", "rad", Number(-1.5, 1.5), "1.1", "Of the field, down."),
            key("declination", "rad", Number(-3.15, 3.15), "0.0", "Of the field, from n1 to n2."),
        ],
    },
    Section {
        table: "sensors.esc",
        about: "Rotor speeds by their controllers.",
        least: "[sensors.esc]\n",
        keys: &[key(
            "noise",
            "",
            Number(0.0, 0.5),
            "0.01",
            "Standard deviation of a reading, as a share of the thrust.",
        )],
    },
    Section {
        table: "sensors.mocap",
        about: "A motion capture system.",
        least: "[sensors.mocap]\n",
        keys: &[
            key("rate_hz", "Hz", Number(1.0, 1000.0), "200.0", "Frames a second."),
            key("delay_s", "s", Number(0.0, 0.3), "0.01", "From a frame to its coming."),
            key("noise", "m", Number(1e-5, 10.0), "0.001", "White noise of an axis."),
            key("attitude_noise", "rad", Number(1e-5, 1.0), "(0.2°)", "White noise of an axis."),
            key("load", "", Word(&["true", "false"]), "true", "Whether it sees the load."),
        ],
    },
    Section {
        table: "estimator",
        about: "What the filters are told, where it differs from what is so or from their defaults.",
        least: "[estimator]\n",
        keys: &[
            key("payload_drag_area", "m²", Number(0.0, 10.0), "(the air's)", "C_d A of the payload."),
            key("uav_drag_area", "m²", Number(0.0, 10.0), "(the air's)", "C_d A of the UAV."),
            key("uav_rotor_drag", "N s/m", Number(0.0, 100.0), "0.0", "Linear drag of the UAV."),
            key("noise", "", Number(0.01, 100.0), "1.0", "Every noise figure of both filters times this."),
            key(
                "accelerometer_noise",
                "m/s²/√Hz",
                Number(1e-4, 1.0),
                "0.015",
                "White noise of the accelerometer in flight.",
            ),
            key(
                "residual",
                "m/s²",
                Number(1e-3, 10.0),
                "0.04",
                "Specific force on the payload that drag does not explain.",
            ),
            key(
                "lateral",
                "m/s²",
                Number(1e-3, 10.0),
                "0.05",
                "Error of the thrust model across its axis, over 40 ms.",
            ),
            key("wind", "m/s", Number(0.1, 50.0), "4.0", "Wind."),
            key("offset", "m/s²", Number(1e-4, 10.0), "0.02", "Lateral bias of accelerometer and thrust axis."),
            key(
                "start",
                "",
                Other("{ rod, rate }"),
                "(0.4 rad, 0.8 1/s)",
                "Standard deviations of rod and rate at the start.",
            ),
            key(
                "navigation",
                "",
                Word(&["own", "other"]),
                "\"own\"",
                "Of `hil-sim hil`: the target's own, from IMU and receiver, or another's, by messages.",
            ),
        ],
    },
    Section {
        table: "actuators",
        about: "What becomes of a command.",
        least: "",
        keys: &[
            key("lag_s", "s", Number(0.0, 0.5), "0.0", "Time constant of thrust and torque."),
            key("latency_s", "s", Number(0.0, 0.5), "0.0", "From a sample to its command's effect."),
            key("thrust_scale", "", Number(0.1, 2.0), "1.0", "Part of the commanded thrust that the vehicle gets."),
            key("thrust_range", "N", Other("[least, most], 0 to 100000"), "(none)", "What the rotors can be told."),
            key("max_torque", "N m", Each(3, 0.0, 1e5), "(none)", "Largest torque about each body axis."),
            key("rotors", "", Other("table"), "(ideal)", "Four rotors, each with its limits."),
            key(
                "rate_loop",
                "",
                Other("table"),
                "(none)",
                "The autopilot's own rate loop, to which the law gives thrust and body rates in place of torques.",
            ),
            key(
                "sag",
                "",
                Other("{ max_thrust, during = { at_s, for_s } }"),
                "(none)",
                "A time with less thrust to be had (N, s): a sagging battery.",
            ),
        ],
    },
    Section {
        table: "actuators.rate_loop",
        about: "A loop of body rates between law and rotors, of first order about each axis. Rotor lag below it is its own to make good.",
        least: "[actuators.rate_loop]\n",
        keys: &[
            key("rate_hz", "Hz", Number(50.0, 1e4), "1000.0", "How often it runs."),
            key("time_constant_s", "s", Each(3, 0.005, 5.0), "[0.03, 0.03, 0.03]", "T_i about the body axes."),
        ],
    },
    Section {
        table: "actuators.rotors",
        about: "Four rotors on a square.",
        least: "[actuators.rotors]\nlayout = \"quad-x\"\narm_m = 0.3\ndrag_m = 0.02\nmax_thrust = 15.0\n",
        keys: &[
            key(
                "layout",
                "",
                Word(&["quad-x", "quad-plus"]),
                "",
                "Front right, rear left, front left, rear right; or right, left, front, rear.",
            ),
            key("arm_m", "m", Number(0.01, 10.0), "", "From the centre to a rotor's axis."),
            key("drag_m", "m", Number(1e-3, 1.0), "", "Drag torque per thrust."),
            key("max_thrust", "N", Number(0.01, 1e5), "", "Of one rotor; the least is 0."),
            key(
                "failure",
                "",
                Other("{ rotor = 1 to 4, at_s, effectiveness = 0 to 1 }"),
                "(none)",
                "A rotor that gives that part of its thrust from then on.",
            ),
        ],
    },
    Section {
        table: "timing",
        about: "The control loop's clock.",
        least: "",
        keys: &[
            key(
                "jitter",
                "",
                Number(0.0, 0.9),
                "0.0",
                "Each period is uniform within this part of the nominal one, either way.",
            ),
            key("missed", "", Number(0.0, 0.9), "0.0", "Probability that no state comes in a control period."),
            key("state_every", "", Whole(1, 1000), "1", "Control periods from one state to the next."),
        ],
    },
];

/// The page: a table of keys for each table of a scenario file.
#[must_use]
pub fn page() -> String {
    let mut page = String::from(
        "# Keys of a scenario file\n\nA scenario is a TOML file of one flight. Everything may be left out, and is then the paper's: Fig. 3's flight. A \
         table that is given needs those of its keys that have no default. This page is what `hil-sim keys` prints.\n",
    );
    for Section { table, about, keys, .. } in SECTIONS {
        let heading = if table.is_empty() { "Before all tables".to_owned() } else { format!("`[{table}]`") };
        let _ = write!(
            page,
            "\n## {heading}\n\n{about}\n\n| key | unit | range | default | meaning |\n|---|---|---|---|---|\n"
        );
        for Key { name, unit, values, default, meaning } in *keys {
            let range = match values {
                Number(low, high) => format!("{low} to {high}"),
                Whole(low, high) => format!("{low} to {high}, whole"),
                Each(count, low, high) => format!("{count} numbers, each {low} to {high}"),
                Word(words) => words.join(", "),
                Other(text) => (*text).to_owned(),
            };
            let default = match *default {
                "" => "must be given".to_owned(),
                text if text.starts_with('(') => text.trim_matches(['(', ')']).to_owned(),
                text => format!("`{text}`"),
            };
            let _ = writeln!(page, "| `{name}` | {unit} | {range} | {default} | {meaning} |");
        }
    }
    page
}
