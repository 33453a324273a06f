"""Parts of the rows of `fegear verify` whose rows take seconds: what compares must notice what is off."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.wide.lines import contact_lines
from fegear.dynamics.planetary.phases import mesh_phases
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tooth import Tooth
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
        "root_stress": {"driver tension 0": [50.0, 61.0], "driver tension 1": [70.0], "driver compression": [99.0],
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
        touching_ones.add(int((force > 0.0).sum()))
    assert {0, 1, 2} <= touching_ones
    assert enumerated(np.zeros((1, 1)), np.array([[1.0]]), np.ones(1), np.zeros(1), np.array([-1.0])) is None
