"""Nominal stresses of shafts against calculations by hand, and the tilt of bearings against that of beams."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.case.built.gears_on_shafts import strained
from fegear.case.reading import build_scene
from fegear.results.shafts.checked_shafts import ShaftChecks, checked_shafts, said_of_checks, tilted_bearings
from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import stiff
from fegear.shafts.deflection import deflect
from fegear.shafts.held import Around, LoadedShaft, Seat
from fegear.shafts.permissible_tilt import PermissibleTilt, tilt_of_kind
from fegear.shafts.section import Section
from fegear.shafts.shaft_strength import ShaftStrength
from fegear.shafts.stress import diameter_for, nominal_stress

E, NU, INF = 206e9, 0.3, math.inf
PIN, ROLLER = stiff(INF, INF), stiff(INF)


def loaded(sections, at, loads, ends=(0.0, 0.4)):
    shaft = Shaft(tuple(Section(*one) for one in sections), E, NU)
    seats = (Seat(PIN, ends[0]), Seat(ROLLER, ends[1]))
    return LoadedShaft(shaft, seats, np.atleast_1d(at).astype(float), np.array(loads, dtype=float), "shaft.a")


def bending_of(moment, d, h=0.0):
    return 32.0 * moment * d / (math.pi * (d**4 - h**4))


def torsion_of(torque, d, h=0.0):
    return 16.0 * torque * d / (math.pi * (d**4 - h**4))


def test_a_stepped_shaft_with_bending_and_torsion_by_hand():
    # 40 / 60 / 40 mm with steps at 0.1 and 0.3 m, 5 kN in the middle, 300 N m from the left end to the middle
    force, torque = 5000.0, 300.0
    box = loaded(((0.1, 0.04), (0.2, 0.06), (0.1, 0.04)), (0.2, 0.0),
                 [(force, 0, 0, 0, 0, torque), (0, 0, 0, 0, 0, -torque)])  # fmt: skip
    found = nominal_stress(deflect((box,))[0])
    bend, twist = bending_of(0.5 * force * 0.1, 0.04), torsion_of(torque, 0.04)
    assert found.z[found.most] == pytest.approx(0.1)
    assert found.diameter[found.most] == 0.04  # the thin side of the step
    assert found.equivalent.max() == pytest.approx(math.sqrt(bend**2 + 3.0 * twist**2), rel=1e-12)
    both = np.flatnonzero(np.isclose(found.z, 0.1))
    np.testing.assert_allclose(found.bending[both], [bend, bending_of(0.5 * force * 0.1, 0.06)], rtol=1e-12)
    middle = np.flatnonzero(np.isclose(found.z, 0.2))
    np.testing.assert_allclose(found.bending[middle], bending_of(0.5 * force * 0.2, 0.06), rtol=1e-12)
    np.testing.assert_allclose(found.torsion[middle], [torsion_of(torque, 0.06), 0.0], rtol=1e-12, atol=1e-6)
    assert np.abs(found.bending[[0, -1]]).max() < 1e-9 * bend


def test_bending_in_two_planes_an_axial_force_with_its_moment_and_a_bore():
    # axial force 2 kN at a radius of 50 mm, at 0.15 m of 0.4 m between the bearings; the left one carries it
    radial, tangential, axial, radius = 900.0, 2500.0, 2000.0, 0.05
    a, b, span, d, h = 0.15, 0.25, 0.4, 0.05, 0.02
    box = loaded(((span, d, h),), (a, 0.0), [(radial, tangential, axial, 0, axial * radius, 0), (0,) * 6])
    found = nominal_stress(deflect((box,))[0])
    # reactions at the right end, from moments about the left one; M_y = +z F_x in fegear's signs
    right_x, right_y = -(radial * a + axial * radius) / span, -tangential * a / span
    just_behind = math.hypot(right_x * b, right_y * b)
    just_before = math.hypot(right_x * b + axial * radius, right_y * b)
    where = np.flatnonzero(np.isclose(found.z, a))
    np.testing.assert_allclose(
        found.bending[where], [bending_of(just_before, d, h), bending_of(just_behind, d, h)], rtol=1e-11
    )
    area = 0.25 * math.pi * (d * d - h * h)
    np.testing.assert_allclose(found.axial[where], [axial / area, 0.0], rtol=1e-11, atol=1e-3)
    assert found.equivalent.max() == pytest.approx(
        max(axial / area + bending_of(just_before, d, h), bending_of(just_behind, d, h)), rel=1e-11
    )


def test_a_cone_and_laws():
    # clamped cone under a force at its end: M = F (L - z), d linear; the maximum lies between its ends
    length, d0, d1, force = 0.2, 0.06, 0.02, 800.0
    shaft = Shaft((Section(length, d0, 0.0, d1),), E, NU)
    box = LoadedShaft(shaft, (Seat(stiff(INF, INF, INF), 0.0),), np.array([length]),
                      np.array([[force, 0.0, 0, 0, 0, 0]]), "cone")  # fmt: skip
    found = nominal_stress(deflect((box,))[0])
    z = np.linspace(0.0, length, 200001)
    expected = bending_of(force * (length - z), d0 + (d1 - d0) * z / length).max()
    assert found.equivalent.max() == pytest.approx(expected, rel=1e-4)
    twice = nominal_stress(deflect((replace(box, loads=2.0 * box.loads),))[0])
    np.testing.assert_allclose(twice.equivalent, 2.0 * found.equivalent, rtol=1e-12)
    rigid = replace(box, shaft=replace(shaft, young_modulus=INF))
    np.testing.assert_allclose(nominal_stress(deflect((rigid,))[0]).equivalent, found.equivalent, rtol=1e-12)


def test_a_shaft_around_another_carries_what_its_bearings_leave_it():
    inner = LoadedShaft(Shaft((Section(0.2, 0.02),), E, NU),
                        (Seat(PIN, 0.0, around=Around(1, 0.1)), Seat(ROLLER, 0.2, around=Around(1, 0.3))),
                        np.array([0.1]), np.array([[1000.0, 0, 0, 0, 0, 0]]), "inner")  # fmt: skip
    outer = loaded(((0.4, 0.06, 0.03),), (0.0,), [(0.0,) * 6])
    found = nominal_stress(deflect((inner, outer))[1])
    assert found.bending.max() == pytest.approx(bending_of(500.0 * 0.1, 0.06, 0.03), rel=1e-10)


def checks(bent, strength=None, tilts=(None, None), factor=1.0, assumed=False):
    drawn = tuple(one.loaded.shaft for one in bent)
    limits = (strength or ShaftStrength(),), (assumed,), (factor,)
    return ShaftChecks(("a",), drawn, *limits, (("left", "right"),), (tilts,))


def test_a_thin_shaft_under_a_large_torque_fails_and_the_named_diameter_does_not():
    def of(d, factor=1.0):
        box = loaded(((0.4, d),), (0.1, 0.3), [(0, 0, 0, 0, 0, 500.0), (0, 0, 0, 0, 0, -500.0)])
        bent = deflect((box,))
        asked = checks(bent, factor=factor)
        return checked_shafts(asked, bent)[0], list(said_of_checks(asked, bent))

    thin, notes = of(0.01)
    assert thin.equivalent == pytest.approx(math.sqrt(3.0) * torsion_of(500.0, 0.01), rel=1e-12)  # 4411 MPa
    assert thin.safety == pytest.approx(275e6 / thin.equivalent)
    assert thin.margin == pytest.approx(thin.safety / 1.2)
    assert notes[0].startswith("Shaft a: nominal equivalent stress 4410 MPa (bending 0, torsion 2550) at 100 mm")
    assert notes[0].margin == thin.margin
    enough, _said = of(thin.needed)
    assert enough.margin == pytest.approx(1.0, rel=1e-9)
    assert diameter_for(thin.stress, thin.safety, thin.required) == thin.needed
    assert of(1.001 * thin.needed)[1] == []
    assert of(thin.needed, 1.5)[0].margin == pytest.approx(1.0 / 1.5, rel=1e-9)
    assert "at K_A 1.5" in of(0.01, 1.5)[1][0]
    idle = deflect((loaded(((0.4, 0.05),), 0.1, [(0,) * 6]),))
    (note,) = said_of_checks(checks(idle, assumed=True), idle)
    assert "275 MPa assumed" in note
    assert math.isinf(checked_shafts(checks(idle), idle)[0].safety)


def test_the_tilt_of_a_bearing_is_the_slope_of_the_beam():
    # F a b (L + b)/(6 E I L) at the left end, F a b (L + a)/(6 E I L) at the right one; shear adds F b/L/(kappa G A)
    force, a, b, span, d = 4000.0, 0.25, 0.15, 0.4, 0.03
    bent = deflect((loaded(((span, d),), a, [(0, force, 0, 0, 0, 0)]),))
    inertia = math.pi / 64 * d**4
    left, right = (force * a * b * (span + far) / (6 * E * inertia * span) for far in (b, a))
    tilts = (PermissibleTilt(0.5 * left, 0.999 * left), PermissibleTilt(1.001 * right, 2.0 * right))
    (found,) = tilted_bearings(checks(bent, tilts=tilts), bent)
    assert found[0].tilt == pytest.approx(left, rel=1e-9)
    assert found[1].tilt == pytest.approx(right, rel=1e-9)
    (note,) = [
        one for one in said_of_checks(checks(bent, ShaftStrength(1e12), tilts), bent) if one.startswith("Bearing")
    ]
    assert note.startswith(f"Bearing left: tilt {left * 10800 / math.pi:.3g}' (")
    assert note.margin == pytest.approx(0.999)
    between = (None, PermissibleTilt(0.999 * right, 1.001 * right))
    (unsure,) = said_of_checks(checks(bent, ShaftStrength(1e12), between), bent)
    assert "specify permissible_tilt of the catalogue" in unsure


def test_sections_are_those_of_the_case_and_end_at_root_circles():
    text = (Path(__file__).parents[2] / "cases" / "two_stage_shafts.toml").read_text("utf-8")
    document = tomllib.loads(text)
    document["shaft"]["in"]["sections"] = [{"length": "120 mm", "outer": "30 mm"}]
    document["gear"]["a"]["bore_radius"] = "8 mm"  # held inside of the shaft: teeth are cut into it
    scene = build_scene(document, "box", Path())
    assert strained(scene, "in").diameters([40.0e-3])[0] == pytest.approx([0.03])
    document["shaft"]["in"]["sections"][0]["outer"] = "70 mm"  # as thick as the tips
    scene = build_scene(document, "box", Path())
    half = 0.5 * scene.gears["a"].face_width
    shaft, root = strained(scene, "in"), 2.0 * scene.gears["a"].root_radius
    assert root < 0.07
    found = shaft.diameters([0.04 - 0.99 * half, 0.04 + 0.99 * half, 0.04 + 1.01 * half, 0.1])[0]
    assert found == pytest.approx([root, root, 0.07, 0.07])


def test_guide_values_by_kind():
    assert tilt_of_kind("ball", 0.0) == PermissibleTilt(0.001, 0.003, "deep groove ball")
    assert tilt_of_kind("ball", 0.3) is None  # angular contact: in no row of the table
    assert tilt_of_kind("tapered", 0.22).low < tilt_of_kind("cylindrical", 0.0).low < tilt_of_kind("ball", 0.0).low
