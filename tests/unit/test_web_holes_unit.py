"""Holes in the web of a gear in a case: keys, refusals, inertia, and results that do without them."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import GeometryError, InputError
from fegear.case.built.solid_influence import solid_support_remarks
from fegear.case.reading import build_scene
from fegear.engine.sheet.seen import Seen
from fegear.fem.solid.holed_teeth import HoledRing
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear_body import GearBody, WebHoles
from fegear.geometry.mass import mass_properties
from fegear.output.solid_mesh_files import pressed_gear
from fegear.results.gear import body_modes
from fegear.results.gear.teeth_over_holes import HOLES_FIGURE, HOLES_TABLE

HOLES = {"count": 5, "circle_diameter": "27 mm", "diameter": "6 mm"}


def scene(results="stiffness", inclination="0 deg", **holes):
    body = {"rim_thickness": "3 mm", "web_thickness": "3 mm", "hub_radius": "8 mm", "holes": HOLES | holes}
    body["web_inclination"] = inclination
    gear = {"teeth": 24, "module": "2 mm", "bore_radius": "6 mm", "face_width": "8 mm", "body": body}
    case = {"results": [results], "gear": {"a": gear}, "stiffness": {"face_positions": 3}}
    return build_scene(case, "case", Path())


def test_holes_of_a_case():
    gear = scene(angle="12 deg", tooth=23).gears["a"]
    assert gear.body.holes == WebHoles(
        5, pytest.approx(13.5e-3), pytest.approx(3e-3), pytest.approx(math.radians(12)), 23
    )
    holes = gear.body_in_modules.holes
    assert (holes.circle_radius, holes.radius) == pytest.approx((6.75, 1.5))
    assert holes.different_teeth(24) == 24
    assert replace(holes, count=16).different_teeth(24) == 3


@pytest.mark.parametrize(
    ("holes", "key", "words"),
    [
        ({"diameter": "12 mm"}, "diameter", "inside of the rim"),
        ({"circle_diameter": "21 mm"}, "diameter", "to the hub"),
        ({"count": 13, "diameter": "6.4 mm"}, "diameter", "between 13 holes"),
        ({"count": 10**400}, "diameter", "leaves no web between 1000"),
        ({"diameter": "0.1 mm"}, "diameter", "at least 0.4 mm"),
        ({"count": 0}, "count", "at least 1"),
        ({"tooth": 24}, "tooth", "between 0 and 23"),
        ({"tooth": -1}, "tooth", "between 0 and 23"),
    ],
)
def test_holes_without_room_are_refused(holes, key, words):
    with pytest.raises(InputError, match=words) as found:
        scene(**holes)
    assert found.value.key == f"gear.a.body.holes.{key}"


def test_holes_in_an_inclined_web_are_refused():
    with pytest.raises(InputError, match="are not supported in an inclined web"):
        scene(inclination="5 deg")


def test_holes_beside_the_teeth_are_refused():
    body = GearBody(97e-3, 50e-3, (-2e-3, 2e-3), (-5e-3, 5e-3), holes=WebHoles(8, 80e-3, 16.5e-3))
    with pytest.raises(GeometryError, match="below the root circle"):
        body.check(1e-3, 10e-3, 20e-3, 100e-3)


def test_what_knows_no_holes_refuses_them():
    with pytest.raises(InputError, match="body-modes"):
        body_modes.BODY_MODES.inputs(scene("body-modes"), "a")
    with pytest.raises(InputError, match="without holes only"):
        pressed_gear(scene().gears["a"])


def test_inertia_lacks_what_is_drilled_out():
    body = GearBody(5.0, 2.0, (-0.5, 1.0), (-2.0, 2.0))
    holes = WebHoles(6, 3.5, 0.8)
    made = (mass_properties(Tooth(14), 1.0, 4.0, 1.0, 3.0, one) for one in (body, replace(body, holes=holes)))
    plain, drilled = ((one.mass, one.inertia, one.inertia_at_mid_face) for one in made)
    one = 3.0 * math.pi * 0.8**2 * 1.5
    assert plain[0] - drilled[0] == pytest.approx(6 * one)
    assert plain[1] - drilled[1] == pytest.approx(6 * one * (0.8**2 / 2 + 3.5**2))
    # About x: each hole's own, and how far its middle lies from the axis.
    across = sum(
        one * ((3 * 0.8**2 + 1.5**2) / 12 + 0.25**2 + (3.5 * math.sin(math.pi * i / 3)) ** 2) for i in range(6)
    )
    assert plain[2] - drilled[2] == pytest.approx(across)


def test_the_figure_of_the_teeth_says_what_pairs_take():
    each = np.array([0.9, 1.0, 1.1])
    uneven = SimpleNamespace(deflection=each, root_tension=each, root_compression=-each)
    solution = SimpleNamespace(body=SimpleNamespace(holes=WebHoles(1, 3.0, 0.5)), uneven=uneven, support=None)
    for tooth, words in ((None, "pairs take the mean."), (2, "pairs take tooth 2 for all teeth.")):
        asked = SimpleNamespace(gear=SimpleNamespace(body=SimpleNamespace(holes=SimpleNamespace(tooth=tooth))))
        seen = Seen(SimpleNamespace(influence=SimpleNamespace(fine=solution)), asked, "a")
        (figure,), (table,) = HOLES_FIGURE.figures(seen), HOLES_TABLE.tables(seen)
        assert figure.caption.endswith(words)
        np.testing.assert_allclose(table["deflection"], each / each.mean())
        np.testing.assert_allclose(figure.panels[0].items[0].y, 100.0 * (each / each.mean() - 1.0))
    (remark,) = solid_support_remarks("a", SimpleNamespace(fine=solution), 2)
    assert remark.startswith("Gear a: compliance varies over 3 consecutive teeth because of the web hole.")


@pytest.mark.parametrize(("teeth", "holes", "different"), [(24, 8, 3), (24, 5, 24), (24, 36, 2), (24, 24, 1)])
def test_as_many_teeth_differ_as_pass_until_holes_and_teeth_stand_alike_again(teeth, holes, different):
    none = np.zeros((1, 1))
    assert HoledRing(none, none, np.zeros(1, int), np.zeros(1, int), teeth, holes).different == different
    assert different * holes % teeth == 0
