"""What a sizing asks of atlas and finite elements, and does with it: with answers made up, whose best is known."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.case.sizing import SizingPart
from fegear.contact.many.many_load_sharing import ManyErrors
from fegear.contact.many.many_roots import ManyRootStress
from fegear.design.sizing import by_atlas
from fegear.design.sizing.by_atlas import AtlasDuty, Bare, bare_errors, relieved_errors
from fegear.engine.executor import Executor
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES
from fegear.results.sizing import by_atlas as in_parts
from fegear.results.sizing import by_fe, estimated, sizing
from fegear.results.sizing.basis import space_of
from fegear.results.sizing.estimated import Estimated

ASKED = {
    "power": "2.9 kW", "speed": "725 rpm", "ratio": 2.5, "ratio_tolerance": 0.01,
    "strength": {"material": "18CrNiMo7-6"}, "operation": {"application_factor": 1.25, "life": "5000 h"},
    "centre_distance": "112 mm", "face_width": "35 mm",
    "normal_modules": ["3 mm"], "pinion_teeth": [18, 26], "pinion_shifts": [0.0, 0.1, 0.2, 0.3, 0.4, 0.5],
    "torques": ["15 N*m", "30 N*m"], "verified": 2, "tolerance": 0.05,
}  # fmt: skip
#: Made up: transmission error over mean deflection without relief, and the share of the mean that is the best amount.
LEFT, SHARE = 0.4, 0.8
MADE_UP = {"share": SHARE}


def _errors(engagements, loads, **_):
    """Mean deflection by load and pinion's tip; an amount of `SHARE` of it is best, short ones better."""
    held = np.isfinite(engagements.flanks.own[:, :, 0].sum(axis=0))
    mean = np.where(held, 1e-9 * (1.0 + 30.0 * engagements.flanks.highest[0]), np.nan)[:, None] * loads
    flanks, reliefs = engagements.flanks, engagements.reliefs
    if reliefs is None:
        return ManyErrors(mean, LEFT * mean, np.ones_like(mean))
    unit = mean.max(axis=1)
    off = np.abs(reliefs.amount[0] / unit / MADE_UP["share"] - 1.0)
    length = ((1.0 - reliefs.start) * (flanks.highest - flanks.lowest)).sum(axis=0)
    left = (0.1 + 0.3 * off)[:, None] * mean + 1e-6 * length[:, None]
    return ManyErrors(mean, left, np.ones_like(mean))


def _stresses(engagements, fillets, loads):
    tension = 1e11 / loads * (1.0 + 30.0 * engagements.flanks.highest[1])[:, None]
    tension = np.stack([tension, 1.1 * tension])
    return ManyRootStress(tension, -tension, tension)


@pytest.fixture(autouse=True)
def made_up(monkeypatch):
    monkeypatch.setattr(by_atlas, "transmission_errors", _errors)
    monkeypatch.setattr(by_atlas, "root_stresses", _stresses)


def _tips(pairs):
    """Roll lengths of the tips."""
    return 0.5 * np.sqrt(np.abs(pairs.tip_diameters**2 - pairs.base_diameters**2))


def _pairs():
    space = space_of(SizingPart.model_validate({**ASKED, "helix_angles": ["0 deg", "12 deg"]}))
    return space, space.pairs(np.arange(space.count))


@pytest.mark.dear
def test_bare_pairs_have_the_largest_error_over_the_torques_and_root_stress_at_their_own():
    _, pairs = _pairs()
    duty = AtlasDuty((15.0, 30.0), 206.8e9, 0.3, 45.0)
    found = bare_errors(pairs, duty)
    held = np.isfinite(found.te)
    assert not held[pairs.helix_angle > 0.0].any()
    assert held.sum() > 3
    radius = 0.5 * pairs.base_diameters[0][held]
    mean = 1e-9 * 30.0 / radius * (1.0 + 30.0 * _tips(pairs)[0][held])
    assert found.te[held] == pytest.approx(LEFT * mean, rel=1e-12)
    assert ((found.error[held] / mean > 1e-5) & (found.error[held] / mean < 1e-2)).all()
    assert found.root[held] == pytest.approx(1.1e11 * radius / 45.0 * (1.0 + 30.0 * _tips(pairs)[1][held]), rel=1e-12)
    assert ((found.root_error / found.root)[held] < 1e-2).all()
    none = bare_errors(pairs, replace(duty, root_torque=0.0))
    np.testing.assert_array_equal(none.te, found.te)
    np.testing.assert_array_equal(none.error, found.error)
    assert np.isnan(none.root).all()
    assert np.isnan(bare_errors(pairs, replace(duty, poisson_ratio=0.31)).te).all()


def test_root_stress_is_looked_up_in_parts_and_errors_are_those_of_the_worse_gear(monkeypatch):
    _, pairs = _pairs()
    duty = AtlasDuty((30.0,), 206.8e9, 0.3, 45.0)
    whole, asked = bare_errors(pairs, duty), []
    known_pairs = by_atlas.known_pairs

    def known(*given, **more):
        found = known_pairs(*given, **more)
        asked.append(found)
        return found

    monkeypatch.setattr(by_atlas, "known_pairs", known)
    monkeypatch.setattr(by_atlas, "_STRESSED", 4)
    for one, other in zip(bare_errors(pairs, duty), whole, strict=True):
        np.testing.assert_array_equal(one, other)
    assert max(one.held.size for one in asked) == 4
    held = np.isfinite(whole.te)
    # those outside the atlas have no number of their own, in the same order
    inside = np.concatenate([one.held for one in asked])
    error = np.concatenate([one.error.max(axis=0) for one in asked])[inside]
    assert whole.error[held] == pytest.approx(2.0 * error * whole.te[held] / LEFT)
    weights = np.concatenate([np.max(one.stress_error[:, :, 0] * [[1.0], [1.1]], axis=0) for one in asked])[inside]
    assert whole.root_error[held] == pytest.approx(weights * whole.root[held] / 1.1)


def test_the_best_relief_is_the_short_one_of_the_best_amount():
    _, pairs = _pairs()
    found, bare = (
        relieved_errors(pairs, AtlasDuty((15.0, 30.0), 206.8e9, 0.3)),
        bare_errors(pairs, AtlasDuty((30.0,), 206.8e9, 0.3)),
    )
    held = np.isfinite(found.te)
    np.testing.assert_array_equal(held, np.isfinite(bare.te))
    unit = bare.te[held] / LEFT
    assert found.amount[held] == pytest.approx(SHARE * unit, abs=1e-7)
    assert found.amount[held] * 1e7 == pytest.approx(np.round(found.amount[held] * 1e7))  # whole tenths of a micrometre
    assert (found.kind[held] == 0).all()
    assert (found.te[held] < bare.te[held]).all()
    assert not found.at_limit.any()
    some = pairs.at(held)
    known = by_atlas.known_pairs(
        by_atlas.shipped_atlas("A"), by_atlas.spur_pairs(some, young_modulus=206.8e9)
    ).engagements
    short, long = by_atlas._lengths(known)
    np.testing.assert_array_equal(found.lengths[:, held], short)
    flank = known.flanks.highest - known.flanks.lowest
    assert (short < long).all()
    assert ((short >= 0.02 * flank) & (long <= 0.98 * flank)).all()
    # along the line of action: short ones of both ends leave one base pitch, long ones meet in the middle of the path
    contact_ratio = some.contact_ratio
    ends, pitch = contact_ratio * known.base_pitch, known.base_pitch
    assert short[:, contact_ratio > 1.0] == pytest.approx(
        np.stack([ends - pitch] * 2)[:, contact_ratio > 1.0], rel=1e-6
    )
    assert long == pytest.approx(np.stack([0.5 * ends] * 2), rel=1e-6)


def test_where_no_relief_is_better_there_is_none_and_the_largest_is_said_to_be_at_the_limit(monkeypatch):
    _, pairs = _pairs()
    duty = AtlasDuty((30.0,), 206.8e9, 0.3)
    monkeypatch.setitem(MADE_UP, "share", 1e-9)
    none = relieved_errors(pairs, duty)
    monkeypatch.setitem(MADE_UP, "share", 3.0)
    most = relieved_errors(pairs, duty)
    held = np.isfinite(none.te)
    np.testing.assert_array_equal(none.te, bare_errors(pairs, duty).te)
    assert (none.amount[held] == 0.0).all()
    assert not none.lengths[:, held].any()
    assert most.at_limit[held].all()
    assert most.amount[held] == pytest.approx(2.5 * bare_errors(pairs, duty).te[held] / LEFT, rel=2e-2)


def test_a_golden_section_ends_at_the_least_of_each():
    places = np.array([0.1, 0.5, 0.93])
    found = by_atlas._golden(lambda x: np.abs(x - places), np.zeros(3), np.ones(3))
    assert found == pytest.approx(places, abs=0.618**8)


def test_parts_are_put_together_in_the_order_of_their_variants(monkeypatch):
    space, pairs = _pairs()
    duty, work = (
        AtlasDuty((15.0, 30.0), 206.8e9, 0.3, 30.0),
        SimpleNamespace(executor=Executor(here=True), cache=SolutionCache()),
    )
    bare, relieved = bare_errors(pairs, duty), relieved_errors(pairs, duty)
    monkeypatch.setattr(in_parts, "_PART", 5)
    monkeypatch.setattr(in_parts, "_RELIEVED", 4)
    numbers, progress = np.arange(space.count), []
    for one, other in zip(in_parts.bare_of(space, numbers, duty, work, progress.append), bare, strict=True):
        np.testing.assert_array_equal(one, other)
    assert progress[-1] == 1.0
    for one, other in zip(in_parts.relieved_of(space, numbers, duty, work, progress.append), relieved, strict=True):
        np.testing.assert_array_equal(one, other)
    none = in_parts.relieved_of(space, numbers[:0], duty, work, progress.append)
    assert [part.shape for part in none] == [(0,), (0,), (0,), (2, 0), (0,)]
    # of some
    two = in_parts.relieved_of(space, np.flatnonzero(np.isfinite(relieved.te))[:2], duty, work, progress.append)
    known = Estimated(np.array([[1.0, 2.0], [np.nan, 1.0], [3.0, 1.0]]), bare, np.array([4, 7]), two)
    assert known.known.tolist() == [0, 2]
    assert known.relief(3) is known.relief(8) is None
    assert known.relief(7).te == two.te[1]
    assert known.relief(4).lengths == (two.lengths[0, 0], two.lengths[1, 0])
    assert known.relief(4).kind == by_atlas.LENGTHS[int(two.kind[0])]
    assert known.at_limit(7) == known.at_limit(0) == ()
    limited = replace(known, relieved=two._replace(at_limit=np.array([False, True])))
    assert limited.at_limit(7) == ("amount of relief (maximum)",)
    assert limited.at_limit(4) == limited.at_limit(8) == ()
    row = int(np.flatnonzero(np.isfinite(bare.te))[0])
    first, relief = estimated.of_one(pairs.at(slice(row, row + 1)), duty, relieved=True)
    assert (first.te, first.te_error, first.root_stress, first.root_stress_error, first.source) == (
        *(values[row] for values in bare), "atlas")  # fmt: skip
    assert relief.amount == relieved.amount[row]
    assert estimated.of_one(pairs.at(slice(row, row + 1)), duty, relieved=False) == (first, None)


def _sized(asked, monkeypatch):
    calls = []

    def by_finite_elements(given, variants, work, folder, progress, *, verified=None, states):
        assert states == ((0.0, 0.0),)
        calls.append((list(variants), verified))
        return tuple(
            by_fe.FromFE(1e-6 * (1.0 + one.profile_shift[0]) * (0.5 if one.relief else 1.0), 1e-9, 2e8, 1e6)
            for one in variants
        )

    monkeypatch.setattr(sizing, "by_finite_elements", by_finite_elements)
    scene = build_scene({"results": ["sizing"], "sizing": asked}, "sized", Path())
    results = run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache(), executor=Executor(here=True))
    (table,) = [one for one in results.tables if one.name == "sizing"]
    (lines,) = [figure.made() for figure in results.figures if figure.name == "sizing_parallel"]
    (panel,) = lines.panels
    shares = np.array([one.y for one in panel.items])
    assert shares.shape[0] == table.columns[0].si.size  # a line for each variant, each quantity from 0 to 1
    assert (np.nanmin(shares, axis=0) == 0.0).all()
    assert np.nanmax(shares, axis=0) == pytest.approx(1.0)
    return calls, {c.name: c.si for c in table.columns}, {v.name: v.si for v in results.values}


def test_a_sizing_by_reliefs_looks_up_searches_and_verifies_its_best(monkeypatch):
    asked = {**ASKED, "criteria": ["relieved-transmission-error", "transmission-error", "root-stress"], "relieved": 4}
    calls, table, values = _sized(asked, monkeypatch)
    ((jobs, verified),) = calls
    assert verified == ("slices", 0.05) or verified[1] == 0.05
    assert [one.relief is None for one in jobs] == [True, True, False, False]
    assert table["place"].tolist() == [1, 2, 0, 0]  # by the verified numbers, which are larger here
    best = np.flatnonzero(np.isfinite(table["te_verified"]))
    assert [one.profile_shift[0] for one in jobs[:2]] != [one.profile_shift[0] for one in jobs[1:3]]
    assert np.isfinite(table["te_verified"]).sum() == 2
    assert sorted(table["te_verified"][best]) == pytest.approx(sorted(1e-6 * (1.0 + table["x_1"][best])))
    assert table["te_verified_error"][best] == pytest.approx([1e-9, 1e-9])
    assert table["root_stress_verified"][best] == pytest.approx([2e8, 2e8])
    assert np.isfinite(table["te_estimated"]).all()
    assert len(table["place"]) == 4
    assert values["sizing.variants"] > 4
    here = np.flatnonzero(np.isfinite(table["te_relieved_verified"]))
    assert table["te_relieved_verified"][here] == pytest.approx(0.5 * table["te_verified"][here])
    assert table["relief_amount"] == pytest.approx(SHARE * table["te_estimated"] / LEFT, abs=1e-7)
    assert [one.relief.amount for one in jobs[2:]] == pytest.approx(table["relief_amount"][here])


@pytest.mark.dear
def test_a_sizing_without_an_atlas_is_estimated_by_coarse_finite_elements(monkeypatch):
    asked = {
        **ASKED,
        "criteria": ["transmission-error", "mass"],
        "helix_angles": ["12 deg"],
        "screened": 3,
        "verified": 1,
    }
    calls, table, _ = _sized(asked, monkeypatch)
    (estimates, verified) = calls
    assert [len(jobs) for jobs, _ in calls] == [3, 1]
    assert estimates[1] is None
    assert verified[1][1] == 0.05
    assert "relief_amount" not in table
    assert table["te_estimated"] == pytest.approx(1e-6 * (1.0 + table["x_1"]))
    assert np.isfinite(table["te_verified"]).sum() == 1
    assert table["te_verified"][np.argmin(table["place"])] == pytest.approx(table["te_estimated"].min())


@pytest.mark.parametrize("relieved", [False, True])
def test_half_of_the_estimates_are_looked_up_and_the_other_half_searched(monkeypatch, relieved):
    """What is done goes from nothing to all in even parts."""

    def parts(progress):
        for part in (0.0, 0.5, 1.0):
            progress(part)

    def bare(_space, numbers, _duty, _work, progress):
        parts(progress)
        return Bare(*np.ones((4, numbers.size)))

    def searched(_space, numbers, _duty, _work, progress):
        parts(progress)
        return SimpleNamespace(te=np.ones(numbers.size))

    monkeypatch.setattr(estimated, "bare_of", bare)
    monkeypatch.setattr(estimated, "relieved_of", searched)
    monkeypatch.setattr(estimated, "sliced_of", lambda _space, numbers, *_: np.ones(numbers.size))
    names = (estimated.BARE, estimated.RELIEVED) if relieved else (estimated.BARE,)
    lives = SimpleNamespace(numbers=np.arange(5), names=("mass",), criteria=np.arange(5.0)[:, None])
    done = []
    found = estimated.estimated(None, lives, names, object(), (4, 2), None, done.append)
    assert done == ([0.0, 0.25, 0.5, 0.5, 0.75, 1.0] if relieved else [0.0, 0.5, 1.0])
    assert np.isfinite(found.costs).sum(axis=0).tolist() == ([4, 2] if relieved else [4])
