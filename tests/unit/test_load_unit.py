"""A loaded pair of its spec, without a case: the answers of a run, every field acts, refusals name what is missing."""

from dataclasses import dataclass, fields, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.effects import PLANE_EFFECTS
from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.pair_spec import pair_spec
from fegear.case.reading import build_scene
from fegear.contact.contact_law import ContactLaw
from fegear.contact.load import load
from fegear.contact.pair_spec import ComplianceTable, FlankSpec, PairSpec
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.relief_spec import CrowningSpec, ReliefSpec, RootReliefSpec, TipReliefSpec
from fegear.results.catalogue import STAGES
from fegear.results.pair.loaded_flanks import LOADED_FLANKS

PINION, WHEEL = Gear(Tooth(23), 3e-3, 15e-3, 10e-3), Gear(Tooth(57), 3e-3, 40e-3, 10e-3)
PAIR = GearPair(PINION, WHEEL)
TIP = ReliefSpec((TipReliefSpec(amount=12e-6, length=2e-3),))
SPACING = np.r_[5e-6, np.zeros(22)]
SPEC = PairSpec(
    PAIR, (1000.0, 3000.0), compliance="weber-banaschek", neighbour_coupling=False,
    driver=FlankSpec(TIP, SPACING, gear="p"), driven=FlankSpec(gear="w"),
)  # fmt: skip


def error_of(spec, **how):
    te = load(spec, **how).transmission_error()
    return np.concatenate([te.te_mean, te.te_peak_to_peak])


def test_a_spur_pair_whose_load_over_the_face_is_asked_for_has_all_that_is_known_of_its_face():
    """Its other results take plane teeth: leads, errors, positions and panels had been left out with the width."""
    gear = {"module": "3 mm", "face_width": "10 mm", "bore_radius": "15 mm"}
    document = {
        "results": ["load-distribution"],
        "load_distribution": {"positions": 5, "panels": 6},
        "effects": {"misalignment": True},
        "gear": {
            "p": {**gear, "teeth": 23},
            "w": {**gear, "teeth": 57},
        },
        "pair": {"I": {"driver": "p", "driven": "w", "load": "1000 N", "line_error": {"over_face": "10 um"}}},
    }
    scene = build_scene(document, "case", None)
    plane, wide = pair_spec(scene, "I"), pair_spec(scene, "I", over_face=True)
    assert (plane.width, wide.width) == ("plane", "solid")
    assert (wide.face.positions, wide.panel_count, wide.misalignment) == (5, 6, True)
    assert wide.face.errors.line_gap == pytest.approx([0.0, 10e-6])


def test_three_lines_give_what_a_run_of_the_case_gives():
    gear = {"module": "3 mm", "face_width": "10 mm"}
    document = {
        "results": ["transmission-error"],
        "effects": {"corner_contact": True, "hertz": "load-dependent", "relief": True, "spacing_errors": True},
        "gear": {
            "p": {
                **gear, "teeth": 23, "bore_radius": "15 mm", "spacing_errors": ["5 um", *["0 um"] * 22],
                "relief": {"tip": {"amount": "12 um", "length": "2 mm"}},
            },
            "w": {**gear, "teeth": 57, "bore_radius": "40 mm"},
        },
        "pair": {
            "I": {
                "driver": "p", "driven": "w", "loads": ["1000 N", "3000 N"],
                "compliance": {"source": "weber-banaschek"},
            }
        },
    }  # fmt: skip
    scene = build_scene(document, "case", None)
    made = pair_spec(scene, "I")
    assert made.pair == PAIR
    assert error_of(made) == pytest.approx(error_of(SPEC), rel=1e-13)
    run = run_plan(scene, make_plan(scene, STAGES))
    found = run.outcomes[Task("transmission-error", "I")].data.found
    assert np.concatenate([found.te_mean, found.te_peak_to_peak]) == pytest.approx(error_of(SPEC), rel=1e-13)


#: Fields of a plane pair, each with another value than `SPEC` has; `test_every_field_of_a_spec_is_among_them`.
OTHERS = {
    "pair": replace(PAIR, centre_distance=PAIR.centre_distance + 50e-6),
    "loads": (1000.0, 2500.0, 3000.0),
    "nominal": 1000.0,
    "compliance": "cornell",
    "table": ComplianceTable(np.linspace(PAIR.x_start, PAIR.x_end, 9), np.linspace(4e-9, 5e-9, 9)),
    "driver": FlankSpec(replace(TIP, crowning=(CrowningSpec(2e-6),)), SPACING),
    "driven": FlankSpec(ReliefSpec(root=(RootReliefSpec(amount=8e-6, length=1e-3),))),
    "corner_contact": False,
    "hertz": "none",
    "relief": False,
    "spacing_errors": False,
}


#: Fields that plane teeth do not have, or that need solved gears.
NOT_PLANE = {"width", "wide", "misalignment", "neighbour_coupling"}


def test_every_field_of_a_spec_is_among_them():
    """A field that no maker reads would have gone unnoticed."""
    missing = {one.name for one in fields(PairSpec) if one.compare} - {*OTHERS, *NOT_PLANE}
    assert missing == set(), "give each another value in OTHERS: it has to change the transmission error"


@pytest.mark.dear
def test_every_field_acts_from_a_shared_cache_as_alone():
    cache, before = SolutionCache(), error_of(SPEC)
    assert (error_of(SPEC, cache=cache) == before).all()
    for field, value in OTHERS.items():
        changed = replace(SPEC, **{field: value})
        if field == "table":
            changed = replace(changed, hertz="none", driver=SPEC.driven)
        if field == "spacing_errors":
            errors = (load(one, cache=cache).engagement.cycles for one in (SPEC, changed))
            assert tuple(errors) == (23, 1)
        shared = error_of(changed, cache=cache)
        assert (shared == error_of(changed)).all(), field
        acts = shared.shape != before.shape or not np.allclose(shared, before, rtol=1e-6)
        assert acts or field in ("nominal", "spacing_errors"), field  # which change none of these numbers
    assert (error_of(SPEC, cache=cache) == before).all()


def test_solved_gears_sources_and_formulas_are_given_alike():
    formula = [closed_form_compliance(gear, "weber-banaschek") for gear in (PINION, WHEEL)]
    assert (error_of(SPEC, gears=formula) == error_of(SPEC)).all()
    twin = PairSpec(GearPair(PINION, PINION), (2000.0,))
    solved = solve_gear(PINION)
    teeth = load(twin, (solved, solved))
    assert teeth.loads == (2000.0,)
    assert teeth.nominal == 2000.0
    assert len(teeth.shifted) == 3
    assert load(twin, (solved, solved), estimates=False).shifted == ()
    rough = solve_gear(PINION, estimate_error=False)
    assert load(twin, (rough, rough)).shifted == ()
    assert teeth.transmission_error().shift.mean > 0.0


def test_what_is_neglected_is_asked_of_the_answer():
    off = replace(SPEC, corner_contact=False, relief=False, hertz="none")
    found = load(off).neglects(("transmission error",), [3000.0])
    usual = {name for name in PLANE_EFFECTS if not SPEC.is_on(name) and name != "neighbour_coupling"}
    assert set(found.changes) == {"corner_contact", "relief", "hertz", *usual}
    assert all(change.share > 1e-3 for (change,) in found.changes.values())
    assert set(load(SPEC).neglects(("transmission error",), [3000.0]).changes) == usual


def test_the_nominal_load_is_one_of_the_loads():
    with pytest.raises(InputError, match="must be one of the loads, 1000, 2500 N"):
        replace(SPEC, loads=(2500.0, 1000.0))
    assert PairSpec(PAIR, (5.0, 3.0, 5.0)).loads == (3.0, 5.0)


@pytest.mark.parametrize(
    ("spec", "key"),
    [
        (replace(SPEC, loads=(), nominal=np.nan), "pair.load"),
        (replace(SPEC, loads=(1e9,), nominal=1e9), "pair.load"),
        (replace(SPEC, compliance="fe"), "gears"),
        (replace(SPEC, driver=FlankSpec(ReliefSpec((TipReliefSpec(amount=3e-3, length=2e-3),)), gear="p")), "gear.p."),
        (replace(SPEC, driver=FlankSpec(ReliefSpec((TipReliefSpec(amount=1e-5),)))), "relief.tip"),
    ],
)
def test_what_cannot_be_loaded_is_refused(spec, key):
    with pytest.raises(InputError) as refusal:
        load(spec)
    assert refusal.value.key.startswith(key)


def test_gears_that_are_not_solved_and_loads_that_are_one_number_are_refused():
    with pytest.raises(InputError, match="gear with 23 teeth: is not solved; give solve_gear"):
        load(replace(SPEC, compliance="fe"), (PINION, WHEEL))
    with pytest.raises(InputError, match="gears = 0 given: must be both solved gears"):
        load(replace(SPEC, compliance="fe", width="slices"))
    with pytest.raises(InputError, match=r"loads = 3000\.0: must be a sequence of loads"):
        PairSpec(PAIR, 3000.0)
    with pytest.raises(InputError, match='width = "2d": must be one of "plane", "slices", "solid"'):
        PairSpec(PAIR, (3000.0,), width="2d")


def test_a_law_changed_alike_keeps_every_field_that_does_not_change():
    law = ContactLaw(np.ones(3), 2.0, None, np.full(3, 0.5))
    assert [getattr(law.at(np.array([0])), one.name) is not None for one in fields(law)] == [True, True, False, True]
    assert law.each(lambda values: values).reference_load == 2.0


@dataclass
class Loaded:
    """Teeth with a width that say whether they were asked what they neglect."""

    neglected: str = "nothing"

    def neglects(self, _answers, _loads):
        return "all"


@pytest.mark.parametrize("neglected", [None, False, True])
def test_a_case_says_whether_pairs_with_a_width_size_what_they_neglect(monkeypatch, neglected):
    document = {
        "results": ["load-distribution"],
        "gear": {"a": {"teeth": 24, "module": "2 mm", "face_width": "10 mm", "bore_radius": "10 mm"}},
        "pair": {"I": {"driver": "a", "driven": "a", "load": "1000 N", "width": "solid"}},
        **({} if neglected is None else {"neglected": neglected}),
    }
    asked = LOADED_FLANKS.inputs(build_scene(document, "case", None), "I")
    monkeypatch.setattr("fegear.contact.wide.maker.load_wide", lambda *_given, **_named: Loaded())
    solved = {Task("solid-solution", "a"): None}
    found = LOADED_FLANKS.compute(asked, solved, SimpleNamespace(cache=None, progress=None))
    assert found.neglected == ("nothing" if neglected is False else "all")
