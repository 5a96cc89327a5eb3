"""The law in MuJoCo from ground to ground, its payload on a tendon that pulls and never pushes.

    python mujoco_cable.py

UAV and payload stand side by side on a slack cable. The vehicle takes off, lifts the payload, joins a circle, follows it, sets the
payload down and lands beside it. MuJoCo's world is north, west, up and its bodies forward, left, up: `frames="nwu"` says so, and no
sign is turned by hand but the accelerometer's, which `Rig.step` takes in the body's own axes forward, right, down.
"""

import mujoco
import numpy as np

import slung

PERIOD, STEP = 0.002, 0.0005
LENGTH, HEIGHT = 2.0, 5.0
SCENE = f"""
<mujoco>
  <option timestep="{STEP}" gravity="0 0 -9.81" integrator="implicitfast" cone="elliptic" impratio="10"/>
  <default><geom contype="1" conaffinity="0" condim="3" friction="0.5" solref="0.01 1"/></default>
  <worldbody>
    <geom type="plane" size="50 50 1" contype="0" conaffinity="1"/>
    <body name="uav" pos="0 0 0.15">
      <freejoint/>
      <inertial pos="0 0 0" mass="2.5" diaginertia="0.03 0.03 0.05"/>
      <site name="hook"/>
      <geom type="sphere" size="0.01" mass="0" pos="0.15 0.15 -0.14"/>
      <geom type="sphere" size="0.01" mass="0" pos="-0.15 0.15 -0.14"/>
      <geom type="sphere" size="0.01" mass="0" pos="-0.15 -0.15 -0.14"/>
      <geom type="sphere" size="0.01" mass="0" pos="0.15 -0.15 -0.14"/>
    </body>
    <body name="payload" pos="0.6 0 0.05">
      <freejoint/>
      <inertial pos="0 0 0" mass="0.5" diaginertia="5e-4 5e-4 5e-4"/>
      <geom type="sphere" size="0.05" mass="0" condim="6" friction="0.5 0.01 0.01"/>
      <site name="payload"/>
    </body>
  </worldbody>
  <tendon>
    <spatial limited="true" range="0 {LENGTH}" solreflimit="{2 * STEP} 5" solimplimit="0.9999 0.9999 0.001 0.5 2">
      <site site="hook"/>
      <site site="payload"/>
    </spatial>
  </tendon>
  <actuator>
    <motor site="hook" gear="0 0 1 0 0 0"/>
    <motor site="hook" gear="0 0 0 1 0 0"/>
    <motor site="hook" gear="0 0 0 0 1 0"/>
    <motor site="hook" gear="0 0 0 0 0 1"/>
  </actuator>
  <sensor><accelerometer site="hook"/></sensor>
</mujoco>
"""


class Scene:
    """A vehicle and its payload in MuJoCo."""

    def __init__(self):
        self.model = mujoco.MjModel.from_xml_string(SCENE)
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)

    def measured(self):
        """What a motion-capture hall and an accelerometer tell: load and rod, UAV, specific force."""
        # Of a free joint: position and quaternion (w, x, y, z), velocity in the world and rate in the body.
        place, motion = self.data.qpos, self.data.qvel
        uav = slung.Uav(place[0:3], motion[0:3], place[3:7], motion[3:6], frames="nwu")
        state = uav.with_load(place[7:10], motion[6:9], frames="nwu")
        return state, uav, self.data.sensordata * (1, -1, -1)

    def advance(self, output):
        output = output.in_frames("nwu")
        self.data.ctrl[:] = [output.thrust, *output.torque]
        mujoco.mj_step(self.model, self.data, round(PERIOD / STEP))

    @property
    def slack(self):
        """How much farther the payload could be from the hook, m."""
        return LENGTH - self.data.ten_length[0]


def main():
    path = slung.Path(kind="circle", radius=3.0, p3=-HEIGHT, speed=1.0)
    rig = slung.Rig(slung.Parameters(CTL_PERIOD=PERIOD, OBS_W_LOAD=4.0, OBS_W_ROD=4.0, OBS_W_TAU=4.0), path)
    scene = Scene()
    worst, mode, seen = 0.0, None, []
    for step in range(round(90.0 / PERIOD)):
        t = step * PERIOD
        state, uav, force = scene.measured()
        request = "idle" if t < 1.0 else "follow" if t < 50.0 else "land"
        output = rig.step(state, request, uav=uav, specific_force=force)
        if output.mode != mode:
            mode = output.mode
            seen.append(mode)
            print(f"{t:6.2f} s  {mode:9}  UAV {-uav.position[2]:5.2f} m up, payload {-state.position[2]:5.2f} m, slack {scene.slack:5.2f} m")
        if 45.0 <= t < 50.0:
            worst = max(worst, path.distance(state.position))
        if t > 50.0 and mode == "off":
            break
        scene.advance(output)
    print(f"farthest from the path in the last 5 s of following: {1e3 * worst:.2f} mm")
    assert seen == ["idle", "take_off", "hold", "join", "follow", "land", "off"], seen
    # A cable of MuJoCo's stretches by some micrometres; the law's slowest pole of -1 leaves less than that after 20 s.
    assert worst < 1e-3
    # Side by side again, and at rest.
    assert scene.slack > 0.5 and np.abs(scene.data.qvel[:3]).max() < 0.05


if __name__ == "__main__":
    main()
