"""What is sent to a page: packed numbers, units, factors of drawing, fewer points along fillets, maps of loads."""

import base64
import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.engine.stage import Task
from fegear.window import on_gears, order
from fegear.window.on_gears import millimetres, on_the_gears, packed, round_factor
from fegear.window.order import HarrisMaps


def unpacked(sent):
    """As the page reads it: steps of sixteen bits, the lowest for none."""
    steps = np.frombuffer(base64.b64decode(sent["data"]), dtype="<i2").reshape(sent["shape"])
    return np.where(steps == -32768, np.nan, steps * sent["step"])


def test_numbers_are_sixteen_bit_steps_of_the_largest():
    values = np.array([[1.0, -2.0, np.nan], [0.5, 1.9999, 0.0]])
    sent = packed(values)
    assert (sent["shape"], sent["step"]) == ([2, 3], 2.0 / 32767)
    np.testing.assert_allclose(unpacked(sent), values, atol=0.5 * 2.0 / 32767)
    assert packed(np.zeros(3))["step"] == 1.0
    assert millimetres(np.array([1.23456789e-3, -2e-8])) == [1.2346, -0.0]


@pytest.mark.parametrize(
    ("value", "most", "factor"),
    [(0.3, 1000.0, 1.0), (1.0, 1000.0, 1.0), (1.99, 1000.0, 1.0), (2.0, 1000.0, 2.0), (4.9, 1000.0, 2.0),
     (5.0, 1000.0, 5.0), (73.0, 1000.0, 50.0), (999.0, 1000.0, 500.0), (5e6, 1000.0, 1000.0), (3e6, 1e6, 1e6)],
)  # fmt: skip
def test_a_factor_of_drawing_is_1_2_or_5_times_a_power_of_ten(value, most, factor):
    assert round_factor(value, most) == factor
    if most == 1000.0:
        assert round_factor(value) == factor


def test_fillets_have_25_places_evenly_along_them():
    x = np.linspace(0.0, 3.0, 61) ** 1.5
    places = np.stack([np.stack([x, 2.0 * x]), np.stack([x + 1.0, 2.0 * x])])
    stress = np.stack([np.stack([3.0 * x, -x]), np.stack([x, 5.0 * x])])
    at, values = on_gears._along(places, stress)
    assert (at.shape, values.shape) == ((2, 2, 25), (2, 2, 25))
    arc = np.hypot(at[0, 0] - at[0, 0, 0], at[0, 1] - at[0, 1, 0])
    np.testing.assert_allclose(np.diff(arc), arc[-1] / 24.0)
    np.testing.assert_allclose(at[0, 0, [0, -1]], x[[0, -1]])
    np.testing.assert_allclose(values[0, 0], 3.0 * at[0, 0], rtol=1e-9)
    np.testing.assert_allclose(values[1, 1], 5.0 * at[0, 0], rtol=1e-9)


PAIR = SimpleNamespace(
    base_pitch=8e-3, x_start=-5e-3,
    driver=SimpleNamespace(module=3e-3, form_radius=1e-3, tip_radius=2e-3, pitch_radius=1.5e-3),
    driven=SimpleNamespace(module=3e-3, form_radius=4e-3, tip_radius=6e-3, pitch_radius=5e-3),
)  # fmt: skip


def test_colours_of_fillets_are_in_megapascals_and_places_in_the_pitch():
    x = np.linspace(0.0, 1e-3, 40)
    places = np.stack([x, x])[None]
    stress = np.full((2, 1, 40), 4e7)
    stress[1, 0, 7] = -9e7
    gear = SimpleNamespace(places={"tension": places}, stress={"tension": stress})
    data = SimpleNamespace(
        pair=PAIR, roll=np.array([-5e-3, -1e-3]), pairs=np.array([0, 1]), gears={"driver": gear}, z=np.empty(0),
        largest=SimpleNamespace(value=9e7, member="driver", pair=1, roll=-1e-3, place=np.array([1e-3, 2e-3]),
                                radius=0.03, z=0.5e-3),
    )  # fmt: skip
    sent = on_the_gears(Task("stress-in-mesh", "I"), data)
    assert (sent["pair"], sent["kind"], sent["roll"], sent["pairs"]) == ("I", "stress", [0.0, 0.5], [0, 1])
    assert sent["limit"] == pytest.approx(90.0)
    (fillet,) = sent["fillets"]
    assert fillet["member"] == "driver"
    assert unpacked(fillet["stress"]).shape == (2, 1, 25)
    assert unpacked(fillet["stress"])[0].max() == pytest.approx(40.0, rel=1e-4)
    assert sent["largest"] == {
        "value": pytest.approx(90.0), "member": "driver", "pair": 1, "roll": pytest.approx(-1.0),
        "x": pytest.approx(7.0), "place": [1.0, 2.0], "radius": pytest.approx(30.0), "z": pytest.approx(0.5), "at": 0.5,
    }  # fmt: skip
    # Of a gear with a width sections are few: they are sent as they are.
    data.z = np.array([-1e-3, 1e-3])
    assert unpacked(on_the_gears(Task("stress-in-mesh", "I"), data)["fillets"][0]["stress"]).shape == (2, 1, 40)


def test_deformed_teeth_are_drawn_a_tenth_of_a_module_wide():
    data = SimpleNamespace(
        pair=PAIR, roll=np.array([-3e-3]), pairs=np.array([0]), transmission_error=np.array([2.5e-6]), largest=1.2e-5,
        places={"driver": np.array([1e-3])}, moved={"driver": np.array([4e-6])},
    )  # fmt: skip
    sent = on_the_gears(Task("deformed-in-mesh", "I"), data)
    assert (sent["roll"], sent["ahead"], sent["largest"]) == ([0.25], [0.0025], pytest.approx(12.0))
    assert sent["factor"] == 20.0  # of 0.3 mm over 12 um, 25, the next round one below
    assert unpacked(sent["gears"]["driver"]["moved"])[0] == pytest.approx(4e-3)
    data.largest = 0.0
    assert on_the_gears(Task("deformed-in-mesh", "I"), data)["factor"] == 1.0
    assert on_the_gears(Task("geometry", ""), None) is None


def test_stress_inside_teeth_is_sent_per_load():
    table = SimpleNamespace(triangles=np.array([[0, 1, 2], [1, 2, 3]]), fillet=np.array([False, True, True, False]),
                            reach=2, stress=np.array([1.0, -0.5]), across=True)  # fmt: skip
    gear = SimpleNamespace(places=np.array([1e-3]), table=table, roll=np.array([2e-3]), per_load=3e6)
    sent = on_the_gears(Task("stress-inside", "I"), SimpleNamespace(gears={"driver": gear}))["gears"]["driver"]
    assert (sent["triangles"], sent["fillet"], sent["reach"]) == ([0, 1, 2, 1, 2, 3], [1, 2], 2)
    assert (sent["per_load"], sent["across"], sent["places"], sent["roll"]) == (pytest.approx(3.0), True, [1.0], [2.0])


def test_pressed_flanks_have_a_line_for_each_pair_at_each_position():
    lines = SimpleNamespace(
        z=np.array([[0.0, 1e-3, 2e-3]]), pair=np.array([[0, 0, 1]]), roll=np.array([-1e-3]), low=-1e-3, high=2e-3,
        at=lambda p: [slice(0, 2), slice(2, 3)], radius=lambda pair, member: np.array([[0.03, 0.031, 0.032]])
        + (0.01 if member == "driven" else 0.0),
    )  # fmt: skip
    found = SimpleNamespace(
        lines=lines, pair=PAIR, pressure=np.stack([np.zeros((1, 3)), np.array([[1e8, 2e8, 3e8]])], axis=2),
        smooth_pressure=np.stack([np.full((1, 3), 9e9), np.array([[1e8, 2.5e8, 2e8]])], axis=2),
        pair_numbers=np.array([0, 1]), share=np.stack([np.ones((2, 1)), np.array([[0.75], [0.25]])], axis=2),
        load=np.array([10.0, 400.0]),
    )  # fmt: skip
    sent = on_the_gears(Task("loaded-flanks", "I"), SimpleNamespace(found=found, at=1))
    first, second = sent["positions"][0]
    assert first == [0, [0.0, 1.0], [30.0, 31.0], [40.0, 41.0], [100.0, 200.0]]
    assert second == [1, [2.0], [32.0], [42.0], [300.0]]
    assert sent["ends"] == {"driver": pytest.approx([1.0, 2.0, 1.5]), "driven": pytest.approx([4.0, 6.0, 5.0])}
    assert (sent["roll"], sent["load"], sent["limit"]) == ([0.5], [[300.0], [100.0]], pytest.approx(250.0))
    assert (sent["low"], sent["high"], sent["pairs"]) == (-1.0, 2.0, [0, 1])


def test_a_slider_s_map_stays_until_the_load_is_beyond_twice_or_below_a_fiftieth(monkeypatch):
    asked = []
    monkeypatch.setattr(order, "teeth_of", lambda task, data: data)
    monkeypatch.setattr(order, "slider_map", lambda name, teeth, most: asked.append((name, most)) or SimpleNamespace(
        key="k", heading="h", caption="c"))  # fmt: skip
    monkeypatch.setattr(order, "plotly_json", lambda figure: {"data": []})
    monkeypatch.setattr(order, "darker", lambda figures: {})
    maps = HarrisMaps()

    def at_rest(load):
        teeth = SimpleNamespace(
            nominal=load, error_under=lambda loads, positions: (None, None, np.zeros((positions, len(loads))))
        )
        results = SimpleNamespace(scene=SimpleNamespace(case=SimpleNamespace(pair={}, gauge={}, encoders={})),
                                  outcomes={Task("loaded-pair", "I"): SimpleNamespace(data=teeth),
                                            Task("geometry", ""): SimpleNamespace(data=None)})  # fmt: skip
        (name,) = maps.at_rest(results)
        return name, asked[-1]

    for load, most in (
        (1000.0, 2000.0),
        (1999.0, 2000.0),
        (20.1, 2000.0),
        (2001.0, 4002.0),
        (40.1, 4002.0),
        (40.0, 80.0),
    ):
        assert at_rest(load) == ("I", ("I", pytest.approx(most)))


def test_the_present_load_s_curve_is_rounded(monkeypatch):
    monkeypatch.setattr(order, "load_now", lambda teeth: (900.0, np.array([1.23456789]), np.array([math.pi])))
    assert order.load_now_of("I", None) == {"pair": "I", "load": 900.0, "x": [1.234568], "te": [3.141593]}
