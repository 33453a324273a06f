"""Fillets of a user in cases: keys, files, what follows the outline, a sentence where a tool is needed."""

import copy
import math
import random
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from mutations import changed_value, processor_seconds

from fegear.base.errors import FegearError, InputError
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.geometry.asymmetric_fillets import AsymmetricFilletSide
from fegear.geometry.curves import Arc
from fegear.geometry.custom_fillet_tooth import CustomFilletTooth, ShapedRingTooth
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_curves import ArcsFillet, EllipseFillet, SplineFillet
from fegear.geometry.outline import gear_outline
from fegear.output.dxf import write_dxf
from fegear.results.catalogue import STAGES
from fegear.results.gear.geometry import _fillets

MADE = Tooth(21, thickness_allowance=0.01)
POINTS = 2.0 * MADE.fillet.points(np.linspace(MADE.fillet.start, MADE.fillet.end, 25))
LISTS = {axis: [f"{value:.9g} mm" for value in row] for axis, row in zip("xy", POINTS, strict=True)}
ARCS = {"kind": "arcs", "radii": ["2.4 mm", "0.8 mm"], "form_diameter": "39.6 mm"}
POINTED = {"kind": "points", **LISTS}
GEAR = {"teeth": 21, "module": "2 mm", "face_width": "12 mm", "bore_radius": "8 mm", "thickness_allowance": "20 um"}
RING = {
    "teeth": 61, "module": "2 mm", "internal": True, "cutter": {"teeth": 25, "tip_radius": 0.2},
    "tip_diameter": "118.6 mm", "fillet": {"kind": "ellipse"},
}  # fmt: skip


def case(fillet=None, results=("geometry",), pair=(), **gear):
    """A pinion with a fillet of its own, and a wheel."""
    one = {key: value for key, value in {**GEAR, **gear}.items() if value is not None}
    two = {**GEAR, "teeth": 38, "bore_radius": "20 mm"}
    if fillet is not None:
        one["fillet"] = fillet
    mesh = {"driver": "p", "driven": "w", "load": "1 kN", **dict(pair)}
    return {"gear": {"p": one, "w": two}, "pair": {"I": mesh}, "results": list(results)}


def asymmetric(coast, results=("geometry",)):
    """The same with two flanks, and a fillet of the coast side."""
    document = case(None, results, coast_fillet=coast)
    for gear in document["gear"].values():
        gear |= {"pressure_angle": "26 deg", "coast_pressure_angle": "20 deg", "rack": {"tip_radius": 0.2}}
    return document


def built(document, folder=None):
    return build_scene(copy.deepcopy(document), "case", folder or Path())


def planned(document, folder=None):
    return make_plan(built(document, folder), STAGES)


def refused(document):
    with pytest.raises(InputError) as problem:
        planned(document)
    text = str(problem.value)
    assert len(text) < 400
    assert "\n" not in text
    return text


def test_kinds_of_fillets_become_curves():
    kinds = {
        "points": (POINTED, SplineFillet), "ellipse": ({"kind": "ellipse"}, EllipseFillet), "arcs": (ARCS, ArcsFillet),
    }  # fmt: skip
    for fillet, curve in kinds.values():
        gear = built(case(fillet)).gears["p"]
        assert type(gear.tooth) is CustomFilletTooth
        assert isinstance(gear.tooth.fillet, curve)
        assert gear.shaped
    assert not built(case()).gears["p"].shaped
    assert type(built({"gear": {"r": RING}, "results": ["geometry"]}).gears["r"].tooth) is ShapedRingTooth


def test_each_side_of_asymmetric_teeth_has_a_fillet_of_its_own():
    for key, other in (("fillet", "coast_fillet"), ("coast_fillet", "fillet")):
        document = asymmetric(None)
        document["gear"]["p"] |= {key: {"kind": "ellipse"}}
        document["gear"]["p"].pop(other, None)
        drive = built(document).gears["p"].tooth
        assert isinstance(drive, AsymmetricFilletSide)
        shaped = {side.fillet_key for side in (drive, drive.back)}
        assert shaped == {key, None}
        document["pair"]["I"]["flank"] = "coast"
        coast = built(document).gears["p"].tooth
        assert coast == drive.back
        assert coast.turn == -drive.turn
    both = asymmetric({"kind": "ellipse", "root_diameter": "37.2 mm"})
    both["gear"]["p"]["fillet"] = {"kind": "arcs", "radii": ["0.7 mm"], "root_diameter": "37.2 mm"}
    tooth = built(both).gears["p"].tooth
    assert 4.0 * tooth.root_radius == pytest.approx(37.2, rel=1e-12)
    assert tooth.root_land_half_angle == 0.0


def test_geometry_states_the_fillet_of_each_side_once():
    document = asymmetric({"kind": "ellipse"})
    document["pair"]["II"] = {"driver": "w", "driven": "p", "load": "1 kN"}
    gears = built(document).gears
    assert {"p", "p-coast", "w", "w-coast"} == set(gears)
    said = list(_fillets(SimpleNamespace(data=SimpleNamespace(gears=gears))))
    assert len(said) == 1
    assert said[0].startswith("Gear p: coast fillet as specified, root form diameter")


def test_points_of_a_file_are_those_of_the_lists(tmp_path):
    rows = "\n".join(f"{x:.9g},{y:.9g}" for x, y in POINTS.T)
    (tmp_path / "fillet.csv").write_text(f"x [mm],y [mm]\n{rows}\n")
    one, other = (built(case(fillet), tmp_path).gears["p"] for fillet in (
        POINTED, {"kind": "points", "file": "fillet.csv"}))  # fmt: skip
    assert one.tooth.root_radius == pytest.approx(other.tooth.root_radius, rel=1e-12)
    u = np.linspace(0.0, 0.99 * one.tooth.fillet.end, 9)
    assert one.tooth.fillet.points(u) == pytest.approx(other.tooth.fillet.points(u), abs=1e-7)
    assert one.tooth.root_radius == pytest.approx(MADE.root_radius, rel=1e-8)


@pytest.mark.parametrize(
    ("document", "said"),
    [
        (case({"kind": "circle"}), "gear.p.fillet.kind"),
        (case({"kind": "points"}), "gear.p.fillet.x"),
        (case({"kind": "points", "x": LISTS["x"]}), "gear.p.fillet.y"),
        (case({"kind": "points", "x": LISTS["x"], "y": LISTS["y"][:-1]}), "as many values as x, 25"),
        (case({"kind": "points", "file": "no.csv"}), "file not found"),
        (case({**POINTED, "file": "no.csv"}), "contradicts x and y"),
        (case({"kind": "ellipse", "radii": ["1 mm"]}), "gear.p.fillet.radii"),
        (case({"kind": "ellipse", "scatter": "1 um"}), "gear.p.fillet.scatter"),
        (case({**POINTED, "scatter": "0.5 mm"}), "gear.p.fillet.scatter = 0.5 mm: must be at most 0.2 mm"),
        (case({"kind": "arcs", "radii": ["1 mm", "0.5 mm"]}), "gear.p.fillet.form_diameter"),
        (case({"kind": "arcs", "radii": ["1 mm"], "form_diameter": "40 mm"}), "contradicts a single radius"),
        (case({"kind": "ellipse", "form_diameter": "30 mm"}), "base radius of 19.7335 mm"),
        (case({"kind": "ellipse", "root_diameter": "41 mm"}), "must be below the root form diameter"),
        (case({**POINTED, "x": [f"-{x}" if n % 2 else x for n, x in enumerate(LISTS["x"])]}), "one side"),
        (case(coast_fillet={"kind": "ellipse"}), "requires asymmetric teeth; specify fillet (both flanks)"),
        (asymmetric({"kind": "ellipse", "root_diameter": "41 mm"}), "gear.p.coast_fillet.root_diameter"),
        (asymmetric({**POINTED, "scatter": "0.5 mm"}), "gear.p.coast_fillet.scatter = 0.5 mm: must be at most 0.2 mm"),
        (asymmetric({"kind": "points", "file": "no.csv"}), "gear.p.coast_fillet.file"),
        (asymmetric({"kind": "ellipse", "form_diameter": "40.5 mm"}, ("load-sharing",)),
         "gear.p.coast_fillet = root form diameter 40.5 mm: is above the active root diameter"),
        (case({"kind": "ellipse"}, ("crosscheck",)), "gear.p.fillet = given: is not supported by \"crosscheck\""),
        (case({"kind": "ellipse"}, pair={"compliance": {"source": "cornell"}}, results=("load-sharing",)),
         "pair.I.compliance.source"),
        (case({"kind": "ellipse", "form_diameter": "40.3 mm"}, ("load-sharing",)),
         "is above the active root diameter"),
        (case({"kind": "ellipse", "root_diameter": "38.2 mm"}, ("load-sharing",)),
         "is cut by the path of the mating tip"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_said_with_its_key(document, said):
    assert said in refused(document)


@pytest.mark.parametrize("gear", [GEAR, RING])
def test_an_ellipse_says_where_the_root_circle_may_be(gear):
    def made(**fillet):
        document = {"gear": {"g": {**gear, "fillet": {"kind": "ellipse", **fillet}}}, "results": ["geometry"]}
        return built(document).gears["g"].tooth

    away = -1.0 if gear is GEAR else 1.0
    with pytest.raises(InputError, match=r"no ellipse .* must be (above|below) .* mm; reduce") as refused:
        made(root_diameter=f"{4.0 * made().root_radius + away * 18.0} mm")
    limit = float(str(refused.value).split(" mm; reduce")[0].split()[-1])
    assert made(root_diameter=f"{limit - away * 0.01} mm").root_radius > 0.0
    with pytest.raises(InputError):
        made(root_diameter=f"{limit + away * 0.01} mm")


def test_the_geometry_of_fillets_that_foul_can_still_be_drawn():
    assert planned(case({"kind": "ellipse", "form_diameter": "40.3 mm"})).steps


def test_drawings_carry_the_fillet(tmp_path):
    import ezdxf

    gear = built(case({"kind": "ellipse"})).gears["p"]
    written = {path.name: path for path in write_dxf(gear, tmp_path, "p")}
    (line,) = ezdxf.readfile(written["p_gear_polyline.dxf"]).modelspace().query("LWPOLYLINE")
    x, y = np.array(line.get_points("xy")).T
    assert np.hypot(x, y).min() == pytest.approx(gear.root_radius * 1e3, rel=1e-6)
    assert gear_outline(gear).shape[1] > 400


@pytest.mark.parametrize("seed", range(4))
def test_mutated_keys_of_fillets_end_in_one_sentence(seed):
    rng = random.Random(seed)  # noqa: S311
    bases = [
        case(POINTED), case({**POINTED, "scatter": "2 um", "form_diameter": "39.6 mm", "frame": "tooth"}),
        case({"kind": "ellipse", "form_diameter": "39.6 mm", "root_diameter": "37 mm"}),
        case({"kind": "arcs", "radii": ["2.4 mm", "0.8 mm"], "form_diameter": "39.6 mm"}),
        asymmetric({"kind": "ellipse"}), asymmetric({"kind": "arcs", "radii": ["2.4 mm", "0.6 mm"],
                                                     "form_diameter": "39.6 mm"}),
    ]  # fmt: skip
    for _ in range(25):
        document = copy.deepcopy(rng.choice(bases))
        gear = document["gear"]["p"]
        fillet = gear["coast_fillet" if "coast_fillet" in gear else "fillet"]
        key = rng.choice([*fillet, "x", "radii", "file", "scatter"])
        place = fillet.get(key, "1 mm")
        if isinstance(place, list) and rng.random() < 0.7:
            place[rng.randrange(len(place))] = changed_value("1 mm", rng)
        elif rng.random() < 0.15:
            fillet.pop(key, None)
        else:
            fillet[key] = changed_value(place, rng)
        try:
            with processor_seconds(5.0):
                tooth = built(document).gears["p"].tooth
        except FegearError as problem:
            text = str(problem)
            assert "\n" not in text
            assert len(text) < 1300  # a value of the user is cut off at 1000
            continue
        assert math.isfinite(tooth.root_radius)


def test_arcs_one_behind_the_other_end_where_their_last_does_and_a_last_bit_beyond():
    arcs = Arc((0.0, 8.0), -1.0, 3.0, 2.0), Arc((0.3, 7.0), -0.5, 2.0, 1.2)
    fillet = ArcsFillet(arcs)
    assert fillet.end == pytest.approx(1.4)
    u = np.array([0.0, 1.0, 1.0 + 1e-12, 1.2, fillet.end, np.nextafter(fillet.end, 2.0)])
    wanted = np.column_stack([arcs[0].points(3.0), arcs[0].points(2.0), arcs[1].points(2.0), arcs[1].points(1.6),
                              arcs[1].points(1.2), arcs[1].points(1.2)])  # fmt: skip
    assert fillet.points(u) == pytest.approx(wanted, abs=1e-9)
    assert np.hypot(*fillet.normals(u)) == pytest.approx(np.ones(6))
    assert np.abs(fillet.curvatures(u)) == pytest.approx([1.0, 1.0, 2.0, 2.0, 2.0, 2.0])
