"""Tables of bands over the face: order of rows, extremes with their places and errors, remarks, refusals, forecast."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.results.gear import stiffness_over_face as module
from fegear.results.gear.stiffness_over_face import SOLID_STIFFNESS

C_SELF = np.array([[3.0, 1.0, 2.0], [5.0, 4.0, 6.0]])
TENSION = np.array([[1.0, 2.0, 3.0], [9.0, 4.0, 2.0]])


def table(**given):
    root = {"tension": Space(value=TENSION), "compression": Space(value=-3.0 * TENSION)}
    errors = {"c_self": 0.01 * C_SELF, "root_tension": 0.1 * TENSION, "root_compression": 0.2 * TENSION}
    usual = {
        "c_self": C_SELF, "root": root, "errors": errors, "radius": np.array([40e-3, 42e-3]),
        "position": np.array([-8e-3, 0.0, 8e-3]), "pressed_half_width": np.array([0.1e-3, 0.2e-3]),
        "before": np.array([0.0, 1e-3, 2e-3]), "after": np.array([3e-3, 1e-3, 0.0]),
    }  # fmt: skip
    return Space(**usual | given)


def seen(**given):
    data = table(**given)
    return Space(name="p", data=data, find=lambda of: data.root[of.removeprefix("root.")] if of else data,
                 asked=Space(tolerance=0.01))  # fmt: skip


EXTREMES = [
    ("largest_band_c_self", (1, 2), 6.0, 0.06), ("smallest_band_c_self", (0, 1), 1.0, 0.01),
    ("largest_band_root_tension", (1, 0), 9.0, 0.9), ("largest_band_root_compression", (1, 0), -27.0, 1.8),
]  # fmt: skip


@pytest.mark.parametrize(("name", "at", "value", "error"), EXTREMES)
def test_extremes_have_the_error_and_the_place_of_their_own_band(name, at, value, error):
    (one,) = (number for number in module._SHEET.values if number.name == name)
    given = seen()
    assert one.si(given) == value
    assert one.error(given) == pytest.approx(error)
    radius, place = (40, 42)[at[0]], (-8, 0, 8)[at[1]]
    assert one.meaning(given) == f"per force on a band at radius {radius} mm, face position {place} mm"


@pytest.mark.parametrize(("name", "value"), [("largest_band_c_self", 7.0), ("smallest_band_c_self", 7.0)])
def test_of_equal_bands_the_first_is_named(name, value):
    (one,) = (number for number in module._SHEET.values if number.name == name)
    given = seen(c_self=np.full((2, 3), 7.0))
    assert one.si(given) == value
    assert one.meaning(given).endswith("radius 40 mm, face position -8 mm")


def test_rows_are_all_positions_of_each_radius_in_turn():
    given = seen()
    np.testing.assert_array_equal(module._over_positions("radius").si(given), [40e-3] * 3 + [42e-3] * 3)
    np.testing.assert_array_equal(module._over_radii("position").si(given), [-8e-3, 0.0, 8e-3] * 2)
    np.testing.assert_array_equal(module._flat("c_self").si(given), [3.0, 1.0, 2.0, 5.0, 4.0, 6.0])
    np.testing.assert_array_equal(module._root("tension", "value", "root").si(given), TENSION.ravel())


def test_the_worst_band_is_one_with_room_for_the_whole_pressure():
    tension = {"tension": Space(value=np.array([[50.0, 2.0], [3.0, 7.0], [9.0, 8.0]]))}
    narrow = table(root=tension, pressed_half_width=np.array([0.1, 0.2, 0.2 * 0.9991]))
    assert module.worst_band(narrow) == (2, 0)
    assert module.worst_band(table(root=tension, pressed_half_width=np.array([0.1, 0.2, 0.2 * 0.9989]))) == (1, 1)
    assert module.worst_band(table(root=tension, pressed_half_width=np.array([0.2, 0.2, 0.2]))) == (0, 0)


@pytest.mark.parametrize(("count", "drawn"), [(1, [0]), (3, [0, 1, 2]), (5, [0, 1, 2, 3, 4]), (9, [0, 2, 4, 6, 8])])
def test_no_more_than_five_bands_are_drawn_the_ends_among_them(count, drawn):
    assert module._bands_drawn(seen(position=np.zeros(count))) == drawn


def test_a_remark_says_what_a_band_is():
    assert module._bands(seen()) == (
        "Gear p over its face: each load patch is triangular along the contact line, 3 mm to either side (shorter at "
        "the face ends). c_self is for the contact half-width; neighbours and root stress are for a pressure "
        "half-width of 0.1 to 0.2 mm."
    )


def test_each_quantity_is_judged_by_its_largest_relative_error_at_every_radius(monkeypatch):
    told = []
    monkeypatch.setattr(module, "tolerance_remarks", lambda *given: told.append(given) or [f"of {given[1]}"])
    assert module._missed(seen()) == ["of c_self", "of root_tension", "of root_compression"]
    for (who, label, worst, radius, tolerance, word), relative in zip(told, (0.01, 0.1, 0.2 / 3.0), strict=True):
        assert (who, tolerance, word) == ("Gear p over its face", 0.01, "radii"), label
        np.testing.assert_allclose(worst, [relative, relative])
        np.testing.assert_array_equal(radius, [40e-3, 42e-3])


def scene(positions, gear=None, radii=6):
    part = Space(face_positions=positions, gear=gear, band_radii=radii, source="source")
    return Space(case=Space(stiffness=part), gears={"p": Space(face_width=20e-3), "w": Space(face_width=30e-3)})


def test_gears_are_those_that_are_named_or_all():
    subjects = SOLID_STIFFNESS.subjects
    assert subjects(scene(None)) == ()
    assert subjects(scene(3)) == ("p", "w")
    assert subjects(scene([0.0], "w")) == ("w",)


@pytest.mark.parametrize(("positions", "bands"), [(5, 30), ([0.0, 1e-3], 12), (None, 0)])
def test_a_forecast_counts_the_bands(positions, bands):
    found = SOLID_STIFFNESS.forecast(scene(positions), "p")
    assert found.settings == {"bands": bands}
    assert found.seconds == pytest.approx(module._SECONDS_OF_TABLE + module._SECONDS_PER_BAND * bands)


@pytest.mark.parametrize(
    ("positions", "wrong"), [([0.0, 10e-3, -10e-3], None), ([0.0, 10.1e-3], 1), ([-10.1e-3], 0), (7, None)]
)
def test_places_beyond_the_face_are_refused_by_their_number(monkeypatch, positions, wrong):
    monkeypatch.setattr(module, "check_contacts_of", lambda scene, name: {"p": None}[name])
    monkeypatch.setattr(module, "check_source", lambda scene, name, key, source: {
        ("p", "stiffness.source", "source"): None}[name, key, source])  # fmt: skip
    if wrong is None:
        SOLID_STIFFNESS.check(scene(positions), "p")
        return
    with pytest.raises(InputError, match=rf"face_positions\[{wrong}\].*-10 mm to 10 mm"):
        SOLID_STIFFNESS.check(scene(positions), "p")
