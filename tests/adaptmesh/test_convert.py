"""Meshes as objects of other libraries."""

from __future__ import annotations

import numpy as np
import pytest

from adaptmesh.convert import to_pyvista
from adaptmesh.mesh import Mesh

MESH = Mesh(
    [[0, 0], [1, 0], [1, 1], [0, 1]],
    [[0, 1, 2], [0, 2, 3]],
    regions=[1, 2],
    edges=[[0, 1], [1, 2], [2, 3]],
    edge_tags=[5, 0, 5],
    names={"wall": 5},
    region_names={"steel": 1},
)


def test_grid_holds_triangles_lines_and_fields():
    grid = to_pyvista(MESH, u=[0.0, 1.0, 2.0, 1.0], flux=[[1.0, 2.0], [3.0, 4.0]])
    assert (grid.n_points, grid.n_cells) == (4, 5)
    np.testing.assert_array_equal(grid.points[:, :2], MESH.points)
    assert grid.points.dtype == np.float64
    np.testing.assert_array_equal(grid.cell_data["region"], [1, 2, 0, 0, 0])
    np.testing.assert_array_equal(grid.cell_data["tag"], [0, 0, 5, 0, 5])
    np.testing.assert_allclose(grid.cell_data["quality"][:2], 3**0.5 / 2)
    np.testing.assert_array_equal(grid.point_data["u"], [0, 1, 2, 1])
    np.testing.assert_array_equal(grid.cell_data["flux"][:2], [[1, 2], [3, 4]])
    assert list(grid.field_data["names"]) == ["5 wall"]
    assert grid.compute_cell_sizes().cell_data["Area"].sum() == pytest.approx(1)


def test_field_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="'u' has shape"):
        to_pyvista(MESH, u=np.zeros(3))
    with pytest.raises(ValueError, match="taken"):
        to_pyvista(MESH, region=np.zeros(2))
