"""A helical rack in 3D beside CalculiX (`make_solid_rack_calculix.py`), and exported decks of racks run by it."""

import json
import re
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.plane.loaded_gear import nodal_fields
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.solid.bands import bands
from fegear.fem.solid.rack.rack_flank import SolidRackSpec
from fegear.fem.solid.rack.solid_rack import solve_solid_rack
from fegear.fem.solid.settings import SolidSettings
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.toothed_rack import Rack
from fegear.output.plane_mesh_files import write_inp
from fegear.output.rack_mesh_files import loaded_rack

sys.path.insert(0, str(Path(__file__).parent))
import solid_by_calculix as solid
import solid_rack_by_calculix as calculix

TOLD = json.loads(Path(__file__).with_name("solid_rack_calculix.json").read_text())


@cache
def own():
    """The loaded tooth."""
    settings = replace(SolidSettings().scaled(1.2), waves_per_module=3.0)
    spec = SolidRackSpec(
        calculix.TOOTH, calculix.RACK.slide, solid.FACE, calculix.BODY, calculix.TEETH, solid.NU, settings
    )
    return solve_solid_rack(spec).loaded(calculix.NUMBER)


def band(name):
    low, top, high = solid.hat(calculix.BANDS[name][1])
    return bands(calculix.HEIGHT, top, top - low, solid.HALF_WIDTH, after=high - top)


def beside(told, loaded):
    """Deflections of fegear and of CalculiX as shares of the loaded band's own; largest difference of stress."""
    wanted = told["deflection"][loaded]
    found = {
        name: float(own().deflection(tooth - calculix.NUMBER, band(name), band(loaded))[0, 0])
        for name, (tooth, _) in calculix.BANDS.items()
    }
    apart = {name: abs(found[name] - one) / wanted[loaded] for name, one in wanted.items()}
    stress = {}
    for side in ("tension", "compression"):
        one = own().largest_root_stress(0, side, band(loaded), solid.STATIONS)[0][:, 0]
        theirs = np.array(told[side][loaded])
        stress[side] = np.abs(one - theirs).max() / np.abs(theirs).max()
    return apart, stress


def agrees(told, loaded):
    apart, stress = beside(told, loaded)
    assert apart[loaded] < 1e-2
    assert max(apart["next"], apart["previous"]) < 1e-4
    assert max(stress.values()) < 2.5e-2


@pytest.mark.dear
@pytest.mark.parametrize("loaded", calculix.LOADED)
def test_a_helical_rack_deflects_and_is_stressed_as_in_calculix(loaded):
    """The own deflection 1 %, the neighbours 0.01 % of it, stress along both fillets 2.5 % of the largest."""
    agrees(TOLD, loaded)


def _printed(path):
    """Displacements by node of the last step."""
    rows = re.findall(r"^\s*(\d+)((?:\s+[-+]?\d\.\d+E[-+]\d+){3})\s*$", path.read_text(), re.MULTILINE)
    return {int(n) - 1: [float(x) for x in three.split()] for n, three in rows}


@pytest.mark.dear
def test_calculix_solves_the_plane_deck_of_a_rack_to_the_same_displacements(tmp_path, program):
    ccx = program("ccx")
    rack = Rack(RackTooth(calculix.TOOTH.rack), 2e-3, 4, 7e-3, 6e-3)
    whole, field = loaded_rack(rack, MeshSettings().scaled(2.0))
    write_inp(tmp_path / "r.inp", rack, whole, field.forces)
    subprocess.run([ccx, "r"], cwd=tmp_path, check=True, capture_output=True, timeout=300)
    found = _printed(tmp_path / "r.dat")
    nodes = whole.node_set("flank_2")
    assert set(found) >= set(nodes.tolist())
    mine = nodal_fields(rack, whole, field, 1e3)["displacement"][nodes, :2]
    theirs = np.array([found[int(n)][:2] for n in nodes])
    assert np.abs(theirs - mine).max() < 1e-5 * np.abs(mine).max()


@pytest.mark.long
def test_calculix_solves_a_3d_rack_to_the_same_compliance_and_root_stress(tmp_path, program):
    """Run now."""
    program("ccx")
    told = calculix.told(tmp_path, *calculix.MESH)
    for loaded in calculix.LOADED:
        agrees(told, loaded)
