"""Leads and measured flanks of asymmetric teeth, each flank its own: ends, files, exchanged flanks, refusals."""

import copy
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.flank_modifications import gear_face
from fegear.case.built.gear_flanks import gear_flanks
from fegear.case.built.pair_notes import end_notes
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.table_ends import table_end_notes
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

GEAR = {
    "teeth": 22, "module": "3 mm", "pressure_angle": "30 deg", "coast_pressure_angle": "20 deg",
    "rack": {"tip_radius": 0.15, "coast_tip_radius": 0.3}, "face_width": "8 mm", "bore_radius": "15 mm",
}  # fmt: skip
#: Heights at which removals are compared [m].
Z = np.linspace(-4e-3, 4e-3, 41)


def case(flank="drive", results=("transmission-error",), exchanged=False, **gear):
    """Two gears, the first with what is given; the flanks exchanged."""
    plain = copy.deepcopy(GEAR)
    if exchanged:
        plain |= {"pressure_angle": "20 deg", "coast_pressure_angle": "30 deg"}
        plain["rack"] = {"tip_radius": 0.3, "coast_tip_radius": 0.15}
    return {
        "gear": {"p": {**plain, **gear}, "w": {**plain, "teeth": 31}},
        "pair": {"I": {"driver": "p", "driven": "w", "flank": flank, "load": "2 kN", "width": "slices"}},
        "results": list(results), "effects": {"relief": True}, "accuracy": {"tolerance": 0.3},
    }  # fmt: skip


def built(document, folder=None):
    return build_scene(document, "case", folder or Path())


def removal(document, folder=None):
    """What is ground off the pinion's loaded flank along its face."""
    return sum(part.removal(0.3, Z) for part in gear_face(built(document, folder), "p")) + np.zeros(Z.size)


LEADS = [
    {"slope": "12 um"},
    {"crowning": "4 um", "end_relief": {"amount": "5 um", "length": "2 mm", "end": "I"}},
    {"slope": "-3 um", "end_relief": [{"amount": "5 um", "length": "2 mm", "end": "II", "shape": "parabolic"}]},
]


@pytest.mark.parametrize("lead", LEADS)
def test_a_lead_is_at_one_end_of_the_gear_on_both_flanks(lead):
    """The coast flank counts its ends from the other side."""
    drive, coast = (removal(case(flank, lead=lead)) for flank in ("drive", "coast"))
    assert np.ptp(drive) > 2e-6
    assert coast == pytest.approx(drive[::-1], abs=1e-18)


@pytest.mark.parametrize("lead", LEADS)
def test_coast_flanks_have_their_own_lead(lead):
    other = {"crowning": "2 um"}
    assert removal(case("drive", lead=lead, coast_lead=other)) == pytest.approx(removal(case(lead=lead)), abs=1e-18)
    assert removal(case("coast", lead=other, coast_lead=lead)) == pytest.approx(removal(case("coast", lead=lead)))
    assert not removal(case("drive", coast_lead=lead)).any()  # one-sided


def written(folder, name, z, values, head):
    (folder / name).write_text(f"z [mm],{head} [um]\n" + "\n".join(f"{a},{b}" for a, b in zip(z, values, strict=True)))


def test_lead_files_of_each_flank(tmp_path):
    z = np.linspace(-4.0, 4.0, 33)
    written(tmp_path, "drive.csv", z, 2.0 + z, "removal")
    written(tmp_path, "coast.csv", z, z**2, "removal")
    leads = {"lead": {"file": "drive.csv"}, "coast_lead": {"file": "coast.csv"}}
    assert removal(case(**leads), tmp_path) == pytest.approx(2e-6 + 1e-3 * Z, abs=1e-12)
    assert removal(case("coast", **leads), tmp_path) == pytest.approx(np.interp(Z, z * 1e-3, z**2 * 1e-6), abs=1e-12)
    leads["coast_lead"] = {"file": "nowhere.csv"}
    removal(case(**leads), tmp_path)
    with pytest.raises(InputError, match=r"^gear\.p\.coast_lead\.file"):
        removal(case("coast", **leads), tmp_path)


def test_measured_files_of_each_flank(tmp_path):
    z = np.linspace(-4.0, 4.0, 81)
    written(tmp_path, "drive.csv", z, -0.5 * z, "deviation")
    written(tmp_path, "coast.csv", z, 2.0 * z, "deviation")
    measured = {
        "measured": {"lead": "drive.csv", "filter": False}, "coast_measured": {"lead": "coast.csv", "filter": False}
    }  # fmt: skip
    slopes = [np.polyfit(Z, removal(case(flank, **measured), tmp_path), 1)[0] for flank in ("drive", "coast")]
    assert slopes == pytest.approx([0.5e-3, 2.0e-3], rel=1e-6)  # -2 along the drive flank's z
    only = {"coast_measured": measured["coast_measured"], "lead": {"slope": "8 um"}}
    assert np.polyfit(Z, removal(case(**only), tmp_path), 1)[0] == pytest.approx(1e-3)
    assert np.polyfit(Z, removal(case("coast", **only), tmp_path), 1)[0] == pytest.approx(2e-3)
    with pytest.raises(InputError, match=r"^gear\.p\.coast_measured\.lead"):
        removal(case("coast", coast_measured={"lead": "nowhere.csv"}), tmp_path)


def test_measured_profiles_count_from_the_base_circle_of_their_flank(tmp_path):
    scene = built(case("coast"))
    base = scene.gears["p"].base_radius
    roll = np.linspace(5.0, 36.0, 60)
    text = "roll_angle [deg],deviation [um]\n" + "\n".join(f"{a},{-0.1 * a}" for a in roll)
    (tmp_path / "coast.csv").write_text(text)
    scene = built(case("coast", coast_measured={"profile": "coast.csv", "filter": False}), tmp_path)
    (table,) = gear_flanks(scene, "p").relief.tables
    assert base == pytest.approx(33e-3 * np.cos(np.deg2rad(20.0)))
    assert np.diff(table.values) == pytest.approx(0.1e-6 * np.rad2deg(np.diff(table.roll)), abs=1e-12)
    assert gear_flanks(built(case(coast_measured={"profile": "coast.csv"}), tmp_path), "p").relief is None


@pytest.mark.parametrize("flank", ["drive", "coast"])
def test_measured_flanks_are_compared_with_the_design_of_their_flank(tmp_path, flank):
    z = np.linspace(-4.0, 4.0, 81)
    written(tmp_path, "drive.csv", z, -(z + 4.0), "deviation")
    written(tmp_path, "coast.csv", z, 2.0 * (z + 4.0), "deviation")
    scene = built(
        case(
            flank, ("measured-flanks",), lead={"slope": "8 um"}, coast_lead={"slope": "-16 um"},
            measured={"lead": "drive.csv"}, coast_measured={"lead": "coast.csv"},
        ),
        tmp_path,
    )  # fmt: skip
    values = {one.name: one.si for one in run_plan(scene, make_plan(scene, STAGES)).values}
    assert values["p.helix_slope"] == pytest.approx(0.0, abs=1e-9)
    assert values["p.helix_total"] == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize("key", ["coast_lead", "coast_measured"])
def test_equal_flanks_have_one_lead(key):
    equal = case(**{key: {"lead": "a.csv"} if key == "coast_measured" else {"slope": "3 um"}})
    for gear in equal["gear"].values():
        gear |= {"coast_pressure_angle": "30 deg", "rack": {"tip_radius": 0.15}}
    with pytest.raises(InputError, match=rf"^gear\.p\.{key} = .*requires asymmetric teeth; specify"):
        built(equal)


def test_a_note_says_that_ends_are_seen_from_the_other_side(tmp_path):
    z = np.linspace(-3.0, 3.0, 13)  # shorter than the face, which another note says
    written(tmp_path, "lead.csv", z, z, "removal")
    said = {
        flank: pair_notes_of(built(case(flank, lead={"file": "lead.csv"}), tmp_path)) for flank in ("drive", "coast")
    }
    ends = "Pair I: coast flanks loaded, face position z from the other side; end I of lead is at positive z here."
    assert ends in said["coast"]
    assert ends not in said["drive"]
    assert any("lead table" in note for note in said["drive"])
    assert any("lead table" in note for note in said["coast"])
    assert end_notes(built(case("coast")), "I") == ()


def pair_notes_of(scene):
    return (*end_notes(scene, "I"), *table_end_notes(pair_spec(scene, "I", over_face=True)))


def test_a_measured_topography_is_mirrored_with_its_flank(tmp_path):
    roll, z = np.linspace(5.0, 36.0, 40), np.linspace(-4.0, 4.0, 17)
    rows = "\n".join(f"{a},{b},{-0.2 * a - b}" for a in roll for b in z)
    (tmp_path / "flank.csv").write_text(f"roll_angle [deg],z [mm],deviation [um]\n{rows}")
    found = removal(case("coast", coast_measured={"topography": "flank.csv", "filter": False}), tmp_path)
    assert np.polyfit(Z, found, 1)[0] == pytest.approx(-1e-3, rel=1e-9)


@pytest.mark.dear
def test_exchanged_flanks_are_a_mirrored_pair():
    """The coast flanks loaded, and the same as drive flanks with the other end relieved."""
    relief = {"amount": "8 um", "length": "3 mm", "end": "I"}
    found = []
    for document in (
        case("coast", lead={"end_relief": relief}),
        case("drive", exchanged=True, lead={"end_relief": relief | {"end": "II"}}),
        case("drive", exchanged=True, lead={"end_relief": relief}),
    ):
        scene = built(document)
        values = run_plan(scene, make_plan(scene, STAGES)).values
        found.append(np.array([one.si for one in values if one.name in ("I.te_mean", "I.te_peak_to_peak")]))
    coast, exchanged, other_end = found
    assert exchanged == pytest.approx(coast, rel=1e-12)
    assert other_end == pytest.approx(coast, rel=1e-9)  # a spur pair does not tell its ends
