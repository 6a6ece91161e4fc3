"""Affine maps of the plane under which every numerical claim is tried.

What holds on an axis-aligned unit square only is untested: there sides are exact in floating point,
axes are eigenvectors, and the size of the domain hides which tolerances are relative. A test takes
its figure through each map::

    @pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
    def test_...(transform):
        mesh = ...(transform(points), ...)
        tensors = transform.metric(tensors)  # the same lengths in the new coordinates

``SIMILARITIES`` are those that keep shapes, for what depends on angles.
"""

from dataclasses import dataclass

import numpy as np

from adaptmesh.curves import Curve


@dataclass(frozen=True)
class Transform:
    """x -> matrix @ x + offset."""

    name: str
    matrix: tuple[tuple[float, float], tuple[float, float]]
    offset: tuple[float, float] = (0.0, 0.0)

    def __str__(self):
        return self.name

    def __call__(self, points):
        """Points (..., 2) in the new coordinates."""
        return np.asarray(points, dtype=float) @ np.array(self.matrix).T + self.offset

    def inverse(self, points):
        """The old coordinates of points (..., 2)."""
        return (np.asarray(points, dtype=float) - self.offset) @ np.linalg.inv(self.matrix).T

    @property
    def determinant(self):
        """What areas are multiplied by; negative if the orientation changes."""
        return np.linalg.det(self.matrix)

    @property
    def scale(self):
        """What lengths are multiplied by, in the mean of all directions."""
        return np.sqrt(abs(self.determinant))

    @property
    def rounding(self):
        """Relative error that rounding gives to coordinates of a figure of about unit size."""
        return np.finfo(float).eps * (1 + np.abs(self.offset).max() / self.scale)

    def gradient(self, gradients):
        """Gradients (..., 2) of a function that is carried along."""
        return np.asarray(gradients) @ np.linalg.inv(self.matrix)

    def metric(self, tensors):
        """Packed metrics (..., 3) that give carried edges the lengths they had."""
        back = np.linalg.inv(self.matrix)
        m11, m12, m22 = np.moveaxis(np.asarray(tensors, dtype=float), -1, 0)
        full = np.stack([np.stack([m11, m12], -1), np.stack([m12, m22], -1)], -2)
        full = back.T @ full @ back
        return np.stack([full[..., 0, 0], full[..., 0, 1], full[..., 1, 1]], -1)

    def triangles(self, triangles):
        """Vertex numbers (n, 3) counter-clockwise again where the map is a reflection."""
        triangles = np.asarray(triangles)
        return triangles[:, ::-1] if self.determinant < 0 else triangles


def _turned(angle, scale=1.0):
    c, s = scale * np.cos(angle), scale * np.sin(angle)
    return ((c, -s), (s, c))


SIMILARITIES = [
    Transform("as it is", _turned(0.0)),
    Transform("turned by 0.7 rad", _turned(0.7)),
    Transform("turned by 45 degrees", _turned(np.pi / 4)),
    Transform("reflected", ((0.8, 0.6), (0.6, -0.8))),
    Transform("scaled by 1e-6, turned", _turned(2.1, 1e-6)),
    Transform("scaled by 1e6, turned", _turned(-1.2, 1e6)),
    Transform("offset by 1e6, turned", _turned(0.3), (1e6, -1e6)),
    Transform("UTM: metres, offset", _turned(0.4, 1e3), (4.5e5, 5.4e6)),
]

TRANSFORMS = [
    *SIMILARITIES,
    Transform("sheared", ((1.0, 0.9), (0.2, 0.7))),
    Transform("stretched by 100, turned", ((70.71, -0.7071), (70.71, 0.7071))),
]


class Moved(Curve):
    """A curve carried by a map, exactly: its points are the images of the points of the curve."""

    def __init__(self, curve, transform):
        self.curve, self.transform = curve, transform
        self.is_closed, self.is_straight = curve.is_closed, curve.is_straight

    @property
    def breaks(self):
        return self.curve.breaks

    @property
    def knots(self):
        return self.curve.knots

    def _point(self, t):
        return self.transform(self.curve.point(t))

    def _derivative(self, t):
        return self.curve.derivative(t) @ np.array(self.transform.matrix).T
