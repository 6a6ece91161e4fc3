"""Periodic boundaries: two that a translation or a rotation makes one.

::

        first          second      Both get the same cuts. First each is cut into unit pieces
      a .------->------. a'        as they would be alone, and of each two parts that correspond
        |    motion    |           the one with fewer cuts gets the images of those of the other.
      b '------->------' b'
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.checks import checked_number
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Index, Ints
from adaptmesh.value import Value

from .paths import Run
from .polyline import Chords, Surroundings, chords_along

if TYPE_CHECKING:
    from .data import DomainData


TOLERANCE = 1e-9
"""Share of the extent of the domain by which images may miss what they are to meet."""

MOST_ROUNDS = 20  # in which cuts that one side needs are carried to the other

_SAMPLES = 64  # places on each part of a run among which the nearest is looked for
_NEWTON = 8


@dataclass(frozen=True, eq=False)
class Motion(Value):
    """A rigid motion of the plane: x to turn x + shift."""

    turn: Floats
    shift: Floats

    @classmethod
    def translation(cls, shift: ArrayLike) -> Motion:
        return cls(np.eye(2), _vector(shift, "translation"))

    @classmethod
    def rotation(cls, degrees: float, centre: ArrayLike) -> Motion:
        """Anticlockwise about a centre."""
        degrees = checked_number(degrees, "rotation")
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        turn = np.array([[c, -s], [s, c]])
        at = _vector(centre, "centre")
        return cls(turn, at - turn @ at)

    def inverse(self) -> Motion:
        return Motion(self.turn.T, -self.turn.T @ self.shift)

    def __call__(self, points: Floats) -> Floats:
        return points @ self.turn.T + self.shift


def _vector(value: ArrayLike, what: str) -> Floats:
    try:
        out = np.array(value, np.float64)
    except (TypeError, ValueError):
        out = np.full(2, np.nan)
    if out.shape != (2,) or not np.isfinite(out).all():
        raise DomainError(f"{what}={value!r}: two finite numbers are wanted")
    return out


@dataclass(frozen=True, eq=False)
class PeriodicPair(Value):
    """Two boundaries by name, and what of the one is carried to what of the other.

    Attributes
    ----------
    first, second : str
    motion : Motion
        From the first to the second.
    pieces : (k, 2) array of int
        Straight pieces of the domain, see `Domain.pieces`.
    runs : (r, 2) array of int
        Curved runs of the domain.
    tolerance : float
        How far images may be off.
    """

    first: str
    second: str
    motion: Motion
    pieces: Index
    runs: Index
    tolerance: float


@dataclass(frozen=True, eq=False)
class PeriodicSides(Value):
    """Two boundaries by name, and the motion that carries the first to the second."""

    first: str
    second: str
    motion: Motion


def used_tolerance(domain: DomainData, tolerance: float | None) -> float:
    """How far images may be off, if it is given or not."""
    if tolerance is None:
        return TOLERANCE * float(np.ptp(domain.points, axis=0).max())
    number = checked_number(tolerance, "tolerance")
    if number < 0:
        raise DomainError(f"tolerance={tolerance!r}: expected a distance, not less than 0")
    return number


def pair_motion(domain: DomainData, first: str, second: str, motion: Motion | None) -> Motion:
    """The motion that is given; if none is, the translation from one boundary to the other.

    It is that of the boxes around them, whatever points divide their straight pieces.
    """
    sides = [_side(domain, name) for name in (first, second)]
    if first == second:
        raise DomainError(f"{first!r} cannot be periodic with itself: give two names")
    for name, side in zip((first, second), sides, strict=True):
        if not len(side.pieces) and not len(side.runs):
            raise DomainError(f"no segment is named {name!r}: what should be periodic?")
    if motion is not None:
        return motion
    boxes = [(p.min(axis=0), p.max(axis=0)) for p in (side.places(domain) for side in sides)]
    (low, high), (to_low, to_high) = boxes
    return Motion.translation(0.5 * ((to_low - low) + (to_high - high)))


def periodic_pair(
    domain: DomainData, first: str, second: str, motion: Motion, tolerance: float
) -> PeriodicPair:
    """Find what belongs together; a `DomainError` names the first place that has no image."""
    sides = [_side(domain, name) for name in (first, second)]
    pieces = _partners(
        [domain.points[domain.pieces[side.pieces]] for side in sides],
        motion,
        tolerance,
        (first, second),
    )
    shapes = [
        np.array([_outline_of(domain.curved.runs[r]) for r in side.runs]).reshape(-1, 3, 2)
        for side in sides
    ]
    runs = _partners(shapes, motion, tolerance, (first, second))
    return PeriodicPair(
        first,
        second,
        motion,
        np.stack([sides[0].pieces, sides[1].pieces[pieces]], axis=1),
        np.stack([sides[0].runs, sides[1].runs[runs]], axis=1),
        tolerance,
    )


def side_pieces(domain: DomainData, name: str) -> Index:
    """The straight pieces that bear a name."""
    return _side(domain, name).pieces


class _Side(NamedTuple):
    """The straight pieces and the runs that bear a name."""

    pieces: Index
    runs: Index

    def places(self, domain: DomainData) -> Floats:
        ends = domain.points[domain.pieces[self.pieces]].reshape(-1, 2)
        curved = [_outline_of(domain.curved.runs[r]) for r in self.runs]
        return np.concatenate([ends, *curved])


def _side(domain: DomainData, name: str) -> _Side:
    mine = domain.segment_tags == domain.tag_named(name)
    run_of = domain.curved.segment_runs
    straight = mine & (run_of < 0)
    return _Side(
        np.flatnonzero(straight[domain.piece_segments]), np.unique(run_of[mine & (run_of >= 0)])
    )


def _outline_of(run: Run) -> Floats:
    """The ends of a run and its middle, (3, 2)."""
    return run.point(np.array([0.0, 0.5 * run.length, run.length]))


def _partners(
    shapes: Sequence[Floats], motion: Motion, tolerance: float, names: tuple[str, str]
) -> Index:
    """For each of the first shapes (k, p, 2) the number of the second that is its image.

    Points may come in either order: that of a shape and the reverse.
    """
    from scipy.spatial import KDTree

    first, second = shapes
    _refuse_without_image(first, second, motion, tolerance, names)
    _refuse_without_image(second, first, motion.inverse(), tolerance, names[::-1])
    if not len(first):
        return np.empty(0, np.intp)
    either = np.concatenate([second, second[:, ::-1]]).reshape(2 * len(second), -1)
    images = motion(first.reshape(-1, 2)).reshape(len(first), -1)
    nearest = KDTree(either).query(images, p=np.inf)[1] % len(second)
    if len(np.unique(nearest)) < len(nearest):
        raise DomainError(f"two parts of {names[0]!r} are carried to the same part of {names[1]!r}")
    return nearest


def _refuse_without_image(
    first: Floats, second: Floats, motion: Motion, tolerance: float, names: tuple[str, str]
) -> None:
    """Raise a `DomainError` if one of the first shapes is carried to none of the second."""
    from scipy.spatial import KDTree

    if not len(first):
        return
    off = np.full(len(first), np.inf)
    images = motion(first.reshape(-1, 2)).reshape(first.shape)
    if len(second):
        either = np.concatenate([second, second[:, ::-1]]).reshape(2 * len(second), -1)
        off = KDTree(either).query(images.reshape(len(first), -1), p=np.inf)[0]
    if off.max() > tolerance:
        k = int(np.flatnonzero(off > tolerance)[0])
        ends = [f"({x:.10g}, {y:.10g})" for x, y in (*first[k, [0, -1]], *images[k, [0, -1]])]
        raise DomainError(
            f"what goes from {ends[0]} to {ends[1]} on {names[0]!r} would be carried to {ends[2]} "
            f"and {ends[3]}, but nothing on {names[1]!r} has its ends there within {tolerance:g}: "
            "check the motion, and that both sides have the same corners"
        )


def frozen_pieces(domain: DomainData) -> NDArray[np.bool_]:
    """Which straight pieces (p,) are not cut: frozen ones, and those tied to one that is."""
    out: NDArray[np.bool_] = domain.segment_is_frozen[domain.piece_segments]
    for pair in domain.periodic:
        out[pair.pieces] = out[pair.pieces].any(axis=1, keepdims=True)
    return out


def with_partners(domain: DomainData, names: Iterable[str]) -> list[str]:
    """Names of boundaries, each once, and of those that are periodic with them."""
    out = dict.fromkeys(names)
    for pair in domain.periodic:
        if {pair.first, pair.second} & out.keys():
            out |= {pair.first: None, pair.second: None}
    return list(out)


def tied_cuts(
    points: Floats, pieces: Ints, cuts: Floats, piece: Index, pairs: Index
) -> tuple[Floats, Ints]:
    """Cuts of straight pieces, the same on those that correspond.

    Parameters
    ----------
    points, pieces : (n, 2), (p, 2) arrays
    cuts, piece : (c, 2), (c,) arrays
        Points on pieces, in order along each, and the piece of each.
    pairs : (k, 4) array of int
        Two pieces, and which ends of theirs correspond: pieces[i, a] to pieces[j, b].
    """
    order = np.argsort(piece, kind="stable")
    groups = np.split(cuts[order], np.searchsorted(piece[order], np.arange(1, len(pieces))))
    for i, j, a, b in pairs.tolist():
        source, target = ((i, a), (j, b)) if len(groups[i]) >= len(groups[j]) else ((j, b), (i, a))
        start, end = (points[pieces[source[0], k]] for k in (source[1], 1 - source[1]))
        span = end - start
        share = (groups[source[0]] - start) @ span / (span @ span)
        start, end = (points[pieces[target[0], k]] for k in (target[1], 1 - target[1]))
        images = start + share[:, None] * (end - start)
        groups[target[0]] = images if source[1] == target[1] else images[::-1]
    owner = np.repeat(np.arange(len(pieces), dtype=np.int32), [len(g) for g in groups])
    return np.concatenate([np.empty((0, 2)), *groups]), owner


def tied_chords(
    chords: Chords,
    runs: Sequence[Run],
    pairs: Sequence[PeriodicPair],
    turn: float,
    around: Surroundings,
) -> Chords:
    """Chords of runs, the same on those that correspond; more where they would cross something."""
    ties = [(pair, *row) for pair in pairs for row in pair.runs.tolist()]
    if not ties:
        return chords
    for _ in range(MOST_ROUNDS):
        cuts = chords.by_run(len(runs))
        for pair, i, j in ties:
            if len(cuts[i]) >= len(cuts[j]):
                cuts[j] = _carried(runs[i], runs[j], cuts[i], pair.motion)
            else:
                cuts[i] = _carried(runs[j], runs[i], cuts[j], pair.motion.inverse())
        chords = chords_along(runs, cuts, turn, around)
        counts = np.bincount(chords.run, minlength=len(runs))
        differing = [pair for pair, i, j in ties if counts[i] != counts[j]]
        if not differing:
            return chords
    pair = differing[0]
    raise DomainError(
        f"{pair.first!r} and {pair.second!r} cannot be cut alike: what comes near one of them "
        "needs more chords there"
    )


def _carried(source: Run, target: Run, u: Floats, motion: Motion) -> Floats:
    """Parameters on the target of the images of points of the source; ends to ends."""
    out = np.sort(images_on(target, motion(source.point(u[1:-1]))))
    return np.concatenate([[0.0], out, [target.length]])


def images_on(run: Run, points: Floats) -> Floats:
    """The parameters (n,) of a run nearest to points (n, 2) that lie on it to rounding.

    The nearest of many samples, then Newton's steps for (p(u) - x) . p'(u) = 0, without the second
    derivative, as the distance is nearly zero.
    """
    samples = np.linspace(0, run.length, int(_SAMPLES * run.length) + 1)
    places = run.point(samples)
    u = samples[((points[:, None] - places) ** 2).sum(axis=2).argmin(axis=1)]
    for _ in range(_NEWTON):
        off, d = points - run.point(u), run.derivative(u)
        u = np.clip(u + (off * d).sum(axis=1) / (d * d).sum(axis=1), 0, run.length)
    return u
