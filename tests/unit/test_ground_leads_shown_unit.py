"""Corrections of leads as results: which of three leads is to be ground, what is said of each, and in what order."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.flanks import lead_correction as design
from fegear.design.flanks.lead_correction import LeadCorrection
from fegear.results.shafts import lead_correction as shown
from fegear.results.shafts.lead_correction import LeadData, LeadInputs

LOADS = np.array([1000.0, 2000.0])


def correction(after, kept, crowning=2e-6, slope=5e-6, left=0.001):
    def both(last):
        return np.array([last + 1.0, last])

    return LeadCorrection(slope, crowning, LOADS, both(1.8), both(after), np.array([left, 0.5 * left]), both(kept))


def ground(found, *, crownings=(3e-6, 3e-6, 0.0), rated=(None, None, None)):
    """Of three meshes what is shown; the second one's load stays even."""
    data = LeadData(("I", "J", "K"), (0.02, 0.03, 0.04), (found[0], None, found[1]))
    asked = LeadInputs(None, ("a", "c", "e"), (1e-6, 2e-6, 0.0), crownings, rated)
    return shown._ground(data, asked)


def test_meshes_that_gain_most_come_first_and_those_whose_load_stays_even_not_at_all():
    less, more = correction(1.3, 1.25), correction(1.1, 1.05, slope=-4e-6)
    first, second = ground((less, more))
    assert [(one.pair, one.gear) for one in (first, second)] == [("K", "e"), ("I", "a")]
    assert first.torque == pytest.approx(0.04 * LOADS)
    assert second.torque == pytest.approx(0.02 * LOADS)
    assert (first.present, second.present) == (0.0, 3e-6)
    for one, of in ((first, more), (second, less)):
        assert (one.slope, one.crowning) == (of.slope, of.crowning)
        assert one.before.tolist() == of.before.tolist()
        assert one.after.tolist() == of.after.tolist()
        assert one.left.tolist() == of.left.tolist()
        assert one.best.flanks == of.after[-1]
        assert one.leads[0].flanks == of.before[-1]
    assert [lead.design for lead in first.leads] == ["present", "lead correction"]
    assert [lead.design for lead in second.leads] == ["present", "lead correction", "lead correction, present crowning"]
    assert (second.leads[0].slope, second.leads[0].crowning) == (1e-6, 3e-6)
    assert (second.leads[2].slope, second.leads[2].crowning, second.leads[2].flanks) == (5e-6, 3e-6, 1.25)
    rows = [(row.design, row.modification, row.shape, row.amount) for row in second.grinding]
    assert [one[0] for one in rows] == ["lead correction"] * 2 + ["lead correction, present crowning"] * 2
    assert [one[3] for one in rows] == [5e-6, 2e-6, 5e-6, 3e-6]
    assert [one[2] for one in rows] == ["linear", "parabolic"] * 2
    assert all((row.gear, row.member) == ("a", "driver") for row in second.grinding)


@pytest.mark.parametrize(("present", "leads"), [(1.9e-6, 2), (2e-6, 2), (2.1e-6, 3)])
def test_the_present_crowning_is_kept_only_where_it_is_more_than_that_of_the_correction(present, leads):
    (one,) = shown._ground(
        LeadData(("I",), (0.02,), (correction(1.3, 1.25),)),
        LeadInputs(None, ("a",), (0.0,), (present,), (None,)),
    )
    assert len(one.leads) == leads


@pytest.mark.parametrize(("kept_is_safer", "crowning", "flanks"), [(True, 3e-6, 1.25), (False, 2e-6, 1.3)])
def test_of_both_leads_the_one_with_the_higher_safety_factor_is_ground(monkeypatch, kept_is_safer, crowning, flanks):
    def rate(lead, row):
        higher = (row.design == "lead correction, present crowning") == kept_is_safer
        return replace(row, factor=1.5, contact=1.4 if higher else 1.2, bending=2.0)

    monkeypatch.setattr(shown, "rated_with", rate)
    (one, _) = sorted(
        ground((correction(1.3, 1.25), correction(1.1, 1.0)), rated=("r", None, None)), key=lambda g: g.pair
    )
    assert (one.best.contact, one.crowning, one.best.flanks, one.after[-1]) == (1.4, crowning, flanks, flanks)
    assert one.leads[2].contact == 1.2


def seen(*leads):
    return SimpleNamespace(data=list(leads))


def test_sentences_say_amounts_ends_and_safety_factors_before_and_after(monkeypatch):
    (one,) = shown._ground(
        LeadData(("I",), (0.02,), (correction(1.3, 1.25),)), LeadInputs(None, ("a",), (0.0,), (3e-6,), (None,))
    )
    (said,) = shown._sentences(seen(one))
    assert "Pair I: grind a helix slope C_Hβ of 5 µm (more removal at end II)" in said
    assert "a crowning C_β of 2 µm on gear a: K_Hβ of the loaded flanks 1.80 -> 1.30 at 40 N m." in said
    assert "S_H" not in said
    rated = [replace(lead, contact=1.0 + k / 10.0, bending=2.0 + k / 10.0) for k, lead in enumerate(one.leads)]
    (said,) = shown._sentences(seen(replace(one, leads=tuple(rated))))
    assert said.endswith("at 40 N m, S_H 1.00 -> 1.10, S_F 2.00 -> 2.10.")
    kept = replace(one, leads=(rated[0], replace(rated[1], crowning=3e-6)))
    assert "a crowning C_β of 3 µm (the present one) on gear a" in next(shown._sentences(seen(kept)))
    none = replace(one, present=0.0, slope=0.0, leads=(rated[0], replace(rated[1], crowning=0.0)))
    (said,) = shown._sentences(seen(none))
    assert "C_Hβ of 0 µm and" in said
    assert "the present one" not in said
    assert "end I" in next(shown._sentences(seen(replace(one, slope=-1e-6))))


def test_remarks_name_what_is_not_recommended_and_leads_that_have_not_settled():
    found = ground((correction(1.3, 1.25, left=0.03), correction(1.1, 1.0, left=0.01)))
    said = list(shown._remarks(seen(*found)))
    (worse,) = [one for one in said if "not recommended" in one]
    assert worse.startswith("Lead correction, pair I: not recommended is lead correction, present crowning")
    assert "crowning of 3 µm (the present one, for manufacturing deviations): K_Hβ of the loaded flanks 1.25." in worse
    assert 'set gear.e.lead slope = "5 um" and crowning = "2 um"' in " ".join(said)
    assert said[-1].endswith("still changes by 0.03 with the shaft deflection of the corrected flanks.")
    settled = ground((correction(1.3, 1.25, left=0.02), correction(1.1, 1.0, left=0.01)))
    assert not any("still changes" in one for one in shown._remarks(seen(*settled)))
    assert len(list(shown._remarks(seen()))) == 2
    swapped = [replace(one, leads=(*one.leads[:1], *one.leads[:0:-1])) for one in found]
    (worse,) = [one for one in shown._remarks(seen(*swapped)) if "not recommended" in one]
    assert "is lead correction, with a crowning of 2 µm: " in worse


def test_columns_of_safety_factors_are_there_where_one_is_known():
    (one,) = ground((correction(1.3, 1.25), correction(1.1, 1.0)))[1:]
    cell = shown._known("contact")
    assert cell.si(seen(one)) is None
    rated = replace(one, leads=(one.leads[0], replace(one.leads[1], contact=1.3)))
    first, second = cell.si(seen(rated))
    assert math.isnan(first)
    assert second == 1.3


def test_leads_are_corrected_with_what_every_driver_has(monkeypatch):
    asked = []
    meshes = tuple(
        SimpleNamespace(pair=pair, found=SimpleNamespace(driver=SimpleNamespace(base_radius=radius)))
        for pair, radius in (("I", 0.02), ("J", 0.03))
    )
    box = SimpleNamespace(meshes=meshes)
    monkeypatch.setattr(shown, "mesh_forces", lambda *given: ("meshes", *given))
    monkeypatch.setattr(shown, "loaded_shafts", lambda upstream: ("shafts", upstream))
    monkeypatch.setattr(design, "correct_leads", lambda *given: asked.append(given) or ("one", None))
    inputs = LeadInputs(SimpleNamespace(gearbox=box), ("a", "c"), (1e-6, 2e-6), (3e-6, 4e-6), (None, None))
    work = SimpleNamespace(progress="progress")
    assert shown._compute(inputs, "upstream", work) == LeadData(("I", "J"), (0.02, 0.03), ("one", None))
    assert asked == [
        (
            box,
            ("meshes", inputs.shafts, "upstream", work),
            ("shafts", "upstream"),
            [(1e-6, 3e-6), (2e-6, 4e-6)],
            "progress",
        )
    ]


def test_what_a_case_says_of_leads_goes_mesh_by_mesh(monkeypatch):
    box = SimpleNamespace(meshes=(SimpleNamespace(pair="I"), SimpleNamespace(pair="J")))
    scene = SimpleNamespace(case=SimpleNamespace(pair={k: SimpleNamespace(driver=k.lower()) for k in "IJ"}))
    made = SimpleNamespace(gearbox=box)
    monkeypatch.setattr(shown, "inputs_of_shafts", lambda given, name: made if (given, name) == (scene, "n") else None)
    monkeypatch.setattr(
        shown, "present_lead", lambda given, pair: ({"I": 1.0, "J": 2.0}[pair], {"I": 3.0, "J": 4.0}[pair])
    )
    monkeypatch.setattr(shown, "rated_lead", lambda given, pair: f"rated {pair}" if given is scene else None)
    assert shown._inputs(scene, "n") == LeadInputs(made, ("i", "j"), (1.0, 2.0), (3.0, 4.0), ("rated I", "rated J"))
