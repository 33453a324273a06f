"""Parts of the rows of `fegear verify` whose rows take seconds: what compares must notice what is off."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.wide.lines import contact_lines
from fegear.dynamics.planetary.phases import mesh_phases
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.verify import calculix, own
from fegear.verify.gearboxes import _Springs
from fegear.verify.kept import kept
from fegear.verify.polygons import SETS, apart, by_polygons, described, teeth, touching, wrapped
from fegear.verify.rolled import enumerated


def test_phases_of_an_uneven_set_are_those_of_its_polygons():
    one = SETS[4]
    found, seen = mesh_phases(described(one)), by_polygons(one)
    assert apart(seen[0, 0] - seen[0], found.sun) < 1e-10
    assert apart(seen[1, 0] - seen[1], found.ring) < 1e-5
    assert apart(seen[0] - seen[1], found.delays[1] - found.delays[0]) < 1e-5


def test_sets_of_polygons_can_be_assembled_and_have_room_at_their_tips():
    """Evenly spaced ones, and those at multiples of a turn over the teeth of sun and ring."""
    for one in SETS:
        places = np.array(one.angles) * (one.sun + one.ring) / 360.0
        assert np.abs(places - np.round(places)).max() < 1e-9 or one.sun in (25, 18)
        sun, planet = teeth(one)
        assert sun.teeth == one.sun
        assert planet.profile_shift == one.shift_planet
        a = described(one).centre_distance
        assert sun.tip_radius <= a - planet.root_radius - 0.25 + 1e-12
        assert planet.tip_radius <= a - sun.root_radius - 0.25 + 1e-12


def test_distances_of_phases_go_round():
    assert apart(np.array([0.95, 0.2]), np.array([0.05, 0.25])) == pytest.approx(0.1)
    np.testing.assert_allclose(wrapped(np.array([-0.6, 0.6, 0.4, -0.4]), 1.0), [0.4, -0.4, 0.4, -0.4])
    np.testing.assert_allclose(wrapped(np.array([3.0]), 4.0), [-1.0])


def test_gaps_close_where_they_pass_zero_and_not_where_they_jump():
    assert touching(lambda turn: wrapped(turn - 0.731, 2.0), 2.0) == pytest.approx(0.731, abs=1e-9)
    assert touching(lambda turn: -wrapped(turn - 1.61, 2.0), 2.0) == pytest.approx(1.61, abs=1e-9)


def test_random_internal_teeth_are_as_many_as_asked_and_always_the_same():
    first, again = (list(own.random_internal_teeth(4)) for _ in range(2))
    assert [one.teeth for one in first] == [one.teeth for one in again]
    assert len(first) == 4
    assert any(one.helix_angle for one in own.random_internal_teeth(12))


def test_springs_side_by_side_carry_the_load_where_they_touch():
    springs = _Springs(np.array([2.0, 3.0, 5.0, 1.0]))
    gap = np.array([[0.0, 0.4, 0.1, 9.0]])
    force, growth = springs.under(gap, 2.4)
    # 2 a + 3 (a - .4) + 5 (a - .1) = 2.4 gives a = .41: the second touches, the last does not.
    np.testing.assert_allclose(force, [[0.82, 0.03, 1.55, 0.0]], atol=1e-12)
    for k in range(4):
        more = gap.copy()
        more[0, k] += 1e-6
        np.testing.assert_allclose((springs.under(more, 2.4)[0] - force)[0] / 1e-6, growth[:, k], atol=1e-6)
    np.testing.assert_allclose(springs.under(gap, 1.0)[0], [[3.0 / 7.0, 0.0, 4.0 / 7.0 - 0.0, 0.0]], atol=0.2)


def test_two_meshes_are_extrapolated_to_third_order():
    """f + (f - c) / 7, for edges of half the size leave an eighth of the error."""
    known = kept("solid_calculix")["helical"]
    coarse, fine = (known[level]["deflection"]["middle"]["middle"] for level in ("coarse", "fine"))
    wanted = (8.0 * fine - coarse) / 7.0
    assert calculix._extrapolated("helical", "deflection", "middle", "middle") == pytest.approx(wanted, rel=1e-12)


def test_deflections_of_solid_gears_are_compared_place_by_place(monkeypatch):
    """A solution that gives what was kept holds; one that mixes up two places or loads does not."""

    def solved(off=1.0, turned=False):
        places = ("middle", "beside", "front", "back", "next")
        pressed = {name: (int(name == "next"), name) for name in places}

        def deflection(k, band, loaded):
            assert k == int(band == "next")
            name = {"front": "back", "back": "front"}.get(band, band) if turned else band
            found = kept("solid_calculix")["helical"]["fine"]["deflection"][loaded]
            if name not in found:
                return np.array([[0.0]])
            return np.array([[off * float(calculix._extrapolated("helical", "deflection", loaded, name))]])

        def stress(k, side, loaded, stations):
            assert k == 0
            assert stations is calculix._STATIONS
            return (off * calculix._extrapolated("helical", side, loaded)[:, None], None)

        return SimpleNamespace(deflection=deflection, largest_root_stress=stress), pressed

    def holds(rows):
        return [all(one.holds for one in row("helical")) for row in rows]

    rows = calculix._solid_deflections, calculix._solid_stresses
    monkeypatch.setattr(calculix, "_solid", lambda _: solved())
    assert holds(rows) == [True, True]
    count = [len(list(row("helical"))) for row in rows]
    assert count[1] == 4 * calculix._STATIONS.size
    assert count[0] >= 8
    monkeypatch.setattr(calculix, "_solid", lambda _: solved(1.017))
    assert holds(rows) == [True, True]
    monkeypatch.setattr(calculix, "_solid", lambda _: solved(1.02))
    assert holds(rows) == [False, False]
    monkeypatch.setattr(calculix, "_solid", lambda _: solved(1.0, turned=True))
    assert holds(rows) == [False, True]


def test_deflections_and_tensions_on_a_web_are_compared_load_by_load():
    known = {"deflection": [[4.0, 1.0], [0.5, 2.0]], "tension": [[10.0, 3.0], [2.0, 20.0]]}

    def solution(off=0.0):
        return SimpleNamespace(
            deflection=lambda k, band, load: np.array([[known["deflection"][load][band] + off]]) + 1e9 * k,
            largest_root_stress=lambda k, side, load, _: (
                (np.array(known["tension"][load])[:, None] + 10 * off + 1e9 * k,) if side == "tension" else None
            ),
        )

    def largest(row):
        return [(one.found, one.wanted, one.scale, one.holds) for one in row]

    bands = [0, 1]
    assert largest(calculix._web_deflections(solution(), bands, known, 0.01)) == [
        (4.0, 4.0, 4.0, True), (1.0, 1.0, 4.0, True), (0.5, 0.5, 2.0, True), (2.0, 2.0, 2.0, True),
    ]  # fmt: skip
    assert [one[3] for one in largest(calculix._web_deflections(solution(0.03), bands, known, 0.01))] == [
        True,
        True,
        False,
        False,
    ]
    assert largest(calculix._web_tensions(solution(), bands, known)) == [
        (10.0, 10.0, 10.0, True), (3.0, 3.0, 10.0, True), (2.0, 2.0, 20.0, True), (20.0, 20.0, 20.0, True),
    ]  # fmt: skip
    assert [one[3] for one in largest(calculix._web_tensions(solution(0.015), bands, known))] == [
        False,
        False,
        True,
        True,
    ]


def test_the_gap_of_a_turned_driver_is_as_wide_as_said_from_end_to_end():
    tooth = Tooth(18, BasicRack(1.0, 1.25, 0.25), 0.0, helix_angle=math.radians(12.0))
    size = 1e-3, 0.5 * tooth.root_radius * 1e-3, 3e-3, Material(206.8e9, 0.3)
    pair = GearPair(*(Gear(tooth, *size, hand=hand) for hand in ("right", "left")))
    lines = contact_lines(pair, [pair.x_start + 0.25 * pair.base_pitch], 0.1e-3)
    gap = calculix._tilt_gap(pair, lines, 7e-6)
    there = lines.present
    slope, _ = np.polyfit(lines.z[there], gap[there], 1)
    # Along a contact line the teeth meet at other places of the path, too: 1 / cos(beta_b)^2.
    base = math.asin(math.sin(math.radians(12.0)) * math.cos(math.radians(20.0)))
    assert slope * pair.face_width == pytest.approx(7e-6 / math.cos(base) ** 2, rel=1e-6)
    assert (gap[~there] == 0.0).all()
    np.testing.assert_allclose(calculix._tilt_gap(pair, lines, -14e-6), -2.0 * gap, atol=1e-18)


def test_the_load_is_found_that_makes_gears_approach_as_far_as_said():
    """A law that stiffens: approach = 0.3 W^0.9, the load fed back by the slope there."""

    def solve(grid, loads):
        assert grid == "grid of 0.25"
        (w,) = loads
        approach, stiffness = 0.3 * w**0.9, w**0.1 / (0.27)
        return SimpleNamespace(
            load=w, transmission_error=np.array([[approach]]), local_stiffness=np.array([[stiffness]])
        )

    engagement = SimpleNamespace(grid=lambda x: f"grid of {x[0]}", solve=solve)
    found = calculix.under_approach(engagement, 0.25, 3.0, 1.7)
    assert found.transmission_error[0, 0] == pytest.approx(1.7, rel=1e-9)


def test_flanks_are_compared_by_load_approach_and_share(monkeypatch):
    step = {
        "tilt_um": 2.0, "approach_um": 5.0, "load_by_bore": {"driver": 905.0, "driven": 907.0},
        "quarters": {"0": [100.0, 200.0], "1": [250.0, 356.0]},
        "root_stress": {"driver tension 0": [50.0, 61.0], "driver tension 1": [70.0],
            "driver, compression side": [99.0],
                        "driven tension 0": [80.0]},
    }  # fmt: skip
    everything = {"two whole lines": {level: {"steps": [step]} for level in ("coarse", "fillets")}}
    monkeypatch.setattr(calculix, "kept", lambda name: everything if name == "pair_calculix" else None)
    lines = SimpleNamespace(at=lambda k: [slice(0, 2), slice(2, 4)] if k == 0 else [], pair=np.array([[0, 0, 1, 1]]))
    force = np.array([[[110.0], [187.9], [301.0], [301.1]]])
    contact = SimpleNamespace(stiffness=np.array([[3e8]]), approach=np.array([[5e-6 - 6.0 / 3e8]]), force=force)
    asked = []
    monkeypatch.setattr(calculix, "_pressed", lambda *given: (asked.append(given), (lines, contact))[1])
    rows = list(calculix.calculix_flanks())
    assert asked == [("two whole lines", 2.0)] * 2
    for one in rows:
        assert one.found == pytest.approx(one.wanted, rel=1e-12)  # the approach less what six newtons more are
        assert one.allowed == 0.01
    rows = list(calculix.calculix_flank_shares())
    assert [round(one.found, 6) for one in rows] == [round(297.9 / 900, 6), round(602.1 / 900, 6)] * 2
    assert [one.wanted for one in rows] == pytest.approx([300 / 906, 606 / 906] * 2)
    assert {one.scale for one in rows} == {1.0}
    monkeypatch.setattr(calculix, "_flanks", lambda: (None, {"driver": 1, "driven": 2}))
    values = {"driver": np.array([60e6, 69.5e6]), "driven": np.array([79e6, 10e6])}
    seen = []

    def rooted(pair, member, lines_, gear, coupling):
        assert (pair, lines_, coupling) == (None, lines, True)
        assert gear == {"driver": 1, "driven": 2}[member]

        def stress(side, forces, stations):
            assert side == "tension"
            assert forces.tolist() == force[:, :, 0].tolist()
            seen.append(stations)
            return SimpleNamespace(value=values[member])

        return SimpleNamespace(stress=stress)

    monkeypatch.setattr("fegear.contact.wide.root_stress.rooted_lines", rooted)
    rows = list(calculix.calculix_flank_root_stress())
    assert [one.found for one in rows] == pytest.approx([69.5, 79.0])
    assert [one.wanted for one in rows] == pytest.approx([70.0 * 900 / 906, 80.0 * 900 / 906])
    np.testing.assert_allclose(seen[0], np.linspace(-1.4e-3, 1.4e-3, 15))


def test_states_of_contact_are_tried_until_forces_and_gaps_agree():
    """Springs behind gaps on a body that a linear spring holds: they push where they are pressed, and balance."""
    rng = np.random.default_rng(11)
    touching_ones = set()
    for _ in range(40):
        rows, k, gap = rng.normal(size=(4, 3)), rng.uniform(1.0, 3.0, 4), rng.uniform(-0.5, 1.0, 4)
        linear, load = np.diag(rng.uniform(0.5, 2.0, 3)), rng.normal(size=3)
        force = enumerated(linear, rows, k, gap, load)
        z = np.linalg.solve(linear, load - rows.T @ force)
        np.testing.assert_allclose(force, k * np.maximum(rows @ z - gap, 0.0), atol=1e-9)
        np.testing.assert_allclose(enumerated(linear, rows, k, 1e9 * gap, 1e9 * load), 1e9 * force, rtol=1e-6, atol=1.0)
        touching_ones.add(int((force > 0.0).sum()))
    assert {0, 1, 2} <= touching_ones
    assert enumerated(np.zeros((1, 1)), np.array([[1.0]]), np.ones(1), np.zeros(1), np.array([-1.0])) is None


def test_bodies_in_space_know_no_unit_of_force():
    """Springs that push, one of them apart: forces grow with the load, from tiny to huge ones."""
    from fegear.verify.bodies import contact_in_space

    rng = np.random.default_rng(3)
    rows, k, linear = rng.normal(size=(4, 3)), rng.uniform(1.0, 3.0, 4), np.diag([0.5, 1.0, 2.0])
    load = np.array([1.0, -2.0, 0.5])
    forces = contact_in_space(rows, linear, load, k)
    q = np.linalg.solve(linear, load - rows.T @ forces)
    np.testing.assert_allclose(forces, np.where(forces > 0.0, k * (rows @ q), 0.0), atol=1e-12)
    assert 0 < (forces > 0.0).sum() < 4
    for size in (1e-12, 1e12):
        np.testing.assert_allclose(contact_in_space(rows, linear, size * load, k), size * forces, rtol=1e-9)
    assert contact_in_space(np.array([[1.0], [1.0]]), np.zeros((1, 1)), np.array([-1.0]), np.ones(2)) is None


def test_a_mesh_is_handed_on_with_the_lag_that_its_load_takes(monkeypatch, tmp_path):
    """In place of the exported unit: the force that makes the teeth approach as far as the angles say, by bisection."""
    import shutil
    import sys

    import fegear
    from fegear.engine.stage import Task
    from fegear.verify import handed_on

    results = fegear.run({**handed_on._CASE, "results": ["natural-modes"]}, progress=False)
    mesh = results.outcomes[Task("gear-train", "")].data.meshes[0]
    r1, r2 = (0.5 * 3e-3 * z * math.cos(math.radians(20.0)) for z in (23, 41))
    given = {}

    def simulate(path, fmi_type, stop_time, output_interval, input, start_values, output):  # noqa: A002
        given.update(path=path, kind=fmi_type, stop=stop_time, step=output_interval, start=start_values, output=output)
        assert (input["driver_speed"] == 0.0).all()
        assert (input["driven_speed"] == 0.0).all()
        assert (input["load"] == 500.0).all()
        deflection = r1 * input["driver_angle"] - r2 * input["driven_angle"]
        force = []
        for far, turned in zip(deflection, input["driver_angle"], strict=True):
            low, high = 0.0, 2000.0
            for _ in range(60):
                middle = 0.5 * (low + high)
                less = float(np.ravel(mesh.excitation.approach(middle, 23.0 * turned / (2.0 * math.pi)))[0]) < far
                low, high = (middle, high) if less else (low, middle)
            force.append(low)
        # The program gives more times than were asked for, the first twice.
        times = np.concatenate([[0.0], input["time"]])
        return {"time": times, "mesh_force": np.array([force[0], *force])}

    monkeypatch.setitem(sys.modules, "fmpy", SimpleNamespace(simulate_fmu=simulate))
    monkeypatch.setattr(shutil, "which", lambda name: f"/bin/{name}")
    monkeypatch.setattr(type(results), "export", lambda self, folder, kind: (folder / f"one.{kind}",))
    found = list(handed_on.fmu())
    assert len(found) == 41
    assert all(one.holds for one in found)
    assert max(one.deviation for one in found) < 1e-9
    assert {one.wanted for one in found} != {500.0}  # computed, not handed through
    assert (given["path"].endswith("one.fmu"), given["kind"], given["stop"]) == (True, "ModelExchange", 1.0)
    assert (given["step"], given["start"], given["output"]) == (0.025, {"damping": 0.0}, ["mesh_force"])
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(Exception, match="exporting an FMU requires a C compiler"):
        list(handed_on.fmu())


# ---- what is solved for rows that take long --------------------------------------------------------------------------
@pytest.fixture
def solved(monkeypatch):
    """Gears that would be solved: with what they are asked for, in place of a solution."""
    for one in (calculix._solid, calculix._on_a_web, calculix._flanks, calculix._pressed):
        one.cache_clear()
        monkeypatch.setattr(calculix, one.__name__, one.__wrapped__)
    asked = []
    monkeypatch.setattr(
        "fegear.fem.solid.solution.solve_solid", lambda *given, **more: (asked.append((given, more)), len(asked))[1]
    )
    return asked


def places(band):
    """What a pressed band says of itself in single numbers: where it is and how wide."""
    values = {name: np.asarray(getattr(band, name)) for name in band.__dataclass_fields__}
    return {
        name: float(one.ravel()[0])
        for name, one in values.items()
        if one.size == 1 and np.issubdtype(one.dtype, np.number)
    }


def test_the_solid_gear_is_the_one_that_calculix_had(solved):
    from fegear.fem.solid.bands import bands
    from fegear.fem.solid.settings import SolidSettings

    solution, pressed = calculix._solid("helical")
    ((given, more),) = solved
    tooth, twist, width, poisson, bore, settings = given
    assert solution == 1
    assert (tooth.teeth, tooth.profile_shift, tooth.rack) == (10, 0.55, BasicRack(1.0, 1.25, 0.25))
    assert twist == pytest.approx(math.tan(math.radians(20.0)) / tooth.pitch_radius)
    assert (width, poisson, bore, more) == (4.0, 0.3, 2.5, {"reach": 1})
    assert settings == replace(SolidSettings().scaled(1.2), waves_per_module=3.0)
    expected = {
        "middle": (0, bands(5.5, 0.0, 0.5, 0.25, after=0.5)), "beside": (0, bands(5.5, 1.0, 0.5, 0.25, after=0.5)),
        "front": (0, bands(5.5, 2.0, 0.5, 0.25, after=0.0)), "back": (0, bands(5.5, -2.0, 0.0, 0.25, after=0.5)),
        "next": (1, bands(5.5, 0.0, 0.5, 0.25, after=0.5)),
    }  # fmt: skip
    assert {name: (k, places(band)) for name, (k, band) in pressed.items()} == {
        name: (k, places(band)) for name, (k, band) in expected.items()
    }
    assert places(expected["front"][1]) != places(expected["middle"][1])


@pytest.mark.parametrize(
    ("which", "web", "lean", "holed"),
    [("off", (-1.5, -0.5), 0.0, False), ("inclined", (-1.5, -0.5), 20.0, False), ("holes", (-0.5, 0.5), 0.0, True)],
)
def test_gears_on_a_web_are_the_ones_that_calculix_had(solved, which, web, lean, holed):
    from fegear.fem.solid.bands import bands
    from fegear.fem.solid.settings import SolidSettings

    _, pressed = calculix._on_a_web(which)
    ((given, more),) = solved
    tooth, *size, settings = given
    assert (tooth.teeth, tooth.profile_shift, tooth.rack) == (16, 0.2, BasicRack(1.0, 1.25, 0.25))
    assert size == [0.0, 4.0, 0.3, 2.0]
    assert settings == replace(SolidSettings().scaled(1.2 if which == "off" else 1.6), waves_per_module=2.5)
    body = more.pop("body")
    assert more == {}
    assert (body.rim_radius, body.hub_radius, body.web, body.hub) == (5.7, 3.0, web, (-2.0, 2.0))
    assert body.lean == pytest.approx(math.tan(math.radians(lean)))
    assert (body.holes is not None) is holed
    if holed:
        assert (body.holes.count, body.holes.circle_radius, body.holes.radius) == (6, 4.35, 0.9)
    tops = [(-2.0, 0.0, 0.5), (-1.0, 0.5, 0.5), (0.0, 0.5, 0.5), (1.0, 0.5, 0.5), (2.0, 0.5, 0.0)]
    assert [places(one) for one in pressed] == [
        places(bands(8.2, top, before, 0.25, after=after)) for top, before, after in tops
    ]


def test_a_tooth_above_a_hole_and_one_between_two_are_of_one_solution(solved, monkeypatch):
    monkeypatch.setattr("fegear.fem.solid.tooth_over_holes.tooth_over_holes", lambda solution, tooth: (solution, tooth))
    found = [(solution, known) for solution, _, known in calculix._over_holes()]
    theirs = kept("web_holes_calculix")
    assert found == [((1, 0), theirs["below"]), ((1, 4), theirs["between"])]
    assert len(solved) == 1


def test_modes_of_a_gear_on_a_web_are_of_coarse_elements_without_nodal_diameters(monkeypatch):
    from fegear.fem.solid.settings import SolidSettings

    asked = []
    wanted = kept("gear_body_calculix")["middle"]["frequencies"][0]

    def body_modes(*given, **more):
        asked.append((given, more))
        return SimpleNamespace(modes=[SimpleNamespace(frequency=one) for one in wanted])

    monkeypatch.setattr("fegear.fem.solid.body_modes.body_modes", body_modes)
    rows = list(calculix.calculix_web_frequencies())
    assert [one.found for one in rows] == wanted
    assert {one.allowed for one in rows} == {0.005}
    (((tooth, *size, settings, body), more),) = asked
    assert (tooth.teeth, body.web, body.lean, body.holes) == (16, (-0.5, 0.5), 0.0, None)
    assert size == [0.0, 4.0, 0.3, 2.0]
    usual = SolidSettings()
    assert settings == replace(usual, section=replace(usual.section.scaled(4.0), order=2))
    assert more == {"diameters": 0, "each": 2, "fineness": 0.6}


def test_flanks_are_loaded_as_calculix_had_them(solved, monkeypatch):
    from fegear.fem.solid.settings import solid_settings

    pair, gears = calculix._flanks()
    assert gears == {"driver": 1, "driven": 2}
    assert [gear.hand for gear in (pair.driver, pair.driven)] == ["right", "left"]
    for (tooth, *size, settings), more in solved:
        assert (tooth.teeth, tooth.profile_shift, tooth.rack) == (18, 0.0, BasicRack(1.0, 1.25, 0.25))
        assert math.degrees(tooth.helix_angle) == pytest.approx(12.0)
        twist = math.tan(math.radians(12.0)) / (9.0 / math.cos(math.radians(12.0)))
        assert size[1:] == pytest.approx([3.0, 0.3, 0.5 * tooth.root_radius])
        assert abs(size[0]) == pytest.approx(twist)
        assert (settings, more) == (solid_settings(1e-2), {"reach": 1})
    assert {gear.material.young_modulus for gear in (pair.driver, pair.driven)} == {206.8e9}

    seen = {}
    monkeypatch.setattr(calculix, "_flanks", lambda: (pair, gears))
    monkeypatch.setattr(
        "fegear.contact.wide.lines.contact_lines",
        lambda of, roll, panel, most_gap: seen.update(roll=roll, panel=panel, most=most_gap) or "lines",
    )
    monkeypatch.setattr("fegear.contact.wide.tip_edges.usual_gap", lambda of, load: ("gap", load))
    monkeypatch.setattr("fegear.contact.wide.compliance.flank_compliance", lambda *given: ("compliance", *given[1:]))
    monkeypatch.setattr("fegear.contact.wide.load_sharing.solve_contact", lambda *given: given)
    monkeypatch.setattr(calculix, "_tilt_gap", lambda of, lines, over_face: (lines, over_face))
    for position, share in (("two whole lines", 0.25), ("a line that ends at the tip", 0.02)):
        lines, (compliance, gap, load) = calculix._pressed(position, 7.0)
        assert seen["roll"] == pytest.approx([pair.x_start + share * pair.base_pitch])
        assert (seen["panel"], seen["most"]) == (0.25e-3, ("gap", 900.0))
        assert (lines, gap, load.tolist()) == ("lines", ("lines", pytest.approx(7e-6)), [900.0])
        assert compliance == ("compliance", gears, "lines", 900.0)


def test_whole_gears_are_checked_at_a_tolerance_and_positions_of_their_own(monkeypatch):
    from fegear.verify import programs

    asked = []

    def check_gear(scene, name, positions):
        asked.append((scene, name, positions))
        rows = (("c_self", 0.1, 0.2), ("c_next", 0.3, 0.4), ("c_prev", 0.5, 0.6), ("root_tension", 0.7, 0.8),
                ("root_compression", 0.9, 1.0))  # fmt: skip
        return SimpleNamespace(compared=[
            SimpleNamespace(quantity=one, difference=off, stated_error=stated) for one, off, stated in rows
        ])  # fmt: skip

    monkeypatch.setattr("fegear.studies.check.check_gear", check_gear)
    monkeypatch.setattr(programs, "_whole", programs._whole.__wrapped__)
    for row, wanted in (
        (programs.whole_gear_compliance, [(0.1, 0.2), (0.3, 0.4), (0.5, 0.6)]),
        (programs.whole_gear_root_stress, [(0.7, 0.8), (0.9, 1.0)]),
    ):
        found = list(row())
        assert [(one.deviation, one.allowed) for one in found] == wanted
        assert [one.stated for one in found] == [one.allowed for one in found]
    scene, name, positions = asked[0]
    gear = scene.gears["pinion"]
    assert (name, positions, scene.case.accuracy.tolerance) == ("pinion", 3, 1e-2)
    assert (gear.teeth, gear.module, gear.bore_radius) == (17, 3e-3, 14e-3)
    assert gear.tooth.profile_shift == 0.35
    asked.clear()
    assert len(list(programs.ring_supports())) == 10
    assert [(name, positions, scene.case.accuracy.tolerance) for scene, name, positions in asked] == [
        ("ring", 1, 5e-2)
    ] * 2
    pins, splined = (scene.gears["ring"].support for scene, _, _ in asked)
    assert (pins.pins, pins.width, math.degrees(pins.angle)) == (4, 6e-3, pytest.approx(17.0))
    assert splined.pins == 0
    for scene, _, _ in asked:
        ring = scene.gears["ring"]
        assert (ring.teeth, ring.module, ring.tip_radius) == (30, 2e-3, pytest.approx(28.7e-3))
        assert ring.bore_radius - ring.root_radius == pytest.approx(5e-3)
        assert ring.tooth.cutter.teeth == 15
