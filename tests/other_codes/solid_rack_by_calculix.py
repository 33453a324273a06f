"""A helical rack of five teeth by CalculiX, in 3D: all teeth explicit, hexahedra and wedges of second order.

Nothing of fegear's solution is used but the nodes of the section (gmsh's); loads and stresses are those of
`solid_by_calculix`. Module and modulus are one.
"""

import math
import sys
from pathlib import Path

import numpy as np

from fegear.fem.plane.rack.whole_rack import middle_tooth, rack_section
from fegear.fem.solid.extruded import extruded
from fegear.fem.solid.rack.pressed_rack import pressed_band_on_rack
from fegear.geometry.gear import Material
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.toothed_rack import Rack

sys.path.insert(0, str(Path(__file__).parent))
import solid_by_calculix as calculix

HELIX, TEETH, BODY, HEIGHT = math.radians(20.0), 5, 2.0, 0.2
TOOTH = RackTooth(BasicRack(), helix_angle=HELIX)
RACK = Rack(
    TOOTH, 1e-3, TEETH, (BODY - TOOTH.root_height) * 1e-3, calculix.FACE * 1e-3, Material(calculix.YOUNG, calculix.NU),
    hand="right",
)  # fmt: skip
#: Bands by name: tooth, station of the top along the face [modules]; the loaded ones; the loaded tooth.
BANDS = {"middle": (2, 0.0), "front": (2, 2.0), "next": (3, 0.0), "previous": (1, 0.0)}
LOADED, NUMBER = ("middle", "front"), middle_tooth(RACK)
#: Edges in the section as a multiple of the usual ones, layers from the ends of the face and inside it [modules].
MESH = 1.4, (0.1, 0.15, 0.25), 0.5


def solid(coarseness, ends, inside):
    """The rack and the nodal forces of each band; its layers from an end of the face, and inside it [modules]."""
    half = 0.5 * calculix.FACE
    depth = half - np.cumsum(ends)
    inner = np.linspace(-depth[-1], depth[-1], round(2.0 * depth[-1] / inside) + 1)
    stations = np.unique(np.round([-half, *-depth, *inner, *depth, half], 12))
    mesh = extruded(rack_section(RACK, coarseness), stations, 0.0, slide=RACK.slide)
    return mesh, {
        name: pressed_band_on_rack(mesh, TOOTH, HEIGHT, calculix.HALF_WIDTH, calculix.hat(place), tooth)
        for name, (tooth, place) in BANDS.items()
    }


def told(folder, coarseness, ends, inside):
    """The numbers of a reference."""
    mesh, bands = solid(coarseness, ends, inside)
    fields = calculix.solved(folder, "rack", RACK, mesh, bands, LOADED, (1, 2, 3))
    y = mesh.section.points[1]
    return {
        "nodes": mesh.points.shape[1],
        "deflection": {
            name: {other: calculix.deflection(u, forces) for other, forces in bands.items()}
            for name, u in fields.items()
        },
        **{
            side: {
                name: calculix.largest_along(mesh, u, fillet, sign, tooth=NUMBER, outward=y).tolist()
                for name, u in fields.items()
            }
            for side, fillet, sign in (("tension", "fillet", 1), ("compression", "back_fillet", -1))
        },
    }
