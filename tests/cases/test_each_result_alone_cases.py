"""A law over all cases: a result gives the same numbers, under the same names, whatever else a case asks for."""

import math
from pathlib import Path

import pytest

from fegear.base.errors import FegearError, InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
#: Results of one loaded or unloaded pair, which say much of the same things: asked for besides those of each case.
OF_PAIRS = ("geometry", "load-sharing", "transmission-error", "load-distribution", "root-stress-history",
            "tooth-contact", "gear-mesh-power-loss")  # fmt: skip
COARSE = ("accuracy.tolerance=0.1",)
#: A spur pair whose key gives no width: plane teeth for all results but load-distribution.
SPUR = """results = ["load-sharing"]
[gear.a]
teeth = 20
module = "2 mm"
face_width = "4 mm"
[gear.b]
teeth = 20
module = "2 mm"
face_width = "4 mm"
[pair.I]
driver = "a"
driven = "b"
load = "400 N"
compliance = { source = "weber-banaschek" }
[load_distribution]
positions = 4
panels = 4
[accuracy]
tolerance = 0.3
"""
#: What a loss of power needs besides.
LOSS = ("effects.friction=true", 'pair.I.speed="1000 rpm"', "pair.I.friction={ coefficient = 0.05 }")


def scene_of(path, results, *more):
    return read_scene(path, [*more, f"results={list(results)!r}"])


def possible(path, results, *more):
    """Those of some results, in order, that a case can have together."""
    found = []
    for result in results:
        try:
            make_plan(scene_of(path, [*found, result], *more), STAGES)
        except FegearError:
            continue
        found.append(result)
    return found


def values_of(path, results, cache, *more):
    scene = scene_of(path, results, *more)
    found = run_plan(scene, make_plan(scene, STAGES), cache=cache)
    return dict(found.values.items()), {table.name for table in found.tables}


def same(one, other):
    both = (one.si, other.si), (one.si_error, other.si_error)
    return (one.unit, one.meaning) == (other.unit, other.meaning) and all(
        a == b or (a is not None and b is not None and math.isnan(a) and math.isnan(b)) for a, b in both
    )


def each_alone(path, results, *more, cache=None):
    """Names of values that differ, or are there only once, by the result that was asked for alone."""
    cache = cache or SolutionCache()
    together, tables = values_of(path, results, cache, *more)
    seen, wrong, alone_tables = set(), {}, set()
    for result in results:
        alone, its_tables = values_of(path, [result], cache, *more)
        off = {name for name, value in alone.items() if name not in together or not same(value, together[name])}
        if off:
            wrong[result] = sorted(off)
        seen |= set(alone)
        alone_tables |= its_tables
    if set(together) - seen:
        wrong["all together"] = sorted(set(together) - seen)
    if tables ^ alone_tables:
        wrong["tables"] = sorted(tables ^ alone_tables)
    return wrong


def every_case():
    return sorted(path.relative_to(CASES).with_suffix("").as_posix() for path in CASES.rglob("*.toml"))


def test_a_plane_pair_states_the_same_alone_and_together(tmp_path):
    """The cheapest pair that has them all, of the ordinary run; the others have widths, or are cases of the gallery."""
    path = tmp_path / "spur.toml"
    path.write_text(SPUR)
    results = ("geometry", "load-sharing", "transmission-error", "gear-mesh-power-loss", "tooth-geometry-check")
    assert possible(path, results, *LOSS) == list(results)
    assert each_alone(path, results, *LOSS) == {}


@pytest.mark.dear
def test_a_pair_with_a_width_states_the_same_alone_and_together():
    """The numbers that load sharing, transmission error and load distribution have in common, at coarse settings."""
    more = (
        "accuracy.tolerance=0.3", "load_distribution.positions=5", "load_distribution.panels=4",
        'pair.I.width="slices"', 'pair.I.loads=["10 kN"]', "effects.corner_contact=false", "tooth_contact.positions=40",
        "gear.gear.teeth=30", 'gear.gear.bore_radius="45 mm"',
    )  # fmt: skip
    results = ("load-sharing", "transmission-error", "load-distribution", "tooth-contact")
    assert each_alone(CASES / "litvin_under_load.toml", results, *more) == {}


@pytest.mark.dear
def test_plane_and_wide_teeth_of_one_pair_have_numbers_of_their_own(tmp_path):
    """Two models, two numbers, two names: none of them goes with what else is asked for."""
    path = tmp_path / "spur.toml"
    path.write_text(SPUR)
    results = ("transmission-error", "load-distribution", "load-sharing")
    cache = SolutionCache()
    assert each_alone(path, results, cache=cache) == {}
    values, _ = values_of(path, results, cache)
    for name in ("te_mean", "te_peak_to_peak", "largest_share", "largest_hertz_pressure"):
        assert {f"I.{name}", f"I.wide_{name}"} <= set(values)


@pytest.mark.long
@pytest.mark.parametrize("name", every_case())
def test_each_result_alone_gives_what_all_give_together(name):
    path = CASES / f"{name}.toml"
    own = read_scene(path).case.results
    try:
        read_scene(path, COARSE)
        more = COARSE
    except InputError:
        more = ()
    results = possible(path, list(dict.fromkeys((*own, *OF_PAIRS))), *more)
    assert each_alone(path, results, *more) == {}
