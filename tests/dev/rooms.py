#!/usr/bin/env python3
"""tests/dev/rooms.py [OUTPUT=docs/pictures/rooms.svg]: a picture of which room includes which.

A box for each room with its number of lines; an arrow from a room to each room that it includes,
without the arrows that a chain of others implies.
"""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUTPUT = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/pictures/rooms.svg"
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
WIDTH, HEIGHT, GAP_X, GAP_Y, MARGIN = 150, 46, 44, 54, 16  # [px]
LANE = 12  # [px] between arrows that pass beside boxes


def rooms():
    """The folders with a CMakeLists.txt of their own, the longest names first."""
    folders = [path.parent.relative_to(ROOT).as_posix()
               for top in ("algo", "sim", "drivers", "db", "server")
               for path in (ROOT / top).rglob("CMakeLists.txt")]
    return sorted((name for name in folders if name != "server"), key=len, reverse=True)


def room_of(path, names):
    return next((name for name in names if path.startswith(name + "/")), None)


def read(names):
    lines, edges = collections.Counter(), collections.defaultdict(set)
    for top in {name.split("/")[0] for name in names}:
        for path in (ROOT / top).rglob("*.[ch]pp"):
            room, text = room_of(path.relative_to(ROOT).as_posix(), names), path.read_text()
            lines[room] += text.count("\n")
            edges[room] |= {room_of(header, names) for header in INCLUDE.findall(text)}
    for path in (ROOT / "web/src").rglob("*"):
        if path.suffix in (".ts", ".tsx", ".css") and "wire" not in path.parts:  # wire: generated
            lines["web"] += path.read_text().count("\n")
    return lines, {room: edges[room] - {room, None} for room in lines}


def below(room, edges):
    """All rooms that a room depends on."""
    found, todo = set(), [room]
    while todo:
        for other in edges[todo.pop()] - found:
            found.add(other)
            todo.append(other)
    return found


def lane(start, end, boxes, taken, width):
    """The x nearest to the middle of an arrow where it passes no box and no other lane."""
    def free(x):
        return MARGIN <= x <= width - MARGIN and all(
            not left - LANE < x < left + WIDTH + LANE for left in boxes) and all(
            abs(x - other) >= LANE for other in taken)

    steps = sorted(range(-int(width), int(width), 4), key=abs)
    return next((x for x in ((start + end) / 2 + step for step in steps) if free(x)), end)


def draw(lines, edges):
    level = {}

    def climb(room):
        if room not in level:
            level[room] = max((climb(other) + 1 for other in edges[room]), default=0)
        return level[room]

    for room in lines:
        climb(room)
    levels = collections.defaultdict(list)
    for room in sorted(lines):
        levels[level[room]].append(room)
    widest, top = max(map(len, levels.values())), max(levels)
    width = 2 * MARGIN + widest * (WIDTH + GAP_X) - GAP_X
    height = 2 * MARGIN + (top + 1) * (HEIGHT + GAP_Y) - GAP_Y
    at = {}
    for row, row_rooms in levels.items():
        left = (width - len(row_rooms) * (WIDTH + GAP_X) + GAP_X) / 2
        for i, room in enumerate(row_rooms):
            at[room] = (left + i * (WIDTH + GAP_X), MARGIN + (top - row) * (HEIGHT + GAP_Y))
    total = sum(lines.values())
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
           f'font-family="sans-serif" font-size="13">',
           '<defs><marker id="a" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" '
           'markerHeight="7" orient="auto"><path d="M0 0 8 4 0 8z" fill="#667"/></marker></defs>',
           f'<rect width="{width:.0f}" height="{height:.0f}" fill="#fff"/>']
    taken = []
    for room in sorted(lines):
        implied = set().union(*(below(other, edges) for other in edges[room]), set())
        for other in sorted(edges[room] - implied):
            x, y = at[room][0] + WIDTH / 2, at[room][1] + HEIGHT
            to_x, to_y = at[other][0] + WIDTH / 2, at[other][1]
            way, half = f"M{x:.0f} {y:.0f}", GAP_Y / 2
            between = [left for left, top_of in at.values() if y < top_of < to_y]
            if between:  # beside the boxes of the rows that it passes
                beside = lane(x, to_x, between, taken, width)
                taken.append(beside)
                way += (f"C{x:.0f} {y + half:.0f} {beside:.0f} {y + half:.0f} {beside:.0f} "
                        f"{y + GAP_Y:.0f}V{to_y - GAP_Y:.0f}")
                x, y = beside, to_y - GAP_Y
            way += (f"C{x:.0f} {y + half:.0f} {to_x:.0f} {to_y - half:.0f} {to_x:.0f} "
                    f"{to_y:.0f}")
            out.append(f'<path d="{way}" fill="none" stroke="#667" marker-end="url(#a)"/>')
    for room, (x, y) in sorted(at.items()):
        share = 100 * lines[room] / total
        out.append(f'<rect x="{x:.0f}" y="{y:.0f}" width="{WIDTH}" height="{HEIGHT}" rx="5" '
                   'fill="#eef2f8" stroke="#456"/>'
                   f'<text x="{x + WIDTH / 2:.0f}" y="{y + 19:.0f}" text-anchor="middle">{room}</text>'
                   f'<text x="{x + WIDTH / 2:.0f}" y="{y + 36:.0f}" text-anchor="middle" '
                   f'font-size="11" fill="#456">{lines[room]:,} lines, {share:.0f} %</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    lines, edges = read(rooms())
    OUTPUT.write_text(draw(lines, edges))
    for room, count in lines.most_common():
        print(f"{room:18} {count:6}  on {', '.join(sorted(edges[room])) or 'nothing of ours'}")


main()
