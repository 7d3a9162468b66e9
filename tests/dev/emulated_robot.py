"""tests/dev/emulated_robot.py: `tautline emulate robot` and `tautline serve --robot` on it, for the
scripts that look at the wheels. Times are seconds of the machine's monotonic clock.
"""
import fcntl
import json
import os
import pty
import subprocess
import sys
import termios
import time

import load

WATCHDOG = {"roboteq": 0.5, "p2os": 2.0, "analog": 0.15}  # [s]
TICK = 0.026  # [s]

ROBOT = """name = "emulated"
period = {tick}
[hull]
radius = 0.35
[limits]
speed = 0.1
[[laser]]
name = "front laser"
port = "{folder}/scanner"
{laser}
[base]
port = "{folder}/base"
track = 0.5
watchdog = {watchdog}
{base}"""

FLOOR = """[psd]
port = "{folder}/psd"
x = 0.35
height = 0.1414
half_spacing = 0.1
"""

BASE = {
    "roboteq": 'type = "roboteq"\nwheel_radius = 0.10\ngear = 20\nencoder_lines = 500\n'
    "full_speed_rpm = 1000\nbumper_inputs = [1]\nrear_bumper_inputs = [2]\nbattery_low = 22\n",
    "p2os": 'type = "pioneer"\nbattery_low = 11\n',
    "analog": 'type = "analog"\nlibrary = "{library}"\nwheel_radius = 0.10\ncounts_per_turn = 2000\n'
    "speed_per_volt = 0.1\nrelay_line = 0\nrelay_closed_line = 1\nstop_line = 2\nfault_line = 3\n"
    "bumper_lines = [4]\nenable_line = 5\n",
}


def robot_file(program, folder, base="roboteq", laser="rate = 500000", changes=(), floor=False):
    """The path of a robot's file for the devices in `folder`; `changes` are pairs of old and new text.
    `floor`: with floor sensors."""
    text = ROBOT.format(tick=TICK, folder=folder, laser=laser, watchdog=WATCHDOG[base],
                        base=BASE[base].replace("{library}", comedi(program)))
    if floor:
        text += FLOOR.format(folder=folder)
    for old, new in changes:
        text = text.replace(old, new)
    path = os.path.join(folder, "robot.toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def comedi(program):
    """The library that opens emulated cards."""
    return os.path.join(os.path.dirname(os.path.realpath(program)), "libemulated_comedi.so")


class Devices:
    """`tautline emulate robot` with further `options`, and its record."""

    def __init__(self, program, folder, base="roboteq", *options, scenario="exp4"):
        self.record = os.path.join(folder, "truth")
        self.process = subprocess.Popen(
            [program, "emulate", "robot", "--links", folder, "--base", base, "--scenario", scenario,
             "--record", self.record,
             *(["--watchdog", str(WATCHDOG[base])] if base == "analog" else []), *options],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        while not os.path.exists(os.path.join(folder, "base")):
            time.sleep(0.05)

    def tell(self, line):
        self.process.stdin.write(f"{line}\n".encode())
        self.process.stdin.flush()

    def truth(self):
        """The true state of the emulator's world and devices."""
        self.tell("truth")
        while True:
            line = self.process.stdout.readline().decode()
            if line.startswith("{"):
                return json.loads(line)

    def scanner(self):
        """The emulator's state of its scanner."""
        return self.truth()["scanner"]

    def end(self):
        self.process.terminate()
        self.process.wait()

    def lines(self, kind, begin, until):
        """Numbers of the record's lines of this kind, in time order."""
        self.tell("nak 0")  # an event, which has the record written out
        time.sleep(0.3)
        with open(self.record, encoding="utf-8") as file:
            for line in file:
                words = line.split()
                if words[0] == kind and begin <= float(words[1]) <= until:
                    yield [float(word) for word in words[1:]]

    def zero_after(self, event, until):
        """[s] from `event` to the first zero command without a later motion until `until`."""
        zero = None
        for when, left, right in self.lines("wheels", event, until):
            still = abs(left) < 0.05 and abs(right) < 0.05
            zero = (zero or when - event) if still else None
        return zero

    def rest_after(self, event, until):
        """[s] from `event` until the wheels stand and stay so until `until`."""
        rest = None
        for when, _, _, _, left, right in self.lines("pose", event, until):
            still = abs(left) < 0.5 and abs(right) < 0.5  # [mm/s]
            rest = (rest or when - event) if still else None
        return rest


class Server(load.Server):
    """`tautline serve --robot` with a fresh store in `folder`, on request with a terminal of its own."""

    def __init__(self, program, folder, robot, *more, terminal=False):
        self.started = time.monotonic()
        self.terminal = None
        options = {}
        if terminal:
            self.terminal, inner = pty.openpty()
            options = {"stdin": inner, "start_new_session": True,
                       "preexec_fn": lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0)}
        super().__init__(program, folder, "--db", os.path.join(folder, "runs.db"), "--robot", robot,
                         *more, **options)
        if terminal:
            os.close(inner)

    def answer(self, method, path, body=None):
        """The JSON of the answer; {"refused": TEXT} for an error status."""
        status, _, text = self.ask(method, path, body)
        return json.loads(text) if status < 300 else {"refused": text.decode()}

    def look_for(self, condition, seconds):
        """The session once the condition holds; None when it does not within `seconds`."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            session = self.answer("GET", "/session")
            if condition(session):
                return session
            time.sleep(0.05)
        return None

    def wait_for(self, what, condition, seconds=40):
        session = self.look_for(condition, seconds)
        if session is None:
            sys.exit(f"{what}: not within {seconds} s: "
                     f"{json.dumps(self.answer('GET', '/session').get('hardware'))}")
        return session

    def scanner_back(self):
        """[s] from the start of the program until the scanner has no fault."""
        def well(session):
            laser = front_laser(session)
            return laser is not None and laser["well"]
        self.wait_for("scanner", well)
        return time.monotonic() - self.started

    def arm(self):
        """Asks again where a moment of a busy machine refused it or disarmed the robot."""
        def motors_on(session):
            hardware = session.get("hardware") or {}
            if not hardware.get("armed"):
                self.answer("POST", "/session/control", {"action": "arm"})
            return hardware.get("halt") == "none"
        self.wait_for("motors on", motors_on)

    def drive(self):
        """Waits until the robot has driven 0.1 m of 5, with signs of life meanwhile."""
        self.arm()
        self.answer("PUT", "/session/goal", {"x": 5.0, "y": 0.0})
        begin = self.wait_for("a pose", lambda s: "pose" in s)["pose"]["x"]

        def moved(session):
            self.answer("POST", "/session/watch", {})
            return session["pose"]["x"] > begin + 0.1
        self.wait_for("motion", moved)

    def close_terminal(self):
        os.close(self.terminal)
        self.process.wait(20)


def front_laser(session):
    devices = (session.get("hardware") or {}).get("devices", [])
    return next((d for d in devices if d["name"] == "front laser"), None)


def row(event, base, zero, most, more=""):
    """Prints a row of docs/hardware.md; true if the wheels were commanded to stop in time."""
    shown = "never" if zero is None else f"{1000 * zero:.0f} ms"
    print(f"| {event} | {base} | {shown} | {1000 * most:.0f} ms | {more} |", flush=True)
    return zero is not None and zero <= most
