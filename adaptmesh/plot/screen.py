"""The plotter: made without complaints, seen from above, written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..errors import FormatError
from .colours import PAPER
from .frame import Frame

FORMATS = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp")


@contextmanager
def quiet() -> Iterator[None]:
    """Keep VTK from printing that there is no X server before it finds another way to draw."""
    from vtkmodules.vtkCommonCore import vtkObject

    before = vtkObject.GetGlobalWarningDisplay()
    vtkObject.GlobalWarningDisplayOff()
    try:
        yield
    finally:
        vtkObject.SetGlobalWarningDisplay(before)


def make_plotter(frame: Frame, off_screen: bool | None) -> Any:
    """An empty plotter that looks at the frame from above, without perspective."""
    import pyvista as pv

    plotter: Any = pv.Plotter(
        off_screen=off_screen, window_size=list(frame.window), lighting="none"
    )
    plotter.set_background(PAPER)
    plotter.enable_anti_aliasing("ssaa")
    x, y = frame.centre
    plotter.enable_parallel_projection()
    plotter.camera.focal_point = (x, y, 0.0)
    plotter.camera.position = (x, y, 4.0)
    plotter.camera.up = (0.0, 1.0, 0.0)
    plotter.camera.parallel_scale = frame.window[1] / 2 / frame.pixel
    plotter.camera.clipping_range = (1.0, 8.0)
    plotter.camera_set = True
    if not plotter.off_screen:
        plotter.enable_2d_style()
    return plotter


def write_picture(plotter: Any, path: Path) -> None:
    """Draw and write the picture under a temporary name, then rename it."""
    handle, name = tempfile.mkstemp(suffix=path.suffix, prefix=".", dir=path.parent)
    os.close(handle)
    try:
        plotter.screenshot(name)
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    finally:
        plotter.close()


def check_path(path: str | os.PathLike[str]) -> Path:
    """The path of a picture, refused before it is drawn if it could not be written."""
    target = Path(path)
    if target.suffix.lower() not in FORMATS:
        raise FormatError(f"{target}: a picture is one of {', '.join(FORMATS)}")
    if not target.parent.is_dir():
        raise FormatError(f"{target}: there is no directory {target.parent}")
    return target
