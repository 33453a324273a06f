"""What is off calls nothing: counted by Python's profiler, with all effects off and with each one on by itself.

And what neglected effects would change is estimated where a case, a run or a question asks for it, nowhere else.
"""

import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

import fegear
from fegear.base.effects import EFFECTS, PLANE_EFFECTS
from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.base.tally import tallying
from fegear.case.reading import read_scene
from fegear.engine.executor import Executor
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES
from fegear.studies.sweep import read_axis, sweep_case

CASES = Path(__file__).parents[2] / "cases"
TIP = "gear.a.relief={ tip = { amount = '20 um', normalised_length = 1.0 } }"
SPACING = "gear.a.spacing_errors={ values = [" + ", ".join(["'3 um'", *["'0 um'"] * 27]) + "] }"
OFF = {name: EFFECTS[name].off or "false" for name in PLANE_EFFECTS}
#: The functions that do an effect's work: a module and how their names begin.
WORK = {
    "corner_contact": ("contact/plane/corner.py", ""),
    "neighbour_coupling": ("contact/plane/fe_compliance.py", "FiniteElementCompliance.neighbour"),
    "hertz": ("contact/plane/coupled_teeth.py", "CoupledTeeth.half_width"),
    "relief": ("geometry/relief.py", ("CombinedRelief.removal", "EndRelief.removal")),
    "spacing_errors": ("contact/plane/engagement.py", "Engagement.spacing"),
    "neglected": ("contact/plane/neglected_effects.py", ""),
}


def scene(*overrides: str, **effects: str):
    given = (f"effects.{name}={value}" for name, value in (OFF | effects).items())
    wanted = 'results=["transmission-error", "load-sharing"]'
    few = ("accuracy.tolerance=1e-2", "pair.I.loads=['350 N']", wanted, TIP, SPACING)
    return read_scene(CASES / "calculix_pair.toml", (*few, *given, *overrides))


def called(of) -> set[str]:
    """Whose work was done in a run, the gears' finite elements recalled."""
    found: Counter = Counter()
    plan = make_plan(of, STAGES)
    run_plan(of, plan, cache=CACHE)  # what is imported and solved once is no call of an effect

    def note(frame, event, _argument):
        if event == "call" and "fegear" in frame.f_code.co_filename:
            found[frame.f_code.co_filename.split("fegear/")[-1], frame.f_code.co_qualname] += 1

    sys.setprofile(note)
    try:
        run_plan(of, plan, cache=SolutionCache())
    finally:
        sys.setprofile(None)
    assert sum(found.values()) > 1000
    return {
        effect
        for effect, (module, names) in WORK.items()
        if any(where == module and name.startswith(names) for where, name in found)
    }


@pytest.mark.dear("corner_contact", "neighbour_coupling", "spacing_errors")
@pytest.mark.parametrize("effect", [None, *OFF])
def test_only_the_effects_that_are_on_are_worked_at(effect):
    assert effect in {None, *WORK}, "name the functions in WORK that no other effect calls"
    on = {} if effect is None else {effect: "true" if EFFECTS[effect].on is True else EFFECTS[effect].on}
    assert called(scene("neglected=false", **on)) == set(on)


def test_estimates_of_what_is_neglected_are_asked_for_and_counted():
    """They look at corners, reliefs, neighbours: the tally says so."""
    plan = make_plan(scene(), STAGES)
    counts = {}
    for asked in ("true", "false"):
        of = scene(f"neglected={asked}")
        with tallying() as found:
            counts[asked] = found
            results = run_plan(of, plan, cache=CACHE)
        said = [remark for remark in results.remarks if "; including it changes" in remark]
        assert bool(said) == (asked == "true")
    assert counts["true"]["neglected effects"] == len(OFF)
    assert counts["true"]["corner searches"] > 0 == counts["false"]["corner searches"]
    assert counts["false"]["neglected effects"] == 0


def test_no_number_depends_on_the_estimates():
    one, other = (
        run_plan(s, make_plan(s, STAGES), cache=CACHE) for s in (scene("neglected=true"), scene("neglected=false"))
    )
    assert [(v.name, v.si, v.si_error) for v in one.values] == [(v.name, v.si, v.si_error) for v in other.values]
    for a, b in zip(one.tables, other.tables, strict=True):
        for left, right in zip(a.columns, b.columns, strict=True):
            assert np.array_equal(left.si, right.si, equal_nan=True)


def test_a_run_estimates_by_itself_and_a_case_may_say_otherwise():
    assert scene().sizes_neglected
    assert not replace(scene(), neglects=False).sizes_neglected
    assert replace(scene("neglected=true"), neglects=False).sizes_neglected
    assert not scene("neglected=false").sizes_neglected
    assert not replace(scene("neglected=true"), estimates=False).sizes_neglected
    with pytest.raises(InputError, match="neglected"):
        scene("neglected=sometimes")


@pytest.mark.parametrize(("given", "points"), [((), 0), (('neglected="once"',), 1), (("neglected=true",), 3)])
def test_points_of_a_sweep_estimate_only_where_it_is_asked_for(given, points):
    few = ("pair.I.loads=['350 N']", 'results=["transmission-error"]', "effects.corner_contact=false", *given)
    axes = [read_axis("accuracy.tolerance=0.01,0.011,0.012")]
    found = sweep_case(CASES / "calculix_pair.toml", axes, few, cache=SolutionCache(), executor=Executor(here=True))
    assert not found.failures
    said = [any("corner_contact is off" in remark for remark in point.remarks) for point in found.points]
    assert said == [i < points for i in range(3)]


def test_questions_from_python_estimate_only_where_it_is_asked_for():
    pair = fegear.Pair(fegear.Gear(20, "3 mm", face_width="10 mm"), fegear.Gear(31, "3 mm", face_width="10 mm"))
    off = {"corner_contact": False}
    for asked in (False, True):
        found = fegear.transmission_error(pair, torque="60 N*m", effects=off, tolerance=1e-2, neglected=asked)
        assert any("corner_contact is off" in remark for remark in found.remarks) == asked
