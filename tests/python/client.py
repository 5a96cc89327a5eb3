"""Drives a target from Python: pymavlink, with a dialect generated from the same XML.

    python client.py tcp:127.0.0.1:5760            a target that listens there
    python client.py --run target/release/hil-sim  starts one with `hil-sim target`

Ends with status 0 if the target does what the dialect says.
"""

import argparse
import contextlib
import importlib
import math
import os
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import time

os.environ["MAVLINK20"] = "1"
XML = pathlib.Path(__file__).parents[2] / "link" / "dialect" / "slung_load.xml"
TIMEOUT_S = 10.0


def generate_dialect(folder):
    """The dialect as a Python module, by pymavlink's own generator."""
    from pymavlink.generator import mavgen, mavparse

    # pymavlink's schema for XML files is not what is under test.
    options = mavgen.Opts(
        str(pathlib.Path(folder) / "slung_load"), wire_protocol=mavparse.PROTOCOL_2_0, language="Python3", validate=False
    )
    with contextlib.redirect_stdout(sys.stderr):
        assert mavgen.mavgen(options, [str(XML)]), "mavgen refuses the dialect"
    sys.path.insert(0, folder)
    return importlib.import_module("slung_load")


class Client:
    """One end of the link."""

    def __init__(self, dialect, address):
        host, port = address.removeprefix("tcp:").rsplit(":", 1)
        deadline = time.monotonic() + TIMEOUT_S
        while True:
            try:
                self.socket = socket.create_connection((host, int(port)), timeout=TIMEOUT_S)
                break
            except ConnectionRefusedError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.05)
        self.mav = dialect.MAVLink(None, srcSystem=255, srcComponent=190)
        self.mav.robust_parsing = True
        self.waiting = []
        self.others = []

    def passed_over(self, kind):
        """The messages of a kind that were passed over since the last call."""
        passed, self.others = self.others, []
        return [message for message in passed if message.get_type() == kind]

    def send(self, message):
        self.socket.sendall(message.pack(self.mav))

    def receive(self, kind, accept=lambda message: True):
        """The next message of a kind, or of one of some; others before it are passed over."""
        kinds = (kind,) if isinstance(kind, str) else kind
        deadline = time.monotonic() + self.socket.gettimeout()
        while time.monotonic() < deadline:
            while self.waiting:
                message = self.waiting.pop(0)
                if message.get_type() in kinds and accept(message):
                    return message
                self.others.append(message)
            data = self.socket.recv(4096)
            assert data, "the target has closed the line"
            self.waiting += self.mav.parse_buffer(data) or []
        raise TimeoutError(f"no {kind}")


def single(number):
    """As a single-precision float."""
    return struct.unpack("f", struct.pack("f", number))[0]


def check(dialect, client):
    heartbeat = client.receive("HEARTBEAT")
    assert heartbeat.type == dialect.MAV_TYPE_GENERIC_MULTIROTOR
    assert not heartbeat.base_mode & dialect.MAV_MODE_FLAG_SAFETY_ARMED

    def name_of(message):
        return message.param_id if isinstance(message.param_id, str) else message.param_id.decode().rstrip("\0")

    # The list, whole and each name once.
    client.send(dialect.MAVLink_param_request_list_message(1, 1))
    first = client.receive("PARAM_VALUE")
    names = {name_of(first)} | {name_of(client.receive("PARAM_VALUE")) for _ in range(first.param_count - 1)}
    assert len(names) == first.param_count, "the list is not complete"
    assert {"LINK_DIALECT", "VEH_M_LOAD", "CTL_PERIOD", "K1_0", "OBS_W_LOAD", "ENV_ROD_LIM", "POL_COAST", "ROT_KT"} <= names

    def set_parameter(name, value):
        client.send(dialect.MAVLink_param_set_message(1, 1, name.encode(), value, dialect.MAV_PARAM_TYPE_REAL32))
        return client.receive("PARAM_VALUE", lambda message: name_of(message) == name).param_value

    assert set_parameter("VEH_M_LOAD", 0.75) == 0.75
    assert set_parameter("VEH_M_LOAD", -1.0) == 0.75, "a negative mass was taken"
    assert set_parameter("SYS_SIM", 1.0) == 1.0
    assert set_parameter("TLM_EVERY", 0.0) == 0.0

    def command_long(command, param1, param2=0.0):
        client.send(dialect.MAVLink_command_long_message(1, 1, command, 0, param1, param2, 0, 0, 0, 0, 0))
        return client.receive("COMMAND_ACK", lambda message: message.command == command).result

    def arm(on):
        # In flight it takes the force code to disarm.
        return command_long(dialect.MAV_CMD_COMPONENT_ARM_DISARM, float(on), 0.0 if on else 21196.0)

    def ask(mode):
        return command_long(dialect.MAV_CMD_DO_SET_MODE, dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, mode)

    def state(sequence, action=0, height=-10.0, lean=0.0, telemetry=0):
        """At rest on the default circle."""
        return dialect.MAVLink_load_state_message(
            time_usec=2000 * sequence,
            sequence=sequence,
            position=[5.0, 0.0, height],
            velocity=[0.0] * 3,
            rod=[math.sin(lean), 0.0, math.cos(lean)],
            rod_rate=[0.0] * 3,
            attitude=[1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0],
            body_rate=[0.0] * 3,
            reference_phase=0.0,
            zeta=[0.0] * 4,
            action=action,
            telemetry=telemetry,
        )

    def answer(sequence):
        return client.receive("LOAD_COMMAND", lambda message: message.sequence == sequence)

    client.send(state(1))
    refused = answer(1)
    assert refused.faults & dialect.LOAD_FAULT_NOT_ARMED and refused.thrust == 0.0 and list(refused.rotor) == [0.0] * 4

    assert arm(True) == dialect.MAV_RESULT_ACCEPTED
    assert set_parameter("VEH_M_LOAD", 0.5) == 0.75, "a parameter was changed in flight"
    client.send(state(2, dialect.LOAD_ACTION_START, telemetry=1))
    telemetry = client.receive("LOAD_TELEMETRY", lambda message: message.sequence == 2)
    hover = answer(2)
    # zeta = 0 at rest: the thrust is the weight of 2.5 kg and 0.75 kg.
    assert math.isclose(hover.thrust, 3.25 * 9.81, rel_tol=1e-4), hover.thrust
    assert hover.mode == dialect.LOAD_MODE_FOLLOW
    assert math.isclose(telemetry.q3, 1.0, rel_tol=1e-6) and telemetry.warning == 0
    # Nothing observed yet: the mass is the one that it was told.
    assert math.isclose(telemetry.payload_mass, 0.75, rel_tol=1e-3), telemetry.payload_mass
    assert list(telemetry.payload_force) == [0.0] * 3
    assert all(0.0 < duty < 1.0 for duty in hover.rotor)

    # The same question again has the same answer, and the next one goes on.
    client.send(state(2, dialect.LOAD_ACTION_START, telemetry=1))
    assert answer(2).to_dict() == hover.to_dict()
    for sequence in range(3, 203):
        client.send(state(sequence))
        command = answer(sequence)
        assert command.mode == dialect.LOAD_MODE_FOLLOW and math.isfinite(command.thrust)
    # Standing still where it should move, it is told to tilt forward along the path.
    assert max(abs(axis) for axis in command.torque) > 1e-4

    # A state that is none: the last command goes on for a while, and it says so.
    client.send(state(203, height=math.nan))
    coasting = answer(203)
    assert coasting.mode == dialect.LOAD_MODE_FOLLOW and coasting.faults & dialect.LOAD_FAULT_BAD_STATE
    assert coasting.thrust == command.thrust

    # Noise between frames does no harm.
    client.socket.sendall(bytes(range(256)) * 2)
    client.send(state(204))
    deadline = time.monotonic() + TIMEOUT_S
    while True:
        try:
            client.socket.settimeout(0.2)
            assert answer(204).mode == dialect.LOAD_MODE_FOLLOW
            break
        except TimeoutError:
            assert time.monotonic() < deadline, "the target has not recovered from noise"
            client.send(state(204))
    client.socket.settimeout(TIMEOUT_S)

    # Beyond the envelope it holds, and names the margin; then it does what it is asked for.
    margins = dialect.LOAD_FAULT_ROD_ANGLE | dialect.LOAD_FAULT_THRUST_ANGLE | dialect.LOAD_FAULT_TENSION | dialect.LOAD_FAULT_THRUST
    client.send(state(205, lean=1.4))
    beyond = answer(205)
    assert beyond.mode == dialect.LOAD_MODE_HOLD and beyond.faults & margins, beyond
    assert ask(dialect.LOAD_MODE_ENGAGE) == dialect.MAV_RESULT_DENIED
    for sequence, mode in enumerate((dialect.LOAD_MODE_LAND, dialect.LOAD_MODE_HOLD), start=206):
        assert ask(mode) == dialect.MAV_RESULT_ACCEPTED
        client.send(state(sequence))
        obeying = answer(sequence)
        assert obeying.mode == mode and not obeying.faults & margins, obeying

    client.send(dialect.MAVLink_timesync_message(0, 123456789))
    sync = client.receive("TIMESYNC")
    assert sync.ts1 == 123456789 and sync.tc1 > 0
    assert arm(False) == dialect.MAV_RESULT_ACCEPTED
    assert client.receive("LOAD_COUNTERS").steps >= 203


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("address", nargs="?", default="tcp:127.0.0.1:5760")
    parser.add_argument("--run", metavar="HIL_SIM", help="start this program's target at the address")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        dialect = generate_dialect(folder)
        target = arguments.run and subprocess.Popen([arguments.run, "target", "--quiet", "--listen", arguments.address])
        try:
            check(dialect, Client(dialect, arguments.address))
        finally:
            if target:
                target.kill()
                target.wait()
    print("the target does what the dialect says")


if __name__ == "__main__":
    main()
