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
import subprocess
import sys

FOLDERS = ("algo/", "sim/", "drivers/", "db/", "server/")
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
# What the checks themselves depend on.
RULES = (".clang-tidy", "CMakeLists.txt", "tests/dev/tidy.py")
# A group's file includes sources; the findings that count lie in them. A local name may shadow that of another
# source only here, and an embedded document may be long.
OPTIONS = ("--quiet", "--header-filter=/(algo|sim|drivers|db|server)/.*[.][ch]pp$", "--extra-arg=-Wno-shadow",
           "--extra-arg=-Wno-overlength-strings")
# The analyzer runs only for the mathematics and the storage: for JSON and Beast it doubles the time and has
# found nothing.
CHECKS, SERVER_CHECKS = "-bugprone-suspicious-include", "-bugprone-suspicious-include,-clang-analyzer-*"


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


def check(build, group, files, root):
    """The words of clang-tidy on one group; empty when it is clean."""
    server = any(str(path.relative_to(root)).startswith("server/") for path in [group, *files])
    result = subprocess.run(
        ["clang-tidy-16", "-p", str(build), *OPTIONS, "--checks=" + (SERVER_CHECKS if server else CHECKS),
         str(group)], capture_output=True, text=True, check=False)
    if result.returncode == 0:
        return ""
    return result.stdout + re.sub(r"(?m)^\d+ warnings?.* generated\.\n", "", result.stderr)


def main():
    build, cache, jobs = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    root = pathlib.Path.cwd().resolve()
    cache.mkdir(parents=True, exist_ok=True)
    rules = b"".join((root / name).read_bytes() for name in RULES)
    rules += subprocess.run(["clang-tidy-16", "--version"], capture_output=True, check=True).stdout
    todo = []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        group = pathlib.Path(entry["file"])
        relative = str(group.relative_to(root))
        if not relative.startswith(FOLDERS) and "/Unity/" not in relative:
            continue  # generated
        files = ours(group, root)
        mark = cache / (key(group, files, rules) + ".ok")
        if not mark.exists():
            todo.append((group.stat().st_size + sum(path.stat().st_size for path in files), group, files, mark))
    if not todo and not any(cache.glob("*.ok")):
        sys.exit(f"{build} knows no source of ours")
    todo.sort(key=lambda item: -item[0])  # the longest first, so that the workers end together
    clean = True
    with concurrent.futures.ThreadPoolExecutor(jobs) as workers:
        running = {workers.submit(check, build, group, files, root): mark for _, group, files, mark in todo}
        for done in concurrent.futures.as_completed(running):
            if done.result():
                clean = False
                print(done.result(), flush=True)
            else:
                running[done].touch()
    sys.exit(0 if clean else 1)


if __name__ == "__main__":
    main()
