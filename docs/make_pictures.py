"""Draw the pictures of the gallery anew: run the examples and the demo, and make small files
of what they draw.

python docs/make_pictures.py
"""

import itertools
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).parent
MOST_BYTES = 200_000


def main() -> None:
    commands = [[example] for example in sorted((HERE.parent / "examples").glob("[0-9]*.py"))]
    for command in [*commands, ["-m", "adaptmesh", "demo", "--out"]]:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, *command, folder], check=True)
            for picture in Path(folder).glob("*.png"):
                reduce(picture, HERE / "images" / picture.name)


def reduce(picture: Path, target: Path) -> None:
    """Fewer colours, and then fewer pixels, until the file is small enough."""
    image = Image.open(picture).convert("RGB")
    for share, colours in itertools.product((1.0, 0.8, 0.6), (256, 64, 32)):
        size = (round(share * image.width), round(share * image.height))
        small = image.resize(size, Image.Resampling.LANCZOS)
        method = Image.Quantize.MAXCOVERAGE
        small = small.quantize(colours, method=method, kmeans=3, dither=Image.Dither.NONE)
        small.save(target, optimize=True)
        if target.stat().st_size < MOST_BYTES:
            return


if __name__ == "__main__":
    main()
