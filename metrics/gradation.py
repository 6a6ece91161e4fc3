"""How fast sizes may grow: a metric at the vertices of a mesh, limited along its edges."""

from __future__ import annotations

from numbers import Real

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core

from . import tensor
from .checks import as_points, as_triangles
from .errors import MetricError
from .types import Floats

__all__ = ["LAWS", "graded"]

LAWS = ("h-correction", "metric", "mixed")


def graded(
    metric: ArrayLike,
    points: ArrayLike,
    triangles: ArrayLike,
    beta: float = 1.5,
    law: str = "mixed",
    *,
    tolerance: float = 1e-6,
) -> Floats:
    """A metric made finer where it would otherwise change too fast.

    Along every edge, in both directions, what a vertex p allows its neighbour q is bounded. With e
    the edge, l_p = sqrt(e' M_p e) its length in the metric at p, and h_p = abs(e) / l_p the size
    along it:

    ``"h-correction"``
        The H-shock is at most beta: (h_q / h_p)^(1 / l) <= beta, where l is the length of the edge
        with sizes that change geometrically along it, (l_p - l_q) / ln(l_p / l_q). Where it is
        more, M_q is multiplied by a number. Keeps the shape of every ellipse, and so must make all
        its sizes smaller where only one has to be: costly where thin ellipses turn.
    ``"metric"``
        M_q is intersected with M_p / (1 + l_p ln beta)^2: from p, all sizes grow in proportion.
        Thin ellipses stay as thin as they go.
    ``"mixed"``
        M_q is intersected with M_p whose eigenvalues are divided by the square of
        (1 + sqrt(eigenvalue) abs(e) ln beta)^t (1 + l_p ln beta)^(1 - t), t = 1/8: nearly as
        above, with a share of growth by which each size grows at the same rate in space, so that
        ellipses get rounder away from where they come from.

    Parameters
    ----------
    metric : (n,), (n, 3) or (n, 2, 2) array_like
        Sizes, packed tensors or matrices at the points.
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
        Their edges are those the metric is limited along.
    beta : float, optional
        The bound on growth from one unit edge to the next, above 1.
    law : {"mixed", "metric", "h-correction"}, optional
    tolerance : float, optional
        Violations of the bound on an edge that are smaller than this, relative, are ignored.

    Returns
    -------
    (n, 3) array of float
        Packed; nowhere coarser than what was given, in no direction. Grading it again changes
        nothing, but for roundings where ellipses are thinner than about 100,000 : 1.

    Raises
    ------
    MetricError
        For an invalid metric, arrays that do not fit, or another `beta` or `law`.

    Notes
    -----
    The vertex of the smallest ellipse acts first, of those with one area that with the shortest
    edges; one that has been made finer acts again. As the intersection is not associative, another
    order would give another result; this one does not depend on the axes or the numbering.

    References
    ----------
    Borouchaki, Hecht, Frey: Mesh gradation control. International Journal for Numerical Methods in
    Engineering 43 (1998), 1143-1165: the H-shock and its correction, and growth in the metric.

    Alauzet: Size gradation control of anisotropic meshes. Finite Elements in Analysis and Design
    46 (2010), doi:10.1016/j.finel.2009.06.028: growth in space, in the metric, and the mixture.
    """
    where = as_points(points)
    tensors = tensor.pack(metric, points=where)
    check_growth(beta, law)
    if not 0 < tolerance < 1:
        raise MetricError(f"tolerance must be between 0 and 1, not {tolerance!r}")
    return _core.graded(
        tensors,
        where,
        as_triangles(triangles, len(where)),
        LAWS.index(law),
        float(np.log(beta)),
        float(tolerance),
    )


def check_growth(beta: float, law: str) -> None:
    """Raise for an invalid bound on growth, or another law."""
    if law not in LAWS:
        raise MetricError(f"law must be one of {', '.join(map(repr, LAWS))}, not {law!r}")
    if not (isinstance(beta, Real) and 1 < beta < np.inf):
        raise MetricError(f"beta must be above 1, and finite, not {beta!r}; 1.5 is usual")
