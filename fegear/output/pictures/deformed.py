"""The deformed gear with its stress, drawn off screen."""

from __future__ import annotations

import ctypes.util
import os
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.errors import MissingLibraryError
from fegear.output.pictures.style import Picture, figure, in_house_style, save

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.fem.whole_gear import WholeGear
    from fegear.geometry import Gear

    Array = NDArray[np.float64]

#: Largest displacement as drawn [modules].
_DRAWN = 0.15
#: The colour scale ends where this share of the nodes near the loaded tooth lies below.
_TOP = 99.5


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


def _grid(points: Array, triangles: NDArray[np.int64]) -> Any:
    pv = offscreen_pyvista()
    cells = np.hstack([np.full((triangles.shape[1], 1), 6), triangles.T])
    kinds = np.full(triangles.shape[1], pv.CellType.QUADRATIC_TRIANGLE)
    return pv.UnstructuredGrid(cells.ravel(), kinds, points)


@in_house_style
def draw_deformed(
    gear: Gear, whole: WholeGear, fields: dict[str, Array], path: Path, name: str, line_load: float
) -> Picture:
    """Draw the whole gear and the loaded tooth, deformed on a larger scale and coloured by von Mises stress.

    Parameters
    ----------
    gear : Gear
    whole : WholeGear
    fields : dict
        ``displacement`` [mm], shape (N, 3), and ``von_mises`` [MPa], shape (N,).
    path : Path
    name : str
    line_load : float
        What the fields are for [N/m].
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    pv = offscreen_pyvista()
    m = gear.module * 1e3
    points = np.column_stack([whole.points.T * m, np.zeros(whole.points.shape[1])])
    scale = _DRAWN * m / float(np.linalg.norm(fields["displacement"], axis=1).max())
    grid = _grid(points + scale * fields["displacement"], whole.triangles)
    near = np.hypot(points[:, 0], points[:, 1] - gear.pitch_radius * 1e3) < 4.0 * m
    top = float(np.percentile(fields["von_mises"][near], _TOP))
    grid.point_data["stress"] = fields["von_mises"]
    outline = _grid(points, whole.triangles).extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    low, high = gear.root_radius * 1e3 - 1.8 * m, gear.tip_radius * 1e3 + 0.5 * m
    views = ((1.06 * gear.tip_radius * 1e3, 0.0), (0.5 * (high - low), 0.5 * (high + low)))
    images = []
    for half_height, centre in views:
        plotter = pv.Plotter(off_screen=True, window_size=(900, 900))
        plotter.set_background("white")
        plotter.add_mesh(grid, scalars="stress", cmap="viridis", clim=(0.0, top), lighting=False, show_scalar_bar=False)
        plotter.add_mesh(outline, color="black", line_width=1, lighting=False)
        plotter.camera.parallel_projection = True
        plotter.camera.focal_point = (0.0, centre, 0.0)
        plotter.camera.position = (0.0, centre, 100.0 * m)
        plotter.camera.up = (0.0, 1.0, 0.0)
        plotter.camera.parallel_scale = half_height
        plotter.reset_camera_clipping_range()
        images.append(plotter.screenshot(return_img=True))
        plotter.close()
    made, both = figure(1, 2, size=(10.4, 5.2))
    for axes, image, (half, centre) in zip(both, images, views, strict=True):
        axes.imshow(image, extent=(-half, half, centre - half, centre + half), interpolation="bilinear")
        axes.grid(visible=False)
        axes.set_xlabel("x [mm]")
    both[0].set_ylabel("y [mm]")
    both[0].set_title("Whole gear")
    both[1].set_title("Loaded tooth")
    colours = ScalarMappable(Normalize(0.0, top), "viridis")
    made.colorbar(colours, ax=both, label="von Mises stress [MPa]", extend="max", shrink=0.9)
    caption = (
        f"Gear {name} under {line_load * 1e-3:.4g} N/mm on tooth 0, displacements {scale:.3g} times as large; thin "
        f"lines show the gear at rest. The colour scale ends at {top:.3g} MPa; under the contact the stress is higher."
    )
    return save(made, path, f"Deformed gear {name}", caption)
