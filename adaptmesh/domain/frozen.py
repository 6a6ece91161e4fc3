"""Segments that are not cut: each is one edge of every mesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.checks import read_only
from adaptmesh.errors import DomainError

from .data import D, with_fields
from .messages import segment_text


def domain_with_frozen(domain: D, names: Sequence[str], segments: ArrayLike | None) -> D:
    """As `Domain.with_frozen`."""
    frozen = domain.segment_is_frozen.copy()
    numbers = np.asarray(() if segments is None else segments).ravel()
    if numbers.size and not np.issubdtype(numbers.dtype, np.integer):
        raise DomainError(
            f"segments={segments!r}: expected numbers of segments, from 0 to {len(frozen) - 1}"
        )
    numbers = numbers.astype(np.int64)
    unknown = numbers[(numbers < 0) | (numbers >= len(frozen))]
    if len(unknown):
        raise DomainError(f"segment {unknown[0]}: they are numbered 0 to {len(frozen) - 1}")
    frozen[numbers] = True
    frozen |= np.isin(domain.segment_tags, [domain.tag_named(name) for name in names])
    curved = np.flatnonzero(frozen & (domain.curved.segment_paths >= 0))
    if len(curved):
        raise DomainError(
            f"{segment_text(domain, int(curved[0]))} is curved, so that nothing says where its "
            "vertices are: freeze it in `adapt`, as a mesh has it, or give it as points and "
            "segments"
        )
    times = np.bincount(domain.piece_segments, minlength=len(domain.segments))
    divided = np.flatnonzero(frozen & (times > 1))
    if len(divided):
        raise DomainError(
            f"{segment_text(domain, int(divided[0]))} is to be one edge, but a point lies on it: "
            "divide it there"
        )
    return with_fields(domain, segment_is_frozen=read_only(frozen))
