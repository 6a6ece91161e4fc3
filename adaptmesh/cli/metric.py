"""The control space given by --size or --metric."""

from __future__ import annotations

from pathlib import Path

import typer

from adaptmesh.domain.domain import Domain
from adaptmesh.errors import FormatError
from adaptmesh.mesh.mesh import Mesh
from metrics import ControlSpace

SOLUTION_SUFFIXES = (".sol", ".solb", ".mtr")
RASTER_SUFFIXES = (".tif", ".tiff", ".asc", ".nc", ".grd")


class Request:
    """The values of --size, --metric and --metric-field, checked before any file is read.

    Parameters
    ----------
    size : str, optional
        An expression.
    metric : path, optional
        A solution at the vertices of the mesh given, a mesh with a metric or sizes, or a raster.
    field : str, optional
        The name of the metric among the fields of a mesh.
    """

    def __init__(self, size: str | None, metric: Path | None, field: str | None = None) -> None:
        import metrics
        from adaptmesh.io.formats import FORMATS, mesh_suffix

        if size is not None and metric is not None:
            raise typer.BadParameter("give one of --size and --metric")
        self.size = None if size is None else metrics.Expression(size)
        self.metric, self.field = metric, field
        suffix = "" if metric is None else metric.suffix.lower()
        self._holds_a_mesh = metric is not None and mesh_suffix(metric) is not None
        if field is not None and not self._holds_a_mesh:
            raise typer.BadParameter("--metric-field names a field in the mesh given as --metric")
        others = (*SOLUTION_SUFFIXES, *RASTER_SUFFIXES)
        if metric is not None and not self._holds_a_mesh and suffix not in others:
            raise typer.BadParameter(
                f"--metric {metric}: expected a solution ({' '.join(SOLUTION_SUFFIXES)}), a mesh "
                f"({' '.join(FORMATS)}) or a raster ({' '.join(RASTER_SUFFIXES)})"
            )

    @property
    def is_empty(self) -> bool:
        """Whether neither --size nor --metric is given."""
        return self.size is None and self.metric is None

    def refuse_empty(self) -> None:
        """Raise a usage error unless one of --size and --metric is given."""
        if self.is_empty:
            raise typer.BadParameter("give one of --size and --metric")

    def refuse_without_mesh(self) -> None:
        """Raise a usage error if the metric is a solution, which needs a mesh."""
        if self.metric is not None and self.metric.suffix.lower() in SOLUTION_SUFFIXES:
            raise typer.BadParameter(
                f"--metric {self.metric} holds values at the vertices of a mesh, but DOMAIN is an "
                "outline: use --size, a metric in a mesh file or a raster, or give the mesh as "
                "DOMAIN"
            )

    def control_space(self, mesh: Mesh | None, cleaned: Mesh | None = None) -> ControlSpace:
        """Make the control space; the values of a solution belong to the vertices of `mesh`.

        `cleaned`, if given, is this mesh after `Mesh.cleaned`, and becomes the background mesh.
        """
        if self.size is not None:
            return self.size
        assert self.metric is not None
        if self._holds_a_mesh:
            import adaptmesh as am

            return am.read_metric(self.metric, self.field)
        if self.metric.suffix.lower() in RASTER_SUFFIXES:
            import metrics

            return metrics.Raster.read(self.metric)
        assert mesh is not None
        return _read_solution(self.metric, mesh, mesh if cleaned is None else cleaned)


def _read_solution(path: Path, mesh: Mesh, carrier: Mesh) -> ControlSpace:
    import adaptmesh as am
    from metrics import Background

    values = am.read_sol(path)
    if len(values) != len(mesh.points):
        raise FormatError(
            f"{path}: expected values for the {len(mesh.points)} vertices of the mesh, got "
            f"{len(values)}"
        )
    if carrier is not mesh:
        values = values[carrier.kept]
    return Background(carrier.points, carrier.triangles, values)


def grade(
    domain: Domain, control: ControlSpace, gradation: float | None, max_vertices: int | None
) -> ControlSpace:
    """Grade the metric if --gradation is given."""
    if gradation is None:
        return control
    from adaptmesh.generate.generate import MAX_VERTICES, graded_within_budget

    return graded_within_budget(domain, control, gradation, max_vertices or MAX_VERTICES)
