#!/usr/bin/env python3
"""tests/dev/bench_instructions.py BENCH [--only P1,P2] [--calls N] [--out FILE] [--against FILE]

Instructions of one call of everything that the benchmark BENCH (tautline_bench) times, counted by
valgrind's callgrind: the same on a busy machine. --against compares with a file of --out and fails
where something takes more than 3 % more. Needs valgrind.
"""
import argparse
import glob
import json
import re
import subprocess
import sys
import tempfile

LIMIT = 1.03


def count(bench, only, calls):
    """{name: instructions of a call}"""
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", "--toggle-collect=bench_counted",
                   "--dump-after=bench_counted", f"--callgrind-out-file={folder}/out",
                   bench, "--count", str(calls)] + (["--only", only] if only else [])
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{done.stderr[-2000:]}\nbench_instructions: the benchmark failed under valgrind")
        names = [line.split("\t") for line in done.stdout.splitlines() if line.startswith("counted ")]
        totals = []
        for k in range(1, len(names) + 1):
            text = "".join(open(path).read() for path in glob.glob(f"{folder}/out.{k}"))
            totals.append(int(re.search(r"^totals: (\d+)", text, re.M).group(1)))
        return {name.removeprefix("counted "): total / int(n) for (name, n), total in zip(names, totals)}


def main():
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("bench")
    asked.add_argument("--only")
    asked.add_argument("--calls", type=int, default=50)
    asked.add_argument("--out")
    asked.add_argument("--against")
    options = asked.parse_args()
    counted = count(options.bench, options.only, options.calls)
    before = json.load(open(options.against)) if options.against else {}
    worse = 0
    for name, instructions in counted.items():
        ratio = instructions / before[name] if before.get(name) else None
        more = ratio is not None and ratio > LIMIT
        worse += more
        print(f"{name:60} {instructions:14.0f}" + (f"  {ratio:7.3f} x" if ratio else "") + ("  MORE" if more else ""))
    if options.out:
        json.dump(counted, open(options.out, "w"), indent=1)
    sys.exit(1 if worse else 0)


main()
