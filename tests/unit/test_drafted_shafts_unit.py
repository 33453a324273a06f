"""Shafts of drafted gearboxes: where gears and bearings are, which forces they carry, and the text that says so."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace

import pytest

from fegear.case.drafts import placed_shafts
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.placed_shafts import ChosenBearing, PlacedShaft, placed_shaft
from fegear.case.drafts.shafts_text import amount, length, shafts_text
from fegear.case.drafts.stage_sizes import mesh_forces, pitch_radii, root_radii
from fegear.case.drafts.stages import gears_on_shafts, staged
from fegear.shafts.bearing_seat import SHOULDER

KINDS = {"gearbox": [0], "two-stage-gearbox": [0, 1], "three-stage-gearbox": [0, 2, 1]}


@pytest.fixture(scope="module", params=KINDS)
def laid(request):
    return staged(Answers(request.param, {})), KINDS[request.param]


def names_of(found) -> list[str]:
    return [f"g{n}" for n in range(2 * len(found.stages))]


def mm(text: str) -> float:
    number, unit = text.split()
    assert unit == "mm"
    return float(number)


def test_faces_follow_each_other_between_the_bearings(laid):
    found, order = laid
    last = found.stages[-1].si("module")
    width = max(one.width for shaft in found.shafts for one in shaft.bearings.values())
    assert found.first == pytest.approx(0.5 * width)
    at = width + 2.0 * last
    for n, stage in enumerate(order):
        face = found.stages[stage].si("face_width")
        assert found.middles[stage] == pytest.approx(at + (3.0 * last if n else 0.0) + 0.5 * face)
        at = found.middles[stage] + 0.5 * face
    beside = found.middles[0] + 0.5 * found.stages[0].si("face_width")  # the first shaft ends beside its pinion
    assert list(found.last) == pytest.approx([one + 2.0 * last + 0.5 * width for one in [beside] + len(order) * [at]])
    for n in range(len(found.shafts)):
        assert found.seats(n).length == pytest.approx(found.last[n] + 0.5 * width)
    assert [sum(pitch_radii(one)) for one in found.stages] == pytest.approx(list(found.distances))


def test_holes_are_those_of_the_shafts_or_as_large_as_the_roots_allow(laid):
    found, _ = laid
    roots = [one for stage in found.stages for one in root_radii(stage)]
    thick = [found.shafts[n // 2 + n % 2].thick for n in range(len(roots))]  # a wheel is on the next shaft
    for hole, cut, root, shaft in zip(found.holes, found.cut, roots, thick, strict=True):
        assert hole == pytest.approx(min(0.5 * shaft, 0.65 * root))
        assert cut == (0.5 * shaft > 0.65 * root)


def test_each_bearing_lasts_under_the_forces_of_its_shaft(laid):
    found, _ = laid
    life, speed, torque = found.stages[0].si("life"), [], []
    for stage in found.stages:
        speed.append(stage.si("speed"))
        torque.append(stage.si("torque"))
    z, other = map(int, found.stages[-1].numbers("teeth"))
    speed.append(speed[-1] * z / other)
    for n, (shaft, gears) in enumerate(zip(found.shafts, gears_on_shafts(len(found.stages)), strict=True)):
        tangent, apart, tilt, axial = [0.0, 0.0], [0.0, 0.0], 0.0, 0.0
        span = found.last[n] - found.first
        for stage, member in gears:
            t, r, a = mesh_forces(found.stages[stage], torque[stage])
            right = (found.middles[stage] - found.first) / span
            side = -1.0 if member else 1.0
            tangent = [tangent[0] + t * (1.0 - right), tangent[1] + t * right]
            apart = [apart[0] + side * r * (1.0 - right), apart[1] + side * r * right]
            tilt += a * pitch_radii(found.stages[stage])[member] / span
            axial += side * a
        radial = [math.hypot(t, abs(r) + tilt) for t, r in zip(tangent, apart, strict=True)]
        wanted = 1.25 * life * speed[n] / (2.0 * math.pi)
        for (role, bearing), force in zip(shaft.bearings.items(), radial, strict=True):
            along = 0.0 if role == "floating" else abs(axial)
            lasting = bearing.rating.revolutions(max(radial) if shaft.tapered else force, along)
            assert lasting >= wanted * (1.0 - 1e-6) or not shaft.lasts
        if not shaft.tapered:  # what locates is where the radial force is less
            assert (next(iter(shaft.bearings)) == "locating") == (radial[0] <= radial[1])
        assert shaft.thick >= math.ceil(SHOULDER * shaft.seat * 1e3) * 1e-3 - 1e-9 or shaft.tapered


def test_the_text_has_the_lengths_the_places_and_the_bearings(laid):
    found, _ = laid
    text = shafts_text(found, names_of(found))
    case = tomllib.loads(text)
    shafts, bearings = case["shaft"], case["bearing"]
    stages = len(found.stages)
    assert list(shafts) == ["input", *{1: [], 2: ["middle"], 3: ["middle_1", "middle_2"]}[stages], "output"]
    away = 0.0
    for n, (name, shaft) in enumerate(shafts.items()):
        made = found.shafts[n]
        assert shaft["sections"] == shaft["sections"][::-1]
        seat, between = shaft["sections"][0], shaft["sections"][len(shaft["sections"]) // 2]
        assert mm(seat["length"]) == pytest.approx(2e3 * found.first, rel=1e-5)
        long = 1e3 * (found.last[n] + found.first)
        assert sum(mm(one["length"]) for one in shaft["sections"]) == pytest.approx(long, rel=1e-5)
        assert [mm(seat["outer"]), mm(between["outer"])] == pytest.approx([1e3 * made.seat, 1e3 * made.thick], rel=1e-5)
        assert mm(shaft.get("axis", ["0 mm"])[0]) == pytest.approx(1e3 * away, rel=1e-5)
        assert shaft.get("axis", ["", "0 mm"])[1] == "0 mm"
        away += found.distances[n] if n < stages else 0.0
        wheel = [(f"g{2 * n - 1}", n - 1)] if n else []
        pinion = [(f"g{2 * n}", n)] if n < stages else []
        assert [one["gear"] for one in shaft["gears"]] == [gear for gear, _ in wheel + pinion]
        places = [1e3 * found.middles[stage] for _, stage in wheel + pinion]
        assert [mm(one["at"]) for one in shaft["gears"]] == pytest.approx(places, rel=1e-5)
        assert [mm(one["at"]) for one in shaft["bearings"]] == pytest.approx(
            [1e3 * found.first, 1e3 * found.last[n]], rel=1e-5
        )
        assert [one["bearing"] for one in shaft["bearings"]] == [f"{name}_{role}" for role in made.bearings]
        assert [one.get("reversed", False) for one in shaft["bearings"]] == [False, made.tapered]
        assert shaft.get("coupling") == {0: "0 mm", stages: length(found.last[n] + found.first)}.get(n)
        for role, one in made.bearings.items():
            assert bearings[f"{name}_{role}"] == {"designation": one.designation, "life": {}}
    # what locates a shaft comes first, wherever it is
    roles = [name.rpartition("_")[2] for name in bearings]
    assert list(zip(roles[::2], roles[1::2], strict=True)) == [
        ("left", "right") if one.tapered else ("locating", "floating") for one in found.shafts
    ]
    assert text.count("distances along it from its left end") == text.count("# clockwise = true") == 1
    assert text.index("distances along it") < text.index("# clockwise = true") < text.index("[shaft.output]")
    assert ("Tapered bearings against each other" in text) == any(one.tapered for one in found.shafts)
    rated = {name: text.split(f"[bearing.{name}]")[1].split("# ")[1].partition(" of the")[0] for name in bearings}
    assert rated == {name: "C" if name.endswith("floating") else "C, X, Y and e" for name in bearings}


def test_bearings_that_do_not_last_or_are_not_tabulated_are_said_to_be_so(laid):
    found, _ = laid
    small = ChosenBearing("", None, 8e-3, 3.2e-3, 16e-3)
    assumed = PlacedShaft(8e-3, 10e-3, {"locating": small, "floating": small})
    made = replace(found, shafts=(assumed, replace(found.shafts[1], lasts=False), *found.shafts[2:]))
    text = shafts_text(made, names_of(found))
    bearings = tomllib.loads(text)["bearing"]
    assert bearings["input_locating"] == {"radial": "56 N/um", "fixed": True}
    assert bearings["input_floating"] == {"radial": "56 N/um"}
    assert text.count("shorter life: none within the root circle lasts as long") == len(found.shafts[1].bearings)


def test_lengths_have_six_digits_and_amounts_two():
    assert [length(0.1234567891), length(2e-7)] == ["123.457 mm", "0.0002 mm"]
    assert [amount(1.26e8, "N/um"), amount(7e9 * 0.0351, "N/um"), amount(9.96, "N")] == ["130 N/um", "250 N/um", "10 N"]


def test_the_forces_of_two_meshes_on_a_shaft_are_in_balance(monkeypatch):
    seen = []

    def located(seat, forces):
        seen.append((seat, forces))
        return PlacedShaft(seat, 0.0, {}) if len(seen) == 4 else None

    monkeypatch.setattr(placed_shafts, "_located", located)
    monkeypatch.setattr(placed_shafts, "_adjusted", lambda *_: None)
    meshes = [(0.5, 400.0, 100.0, 200.0, 0.1, 1.0), (1.0, 100.0, 60.0, 50.0, 0.2, -1.0)]
    found = placed_shaft(0.09, 2.0 * math.pi, 0.0583 * SHOULDER, meshes, 2.0, 1e6)
    assert found == PlacedShaft(0.055, 0.0, {}, lasts=False)  # the largest seat of 5 mm with a shoulder below the root
    seat, forces = seen[0]
    assert seat == pytest.approx(0.055)
    # tangential 300 + 50 and 100 + 50; radial 75 - 30 and 25 - 30; axial (200 x 0.1 + 50 x 0.2)/2 about the shaft
    wanted = (math.hypot(350.0, 45.0 + 15.0), math.hypot(150.0, 5.0 + 15.0), 150.0, 1.25e6, 0.0583 * SHOULDER)
    assert forces == pytest.approx(wanted)
    assert [one.rolls for _, one in seen] == pytest.approx([1.25e6, 0.625e6, 0.3125e6, 0.15625e6])
    assert {one[:3] for _, one in seen} == {forces[:3]}
    seen[:] = [None] * 3  # the first that is tried suffices
    assert placed_shaft(0.12, 1.0, 1.0, meshes, 2.0, 1e6) == PlacedShaft(0.1, 0.0, {}, lasts=True)


def test_what_no_table_has_is_assumed():
    found = placed_shaft(0.02, 1.0, 0.01, [(0.5, 400.0, 100.0, 200.0, 0.1, 1.0)], 1.0, 1e6)
    assert (found.seat, found.thick, found.tapered) == (pytest.approx(8e-3), 0.01, False)
    assert list(found.bearings) == ["locating", "floating"]
    for one in found.bearings.values():
        assert (one.designation, one.rating) == ("", None)
        assert (one.bore, one.width, one.outside) == pytest.approx((8e-3, 3.2e-3, 16e-3))


def test_tapered_bearings_are_chosen_where_no_other_fits_the_root():
    """The smallest bore, then the lightest series, that lasts with what its mate induces."""
    mesh = [(0.5, 4000.0, 1000.0, 900.0, 0.1, 1.0)]
    radial = math.hypot(2000.0, 500.0 + 90.0)
    for root in (0.036, 0.042, 0.05):
        found = placed_shaft(0.02, 20.0, root, mesh, 1.0, 3.6e7)
        if not found.tapered:
            continue
        assert found.bearings["left"] == found.bearings["right"]
        rolls = 1.25 * 3.6e7 * 20.0 / (2.0 * math.pi)
        tried = [f"{series}{n:02d}" for n in range(4, 21) for series in ("302", "322", "303", "323")]
        known = [placed_shafts._known(one) for one in tried if 5e-3 * int(one[3:]) * SHOULDER <= root]
        fits = [
            one for one in known
            if one.rating.revolutions(radial, 900.0 + 0.5 * radial / one.rating.axial.at(0.0)[1]) >= rolls
        ]  # fmt: skip
        if found.lasts:
            assert found.bearings["left"].designation == fits[0].designation
        assert found.thick <= root
