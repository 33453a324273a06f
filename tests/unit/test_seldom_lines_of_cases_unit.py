"""Keys of a case in combinations that are seldom: which one a refusal names, and what is taken where none is given."""

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.case.built import compound as built_compound
from fegear.case.built.odd_teeth import keyway_of
from fegear.case.built.tip_tolerances import flank_tolerance, tip_tolerances
from fegear.case.compound import CompoundPart, CompoundPlanetPart
from fegear.case.drafts import stages
from fegear.case.drafts.first_size import MODULES
from fegear.case.drafts.kinds import THREE_STAGES, TWO_STAGES
from fegear.case.odd_tooth import KeywayPart
from fegear.case.reading import build_scene
from fegear.case.sizing import SizingPart
from fegear.formulas.iso1328 import flank_tolerances


def case(pair=None, gears=None, results=("transmission-error",), **gear):
    common = {"module": "2 mm", "face_width": "10 mm"} | gear
    return {
        "results": list(results),
        "gear": {"a": {"teeth": 20, **common}, "b": {"teeth": 31, **common}} if gears is None else gears,
        "pair": {"I": {"driver": "a", "driven": "b", "torque": "10 N*m"} | (pair or {})},
        "effects": {"hertz": "load-dependent"},
    }


def scene_of(document, folder=None):
    from pathlib import Path

    return build_scene(document, "case", folder or Path())


def refused(document, folder=None):
    with pytest.raises(InputError) as caught:
        scene_of(document, folder)
    return caught.value


# ---- which key is named ----------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({"fixed": ("c",)}, "fixed"),
        ({"output": "s"}, "output"),
        ({"torque": 10.0}, "torque"),
        ({"speed": 10.0}, "speed"),
        ({"fixed": ("c",), "speed": 10.0}, "fixed"),
        ({"torque": 10.0, "speed": 10.0}, "torque"),
    ],
)
def test_what_a_set_without_an_input_does_not_use_is_named(given, key):
    none = {"input": None, "fixed": (), "output": None, "torque": None, "speed": None}
    CompoundPart._check_drive(SimpleNamespace(**none))
    with pytest.raises(ValueError, match="is not used without input") as caught:
        CompoundPart._check_drive(SimpleNamespace(**none | given))
    assert caught.value.context["key"] == key


@pytest.mark.parametrize(
    ("shaft", "key"),
    [
        ({"bearing_span": "100 mm"}, "bearing_span"),
        ({"diameter": "30 mm"}, "diameter"),
        ({"diameter": "30 mm", "bearing_span": "100 mm"}, "bearing_span"),
        ({"arrangement": "a", "diameter": "30 mm"}, "arrangement"),
    ],
)
def test_a_shaft_that_contradicts_its_deformation_is_named_by_its_first_key(shaft, key):
    document = case({"shafts": {"deformation": "5 um", **shaft}})
    error = refused(document)
    assert error.key == f"pair.I.shafts.{key}"
    assert "contradicts deformation" in error.rule


@pytest.mark.parametrize(
    ("viscosities", "key"),
    [(("1.9 mm^2/s", "1.5 mm^2/s"), "viscosity_40"), (("9 mm^2/s", "1.9 mm^2/s"), "viscosity_100")],
)
def test_oil_thinner_than_its_law_is_named_at_the_temperature_of_which_it_is(viscosities, key):
    oil = {"viscosity_40": viscosities[0], "viscosity_100": viscosities[1], "temperature": "70 degC"}
    error = refused(case({"lubricant": oil, "speed": "1000 rpm"}))
    assert error.key == f"pair.I.lubricant.{key}"
    assert "below 2 mm^2/s" in error.rule


@pytest.mark.parametrize(("given", "key"), [({}, "width"), ({"width": 2e-3}, "depth"), ({"depth": 1e-3}, "width")])
def test_a_keyway_of_a_bore_that_din_6885_does_not_have_is_named_by_what_it_lacks(given, key):
    gear = SimpleNamespace(bore_radius=1.5e-3, module=2e-3)
    part = SimpleNamespace(**{"width": None, "depth": None, "angle": 0.1} | given)
    with pytest.raises(InputError) as caught:
        keyway_of(gear, part, "gear.a.keyway")
    assert caught.value.key == f"gear.a.keyway.{key}"
    assert KeywayPart.model_fields.keys() >= {"width", "depth", "angle"}


def test_keyways_of_din_6885_are_taken_unless_they_are_given():
    """A bore of 30 mm: 8 mm wide, 3.3 mm deep in the hub."""
    gear = SimpleNamespace(bore_radius=15e-3, module=2e-3)
    for given, wanted in (({}, (4.0, 1.65)), ({"width": 6e-3}, (3.0, 1.65)), ({"depth": 4e-3}, (4.0, 2.0))):
        made = keyway_of(gear, SimpleNamespace(**{"width": None, "depth": None, "angle": 0.1} | given), "k")
        assert (made.width, made.depth, made.angle) == pytest.approx((*wanted, 0.1))


def test_a_file_of_pitch_deviations_without_their_column_is_refused(tmp_path):
    (tmp_path / "pitch.csv").write_text("deviation [um]\n" + "1.0\n" * 20)
    document = case()
    document["gear"]["a"]["spacing_errors"] = {"file": "pitch.csv"}
    document["effects"]["spacing_errors"] = True
    from fegear.case.built.gear_flanks import _spacing_errors

    with pytest.raises(InputError, match=r"has no column spacing_error; it has .*deviation"):
        _spacing_errors(scene_of(document, tmp_path), "a")
    (tmp_path / "pitch.csv").write_text("spacing_error [um]\n" + "".join(f"{k % 3 - 1}\n" for k in range(20)))
    assert _spacing_errors(scene_of(document, tmp_path), "a")[:4].tolist() == pytest.approx([-1e-6, 0.0, 1e-6, -1e-6])


@pytest.mark.parametrize(("odd", "key"), [({"missing": True}, "missing"), ({"tip_diameter": "150 mm"}, "tip_diameter")])
def test_a_ring_gear_has_no_teeth_of_another_outline(odd, key):
    ring = {
        "teeth": 70, "module": "2 mm", "face_width": "10 mm", "internal": True,
        "cutter": {"teeth": 20}, "odd_tooth": [{"tooth": 1, "crack": {"depth": "0.5 mm"}}, {"tooth": 3, **odd}],
    }  # fmt: skip
    error = refused({"results": ["geometry"], "gear": {"r": ring}})
    assert error.key == f"gear.r.odd_tooth[1].{key}"


def test_gears_that_do_not_reach_each_other_are_named_at_the_mesh(monkeypatch):
    """What GearPair says of a centre distance that nobody wrote is said of the gears that have it."""

    gears = {"p": {"1": None}, "s": {"1": None}}
    for key, value in (("centre_distance", "centre distance 20 mm"), ("module", "20 mm")):

        def pair(*_given, key=key):
            raise InputError(key, "20 mm", "is below the base circles", "increase it")

        monkeypatch.setattr(built_compound, "GearPair", pair)
        with pytest.raises(InputError) as caught:
            built_compound._pair(gears, "p", "1", "s", "1", 0.02, "compound.X.mesh.0")
        assert caught.value.value == value
        assert caught.value.key.startswith("compound.X.mesh.0")


# ---- what is taken where nothing is given ----------------------------------------------------------------------------
def test_modules_are_those_of_iso_54_in_order():
    def modules(series, own=None):
        return SizingPart.modules.fget(SimpleNamespace(normal_modules=own, module_series=series))

    preferred, all_of_them = modules("I"), modules("II")
    assert preferred[:5] == (1e-3, 1.25e-3, 1.5e-3, 2e-3, 2.5e-3)
    assert {2.25e-3, 2.75e-3, 9e-3} < set(all_of_them) - set(preferred)
    assert set(preferred) < set(all_of_them)
    assert list(all_of_them) == sorted(all_of_them)
    assert modules("I", (3e-3, 1e-3, 3e-3)) == (1e-3, 3e-3)


def test_fewer_helical_variants_are_verified_than_spur_ones():
    def count(angles, verified=None):
        return SizingPart.verified_count.fget(SimpleNamespace(verified=verified, chosen_helix_angles=angles))

    assert count((0.0,)) > count((0.0, 0.2)) == count((0.3,)) > 0
    assert count((0.0,), 0) == count((0.3,), 0) == 0


def test_tolerances_of_gears_smaller_than_the_standard_s_are_those_of_its_smallest():
    """Modules of ISO 1328-1 begin at 0.5 mm: 0.3 mm takes theirs."""
    small = case(module="0.3 mm")
    least = flank_tolerances(5, 6e-3, 0.5e-3, 20e-3).rounded  # 20 teeth of 0.3 mm
    scene = scene_of(small)
    for one, d in zip(tip_tolerances(scene, "I"), (6e-3, 9.3e-3), strict=True):
        assert one.amount == flank_tolerances(5, d, 0.5e-3, 20e-3).rounded.profile_slope
        assert one.form == flank_tolerances(5, d, 0.5e-3, 20e-3).rounded.profile_form
    lead = flank_tolerance(scene, "I").lead
    assert (lead.slope, lead.crowning) in {
        (one.helix_slope, one.helix_form) for one in (least, flank_tolerances(5, 9.3e-3, 0.5e-3, 20e-3).rounded)
    }


def test_a_gear_that_meshes_with_its_like_has_half_of_the_sum_of_shifts():
    """20 teeth of 2 mm at 41 mm: inv(a_w) = inv(a) + 2 x tan(a) / z."""
    document = case(
        {"driven": "a", "centre_distance": "41 mm", "shift_distribution": "equal"},
        {"a": {"teeth": 20, "module": "2 mm", "face_width": "10 mm"}},
    )
    alpha = math.radians(20.0)
    working = math.acos(40.0 * math.cos(alpha) / 41.0)
    half = 0.5 * 20 * (math.tan(working) - working - math.tan(alpha) + alpha) / math.tan(alpha)
    assert scene_of(document).gears["a"].tooth.profile_shift == pytest.approx(half, rel=1e-9)


def test_a_backlash_of_half_a_module_is_a_wrong_unit():
    error = refused(case({"normal_backlash": "6 mm"}))
    assert error.key == "pair.I.normal_backlash"
    assert "more than half a module" in error.rule
    assert scene_of(case({"normal_backlash": "0.2 mm"})).pairs["I"].normal_backlash == pytest.approx(0.2e-3, rel=1e-6)


# ---- drafts of gearboxes ---------------------------------------------------------------------------------------------
@pytest.mark.parametrize(("begins", "room"), [(2.0, 2.0), (2.0, 3.0), (2.5, 10.0), (2.0, 99.0), (32.0, 99.0)])
def test_a_second_stage_takes_the_first_module_of_the_series_that_has_room(monkeypatch, begins, room):
    """Where none has any, it is that of its torque."""
    tried = []

    def laid(both):
        tried.append(both[1])
        return SimpleNamespace(stages=(both[0], SimpleNamespace(si=lambda _name: both[1] * 1e-3)), module=both[1])

    monkeypatch.setattr(stages, "_first", lambda _answers: "first")
    monkeypatch.setattr(stages, "_next", lambda _answers, _before, _number, least: max(least, begins))
    monkeypatch.setattr(stages, "laid_out", laid)
    monkeypatch.setattr(stages, "_beside", lambda draft, stage: stage == 1 and draft.module >= room)
    found = stages.staged(SimpleNamespace(kind=TWO_STAGES))
    assert tried == [one for one in MODULES if begins <= one <= room]
    assert found.module == (begins if room > MODULES[-1] else room)


def test_of_three_stages_the_one_without_room_grows_and_the_last_one_with_it(monkeypatch):
    """Stage 2 needs 4 mm, stage 3 then 6 mm: each step is the next module of the series for the first without room."""
    tried = []

    def laid(modules):
        tried.append(modules)
        return SimpleNamespace(stages=[SimpleNamespace(si=lambda _name, m=one: m * 1e-3) for one in modules])

    monkeypatch.setattr(stages, "_first", lambda _answers: 2.0)
    monkeypatch.setattr(stages, "_next", lambda _answers, before, _number, least: max(before, least))
    monkeypatch.setattr(stages, "laid_out", laid)
    needed = {1: 4.0, 2: 6.0}
    monkeypatch.setattr(stages, "_beside", lambda draft, n: draft.stages[n].si("module") >= needed[n] * 1e-3)
    stages.staged(SimpleNamespace(kind=THREE_STAGES))
    assert tried == [
        (2.0, 2.0, 2.0), (2.0, 2.5, 2.5), (2.0, 3.0, 3.0), (2.0, 4.0, 4.0), (2.0, 4.0, 5.0), (2.0, 4.0, 6.0),
    ]  # fmt: skip


def test_axes_have_room_for_bearings_and_the_wheel_beside_the_shaft(monkeypatch):
    """Bearings of 60 and 80 mm need 70 mm, the wheel of 95 mm tip radius beside a shaft of 40 mm 115 mm, and a gap."""

    def laid(distances):
        shafts = [
            SimpleNamespace(thick=0.04, bearings={"l": SimpleNamespace(outside=d), "r": SimpleNamespace(outside=0.05)})
            for d in (0.06, 0.08, 0.08)
        ]
        return SimpleNamespace(
            shafts=shafts, distances=distances, stages=[SimpleNamespace(si=lambda _name: 2e-3)] * len(distances)
        )

    monkeypatch.setattr(stages, "tip_radii", lambda _stage: (0.02, 0.095))
    gap = stages._APART * 2e-3
    assert gap > 0.0
    for first, second, apart in (
        (0.0701, 0.1151, True), (0.0699, 0.1151, False), (0.0701, 0.1149, False), (0.2, 0.2, True)
    ):  # fmt: skip
        assert stages._apart(laid((first + gap, second + gap))) is apart
    assert stages._apart(laid((0.0701 + gap,)))
    shorter = [laid((0.2, 0.0801 + gap)), laid((0.2, 0.0799 + gap))]  # bearings of 80 mm on both
    monkeypatch.setattr(stages, "tip_radii", lambda _stage: (0.02, 0.01))
    assert [stages._apart(one) for one in shorter] == [True, False]


@pytest.mark.parametrize("kind", [TWO_STAGES, "gearbox"])
@pytest.mark.parametrize("rounded", [True, False])
@pytest.mark.parametrize(
    ("given", "room", "module"), [(None, 2.5, 2.5), (None, 2.0, 2.0), (None, 99.0, 2.0), (2.0, 99.0, 2.0)]
)
def test_a_gearbox_takes_the_first_module_with_room_unless_one_is_given(
    monkeypatch, kind, given, room, module, rounded
):
    @dataclass(frozen=True)
    class Given:
        kind: str
        suited: dict
        rounded: bool
        whole: bool = False

        def assumed(self, _name):
            return given is None

        def si(self, _name):
            return float(self.suited["module"].split()[0]) * 1e-3

        def __getitem__(self, name):
            return {"torque": "50 N*m"}[name]

    monkeypatch.setattr(stages, "staged", lambda answers: answers)
    monkeypatch.setattr(stages, "_apart", lambda one: one.si("module") >= (room - 1e-6) * 1e-3)
    monkeypatch.setattr(stages, "with_whole_distances", lambda one: replace(one, whole=True))
    start = Given(kind, {"module": "2 mm"}, rounded)
    found = stages.with_room(start)
    assert found.si("module") == pytest.approx(module * 1e-3)
    assert found.whole is rounded
    assert (found.suited is start.suited) == (module == 2.0)
    assert module == 2.0 or found.suited["torque"] == "50 N*m"


def test_planets_are_placed_by_their_number_or_by_their_angles():
    """The first of equally spaced planets may be turned; angles say it themselves."""
    uneven = CompoundPlanetPart.model_validate({"carrier": "c", "angles": ["0 deg", "117 deg"]})
    assert uneven.angles == pytest.approx([0.0, math.radians(117.0)])
    turned = CompoundPlanetPart.model_validate({"carrier": "c", "planets": 3, "first_angle": "10 deg"})
    assert turned.first_angle == pytest.approx(math.radians(10.0))
    for placed, words in (
        ({"angles": ["0 deg", "117 deg"], "first_angle": "10 deg"}, "contradicts angles"),
        ({"angles": ["0 deg"], "planets": 3}, "must be specified in one way"),
        ({}, "must be specified in one way"),
    ):
        with pytest.raises(ValueError, match=words):
            CompoundPlanetPart.model_validate({"carrier": "c", **placed})
