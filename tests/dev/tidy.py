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
# A group's file includes sources; the findings that count lie in them. A local name may shadow that of another
# source only here, and an embedded document may be long.
OPTIONS = ("--quiet", "--header-filter=/(algo|sim|drivers|db|server)/.*[.][ch]pp$", "--extra-arg=-Wno-shadow",
           "--extra-arg=-Wno-overlength-strings")
GROUP_CHECKS = "--checks=-bugprone-suspicious-include,-clang-analyzer-*"
# The analyzer passes over included sources, so it reads each alone. It runs only for the mathematics and the
# storage: for JSON and Beast it doubles the time and has found nothing.
ANALYZER = "--checks=-*,clang-analyzer-*,-clang-analyzer-optin.*"


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


def tidy(*arguments):
    """The words of clang-tidy; empty when it finds nothing."""
    result = subprocess.run(["clang-tidy-16", *OPTIONS, *arguments], capture_output=True, text=True, check=False)
    if result.returncode == 0:
        return ""
    return result.stdout + re.sub(r"(?m)^\d+ warnings?.* generated\.\n", "", result.stderr)


def check(build, entry, files, root):
    """The words of clang-tidy on the group of `entry`, and of the analyzer on each of its sources."""
    words = tidy("-p", str(build), GROUP_CHECKS, entry["file"])
    sources = [path for path in [pathlib.Path(entry["file"]), *files] if path.suffix == ".cpp"]
    command = shlex.split(entry["command"])
    options = [word for word in command[:command.index("-o")] if not word.endswith(("ccache", "clang++-16"))]
    for source in sources:
        if not str(source.relative_to(root)).startswith("server/"):
            words += tidy(ANALYZER, str(source), "--", *options)
    return words


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
            todo.append((group.stat().st_size + sum(path.stat().st_size for path in files), entry, files, mark))
    if not todo and not any(cache.glob("*.ok")):
        sys.exit(f"{build} knows no source of ours")
    todo.sort(key=lambda item: -item[0])  # the longest first, so that the workers end together
    clean = True
    with concurrent.futures.ThreadPoolExecutor(jobs) as workers:
        running = {workers.submit(check, build, entry, files, root): mark for _, entry, files, mark in todo}
        for done in concurrent.futures.as_completed(running):
            if done.result():
                clean = False
                print(done.result(), flush=True)
            else:
                running[done].touch()
    sys.exit(0 if clean else 1)


if __name__ == "__main__":
    main()
