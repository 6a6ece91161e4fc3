"""Draw the pictures of the gallery anew: run the examples and reduce what they draw to 256 colours.

python docs/make_pictures.py
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).parent


def main() -> None:
    for example in sorted((HERE.parent / "examples").glob("[0-9]*.py")):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, example, folder], check=True)
            for picture in Path(folder).glob("*.png"):
                reduce_colours(picture, HERE / "images" / picture.name)


def reduce_colours(picture: Path, target: Path) -> None:
    """A third of the size, and no colour is off by more than one can see."""
    image = Image.open(picture).convert("RGB")
    method = Image.Quantize.MAXCOVERAGE
    reduced = image.quantize(256, method=method, kmeans=3, dither=Image.Dither.NONE)
    reduced.save(target, optimize=True)


if __name__ == "__main__":
    main()
