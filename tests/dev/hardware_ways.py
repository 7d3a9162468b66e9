#!/usr/bin/env python3
"""tests/dev/hardware_ways.py PROGRAM [short] [strip|strip_moving]: `tautline serve --robot` at 0.5 m/s on
an emulated Roboteq and LMS200, in real time, by the wheels alone: through doors, past people who cross
its way, and before a door that opens late; prints the table of docs/hardware.md.

The emulator's world tells the truth: where the robot is, its room, and whether it touched anything.
People yield to nobody, and only strip_moving looks out for them; somebody who walks into a robot at
rest ends the way without blame. `short` drives one way of each sort. Exit status 1 when a way did not
end at its goal, or the robot touched something.
"""
import json
import math
import os
import sys
import tempfile
import time

from emulated_robot import Devices, Server, robot_file

PROGRAM = sys.argv[1]
SHORT = "short" in sys.argv[2:]
CONTROLLERS = [name for name in sys.argv[2:] if name != "short"] or ["strip", "strip_moving"]
SPEED = 0.5  # [m/s]
WALK = 1.2  # [m/s] of a person
NEAR = 0.25  # [m] off the goal at most: its reach, and the wheels' error on the way
WHEEL_ERROR = {"odometry_scale": 0.01, "odometry_noise": 0.01}
LATE = 60  # [s] for one way
AT_REST = 0.05  # [m/s]
OPENS = 25.0  # [s] after the start of the world


def wall(begin, end, y_or_x, upright):
    line = ([y_or_x, begin], [y_or_x, end]) if upright else ([begin, y_or_x], [end, y_or_x])
    return {"type": "wall", "from": line[0], "to": line[1], "thickness": 0.1}


def rooms(length, half):
    """The outer walls, 1.2 m behind the start."""
    return [wall(-1.2, length, -half, False), wall(-1.2, length, half, False),
            wall(-half, half, -1.2, True), wall(-half, half, length, True)]


def two_rooms(door, middle):
    """Rooms of 3 m with a door of this width [m] between them, its middle at y = `middle`."""
    half = 1.6
    return rooms(4.8, half) + [wall(-half, middle - door / 2, 2.2, True),
                               wall(middle + door / 2, half, 2.2, True)]


def person(x, phase):
    """Walks across at `x` and back, and rests 3 s at either wall."""
    side, rest = 2.2, 3.0
    walk = 2 * side / WALK
    keys = [[0, x, -side], [rest, x, -side], [rest + walk, x, side], [2 * rest + walk, x, side],
            [2 * rest + 2 * walk, x, -side]]
    return {"type": "cylinder", "x": x, "y": -side, "radius": 0.25,
            "path": {"period": 2 * (rest + walk), "phase": phase, "keys": keys}}


def late_door(width):
    """Stands in the door of two_rooms(width, 0), and slides aside at OPENS."""
    end = 36_000
    return {"type": "box", "x": 2.2, "y": 0, "heading": math.pi / 2, "length": width, "width": 0.06,
            "path": {"period": end, "keys": [[0, 2.2, 0], [OPENS, 2.2, 0], [OPENS + 1.5, 2.2, width],
                                             [end, 2.2, width]]}}


def ways(controller):
    """(words, obstacles, goal, whether the robot has to wait)"""
    for width in (0.80,) if SHORT else (0.80, 0.90, 1.00):
        if not SHORT:
            yield f"door of {width:.2f} m, straight on", two_rooms(width, 0), (3.8, 0), False
        yield f"door of {width:.2f} m, aside", two_rooms(width, 0.7), (3.8, -0.6), False
    phases = (0,) if SHORT else (0, 2, 4, 6)
    for phase in phases if controller == "strip_moving" else ():
        people = [person(1.8, phase), person(3.4, phase + 3)]
        yield f"two people cross, {phase} s on", rooms(6, 3) + people, (5, 0), False
    yield "door of 0.90 m, shut at first", two_rooms(0.9, 0) + [late_door(0.9)], (3.8, 0), True


def world(folder, obstacles, start=(0, 0, 0)):
    path = os.path.join(folder, "world.json")
    document = {"name": "ways", "start": dict(zip(("x", "y", "heading"), start)),
                "drive": WHEEL_ERROR,
                "obstacles": [{"id": i + 1, **o} for i, o in enumerate(obstacles)]}
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    return path


def fast_robot(folder, controller):
    return robot_file(PROGRAM, folder, changes=[
        ("speed = 0.1", f"speed = {SPEED}"), ("period = ", f'controller = "{controller}"\nperiod = '),
        ("full_speed_rpm = 1000", "full_speed_rpm = 2000")])


def follow(server, devices, goal):
    """Watches the way until its end: the session, the truth, what the robot said, the least true room, and the last
    time at which it touched nothing."""
    said, least, clear = [], math.inf, time.monotonic()
    end = time.monotonic() + LATE
    while time.monotonic() < end:
        server.answer("POST", "/session/watch", {})
        session = server.answer("GET", "/session")
        truth = devices.truth()
        clear = clear if truth["collided"] else truth["time"]
        least = min(least, truth["clearance"])
        words = session.get("what", "")
        if words and (not said or said[-1] != words):
            said.append(words)
        if session.get("mission") == "arrived" or truth["collided"]:
            break
        time.sleep(0.05)
    return session, truth, said, least, clear


def speed_at(devices, when):
    """[m/s] The true speed at the newest recorded pose before `when`; the record has ten a second."""
    poses = list(devices.lines("pose", when - 0.5, when))
    return (poses[-1][4] + poses[-1][5]) / 2000 if poses else 0.0


def drive(name, obstacles, goal, waits, controller):
    with tempfile.TemporaryDirectory() as folder:
        devices = Devices(PROGRAM, folder, "roboteq", scenario=world(folder, obstacles))
        server = Server(PROGRAM, folder, fast_robot(folder, controller))
        try:
            server.arm()
            begin = time.monotonic()
            server.answer("PUT", "/session/goal", {"x": goal[0], "y": goal[1]})
            session, truth, said, least, clear = follow(server, devices, goal)
            took = time.monotonic() - begin
            speed = speed_at(devices, clear)
        finally:
            server.end()
            devices.end()
    off = math.dist(truth["pose"][:2], goal)
    stopped = any("no way" in words.lower() or "blocked" in words.lower() for words in said)
    walked_into = truth["collided"] and speed < AT_REST
    arrived = session.get("mission") == "arrived" and off < NEAR and not truth["collided"]
    well = walked_into or (arrived and (stopped or not waits))
    end = "walked into at rest" if walked_into else "touched" if truth["collided"] else session.get("mission")
    print(f"| {name} | {controller} | {end} | {took:.1f} | {1000 * least:.0f} | {1000 * off:.0f} |",
          flush=True)
    if not well or os.environ.get("TAUTLINE_TALK"):
        print(f"{name}, {controller}: {said}, {truth['pose']}, {speed:.2f} m/s, missed {truth['missed_steps']}, "
              f"{json.dumps(session.get('hardware', {}).get('trouble'))}", file=sys.stderr)
    return well


def main():
    print("| way | controller | end | time [s] | least room [mm] | off the goal [mm] |\n"
          "|---|---|---|---|---|---|", flush=True)
    well = True
    for controller in CONTROLLERS:
        for way in ways(controller):
            well = drive(*way, controller) and well
    sys.exit(0 if well else 1)


if __name__ == "__main__":
    main()
