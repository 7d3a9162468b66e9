"""tests/server/external/faulty.py FAULT: drives straight on for three ticks, then breaks the protocol.

FAULT: raises, exits, silent, babbles, huge, nan, wrong_tick, prints, none.
"""
import os
import struct
import sys
import time

import tautline

fault = sys.argv[1]


def send_raw(data):
    os.write(int(os.environ["TAUTLINE_CONTROLLER_FD"]), data)


def update(seen):
    if fault == "prints":
        print("x" * 5000)
    if seen.tick < 3 or fault in ("none", "prints"):
        return 0.2, 0.0
    if fault == "raises":
        raise ValueError("no way at tick %d" % seen.tick)
    if fault == "exits":
        os._exit(7)
    if fault == "silent":
        time.sleep(60)
    if fault == "babbles":
        send_raw(struct.pack("<I", 40) + b"not a message " * 4)
        time.sleep(60)
    if fault == "huge":
        send_raw(struct.pack("<I", 1 << 31))
        time.sleep(60)
    if fault == "wrong_tick":
        seen.tick += 1
    return (float("nan") if fault == "nan" else 0.2), 0.0


tautline.drive(update)
