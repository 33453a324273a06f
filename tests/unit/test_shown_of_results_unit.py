"""What results show of numbers they are given: traces of gauges, variants as lines, spectra, loads over flanks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.curve_fit import NothingToCompareError
from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.part6_spectrum import Bin
from fegear.results.pair import placed_gauge
from fegear.results.pair.load_over_flanks import LoadOverFace, Stations
from fegear.results.rating import rating_sheet
from fegear.results.sizing.parallel_coordinates import parallel_coordinates

# ---- traces of gauges ------------------------------------------------------------------------------------------------
ANGLE, STRAIN = np.array([-0.2, 0.0, 0.3]), np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class Fitted:
    """A fit, and the trace that it was made of."""

    of: tuple[float, ...]
    step: float
    shift: float = 0.1
    turn_gains: object = None
    wave: object = None
    wave_less: bool = False
    jump: object = None
    hum: object = None


class _At:
    """A wave that is the same multiple of where it is looked at."""

    def __init__(self, size):
        self.size = size

    def at(self, x):
        return self.size * np.asarray(x)


@pytest.fixture
def trace(monkeypatch):
    found = Space(wave=None, jump=None, hum=None, seen=[])

    def fit_curve(angle, strain, computed_angle, computed, fit, step=7.0):
        assert computed_angle is ANGLE
        assert computed is STRAIN
        assert fit == ("shift",)
        np.testing.assert_array_equal(angle, [1.0, 2.0, 4.0])
        return Fitted(tuple(strain.tolist()), step, turn_gains=f"gains of {strain.tolist()}")

    def looked(name):
        def look(angle, strain, turns, *given):
            np.testing.assert_array_equal(angle, [1.0, 2.0, 4.0])
            np.testing.assert_array_equal(strain, [10.0, 20.0, 30.0])
            np.testing.assert_array_equal(turns, [0.1, 0.2, 0.4])
            found.seen.append((name, *given[:-1]))
            assert given[-1] is ANGLE
            return getattr(found, name)

        return look

    monkeypatch.setattr(placed_gauge, "fit_curve", fit_curve)
    monkeypatch.setattr(placed_gauge, "turns_along", lambda angle: 0.1 * angle)
    for name, key in (("wave", "once_per_turn"), ("jump", "zero_jump"), ("hum", "mains_hum")):
        monkeypatch.setattr(placed_gauge, key, looked(name))
    return found


def gauge_of(*, runout=False):
    angle, strain = np.array([1.0, 2.0, 4.0]), np.array([10.0, 20.0, 30.0])
    return Space(name="G", measured=Space(angle=angle, strain=strain, fit=("shift",), runout=runout, file="g.csv"))


def test_a_trace_is_fitted_as_it_is_where_nothing_disturbs_it(trace):
    assert placed_gauge.compared(Space(measured=None), ANGLE, STRAIN) is None
    found = placed_gauge.compared(gauge_of(runout=True), ANGLE, STRAIN, 12.0)
    assert found.of == (10.0, 20.0, 30.0)
    assert (found.wave, found.jump, found.hum, found.wave_less) == (None, None, None, True)
    assert trace.seen == [("wave", 0.1), ("jump", 0.1), ("hum", 12.0, 0.1)]


def test_runout_is_taken_off_where_the_case_says_so_and_hum_from_the_gains_of_turns_only(trace):
    trace.wave = _At(2.0)
    found = placed_gauge.compared(gauge_of(), ANGLE, STRAIN)
    assert (found.of, found.wave, found.wave_less) == ((10.0, 20.0, 30.0), trace.wave, False)
    found = placed_gauge.compared(gauge_of(runout=True), ANGLE, STRAIN)
    assert (found.of, found.step, found.wave_less) == ((8.0, 16.0, 22.0), 7.0, True)
    trace.jump, trace.hum = "jump", _At(10.0)
    found = placed_gauge.compared(gauge_of(runout=True), ANGLE, STRAIN)
    assert (found.of, found.jump, found.hum) == ((8.0, 16.0, 22.0), "jump", trace.hum)
    assert found.turn_gains == "gains of [9.0, 18.0, 26.0]"  # by turns, not by the angle


@pytest.mark.parametrize(("fit", "remedy"), [(("shift",), "check the unit"), (("scale",), r'set fit = \["shift"\]')])
def test_a_trace_elsewhere_is_refused_with_where_the_engagement_is(trace, monkeypatch, fit, remedy):
    def nothing(*_given):
        raise NothingToCompareError

    monkeypatch.setattr(placed_gauge, "fit_curve", nothing)
    gauge = gauge_of()
    gauge.measured.fit = fit
    with pytest.raises(InputError, match=rf"engagement, -11\.46 to 17\.19 deg.*{remedy}"):
        placed_gauge.compared(gauge, ANGLE, STRAIN)


# ---- variants as lines -----------------------------------------------------------------------------------------------
def variant(number, place, **given):
    usual = {"te": 2e-6, "mass": 3.0, "module": 2e-3, "teeth_1": 20, "helix_angle": 0.0, "shift_1": 0.1,
             "face_width": 0.02, "words": f"of {number}"}  # fmt: skip
    return Space(number=number, place=place, **usual | given)


def drawn(chosen, present=None):
    front = tuple(one for one in chosen if one.place)
    data = Space(chosen=tuple(chosen), front=front, present=None if present is None else Space(design=present))
    criteria = ("transmission-error", "mass", "unknown")
    return list(parallel_coordinates(Space(data=data, asked=Space(criteria=criteria))))


def test_variants_are_lines_from_the_least_to_the_largest_of_what_differs():
    chosen = [variant(1, 1, te=1e-6, mass=4.0), variant(2, 2, te=3e-6, mass=2.0), variant(3, 0, te=2e-6, mass=math.nan),
              variant(4, 0, te=5e-6, mass=2.5, teeth_1=24)]  # fmt: skip
    (figure,) = drawn(chosen, variant(0, 0, te=2e-6, mass=6.0))
    (panel,) = figure.panels
    ticks = panel.x.ticks
    assert [at for at, _ in ticks] == [0.0, 1.0, 2.0]
    assert [word for _, word in ticks] == ["TE, µm\n1 to\n5", "mass, kg\n2 to\n6", "z_1\n20 to\n24"]
    assert [one.name for one in panel.items] == ["compared", "compared", "Pareto front", "present design", "best"]
    assert [one.role for one in panel.items] == ["grey", "grey", "blue", "orange", "red"]
    assert [one.width for one in panel.items] == [1.0, 1.0, 1.0, 1.0, 2.6]
    wanted = [[0.25, math.nan, 0.0], [1.0, 0.125, 1.0], [0.5, 0.0, 0.0], [0.25, 1.0, 0.0], [0.0, 0.5, 0.0]]
    for one, shares in zip(panel.items, wanted, strict=True):
        np.testing.assert_allclose(one.y, shares)
        np.testing.assert_array_equal(one.x, [0.0, 1.0, 2.0])
        assert len(one.notes) == 3
    notes = [one.notes[0] for one in panel.items]
    assert notes == ["variant 3: of 3", "variant 4: of 4", "variant 2: of 2", "present: of 0", "variant 1: of 1"]


def test_lines_are_drawn_where_two_variants_differ_in_two_quantities():
    assert drawn([variant(1, 1)]) == []
    assert drawn([variant(1, 1), variant(2, 0)]) == []
    assert drawn([variant(1, 1), variant(2, 0, te=3e-6)]) == []
    assert len(drawn([variant(1, 1), variant(2, 0, te=3e-6, mass=4.0)])) == 1
    # differences that are round-off, and numbers known of one only, are none
    assert drawn([variant(1, 1, mass=math.nan), variant(2, 0, te=3e-6, module=2e-3 * (1.0 + 1e-10))]) == []


def test_of_many_variants_60_are_drawn_the_first_and_the_last_among_them():
    many = [variant(n, 0, te=n * 1e-6, mass=float(n)) for n in range(1, 122)]
    (figure,) = drawn([variant(200, 1, te=0.5e-6, mass=0.5), *many])
    numbers = [one.notes[0].split(":")[0] for one in figure.panels[0].items if one.name == "compared"]
    assert len(numbers) == 60
    assert (numbers[0], numbers[-1]) == ("variant 1", "variant 121")
    (figure,) = drawn([variant(200, 1, te=0.5e-6, mass=0.5), *many[:60]])
    assert len(figure.panels[0].items) == 61


# ---- spectra of ratings ----------------------------------------------------------------------------------------------
class _Rating(dict):
    """K factors by symbol."""

    def __init__(self, *values):
        super().__init__(zip(("K_v", "K_Hbeta", "K_Halpha"), (Space(value=one) for one in values), strict=True))


CURVE = Knots((1e4, 1e10), (1e9, 1e8))


def spectrum_of(*, computed, width="solid"):
    geometry = Space(diameters=(0.06, 0.15), turns=(1.0, 0.4))
    asked = Space(
        width=width, halves=2, levels=[Space(tangential=1000.0, speed=50.0, share=0.3),
                                       Space(tangential=500.0, speed=80.0, share=0.7)],
        of={"driver": 1, "driven": 0}.get, conditions=Space(geometry=geometry, duty=Space(cycles=(1e7, 2e7))),
    )  # fmt: skip

    def bins(stress):
        return Space(contact=[Bin(stress, 1e5, CURVE), Bin(1.1 * stress, 2e5, CURVE)], rating=_Rating(1.1, 1.2, 1.3),
                     bending=[Bin(0.5 * stress, 1e5, CURVE), Bin(0.6 * stress, 2e5, CURVE)])  # fmt: skip

    levels = [bins(3e8), bins(0.0)]
    levels[1].rating = None
    fe = [Space(rating=_Rating(2.1, 2.2, 2.3), contact=[Space(stress=1.0 + k), Space(stress=3.0 + k)],
                bending=[Space(stress=5.0 + k), Space(stress=7.0 + k)]) for k in range(2)]  # fmt: skip
    data = Space(spectrum=Space(levels=levels), spectrum_computed=Space(levels=fe) if computed else None)
    return data, asked


def test_levels_of_a_spectrum_have_the_torque_and_speed_of_the_driver():
    """The driver is the wheel of 150 mm here, and both halves carry."""
    for computed in (False, True):
        data, asked = spectrum_of(computed=computed)
        one, two = rating_sheet._levels(data, asked)
        assert (one.level, one.torque, one.speed, one.share) == (1, pytest.approx(150.0), 20.0, 0.3)
        assert (two.level, two.torque, two.speed, two.share) == (2, pytest.approx(75.0), 32.0, 0.7)
        assert (one.factors.K_v, one.factors.K_Hbeta, one.factors.K_Halpha) == (1.1, 1.2, 1.3)
        assert math.isnan(two.factors.K_v)
        wanted = (None, 2.2, 2.3) if computed else (None, None, None)
        assert (one.computed.K_v, one.computed.K_Hbeta, one.computed.K_Halpha) == wanted
    data, asked = spectrum_of(computed=True, width="plane")
    assert rating_sheet._levels(data, asked)[0].computed.K_Hbeta is None
    data.spectrum = None
    assert rating_sheet._levels(data, asked) == rating_sheet._levels_of_gear(data, asked, 0) == []


@pytest.mark.parametrize("i", [0, 1])
def test_levels_of_a_gear_have_its_own_stresses_and_damage(i):
    data, asked = spectrum_of(computed=True)
    one, two = rating_sheet._levels_of_gear(data, asked, i)
    flank, root = (3e8, 1.1 * 3e8)[i], (1.5e8, 0.6 * 3e8)[i]
    n = (1e5, 2e5)[i]
    assert (one.cycles, one.contact_stress, one.bending_stress) == pytest.approx((n, flank, root))
    damages = (n / (1e4 * (1e9 / flank) ** 6), n / (1e4 * (1e9 / root) ** 6))
    assert (one.contact_damage, one.bending_damage) == pytest.approx(damages)
    assert (one.contact_computed, one.bending_computed) == (1.0 + 2 * i, 5.0 + 2 * i)
    assert (two.contact_damage, two.contact_computed, two.bending_computed) == (0.0, 2.0 + 2 * i, 6.0 + 2 * i)
    data, asked = spectrum_of(computed=True, width="plane")
    one, _ = rating_sheet._levels_of_gear(data, asked, i)
    assert (one.contact_computed, one.bending_computed) == (None, 5.0 + 2 * i)
    data, asked = spectrum_of(computed=False)
    one, _ = rating_sheet._levels_of_gear(data, asked, i)
    assert (one.contact_computed, one.bending_computed) == (None, None)


@pytest.mark.parametrize("i", [0, 1])
def test_points_on_s_n_curves_are_the_loads_that_are_borne(monkeypatch, i):
    data, asked = spectrum_of(computed=False)
    data.curves = Space(contact=(CURVE, Knots((1e5, 1e9), (8e8, 2e8))), bending=(Knots((1e3, 3e6), (9e8, 3e8)), CURVE))
    data.formula = Space(contact_stress=(2e8, 3e8), bending_stress=(1e8, 1.5e8))
    data.by_computed = Space(contact_stress=(4e8, 5e8), bending_stress=(6e8, 7e8))
    monkeypatch.setattr(rating_sheet, "computed_flanks", lambda one: one.flanks)
    data.flanks = True
    flank, root = rating_sheet._strengths(data, asked, i)
    for one, curve in ((flank, data.curves.contact[i]), (root, data.curves.bending[i])):
        np.testing.assert_allclose(one.limit.cycles, [1e2, *curve.cycles, 1e11])
        np.testing.assert_allclose(one.limit.stress, [curve.values[0], *curve.values, curve.values[-1]])
        assert (one.what, one.computed) == ("spectrum", None)
    np.testing.assert_allclose(flank.loads.stress, [(3e8, 3.3e8)[i]])  # idle running is no load
    np.testing.assert_allclose(root.loads.stress, [(1.5e8, 1.8e8)[i]])
    np.testing.assert_allclose(root.loads.cycles, [(1e5, 2e5)[i]])
    data.spectrum = None
    flank, root = rating_sheet._strengths(data, asked, i)
    assert (flank.what, flank.loads.stress[0], root.loads.stress[0]) == ("load", (2e8, 3e8)[i], (1e8, 1.5e8)[i])
    assert (flank.computed.stress[0], root.computed.stress[0]) == ((4e8, 5e8)[i], (6e8, 7e8)[i])
    assert {float(one.cycles[0]) for one in (flank.loads, root.loads, flank.computed)} == {(1e7, 2e7)[i]}
    data.flanks = False
    assert rating_sheet._strengths(data, asked, i)[0].computed is None
    data.by_computed = None
    assert [one.computed for one in rating_sheet._strengths(data, asked, i)] == [None, None]


# ---- load over flanks ------------------------------------------------------------------------------------------------
def test_stations_are_those_that_lines_have_and_cells_lie_about_their_middles():
    present = np.array([[True, True, False], [True, False, False]])
    load = np.arange(12.0).reshape(2, 3, 2) - 3.0
    lines = Space(present=present, roll=np.array([0.1, 0.2]), z=np.arange(6.0).reshape(2, 3), low=np.array([7.0, 8.0]))
    known = Space(half_width=lambda w: 2.0 * w)
    found = Space(lines=lines, line_load=load, pressure=10.0 * load, known=known, load=np.array([5.0, 8.0]),
                  cells=np.array([-0.01, 0.0, 0.03]), over_face=np.array([[[1.0, 2.0], [9.0, 4.0]],
                                                                         [[3.0, 7.0], [5.0, 6.0]]]))  # fmt: skip
    one = Stations(found, 1)
    np.testing.assert_array_equal(one.position, [1, 1, 2])
    np.testing.assert_array_equal(one.line_load, [-2.0, 0.0, 4.0])
    np.testing.assert_array_equal(one.pressure, [-20.0, 0.0, 40.0])
    np.testing.assert_array_equal(one.half_width, [-4.0, 0.0, 8.0])
    np.testing.assert_array_equal(one.active, [0.0, 0.0, 1.0])
    np.testing.assert_array_equal(one.of_lines("low"), [7.0, 7.0, 8.0])
    np.testing.assert_array_equal(one.of_lines("z"), [0.0, 1.0, 3.0])
    over = LoadOverFace(found, 1)
    np.testing.assert_allclose(over.z, [-0.005, 0.015])
    np.testing.assert_array_equal(over.least, [2.0, 4.0])
    np.testing.assert_array_equal(over.largest, [7.0, 6.0])
    assert over.even == pytest.approx(200.0)
