"""Curves that lie on one another, made one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from adaptmesh.curves import Curve

from .joining import places_of

_PLACES = np.array([0.25, 0.5, 0.75])  # where curves with the same ends are compared


def curves_once(curves: Sequence[Curve], tolerance: float) -> tuple[list[int], list[int]]:
    """Which curves to keep, and for each curve the place of its like among these.

    Curves are alike if their ends and three places between are, to the tolerance, perhaps
    backwards.
    """
    if not curves:
        return [], []
    ends = np.array([end for c in curves for end in (c.start, c.end)])
    places = np.sort(places_of(ends, tolerance).reshape(-1, 2), axis=1)
    kept: list[int] = []
    number: list[int] = []
    alike: dict[tuple[int, int], list[int]] = {}
    for k, (first, second) in enumerate(places.tolist()):
        same = alike.setdefault((first, second), [])
        twin = next((j for j in same if _coincide(curves[k], curves[kept[j]], tolerance)), None)
        if twin is None:
            same.append(len(kept))
            number.append(len(kept))
            kept.append(k)
        else:
            number.append(twin)
    return kept, number


def _coincide(a: Curve, b: Curve, tolerance: float) -> bool:
    p, q = a.point(_PLACES), b.point(_PLACES)
    return bool((np.abs(p - q) <= tolerance).all() or (np.abs(p - q[::-1]) <= tolerance).all())
