"""Stock ground stations' missions: pymavlink and MAVSDK send a plan of 100 items over a line that loses frames, and read
the same plan back; the target on this machine flies it.

    python missions.py --run target/release/hil-sim                   the target on this machine
    python missions.py --run target/release/hil-sim --emulate IMAGE   the firmware in QEMU

Ends with status 0 if all of it goes well.
"""

import argparse
import asyncio
import json
import math
import os
import random
import socket
import struct
import subprocess
import tempfile
import threading
import time

os.environ["MAVLINK20"] = "1"

from client import Client, generate_dialect  # noqa: E402

HOME = (535270000, -1135290000, 668.0)
ITEMS = 100
LOSS = 0.05
RADIUS_M = 6.0
HEIGHT_M = 12.0


def plan(common):
    """100 items about home: a speed, and a circle in steps of 0.4 m, which ends in a rest."""
    degrees_per_metre = 1.0 / 111297.0
    items = [dict(command=common.MAV_CMD_DO_CHANGE_SPEED, frame=common.MAV_FRAME_MISSION, params=(1.0, 2.0, -1.0, 0.0), x=0, y=0, z=0.0)]
    for number in range(1, ITEMS):
        angle = 2.0 * math.pi * number / (ITEMS + 4)
        north, east = RADIUS_M * math.cos(angle), RADIUS_M * math.sin(angle)
        last = number == ITEMS - 1
        items.append(
            dict(
                command=common.MAV_CMD_NAV_WAYPOINT if last else common.MAV_CMD_NAV_SPLINE_WAYPOINT,
                frame=common.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
                params=(2.0 if last else 0.0, 0.0, 0.0, math.nan),
                x=HOME[0] + round(north * degrees_per_metre * 1e7),
                y=HOME[1] + round(east * degrees_per_metre / math.cos(math.radians(HOME[0] * 1e-7)) * 1e7),
                z=HEIGHT_M + 0.01 * number,
            )
        )
    return items


def bits(command, frame, params, x, y, z):
    """What has to come back, bit by bit."""
    return command, frame, struct.pack("<4f", *params), x, y, struct.pack("<f", z)


class Lossy:
    """A line in two pieces: clients connect here by TCP, and a share of all frames does not come through."""

    def __init__(self, far):
        self.far, self.loss, self.random = far, 0.0, random.Random(1)
        self.passed = self.lost = 0
        self.near = None
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = "tcp:127.0.0.1:%d" % self.listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()
        threading.Thread(target=self._pass, args=(lambda: far.recv(4096), self._to_near), daemon=True).start()

    def _accept(self):
        while True:
            near, _ = self.listener.accept()
            near.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.near = near
            self._pass(lambda: near.recv(4096), self.far.sendall)

    def _to_near(self, frame):
        near = self.near
        if near:
            try:
                near.sendall(frame)
            except OSError:
                pass

    def _pass(self, read, write):
        buffer = b""
        while True:
            try:
                data = read()
            except OSError:
                return
            if not data:
                return
            if self.loss == 0.0:
                write(buffer + data)
                buffer = b""
                continue
            buffer += data
            while True:
                # Frames of MAVLink 2, as both stations send them.
                start = buffer.find(b"\xfd")
                buffer = buffer[start:] if start >= 0 else b""
                if len(buffer) < 2 or len(buffer) < (length := buffer[1] + 12):
                    break
                frame, buffer = buffer[:length], buffer[length:]
                self.passed += 1
                if self.random.random() < self.loss:
                    self.lost += 1
                else:
                    write(frame)


def target(arguments, folder):
    """A target and the line to it."""
    if arguments.emulate:
        line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        line.bind(("127.0.0.1", 0))
        # As hil-sim starts it.
        udp = f"udp,id=hil,host=127.0.0.1,port={line.getsockname()[1]},localaddr=127.0.0.1,localport=0,mux=on"
        process = subprocess.Popen(
            ["qemu-system-arm", "-machine", arguments.machine, "-display", "none", "-monitor", "none"]
            + ["-kernel", arguments.emulate, "-chardev", udp, "-echr", "0x100", "-serial", "chardev:hil"],
            stdin=subprocess.DEVNULL,
        )
        _, whence = line.recvfrom(4096)
        line.connect(whence)
        return process, line
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    process = subprocess.Popen([arguments.run, "target", "--quiet", "--listen", f"tcp:127.0.0.1:{port}"])
    deadline = time.monotonic() + 10.0
    while True:
        try:
            return process, socket.create_connection(("127.0.0.1", port))
        except ConnectionRefusedError:
            assert time.monotonic() < deadline, "the target does not listen"
            time.sleep(0.05)


def insist(client, message, kind, accept=lambda message: True):
    """Asks again until the answer comes."""
    client.socket.settimeout(0.5)
    for _ in range(40):
        client.send(message)
        try:
            return client.receive(kind, accept)
        except TimeoutError:
            continue
    raise TimeoutError(f"no {kind}")


def by_pymavlink(common, client, items):
    """The items, sent up and read back."""
    count = common.MAVLink_mission_count_message(1, 1, len(items), common.MAV_MISSION_TYPE_MISSION)
    message = count
    client.socket.settimeout(0.5)
    deadline = time.monotonic() + 60.0
    while True:
        assert time.monotonic() < deadline, "no end of the upload"
        client.send(message)
        try:
            answer = client.receive(("MISSION_REQUEST_INT", "MISSION_ACK"))
        except TimeoutError:
            continue
        if answer.get_type() == "MISSION_ACK":
            assert answer.type == common.MAV_MISSION_ACCEPTED, answer
            break
        item = items[answer.seq]
        message = common.MAVLink_mission_item_int_message(
            1, 1, answer.seq, item["frame"], item["command"], 0, 1, *item["params"], item["x"], item["y"], item["z"], 0
        )
    kept = insist(client, common.MAVLink_mission_request_list_message(1, 1, 0), "MISSION_COUNT").count
    back = []
    for seq in range(kept):
        request = common.MAVLink_mission_request_int_message(1, 1, seq, 0)
        item = insist(client, request, "MISSION_ITEM_INT", lambda item, seq=seq: item.seq == seq)
        params = (item.param1, item.param2, item.param3, item.param4)
        back.append(bits(item.command, item.frame, params, item.x, item.y, item.z))
    client.send(common.MAVLink_mission_ack_message(1, 1, common.MAV_MISSION_ACCEPTED, 0))
    return back


async def by_mavsdk(address, items):
    """The same by MAVSDK."""
    from mavsdk import System
    from mavsdk.mission_raw import MissionItem

    station = System(port=50055)
    await station.connect(system_address=address.replace("tcp:", "tcpout://"))
    async for state in station.core.connection_state():
        if state.is_connected:
            break
    raw = [
        MissionItem(seq, item["frame"], item["command"], int(seq == 0), 1, *item["params"], item["x"], item["y"], item["z"], 0)
        for seq, item in enumerate(items)
    ]
    await station.mission_raw.upload_mission(raw)
    back = await station.mission_raw.download_mission()
    station._stop_mavsdk_server()
    return [
        bits(item.command, item.frame, (item.param1, item.param2, item.param3, item.param4), item.x, item.y, item.z) for item in back
    ]


class Plant:
    """The simulator's, a state a command."""

    def __init__(self, program, folder, position):
        scenario = os.path.join(folder, "still.toml")
        with open(scenario, "w") as file:
            file.write(f'duration_s = 60.0\nsteady_from_s = 1.0\n[initial]\nposition = {list(position)}\n[controller]\nrate_hz = 500.0\n')
        self.process = subprocess.Popen([program, "plant", scenario], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.state = json.loads(self.process.stdout.readline())

    def step(self, command):
        self.process.stdin.write(json.dumps({"thrust": command.thrust, "torque": list(command.torque)}) + "\n")
        self.process.stdin.flush()
        self.state = json.loads(self.process.stdout.readline())


def fly(dialect, client, plant, last):
    """Flies the mission that is kept, in lockstep, until the item `last`, and says which items were reached."""
    client.socket.settimeout(10.0)
    heard = []

    def parameter(name, value):
        client.send(dialect.MAVLink_param_set_message(1, 1, name.encode(), value, dialect.MAV_PARAM_TYPE_REAL32))
        assert client.receive("PARAM_VALUE").param_value == value, name

    def ordered(command, param1):
        client.send(dialect.MAVLink_command_long_message(1, 1, command, 0, param1, 0, 0, 0, 0, 0, 0))
        result = client.receive("COMMAND_ACK", lambda message: message.command == command).result
        assert result == dialect.MAV_RESULT_ACCEPTED, (command, result)

    parameter("PATH_KIND", 6.0)
    parameter("SYS_SIM", 1.0)
    # A station that was heard and is silent is lost.
    client.send(dialect.MAVLink_heartbeat_message(dialect.MAV_TYPE_GCS, dialect.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3))
    ordered(dialect.MAV_CMD_COMPONENT_ARM_DISARM, 1.0)
    for sequence in range(1, 50000):
        state = plant.state
        line = [p - q for p, q in zip(state["position"], state["uav_position"])]
        length = math.sqrt(sum(x * x for x in line))
        rate = [(v - w) / length for v, w in zip(state["velocity"], state["uav_velocity"])]
        frame = dialect.MAVLink_load_state_message(
            time_usec=2000 * sequence, sequence=sequence, position=state["position"], velocity=state["velocity"],
            rod=[x / length for x in line], rod_rate=rate, attitude=sum(state["attitude"], []), body_rate=state["body_rate"],
            reference_phase=0.0, zeta=[0.0] * 4, action=dialect.LOAD_ACTION_ENGAGE if sequence == 1 else 0, telemetry=0,
        )
        # The same question again has the same answer, so a frame that the line loses is sent again.
        command = insist(client, frame, "LOAD_COMMAND", lambda message, sequence=sequence: message.sequence == sequence)
        heard += client.passed_over("MISSION_ITEM_REACHED")
        plant.step(command)
        if sequence == 100:
            ordered(dialect.MAV_CMD_MISSION_START, 0.0)
        reached = [message.seq for message in heard]
        if reached and reached[-1] == last:
            break
    return reached


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--run", metavar="HIL_SIM", required=True)
    parser.add_argument("--emulate", metavar="IMAGE")
    parser.add_argument("--machine", default="mps2-an386")
    arguments = parser.parse_args()
    from pymavlink.dialects.v20 import common

    items = plan(common)
    wanted = [bits(item["command"], item["frame"], item["params"], item["x"], item["y"], item["z"]) for item in items]
    with tempfile.TemporaryDirectory() as folder:
        dialect = generate_dialect(folder)
        for number, message in dialect.mavlink_map.items():
            if number < 256:
                assert message.crc_extra == common.mavlink_map[number].crc_extra, f"{message.msgname} is not MAVLink's"
        process, far = target(arguments, folder)
        try:
            line = Lossy(far)
            client = Client(common, line.address)
            client.receive("HEARTBEAT")
            home = common.MAVLink_set_gps_global_origin_message(1, HOME[0], HOME[1], round(HOME[2] * 1e3))
            insist(client, home, "GPS_GLOBAL_ORIGIN")
            line.loss = LOSS
            begun = time.monotonic()
            assert by_pymavlink(common, client, items) == wanted, "another plan comes back to pymavlink"
            print(f"pymavlink: {len(items)} items up and down in {time.monotonic() - begun:.1f} s, {line.lost} of {line.passed} frames lost")
            client.socket.close()
            # Another plan first, so that it is MAVSDK's own that comes back.
            begun, line.lost, line.passed = time.monotonic(), 0, 0
            other = items[:1] + items[:0:-1]
            expected = [bits(item["command"], item["frame"], item["params"], item["x"], item["y"], item["z"]) for item in other]
            assert asyncio.run(by_mavsdk(line.address, other)) == expected, "another plan comes back to MAVSDK"
            print(f"MAVSDK: {len(other)} items up and down in {time.monotonic() - begun:.1f} s, {line.lost} of {line.passed} frames lost")
            client = Client(common, line.address)
            assert by_pymavlink(common, client, items) == wanted
            client.socket.close()
            line.loss = 0.0
            client = Client(dialect, line.address)
            first = 2.0 * math.pi / (ITEMS + 4)
            plant = Plant(arguments.run, folder, (RADIUS_M * math.cos(first), RADIUS_M * math.sin(first), -HEIGHT_M))
            if arguments.emulate:
                # It takes minutes.
                return
            # A quarter of the circle.
            last = ITEMS // 4
            reached = fly(dialect, client, plant, last)
            assert reached == list(range(1, last + 1)), reached
            angle = 2.0 * math.pi * last / (ITEMS + 4)
            end = (RADIUS_M * math.cos(angle), RADIUS_M * math.sin(angle), -HEIGHT_M - 0.01 * last)
            away = math.dist(plant.state["position"], end)
            # An item's place is to 11 mm; it has been passed for less than two control periods.
            assert away < 0.05, away
            print(f"flown: {len(reached)} items reached, the last to {1e3 * away:.0f} mm")
        finally:
            process.kill()
            process.wait()


if __name__ == "__main__":
    main()
