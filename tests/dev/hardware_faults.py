#!/usr/bin/env python3
"""tests/dev/hardware_faults.py PROGRAM [floor] [roboteq|p2os|analog]: each fault of tests/hardware/faults.json
(with `floor`: of floor_faults.json, on a robot with floor sensors) while `tautline serve --robot` drives
emulated devices, in real time; prints the table of docs/hardware.md.

"Zero command" and "wheels stand" come from the emulator's record, not from the server. Exit status 1
when anything took longer than it may, or went on though it should not.
"""
import json
import os
import sys
import tempfile
import time

from emulated_robot import Devices, Server, TICK, WATCHDOG, robot_file

PROGRAM = sys.argv[1]
FLOOR_ONLY = "floor" in sys.argv[2:]
BASES = [base for base in sys.argv[2:] if base != "floor"] or ["roboteq", "p2os", "analog"]
LIST = "floor_faults.json" if FLOOR_ONLY else "faults.json"
HERE = os.path.dirname(os.path.abspath(__file__))
AWAKE = 0.05  # [s] for threads to wake up on a busy machine
SCANS = 3 * 0.0267 + 0.02 + 0.015  # [s] three scan periods, a USB chip, the line
FLOOR = 3 * 0.0383 + 0.02 + 0.004  # [s] three of the floor sensors' periods, a USB chip, the line
STUCK = 20 * 0.0383  # [s] readings until a count passes for stuck
SLOW = 11 * 3 * 0.0383  # [s] eleven slow lines at most until the adapter passes for slow
REPORT = {"roboteq": 0.165, "p2os": 0.1 + 0.065, "analog": 0.026}  # [s] between two reports, plus the transfer
SETTLED = 1.0  # [s] after the limit, without new motion


def limit(expected, base):
    """[s] from the fault to a zero command, at most; None when the robot must go on."""
    return {
        "goes on": None,
        "scans": SCANS + TICK + AWAKE,
        "floor": FLOOR + TICK + AWAKE,
        "slow": SLOW + FLOOR + TICK + AWAKE,
        "stuck": STUCK + FLOOR + TICK + AWAKE,
        "base": 0.3 + TICK + AWAKE,
        "report": REPORT[base] + TICK + AWAKE,
        "wheels": 0.3,
        "battery": 3 + REPORT[base] + TICK + AWAKE,
        "blind": 0.3,
        "storm": 2.0,
        "watchdog": WATCHDOG[base] + 0.1,
    }[expected]


def words(session, folder):
    """The robot's sentence: of the hardware, else of the pipeline."""
    said = (session.get("hardware") or {}).get("trouble") or ""
    if not said and session.get("hold") not in (None, "none", "halted"):
        said = session.get("why") or f"Held: {session['hold']}."
    return said.replace(folder + "/", "/dev/")


def moves(session):
    return (session.get("hardware") or {}).get("halt") == "none" and session.get("hold") == "none"


def goes_on(server):
    """What the robot does after the fault."""
    if server.look_for(moves, 5):
        return "by itself"
    server.arm()
    return "armed again" if server.look_for(moves, 5) else "no"


def trial(fault, base, folder):
    devices = Devices(PROGRAM, folder, base, *(["--psd"] if FLOOR_ONLY else []))
    server = Server(PROGRAM, folder, robot_file(PROGRAM, folder, base, floor=FLOOR_ONLY),
                    "--unattended")
    try:
        if fault.get("at_rest"):
            server.arm()
            time.sleep(2)
        else:
            server.drive()
        most = limit(fault["expected"], base)
        at = time.monotonic()
        devices.tell(fault["command"])
        until = at + (most or 2.0) + SETTLED
        said = ""
        while time.monotonic() < until:
            said = said or words(server.answer("GET", "/session"), folder)
            time.sleep(0.02)
        zero = devices.zero_after(at, until)
        rest = devices.rest_after(at, until)
        if "recovery" in fault:
            devices.tell(fault["recovery"])
        on = "" if most is None else goes_on(server)
    finally:
        server.end()
        devices.end()
    if fault.get("at_rest"):  # zero was commanded throughout: the wheels must stand
        zero = rest
    held = zero is None if most is None else zero is not None and zero <= most + 0.1 * bool(
        fault.get("at_rest"))
    milliseconds = lambda seconds: "goes on" if seconds is None else f"{1000 * seconds:.0f} ms"
    shown = "" if most is None else f"{1000 * most:.0f} ms"
    print(f"| {fault['fault']} | {base} | {said} | {milliseconds(zero)} | {shown} | "
          f"{milliseconds(rest)} | {on} |", flush=True)
    if not held:
        print(f"{fault['fault']}, {base}: not as expected", file=sys.stderr)
    return held


def main():
    with open(os.path.join(HERE, "../hardware", LIST), encoding="utf-8") as file:
        faults = json.load(file)
    print("| fault | base | what the robot says | zero command after | at most | wheels stand after | "
          "goes on |\n|---|---|---|---|---|---|---|", flush=True)
    well = True
    for base in BASES:
        for fault in faults:
            with tempfile.TemporaryDirectory() as folder:
                well = trial(fault, base, folder) and well
    sys.exit(0 if well else 1)


main()
