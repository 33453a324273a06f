"""A row of rack teeth: the limit of gears, an own assembly of all teeth, reciprocity; loads as gears' limit."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.linalg import splu

from fegear.contact.pair_spec import FlankSpec, PairSpec
from fegear.contact.plane.fe_compliance import FiniteElementCompliance, finite_element_compliance
from fegear.contact.plane.maker import load_plane
from fegear.contact.rack.over_stroke import base_pitch
from fegear.contact.rack.rack_contacts import RackContacts
from fegear.contact.rack.rack_flanks import RackFlanks
from fegear.contact.rack.rack_teeth import RackCompliance, RackTeeth
from fegear.fem.plane.elasticity import assemble_two_orders
from fegear.fem.plane.rack.solved_rack import solve_rack_teeth
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_and_pinion import RackAndPinion, distance_of_backlash
from fegear.geometry.rack_relief import RackReliefSpec
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.relief import tip_relief
from fegear.geometry.relief_spec import ReliefSpec, TipReliefSpec
from fegear.geometry.toothed_rack import Rack

TEETH, BODY, MODULE = (200, 500, 1000), 3.0, 2e-3
SETTINGS = settings_at(-3)
HALF = np.asarray(0.02)


def _asked(tooth, places):
    """Compliance of a tooth and its neighbours, and both root stresses, at five places of the flank."""
    patch = SETTINGS.patch_half_width
    return np.concatenate([
        tooth.self_compliance(places, patch, HALF),
        np.diag(tooth.neighbour(1, places, places, patch)),
        np.diag(tooth.neighbour(-1, places, places[::-1], patch)),
        tooth.largest_root_stress(0, "tension", places)[0],
        tooth.largest_root_stress(0, "compression", places)[0],
    ])  # fmt: skip


def _extrapolated(values):
    """The limit of values at TEETH by powers of 1/z."""
    return np.linalg.solve(np.vander(1.0 / np.array(TEETH), 3, increasing=True), np.array(values))[0]


def _positions(pair):
    """Three on the path, and three about its end, beyond which the pinion's corner touches, in one base pitch [m]."""
    pitch = getattr(pair, "base_pitch", None) or pair.rack.base_pitch
    places = np.append(
        pair.x_start + pitch * np.array([0.1, 0.25, 0.4]), pair.x_end + pitch * np.array([-0.1, 0.02, 0.05])
    )
    return pair.x_start + np.mod(places - pair.x_start, pitch)


@pytest.fixture(scope="module")
def limits():
    """Rack and gears of the same profile and body, a pinion that meets them, and their matched numbers."""
    basic, height = BasicRack(), np.array([-0.9, -0.5, 0.0, 0.5, 0.95])
    pinion = Gear(Tooth(20, basic, profile_shift=0.3), MODULE, 0.01, 0.02)
    rack = Rack(RackTooth(basic), MODULE, 25, (BODY + 1.25) * MODULE, 0.02)
    solved = solve_rack_teeth(rack.tooth, BODY, rack.teeth, 0.3, "strain", SETTINGS, reach=2)[0]
    pair = RackAndPinion(pinion, rack, distance_of_backlash(pinion, rack, 0.0))
    driving = solve_gear(pinion, SETTINGS, reach=2, estimate_error=False)
    compliance = RackCompliance(
        pair, finite_element_compliance(driving), RackTeeth(rack, solved, SETTINGS.patch_half_width)
    )
    load = 2000.0
    found = base_pitch(compliance, RackContacts(pair), load, 12, _positions(pair))
    of_pinion, of_rack = TipReliefSpec(amount=8e-6, length=1.8e-3), RackReliefSpec(amount=12e-6, length=2e-3)
    flanks = RackFlanks(tip_relief(pinion, 8e-6, length=1.8e-3), of_rack.built(rack))
    relieved = base_pitch(compliance, RackContacts(pair), load, 12, _positions(pair), flanks)
    ground = [FlankSpec(ReliefSpec((of_pinion,))), FlankSpec(ReliefSpec((TipReliefSpec(amount=12e-6, length=2e-3),)))]
    teeth, errors, with_relief = [], [], []
    for z in TEETH:
        tooth = Tooth(z, basic)
        gear = Gear(tooth, MODULE, (tooth.root_radius - BODY) * MODULE, 0.02)
        known = solve_gear(gear, SETTINGS, reach=2, estimate_error=False)
        teeth.append(_asked(known.fine, tooth.pitch_radius + height))
        spec = PairSpec(GearPair(pinion, gear), (load,), corner_contact=True)
        engaged, x = load_plane(spec, (driving, known)).engagement, _positions(spec.pair)
        errors.append(engaged.solve(engaged.grid(x), [load]).transmission_error[:, 0])
        spec = replace(spec, driver=ground[0], driven=ground[1], relief=True)
        engaged = load_plane(spec, (driving, known)).engagement
        with_relief.append(engaged.solve(engaged.grid(x), [load]).transmission_error[:, 0])
    return _asked(solved.loaded(12), height), teeth, (found, errors), (relieved, with_relief)


@pytest.mark.dear
def test_tooth_is_the_limit_of_gears(limits):
    """Of 200, 500 and 1000 teeth, extrapolated: c_0, c_1, c_-1 over c_0, and root stress over its largest."""
    rack, gears, _, _ = limits
    scale = np.concatenate(
        [np.tile(rack[:5], 3), *(np.full(5, np.abs(part).max()) for part in (rack[15:20], rack[20:]))]
    )
    off = (_extrapolated(gears) - rack) / scale
    assert np.abs(off).max() < 1e-3
    assert np.abs((gears[2] - rack) / scale).max() > 5.0 * np.abs(off).max()  # a thousand teeth are no rack


@pytest.mark.dear
def test_transmission_error_is_the_limit_of_gears(limits):
    """Loads, Hertzian contacts and tip corners included; at a corner the limit is reached later."""
    _, _, (found, errors), _ = limits
    off = np.abs(_extrapolated(errors) / found.error - 1.0)
    assert off[:4].max() < 1e-4
    assert off.max() < 1e-3
    assert np.abs(errors[2] / found.error - 1.0).max() > 2e-3


@pytest.mark.dear
def test_transmission_error_with_tip_relief_is_the_limit_of_gears(limits):
    """Reliefs of equal length along the line of action on both; tip corners included."""
    _, _, (without, _), (found, errors) = limits
    off = np.abs(_extrapolated(errors) / found.error - 1.0)
    assert off[:4].max() < 1e-4
    assert off.max() < 1e-3
    assert np.abs(found.error - without.error).max() > 2e-6


COARSE = settings_at(-4)


def _assembled(solved, elasticity, held):
    """All teeth in one sparse matrix: unknowns by place, and its factor without the held ones."""
    z, n = len(held), elasticity.size
    number = np.arange(z * n).reshape(z, n)
    at = {}
    for name in ("side_a", "side_b"):
        along = elasticity.edge_dofs[name]
        ends = np.linspace(0.0, 1.0, elasticity.order + 1)
        curve = elasticity.edge_places[name]
        first, last = curve[:, 0], curve[:, -1]
        spots = first[:, None] + (last - first)[:, None] * ends[None, :, None]
        for c in range(2):
            for dof, y in zip(along[c].ravel(), spots[1].ravel(), strict=True):
                at[name, c, round(float(y), 8)] = dof
    for k in range(1, z):
        for (name, c, y), dof in at.items():
            if name == "side_a":
                number[k, dof] = number[k - 1, at["side_b", c, y]]
    rows, columns, values = [], [], []
    for k in range(z):
        dofs = number[k][elasticity.element_dofs]
        rows.append(np.broadcast_to(dofs[:, :, None], elasticity.stiffness.shape).ravel())
        columns.append(np.broadcast_to(dofs[:, None, :], elasticity.stiffness.shape).ravel())
        values.append(elasticity.stiffness.ravel())
    fixed = np.concatenate([number[k][np.unique(elasticity.edge_dofs["bore"])] for k in range(z) if held[k]])
    free = np.setdiff1d(np.unique(number), fixed)
    whole = coo_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (z * n, z * n)).tocsc()
    return number, free, splu(whole[free][:, free].tocsc())


@pytest.mark.parametrize(("held", "pin"), [((), 0.0), ((False, True, False, False, True), 1.2), ((True,), 1.0)])
def test_every_tooth_against_an_own_assembly(held, pin):
    """Rows with the back held, on two pins, and of one tooth on one pin: sparse LU of all unknowns at once."""
    teeth = len(held) or 4
    tooth = RackTooth(BasicRack())
    fine, coarse, _ = solve_rack_teeth(tooth, 1.5, teeth, 0.3, "strain", COARSE, reach=teeth, held=held, pin_width=pin)
    _, elasticity = assemble_two_orders(fine.mesh, 0.3, "strain", COARSE.order)
    number, free, factor = _assembled(coarse, elasticity, held or (True,) * teeth)
    load = coarse.flank.patches(np.array([0.6 * coarse.flank.flank_end]), np.array([0.2]))[:, 0]
    for i in range(teeth):
        force = np.zeros(number.size)
        np.add.at(force, number[i][coarse.flank.dofs], load)
        moved = np.zeros(number.size)
        moved[free] = factor.solve(force[free])
        one = coarse.loaded(i)
        for k in range(-i, teeth - i):
            by_row = load @ one.compliance[k] @ load
            by_all = load @ moved[number[i + k][coarse.flank.dofs]]
            assert by_row == pytest.approx(by_all, rel=1e-7, abs=1e-9)
            stress = one.stress[k, "tension"] @ load
            fillet = coarse.fillets["tension"]
            wanted = fillet.strain @ moved[number[i + k][fillet.dofs]] / (1.0 - 0.3**2)
            assert np.abs(stress - wanted).max() < 1e-6 * max(1.0, np.abs(wanted).max())


def test_neighbours_are_reciprocal_and_ends_are_softer():
    """c_ij(p, q) = c_ji(q, p); a tooth with fewer neighbours gives way more; teeth far from the ends are alike."""
    solved = solve_rack_teeth(RackTooth(BasicRack()), 2.0, 30, 0.3, "stress", COARSE, reach=2)[0]
    p, q, patch = np.array([-0.3]), np.array([0.7]), COARSE.patch_half_width
    for i, j in ((0, 1), (0, 2), (14, 15), (28, 29)):
        there = solved.loaded(j).neighbour(i - j, p, q, patch)[0, 0]
        back = solved.loaded(i).neighbour(j - i, q, p, patch)[0, 0]
        assert there == pytest.approx(back, rel=1e-8)
    own = [float(solved.loaded(i).self_compliance(q, patch, HALF)[0]) for i in (0, 1, 2, 15)]
    assert own == sorted(own, reverse=True)
    assert own[0] > 1.1 * own[1]
    assert len(set(solved.alike)) < 30


def test_the_corner_of_a_rack_is_that_of_a_gear_of_many_teeth():
    """The slope of its wedge; the difference falls like one over the teeth."""
    rack = SimpleNamespace(tooth=RackTooth(BasicRack(1.0, 1.25, 0.38)), module=MODULE)
    found, half = RackTeeth.tip_wedge.fget(SimpleNamespace(rack=rack))
    assert half == pytest.approx(0.02 * MODULE)
    off = []
    for teeth in (250, 500, 1000):
        of = SimpleNamespace(gear=SimpleNamespace(tooth=Tooth(teeth, BasicRack(1.0, 1.25, 0.38))),
                             reference_half_width=1.0)  # fmt: skip
        off.append(FiniteElementCompliance.tip_wedge.fget(SimpleNamespace(influence=of))[0] - found)
    assert np.abs(off[1:]) == pytest.approx(np.abs(off[:-1]) / 2.0, rel=0.05)
    assert abs(off[-1]) < 2e-2 * abs(found)
