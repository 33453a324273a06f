"""Relief for who grinds it: the points of a profile chart stand for the relief, and the tables are the case's."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.flank_modifications import described_relief
from fegear.case.reading import build_scene
from fegear.geometry.relief import CombinedRelief, Crowning, EndRelief, TabulatedRelief, chart_points
from fegear.output.export import export_gears


def _random_relief(chance: np.random.Generator) -> CombinedRelief:
    parts = [EndRelief(chance.uniform(0, 4e-5), chance.uniform(0.3, 0.5), 0.6, chance.choice([1.0, 2.0]))]
    parts += [EndRelief(chance.uniform(0, 4e-5), chance.uniform(0.2, 0.3), 0.1, 2.0)] * int(chance.integers(2))
    parts += [Crowning(chance.uniform(0, 1e-5), 0.1, 0.6)] * int(chance.integers(2))
    roll = np.sort(chance.uniform(0.1, 0.6, 12))
    form = str(chance.choice(["linear", "cubic"]))
    parts += [TabulatedRelief(roll, chance.uniform(0, 2e-5, 12), form)] * int(chance.integers(2))
    return CombinedRelief(tuple(parts))


def test_lines_between_the_points_of_a_chart_stay_close_to_the_relief():
    chance = np.random.default_rng(3)
    for _ in range(40):
        relief, within = _random_relief(chance), 10.0 ** chance.uniform(-8, -6)
        roll = chart_points(relief, 0.12, 0.61, within, (0.37, 0.9))
        assert (roll[0], roll[-1]) == (0.12, 0.61)
        assert 0.37 in roll
        assert (np.diff(roll) > 0.0).all()
        dense = np.linspace(0.12, 0.61, 4999)
        missed = np.abs(np.interp(dense, roll, relief.removal(roll)) - relief.removal(dense)).max()
        assert missed < 1.05 * within + 1e-10


def test_a_chart_of_straight_lines_has_their_corners_and_no_other_point():
    relief = CombinedRelief((EndRelief(2e-5, 0.45, 0.6), EndRelief(1e-5, 0.2, 0.1)))
    assert chart_points(relief, 0.1, 0.6, 1e-7) == pytest.approx([0.1, 0.2, 0.45, 0.6])
    assert chart_points(CombinedRelief(), 0.1, 0.6, 1e-7) == pytest.approx([0.1, 0.6])
    # Lines that may miss nothing have every place that is tried as a point, the only one between two others, too.
    every = chart_points(Crowning(5e-6, 0.1, 0.6), 0.1, 0.6, 0.0)
    assert np.diff(every).max() < 1.01 * 0.5 / 2000.0


CASE = {
    "results": ["geometry"],
    "gear": {
        "a": {"teeth": 28, "module": "3 mm", "face_width": "10 mm",
              "relief": {"tip": {"amount": "20 um", "start_roll_angle": "26 deg", "shape": "parabolic"}}},
        "b": {"teeth": 41, "module": "3 mm", "face_width": "10 mm"},
    },
    "pair": {"I": {"driver": "a", "driven": "b", "load": "1 kN"}},
}  # fmt: skip


def test_the_tables_for_the_grinder_are_the_relief_of_the_case(tmp_path):
    scene = build_scene(CASE, "c", tmp_path)
    written = export_gears(scene, tmp_path, (), "relief")
    assert written.files == ("a_relief.csv", "a_k_chart.csv")
    assert any("Gear b, RELIEF: no relief specified" in one for one in written.remarks)
    with (tmp_path / "a_k_chart.csv").open() as file:
        head, *rows = csv.reader(file)
    assert head == ["point", "diameter [mm]", "roll_angle [deg]", "roll_length [mm]", "removal [um]"]
    assert rows[0][0] == "start of involute"
    assert rows[-1][0] == "end of involute"
    assert any(row[0] == "start of active profile, pair I" for row in rows)
    assert float(rows[-1][1]) == pytest.approx(30 * 3.0)  # the tip circle, 28 + 2 modules
    assert float(rows[-1][4]) == pytest.approx(20.0)
    base = 14 * 3.0 * math.cos(math.radians(20.0))
    for _, diameter, angle, length, removal in rows:
        roll = math.radians(float(angle))
        assert float(diameter) == pytest.approx(2.0 * base * math.sqrt(1.0 + roll**2))
        assert float(length) == pytest.approx(base * roll)
        tip = math.degrees(math.sqrt((45.0 / base) ** 2 - 1.0))
        share = max(0.0, (float(angle) - 26.0) / (tip - 26.0))
        assert float(removal) == pytest.approx(20.0 * share**2, abs=1e-6)


def test_the_tables_of_a_ring_gear_are_positive_and_are_read_back_with_either_sign(tmp_path):
    def scene_of(relief):
        ring = {"teeth": 97, "internal": True, "module": "2.25 mm", "face_width": "20 mm", "rim_thickness": "10 mm",
                "cutter": {"teeth": 25, "addendum": 1.25, "tip_radius": 0.3}, "relief": relief}  # fmt: skip
        planet = {"teeth": 31, "module": "2.25 mm", "face_width": "20 mm", "profile_shift": 0.15}
        pair = {"I": {"driver": "planet", "driven": "ring", "load": "1 kN"}}
        return build_scene(
            {"results": ["geometry"], "gear": {"planet": planet, "ring": ring}, "pair": pair}, "c", tmp_path
        )

    ends = {"amount": "10 um", "shape": "parabolic"}
    scene = scene_of({"tip": ends | {"start_roll_angle": "21.9 deg"}})
    gear = scene.gears["ring"]
    export_gears(scene, tmp_path, ("ring",), "relief")
    with (tmp_path / "ring_k_chart.csv").open() as file:
        _, *rows = csv.reader(file)
    assert [rows[0][0], rows[-1][0]] == ["start of involute", "end of involute"]  # the root first, as of every gear
    base = gear.base_radius * 1e3
    for _, diameter, angle, length, _removal in rows:
        assert float(length) == pytest.approx(base * math.radians(float(angle)))
        assert float(angle) == pytest.approx(math.degrees(math.sqrt((float(diameter) / 2.0 / base) ** 2 - 1.0)))
    removal = {row[2]: float(row[4]) for row in rows}
    assert all(one == 0.0 for angle, one in removal.items() if float(angle) > 21.9)
    assert float(rows[-1][4]) == pytest.approx(10.0)
    roll = np.linspace(gear.tooth.involute.start, gear.tooth.involute.end, 50)
    (tip,) = described_relief(scene, "ring").relief.parts
    assert tip.start == pytest.approx(math.radians(-21.9))
    shifted = (tmp_path / "ring_relief.csv").read_text("utf-8").replace("removal", "relief")
    (tmp_path / "back.csv").write_text(shifted, "utf-8")
    listed = {"roll_angles": ["18 deg", "20 deg", "21.9 deg"], "removals": ["10 um", "4 um", "0 um"]}
    minus = {"roll_angles": ["-21.9 deg", "-20 deg", "-18 deg"], "removals": ["0 um", "4 um", "10 um"]}
    for ours, theirs, within in (
        ({"table": {"file": "back.csv"}}, {"tip": ends | {"start_roll_angle": "-21.9 deg"}}, 5e-8),
        ({"table": listed}, {"table": minus}, 1e-15),
    ):
        found = [described_relief(scene_of(one), "ring").relief.removal(roll) for one in (ours, theirs)]
        assert np.ptp(found[1]) > 5e-6
        np.testing.assert_allclose(*found, atol=within)


def test_gears_without_relief_have_none_to_grind(tmp_path):
    scene = build_scene(CASE, "c", tmp_path)
    with pytest.raises(InputError, match="has nothing to write: no gear has a relief of"):
        export_gears(scene, tmp_path, ("b",), "relief")
