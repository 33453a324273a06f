"""Exports hold the flank that the case describes: relief measured on drawings, edges that meet, words where not."""

from __future__ import annotations

import math
from itertools import pairwise

import ezdxf
import numpy as np
import pytest
from scipy.interpolate import BSpline

from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.fem.plane.gmsh_session import gmsh_session
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.outline import relieved_outline
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import CombinedRelief, EndRelief, TabulatedRelief
from fegear.output.dxf import write_dxf
from fegear.output.export import export_gears

GEARS = {
    "plain": Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3e-3, 15e-3),
    "rounded": Gear(Tooth(28, BasicRack.full_fillet(), tip_rounding=0.12), 3e-3, 15e-3),
    "chamfered": Gear(Tooth(17, BasicRack.named("D"), profile_shift=0.3, tip_chamfer=0.1), 3e-3, 12e-3),
}


#: Each end of a tooth and each relief is met in the ordinary run, each together in the long one.
_ORDINARY = {("plain", "both"), ("rounded", "table"), ("chamfered", "tip"), ("rounded", "both")}
EACH = [
    pytest.param(gear, kind, id=f"{name}-{kind}", marks=() if (name, kind) in _ORDINARY else pytest.mark.long)
    for name, gear in GEARS.items()
    for kind in ("tip", "both", "table")
]


def reliefs(gear):
    involute = gear.tooth.involute
    low, high = involute.start, involute.end
    middle = 0.5 * (low + high)
    return {
        "tip": EndRelief(50e-6, middle, high),
        "both": CombinedRelief((EndRelief(50e-6, middle, high, 2.0), EndRelief(30e-6, middle, low))),
        "table": TabulatedRelief(np.linspace(low, high, 7), 1e-6 * np.array([9.0, 3, 0, 0, 4, 20, 55])),
    }


def removed(gear, points):
    """Distance of points [modules] from the involute along its normal: the roll length less that on the involute."""
    r, angle = np.hypot(*points), np.arctan2(*points)
    base, half = gear.tooth.involute.base_radius, gear.tooth.involute.base_half_angle
    string = np.sqrt(r**2 - base**2)
    return base * (half - angle + np.arctan2(string, base)) - string, string / base


@pytest.mark.dear("rounded-table", "rounded-both")
@pytest.mark.parametrize(("gear", "kind"), EACH)
def test_the_drawn_flank_is_the_involute_less_the_relief(gear, kind, tmp_path):
    """The tangent of the base circle through a point meets the involute at the string's length."""
    relief = reliefs(gear)[kind]
    paths = {path.stem: path for path in write_dxf(gear, tmp_path, "g", relief, "relieved")}
    document = ezdxf.readfile(paths["g_tooth_polyline"])
    assert ("FLANKS", "relieved") in document.header.custom_vars.properties
    (line,) = document.modelspace().query("LWPOLYLINE")
    points = np.array(line.get_points("xy")).T / (gear.module * 1e3)
    involute = gear.tooth.involute
    ends = [np.hypot(*involute.points(t)) for t in (involute.start, involute.end)]
    r = np.hypot(*points)
    flank = points[:, (points[0] > 0.0) & (r > ends[0] + 1e-3) & (r < ends[1] - 1e-9)]
    found, roll = removed(gear, flank)
    # The point lies a removal nearer along the tangent: its own roll is the string's plus the removal.
    expected = relief.removal(roll + found / involute.base_radius) / gear.module
    assert flank.shape[1] > 8
    np.testing.assert_allclose(found, expected, atol=1e-9)
    assert found.max() > 0.8 * expected.max() > 0.0
    assert r.max() == pytest.approx(gear.tooth.tip_radius, rel=1e-12)


@pytest.mark.dear("rounded-table", "rounded-both")
@pytest.mark.parametrize(("gear", "kind"), EACH)
def test_pieces_meet_and_splines_follow_them(gear, kind, tmp_path):
    relief = reliefs(gear)[kind]
    pieces = relieved_outline(gear, relief)
    for one, other in pairwise(pieces):
        np.testing.assert_allclose(one.points(one.end), other.points(other.start), atol=1e-9)
    assert pieces[-1].points(pieces[-1].end)[0] == pytest.approx(0.0, abs=1e-12)
    paths = {path.stem: path for path in write_dxf(gear, tmp_path, "g", relief)}
    space = ezdxf.readfile(paths["g_tooth_spline"]).modelspace()
    deepest = 0.0
    for entity in space.query("SPLINE"):
        knots = np.array(entity.knots)
        curve = BSpline(knots, np.array(entity.control_points)[:, :2], 5)
        points = curve(np.linspace(knots[0], knots[-1], 50)).T / (gear.module * 1e3)
        if points[0, 0] > 0.0 and np.hypot(*points).min() > gear.tooth.involute.base_radius:
            deepest = max(deepest, removed(gear, points)[0].max())
    assert deepest * gear.module == pytest.approx(float(relief.removal(gear.tooth.involute.end)), rel=0.02)


def test_a_relief_that_takes_the_tip_away_is_refused():
    gear = GEARS["plain"]
    with pytest.raises(InputError, match="removes the entire tip"):
        relieved_outline(gear, EndRelief(3e-3, gear.tooth.involute.start, gear.tooth.involute.end))


CASE = """
title = "Export"
results = ["geometry"]
[gear.a]
teeth = 20
module = "3 mm"
bore_radius = "15 mm"
face_width = "10 mm"
relief = { tip = { amount = "200 um", start_radius = "30.5 mm" } }
[gear.b]
teeth = 30
module = "3 mm"
bore_radius = "15 mm"
face_width = "10 mm"
relief = { tip = { amount_over_delta = 1.0, normalised_length = 1.0 } }
[pair.I]
driver = "a"
driven = "b"
load = "1000 N"
[accuracy]
tolerance = 1e-2
"""

HELICAL = """
[gear.{}]
teeth = 30
normal_module = "3 mm"
pressure_angle = "20 deg"
helix_angle = "20 deg"
hand = "{}"
face_width = "20 mm"
"""


def scene_of(tmp_path, text):
    (tmp_path / "case.toml").write_text(text, "utf-8")
    return read_scene(tmp_path / "case.toml")


@pytest.mark.dear
def test_exports_carry_the_relief_or_say_that_they_do_not(tmp_path):
    """Half a millimetre of tip relief changed no file, and none said so."""
    scene = scene_of(tmp_path, CASE)
    done = export_gears(scene, tmp_path, (), "dxf,msh,vtu,inp")
    assert len(done.files) == 14
    (line,) = ezdxf.readfile(tmp_path / "a_tooth_polyline.dxf").modelspace().query("LWPOLYLINE")
    points = np.array(line.get_points("xy")).T / 3.0
    right = points[:, (points[0] > 0.0) & (np.hypot(*points) > 10.9)]
    assert removed(scene.gears["a"], right)[0].max() * 3000.0 > 160.0
    told = "\n".join(done.remarks)
    assert "Gear a, inp, msh, vtu: flanks as generated, without the relief of the case." in told
    assert "Gear b, DXF: flanks without relief, because amount depends on the deflection (amount_over_delta)." in told
    for name in ("a.msh", "a.vtu", "a.inp"):
        assert b"as generated, without relief" in (tmp_path / name).read_bytes()[:400], name
    properties = ezdxf.readfile(tmp_path / "b_gear_spline.dxf").header.custom_vars.properties
    assert ("FLANKS", "as generated, without relief") in properties


def test_meshes_with_their_remark_are_read_by_other_programs(tmp_path):
    import meshio

    text = CASE.replace("relief = { tip = { amount_over_delta = 1.0, normalised_length = 1.0 } }", "")
    export_gears(scene_of(tmp_path, text), tmp_path, ("a",), "msh,vtu")
    nodes = [meshio.read(tmp_path / f"a.{kind}").points.shape for kind in ("msh", "vtu")]
    assert nodes[0] == nodes[1]
    with gmsh_session(
        "designed, relief tables interpolated linearly,"
    ) as gmsh:  # its own start takes the signals from whoever has them, for good
        gmsh.merge(str(tmp_path / "a.msh"))
        assert len(gmsh.model.mesh.getNodes()[0]) == nodes[0][0]


def test_a_helical_gear_is_drawn_across_its_axis_and_has_no_plane_mesh(tmp_path):
    """A helical case wrote no file and no message."""
    both = 'title = "H"\nresults = ["tooth-contact"]\n' + HELICAL.format("a", "left") + HELICAL.format("b", "right")
    scene = scene_of(tmp_path, both + '[pair.I]\ndriver = "a"\ndriven = "b"\n')
    with pytest.raises(InputError, match=r"--gear = a, b: must be spur gears for inp, msh \(plane meshes\); use dxf"):
        export_gears(scene, tmp_path, (), "msh,inp")
    with pytest.raises(InputError, match=r"--gear = a: must be a spur gear for vtu \(plane meshes\)"):
        export_gears(scene, tmp_path, ("a",), "vtu")
    assert not list(tmp_path.iterdir()) or {path.name for path in tmp_path.iterdir()} == {"case.toml"}
    done = export_gears(scene, tmp_path, ("a",), "dxf,msh")
    assert len(done.files) == 4
    assert any("no msh is written" in remark for remark in done.remarks)
    (line,) = ezdxf.readfile(tmp_path / "a_gear_polyline.dxf").modelspace().query("LWPOLYLINE")
    x, y = np.array(line.get_points("xy")).T
    tip, root = 45.0 / math.cos(math.radians(20.0)) + 3.0, 45.0 / math.cos(math.radians(20.0)) - 3.75
    assert np.hypot(x, y).max() == pytest.approx(tip, rel=1e-9)
    assert np.hypot(x, y).min() == pytest.approx(root, abs=1e-3)
