#!/usr/bin/env python3
"""tests/dev/hardware_stops.py PROGRAM [roboteq|p2os]: what becomes of the wheels when the server or
its operator goes, on emulated devices, in real time; prints rows of the table in docs/hardware.md.

The server is killed (kill -9), ended (SIGTERM, Ctrl-C), left by whoever asked over REST, by a page
that is closed and by one whose network is lost. After kill -9 the server is started again: the
scanner, which still streams at 500000 bit/s, has to be back in 5 s. Exit status 1 when anything took
longer than it may.
"""
import base64
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request

PROGRAM = sys.argv[1]
BASES = sys.argv[2:] or ["roboteq", "p2os"]
WATCHDOG = {"roboteq": 0.5, "p2os": 2.0}  # [s]
TICK = 0.026  # [s]
PATIENCE = 3.0  # [s] server/operator_watch.hpp
SLACK = 0.2  # [s] a look every 0.1 s, and a busy machine
REATTACH = 5.0  # [s]


def robot_file(folder, base):
    kind = {
        "roboteq": 'type = "roboteq"\nwheel_radius = 0.10\ngear = 20\nencoder_lines = 500\n'
        "full_speed_rpm = 1000\nbumper_inputs = [1]\n",
        "p2os": 'type = "pioneer"\n',
    }[base]
    path = os.path.join(folder, "robot.toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(
            f'name = "emulated"\nperiod = {TICK}\n[hull]\nradius = 0.35\n[limits]\nspeed = 0.1\n'
            f'[[laser]]\nname = "front laser"\nport = "{folder}/scanner"\nrate = 500000\n'
            f'[base]\nport = "{folder}/base"\ntrack = 0.50\nwatchdog = {WATCHDOG[base]}\n{kind}'
        )
    return path


class Devices:
    """`tautline emulate robot` and its record."""

    def __init__(self, folder, base):
        self.record = os.path.join(folder, "truth")
        self.process = subprocess.Popen(
            [PROGRAM, "emulate", "robot", "--links", folder, "--base", base, "--scenario", "exp4",
             "--record", self.record],
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not os.path.exists(os.path.join(folder, "base")):
            time.sleep(0.05)

    def end(self):
        self.process.terminate()
        self.process.wait()

    def zero_after(self, event, until):
        """[s] from `event` to the first zero that no motion follows until `until`."""
        self.process.stdin.write(b"nak 0\n")  # an event, which has the record written out
        self.process.stdin.flush()
        time.sleep(0.3)
        zero = None
        with open(self.record, encoding="utf-8") as file:
            for line in file:
                if not line.startswith("wheels"):
                    continue
                _, when, left, right = line.split()
                if not event <= float(when) <= until:
                    continue
                still = abs(float(left)) < 0.05 and abs(float(right)) < 0.05
                zero = (zero or float(when) - event) if still else None
        return zero


class Server:
    """`tautline serve --robot` on a free port."""

    def __init__(self, folder, robot, *more):
        self.started = time.monotonic()
        self.log = open(os.path.join(folder, "log"), "w+", encoding="utf-8")
        self.process = subprocess.Popen(
            [PROGRAM, "serve", "--port", "0", "--db", os.path.join(folder, "runs.db"), "--robot",
             robot, *more], stdout=self.log, stderr=subprocess.STDOUT)
        self.url = None
        while self.url is None:
            time.sleep(0.02)
            with open(self.log.name, encoding="utf-8") as file:
                for word in file.read().split():
                    if word.startswith("http://"):
                        self.url = word.rstrip("/")
        self.port = int(self.url.rsplit(":", 1)[1])

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(
            f"{self.url}/api/v1{path}", data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=5) as answer:
                return json.loads(answer.read())
        except urllib.error.HTTPError as error:
            return {"refused": error.read().decode()}

    def wait_for(self, what, condition, seconds=40):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            session = self.ask("GET", "/session")
            if condition(session):
                return session
            time.sleep(0.05)
        sys.exit(f"{what}: not within {seconds} s: {json.dumps(session.get('hardware'))}")

    def scanner_back(self):
        """[s] from the start of the program until the scanner is well."""
        def well(session):
            hardware = session.get("hardware") or {}
            return any(device["name"] == "front laser" and device["well"]
                       for device in hardware.get("devices", []))
        self.wait_for("scanner", well)
        return time.monotonic() - self.started

    def drive(self):
        self.wait_for("ready to be armed",
                      lambda s: "refused" not in self.ask("POST", "/session/control",
                                                          {"action": "arm"}))
        self.ask("PUT", "/session/goal", {"x": 5.0, "y": 0.0})
        begin = self.wait_for("a pose", lambda s: "pose" in s)["pose"]["x"]
        self.wait_for("motion", lambda s: s["pose"]["x"] > begin + 0.1)

    def end(self, sign=signal.SIGTERM):
        self.process.send_signal(sign)
        self.process.wait()


class Page:
    """A WebSocket client that answers pings until it is told not to."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port))
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n"
            "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n".encode())
        self.answering = True
        self.stream = self.socket.makefile("rb")
        while self.stream.readline().strip():
            pass
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        try:
            while True:
                head = self.stream.read(2)
                if len(head) < 2:
                    return
                size = head[1] & 0x7F
                if size > 125:
                    size = int.from_bytes(self.stream.read(2 if size == 126 else 8), "big")
                payload = self.stream.read(size)
                if head[0] & 0x0F == 9 and self.answering:
                    self.socket.sendall(bytes([0x8A, 0x80 | len(payload), 0, 0, 0, 0]) + payload)
        except (OSError, ValueError):
            pass

    def close(self):
        self.socket.shutdown(socket.SHUT_RDWR)
        self.socket.close()


def row(event, base, zero, most, more=""):
    held = zero is not None and zero <= most
    shown = "never" if zero is None else f"{1000 * zero:.0f} ms"
    print(f"| {event} | {base} | {shown} | {1000 * most:.0f} ms | {more} |", flush=True)
    return held


def ended(folder, robot, base, devices):
    """Rows of a server that goes."""
    well = True
    for event, sign, most in (("kill -9", signal.SIGKILL, WATCHDOG[base] + SLACK),
                              ("SIGTERM", signal.SIGTERM, 0.5), ("Ctrl-C", signal.SIGINT, 0.5)):
        server = Server(folder, robot, "--unattended")
        server.drive()
        at = time.monotonic()
        server.end(sign)
        time.sleep(most + 0.5)
        zero = devices.zero_after(at, time.monotonic())
        more = ""
        if sign == signal.SIGKILL:
            again = Server(folder, robot)
            back = again.scanner_back()
            again.end()
            more = f"started again: scanner back after {back:.1f} s"
            well = well and back < REATTACH
        well = row(event, base, zero, most, more) and well
    return well


def abandoned(folder, robot, base, devices):
    """Rows of an operator that goes."""
    most = PATIENCE + SLACK + TICK
    well = True
    for event in ("nobody asks over REST", "page closed", "network lost"):
        server = Server(folder, robot)
        page = None if event.startswith("nobody") else Page(server.port)
        server.drive()
        if page:
            time.sleep(PATIENCE + 2)  # only the page is there now
            asked = server.ask("GET", "/session")
            if not asked["hardware"]["armed"]:
                sys.exit(f"{event}: a page is open, and the robot was disarmed")
            time.sleep(PATIENCE + 1)
        at = time.monotonic()
        if page:
            page.answering = False
            if event == "page closed":
                page.close()
        time.sleep(most + 0.7)
        until = time.monotonic()
        said = server.ask("GET", "/session")["hardware"]["trouble"]
        well = row(event, base, devices.zero_after(at, until), most, said) and well
        server.end()
    return well


def main():
    well = True
    print("| event | base | zero wheels after | at most | then |\n|---|---|---|---|---|", flush=True)
    for base in BASES:
        with tempfile.TemporaryDirectory() as folder:
            robot = robot_file(folder, base)
            devices = Devices(folder, base)
            try:
                well = ended(folder, robot, base, devices) and well
                well = abandoned(folder, robot, base, devices) and well
            finally:
                devices.end()
    sys.exit(0 if well else 1)


main()
