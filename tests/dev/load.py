"""tests/dev/load.py: a served program under test, and heavy requests."""
import http.client
import json
import multiprocessing
import os
import signal
import socket
import sqlite3
import subprocess
import time

CSV_ROWS = 160_000  # some 55 MB of CSV
HEAVY = {"scenario": "case3", "controller": "certainty_grid", "vehicle": "kinematic"}


class Server:
    """`tautline serve` on a free port; `more` are further arguments, `options` those of Popen."""

    def __init__(self, program, folder, *more, **options):
        self.log = os.path.join(folder, "log")
        with open(self.log, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen([program, "serve", "--port", "0", *more],
                                            stdout=log, stderr=subprocess.STDOUT, **options)
        self.port = None
        while self.port is None:
            if self.process.poll() is not None:
                raise SystemExit(f"the program ended:\n{self.said()}")
            time.sleep(0.02)
            for word in self.said().split():
                if word.startswith("http://"):
                    self.port = int(word.rstrip("/").rsplit(":", 1)[1])

    def said(self):
        with open(self.log, encoding="utf-8") as file:
            return file.read()

    def ask(self, method, path, body=None, timeout=60):
        return ask(self.port, method, path, body, timeout)

    def memory(self, key):
        """[MB] VmRSS or VmHWM."""
        with open(f"/proc/{self.process.pid}/status", encoding="utf-8") as file:
            for line in file:
                if line.startswith(key + ":"):
                    return int(line.split()[1]) / 1024
        return 0

    def running(self):
        return self.process.poll() is None

    def end(self, sign=signal.SIGTERM):
        if self.running():
            self.process.send_signal(sign)
            self.process.wait(20)


def ask(port, method, path, body=None, timeout=60):
    """(status, headers, bytes) of one request on a connection of its own."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=timeout)
    try:
        data = None if body is None else json.dumps(body)
        connection.request(method, f"/api/v1{path}", data, {"Content-Type": "application/json"})
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read()
    finally:
        connection.close()


def add_long_run(database, like):
    """Writes a finished run whose CSV has some 55 MB into a store that nobody has open, of the blocks
    of run `like` over and over; its number."""
    store = sqlite3.connect(database)
    run = store.execute(
        "INSERT INTO run (status, outcome, scenario, controller, filter, physics, seed, parameters,"
        " version, started, ticks) SELECT status, outcome, scenario, controller, filter, physics, seed,"
        " parameters, version, started, ? FROM run WHERE id = ?", (CSV_ROWS, like)).lastrowid
    store.execute("INSERT INTO document SELECT ?, text FROM document WHERE run ="
                  " (SELECT coalesce(document, id) FROM run WHERE id = ?)", (run, like))
    ticks = store.execute("SELECT max(last_tick) + 1 FROM block WHERE run = ?", (like,)).fetchone()[0]
    for first in range(0, CSV_ROWS, ticks):
        store.execute("INSERT INTO block SELECT ?, first_tick + ?, last_tick + ?, first_time, frames"
                      " FROM block WHERE run = ?", (run, first, first, like))
    store.commit()
    store.close()
    return run


def record_heavy_run(program, database):
    """Records a run of the controller with the largest frames; its number."""
    subprocess.run([program, "run", HEAVY["scenario"], "--controller", HEAVY["controller"],
                    "--vehicle", HEAVY["vehicle"], "--out", database],
                   stdout=subprocess.DEVNULL, check=False)
    store = sqlite3.connect(database)
    run = store.execute("SELECT max(id) FROM run").fetchone()[0]
    store.close()
    return run


# ---- loads: each repeats until it is ended, in a process of its own -----------------------------

def read_csv(port, run):
    while True:
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
        connection.request("GET", f"/api/v1/runs/{run}/csv")
        answer = connection.getresponse()
        while answer.read(1 << 16):
            pass
        connection.close()


def read_frames(port, run):
    start = "0"
    while True:
        _, headers, _ = ask(port, "GET", f"/runs/{run}/frames?limit=5000&from={start}", timeout=120)
        start = headers.get("X-Next-Tick", "0")


def post_batches(port, repeats=10_000):
    while True:
        ask(port, "POST", "/runs",
            {"scenario": "case1", "vehicle": "kinematic", "repeats": repeats}, 120)
        time.sleep(0.2)


def load_and_reset(port):
    while True:
        ask(port, "POST", "/session/control", {"action": "load"}, 120)
        ask(port, "POST", "/session/control", {"action": "reset"}, 120)


def read_lists(port, run):
    while True:
        for path in ("/runs?limit=500", f"/runs/{run}/ticks?limit=10000", f"/runs/{run}",
                     "/scenarios", "/scenarios/demo", f"/runs/{run}/metrics"):
            ask(port, "GET", path, timeout=120)


def hold_connections(port, count):
    sockets = []
    while True:
        while len(sockets) < count:
            try:
                sockets.append(socket.create_connection(("127.0.0.1", port), timeout=5))
            except OSError:
                break
        time.sleep(1)


def lock_store(database):
    """Another program's transaction, held 3 s at a time."""
    while True:
        store = sqlite3.connect(database, timeout=5, isolation_level=None)
        try:
            store.execute("BEGIN EXCLUSIVE")
            time.sleep(3)
            store.execute("ROLLBACK")
        except sqlite3.OperationalError:
            pass
        store.close()


class Load:
    """`target` in `count` processes while a `with` block lasts."""

    def __init__(self, target, *args, count=1):
        self.processes = [multiprocessing.Process(target=quietly, args=(target, *args), daemon=True)
                          for _ in range(count)]

    def __enter__(self):
        for process in self.processes:
            process.start()

    def __exit__(self, *_):
        for process in self.processes:
            process.kill()
            process.join()


def quietly(target, *args):
    """Repeats a failed request: the measurement is of its effect on others."""
    while True:
        try:
            target(*args)
        except (OSError, http.client.HTTPException):
            time.sleep(0.1)
