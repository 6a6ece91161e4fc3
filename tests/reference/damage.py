"""Damage to files, each from a seed, and what may come of reading them."""

import contextlib
import random
import re
import signal
import struct
import tempfile
import warnings
from pathlib import Path

import numpy as np
import pytest
from reference.whole_files import WHOLE

import adaptmesh as am
from adaptmesh import io
from adaptmesh.errors import FormatWarning
from adaptmesh.io.formats import OUTLINES

MEMORY = 1 << 30  # bytes that reading a file of some kB may take, beyond what is in use
SECONDS = 20  # of processor time, where milliseconds are usual

NUMBERS = [
    b"nan", b"inf", b"-inf", b"1e400", b"1e308", b"-1e308", b"1e75", b"1e-400", b"1e-310", b"-0",
    b"0", b"1", b"-1", b"2", b"0.5", b"1e5", b"65536", b"99999999", b"2147483647", b"2147483648",
    b"4294967295", b"9223372036854775807", b"9" * 25, b"1" * 500, b"", b"x", b"1_0",
    b"\xb2", b"0x10",
]  # fmt: skip
WORDS = [
    struct.pack(order + code, value)
    for order in "<>"
    for code, values in (
        ("i", [0, 1, -1, 2**16, 2**31 - 1, -(2**31)]),
        ("q", [1, -1, 2**31, 2**40, 2**62, 2**63 - 1, -(2**63)]),
        ("d", [np.nan, np.inf, 1e308, -1e308, 1e75, 5e-324, 0.5]),
    )
    for value in values
]
EXTREMES = [1.7e308, 1e300, 1e200, 1e160, 1e150, 1e100, 1e76, 1e74, 1e60, 1e-60, 1e-160, 1e-310]
_NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


# ----------------------------------------------------------------------------------------- damage


def damaged(data, chance, others):
    """The bytes of a file after an accident of some kind; `others` are whole files of any kind."""
    kind = chance.choice(KINDS)
    return kind(data, chance) if kind is not other_content else kind(chance, others)


def cut(data, chance):
    return data[: chance.randrange(len(data) + 1)]


def flipped(data, chance):
    out = bytearray(data)
    for _ in range(chance.choice([1, 1, 3, 20])):
        i = chance.randrange(len(out))
        out[i] = chance.choice([out[i] ^ 1 << chance.randrange(8), 0, 255, 45, 57])
    return bytes(out)


def piece_lost_or_repeated(data, chance):
    i, j = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    return chance.choice([data[:i] + data[j:], data[:j] + data[i:]])


def line_lost_repeated_or_moved(data, chance):
    lines = data.splitlines(keepends=True)
    i, j = (chance.randrange(len(lines)) for _ in range(2))
    how = chance.randrange(3)
    if how == 0:
        del lines[i]
    elif how == 1:
        lines.insert(j, lines[i])
    else:
        lines[i], lines[j] = lines[j], lines[i]
    return b"".join(lines)


def digits_changed(data, chance):
    places = [m.start() for m in re.finditer(rb"\d", data)]
    out = bytearray(data)
    for i in chance.sample(places, min(len(places), chance.choice([1, 1, 2, 5]))):
        out[i] = chance.choice(b"0123456789")
    return bytes(out)


def numbers_replaced(data, chance):
    found = list(_NUMBER.finditer(data))
    for m in sorted(
        chance.sample(found, min(len(found), chance.choice([1, 1, 2]))), key=lambda m: -m.start()
    ):
        data = data[: m.start()] + chance.choice(NUMBERS) + data[m.end() :]
    return data


def numbers_made_extreme(data, chance):
    """Numbers whose squares or products overflow or underflow, in text; or one in binary."""
    found = list(_NUMBER.finditer(data))
    if data.count(b"\0") > len(data) // 20 or not found:
        i = 8 * chance.randrange(len(data) // 8 + 1) + chance.choice([0, 0, len(data) % 8])
        word = struct.pack("<d", chance.choice([1, -1]) * chance.choice(EXTREMES))
        return data[:i] + word + data[i + 8 :]
    few = chance.sample(found, min(len(found), chance.choice([1, 1, 2, 3, 8])))
    for m in sorted(few, key=lambda m: -m.start()):
        number = chance.choice([1, -1]) * chance.choice(EXTREMES)
        data = data[: m.start()] + b"%r" % number + data[m.end() :]
    return data


def word_overwritten(data, chance):
    word = chance.choice(WORDS)
    i = chance.choice([1, 4, 8]) * chance.randrange(len(data) // 8 + 1)
    return data[:i] + word + data[i + len(word) :]


def other_content(chance, others):
    return chance.choice([b"", b"\0" * 100, bytes(range(256)) * 4, b"x" * 10_000, *others])


KINDS = [
    cut, flipped, flipped, piece_lost_or_repeated, line_lost_repeated_or_moved, digits_changed,
    numbers_replaced, numbers_replaced, numbers_made_extreme, word_overwritten, other_content,
]  # fmt: skip


# ----------------------------------------------------------------------------------------- reading


def read_every_way(path):
    """Read the file by all functions that take its suffix; "read" or "refused", by the first.

    Raises whatever is no `AdaptmeshError`, and an `AssertionError` for one that does not name the
    file, or for what is read and is not valid.
    """
    outcomes = [outcome(reader, path) for reader in readers_of(path)]
    return outcomes[0]


def outcome(reader, path):
    try:
        with warnings.catch_warnings(), little_time():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", FormatWarning)  # of what is passed over
            warnings.simplefilter("ignore", DeprecationWarning)  # of libraries
            reader(path)
    except am.AdaptmeshError as error:
        name = path.parent.name if path.name in HISTORIES else f"{path.stem}."
        assert name in str(error), f"does not name the file: {error}"
        cause = error.__cause__
        assert isinstance(cause, (am.AdaptmeshError, type(None))), f"unforeseen: {cause!r}"
        return "refused"
    return "read"


def readers_of(path):
    suffix = path.suffix
    if path.name in HISTORIES:
        return [HISTORIES[path.name]]
    if suffix == ".mtr":
        return [io.read_metric]
    if suffix in (".sol", ".solb"):
        return [io.read_sol]
    if suffix in OUTLINES:
        return [read_domain, repaired]
    return [read_mesh, io.read_fields, read_domain, io.read_metric]


def read_history(path):
    found = am.History.load(path.parent)
    str(found)
    for iteration in found:
        assert len(iteration.mesh.points) == iteration.n_points == len(iteration.metric)
        assert iteration.mesh.validate().ok
        assert all(np.isfinite(values).all() for values in iteration.fields.values())


def read_history_in_time(path):
    found = am.TransientHistory.load(path.parent)
    str(found)
    assert all(interval.mesh.validate().ok for interval in found.intervals)


HISTORIES = {"history.json": read_history, "transient.json": read_history_in_time}


def read_mesh(path):
    mesh = io.read(path)
    assert np.isfinite(mesh.points).all()
    assert mesh.triangles.min() >= 0
    assert mesh.triangles.max() < len(mesh.points)
    mesh.validate()


def read_domain(path):
    domain = am.read_domain(path)
    assert domain.area > 0
    assert np.isfinite(domain.area)


def repaired(path):
    domain, report = am.repair(path)
    assert domain.area > 0
    str(report)


class TookTooLong(BaseException):
    """A reader that does not come to an end."""


@contextlib.contextmanager
def little_time():
    """Stop after `SECONDS` of processor time."""

    def stop(*_):
        raise TookTooLong(f"more than {SECONDS} s of processor time")

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


@contextlib.contextmanager
def little_memory():
    """Let the process have no more than `MEMORY` beyond what it has: more is a `MemoryError`."""
    import resource

    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


# ------------------------------------------------------------------------------------------- cases


class Whole:
    """The files that one way to write a suffix gives, to be damaged again and again."""

    def __init__(self, suffix, way, folder):
        self.path = WHOLE[suffix][way](folder)
        self.files = {p: p.read_bytes() for p in sorted(folder.iterdir())}
        assert read_every_way(self.path) == "read", "the whole file is refused"

    def damage(self, seed, others):
        """Damage one of the files, the others being whole."""
        chance = random.Random(seed)
        victim = chance.choice([self.path, *self.files])
        for path, data in self.files.items():
            path.write_bytes(damaged(data, chance, others) if path == victim else data)


def contents():
    """The bytes of one whole file of every kind."""
    out = []
    for ways in WHOLE.values():
        for write in ways.values():
            with (
                tempfile.TemporaryDirectory() as folder,
                contextlib.suppress(pytest.skip.Exception),
            ):
                out.append(write(Path(folder)).read_bytes())
    return out
