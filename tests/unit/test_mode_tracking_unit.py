"""Modes over a parameter as they are shown: units, meetings, branches that are there, and refusals; made-up modes."""

from __future__ import annotations

import math
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.results.helical import mode_tracking
from fegear.results.helical.mode_tracking import (
    INDICES,
    PARAMETERS,
    UNITS,
    AllFollowed,
    Followed,
    ParameterValue,
    _check,
    _forecast,
    _indices,
    _over,
    _pairs,
    _remarks,
    _response,
)

VALUES = np.array([1.0, 1.2, 1.4])


def followed(parameter="mu", values=VALUES, coupling=0.3, responses=()):
    ratio = np.array([[3.0, 2.0, 0.0], [3.1, 1.9, 0.0], [3.2, 1.8, 0.0]])
    indices = {key: np.full((3, 3), size) for (key, *_), size in zip(INDICES, (0.5, 2e-9, coupling), strict=True)}
    modes = Space(ratio=ratio, values=values, crossings=(), veerings=(), likeness=0.9)
    return Followed(Space(parameter=parameter, modes=modes, frequency=2.0 * math.pi * 100.0 * ratio, indices=indices,
                          responses=responses))  # fmt: skip


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_a_value_is_in_the_unit_of_its_parameter_only(parameter):
    found, unit = ParameterValue.of(parameter, 0.25), PARAMETERS[parameter][1]
    assert (found.plain, found.angle, found.stiffness) == tuple(
        0.25 if unit == one else None for one in ("", "deg", "N/um")
    )
    assert UNITS[unit] == pytest.approx({"": 1.0, "deg": 180.0 / math.pi, "N/um": 1e-6}[unit])


def test_branches_have_their_own_columns_in_hertz():
    one = followed()
    branches = one.branches
    assert [branch.number for branch in branches] == [1, 2, 3]
    np.testing.assert_allclose(branches[1].ratio, [2.0, 1.9, 1.8])
    np.testing.assert_allclose(branches[1].frequency, [200.0, 190.0, 180.0])
    assert (branches[0].normal[0], branches[0].bending[0], branches[0].coupling[0]) == (0.5, 2e-9, 0.3)
    assert AllFollowed((one, Followed(Space(modes=Space(likeness=0.7))))).least_likeness == 0.7
    assert AllFollowed(()).least_likeness == 1.0


def test_panels_draw_modes_that_are_there_and_indices_that_are_not_zero():
    panels = followed().mode_panels
    assert [panel.y.label for panel in panels] == ["Λ_{r}", "Δ_{η}", "Δ_{θx}", "coupling ratio"]
    assert [curve.name for curve in panels[0].curves] == ["mode 1", "mode 2"]
    without = followed(coupling=1e-9)
    assert [panel.y.label for panel in without.mode_panels] == ["Λ_{r}", "Δ_{η}", "Δ_{θx}"]
    assert without.columns == 2


@pytest.mark.parametrize(
    ("values", "log"),
    [([1.0, 2.0, 3.0], False), ([1.0, 2.0, 4.0], True), ([0.0, 2.0, 8.0], False), ([1.0, 2.0, 3.0 + 1e-7], False),
     ([1.0, 2.0, 3.0 + 1e-5], True), ([-1.0, 2.0, 8.0], False)],
)  # fmt: skip
def test_uneven_steps_above_zero_have_a_logarithmic_axis(values, log):
    axis = followed(values=np.array(values)).mode_panels[0].x
    assert axis.log is log
    assert axis.limits == (values[0], values[-1])
    angle = followed("base_helix_angle", np.radians([0.0, 20.0, 40.0])).mode_panels[0].x
    assert (angle.unit, angle.limits) == ("deg", (0.0, pytest.approx(40.0)))


def test_meetings_are_said_with_both_modes_their_place_and_how_near_they_come():
    one = followed("base_helix_angle")
    meet = Space(first=0, second=1, value=math.radians(12.5), gap=0.0)
    one.data.modes.crossings = (meet, Space(first=2, second=3, value=math.radians(30.0), gap=0.0123))
    seen = Space(name="I", one=one)
    (said,) = _remarks(seen)
    assert said == (
        "Pair I: crossings of modes 1 and 2 at base_helix_angle = 12.5 deg; modes 3 and 4 at base_helix_angle = 30 deg "
        "(Lambda 0.012 apart)."
    )
    one.data.modes.crossings = ()
    plain = followed("mu")
    plain.data.modes.veerings = (Space(first=1, second=2, value=1.5, gap=0.0),)
    assert _remarks(Space(name="I", one=plain)) == ["Pair I: veerings of modes 2 and 3 at mu = 1.5."]
    assert _remarks(seen) == []


def scene(**follow):
    pairs = {name: Space(follow=one) for name, one in follow.items()}
    return Space(case=Space(transmissibility=pairs))


def test_pairs_that_follow_modes_are_shown_and_without_any_the_first_is_refused():
    there = Space(ranges={"mu": Space(count=20, responses=[1.0, 2.0]), "kappa": Space(count=30, responses=[])})
    given = scene(I=None, II=there, III=there)
    assert _pairs(given) == ("II", "III")
    assert _pairs(scene(I=None, II=None)) == ("I",)
    assert _pairs(scene()) == ()
    _check(given, "II")
    with pytest.raises(InputError, match=r"transmissibility.I.follow"):
        _check(given, "I")
    found = _forecast(given, "II")
    assert found.settings == {"values": 50}
    assert found.seconds == pytest.approx(0.1 + 0.05 + 0.1)
    assert _forecast(given, "I").seconds == pytest.approx(0.1)


def test_modes_are_followed_from_the_case_and_scaled_by_each_model(monkeypatch):
    asked = Space(part="part", mesh="mesh", name="I")
    monkeypatch.setattr(
        mode_tracking, "model_at", lambda *given: Space(given=given, natural_frequency=10.0 * given[-1])
    )
    monkeypatch.setattr(mode_tracking, "own_value", lambda *given: ("own", *given))
    monkeypatch.setattr(mode_tracking, "_indices", lambda model, ratio, shapes: {
        key: ratio * model.given[-1] + shapes for key, *_ in INDICES})  # fmt: skip
    monkeypatch.setattr(mode_tracking, "_response", lambda given, model, value: (given, model.given, value))
    ratio, shapes = np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([[0.1, 0.2], [0.3, 0.4]])

    def follow(build, values, start):
        assert build(7.0).given == ("part", "mesh", "I", "mu", 7.0)
        assert start == ("own", "part", "mesh", "mu")
        return Space(ratio=ratio, shapes=shapes, values=values)

    monkeypatch.setattr("fegear.dynamics.helical_pair.mode_following.follow_modes", follow)
    found = _over(asked, "mu", np.array([2.0, 5.0]), [3.0, 6.0])
    np.testing.assert_allclose(found.frequency, [[20.0, 40.0], [150.0, 200.0]])
    np.testing.assert_allclose(found.indices["coupling"], [[2.1, 4.2], [15.3, 20.4]])
    assert (found.parameter, set(found.indices)) == ("mu", {"normal", "bending", "coupling"})
    assert found.responses == tuple((asked, ("part", "mesh", "I", "mu", one), one) for one in (3.0, 6.0))

    def refused(*_given):
        raise InputError("follow.mu.responses", "9", "is wrong", "remedy")

    monkeypatch.setattr(mode_tracking, "_response", refused)
    with pytest.raises(InputError, match=r"transmissibility.I"):
        _over(asked, "mu", np.array([2.0, 5.0]), [9.0])


def test_indices_are_of_shapes_of_length_one(monkeypatch):
    def displacements(model, ratio, shapes):
        assert (model, ratio) == ("model", "ratio")
        np.testing.assert_allclose(np.linalg.norm(shapes, axis=0), 1.0)
        return "eta", "theta"

    room = "fegear.dynamics.helical_pair.modal_indices"
    monkeypatch.setattr(f"{room}.mesh_displacements", displacements)
    monkeypatch.setattr(f"{room}.over_largest", lambda one: ("largest", one))
    monkeypatch.setattr(f"{room}.coupling", lambda *given: ("coupling", *given))
    assert _indices("model", "ratio", np.array([[3.0, 0.0], [4.0, 2.0]])) == {
        "normal": ("largest", "eta"), "bending": ("largest", "theta"),
        "coupling": ("coupling", "model", "eta", "theta"),
    }  # fmt: skip


def test_a_response_is_that_of_the_mesh_along_and_about_the_line_of_action(monkeypatch):
    asked = Space(part=Space(lambda_from=0.1, lambda_to=2.5))
    force = np.arange(2 * 36).reshape(2, 6, 6) * (1.0 - 1.0j)
    moved = np.arange(2 * 36).reshape(2, 6, 6) * 2.0j
    found = Space(ratio="ratio", G_minus_a=moved)
    model = Space(mesh=Space(stiffness=4.0))

    def resolved(given, low, high):
        assert (given, low, high) == (model, 0.1, 2.5)
        return found, "undamped"

    monkeypatch.setattr(mode_tracking, "resolved_response", resolved)
    monkeypatch.setattr(
        mode_tracking, "mesh_forces", lambda one: {"mesh": force, "other": None} if one is found else {}
    )
    one = _response(asked, model, 0.7)
    assert (one.value, one.undamped, one.ratio) == (0.7, "undamped", "ratio")
    np.testing.assert_allclose(one.dynamic, [24 * 2.0 / 4.0, 60 * 2.0 / 4.0])
    np.testing.assert_allclose(one.line_of_action, [0.0, 36 * math.sqrt(2.0)])
    np.testing.assert_allclose(one.torsion, [28 * math.sqrt(2.0), 64 * math.sqrt(2.0)])
