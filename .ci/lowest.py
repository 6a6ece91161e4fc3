"""Print constraints for pip: the lowest version of each requirement that pyproject.toml promises.

python .ci/lowest.py > lowest.txt && PIP_CONSTRAINT=lowest.txt pip install ".[test]"
"""

import re
from pathlib import Path

text = (Path(__file__).parent.parent / "pyproject.toml").read_text("utf-8")
for name, version in sorted(set(re.findall(r'"([\w.-]+)>=([\d.]+)"', text))):
    print(f"{name}=={version}")
