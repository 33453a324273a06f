"""Laws that tie two runs of a case to each other: other units of measurement, names, orders and spellings of one thing.

Mechanics knows no units: scaling the units of length, mass and time (a gear twice as large, of another steel under
another load, in slow motion) scales every number of a run by what its own unit says. What a gear is called, in which
order a case file lists its keys, and whether a default is written out, changes nothing.
"""

import json
import re
from pathlib import Path

import meshio
import numpy as np
import pytest
from case_laws import CASES, assert_same, case, cases, changed, columns, dimensions, ran

from fegear.base.units import quantity, registry
from fegear.case.part import _number
from fegear.case.reading import build_scene

#: New units of length, mass and time. E and load together: a gear as heavy of a steel four times as stiff under four
#: times the load, at speeds twice as high.
SCALES = {"units": (1.3, 1.9, 0.8), "lengths": (1.7, 1.0, 1.0), "E and load": (1.0, 1.0, 0.5)}
#: Shafts of the usual steel, on bearings by laws in N and mm.
OWN_STEEL = "gearbox_misaligned", "two_stage_shafts"
#: Results that a standard's formulas with units of their own go into (N/mm in c' and K_v of ISO 6336, m/s and mPa.s in
#: the laws of oil): the case is scaled with these results in their place.
OWN_SCALE = {
    "rating_spur": ("geometry", "transmission-error", "root-stress-history"), "rating_helical": ("load-distribution",),
    "surface_and_loss": ("geometry", "transmission-error", "load-sharing", "root-stress-history"),
    "robust_pair": ("geometry", "transmission-error", "root-stress-history"),
}  # fmt: skip
_QUANTITY = re.compile(r"[+-]?\d+(\.\d+)?([eE][+-]?\d+)?\s*[A-Za-z/*(]")


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


def scaled_file(path, scales, folder):
    """A mesh with other places, or a file of columns with other numbers in the units that its header says."""
    if path.endswith(".msh"):
        mesh = meshio.read(CASES / path)
        mesh.points = mesh.points * scales[0]
        mesh.write(folder / Path(path).name, file_format="gmsh")
        return str(folder / Path(path).name)
    lines = (CASES / path).read_text("utf-8").splitlines()
    head = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    units = [re.search(r"\[(.*)\]", one) for one in lines[head].split(",")]
    powers = [dimensions(quantity(1.0, one[1])) if one else (0.0,) * 3 for one in units]
    factors = [np.prod(np.power(scales, power)) for power in powers]
    rows = np.loadtxt(lines[head + 1 :], delimiter=",") * factors
    copied = folder / f"{len(list(folder.iterdir()))}_{Path(path).name}"
    copied.write_text("\n".join([lines[head], *(",".join(f"{x:.17g}" for x in row) for row in rows)]), "utf-8")
    return str(copied)


@pytest.mark.dear(
    *(f"{name}-{how}" for name in ("litvin_lead", "blankenship_singh", "pinion_and_wheel") for how in SCALES)
)
@pytest.mark.parametrize("how", SCALES)
@pytest.mark.parametrize("name", cases(*OWN_STEEL))
def test_mechanics_knows_no_units_of_length_mass_and_time(name, how, monkeypatch, tmp_path):
    scales, document = SCALES[how], with_steel(case(name))
    if name in OWN_SCALE:
        document["results"] = list(OWN_SCALE[name])
        document["accuracy"] = {"tolerance": 5e-2}
        for pair in document["pair"].values():
            pair.pop("lubricant", None)  # of none of them, and a density of no oil in other units
            if OWN_SCALE[name] == ("load-distribution",):
                pair["width"] = "slices"  # a wheel of 103 teeth as a solid takes 14 GB; other cases have solids

    def other(text):
        return scaled_file(text, scales, tmp_path) if text.endswith((".csv", ".msh")) else rescaled(text, scales)

    scaled = changed(document, other)
    assert_same(ran(document, monkeypatch), ran(scaled, monkeypatch), scales)


@pytest.fixture(scope="module")
def searched():
    """NASA's pair with reliefs that are searched, as it is and in other units."""
    document = with_steel(case("nasa_relief_design"))
    document |= {"results": ["relief"], "accuracy": {"tolerance": 1e-2}}
    with pytest.MonkeyPatch.context() as patch:
        other = changed(document, lambda one: rescaled(one, SCALES["units"]))
        return columns(ran(document, patch)), columns(ran(other, patch))


@pytest.mark.dear
def test_other_units_leave_searched_reliefs_and_what_they_leave(searched):
    """Scaling the lengths once made 18.7 um of 41.3 um."""
    length = SCALES["units"][0]
    for name, factor in (("amount", length), ("te_peak_to_peak", length), ("least", length), ("start_roll_angle", 1.0)):
        one, other = (found[f"grindable_I.{name}"][0] for found in searched)
        np.testing.assert_allclose(other, one * factor, rtol=1e-6)


@pytest.mark.dear
def test_curves_of_searched_reliefs_stay_within_half_of_their_errors(searched):
    """Between processors they moved by 6.6e-9 without a stated error."""
    for shape in ("linear", "parabolic"):
        one, other = (found[f"harris_map_I.te_{shape}_tip_relief"][0] for found in searched)
        error = searched[0][f"harris_map_I.te_{shape}_tip_relief_error"][0]
        assert (np.abs(other / SCALES["units"][0] - one) <= 0.5 * error).all()
        assert (error < 1e-4 * one.max()).all()


@pytest.mark.dear("litvin_lead")
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
    for name_of_set, part in document.get("planetary", {}).items():  # members of a set are no names of gears
        other["planetary"][name_of_set] |= {k: part[k] for k in ("fixed", "input", "floating") if k in part}

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
        named = path in {("gear",), ("pair",), ("shaft",), ("train", "body"), ("train", "mesh")}
        return {k: reversed_keys(v, (*path, k)) for k, v in (node.items() if named else reversed(node.items()))}
    return [reversed_keys(v) for v in node] if isinstance(node, list) else node


@pytest.mark.dear("litvin_lead")
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


@pytest.mark.dear("litvin_lead")
@pytest.mark.parametrize("name", cases())
def test_defaults_that_are_written_out_change_nothing(name, monkeypatch):
    document = case(name)
    written = with_defaults(build_scene(document, name, CASES).case, document)
    assert json.dumps(written) != json.dumps(document)
    assert_same(ran(document, monkeypatch), ran(written, monkeypatch))
