"""Random dirty outlines: a valid mesh of the right area, or an error that names the place.

Here are a few; for many, ``python tests/dirty_outlines.py 1000``.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.dirty import check, check_outline

# Places that coincide, nearly coincide, or lie on each other's lines.
NEAR = st.tuples(st.integers(0, 4), st.integers(-3, 3), st.sampled_from([0.0, 1e-16, 1e-10, 1e-9]))
COORDINATES = NEAR.map(lambda n: n[0] / 4 + n[1] * n[2])


@pytest.mark.parametrize("seed", range(120))
def test_a_valid_mesh_or_a_place(seed):
    check(seed)


@pytest.mark.slow
@given(
    st.lists(st.tuples(COORDINATES, COORDINATES), min_size=3, max_size=12),
    st.sampled_from([1e-6, 1.0, 1e6]),
    st.sampled_from([0.0, 1.0, 1e6]),
)
@settings(max_examples=60, deadline=None)
def test_rings_that_nearly_touch_themselves(ring, scale, offset):
    check_outline(scale * (np.array(ring) + offset))
