#!/usr/bin/env python3
"""tests/dev/memory_mix.py PROGRAM [MINUTES=20] [LIMIT_MB=512]: memory under all heavy requests at once.

Eight readers of a 55 MB CSV, four of heavy frames, lists, batches of 10,000 runs, loads and resets,
and a store that is locked now and then. Prints a row a minute. Exit status 1 when the program ends,
passes the limit, or its memory in the second half of the time lies a tenth above the first.
"""
import contextlib
import os
import statistics
import sys
import tempfile
import time

import load

PROGRAM = sys.argv[1]
MINUTES = float(sys.argv[2]) if len(sys.argv) > 2 else 20.0
LIMIT = float(sys.argv[3]) if len(sys.argv) > 3 else 512.0  # [MB]


def watch(server):
    """[MB] of resident memory, a sample a second."""
    samples = []
    end = time.monotonic() + MINUTES * 60
    while time.monotonic() < end and server.running():
        time.sleep(1)
        samples.append(server.memory("VmRSS"))
        if len(samples) % 60 == 0:
            print(f"{len(samples) // 60} min: {samples[-1]:.0f} MB, "
                  f"peak {server.memory('VmHWM'):.0f} MB", flush=True)
    return samples


def main():
    with tempfile.TemporaryDirectory() as folder:
        database = os.path.join(folder, "runs.db")
        heavy = load.record_heavy_run(PROGRAM, database)
        long = load.add_long_run(database, heavy)
        server = load.Server(PROGRAM, folder, "--db", database)
        port = server.port
        with contextlib.ExitStack() as mix:
            for one in (load.Load(load.read_csv, port, long, count=8),
                        load.Load(load.read_frames, port, heavy, count=4),
                        load.Load(load.read_lists, port, long, count=2),
                        load.Load(load.post_batches, port),
                        load.Load(load.load_and_reset, port),
                        load.Load(load.lock_store, database)):
                mix.enter_context(one)
            samples = watch(server)
        if not server.running():
            sys.exit(f"the program ended after {len(samples)} s:\n{server.said()[-2000:]}")
        peak = server.memory("VmHWM")
        server.end()
    settled = samples[len(samples) // 5:]  # the first fifth warms up
    half = len(settled) // 2
    early, late = statistics.median(settled[:half]), statistics.median(settled[half:])
    print(f"peak {peak:.0f} MB of {LIMIT:.0f}; median {early:.0f} MB, then {late:.0f} MB")
    sys.exit(0 if peak < LIMIT and late < early * 1.1 + 5 else 1)


if __name__ == "__main__":
    main()
