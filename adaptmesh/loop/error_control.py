"""How many vertices give the error that was asked for, learned from the meshes made so far."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

LEARNING_RATIO = 1.1  # meshes whose vertex counts differ by less say nothing about the order
ORDER_RANGE = (0.5, 4.0)  # of the learned order over the one assumed
NEAR = 0.3  # logarithm of the excess on meshes that each tell about the same number
SCATTER = 0.1  # steps shorter than this, in logarithms, are as good as none
SHRINK, EXPAND = 0.5, 1.25  # of the longest step, where steps turn back and where they go on
SHORTEST = 0.1  # so long a step, in logarithms, is always allowed
MEMORY = 4  # meshes looked back on: older ones were made for a solution not yet resolved


def next_count(
    counts: Sequence[int], excesses: Sequence[float], order: float, growth: float = np.inf
) -> float:
    """The number of vertices with which the error is expected to be the one asked for.

    The error is taken to fall with the number of vertices N as N^-q. For isotropic and for most
    anisotropic fields q = 1; for one that varies in one direction only, whose other size stays at
    `h_max`, q = 2. The order q is that between the last mesh and the latest one before it with
    another number of vertices. Where the error was too large on one of the last two meshes and too
    small on the other, the answer lies between their numbers.

    The error is that on a mesh made by what was seen on the one before. Much fewer vertices lose
    what is resolved, and many more do not resolve at once what was lost, so that numbers can go up
    and down for ever. Hence steps get shorter each time that they turn back.

    Parameters
    ----------
    counts : sequence of int
        Vertices of the meshes so far, the last one last; at least one.
    excesses : sequence of float
        The error on each, over the one asked for.
    order : float
        The order assumed where there is nothing to learn from.
    growth : float
        Bound on the ratio of the answer and the last number, either way.
    """
    x = np.log(np.asarray(counts[-MEMORY:], np.float64))
    y = np.log(np.maximum(np.asarray(excesses[-MEMORY:], np.float64), np.finfo(float).tiny))
    counts_asked = x + y / _learned_order(x, y, order)  # by each mesh
    near = np.abs(y) < NEAR
    answer = float(counts_asked[near].mean() if near[-1] else counts_asked[-1])
    if len(x) > 1 and y[-1] * y[-2] < 0:
        answer = float(np.clip(answer, min(x[-2:]), max(x[-2:])))
    answer = min(answer, np.log(np.finfo(float).max) - 1)
    steps = np.append(np.diff(np.log(np.asarray(counts, np.float64))), answer - x[-1])
    longest = _longest_step(steps, float(np.log(growth)))
    return float(np.exp(x[-1] + np.clip(steps[-1], -longest, longest)))


def _longest_step(steps: np.ndarray, bound: float) -> float:
    """How long the last of these steps may be: less for each time that they turned back."""
    signs = np.sign(steps[np.abs(steps) > SCATTER])
    longest = bound
    for turns_back in signs[1:] != signs[:-1]:
        longest = min(bound, longest * (SHRINK if turns_back else EXPAND))
    return min(bound, max(longest, SHORTEST))


def _learned_order(x: np.ndarray, y: np.ndarray, order: float) -> float:
    """The order between the last mesh and the latest of another size, within bounds."""
    others = np.flatnonzero(np.abs(x[:-1] - x[-1]) >= np.log(LEARNING_RATIO))
    if not len(others):
        return order
    k = others[-1]
    low, high = ORDER_RANGE
    return float(np.clip((y[k] - y[-1]) / (x[-1] - x[k]), low * order, high * order))
