"""Safety factors of meshes with another lead: those of a fresh case; the design with the higher one is first."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.case.built.rated_pair import pair_to_rate
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.text import draft
from fegear.case.reading import build_scene
from fegear.design.flanks.lead_correction import LeadCorrection, LevelLead
from fegear.formulas.iso6336.part1_face_load import FULL_CROWNING, manufacturing
from fegear.formulas.iso6336.safety import rate_pair, rate_spectrum
from fegear.results.rating.rating import given, rated
from fegear.results.shafts.at_glance import MeshAtGlance, Safety
from fegear.results.shafts.gearbox_overview import _levelled
from fegear.results.shafts.lead_correction import _ground_lead, _leads
from fegear.results.shafts.rated_lead import SafetyOfLead, present_lead, rated_lead, rated_with

LEADS = ((0.0, 3e-6), (-4e-6, 0.0), (-4e-6, 3e-6), (0.0, 0.0))


def drafted(*, driven=None, spectrum=False):
    case = tomllib.loads(draft(Answers("gearbox", {"teeth": "21 53"}), "box"))
    if driven is not None:
        case["gear"]["wheel"]["lead"] = driven
    if spectrum:
        levels = [{"torque": "190 N*m", "time": "100 h"}, {"torque": "0 N*m", "time": "20 h"}]
        case["pair"]["I"]["operation"].pop("life")
        case["pair"]["I"]["operation"]["spectrum"] = levels
    return case


def scene_of(case):
    return build_scene(case, "box", Path())


def row(slope, crowning):
    return SafetyOfLead("I", "lead correction", slope, crowning, 1.1)


@pytest.mark.parametrize("driven", [None, {"crowning": "4 um"}, {"end_relief": {"amount": "5 um", "length": "3 mm"}}])
def test_safety_factors_are_those_of_a_fresh_case_with_the_lead(driven):
    case = drafted(driven=driven)
    lead = rated_lead(scene_of(case), "I")
    for slope, crowning in LEADS:
        case["gear"]["pinion"]["lead"] = {"slope": f"{slope * 1e6} um", "crowning": f"{crowning * 1e6} um"}
        asked = pair_to_rate(scene_of(case), "I")
        fresh, found = rate_pair(rated(asked), given(asked)), rated_with(lead, row(slope, crowning))
        assert found.factor == pytest.approx(fresh["K_Hbeta"].value, rel=1e-12)
        assert found.contact == pytest.approx(min(fresh.contact_safety), rel=1e-12)
        assert found.bending == pytest.approx(min(fresh.bending_safety), rel=1e-12)


def test_gearbox_and_lead_correction_rate_the_same_lead_alike_with_manufacturing_deviations():
    """A lead that evens out the flanks to 1.1 leaves more in the rating: f_ma stays, and K_Halpha rises."""
    case, none = drafted(), math.nan
    case["gear"]["pinion"]["lead"] = {"slope": "0 um", "crowning": "3 um"}
    scene = scene_of(case)
    lead, present = rated_lead(scene, "I"), present_lead(scene, "I")
    assert present == (0.0, 3e-6)
    now = rated_with(lead, row(*present))
    safety = Safety(now.contact, now.bending, (1.0, 1.4), now.factor)
    one = MeshAtGlance(safety, none, none, 0.9, "I", 1e-5, (1e-5,), 2.0, now.contact, 1.0, now.bending, 1.4, none, 0.9)
    of_gearbox = _levelled(replace(one, lead=LevelLead(-4e-6, 2.0, 1.1, 2e-6), present=present), lead)
    of_lead = rated_with(lead, row(-4e-6, 5e-6))
    assert (of_gearbox.contact, of_gearbox.bending) == (of_lead.contact, of_lead.bending)
    assert 1.1 < of_gearbox.face_load_factor == of_lead.factor < now.factor
    assert now.contact < of_gearbox.contact < now.contact * math.sqrt(now.factor / 1.1)
    case["pair"]["I"]["operation"]["face_load_factor"] = 1.3
    fixed = replace(one, safety=replace(safety, face_load_factor=1.3), lead=LevelLead(-4e-6, 2.0, 1.1))
    assert _levelled(fixed, rated_lead(scene_of(case), "I")) is None  # no rating says what the lead brings


def test_what_the_case_says_of_the_flanks_stays_and_what_is_not_rated_has_no_safety_factors():
    case = drafted()
    case["pair"]["I"]["operation"]["face_load_factor"] = 1.3
    lead = rated_lead(scene_of(case), "I")
    assert {rated_with(lead, row(*one)).factor for one in LEADS} == {1.3}
    case["gear"]["wheel"].pop("strength")
    assert rated_lead(scene_of(case), "I") is None


def test_crowning_counts_in_the_rating_by_its_amount():
    """0.5 µm had the credit of the whole crowning, and the search for the minimum K_Hbeta recommended it."""
    case = drafted()
    asked = pair_to_rate(scene_of(case), "I")
    f_ma = manufacturing(rated(asked).quality)
    lead = rated_lead(scene_of(case), "I")

    def factors(slope, *shares):
        return [rated_with(lead, row(slope, share * FULL_CROWNING * f_ma)).factor for share in shares]

    for slope in (0.0, -4e-6):
        none, little, half, full, more = factors(slope, 0.0, 0.01, 0.5, 1.0, 4.0)
        assert none > little > half > full == more
        assert little == pytest.approx(none, abs=0.02 * (none - full))
        assert factors(slope, 0.0, 1e-9)[1] == pytest.approx(none, rel=1e-8)
    case["gear"]["pinion"]["lead"] = {"crowning": f"{0.05 * f_ma * 1e6} um"}
    found = rate_pair(rated(pair_to_rate(scene_of(case), "I")))
    assert found["B_2"].value == pytest.approx(1.0 - 0.5 * 0.05 / FULL_CROWNING, rel=1e-9)
    assert any(one.startswith("B_2: lead crowning below 0.2 f_ma") for one in found.remarks)
    case["pair"]["I"]["shafts"] = {"modification": "crowned for manufacture", "deformation": "0 um"}
    assert rate_pair(rated(pair_to_rate(scene_of(case), "I")))["B_2"].value == 0.5  # as specified


def test_a_correction_with_hardly_any_crowning_is_not_recommended():
    one = np.ones(1)
    found = LeadCorrection(-4e-6, 5e-7, one, 1.2 * one, 1.02 * one, 0.0 * one, 1.1 * one)
    designs = [row.design for row in _leads("I", found, (0.0, 3e-6), rated_lead(scene_of(drafted()), "I"))]
    assert designs == ["present", "lead correction, present crowning", "lead correction"]


def test_flanks_with_a_larger_load_factor_than_the_rating_have_its_safety_factors():
    """A crowning beyond the load, or a factor that is given, leaves more on the flanks than the rating has."""
    lead = rated_lead(scene_of(drafted()), "I")
    rated, formula = rated_with(lead, row(4e-6, 3e-6)), math.nan
    for flanks in (formula, 1.0, rated.factor, 2.0 * rated.factor, 3.0):
        found = rated_with(lead, replace(row(4e-6, 3e-6), flanks=flanks))
        larger = max(1.0, flanks / rated.factor) if flanks == flanks else 1.0
        assert found.factor == rated.factor
        assert found.contact == pytest.approx(rated.contact / math.sqrt(larger), rel=1e-12)
        assert found.bending == pytest.approx(rated.bending / larger, rel=1e-12)
        safety = Safety(rated.contact, rated.bending, (1.0, 1.4), rated.factor).on_flanks(flanks)
        assert (safety.contact, safety.bending) == pytest.approx((found.contact, found.bending), rel=1e-12)
        assert safety.of_flanks == (larger > 1.0)
        assert safety.face_load_factor == pytest.approx(rated.factor * larger, rel=1e-12)


@pytest.mark.dear
def test_a_lead_that_opens_the_gap_does_not_pass_by_the_credit_of_a_correction():
    case = drafted()
    case["results"] = ["gearbox"]
    case["pair"]["I"]["width"] = "slices"
    case["gear"]["pinion"]["lead"] = {"slope": "-120 um", "crowning": "3 um"}
    found = fegear.run(case, progress=False)
    mesh = {name: found.tables["gearbox_meshes"].column(name).si[0] for name in ("S_H", "S_F", "K_Hbeta", "S_H_min")}
    formula = found.values["I.K_Hbeta_rated"].value
    assert formula == pytest.approx(mesh["K_Hbeta"], rel=0.15)  # B_1 = 0.1 credited it: less than 1/1.5 of the flanks
    rated = min(found.values[f"I.{one}.S_H"].value for one in ("driver", "driven"))
    assert mesh["S_H"] == pytest.approx(rated * math.sqrt(min(1.0, formula / mesh["K_Hbeta"])), rel=1e-9)
    assert rated < 1.0
    assert found.answer.sentences[0].startswith("Fails: pair I")


@pytest.mark.dear
def test_a_crowning_that_narrows_the_contact_is_noted_with_the_factor_of_the_loaded_flanks():
    """ISO 6336-1 credits any crowning with B_1 = 0.5; of one that reaches beyond the load the ends stay apart."""
    case = drafted()
    case["results"] = ["gearbox"]
    case["pair"]["I"]["width"] = "slices"
    case["gear"]["pinion"]["lead"] = {"crowning": "120 um"}
    found = fegear.run(case, progress=False)
    flanks, formula = found.tables["gearbox_meshes"].column("K_Hbeta").si[0], k_h_beta(case)
    assert formula < 2.0 < flanks
    (note,) = [one for one in found.remarks if "of the loaded flanks exceeds" in one]
    assert f"K_Hbeta {flanks:.2f} of the loaded flanks exceeds {formula:.2f} of the rating" in note


def test_under_a_spectrum_the_safety_factors_are_those_of_the_spectrum():
    scene = scene_of(drafted(spectrum=True))
    lead, found = rated_lead(scene, "I"), []
    asked = pair_to_rate(scene, "I")
    conditions = rated(asked)
    for one in LEADS[:2]:
        found.append(rated_with(lead, row(*one)))
    duty = conditions.duty
    levels = [(None if not one.tangential else duty, one.cycles) for one in asked.levels]
    whole = rate_spectrum(conditions, levels, given(asked))
    assert found[0].contact == pytest.approx(min(whole.contact_safety), rel=1e-9)
    assert found[1].contact < found[0].contact


def test_the_table_has_the_amounts_and_factors_of_the_lead_to_grind():
    """They were those of the minimum K_Hbeta, whatever the answer recommended."""
    one = np.ones(1)
    found = LeadCorrection(-4e-6, 0.0, one, 1.2 * one, 1.05 * one, 0.0 * one, 1.15 * one)
    lead = rated_lead(scene_of(drafted()), "I")
    for asked, crowning, after in ((lead, 3e-6, 1.15), (None, 0.0, 1.05)):
        leads = _leads("I", found, (0.0, 3e-6), asked)
        ground = _ground_lead("I", 0.05, found, "pinion", 3e-6, leads)
        assert (ground.slope, ground.crowning, ground.after[0]) == (-4e-6, crowning, after)
        assert [row.amount for row in ground.grinding][:2] == [-4e-6, crowning]
        assert (ground.best.crowning, ground.best.flanks) == (crowning, after)


def test_the_design_with_the_higher_safety_factor_is_first():
    one = np.ones(1)
    found = LeadCorrection(-4e-6, 0.0, one, 1.2 * one, 1.05 * one, 0.0 * one, 1.15 * one)
    lead = rated_lead(scene_of(drafted()), "I")
    kept = "lead correction, present crowning"
    designs = [row.design for row in _leads("I", found, (0.0, 3e-6), lead)]
    assert designs == ["present", kept, "lead correction"]  # f_ma counts for half with crowning
    unrated = _leads("I", found, (0.0, 3e-6), None)
    assert [row.design for row in unrated] == ["present", "lead correction", kept]
    assert [row.flanks for row in unrated] == [1.2, 1.05, 1.15]
    assert all(math.isnan(row.contact) for row in unrated)
    assert len(_leads("I", found, (0.0, 0.0), lead)) == 2


def k_h_beta(case):
    asked = pair_to_rate(scene_of(case), "I")
    return rate_pair(rated(asked), given(asked))["K_Hbeta"].value


def test_a_slope_is_credited_only_for_what_it_takes_off_the_gap_of_the_shafts():
    case = drafted()
    case["gear"]["pinion"].pop("lead", None)
    opened = rated_lead(scene_of(case), "I").opened
    without, towards = k_h_beta(case), -math.copysign(1.0, opened)
    found = []
    for amount in (0.5e-6, -0.5e-6, -20e-6, 20e-6):
        case["gear"]["pinion"]["lead"] = {"slope": f"{towards * amount * 1e6} um"}
        found.append(k_h_beta(case))
    assert found[0] < without < found[1] < found[2]
    assert without < found[3] < found[2]


def test_a_slope_without_computed_shafts_is_said_to_be_assumed():
    case = drafted()
    for key in ("shaft", "bearing"):
        case.pop(key)
    case["results"] = ["rating"]
    case["gear"]["pinion"]["lead"] = {"slope": "5 um"}
    case["pair"]["I"]["shafts"] = {"deformation": "8 um"}
    said = pair_to_rate(scene_of(case), "I").assumed
    assert any("helix slope modification is assumed to compensate" in one for one in said)
    case["gear"]["pinion"].pop("lead")
    assert not any("helix slope" in one for one in pair_to_rate(scene_of(case), "I").assumed)
