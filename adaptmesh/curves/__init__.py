"""Parametrised planar curves for the boundaries and interfaces of domains.

Each is a function of t in [0, 1]: lines, arcs, Bézier curves, splines (evaluated by scipy), and any
function as `Parametric`. `adaptmesh.Domain.from_curves` makes a domain of curves.
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
