"""Settings of a gear's finite elements one at a time, from answers that follow a law."""

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.fem.plane.settings import MeshSettings
from fegear.studies.cost import knobs
from fegear.studies.cost.answers import FiniteElements
from fegear.studies.cost.knobs import ladder_knobs
from fegear.studies.cost.ladder import Configuration
from fegear.studies.cost.quantities import Miss
from fegear.studies.cost.result import Measured, Seconds

USUAL = MeshSettings()
C0 = SimpleNamespace(name="c_0")


@dataclass(frozen=True)
class Solved:
    settings: MeshSettings


def configuration(factor, patch, order=2, family="ring", teeth=0):
    return Configuration(family, replace(USUAL, order=order, patch_half_width=patch), factor, teeth)


def exact(patch):
    """What the reference's mesh answers under a pressure of this width."""
    return np.array([10.0, 20.0]) * (1.0 + patch**2)


def row(one, error, seconds):
    return Measured(one, "c_0", 1.0, Miss(2.0 * error, error, 1.0), Seconds(seconds, seconds), Seconds(0.5, 0.5))


@pytest.fixture
def study(monkeypatch):
    """A ladder of three meshes of order 2 and two of order 3, and two sectors; errors of the second power of edges."""
    asked_for = []

    def answer(asked, quantity, source):
        (one,) = source.solved.values()
        asked_for.append(one.settings.patch_half_width)
        assert one.settings.order == 4  # the reference's
        return exact(one.settings.patch_half_width)

    monkeypatch.setattr(knobs, "answer", answer)
    wide, narrow = 0.2, 0.1
    meshes = [
        tuple(configuration(f, patch) for patch in ((wide, narrow) if f < 4.0 else (wide, narrow, 0.4)))
        for f in (4.0, 2.0, 1.0)
    ]
    meshes += [tuple(configuration(f, wide, order=3) for _ in "x") for f in (2.0, 1.0)]
    meshes += [(configuration(1.0, 0.05, family="sector", teeth=t),) for t in (3, 5)]
    meshes += [(Configuration("compliance-formula", formula="a"),)]
    values, rows = {}, []
    for group in meshes[:5]:
        for one in group:
            patch, order = one.settings.patch_half_width, one.settings.order
            error = 1e-3 * one.factor**order
            values[one, "c_0"] = exact(patch) * (1.0 + error * np.array([1.0, -1.0]))
            rows.append(row(one, error, 8.0 / one.factor))
    rows += [row(group[0], 0.6 / group[0].teeth ** 2, float(group[0].teeth)) for group in meshes[5:7]]
    asked = SimpleNamespace(quantities=(C0, SimpleNamespace(name="te")), solves=lambda quantity: quantity is C0)
    found = SimpleNamespace(
        asked=asked, values=values, rows=rows, floors={"c_0": 3e-5}, mesh_floors={"c_0": 1e-5},
    )  # fmt: skip
    best = FiniteElements({"a": Solved(replace(USUAL, order=4))})
    return SimpleNamespace(found=found, ladder=SimpleNamespace(meshes=meshes), best=best, asked_for=asked_for)


def test_edges_of_each_order_are_varied_under_the_narrowest_pressure_that_all_have(study):
    second, third, *_ = ladder_knobs(study.found, study.ladder, study.best)
    assert (second.quantity, second.name, third.name) == ("c_0", "edge length, order 2", "edge length, order 3")
    assert second.at.startswith("patch 0.1 modules,")
    assert third.at.startswith("patch 0.2 modules,")
    assert second.step.tolist() == [4.0, 2.0, 1.0]
    np.testing.assert_allclose(second.settings, USUAL.root_edge_length * second.step, rtol=1e-14)
    np.testing.assert_allclose(second.error, 1e-3 * second.step**2, rtol=1e-9)
    np.testing.assert_allclose(third.error, 1e-3 * third.step**3, rtol=1e-9)
    assert (second.order.slope, second.floor) == (pytest.approx(2.0, rel=1e-6), 1e-5)
    np.testing.assert_allclose(second.seconds, 8.0 / second.step + 0.5, rtol=1e-14)


def test_widths_of_the_pressure_fall_by_the_root_of_two_and_each_is_compared_with_the_next(study):
    knob = ladder_knobs(study.found, study.ladder, study.best)[2]
    widths = 2.0 * USUAL.patch_half_width * 2.0 ** (-0.5 * np.arange(6))
    assert knob.name == "patch half-width"
    np.testing.assert_allclose(knob.settings, widths[:-1], rtol=1e-14)
    np.testing.assert_allclose(knob.step, widths[:-1], rtol=1e-14)
    a, b = 1.0 + widths[:-1] ** 2, 1.0 + widths[1:] ** 2
    np.testing.assert_allclose(knob.error, (a - b) / b, rtol=1e-9)
    assert (knob.floor, bool(np.isnan(knob.seconds).all())) == (0.0, True)
    assert len(study.asked_for) == len(set(study.asked_for))  # each width is computed once


def test_two_sectors_are_enough_to_see_how_the_error_falls_with_their_teeth(study):
    *_, knob = ladder_knobs(study.found, study.ladder, study.best)
    assert knob.name == "number of teeth of a sector with free sides"
    assert knob.settings.tolist() == [3.0, 5.0]
    np.testing.assert_allclose(knob.step, [1.0 / 3.0, 0.2], rtol=1e-14)
    np.testing.assert_allclose(knob.error, [0.6 / 9.0, 0.6 / 25.0], rtol=1e-14)
    assert (knob.floor, knob.seconds.tolist()) == (3e-5, [3.5, 5.5])
    study.found.rows.pop()
    assert [one.name for one in ladder_knobs(study.found, study.ladder, study.best)] == [
        "edge length, order 2", "edge length, order 3", "patch half-width",
    ]  # fmt: skip


def test_a_mesh_that_did_not_answer_is_left_out_and_one_alone_shows_nothing(study):
    coarsest, second = study.ladder.meshes[0][1], study.ladder.meshes[1][1]
    del study.found.values[coarsest, "c_0"]
    assert ladder_knobs(study.found, study.ladder, study.best)[0].step.tolist() == [2.0, 1.0]
    del study.found.values[second, "c_0"]
    assert ladder_knobs(study.found, study.ladder, study.best)[0].name == "edge length, order 3"
    assert math.isclose(study.asked_for[0], 0.1)


def test_bands_of_a_3d_gear_are_those_of_the_case_in_modules_of_its_gear(monkeypatch):
    m, settings = 4e-3, object()
    gear = SimpleNamespace(
        tooth="tooth", module=m, twist=2.0, face_width=20e-3, material=SimpleNamespace(poisson_ratio=0.28),
        bore_radius=12e-3, body_in_modules="body", support_in_modules="support",
    )  # fmt: skip
    scene = SimpleNamespace(gears={"p": gear})
    asked = SimpleNamespace(scene=scene, gear="p", radii=np.array([40e-3, 44e-3]), half_width=0.2e-3)

    def solver_of(given):
        assert given is settings
        return lambda *numbers, **body: (numbers, body)

    def places(given, name):
        assert (given, name) == (scene, "p")
        return np.array([-8e-3, 0.0, 4e-3])

    def bands(solution, radii, positions, half):
        assert solution == (("tooth", 2.0 * m, 5.0, 0.28, 3.0, settings), {"body": "body", "support": "support"})
        np.testing.assert_allclose(radii, [10.0, 11.0])
        np.testing.assert_allclose(positions, [-2.0, 0.0, 1.0])
        assert half == pytest.approx(0.05)
        return "bands"

    monkeypatch.setattr(knobs, "solver_of", solver_of)
    monkeypatch.setattr(knobs, "face_positions", places)
    monkeypatch.setattr(knobs, "bands_of_table", bands)
    monkeypatch.setattr(knobs, "band_numbers", lambda solution, of: (solution[0][0], of))
    assert knobs._answer(asked, settings) == ("tooth", "bands")
