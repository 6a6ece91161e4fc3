"""A program of its own that opens a script with Gmsh and prints, as JSON, what it defines.

It is started by `by_gmsh` beside it, so that a crash, an endless loop or the global state of
Gmsh stay outside of the caller. It imports nothing of adaptmesh. Started with the path of the
script, the seconds of processor time and the bytes of memory it may take, it prints ::

    {"points":   {tag: [x, y, z]},
     "curves":   {tag: {"kind": "line" | "ellipse" | "cubics", ...}},
     "surfaces": {tag: {"curves": [tag, ...], "curves_inside": [...], "points_inside": [...]}},
     "groups":   [[dimension, tag, name, [entity, ...]]],
     "periodic": [[curve, other curve], ...],
     "volumes":  number, "error": text or null}

Curves that a surface has on both sides, as slits, are listed twice. A line has its two ends; an arc
of a circle or an ellipse P(s) = centre + cos(s) first + sin(s) second for s in (0, turn); any other
curve is a cubic spline with double knots, given by these and control points: exactly, where it
consists of cubics over equal parts of its parameter (Gmsh's own splines), else to `ACCURACY` of its
size.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import numpy as np

EXACT = 1e-12
"""What rounding may leave of the distance to a curve, as a share of its size."""

ACCURACY = 1e-9
"""How near cubics have to be to a curve that they are not, likewise."""

MOST_PARTS = 128  # equal parts of the parameter that are tried
_SNAP = 1e-6  # share of its size by which the end of a curve may miss its point
_DEEPEST = 14  # halvings where none of these fit
_SAMPLES = np.array([0.15, 0.4, 0.62, 0.87])


def main(path: str, seconds: str, memory: str) -> None:
    """Open the script and print what it defines."""
    _limit(int(seconds), int(memory))
    out: dict[str, Any] = {"error": None}
    try:
        import gmsh
    except (ImportError, OSError) as error:
        out["error"] = f"gmsh cannot be loaded ({error}): install the library that it names"
        print(json.dumps(out))
        return
    gmsh.initialize(["gmsh"], readConfigFiles=False, run=False, interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.logger.start()
    try:
        gmsh.open(path)
    except Exception as error:  # gmsh raises plain exceptions
        out["error"] = str(error)
    said = [line for line in gmsh.logger.get() if line.startswith("Error")]
    if said or out["error"]:
        out["error"] = said[0] if said else out["error"]
    else:
        out.update(_content(gmsh.model))
    print(json.dumps(out))


def _limit(seconds: int, memory: int) -> None:
    """Bound time and memory, and write no files, where the system can."""
    try:
        import resource
    except ImportError:  # Windows
        return
    for what, bound in (
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
    ):
        hard = resource.getrlimit(what)[1]
        bound = bound if hard == resource.RLIM_INFINITY else min(bound, hard)
        resource.setrlimit(what, (bound, hard))


def _content(model: Any) -> dict[str, Any]:
    surfaces = {}
    for _, tag in model.getEntities(2):
        boundary = model.getBoundary([(2, tag)], combined=False, oriented=False)
        inside = model.mesh.getEmbedded(2, tag)
        surfaces[tag] = {
            "curves": sorted(t for _, t in boundary),
            "curves_inside": [t for dim, t in inside if dim == 1],
            "points_inside": [t for dim, t in inside if dim == 0],
        }
    curves = [tag for _, tag in model.getEntities(1)]
    return {
        "points": {tag: model.getValue(0, tag, []).tolist() for _, tag in model.getEntities(0)},
        "curves": {tag: _curve(model, tag) for tag in curves},
        "surfaces": surfaces,
        "groups": [
            [dim, tag, model.getPhysicalName(dim, tag), _entities(model, dim, tag)]
            for dim, tag in model.getPhysicalGroups()
        ],
        "periodic": [
            [tag, int(other)]
            for tag, other in zip(curves, model.mesh.getPeriodic(1, curves), strict=True)
            if tag != other
        ]
        if curves
        else [],
        "volumes": len(model.getEntities(3)),
    }


def _entities(model: Any, dim: int, tag: int) -> list[int]:
    return [abs(int(e)) for e in model.getEntitiesForPhysicalGroup(dim, tag)]


# --------------------------------------------------------------------------------------- curves


class _Path:
    """A curve of the model over its parameter."""

    def __init__(self, model: Any, tag: int) -> None:
        self._model, self._tag = model, tag
        (low,), (high,) = model.getParametrizationBounds(1, tag)
        self.low, self.high = float(low), float(high)

    def at(self, t: Any) -> Any:
        """Points, (n, 3), at t from 0 to 1."""
        u = self.low + (self.high - self.low) * np.asarray(t, float)
        return np.reshape(self._model.getValue(1, self._tag, u), (-1, 3))


def _curve(model: Any, tag: int) -> dict[str, Any]:
    kind = model.getType(1, tag)
    if kind in ("Discrete curve", "Unknown"):
        return {"kind": kind}
    path = _Path(model, tag)
    ends = [t for _, t in model.getBoundary([(1, tag)], combined=False, oriented=True)]
    points = [model.getValue(0, abs(t), []) for t in ends] if len(ends) == 2 else path.at([0, 1])
    if kind == "Line":
        return {"kind": "line", "points": np.array(points).tolist()}
    samples = path.at(np.linspace(0, 1, 33))
    size = float(np.ptp(samples, axis=0).max())
    conic = _conic(samples, size) if kind in ("Circle", "Ellipse") else None
    if conic is not None:
        if kind == "Circle" and len(ends) == 2:
            conic["off"] = _snap(conic["points"], points, size)
        return conic
    knots, pieces = _cubics(path, size)
    control = np.concatenate([pieces[:1, 0], pieces[:, 1:3].reshape(-1, 3), pieces[-1:, 3]])
    for end in (0, -1):  # points of the model, from which rounding parts them
        nearest = min(points, key=lambda p: float(np.abs(p - control[end]).max()))
        if np.abs(nearest - control[end]).max() <= _SNAP * size:
            control[end] = nearest
    return {"kind": "cubics", "control": control.tolist(), "knots": knots.tolist()}


def _snap(arc: list[Any], ends: list[Any], size: float) -> float:
    """Put an arc's first and last of three points to its ends; how far they were, of its size.

    Three points of a script do not always lie on one circle: Gmsh's arc then misses its end.
    """
    off = 0.0
    for k in (0, 2):
        nearest = min(ends, key=lambda p: float(np.abs(p - arc[k]).max()))
        off = max(off, float(np.abs(nearest - arc[k]).max()) / size)
        arc[k] = np.asarray(nearest).tolist()
    return off


def _conic(samples: Any, size: float) -> dict[str, Any] | None:
    """The arc P(s) = C + A cos s + B sin s through points at equal steps; None if there is none."""
    # D(k) = P(k + 1) - P(k - 1) satisfies D(k + 1) + D(k - 1) = 2 cos(h) D(k).
    step = samples[2:] - samples[:-2]
    twice = float((step[1:-1] * (step[2:] + step[:-2])).sum() / (step[1:-1] ** 2).sum())
    # 2 - 2 cos(h) from second differences keeps its digits for short arcs.
    bend = step[1:-1] * (2 * step[1:-1] - step[2:] - step[:-2])
    gap = float(bend.sum() / (step[1:-1] ** 2).sum())
    if not 0 < gap < 4 or twice <= -2:
        return None
    h = 2 * np.arcsin(np.sqrt(gap) / 2)
    turn = h * (len(samples) - 1)
    whole = 2 * np.pi
    turn = whole if abs(turn - whole) < 1e-9 else turn
    angles = np.linspace(0, turn, len(samples))
    matrix = np.column_stack([np.ones_like(angles), np.cos(angles), np.sin(angles)])
    (centre, first, second), *_ = np.linalg.lstsq(matrix, samples, rcond=None)
    if np.abs(matrix @ [centre, first, second] - samples).max() > 1e-10 * size:
        return None
    return {
        "kind": "ellipse",
        "centre": centre.tolist(),
        "first": first.tolist(),
        "second": second.tolist(),
        "turn": float(turn),
        "points": samples[[0, 16, -1]].tolist(),
    }


def _cubics(path: _Path, size: float) -> tuple[Any, Any]:
    """Where cubics begin and end, (n + 1,), and their control points, (n, 4, 3)."""
    for parts in range(1, MOST_PARTS + 1):
        first = _pieces(path, np.array([0, 1 / parts]))
        if _error(path, first, np.array([0, 1 / parts])) > EXACT * size:
            continue
        t = np.linspace(0, 1, parts + 1)
        pieces = _pieces(path, t)
        if _error(path, pieces, t) <= EXACT * size:
            return t, pieces
    t = np.array([0.0, 1.0])
    for _ in range(_DEEPEST):
        off = _errors(path, _pieces(path, t), t) > ACCURACY * size
        if not off.any():
            break
        t = np.sort(np.concatenate([t, (t[1:][off] + t[:-1][off]) / 2]))
    return t, _pieces(path, t)


def _pieces(path: _Path, t: Any) -> Any:
    """Cubics from t to t, whose slopes where they meet are those of cubics through four points.

    Gmsh's own derivatives are differences, of half the digits.
    """
    h = np.diff(t)[:, None]
    places = t[:-1] + h[:, 0] * np.array([[0], [1 / 3], [2 / 3], [1]])
    p = path.at(places.ravel()).reshape(4, len(h), 3)
    first = (-11 * p[0] + 18 * p[1] - 9 * p[2] + 2 * p[3]) / (2 * h)
    last = (11 * p[3] - 18 * p[2] + 9 * p[1] - 2 * p[0]) / (2 * h)
    d = np.concatenate([first[:1], (last[:-1] + first[1:]) / 2, last[-1:]])
    return np.stack([p[0], p[0] + d[:-1] * h / 3, p[3] - d[1:] * h / 3, p[3]], axis=1)


def _error(path: _Path, pieces: Any, t: Any) -> float:
    return float(_errors(path, pieces, t).max())


def _errors(path: _Path, pieces: Any, t: Any) -> Any:
    s = _SAMPLES[:, None, None]
    a, b, c, d = (pieces[:, k] for k in range(4))
    found = (1 - s) ** 3 * a + 3 * s * (1 - s) ** 2 * b + 3 * s**2 * (1 - s) * c + s**3 * d
    places = t[:-1] + np.diff(t) * _SAMPLES[:, None]
    true = path.at(places.ravel()).reshape(found.shape)
    return np.abs(found - true).max(axis=(0, 2))


if __name__ == "__main__":
    main(*sys.argv[1:])
