"""Draw the picture of the README: `adaptmesh demo`, and a small file of what it draws.

python docs/make_pictures.py
"""

import itertools
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

IMAGES = Path(__file__).parent / "images"
PICTURES = ("naca0012.png",)
MAX_BYTES = 200_000


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-m", "adaptmesh", "demo", "--out", folder], check=True)
        for name in PICTURES:
            reduce(Path(folder) / name, IMAGES / name)


def reduce(picture: Path, target: Path) -> None:
    """Fewer colours, and then fewer pixels, until the file is small enough."""
    image = Image.open(picture).convert("RGB")
    for share, colours in itertools.product((1.0, 0.8, 0.6), (256, 64, 32)):
        size = (round(share * image.width), round(share * image.height))
        small = image.resize(size, Image.Resampling.LANCZOS)
        method = Image.Quantize.MAXCOVERAGE
        small = small.quantize(colours, method=method, kmeans=3, dither=Image.Dither.NONE)
        small.save(target, optimize=True)
        if target.stat().st_size < MAX_BYTES:
            return


if __name__ == "__main__":
    main()
