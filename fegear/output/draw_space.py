"""Surfaces in space as a picture, by pyvista without a screen."""

from __future__ import annotations

import ctypes.util
import os
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.engine.figure import Spot, Surface
from fegear.errors import MissingLibraryError
from fegear.output.shades import shade

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

_SIZE = (1400, 900)
#: How much closer the camera stands than where a sphere around everything would fit.
_ZOOM = 1.0


def offscreen_pyvista() -> Any:
    """Import pyvista set up for drawing without a screen.

    Raises
    ------
    MissingLibraryError
        If the system has nothing to draw with: VTK itself would end the process.
    """
    if sys.platform.startswith("linux"):
        if ctypes.util.find_library("EGL") is None:
            raise MissingLibraryError(
                "pictures in space cannot be drawn without a screen; on Debian or Ubuntu run: apt-get install libegl1"
            )
        # Else VTK first asks for an X server and warns that there is none.
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    import pyvista as pv

    return pv


def draw_space(items: Sequence[Surface | Spot], camera: tuple[tuple[float, float, float], ...]) -> NDArray[np.uint8]:
    """Draw surfaces with their boundaries, and spots, as seen by a camera.

    Parameters
    ----------
    items : sequence of Surface or Spot
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
    plotter.show_bounds(
        grid="back", location="outer", xtitle="x [mm]", ytitle="y [mm]", ztitle="z [mm]", n_xlabels=4, n_ylabels=4,
        n_zlabels=3, font_size=22, fmt="%.3g", use_3d_text=False,
    )  # fmt: skip
    plotter.camera.position, plotter.camera.focal_point, plotter.camera.up = camera
    plotter.reset_camera()  # keeps the direction, and everything in the picture
    plotter.camera.zoom(_ZOOM)
    plotter.reset_camera_clipping_range()
    image = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()
    return image
