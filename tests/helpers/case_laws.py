"""What laws that tie two runs of a case to each other share: changed documents, runs, and tables that are equal."""

import copy
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

import fegear
from fegear.base.units import quantity

CASES = Path(__file__).parents[2] / "cases"
EVERY = sorted(path.stem for path in CASES.glob("*.toml"))
#: A second or two each: a table of one gear, a plane pair, unloaded helical contact, modes and transmissibility.
ORDINARY = ("pinion_and_wheel", "litvin_lead", "blankenship_singh", "thin_rim")
SAME = 1e-9
#: Numbers with a scale of their own in any case: balls of whole sizes, ISO 6336 and ISO 1328 in mm, paint of 6.3 um, a
#: nanometre.
OWN_NUMBERS = re.compile(
    r"ball_diameter|over_balls|_iso$|^contact_pattern_|printed_share$|contact_I\.spread$|_tolerance$|[._]class$"
)
#: Where the ends of a band of equally good reliefs lie is known to the search's own step of 1e-3 (`_WITHIN`) or to what
#: is stated: how far apart two searches find them, which hangs on what either of them comes across. That is not
#: compared, nor errors that follow from it; the reliefs taken and what they leave are.
SEARCHED = re.compile(
    r"^grindable_\w+\.(?:(?:amount|start)_(?:from|to)|(?:amount|start_roll_angle|start_radius)(?=_error))(_error)?$"
)
SAME_SEARCHED = 1e-3
#: The relief that leaves the least: the least is flat there, and it is known to its stated error alone; what is left
#: has none, and is found again to the search's own digits.
OPTIMUM, SAME_LEAST = re.compile(r"\.optimum_\w+$"), 1e-5
#: Forces that phases cancel are zero, and their errors what round-off leaves.
CANCELLED = re.compile(r"^planet_forces_\w+\.force_\w+_error$")
#: An angle between two gears is a difference of angles of some radian: below this it has no digits left [rad].
SMALLEST_ANGLE = 1e-6
#: Where something is largest has half as many digits as how large it is.
PLACES, SAME_PLACE = re.compile(r"place_angle$"), 1e-6
#: Rows stand a ten-millionth of a base pitch beside changes of contact, where a pair bears as little of the load:
#: round-off of the place is some 1e-9 of what it bears, and of the secant and tangent there.
BESIDE_CHANGES = re.compile(r"^transmission_error_\w+\.(?:mesh_stiffness|local_stiffness|te_0)\b")
SAME_BESIDE_CHANGES = 5e-8


def case(name):
    return tomllib.loads((CASES / f"{name}.toml").read_text("utf-8"))


def changed(node, text=lambda one: one, key=lambda _path, one: one, path=()):
    """A copy of a document with other texts and keys."""
    if isinstance(node, dict):
        return {key(path, k): changed(v, text, key, (*path, k)) for k, v in node.items()}
    if isinstance(node, list):
        return [changed(v, text, key, path) for v in node]
    return text(node) if isinstance(node, str) else copy.copy(node)


def ran(document, monkeypatch):
    monkeypatch.chdir(CASES)
    return fegear.run(document, progress=False, cache=CACHE)


def smallest(unit):
    """The least size that numbers of a unit are compared with."""
    return SMALLEST_ANGLE if unit in {"arcsec", "arcmin", "deg", "rad"} else 0.0


def columns(results, names=lambda one: one):
    """All numbers by name: values in SI, unit, and the largest magnitude in that unit nearby."""
    found = {}
    for table in results.tables:
        numeric = [
            c for c in table.columns if c.si.dtype.kind in "fiu" and "seconds" not in c.name and c.unit != "s_cpu"
        ]
        for c in numeric:
            alike = [np.abs(d.si[np.isfinite(d.si)]).max(initial=0.0) for d in numeric if d.unit == c.unit]
            values = np.asarray(c.si, dtype=float)
            if c.name.startswith("shape_"):  # of a mode, which may as well be turned by half a period
                values = np.abs(values)
            found[names(f"{table.name}.{c.name}")] = values, c.unit, max(*alike, smallest(c.unit))
    sizes = {}
    for v in results.values:
        sizes[v.unit] = max(sizes.get(v.unit, 0.0), abs(v.si))
    for v in results.values:
        found[names(v.name)] = np.array([v.si]), v.unit, max(abs(v.si), 1e-3 * sizes[v.unit], smallest(v.unit))
    return found


def dimensions(q):
    """Exponents of length, mass and time."""
    return tuple(float(q.dimensionality.get(f"[{one}]", 0.0)) for one in ("length", "mass", "time"))


def assert_same(one, other, scales=(1.0, 1.0, 1.0), names=lambda name: name):
    a, b = columns(one), columns(other, names)
    if scales != (1.0, 1.0, 1.0):  # loads in a column's name, and what has a scale of its own
        a, b = ({re.sub(r" at \S+ k?N", f" at load {i}", k): v for i, (k, v) in enumerate(x.items())} for x in (a, b))
        a, b = ({k: v for k, v in x.items() if not OWN_NUMBERS.search(k)} for x in (a, b))
    assert a.keys() == b.keys()
    errors = {v.name: v.si_error for v in one.values}, {names(v.name): v.si_error for v in other.values}
    differing = {}
    for name, (x, unit, size) in a.items():
        powers = dimensions(quantity(1.0, unit)) if unit else (0.0,) * 3
        if ".shape_" in name:  # rotation angle for unit modal mass
            powers = -1.0, -0.5, 0.0
        factor = float(np.prod([scale**power for scale, power in zip(scales, powers, strict=True)]))
        y = b[name][0] / factor
        assert y.shape == x.shape, name
        same = (x == y) | (np.isnan(x) & np.isnan(y))
        off = np.where(same, 0.0, np.abs(x - y)) / (size or 1.0)
        most = SAME_PLACE if PLACES.search(name) else SAME_BESIDE_CHANGES if BESIDE_CHANGES.search(name) else SAME
        if searched := SEARCHED.search(name):
            stated = [np.inf] if searched[1] else [a[f"{name}_error"][0], b[f"{name}_error"][0] / factor]
            most = np.maximum(SAME_SEARCHED, np.minimum.reduce(stated) / size)
        if OPTIMUM.search(name):
            known = [errors[0][name], errors[1][name]]
            most = SAME_LEAST if None in known else max(SAME, min(known[0], known[1] / factor) / size)
        if CANCELLED.search(name) and not a[name.removesuffix("_error")][0].any():
            continue
        if not (off <= most).all():
            differing[name] = float(off.max())
    assert not differing, differing


def cases(*without):
    return [
        pytest.param(name, marks=[] if name in ORDINARY else pytest.mark.long) for name in EVERY if name not in without
    ]
