"""Terms, signs and limits that matter for few gears only: each with a gear or a number for which it does."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.effects import MISALIGNMENT, RELIEF, SPACING_ERRORS
from fegear.base.errors import GeometryError, RangeError
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.many import corners
from fegear.contact.many.arrays import ManyEngagements, ManyFlanks
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.corner import corner_contact
from fegear.contact.rack.rack_contacts import RackContacts
from fegear.design.flanks.lead_correction import least_of_grid
from fegear.dynamics.train.torque_response import torque_response
from fegear.dynamics.train.train import Body, Damper, Shaft, Train
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import EllipseOnSpace
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import GearPair


# ---- contact ---------------------------------------------------------------------------------------------------------
def pair_of(kind):
    wheel = Gear(Tooth(43, profile_shift=-0.1), 2e-3, 0.02, 0.02)
    ring = Gear(InternalTooth(70, PinionCutter(25, 0.0, 1.25, math.nan, 0.2), tip_radius=34.3), 2e-3, 0.09, 0.02)
    pinion = Gear(Tooth(23, profile_shift=0.2), 2e-3, 0.01, 0.02)
    return {"external": GearPair(pinion, wheel), "ring driven": GearPair(pinion, ring),
            "ring drives": GearPair(ring, pinion)}[kind]  # fmt: skip


def packed(pair):
    """The pair's row of numbers, by which arrays of pairs know it."""
    two = (pair.driver, pair.driven)
    side = np.array([[1.0 if not gear.tooth.internal else -1.0] for gear in two])

    def each(of):
        return np.array([[of(gear)] for gear in two], dtype=float)

    def length(gear, radius):
        return gear.tooth.side * math.sqrt(radius**2 - gear.base_radius**2)

    flanks = ManyFlanks(
        np.zeros((2, 1, 3)), np.zeros((2, 1, 1)),
        each(lambda gear: length(gear, gear.form_radius)), each(lambda gear: length(gear, gear.involute_tip_radius)),
        each(lambda gear: gear.base_radius), np.zeros((2, 1)), np.ones((2, 1)),
    )  # fmt: skip
    assert (flanks.side == side).all()
    one = (np.array([value]) for value in (2e-3, pair.base_pitch, pair.centre_distance, 0.02))
    return ManyEngagements(flanks, *one).numbers[0]


@pytest.mark.parametrize("late", [True, False])
@pytest.mark.parametrize("kind", ["external", "ring driven", "ring drives"])
def test_a_tip_corner_of_many_pairs_goes_the_way_of_one_pair_s(monkeypatch, kind, late):
    """Gap, place and tilt beyond both ends of the path, of external and of internal pairs: two programs."""
    for name, function in list(vars(corners).items()):
        if callable(function):
            monkeypatch.setattr(corners, name, getattr(function, "py_func", function))
    pair = pair_of(kind)
    n, one, way = packed(pair), corner_contact(pair, "driver" if late else "driven"), np.zeros(4)
    corners.corner_way(n, late, way)
    assert way[corners.REACH] == pytest.approx(one.reach, rel=1e-6)
    beyond = one.reach * np.array([0.05, 0.3, 0.6, 0.9])
    expected = np.transpose(one.locate(beyond))
    found = np.array([corners.corner_at(u, way, corners.corner_of(n, late)) for u in beyond])
    assert (expected[:, 0] > 0.0).all()
    assert (expected[:, 2] > 1e-3).all()
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-12)
    assert corners.corner_at(1.01 * way[corners.REACH], way, corners.corner_of(n, late))[0] == math.inf


@pytest.mark.parametrize(("ratio", "count"), [(1.0, 1), (1.3, 2), (2.0, 2), (2.0 + 1e-14, 2), (2.0 + 1e-10, 3)])
def test_a_whole_contact_ratio_is_whole_whatever_its_last_digits(ratio, count):
    """Pairs between the ends of the path, and with corners one before and one after it."""
    pair = SimpleNamespace(contact_ratio=ratio)
    assert RackContacts(pair, corners=False).numbers.tolist() == list(range(count))
    assert RackContacts(pair).numbers.tolist() == list(range(-1, count + 1))


def flank(*has):
    given = dict.fromkeys(("relief", "over_face", "profiles", "wants_delta"), False)
    return SimpleNamespace(
        **given | dict.fromkeys(set(has) - {"spacing"}, True), spacing=np.zeros(int("spacing" in has))
    )


@pytest.mark.parametrize("wide", [False, True])
@pytest.mark.parametrize("turned", [1, -1])
def test_an_effect_has_something_to_count_if_either_flank_has(turned, wide):
    """Reliefs along the tooth as three things; what plane teeth say by Welbourn's Delta is no relief of wide ones."""

    def has(effect, *flanks, cutter=False, given=False):
        face = SimpleNamespace(cutter=cutter, errors=SimpleNamespace(given=given)) if wide else None
        return PairSpec.has_data(SimpleNamespace(both=flanks[::turned], wide=face), effect.name)

    plain = flank()
    assert not has(RELIEF, plain, plain)
    assert not has(SPACING_ERRORS, plain, plain)
    assert not has(MISALIGNMENT, plain, plain)
    for kind in ("relief", "over_face", "profiles"):
        assert has(RELIEF, plain, flank(kind))
        assert has(RELIEF, plain, flank(kind, "wants_delta")) is not wide
        assert has(RELIEF, flank("wants_delta"), flank(kind)) is not wide
    assert has(SPACING_ERRORS, plain, flank("spacing"))
    assert has(RELIEF, plain, plain, cutter=True) is wide
    assert has(MISALIGNMENT, plain, plain, given=True) is wide
    assert has(SimpleNamespace(name="friction"), plain, plain)


# ---- design and geometry ---------------------------------------------------------------------------------------------
@pytest.mark.parametrize("way", [(2, 1), (-1, 2), (2, 2), (-2, 0), (0, 2)])
def test_a_minimum_two_steps_away_is_found_where_all_neighbours_are_higher(way):
    """The floor of a valley askew; three steps away it would not be seen."""
    low = {(5, 5): 1.0, (5 + way[0], 5 + way[1]): 0.5}
    assert least_of_grid(lambda k, n: low.get((k, n), 2.0), (5, 5), 1) == (5 + way[0], 5 + way[1])
    far = {(5, 5): 1.0, (8, 5): 0.5}
    assert least_of_grid(lambda k, n: far.get((k, n), 2.0), (5, 5), 1) == (5, 5)


def test_a_fillet_has_some_depth():
    """A thousandth of a module at least, below the form circle and above the axis."""
    tooth = Tooth(28, profile_shift=0.2)
    form = tooth.form_radius
    for root in (form + 0.01, form, form - 0.9e-3):
        with pytest.raises(GeometryError, match="must be below the root form diameter") as problem:
            with_fillet(tooth, EllipseOnSpace(None, root))
        assert problem.value.key == "fillet.root_diameter"


# ---- dynamics --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("ends", [("a", "c"), ("c", "a")])
def test_a_damper_between_bodies_that_move_alike_does_not_bound_their_resonance(ends):
    """Two equal bodies on one shaft each of a third: in one mode they move alike, in the other against each other."""
    k, j, middle = 2e4, 3e-3, 5e-3
    train = Train(
        (Body("a", j), Body("b", middle), Body("c", j)), (Shaft("1", "b", "a", k), Shaft("2", "b", "c", k)),
        dampers=(Damper(*ends, 0.3),),
    )  # fmt: skip
    against, alike = math.sqrt(k / j), math.sqrt(k * (1.0 / j + 2.0 / middle))
    assert np.isfinite(torque_response(train, against, "b").shafts).all()
    with pytest.raises(RangeError, match="natural frequency of the undamped train"):
        torque_response(train, alike, "b")


# ---- measured traces -------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("scale", [0.0, 0.5, -2.0])
def test_samples_as_measured_are_divided_by_no_scale_of_zero(scale):
    """Samples and those that are left out alike; what is left of them is the scaled residual."""
    trace, computed, out = np.array([3e-6, 8e-6, 5e-6]), np.array([2e-6, 9e-6, 4e-6]), np.array([90e-6, -70e-6])
    by = scale or 1.0
    found = FittedCurve(
        fit=("scale",), errors={"drift": 3e-7}, outside=0, offset=1e-6, scale=scale, shift=0.1, gain=1.0,
        gain_error=0.0, angle=np.array([0.2, -0.1, 0.4]), measured=trace / by, computed=computed, left_out=out / by,
        wave=SimpleNamespace(place=-0.4, amplitude=2e-6, error=1e-7),
    )  # fmt: skip
    assert found.as_measured == pytest.approx(trace, rel=1e-15)
    assert found.left_out_as_measured == pytest.approx(out, rel=1e-15)
    assert found.drawn_angle.tolist() == [-0.1, 0.2, 0.4]
    assert found.fitted == pytest.approx(scale * computed[[1, 0, 2]])
    assert found.left_by_fit == pytest.approx(trace - scale * computed)
    if scale:
        assert found.left_by_fit == pytest.approx(scale * found.residual)
    assert (found.runout, found.runout_error, found.drift_error) == (2e-6, 1e-7, 3e-7)
    assert found.runout_angle == pytest.approx(-0.5)  # less the shift, between half a turn before and after
    assert found.runout_measured_angle == pytest.approx(2.0 * math.pi - 0.4)
