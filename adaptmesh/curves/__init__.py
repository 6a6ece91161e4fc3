"""Parametrised planar curves: what bounds a domain, separates its regions, or lies inside it.

Each is a function of t in [0, 1]. They are those of drawings and of numerical libraries; splines
are evaluated by scipy, and `Parametric` takes any function. `adaptmesh.Domain.from_curves` makes a
domain of them.
"""

from .conics import Arc, Circle, EllipticArc
from .curve import Curve
from .lines import Line, Polyline
from .parametric import Parametric
from .splines import Bezier, BSpline, Spline

__all__ = [
    "Arc",
    "BSpline",
    "Bezier",
    "Circle",
    "Curve",
    "EllipticArc",
    "Line",
    "Parametric",
    "Polyline",
    "Spline",
]
