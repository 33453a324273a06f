"""Drawings of gears in mesh with their stress: loads at the points of the path, stress at the fillets, files."""

import re
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.geometry.pair import MEMBERS
from fegear.output.export import export_gears
from fegear.results.catalogue import STAGES
from fegear.results.gear.drawing import moving_pair
from fegear.results.pair.drawn_mesh import _rounded_up, standing_at_points, stress_drawings, tooth_stress, turned_by

GEAR = {"module": "4 mm", "face_width": "20 mm", "plane": "stress"}
CASE = {
    "title": "gears in mesh", "results": ["root-stress-history"],
    "gear": {
        "p": {"teeth": 18, "profile_shift": 0.3, "bore_radius": "15 mm", **GEAR},
        "w": {"teeth": 41, "bore_radius": "30 mm", **GEAR},
    },
    "pair": {"I": {"driver": "p", "driven": "w", "torque": "150 N*m"}},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent"},
    "accuracy": {"tolerance": 0.05},
}  # fmt: skip


@pytest.fixture(scope="module")
def scene():
    return build_scene(CASE, "mesh", Path())


@pytest.fixture(scope="module")
def results(scene):
    tasks = [Task("stress-inside", "I"), Task("root-stress-history", "I"), Task("loaded-pair", "I")]
    return run_plan(scene, make_plan(scene, STAGES, tasks), cache=SolutionCache())


@pytest.fixture(scope="module")
def loaded(results):
    return results.outcomes[Task("loaded-pair", "I")].data


@pytest.fixture(scope="module")
def inside(results):
    return results.outcomes[Task("stress-inside", "I")].data


def test_gears_stand_at_the_points_of_the_path_with_their_loads(loaded):
    pair = loaded.pair
    stands = {one.letter: one for one in standing_at_points(loaded.engagement, loaded.nominal)}
    assert list(stands) == ["A", "B", "C", "D", "E"]
    assert {letter: len(one.touching) for letter, one in stands.items()} == {"A": 2, "B": 1, "C": 1, "D": 1, "E": 2}
    for one in stands.values():
        assert sum(touching.load for touching in one.touching) == pytest.approx(loaded.nominal, rel=1e-6)
        for touching in one.touching:  # pair 0 is the one that stands at the point
            assert touching.x == pytest.approx(one.x + touching.number * pair.base_pitch, abs=1e-9)
        assert 0 in {touching.number for touching in one.touching}


def test_stress_at_the_fillets_is_the_root_stress(results, loaded, inside):
    """Von Mises at a free surface in plane stress is its tangential stress; the history searches the maximum."""
    largest = {value.name: value.value for value in results.values}
    stands = standing_at_points(loaded.engagement, loaded.nominal)
    for member, letter in (("driver", "D"), ("driven", "B")):  # where one pair carries all farthest out on the tooth
        stand = next(one for one in stands if one.letter == letter)
        tooth = inside.gears[member]
        mises = 1e-6 * tooth_stress(tooth, inside.pair, member, 0, stand.touching)
        both = [largest[f"I.{member}.largest_root_{kind}"] for kind in ("tension", "compression")]
        assert mises[tooth.table.fillet].max() == pytest.approx(max(map(abs, both)), rel=0.02)
        beside = 1e-6 * tooth_stress(tooth, inside.pair, member, 2, stand.touching)
        assert beside[tooth.table.fillet].max() < 0.5 * mises[tooth.table.fillet].max()


def test_the_stress_is_where_the_flanks_touch(loaded, inside):
    pair, moving = inside.pair, moving_pair(inside.pair, 0)
    stand = next(one for one in standing_at_points(loaded.engagement, loaded.nominal) if one.letter == "D")
    touches = stand.touching[0].x * np.array([np.cos(moving.pressure_angle), np.sin(moving.pressure_angle)])
    for member in MEMBERS:
        tooth = inside.gears[member]
        mises = tooth_stress(tooth, pair, member, 0, stand.touching)
        upper = ~tooth.table.fillet & (np.hypot(*tooth.table.points) > pair.gear(member).form_radius / 4e-3)
        angle = turned_by(moving, member, 0, stand.x, pair.base_pitch)
        centre = np.array([0.0, -moving.driver_radius if member == "driver" else moving.driven_radius])[:, None]
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        places = turn @ (tooth.places - centre) + centre
        most = places[:, upper][:, np.argmax(mises[upper])]
        assert np.hypot(*(most - touches)) < 0.2 * 4e-3  # within the half-width of the pressure that is shown


def test_drawings_have_the_teeth_of_both_gears_where_they_touch(loaded, inside):
    """Lengths in mm from the pitch point: mates touch where loads are, each tooth is the one that its stress is of."""
    pair, drawings = inside.pair, list(stress_drawings("I", loaded.engagement, loaded.nominal, inside))
    stands = standing_at_points(loaded.engagement, loaded.nominal)
    assert [one.letter for one in drawings] == list("ABCDE")
    assert len({one.top for one in drawings}) == 1
    for one, stand in zip(drawings, stands, strict=True):
        assert one.loads == pytest.approx(np.array([(1e3 * at.x, at.load) for at in stand.touching]))
        assert one.points.shape[1] == one.stress.size
        assert one.triangles.min() == 0
        assert one.triangles.max() == one.stress.size - 1
        assert one.path == pytest.approx([1e3 * pair.x_start, 1e3 * pair.x_end])
        for place, _ in one.loads:  # both outlines pass through it, and material of both gears is beside it
            at = place * one.along[:, None]
            for member in MEMBERS:
                a, b = one.outlines[member][:, :-1], one.outlines[member][:, 1:]
                chords = (a + part * (b - a) for part in np.linspace(0.0, 1.0, 21))
                assert min(np.hypot(*(points - at)).min() for points in chords) < 0.02
            beside = np.hypot(*(one.points - at)) < 0.3
            assert one.stress[beside].max() > 5.0 * np.median(one.stress)
        x, y = one.points
        assert min(-y.min(), y.max()) > 4.0  # a module and more to either side of the pitch line
        assert np.hypot(one.along[0], one.along[1]) == pytest.approx(1.0)
        assert x.min() < one.path[0]
        assert x.max() > one.path[1]
    fillets = max(
        float(tooth_stress(inside.gears[member], pair, member, at.number, stand.touching)[
            inside.gears[member].table.fillet].max())
        for stand in stands for at in stand.touching for member in MEMBERS
    )  # fmt: skip
    assert 1e-6 * fillets <= drawings[0].top < 1.1 * 1e-6 * fillets  # two digits, rounded up


@pytest.mark.parametrize(("stress", "top"), [(123e6, 130e6), (120e6, 120e6), (99.1e6, 100e6), (1.01, 1.1), (0.0, 0.0)])
def test_a_colour_scale_ends_at_two_digits_and_no_less(stress, top):
    assert _rounded_up(stress) == pytest.approx(top)


@pytest.mark.dear
def test_drawings_have_one_scale_and_are_written(scene, loaded, inside, tmp_path):
    drawings = list(stress_drawings("I", loaded.engagement, loaded.nominal, inside))
    assert len({one.top for one in drawings}) == 1
    assert [one.letter for one in drawings] == list("ABCDE")
    for one in drawings:
        assert sum(load for _, load in one.loads) == pytest.approx(one.load, rel=1e-6)
    found = export_gears(scene, tmp_path, (), "svg")
    assert found.files == tuple(f"mesh_I_{letter}.svg" for letter in "ABCDE")
    assert all((tmp_path / name).stat().st_size < 1_000_000 for name in found.files)  # as triangles 17 MB each
    texts = [re.findall(r"<!-- (.*?) -->", (tmp_path / name).read_text("utf-8")) for name in found.files]
    for one, said in zip(drawings, texts, strict=True):
        assert {*"ABCDE"} <= set(said)  # points of the path of contact
        assert {f"{load * 1e-3:.3g} kN" for _, load in one.loads} <= set(said)
        assert "driver" in said
        assert "driven" in said
    with pytest.raises(InputError, match="requires a pair of plane"):
        export_gears(build_scene({**CASE, "results": ["geometry"], "pair": {}}, "mesh", Path()), tmp_path, (), "svg")
