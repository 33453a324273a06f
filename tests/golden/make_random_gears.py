"""Write random_gears.json: random gears with converged values, to hold error estimates and tolerances against them.

The first thirty are for the error estimates, the last ten for tolerances. What the estimates' constants were set on are
other gears (seed 101). Run by hand; it takes two minutes:

python tests/golden/make_random_gears.py
"""

import json
import math
from pathlib import Path

import numpy as np

from fegear.base.errors import FegearError
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

#: Fourth order on edges a third to a sixth of the default's; narrow pressures, so that nothing is extrapolated far.
FINE = MeshSettings(
    root_edge_length=0.03,
    root_fraction=0.06,
    flank_edge_length=0.01,
    tip_edge_length=0.0015,
    junction_edge_length=0.002,
    back_edge_length=0.15,
    growth=0.15,
    tip_growth=0.11,
    side_growth=0.18,
    body_fraction=0.5,
    rim_fraction=0.18,
    patch_half_width=0.06,
    order=4,
)
HALF_WIDTH = 0.02
POSITIONS = 17


def random_gears(count, seed):
    """Shapes from 8 to 500 teeth, sharp to full fillets, thick to thin rims; what cannot exist is drawn again."""
    rng = np.random.default_rng(seed)
    found = []
    while len(found) < count:
        teeth = round(math.exp(rng.uniform(math.log(8), math.log(500))))
        alpha = math.radians(rng.choice([20, 20, 20, 14.5, 25]))
        addendum = float(rng.choice([1.0, 1.0, 0.8, 1.2]))
        dedendum = addendum + rng.uniform(0.2, 0.4)
        shift, bore, nu = rng.uniform(-0.4, 0.8), rng.uniform(0.5, 0.95), rng.uniform(0.25, 0.49)
        plane = str(rng.choice(["strain", "strain", "stress"]))
        sharpness, rounding = rng.uniform(0, 1.15), float(rng.choice([0, 0, 0, 0.05, 0.1]))
        full = (math.pi / 4 - dedendum * math.tan(alpha)) * math.cos(alpha) / (1 - math.sin(alpha))
        radius = full * min(sharpness, 1 - 1e-12)
        radius = max(0.1, radius) if full > 0.1 else full * (1 - 1e-12)
        gear = {
            "teeth": teeth, "addendum": addendum, "dedendum": dedendum, "rack_tip_radius": radius,
            "pressure_angle": alpha, "profile_shift": shift, "bore": bore, "poisson_ratio": nu, "plane": plane,
            "tip_rounding": rounding,
        }  # fmt: skip
        try:
            tooth = tooth_of(gear)
            short = tooth.involute_tip_radius - tooth.form_radius < 0.8
            pointed = tooth.tip_half_angle * tooth.tip_radius < 0.1
        except (FegearError, ValueError):
            continue
        if not (short or pointed):
            found.append(gear)
    return found


def tooth_of(gear):
    """The tooth of one of these gears."""
    rack = BasicRack(gear["addendum"], gear["dedendum"], gear["rack_tip_radius"], gear["pressure_angle"])
    return Tooth(gear["teeth"], rack, gear["profile_shift"], tip_rounding=gear["tip_rounding"])


def converged(tooth, bore, nu, plane, positions=POSITIONS, settings=FINE):
    """Converged values at load positions evenly spaced in roll angle, from the start of the involute to its end."""
    mesh = mesh_sector(tooth, bore * tooth.root_radius, settings)
    known = solve_influence(tooth, mesh, nu, plane, order=settings.order)
    ends = tooth.roll(np.array([max(tooth.form_radius, tooth.base_radius), tooth.involute_tip_radius]))
    radii = tooth.radius_of_roll(np.linspace(*ends, positions))
    radii = np.clip(radii, known.flank.lowest_radius, known.flank.highest_radius)
    patch = settings.patch_half_width
    return {
        "radii": radii.tolist(),
        "c_self": known.self_compliance(radii, patch, HALF_WIDTH).tolist(),
        "c_next": np.diagonal(known.neighbour(1, radii, radii, patch)).tolist(),
        "root_tension": known.largest_root_stress(0, "tension", radii)[0].tolist(),
        "root_compression": known.largest_root_stress(0, "compression", radii)[0].tolist(),
    }


if __name__ == "__main__":
    gears = random_gears(30, 404) + random_gears(10, 505)
    told = [g | converged(tooth_of(g), g["bore"], g["poisson_ratio"], g["plane"]) for g in gears]
    Path(__file__).with_name("random_gears.json").write_text(json.dumps(told) + "\n")
