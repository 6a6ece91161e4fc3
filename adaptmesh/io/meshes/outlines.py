"""Files of edges without triangles: the outline of a domain."""

from __future__ import annotations

import numpy as np

from adaptmesh.domain.inputs import labelled
from adaptmesh.domain.outline import Outline
from adaptmesh.mesh.incoming import Content, check_vertices, planar


def outline_of(content: Content) -> Outline:
    """The edges as segments, with their tags, and the points that they use.

    What they enclose is the domain: as the seeds of the file say, or else by nesting.
    """
    points = planar(content.points)
    edges = np.asarray(content.edges, dtype=np.int64)
    check_vertices("edge", edges, len(points))
    used, segments = np.unique(edges, return_inverse=True)
    has_parts = bool(content.region_seeds)
    return Outline(
        points[used],
        segments.reshape(-1, 2),
        holes=content.hole_seeds if has_parts else "nesting",
        regions=dict(content.region_seeds) if has_parts else None,
        names=labelled(np.asarray(content.edge_tags)),
        tags=content.names,
        region_tags=content.region_names,
    )
