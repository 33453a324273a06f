"""What a case neglects is reported with its size, and the size is that of the run with the effect on."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.case.built.neglected_effects import neglected_remarks
from fegear.case.reading import build_scene, read_scene
from fegear.contact.plane.pair_history import pair_history
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
COARSE = "accuracy.tolerance=1e-2"
OFF = {
    "corner_contact": "false", "neighbour_coupling": "false", "hertz": "none", "relief": "false",
    "spacing_errors": "false",
}  # fmt: skip
ON = {**dict.fromkeys(OFF, "true"), "hertz": "load-dependent"}
#: Pairs and loads: equal and unequal gears, two and three pairs in contact, finite elements and a closed form.
PAIRS = {
    "calculix_pair": (
        "pair.I.loads=['20 N', '800 N']",
        'results=["load-sharing", "transmission-error", "root-stress-history"]',
    ),
    "pinion_and_wheel": ("pair.I.loads=['300 N', '9000 N']", 'results=["transmission-error", "load-sharing"]'),
    "high_contact_ratio": ("pair.I.loads=['500 N']", 'results=["transmission-error", "load-sharing"]'),
    "lin_tip_relief": ("pair.I.loads=['2000 N', '11000 N']", 'results=["transmission-error", "load-sharing"]'),
}  # fmt: skip


@functools.cache
def run(name: str, *overrides: str):
    scene = read_scene(CASES / f"{name}.toml", (COARSE, *PAIRS.get(name, ()), *overrides))
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


def inputs_of(results):
    """What the loaded pair was estimated for: the results that read it say so."""
    (step,) = (step for step in results.plan.steps if step.task == Task("loaded-pair", "I"))
    return step.inputs(results.scene)


def columns(results, table: str) -> dict[str, np.ndarray]:
    found = next(t for t in results.tables if t.name == table)
    return {column.name: column.si for column in found.columns}


def true_change(before, after, answer: str, load: float) -> float:
    """Between two runs, from what they wrote down."""
    if answer == "root tension":

        def largest(results):
            return max(
                c["stress"].max()
                for c in (columns(results, t.name) for t in results.tables if t.name.startswith("root_stress_history"))
            )

        return abs(largest(after) - largest(before))
    table, column = {
        "transmission error": ("transmission_error_loads_I", "te"),
        "load on a tooth pair": ("load_sharing_loads_I", "load"),
    }[answer]
    a, b = (columns(results, table) for results in (before, after))
    (xa, ya), (xb, yb) = ((c["x"][c["total_load"] == load], c[column][c["total_load"] == load]) for c in (a, b))
    # beside a jump the two tables' positions differ
    x = np.union1d(xa, xb)
    inside = (x >= max(xa[0], xb[0])) & (x <= min(xa[-1], xb[-1]))
    shared = np.interp(x, xb, yb) - np.interp(x, xa, ya)
    off = np.interp(x, xb, yb)[~inside] if answer == "load on a tooth pair" else np.zeros(0)
    return float(np.abs(np.concatenate([shared[inside], off])).max())


def true_load_change(before, after, load: float) -> float:
    """Between two runs' engagements, a tooth pair followed over twenty thousand positions."""
    histories = []
    for results in (before, after):
        engagement = results.outcomes[Task("loaded-pair", "I")].data.engagement
        histories.append(pair_history(engagement, [load], 20_000))
    x = np.unique(np.concatenate([h.x for h in histories]))
    a, b = (np.interp(x, h.x, h.load[:, 0], left=0.0, right=0.0) for h in histories)
    return float(np.abs(b - a).max())


def effects(**chosen: str) -> tuple[str, ...]:
    return tuple(f"effects.{name}={value}" for name, value in chosen.items())


@pytest.mark.dear
@pytest.mark.parametrize(
    ("name", "effect", "among"),
    [
        ("calculix_pair", "corner_contact", {}),
        pytest.param(
            *("calculix_pair", "neighbour_coupling", {"hertz": "load-dependent", "corner_contact": "true"}),
            marks=pytest.mark.long,
        ),
        pytest.param(
            *("calculix_pair", "hertz", {"neighbour_coupling": "true", "corner_contact": "true"}),
            marks=pytest.mark.long,
        ),
        pytest.param(
            *("calculix_pair", "corner_contact", {"hertz": "load-dependent", "neighbour_coupling": "true"}),
            marks=pytest.mark.long,
        ),
        pytest.param(*("pinion_and_wheel", "corner_contact", {"hertz": "load-dependent"}), marks=pytest.mark.long),
        pytest.param(*("pinion_and_wheel", "neighbour_coupling", {}), marks=pytest.mark.long),
        ("pinion_and_wheel", "hertz", {}),
        ("high_contact_ratio", "corner_contact", {"hertz": "load-dependent"}),
        pytest.param(
            *("high_contact_ratio", "neighbour_coupling", {"hertz": "load-dependent"}), marks=pytest.mark.long
        ),
        ("lin_tip_relief", "corner_contact", {"relief": "true", "hertz": "load-dependent"}),
        pytest.param(*("lin_tip_relief", "hertz", {"relief": "true"}), marks=pytest.mark.long),
        ("lin_tip_relief", "relief", {"hertz": "load-dependent"}),
    ],
)
def test_the_reported_size_is_that_of_the_run_with_the_effect_on(name, effect, among):
    off = {**OFF, **among, effect: OFF[effect]}
    before = run(name, *effects(**off))
    after = run(name, *effects(**{**off, effect: ON[effect]}))
    pair = before.outcomes[Task("loaded-pair", "I")].data
    inputs = inputs_of(before)
    compared = 0
    for load in (pair.loads[0], pair.nominal, pair.loads[-1]):
        found = pair.neglects(inputs.answers, [load])
        assert not found.wrong
        for change in found.changes[effect]:
            if change.answer == "root tension" and load != pair.nominal:
                continue  # its values are for the nominal load
            true = true_change(before, after, change.answer, load)
            # straight lines between the positions of the load's table leave about a hundredth of the load
            seen = 0.03 if change.answer == "load on a tooth pair" else 1e-3
            if true < seen * change.scale:
                assert change.share < 2.0 * seen
                continue
            assert 0.5 * true < abs(change.size) < 2.0 * true, (change, true)
            compared += 1
    assert compared >= 1


@pytest.mark.dear("corner_contact")
@pytest.mark.parametrize("effect", ["corner_contact", "neighbour_coupling", "hertz"])
def test_it_is_reported_above_the_tolerance_and_not_below(effect):
    results = ('results=["transmission-error"]',)
    off = {"corner_contact": "true", "neighbour_coupling": "true", "hertz": "load-dependent", effect: OFF[effect]}
    asked = (*results, *effects(**off))
    before, after = (
        run("calculix_pair", *asked),
        run("calculix_pair", *results, *effects(**{**off, effect: ON[effect]})),
    )
    pair = before.outcomes[Task("loaded-pair", "I")].data
    load, te = pair.loads[-1], columns(before, "transmission_error_loads_I")
    share = true_change(before, after, "transmission error", load) / te["te"][te["total_load"] == load].mean()

    def remarks_at(tolerance: float) -> list[str]:
        scene = before.scene
        found = pair.neglects(("transmission error",), [load])
        return [r for r in neglected_remarks("I", found, scene.case.effects, tolerance, load) if effect in r]

    assert len(remarks_at(share / 2.2)) == 1
    assert remarks_at(share * 2.2) == []
    remark = remarks_at(share / 2.2)[0]
    line = f'{effect} = "load-dependent"' if effect == "hertz" else f"{effect} = true"
    assert f"Set {line} under [effects]." in remark
    assert " um (" in remark


def test_nothing_is_reported_where_everything_is_on():
    on = effects(corner_contact="true", neighbour_coupling="true", hertz="load-dependent")
    assert not [r for r in run("calculix_pair", *on).remarks if "; including it changes" in r]


def test_wrong_data_of_an_effect_that_is_off_does_not_stop_the_run():
    far = "gear.a.relief={ tip = { amount = '10 um', start_radius = '900 mm' } }"
    results = run("lin_tip_relief", "effects.relief=false", far)
    assert any("relief is off; its influence cannot be estimated from the data specified" in r for r in results.remarks)


def test_neglected_spacing_errors_are_reported_with_their_size():
    errors = [0.0] * 28
    errors[5] = 4.0
    given = "gear.a.spacing_errors={ values = [" + ", ".join(f"'{e} um'" for e in errors) + "] }"
    results = run("lin_tip_relief", "effects.relief=false", given)
    remark = next(r for r in results.remarks if r.startswith("Pair I: spacing_errors is off"))
    # the pair alone on the path takes the whole error; both gears are the same part
    assert "by +8 um" in remark


WHOLE = {"neighbour_coupling": True, "hertz": "load-dependent", "corner_contact": True}


def random_pair(seed: int):
    """Teeth, shifts, face, bore and load at random: the load, and what makes and runs the pair with chosen effects."""
    dice = np.random.default_rng(seed)
    gears = {
        name: {
            "teeth": int(dice.integers(17, 70)),
            "module": "3 mm",
            "profile_shift": float(dice.uniform(-0.1, 0.4)),
            "bore_radius": "12 mm",
            "face_width": "10 mm",
        }
        for name in ("a", "b")
    }
    load = float(10.0 ** dice.uniform(1.5, 4.0))
    pair = {"I": {"driver": "a", "driven": "b", "load": f"{load} N", "loads": [f"{0.5 * load} N"]}}
    parts = {"gear": gears, "pair": pair, "accuracy": {"tolerance": 1e-2}}

    def made(*wanted: str, **chosen):
        built = build_scene({**parts, "results": list(wanted), "effects": chosen}, "case", Path())
        return run_plan(built, make_plan(built, STAGES), cache=CACHE)

    return load, made


def largest_tension(results, load: float) -> float:
    """Of both gears over four thousand roll positions."""
    e = results.outcomes[Task("loaded-pair", "I")].data.engagement
    x = e.pair.x_start + e.pair.base_pitch * (np.arange(4000) + 0.5) / 4000
    beside = [b + side * 1e-7 * e.pair.base_pitch for b in e.breaks for side in (-1.0, 1.0)]
    state = e.solve(e.grid(np.concatenate([x, beside]), again=False), [load])
    return max(float(root_stress_history(e, state, member).largest[0]) for member in ("driver", "driven"))


@pytest.mark.long
@pytest.mark.parametrize("seed", range(30))
def test_sizes_of_root_tension_of_random_pairs(seed):
    """Within a factor of two of brute force, and so is the difference of two runs: both peaks are found."""
    load, made = random_pair(seed)
    after = made("root-stress-history", **WHOLE)
    stress = largest_tension(after, load)

    def headline(results) -> float:
        return max(v.si for v in results.values if v.name.endswith("largest_root_tension"))

    assert (1.0 - 1e-6) * stress <= headline(after) <= (1.0 + 5e-4) * stress  # which misses kinks by its own step
    for effect in WHOLE:
        before = made("root-stress-history", **{name: value for name, value in WHOLE.items() if name != effect})
        inputs = inputs_of(before)
        pair = before.outcomes[Task("loaded-pair", "I")].data
        (change,) = pair.neglects(inputs.answers, [load]).changes[effect]
        true = stress - largest_tension(before, load)
        if abs(true) < 3e-4 * change.scale:
            assert change.share < 6e-4
        else:
            assert 0.5 < change.size / true < 2.0, (effect, change, true)
            assert 0.5 < (headline(after) - headline(before)) / true < 2.0, (effect, true)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(30))
def test_sizes_of_random_pairs_and_loads(seed):
    """Every reported size is within a factor of two of the run's."""
    load, made = random_pair(seed)
    results = ("transmission-error", "load-sharing")
    after = made(*results, **WHOLE)
    for effect in WHOLE:
        before = made(*results, **{name: value for name, value in WHOLE.items() if name != effect})
        inputs = inputs_of(before)
        pair = before.outcomes[Task("loaded-pair", "I")].data
        for change in pair.neglects(inputs.answers, [load]).changes[effect]:
            if change.answer == "load on a tooth pair":
                true = true_load_change(before, after, load)
            else:
                true = true_change(before, after, change.answer, load)
            if true < 1e-3 * change.scale:
                assert change.share < 2e-3
            else:
                assert 0.5 * true < abs(change.size) < 2.0 * true, (effect, change, true)
