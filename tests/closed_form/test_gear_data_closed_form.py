"""The gear data of a drawing: over balls, active profile, sliding and the pair in mesh, against books and outlines."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from matplotlib.path import Path

from fegear.base.errors import GeometryError, InputError
from fegear.case.reading import build_scene
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.gear_data import measured
from fegear.geometry.inspection import span
from fegear.geometry.outline import gear_outline
from fegear.geometry.over_balls import over_balls, touching_ball, usual_ball
from fegear.geometry.pair import GearPair
from fegear.geometry.path_of_contact import active_profile, path_points, specific_sliding
from fegear.geometry.rack import BasicRack
from fegear.results.gear.drawing import in_mesh
from fegear.results.gear.geometry import drawing_of, pair_table, unmeasured_remarks


def gear(z, shift=0.0, module=1e-3, **more):
    return Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25), shift, **more), module, 0.2 * z * module)


# ---- span and balls ----------------------------------------------------------------------------------------------
def test_the_published_example_over_pins_and_its_span():
    """SDP/SI, Elements of Metric Gear Technology, section 10: m 1, z 20, pins of 1.7 mm; m 3, z 24, x 0.4, k 4."""
    assert over_balls(gear(20), 1.7e-3).dimension == pytest.approx(22.2941e-3, abs=5e-8)
    assert span(gear(24, 0.4, 3e-3), 4) == pytest.approx(32.8266e-3, abs=5e-8)


@pytest.mark.parametrize(("z", "shift", "pin"), [(10, 0.0, 1.7886), (10, 0.2, 1.9979), (10, 0.4, 2.2687)])
def test_pins_that_touch_at_the_v_circle_are_those_of_the_table(z, shift, pin):
    """The same source's table of pins for module 1."""
    assert touching_ball(gear(z, shift)) == pytest.approx(pin * 1e-3, abs=5e-8)


@given(st.integers(12, 120), st.floats(-0.2, 0.5), st.sampled_from([0.0, 0.03]))
def test_balls_touch_the_generated_outline_on_both_flanks_and_stand_out(z, shift, allowance):
    try:
        made = gear(z, shift, thickness_allowance=allowance)
    except GeometryError:
        assume(False)
    found = over_balls(made, usual_ball(made))
    radius = 0.5 * found.ball_diameter
    # The two opposite (or nearly opposite) spaces lie half a pitch off tooth 0 and that many pitches further.
    across = 2.0 * math.pi / z * (z // 2)
    reach = (found.dimension - found.ball_diameter) / (2.0 * math.sin(0.5 * across))
    angle = math.pi / z
    centre = reach * np.array([math.sin(angle), math.cos(angle)])
    x, y = gear_outline(made, 1e-6)
    distance = np.hypot(x - centre[0], y - centre[1])
    assert distance.min() == pytest.approx(radius, abs=2e-8)
    for side in (-1.0, 1.0):
        here = side * (np.arctan2(x, y) - angle) > 0.0
        assert distance[here].min() == pytest.approx(radius, abs=2e-8)
    assert reach + radius > made.tip_radius


@pytest.mark.parametrize(
    ("size", "rule"),
    [
        (1e-4, "so small that it has no contact above the base circle"),
        (1.3e-3, "below|root|tip"),
        (4e-3, "tips|no involute"),
    ],
)
def test_balls_that_no_gauge_could_use_are_refused_with_a_size_that_fits(size, rule):
    with pytest.raises(GeometryError, match=rule) as refused:
        over_balls(gear(20), size)
    assert "1.724" in refused.value.remedy


def test_a_case_names_its_balls_and_is_told_where_they_do_not_fit(tmp_path):
    a = {"teeth": 20, "module": "1 mm", "ball_diameter": "1.7 mm"}
    document = {"results": ["geometry"], "gear": {"a": a}, "pair": {"I": {"driver": "a", "driven": "a"}}}
    table = pair_table("I", drawing_of(build_scene(document, "c", tmp_path)))
    assert table.column("over_balls").values == pytest.approx([22.2941] * 2, abs=5e-5)
    a["ball_diameter"] = "4 mm"
    with pytest.raises(InputError, match=r"gear\.a\.ball_diameter"):
        build_scene(document, "c", tmp_path)


def test_a_gear_without_balls_is_named(tmp_path, monkeypatch):
    document = {"results": ["geometry"], "gear": {"a": {"teeth": 20, "module": "1 mm"}}}
    drawing = drawing_of(build_scene(document, "c", tmp_path))
    assert unmeasured_remarks(drawing) == ()

    def never(*_given):
        raise GeometryError("ball_diameter", 1.0, "fits no space")

    monkeypatch.setattr("fegear.geometry.gear_data.over_balls", never)
    assert measured(drawing.gears["a"]) is None
    assert "Gear a" in unmeasured_remarks(drawing)[0]


# ---- the path of contact -----------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def pair():
    return GearPair(gear(19, 0.3), gear(61, -0.1))


def test_points_of_the_path_stand_where_tips_and_base_pitches_put_them(pair):
    at = {point.letter: point.x for point in path_points(pair)}
    assert list(at) == ["A", "B", "C", "D", "E"]
    assert pair.radius(at["A"], "driven") == pytest.approx(pair.driven.tip_radius)
    assert pair.radius(at["E"], "driver") == pytest.approx(pair.driver.tip_radius)
    assert at["D"] - at["A"] == pytest.approx(pair.base_pitch)
    assert at["E"] - at["B"] == pytest.approx(pair.base_pitch)
    assert at["C"] == 0.0


def test_high_contact_ratios_have_several_changes():
    tall = BasicRack(1.4, 1.7, 0.2)
    wheel = Gear(Tooth(60, tall), 1e-3, 10e-3)
    high = GearPair(wheel, wheel)
    assert 2.0 < high.contact_ratio < 3.0
    letters = [point.letter for point in path_points(high)]
    assert letters == ["A", "B_{2}", "D_{1}", "C", "B_{1}", "D_{2}", "E"]
    found = active_profile(high, "driver")
    assert math.isnan(found.lowest_single)
    assert math.isnan(found.highest_single)


def test_active_profiles_end_at_the_mate_and_single_contact_lies_between(pair):
    for member in ("driver", "driven"):
        found = active_profile(pair, member)
        assert pair.gear(member).form_radius <= found.start < found.lowest_single
        assert found.lowest_single < found.highest_single < found.end <= pair.gear(member).tip_radius
    turned = active_profile(pair.reversed(), "driver")
    assert turned == pytest.approx(active_profile(pair, "driven"))


def test_specific_sliding_is_the_difference_of_the_arcs_that_flanks_roll_over(pair):
    x = np.linspace(pair.x_start, pair.x_end, 41)
    arcs = {m: pair.roll_angle(x, m) ** 2 * pair.gear(m).base_radius / 2.0 for m in ("driver", "driven")}
    middle, (one, two) = 0.5 * (x[1:] + x[:-1]), (np.abs(np.diff(arcs[m])) for m in ("driver", "driven"))
    assert specific_sliding(pair, middle, "driver") == pytest.approx((one - two) / one, rel=1e-9, abs=1e-12)
    assert specific_sliding(pair, middle, "driven") == pytest.approx((two - one) / two, rel=1e-9, abs=1e-12)


def test_the_pair_is_drawn_touching_at_the_pitch_point_and_nowhere_inside_each_other(pair):
    driver, driven = in_mesh(pair, "driver"), in_mesh(pair, "driven")
    chord = 1e-3 * pair.driver.module

    def away(line, points):
        """Distances of points, shape (2, N), from a line of chords."""
        a, along = line[:, :-1, None], np.diff(line)[:, :, None]
        share = ((points[:, None] - a) * along).sum(axis=0) / np.maximum((along**2).sum(axis=0), 1e-30)
        return np.hypot(*(points[:, None] - a - np.clip(share, 0.0, 1.0) * along)).min(axis=0)

    assert away(driver, np.zeros((2, 1))) < chord
    assert away(driven, np.zeros((2, 1))) < chord
    body = np.hstack([driver, [[0.0], [-pair.driver.pitch_radius]]])
    inside = Path(body.T).contains_points(driven.T)
    assert away(driver, driven[:, inside]).max(initial=0.0) < chord
    deeper = driven - np.array([[0.0], [20.0 * chord]])
    assert away(driver, deeper[:, Path(body.T).contains_points(deeper.T)]).max() > chord  # what the test can see
