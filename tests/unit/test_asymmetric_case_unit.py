"""Asymmetric teeth in cases: keys of both flanks, which flank works, a sentence where equal flanks are needed."""

import copy
import math
import random
from pathlib import Path

import numpy as np
import pytest
from mutations import changed_value, processor_seconds

from fegear.base.errors import FegearError, InputError
from fegear.case.built.flank_modifications import described_relief
from fegear.case.built.pair_spec import pair_spec
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.geometry.asymmetric_tooth import AsymmetricSide
from fegear.geometry.external_tooth import Tooth
from fegear.output.dxf import write_dxf
from fegear.output.export import export_gears
from fegear.results.catalogue import RESULTS, STAGES

GEAR = {
    "teeth": 22, "module": "3 mm", "pressure_angle": "30 deg", "coast_pressure_angle": "20 deg",
    "rack": {"tip_radius": 0.15, "coast_tip_radius": 0.3}, "profile_shift": 0.2, "face_width": "20 mm",
    "thickness_allowance": "40 um", "bore_radius": "15 mm",
}  # fmt: skip
TIP = {"tip": {"amount": "20 um", "length": "1 mm"}}
RELIEF = {"relief": True, "hertz": "load-dependent"}
#: Results that take asymmetric teeth.
KNOWN = {
    "geometry", "stiffness", "root-stress", "load-sharing", "transmission-error", "root-stress-history",
    "load-distribution", "measured-flanks", "fillet-design",
}  # fmt: skip
#: The same of trains and of planetary sets.
IN_TRAINS = {
    "gear-train", "natural-modes", "campbell", "torque-ripple", "dynamic-increments", "mesh-force-spectrum",
    "tooth-force", "dynamic-root-stress", "idler-root-stress", "planet-set", "planet-load-sharing",
    "planet-root-stress", "planet-modes", "planet-vibration", "dynamic-factor",
    "vibration-revolution", "planet-motion",
}  # fmt: skip


def case(flank=None, results=("geometry",), pair=(), effects=(), **gear):
    """Two asymmetric gears in mesh."""
    one = {key: value for key, value in {**GEAR, **gear}.items() if value is not None}
    two = {**one, "teeth": 41, "profile_shift": 0.0, "bore_radius": "40 mm"}
    mesh = {"driver": "p", "driven": "w", "load": "4 kN", **dict(pair)}
    if flank:
        mesh["flank"] = flank
    return {"gear": {"p": one, "w": two}, "pair": {"I": mesh}, "results": list(results), "effects": dict(effects)}


def built(document):
    return build_scene(copy.deepcopy(document), "case", Path())


def planned(document):
    return make_plan(built(document), STAGES)


def refused(document):
    with pytest.raises(InputError) as problem:
        planned(document)
    text = str(problem.value)
    assert len(text) < 400
    assert "\n" not in text
    return text


def test_gears_are_seen_from_the_flank_that_works():
    for flank, angle in ((None, 30.0), ("drive", 30.0), ("coast", 20.0)):
        scene = built(case(flank))
        for gear in scene.gears.values():
            assert isinstance(gear.tooth, AsymmetricSide)
            assert gear.tooth.flank == (flank or "drive")
            assert np.rad2deg(gear.normal_pressure_angle) == pytest.approx(angle)
    alone = case()
    del alone["pair"]
    assert built(alone).gears["p"].tooth.flank == "drive"


def test_the_coast_flank_is_the_drive_flank_of_exchanged_keys():
    coast = built(case("coast")).pairs["I"]
    exchanged = built(case(
        pressure_angle="20 deg", coast_pressure_angle="30 deg", rack={"tip_radius": 0.3, "coast_tip_radius": 0.15}
    )).pairs["I"]  # fmt: skip
    for name in ("centre_distance", "contact_ratio", "normal_backlash", "working_pressure_angle", "x_start", "x_end"):
        assert getattr(coast, name) == pytest.approx(getattr(exchanged, name), rel=1e-13), name
    for one, other in zip((coast.driver, coast.driven), (exchanged.driver, exchanged.driven), strict=True):
        for name in ("base_radius", "form_radius", "root_radius", "tip_radius"):
            assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-14), name


def test_equal_keys_of_both_flanks_are_the_usual_gear():
    rack = {"tip_radius": 0.1, "coast_tip_radius": 0.1}
    equal = built(case("coast", coast_pressure_angle="30 deg", rack=rack))
    usual = built(case(coast_pressure_angle=None, rack={"tip_radius": 0.1}))
    assert equal.gears == usual.gears
    assert isinstance(equal.gears["p"].tooth, Tooth)
    in_rad = built(case(pressure_angle="0.5235987755982988 rad", coast_pressure_angle="30 deg", rack=rack))
    assert isinstance(in_rad.gears["p"].tooth, Tooth)


def test_a_full_fillet_is_the_widest_of_both_angles():
    tooth = built(case(rack={"tip_radius": "full"})).gears["p"].tooth
    assert tooth.root_land_half_angle == pytest.approx(0.0, abs=1e-12)
    assert tooth.rack.tip_radius == tooth.back.rack.tip_radius


@pytest.mark.parametrize(
    ("document", "said"),
    [
        (case(coast_pressure_angle="50 deg"), "gear.p.coast_pressure_angle"),
        (case(rack={"tip_radius": 0.15, "coast_tip_radius": -0.1}), "gear.p.rack.coast_tip_radius"),
        (case(rack={"coast_tip_radius": 0.2}), "gear.p.rack.tip_radius"),
        (case(rack={"tip_radius": "full", "coast_tip_radius": 0.2}), "gear.p.rack.tip_radius"),
        (case(rack={"tip_radius": 0.4}), "do not fit side by side"),
        (case(rack={"tip_radius": 0.15, "protuberance": 0.05}), "gear.p.rack.protuberance"),
        (case(profile_shift="no-undercut"), "give the profile shift as a number"),
        (case(profile_shift=None, span="23 mm", span_teeth=3), "gear.p.span"),
        (case(span_teeth=3), "no span can be measured"),
        (case(tooth_mesh="a.msh"), "gear.p.tooth_mesh"),
        (case(topography={"file": "t.csv"}), "gear.p.topography"),
        (case(coast_pressure_angle=None, rack={"tip_radius": 0.1}, coast_relief=TIP), "requires asymmetric teeth"),
        (case(odd_tooth=[{"tooth": 0, "crack": {"depth": "1 mm"}}]), "gear.p.odd_tooth"),
        (case(body={"rim_thickness": "6 mm", "web_thickness": "8 mm"}), "gears with asymmetric teeth are solid discs"),
        (case(pair={"compliance": {"source": "cornell"}}), "pair.I.compliance.source"),
        (case(pair={"root_stress": {"source": "iso-6336-3"}}), "pair.I.root_stress.source"),
        (case(pair={"circumferential_backlash": "0.1 mm"}), "set thickness_allowance"),
        (case(pair={"shift_distribution": "equal", "centre_distance": "96 mm"}, profile_shift=None),
         "set profile_shift of both gears"),
        (case("coast", coast_pressure_angle=None, rack={"tip_radius": 0.1}), "requires asymmetric teeth"),
    ],
)  # fmt: skip
def test_what_asymmetric_teeth_cannot_have_is_said(document, said):
    assert said in refused(document)


def test_flanks_on_which_no_two_mates_can_load_a_gear_are_refused():
    idler = case("drive")
    idler["gear"]["c"] = {**idler["gear"]["w"], "teeth": 30}
    idler["pair"]["J"] = {"driver": "w", "driven": "c", "load": "4 kN", "flank": "drive"}
    assert 'pair.J.flank = "drive": contradicts pair I, which loads the drive flank of idler w' in refused(idler)
    assert 'set flank = "coast", or remove it' in refused(idler)
    del idler["pair"]["J"]["flank"]
    assert set(built(idler).gears) == {"p", "w", "c", "w-coast"}
    idler["gear"]["w-coast"] = idler["gear"]["c"]
    assert "gear.w-coast = (given): is the name of the coast flank of gear w; rename it" in refused(idler)
    split = case("drive")
    split["gear"]["c"] = {**split["gear"]["w"], "teeth": 30}
    split["pair"]["J"] = {"driver": "p", "driven": "c", "load": "4 kN", "flank": "coast"}
    assert 'pair.J.flank = "coast": contradicts the drive flank of gear p in pair I' in refused(split)
    split["pair"]["J"]["flank"] = "drive"
    assert set(built(split).pairs) == {"I", "J"}
    one_side = case()
    del one_side["gear"]["w"]["coast_pressure_angle"]
    one_side["gear"]["w"]["rack"] = {"tip_radius": 0.1}
    assert "non-working flanks to mesh" in refused(one_side)


@pytest.mark.parametrize("result", RESULTS)
def test_every_result_takes_asymmetric_teeth_or_says_that_it_does_not(result):
    flags = {entry.asymmetric for entry in STAGES.entries if result in entry.results}
    if result in KNOWN | IN_TRAINS:
        assert True in flags
        if result in IN_TRAINS or result == "measured-flanks":
            return
        assert planned(case(results=[result])).steps
    else:
        assert flags == {False}


@pytest.mark.parametrize("result", ["rating", "crosscheck", "relief", "tooth-geometry-check", "flank-surface"])
def test_results_for_equal_flanks_name_the_teeth(result):
    text = refused(case(results=[result], pair={"speed": "1500 rpm"}))
    assert "asymmetric teeth" in text
    assert "teeth with equal flanks only" in text


def test_exports_hold_both_flanks_or_are_refused(tmp_path):
    scene = built(case("coast"))
    with pytest.raises(InputError, match=r'"rexs": is not available for the asymmetric teeth of gear p; use dxf'):
        export_gears(scene, tmp_path, [], "rexs")
    made = export_gears(scene, tmp_path, ["p"], "dxf")
    assert "Gear p: seen with the tooth tip up, the coast flank is on the right." in made.remarks
    import ezdxf

    (line,) = ezdxf.readfile(tmp_path / "p_gear_polyline.dxf").modelspace().query("LWPOLYLINE")
    x, y = np.array(line.get_points("xy")).T
    area = 0.5 * abs(float(x @ np.roll(y, -1) - np.roll(x, -1) @ y))
    from fegear.geometry.mass import section_moments

    gear = scene.gears["p"]
    assert area == pytest.approx(section_moments(gear.tooth).area * (gear.module * 1e3) ** 2, rel=1e-4)
    sector = ezdxf.readfile(tmp_path / "p_tooth_spline.dxf").modelspace()
    half = len(sector.query("SPLINE ARC LINE[layer=='OUTLINE']")) / 2
    assert half == int(half)


NEW = [("gear", "p", "coast_pressure_angle"), ("gear", "p", "rack", "coast_tip_radius"), ("pair", "I", "flank"),
       ("gear", "p", "pressure_angle"), ("gear", "p", "rack", "tip_radius")]  # fmt: skip


@pytest.mark.dear
def test_five_hundred_mutations_of_the_keys_are_a_case_or_one_sentence():
    ran = 0
    for number in range(500):
        draw = random.Random(number)  # noqa: S311
        document = copy.deepcopy(case(draw.choice(["drive", "coast"])))
        for place in draw.sample(NEW, draw.choice([1, 1, 2])):
            table = document
            for step in place[:-1]:
                table = table[step]
            table[place[-1]] = changed_value(table[place[-1]], draw)
            if place[0] == "gear" and place[-1] in document["gear"]["w"]:
                document["gear"]["w"][place[-1]] = table[place[-1]]  # of both gears; they share their rack
        try:
            with processor_seconds(10.0):
                planned(document)
        except FegearError as error:
            said = str(error)
        else:
            said, ran = "a case", ran + 1
        assert len(said.splitlines()) == 1, (number, said)
    assert 20 < ran < 480


def test_at_large_pressure_angles_only_the_given_tip_radius_must_fit():
    """The numbers of the named profile were tried at the gear's own angle before those of the case replaced them."""
    steep = case(coast_pressure_angle=None, rack={"tip_radius": 0.1})
    assert built(steep).gears["p"].external_tooth.rack.tip_radius == 0.1
    steep["gear"]["p"]["rack"] = {}
    assert "gear.p.rack.tip_radius = 0.25: exceeds the maximum of 0.110349 modules" in refused(steep)


@pytest.mark.parametrize("flank", ["drive", "coast"])
def test_the_loaded_flank_has_its_own_relief(flank):
    other = {"tip": {"amount": "9 um", "length": "0.5 mm"}}
    scene = built(case(flank, effects=RELIEF, relief=TIP, coast_relief=other))
    spec = pair_spec(scene, "I")
    for member in ("driver", "driven"):
        found = spec.flanks(member).profile(spec.pair, member)
        gear = spec.pair.gear(member)
        at_tip = float(found.removal(gear.tooth.involute.end))
        assert at_tip == pytest.approx(20e-6 if flank == "drive" else 9e-6, rel=1e-12)
    only = built(case(flank, effects=RELIEF, relief=TIP))
    assert (pair_spec(only, "I").driver.relief is None) == (flank == "coast")
    for one, amount in (("drive", 20e-6), ("coast", 9e-6)):
        drawn, tooth = described_relief(scene, "p", back=one != flank).relief, scene.gears["p"].tooth.tooth.side(one)
        assert float(drawn.removal(tooth.involute.end)) == pytest.approx(amount, rel=1e-12)


def test_drawings_have_the_relief_of_each_flank(tmp_path):
    scene = built(case("coast", relief=TIP))
    gear, relief = scene.gears["p"], described_relief(scene, "p", back=True).relief
    assert described_relief(scene, "p").relief is None
    (path,) = [one for one in write_dxf(gear, tmp_path, "p", None, "", relief) if one.name == "p_tooth_polyline.dxf"]
    import ezdxf

    (line,) = ezdxf.readfile(path).modelspace().query("LWPOLYLINE")
    x, y = np.array(line.get_points("xy")).T
    m, tip = gear.module * 1e3, gear.tip_radius * 1e3
    corners = x[np.abs(np.hypot(x, y) - tip) < 1e-6 * tip] / y[np.abs(np.hypot(x, y) - tip) < 1e-6 * tip]
    right, left = math.atan(corners.max()), math.atan(-corners.min())
    tooth = gear.tooth
    assert right == pytest.approx(tooth.tip_half_angle, abs=1e-9)
    # the drive flank, drawn on the left, has lost 20 um along its normal, and a little more where it meets the tip
    lost = 0.02 / (tip * math.cos(math.acos(tooth.back.base_radius * m / tip)))
    assert tooth.back.tip_half_angle - left == pytest.approx(lost, rel=4e-2)


def test_a_relief_of_the_coast_flank_is_refused_under_its_own_key():
    long = {"tip": {"amount": "20 um", "length": "90 mm"}}
    scene = built(case("coast", effects=RELIEF, coast_relief=long))
    spec = pair_spec(scene, "I")
    with pytest.raises(InputError, match=r"^gear\.p\.coast_relief"):
        spec.driver.profile(spec.pair, "driver")
