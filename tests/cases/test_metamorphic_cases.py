"""Laws that tie two runs of a case to each other: other units of measurement, names, orders and spellings of one thing.

Mechanics knows no units: scaling the units of length, mass and time (a gear twice as large, of another steel under
another load, in slow motion) scales every number of a run by what its own unit says. What a gear is called, in which
order a case file lists its keys, and whether a default is written out, changes nothing.
"""

import copy
import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

import fegear
from fegear.base.units import quantity, registry
from fegear.case.part import _number
from fegear.case.reading import build_scene

CASES = Path(__file__).parents[2] / "cases"
EVERY = sorted(path.stem for path in CASES.glob("*.toml"))
#: A second or two each: a table of one gear, a plane pair, unloaded helical contact, modes and transmissibility.
ORDINARY = ("pinion_and_wheel", "litvin_lead", "blankenship_singh", "thin_rim")
SAME = 1e-9
#: New units of length, mass and time. E and load together: a gear as heavy of a steel four times as stiff under four
#: times the load, at speeds twice as high.
SCALES = {"units": (1.3, 1.9, 0.8), "E and load": (1.0, 1.0, 0.5)}
#: Shafts of the usual steel, on bearings by laws in N and mm.
OWN_STEEL = "gearbox_misaligned", "two_stage_shafts"
#: Results that a standard's formulas with units of their own go into (N/mm in c' and K_v of ISO 6336, mm in ISO 1328,
#: m/s and mPa.s in the laws of oil): the case is scaled with these results in their place.
OWN_SCALE = {
    "rating_spur": ("geometry", "transmission-error", "root-stress-history"), "rating_helical": ("load-distribution",),
    "surface_and_loss": ("geometry", "transmission-error", "load-sharing", "root-stress-history"),
    "robust_pair": ("geometry", "transmission-error", "root-stress-history"),
}  # fmt: skip
#: Numbers with a scale of their own in any case: balls of whole sizes, ISO 6336 in mm, paint of 6.3 um, a nanometre.
OWN_NUMBERS = re.compile(r"ball_diameter|over_balls|_iso$|^contact_pattern_|printed_share$|contact_I\.spread$")
#: Where the ends of a band of equally good reliefs lie is known to the search's own step of 1e-3 (`_WITHIN`); what the
#: best of them leave is not excepted.
SEARCHED = re.compile(r"^grindable_\w+\.(amount_from|amount_to|start_from|start_to)$")
SAME_SEARCHED = 1e-3
#: An angle between two gears is a difference of angles of some radian: below this it has no digits left [rad].
SMALLEST_ANGLE = 1e-6
#: Where something is largest has half as many digits as how large it is.
PLACES, SAME_PLACE = re.compile(r"place_angle$"), 1e-6
SAME_AT_KINKS = 1e-6
_QUANTITY = re.compile(r"[+-]?\d+(\.\d+)?([eE][+-]?\d+)?\s*[A-Za-z/*(]")


def case(name):
    return tomllib.loads((CASES / f"{name}.toml").read_text("utf-8"))


def changed(node, text=lambda one: one, key=lambda _path, one: one, path=()):
    """A copy of a document with other texts and keys."""
    if isinstance(node, dict):
        return {key(path, k): changed(v, text, key, (*path, k)) for k, v in node.items()}
    if isinstance(node, list):
        return [changed(v, text, key, path) for v in node]
    return text(node) if isinstance(node, str) else copy.copy(node)


def dimensions(q):
    """Exponents of length, mass and time."""
    return tuple(float(q.dimensionality.get(f"[{one}]", 0.0)) for one in ("length", "mass", "time"))


def with_steel(document):
    """The same document with the steel that it assumes written out, so that it can be scaled.

    And with a constant friction of teeth: the laws that oil follows are formulas in m/s and mPa.s.
    """
    if document.get("effects", {}).get("friction"):
        document.setdefault("dynamics", {})["friction"] = {"law": "constant", "coefficient": 0.06}
    steel = {"young_modulus": "206.8 GPa", "density": "7850 kg/m^3"}
    for gear in document.get("gear", {}).values():
        gear["material"] = steel | gear.get("material", {})
    for shaft in document.get("train", {}).get("shaft", {}).values():
        if "diameter" in shaft:
            shaft.setdefault("shear_modulus", "79.5 GPa")
    return document


def rescaled(text, scales):
    """A quantity with other units of length, mass and time; another text as it is."""
    if not _QUANTITY.match(text) or "deg" in text:
        return text
    try:
        q = registry().Quantity(text).to_base_units()
    except Exception:  # noqa: BLE001  (a text that only looks like a quantity)
        return text
    powers = dimensions(q)
    if not any(powers):
        return text
    factor = np.prod([scale**power for scale, power in zip(scales, powers, strict=True)])
    return f"{float(q.magnitude * factor)!r} {q.units:~}"


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


def assert_same(one, other, scales=(1.0, 1.0, 1.0), names=lambda name: name):
    a, b = columns(one), columns(other, names)
    if scales != (1.0, 1.0, 1.0):  # loads in a column's name, and what has a scale of its own
        a, b = ({re.sub(r" at \S+ k?N", f" at load {i}", k): v for i, (k, v) in enumerate(x.items())} for x in (a, b))
        a, b = ({k: v for k, v in x.items() if not OWN_NUMBERS.search(k)} for x in (a, b))
    assert a.keys() == b.keys()
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
        most = SAME_SEARCHED if SEARCHED.search(name) else SAME_PLACE if PLACES.search(name) else SAME
        if not off.max(initial=0.0) <= most:
            differing[name] = float(off.max())
    assert not differing


def cases(*without):
    return [
        pytest.param(name, marks=[] if name in ORDINARY else pytest.mark.long) for name in EVERY if name not in without
    ]


def scaled_file(path, scales, folder):
    """A file of columns, copied with other numbers in the units that its header says."""
    lines = (CASES / path).read_text("utf-8").splitlines()
    head = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    units = [re.search(r"\[(.*)\]", one) for one in lines[head].split(",")]
    powers = [dimensions(quantity(1.0, one[1])) if one else (0.0,) * 3 for one in units]
    factors = [np.prod(np.power(scales, power)) for power in powers]
    rows = np.loadtxt(lines[head + 1 :], delimiter=",") * factors
    copied = folder / f"{len(list(folder.iterdir()))}_{Path(path).name}"
    copied.write_text("\n".join([lines[head], *(",".join(f"{x:.17g}" for x in row) for row in rows)]), "utf-8")
    return str(copied)


@pytest.mark.parametrize("how", SCALES)
@pytest.mark.parametrize("name", cases(*OWN_STEEL))
def test_mechanics_knows_no_units_of_length_mass_and_time(name, how, monkeypatch, tmp_path):
    scales, document = SCALES[how], with_steel(case(name))
    if name in OWN_SCALE:
        document["results"] = list(OWN_SCALE[name])

    def other(text):
        return scaled_file(text, scales, tmp_path) if text.endswith(".csv") else rescaled(text, scales)

    scaled = changed(document, other)
    assert_same(ran(document, monkeypatch), ran(scaled, monkeypatch), scales)


@pytest.mark.parametrize("name", cases())
def test_names_of_gears_change_nothing(name, monkeypatch):
    document = case(name)
    new = {old: f"Rädchen{'αβγδ'[i]}轮" for i, old in enumerate(document.get("gear", {}))}
    back = {v: k for k, v in new.items()}

    def key(path, one):
        named = path in {("gear",), ("train", "body"), ("train", "torque")}
        return new.get(one, one) if named else one

    other = changed(document, lambda text: new.get(text, text), key)
    other |= {k: document[k] for k in ("title", "results") if k in document}

    def names(one):
        for k, v in back.items():
            one = one.replace(k, v)
        return one

    assert_same(ran(document, monkeypatch), ran(other, monkeypatch), names=names)


def reversed_keys(node, path=()):
    """Keys in another order; things that have names keep theirs, for rows stand as the case lists them.

    Nor do bodies: the first is the one that speeds refer to where the case names none, as a remark says.
    """
    if isinstance(node, dict):
        named = path in {("gear",), ("pair",), ("train", "body"), ("train", "mesh")}
        return {k: reversed_keys(v, (*path, k)) for k, v in (node.items() if named else reversed(node.items()))}
    return [reversed_keys(v) for v in node] if isinstance(node, list) else node


@pytest.mark.parametrize("name", cases())
def test_the_order_of_keys_changes_nothing(name, monkeypatch):
    document = case(name)
    assert_same(ran(document, monkeypatch), ran(reversed_keys(document), monkeypatch))


def with_defaults(part, table):
    """A table of a case with the plain defaults of its model written out."""
    written = dict(table)
    if "pair" in table and "kappa" in type(part).model_fields:  # all comes from the teeth, and no key may say it again
        return written
    for key, field in type(part).model_fields.items():
        value = getattr(part, key)
        if key in written:
            if isinstance(written[key], dict) and hasattr(type(value), "model_fields"):
                written[key] = with_defaults(value, written[key])
            elif isinstance(value, dict) and isinstance(written[key], dict):
                written[key] = {
                    k: with_defaults(value[k], v) if k in value and hasattr(type(value[k]), "model_fields") else v
                    for k, v in written[key].items()
                }
            continue
        readers = [getattr(one, "func", None) for one in field.metadata if type(one).__name__ == "BeforeValidator"]
        plain = isinstance(field.default, (bool, int, float, str)) and all(one is _number for one in readers)
        if plain:
            written[key] = field.default
    return written


@pytest.mark.parametrize("name", cases())
def test_defaults_that_are_written_out_change_nothing(name, monkeypatch):
    document = case(name)
    written = with_defaults(build_scene(document, name, CASES).case, document)
    assert json.dumps(written) != json.dumps(document)
    assert_same(ran(document, monkeypatch), ran(written, monkeypatch))


def of_two_gears(document):
    """The first pair of a case under a load; a gear that meshes with its like gets another mate."""
    name, pair = next(iter(document["pair"].items()))
    kept = {key: pair[key] for key in ("driver", "driven", "line_error", "width", "compliance") if key in pair}
    gears = {one: document["gear"][one] for one in (pair["driver"], pair["driven"])}
    if len(gears) == 1:
        (gear,) = gears.values()
        gears |= {"mate": gear | {"teeth": gear["teeth"] + 9}}
        kept["driven"] = "mate"
    load = pair.get("load", document.get("design", {}).get("load", "3000 N"))
    wide = any("helix_angle" in gear for gear in gears.values())
    names = ("transmission-error", "root-stress-history") if not wide else ("load-distribution",)
    more = {key: document[key] for key in ("effects", "accuracy", "load_distribution") if key in document}
    return {"results": list(names), "gear": gears, "pair": {name: kept | {"load": load}}, **more}


def turned(document):
    """Driver and driven exchanged."""
    other = copy.deepcopy(document)
    (pair,) = other["pair"].values()
    pair["driver"], pair["driven"] = pair["driven"], pair["driver"]
    return other


def numbers(results, exchanged):
    """Values of a pair by name; those of driver and driven under each other's name where they are exchanged."""
    swap = {"driver": "driven", "driven": "driver"} if exchanged else {}
    return {
        ".".join(swap.get(part, part) for part in v.name.split(".")): v
        for v in results.values
        if re.search(r"te_|stiffness|K_Hbeta|root_tension|root_compression|root_stress", v.name)
    }


PLANE = (
    "pinion_and_wheel", "calculix_pair", "high_contact_ratio", "nasa_relief_design", "robust_pair", "surface_and_loss",
    "two_stage_gearbox",
)  # fmt: skip


def dear(*names):
    return [pytest.param(name, marks=[] if name in ("pinion_and_wheel", "two_stage_gearbox") else pytest.mark.long)
            for name in names]  # fmt: skip


@pytest.mark.parametrize("name", dear(*PLANE))
def test_driver_and_driven_that_change_places_leave_error_stiffness_and_root_stress(name, monkeypatch):
    document = of_two_gears(case(name))
    if document["pair"][next(iter(document["pair"]))].get("compliance"):
        document["results"] = ["transmission-error"]
    a, b = numbers(ran(document, monkeypatch), False), numbers(ran(turned(document), monkeypatch), True)
    assert a.keys() == b.keys()
    assert any(one.endswith("te_mean") for one in a)
    for one, value in a.items():
        # Root stress peaks at kinks, whose places are followed to a share of a sample's distance.
        assert b[one].si == pytest.approx(value.si, rel=SAME_AT_KINKS if "root_" in one else SAME), one


def test_amounts_over_delta_hang_on_which_gear_drives(monkeypatch):
    """Delta is the deflection at the driver's HPSTC, which lies elsewhere when the other one drives."""
    document = of_two_gears(case("lin_tip_relief"))
    document["results"] = ["transmission-error"]

    def mean(one):
        return next(v.si for v in ran(one, monkeypatch).values if v.name == "I.te_mean")

    apart = abs(mean(turned(document)) / mean(document) - 1.0)
    assert 1e-4 < apart < 1e-2
    for gear in document["gear"].values():
        gear["relief"] = {"tip": {"amount": "28 um", "normalised_length": 1.0, "shape": "linear"}}
    assert mean(turned(document)) == pytest.approx(mean(document), rel=1e-8)
