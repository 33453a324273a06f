"""Equal inputs are computed once where a cache is shared: what is recalled, what is not, and that both are said."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache, arrays_of
from fegear.case.reading import build_scene
from fegear.engine.joined_names import WORDS
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

COARSE = {"tolerance": 0.1}


def run(cache, *, load="1000 N", names=("p", "w"), title="", **gear):
    first, second = names
    document = {
        "title": title,
        "results": ["stiffness", "load-sharing", "transmission-error", "root-stress-history"],
        "gear": {
            first: {"teeth": 20, "module": "2 mm", "bore_radius": "9 mm", "face_width": "10 mm", **gear},
            second: {"teeth": 31, "module": "2 mm", "bore_radius": "15 mm", "face_width": "10 mm"},
        },
        "pair": {"I": {"driver": first, "driven": second, "load": load}},
        "effects": {"neighbour_coupling": True},
        "accuracy": COARSE,
    }
    scene = build_scene(document, "case", Path())
    return run_plan(scene, make_plan(scene, STAGES), cache=cache)


@pytest.fixture(scope="module")
def first():
    cache = SolutionCache()
    return cache, run(cache)


def recalled(results) -> set[str]:
    return {str(task) for task, timing in results.timings.items() if timing.recalled}


def test_a_second_run_recalls_everything_and_says_so(first):
    cache, before = first
    after = run(cache, title="the title changes no number")
    assert recalled(before) == set()
    assert recalled(after) == {str(task) for task in after.outcomes}
    assert {timing.origin for timing in after.timings.values()} == {"recalled"}
    assert any("From cache" in remark for remark in after.cache_remarks)
    for one, two in zip(before.tables, after.tables, strict=True):
        assert one.name == two.name
        for a, b in zip(one.columns, two.columns, strict=True):
            assert np.array_equal(a.values, b.values)
    assert sum(after.seconds.values()) < 0.5 * sum(before.seconds.values())


def test_what_is_tabulated_of_a_solved_gear_does_not_hold_it_in_a_circle(first):
    """Such a circle keeps some 35 MB for each gear tried until the collector happens to look there."""
    _, results = first
    solved = [o.data for task, o in results.outcomes.items() if task.stage == "gear-solution"]
    assert len(solved) == 2
    for influence in solved:
        held = sum(arrays_of(influence.tabulated).values())
        assert 0 < held < 0.02 * sum(arrays_of(influence).values())


def test_what_is_held_is_the_same_whether_or_not_its_parts_have_been_looked_through(first):
    _, results = first
    known = {}
    for outcome in results.outcomes.values():
        found = arrays_of(outcome.data, known)
        assert found == arrays_of(outcome.data)
        known[id(outcome.data)] = found


@pytest.mark.dear
def test_a_changed_load_solves_no_gear_again(first):
    cache, _before = first
    after = run(cache, load="1100 N")
    assert recalled(after) == {"gear-solution of p", "gear-solution of w", "stiffness of p", "stiffness of w"}
    fresh = run(None, load="1100 N")
    for one, two in zip(fresh.tables, after.tables, strict=True):
        for a, b in zip(one.columns, two.columns, strict=True):
            assert np.array_equal(a.values, b.values)


def test_a_changed_gear_leaves_the_other_gear_alone(first):
    cache, _ = first
    after = run(cache, profile_shift=0.1)
    assert "gear-solution of w" in recalled(after)
    assert not recalled(after) & {"gear-solution of p", "stiffness of p", "loaded-pair of I", "transmission-error of I"}


def test_other_names_recall_the_numbers_under_their_own_names(first):
    cache, _ = first
    after = run(cache, names=("pinion", "wheel"))
    assert recalled(after) == {str(task) for task in after.outcomes}
    assert {table.name for table in after.tables} >= {"stiffness_pinion", "root_stress_history_I_wheel"}


def test_the_order_of_the_gears_in_the_case_is_kept(first):
    cache, _ = first
    document = {"results": ["geometry"], "gear": {}}
    for order in (("a", "b"), ("b", "a")):
        document["gear"] = {name: {"teeth": 20 if name == "a" else 30, "module": "1 mm"} for name in order}
        scene = build_scene(document, "case", Path())
        table = run_plan(scene, make_plan(scene, STAGES), cache=cache).tables["geometry"]
        assert tuple(table["gear"]) == order


def test_names_that_join_to_one_table_are_refused_by_the_plan(monkeypatch):
    """The table of harmonics of pair I and the transmission error of pair harmonics_I overwrote each other."""
    gears = {name: {"teeth": 24, "module": "2 mm", "face_width": "10 mm"} for name in ("p", "w")}
    pair = {"driver": "p", "driven": "w", "load": "1000 N", "compliance": {"source": "cornell"}}
    document = {"results": ["transmission-error"], "gear": gears, "pair": {"I": pair, "harmonics_I": pair}}
    scene = build_scene(document, "case", Path())
    with pytest.raises(InputError, match='"harmonics_I": joins to names of tables that "I" has'):
        make_plan(scene, STAGES)
    monkeypatch.setattr("fegear.engine.joined_names.WORDS", frozenset())  # a word that is not listed
    with pytest.raises(InputError, match="both have a table transmission_error_harmonics_I"):
        run_plan(scene, make_plan(scene, STAGES))


#: What makes tables and figures, by hand or as a part of a sheet; the text of its name comes first.
MAKERS = {"Table", "Figure", "DeferredFigure", "Rows", "EveryLoad", "Every", "Chart", "Over", "Map", "Bundle", "Family"}


def joined_words():
    """What names that results make go on with, where shorter ones end: of all texts with a name behind them."""
    stems = set()
    for path in sorted((Path(fegear.__file__).parent / "results").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.JoinedStr) and isinstance(node.values[0], ast.Constant):
                stem = node.values[0].value
                stems |= {stem[:-1]} if re.fullmatch(r"[a-z0-9_]+_", stem) else set()
            elif isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in MAKERS:
                given = [*node.args[:1], *(key.value for key in node.keywords if key.arg == "name")]
                names = [one.value for one in given if isinstance(one, ast.Constant)]
                stems |= {re.sub(r"_?\{.*", "", name) for name in names if isinstance(name, str)} - {""}
    return {long[len(stem) + 1 :] for stem in stems for long in stems if long.startswith(f"{stem}_")}


@pytest.mark.dear
def test_every_word_that_a_name_of_a_table_goes_on_with_is_known():
    found = joined_words()
    assert len(found) > 40
    assert found <= WORDS


def test_what_is_given_up_while_it_is_computed_is_not_kept():
    unwanted = [True]

    def check():
        if unwanted[0]:
            raise KeyboardInterrupt

    cache = SolutionCache(check=check)
    with pytest.raises(KeyboardInterrupt):
        cache.solve("a", lambda: 1)
    unwanted[0] = False
    assert cache.solve("a", lambda: 2).value == 2


def test_memory_is_bounded_by_the_bytes_of_what_is_held_and_shared_arrays_count_once():
    cache = SolutionCache()
    big = np.zeros(1_000_000 // 8)

    def add(key, *arrays):
        return cache.solve(key, lambda: {"one": [arrays], "two": (arrays[0][3:],)}).source

    add("a", big)
    add("b", big, np.zeros(25_000))  # 0.2 MB more
    add("c", np.zeros(50_000))
    assert not cache.shrink(1_700_000)
    assert not cache.shrink(1_600_000)
    assert cache.shrink(1_500_000)  # nothing was used since; a alone frees nothing, b does
    assert [add(key, big) for key in ("c", "a", "b")] == ["memory", "computed", "computed"]
    assert not cache.shrink(0)  # used just now
    assert [add(key, big) for key in ("c", "a")] == ["memory", "memory"]
    assert cache.shrink(0)
    assert [add(key, big) for key in ("c", "a", "b")] == ["memory", "memory", "computed"]


def test_what_recalls_from_a_cache_does_not_hold_all_that_lies_there():
    """A loaded pair keeps the cache that it recalls compliances from; it held all pairs before it, each move more."""
    cache = SolutionCache()
    for number in range(4):
        cache.solve(str(number), lambda: {"own": np.zeros(125_000), "recalls from": cache})
    assert sum(arrays_of(cache.solve("0", dict).value).values()) == 1_000_000
    cache.shrink(10_000_000)
    assert cache.shrink(2_500_000)  # two of four are forgotten, not all
    assert [cache.solve(number, dict).source for number in "301"] == ["memory", "memory", "computed"]
