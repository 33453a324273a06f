"""Teeth that are cut into a shaft: its stiffness, the rim of their rating and what is said, of no assumed bore."""

from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.gears_on_shafts import stiffened
from fegear.case.built.rated_body import gear_body
from fegear.case.built.rated_duty import bore_remarks
from fegear.case.built.solid_influence import solid_gear_to_solve
from fegear.case.built.teeth_in_shafts import cut_into
from fegear.case.reading import read_scene

CASE = Path(__file__).parents[2] / "cases" / "two_stage_shafts.toml"


def box(bore, outer, inner=0.0):
    section = f"{{length='120 mm', outer='{outer} mm', inner='{inner} mm'}}"
    given = ["gear.a.bore_radius=" + f"'{bore} mm'"] if bore else []
    return read_scene(CASE, [f"shaft.in.sections=[{section}]", *given])


def bending(scene):
    """Tilt at the middle of the face under a moment there, with the shaft held at its left end [rad]."""
    shaft = stiffened(scene, "in", scene.case.shaft["in"].build(), {}).shaft
    loads = np.zeros((1, 6))
    loads[0, 3] = 1.0
    return shaft.bent([0.1], np.array([0.1]), loads)[0, 3]


def test_the_bore_of_teeth_cut_into_a_shaft_does_not_weaken_it():
    """The core ended at the bore radius: a neck below the teeth, -74 for -17 um of bending at a bore of 6 mm."""
    found = [bending(box(bore, 40.0)) for bore in (4.0, 10.0, 19.5)]
    assert found[0] == pytest.approx(found[1], rel=1e-12)
    assert found[2] == pytest.approx(found[1], rel=1e-12)
    assert bending(box(20.0, 40.0)) == pytest.approx(found[0], rel=1e-3)  # pressed on the same shaft: the same body
    scene = box(10.0, 40.0)
    bare = scene.case.shaft["in"].build()
    loads = np.zeros((1, 6))
    loads[0, 3] = 1.0
    assert found[0] < bare.bent([0.1], np.array([0.1]), loads)[0, 3]  # the teeth's ring stiffens, and by no more than
    root = 2.0 * scene.gears["a"].root_radius
    whole = box(10.0, root * 1e3)
    assert bending(whole) < found[0]
    assert bending(whole) == pytest.approx(
        whole.case.shaft["in"].build().bent([0.1], np.array([0.1]), loads)[0, 3], rel=1e-9
    )  # a shaft as thick as its root circle is the shaft itself


def test_teeth_cut_into_a_shaft_have_no_rim_of_their_bore():
    """A pinion of 18 teeth on a thicker shaft had Y_B 1.22 and failed with S_F 1.27; solid it has 1.55."""
    said = []
    pressed = gear_body(box(23.0, 46.0), "a", said)
    assert pressed.rim_thickness == pytest.approx(box(23.0, 46.0).gears["a"].root_radius - 0.023)
    assert any("from bore_radius used" in text for text in said)
    assert any("underestimated" in text for text in bore_remarks(box(23.0, 46.0), "a"))
    cut, quiet = box(23.0, 50.0), []
    assert gear_body(cut, "a", quiet).rim_thickness is None
    assert not quiet
    assert bore_remarks(cut, "a") == ()
    assert solid_gear_to_solve(cut, "a").cut
    assert not solid_gear_to_solve(cut, "b").cut


def test_the_hole_of_a_shaft_leaves_the_rim_of_teeth_cut_into_it():
    hollow, said = box(15.0, 50.0, 45.0), []
    root = hollow.gears["a"].root_radius
    assert cut_into(hollow, "a") == pytest.approx(0.0225)
    assert gear_body(hollow, "a", said).rim_thickness == pytest.approx(root - 0.0225)
    assert any("from the hole of its shaft used" in text for text in said)
    with pytest.raises(InputError, match=r"the hole of its shaft leaves a rim of 3\.308 mm"):
        gear_body(box(15.0, 50.0, 48.0), "a", [])
    assert cut_into(box(15.0, 50.0), "a") == 0.0
    assert cut_into(box(15.0, 30.0), "a") is None
