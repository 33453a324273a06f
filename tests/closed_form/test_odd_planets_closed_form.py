"""Planetary sets with odd teeth: which tooth meets where, loads by an own solver, lines by brute force."""

import functools
import math

import numpy as np
import pytest
from scipy.optimize import brentq

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.dynamics.planetary.phases import whole_delays
from fegear.dynamics.planetary.planet_set import even_angles
from fegear.dynamics.planetary.set_cycle import SetCycle, set_cycle
from fegear.dynamics.planetary.set_revolution import SetRevolution, with_ordinary_teeth
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.gear import Gear, Material
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.results.catalogue import STAGES
from fegear.results.planetary.turning_set import turning_set

SIZE = {"module": "2 mm", "face_width": "20 mm", "thickness_allowance": "20 um"}
RING = {"internal": True, "teeth": 56, "cutter": {"teeth": 20}, "tip_diameter": "108.6 mm", "rim_thickness": "10 mm"}
CACHE = SolutionCache()


def scene_of(odd=None, results=("planet-revolution",), **keys):
    gears = {"s": SIZE | {"teeth": 16}, "p": SIZE | {"teeth": 20}, "r": SIZE | RING}
    for name, teeth in (odd or {}).items():
        gears[name] = gears[name] | {"odd_tooth": teeth}
    part = {"sun": "s", "planet": "p", "ring": "r", "planets": 3, "torque": "100 N*m", "speed": "1000 rpm",
            "floating": []} | keys  # fmt: skip
    case = {
        "results": list(results),
        "gear": gears,
        "planetary": {"P": part},
        "accuracy": {"tolerance": 2e-2},
        "effects": {"neighbour_coupling": True, "odd_teeth": bool(odd)},
    }
    return build_scene(case, "case", None)


def run(odd=None, results=("planet-revolution",), **keys):
    scene = scene_of(odd, results, **keys)
    return {
        task.subject + task.stage: outcome.data
        for task, outcome in run_plan(scene, make_plan(scene, STAGES), cache=CACHE).outcomes.items()
    }


def pit(depth="8 um", tooth=0):
    return {"tooth": tooth, "pits": [{"diameter": ["20 mm", "60 mm"], "depth": depth}]}


@functools.cache
def with_pits():
    """Tooth 2 of the sun and tooth 1 of planet 2 have their whole flanks too low."""
    return run({"s": [pit("4 um", 2)], "p": [pit("6 um", 1)]}, odd_planet=2)


@pytest.mark.parametrize(
    "way", [{}, {"clockwise": True}, {"input": "carrier", "fixed": "ring"}, {"input": "ring", "fixed": "carrier"}]
)
def test_a_tooth_meets_the_ring_half_a_turn_after_the_sun_as_its_outline_says(way):
    """Outlines of the set that is drawn turning: the flank that does not touch the sun comes to the ring."""
    scene = scene_of(results=("planet-set",), **way)
    from fegear.case.built.planetary import set_inputs

    asked, drawn = set_inputs(scene, "P"), turning_set(scene, "P")
    clockwise, drives = asked.run.sun_turns < 0.0, asked.run.sun_drives
    late = whole_delays(asked.found, asked.phases, 0, clockwise=clockwise, sun_drives=drives)
    whole = late - asked.phases.delays
    assert whole == pytest.approx(np.rint(whole), abs=1e-9)
    planet, found = drawn.gears["planet"], asked.found
    off = []
    for q, angle, facing in ((0.0, found.sun_angle, math.pi), (late[1, 0], found.ring_angle, 0.0)):
        radius = found.base_radius("planet") / math.cos(angle)
        x, y = planet.tooth
        right = x > 0.0
        order = np.argsort(np.hypot(x, y)[right])
        half = np.interp(radius, np.hypot(x, y)[right][order], np.arctan2(x, y)[right][order])
        centre = planet.start[0] + planet.turn * q
        away = (centre - found.angles[0] - facing + math.pi) % (2.0 * math.pi) - math.pi
        off.append((away, half))
    (at_sun, thick_sun), (at_ring, thick_ring) = off
    assert abs(at_sun) == pytest.approx(thick_sun, abs=2e-4)
    assert abs(at_ring) == pytest.approx(thick_ring, abs=2e-4)
    assert at_sun * at_ring < 0.0  # one flank is on one side of the centre line, the other one on the other
    assert 0.0 < late[1, 0] < found.planet_teeth


@pytest.mark.dear
def test_teeth_that_differ_by_nothing_change_nothing():
    found, plain = run({"p": [pit("0 um")]}), run(results=("planet-load-sharing",))
    loads, usual = found["Pplanet-revolution"].loads, plain["Pplanet-load-sharing"]
    assert loads.cycle.cycles == 20
    assert usual.cycle.cycles == 1
    assert loads.te_mean == pytest.approx(usual.te_mean, abs=usual.te_mean_error)
    assert loads.te_mean == pytest.approx(usual.te_mean, rel=3e-5)
    assert loads.shares == pytest.approx(usual.shares, rel=1e-9)
    assert found["Pplanet-revolution"].te_residual_max < 1e-9 * usual.te_mean


@pytest.mark.dear
def test_four_planets_about_a_floating_sun_make_no_lines_at_the_ring():
    """A sun without a bearing has equal forces of opposite planets, whatever their teeth."""
    scene = scene_of({"s": [pit("4 um", 2)], "p": [pit("6 um", 1)]}, odd_planet=2, planets=4, floating=["sun"])
    outcomes = run_plan(scene, make_plan(scene, STAGES), cache=CACHE).outcomes
    (found,) = (outcome for task, outcome in outcomes.items() if task.stage == "planet-revolution")
    force = found.data.loads.mesh_force
    assert np.ptp(force[1], axis=1).min() > 0.0
    assert force[:, :2] == pytest.approx(force[:, 2:], rel=1e-9)
    assert not any("lines" in table.name for table in found.tables)
    assert not any("lines" in figure.name for figure in found.figures)
    assert any("no lines at the ring" in remark for remark in found.remarks)


def own_loads(found, part, s):
    """Forces of rigidly held planets at a place, by teeth counted here and forces by interpolation and bisection."""
    z_s, z_p, z_r, odd, count = 16, 20, 56, 1, 3
    loads, force = part.loads, np.linspace(0.0, 4.0 * part.loads.mean_force, 161)[1:]
    engagements = {m: found[f"P_{m}odd-pair"].engagement for m in ("sun", "ring") if f"P_{m}odd-pair" in found}
    engagements.setdefault("ring", (found.get("P_ringodd-pair") or found["P_ringloaded-pair"]).engagement)
    approach = []
    psi = 2.0 * math.pi * np.arange(count) / count
    first = z_s * odd / count % 1.0
    for n in range(count):
        total = np.zeros(force.size)
        for mesh, teeth in (("sun", z_s), ("ring", -z_r)):
            e = engagements[mesh]
            if n != odd:
                e = with_ordinary_teeth(e, "driven" if mesh == "sun" else "driver")
            pitch, model = e.pair.base_pitch, loads.cycle.model.found
            place = s - first - teeth * (psi[n] - psi[odd]) / (2.0 * math.pi)
            if mesh == "ring":
                thick = model.half_tooth_angle("sun") + model.half_tooth_angle("ring")
                place -= z_p * (math.pi - thick) / (2.0 * math.pi)
            inside = float(e.meshing.reduced(place * pitch))
            cycle = round((place * pitch - inside) / pitch)
            total += e.solve(e.grid([inside]), force, cycle).transmission_error[0]
        approach.append(total)

    def carried(u):
        return [np.interp(u, np.append(0.0, one), np.append(0.0, force), left=0.0) for one in approach]

    top = min(one[-1] for one in approach)
    u = brentq(lambda u: sum(carried(u)) - count * loads.mean_force, 0.0, top)
    return np.array(carried(u)), u


@pytest.mark.dear
def test_loads_of_a_set_with_odd_teeth_are_those_of_an_own_solver():
    """Sun and planet hunt: at the places where either odd tooth touches, and elsewhere, all planets by themselves."""
    found = with_pits()
    part = found["Pplanet-revolution"]
    loads = part.loads
    assert loads.cycle.cycles == math.lcm(16, 20)
    residual = np.abs(part.te_residual)
    places = {*np.argsort(residual)[[-1, -40, -400, -1200]], *range(5, loads.s.size, loads.s.size // 8)}
    for at in places:
        own, u = own_loads(found, part, float(loads.s[at]))
        assert loads.mesh_force[0, :, at] == pytest.approx(own, abs=4e-3 * loads.mean_force)
        assert loads.te[at] == pytest.approx(u, rel=2e-3)
    assert residual.max() > 1e-7


def test_the_odd_tooth_of_a_planet_unloads_this_planet_and_no_other():
    """Its flank that touches the sun is 8 um too low: once in a turn of the planet, for two base pitches."""
    part = run({"p": [pit("8 um")]}, odd_planet=3)["Pplanet-revolution"]
    loads = part.loads
    share = loads.mesh_force[0].reshape(3, 20, -1)
    lower = (share.min(axis=2) < 0.97 * np.median(share.min(axis=2), axis=1)[:, None]).nonzero()
    assert set(lower[0]) == {2}
    assert len(set(lower[1])) <= 3
    assert part.te_residual_max > 1e-8


def lines_by_force(part, z_r):
    """A pick-up on the ring by samples over the whole period: planets pass it with their windows."""
    loads, count, each = part.loads, part.base_pitches, 960
    whole = math.lcm(count, z_r)
    s = np.arange(whole * each) / each
    signal = np.zeros(s.size)
    for n, angle in enumerate(loads.cycle.model.found.angles):
        force = np.interp(s % count, loads.s, loads.mesh_force[1, n], period=count)
        signal += 0.5 * (1.0 + np.cos(angle + 2.0 * math.pi * s / z_r)) * force
    return np.arange(3 * whole + 1) / whole, 2.0 * np.abs(np.fft.rfft(signal)[: 3 * whole + 1]) / s.size


@pytest.mark.parametrize("odd", [None, {"p": [pit()]}, {"s": [pit()]}])
def test_lines_at_the_ring_are_those_of_planets_passing(odd):
    """Carrier, planet and sun: every line by brute force; of equal teeth those of the planets only."""
    part = run(odd)["Pplanet-revolution"]
    lines = part.at_ring
    order, amplitude = lines_by_force(part, 56)
    seen, at = np.zeros(order.size), np.rint(lines.order * (order.size - 1) / 3.0).astype(int)
    assert order[at[at < order.size]] == pytest.approx(lines.order[at < order.size], rel=1e-9)
    seen[at[at < order.size]] = lines.force[at < order.size]
    low = order < 2.9
    assert seen[low][1:] == pytest.approx(amplitude[low][1:], abs=1e-4 * amplitude[1:].max())
    kept = lines.force > 1e-3 * lines.force.max()
    period = {None: 1, "p": 20, "s": 16}[next(iter(odd)) if odd else None]
    turns = (lines.order - lines.passing / 56.0) * period
    assert np.abs(turns - np.rint(turns)).max() < 1e-9
    if odd is None:  # orders of the carrier are multiples of the number of planets
        assert set(np.rint(lines.order[kept] * 56).astype(int) % 3) == {0}
    else:
        # held rigidly, planets carry the torque together at any place: all lines are those of their passing
        assert set(lines.passing[kept].tolist()) == {-1, 1}
        turned = np.rint(lines.force_order[kept] * period).astype(int) % period
        assert np.count_nonzero(turned) > 20


def test_frequencies_of_lines_are_those_of_the_members():
    """A planet turns z_s / z_p times as often as the sun against the carrier: the first order of its odd tooth."""
    part = run({"p": [pit()]})["Pplanet-revolution"]
    first = part.orders.frequency[0]
    turns = 1000.0 / 60.0 * (1.0 - 16.0 / 72.0)  # of the sun against the carrier, the ring fixed
    assert first == pytest.approx(turns * 16.0 / 20.0, rel=1e-9)


def test_a_set_that_is_not_told_where_its_teeth_stand_is_refused():
    part = run({"p": [pit()]})["Pplanet-revolution"]
    cycle = part.loads.cycle

    class Odd:
        cycles, breaks = 20, np.array([0.3])

    with pytest.raises(InputError, match="use identical teeth"):
        set_cycle(cycle.model, (Odd(), Odd()), None, 1.0, "sun")

    class Many(Odd):
        cycles = 2003

    with pytest.raises(InputError, match="2003 base pitches"):
        set_cycle(cycle.model, (Many(), Many()), None, 1.0, "sun", np.zeros((2, 3)))
    assert isinstance(part, SetRevolution)
    assert isinstance(cycle, SetCycle)
    assert even_angles(3).size == 3


def test_an_odd_planet_that_is_not_there_is_refused():
    with pytest.raises(InputError, match="must be at most 3"):
        scene_of({"p": [pit()]}, odd_planet=4)


@pytest.mark.dear
def test_a_crack_of_a_ring_gear_gives_back_the_energy():
    """K_I^2 + K_II^2 = E' dc/da / 2 under a load on its tooth, from deflections of three depths."""
    tooth = InternalTooth(56, PinionCutter(20), tip_radius=27.15)
    gear = Gear(tooth, 1.0, tooth.root_radius + 4.0, 10.0, Material(1.0))
    plain = solve_gear(gear, settings_at(-4), reach=1, estimate_error=False)
    mouth, radii, step = mouth_at_tangent(tooth, math.radians(60.0)), [27.5, 28.0, 28.5], 0.01
    known = [
        solve_cracked_gear(plain, {0: straight_crack(tooth, mouth, math.radians(70.0), depth=depth)})
        for depth in (0.5 - step, 0.5, 0.5 + step)
    ]
    soft, _, softer = (one.own(0, radii, np.full(3, 0.02)) for one in known)
    release = 0.5 * (softer - soft) / (2.0 * step) / (1.0 - 0.3**2)
    k = known[1].stress_intensity(0, 0, radii)[0]
    assert (k**2).sum(axis=0) == pytest.approx(release, rel=2e-3)
    assert (k[0] > 0.0).all()
