"""Helical pairs by thin slices of spur ones in known limits, which variants are screened, and their tolerances."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.atlas.many_pairs import known_pairs, spur_pairs
from fegear.atlas.shipped import shipped_atlas
from fegear.atlas.thin_slices import sliced_errors
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.case.sizing import TolerancesPart
from fegear.contact.many.many_load_sharing import transmission_errors
from fegear.design.sizing.by_atlas import AtlasDuty, Bare, sliced_errors_of
from fegear.design.sizing.feasible import Lives
from fegear.design.sizing.space import variant_of
from fegear.engine.executor import Executor
from fegear.engine.stage import Work
from fegear.geometry.many_pairs import ManyGearPairs
from fegear.results.sizing import by_fe
from fegear.results.sizing.estimated import Estimated, screened_rows
from fegear.results.sizing.variant_case import case_of_variant

STEEL = 2.06e11


def pairs(betas: list[float], width: float = 30e-3, teeth: tuple[int, int] = (23, 57)) -> ManyGearPairs:
    count, module, alpha = len(betas), 3e-3, math.radians(20.0)
    beta = np.radians(betas)
    distance = 0.5 * module * sum(teeth) / np.cos(beta)
    each = np.ones(count)
    return ManyGearPairs(
        np.outer(teeth, each), np.outer((0.2, -0.2), each), module * each, alpha * each, beta, each, 1.25 * each,
        0.38 * each, 0.0 * each, distance, width * each,
    )  # fmt: skip


@pytest.mark.dear
def test_without_a_helix_it_is_the_spur_pair():
    some, loads = pairs([0.0, 1e-4]), np.full((2, 1), 6000.0)
    found = sliced_errors(shipped_atlas("A"), some, loads, STEEL)
    spur = transmission_errors(known_pairs(shipped_atlas("A"), spur_pairs(pairs([0.0]))).engagements, [6000.0])
    assert found.mean[:, 0] == pytest.approx(spur.mean[0, 0], rel=2e-3)
    # 64 roll positions miss the ends of the contact of two pairs by half a step
    assert found.peak_to_peak[:, 0] == pytest.approx(spur.peak_to_peak[0, 0], rel=3e-2)


def test_ripple_vanishes_at_whole_overlap_ratios_and_falls_with_the_width():
    beta = 15.0
    whole = math.pi * 3e-3 / math.sin(math.radians(beta))
    loads = np.full((1, 1), 6000.0)
    atlas = shipped_atlas("A")
    narrow, one, beside, two = (
        sliced_errors(atlas, pairs([beta], share * whole), share * loads, STEEL).peak_to_peak[0, 0]
        for share in (0.5, 1.0, 1.1, 2.0)
    )
    assert max(one, two) < 1e-3 * narrow < 1e-2 * beside * 10.0
    around = sliced_errors(atlas, pairs([beta], whole), loads, STEEL, (0.9, 1.0, 1.1)).peak_to_peak[0, 0]
    assert around == pytest.approx(
        max(sliced_errors(atlas, pairs([beta], whole), loads, STEEL, (f,)).peak_to_peak[0, 0] for f in (0.9, 1.1)),
        rel=1e-12,
    )
    assert around > 10.0 * one


def test_gears_beside_the_regions_are_taken_at_their_ends_and_other_racks_have_no_number():
    some = pairs([25.0], teeth=(11, 350))
    assert np.isfinite(sliced_errors(shipped_atlas("A"), some, np.full((1, 1), 6000.0), STEEL).mean).all()
    duty = AtlasDuty((100.0, 200.0), STEEL, 0.3)
    both = pairs([0.0, 15.0])
    te = sliced_errors_of(both, duty)
    assert math.isnan(te[0])
    assert te[1] > 0.0
    shallow = ManyGearPairs(**{**vars(both), "dedendum": np.full(2, 1.1)})
    assert np.isnan(sliced_errors_of(shallow, duty)).all()


def test_helical_variants_are_screened_by_thin_slices_the_others_by_formulas():
    mass, te = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 1.5]), np.array([9.0, 1.0, 8.0, 7.0, 6.0, np.nan])
    names = ("transmission-error", "mass")
    lives = Lives(np.arange(6), mass[:, None], ("mass",), {}, 6)
    costs = np.stack([np.full(6, np.nan), mass], axis=1)
    none = np.zeros(0, dtype=np.int64)
    known = Estimated(costs, Bare.unknown(6), none, None, te)
    assert sorted(screened_rows(lives, known, names, 3)) == [0, 1, 5]
    assert sorted(screened_rows(lives, known, names, 6)) == list(range(6))
    unknown = Estimated(costs, Bare.unknown(6), none, None, np.full(6, np.nan))
    assert sorted(screened_rows(lives, unknown, names, 2)) == [0, 5]
    assert known.costs[1, 0] != te[1]


def _fake(point, _cache):
    document = point["document"]
    pair = document["pair"]["I"]
    width = float(document["gear"]["wheel"]["face_width"].split()[0])
    shafts = pair.get("misalignment", {}).get("driver", {}).get("out_of_plane", "0 mm")
    assert ("misalignment" in document["effects"]) == (shafts != "0 mm")
    leaned = float(shafts.split()[0])
    return {
        "te": width + 100.0 * max(-leaned, 0.0),
        "te_error": width,
        "root_stress": -width,
        "root_stress_error": leaned,
    }


def test_numbers_of_helical_variants_are_maxima_over_the_tolerances(monkeypatch):
    some = pairs([0.0, 15.0])
    states = TolerancesPart(face_width="1 mm", parallelism="0.02 mm").states
    assert states == ((0.0, 0.0), (-1e-3, 0.0), (1e-3, 0.0), (0.0, -2e-5), (0.0, 2e-5))
    monkeypatch.setattr(by_fe, "compute_variant", _fake)
    work = Work(lambda _part: None, SolutionCache(), Executor(here=True))
    asked = {"torque": "100 N*m", "speed": "1000 rpm", "strength": {"material": "18CrNiMo7-6"}}
    variants = [variant_of(some, n) for n in (0, 1)]
    spur, helical = by_fe.by_finite_elements(asked, variants, work, "", lambda _part: None, states=states)
    assert (spur.te, spur.te_error, spur.root_stress) == (30.0, 30.0, -30.0)
    assert (helical.te, helical.te_error) == (32.0, 30.0)  # with shafts out of parallel
    assert (helical.root_stress, helical.root_stress_error) == (-29.0, 0.0)  # of the narrow face
    (alone,) = by_fe.by_finite_elements(asked, variants[1:], work, "", lambda _part: None)
    assert alone.te == 30.0
    document = case_of_variant(asked, variants[1], ("transmission-error",), width="slices", parallelism=2e-5)
    scene = build_scene(document, "one", Path())
    assert scene.case.pair["I"].misalignment.driver.out_of_plane == 2e-5
