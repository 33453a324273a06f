"""Cracked teeth in the window: what is computed and sent of them, and what a dragged tip writes into the case."""

import functools
import json
import math
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.odd_teeth import crack_of
from fegear.case.reading import build_scene, parse_document
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.window.crack_handle import moved_crack
from fegear.window.document import Desk
from fegear.window.glance import crack_tasks
from fegear.window.messages import checked
from fegear.window.on_gears import on_the_gears

TEXT = """results = ["odd-tooth-stiffness"]
[gear.a]
teeth = 25
module = "2 mm"
face_width = "20 mm"
[[gear.a.odd_tooth]]
tooth = 4
pits = [{ diameter = ["49 mm", "51 mm"], face_share = 0.4 }]
[[gear.a.odd_tooth]]
tooth = 2
crack = { depth_ratio = 0.4, angle = "70 deg" }  # kept
[gear.b]
teeth = 30
module = "2 mm"
face_width = "20 mm"
[pair.I]
driver = "a"
driven = "b"
torque = "60 N*m"
[effects]
odd_teeth = true
[accuracy]
tolerance = 1e-2
"""
TASK, CACHE = Task("crack-shown", "a"), SolutionCache()


@functools.cache
def shown(crack='depth_ratio = 0.4, angle = "70 deg"', on="true"):
    text = TEXT.replace('depth_ratio = 0.4, angle = "70 deg"', crack).replace("odd_teeth = true", f"odd_teeth = {on}")
    scene = build_scene(parse_document(text, "c"), "c", Path())
    ran = run_plan(scene, make_plan(scene, STAGES, [TASK]), cache=CACHE)
    return scene, ran.outcomes[TASK].data, ran.outcomes[Task("odd-gear-solution", "a")].data


def test_opening_and_stress_are_those_of_the_solution():
    """Opening near the tip is 8 K_I / E' sqrt(r / 2 pi) but for its elements; on a free fillet one stress is left."""
    _, data, known = shown()
    (one,) = data.cracks
    gear = data.gear
    assert (one.tooth, one.place, one.ends, data.pair) == (2, 1, "depth_ratio", "I")
    assert np.isfinite(one.moved).all()
    assert np.isfinite(one.mises).all()
    assert data.load == pytest.approx(60.0 / gear.base_radius / 20e-3)
    plane = gear.material.young_modulus / (1.0 - gear.material.poisson_ratio**2)
    way = one.path[:, 1] - one.path[:, 0]
    normal = np.array([-way[1], way[0]]) / np.hypot(*way)
    left, right = one.left[-3], one.right[-3]  # the last vertices before the tip
    r = np.hypot(*(one.points[:, left] - one.path[:, 1]))
    opened = normal @ (one.moved[:, left] - one.moved[:, right])
    assert opened == pytest.approx(8.0 * one.k_1[0] / plane * math.sqrt(r / (2.0 * math.pi)), rel=0.08)
    assert (one.left[-1], np.allclose(one.points[:, one.left[-1]], one.path[:, 1])) == (one.right[-1], True)
    number = known.gear.teeth - 2  # meshing order of a driver runs the other way
    half = known.ordinary.reference_half_width
    stress, _ = known.largest_root_stress(number, number, "compression", [data.radius], [half])
    nu = gear.material.poisson_ratio
    back = one.fillets[one.points[0, one.fillets] < 0.0]
    expected = abs(stress[0]) * data.load * math.sqrt(1.0 - nu + nu**2)
    assert one.mises[back].max() == pytest.approx(expected, rel=0.03)
    usual = known.ordinary.self_compliance(np.array([data.radius]), np.array([half]))[0]
    assert one.loss == pytest.approx(1.0 - usual / known.own(number, data.radius, half)[0])


def test_faces_that_a_load_closes_are_shown_closed():
    crack = 'depth_ratio = 0.4, angle = "70 deg", fillet = "compression"'
    (free,), (closed,) = (shown(f"{crack}, {more}")[1].cracks for more in ("tangent_angle = '30 deg'",
                                                                          'crack_faces = "closing"'))  # fmt: skip
    gaps = []
    for one in (free, closed):
        way = one.path[:, 1] - one.path[:, 0]
        normal = np.array([-way[1], way[0]]) / np.hypot(*way)
        gaps.append(normal @ (one.moved[:, one.left] - one.moved[:, one.right]))
    assert (free.k_1[0] < 0.0, closed.closed > 0.9) == (True, True)
    assert closed.k_1[0] == pytest.approx(0.0, abs=0.01 * abs(free.k_1[0]))
    assert gaps[0].min() < -1e-6  # open faces go through each other
    assert np.abs(gaps[1]).max() < 0.01 * np.abs(gaps[0]).max()


def test_what_is_sent_is_small_and_whole():
    scene, data, _ = shown()
    sent = json.loads(json.dumps(on_the_gears(TASK, data), allow_nan=False))
    (one,) = sent["cracks"]
    count = len(one["points"][0])
    assert (sent["pair"], sent["kind"], sent["of"]) == ("a", "crack", "I")
    assert one["moved"]["shape"] == [2, count]
    assert one["mises"]["shape"] == [count]
    assert max(one["triangles"]) == count - 1
    crack = data.cracks[0]
    stands = crack.points + crack.moved  # both faces are one line before they are loaded
    assert one["opening"] == pytest.approx(1e6 * np.hypot(*(stands[:, crack.left[0]] - stands[:, crack.right[0]])))
    assert one["k"][0]["error"] > 0.0
    assert len(json.dumps(sent)) < 150_000
    assert crack_tasks(scene) == [TASK]
    off = build_scene(
        parse_document(TEXT.replace("odd_teeth = true", "odd_teeth = false").replace("odd-tooth-stiffness", "geometry"),
                       "c"), "c", Path())  # fmt: skip
    assert crack_tasks(off) == []


def test_a_dragged_tip_changes_length_and_angle_in_the_text():
    desk = Desk(TEXT, "c", Path())
    text = moved_crack(desk, "a", 1, 1.5, 60.0)
    assert "# kept" in text
    scene = build_scene(parse_document(text, "c"), "c", Path())
    part, gear = scene.case.gear["a"].odd_tooth[1].crack, scene.gears["a"]
    assert part.depth is None
    crack = crack_of(gear, part, "crack")
    assert crack.length(gear.tooth) * gear.module == pytest.approx(1.5e-3, rel=1e-3)
    (mx, my), (x, y) = crack.path(gear.tooth).T
    assert math.degrees(math.atan2(mx - x, my - y)) == pytest.approx(60.0)
    # into the body there is no way through: the length itself
    text = moved_crack(desk, "a", 1, 1.2, 0.0)
    assert 'depth = "1.2 mm"' in text
    assert "depth_ratio" not in text
    made = build_scene(parse_document(text, "c"), "c", Path()).case.gear["a"].odd_tooth[1].crack
    assert (made.depth, made.angle) == pytest.approx((1.2e-3, 0.0))


def test_of_a_single_table_and_of_a_crack_by_its_corners():
    single = TEXT.replace("[[gear.a.odd_tooth]]\ntooth = 4\npits", "x = 1\n[gear.c]\ny").replace("[[", "[").replace(
        "odd_tooth]]", "odd_tooth]")  # fmt: skip
    desk = Desk(single, "c", Path())
    assert 'depth = "0.9 mm"' in moved_crack(desk, "a", 0, 0.9, 50.0)  # a case that is refused may be changed, too
    path = TEXT.replace('depth_ratio = 0.4, angle = "70 deg"', 'path = [["0.5 mm", "22 mm"]]')
    with pytest.raises(InputError, match="is not a straight crack"):
        moved_crack(Desk(path, "c", Path()), "a", 1, 0.9, 50.0)


def test_pages_say_where_a_tip_is():
    said = {"gear": "a", "place": 1, "depth": 1.5, "angle": 60.0, "moving": True}
    assert checked("crack", said) == said
    with pytest.raises(InputError, match=r"page\.crack\.depth"):
        checked("crack", {**said, "depth": None})
