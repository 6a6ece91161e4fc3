"""Exact Delaunay triangulation of points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh._core import InputError
from adaptmesh._core import delaunay as core_delaunay
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Ints

__all__ = ["delaunay"]


def delaunay(points: ArrayLike) -> Ints:
    """Compute the Delaunay triangulation of points.

    No circumcircle has a point in its interior. The predicates are exact, so that this holds for
    any finite coordinates; cocircular points are triangulated in one of the possible ways. The same
    points give the same triangles in the same order.

    Parameters
    ----------
    points : (n, 2) array_like of float
        At least three points, not all on one line.

    Returns
    -------
    (m, 3) array of int32
        Indices of the points of each triangle, counter-clockwise. Of equal points only the first
        is used.

    Raises
    ------
    DomainError
        If the shape is not (n, 2), a coordinate is not finite, there are fewer than three points,
        or all lie on one line.

    See Also
    --------
    adaptmesh.generate : a mesh of a domain, with edges of the requested lengths.

    Notes
    -----
    Incremental insertion along a Hilbert curve with Lawson's flips [1]_ and Shewchuk's approach
    to exact signs [2]_.

    References
    ----------
    .. [1] C. L. Lawson, Software for C1 surface interpolation, in: Mathematical Software III,
       Academic Press, 1977, 161-194.
    .. [2] J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric
       predicates, Discrete & Computational Geometry 18 (1997), 305-363.

    Examples
    --------
    >>> from adaptmesh import delaunay
    >>> delaunay([[0, 0], [1, 0], [0, 1]])
    array([[0, 1, 2]], dtype=int32)
    """
    array = _checked(points)
    try:
        triangles, _ = core_delaunay(array)
    except InputError as fault:
        # Collinear points are the only fault that was not excluded above.
        low, high = array.min(axis=0), array.max(axis=0)
        raise DomainError(
            f"all {len(array)} points lie exactly on one line, between ({low[0]:.17g}, "
            f"{low[1]:.17g}) and ({high[0]:.17g}, {high[1]:.17g}); "
            "add a point off the line"
        ) from fault
    return triangles


def _checked(points: ArrayLike) -> Floats:
    raw = np.asarray(points)
    if raw.dtype.kind not in "biuf":
        raise DomainError(f"points: expected real numbers, got an array of type {raw.dtype}")
    array = np.ascontiguousarray(raw, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 2:
        raise DomainError(f"points: expected shape (n, 2), got {array.shape}")
    if len(array) < 3:
        raise DomainError(f"expected at least 3 points, got {len(array)}")
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(bad):
        i = int(bad[0])
        more = f" (and {len(bad) - 1} more)" if len(bad) > 1 else ""
        raise DomainError(
            f"point {i} at ({array[i, 0]}, {array[i, 1]}){more} is not finite; "
            "remove it or correct its coordinates"
        )
    return array
