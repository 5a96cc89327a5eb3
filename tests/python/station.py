"""A stock ground station flies the simulated vehicle: pymavlink with MAVLink's own dialect, over UDP, and nothing of this project.

    python station.py --run target/release/hil-sim                   the flight program in the simulator
    python station.py --run target/release/hil-sim --emulate IMAGE   the firmware in QEMU

It connects, reads parameters, modes and the mission, takes off and lands, sends a mission of its own, flies it to its end, and
looks at what a map and instruments are drawn from all the while. Ends with status 0 if all of it goes well.
"""

import argparse
import math
import os
import signal
import subprocess
import tempfile
import time

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil  # noqa: E402

HOME = (53.527, -113.529, 668.0)
METRES_PER_DEGREE = 111297.0
# The load's way: north, east and up of home, m.
MISSION = [(0.0, 0.0, 6.0), (15.0, 0.0, 6.0), (15.0, 10.0, 7.0), (0.0, 10.0, 7.0)]
ROD_M = 2.0
# What wind, gusts and the sensors' noise of the scenario leave a route, the corner's blend beside it.
NEAR_M = 0.5
# The first item is not flown to: its leg is joined from hold, with as much of a swing as is calm, 0.3 1/s of the rod, which takes some 4 s to brake.
JOINED_M = 0.3 * ROD_M * 4.0 / 2.0


class Station:
    """What every ground station does."""

    def __init__(self, port):
        self.link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255)
        self.ml = mavutil.mavlink
        self.texts = []
        self.places = []
        self.beat = 0.0
        assert self.link.wait_heartbeat(timeout=20), "no vehicle"

    def receive(self, kinds, timeout_s, accept=lambda message: True):
        """The next message of these kinds; a heartbeat goes out every second meanwhile."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            if time.monotonic() - self.beat > 1.0:
                self.beat = time.monotonic()
                self.link.mav.heartbeat_send(self.ml.MAV_TYPE_GCS, self.ml.MAV_AUTOPILOT_INVALID, 0, 0, 0)
            message = self.link.recv_match(blocking=True, timeout=0.2)
            if message is None:
                continue
            if message.get_type() == "STATUSTEXT":
                self.texts.append(message.text)
                print("    vehicle:", message.text)
            if message.get_type() == "GLOBAL_POSITION_INT":
                self.places.append((time.monotonic(), message))
            if message.get_type() in kinds and accept(message):
                return message
        raise TimeoutError(f"no {kinds} in {timeout_s} s; {self.texts[-3:]}")

    def command(self, command, *params):
        params = (list(params) + [0.0] * 7)[:7]
        self.link.mav.command_long_send(self.link.target_system, self.link.target_component, command, 0, *params)
        return self.receive(["COMMAND_ACK"], 5.0, lambda ack: ack.command == command).result

    def insist(self, command, *params):
        result = self.command(command, *params)
        assert result == self.ml.MAV_RESULT_ACCEPTED, (command, params, result, self.texts[-3:])

    def parameters(self):
        """All of them; those that got lost are asked for again by their index, as every station does."""
        self.link.param_fetch_all()
        values, count = {}, 1
        while len(values) < count:
            try:
                message = self.receive(["PARAM_VALUE"], 1.0)
            except TimeoutError:
                missing = next(index for index in range(count) if index not in values)
                self.link.mav.param_request_read_send(1, 1, b"", missing)
                continue
            values[message.param_index], count = (message.param_id, message.param_value), message.param_count
        return dict(values.values())

    def modes(self):
        """Every mode's number by its name, as AVAILABLE_MODES announces them."""
        self.insist(self.ml.MAV_CMD_REQUEST_MESSAGE, self.ml.MAVLINK_MSG_ID_AVAILABLE_MODES)
        modes = {}
        while True:
            message = self.receive(["AVAILABLE_MODES"], 5.0)
            modes[message.mode_name] = message.custom_mode
            if len(modes) == message.number_modes:
                return modes

    def until_mode(self, mode, timeout_s):
        self.receive(["HEARTBEAT"], timeout_s, lambda beat: beat.get_srcSystem() == 1 and beat.custom_mode == mode)

    def download(self):
        self.link.mav.mission_request_list_send(1, 1, 0)
        count = self.receive(["MISSION_COUNT"], 5.0).count
        items = []
        for seq in range(count):
            self.link.mav.mission_request_int_send(1, 1, seq, 0)
            items.append(self.receive(["MISSION_ITEM_INT"], 5.0, lambda item, seq=seq: item.seq == seq))
        self.link.mav.mission_ack_send(1, 1, self.ml.MAV_MISSION_ACCEPTED, 0)
        return items

    def upload(self, items):
        self.link.mav.mission_count_send(1, 1, len(items), 0)
        while True:
            answer = self.receive(["MISSION_REQUEST_INT", "MISSION_ACK"], 5.0)
            if answer.get_type() == "MISSION_ACK":
                return answer.type
            command, params, (x, y, z) = items[answer.seq]
            frame = self.ml.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
            self.link.mav.mission_item_int_send(1, 1, answer.seq, frame, command, 0, 1, *params, x, y, z, 0)


def on_earth(north, east, up):
    latitude = HOME[0] + north / METRES_PER_DEGREE
    longitude = HOME[1] + east / (METRES_PER_DEGREE * math.cos(math.radians(HOME[0])))
    return round(latitude * 1e7), round(longitude * 1e7), up


def place(message):
    """North, east and up of home, m."""
    north = (message.lat * 1e-7 - HOME[0]) * METRES_PER_DEGREE
    east = (message.lon * 1e-7 - HOME[1]) * METRES_PER_DEGREE * math.cos(math.radians(HOME[0]))
    return north, east, message.relative_alt * 1e-3


def fly(station):
    ml = station.ml
    parameters = station.parameters()
    assert parameters["VEH_ROD"] == ROD_M and parameters["PATH_KIND"] == 6.0
    print(f"{len(parameters)} parameters")
    modes = station.modes()
    print("modes:", ", ".join(modes))

    # On a map and instruments before anything is done.
    at = place(station.receive(["GLOBAL_POSITION_INT"], 5.0))
    assert math.dist(at[:2], (0.0, 0.0)) < 0.3 and abs(at[2]) < 0.5, at
    euler = station.receive(["ATTITUDE"], 5.0)
    assert abs(euler.roll) < 0.1 and abs(euler.pitch) < 0.1, euler
    assert station.receive(["VFR_HUD"], 5.0).groundspeed < 1.0
    # The receiver's own word, RTK fixed, beside where the vehicle takes itself to be.
    begun = time.monotonic()
    for _ in range(5):
        fix = station.receive(["GPS_RAW_INT"], 5.0)
    assert time.monotonic() - begun < 5.0, "fixes come less than once a second"
    assert fix.fix_type == ml.GPS_FIX_TYPE_RTK_FIXED and fix.satellites_visible == 255, fix
    off = math.dist(((fix.lat * 1e-7 - HOME[0]) * METRES_PER_DEGREE, fix.alt * 1e-3 - HOME[2]), (at[0], at[2]))
    assert off < 0.2 and fix.h_acc < 50, (off, fix)
    health = station.receive(["SYS_STATUS"], 5.0).onboard_control_sensors_health
    assert health & ml.MAV_SYS_STATUS_PREARM_CHECK and health & ml.MAV_SYS_STATUS_SENSOR_GPS, health
    # A mission is there, to be drawn.
    begun = station.download()
    assert begun[-1].command == ml.MAV_CMD_NAV_LAND and len(begun) >= 5, begun
    assert all(item.frame == ml.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT for item in begun if item.command != ml.MAV_CMD_DO_CHANGE_SPEED)

    # Up, and down again.
    assert station.command(ml.MAV_CMD_NAV_TAKEOFF) != ml.MAV_RESULT_ACCEPTED, "it takes off without being armed"
    station.insist(ml.MAV_CMD_COMPONENT_ARM_DISARM, 1.0)
    station.until_mode(modes["Idle"], 5.0)
    station.insist(ml.MAV_CMD_NAV_TAKEOFF)
    station.until_mode(modes["Hold"], 30.0)
    up = place(station.receive(["GLOBAL_POSITION_INT"], 1.0))
    assert up[2] > ROD_M, up
    assert station.upload([]) == ml.MAV_MISSION_DENIED, "a mission was taken in flight"
    station.insist(ml.MAV_CMD_NAV_LAND)
    station.until_mode(modes["Off"], 60.0)
    station.receive(["EXTENDED_SYS_STATE"], 5.0, lambda state: state.landed_state == ml.MAV_LANDED_STATE_ON_GROUND)

    # A mission of the station's own.
    nan = math.nan
    commands = [ml.MAV_CMD_NAV_TAKEOFF, ml.MAV_CMD_NAV_WAYPOINT, ml.MAV_CMD_NAV_WAYPOINT, ml.MAV_CMD_NAV_LAND]
    items = [(command, (0.0, 0.0, 0.0, nan), on_earth(*point)) for command, point in zip(commands, MISSION)]
    assert station.upload(items) == ml.MAV_MISSION_ACCEPTED, station.texts[-3:]
    back = [(item.command, (item.x, item.y)) for item in station.download()]
    assert back == [(command, (x, y)) for command, _, (x, y, _) in items], back
    station.insist(ml.MAV_CMD_COMPONENT_ARM_DISARM, 1.0)
    station.until_mode(modes["Idle"], 5.0)
    station.places.clear()
    station.insist(ml.MAV_CMD_MISSION_START)
    reached = []
    while not reached or reached[-1] < len(MISSION) - 1:
        reached.append(station.receive(["MISSION_ITEM_REACHED"], 60.0).seq)
    assert reached == list(range(len(MISSION))), reached
    # The UAV flies above the load's way, near each of its corners.
    for item, (north, east, up) in enumerate(MISSION):
        nearest = min(math.dist(place(message), (north, east, up + ROD_M)) for _, message in station.places)
        # By half a corner's blend, at the most.
        most = parameters["MIS_CORNER"] / 2 + NEAR_M + (JOINED_M if item == 0 else 0.0)
        assert nearest < most, (north, east, up, nearest)
    station.until_mode(modes["Land"], 20.0)
    station.until_mode(modes["Off"], 90.0)
    down = place(station.receive(["GLOBAL_POSITION_INT"], 1.0))
    assert down[2] < 0.5 and math.dist(down[:2], MISSION[-1][:2]) < ROD_M, down
    # Ten places a second, as long as the machine keeps pace.
    seconds = station.places[-1][0] - station.places[0][0]
    rate = len(station.places) / seconds
    assert rate > 5.0, rate
    print(f"a mission of {len(items)} items flown, with {rate:.1f} places a second")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--run", metavar="HIL_SIM", required=True)
    parser.add_argument("--emulate", metavar="IMAGE")
    parser.add_argument("--machine", default="mps2-an386")
    parser.add_argument("--port", type=int, default=14559)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        place = ["--emulate", arguments.emulate, "--machine", arguments.machine] if arguments.emulate else []
        command = [arguments.run, "hil", f"--station=127.0.0.1:{arguments.port}", "--out", folder, *place]
        vehicle = subprocess.Popen(command)
        try:
            fly(Station(arguments.port))
            # Ctrl-C ends the flight with its report.
            vehicle.send_signal(signal.SIGINT)
            assert vehicle.wait(timeout=60.0) == 0
            assert os.path.exists(os.path.join(folder, "report.html"))
        finally:
            vehicle.kill()
            vehicle.wait()


if __name__ == "__main__":
    main()
