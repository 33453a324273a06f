"""The moving picture of a pair: colours of the fillets, deformed teeth, the tool that leaves the profile."""

import base64
import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.fem.plane.imported_mesh import read_sector_mesh
from fegear.fem.plane.outline_motion import _outline, half_plane_dent
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.outline import rack_tooth, tool_in_space, tooth_outline
from fegear.geometry.pair import MEMBERS
from fegear.geometry.rack import BasicRack
from fegear.results.catalogue import STAGES
from fegear.results.gear.drawing import moving_pair, placed_in_mesh
from fegear.window.on_gears import gears_in_mesh, on_the_gears, wanted_on_gears

CASE = {
    "results": ["root-stress-history"],
    "gear": {"a": {
        "teeth": 23, "module": "3 mm", "face_width": "10 mm", "bore_radius": "15 mm", "profile_shift": 0.3,
        "relief": {"tip": {"amount": "9 um", "length": "1.4 mm"}},
    }},
    "pair": {"I": {"driver": "a", "driven": "a", "load": "2500 N"}},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent", "relief": True},
    "accuracy": {"tolerance": 1e-3},
}  # fmt: skip
MESHES = Path(__file__).parents[2] / "meshes"
STRESS, DEFORMED = Task("stress-in-mesh", "I"), Task("deformed-in-mesh", "I")
WIDE = Task("stress-in-mesh", "I")


@pytest.fixture(scope="module")
def cache():
    return SolutionCache()


@pytest.fixture(scope="module")
def ran(cache):
    scene = build_scene(CASE, "case", None)
    return run_plan(scene, make_plan(scene, STAGES, [STRESS, DEFORMED]), cache=cache)


def test_colours_of_the_fillets_are_the_root_stress_through_the_mesh(ran):
    found = ran.outcomes[STRESS].data
    for member, table in (("driver", "root_stress_history_I_a"), ("driven", "root_stress_history_I_a_driven")):
        x, largest = (ran.tables[table].column(name).si for name in ("x", "stress"))
        # Every tooth at every roll position, and the largest of all.
        for t, j in enumerate(found.pairs.tolist()):
            own = found.roll + j * found.pair.base_pitch
            on = (own > x[0]) & (own < x[-1])
            near = np.abs(x[:, None] - own[on]).argmin(axis=0)
            assert np.abs(x[near] - own[on]).max() < 1e-12
            # Colours stand at the mesh's points; the table has the largest of the curve between them, which ends a
            # clearance below a contact on this tooth.
            coloured = found.gears[member].stress["tension"][on, t].max(axis=1)
            np.testing.assert_allclose(coloured, largest[near], rtol=0.0, atol=1e-3 * largest.max())
    value = max(ran.values[f"I.{member}.largest_root_tension"].si for member in MEMBERS)
    assert found.largest.value == pytest.approx(value, rel=1e-12)
    # Where it is marked it is.
    one = found.gears[found.largest.member]
    p, t = np.flatnonzero(found.roll == found.largest.roll)[0], list(found.pairs).index(found.largest.pair)
    at = one.stress["tension"][p, t].argmax()
    assert one.stress["tension"][p, t, at] == pytest.approx(found.largest.value, rel=5e-4)
    near = one.places["tension"][t, :, max(at - 1, 0) : at + 2]
    assert math.dist(near[:, 1], found.largest.place) <= np.hypot(*np.diff(near)).max()
    # Compression lies on the other fillet of the same tooth: on its other side.
    middle = placed_in_mesh(found.pair, "driver", np.array([[0.0], [3e-2]]), 0)
    sides = [
        np.sign(found.gears["driver"].places[side][list(found.pairs).index(0), 0] - middle[0])
        for side in ("tension", "compression")
    ]
    assert (sides[0] > 0).all()
    assert (sides[1] < 0).all()


def test_deformed_flanks_touch_where_the_load_is_shared(ran):
    """Once the driver is ahead by the transmission error, the gap of every loaded pair is closed: to 0.2 %."""
    assert _touching(ran) > 40


def test_without_coupling_a_load_moves_its_own_tooth_alone(cache):
    scene = build_scene({**CASE, "effects": {**CASE["effects"], "neighbour_coupling": False}}, "case", None)
    alone = run_plan(scene, make_plan(scene, STAGES, [DEFORMED]), cache=cache)
    assert _touching(alone) > 40


def _touching(ran):
    found, e = ran.outcomes[DEFORMED].data, ran.outcomes[Task("loaded-pair", "I")].data.engagement
    state = e.solve(e.grid(found.roll), [2500.0])
    contacts, te = state.grid.contacts, found.transmission_error
    np.testing.assert_allclose(te, state.transmission_error[:, 0], rtol=1e-12)
    along = np.array([np.cos(found.pair.working_pressure_angle), np.sin(found.pair.working_pressure_angle)])
    room, kinks = 0.3 * 3e-3, [k * found.pair.driver.base_radius for k in e.driver_relief.kinks]
    looked = 0
    for row, j in enumerate(contacts.number.tolist()):
        for p in np.flatnonzero(state.loads[row, :, 0] > 0.0).tolist():
            x, line_load = contacts.x[row, p], state.loads[row, p, 0] / e.compliance.face_width
            rolls = [contacts.roll_driver[row, p], contacts.roll_driven[row, p]]
            near = [abs(roll * found.pair.driver.base_radius - kink) for roll in rolls for kink in kinks]
            if min(x - found.pair.x_start, found.pair.x_end - x, *near) < room:
                continue  # a spline through points 0.05 modules apart follows no corner
            width = e.compliance.half_width(state.loads[row, p, 0], contacts.relative_radius[row, p])
            closed = sum(_toward(found, member, p, j, x, along, line_load, width) for member in MEMBERS)
            assert closed == pytest.approx(te[p], rel=2e-3)
            looked += 1
    return looked


def _toward(found, member, p, j, x, along, line_load, width):
    """How far the flank gives way at x on the line of action, from the points of the outline beside it."""
    from scipy.interpolate import CubicSpline

    sign = 1.0 if member == "driver" else -1.0
    gear = found.pair.gear(member)
    centre = np.array([[0.0], [-sign * gear.base_radius / np.cos(found.pair.working_pressure_angle)]])
    turn = sign * found.roll[p] / gear.base_radius  # clockwise
    t = j + 3
    points, moved = (_turned(one, turn) for one in (found.places[member][t] - centre, found.moved[member][p, t]))
    off = points + centre - (x * along)[:, None]
    tangent = np.array([-along[1], along[0]])
    beside = np.flatnonzero((np.abs(tangent @ off) < 1.0e-3) & (np.abs(along @ off) < 0.4e-3))
    order = beside[np.argsort(tangent @ off[:, beside])]
    kappa = 2.0 * (1.0 - 0.3**2) / (np.pi * gear.material.young_modulus) * line_load
    if gear.plane_assumption == "stress":
        kappa /= 1.0 - 0.3**2
    distance = np.hypot(*off[:, order])
    smooth = -sign * (along @ moved[:, order]) - kappa * half_plane_dent(distance, np.array(width))
    return float(CubicSpline(tangent @ off[:, order], smooth)(0.0)) + kappa * float(
        half_plane_dent(np.zeros(1), np.array(width))[0]
    )


def _turned(points, angle):
    s, c = np.sin(angle), np.cos(angle)
    return np.stack([c * points[0] + s * points[1], c * points[1] - s * points[0]])


def test_what_carries_nothing_stays_and_the_rest_grows_with_the_load(ran, cache):
    data = ran.outcomes[DEFORMED].data
    points = np.hypot(*(data.places["driver"][3] + np.array([[0.0], [data.pair.centre_distance / 2]])))
    fillet = points < data.pair.driver.form_radius  # no relief there
    scene = build_scene({**CASE, "pair": {"I": {**CASE["pair"]["I"], "load": "1e-3 N"}}}, "case", None)
    light = run_plan(scene, make_plan(scene, STAGES, [DEFORMED]), cache=cache).outcomes[DEFORMED].data
    assert (
        np.abs(light.moved["driver"][:, 3][..., fillet]).max()
        < 1e-6 * np.abs(data.moved["driver"][:, 3][..., fillet]).max()
    )
    assert light.largest == pytest.approx(9e-6, rel=0.05)  # what the relief takes off the tips


def test_a_half_plane_gives_way_by_the_mean_logarithm_of_the_distance():
    theta = np.pi * (np.arange(20_000) + 0.5) / 20_000
    for s in (0.0, 0.3, 0.99, 1.01, 2.0, 50.0):
        mean = float(np.mean(2.0 * np.sin(theta) ** 2 * np.log(np.abs(0.7 * s - 0.7 * np.cos(theta)))))
        assert half_plane_dent(np.array([0.7 * s]), np.array([0.7]))[0] == pytest.approx(-mean, abs=2e-4)


@pytest.mark.parametrize(("teeth", "shift"), [(12, 0.0), (28, 0.0), (23, 0.5), (90, -0.3)])
def test_the_tool_touches_the_profile_and_never_cuts_it(teeth, shift):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), shift)
    corners = tool_in_space(tooth, 601)
    share = np.linspace(0.0, 1.0, 40)  # straight between its points
    at = (corners[..., -1:, None] * (1.0 - share) + corners[..., -2:-1, None] * share).reshape(601, 2, -1)
    at = (
        np.concatenate([at, corners[..., -26:]], axis=2).transpose(1, 0, 2).reshape(2, -1)
    )  # one flank and its rounding
    profile = tooth_outline(tooth, 1e-6)
    radius = np.hypot(*profile)
    between = (profile[0] > 0.0) & (radius > tooth.root_radius + 1e-6) & (radius < tooth.tip_radius - 1e-6)
    order = np.flatnonzero(between)[np.argsort(radius[between])]
    inside = (np.hypot(*at) < radius[order[-1]]) & (np.hypot(*at) > radius[order[0]])
    r, phi = np.hypot(*at[:, inside]), np.arctan2(*at[:, inside])
    # In the space: no nearer to the tooth's centre line than its own outline at that radius.
    assert (phi - np.interp(r, radius[order], np.arctan2(*profile[:, order]))).min() * tooth.pitch_radius > -2e-5
    places = profile[:, order[:: max(1, order.size // 60)]]
    assert max(float(np.hypot(*(at - one[:, None])).min()) for one in places.T) < 0.03
    assert float(np.hypot(*at).min()) == pytest.approx(tooth.root_radius, abs=1e-6)


def test_the_outline_of_any_mesh_runs_from_space_to_space():
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    for file in sorted(MESHES.glob("four_square*.msh")):
        mesh = read_sector_mesh(file, tooth, 3.175e-3, 20.240625e-3)
        x, y = mesh.points[:, _outline(mesh)]
        np.testing.assert_allclose(
            [np.arctan2(x[0], y[0]), np.arctan2(x[-1], y[-1])], [-np.pi / 28, np.pi / 28], atol=1e-6
        )
        assert np.hypot(np.diff(x), np.diff(y)).max() < 0.4
        assert np.hypot(x, y).max() == pytest.approx(tooth.tip_radius, abs=1e-3)
        assert np.hypot(x, y).min() == pytest.approx(tooth.root_radius, abs=1e-3)


def test_deformed_teeth_need_finite_elements():
    pair = {**CASE["pair"]["I"], "compliance": {"source": "weber-banaschek"}}
    scene = build_scene({**CASE, "pair": {"I": pair}, "effects": {"neighbour_coupling": False}}, "case", None)
    with pytest.raises(InputError, match="gives flank deflections, not the deformed tooth"):
        make_plan(scene, STAGES, [DEFORMED])


def test_what_the_page_is_sent_is_small_and_keeps_the_largest_value(ran):
    stress, deformed = (on_the_gears(task, ran.outcomes[task].data) for task in (STRESS, DEFORMED))
    assert len(json.dumps(stress)) < 150e3
    assert len(json.dumps(deformed)) < 600e3
    data = ran.outcomes[STRESS].data
    assert stress["largest"]["value"] == pytest.approx(data.largest.value * 1e-6)
    assert stress["limit"] >= stress["largest"]["value"]
    assert stress["limit"] <= 2.0 * stress["largest"]["value"]
    assert stress["largest"]["at"] in stress["roll"]
    values = np.stack([_unpacked(one["stress"]) for one in stress["fillets"]])
    assert values.shape[1:3] == (len(stress["roll"]), len(stress["pairs"]))
    assert values.max() == pytest.approx(
        stress["largest"]["value"], rel=5e-3
    )  # points of a fillet between the solved ones
    moved = _unpacked(deformed["gears"]["driven"]["moved"])
    assert np.hypot(moved[:, :, 0], moved[:, :, 1]).max() == pytest.approx(
        ran.outcomes[DEFORMED].data.largest * 1e3, rel=0.02
    )
    drawn = deformed["factor"] * deformed["largest"] * 1e-3
    assert 0.04 * 3.0 < drawn <= 0.1 * 3.0
    assert np.all(np.diff(stress["roll"]) > 0.0)
    assert np.diff(deformed["roll"]).max() < 0.03


def _unpacked(sent):
    return np.frombuffer(base64.b64decode(sent["data"]), "<i2").reshape(sent["shape"]) * sent["step"]


def test_what_cannot_be_shown_is_said_and_stops_nothing():
    pair = {**CASE["pair"]["I"], "compliance": {"source": "weber-banaschek"}}
    scene = build_scene({**CASE, "pair": {"I": pair}, "effects": {"neighbour_coupling": False}}, "case", None)
    tasks, told = wanted_on_gears(scene, [("I", "stress"), ("I", "deformed"), ("I", "tool"), ("J", "stress")])
    assert tasks == [STRESS]
    refused, tool = told
    assert "gives flank deflections, not the deformed tooth" in refused["refused"]
    assert np.shape(tool["lines"]["driver"])[:2] == (31, 2)
    assert tool["tips"] == {
        member: pytest.approx(scene.pairs["I"].gear(member).tip_radius * 1e3) for member in ("driver", "driven")
    }


def wide(hand="", load="2500 N"):
    """The gears without relief as coupled slices: spur, or helical with a hand of the driver."""
    gear = {"teeth": 23, "face_width": "10 mm", "bore_radius": "15 mm", "profile_shift": 0.3}
    helix = {"normal_module": "3 mm", "helix_angle": "15 deg", "hand": hand} if hand else {"module": "3 mm"}
    gears = {"a": gear | helix, "b": gear | helix}
    if hand:
        gears["b"] |= {"hand": {"left": "right", "right": "left"}[hand]}
    pair = {"driver": "a", "driven": "b" if hand else "a", "load": load, "width": "slices"}
    return {**CASE, "gear": gears, "pair": {"I": pair}, "load_distribution": {"positions": 8, "panels": 5},
            "effects": {"neighbour_coupling": True, "hertz": "load-dependent"}}  # fmt: skip


@pytest.fixture(scope="module")
def over_the_face(cache):
    def run(**kind):
        scene = build_scene(wide(**kind), "case", None)
        return run_plan(scene, make_plan(scene, STAGES, [WIDE]), cache=cache)

    return run


@pytest.mark.dear
def test_colours_in_sections_of_helical_teeth_are_the_root_stress_through_the_mesh(over_the_face):
    ran = over_the_face(hand="right")
    found, largest = ran.outcomes[WIDE].data, ran.outcomes[WIDE].data.largest
    values = [ran.values[f"I.{member}.largest_root_tension"].si for member in MEMBERS]
    # values look at all positions of the base pitch, the picture at those of the table
    assert 0.98 * max(values) < largest.value <= values[MEMBERS.index(largest.member)]
    # It is in the picture where it is marked; the result lies on a curve through the points up the fillet.
    p, t = np.flatnonzero(found.roll == largest.roll)[0], list(found.pairs).index(largest.pair)
    one = found.gears[largest.member]
    along = one.stress["tension"][list(found.z).index(largest.z), p, t]
    assert np.nanmax(along) == pytest.approx(largest.value, rel=0.01)
    assert np.nanmax([np.nanmax(gear.stress["tension"]) for gear in found.gears.values()]) == pytest.approx(
        largest.value, rel=0.01
    )
    assert np.hypot(*(one.places["tension"][t, :, np.nanargmax(along)] - largest.place)) < 0.1 * 3e-3
    # In every section the tooth through the mesh is that of the table over the face, as far as the points go.
    over = ran.outcomes[Task("root-stress-history", "I")].data.found.over_face["driver"]["tension"]
    for section, z in enumerate(found.z.tolist()):
        for t, j in enumerate(found.pairs.tolist()):
            own = found.roll + j * found.pair.base_pitch
            on = np.abs(over.x[:, None] - own).min(axis=0) < 1e-12
            at = np.abs(over.x[:, None] - own[on]).argmin(axis=0)
            np.testing.assert_allclose(
                np.nanmax(found.gears["driver"].stress["tension"][section, on, t], axis=1),
                over.value[at, list(over.z).index(z)], rtol=0.02, atol=0.01 * largest.value,
            )  # fmt: skip
    # One base pitch on, every tooth stands where that of the pair ahead stood.
    stress = found.gears["driven"].stress["tension"]
    first, last = np.searchsorted(found.roll, found.roll[0] + found.pair.base_pitch + np.array([-1e-9, 1e-9]))
    for p in range(first, last):
        before = np.argmin(np.abs(found.roll + found.pair.base_pitch - found.roll[p]))
        np.testing.assert_allclose(stress[:, p, :-1], stress[:, before, 1:], rtol=1e-12)
    sent = on_the_gears(WIDE, found)
    assert sent["largest"]["value"] == pytest.approx(largest.value * 1e-6)
    assert sent["roll"][0] <= 0.0
    assert sent["roll"][-1] >= 1.0
    for one in sent["fillets"]:
        values = _unpacked(one["stress"])
        known = values > -32767.5 * one["stress"]["step"]  # below that none is meant
        assert np.abs(values[known]).max() <= sent["limit"] * (1.0 + 1e-4)
        assert 0.5 < known.mean() <= 1.0


@pytest.mark.dear
def test_a_helical_pair_of_the_other_hand_shows_the_same_from_the_other_end(over_the_face):
    right, left = (over_the_face(hand=hand).outcomes[WIDE].data for hand in ("right", "left"))
    np.testing.assert_allclose(right.z, -left.z[::-1], atol=1e-15)
    for member in MEMBERS:
        for side in ("tension", "compression"):
            one, other = (found.gears[member].stress[side] for found in (right, left))
            np.testing.assert_allclose(one, other[::-1], rtol=1e-5, atol=1e-6 * right.largest.value)
    assert right.largest.value == pytest.approx(left.largest.value, rel=1e-9)


@pytest.mark.long
def test_without_a_helix_sections_show_what_plane_teeth_do(over_the_face, cache):
    data = over_the_face().outcomes[WIDE].data
    case = wide()
    del case["pair"]["I"]["width"], case["load_distribution"]
    scene = build_scene(case, "case", None)
    plane = run_plan(scene, make_plan(scene, STAGES, [STRESS]), cache=cache).outcomes[STRESS].data
    # Slices are right to within 12 % of solids, whose ends strain otherwise than the plane; they give the plane here.
    assert data.largest.value == pytest.approx(plane.largest.value, rel=0.02)
    t = list(plane.pairs).index(0), list(data.pairs).index(0)
    for member in MEMBERS:
        for side, best in (("tension", np.nanmax), ("compression", np.nanmin)):
            flat = best(plane.gears[member].stress[side][:, t[0]], axis=1)
            for section in data.gears[member].stress[side][:, :, t[1]]:
                seen = best(section, axis=1)
                beside = np.interp(data.roll, plane.roll, flat)
                off = np.abs(seen - beside)[(data.roll > plane.roll[0]) & (data.roll < plane.roll[-1])]
                assert np.median(off) < 0.02 * plane.largest.value


@pytest.mark.dear
def test_hardly_any_load_shows_hardly_any_stress(over_the_face):
    loaded, light = (over_the_face(load=load).outcomes[WIDE].data for load in ("2500 N", "2.5e-3 N"))
    assert 0.0 < light.largest.value < 2e-6 * loaded.largest.value
    assert np.nanmax(np.abs(light.gears["driven"].stress["compression"])) < 2e-6 * loaded.largest.value


def test_the_page_knows_beforehand_what_of_a_pair_is_shown_in_vain():
    helical = json.loads(json.dumps(CASE))
    gear = {"teeth": 23, "module": "3 mm", "face_width": "10 mm"}
    helical["gear"] |= {"a": gear | {"helix_angle": "15 deg", "hand": "left", "normal_module": gear.pop("module")}}
    helical["gear"]["b"] = helical["gear"]["a"] | {"hand": "right"}
    helical["pair"]["I"] = {"driver": "a", "driven": "b"}
    del helical["effects"]
    for case, kinds in ((CASE, []), (helical, ["deformed"])):
        scene = build_scene(case, "case", None)
        told = gears_in_mesh(scene, "I")["refused"]
        assert sorted(told) == kinds
        # The same sentence answers whoever asks for it all the same.
        tasks, answers = wanted_on_gears(scene, [("I", "stress"), ("I", "deformed")])
        assert {one["kind"]: one["refused"] for one in answers if one["kind"] in told} == told
        # A pair without a load is refused for that.
        assert [task.stage for task in tasks] == (["stress-in-mesh", "deformed-in-mesh"] if case is CASE else [])
        assert all("load" in one["refused"] for one in answers if one["kind"] not in told)


@pytest.mark.parametrize("helix", [0.0, 25.0])
def test_the_tool_across_the_axis_is_half_a_transverse_pitch_thick_where_it_rolls_without_shift(helix):
    """Lengths along the rack over cos beta; its flanks lean by the transverse pressure angle, heights stay."""
    lean = math.cos(math.radians(helix))
    tooth = Tooth(30, BasicRack(1.0, 1.25, 0.3), 0.2, helix_angle=math.radians(helix))
    x, y = rack_tooth(tooth)
    half = x.size // 2
    for side in (np.s_[:half], np.s_[half:]):
        order = np.argsort(y[side])
        at = np.interp([0.2, 1.2], y[side][order], np.abs(x[side])[order])
        assert at[0] == pytest.approx(0.25 * math.pi / lean)
        assert at[1] - at[0] == pytest.approx(math.tan(tooth.rack.pressure_angle) / lean)
    assert (y.max(), y.min()) == (pytest.approx(1.2), pytest.approx(0.2 - 1.25))


RING = "teeth = 71\ninternal = true\ncutter = { teeth = 20, addendum = 1.25, tip_radius = 0.2 }"


@pytest.mark.parametrize(
    ("driver", "driven"),
    [("teeth = 20", "teeth = 53"), ("teeth = 20", RING), (RING, "teeth = 20"),
     ("teeth = 9\nprofile_shift = 0.5", "teeth = 30")],
)  # fmt: skip
def test_all_teeth_that_are_drawn_are_turned_from_the_one_that_is_sent(driver, driven, tmp_path):
    text = f"""results = ["geometry"]
[gear.a]
{driver}
module = "3 mm"
[gear.b]
{driven}
module = "3 mm"
[pair.I]
driver = "a"
driven = "b"
"""
    scene = build_scene(tomllib.loads(text), "case", tmp_path)
    mesh, whole = gears_in_mesh(scene, "I"), moving_pair(scene.pairs["I"])
    for member, sign in (("driver", -1.0), ("driven", 1.0)):
        count, turn = mesh["rows"][member]
        x, y = np.array(mesh[member])
        centre = sign * mesh[f"{member}_radius"]
        row = [
            (math.cos(k * turn) * x - math.sin(k * turn) * (y - centre),
             math.sin(k * turn) * x + math.cos(k * turn) * (y - centre) + centre)
            for k in range(-count, count + 1)
        ]  # fmt: skip
        assert np.hstack(row) == pytest.approx(getattr(whole, member), abs=2e-9)
    assert len(json.dumps(mesh)) < 30_000
