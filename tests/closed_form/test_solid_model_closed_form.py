"""STEP files of solid gears: read back, they are one closed solid of the exact volume with the exact flanks on it."""

import contextlib
import itertools
import math
from collections import Counter

import gmsh as kernel
import numpy as np
import pytest

from fegear.base.errors import FegearError
from fegear.case.reading import build_scene
from fegear.fem.plane.gmsh_session import gmsh_session
from fegear.fem.solid.step_model import write_step
from fegear.geometry.curves import smooth_pieces
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.geometry.outline import relieved_outline
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import tip_relief
from fegear.geometry.spline import enclosed_area, spline_of
from fegear.output.export import export_gears

DEG = math.pi / 180.0
PROTUBERANCE = BasicRack(1.0, 1.4, 0.3, 20 * DEG, 0.1, 0.02, 8 * DEG)


def gear(teeth, beta, hand, width=6.0, **more):
    tooth = Tooth(teeth, helix_angle=beta * DEG, **({"profile_shift": 0.3} | more))
    return Gear(tooth, 2e-3, 0.4 * tooth.root_radius * 2e-3, width * 2e-3, hand=hand)


def section_area(one: Gear) -> float:
    """From the exact curves by Gauss quadrature of half the arm of the outline about the centre [m^2]."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    total = 0.0
    for curve in smooth_pieces(one.tooth.outline.values()):
        marks = np.linspace(curve.start, curve.end, 33)
        for a, b in itertools.pairwise(marks):
            u = 0.5 * (a + b) + 0.5 * (b - a) * nodes
            arm = (curve.points(u) * curve.normals(u)).sum(axis=0)
            total += float((weights * arm * curve.speed(u)).sum()) * 0.5 * abs(b - a)
    return total * one.teeth * one.module**2 - math.pi * one.bore_radius**2


@contextlib.contextmanager
def read_back(path):
    with gmsh_session("designed, relief tables interpolated linearly,") as gmsh:
        shapes = gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        yield gmsh, shapes


@pytest.mark.dear("one0-4")
@pytest.mark.parametrize(
    ("one", "pieces"),
    [
        (gear(9, 25.0, "right"), 4),
        pytest.param(gear(9, 25.0, "left", tip_rounding=0.05), 5, marks=pytest.mark.long),
        pytest.param(gear(17, 0.0, "spur", tip_chamfer=0.05), 5, marks=pytest.mark.long),
        pytest.param(gear(20, 40.0, "left", 8.0, profile_shift=0.6, rack=PROTUBERANCE), 5, marks=pytest.mark.long),
        pytest.param(gear(11, 12.0, "left", profile_shift=0.1), 4, marks=pytest.mark.long),
        pytest.param(gear(24, 20.0, "right", rack=BasicRack.full_fillet()), 3, marks=pytest.mark.long),
    ],
)  # fmt: skip
def test_the_file_holds_one_closed_solid_of_the_exact_volume_and_flanks(tmp_path, one, pieces, monkeypatch):
    taken, remove = [], kernel.model.occ.remove
    monkeypatch.setattr(kernel.model.occ, "remove", lambda what, **more: taken.extend(what) or remove(what, **more))
    (tmp_path / "gear.brep").write_text("of a user")
    made = write_step(tmp_path / "gear.step", one)
    assert {dim for dim, _ in taken} == {0}  # to take away surfaces and edges takes a time that grows with its square
    assert (tmp_path / "gear.brep").read_text() == "of a user"
    assert {path.name for path in tmp_path.iterdir()} == {"gear.brep", "gear.step"}
    volume = section_area(one) * one.face_width
    assert made.volume == pytest.approx(volume, rel=3e-8)
    assert made.faces == 2 * pieces * one.teeth + 3
    flank = InvoluteHelicoid.of(one, "tooth")
    low, high = (flank.tangent_length(r) for r in (one.form_radius, one.involute_tip_radius))
    t, z = np.meshgrid(np.linspace(low, high, 3), np.linspace(-0.499, 0.499, 3) * one.face_width)
    x, y, z = flank.points(t, z).reshape(3, -1)
    places = np.stack([-y, x, z]).T * 1e3  # the tooth's centre line is +y: a quarter turn
    with read_back(tmp_path / "gear.step") as (gmsh, shapes):
        assert [dim for dim, _ in shapes] == [3]
        assert gmsh.model.occ.getMass(3, shapes[0][1]) == pytest.approx(volume * 1e9, rel=1e-6)
        faces = gmsh.model.getEntities(2)
        on = Counter(e for face in faces for _, e in gmsh.model.getBoundary([face], oriented=False))
        assert set(on.values()) == {2}
        corners, edges = (len(gmsh.model.getEntities(dim)) for dim in (0, 1))
        assert len(on) == edges - 1  # the seam of the bore
        # Euler and Poincare: a body with one hole, two of whose faces have an inner loop
        assert corners - edges + len(faces) - 2 == 0
        for place in places:
            off = [math.dist(gmsh.model.getClosestPoint(2, tag, place)[0], place) for _, tag in faces]
            assert min(off) < 1e-5 * one.module * 1e3


@pytest.mark.dear
def test_a_relieved_solid_has_less(tmp_path):
    one = gear(8, 15.0, "left", 3.0, profile_shift=0.5)
    relief = tip_relief(one, 5e-6, length=1e-3)
    ground = write_step(tmp_path / "g.step", one, relieved_outline(one, relief))
    # A sliver of relief on each flank: removal along the normal times the arc r_b roll d(roll) of the involute.
    roll = np.linspace(relief.start, relief.end, 2001)
    lost = np.trapezoid(relief.removal(roll) * one.base_radius * roll, roll) * 2 * one.teeth * one.face_width
    assert section_area(one) * one.face_width - ground.volume == pytest.approx(lost, rel=2e-2)


def test_what_takes_long_is_said_before_it_starts(tmp_path, monkeypatch):
    document = {"results": ["geometry"], "gear": {"a": {"teeth": 150, "module": "3 mm", "bore_radius": "60 mm"}}}
    said = []

    def writes(path, *_, **_more):
        path.touch()
        said.append(path.name)

    monkeypatch.setattr("fegear.output.step.write_step", writes)
    export_gears(build_scene(document, "long", tmp_path), tmp_path, (), "step", say=said.append)
    assert said == ["Gear a, STEP: about 20 s of CPU time for 150 teeth.", "a.step"]
    document["gear"]["a"].update(teeth=20, bore_radius="10 mm")
    said.clear()
    export_gears(build_scene(document, "short", tmp_path), tmp_path, (), "step", say=said.append)
    assert said == ["a.step"]


def test_what_is_not_closed_is_not_written(tmp_path):
    one = gear(8, 15.0, "left", 3.0, profile_shift=0.5)
    pieces = list(one.tooth.outline.values())
    with pytest.raises(FegearError, match=r"g\.step: OpenCASCADE could not create a solid"):
        write_step(tmp_path / "g.step", one, pieces[:1] + pieces[2:])
    assert not (tmp_path / "g.step").exists()


def test_the_area_inside_splines_is_that_of_the_circle():
    tooth = Tooth(20)
    half = enclosed_area([spline_of(tooth.tip_land, 1e-12)])
    assert abs(half) == pytest.approx(0.5 * tooth.tip_radius**2 * tooth.tip_half_angle, rel=1e-12)
