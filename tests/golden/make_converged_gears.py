"""Write converged_gears.json: third-order elements on meshes of at least twice the default density (run by hand).

python tests/golden/make_converged_gears.py
"""

import json
from pathlib import Path

import numpy as np

from fegear.fem.influence import solve_influence
from fegear.fem.sector import mesh_sector
from fegear.fem.settings import MeshSettings
from fegear.geometry import BasicRack, Tooth

FINE = MeshSettings(
    root_edge_length=0.03,
    flank_edge_length=0.02,
    tip_edge_length=0.003,
    junction_edge_length=0.004,
    growth=0.15,
    tip_growth=0.1,
    side_growth=0.2,
    body_fraction=0.7,
    order=3,
)
RACKS = {"0.25": BasicRack(1.0, 1.25, 0.25), "0.38": BasicRack.named("A"), "full": BasicRack.full_fillet()}
#: teeth, profile shift, rack tip radius, bore over root radius
GEARS = [
    (17, 0.3, "0.25", 0.5),
    (17, -0.1, "0.38", 0.5),
    (28, 0.0, "0.25", 0.5),
    (28, 0.0, "full", 0.5),
    (28, 0.0, "0.25", 0.95),
    (40, 0.0, "0.38", 0.7),
    (40, 0.5, "full", 0.9),
    (100, 0.0, "0.25", 0.5),
    (100, 0.2, "0.38", 0.95),
]
HALF_WIDTH = 0.02
PATCH = 0.04


def converged(teeth, shift, rack, bore):
    """Solve one gear at nine load positions from the start of the involute to the tip."""
    tooth = Tooth(teeth, RACKS[rack], shift)
    mesh = mesh_sector(tooth, bore * tooth.root_radius, FINE)
    known = solve_influence(tooth, mesh, 0.3, "strain", order=3)
    rolls = np.sqrt(np.linspace(tooth.involute.start**2, tooth.involute.end**2, 9))
    radii = np.clip(tooth.radius_of_roll(rolls), known.flank.lowest_radius, known.flank.highest_radius)
    return {
        "teeth": teeth,
        "profile_shift": shift,
        "rack": rack,
        "bore": bore,
        "radii": radii.tolist(),
        "c_self": known.self_compliance(radii, PATCH, HALF_WIDTH).tolist(),
        "c_next": np.diagonal(known.neighbour(1, radii, radii, PATCH)).tolist(),
        "root_tension": known.largest_root_stress(0, "tension", radii, PATCH)[0].tolist(),
        "root_compression": known.largest_root_stress(0, "compression", radii, PATCH)[0].tolist(),
        "unknowns": known.unknowns,
    }


if __name__ == "__main__":
    out = Path(__file__).with_name("converged_gears.json")
    out.write_text(json.dumps([converged(*gear) for gear in GEARS], indent=1) + "\n")
