"""The L² projection onto a space: from the moments of a field to its values at the nodes.

    M u = b,   M_ij = integral of phi_i phi_j,   b_i = integral of phi_i times the old field

The sum of b over i is the integral of the old field, and that of M u the integral of the new: they
agree to rounding.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from adaptmesh.types import Floats

from .spaces import Space

# Integrals of products of two basis functions over a triangle of area 1, by degree.
MASSES = {
    0: np.ones((1, 1)),
    1: (np.ones((3, 3)) + np.eye(3)) / 12,
    2: np.block(
        [
            [(7 * np.eye(3) - np.ones((3, 3))) / 180, -4 * np.eye(3) / 180],
            [-4 * np.eye(3) / 180, 16 * (np.ones((3, 3)) + np.eye(3)) / 180],
        ]
    ),
}

RESIDUAL = 1e-14
"""Of an equation divided by its diagonal, relative to the largest right-hand side."""

ROUNDS = 4


def mass_matrix(space: Space) -> Any:
    """The mass matrix of a space, (size, size), sparse by rows."""
    local = MASSES[space.degree]
    nodes = space.nodes_of_triangles
    count = nodes.shape[1]
    values = space.mesh.areas[:, None, None] * local
    rows, columns = np.repeat(nodes, count, axis=1), np.tile(nodes, count)
    shape = (space.size, space.size)
    return sp.csr_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape)


def solve_mass(matrix: Any, moments: Floats, degree: int) -> Floats:
    """Solve M u = b, to rounding, for all columns of b at once.

    By Chebyshev iteration with the diagonal as preconditioner. The eigenvalues of D^-1 M lie
    between those of a single triangle, whatever the mesh (Wathen 1987), so that the number of steps
    is known beforehand: 34 for P1, where each takes off two thirds of the error.

    That holds for the error weighted with areas. Where those of neighbours differ by many powers of
    ten, small triangles may need another round, which the residual at each node tells.

    References
    ----------
    Wathen: Realistic eigenvalue bounds for the Galerkin mass matrix. IMA Journal of Numerical
    Analysis 7 (1987). Wathen, Rees: Chebyshev semi-iteration in preconditioning for problems
    including the mass matrix. Electronic Transactions on Numerical Analysis 34 (2009).
    """
    diagonal = matrix.diagonal()[:, None]
    if degree == 0:
        return moments / diagonal
    u = _chebyshev(matrix, diagonal, moments, degree)
    enough = RESIDUAL * np.abs(moments / diagonal).max(axis=0, initial=0)
    for _ in range(ROUNDS - 1):
        residual = moments - matrix @ u
        if (np.abs(residual / diagonal).max(axis=0, initial=0) <= enough).all():
            break
        u += _chebyshev(matrix, diagonal, residual, degree)
    return u


def _chebyshev(matrix: Any, diagonal: Floats, moments: Floats, degree: int) -> Floats:
    """As many steps as reduce the error, weighted with areas, to that of rounding."""
    low, high = _eigenvalue_bounds(degree)
    middle, half = 0.5 * (high + low), 0.5 * (high - low)
    root = np.sqrt(high / low)
    steps = int(np.ceil(np.log(2 / np.finfo(float).eps) / np.log((root + 1) / (root - 1))))
    # Saad, Iterative Methods for Sparse Linear Systems, 2nd edition (2003), algorithm 12.1
    u, step, rho = np.zeros_like(moments), moments / diagonal / middle, half / middle
    for _ in range(steps):
        u += step
        before, rho = rho, 1 / (2 * middle / half - rho)
        residual = moments - matrix @ u
        step = rho * before * step + (2 * rho / half) * residual / diagonal
    return u


def _eigenvalue_bounds(degree: int) -> tuple[float, float]:
    """The smallest and the largest eigenvalue of D^-1 M on a triangle: 1/2 and 2 for P1."""
    local = MASSES[degree]
    scale = np.sqrt(np.diag(local))
    values = np.linalg.eigvalsh(local / np.outer(scale, scale))
    return float(values[0]), float(values[-1])
