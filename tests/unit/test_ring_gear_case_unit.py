"""Ring gears in case files and in Python: their keys, what is refused, exports and figures."""

from __future__ import annotations

import copy
import math
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.errors import GeometryError, InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import apply_override, build_scene, read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.fem.solid.step_model import write_step
from fegear.formulas.cornell import tooth_compliance
from fegear.geometry.outline import gear_outline, relieved_outline, tool_in_space, tooth_outline
from fegear.geometry.over_balls import over_balls, touching_ball
from fegear.geometry.relief import CombinedRelief, tip_relief
from fegear.output.dxf import write_dxf
from fegear.results.catalogue import STAGES
from fegear.results.gear import body_modes

CASES = Path(__file__).parents[2] / "cases"
CASE = {
    "results": ["geometry"],
    "gear": {
        "r": {
            "internal": True,
            "teeth": 60,
            "module": "4 mm",
            "profile_shift": 0.2,
            "cutter": {"teeth": 20, "profile_shift": 0.1, "addendum": 1.25, "tip_radius": 0.25},
        }
    },
}


def ring(**changed):
    document = copy.deepcopy(CASE)
    keys = {**document["gear"]["r"], **changed}
    document["gear"]["r"] = {key: value for key, value in keys.items() if value is not None}
    return build_scene(document, "ring", Path()).gears["r"]


def test_keys_arrive_in_the_gear():
    gear = ring(rim_thickness="12 mm", thickness_allowance="40 um", tip_radius_rounding="0.4 mm")
    tooth = gear.tooth
    assert tooth.internal
    assert (tooth.teeth, tooth.profile_shift, tooth.cutter.teeth) == (60, 0.2, 20)
    assert tooth.cutter.tip_radius == 0.25
    assert (tooth.thickness_allowance, tooth.tip_rounding) == pytest.approx((0.01, 0.1))
    assert gear.tip_radius == pytest.approx(4e-3 * (30.0 - 0.2 - 1.0))
    assert gear.bore_radius == pytest.approx(gear.root_radius + 12e-3)
    assert ring(outer_radius="140 mm").bore_radius == pytest.approx(0.14)
    assert ring().bore_radius == pytest.approx(ring().root_radius + 3.5 * 4e-3)
    assert ring(tip_diameter="231 mm").tip_radius == pytest.approx(0.1155)


def test_the_root_diameter_says_what_the_addendum_says():
    by_addendum = ring()
    cutter = {"teeth": 20, "profile_shift": 0.1, "tip_radius": 0.25}
    by_root = ring(cutter={**cutter, "root_diameter": f"{2e3 * by_addendum.root_radius:.15g} mm"})
    assert by_root.form_radius == pytest.approx(by_addendum.form_radius, rel=1e-13)


def test_python_takes_the_same_keys():
    keys = {key: value for key, value in CASE["gear"]["r"].items() if key not in ("teeth", "module")}
    assert fegear.Gear(60, "4 mm", name="r", **keys).geometry == ring()


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"cutter": None}, "gear.r.cutter = (not given)"),
        ({"rack": "A"}, "is not used for an internal gear; specify its cutter"),
        ({"bore_radius": "50 mm"}, "set outer_radius or rim_thickness"),
        ({"outer_radius": "140 mm", "rim_thickness": "12 mm"}, "contradicts outer_radius"),
        ({"outer_radius": "120 mm"}, "gear.r.outer_radius = 120 mm: must be outside the root circle"),
        ({"internal": False}, "gear.r.cutter"),
        ({"cutter": {"teeth": 58}}, "gear.r.cutter.teeth = 58: leaves a difference below 3"),
        ({"cutter": {"teeth": 20, "addendum": 1.2, "root_diameter": "248 mm"}}, "contradicts addendum"),
        ({"tip_diameter": "226 mm"}, "gear.r.tip_diameter = 226 mm"),
        ({"ball_diameter": "12 mm"}, "gear.r.ball_diameter = 12 mm"),
    ],
)
def test_what_no_ring_gear_has_is_refused_in_one_sentence(changed, words):
    with pytest.raises(InputError) as refused:
        ring(**changed)
    assert words in str(refused.value)
    assert str(refused.value).count("\n") == 0


def test_formulas_of_external_teeth_refuse_a_ring_gear():
    with pytest.raises(GeometryError, match="is an internal gear; this result is available for external gears only"):
        tooth_compliance(ring(), np.array([0.12]))


@pytest.mark.dear("0.99-60-15 deg")
@pytest.mark.parametrize(("teeth", "helix"), [(60, None), (61, None), (60, "15 deg")])
@pytest.mark.parametrize("size", [0.99, 1.0, 1.15])
def test_balls_touch_the_flanks_of_the_drawn_outline(teeth, helix, size):
    """The gap between a ball at its place and the flank's own curve is zero, by brute force over curve and ball."""
    turned = {"module": None, "normal_module": "4 mm", "helix_angle": helix, "hand": "right", "face_width": "40 mm"}
    gear = ring(teeth=teeth, **(turned if helix else {}))
    found = over_balls(gear, size * touching_ball(gear))
    nearer = math.cos(0.5 * math.pi / gear.teeth) if gear.teeth % 2 else 1.0
    centre = 0.5 * (found.dimension + found.ball_diameter) / nearer
    flank = gear.tooth.involute
    x, y = flank.points(np.linspace(flank.start, flank.end, 4001)) * gear.module
    # the flank at heights along the axis, which a helix turns; the ball lies in the middle of the space at its right
    z = np.linspace(-1.2e-3, 1.2e-3, 1201)[:, None] if helix else np.zeros((1, 1))
    c, s = np.cos(gear.twist * z), np.sin(gear.twist * z)
    middle = math.pi / gear.teeth
    distance = np.sqrt(
        (c * x - s * y - centre * math.sin(middle)) ** 2 + (s * x + c * y - centre * math.cos(middle)) ** 2 + z**2
    )
    assert distance.min() == pytest.approx(0.5 * found.ball_diameter, abs=3e-9)
    if not helix:
        radius = np.hypot(x, y)[np.argmin(distance[0])]
        assert radius == pytest.approx(found.contact_radius, abs=1e-6)


def test_the_tool_s_positions_touch_the_outline_and_do_not_cut_it():
    tooth = ring().tooth
    shape = tooth_outline(tooth, 1e-6)
    half = shape.shape[1] // 2
    right = shape[:, half:]
    angle = np.arctan2(*right)
    positions = tool_in_space(tooth, 401)
    # of all tool points nearest to the flank's angle at their radius: none beyond it, some on it
    radius, at = (
        np.hypot(*positions.reshape(401, 2, -1).transpose(1, 0, 2)),
        np.arctan2(positions[:, 0], positions[:, 1]),
    )
    own = np.hypot(*right)
    order = np.argsort(own)
    inside = (radius > own.min()) & (radius < own.max() - 1e-6)
    room = (at - np.interp(radius, own[order], angle[order])) * radius
    near = inside & (at < math.pi / tooth.teeth)
    assert room[near].min() > -1e-4
    assert room[near].min() < 1e-4


SMALL = {"teeth": 45, "cutter": {"teeth": 20}, "tip_diameter": "174 mm", "face_width": "5 mm"}


def test_drawings_hold_the_ring_s_outside(tmp_path):
    import ezdxf

    gear = ring(**SMALL)
    drawing = ezdxf.readfile(write_dxf(gear, tmp_path, "r")[1]).modelspace()
    (circle,) = drawing.query("CIRCLE")
    assert circle.dxf.radius == pytest.approx(gear.bore_radius * 1e3)
    (teeth,) = drawing.query("LWPOLYLINE")
    assert max(math.hypot(x, y) for x, y in teeth.vertices()) == pytest.approx(gear.root_radius * 1e3)


@pytest.mark.long
def test_the_solid_of_a_ring_is_the_disc_without_its_teeth_s_spaces(tmp_path):
    gear = ring(**SMALL)
    x, y = gear_outline(gear, 1e-5)
    space = 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))
    made = write_step(tmp_path / "r.step", gear)
    assert made.expected == pytest.approx((math.pi * gear.bore_radius**2 - space) * 5e-3, rel=1e-5)
    assert made.volume == pytest.approx(made.expected, rel=1e-7)


def test_the_case_of_a_ring_gear_is_read():
    scene = read_scene(CASES / "ring_gear.toml")
    assert scene.gears["ring"].tooth.internal
    assert set(scene.case.results) == {"geometry", "stiffness", "root-stress"}


PLANET = {"teeth": 23, "module": "4 mm", "profile_shift": 0.3, "face_width": "40 mm"}
RING = {
    "internal": True, "teeth": 60, "module": "4 mm", "profile_shift": -0.3, "face_width": "40 mm",
    "cutter": {"teeth": 25, "profile_shift": 0.1}, "tip_diameter": "236 mm", "thickness_allowance": "80 um",
}  # fmt: skip
MESHING = {
    "results": ["transmission-error"],
    "gear": {"p": PLANET, "r": RING},
    "pair": {"I": {"driver": "p", "driven": "r", "load": "10 kN"}},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent", "corner_contact": True},
    "accuracy": {"tolerance": 1e-2},
}


def meshing(*overrides):
    document = copy.deepcopy(MESHING)
    for override in overrides:
        apply_override(document, override)
    return build_scene(document, "pair", Path())


def te_of(scene, cache):
    found = run_plan(scene, make_plan(scene, STAGES), cache=cache)
    return {value.name: value.si for value in found.values}


@pytest.fixture(scope="module")
def cache():
    return SolutionCache()


def test_planet_or_ring_may_drive(cache):
    """The same teeth touch the same way: transmission error and stiffness do not know which of them drives."""
    one = te_of(meshing(), cache)
    other = te_of(meshing("pair.I.driver=r", "pair.I.driven=p"), cache)
    for name in ("I.te_mean", "I.te_peak_to_peak", "I.mesh_stiffness_mean"):
        assert other[name] == pytest.approx(one[name], rel=1e-6)


def test_reliefs_and_spacing_errors_of_a_ring_hold_its_flanks_back(cache):
    """What all its teeth stand back is transmission error one for one."""
    plain = te_of(meshing(), cache)
    relief = 'gear.r.relief={ tip = { amount = "12 um", length = "4 mm" } }'
    assert te_of(meshing(relief, "effects.relief=true"), cache)["I.te_mean"] > plain["I.te_mean"] + 0.2e-6
    errors = ", ".join(['"5 um"'] * 60)
    spaced = te_of(meshing(f"gear.r.spacing_errors=[{errors}]", "effects.spacing_errors=true"), cache)
    assert spaced["I.te_mean"] == pytest.approx(plain["I.te_mean"] + 5e-6, rel=1e-6)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (['results=["rating"]'], "gear.p.strength = (not given): is missing"),
        (['results=["mesh-stiffness-matrix"]', 'pair.I.width="solid"'], "(external gears only"),
        (['results=["crosscheck"]'], "(external gears only"),
        (['results=["flank-fracture"]'], '"flank-fracture" (external gears only: ISO/TS 6336-4 applies to'),
        (
            ['pair.I.compliance={ source = "cornell" }', "effects.neighbour_coupling=false"],
            "external gears only; r is internal",
        ),
        (
            ['pair.I.root_stress={ source = "heywood" }', 'results=["root-stress-history"]'],
            "external gears only; r is internal",
        ),
        (['pair.I.width="slices"'], 'is not available with width = "slices" (external gears only)'),
        (['pair.I.centre_distance="75 mm"'], "both flanks are in contact at 74.1093 mm; reduce the centre distance"),
    ],
)
def test_what_an_internal_pair_is_not_computed_for_is_refused_in_one_sentence(overrides, words):
    with pytest.raises(InputError) as refused:
        make_plan(meshing(*overrides), STAGES)
    assert words in str(refused.value)


@pytest.mark.parametrize("result", ["relief", "relief-chart", "relief-curves", "robustness", "gear-mesh-power-loss"])
def test_what_was_for_external_pairs_takes_a_planet_in_its_ring(result):
    keys = {
        "robustness": ("gear.r.tolerance_class=6", "robustness={ draws = 20 }"),
        "gear-mesh-power-loss": ('pair.I.speed="500 rpm"', 'pair.I.friction={ law = "constant", coefficient = 0.05 }'),
    }.get(result, ('design={ pair = "I", load = "10 kN" }',))
    plan = make_plan(meshing(f'results=["{result}"]', *keys), STAGES)
    assert result in [one for step in plan.steps for one in step.stage.results]


def test_the_room_of_a_ring_s_centre_distance_is_toward_smaller_ones():
    """The teeth of this pair touch on both flanks at .11 mm more."""
    tolerances = ("gear.r.tolerance_class=6", 'results=["robustness"]')
    make_plan(meshing(*tolerances, 'robustness={ draws = 20, centre_distance = "100 um" }'), STAGES)
    with pytest.raises(InputError, match=r"mm of centre distance until both flanks touch.* a smaller centre_distance"):
        make_plan(meshing(*tolerances, 'robustness={ draws = 20, centre_distance = "120 um" }'), STAGES)


def test_what_a_helical_internal_pair_is_not_computed_for_is_refused_by_its_name():
    """And not by that of a stage which nobody knows."""
    document = copy.deepcopy(MESHING) | {"results": ["mesh-stiffness-matrix"]}
    for gear in document["gear"].values():
        gear |= {"helix_angle": "5 deg", "hand": "right", "normal_module": gear.pop("module")}
    with pytest.raises(InputError) as refused:
        make_plan(build_scene(document, "pair", Path()), STAGES)
    told = 'is not supported by "mesh-stiffness-matrix" (external gears only for helical'
    assert told in str(refused.value)


def test_natural_frequencies_of_bodies_say_that_they_pass_ring_gears_over(monkeypatch):
    """With coarse elements; rings alone are refused by name."""
    document = copy.deepcopy(CASE) | {"results": ["body-modes"], "accuracy": {"tolerance": 0.1}}
    document["gear"]["r"]["face_width"] = "8 mm"
    with pytest.raises(InputError, match=r'gear\.r.* is not supported by "body-modes"'):
        make_plan(build_scene(document, "ring", Path()), STAGES)
    document["gear"]["p"] = {"teeth": 16, "module": "4 mm", "face_width": "4 mm", "bore_radius": "18 mm"}
    monkeypatch.setattr(body_modes, "_COARSER", 8.0)
    monkeypatch.setattr(body_modes, "_DIAMETERS", 1)
    monkeypatch.setattr(body_modes, "_EACH", 1)
    scene = build_scene(document, "ring", Path())
    found = run_plan(scene, make_plan(scene, STAGES))
    (said,) = (remark for remark in found.remarks if remark.startswith("Gear r"))
    assert said == "Gear r: internal gear; natural frequencies of gear bodies are computed for external gears only."


def test_relief_of_a_ring_is_drawn_where_it_is_ground():
    """Points of the relieved outline lie off the generated flank by the removal."""
    gear = ring()
    relief = CombinedRelief((tip_relief(gear, 30e-6, length=3e-3),))
    shape = tooth_outline(gear.tooth, 1e-6, relieved_outline(gear, relief)) * gear.module
    right = shape[:, shape.shape[1] // 2 :]
    radius = np.hypot(*right)
    on = (radius > gear.tip_radius * (1.0 + 1e-9)) & (radius < gear.form_radius * (1.0 - 1e-6))
    flank = gear.tooth.involute
    t = np.linspace(flank.start, flank.end + 0.01, 400001)
    x, y = flank.points(t) * gear.module
    for px, py in right[:, on].T[:: max(1, on.sum() // 40)]:
        apart = np.hypot(x - px, y - py)
        i = int(np.argmin(apart))
        assert apart[i] == pytest.approx(float(relief.removal(t[i])), abs=2e-8)


def test_flanks_of_a_ring_that_meshes(cache):
    """Hertz at every place with the hollow flank's curvature, and what the standard does not say is said."""
    oil = "{ viscosity_40 = '220 mm^2/s', temperature = '70 degC', scuffing_load_stage = 12 }"
    scene = meshing(
        'results=["flank-surface"]', 'gear.p.roughness={ flank = "0.4 um" }', 'gear.r.roughness={ flank = "0.4 um" }',
        f"pair.I.lubricant={oil}", 'pair.I.speed="1500 rpm"',
    )  # fmt: skip
    found = run_plan(scene, make_plan(scene, STAGES), cache=cache)
    (table,) = (one for one in found.tables if one.name == "flank_surface_I")
    at = {column.name: column.si for column in table.columns}
    assert np.all(at["radius_driven"] < 0.0)
    bent = 1.0 / at["radius_driver"] + 1.0 / at["radius_driven"]
    assert at["relative_radius"] == pytest.approx(1.0 / bent)
    on = at["line_load"] > 0.0
    modulus = 206.8e9 / 2.0 / (1.0 - 0.3**2)
    hertz = np.sqrt(at["line_load"] * modulus * bent / np.pi)
    assert at["hertz_pressure"][on] == pytest.approx(hertz[on], rel=1e-3)
    assert any(": ISO/TS 6336-22 applies to external gears;" in remark for remark in found.remarks)


def test_two_pins_hold_a_ring_and_one_does_not():
    assert ring(rim_support={"kind": "pins", "pins": 2, "width": "6 mm"}).support.pins == 2
    with pytest.raises(InputError, match=r"rim_support\.pins = 1: must be at least 2"):
        ring(rim_support={"kind": "pins", "pins": 1, "width": "6 mm"})
