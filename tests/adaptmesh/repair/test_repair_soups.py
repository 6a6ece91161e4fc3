"""Meshes of repaired soups of segments are valid, and cover what the lines enclose.

Here are a few; ``SOUPS=10000 pytest tests/adaptmesh/repair/test_repair_soups.py`` tries more.
"""

import os

import pytest
from reference.soups import check_soup


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("block", range(8))
def test_meshes_of_repaired_soups_are_valid(block):
    count = int(os.environ.get("SOUPS", "400")) // 8
    outcomes = [check_soup(seed) for seed in range(block * count, (block + 1) * count)]
    assert outcomes.count("refused") < 0.6 * count
