"""Edges of contact that runs seldom reach: few places, flat ends, other hands, other makers; each by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from helical_gears import helical_gear

from fegear.base.errors import FegearError, RangeError
from fegear.contact import load as load_module
from fegear.contact.compared.population import unevenness
from fegear.contact.double_helical.double_stress import largest_tension
from fegear.contact.error_over_pitch import (
    ErrorOverPitch,
    TransmissionErrorShift,
    no_less_than_beside,
    over_pitch,
    secant_start,
)
from fegear.contact.fourier import effective_error
from fegear.contact.load import load
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane import moved_outlines
from fegear.contact.plane.both_flanks import _vertex
from fegear.contact.plane.largest_on_pair import _beside, _left_of_kink, _smooth
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.peaks import LEFT
from fegear.contact.plane.shifted_loads import _between_two_places, _of_effective, load_shift
from fegear.contact.unloaded.manufacture import as_cut
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.pair_contact import pair_contact
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


# ---- errors and curves over a base pitch -----------------------------------------------------------------------------
def test_errors_of_amplitudes_add_in_the_effective_one_by_its_slopes():
    """Against differences of A_e itself, amplitude by amplitude."""
    amplitude, off = 3.0 / np.arange(1, 15) ** 2, 0.1 + 0.3 * np.random.default_rng(3).random(14)

    def effective(a):
        return float(effective_error(SimpleNamespace(amplitude=a)))

    step, expected = 1e-6, 0.0
    for n in range(amplitude.size):
        more, less = amplitude.copy(), amplitude.copy()
        more[n] += step
        less[n] -= step
        expected += ((effective(more) - effective(less)) / (2.0 * step) * off[n]) ** 2
    assert _of_effective(amplitude, off) == pytest.approx(math.sqrt(expected), rel=1e-6)
    assert _of_effective(0.0 * amplitude, off) == pytest.approx(off[0])  # of none, that of the first


def test_a_change_that_is_the_same_everywhere_leaves_no_height_and_half_a_step_half_of_it():
    x = np.linspace(-2.0, 1.0, 3001)[:-1]
    points = SimpleNamespace(breaks=np.array([-2.0, 0.0, 1.0]), period=3.0, x=x)
    assert _between_two_places(points, np.full(x.size, 7.0)) == 0.0
    assert _between_two_places(points, np.where(x < -0.5, 0.0, 4.0)) == pytest.approx(2.0)  # as many alike as apart
    assert _between_two_places(points, np.where(x < -1.7, 4.0, 0.0)) == 0.0  # few places
    even = np.sin(2.0 * math.pi * (np.arange(600) + 0.5) / 600.0)
    wave = _between_two_places(points, np.sin(2.0 * math.pi * x / 3.0))
    assert wave == pytest.approx(float(np.median(np.abs(even[:, None] - even))), rel=2e-2)


def test_loads_of_a_shifted_solution_are_compared_where_both_have_points():
    one = SimpleNamespace(
        x=np.array([0.0, 1.0, 2.0, 3.0]), load=np.array([[1.0, 5.0], [2.0, 5.0], [4.0, 5.0], [9.0, 5.0]])
    )
    other = SimpleNamespace(x=np.array([0.5, 2.5]), load=np.array([[1.0, 4.0], [5.0, 8.0]]))
    # between its two points the other goes straight: 2 at 1, 4 at 2, and 5, 7 of the second load
    assert load_shift(one, other).tolist() == [[0.0, 0.0], [0.0, 0.0], [0.0, 2.0], [0.0, 0.0]]


def error_over_pitch(**given):
    one = SimpleNamespace(
        mesh_stiffness_mean=200.0, mesh_stiffness_on_path=190.0, local_stiffness_on_path=300.0, at=1,
        local_stiffness_mean=np.array([100.0, 400.0]), te_mean=np.array([1.0, 5.0]), mesh_compliance_mean=0.02,
        shift=SimpleNamespace(stiffness=4.0, mean=0.5), shifts=(), **given,
    )  # fmt: skip
    one._share_of_error = lambda stiffness: ErrorOverPitch._share_of_error(one, stiffness)
    one._errors = lambda of: ErrorOverPitch._errors(one, of)
    return one


def test_errors_of_stiffnesses_are_relatively_those_of_the_secant_s_mean():
    one = error_over_pitch()
    # 4 of 200: 2 %
    assert ErrorOverPitch.on_path_error.fget(one) == pytest.approx(0.02 * 190.0)
    assert ErrorOverPitch.local_on_path_error.fget(one) == pytest.approx(0.02 * 300.0)
    assert ErrorOverPitch.local_stiffness_error.fget(one) == pytest.approx(0.02 * 400.0)
    assert ErrorOverPitch.mesh_compliance_error.fget(one) == pytest.approx(0.1 * 0.02)  # 0.5 of 5
    one.mesh_compliance_mean = one.mesh_stiffness_on_path = None
    assert ErrorOverPitch.mesh_compliance_error.fget(one) is ErrorOverPitch.on_path_error.fget(one) is None
    one.shift = None
    assert ErrorOverPitch.local_stiffness_error.fget(one) is None


def test_contact_outside_the_path_stiffens_where_the_change_exceeds_its_error():
    one = error_over_pitch()
    stiffens = ErrorOverPitch.off_path_stiffens.fget
    assert stiffens(one) is True
    for on_path, expected in ((195.9, True), (196.1, False), (204.1, True), (203.9, False)):
        one.mesh_stiffness_on_path = on_path
        assert stiffens(one) is expected
    one.shift, one.mesh_stiffness_on_path = None, 200.0 * (1.0 - 1e-15)
    assert stiffens(one) is False  # round-off
    one.mesh_stiffness_on_path = 199.9
    assert stiffens(one) is True
    one.mesh_stiffness_on_path = None
    assert stiffens(one) is None


def test_errors_under_every_load_are_those_of_its_own_shift():
    shifts = tuple(TransmissionErrorShift(n, 10.0 + n, 20.0 + n, np.zeros(1), 30.0 + n) for n in (1.0, 2.0))
    one = error_over_pitch()
    one.shifts = shifts
    assert ErrorOverPitch.mean_errors.fget(one).tolist() == [1.0, 2.0]
    assert ErrorOverPitch.peak_to_peak_errors.fget(one).tolist() == [11.0, 12.0]
    assert ErrorOverPitch.effective_errors.fget(one).tolist() == [21.0, 22.0]
    one.shifts = ()
    assert ErrorOverPitch.mean_errors.fget(one) is None
    empty = TransmissionErrorShift(1.0, 1.0, 1.0, np.zeros(0), 1.0)
    assert empty.first_harmonic == 0.0
    assert TransmissionErrorShift(1.0, 1.0, 1.0, np.array([3.0, 4.0]), 1.0).first_harmonic == 3.0


def test_no_harmonic_is_surer_than_those_beside_it():
    error = np.array([0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0])
    found = no_less_than_beside(error)
    assert found == pytest.approx([math.sqrt(5.0)] * 2 + [5.0] + [math.sqrt(5.0)] * 2 + [0.0, 0.0])
    # at an end the first stands for what is beyond it
    assert no_less_than_beside(np.array([2.0, 0.0, 0.0, 0.0]))[1] == pytest.approx(math.sqrt(2.0 * 4.0 / 5.0))


def test_the_secant_starts_where_it_has_no_force_and_round_off_is_none():
    te, stiffness = np.array([7.0, 5.0, 5.0]), np.array([100.0, 100.0, 100.0 * (1.0 + 1e-14)])
    assert secant_start(te, stiffness, 500.0).tolist() == [2.0, 0.0, 0.0]


def test_a_curve_over_a_pitch_goes_round_straight_between_its_rows():
    x, values = np.array([-1.0, 0.0, 1.5, 2.0]), np.array([3.0, 5.0, 2.0, 99.0])
    part = np.array([0.0, 1.0 / 6.0, 1.0 / 3.0, 5.0 / 6.0, 11.0 / 12.0])
    # the row a pitch behind the first one is the first one itself
    assert over_pitch(x, values, 3.0, part) == pytest.approx([3.0, 4.0, 5.0, 2.0, 2.5])


# ---- outlines under load ---------------------------------------------------------------------------------------------
@pytest.mark.parametrize("coupling", [True, False])
@pytest.mark.parametrize(("member", "forward"), [("driver", 1), ("driven", -1)])
def test_an_outline_is_moved_by_the_loads_on_all_pairs(member, forward, coupling, monkeypatch):
    rng = np.random.default_rng(8)
    loads, radius, width = (
        rng.uniform(50.0, 90.0, (2, 3, 1)),
        rng.uniform(1.0, 2.0, (2, 3)),
        rng.uniform(0.1, 0.2, (2, 3)),
    )
    loads[0, 1] = loads[1, 2] = 0.0
    number = np.array([0, 1])
    contacts = SimpleNamespace(number=number, radius_driver=radius, radius_driven=radius)

    def moves(k, r, b):
        return np.array([1.0 + 10.0 * k + r, 2.0 - k + b])

    def displacement(r, patch, b):
        assert patch == 0.07
        return {k: np.stack([moves(k, r, b), -moves(k, r, b)], axis=1) for k in (-1, 0, 1)}  # (2, N, P)

    motion = SimpleNamespace(points=np.ones((2, 2)), displacement=displacement)
    gear_ = SimpleNamespace(module=2.0, material=SimpleNamespace(young_modulus=400.0))
    e = SimpleNamespace(
        pair=SimpleNamespace(gear=lambda name: gear_), compliance=SimpleNamespace(face_width=5.0, coupling=coupling)
    )  # fmt: skip
    taken = np.full((4, 2, 2), 0.25)
    monkeypatch.setattr(moved_outlines, "_half_width", lambda *asked: width if asked == (e, state, member) else None)
    monkeypatch.setattr(moved_outlines, "_removed", lambda *asked: taken)
    state = SimpleNamespace(grid=SimpleNamespace(contacts=contacts), loads=loads)
    pairs = (-1, 0, 1, 3)
    found = moved_outlines.moved_outline(e, state, member, motion, 0.07, pairs)
    assert found.points == pytest.approx(2.0 * np.ones((2, 2)))
    assert found.pairs.tolist() == list(pairs)
    for p in range(3):
        for t, pair in enumerate(pairs):
            expected = np.array([0.25, 0.25])
            for row, other in enumerate(number.tolist()):
                k = forward * (pair - other)
                if abs(k) <= 1 and (coupling or k == 0):
                    own = moves(k, radius[row, p] / 2.0, width[row, p] / 2.0)
                    expected = expected + own * loads[row, p, 0] / 5.0 / 400.0
            assert found.displacement[p, t, :, 0] == pytest.approx(expected)
            assert found.displacement[p, t, :, 1] == pytest.approx(0.5 - expected)
    assert found.largest == pytest.approx(np.hypot(*np.moveaxis(found.displacement, 2, 0)).max())


# ---- unloaded contact ------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("hands", "errors"),
    [
        (("spur", "spur"), (6, 0, 0)), (("right", "left"), (-6, 2, 0)), (("right", "left"), (6, 0, 1)),
        (("left", "right"), (4, 4, 3)),
    ],
)  # fmt: skip
@pytest.mark.parametrize("widths", [(30e-3, 27e-3), (27e-3, 30e-3)])
def test_the_slope_of_the_transmission_error_is_that_of_its_differences_in_corners_too(hands, errors, widths):
    """Flanks, edges of tips and of faces, and corners of two of these."""
    gears = [
        helical_gear(teeth, 4e-3, math.radians(20.0), 0.0 if hand == "spur" else math.radians(15.0), width, hand)
        for teeth, width, hand in zip((23, 31), widths, hands, strict=True)
    ]
    pair = HelicalPair(*gears, Misalignment(*(math.pi / 10800.0 * one for one in errors), 0.0), 0.4, 0.0, 1e-3)
    low, high = pair.engagement
    step, angle = 1e-7, np.linspace(low - 0.3 * (high - low), high + 0.3 * (high - low), 61)
    found, after, before = (pair_contact(pair, angle + by) for by in (0.0, step, -step))
    alike = (after.bounds == found.bounds).all(axis=0) & (before.bounds == found.bounds).all(axis=0)
    alike &= np.isfinite(after.error) & np.isfinite(before.error)  # elsewhere these teeth do not touch
    assert (found.kind[alike] == "corner").sum() > 10
    difference = (after.error[alike] - before.error[alike]) / (2.0 * step)
    assert found.slope[alike] == pytest.approx(difference, abs=2e-8)
    assert np.abs(found.slope[found.kind == "corner"]).max() > 0.05
