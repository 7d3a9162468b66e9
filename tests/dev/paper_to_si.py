#!/usr/bin/env python3
# tests/dev/paper_to_si.py: converts a file of layouts and limits from the papers' notes, in
# millimetres and partly as text, to the document of `tautline reproduce`: SI, with each number in its
# own field (docs/interfaces.md).
#
#   python3 tests/dev/paper_to_si.py tests/golden/paper.json > server/lab/reproduce/study.json
#   python3 tests/dev/paper_to_si.py OLD --check NEW        exit status 1 when NEW is not that
import json
import re
import sys

READINGS = ("original modified_published modified_linear modified_c1 modified via_kept original_side"
            ).split()
# Metrics of the old form: our name of the figure, and the old unit in ours.
FIGURES = {
    "time_s": ("time_s", 1),
    "path_mm": ("path_m", 1e-3),
    "min_clearance_mm": ("min_clearance_m", 1e-3),
    "safety_infringed_s": ("safety_infringed_s", 1),
    "safety_depth_mm": ("safety_depth_m", 1e-3),
    "body1000_infringed_s": ("body_infringed_s", 1),
    "body1000_depth_mm": ("body_depth_m", 1e-3),
    "turning_rad": ("turning_rad", 1),
    "curv2_e-3_rad2_per_mm": ("bending_rad2_per_m", 1),  # 1e-3 rad2/mm is rad2/m
    "via_points": ("via_points", 1),
    "standing_s": ("standing_s", 1),
    "pauses": ("pauses", 1),
    "pause_s": ("pause_s", 1),
}
COUNTS = "runs reached stuck out_of_time collided".split()
OUTCOMES = {"reached": "reached", "stuck": "stuck", "timeout": "out_of_time",
            "out_of_time": "out_of_time", "collided": "collided"}
# The sweeps are ours: the old form had none.
SWEEPS = [
    {"parameter": "k_r", "controllers": ["original", "modified_published", "modified"],
     "values": [0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0]},
    {"parameter": "safety_distance", "controllers": ["original", "modified_published", "modified"],
     "values": [0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2]},
    {"parameter": "k_c", "controllers": ["original", "modified", "via_kept"],
     "values": [0, 0.2, 0.4, 0.6, 0.8, 1.0]},
    {"parameter": "filter_half_width", "controllers": ["original", "modified"], "values": [0, 1, 2, 3, 5]},
]


class Refusal(Exception):
    """A sentence about the field that cannot be converted."""


def tidy(value):
    """The shortest decimal, without binary rounding digits or a trailing .0."""
    value = round(value, 9)
    return int(value) if value == int(value) else value


def metres(mm):
    return tidy(mm / 1000)


def found(pattern, text, field):
    match = re.match(pattern, text)
    if not match:
        raise Refusal(f"{field}: '{text[:60]}' is not understood")
    return match


def only(value, wanted, field):
    if value != wanted:
        raise Refusal(f"{field}: is {value}; the program has {wanted} only")


def conditions(common):
    only(common.get("units", "mm, s, rad"), "mm, s, rad", "common/units")
    only(common["robot"]["radius"], 350, "common/robot/radius")
    for reach in ("d_o", "d_r"):
        only(common.get(reach, common["d_safe"] + 350), common["d_safe"] + 350, "common/" + reach)
    only(common.get("barrier_B", "S/2"), "S/2", "common/barrier_B")
    lidar = common["lidar"]
    only(lidar["beams"], 361, "common/lidar/beams")
    only(lidar["resolution_deg"], 0.5, "common/lidar/resolution_deg")
    only(lidar["used_beams"], [31, 329], "common/lidar/used_beams")
    number = r"(\d+(?:\.\d+)?)"
    period = found(rf"{number} s(?: \({number} s where v_max = {number}\))?(?:$|;)", common["dt"],
                   "common/dt")
    noise = found(rf"(?:uniform \+-{number} mm|none)(?:$|,)", lidar["noise"], "common/lidar/noise")
    filter_ = found(r"([a-z]+)(?: N = (\d+))?(?:$|,)", lidar["filter"], "common/lidar/filter")
    limit = found(rf"{number} \* straight-line distance / v_max$", common["time_limit_s"],
                  "common/time_limit_s")
    out = {
        "safety_distance": metres(common["d_safe"]),
        "strip_step": metres(common["strip_step_S"]),
        "arrival_radius": metres(common["arrival_radius"]),
        "max_turn_rate": tidy(common["w_max"]),
        "heading_gain": tidy(common["heading_gain"]),
        "period": tidy(float(period[1])),
        "range_max": metres(lidar["max_range"]),
        "noise": metres(float(noise[1] or 0)),
        "filter": filter_[1],
        "filter_half_width": int(filter_[2] or 1),
        "time_limit_factor": tidy(float(limit[1])),
    }
    if period[2]:
        out["slow"] = {"v_max": metres(float(period[3])), "period": tidy(float(period[2]))}
    return out


def turn(a, b, c):
    """Twice the area of a, b, c; positive when they turn left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def convex_parts(outline):
    """The outline itself when it is convex, else triangles that fill it (ear clipping), all
    counter-clockwise. None when it crosses itself or has no area."""
    outline = list(outline)
    if len(outline) > 3 and outline[0] == outline[-1]:  # "closed": the first vertex is repeated
        outline.pop()
    count = len(outline)
    sides = [(outline[i], outline[(i + 1) % count]) for i in range(count)]
    crossing = any(turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0
                   for i, (a, b) in enumerate(sides) for c, d in sides[i + 1:])
    area = sum(a[0] * b[1] - a[1] * b[0] for a, b in sides)
    if count < 3 or crossing or area == 0:
        return None
    if area < 0:
        outline.reverse()
    if all(turn(*(outline[(i + k) % count] for k in range(3))) >= 0 for i in range(count)):
        return [outline]
    parts = []
    while len(outline) > 3:
        for i, b in enumerate(outline):
            a, c = outline[i - 1], outline[(i + 1) % len(outline)]
            others = (p for p in outline if p not in (a, b, c))
            if turn(a, b, c) > 0 and not any(
                    turn(a, b, p) >= 0 and turn(b, c, p) >= 0 and turn(c, a, p) >= 0
                    for p in others):
                break
        else:
            return None
        parts.append([a, b, c])
        del outline[i]
    return parts + ([outline] if turn(*outline) > 0 else [])


def obstacles(listed, field):
    out = []
    for i, each in enumerate(listed):
        if each["type"] == "cylinder":
            out.append({"type": "cylinder", "x": metres(each["x"]), "y": metres(each["y"]),
                        "radius": metres(each["radius"])})
        elif each["type"] == "polygon":
            parts = convex_parts(each["points"])
            if parts is None:
                raise Refusal(f"{field}/obstacles/{i}/points: is not the outline of a solid")
            out += [{"type": "polygon", "points": [[metres(x), metres(y)] for x, y in part]}
                    for part in parts]
        else:
            raise Refusal(f"{field}/obstacles/{i}/type: '{each['type']}' is unknown")
    return [{"id": i, **each} for i, each in enumerate(out, 1)]


def scenario(old, start, field):
    out = {"name": old["name"], "title": old.get("source", ""),
           "description": old.get("expect", "")}
    out["start"] = {"x": metres(start["x"]), "y": metres(start["y"])}
    heading = start.get("heading", "towards the goal")
    if not isinstance(heading, str):
        out["start"]["heading"] = tidy(heading)
    elif not heading.startswith("towards the goal"):
        raise Refusal("common/start/heading: must be a number or begin with 'towards the goal'")
    out["goal"] = {"x": metres(old["goal"][0]), "y": metres(old["goal"][1])}
    out["parameters"] = {"k_c": old["K_c"], "k_r": old["K_r"], "v_max": metres(old["v_max"])}
    out["obstacles"] = obstacles(old["obstacles"], field)
    return out


def bound(key, value, field):
    match = re.fullmatch(r"(.+)_(at_least|at_most)", key)
    name = match and match[1]
    if name in COUNTS:
        return {"figure": name, match[2]: value}
    if name not in FIGURES:
        raise Refusal(f"{field}/{key}: is neither outcome, collisions nor a metric and a bound")
    figure, factor = FIGURES[name]
    return {"figure": figure, match[2]: tidy(value * factor)}


def limits(old, field):
    out = []
    for key in ("accept", "accept_compare", "accept_noise_free"):
        if key == "accept_compare":
            for each in old.get(key, []):
                out.append({"scenario": old["name"], "controller": each["lower"],
                            "figure": FIGURES[each["metric"]][0], "below": each["higher"]})
            continue
        unknown = set(old.get(key, {})) - set(READINGS)
        if unknown:
            raise Refusal(f"{field}/{key}: no readings are called {', '.join(sorted(unknown))}")
        noise_free = {"noise_free": True} if key == "accept_noise_free" else {}
        for reading in (r for r in READINGS if r in old.get(key, {})):
            asked = dict(old[key][reading])
            head = {"scenario": old["name"], "controller": reading, **noise_free}
            if "outcome" in asked:
                out.append({**head, "outcome": OUTCOMES[asked.pop("outcome")]})
            if "collisions" in asked:
                out.append({**head, "collisions": asked.pop("collisions")})
            for name in sorted(asked):
                out.append({**head, **bound(name, asked[name], f"{field}/{key}/{reading}")})
    return out


def convert(old):
    new = {"about": old.get("about", ""), "conditions": conditions(old["common"]),
           "scenarios": [], "limits": [], "sweeps": SWEEPS}
    for i, each in enumerate(old["scenarios"]):
        field = f"scenarios/{i}"
        new["scenarios"].append(scenario(each, old["common"]["start"], field))
        new["limits"] += limits(each, field)
    return new


def written(document):
    """JSON with one line for each field of the conditions and each entry of a list."""
    def line(value):
        return json.dumps(value, ensure_ascii=False)

    def block(value):
        if isinstance(value, dict):
            inner = ",\n".join(f"  {line(k)}: {line(v)}" for k, v in value.items())
            return "{\n" + inner + "\n }"
        if isinstance(value, list):
            return "[\n" + ",\n".join("  " + line(v) for v in value) + "\n ]"
        return line(value)

    return "{\n" + ",\n".join(f" {line(k)}: {block(v)}" for k, v in document.items()) + "\n}\n"


def main(arguments):
    if len(arguments) not in (1, 3) or (len(arguments) == 3 and arguments[1] != "--check"):
        sys.exit("usage: paper_to_si.py OLD [--check NEW]")
    with open(arguments[0], encoding="utf-8") as file:
        old = json.load(file)
    try:
        text = written(convert(old))
    except Refusal as refusal:
        sys.exit(f"{arguments[0]}: {refusal}")
    except KeyError as missing:
        sys.exit(f"{arguments[0]}: {missing} is missing or unknown")
    if len(arguments) == 1:
        sys.stdout.write(text)
        return
    with open(arguments[2], encoding="utf-8") as file:
        if file.read() != text:
            sys.exit(f"{arguments[2]} is not what {arguments[0]} converts to")


if __name__ == "__main__":
    main(sys.argv[1:])
