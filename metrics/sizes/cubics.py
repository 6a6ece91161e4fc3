"""Short pieces of curves, as cubics, and the nearest points on them."""

from __future__ import annotations

import numpy as np

from metrics.types import Floats, Ints

__all__ = ["Cubics"]

STEPS = 12
"""Newton's steps at most: pieces turn little, and the chord is a good start."""

CONVERGED = 1e-14
"""A step no longer than this, as a share of the piece, is the last."""

HOPS = 3
"""So often the foot may move on to the next piece."""

SMOOTH = 1e-6
"""Two pieces go on smoothly into each other if they turn by less than this, in radians."""


class Cubics:
    """Pieces a + c1 t + c2 t² + c3 t³, 0 <= t <= 1, by their ends and derivatives there.

    Parameters
    ----------
    ends, derivatives : (k, 2, 2) arrays
    """

    def __init__(self, ends: Floats, derivatives: Floats) -> None:
        a, b = ends[:, 0], ends[:, 1]
        d0, d1 = derivatives[:, 0], derivatives[:, 1]
        self.start, self.end = a, b
        self.coefficients = d0, 3 * (b - a) - 2 * d0 - d1, d0 + d1 - 2 * (b - a)
        self.is_curved = (derivatives != (b - a)[:, None]).any(axis=(1, 2))
        self.next = _neighbours(ends, derivatives)

    def project(
        self, points: Floats, pieces: Ints, shares: Floats
    ) -> tuple[Ints, Floats, Floats, Floats]:
        """The nearest points, from the nearest piece and place on its chord.

        Returns
        -------
        pieces, shares : (n,) arrays
        feet, tangents : (n, 2) arrays
            The nearest points, and unit vectors along the pieces there.
        """
        pieces, shares = pieces.copy(), shares.copy()
        shares = self._newton(points, pieces, shares)
        for _ in range(HOPS):
            foot, along, _ = self._at(pieces, shares)
            pull = ((points - foot) * along).sum(axis=1)
            side = np.where(
                (shares == 1) & (pull > 0), 1, np.where((shares == 0) & (pull < 0), 0, -1)
            )
            there = np.where(side[:, None] >= 0, self.next[pieces, np.maximum(side, 0)], -1)
            hops = np.flatnonzero(there[:, 0] >= 0)
            if not len(hops):
                break
            piece, end = there[hops].T
            share = self._newton(points[hops], piece, end.astype(np.float64))
            new, old = self._at(piece, share)[0], foot[hops]
            nearer = _squares(points[hops] - new) < _squares(points[hops] - old)
            if not nearer.any():
                break
            pieces[hops[nearer]], shares[hops[nearer]] = piece[nearer], share[nearer]
        foot, along, _ = self._at(pieces, shares)
        length = np.maximum(np.hypot(*along.T), np.finfo(float).tiny)
        return pieces, shares, foot, along / length[:, None]

    def _at(self, pieces: Ints, t: Floats) -> tuple[Floats, Floats, Floats]:
        """Points, first and second derivatives, (n, 2) each; at t = 1 the end, to the bit."""
        c1, c2, c3 = (c[pieces] for c in self.coefficients)
        t = t[:, None]
        at = self.start[pieces] + t * (c1 + t * (c2 + t * c3))
        at = np.where(t == 1, self.end[pieces], at)
        return at, c1 + t * (2 * c2 + 3 * t * c3), 2 * c2 + 6 * t * c3

    def _newton(self, points: Floats, pieces: Ints, t: Floats) -> Floats:
        """Where on their pieces the nearest points are, from places near them."""
        active = np.flatnonzero(self.is_curved[pieces])
        out: Floats = t.copy()
        straight = np.flatnonzero(~self.is_curved[pieces])
        if len(straight):
            c1 = self.coefficients[0][pieces[straight]]
            off = points[straight] - self.start[pieces[straight]]
            share = (off * c1).sum(axis=1) / np.maximum(_squares(c1), np.finfo(float).tiny)
            out[straight] = np.clip(share, 0, 1)
        for _ in range(STEPS):
            if not len(active):
                break
            at, first, second = self._at(pieces[active], out[active])
            off, speed = at - points[active], _squares(first)
            slope = speed + (off * second).sum(axis=1)
            slope = np.where(slope > 0.1 * speed, slope, np.maximum(speed, np.finfo(float).tiny))
            before = out[active]
            out[active] = np.clip(before - (off * first).sum(axis=1) / slope, 0, 1)
            active = active[np.abs(out[active] - before) > CONVERGED]
        return out


def _squares(vectors: Floats) -> Floats:
    return (vectors**2).sum(axis=1)


def _neighbours(ends: Floats, derivatives: Floats) -> Ints:
    """What goes on smoothly at each end of each piece: piece and end, (k, 2, 2), or -1."""
    out = np.full((len(ends), 2, 2), -1, np.int32)
    leaves = derivatives * np.array([1.0, -1.0])[None, :, None]  # from the end into the piece
    leaves = leaves.reshape(-1, 2)
    _, place, count = np.unique(
        ends.reshape(-1, 2), axis=0, return_inverse=True, return_counts=True
    )
    order = np.argsort(place.ravel(), kind="stable")
    first = np.cumsum(count) - count
    i, j = order[first[count == 2]], order[first[count == 2] + 1]
    u, v = leaves[i], -leaves[j]
    turn = np.arctan2(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]), (u * v).sum(axis=1))
    i, j = i[turn < SMOOTH], j[turn < SMOOTH]
    for one, other in ((i, j), (j, i)):
        out[one // 2, one % 2] = np.stack([other // 2, other % 2], axis=1)
    return out
