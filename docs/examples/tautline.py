"""docs/examples/tautline.py: drives a robot of Tautline from Python (docs/external-controllers.md).

One file, standard library only; with numpy installed, ranges come as arrays. Copy it beside your own
controller. Metres, radians, seconds; ccw positive; world frame W, robot frame R (x ahead, y left).

    import tautline
    tautline.drive(lambda seen: (0.2, 0.0))    # v [m/s], omega [rad/s]
"""
import os
import socket
import struct
import sys

try:
    import numpy
except ImportError:
    numpy = None

VERSION = 1  # of server/external/controller.fbs
POINTS, POLYLINE, ARROWS, CIRCLES, ARCS, GRID, POLAR, TEXT = range(8)  # kinds of layers
OK, FREE, INVALID = range(3)  # status of a beam

_HELLO, _COMMAND, _WELCOME, _RESET, _OBSERVATION, _END = range(1, 7)
_IDENTIFIER = b"TLX1"
_U16, _U32, _I32, _F64 = (struct.Struct("<" + f) for f in ("H", "I", "i", "d"))
_NOW = struct.Struct("<Q6d")
_GOAL = struct.Struct("<3d?")
_SCAN = struct.Struct("<7d?")
_READING = struct.Struct("<6dB7x")


class TautlineError(Exception):
    """Tautline refused this controller, or sent what this file does not understand."""


class Run:
    """The run that begins.

    scenario: its name. seed: of the sensor noise; use it for your own randomness too.
    start: (x, y, heading) [m, m, rad] in W. robot: a dict of the fields of table Robot; "arm" is
    None, or a dict of those of table Arm.
    """

    def __init__(self, table):
        self.scenario = table.text(0)
        self.seed = table.number(1, "<Q", 0)
        self.start = table.struct(2, struct.Struct("<3d"))
        robot = table.table(3)
        names = ("radius", "half_length", "half_width", "half_track", "period", "max_v",
                 "max_omega", "max_acceleration", "max_angular_acceleration", "command_delay")
        self.robot = {name: robot.number(slot, "<d", 0.0) for slot, name in enumerate(names, 1)}
        self.robot["name"] = robot.text(0)
        self.robot["has_laser"] = bool(robot.number(11, "<B", 0))
        self.robot["arm"] = _arm(robot.table(12))
        self.parameter_names = table.texts(4)


def _arm(table):
    if table is None:
        return None
    arm = dict(zip(("x", "y", "z", "heading"), table.struct(0, struct.Struct("<4d"))))
    for slot, name in enumerate(("upper_arm", "elbow_offset", "forearm", "hand"), 1):
        arm[name] = table.number(slot, "<d", 0.0)
    for slot, name in enumerate(("limits", "rates", "rest"), 5):
        arm[name] = list(table.vector(slot, 8, "d"))
    return arm


class Seen:
    """One observation. B beams; beam i points at angle_min + i * angle_increment in R (mount).

    tick: from 0. stamp [s]. pose: (x, y, heading) by odometry in W. twist: (v, omega).
    goal: (x, y, heading or None) in W, or None. ranges: B floats [m], range_max where status is
    not OK. status: B bytes. fresh: the scan is new in this tick. run: the Run.
    """

    def __init__(self, table, run):
        self._table = table
        self.run = run
        now = table.struct(0, _NOW)
        self.tick, self.stamp = now[0], now[1]
        self.pose, self.twist = now[2:5], now[5:7]
        goal = table.struct(1, _GOAL)
        self.goal = None if goal is None else (goal[0], goal[1], goal[2] if goal[3] else None)
        (self.scan_stamp, x, y, heading, self.angle_min, self.angle_increment, self.range_max,
         self.fresh) = table.struct(2, _SCAN)
        self.mount = (x, y, heading)

    @property
    def ranges(self):
        return self._table.vector(3, 8, "d")

    @property
    def status(self):
        return self._table.vector(4, 1, "B")

    @property
    def parameters(self):
        """Values by name, such as v_max."""
        return dict(zip(self.run.parameter_names, self._table.vector(5, 8, "d")))

    @property
    def sonar(self):
        """One tuple a reading: mount x, y, heading, stamp, range, range_max, status."""
        return self._table.structs(6, _READING)

    @property
    def infrared(self):
        return self._table.structs(7, _READING)

    @property
    def joints(self):
        """[rad] as measured, the shoulder's first; empty without an arm."""
        return self._table.vector(8, 8, "d")

    @property
    def joint_rates(self):
        """[rad/s]"""
        return self._table.vector(9, 8, "d")


class Answer:
    """A command with its explanation and drawings. update() may return this or (v, omega).

    waits: the robot may stand still now. state: 0 to 255; a change shows new words at once.
    what, why: one sentence each, of at most 500 bytes. joint_rates: [rad/s] of an arm's seven joints;
    None: the arm rests.
    """

    def __init__(self, v, omega, what="", why="", waits=False, state=0, joint_rates=None):
        self.v, self.omega = v, omega
        self.what, self.why = what, why
        self.waits, self.state = waits, state
        self.joint_rates = joint_rates
        self.layers = []
        self.measures = []

    def layer(self, name, values, kind=POINTS, label="", unit="", frame=0, tone=0, style=0, text=""):
        """Shows a layer. values: flat list of floats as LayerKind says; frame: 0 is W, 1 is R."""
        self.layers.append((name, values, kind, label, unit, frame, tone, style, text))

    def measure(self, name, value, unit=""):
        """Plots a number."""
        self.measures.append((name, value, unit))


class _Table:
    """A FlatBuffers table inside `data`."""

    def __init__(self, data, at):
        self.data, self.at = data, at
        self.fields = at - _I32.unpack_from(data, at)[0]
        self.size = _U16.unpack_from(data, self.fields)[0]

    def field(self, slot):
        """The place of a field; 0 if it is absent."""
        entry = 4 + 2 * slot
        if entry >= self.size:
            return 0
        offset = _U16.unpack_from(self.data, self.fields + entry)[0]
        return self.at + offset if offset else 0

    def target(self, slot):
        at = self.field(slot)
        return at + _U32.unpack_from(self.data, at)[0] if at else 0

    def number(self, slot, form, default):
        at = self.field(slot)
        return struct.unpack_from(form, self.data, at)[0] if at else default

    def struct(self, slot, form):
        at = self.field(slot)
        return form.unpack_from(self.data, at) if at else None

    def table(self, slot):
        at = self.target(slot)
        return _Table(self.data, at) if at else None

    def text(self, slot):
        return _text(self.data, self.target(slot))

    def texts(self, slot):
        at = self.target(slot)
        count = _U32.unpack_from(self.data, at)[0] if at else 0
        places = (at + 4 + 4 * i for i in range(count))
        return [_text(self.data, p + _U32.unpack_from(self.data, p)[0]) for p in places]

    def vector(self, slot, size, form):
        at = self.target(slot)
        count = _U32.unpack_from(self.data, at)[0] if at else 0
        if numpy is not None:
            return numpy.frombuffer(self.data, form, count, at + 4)
        return memoryview(self.data)[at + 4:at + 4 + size * count].cast(form)

    def structs(self, slot, form):
        at = self.target(slot)
        count = _U32.unpack_from(self.data, at)[0] if at else 0
        return [form.unpack_from(self.data, at + 4 + form.size * i) for i in range(count)]


def _text(data, at):
    if not at:
        return ""
    size = _U32.unpack_from(data, at)[0]
    return bytes(data[at + 4:at + 4 + size]).decode("utf-8", "replace")


class _Writer:
    """Writes one message from its root on: each part stands behind those that refer to it."""

    def __init__(self):
        self.data = bytearray(8) + _IDENTIFIER

    def align(self, size):
        self.data += bytes(-len(self.data) % size)

    def table(self, fields):
        """fields: slot -> (format, values), or slot -> function that writes the part referred to."""
        count = max(fields, default=-1) + 1
        self.align(2)
        vtable = len(self.data)
        self.data += bytes(4 + 2 * count)
        self.align(8)
        at = len(self.data)
        self.data += bytes(4)
        # The wide ones first, so that each is aligned to its size.
        inline = sorted(fields.items(), key=lambda item: -self.width(item[1]))
        references = []
        for slot, field in inline:
            self.align(self.width(field))
            _U16.pack_into(self.data, vtable + 4 + 2 * slot, len(self.data) - at)
            if callable(field):
                references.append((len(self.data), field))
                self.data += bytes(4)
            else:
                self.data += struct.pack(field[0], *field[1:])
        struct.pack_into("<HH", self.data, vtable, 4 + 2 * count, len(self.data) - at)
        _I32.pack_into(self.data, at, at - vtable)
        for place, write in references:
            self.refer(place, write())
        return at

    @staticmethod
    def width(field):
        if callable(field):
            return 4
        return {"d": 8, "Q": 8, "I": 4, "f": 4}.get(field[0][-1], 1)

    def refer(self, place, target):
        _U32.pack_into(self.data, place, target - place)

    def text(self, value):
        return lambda: self.bytes(value.encode("utf-8"), b"\0")

    def bytes(self, content, end=b"", count=None):
        self.align(4)
        at = len(self.data)
        self.data += _U32.pack(len(content) if count is None else count) + content + end
        return at

    def floats(self, values):
        return lambda: self.bytes(struct.pack("<%df" % len(values), *values), count=len(values))

    def doubles(self, values):
        def write():
            self.data += bytes((4 - len(self.data)) % 8)  # the count ends where the numbers begin
            return self.bytes(struct.pack("<%dd" % len(values), *values), count=len(values))
        return write

    def tables(self, all_fields):
        def write():
            at = self.bytes(bytes(4 * len(all_fields)), count=len(all_fields))
            for i, fields in enumerate(all_fields):
                self.refer(at + 4 + 4 * i, self.table(fields))
            return at
        return write

    def finish(self, body_type, body):
        root = self.table({0: ("<B", body_type), 1: lambda: self.table(body)})
        self.refer(4, root)
        _U32.pack_into(self.data, 0, len(self.data) - 4)
        return self.data


def _hello(token):
    writer = _Writer()
    fields = {0: ("<I", VERSION)}
    if token:
        fields[1] = writer.text(token)
    return writer.finish(_HELLO, fields)


def _layer(writer, layer):
    name, values, kind, label, unit, frame, tone, style, text = layer
    fields = {0: writer.text(name), 3: ("<B", kind), 4: ("<B", frame), 5: ("<B", tone),
              6: ("<B", style), 9: writer.floats(values)}
    for slot, value in ((1, label), (2, unit), (11, text)):
        if value:
            fields[slot] = writer.text(value)
    return fields


def _command(tick, answer):
    writer = _Writer()
    fields = {0: ("<Q", tick), 1: ("<2d", answer.v, answer.omega), 2: ("<?", answer.waits),
              3: ("<B", answer.state)}
    for slot, value in ((4, answer.what), (5, answer.why)):
        if value:
            fields[slot] = writer.text(value)
    if answer.layers:
        fields[6] = writer.tables([_layer(writer, layer) for layer in answer.layers])
    if answer.measures:
        fields[7] = writer.tables([{0: writer.text(name), 1: writer.text(unit),
                                    2: ("<d", value)} for name, value, unit in answer.measures])
    if answer.joint_rates is not None:
        fields[9] = writer.doubles(answer.joint_rates)
    return writer.finish(_COMMAND, fields)


class _PlainCommand:
    """A command without words and drawings: the same bytes but for three numbers."""

    def __init__(self):
        self.data = _command(0x1122334455667788, Answer(1.25, -2.5))
        self.tick = self.data.index(struct.pack("<Q", 0x1122334455667788))
        self.twist = self.data.index(struct.pack("<2d", 1.25, -2.5))

    def bytes(self, tick, v, omega):
        struct.pack_into("<Q", self.data, self.tick, tick)
        struct.pack_into("<2d", self.data, self.twist, v, omega)
        return self.data


class _Link:
    """Whole messages over a socket."""

    def __init__(self, link):
        self.socket = link
        self.rest = b""  # received, of the next message

    def send(self, message):
        self.socket.sendall(message)

    def receive(self):
        """(type of the body, its table), or (_END, None) once the other side has closed."""
        data = self.rest or self.socket.recv(65536)
        while len(data) < 4 or len(data) < 4 + _U32.unpack_from(data)[0]:
            more = self.socket.recv(1 << 20) if data else b""
            if not more:
                return _END, None
            data += more
        self.rest = data[4 + _U32.unpack_from(data)[0]:]
        message = _Table(data, 4 + _U32.unpack_from(data, 4)[0])
        return message.number(0, "<B", 0), message.table(1)


def _connect(address):
    """A socket to `address`: "unix:/path", "tcp:127.0.0.1:port", or the one Tautline handed down."""
    if address is None:
        number = os.environ.get("TAUTLINE_CONTROLLER_FD")
        if number is None:
            raise TautlineError("Start this with: tautline run SCENARIO --controller 'python3 %s'"
                                % os.path.basename(sys.argv[0]))
        return socket.socket(fileno=int(number))
    kind, _, place = address.partition(":")
    if kind == "unix":
        link = socket.socket(socket.AF_UNIX)
        link.connect(place)
        return link
    host, _, port = place.rpartition(":")
    link = socket.create_connection((host, int(port)))
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return link


def drive(update, reset=None, address=None, token=None):
    """Answers Tautline until it says that no run follows.

    update(seen) returns (v, omega) [m/s, rad/s] or an Answer; reset(run) begins a run.
    address: None when Tautline starts this program, else where it listens. token: of a TCP port;
    None takes TAUTLINE_CONTROLLER_TOKEN. Raises TautlineError, and any error of update() and reset().
    """
    if token is None:
        token = os.environ.get("TAUTLINE_CONTROLLER_TOKEN", "")
    link = _Link(_connect(address))
    try:
        link.send(_hello(token))
    except (BrokenPipeError, ConnectionResetError):
        pass  # refused at once: the reason can still be read
    plain = _PlainCommand()
    run = None
    welcome = False
    while True:
        kind, table = link.receive()
        if kind == _OBSERVATION:
            seen = Seen(table, run)
            answer = update(seen)
            if isinstance(answer, Answer):
                link.send(_command(seen.tick, answer))
            else:
                link.send(plain.bytes(seen.tick, *answer))
        elif kind == _RESET:
            run = Run(table)
            if reset is not None:
                reset(run)
        elif kind == _WELCOME:
            if table.number(0, "<I", 0) != VERSION:
                raise TautlineError("This file speaks another version of the protocol.")
            welcome = True
        elif kind == _END:
            if not welcome:
                reason = table.text(0) if table is not None else ""
                raise TautlineError(reason or "Tautline closed the connection.")
            return
        else:
            raise TautlineError("Tautline sent an unknown message.")
