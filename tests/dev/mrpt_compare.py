#!/usr/bin/env python3
"""tests/dev/mrpt_compare.py NAME TRUTH FOLDER: scans that MRPT stored (rawlog-edit's text export in
FOLDER) against the record of `tautline emulate`. Exit status 1 on any difference or when there is
too little to compare."""
import glob
import sys

WIRE_FREE, WIRE_CODES = 65535, 65519


def truth(path):
    """Beams of each scan sent intact; None where the device had no distance."""
    scans = []
    for line in open(path):
        words = line.split()
        if words[0] != "scan" or words[4] != "sent":
            continue
        beams = [int(w) for w in words[6:]]
        scans.append([b if b <= WIRE_CODES else None for b in beams])
    return scans


def stored(folder):
    """Ranges [m] of each scan: a line is its time, the ranges and as many flags."""
    files = glob.glob(folder + "/*LASER.txt")
    if not files:
        sys.exit("rawlog-edit exported nothing")
    rows = [line.split() for line in open(files[0]) if not line.startswith("%")]
    return [[float(w) for w in row[1:1 + len(row) // 2]] for row in rows if row]


def same(ranges, beams):
    """The largest difference [mm], or None when they are not of the same scan."""
    if len(ranges) != len(beams):
        return None
    widest = 0.0
    for r, b in zip(ranges, beams):
        if b is None:  # MRPT keeps the code as a distance of 8, 32 or 81 m
            if r < 8:
                return None
            continue
        widest = max(widest, abs(1000 * r - b))
    return widest


def main():
    name, path, folder = sys.argv[1:]
    sent, got = truth(path), stored(folder)
    at, matched, worst = 0, 0, 0.0
    for number, ranges in enumerate(got):
        for i in range(at, len(sent)):
            difference = same(ranges, sent[i])
            if difference is not None and difference < 0.5:
                at, matched, worst = i + 1, matched + 1, max(worst, difference)
                break
        else:
            sys.exit(f"{name}: scan {number} of MRPT's {len(got)} was never sent")
    beams = sum(b is not None for b in sent[0]) if sent else 0
    print(f"{name}: {matched} scans of {len(got[0]) if got else 0} values, "
          f"{beams} distances each, widest difference {worst:.3f} mm")
    if matched < 10:
        sys.exit(f"{name}: too few scans")


main()
