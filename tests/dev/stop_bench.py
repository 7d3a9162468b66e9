#!/usr/bin/env python3
"""tests/dev/stop_bench.py PROGRAM [SECONDS=10]: how long Stop takes while the server has much to do.

Under each load Stop is asked for over and over, each time on a new connection, and five times a robot
on emulated devices is stopped while it drives; the emulator's record says when its wheels were told
to stand. Prints rows of the table in docs/benchmarks.md; exit status 1 beyond the limits. Needs root
for the full disk, and the machine to itself.
"""
import contextlib
import os
import subprocess
import sys
import tempfile
import time

import load
from emulated_robot import Devices, robot_file

PROGRAM = sys.argv[1]
SECONDS = float(sys.argv[2]) if len(sys.argv) > 2 else 10.0
MOST = {"p99": 0.050, "max": 0.250, "wheels": 0.100}  # [s]
DRIVES = 5
DISK_MB = 8


def drive(server):
    """Turns the robot on the spot by the stick until the wheels turn, so that no wall stops it; false
    when the robot does not move."""
    def push(turn):
        server.ask("POST", "/session/watch", {})
        server.ask("POST", "/session/requests", {"type": "joystick", "forward": 0, "turn": turn})
        time.sleep(0.05)

    for _ in range(60):
        session = load.json.loads(server.ask("GET", "/session")[2])
        if abs(session.get("command", {}).get("omega", 0)) > 0:
            return True
        if not (session.get("hardware") or {}).get("armed"):
            server.ask("POST", "/session/control", {"action": "arm"})
        if session["stop"]:
            server.ask("POST", "/session/control", {"action": "release"})
        push(0)  # after a stop, the stick counts only once it has been released
        for _ in range(8):
            push(1)
    return False


def stop(port, address="127.0.0.1"):
    """[s] until the answer, on a connection of its own."""
    connection = load.http.client.HTTPConnection("127.0.0.1", port, timeout=20,
                                                 source_address=(address, 0))
    begin = time.monotonic()
    connection.request("POST", "/api/v1/session/control", '{"action":"stop"}',
                       {"Content-Type": "application/json"})
    answer = connection.getresponse()
    body = answer.read()
    took = time.monotonic() - begin
    connection.close()
    if answer.status != 200:
        sys.exit(f"Stop was answered {answer.status}: {body.decode()}")
    return took


def stops(server, address):
    """[s] of the answers to Stop during SECONDS, rising."""
    took = []
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        took.append(stop(server.port, address))
        time.sleep(0.02)
    return sorted(took)


def wheels(server, devices, address):
    """[s] from the request to a lasting zero command, the longest of some drives."""
    worst = 0.0
    for _ in range(DRIVES):
        if not drive(server):
            sys.exit("the robot does not drive: " + server.ask("GET", "/session")[2].decode()[:800])
        asked = time.monotonic()
        stop(server.port, address)
        time.sleep(1)
        zero = devices.zero_after(asked, time.monotonic())
        worst = max(worst, 1.0 if zero is None else zero)
    return worst


def measure(name, server, devices, under=contextlib.nullcontext(), address="127.0.0.1"):
    with under:
        time.sleep(1)
        took = stops(server, address)
        zero = wheels(server, devices, address)
    p50, p99 = took[len(took) // 2], took[int(len(took) * 0.99)]
    well = p99 <= MOST["p99"] and took[-1] <= MOST["max"] and zero <= MOST["wheels"]
    print(f"| {name} | {len(took)} | {p50 * 1e3:.1f} | {p99 * 1e3:.1f} | {took[-1] * 1e3:.1f} | "
          f"{zero * 1e3:.0f} | {server.memory('VmHWM'):.0f} |{'' if well else ' LATE'}", flush=True)
    return well


def all_loads(folder):
    database = os.path.join(folder, "runs.db")
    heavy = load.record_heavy_run(PROGRAM, database)
    long = load.add_long_run(database, heavy)
    devices = Devices(PROGRAM, folder)
    robot = robot_file(PROGRAM, folder)
    well = True
    try:
        server = load.Server(PROGRAM, folder, "--db", database, "--robot", robot)
        port = server.port
        for name, under in (
                ("nothing else", contextlib.nullcontext()),
                ("55 MB of CSV to 8 readers", load.Load(load.read_csv, port, long, count=8)),
                ("frames?limit=5000 to 4 readers",
                 load.Load(load.read_frames, port, heavy, count=4)),
                ("10,000 repeats, again and again", load.Load(load.post_batches, port)),
                ("the store locked by another program", load.Load(load.lock_store, database))):
            well = measure(name, server, devices, under) and well
        well = measure("2,000 idle connections, Stop from another address", server, devices,
                       load.Load(load.hold_connections, port, 2000), "127.0.0.2") and well
        server.end()
        well = loads_and_resets(folder) and well
        well = full_disk(folder, robot, devices) and well
    finally:
        devices.end()
    return well


def loads_and_resets(folder):
    """In simulation: on hardware a reset disarms, so there is no motion to stop."""
    server = load.Server(PROGRAM, folder, "--db", os.path.join(folder, "other.db"))
    with load.Load(load.load_and_reset, server.port, count=2):
        time.sleep(1)
        took = stops(server, "127.0.0.1")
    p50, p99 = took[len(took) // 2], took[int(len(took) * 0.99)]
    print(f"| load and reset in a loop, twice (simulated) | {len(took)} | {p50 * 1e3:.1f} | "
          f"{p99 * 1e3:.1f} | {took[-1] * 1e3:.1f} | | {server.memory('VmHWM'):.0f} |", flush=True)
    server.end()
    return p99 <= MOST["p99"] and took[-1] <= MOST["max"]


def full_disk(folder, robot, devices):
    disk = os.path.join(folder, "disk")
    os.mkdir(disk)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK_MB}m", "tmpfs", disk], check=True)
    try:
        server = load.Server(PROGRAM, folder, "--db", os.path.join(disk, "runs.db"), "--robot",
                             robot)
        with contextlib.suppress(OSError), open(os.path.join(disk, "filler"), "wb") as filler:
            while True:
                filler.write(bytes(4096))
                filler.flush()
        well = measure("a full disk", server, devices)
        server.end()
        return well
    finally:
        subprocess.run(["umount", "-l", disk], check=False)


def main():
    print("| Stop during | answers | p50 ms | p99 ms | max ms | zero at the wheels ms | peak MB |\n"
          "|---|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        sys.exit(0 if all_loads(folder) else 1)


if __name__ == "__main__":
    main()
