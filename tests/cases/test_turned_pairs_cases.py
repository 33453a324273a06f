"""Laws of pairs that are turned round: driver and driven exchanged, and gears seen in a mirror."""

import copy
import math
import re

import numpy as np
import pytest
from case_laws import CANCELLED, CASES, EVERY, SAME, case, ran
from scipy.optimize import brentq

from fegear.base.units import registry
from fegear.case.reading import build_scene

#: Root stress peaks at kinks, whose places are followed to a share of a sample's distance.
SAME_AT_KINKS = 1e-6


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


#: Cases with a hand or something that differs along the face; `seen_in_a_mirror` knows how each of it looks there.
ALONG_THE_FACE = re.compile(r"\b(hand|line_error|misalignment|lead|bias|axial_offset|shaft|width)\b")


def negative(text):
    """The opposite of a quantity."""
    return text[1:] if text.startswith("-") else f"-{text}"


def over_the_face(rows, name, folder, sign):
    """A file of two columns over the face, as it is or seen in a mirror."""
    head, *rest = rows
    z = [line.split(",") for line in rest]
    at = head.split(",").index("z [mm]")
    for row in z:
        row[at] = f"{sign * float(row[at])!r}"
    path = folder / f"{name}_{'same' if sign > 0 else 'mirrored'}.csv"
    key = (lambda row: float(row[at])) if len(head.split(",")) == 2 else (lambda row: (row[0], float(row[at])))
    path.write_text("\n".join([head, *(",".join(row) for row in sorted(z, key=key))]), "utf-8")
    return str(path)


def mirrored_shaft(shaft):
    """A shaft whose right end is the left one."""
    length = sum(quantity_of(one["length"]) for one in shaft["sections"])
    for kind in ("gears", "bearings", "loads"):
        for one in shaft.get(kind, []):
            one["at"] = f"{length - quantity_of(one['at'])!r} m"
    for one in shaft.get("bearings", []):
        one["reversed"] = not one.get("reversed", False)
    if "coupling" in shaft:
        shaft["coupling"] = f"{length - quantity_of(shaft['coupling'])!r} m"
    shaft["start"] = f"{-length - quantity_of(shaft.get('start', '0 m'))!r} m"
    shaft["sections"].reverse()


def quantity_of(text):
    return float(registry().Quantity(text).to_base_units().magnitude)


def mirror_gear(name, gear, folder, sign):
    """The other hand, and what was measured over the face from its other end."""
    assert not {"topography", "bias"} & gear.keys()
    assert not {"slope", "file"} & gear.get("lead", {}).keys()
    if sign < 0 and "hand" in gear:
        gear["hand"] = {"right": "left", "left": "right"}[gear["hand"]]
    if "lead" in gear.get("measured", {}):
        lines = (CASES / gear["measured"]["lead"]).read_text("utf-8").splitlines()
        rows = [one for one in lines if not one.startswith("#")]
        gear["measured"]["lead"] = over_the_face(rows, name, folder, sign)


def seen_in_a_mirror(document, folder, sign=-1):
    """The same gears with z in place of -z; with a sign of one as they are, in the same spelling."""
    made = copy.deepcopy(document)
    for name, gear in made.get("gear", {}).items():
        mirror_gear(name, gear, folder, sign)
    for name, pair in made.get("pair", {}).items():
        if "over_face" in pair.get("line_error", {}):
            half = 0.5e3 * min(quantity_of(made["gear"][pair[one]]["face_width"]) for one in ("driver", "driven"))
            most = 1e6 * quantity_of(pair["line_error"].pop("over_face"))
            rows = ["z [mm],gap [um]", f"{-half!r},0.0", f"{half!r},{most!r}"]
            pair["line_error"]["file"] = over_the_face(rows, name, folder, sign)
        if sign < 0:
            errors = pair.get("misalignment", {})
            of_shafts = [errors.get(member, {}) for member in ("driver", "driven")]
            for table in (pair, errors, *of_shafts):
                for key in {"axial_offset", "shaft_angle", "in_plane", "out_of_plane"} & table.keys():
                    table[key] = negative(table[key])
    for shaft in made.get("shaft", {}).values() if sign < 0 else ():
        mirrored_shaft(shaft)
    return made


#: Columns that are counted toward end II, or turn with the gears seen from there.
TOWARD_END_II = {"z", "z1", "z2", "z_first", "z_last", "along", "turn_x", "turn_y", "force_axial", "in_plane",
                 "out_of_plane", "over_face", "face_position", "stress_face_position", "compression_face_position",
                 "axial_force", "tilting_moment", "moment_x", "moment_y"}  # fmt: skip
#: Numbers that are counted toward it too.
NUMBER_TOWARD_END_II = re.compile(
    r"helix_slope(?!.*tolerance)|shaft_misalignment$|kappa(_even|_driver|_driven)?$|force_lever$"
    r"|axial_force$|tilting_moment$"
)
#: Levers along the face, and tables over coordinates of a pair, which a mirror turns: the face and turns about x and y.
LEVERS, OVER_COORDINATES = {"kappa", "force_lever"}, re.compile(r"transmissibility|mesh_stiffness_mean")
COORDINATE = re.compile(r"theta_[xyz]|(?<![a-z])[yz](?![a-z])")
TURNED = {"z", "theta_x", "theta_y"}
#: What is counted from an end of a shaft, and what stands in rows of profile and helix alike.
FROM_AN_END = {"at", "twist", "slope_deviation"}
#: What names a row, in the order in which rows are compared.
ROWS = ("position", "pair", "tooth", "load", "phi1", "z", "face_position")


def turns(name):
    """Sign that a mirror gives to what coordinates name."""
    return (-1) ** sum(one in TURNED for one in COORDINATE.findall(name))


def seen(table, name, values, sign):
    """A column as a mirror has it with a sign of -1; a mode shape has no sign."""
    if table.name.startswith("mode_shapes"):
        return np.abs(values)
    if sign > 0 or name.endswith("_abs"):
        return values
    if OVER_COORDINATES.match(table.name):
        rows = [turns(row) for row in table["coordinate"]] if "coordinate" in table.keys() else 1.0  # noqa: SIM118
        return turns(name) * values * rows
    lever = name in LEVERS and table.name.startswith("mesh_stiffness_matrix")
    return -values if lever or name in TOWARD_END_II else values


def rows_of(table, sign):
    """Numbers of a table by column, seen in a mirror with a sign of -1, in an order that a mirror does not change."""
    found = {
        c.name: np.asarray(c.si, dtype=float)
        for c in table.columns
        if c.si.dtype.kind in "fiu" and "seconds" not in c.name and c.name not in FROM_AN_END
    }
    shaft = table.name.startswith("shaft_stress_")
    if "z" in found and ("along" in found or shaft):  # from the left end of a shaft
        found["z"] = found["z"] - 0.5 * (found["z"].min() + found["z"].max())
    found = {name: seen(table, name, one, sign) for name, one in found.items()}
    if sign < 0 and "z_first" in found:
        found["z_first"], found["z_last"] = found["z_last"], found["z_first"]
        if not table.name.startswith("contact_pattern"):  # a line's ends; those are outermost places
            found["x_first"], found["x_last"] = found["x_last"], found["x_first"]
    rows = (*ROWS, "equivalent") if shaft else ROWS  # both sides of a step stand at one place
    places = [np.round(found[name] / (np.abs(found[name]).max() or 1.0), 9) for name in rows if name in found]
    order = np.lexsort(places[::-1]) if {"z", "face_position"} & found.keys() else slice(None)
    return {name: one[order] for name, one in found.items()}


#: Of the largest number of the same unit in any table.
ROUND_OFF = 1e-11


def largest_by_unit(tables):
    found = {}
    for column in (c for table in tables for c in table.columns if c.si.dtype.kind in "fiu"):
        finite = np.abs(column.si[np.isfinite(column.si)])
        found[column.unit] = max(found.get(column.unit, 0.0), finite.max(initial=0.0))
    return found


def with_hands():
    """Cases that a mirror changes."""
    return [name for name in EVERY if ALONG_THE_FACE.search((CASES / f"{name}.toml").read_text("utf-8"))]


#: A second or two each: rigid flanks, shafts.
MIRRORED_AT_ONCE = ("litvin_lead", "two_stage_shafts")
#: Searches for a design go other ways in a mirror: flanks that are as good within their errors.
ONE_DESIGN = "helical_flank_design"


@pytest.mark.dear("litvin_lead")
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[] if name in MIRRORED_AT_ONCE else pytest.mark.long)
        for name in with_hands()
        if name != ONE_DESIGN
    ],
)
def test_gears_in_a_mirror_have_the_same_tables(name, monkeypatch, tmp_path):
    """Right for left hand, misalignments and places along shafts with them: rows at z are those at -z."""
    document = case(name)
    one = ran(seen_in_a_mirror(document, tmp_path, 1), monkeypatch)
    other = ran(seen_in_a_mirror(document, tmp_path, -1), monkeypatch)
    differing = {}
    assert [t.name for t in one.tables] == [t.name for t in other.tables]
    largest = largest_by_unit(one.tables)
    for table, image in zip(one.tables, other.tables, strict=True):
        a, b = rows_of(table, 1), rows_of(image, -1)
        assert a.keys() == b.keys()
        units = {c.name: c.unit for c in table.columns}
        for key, x in a.items():
            assert x.shape == b[key].shape, (table.name, key)
            alike = [np.abs(v[np.isfinite(v)]).max(initial=0.0) for k, v in a.items() if units[k] == units[key]]
            same = (x == b[key]) | (np.isnan(x) & np.isnan(b[key]))
            off = float(np.where(same, 0.0, np.abs(x - b[key])).max(initial=0.0)) / (max(alike) or 1.0)
            if off * max(alike) <= ROUND_OFF * largest[units[key]]:
                continue  # what rounding leaves of curves that are constant, as those of a pure profile error
            if not off <= SAME and not CANCELLED.match(f"{table.name}.{key}"):
                differing[f"{table.name}.{key}"] = off
    values = {v.name: v for v in other.values}
    assert [v.name for v in one.values] == list(values)
    for v in one.values:
        wanted = -v.si if NUMBER_TOWARD_END_II.search(v.name) else v.si
        if values[v.name].si != pytest.approx(wanted, rel=SAME, abs=1e-300):
            differing[v.name] = (v.si, values[v.name].si)
    assert not differing


def at_the_same_places(document, positions):
    """A helical pair whose tips are turned down until the positions of a pitch are the same ones when it is turned."""
    made = copy.deepcopy(document)
    ((name, pair),) = made["pair"].items()
    whole = build_scene(made, "pair", CASES).pairs[name]
    wanted = math.floor(whole.contact_ratio * positions) / positions

    def too_much(diameter):
        made["gear"][pair["driven"]]["tip_diameter"] = f"{diameter!r} m"
        return build_scene(made, "pair", CASES).pairs[name].contact_ratio - wanted

    most = 2.0 * whole.driven.tip_radius
    too_much(brentq(too_much, 0.95 * most, most, xtol=1e-15))
    return made


#: Gears of 17 and 25 teeth, 12 degrees, misaligned by 6 um over the face; a wheel wider than its pinion.
HELICAL = {
    "results": ["load-distribution"],
    "gear": {
        name: {
            "teeth": teeth, "normal_module": "3 mm", "helix_angle": "12 deg", "hand": hand, "face_width": "9 mm",
            "relief": {"tip": {"amount": "10 um", "length": "1.5 mm"}},
        }
        for name, teeth, hand in (("pinion", 17, "right"), ("wheel", 25, "left"))
    },
    "pair": {"I": {"driver": "pinion", "driven": "wheel", "load": "2 kN", "line_error": {"over_face": "6 um"}}},
    "load_distribution": {"positions": 6},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent", "relief": True, "misalignment": True},
    "accuracy": {"tolerance": 5e-2},
}  # fmt: skip


@pytest.mark.dear
@pytest.mark.parametrize("width", ["slices", pytest.param("solid", marks=pytest.mark.long)])
def test_a_helical_pair_that_changes_places_has_the_same_load_over_its_flanks(width, monkeypatch):
    """The wheel drives backward: the same flanks bear, and the ends of the face stay the same."""
    document = at_the_same_places(HELICAL, HELICAL["load_distribution"]["positions"])
    document["pair"]["I"]["width"] = width
    one, other = ran(document, monkeypatch), ran(turned(document), monkeypatch)
    a, b = ({v.name: v.si for v in found.values} for found in (one, other))
    for name in ("te_mean", "te_peak_to_peak", "K_Hbeta", "largest_line_load", "largest_share"):
        assert b[f"I.{name}"] == pytest.approx(a[f"I.{name}"], rel=SAME), name
    # The largest pressure of lines of a module or more stands between roll positions, which are not mirrored.
    pressure = next(v for v in one.values if v.name == "I.largest_hertz_pressure")
    assert abs(b[pressure.name] - pressure.si) < min(pressure.si_error, 0.02 * pressure.si)
    for member, mate in (("driver", "driven"), ("driven", "driver")):
        assert b[f"I.{member}.K_Fbeta"] == pytest.approx(a[f"I.{mate}.K_Fbeta"], rel=SAME)
    lines = [
        {name: found.tables["load_distribution_I"].column(name).si for name in ("x", "z", "line_load")}
        for found in (one, other)
    ]
    lines[1]["x"] = -lines[1]["x"]  # from the start of the wheel's path
    orders = [np.lexsort((np.round(each["z"], 9), np.round(each["x"], 9))) for each in lines]
    for name, values in lines[0].items():
        there, back = values[orders[0]], lines[1][name][orders[1]]
        assert back == pytest.approx(there, rel=SAME, abs=SAME * np.abs(there).max()), name
