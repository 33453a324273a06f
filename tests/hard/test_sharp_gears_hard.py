"""Gears cut by sharp racks far out: fillets of a few thousandths to hundredths of a module, the hardest there are.

The reference has edges of half the default length, an eighth of it where flank and fillet meet.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

import fegear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

HALF_WIDTH = 0.02
TOLERANCES = (1e-2, 1e-3, 1e-2, 1e-3, 1e-4)
ORDINARY, DRAWS = (171,), 300


def drawn(i):
    """Teeth, profile shift, tip radius of the rack (half of them zero), addendum and bore of draw i."""
    rng = np.random.default_rng([24, 300, i])
    teeth, shift = int(rng.integers(18, 100)), float(rng.uniform(0.8, 1.1))
    tip = float(rng.choice([0.0, rng.uniform(0.0, 0.02)]))
    return teeth, shift, tip, float(rng.uniform(0.6, 1.0)), float(rng.uniform(0.4, 0.8))


def missed(i):
    """How many times more than allowed an entry of the table of draw i is off: by quantity, at the worst of positions.

    Allowed is the tolerance, or half as much again as the entry's stated error.
    """
    teeth, shift, tip, addendum, bore = drawn(i)
    tolerance = TOLERANCES[i % len(TOLERANCES)]
    tooth = Tooth(teeth, BasicRack(addendum, 1.25, tip, math.radians(20.0)), shift)
    gear = Gear(tooth, 1.0, bore * tooth.root_radius, material=Material(1.0, 0.3))
    finest = settings_at(2)
    finest = replace(finest, junction_edge_length=0.25 * finest.junction_edge_length)
    exact = solve_gear(gear, finest)
    radii = np.linspace(exact.lowest_radius + 1e-6, exact.highest_radius - 1e-6, 11)
    table = fegear.run(
        {
            "results": ["stiffness"],
            "gear": {
                "a": {
                    "teeth": teeth, "module": "1 mm", "profile_shift": shift, "bore_radius": f"{gear.bore_radius!r} mm",
                    "rack": {"addendum": addendum, "dedendum": 1.25, "tip_radius": tip},
                    "material": {"young_modulus": "1 MPa", "poisson_ratio": 0.3},
                }
            },
            "stiffness": {"radii": [f"{float(r)!r} mm" for r in radii], "contact_half_width": f"{HALF_WIDTH} mm"},
            "accuracy": {"tolerance": tolerance},
        },
        progress=False,
    ).tables["stiffness_a"]  # fmt: skip
    self_compliance = exact.self_compliance(radii, HALF_WIDTH)
    known = {
        "c_self": (self_compliance, "c_self_error"),
        "c_next": (np.diagonal(exact.neighbour(1, radii, radii)), "c_neighbour_error"),
        "root_tension": (exact.largest_root_stress(0, "tension", radii, HALF_WIDTH)[0], "root_tension_error"),
        "root_compression": (
            exact.largest_root_stress(0, "compression", radii, HALF_WIDTH)[0],
            "root_compression_error",
        ),
    }
    over = {}
    for name, (values, error) in known.items():
        # Per modulus of 1 MPa in SI, and per module of 1 mm: the same figures but for powers of ten.
        found = table.column(name).si
        power = 10.0 ** round(math.log10(abs(found[5] / values[5])))
        size = np.abs(self_compliance if name == "c_next" else values) * power
        off = np.abs(found - values * power)
        over[name] = float((off / np.maximum(tolerance * size, 1.5 * table.column(error).si)).max())
    return over


@pytest.mark.dear
@pytest.mark.parametrize("i", ORDINARY)
def test_tables_of_sharp_gears_are_within_their_tolerance_or_their_stated_error(i):
    """With edges of .0015 modules where flank and fillet meet draw 171, a fillet of .0034, was 2.2 times outside."""
    assert max(missed(i).values()) <= 1.0


@pytest.mark.long
def test_two_of_a_hundred_sharp_gears_are_outside_at_most():
    over = [max(missed(i).values()) for i in range(DRAWS)]
    print(f"{sum(one > 1.0 for one in over)} of {DRAWS} outside, the worst {max(over):.2f} times")
    assert sum(one > 1.0 for one in over) <= 0.02 * DRAWS
