"""What a file of ours should hold, said in it once more, so that what is lost is missed.

Formats of lines and sections stay valid when some are cut out: edges, tags or names would be gone
without a word. So a comment (or what else other programs skip) says how many there are. Files of
other programs do not have it, and those that they save again lose it.
"""

from __future__ import annotations

import json

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import read_json
from adaptmesh.mesh.incoming import Content


def counts_of(content: Content, fields: bool = True) -> dict[str, int]:
    """Numbers of items, by what they are; without those of fields that are in other files."""
    out = {
        "points": len(content.points),
        "triangles": len(content.triangles),
        "edges": len(content.edges),
        "names": len(content.names),
        "named regions": len(content.region_names),
        "regions": len(np.unique(content.regions)),
        "edge tags": len(np.unique(content.edge_tags)),
    }
    if fields:
        out["point fields"] = len(content.point_fields) + (content.metric is not None)
        out["triangle fields"] = len(content.triangle_fields)
    return out


def stated(content: Content, fields: bool = True) -> str:
    """The counts as a line of text."""
    return json.dumps(counts_of(content, fields), separators=(",", ":"))


def check_stated(text: str, content: Content) -> None:
    """Raise if the content is not what the file says it is."""
    said = read_json(text)
    if not isinstance(said, dict):
        raise FormatError(f"its counts {text[:80]!r} are damaged")
    for what, found in counts_of(content).items():
        if said.get(what, found) != found:
            raise FormatError(
                f"has {found} {what}, not {said[what]!r} as it says itself: is the file complete? "
                "(If it was changed on purpose, remove the line that says so.)"
            )
