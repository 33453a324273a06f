"""Effects have one named start: what a case file and Python begin with, and what named keys change."""

from pathlib import Path

import pytest

import fegear
from fegear.base.effects import (
    AT_REST,
    EFFECTS,
    GAPS,
    MOTION_EFFECTS,
    PLANE_EFFECTS,
    ROOT_EFFECTS,
    WIDE_EFFECTS,
    Described,
)
from fegear.base.errors import InputError
from fegear.case.effects import EffectsPart, started
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES

#: Effects of teeth that every pair is described with.
TEETH = {"corner_contact", "neighbour_coupling", "hertz"}
TIP = {"tip": {"amount": "20 um", "length": "3 mm"}}
GEARS = {"a": {"teeth": 20, "module": "3 mm", "face_width": "10 mm"}, "b": {"teeth": 40, "module": "3 mm"}}


def case(*, results=("load-sharing",), relief=None, effects=(), pair=(), **more):
    gears = {"a": {**GEARS["a"], **({"relief": relief} if relief else {})}, "b": GEARS["b"]}
    one = {"driver": "a", "driven": "b", "torque": "60 N*m", **dict(pair)}
    start = {"start": "described", **dict(effects)}
    return build_scene(
        {"results": list(results), "gear": gears, "pair": {"I": one}, "effects": start, **more}, "case", Path()
    )


@pytest.mark.parametrize(
    ("given", "on"),
    [
        ({}, TEETH),
        ({"relief": TIP}, {*TEETH, "relief"}),
        ({"relief": TIP, "effects": {"relief": False}}, TEETH),
        ({"effects": {"hertz": "none", "friction": True}}, {"corner_contact", "neighbour_coupling", "friction"}),
        ({"pair": {"compliance": {"source": "weber-banaschek"}}}, {"corner_contact", "hertz"}),
        ({"pair": {"width": "slices", "line_error": {"over_face": "10 um"}}}, {*TEETH, "misalignment"}),
        ({"effects": {"start": "none"}}, set()),
    ],
)
def test_a_case_starts_from_what_it_describes(given, on):
    assert set(case(**given).case.effects.on()) == on


def test_what_flanks_have_counts_where_one_pair_has_it_and_what_teeth_do_where_all_can():
    relieved, bare = Described({"relief"}, {}, wide=False), Described((), {}, wide=False)
    table = Described((), {"compliance": {"source": "table"}}, wide=False)
    start = EffectsPart(start="described")
    assert set(started(start, [relieved, bare]).on()) == {*TEETH, "relief"}
    assert set(started(start, [relieved, table]).on()) == {"corner_contact", "hertz", "relief"}
    assert set(started(start, [Described((), {}, wide=True, carried=True)]).on()) == {*TEETH, "misalignment"}
    assert set(started(start, [Described((), {}, wide=False, moving=True)]).on()) == {
        *TEETH, "contact_loss", "parametric",
    }  # fmt: skip
    assert started(start, []).on() == ()
    assert started(EffectsPart(), [relieved]) == EffectsPart()


def test_only_what_the_case_names_is_called_idle():
    """A table of a gear alone uses no effect of pairs: that the description calls for some needs no remark."""
    quiet, named = case(results=("geometry",)), case(results=("geometry",), effects={"hertz": "linear"})
    assert make_plan(quiet, STAGES).remarks == ()
    (said,) = make_plan(named, STAGES).remarks
    assert said.startswith(
        'effects.hertz has no influence on the requested results; request "load-sharing" or "transmission-error" or '
        '"root-stress-history" or "mesh-stiffness-revolution" ('
    )
    assert said.endswith(" results include it), or switch the effect off.")


def test_python_and_a_case_file_start_alike():
    gear = {name: {**keys, "bore_radius": "8 mm"} for name, keys in GEARS.items()}
    compliance = {"source": "weber-banaschek"}
    pair = fegear.Pair(
        *(fegear.Gear(name=name, **keys) for name, keys in gear.items()), compliance=compliance
    )  # teeth, module, ... by keyword
    asked = fegear.load_sharing(pair, torque="60 N*m", progress=False)
    written = fegear.run(
        {
            "results": ["load-sharing"], "gear": gear, "effects": {"start": "described"},
            "pair": {"I": {"driver": "a", "driven": "b", "torque": "60 N*m", "compliance": compliance}},
        },
        progress=False,
    )  # fmt: skip
    assert str(asked.values) == str(written.values)
    off = fegear.load_sharing(pair, torque="60 N*m", effects={"start": "none"}, progress=False)
    assert str(off.values) != str(asked.values)


def test_a_slip_in_the_start_is_refused_and_every_effect_has_its_facts():
    with pytest.raises(InputError, match=r"effects\.start"):
        case(effects={"start": "all"})
    assert set(EFFECTS) == set(EffectsPart.model_fields) - {"start"}


def test_which_effects_teeth_gaps_motions_and_widths_have():
    """A spacing error is felt at any width, a misalignment only by a face; an odd tooth only over a revolution."""
    kinds = (AT_REST, GAPS, ROOT_EFFECTS, MOTION_EFFECTS, ("odd_teeth",))
    assert sorted(name for names in kinds for name in names) == sorted(EFFECTS)
    assert set(AT_REST) >= TEETH
    assert set(GAPS) >= {"relief", "spacing_errors", "misalignment"}
    assert set(MOTION_EFFECTS) >= {"contact_loss", "friction", "parametric", "torque_ripple"}
    assert {*WIDE_EFFECTS, *PLANE_EFFECTS} == {*AT_REST, *GAPS}
    assert {*WIDE_EFFECTS} & {*PLANE_EFFECTS} >= TEETH | {"relief", "spacing_errors"}
    assert "misalignment" not in PLANE_EFFECTS


@pytest.mark.parametrize(("given", "taken"), [(False, "none"), (True, "load-dependent"), ("linear", "linear")])
def test_an_effect_with_words_takes_true_and_false_too(given, taken):
    assert EffectsPart.model_validate({"hertz": given}).hertz == taken
    with pytest.raises(ValueError, match="load-dependent"):
        EffectsPart.model_validate({"hertz": 0})
