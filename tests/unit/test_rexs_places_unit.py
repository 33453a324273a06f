"""Shafts of a REXS stage are put at its centre distance, or must stand there; the model is made up."""

import math
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.exchange.rexs import places
from fegear.exchange.rexs.places import Place, _place_stage

DISTANCE, TURN = 0.1, math.radians(30.0)


@pytest.fixture
def stage(monkeypatch):
    """A stage of gears 1 and 2 on shafts 11 and 12; what the model says of it can be changed."""
    one = SimpleNamespace(
        component=SimpleNamespace(said="cylindrical_stage 5"),
        gears=(SimpleNamespace(id=1), SimpleNamespace(id=2)), distance=DISTANCE, turn=TURN, shafts={1: 11, 2: 12},
        reversed={11: False, 12: False},
    )  # fmt: skip

    def shaft(said, gear):
        number = one.shafts[gear.id]
        return number and SimpleNamespace(id=number, said=f"shaft {number}")

    monkeypatch.setattr(places, "shaft_of", shaft)
    monkeypatch.setattr(places, "_own_distance", lambda said, stage: one.distance)
    monkeypatch.setattr(places, "direction", lambda said, shaft: one.reversed[shaft.id])
    return one


def placed(stage, found, middles=None):
    said = SimpleNamespace(notes=[], number=lambda component, quantity, name: stage.turn)
    _place_stage(said, stage, found, {1: 0.05, 2: 0.02} if middles is None else middles)
    return found, said.notes


def test_the_first_shaft_of_all_stands_in_the_origin_and_the_second_at_the_distance(stage):
    found, notes = placed(stage, {})
    assert found[11] == Place(0.0, 0.0, 0.0)
    # w is the angle's zero, and both gears meet in one plane across the axes.
    assert (found[12].v, found[12].w) == pytest.approx((0.05, 0.1 * math.cos(TURN)))
    assert found[12].u == pytest.approx(0.05 - 0.02)
    assert notes == ["shaft 12: no support_vector; positioned by cylindrical_stage 5."]
    stage.reversed[12] = True
    assert placed(stage, {})[0][12] == Place(pytest.approx(0.05 + 0.02), found[12].v, found[12].w, True)


def test_a_shaft_is_put_beside_the_one_that_is_known_whichever_it_is(stage):
    known = Place(0.3, 0.2, -0.1, True)
    found, notes = placed(stage, {12: known})
    assert found[12] is known
    assert (found[11].v, found[11].w) == pytest.approx((0.2 - 0.05, -0.1 - 0.1 * math.cos(TURN)))
    assert found[11].u == pytest.approx(0.3 - 0.02 - 0.05)
    assert notes[0].startswith("shaft 11: ")
    stage.turn = None  # an angle of zero
    assert placed(stage, {11: Place(0.0, 0.0, 0.0)}, {})[0][12] == Place(0.0, 0.0, 0.1)


@pytest.mark.parametrize("off", [0.0, 0.9e-4, -0.9e-4])
def test_places_that_are_rounded_are_put_at_the_distance_that_is_said(stage, off):
    apart = DISTANCE + off
    start = {11: Place(0.1, 0.01, 0.02), 12: Place(0.2, 0.01 + 0.6 * apart, 0.02 + 0.8 * apart, True)}
    found, notes = placed(stage, dict(start))
    assert found[11] == start[11]
    assert (found[12].v, found[12].w) == pytest.approx((0.01 + 0.06, 0.02 + 0.08), rel=1e-12)
    assert (found[12].u, found[12].reversed) == (0.2, True)
    assert notes == []


@pytest.mark.parametrize("off", [1.1e-4, -1.1e-4, 0.08])
def test_places_that_contradict_the_distance_are_refused_with_both(stage, off):
    there = {11: Place(0.0, 0.0, 0.0), 12: Place(0.0, 0.0, DISTANCE + off)}
    with pytest.raises(
        InputError, match=rf"100 mm: of .*contradicts the distance of its shafts, {1e3 * (0.1 + off):.6g} mm"
    ):
        placed(stage, there)
    stage.distance = None
    assert placed(stage, dict(there))[0] == there


def test_a_stage_whose_gears_are_on_no_shaft_puts_nothing_and_one_without_distance_is_refused(stage):
    stage.distance = None
    with pytest.raises(InputError, match="is missing in cylindrical_stage 5"):
        placed(stage, {11: Place(0.0, 0.0, 0.0)})
    stage.shafts[2] = None
    assert placed(stage, {})[0] == {}
