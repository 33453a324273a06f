"""Edges of contact that runs seldom reach: few places, flat ends, other hands, other makers; each by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import FegearError, RangeError
from fegear.contact import load as load_module
from fegear.contact.compared.population import unevenness
from fegear.contact.double_helical.double_stress import largest_tension
from fegear.contact.load import load
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.both_flanks import _vertex
from fegear.contact.plane.largest_on_pair import _beside, _left_of_kink, _smooth
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.peaks import LEFT
from fegear.contact.unloaded.manufacture import as_cut
from fegear.contact.wide_spec import WideSpec
from fegear.fem.plane.condensation import joined
from fegear.fem.plane.odd import growth
from fegear.fem.plane.odd.growth import _next
from fegear.fem.solid.table import bands_of_table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

MODULE = 3e-3


def gear(teeth, beta=0.0, hand="spur", width=20e-3):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, MODULE, 0.3 * teeth * MODULE, width, Material(206e9), "strain", hand)


SPUR = GearPair(gear(17), gear(43))


# ---- between positions -----------------------------------------------------------------------------------------------
def test_above_a_kink_a_curve_rises_no_more_than_its_gentler_side_goes_on():
    x, samples = np.array([0.0, 1.0, 2.0, 4.0]), np.array([0.0, 1.0, 0.0, -5.0])
    # at 1.5 the value is 3: from the left by 4 for each length, from the right by 6, over a step of 1
    assert _left_of_kink(x, samples, 1.5, 3.0) == pytest.approx(4.0 * 1.0 * LEFT)
    # at a position the ends are those beside it, 2 apart
    assert _left_of_kink(x, samples, 1.0, 3.0) == pytest.approx(3.0 * 2.0 * LEFT)
    assert _left_of_kink(x, samples, 1.5, 0.5) == 0.0  # no peak: one side is higher
    for end in (0.0, 4.0, -1.0, 9.0):
        assert _left_of_kink(x, samples, end, 3.0) == 0.0


def test_pressure_counts_on_the_path_only_its_ends_included():
    pair = SimpleNamespace(x_start=-1.0, x_end=2.0)
    x = np.array([-1.1, -1.0, 0.0, 2.0, 2.1])
    assert _smooth(SimpleNamespace(pair=pair), x, np.full(5, 7.0)).tolist() == [0.0, 7.0, 7.0, 7.0, 0.0]


def test_positions_about_peaks_are_within_those_known_and_on_either_side():
    x = np.linspace(0.0, 1.0, 11)
    found = _beside(x, np.array([0.33, 0.98]))
    assert (np.diff(found) > 0.0).all()
    assert (found.min() >= 0.0, found.max()) == (True, 1.0)
    for peak in (0.33, 0.98):
        off = np.sort(np.abs(found - peak))
        assert off[0] < 1e-12
        assert off[1] < 0.05
    below, above = 0.33 - found[found < 0.33], found[(found > 0.33) & (found < 0.6)] - 0.33
    assert below.min() == pytest.approx(above.min())


def test_a_parabola_has_its_vertex_and_less_than_three_places_their_largest():
    at = np.array([1.0, 1.5, 2.0])
    assert _vertex(at, 3.0 - 2.0 * (at - 1.6) ** 2) == pytest.approx(1.6)
    assert _vertex(at, np.array([1.0, 2.0, 3.0])) == 1.5  # straight: no vertex
    assert _vertex(at[:2], np.array([1.0, 4.0])) == 1.5
    assert _vertex(at[:2], np.array([4.0, 1.0])) == 1.0


def test_points_that_are_even_miss_nothing_and_all_in_one_sixteenth_fifteen_times():
    even = (np.arange(160) + 0.5) / 160.0
    values = np.stack([even, 5.0 + 0.0 * even], axis=1)
    assert unevenness(values, np.zeros(2), np.array([1.0, 0.0])) == pytest.approx(0.0, abs=1e-12)
    half = np.stack([0.5 * even, even], axis=1)
    assert unevenness(half, np.zeros(2), np.ones(2)) == pytest.approx(1.0)
    assert unevenness(np.full((10, 1), 0.01), np.zeros(1), np.ones(1)) == pytest.approx(15.0)
    assert math.isnan(unevenness(values, np.ones(2), np.ones(2)))


def test_halfway_between_both_ends_of_the_path_either_tip_is_as_near():
    source = SimpleNamespace()
    middle = PairCompliance(SPUR, source, source).middle_of_path
    assert middle - SPUR.x_start == pytest.approx(SPUR.x_end - middle)
    assert abs(middle) > 1e-4  # the pitch point is elsewhere


# ---- gears cut with errors -------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("beta", "hand", "lead", "helix", "made"),
    [
        (0.0, "spur", -0.5, 0.5, "left"), (0.0, "spur", 0.5, 0.5, "right"), (10.0, "left", 0.5, 9.5, "left"),
        (10.0, "right", 0.5, 9.5, "right"), (0.3, "left", 0.5, 0.2, "right"), (0.3, "right", 0.5, 0.2, "left"),
        (10.0, "right", 10.0, 0.0, "spur"),
    ],
)  # fmt: skip
def test_a_lead_error_beyond_the_helix_turns_the_hand(beta, hand, lead, helix, made):
    found = as_cut(gear(20, beta, hand), lead_angle=math.radians(lead))
    assert math.degrees(found.helix_angle) == pytest.approx(helix, abs=1e-12)
    assert found.hand == made


# ---- makers ----------------------------------------------------------------------------------------------------------
def test_teeth_with_a_width_are_loaded_by_their_own_maker(monkeypatch):
    asked = {}

    def load_wide(spec, gears, **how):
        asked.update(spec=spec, gears=gears, **how)
        return "loaded"

    monkeypatch.setattr("fegear.contact.wide.maker.load_wide", load_wide)
    monkeypatch.setattr(load_module, "_refuse_gears", lambda spec, gears: None)
    spec = PairSpec(SPUR, (500.0,), width="solid", wide=WideSpec())
    assert load(spec, ("one", "other"), cache="cache", progress="progress", estimates=False) == "loaded"
    assert asked == {
        "spec": spec, "gears": ("one", "other"), "cache": "cache", "progress": "progress", "estimates": False
    }  # fmt: skip


@pytest.mark.parametrize(("width", "panels"), [(20e-3, 0), (200e-3, 0), (20e-3, 3), (1e-3, 0)])
def test_panels_are_those_that_are_given_or_as_many_as_modules_of_the_face_four_at_least(width, panels):
    pair = GearPair(gear(17, width=width), gear(43, width=width))
    found = PairSpec(pair, (500.0,), width="solid", wide=WideSpec(panels=panels)).panel_count
    if panels:
        assert found == panels
    else:
        longer = PairSpec(
            GearPair(gear(17, width=2.0 * width), gear(43, width=2.0 * width)), (500.0,), width="solid", wide=WideSpec()
        ).panel_count
        assert found >= 4
        assert longer in ((2 * found, 2 * found - 1) if width > 5e-3 else (4,))


# ---- tables and refusals ---------------------------------------------------------------------------------------------
def test_places_off_the_face_are_refused_its_ends_are_on_it():
    solution = SimpleNamespace(width=4.0)
    for place in (2.0 * (1.0 + 1e-6), -2.1):
        with pytest.raises(RangeError, match="is outside the face width, -2 to 2 modules"):
            bands_of_table(solution, [9.0], [0.0, place], 0.1)
    with pytest.raises(RangeError, match=r"6\.3 mm.*is outside the face width, -6 to 6 mm"):
        bands_of_table(solution, [9.0], [2.1], 0.1, MODULE)
    # round-off at an end is none: what is missing of this solution is asked for next
    with pytest.raises(AttributeError):
        bands_of_table(solution, [9.0], [2.0 * (1.0 + 1e-12)], 0.1)


# ---- stress of a half ------------------------------------------------------------------------------------------------
def half_loaded(known, fine=1.0, coarse=1.1, force=1.0):
    """Two halves of two loads; stress is `fine`, of the coarser gear `coarse`, times places and teeth by hand."""
    size = np.array([[1.0, 2.0], [3.0, 1.0], [0.5, 0.5]])  # teeth, places

    class Felt:
        def __init__(self, times):
            self.value = times * size

        def largest(self, sign):
            at = (sign * self.value).argmax(axis=1)
            return self.value[np.arange(3), at], np.array([-4.0, 4.0])[at], None

    cache = SimpleNamespace(
        call=lambda function, pair, member, lines, solution, coupling: SimpleNamespace(
            value=SimpleNamespace(stress=lambda side, by, z: Felt(solution * float(by[0, 0])))
        )
    )
    one = SimpleNamespace(
        contact=SimpleNamespace(force=np.full((2, 3, 2), force)), lines=SimpleNamespace(low=-4.0, high=4.0),
        pair=SimpleNamespace(driver=SimpleNamespace(module=2.0)),
    )  # fmt: skip
    share = np.array([[[0.4, 0.5], [0.2, 0.4]], [[0.6, 0.5], [0.8, 0.6]]])
    error = SimpleNamespace(share=np.array([[0.01, 0.02], [0.03, 0.05]])) if known else None
    pair = SimpleNamespace(
        halves=(one, one), spec=SimpleNamespace(halves=(SimpleNamespace(neighbour_coupling=True),) * 2),
        share=share, error=error,
    )  # fmt: skip
    gear_ = SimpleNamespace(
        fine=fine, coarse=coarse, error={"root_tension": 0.02}, entry_shares={"root_tension": 0.5}
    )  # fmt: skip
    return pair, gear_, cache


def test_the_error_of_a_half_s_root_stress_is_that_of_its_gear_and_of_its_load():
    pair, one, cache = half_loaded(known=True)
    found = largest_tension(pair, 1, "driver", one, 1, cache)
    assert (found.value, found.z) == (3.0, -4.0)
    # half of what the coarser gear changes, and the load's 0.05 of 0.6
    assert found.error == pytest.approx(0.5 * 0.3 + 3.0 * 0.05 / 0.6)
    one.coarse = None
    assert largest_tension(pair, 1, "driver", one, 1, cache).error == pytest.approx(0.02 * 3.0 + 3.0 * 0.05 / 0.6)
    pair, one, cache = half_loaded(known=False)
    assert math.isnan(largest_tension(pair, 0, "driver", one, 0, cache).error)
    pair, one, cache = half_loaded(known=True, force=0.0)
    assert all(math.isnan(value) for value in largest_tension(pair, 0, "driver", one, 0, cache))


# ---- growing cracks --------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("turn", [0.0, 0.7, -0.7, math.pi / 2.0])
def test_a_crack_goes_on_by_a_step_turned_from_its_last_way(turn):
    path = np.array([[5.0, 1.0, 4.0], [5.0, 2.0, 6.0]])  # its last way is (3, 4), 5 long
    x, y = _next(path, turn, 2.0)
    ahead = complex(0.6, 0.8) * 2.0 * complex(math.cos(turn), math.sin(turn))
    assert complex(x - 4.0, y - 6.0) == pytest.approx(ahead)


@pytest.mark.parametrize("known", [0, 2])
def test_where_the_next_step_has_no_room_growth_ends_at_the_surface_or_is_refused(known, monkeypatch):
    rows = []

    def one(*_asked):
        if len(rows) == known:
            raise FegearError("no room")
        rows.append(1)
        return SimpleNamespace(
            k=np.array([1.0, 0.1]), k_error=np.zeros(2), middle=9.0, shut=0.0, radius=5.0, compliance=7.0,
            compliance_error=0.0,
        )  # fmt: skip

    monkeypatch.setattr(growth, "_one", one)
    monkeypatch.setattr(growth, "_ends_in", lambda *_asked: "bore")
    monkeypatch.setattr(growth, "rest_of_ring", lambda *_asked, **_more: SimpleNamespace(half=1))
    from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
    from fegear.fem.plane.settings import settings_at

    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    crack = straight_crack(tooth, mouth_at_tangent(tooth, math.radians(30.0)), math.radians(70.0), depth=0.2)

    def grown():
        loads = np.array([13.0]), np.array([1.0])
        return growth.grow(tooth, 9.0, 0.3, "strain", crack, loads, settings=settings_at(-5), step=0.1, steps=5)

    if not known:
        with pytest.raises(FegearError, match="no room"):
            grown()
        return
    found = grown()
    assert (found.stopped, found.k_1.size) == ("surface", 2)
    assert len(found.crack.corners) == len(crack.corners) + 1  # the step that had no room is taken back
    assert np.diff(found.length) == pytest.approx([0.1])


def test_parts_without_unknowns_join_nothing():
    nothing, one = (np.zeros(0, int), np.zeros((0, 0))), (np.array([2, 5]), np.eye(2))
    assert joined(nothing, one) is one
    assert joined(one, nothing) is one
    dofs, stiffness = joined(one, (np.array([3, 5]), np.array([[4.0, 0.0], [1.0, 6.0]])))
    assert dofs.tolist() == [2, 3, 5]
    assert np.tril(stiffness).tolist() == [[1.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 1.0, 7.0]]
