"""Reads logs back with the field's own readers: pandas' kind of CSV, pyulog, mcap, pyarrow. Every value must equal the CSV's."""

import argparse
import csv
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

import pyarrow.parquet
from mcap.reader import make_reader
from pyulog import ULog

SCENARIOS = pathlib.Path(__file__).parents[2] / "hil-sim/scenarios"
CAMPAIGN, ESTIMATE = SCENARIOS / "campaign.toml", SCENARIOS / "estimate.toml"


def single(text):
    """A cell as the single-precision number that it stands for; None if it is empty."""
    return None if text == "" else struct.unpack("f", struct.pack("f", float(text)))[0]


def read_csv(path):
    """Columns by name, and what the sidecar says of them."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    described = json.loads(pathlib.Path(f"{path}-metadata.json").read_text())
    schema = described["tableSchema"]["columns"]
    assert [column["name"] for column in schema] == list(columns), path
    for column in schema:
        assert column["dc:description"], column
        assert column["datatype"] == "string" or column["schema:unitText"], column
    return columns, schema


def microseconds(columns):
    return [round(1e6 * float(t)) for t in columns["t_s"]]


def same(found, text):
    """Whether a number is the one of a CSV cell; an empty cell is no number."""
    expected = single(text)
    if expected is None:
        return found is None or math.isnan(found)
    return found == expected


def check_ulog(path, columns, schema):
    log = ULog(str(path))
    assert not log.file_corruption
    times = {t: row for row, t in enumerate(microseconds(columns))}
    topics = {data.name: data.data for data in log.data_list}
    for px4 in ["vehicle_local_position", "vehicle_attitude", "vehicle_angular_velocity", "vehicle_status"]:
        assert px4 in topics, f"{path}: no {px4}"
    compared = 0
    for column in schema[1:]:
        name = column["name"]
        topic = next(name_ for name_, data in topics.items() if name in data)
        key = f"{topic}.{name}"
        assert log.msg_info_dict[f"about:{key}"] == column["dc:description"]
        if column["datatype"] == "number":
            assert log.msg_info_dict[f"unit:{key}"] == column["schema:unitText"]
        words = log.msg_info_dict.get(f"words:{key}", "").split(";")
        seen = set()
        for t, value in zip(topics[topic]["timestamp"], topics[topic][name]):
            text = columns[name][times[int(t)]]
            if column["datatype"] == "string":
                assert words[value] == text, (name, t)
            else:
                assert same(float(value), text), (name, t, value, text)
            seen.add(int(t))
            compared += 1
        missing = [text for t, text in zip(times, columns[name]) if t not in seen]
        assert not any(missing), f"{path}: {name} lacks rows"
    return compared


def check_mcap(path, columns, schema):
    times = {t: row for row, t in enumerate(microseconds(columns))}
    found = {column["name"]: [None] * len(times) for column in schema}
    units = {}
    with open(path, "rb") as file:
        for message_schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            assert (message_schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            properties = json.loads(message_schema.data)["properties"]
            for name, value in json.loads(message.data).items():
                found[name][times[message.log_time // 1000]] = value
                units[name] = properties[name].get("unit")
    compared = 0
    for column in schema[1:]:
        name = column["name"]
        assert units[name] == column.get("schema:unitText"), name
        for value, text in zip(found[name], columns[name]):
            if column["datatype"] == "string":
                assert (value or "") == text, (name, value, text)
            else:
                assert same(None if value is None else single(value), text), (name, value, text)
            compared += 1
    return compared


def check_parquet(path, table):
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    read = pyarrow.parquet.read_table(path)
    units = json.loads(read.schema.metadata[b"units"])
    assert read.column_names == list(rows[0]) == list(units) or set(units) == set(rows[0])
    assert read.num_rows == len(rows)
    compared = 0
    for name in read.column_names:
        for value, row in zip(read.column(name).to_pylist(), rows):
            text = row[name]
            if isinstance(value, list):
                assert value == [float(part) for part in text.split(";")], name
            elif isinstance(value, str):
                assert value == text, name
            elif value is None:
                assert text in ("", "inf"), (name, text)
            else:
                assert value == float(text), (name, value, text)
            compared += 1
    return compared


def check_replay(program, out):
    """PX4's topics alone, written by pyulog, are enough to replay the estimator; returns the load's largest error."""
    quiet = ["--out", str(out), "--log", "ulog", "--quiet"]
    subprocess.run([program, "run", str(ESTIMATE), *quiet], check=True)
    flown = ULog(str(out / "estimate.ulg"))
    load = flown.get_dataset("load").data
    flown.data_list[:] = [data for data in flown.data_list if data.name.startswith("vehicle_")]
    flown.write_ulog(str(out / "px4.ulg"))
    replay = [program, "replay", str(out / "px4.ulg"), "--with", str(ESTIMATE), "--out", str(out), "--log", "ulog"]
    said = subprocess.run(replay, check=True, capture_output=True, text=True).stdout
    assert "no thrust (PX4: vehicle_thrust_setpoint" in said and "no p1 … p3, v1 … v3 of the load" in said, said
    found = ULog(str(out / "px4-replay.ulg")).get_dataset("estimate").data
    # Without thrust nothing is learnt of wind and lateral force, but the pendulum is the accelerometer's.
    error = 0.0
    place = {int(t): row for row, t in enumerate(load["timestamp"])}
    for row, t in enumerate(found["timestamp"]):
        if t > 20_000_000 and int(t) in place:
            apart = [found[f"est_p{i}"][row] - load[f"p{i}"][place[int(t)]] for i in (1, 2, 3)]
            error = max(error, math.hypot(*apart))
    assert 0.0 < error < 1.0, error
    return error


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--run", required=True, help="the hil-sim program")
    program = parser.parse_args().run
    doctor = pathlib.Path(sys.executable).with_name("pymcap-cli")

    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        every = ["--log", "csv,ulog,mcap", "--out", folder, "--quiet"]
        subprocess.run([program, "run", "fig2a", "fig3b", *every], check=True)
        few = [program, "campaign", str(CAMPAIGN), "--runs", "12", "--out", folder, "--quiet"]
        subprocess.run([*few, "--table", "csv,parquet"], check=True)
        subprocess.run([*few, "--replay", "3", "--log", "csv,ulog,mcap"], check=True)
        for name in ["fig2a", "fig3b", "replay-3"]:
            columns, schema = read_csv(out / f"{name}.csv")
            in_ulog = check_ulog(out / f"{name}.ulg", columns, schema)
            in_mcap = check_mcap(out / f"{name}.mcap", columns, schema)
            if not name.startswith("replay"):
                # 120,000 messages of a replay would take the doctor a minute.
                subprocess.run([doctor, "--quiet", "doctor", str(out / f"{name}.mcap")], check=True)
            print(f"{name}: {len(columns)} columns, {in_ulog} values by pyulog, {in_mcap} by mcap")
        print(f"replay of PX4's topics as pyulog writes them: the load within {check_replay(program, out):.3f} m")
        print(f"campaign: {check_parquet(out / 'runs.parquet', out / 'runs.csv')} values by pyarrow")


main()
