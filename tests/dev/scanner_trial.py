#!/usr/bin/env python3
"""tests/dev/scanner_trial.py PROGRAM: scanners that are slow, deaf, wrong or dazzled, on emulated
devices through `serve --robot`, in real time; prints the tables of docs/hardware.md.

Each set-up has to end in scans or in the right sentence, each blinding in a commanded stop within
0.3 s or two scan periods, each robot file that no device can fulfil in a sentence with its line.
Exit status 1 when anything did not.
"""
import subprocess
import sys
import tempfile
import time

from emulated_robot import Devices, Server, front_laser, robot_file, row

PROGRAM = sys.argv[1]

# The fault of the scanner, its emulation, and the server's sentence; empty: scans.
SET_UPS = [
    ("mode switches of 3 s", ["--mode-time", "3"], ""),
    ("2 s of silence after switches and power-on", ["--deaf", "2", "--boot", "2"], ""),
    ("both", ["--mode-time", "3", "--deaf", "2", "--boot", "2"], ""),
    ("found at 38400", ["--rate", "38400"], ""),
    ("found at 500000", ["--rate", "500000"], ""),
    ("RS-232, which carries no 500000", ["--rs232"], "runs at 38400 bit/s instead"),
    ("another password", ["--password", "MOBILE_1"], "--password"),
    ("NAK to everything", ["--refuse", "1000000"], "for damaged (NAK)"),
]

# A scanner's rate and step, and its period [s] on that line.
LINES = [("rate = 500000\nstep_deg = 0.5", 0.0266), ("rate = 38400\nstep_deg = 1", 0.1066),
         ("rate = 38400\nstep_deg = 0.5", 0.2131)]
BLINDINGS = [("scanner silent", "scanner silence 2"), ("all beams dazzled", "dazzle on"),
             ("20 degrees ahead dazzled", "cone 20")]

# A mistake in a robot's file, as changes of its text, and the sentence of `serve`.
FILES = [
    ("the scanner outside the hull", [("rate = 500000", "x = 0.5")], "outside of the hull"),
    ("180 degrees at 0.25 on a slow line", [("rate = 500000", "rate = 38400\nstep_deg = 0.25")],
     "interlaced"),
    ("a track of 2 m", [("track = 0.5", "track = 2")], "track must be"),
    ("2.5 m to brake", [("speed = 0.1", "speed = 0.5\nacceleration = 0.05")], "2.50 m to brake"),
    ("a watchdog of 5 s at 0.5 m/s", [("speed = 0.1", "speed = 0.5\nturn = 0.05"),
                                      ("watchdog = 0.5", "watchdog = 5")], "2.50 m before"),
]


def set_up(name, options, expected):
    with tempfile.TemporaryDirectory() as folder:
        devices = Devices(PROGRAM, folder, "roboteq", *options)
        found = devices.scanner()["baud"]
        server = Server(PROGRAM, folder, robot_file(PROGRAM, folder))

        def ready(session):
            laser = front_laser(session)
            if laser is None or not (laser["well"] or "NAK" in expected):
                return False
            return expected in " ".join([laser["sentence"], *laser["remarks"]])
        laser = front_laser(server.wait_for(name, ready, 60))
        after = time.monotonic() - server.started
        server.end()
        left = devices.scanner()["baud"]
        devices.end()
    well = left == found
    said = " ".join([laser["sentence"], *laser["remarks"]])
    print(f"| {name} | {after:.1f} s | {said} | {found}, {left} |", flush=True)
    return well


def looked_at():
    """`lms200 info` changes nothing."""
    with tempfile.TemporaryDirectory() as folder:
        devices = Devices(PROGRAM, folder, "roboteq", "--rate", "38400")
        info = subprocess.run([PROGRAM, "lms200", "info", folder + "/scanner"], check=True,
                              stdout=subprocess.PIPE, text=True).stdout
        after = devices.scanner()
        devices.end()
    print(f"| `lms200 info`, found at 38400 | | {info.splitlines()[0].split(': ')[1]} | "
          f"38400, {after['baud']} |", flush=True)
    return after["baud"] == 38400 and after["memory_writes"] == 0 and "38400 bit/s" in info


def blinding(name, command, laser, period):
    most = max(0.3, 2 * period)
    with tempfile.TemporaryDirectory() as folder:
        devices = Devices(PROGRAM, folder)
        server = Server(PROGRAM, folder, robot_file(PROGRAM, folder, laser=laser), "--unattended")
        server.drive()
        at = time.monotonic()
        devices.tell(command)
        time.sleep(1.5)
        until = time.monotonic()
        session = server.answer("GET", "/session")
        said = session["hardware"]["trouble"] or session.get("why") or f"Held: {session['hold']}."
        zero = devices.zero_after(at, until)
        server.end()
        devices.end()
    return row(f"{name}, {laser.replace(chr(10), ', ')}", "roboteq", zero, most,
               said.replace(folder, "/dev"))


def refused(name, changes, expected):
    with tempfile.TemporaryDirectory() as folder:
        path = robot_file(PROGRAM, folder, changes=changes)
        ended = subprocess.run([PROGRAM, "serve", "--port", "0", "--db", folder + "/runs.db",
                                "--robot", path], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, timeout=20, check=False)
        said = ended.stdout.strip().replace(folder + "/", "")
    print(f"| {name} | {said} |", flush=True)
    return ended.returncode != 0 and expected in said and "robot.toml:" in said


def main():
    well = True
    print("| set-up | scans or sentence after | what the server says | found at, left at |\n"
          "|---|---|---|---|", flush=True)
    for entry in SET_UPS:
        well = set_up(*entry) and well
    well = looked_at() and well
    print("\n| robot file | what `serve` says |\n|---|---|", flush=True)
    for entry in FILES:
        well = refused(*entry) and well
    print("\n| blinding | base | zero wheels after | at most | what the robot says |\n"
          "|---|---|---|---|---|", flush=True)
    for laser, period in LINES:
        for name, command in BLINDINGS:
            well = blinding(name, command, laser, period) and well
    sys.exit(0 if well else 1)


if __name__ == "__main__":
    main()
