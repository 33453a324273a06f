"""Errors stated where two solutions agree by chance, or share what is wrong: by what is known beside, or otherwise."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.wide.load_factors import RootFactors
from fegear.fem.plane import estimate as estimate_module
from fegear.fem.plane.edge_curves import beyond_the_fillet, moved_by_edges
from fegear.fem.plane.estimate import Estimate
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rack import BasicRack
from fegear.results.pair.load_factors import FlankLoadFactorsData


@pytest.fixture(scope="module")
def ring():
    """A ring on a rim of four modules whose next tooth was 3.4 times the stated error off; and with shorter edges."""
    cutter = PinionCutter(20, profile_shift=0.244, addendum=1.25, tip_radius=0.244)
    tooth = InternalTooth(72, cutter, profile_shift=0.244, tip_radius=210.7378 / 6.0)
    gear = Gear(tooth, 1e-3, (tooth.root_radius + 12.7142 / 3.0) * 1e-3, 0.02)
    rough = settings_at(-4.5)
    finer = replace(rough, root_edge_length=0.022, root_fraction=0.045)
    return solve_gear(gear, rough), solve_gear(gear, finer, estimate_error=False)


def test_edges_of_a_fillet_move_the_next_tooth_by_what_shorter_ones_change(ring):
    rough, finer = ring
    known, patch = rough.fine, rough.settings.patch_half_width
    radius = np.linspace(rough.lowest_radius, rough.highest_radius, 9) * 1e3
    change = finer.fine.neighbour(1, radius, radius, patch) - known.neighbour(1, radius, radius, patch)
    loads, outside = known.remote(radius, patch), {side: beyond_the_fillet(known, side) for side in SIDES}
    moved = moved_by_edges(known, 1, loads, loads, outside)
    assert np.linalg.norm(moved - change) < 0.3 * np.linalg.norm(change)
    backward = moved_by_edges(known, -1, loads, loads, outside)
    assert backward == pytest.approx(moved.T, rel=1e-6, abs=1e-9 * np.abs(moved).max())
    other = rough.estimate.neighbour(1, radius, radius)[1]
    assert (np.abs(change) < 1.5 * other).all()


def test_points_off_a_fillet_are_as_far_from_it_as_they_were_put(ring):
    known = ring[0].fine
    for side, mirror in (("tension", 1.0), ("compression", -1.0)):
        fillet, curve, h = known.fillets[side], known.tooth.fillet, 1e-3
        parameter = np.linspace(curve.start, curve.end, fillet.arc.size + 2)[1:-1]
        place = curve.points(parameter) + h * curve.normals(parameter)
        arc = np.array([_length(curve, one) for one in parameter])
        radius, angle = np.hypot(*place), mirror * np.arctan2(*place)
        moved = replace(fillet, radius=radius, angle=angle, arc=arc, length=_length(curve, curve.end))
        off = beyond_the_fillet(replace(known, fillets={**known.fillets, side: moved}), side)
        assert off == pytest.approx(np.full(off.shape, h), rel=1e-6)
        user = replace(known, mesh=replace(known.mesh, origin="mesh.msh"))
        assert not beyond_the_fillet(user, side).any()


def test_pressures_narrowed_beside_the_start_of_a_flank_are_halved_too():
    """Half of the usual width was no narrower there, and a next tooth 1.6 times the stated error off."""
    rack = BasicRack(1.052, 1.354, 0.1847, math.radians(22.5))
    gear = Gear(Tooth(13, rack, 0.162), 3e-3, 9.542e-3, 0.02, Material(2.06e11, 0.323), "stress")
    solved = solve_gear(gear, settings_at(-2.0))
    known, patch = solved.fine, solved.settings.patch_half_width
    radius = np.linspace(known.flank.lowest_radius * 1.0001, solved.highest_radius * 1e3 / 3.0 * 0.9999, 61)
    value, stated = (np.diagonal(one) for one in solved.estimate.neighbour(1, radius, radius))
    off = np.abs(value - np.diagonal(known.neighbour(1, radius, radius, 0.06)))
    assert (off < 1.2 * stated).all()
    assert np.median(stated[off > 0.2 * off.max()] / off[off > 0.2 * off.max()]) < 3.0
    narrow, nominal = known.remote(radius, patch, 0.5), known.remote(radius, 0.5 * patch)
    middle = np.abs(radius - radius.mean()).argmin()
    assert narrow[:, middle] == pytest.approx(nominal[:, middle], abs=1e-12)


def _length(curve, to):
    at = np.linspace(curve.start, to, 2001)
    return float(np.hypot(*np.diff(curve.points(at))).sum())


def test_where_a_difference_changes_its_sign_the_error_is_that_of_places_beside_it(ring, monkeypatch):
    """Of a ring the true error at such a place was twice the stated one."""
    low, high = (radius * 1e3 for radius in (ring[0].lowest_radius, ring[0].highest_radius))
    middle, span = 0.5 * (low + high), 0.02 * (high - low)

    def difference(self, value, radius, half_width):
        """Large about the middle, through zero there, and next to nothing elsewhere; larger still at the end."""
        r = np.broadcast_to(np.asarray(radius, dtype=float), np.shape(value))
        off = (r - middle) / span
        return 1e-3 * np.abs(off) * np.exp(-0.5 * off**2) + np.where(high - r < 1e-3, 1.0, 1e-9)

    monkeypatch.setattr(Estimate, "_self_difference", difference)
    monkeypatch.setattr(estimate_module, "USUAL", 0.0)
    estimate, b = replace(ring[0].estimate), np.asarray(0.02)
    sampled = difference(None, estimate._samples, estimate._samples, None)
    crossing, before, end, next_to_it = estimate.self_error(np.array([middle, middle + span, high, high - 0.02]), b)
    share = end / estimate_module._NARROWED
    nearest = np.argsort(np.abs(estimate._samples[:33] - middle))[:3]
    assert crossing >= 0.99 * share * sampled[nearest].max()
    assert before >= 0.99 * share * 1e-3 * math.exp(-0.5)
    assert next_to_it < 1e-3 * share  # what a corner does concerns no other place


def test_a_root_factor_errs_as_that_of_the_gear_it_meshes_with():
    """K_Fbeta of one gear agreed by chance: 8 times the stated error off."""
    fine = {"driver": RootFactors(1.01, 1.1, 3e8), "driven": RootFactors(1.02, 1.2, 2e8)}
    coarse = {
        "driver": (fine["driver"], RootFactors(1.01, 1.15, 3e8)),
        "driven": (fine["driven"], RootFactors(1.023, 1.21, 2e8)),
    }
    of_load = SimpleNamespace(face_load_factor=np.array([0.02]))
    loaded = SimpleNamespace(at=0, error=of_load, stated=SimpleNamespace(face_load_factor=np.ones(1)))
    data = FlankLoadFactorsData(loaded, np.zeros(1), fine, coarse, "", 0.9, 0.0, None, np.ones(1))
    for member in ("driver", "driven"):
        one = data.members[member]
        assert one.fine is fine[member]
        assert one.off("face") == pytest.approx(0.003)
        assert one.off("transverse") == pytest.approx(0.05)
    of_load.face_load_factor[:] = 0.2  # a load that is off by a fifth is felt at the root
    assert data.members["driver"].off("face") == pytest.approx(0.01)
    assert data.members["driver"].off("transverse") == pytest.approx(0.05)
    none = replace(data, again={"driver": (), "driven": ()})
    assert none.members["driver"].off("face") is None
    half = replace(data, again={"driver": (), "driven": coarse["driven"]})
    assert half.members["driver"].off("transverse") == pytest.approx(0.01)


def test_no_loads_far_away_are_no_loads():
    """Where no contact stands at any position, as of a tooth that faces of cracks are followed from."""
    gear = Gear(Tooth(20, BasicRack(1.0, 1.25, 0.38)), 3e-3, 15e-3, 0.02)
    solved = solve_gear(gear, settings_at(-5.0))
    none = solved.fine.remote(np.zeros(0), 0.02)
    assert none.shape == (solved.fine.remote(np.array([9.5]), 0.02).shape[0], 0)
