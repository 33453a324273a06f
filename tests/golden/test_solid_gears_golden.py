"""Estimates of solid gears against references that share little with them: see make_solid_gears.py."""

import importlib.util
import json
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from fegear.fem.solid.influence import solid_influence
from fegear.fem.solid.table import solid_table
from fegear.geometry.gear import Gear, Material

HERE = Path(__file__).parent
KNOWN = json.loads((HERE / "solid_gears.json").read_text())
#: Places up the flank, as a share of it, below which root tension is left out of a gear's own estimate.
ABOVE_FOOT = 0.35
#: Which of a gear's own estimates speaks of a quantity.
OF = {
    **{f"{what} {width}": "contact" for what in ("own", "even", "beside") for width in ("0.02", "0.1")},
    "next": "neighbour", "prev": "neighbour", "tension": "root_tension", "compression": "root_compression",
}  # fmt: skip

#: That of the ordinary run.
QUICK = ("z 33, 35 degrees left",)

sys.path.insert(0, str(HERE))
_spec = importlib.util.spec_from_file_location("make_solid_gears", HERE / "make_solid_gears.py")
generator = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(generator)


def apart(one, other):
    """How far two solutions differ, quantity by quantity: the worst of all contact lines, as estimates have it.

    Own and even loads and the largest root stress of a load over themselves, tension of loads above the flank's foot;
    neighbours and places beside a load over the largest of its own.
    """
    found = dict.fromkeys(OF, 0.0)
    for first, second in zip(one, other, strict=True):
        a, b = ({key: np.asarray(value) for key, value in line.items()} for line in (first, second))
        line = {}
        for width in generator.CONTACTS:
            own, even, beside = (f"{what} {width}" for what in ("own", "even", "beside"))
            line[own] = np.abs(b[own] / a[own] - 1.0).max()
            line[even] = np.abs(b[even] / a[even] - 1.0).max()
            line[beside] = np.abs(b[beside] - a[beside]).max() / a[own].max()
        for key in ("next", "prev"):
            line[key] = np.abs(b[key] - a[key]).max() / a["own 0.02"].max()
        high = a["place"][generator.loads_among(a["place"].size)] > ABOVE_FOOT
        for side, sign, counts in (("tension", 1.0, high), ("compression", -1.0, np.ones_like(high))):
            largest = [(sign * x[side]).max(axis=0) for x in (a, b)]
            line[side] = np.abs(largest[1] / largest[0] - 1.0)[counts].max(initial=0.0)
        found = {key: max(value, float(line[key])) for key, value in found.items()}
    return found


@cache
def solved(name):
    return solid_influence(*generator.problem_of(generator.GEARS[name]))


@cache
def own_estimates(name):
    """True errors over the whole gear and its own estimates of them, by quantity."""
    known = solved(name)
    truth = apart(generator.quantities(known.fine, generator.GEARS[name]), KNOWN[name]["first"])
    return {key: (value, known.error[OF[key]]) for key, value in truth.items()}


def largest(table, side, sign, row, column, at):
    """Largest root stress of bands over the places along the face that the references know."""
    root = table.root[side]
    along = CubicSpline(root.places, root.along[row, column], axis=1)
    return [np.max(sign * along(line["stations"])[i]) for i, (line, _, _) in enumerate(at)]


@cache
def table_estimates(name):
    """True and estimated errors of the table's entries: the entry that is told least, by quantity."""
    tooth, tau, width, nu, bore = generator.problem_of(generator.GEARS[name])
    hand = "spur" if tau == 0.0 else "right" if tau > 0.0 else "left"
    gear = Gear(tooth, 1.0, bore, face_width=width, material=Material(1.0, nu), hand=hand)
    at = [
        (line, load, i)
        for line in KNOWN[name]["first"]
        for load, i in enumerate(generator.loads_among(len(line["radius"])))
        if load == 1 or abs(abs(line["stations"][i]) - 0.5 * width) < 1e-9
    ]
    radii, places = (np.array([line[key][i] for line, _, i in at]) for key in ("radius", "stations"))
    positions, column = np.unique(places, return_inverse=True)
    table = solid_table(gear, solved(name), radii, positions, 0.02)
    row, found = np.arange(len(at)), {}
    scale = {"c_self": table.c_self, "c_neighbour": table.c_next}
    scale |= {f"root_{side}": np.abs(root.value) for side, root in table.root.items()}
    for key, entries, of, exact in (  # root stress at the references' places, between which the table's may be larger
        ("c_self", table.c_self, "c_self", [line["own 0.02"][i] for line, _, i in at]),
        ("c_next", table.c_next, "c_neighbour", [line["next"][load][i] for line, load, i in at]),
        ("c_prev", table.c_prev, "c_neighbour", [line["prev"][load][i] for line, load, i in at]),
        *(
            (f"root_{side}", largest(table, side, sign, row, column, at), f"root_{side}",
             [np.max(sign * np.array(line[side])[:, load]) for line, load, _ in at])
            for side, sign in (("tension", 1.0), ("compression", -1.0))
        ),
    ):  # fmt: skip
        chosen = np.array(entries) if np.ndim(entries) == 1 else entries[row, column]
        true = np.abs(chosen / np.array(exact) - 1.0)
        told = table.errors[of][row, column] / scale[of][row, column]
        least = np.argmax(true / told)
        found[key] = float(true[least]), float(told[least])
    return found


def told_too_little(estimates, names):
    """Gears of which some true error exceeds its estimate, by quantity."""
    found = {}
    for name in names:
        for key, (true, told) in estimates(name).items():
            if not true <= told:
                found.setdefault(key, []).append((name, true, told))
    return found


@pytest.mark.dear
@pytest.mark.parametrize("estimates", [own_estimates, table_estimates])
def test_a_solid_gear_is_no_further_off_than_it_tells(estimates):
    assert not told_too_little(estimates, QUICK)


@pytest.mark.long
@pytest.mark.parametrize("estimates", [own_estimates, table_estimates])
def test_of_all_solid_gears_at_most_one_is_further_off_than_it_tells(estimates):
    assert len(KNOWN) == 12
    # A table's bands reach half a module: hats on the widest gear are wider.
    names = [name for name in KNOWN if estimates is own_estimates or generator.GEARS[name]["width"] <= 12.0]
    for key, gears in told_too_little(estimates, names).items():
        assert len(gears) <= 1, (key, gears)


@pytest.mark.long
def test_usual_settings_are_within_the_errors_that_the_theory_page_tells():
    for name in KNOWN:
        errors = {key: true for key, (true, _) in own_estimates(name).items()}
        assert max(value for key, value in errors.items() if OF[key] == "contact") < 0.025, name
        assert max(errors["next"], errors["prev"]) < 3e-4, name
        assert max(errors["tension"], errors["compression"]) < 0.065, name
