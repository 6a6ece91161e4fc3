"""The plotter of pyvista, and writing a picture whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.whole import replace_files

from .colours import PAPER
from .frame import Frame

FORMATS = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG", ".tif": "TIFF", ".tiff": "TIFF"}


@contextmanager
def silence_vtk() -> Iterator[None]:
    """Keep VTK from printing warnings in a block, such as that of a missing X server."""
    from vtkmodules.vtkCommonCore import vtkObject

    before = vtkObject.GetGlobalWarningDisplay()
    vtkObject.GlobalWarningDisplayOff()
    try:
        yield
    finally:
        vtkObject.SetGlobalWarningDisplay(before)


def make_plotter(frame: Frame, off_screen: bool | None) -> Any:
    """Make an empty plotter with a view of the frame from above, without perspective."""
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
    """Draw the picture and write it; the file is whole or absent."""
    from PIL import Image

    try:
        pixels = plotter.screenshot(return_img=True)
    finally:
        plotter.close()
    data = BytesIO()
    Image.fromarray(np.asarray(pixels)).save(data, FORMATS[path.suffix.lower()])
    replace_files({path: data.getvalue()})


def check_path(path: str | os.PathLike[str]) -> Path:
    """Return the path of a picture; raise `FormatError` if it cannot be written there."""
    target = Path(path)
    if target.suffix.lower() not in FORMATS:
        raise FormatError(f"{target}: expected a picture of type {', '.join(FORMATS)}")
    if not target.parent.is_dir():
        raise FormatError(f"{target}: there is no directory {target.parent}")
    return target
