#!/usr/bin/env python3
"""tests/dev/hardware_stops.py PROGRAM [roboteq|p2os|analog]: what becomes of the wheels when the server or
its operator goes, on emulated devices, in real time; prints rows of the table in docs/hardware.md.

The server is killed (kill -9), ended (SIGTERM, Ctrl-C, SIGHUP), left without its terminal, stopped
for a while (SIGSTOP), left by a script, by a page that is closed and by one whose network is lost. After
kill -9 the server is started again: the scanner, which still streams at 500000 bit/s, has to be back
in 5 s. Exit status 1 when anything took longer than it may.
"""
import base64
import json
import os
import signal
import socket
import struct
import sys
import tempfile
import threading
import time

from emulated_robot import Devices, Server, TICK, WATCHDOG, robot_file, row

PROGRAM = sys.argv[1]
BASES = sys.argv[2:] or ["roboteq", "p2os", "analog"]
PATIENCE = 1.5  # [s] server/serve/operator_watch.hpp
SLACK = 0.2  # [s] polling at 10 Hz on a busy machine
REATTACH = 5.0  # [s]
ASLEEP = 3.0  # [s]

signal.signal(signal.SIGHUP, signal.SIG_DFL)  # `nohup` ignores it, in children too


class Page:
    """A WebSocket client that sends signs of life until switched off, and answers every ping."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port))
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n"
            "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n".encode())
        self.answering = True
        self.service = 0
        self.stream = self.socket.makefile("rb")
        while self.stream.readline().strip():
            pass
        threading.Thread(target=self.listen, daemon=True).start()
        threading.Thread(target=self.watch, daemon=True).start()

    def watch(self):
        """Calls the service /watch, which the server has advertised by then."""
        try:
            while True:
                if self.answering and self.service:
                    body = b"\x02" + struct.pack("<III", self.service, 1, 4) + b"json{}"
                    self.socket.sendall(bytes([0x82, 0x80 | len(body), 0, 0, 0, 0]) + body)
                time.sleep(0.4)
        except OSError:
            pass

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
                if b'"advertiseServices"' in payload[:200]:
                    named = {s["name"]: s["id"] for s in json.loads(payload)["services"]}
                    self.service = named["/watch"]
                if head[0] & 0x0F == 9:
                    self.socket.sendall(bytes([0x8A, 0x80 | len(payload), 0, 0, 0, 0]) + payload)
        except (OSError, ValueError):
            pass

    def close(self):
        self.socket.shutdown(socket.SHUT_RDWR)
        self.socket.close()


def ended(folder, robot, base, devices):
    """Rows of a server that ends."""
    well = True
    for event, sign, most in (("kill -9", signal.SIGKILL, WATCHDOG[base] + SLACK),
                              ("SIGTERM", signal.SIGTERM, 0.3), ("Ctrl-C", signal.SIGINT, 0.3),
                              ("SIGHUP", signal.SIGHUP, 0.3), ("its terminal closes", None, 0.3)):
        server = Server(PROGRAM, folder, robot, "--unattended", terminal=sign is None)
        server.drive()
        at = time.monotonic()
        if sign is None:
            server.close_terminal()
        else:
            server.end(sign)
        time.sleep(most + 0.5)
        zero = devices.zero_after(at, time.monotonic())
        more = ""
        if sign == signal.SIGKILL:
            again = Server(PROGRAM, folder, robot)
            back = again.scanner_back()
            again.end()
            more = f"started again: scanner back after {back:.1f} s"
            well = well and back < REATTACH
        well = row(event, base, zero, most, more) and well
    return well


def asleep(folder, robot, base, devices):
    """The row of a server that is stopped for a while: its base stops by itself meanwhile."""
    most = WATCHDOG[base] + SLACK
    server = Server(PROGRAM, folder, robot, "--unattended")
    server.drive()
    at = time.monotonic()
    server.process.send_signal(signal.SIGSTOP)
    time.sleep(ASLEEP)
    server.process.send_signal(signal.SIGCONT)
    time.sleep(3)
    said = server.answer("GET", "/session")["hardware"]
    zero = devices.zero_after(at, time.monotonic())
    server.end()
    return row(f"SIGSTOP, {ASLEEP:.0f} s later SIGCONT", base, zero, most,
               said["trouble"]) and not said["armed"]


def abandoned(folder, robot, base, devices):
    """Rows of an operator that leaves."""
    most = PATIENCE + SLACK + TICK
    well = True
    for event in ("a script renews no more", "page closed", "network lost"):
        server = Server(PROGRAM, folder, robot)
        page = None if event.startswith("a script") else Page(server.port)
        server.drive()
        if page:
            time.sleep(PATIENCE + 2)  # only the page is left
            asked = server.answer("GET", "/session")
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
        said = server.answer("GET", "/session")["hardware"]["trouble"]
        well = row(event, base, devices.zero_after(at, until), most, said) and well
        server.end()
    return well


def main():
    well = True
    print("| event | base | zero wheels after | at most | then |\n|---|---|---|---|---|", flush=True)
    for base in BASES:
        with tempfile.TemporaryDirectory() as folder:
            robot = robot_file(PROGRAM, folder, base)
            devices = Devices(PROGRAM, folder, base)
            try:
                well = ended(folder, robot, base, devices) and well
                well = asleep(folder, robot, base, devices) and well
                well = abandoned(folder, robot, base, devices) and well
            finally:
                devices.end()
    sys.exit(0 if well else 1)


if __name__ == "__main__":
    main()
