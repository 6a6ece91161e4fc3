"""Lets tests import the oracles: ``from reference.exact import incircle``.

Appended, not put first: tests/metrics and tests/adaptmesh must not hide the packages.
"""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent))
