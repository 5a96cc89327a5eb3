"""What is behind the package, in Rust."""

from collections.abc import Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, final

from typing_extensions import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Vector = NDArray[np.float64]
_Frames = Literal["ned", "enu", "nwu"]
_Arithmetic = Literal["f32", "f64"]
_Request = Literal["off", "idle", "follow", "hold", "land"]
_Mode = Literal["off", "idle", "take_off", "join", "follow", "hold", "land", "fault"]

class Refused(ValueError):
    """A value that is refused. Its message says all of what follows."""

    field: str
    """What it was given for, as a parameter's name or a key's path; empty where it is several."""
    value: float | None
    """The value, where it is one number."""
    range: tuple[float, float] | None
    """What it may be, where that is one range."""

@final
class Entry:
    """What a parameter is."""

    name: str
    unit: str
    default: float
    min: float
    max: float
    text: str

@final
class Parameters:
    """The named numbers that a controller is made of: those of boards and of C. A mapping; an unknown name is a KeyError."""

    def __new__(cls, **values: float) -> Self:
        """All at their defaults, which are the paper's vehicle on the paper's circle, but for `values`."""
    def __getitem__(self, name: str, /) -> float: ...
    def __setitem__(self, name: str, value: float, /) -> None: ...
    def __contains__(self, name: str, /) -> bool: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def keys(self) -> list[str]: ...
    def items(self) -> list[tuple[str, float]]: ...
    def copy(self) -> Parameters: ...
    @staticmethod
    def entry(name: str) -> Entry:
        """Unit, default, range and meaning of a parameter."""

@final
class State:
    """What a law is stepped on: payload, rod and UAV. Any numbers are taken; a step on bad ones says so in its fault."""

    def __new__(
        cls,
        position: ArrayLike,
        velocity: ArrayLike = ...,
        rod: ArrayLike = ...,
        rod_rate: ArrayLike = ...,
        attitude: ArrayLike = ...,
        body_rate: ArrayLike = ...,
    ) -> Self:
        """Of the payload at `position`, at rest below a level UAV where the others are left out. `attitude` is R, body to N, or the
        unit quaternion (w, x, y, z) of it."""
    @staticmethod
    def from_paper(x: ArrayLike) -> State:
        """Of the paper's 16 coordinates (p, alpha, beta, phi, theta, psi, v, rates of alpha and beta, omega)."""
    def to_paper(self) -> _Vector: ...
    def check(self) -> None:
        """Raises `Refused` if a law can't be trusted with it."""
    @property
    def position(self) -> _Vector:
        """Of the payload in N, m."""
    @property
    def velocity(self) -> _Vector:
        """Of the payload in N, m/s."""
    @property
    def rod(self) -> _Vector:
        """Unit vector from the UAV to the payload, in N."""
    @property
    def rod_rate(self) -> _Vector:
        """1/s, in N."""
    @property
    def attitude(self) -> NDArray[np.float64]:
        """R, body to N, by rows."""
    @property
    def body_rate(self) -> _Vector:
        """rad/s, in body axes."""

@final
class Uav:
    """The UAV as its own navigation has it; with a load, the state of a law. `frames` are the axes that the numbers are given in: north,
    east, down with a body forward, right, down (`ned`), or east, north, up (`enu`) or north, west, up (`nwu`) with a body forward, left,
    up. What is read is in `ned`."""

    def __new__(
        cls,
        position: ArrayLike,
        velocity: ArrayLike = ...,
        attitude: ArrayLike = ...,
        body_rate: ArrayLike = ...,
        frames: _Frames = "ned",
    ) -> Self: ...
    def with_load(self, position: ArrayLike, velocity: ArrayLike, frames: _Frames = "ned") -> State:
        """With the load there, as motion capture has it."""
    def with_cable(
        self, length: float, direction: ArrayLike, rate: ArrayLike = ..., hook: ArrayLike = ..., frames: _Frames = "ned"
    ) -> State:
        """With the load on a taut cable of `length` (m) from `hook` (m, in the body) along the unit vector `direction`, which turns at
        `rate` (1/s)."""
    @property
    def position(self) -> _Vector: ...
    @property
    def velocity(self) -> _Vector: ...
    @property
    def attitude(self) -> NDArray[np.float64]: ...
    @property
    def body_rate(self) -> _Vector: ...

@final
class Path:
    """A curve with a speed and a yaw along it."""

    def __new__(cls, **keys: Any) -> Self:
        """Of the keys of a scenario's `[path]`: `kind`, the kind's own numbers, `speed` and `yaw`."""
    @property
    def keys(self) -> dict[str, Any]: ...
    def distance(self, position: ArrayLike) -> float:
        """Of a point of N from the curve, m; NaN where no curve is found."""
    def outline(self, points: int = 256) -> NDArray[np.float64]:
        """So many points of the curve and the first again, m; none of a curve that does not close."""
    def check(self, parameters: Parameters | None = None) -> str:
        """What a lap asks of the vehicle, and how fast it can be flown. Raises `Refused` where there is none."""

@final
class Output:
    """What a step answers."""

    @property
    def thrust(self) -> float:
        """Along -b3, N."""
    @property
    def torque(self) -> _Vector:
        """N m, in body axes."""
    @property
    def mode(self) -> _Mode: ...
    @property
    def fault(self) -> str | None:
        """Why the vehicle does not do what was asked: the last fault since the request changed."""
    @property
    def warning(self) -> str | None:
        """A margin past its warning."""
    @property
    def limited(self) -> bool:
        """The law asked for more than limits and rotors give."""
    @property
    def angular_acceleration(self) -> _Vector:
        """What the torque gives with what was found to disturb, rad/s^2."""
    @property
    def body_rate_setpoint(self) -> _Vector:
        """For an autopilot's own rate loop, with its time constants in `INN_T_1` to `INN_T_3`; rad/s."""
    @property
    def thrust_normalized(self) -> float:
        """A share of all rotors' largest force (`ROT_*`)."""
    @property
    def torque_normalized(self) -> _Vector:
        """Shares of what all rotors could give about each axis."""
    @property
    def rotors(self) -> _Vector:
        """Speeds as shares of the largest: front right, rear left, front left, rear right."""
    def in_frames(self, frames: _Frames) -> Output:
        """The same with the body's vectors in other axes."""

@final
class Rig:
    """The supervised law: it answers every state with a command that is finite and within the limits, and says why."""

    def __new__(
        cls, parameters: Parameters | None = None, path: Path | None = None, *, arithmetic: _Arithmetic = "f32"
    ) -> Self:
        """Rotors off. Without a `path` it is the one of `PATH_*`. `f32` is a board's arithmetic, bit by bit."""
    def take_over(self, state: State, thrust: float, torque: ArrayLike = ...) -> None:
        """From whatever has applied this thrust and torque to the flying vehicle until now, without a bump: mode hold."""
    def start(self, state: State, zeta: ArrayLike = ...) -> None:
        """On the path, from a stated zeta (0 is hover): mode follow, without an approach."""
    def step(
        self,
        state: State | None,
        request: _Request = "follow",
        *,
        uav: Uav | None = None,
        specific_force: ArrayLike | None = None,
        phase: float = 0.0,
    ) -> Output:
        """One control period (`CTL_PERIOD`); None is no state this time. With `uav`, the UAV's own navigation, hold and landing fly
        that, and a vehicle on the ground takes off from a slack cable; `specific_force` is its accelerometer's, m/s^2 in body axes.
        `phase` is where the tracking law's reference is, rad."""
    def set_speed_factor(self, factor: float) -> None:
        """Flies the path at `factor` times its speed from now on, smoothly: 0 rests where it is, 1 goes on, less than 0 goes back; -2 to
        2."""
    def go_on(self) -> bool:
        """From the stop where the payload rests, before its time is over. False: it does not rest, or nothing comes after."""
    @property
    def is_over(self) -> bool:
        """Whether the payload has rested at its route's end for as long as it is to. A route with `end="land"` is landed there by itself, while
        "follow" is asked for."""
    @property
    def mode(self) -> _Mode: ...
    @property
    def zeta(self) -> _Vector:
        """The compensator's state when the next command begins to act."""
    def telemetry(self, state: State) -> dict[str, Any]:
        """What was found of disturbances (`payload_force` and `uav_force`, N in N; `torque`, N m; `payload_mass`, kg), and where the law
        flew, `xi`, `nu`, `u_zeta` and `margins`; `state` is the one that the step was made on."""

@final
class Navigation:
    """A navigation filter for those who have none, in f32: IMU with GNSS or motion capture. Levers are in body axes from the centre of
    mass, m. A measurement that is not used is `Refused`; where one answers True, the filter had gone astray and has begun anew there."""

    def __new__(
        cls,
        parameters: Parameters,
        uav: Uav,
        *,
        deviations: ArrayLike = ...,
        imu: ArrayLike = ...,
        antenna: ArrayLike = ...,
        declination: float = 0.0,
    ) -> Self:
        """Beginning at `uav`, known to these deviations (5 cm and 0.1 m/s if left out). Gravity and the period are the parameters' (1 to 10 ms)."""
    def step(self, body_rate: ArrayLike, specific_force: ArrayLike) -> Uav:
        """A period: the newest body rate (rad/s), and the period's mean specific force (m/s^2, -g e3 at rest), both in body axes."""
    def fix(
        self,
        position: ArrayLike,
        velocity: ArrayLike | None = None,
        *,
        position_accuracy: ArrayLike = ...,
        velocity_accuracy: ArrayLike = ...,
        age: float = 0.0,
    ) -> bool:
        """GNSS: the antenna in N, with its stated accuracies, horizontal and down, and its age (s; at most 150 periods, 0.3 s at
        500 Hz)."""
    def pose(
        self, position: ArrayLike, attitude: ArrayLike, *, accuracy: float, attitude_accuracy: float, age: float = 0.0
    ) -> bool:
        """Motion capture: the centre of mass (accuracy in m) and the attitude (in rad)."""
    def height(self, height: float) -> None:
        """A barometer's, m, up."""
    def heading(self, heading: float) -> None:
        """rad, from n1 towards n2."""
    def magnetic_field(self, field: ArrayLike) -> None:
        """In body axes, of any strength."""
    @property
    def specific_force(self) -> _Vector:
        """The last one less its bias: what `PayloadFilter.step` takes."""
    @property
    def position_deviation(self) -> float: ...
    @property
    def is_blind(self) -> bool:
        """No IMU for more than 50 periods, 0.1 s at 500 Hz."""

@final
class PayloadFilter:
    """Where the load is, in f32, behind any navigation filter: from how the UAV moves and the thrust it was given."""

    def __new__(
        cls,
        parameters: Parameters,
        *,
        hook: ArrayLike = ...,
        imu: ArrayLike = ...,
        uav_drag: ArrayLike = ...,
        payload_drag: ArrayLike = ...,
        noise: float = 1.0,
    ) -> Self:
        """Of the parameters' vehicle and period (1 to 10 ms). Drags are linear (N s/m) and quadratic (N s^2/m^2); `noise` multiplies the
        deviations that the filter takes for true."""
    def step(self, uav: Uav, specific_force: ArrayLike, thrust: float | None) -> Estimate:
        """A period: the UAV at its end, the mean specific force in it less its bias (m/s^2, body axes), and the mean thrust (N)."""
    def observe_direction(self, direction: ArrayLike, deviation: float, age: float = 0.0) -> bool:
        """A camera's: from the hook to the load in N, with its deviation, rad. Whether it was used."""
    def observe_position(self, position: ArrayLike, deviation: float, age: float = 0.0) -> bool:
        """Of the load in N, m. Whether it was used."""
    def observe_pair(self, position: ArrayLike, uav_position: ArrayLike, deviation: float, age: float = 0.0) -> bool:
        """Motion capture's: load and UAV (its centre of mass) in N at one instant, m, with the deviation of each. Whether it was used."""
    def observe_velocity(self, velocity: ArrayLike, deviation: float, age: float = 0.0) -> bool:
        """Of the load in N, m/s. Whether it was used."""

@final
class Estimate:
    """What the payload filter has found."""

    @property
    def state(self) -> State:
        """For `Rig.step` while `validity` is "valid"; None goes there otherwise: on a slack cable there is no rod, and hold and landing fly
        the UAV alone."""
    @property
    def uav(self) -> Uav:
        """For `Rig.step` beside the state. Where navigation jumps by 5 cm to 2 m, both glide to the new place within some seconds; the UAV by
        navigation is there at once, where no cable reaches from it to the load."""
    @property
    def tension(self) -> float:
        """N."""
    @property
    def is_taut(self) -> bool: ...
    @property
    def validity(self) -> Literal["valid", "converging", "inconsistent", "blind", "slack"]:
        """The rod is as good as its deviation says; not known to 0.15 rad, or not to 0.04 rad an axis for 3030 periods (6 s at 500 Hz), or to
        0.15 rad for twice as many, yet; thrust and rod have disagreed for some 500 periods (1 s); inputs have been missing for more than 50
        periods (0.1 s); there is no rod."""
    @property
    def rod_deviation(self) -> float:
        """Standard deviation of the rod's direction, rad."""

@final
class Scenario:
    """A flight, described: by a TOML file, a built-in scenario's name, or a mapping with the same keys."""

    def __new__(cls, source: str | PathLike[str] | Mapping[str, Any] | None = None, /, **keys: Any) -> Self:
        """What is left out is the paper's. `keys` go in the place of the source's, as in `replace`. An array may stand for a list, and
        a `Path` for the table `path`."""
    def replace(self, **keys: Any) -> Scenario:
        """The same with other keys, table by table: `replace(vehicle={"payload_mass": 1.0})` keeps the rest of the vehicle."""
    @staticmethod
    def names() -> list[str]:
        """Of the built-in scenarios."""
    @property
    def keys(self) -> dict[str, Any]: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def duration_s(self) -> float: ...
    @property
    def period_s(self) -> float:
        """Of control, s."""
    def distance(self, position: ArrayLike) -> float:
        """d_C of a point of N, m."""

@final
class Flight:
    """What became of a scenario."""

    @property
    def results(self) -> dict[str, float]:
        """What was measured; what does not apply is not there."""
    @property
    def failure(self) -> str | None:
        """None, or how it ended before its time."""
    @property
    def log(self) -> dict[str, Any]:
        """Time `t_s` and every logged quantity: an array of numbers, NaN where there is none, or a list of words."""
    @property
    def quantities(self) -> dict[str, tuple[str, str]]:
        """Unit and meaning of each quantity of the log."""
    @property
    def times_real_time(self) -> float:
        """Time flown over the CPU time that it took."""
    @property
    def said(self) -> list[str]:
        """Of a replay: how it compares with its log, and what the log lacks, in sentences; else none."""

def replay(
    log: str | PathLike[str],
    scenario: Scenario,
    *,
    from_s: float | None = None,
    to_s: float | None = None,
    full_thrust: float | None = None,
) -> Flight:
    """Puts a flown log (CSV or ULog; the simulator's, or PX4's) through a scenario's estimator and law again: what would they have said?
    The loop is open: the UAV moves as the log has it. The answer's log has `thrust`, `torque1` ... of the law beside `logged_thrust`, `logged_torque1` ....
    `full_thrust`, N, is what all rotors give together, for logs that have thrust as a share of it."""

def run(scenario: Scenario, *, arithmetic: _Arithmetic = "f32") -> Flight:
    """Flies a scenario, its controller in the loop with its world."""

def compare(
    runs: int = 20, *, cases: Sequence[str] | None = None, seed: int = 1, bandwidth: float = ..., jobs: int = 0
) -> dict[str, NDArray[Any]]:
    """Four laws in each case of a world that is not as told: a row a case and law, by columns. `jobs` are threads, 0 for all cores."""

@final
class Campaign:
    """Thousands of flights of the supervised law, each drawn from distributions: a TOML file, a mapping with the same keys, or the
    campaign that comes with the simulator. A flight is a function of campaign, seed and its number alone."""

    def __new__(cls, source: str | PathLike[str] | Mapping[str, Any] | None = None, /) -> Self: ...
    @property
    def title(self) -> str: ...
    @property
    def runs(self) -> int: ...
    def start(self, run: int, *, seed: int = 1) -> State:
        """Where a flight starts."""
    def run(self, runs: int | None = None, *, seed: int = 1, jobs: int = 0) -> dict[str, NDArray[Any]]:
        """Flies all of them, or the first `runs`: a row a flight, by columns. One that resumes or is in shards is `hil-sim campaign`."""
    def replay(self, run: int, *, seed: int = 1) -> tuple[dict[str, Any], dict[str, Any]]:
        """One flight again: its row, and its log with a sample a period."""

@final
class World:
    """Everything outside the controller: the vehicle in a scenario's environment, behind its actuators, seen through its sensors."""

    def __new__(cls, scenario: Scenario, *, seed: int | None = None, run: int = 0, thrust: float | None = None) -> Self:
        """At the scenario's start, `thrust` (N; hover's if left out) having acted for long."""
    def advance(self, thrust: float, torque: ArrayLike = ..., periods: int = 1) -> None:
        """Passes control periods under a thrust (N) and torque (N m, body axes)."""
    def advance_at_rates(self, thrust: float, body_rate: ArrayLike, periods: int = 1) -> None:
        """The same through the scenario's `actuators.rate_loop`: a thrust (N) and body rate (rad/s, body axes)."""
    @property
    def time_s(self) -> float: ...
    @property
    def state(self) -> State:
        """As it is. On a slack cable the rod is the line from UAV to payload."""
    @property
    def uav(self) -> Uav: ...
    def read(self) -> State:
        """The state through the scenario's sensors: once a period."""
    @property
    def pull(self) -> float:
        """The cable's tension, N; of a rod, negative while it pushes."""
    @property
    def on_ground(self) -> tuple[bool, bool]:
        """Payload and UAV."""
    @property
    def energy(self) -> float:
        """J."""
    def instruments(self) -> dict[str, Any]:
        """What the scenario's instruments give at the end of this period, once a period: always `body_rate` and `specific_force`; when
        they come, `fix` and `pose` (with the names of `Navigation`'s arguments), `load`, `height`, `field`, `thrust`."""

@final
class Fleet:
    """Flights of a campaign side by side, whose commands come from outside: what `slung.gym` is made of."""

    def __new__(cls, campaign: Campaign, size: int, periods: int, lost_m: float) -> Self: ...
    @property
    def period_s(self) -> float: ...
    def begin(self, index: int, seed: int, run: int) -> NDArray[np.float32]: ...
    def step(
        self, actions: ArrayLike, skip: ArrayLike | None = None
    ) -> tuple[
        NDArray[np.float32], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.float64]
    ]: ...
    def state(self, index: int) -> State: ...
    def scale(self, index: int) -> tuple[float, tuple[float, float, float]]: ...
