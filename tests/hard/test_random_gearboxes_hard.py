"""Random gearboxes: any bearings, clearances and sizes are solved in balance, or refused in one sentence."""

import copy
import math
import random
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import FegearError
from fegear.case.built.shafts import gearbox_of
from fegear.case.reading import build_scene
from fegear.contact.wide.on_shafts import EvenForces, load_gearbox

CASE = tomllib.loads(Path(__file__).parents[2].joinpath("cases", "two_stage_shafts.toml").read_text(encoding="utf-8"))
FACTORS = (1e-12, 1e-6, 1e-3, 0.1, 0.5, 2.0, 10.0, 1e3, 1e6, 1e12, 1e20)


def _solved(case):
    """Misalignments over the faces under a third of the loads and all of them; balance is checked."""
    box = gearbox_of(build_scene(case, "box", Path()))
    even = [EvenForces(mesh.even / mesh.load) for mesh in box.meshes]
    states = load_gearbox(box, even, [1.0 / 3.0, 1.0])
    assert max(one.balance.max() for state in states for one in state.bent) < 1e-9
    return np.concatenate(
        [shares.over_face for state in states for shares, _ in box.misalignment(state.bent, state.forces)]
    )


def _sizes(table, path=()):
    """Places of quantities with a unit, those of the axes left aside: they must fit the centre distances."""
    for key, value in table.items() if isinstance(table, dict) else enumerate(table):
        if isinstance(value, (dict, list)) and key != "axis":
            yield from _sizes(value, (*path, key))
        elif isinstance(value, str) and value[0].isdigit():
            yield (*path, key)


def _in_a_sentence(case):
    try:
        found = _solved(case)
    except FegearError as error:
        text = str(error)
        assert text.endswith(".")
        assert "\n" not in text
        return
    assert np.isfinite(found).all()


def _any_size(seed):
    draw, case = random.Random(seed), copy.deepcopy(CASE)  # noqa: S311
    places = [(table, *place) for table in ("shaft", "bearing") for place in _sizes(case[table])]
    for _ in range(draw.choice([1, 2])):
        *above, key = draw.choice(places)
        table = case
        for step in above:
            table = table[step]
        number, unit = table[key].split(" ", 1)
        table[key] = f"{float(number) * draw.choice(FACTORS)!r} {unit}"
    return case


def _any_bearings(seed):
    """Linear, loose, balls and rollers with clearance or preload, two or three on each shaft, some of them overhung."""
    rng, case = np.random.default_rng(seed), copy.deepcopy(CASE)
    case["bearing"] = {}
    for name, shaft in case["shaft"].items():
        shaft["sections"] = [{"length": "120 mm", "outer": f"{rng.uniform(15.0, 60.0):.3f} mm"}]
        shaft["bearings"] = []
        for n, at in enumerate((5.0, rng.choice([60.0, 115.0]), 100.0)[: rng.integers(2, 4)]):
            stiffness, clearance = f"{10 ** rng.uniform(1.0, 3.5):.4g} N/um", f"{rng.uniform(-3.0, 30.0):.3g} um"
            loose = {"radial_clearance": f"{10 ** rng.uniform(-1, 2):.3g} um"} if rng.random() < 0.5 else {}
            ball = {"kind": "ball", "count": 9, "diameter": "12.7 mm", "pitch_diameter": "65 mm"}
            roller = ball | {"kind": "roller", "count": 14, "diameter": "10 mm", "roller_length": "12 mm"}
            kinds = [{"radial": stiffness} | loose, {"elements": ball | {"clearance": clearance}}]
            if n:
                kinds.append({"elements": roller | {"clearance": clearance}})
            data = kinds[rng.integers(len(kinds))]
            if not n and "radial" in data:
                data |= {"axial": "100 N/um", "axial_clearance": f"{rng.uniform(0.0, 20.0):.3g} um"}
            case["bearing"][f"{name}_{n}"] = data | ({"housing_radial": "500 N/um"} if rng.random() < 0.3 else {})
            shaft["bearings"].append({"bearing": f"{name}_{n}", "at": f"{at} mm"})
    return case


@pytest.mark.parametrize("first", [0, *(pytest.param(n, marks=pytest.mark.long) for n in range(12, 312, 50))])
def test_sizes_of_any_magnitude(first):
    for seed in range(first, first + (50 if first else 12)):
        _in_a_sentence(_any_size(seed))


@pytest.mark.dear
@pytest.mark.parametrize("first", [0, *(pytest.param(n, marks=pytest.mark.long) for n in range(8, 208, 50))])
def test_bearings_of_any_kind_find_their_balance(first):
    count, refused = 50 if first else 8, []
    for seed in range(first, first + count):
        try:
            assert np.isfinite(_solved(_any_bearings(seed))).all()
        except FegearError as error:
            refused.append(str(error))
    # So loose, or so soft, that a shaft lies askew by more than half a degree.
    assert all("is not small" in text or "is not small" in text for text in refused), refused
    assert len(refused) <= math.ceil(0.1 * count)


def test_a_shaft_without_axial_force_floats_in_its_clearance():
    case = copy.deepcopy(CASE)
    case["bearing"]["fixed"] = {"radial": "200 N/um", "axial": "100 N/um", "axial_clearance": "20 um"}
    play = _solved(case)
    case["bearing"]["fixed"]["axial_clearance"] = "0 um"
    assert play == pytest.approx(_solved(case), rel=1e-6)  # spur gears: where along its axis matters nothing
