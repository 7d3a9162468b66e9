#!/usr/bin/env python3
"""clang-tidy over every source of ours, in the groups that CMake compiles together.

Usage: tidy.py BUILD CACHE JOBS, from the root of the repository. BUILD is a build folder with
compile_commands.json and its generated headers. Tests are only formatted: GoogleTest's macros would take
more time than all the rest. A group that was clean is not read again until one of its files changes; a
finding is printed, and the exit status is 1.
"""
import concurrent.futures
import hashlib
import json
import pathlib
import re
import shlex
import subprocess
import sys

FOLDERS = ("algo/", "sim/", "drivers/", "db/", "server/")
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
# What the checks themselves depend on.
RULES = (".clang-tidy", "CMakeLists.txt", "tests/dev/tidy.py")
# The findings that count lie in our files. A local name may shadow that of another source only here, and an
# embedded document may be long.
OPTIONS = ("--quiet", "--header-filter=/(algo|sim|drivers|db|server)/.*[.][ch]pp$", "--extra-arg=-Wno-shadow",
           "--extra-arg=-Wno-overlength-strings")
# The analyzer runs only for the mathematics and the storage: for JSON and Beast it doubles the time and has
# found nothing.
WITHOUT_ANALYZER = "--checks=-clang-analyzer-*"


def ours(group, root):
    """The files of ours that a group's file includes, the sources first, each once."""
    found, queue = [], [group]
    while queue:
        text = queue.pop().read_text(encoding="utf-8", errors="replace")
        for name in INCLUDE.findall(text):
            path = root / name
            if path.is_file() and path not in found:
                found.append(path)
                queue.append(path)
    return found


def key(group, files, rules):
    """A hash over all that a verdict depends on, without the place of this clone."""
    digest = hashlib.sha256(rules)
    for path in [*([] if "/Unity/" in str(group) else [group]), *files]:
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()[:32]


def sources_of(group, files):
    """The sources of ours that a group compiles; none if all of them are generated."""
    return [path for path in files if path.suffix == ".cpp"] if "/Unity/" in str(group) else [group]


def joined(group, files, root, folder):
    """The sources of a group as one file, and for each of its lines the line it comes from. Included ones would
    not do: the analyzer passes over all that is not in the main file."""
    lines, origins = [], []
    for source in sources_of(group, files):
        for number, line in enumerate(source.read_text(encoding="utf-8").split("\n"), 1):
            lines.append(line)
            origins.append(f"{source.relative_to(root)}:{number}")
    path = folder / ("_".join(group.relative_to(root).with_suffix("").parts) + ".cpp")
    path.write_text("\n".join(lines), encoding="utf-8")
    return path, origins


def check(entry, files, root, folder):
    """The words of clang-tidy on a group; empty when it finds nothing."""
    path, origins = joined(pathlib.Path(entry["file"]), files, root, folder)
    checks = [WITHOUT_ANALYZER] if origins[0].startswith("server/") else []
    command = shlex.split(entry["command"])
    options = [word for word in command[:command.index("-o")] if not word.endswith(("ccache", "clang++-16"))]
    result = subprocess.run(["clang-tidy-16", *OPTIONS, *checks, str(path), "--", *options],
                            capture_output=True, text=True, check=False)
    if result.returncode == 0:
        return ""
    words = result.stdout + re.sub(r"(?m)^\d+ warnings?.* generated\.\n", "", result.stderr)
    if not words.strip():
        return f"{path}: clang-tidy ended with {result.returncode} without a word"
    return re.sub(re.escape(str(path)) + r":(\d+)", lambda found: origins[int(found[1]) - 1], words)


def main():
    build, cache, jobs = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    root = pathlib.Path.cwd().resolve()
    cache.mkdir(parents=True, exist_ok=True)
    folder = build / "joined"  # .clang-tidy is found from there
    folder.mkdir(exist_ok=True)
    rules = b"".join((root / name).read_bytes() for name in RULES)
    rules += subprocess.run(["clang-tidy-16", "--version"], capture_output=True, check=True).stdout
    todo = []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        group = pathlib.Path(entry["file"])
        relative = str(group.relative_to(root))
        if not relative.startswith(FOLDERS) and "/Unity/" not in relative:
            continue  # generated
        files = ours(group, root)
        if not sources_of(group, files):
            continue  # generated
        mark = cache / (key(group, files, rules) + ".ok")
        if not mark.exists():
            todo.append((group.stat().st_size + sum(path.stat().st_size for path in files), entry, files, mark))
    if not todo and not any(cache.glob("*.ok")):
        sys.exit(f"{build} knows no source of ours")
    todo.sort(key=lambda item: -item[0])  # the longest first, so that the workers end together
    clean = True
    with concurrent.futures.ThreadPoolExecutor(jobs) as workers:
        running = {workers.submit(check, entry, files, root, folder): mark for _, entry, files, mark in todo}
        for done in concurrent.futures.as_completed(running):
            if done.result():
                clean = False
                print(done.result(), flush=True)
            else:
                running[done].touch()
    sys.exit(0 if clean else 1)


if __name__ == "__main__":
    main()
