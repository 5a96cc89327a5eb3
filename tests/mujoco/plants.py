"""The simulator's plant, behind `hil-sim plant`, and the same model built in MuJoCo: one face for both.

Frames are the simulator's: N with its third axis down, so that MuJoCo's gravity is +9.81 along z and its ground is turned over.
"""

import json
import subprocess
from dataclasses import dataclass, field

import mujoco
import numpy as np

GRAVITY = 9.81


@dataclass
class Case:
    """What is flown, and from where. SI units; positions in N, `hook` in body axes."""

    payload_mass: float = 0.5
    uav_mass: float = 2.5
    length: float = 2.0
    inertia: tuple = (0.03, 0.03, 0.05)
    hook: tuple = (0.0, 0.0, 0.0)
    link: str = "cable"  # "rod", "cable" (does not stretch) or "elastic"
    ea: float = 0.0
    damping: float = 0.0
    ground: bool = False
    friction: float = 0.5
    position: tuple = (0.0, 0.0, -10.0)
    uav_position: tuple = (0.0, 0.0, -12.0)
    velocity: tuple = (0.0, 0.0, 0.0)
    uav_velocity: tuple = (0.0, 0.0, 0.0)
    period: float = 0.002
    # Of MuJoCo's integration, s.
    step: float = 1e-4
    # As a scenario's [ground].
    sink: float = 0.002
    damping_ratio: float = 0.5
    payload_height: float = 0.05
    feet_below: float = 0.15
    feet_apart: float = 0.2
    # What is asked of the controller: (from when, s, what). From the ground, rotors off, or from a hover.
    mission: tuple = ()
    standing: bool = False


# What a state is made of, in its order.
STATE = ("position", "velocity", "uav_position", "uav_velocity", "attitude", "body_rate")


@dataclass
class State:
    """What both plants answer; `attitude` is R, body to N, `body_rate` in body axes."""

    position: np.ndarray
    velocity: np.ndarray
    uav_position: np.ndarray
    uav_velocity: np.ndarray
    attitude: np.ndarray
    body_rate: np.ndarray
    on_ground: tuple = field(default=(False, False))


def written(folder, case):
    """The case as a scenario: what flies, from where, and what is asked of the controller."""
    vector = lambda v: "[" + ", ".join(repr(float(x)) for x in v) + "]"
    cable = f"hook = {vector(case.hook)}\n"
    if case.link == "elastic":
        cable += f"ea = {float(case.ea)}\ndamping = {float(case.damping)}\n"
    ground = ""
    if case.ground:
        ground = f"""[ground]
sink = {case.sink}
damping_ratio = {case.damping_ratio}
friction = {case.friction}
payload_height = {case.payload_height}
feet_below = {case.feet_below}
feet_apart = {case.feet_apart}
"""
    requests = "".join(f'[[request]]\nat_s = {float(at_s)}\ndo = "{do}"\n' for at_s, do in case.mission)
    weight = (case.payload_mass + case.uav_mass) * GRAVITY
    size = (case.payload_mass / 0.5) ** (1 / 3)
    poles = [1.0 / (1.0 + case.length / 5.0) ** 0.5 * -k for k in range(1, 7)]
    scenario = folder / "case.toml"
    scenario.write_text(
        f"""duration_s = 1000.0
vehicle = {{ payload_mass = {case.payload_mass}, uav_mass = {case.uav_mass}, rod_length = {case.length}, inertia = {vector(case.inertia)} }}
path = {{ kind = "circle", radius = 4.0, p3 = -5.0, speed = 1.0 }}
initial = {{ position = {vector(case.position)}, uav_position = {vector(case.uav_position)}, velocity = {vector(case.velocity)}, uav_velocity = {vector(case.uav_velocity)}, standing = {str(case.standing).lower()} }}
[controller]
law = "follow"
rate_hz = {1.0 / case.period}
poles = [{vector(poles)}, {vector(poles)}, {vector(poles[:5])}, [-2.0, -3.0]]
observer = {{ payload = 4.0, rod = 4.0, torque = 4.0 }}
limits = {{ thrust = [{0.05 * weight}, {2.2 * weight}], torque = {vector([0.1 * size * weight] * 3)} }}
parameters = {{ POL_ASIDE = {0.4 * size} }}
[cable]
{cable}{ground}{requests}"""
    )
    return scenario


class Lines:
    """A command of the project that answers lines."""

    def __init__(self, program, command, folder, case):
        self.process = subprocess.Popen(
            [program, command, str(written(folder, case))], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )

    def read(self):
        line = self.process.stdout.readline()
        answer = json.loads(line) if line else {"error": "it has ended"}
        assert "error" not in answer, answer
        return answer

    def ask(self, **line):
        self.process.stdin.write(json.dumps(line) + "\n")
        self.process.stdin.flush()
        return self.read()

    def close(self):
        self.process.stdin.close()
        assert self.process.wait() == 0


class Pilot(Lines):
    """The controller of the project."""

    def __init__(self, program, folder, case):
        super().__init__(program, "pilot", folder, case)
        self.mode = None

    def __call__(self, t, state):
        vectors = {name: getattr(state, name).tolist() for name in STATE}
        answer = self.ask(**vectors)
        self.mode = answer["mode"]
        return answer["thrust"], answer["torque"]


class Simulator(Lines):
    """The plant of the project."""

    def __init__(self, program, folder, case):
        super().__init__(program, "plant", folder, case)
        self.state = self._state(self.read())

    def _state(self, answer):
        return State(*(np.array(answer[name]) for name in STATE), tuple(answer["on_ground"]))

    def step(self, thrust, torque):
        self.state = self._state(self.ask(thrust=float(thrust), torque=[float(x) for x in torque]))
        return self.state


# Of a limit or a contact: an impedance that is constant and near one, so that little of its force is left to softness.
FIRM = '"0.9999 0.9999 0.001 0.5 2"'


class MuJoCo:
    """The same model in a physics engine that is not ours."""

    def __init__(self, case):
        self.case, self.substeps = case, round(case.period / case.step)
        vector = lambda v: " ".join(repr(float(x)) for x in v)
        # A point: its own inertia turns nothing that matters (1e-7 of m L²).
        point = f'<inertial pos="0 0 0" mass="{case.payload_mass}" diaginertia="1e-7 1e-7 1e-7"/>'
        apart = np.subtract(case.position, case.uav_position)
        if case.link == "rod":
            # A ball joint in the hook and the payload at the rod's end: exact, without a soft constraint.
            rod = np.subtract(apart, case.hook)
            inside = f'<body name="payload" pos="{vector(case.hook)}"><joint name="swing" type="ball"/>'
            inside += f'<inertial pos="{vector(rod)}" mass="{case.payload_mass}" diaginertia="1e-7 1e-7 1e-7"/>'
            inside += f'<site name="payload" pos="{vector(rod)}"/></body>'
            outside, tendon = "", ""
        else:
            inside = ""
            # The ground's spring and damper, per mass of what stands on it, in MuJoCo's direct format;
            # gravity has no part in it, so that a body rests at the surface where it sinks in by
            # `sink` in the simulator.
            soft = f'"{-GRAVITY / case.sink} {-2 * case.damping_ratio * (GRAVITY / case.sink) ** 0.5}"'
            ball = f'<geom type="sphere" size="{case.payload_height}" mass="0" solref={soft} solimp={FIRM}/>' if case.ground else ""
            outside = f'<body name="payload" pos="{vector(case.position)}"><joint name="payload" type="slide" axis="1 0 0"/>'
            outside += f'<joint type="slide" axis="0 1 0"/><joint type="slide" axis="0 0 1"/>{point}{ball}<site name="payload"/></body>'
            if case.link == "elastic":
                # Two values of `springlength` are a dead band: the spring pulls beyond the upper one,
                # and nothing pushes below (XML reference, tendon/spatial). Its damping acts
                # everywhere, so these cases stay taut.
                pull = f'springlength="0 {case.length}" stiffness="{case.ea / case.length}" damping="{case.damping}"'
            else:
                # A limit with the least time constant that MuJoCo takes, two steps. It is a spring
                # with a damper that does not push: critically damped it throws an impact back with
                # exp(-2) of its speed, at five times that with a hundredth.
                pull = f'limited="true" range="0 {case.length}" solreflimit="{2 * case.step} 5" solimplimit={FIRM}'
            tendon = f'<tendon><spatial name="cable" {pull}><site site="hook"/><site site="payload"/></spatial></tendon>'
        feet, plane = "", ""
        if case.ground:
            side = case.feet_apart * 0.5**0.5
            for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
                place = vector((side * x, side * y, case.feet_below - 0.01))
                feet += f'<geom type="sphere" size="0.01" pos="{place}" mass="0" contype="1" conaffinity="0" solref={soft} solimp={FIRM}/>'
            plane = '<geom name="ground" type="plane" size="100 100 1" euler="180 0 0" contype="0" conaffinity="1"/>'
        # Slide friction alone: a point on its foot neither rolls nor spins.
        model = mujoco.MjModel.from_xml_string(
            f"""<mujoco>
  <option timestep="{case.step}" gravity="0 0 {GRAVITY}" integrator="{'RK4' if case.link == 'rod' else 'implicitfast'}" cone="elliptic" impratio="10"/>
  <default><geom friction="{case.friction} 0 0" condim="3" contype="1" conaffinity="0"/></default>
  <worldbody>{plane}
    <body name="uav" pos="{vector(case.uav_position)}"><freejoint name="uav"/>
      <inertial pos="0 0 0" mass="{case.uav_mass}" diaginertia="{vector(case.inertia)}"/>
      <site name="centre"/><site name="hook" pos="{vector(case.hook)}"/>{feet}{inside}
    </body>{outside}
  </worldbody>
  {tendon}
  <actuator><motor site="centre" gear="0 0 -1 0 0 0"/><motor site="centre" gear="0 0 0 1 0 0"/>
    <motor site="centre" gear="0 0 0 0 1 0"/><motor site="centre" gear="0 0 0 0 0 1"/></actuator>
</mujoco>"""
        )
        self.model, self.data = model, mujoco.MjData(model)
        self.data.qvel[:3] = case.uav_velocity
        if case.link == "rod":
            # The rod's rate, in its own axes, that are N's at the start.
            apart_velocity = np.subtract(case.velocity, case.uav_velocity)
            self.data.qvel[6:9] = np.cross(rod, apart_velocity) / np.dot(rod, rod)
        else:
            self.data.qvel[6:9] = case.velocity
        mujoco.mj_forward(model, self.data)
        self.payload, self.uav = (mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name) for name in ("payload", "centre"))
        self.ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) for name in ("payload", "uav")]
        self.state = self._read()

    def _velocity(self, site):
        velocity = np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_SITE, site, velocity, 0)
        return velocity[3:]

    def _read(self):
        data = self.data
        touching = {int(self.model.geom_bodyid[geom]) for contact in data.contact for geom in contact.geom}
        return State(
            data.site_xpos[self.payload].copy(),
            self._velocity(self.payload),
            data.site_xpos[self.uav].copy(),
            self._velocity(self.uav),
            data.site_xmat[self.uav].reshape(3, 3).copy(),
            data.qvel[3:6].copy(),
            tuple(body in touching for body in self.ids),
        )

    def step(self, thrust, torque):
        self.data.ctrl[:] = [thrust, *torque]
        mujoco.mj_step(self.model, self.data, self.substeps)
        # Positions and velocities of one instant.
        mujoco.mj_forward(self.model, self.data)
        self.state = self._read()
        return self.state

    def close(self):
        pass
