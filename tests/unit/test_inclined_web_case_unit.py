"""An inclined web of a case: which way it leans, what is refused and said."""

import math
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.gears_on_shafts import _body
from fegear.case.built.solid_influence import check_solid_gear
from fegear.case.reading import build_scene, read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
BODY = {"rim_thickness": "3 mm", "web_thickness": "3 mm", "web_offset": "1.5 mm", "hub_radius": "11 mm"}


def scene(**more):
    gear = {"teeth": 24, "module": "2 mm", "bore_radius": "7 mm", "face_width": "8 mm"}
    body = {key: one for key, one in (BODY | more).items() if one is not None}
    gears = {"a": gear, "b": gear | {"body": body}, "c": gear}
    pairs = {"I": {"driver": "a", "driven": "b"}, "II": {"driver": "b", "driven": "c"}}
    pairs = {key: one | {"width": "solid", "torque": "20 N*m"} for key, one in pairs.items()}
    return build_scene({"results": ["load-distribution"], "gear": gears, "pair": pairs}, "case", Path())


def test_a_positive_inclination_leads_toward_end_two():
    """From 0 to 3 mm at the rim, 18.5 mm from the axis, over the radius to the hub or to the bore."""
    body = scene(web_offset="-0.5 mm", web_inclination="15 deg").gears["b"].body
    rise = math.tan(math.radians(15.0)) * 7.5e-3
    assert body.web == pytest.approx((-2e-3, 1e-3))
    assert body.foot == pytest.approx((-2e-3 + rise, 1e-3 + rise))
    assert body.hub == pytest.approx((-4e-3, 4e-3))
    down = scene(web_offset="-1 mm", web_inclination="15 deg", hub_radius=None).gears["b"].body
    assert down.hub == down.foot == pytest.approx([x + rise * 11.5 / 7.5 for x in (-2.5e-3, 0.5e-3)])


def test_on_its_shaft_it_leans_with_its_end_two():
    gear = scene(web_offset="-0.5 mm", web_inclination="15 deg").gears["b"]
    place = type("Place", (), {"seat": None})
    left, right = (_body(gear, place, sense) for sense in (1, -1))
    assert right.lean == -left.lean == pytest.approx(math.tan(math.radians(15.0)))
    assert right.rings[1][1:] == pytest.approx(gear.body.web)
    assert left.rings[1][1:] == pytest.approx((-gear.body.web[1], -gear.body.web[0]))
    gear = scene(web_offset="-1 mm", web_inclination="15 deg", hub_radius=None).gears["b"]
    assert _body(gear, place, -1).held == pytest.approx(gear.body.foot)
    assert _body(gear, place, 1).held == pytest.approx((-gear.body.foot[1], -gear.body.foot[0]))


@pytest.mark.parametrize(
    ("more", "key", "said"),
    [
        ({"web_inclination": "31 deg"}, "web_inclination", "must be between -30 deg and 30 deg"),
        ({"web_inclination": "100 deg"}, "web_inclination", "must be between -30 deg and 30 deg"),
        ({"web_inclination": "20 deg"}, "web_inclination", "places the web outside the face width,"),
        (
            {"web_inclination": "-20 deg", "hub_width": "4 mm", "hub_offset": "2 mm"},
            "hub",
            "must cover the web, there -2.72978 to 0.270223 mm, within the face width",
        ),
        (
            {"web_inclination": "-5 deg", "web_offset": "2.5 mm"},
            "web_offset",
            "mm beyond an inclined web and the rim by less",
        ),
    ],
)
def test_what_cannot_be_or_was_not_compared_is_refused_with_its_key(more, key, said):
    with pytest.raises(InputError) as refused:
        scene(**more)
    assert refused.value.key == f"gear.b.body.{key}"
    assert said in str(refused.value)


def test_an_inclined_web_of_an_idler_is_refused():
    with pytest.raises(InputError, match="web_inclination = 1 deg: is ambiguous for idler b: end II is at"):
        check_solid_gear(scene(web_offset="0 mm", web_inclination="1 deg"), "b")
    with pytest.raises(InputError, match=r"body\.web_offset = 1 mm: is ambiguous for idler b"):
        check_solid_gear(scene(web_offset="1 mm"), "b")
    check_solid_gear(scene(web_offset="0 mm"), "b")


def test_a_rating_says_that_it_takes_the_web_for_a_straight_one():
    def remarks(inclination):
        body = f"gear.wheel.body={{rim_thickness='20 mm',web_thickness='10 mm',web_inclination='{inclination} deg'}}"
        settings = ["results=['rating']", "rating.beside=[]", "gear.wheel.bore_radius='60 mm'", body]
        found = read_scene(CASES / "rating_spur.toml", settings)
        done = run_plan(found, make_plan(found, STAGES), cache=SolutionCache())
        (outcome,) = (one for task, one in done.outcomes.items() if task.stage == "rating")
        return " ".join(outcome.remarks)

    assert "Gear wheel: C_R is computed for a straight web" in remarks(10)
    assert "straight web" not in remarks(0)
