"""Default settings against converged solutions of nine common gears: see make_converged_gears.py."""

import functools
import json
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.plane.table import stiffness_table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

GEARS = json.loads(Path(__file__).with_name("converged_gears.json").read_text())
RACKS = {"0.25": BasicRack(1.0, 1.25, 0.25), "0.38": BasicRack.named("A"), "full": BasicRack.full_fillet()}


@functools.cache
def compared(index):
    g = GEARS[index]
    tooth = Tooth(g["teeth"], RACKS[g["rack"]], g["profile_shift"])
    gear = Gear(tooth, 1.0, g["bore"] * tooth.root_radius, material=Material(1.0, 0.3))
    table = stiffness_table(gear, np.clip(g["radii"], gear.form_radius, gear.involute_tip_radius), 0.02)
    relative = {}
    for name in ("c_self", "root_tension", "root_compression"):
        reference = np.array(g[name])
        relative[name] = np.abs(getattr(table, name) / reference - 1.0), np.abs(table.errors[name] / reference)
    scale = np.array(g["c_self"])
    relative["c_next"] = np.abs(table.c_next - g["c_next"]) / scale, table.errors["c_neighbour"] / scale
    return relative


@pytest.mark.dear(
    "z17x-0.1r0.38b0.5",
    "z28x0.0rfullb0.5",
    "z28x0.0r0.25b0.95",
    "z40x0.0r0.38b0.7",
    "z100x0.0r0.25b0.5",
    "z100x0.2r0.38b0.95",
)
@pytest.mark.parametrize(
    "index", range(len(GEARS)), ids=lambda i: "z{teeth}x{profile_shift}r{rack}b{bore}".format(**GEARS[i])
)
def test_default_settings_are_within_their_promise(index):
    # From the very start of the involute to the tip.
    found = compared(index)
    assert found["root_tension"][0].max() < 1e-3
    assert found["root_compression"][0].max() < 1e-3
    assert found["c_next"][0].max() < 1e-4
    assert found["c_self"][0].max() < 5e-4


@pytest.mark.dear
def test_error_estimates_cover_most_positions_without_crying_wolf():
    every = [compared(i)[name] for i in range(len(GEARS)) for name in compared(i)]
    truth, estimate = (np.concatenate([pair[part] for pair in every]) for part in (0, 1))
    assert np.mean(truth <= estimate) > 0.85
    assert np.mean(truth <= 3.0 * estimate + 2e-5) > 0.98
    assert np.median([e.max() / t.max() for t, e in every]) < 10.0
