"""Planetary sets described as data: Willis in fractions, today's simple set, flanks unwound, bodies on springs."""

import dataclasses
import math
from dataclasses import replace
from fractions import Fraction
from itertools import permutations
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import eigh

from fegear.base.errors import GeometryError, InputError
from fegear.dynamics.compound.assembly import Cluster, check_assembly, check_neighbours, clearances, clusters
from fegear.dynamics.compound.compound_modes import CompoundModel, compound_modes, loaded_flanks
from fegear.dynamics.compound.compound_set import CompoundSet, End, Mesh, Shaft
from fegear.dynamics.compound.mesh_phases import mesh_phases, phasing
from fegear.dynamics.compound.speeds_and_torques import Drive, Trains
from fegear.dynamics.compound.tooth_search import Wanted, search
from fegear.dynamics.planetary import phases as simple_phases
from fegear.dynamics.planetary.kinematics import running
from fegear.dynamics.planetary.planet_set import CENTRALS, PlanetarySet
from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
from fegear.dynamics.planetary.set_modes import set_modes
from fegear.results.planetary import compound_set
from tests.helpers import compound_sets


def as_simple(of):
    """Today's planetary set of the same gears."""
    (group,) = of.planets
    sun, ring = of.members["sun"].wheels[0], of.members["ring"].wheels[0]
    planet = group.wheels[0]
    return PlanetarySet(
        sun.teeth, planet.teeth, ring.teeth, 2.0 * math.pi * compound_sets.PER_TOOTH, group.radius,
        np.array(group.angles), planet.base_half_angle, planet.tip_radius,
    )  # fmt: skip


# ------------------------------------------------------------------------------------------------- speeds and torques


@pytest.mark.parametrize("teeth", [(26, 34, 20, 21, 74), (23, 31, 21, 19, 73), (30, 36, 24, 25, 84)])
def test_a_ravigneaux_set_by_willis_for_every_fixed_driving_and_loaded_shaft(teeth):
    """Seen from the carrier each shaft turns k times the ring: speeds go as k - k_fixed, torques follow by power."""
    small, large, _, _, ring = teeth
    k = {"small": Fraction(ring, small), "large": -Fraction(ring, large), "ring": Fraction(1), "carrier": Fraction(0)}
    trains = Trains(compound_sets.ravigneaux(*teeth))
    assert trains.free == 2
    every = {(*fixed, a, b): found for fixed, a, b, found in trains.every(100)}
    assert set(every) == set(permutations(k, 3))
    for (fixed, driving, loaded), found in every.items():
        ratio = (k[driving] - k[fixed]) / (k[loaded] - k[fixed])
        assert found.ratio == ratio
        assert {name: found.speed[name] for name in k} == {
            name: (k[name] - k[fixed]) / (k[driving] - k[fixed]) for name in k
        }
        (idle,) = set(k) - {fixed, driving, loaded}
        assert found.torque == {driving: 1, loaded: -ratio, fixed: ratio - 1, idle: 0}
        assert found.efficiency == 1
        assert not any(found.loss)


@pytest.mark.parametrize(("fixed", "driving"), list(permutations(CENTRALS, 2)))
@pytest.mark.parametrize("efficiency", [(1.0, 1.0), (0.99, 0.985)])
def test_todays_simple_set_has_these_speeds_torques_and_losses(fixed, driving, efficiency):
    of = compound_sets.simple(efficiency=efficiency)
    today = running(as_simple(of), fixed, driving, 1.0, 1.0, efficiency[0] * efficiency[1])
    (loaded,) = set(CENTRALS) - {fixed, driving}
    found = Trains(of).drive((fixed,), driving, loaded)
    for name in CENTRALS:
        assert float(found.speed[name]) == pytest.approx(today.speed[name], rel=1e-14)
        assert float(found.torque[name]) == pytest.approx(today.torque[name], rel=1e-13)
    assert float(found.speed["planet"]) == pytest.approx(today.planet_speed, rel=1e-14)
    assert float(found.efficiency) == pytest.approx(today.efficiency, rel=1e-13)
    assert float(sum(found.loss)) == pytest.approx(1.0 - today.efficiency, abs=1e-14)


def test_simpson_has_the_ratios_of_its_gears():
    """Gears by hand, for equal sets of 30 and 66 teeth."""
    trains = Trains(compound_sets.simpson())
    assert trains.free == 2
    i = Fraction(66, 30)
    assert trains.drive(("carrier",), "ring", "output").ratio == 2 + 1 / i  # first
    assert trains.drive(("sun",), "ring", "output").ratio == 1 + 1 / i  # second
    assert trains.drive(("carrier",), "sun", "output").ratio == -i  # reverse


def test_a_wolfrom_set_may_be_self_locking():
    """With much friction only the sun can drive; without it either way goes."""
    of = compound_sets.stepped(18, 36, 33, 87, second_ring=90)
    slow = Trains(of).drive(("other",), "sun", "ring")
    assert isinstance(slow, Drive)
    worse = CompoundSet(of.shafts, of.planets, tuple(
        Mesh(one.first, one.second, 0.93) for one in of.meshes
    ))  # fmt: skip
    assert isinstance(Trains(worse).drive(("other",), "sun", "ring"), Drive)
    back = Trains(worse).drive(("other",), "ring", "sun")
    assert isinstance(back, str)
    assert "self-locking" in back
    assert isinstance(Trains(of).drive(("other",), "ring", "sun"), Drive)


@pytest.mark.parametrize("seed", range(12))
def test_power_and_torque_balance_with_losses(seed):
    rng = np.random.default_rng(seed)
    made = (compound_sets.ravigneaux, compound_sets.simpson, compound_sets.stepped, compound_sets.simple)[seed % 4]
    of = made(rng=rng)
    of = CompoundSet(of.shafts, of.planets, tuple(
        Mesh(one.first, one.second, round(rng.uniform(0.97, 1.0), 4)) for one in of.meshes
    ))  # fmt: skip
    ran = 0
    for _, _, _, found in Trains(of).every(100):
        if isinstance(found, str):
            continue
        ran += 1
        assert sum(found.torque.values()) == 0
        assert sum(found.torque[name] * found.speed[name] for name in of.shaft_names) == sum(found.loss)
        assert all(one >= 0 for one in found.loss)
        assert found.efficiency == 1 - sum(found.loss)
    assert ran >= 5


def test_clusters_are_in_the_order_of_their_first_planets():
    planets = {name: SimpleNamespace(name=name) for name in "abc"}
    of = SimpleNamespace(
        planets=planets.values(), names=["sun", *planets],
        toothed=[SimpleNamespace(planets=planets["a"], other=planets["c"])],
    )  # fmt: skip
    assert ["".join(one.name for one in cluster.planets) for cluster in clusters(of)] == ["ac", "b"]


def test_what_cannot_run_is_said():
    trains = Trains(compound_sets.ravigneaux())
    assert trains.drive(("ring",), "ring", "carrier").startswith("fixed, driving and loaded shafts must differ")
    # held still itself, the driving shaft lets all others turn
    assert trains.drive((), "small", "ring") == (
        f"speeds of {', '.join(one for one in trains.of.names if one != 'small')} are not determined: fix another shaft"
    )
    assert trains.drive(("ring", "large"), "small", "carrier") == (
        "small cannot rotate with ring and large fixed (the set is locked)"
    )
    of = compound_sets.simple()
    loose = Trains(CompoundSet((*of.shafts, Shaft("free")), of.planets, of.meshes))
    assert loose.free == 3
    assert loose.drive(("ring", "carrier"), "free", "sun") == (
        "sun does not rotate when free drives with ring and carrier fixed"
    )
    with pytest.raises(InputError, match="is given twice"):
        CompoundSet(of.shafts, of.planets, (*of.meshes, of.meshes[0]))


# ---------------------------------------------------------------------------------------------- assembly and phases


def unwound(gear, angle, flank, centre, pitch_point, normal):
    """Places of a gear's contacts on a line of action from the pitch point, modulo a base pitch: a string unwound.

    The involute of the flank on the counter-clockwise (1) or clockwise side of the tooth at `angle` begins on the base
    circle; the string is tangent to it where the line of action is.
    """
    radius = gear.base_radius
    foot = centre + ((pitch_point - centre) @ np.array([-normal[1], normal[0]])) * np.array([-normal[1], normal[0]])
    tangent = math.atan2(*(foot - centre)[::-1])
    start = angle + flank * gear.base_half_angle
    unwinds = -flank if not gear.internal else flank  # sense in which the tangent point leaves the start
    roll = unwinds * (tangent - start)
    along = -unwinds * np.array([-math.sin(tangent), math.cos(tangent)])
    place = foot + radius * roll * along
    return float((place - pitch_point) @ normal)


@pytest.mark.parametrize("of", [
    compound_sets.simple(), compound_sets.simple(20, 16, 52, 3), compound_sets.ravigneaux(),
    compound_sets.ravigneaux(30, 36, 24, 25, 84), compound_sets.stepped(), compound_sets.simpson(planets=(3, 4)),
    compound_sets.stepped(21, 30, 24, 84),
])  # fmt: skip
@pytest.mark.parametrize("direction", [1, -1])
def test_phases_are_those_of_strings_unwound_from_base_circles(of, direction):
    check_assembly(of)
    shafts = of.shaft_names
    fixed, driving, loaded, drive = next(
        one for one in Trains(of).every(100) if not isinstance(one[3], str) and all(one[3].tooth)
        and all(one[3].rolling)
    )  # fmt: skip
    assert {driving, loaded, *fixed} <= set(shafts)
    pitch = 2.0 * math.pi
    angle = {(name, wheel.name): 0.0 for name in shafts for wheel in of.members[name].wheels}
    phases = {one.mesh: one for one in mesh_phases(of, drive, direction)}
    assert set(phases) == {one.name for one in of.meshes}
    found = {}
    placed = set()
    for cluster in clusters(of):
        waiting = list(enumerate(cluster.meshes))
        first_angle = {}
        while waiting:
            # whichever has a member that stands already: that of the other follows, so that both touch at one place
            number, toothed = next(
                (one for one in waiting if one[1].planets.name in first_angle or one[1].other.name in first_angle
                 or one[1].other.name in placed), waiting[0],
            )  # fmt: skip
            waiting.remove((number, toothed))
            for n, psi in enumerate(cluster.turns):
                turned = cluster.turned(psi)
                ends = []
                tooth = drive.tooth[of.toothed.index(toothed)]
                toward = of.direction(toothed, n)
                e = np.array([math.cos(toward), math.sin(toward)])
                side = loaded_flanks([tooth], direction)[0]
                alpha = of.working_angle(toothed)
                normal = side * math.cos(alpha) * np.array([-e[1], e[0]]) + math.sin(alpha) * e
                centre = toothed.planets.radius * np.array(
                    [math.cos(toothed.planets.angles[n]), math.sin(toothed.planets.angles[n])]
                )
                point = centre + toothed.wheel.base_radius / math.cos(alpha) * e
                for member, gear in ((toothed.planets, toothed.wheel), (toothed.other, toothed.other_wheel)):
                    torque = direction * float(tooth) * gear.signed
                    flank = -1 if torque > 0 else 1
                    planet = member.name not in shafts
                    own = np.zeros(2)
                    if planet:
                        own = member.radius * np.array([math.cos(member.angles[n]), math.sin(member.angles[n])])
                    first = first_angle.setdefault(member.name, 0.0) if planet else angle[member.name, gear.name]
                    at = first + psi + pitch * turned[member.name] if planet else first
                    ends.append((member, gear, at, flank, own, planet))
                if n == 0:
                    moves = int(toothed.planets.name in placed)
                    other = ends[1 - moves]
                    want = unwound(*(other[1], other[2], other[3], other[4]), point, normal)
                    member, gear, at, flank, own, planet = ends[moves]
                    have = unwound(gear, at, flank, own, point, normal)
                    slope = (unwound(gear, at + 1e-3, flank, own, point, normal) - have) / 1e-3
                    shift = (want - have) / slope
                    if planet:
                        first_angle[member.name] += shift
                    else:
                        angle[member.name, gear.name] += shift
                    placed |= {toothed.planets.name, toothed.other.name}
                    ends[moves] = (member, gear, at + shift, flank, own, planet)
                base_pitch = pitch * toothed.wheel.base_radius / toothed.wheel.teeth
                places = [unwound(g, a, f, o, point, normal) / base_pitch for _, g, a, f, o, _ in ends]
                assert abs((places[0] - places[1] + 0.5) % 1.0 - 0.5) < 1e-9
                w = direction * float(drive.speed[toothed.planets.name] - drive.speed[toothed.planets.carrier])
                ahead = unwound(ends[0][1], ends[0][2] + 1e-4 * w, ends[0][3], ends[0][4], point, normal) / base_pitch
                forward = 1.0 if ahead > places[0] else -1.0
                found[toothed.mesh.name, n] = forward * places[0]
    for name, one in phases.items():
        for n in range(one.planet.size):
            lag = found[name, 0] - found[name, n]
            assert abs((lag - one.lag[n] + 0.5) % 1.0 - 0.5) < 1e-9
        if one.behind is not None:
            behind = found[one.reference, 0] - found[name, 0]
            assert abs((behind - one.behind + 0.5) % 1.0 - 0.5) < 1e-9
    assert any(one.reference != name for name, one in phases.items()) or len(of.planets[0].wheels) == 2


def test_todays_phases_and_phasing_of_a_simple_set():
    of = compound_sets.simple()
    for direction, (fixed, driving, loaded) in ((d, p) for d in (1, -1) for p in permutations(CENTRALS)):
        drive = Trains(of).drive((fixed,), driving, loaded)
        run = running(as_simple(of), fixed, driving, float(direction), 1.0)
        today = simple_phases.mesh_phases(as_simple(of), clockwise=run.sun_turns < 0.0, sun_drives=run.sun_drives)
        sun, ring = mesh_phases(of, drive, direction)
        for one, lag in ((sun, today.sun), (ring, today.ring)):
            assert np.allclose((one.lag - lag + 0.5) % 1.0, 0.5, atol=1e-9)
        assert (ring.behind - today.ring_behind_sun + 0.5) % 1.0 == pytest.approx(0.5, abs=1e-9)
        rule, now = simple_phases.phasing(as_simple(of), 12), phasing(sun, 12)
        assert np.allclose(now.torque, rule.torque, atol=1e-9)
        assert np.allclose(now.force, rule.force, atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_planets_fit_where_a_search_over_whole_turns_finds_them(seed):
    """The condition by whole multiples of rows against trying all turns of the planets in their teeth."""
    rng = np.random.default_rng(seed)
    seen = set()
    for _ in range(60):
        z = {name: int(rng.integers(17, 40)) for name in ("s", "p1", "p2", "q", "s2")}
        ring, count = z["p1"] * 2 + z["s"], int(rng.integers(2, 7))
        if seed % 2:  # stepped planets
            of = compound_sets.stepped(z["s"], z["p1"], z["p2"], z["p2"] + z["s2"] + 20, count)
            turns = (
                z["p2"] * (k + z["s"] / count) / z["p1"] + (z["p2"] + z["s2"] + 20) / count for k in range(z["p1"])
            )
            fits = any(abs(round(one) - one) < 1e-9 for one in turns)
        else:
            of = compound_sets.simple(z["s"], z["p1"], ring, count)
            fits = (z["s"] + ring) % count == 0
        seen.add(fits)
        cluster = clusters(of)[0]
        assert (max(map(abs, cluster.misfit())) < 1e-9) == fits
        if fits:
            check_assembly(of)
        else:
            with pytest.raises(GeometryError, match="violates the assembly condition"):
                check_assembly(of)
    assert seen == {True, False}


def test_neighbours():
    check_neighbours(compound_sets.simple())
    (one,) = clearances(compound_sets.simple())
    assert one.gap == pytest.approx(as_simple(compound_sets.simple()).neighbour_clearance)
    with pytest.raises(GeometryError, match="tip circles overlap"):
        check_neighbours(compound_sets.simple(planets=6))
    assert {(one.first, one.second) for one in clearances(compound_sets.ravigneaux())} == {
        ("long", "long"), ("short", "short"), ("long", "short"),
    }  # fmt: skip


# ------------------------------------------------------------------------------------------------------------- modes


def absolute(of, flanks, turning):
    """Natural frequencies from springs between points of rigid bodies, in x, y and angle of every body [Hz]."""
    places, mass = [], []
    index = {}
    for member in of.members.values():
        copies = [(0.0, 0.0)] if isinstance(member, Shaft) else [
            (member.radius * math.cos(a), member.radius * math.sin(a)) for a in member.angles
        ]  # fmt: skip
        for n, place in enumerate(copies):
            index[member.name, n] = len(places)
            places.append(np.array(place))
            mass += [member.mass, member.mass, member.inertia]
    stiffness = np.zeros((len(mass), len(mass)))

    def motion(body, point):
        """Two rows: the motion of a body's point."""
        rows = np.zeros((2, len(mass)))
        x, y = point - places[body]
        rows[:, 3 * body : 3 * body + 3] = [[1.0, 0.0, -y], [0.0, 1.0, x]]
        return rows

    for toothed, side in zip(of.toothed, flanks, strict=True):
        for n in range(toothed.planets.count):
            planet = index[toothed.planets.name, n]
            mate = index[toothed.other.name, 0 if isinstance(toothed.other, Shaft) else n]
            line = places[mate] - places[planet]
            own, other = toothed.wheel.teeth, toothed.other_wheel.teeth
            share = own / (own + (-other if toothed.other_wheel.internal else other))
            point = places[planet] + share * line  # ratio of the pitch radii, negative in a ring: beyond the planet
            e = (point - places[planet]) / np.linalg.norm(point - places[planet])
            alpha = math.acos(toothed.wheel.base_radius / np.linalg.norm(point - places[planet]))
            turn = side * (math.pi / 2.0 - alpha)
            normal = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]) @ e
            row = normal @ (motion(planet, point) - motion(mate, point))
            stiffness += toothed.mesh.stiffness * np.outer(row, row)
    for group in of.planets:
        for n in range(group.count):
            body, carrier = index[group.name, n], index[group.carrier, 0]
            rows = motion(body, places[body]) - motion(carrier, places[body])
            stiffness += group.pin * rows.T @ rows
    for shaft in of.shafts:
        at = 3 * index[shaft.name, 0]
        stiffness[[at, at + 1], [at, at + 1]] += shaft.bearing
        stiffness[at + 2, at + 2] += turning.get(shaft.name, 0.0)
    return np.sqrt(np.abs(eigh(stiffness, np.diag(mass), eigvals_only=True))) / (2.0 * math.pi)


@pytest.mark.parametrize("seed", range(20))
def test_modes_against_bodies_on_springs_in_absolute_coordinates(seed):
    rng = np.random.default_rng(100 + seed)
    made = (compound_sets.ravigneaux, compound_sets.simpson, compound_sets.stepped, compound_sets.simple)[seed % 4]
    of = made(rng=rng) if seed % 4 != 2 else compound_sets.stepped(
        18, 36, 33, 87, planets=int(rng.integers(1, 4)), rng=rng, second_ring=90
    )  # fmt: skip
    flanks = tuple(int(one) for one in rng.choice([-1, 1], len(of.meshes)))
    turning = {of.shaft_names[int(rng.integers(3))]: 10 ** rng.uniform(4, 7)}
    found = compound_modes(CompoundModel(of, flanks, turning))
    want = absolute(of, flanks, turning)
    assert np.allclose(found.frequency, want, rtol=1e-9, atol=2e-8 * want[-1])
    stiff = want > 1e-3 * want[-1]
    assert np.allclose(found.frequency[stiff], want[stiff], rtol=1e-9, atol=0.0)
    assert np.count_nonzero(found.frequency == 0.0) == Trains(of).free - 1


@pytest.mark.parametrize("clockwise", [False, True])
def test_todays_simple_set_has_these_modes(clockwise):
    of = compound_sets.simple()
    found = as_simple(of)
    direction = -1 if clockwise else 1
    drive = Trains(of).drive(("ring",), "sun", "carrier")
    (group,) = of.planets
    for rigid in (False, True):
        bearing = {name: math.inf if rigid and name != "sun" else of.members[name].bearing for name in CENTRALS}
        central = [
            CentralBody(of.members[name].mass, of.members[name].inertia, bearing[name],
                        math.inf if name == "ring" else 0.0)
            for name in CENTRALS
        ]  # fmt: skip
        pin = math.inf if rigid else group.pin
        model = SetModel(found, *central, PlanetBody(group.mass, group.inertia, pin), clockwise)
        today = set_modes(model, of.meshes[0].stiffness, of.meshes[1].stiffness)
        same = CompoundSet(
            tuple(Shaft(one.name, one.wheels, one.mass, one.inertia, bearing[one.name]) for one in of.shafts),
            (type(group)(group.name, group.carrier, group.wheels, group.angles, group.radius, group.mass,
                         group.inertia, pin),),
            of.meshes,
        )  # fmt: skip
        now = compound_modes(CompoundModel(same, loaded_flanks(drive.tooth, direction), {"ring": math.inf}))
        assert np.allclose(now.frequency, today.frequency, rtol=1e-10, atol=1e-8 * today.frequency[-1])
        assert now.kind == today.kind
        for one, other in ((now.strain[0], today.sun_mesh), (now.strain[1], today.ring_mesh)):
            assert np.allclose(one, other, atol=1e-8)


def test_evenly_spaced_planets_give_modes_of_pure_kinds():
    for of in (compound_sets.ravigneaux(), compound_sets.simpson(), compound_sets.stepped()):
        kinds = compound_modes(CompoundModel(of, (1,) * len(of.meshes))).kind
        assert "mixed" not in kinds
        assert {"rotation", "translation"} <= set(kinds)


@pytest.mark.parametrize(("planets", "ratio"), [(3, 4.0), (4, 4.35), (5, 3.2)])
def test_numbers_of_teeth_are_those_of_loops_over_all(planets, ratio):
    """Sun in, carrier out, ring fixed: i = 1 + z_r/z_s."""
    of = compound_sets.simple()
    module = 2.0 * compound_sets.PER_TOOTH / math.cos(math.radians(20.0))
    of = CompoundSet(
        of.shafts, tuple(replace(one, angles=compound_sets.evenly(planets)) for one in of.planets), of.meshes
    )
    drive = Trains(of).drive(("ring",), "sun", "carrier")
    ranges = {"s": (17, 34), "p": (14, 44), "r": (50, 110)}
    wanted = Wanted(ratio, 0.004, ranges, dict.fromkeys(ranges, module))
    found = {tuple(one.teeth[name] for name in "spr") for one in search(of, drive, wanted, 10**6)}
    own = set()
    for s in range(17, 35):
        for p in range(14, 45):
            for r in range(max(50, p + 10), 111):
                if abs(r - s - 2 * p) > 1 or (s + r) % planets or abs((1 + r / s) / ratio - 1) > 0.004:
                    continue
                tip = module * p / 2 + of.planets[0].wheels[0].tip_radius - module * 29 / 2
                if 2.0 * (0.5 * module * (s + p) * math.sin(math.pi / planets) - tip) >= module:
                    own.add((s, p, r))
    assert found == own
    assert own
    wide = replace(wanted, tolerance=0.04)
    every = search(of, drive, wide, 10**6)
    count = len(every) // 2
    few = search(of, drive, wide, count)
    off = [round(abs(one.off), 9) for one in few]
    assert off == sorted(off)
    assert [one.teeth for one in few[:count]] == [one.teeth for one in every[:count]]  # none nearer was left out
    with pytest.raises(InputError, match="is not reached within"):
        search(of, drive, replace(wanted, ratio=-7.0), 3)


def test_meshes_that_close_a_loop_are_refused():
    of = compound_sets.simple()
    (group,) = of.planets
    again = type(group)("other", "carrier", group.wheels, tuple(one + 0.5 for one in group.angles), group.radius)
    meshes = tuple(Mesh(End(one.first.member, one.first.wheel), End("other", "p")) for one in of.meshes)
    with pytest.raises(InputError, match="close a loop"):
        Trains(CompoundSet(of.shafts, (group, again), (*of.meshes, *meshes)))


def test_planets_miss_the_nearest_angle_that_fits_and_nothing_where_any_does():
    turns = (0.0, 1.0, 2.1, 4.0)
    assert Cluster.misfit(SimpleNamespace(step=0, turns=turns)) == [0.0] * 4
    found = Cluster.misfit(SimpleNamespace(step=12, turns=turns))
    step = 2.0 * math.pi / 12
    assert found == pytest.approx([0.0, 1.0 - 2.0 * step, 2.1 - 4.0 * step, 4.0 - 8.0 * step])
    assert max(map(abs, found)) <= 0.5 * step


def test_a_row_of_ratios_names_what_is_held_drives_and_is_loaded():
    row = compound_set._ratio(("a", "b"), "c", "d", "both turn freely")
    drive = SimpleNamespace(ratio=3.0, torque={"d": -2.5, "a": 1.5}, efficiency=0.97, rolling=[0.2, -0.7])
    known = compound_set._ratio(("a",), "c", "d", drive)
    fields = [field.name for field in dataclasses.fields(row)]
    first, second = ([getattr(one, name) for name in fields] for one in (row, known))
    assert first[:3] + first[-1:] == ["a, b", "c", "d", "both turn freely"]
    assert np.isnan(first[3:-1]).all()
    assert second == ["a", "c", "d", 3.0, -2.5, 1.5, 0.97, 0.7, ""]
