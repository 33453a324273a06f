"""Strain in motion: what is computed of which teeth, half bridges beside their second gauge, and what is neglected."""

from __future__ import annotations

import sys
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.engine.stage import Task
from fegear.results.train import dynamic_strain

EFFECTS = "effects of the case"
UPSTREAM = {
    Task("tooth-force", "m"): Space(
        train=Space(exciters=["m"], meshes={"x": Space(force=300.0)}), mesh="x",
    ),
}  # fmt: skip


class Strain:
    """Of one gauge, or what a half bridge sees of two."""

    def __init__(self, name):
        self.name, self.speed, self.member = name, 70.0, "driver"
        self.angle, self.total = f"angle of {name}", f"total of {name}"
        self.static = np.array([1e-3, -4e-3, 2e-3])
        gears = {"driver": Space(teeth=21), "driven": Space(teeth=53)}
        self.pair = Space(gear=gears.get, mate=lambda member: gears["driven" if member == "driver" else "driver"],
                          driver=Space(base_radius=0.05))  # fmt: skip

    def less(self, other):
        return Strain(f"{self.name} - {other.name}")

    def less_displaced(self, other):
        return f"displaced {self.name} - {other.name}"


class With:
    """Strain with an effect."""

    def __init__(self, change):
        self.change = change

    def less(self, other, peak):
        assert peak == 4e-3
        return With(10.0 * (self.change - other.change))


def gauge(**given):
    usual = {"second": "", "trace_speed": None, "load_tolerance": 0.02, "side": "tension", "over_time": False}
    return Space(**usual | given)


def inputs(**given):
    usual = {"gauge": gauge(), "mesh": "m", "wide": False, "neglected": False, "tolerance": 0.01, "in_bridge": False,
             "sharper": "sharper", "off": EFFECTS}  # fmt: skip
    return Space(**usual | given)


@pytest.fixture
def asked(monkeypatch):
    """What the parts of a comparison are given."""
    found = {}

    def told(name, answer):
        def one(*given):
            found[name] = given
            return answer

        monkeypatch.setattr(dynamic_strain, name, one)

    told("_in_plane", Strain("plane"))
    told("_on_face", Strain("face"))
    told("compared", "measured")
    told("better_described", "better")
    told("behind_low_pass", "low pass")
    told("_neglected_of", {"friction": With(0.2), "plain": With(0.009), "holes": With(-0.011)})
    monkeypatch.setattr(dynamic_strain, "including", lambda names, off: (list(names), off))
    return found


@pytest.mark.parametrize(("wide", "name"), [(False, "plane"), (True, "face")])
@pytest.mark.parametrize("speed", [None, 90.0])
def test_a_trace_is_compared_with_the_strain_of_its_kind_of_teeth_at_its_own_speed(asked, wide, name, speed):
    one = inputs(wide=wide, gauge=gauge(trace_speed=speed))
    found = dynamic_strain._compute(one, UPSTREAM, None)
    assert found.found.name == name
    force = UPSTREAM[Task("tooth-force", "m")]
    assert asked["_on_face" if wide else "_in_plane"] == (one, UPSTREAM, force)
    curve = f"angle of {name}", f"total of {name}"
    assert asked["compared"] == (one.gauge, *curve, speed or 70.0)
    assert asked["better_described"] == (one.gauge, "measured", found.found.pair, *curve)
    assert asked["behind_low_pass"] == (one.gauge, "measured", "better", *curve)
    other = found.otherwise
    assert (other.better, other.side, other.teeth, other.mate_teeth) == ("better", "tension", 21, 53)
    assert (other.low_pass, other.speed, other.second, other.over_time) == ("low pass", speed or 70.0, "", False)
    assert (found.sharper, found.seen, found.displaced_second) == ("sharper" if wide else "", None, None)
    assert (found.neglected, found.including) == ({}, ([], EFFECTS))
    assert found.torque == pytest.approx(300.0 * 0.05)
    assert found.alone is True


def test_other_exciters_are_no_mesh_alone(asked):
    more = {Task("tooth-force", "m"): Space(
        train=Space(exciters=["m", "n"], meshes={"x": Space(force=1.0)}), mesh="x",
    )}  # fmt: skip
    assert dynamic_strain._compute(inputs(), more, None).alone is False


def test_effects_that_change_more_than_the_tolerance_are_said_and_taken_from_the_trace(asked):
    found = dynamic_strain._compute(inputs(neglected=True), UPSTREAM, None)
    assert asked["_neglected_of"] == (inputs(neglected=True), UPSTREAM)
    assert found.neglected == {"friction": 0.2, "holes": -0.011}
    assert found.including == (["friction", "holes"], EFFECTS)
    assert found.gains == pytest.approx({"friction": 1.0 / 1.2 - 1.0, "holes": 1.0 / 0.989 - 1.0})
    assert found.with_effects == {}
    bridge = dynamic_strain._compute(inputs(neglected=True, in_bridge=True), UPSTREAM, None)
    assert {name: one.change for name, one in bridge.with_effects.items()} == {
        "friction": 0.2, "plain": 0.009, "holes": -0.011,
    }  # fmt: skip


def test_a_half_bridge_sees_the_difference_of_both_gauges(asked):
    second = Space(found=Strain("second"), with_effects={"friction": With(0.1), "plain": With(0.0)})
    upstream = UPSTREAM | {Task("dynamic-strain", "g2"): second}
    one = inputs(gauge=gauge(second="g2", over_time=True), neglected=True)
    found = dynamic_strain._compute(one, upstream, None)
    assert (found.found.name, found.seen.name) == ("plane", "plane - second")
    assert found.displaced_second == "displaced plane - second"
    assert asked["compared"][1:] == ("angle of plane - second", "total of plane - second", 70.0)
    assert (found.otherwise.second, found.otherwise.over_time) == ("g2", True)
    # alone each effect changes its own gauge; of what the bridge sees the difference counts
    assert found.neglected == {"friction": 0.2, "holes": -0.011}
    assert found.gains == pytest.approx({"friction": 1.0 / 2.0 - 1.0, "plain": 1.0 / 1.09 - 1.0})
    assert found.including == (["friction", "holes", "plain"], EFFECTS)


def test_effects_that_are_off_are_looked_at_on_the_teeth_of_the_gauge(monkeypatch):
    at = Space(pair="I", gear="p", member="driver", side="tension", grid="grid", z=0.004, tooth=5)
    wide = Space(pair=Space(gear=lambda member: f"gear of {member}"))

    def of(answers):
        def one(*given):
            return answers[given]

        return one

    monkeypatch.setattr(dynamic_strain, "loaded_teeth", of({("up", "I"): wide}))
    monkeypatch.setattr(dynamic_strain, "solid_solution_of", of({("up", "p"): "body"}))
    place = Space(middle=0.7, displacement=np.array([-2e-4, 1e-5, 3e-4]))
    placed = {(id(at), "body", "gear of driver"): place}
    monkeypatch.setattr(dynamic_strain, "placed_on_face", lambda gauge, body, gear: placed[id(gauge), body, gear])
    face = Space(wide_gauge_neglects=lambda *given: ("on face", *given))
    monkeypatch.setitem(sys.modules, "fegear.contact.wide.gauge_on_face", face)
    assert dynamic_strain._neglected_of(inputs(gauge=at, wide=True), "up") == (
        "on face", wide, "driver", "tension", "grid", 0.7, 0.004, "body",
    )  # fmt: skip

    teeth = Space(spec="spec", engagement="engagement")
    monkeypatch.setattr(dynamic_strain, "loaded_pair", of({("up", "I"): teeth}))
    monkeypatch.setattr(dynamic_strain, "solution_of", of({("up", "p"): "solved"}))
    monkeypatch.setattr(dynamic_strain, "placed_gauge", lambda gauge, solved: {(id(at), "solved"): place}[
        id(gauge), solved])  # fmt: skip
    grids = Space(only=lambda number: ("grid", number))
    monkeypatch.setattr(dynamic_strain, "gauges_on", lambda gauge, there, solved: {
        (id(at), id(place), "solved"): (grids, "opposite")}[id(gauge), id(there), solved])  # fmt: skip
    plane = Space(gauge_neglects=lambda *given: ("in plane", *given))
    monkeypatch.setitem(sys.modules, "fegear.contact.plane.gauge_history", plane)
    assert dynamic_strain._neglected_of(inputs(gauge=at), "up") == (
        "in plane", "spec", "engagement", "driver", ("grid", 1), "opposite", 5,
    )  # fmt: skip


@pytest.mark.parametrize(("pitches", "number"), [(1, 0), (53, 5)])
def test_teeth_have_numbers_where_the_error_does_not_repeat_with_each(monkeypatch, pitches, number):
    at = Space(gear="p", member="driver", tooth=5)
    mesh = Space(error=Space(pitches=pitches), role=lambda member: f"role of {member}")
    force = Space(train=Space(meshes={"x": mesh}), mesh="x", harmonics=9)
    place = Space(displacement="displacement")
    monkeypatch.setattr(dynamic_strain, "solution_of", lambda up, gear: (up, gear))
    monkeypatch.setattr(dynamic_strain, "placed_gauge", lambda gauge, solved: place)
    monkeypatch.setattr(dynamic_strain, "gauges_on", lambda gauge, there, solved: (("grids", *solved), "opposite"))
    module = Space(tooth_strain=lambda *given, **named: (given, named))
    monkeypatch.setitem(sys.modules, "fegear.dynamics.train.tooth_strain", module)
    one = inputs(gauge=at, speed=80.0, positions=64, coupled=True, effects=EFFECTS)
    given, named = dynamic_strain._in_plane(one, "up", force)
    assert given == (force.train, "x", "role of driver", ("grids", "up", "p"), "displacement", 80.0, 64, 9, number)
    assert named == {"coupled": True, "effects": EFFECTS}


@pytest.mark.parametrize(("halves", "load", "wanted"), [(1, 300.0, 300.0), (2, 300.0, 150.0), (1, 0.0, 222.0)])
def test_on_the_face_a_strain_is_about_the_load_of_its_half(monkeypatch, halves, load, wanted):
    at = Space(pair="I", gear="p", member="driven", side="compression", grid="grid", z=0.004)
    mesh = Space(force=load, role=lambda member: f"role of {member}")
    force = Space(train=Space(meshes={"x": mesh}), mesh="x", harmonics=9)
    teeth = Space(pair=Space(gear=lambda member: f"gear of {member}"), nominal=222.0)
    place = Space(middle=0.7, displacement="displacement")
    monkeypatch.setattr(dynamic_strain, "solid_solution_of", lambda up, gear: (up, gear))
    monkeypatch.setattr(dynamic_strain, "loaded_teeth", lambda up, pair: {("up", "I"): teeth}[up, pair])
    monkeypatch.setattr(dynamic_strain, "placed_on_face", lambda gauge, solved, gear: {
        (("up", "p"), "gear of driven"): place}[solved, gear])  # fmt: skip
    face = Space(gauge_about_load=lambda *given: given)
    monkeypatch.setitem(sys.modules, "fegear.contact.wide.gauge_on_face", face)
    module = Space(strain_on_face=lambda *given: given)
    monkeypatch.setitem(sys.modules, "fegear.dynamics.train.tooth_strain", module)
    found = dynamic_strain._on_face(inputs(gauge=at, halves=halves, speed=80.0, positions=64), "up", force)
    known = (teeth, "driven", "compression", "grid", 0.7, "displacement", 0.004, ("up", "p"), wanted)
    assert found == (force.train, "x", "role of driven", known, "displacement", 80.0, 64, 9)
