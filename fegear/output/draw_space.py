"""Surfaces in space as a picture, by pyvista without a screen."""

from __future__ import annotations

import ctypes.util
import math
import os
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fegear.base.errors import MissingLibraryError
from fegear.base.extras import install
from fegear.engine.figure.items import Skin, Spot, Surface
from fegear.output.shades import SEQUENTIAL, shade

_SIZE = (1400, 900)
#: How far a body moves to the left for the scale of colours, of half the picture's width.
_ROOM_FOR_SCALE = 0.17
#: How much closer the camera stands than where a sphere around everything would fit: with axes, without.
_ZOOM, _ZOOM_BARE = 1.0, 1.15
#: Margin of a body alone [pixels], and from where on a colour is white.
_MARGIN, _WHITE = 24, 250


def offscreen_pyvista() -> Any:
    """Import pyvista set up for drawing without a screen.

    Raises
    ------
    MissingLibraryError
        If pyvista is not installed, or the system has nothing to draw with: VTK itself would end the process.
    """
    if sys.platform.startswith("linux"):
        if ctypes.util.find_library("EGL") is None:
            raise MissingLibraryError(
                "3D figures cannot be drawn without a display; on Debian or Ubuntu run: apt-get install libegl1"
            )
        # Else VTK first asks for an X server and warns that there is none.
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    try:
        import pyvista as pv
    except ImportError:
        raise MissingLibraryError(f"{install('space')}.") from None
    return pv


def _add_skin(pv: Any, plotter: Any, item: Skin) -> None:
    """A body's surface with its values, its edges and a scale of colours."""
    triangles = np.asarray(item.triangles).T
    faces = np.column_stack([np.full(len(triangles), 3), triangles])
    body = pv.PolyData(np.asarray(item.points).T, faces.ravel())
    title = f"{item.label} [{item.unit}]" if item.unit else item.label
    body[title] = np.asarray(item.values)
    if np.isfinite(item.floor):
        body = body.clip(normal=(0.0, -1.0, 0.0), origin=(0.0, item.floor, 0.0))
    bar = {"vertical": True, "title_font_size": 24, "label_font_size": 24, "fmt": "%.4g", "color": "black",
           "height": 0.6, "width": 0.05, "position_x": 0.86, "position_y": 0.2}  # fmt: skip
    plotter.add_mesh(
        body, scalars=title, clim=(0.0, item.top), cmap=SEQUENTIAL, ambient=0.45, diffuse=0.55, smooth_shading=False,
        nan_color="lightgrey",
        scalar_bar_args=bar,
    )  # fmt: skip
    sharp = body.extract_feature_edges(
        feature_angle=40.0, boundary_edges=True, feature_edges=True, manifold_edges=False, non_manifold_edges=False
    )
    plotter.add_mesh(sharp, color="black", line_width=2)


def draw_space(
    items: Sequence[Surface | Skin | Spot], camera: tuple[tuple[float, float, float], ...]
) -> NDArray[np.uint8]:
    """Draw surfaces with their boundaries, and spots, as seen by a camera.

    Parameters
    ----------
    items : sequence of Surface, Skin or Spot
    camera : tuple
        Position, focal point and upward direction.

    Returns
    -------
    ndarray, shape (height, width, 3)
    """
    pv = offscreen_pyvista()
    plotter = pv.Plotter(off_screen=True, window_size=_SIZE)
    plotter.set_background("white")
    for item in items:
        if isinstance(item, Skin):
            _add_skin(pv, plotter, item)
            continue
        points, colour = np.asarray(item.points), shade(item.role).light
        if isinstance(item, Spot):
            plotter.add_mesh(pv.PolyData(points), color=colour, point_size=16.0, render_points_as_spheres=True)
            continue
        grid = pv.StructuredGrid(*points)
        plotter.add_mesh(grid, color=colour, opacity=item.opacity, ambient=0.5, diffuse=0.5)
        outline = grid.extract_feature_edges(
            boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
        )
        plotter.add_mesh(outline, color="black", line_width=2)
    bare = any(isinstance(item, Skin) for item in items)
    if not bare:
        plotter.show_bounds(
            grid="back", location="outer", xtitle="x [mm]", ytitle="y [mm]", ztitle="z [mm]", n_xlabels=4, n_ylabels=4,
            n_zlabels=3, font_size=22, fmt=_labels(plotter.bounds), use_3d_text=False,
        )  # fmt: skip
    plotter.camera.position, plotter.camera.focal_point, plotter.camera.up = camera
    plotter.reset_camera()  # keeps the direction, and everything in the picture
    plotter.camera.zoom(_ZOOM_BARE if bare else _ZOOM)
    if bare:
        plotter.camera.SetWindowCenter(_ROOM_FOR_SCALE, 0.0)
    plotter.reset_camera_clipping_range()
    image = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()
    return _trimmed(image) if bare else image


def _labels(bounds: Sequence[float]) -> str:
    """Format of the numbers along the axes: decimals for three digits of the longest side, so that zero reads so."""
    longest = max(high - low for low, high in zip(bounds[::2], bounds[1::2], strict=True))
    return f"%.{max(0, 2 - math.floor(math.log10(longest))) if longest > 0.0 else 0}f"


def _trimmed(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The picture without the white around it, but for a margin."""
    drawn = image.min(axis=2) < _WHITE
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    if not rows.size:
        return image
    low, left = max(rows[0] - _MARGIN, 0), max(columns[0] - _MARGIN, 0)
    return image[low : rows[-1] + _MARGIN, left : columns[-1] + _MARGIN]
