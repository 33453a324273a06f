"""Root stress of teeth between two mates: by whole curves along the fillet, and by loads put on both flanks by hand."""

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

SIZE = {"module": "2 mm", "face_width": "25 mm", "thickness_allowance": "20 um"}
RING = {"internal": True, "teeth": 83, "cutter": {"teeth": 30}, "tip_diameter": "162.4 mm", "rim_thickness": "10 mm"}
CACHE = SolutionCache()


def run(gears=None, results=("planet-root-stress",), **keys):
    part = {"sun": "s", "planet": "p", "ring": "r", "planets": 3, "torque": "320 N*m"} | keys
    part = {key: one for key, one in part.items() if one is not None}
    case = {
        "results": list(results),
        "accuracy": {"tolerance": 1e-2},
        "effects": {"hertz": "linear", "neighbour_coupling": True},
        "gear": {"s": SIZE | {"teeth": 25}, "p": SIZE | {"teeth": 29}, "r": SIZE | RING},
        "planetary": {"P": part},
    }
    for name, more in (gears or {}).items():
        case["gear"][name] |= more
    if "rating" in results:
        case["rating"] = {"beside": ["computed"]}
    scene = build_scene(case, "case", None)
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


@pytest.fixture(scope="module")
def ran():
    return run()


@pytest.fixture(scope="module")
def found(ran):
    return ran.outcomes[Task("planet-root-stress", "P")].data.found


def history(ran, mesh, member):
    """Largest tension and most negative compression wherever they stand, by the result of the pair."""
    stress = ran.outcomes[Task("root-stress-history", f"P_{mesh}")].data.found.stress[member]["fe"]
    return float(stress.largest_tension[0]), float(stress.largest_compression[0]), stress.error(0)


def test_highest_stress_is_that_of_the_mesh_and_the_lowest_is_no_more_than_its_compression(ran, found):
    """At one place the compression is at most the largest of all places, and not far from it."""
    for tooth, pulled, pressed in (("planet_sun_side", "sun", "ring"), ("planet_ring_side", "ring", "sun")):
        member = {"sun": "driven", "ring": "driver"}
        tension, _, error = history(ran, pulled, member[pulled])
        _, compression, _ = history(ran, pressed, member[pressed])
        one = found[tooth]
        assert abs(one.highest - tension) <= one.highest_error
        assert error <= one.highest_error < 0.02 * tension
        assert compression - one.lowest_error <= one.lowest <= 0.97 * compression
    for mesh, member in (("sun", "driver"), ("ring", "driven")):
        assert found[mesh].highest == pytest.approx(history(ran, mesh, member)[0], rel=2e-3)
        assert -0.3 < found[mesh].ratio < 0.0  # pressed by its neighbours' loads alone


def test_numbers_of_one_place_hang_together(found):
    for one in found.values():
        assert one.range == pytest.approx(one.highest - one.lowest)
        assert one.mean == pytest.approx(0.5 * (one.highest + one.lowest))
        assert one.ratio == pytest.approx(one.lowest / one.highest)
        assert one.ratio_error == pytest.approx(
            abs(one.ratio) * (one.highest_error / one.highest + one.lowest_error / abs(one.lowest))
        )


def test_stress_at_the_place_is_that_of_the_influence_functions(ran, found):
    """One load on a flank by hand: its own stress curve along both fillets, read at the place."""
    pair = ran.outcomes[Task("loaded-pair", "P_sun")].data
    e, load = pair.engagement, pair.nominal
    x = np.array([0.5 * (e.pair.x_end - e.pair.base_pitch + e.pair.x_start + e.pair.base_pitch)])
    state = e.solve(e.grid(x), [load])
    (row,) = np.flatnonzero(state.loads[:, 0, 0] > 0.0)
    influence = ran.outcomes[Task("gear-solution", "p")].data
    radius = [float(state.grid.contacts.radius_driven[row, 0])]
    source, line = e.compliance.source("driven"), load / e.pair.face_width
    table = ran.outcomes[Task("planet-root-stress", "P")].data
    assert influence is not None
    for side, place, stress in (
        ("tension", found["planet_sun_side"].place, table.stress[0]),
        ("compression", found["planet_ring_side"].place, table.stress[1]),
    ):
        along = source.root_stress(0, 0, radius, side)[:, 0] * line
        by_hand = np.interp(place, source.fillet_curve(0, side).arc, along)
        own = np.array(table.mesh) == "sun"
        there = state.grid.contacts.x[row, 0]
        order = np.argsort(table.x[own])
        assert np.interp(there, table.x[own][order], stress[own][order]) == pytest.approx(by_hand, rel=0.02)


def test_a_tooth_meets_the_ring_half_a_turn_after_the_sun_and_back(ran):
    """Less both halves of its thickness where the sun drives, more where the ring does; stresses stay."""
    table = ran.outcomes[Task("planet-root-stress", "P")].data
    back = run(fixed="carrier", input="ring", torque=f"{320 * 83 / 25:.12g} N*m")
    other = back.outcomes[Task("planet-root-stress", "P")].data
    turn = []
    for one in (table, other):
        mesh, radius = np.array(one.mesh), 29e-3 * np.cos(np.radians(20.0))
        turn.append(float(np.mean(one.angle[mesh == "ring"] - one.x[mesh == "ring"] / radius)))
    assert sum(turn) == pytest.approx(2.0 * np.pi)
    assert turn[0] == pytest.approx(np.pi - np.pi / 29, abs=0.01)
    for tooth in table.found:
        assert other.found[tooth].range == pytest.approx(table.found[tooth].range, rel=0.05)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        (
            {"ring": None, "ring_teeth": 83, "stiffness": {"ring_mesh": "480 N/um"}},
            "is required for alternating bending of the",
        ),
    ],
)
def test_what_is_refused(keys, said):
    with pytest.raises(InputError, match=said):
        run(**keys)


def test_the_computed_rating_takes_the_ratio_and_names_it(found):
    strong = {"strength": {"material": "case-hardened-steel"}}
    results = run(dict.fromkeys("spr", strong), ("rating",), speed="1000 rpm")
    table = next(one for one in results.tables if one.name == "rating_P_sun")
    rows = {one.name: list(one.values) for one in table.columns}
    of, computed = rows["driven"], rows["driven_computed"]
    at = rows["symbol"].index("Y_M")
    # 1 / (1 - R (1 - M)/(1 + M)), of one M
    slope = (1.0 / of[at] - 1.0) / 1.2
    ratio = max(found["planet_sun_side"].ratio, -1.2)
    assert computed[at] == pytest.approx(1.0 / (1.0 - ratio * slope), rel=1e-3)
    assert rows["driver_computed"][at] == 1.0
    assert any(f"R = {found['planet_sun_side'].ratio:.4g} of the planet" in one for one in results.remarks)
