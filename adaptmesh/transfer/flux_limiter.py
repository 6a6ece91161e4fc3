"""The L² projection kept within the bounds of the old field, with the same integral.

Flux-corrected transport: the projection with the lumped mass matrix is within the bounds, for each
of its values is a mean of the old field with positive weights; but it smears. What it lacks of the
L² projection u are fluxes between nodes,

    m_i u_i = m_i l_i + sum over j of f_ij,     f_ij = M_ij (u_i - u_j) = -f_ji

and of each as much is put back as keeps both its ends within the bounds. What leaves one node
arrives at another: the integral does not change. The bounds of a node are those of the old field on
the old triangles that overlap the new triangles of the node.

P2 is limited in the Bernstein basis, whose functions are not negative: a field whose coefficients
are within bounds is so everywhere.

References
----------
Zalesak: Fully multidimensional flux-corrected transport algorithms for fluids. Journal of
Computational Physics 31 (1979). Kuzmin, Möller, Shadid, Shashkov: Failsafe flux limiting and
constrained data projections for equations of gas dynamics. Journal of Computational Physics 229
(2010). Lohmann, Kuzmin, Shadid, Mabuza: Flux-corrected transport algorithms for continuous Galerkin
methods based on high order Bernstein finite elements. Journal of Computational Physics 344 (2017).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from adaptmesh.types import Floats

from .spaces import Space

PASSES = 3
"""What a pass holds back, because the bounds were taken up, is tried again in the next."""


def limit(
    space: Space, matrix: Any, moments: Floats, projected: Floats, low: Floats, high: Floats
) -> Floats:
    """The projection between `low` and `high`, both (size, k), at the nodes."""
    if space.degree == 0:
        return np.clip(projected, low, high)
    to_bernstein = _to_bernstein(space)
    masses = to_bernstein @ matrix @ to_bernstein.T
    lumped = np.asarray(masses.sum(axis=1))
    target = _bernstein_coefficients(space, projected)
    pairs = sp.triu(masses, 1).tocoo()
    i, j = pairs.row, pairs.col
    fluxes = pairs.data[:, None] * (target[i] - target[j])
    now = (to_bernstein @ moments) / lumped
    for _ in range(PASSES):
        share = _shares(fluxes, i, j, lumped * (high - now), lumped * (now - low))
        now = now + _net(share * fluxes, i, j, space.size) / lumped
        fluxes = (1 - share) * fluxes
    # What is beyond the bounds now is so by rounding.
    return np.asarray(to_bernstein.T @ np.clip(now, low, high))


def _shares(fluxes: Floats, i: Any, j: Any, room_above: Floats, room_below: Floats) -> Floats:
    """The share of each flux that both its ends can take, whatever happens to the others."""
    gains, losses = np.maximum(fluxes, 0), np.maximum(-fluxes, 0)
    size = len(room_above)
    up = _fraction(room_above, _sum(gains, i, size) + _sum(losses, j, size))
    down = _fraction(room_below, _sum(losses, i, size) + _sum(gains, j, size))
    return np.where(fluxes > 0, np.minimum(up[i], down[j]), np.minimum(down[i], up[j]))


def _fraction(room: Floats, amount: Floats) -> Floats:
    """The share of an amount that there is room for, from 0 to 1."""
    room = np.maximum(room, 0)
    return np.divide(room, amount, out=np.ones_like(room), where=amount > room)


def _net(fluxes: Floats, i: Any, j: Any, size: int) -> Floats:
    return _sum(fluxes, i, size) - _sum(fluxes, j, size)


def _sum(values: Floats, at: Any, size: int) -> Floats:
    return np.stack([np.bincount(at, column, size) for column in values.T], axis=1)


def _to_bernstein(space: Space) -> Any:
    """E, (size, size): Bernstein functions B = E phi from the nodal ones.

    B is 1 for P1 the same; for P2, l_i² is 1 at its vertex and 1/4 at the midpoints beside it, and
    2 l_j l_k is 1/2 at its midpoint.
    """
    if space.degree == 1:
        return sp.identity(space.size, format="csr")
    n, ends = len(space.mesh.points), space.mesh.unique_edges
    midpoints = n + np.arange(len(ends))
    rows = np.concatenate([np.arange(n), midpoints, ends[:, 0], ends[:, 1]])
    columns = np.concatenate([np.arange(n), midpoints, midpoints, midpoints])
    values = np.repeat([1, 0.5, 0.25], [n, len(ends), 2 * len(ends)])
    return sp.csr_matrix((values, (rows, columns)), shape=(space.size, space.size))


def _bernstein_coefficients(space: Space, nodal: Floats) -> Floats:
    """Coefficients c of the field sum of c_i B_i with these values at the nodes."""
    out: Floats = nodal.copy()
    if space.degree == 2:
        n, ends = len(space.mesh.points), space.mesh.unique_edges
        out[n:] = 2 * nodal[n:] - 0.5 * (nodal[ends[:, 0]] + nodal[ends[:, 1]])
    return out


def bounds_on_triangles(space: Space, columns: Floats) -> tuple[Floats, Floats]:
    """The minimum and the maximum of fields on each triangle, both (m, k)."""
    values = columns[space.nodes_of_triangles]
    if space.degree == 2:
        values = np.concatenate([values, _extremes(values)], axis=1)
    return values.min(axis=1), values.max(axis=1)


def _extremes(values: Floats) -> Floats:
    """The values of quadratic functions, (m, 6, k), where they are stationary: (m, 4, k).

    Inside the triangle and inside each edge; elsewhere the value at a vertex, which is no news.
    """
    v, e = values[:, :3], values[:, 3:]
    following, before = np.roll(v, -1, axis=1), np.roll(v, 1, axis=1)
    # On an edge from a to b with m between: a + (4m - 3a - b) t + 2 (a - 2m + b) t².
    slope, bend = 4 * e - 3 * following - before, 2 * (following - 2 * e + before)
    place = np.divide(-slope, 2 * bend, out=np.zeros_like(bend), where=bend != 0)
    place = np.where((place > 0) & (place < 1), place, 0)
    on_edges = following + place * (slope + bend * place)

    # Inside, with (s, t) the coordinates of vertices 1 and 2: u0 + g x + x' H x / 2.
    v0, v1, v2 = v[:, 0], v[:, 1], v[:, 2]
    e0, e1, e2 = e[:, 0], e[:, 1], e[:, 2]
    g = np.stack([4 * e2 - 3 * v0 - v1, 4 * e1 - 3 * v0 - v2])
    h11, h22 = 4 * (v0 - 2 * e2 + v1), 4 * (v0 - 2 * e1 + v2)
    h12 = 4 * (v0 + e0 - e1 - e2)
    det = h11 * h22 - h12 * h12
    curved = det != 0
    s = np.divide(h12 * g[1] - h22 * g[0], det, out=np.zeros_like(det), where=curved)
    t = np.divide(h12 * g[0] - h11 * g[1], det, out=np.zeros_like(det), where=curved)
    inside = (s > 0) & (t > 0) & (s + t < 1)
    s, t = np.where(inside, s, 0), np.where(inside, t, 0)
    # At a stationary point the quadratic term is minus half the linear one.
    within = v0 + 0.5 * (g[0] * s + g[1] * t)
    return np.concatenate([on_edges, within[:, None]], axis=1)
