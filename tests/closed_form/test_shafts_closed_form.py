"""Shafts against closed forms of beams: bending with shear, steps, cones, tension, twist; bearings in series."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import FegearError, InputError
from fegear.case.shaft import BearingPart
from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import LooseBearing, StiffBearing, stiff
from fegear.shafts.deflection import deflect
from fegear.shafts.held import Around, LoadedShaft, Seat
from fegear.shafts.life import LifeRating
from fegear.shafts.section import Section

E, NU, INF = 206e9, 0.3, math.inf
PIN, ROLLER = stiff(INF, INF), stiff(INF)


def _shaft(*sections):
    return Shaft(tuple(Section(*one) for one in sections), E, NU)


def _one(shaft, seats, at, *loads, name="shaft"):
    held = tuple(Seat(bearing, z) for bearing, z in seats)
    return deflect((LoadedShaft(shaft, held, np.atleast_1d(at).astype(float), np.array(loads, dtype=float), name),))[0]


def _bending(d, h=0.0):
    return E * math.pi / 64 * (d**4 - h**4)


def _shear(d, h=0.0):
    m = (h / d) ** 2
    kappa = 6 * (1 + NU) * (1 + m) ** 2 / ((7 + 6 * NU) * (1 + m) ** 2 + (20 + 12 * NU) * m)
    return kappa * E / (2 * (1 + NU)) * math.pi / 4 * (d * d - h * h)


@pytest.mark.parametrize("hole", [0.0, 0.02])
def test_a_simply_supported_shaft_with_a_force_between_its_bearings(hole):
    length, a, force = 0.4, 0.15, 3000.0
    found = _one(_shaft((length, 0.05, hole)), ((PIN, 0.0), (ROLLER, length)), a, (0, -force, 0, 0, 0, 0))
    b = length - a
    expected = -force * a**2 * b**2 / (3 * _bending(0.05, hole) * length) - force * a * b / length / _shear(0.05, hole)
    assert found.at(a)[0, 1] == pytest.approx(expected, rel=1e-11)
    assert found.bearing_forces[:, 1] == pytest.approx([force * b / length, force * a / length], rel=1e-12)
    assert found.balance.max() < 1e-12


def test_an_overhung_shaft():
    span, over, force = 0.3, 0.1, 2000.0
    found = _one(_shaft((span + over, 0.04)), ((PIN, 0.0), (ROLLER, span)), span + over, (force, 0, 0, 0, 0, 0))
    ei, shear = _bending(0.04), _shear(0.04)
    expected = force * over**2 * (span + over) / (3 * ei) + force * over / shear * (1 + over / span)
    assert found.at(span + over)[0, 0] == pytest.approx(expected, rel=1e-11)


def test_a_stepped_shaft_in_the_middle():
    half, d, thick, force = 0.2, 0.04, 0.06, 5000.0
    found = _one(
        _shaft((0.1, d), (0.2, thick), (0.1, d)), ((PIN, 0.0), (ROLLER, 2 * half)), half, (force, 0, 0, 0, 0, 0)
    )
    bent = (0.1**3 / _bending(d) + (half**3 - 0.1**3) / _bending(thick)) * force / 6
    shear = force / 2 * (0.1 / _shear(d) + 0.1 / _shear(thick))
    assert found.at(half)[0, 0] == pytest.approx(bent + shear, rel=1e-11)


def test_a_clamped_cone_is_the_integral_and_the_limit_of_fine_steps():
    length, d0, d1, force = 0.2, 0.06, 0.02, 800.0
    clamp = stiff(INF, INF, INF)
    cone = Shaft((Section(length, d0, 0.0, d1),), E, NU)
    found = _one(cone, ((clamp, 0.0),), length, (force, 0, 0, 0, 0, 0)).at(length)[0]
    # int (L-z)^2/(E I) dz of a solid cone: 64 L^3/(3 pi E d1 d0^3), free end of diameter d1.
    bent = 64 * force * length**3 / (3 * math.pi * E * d0**3 * d1)
    shear = force * length / _shear(1.0) / (d0 * d1)
    assert found[0] == pytest.approx(bent + shear, rel=1e-11)
    errors = []
    for count in (64, 128):
        middle = d0 + (d1 - d0) * (np.arange(count) + 0.5) / count
        steps = _shaft(*((length / count, float(d)) for d in middle))
        errors.append(_one(steps, ((clamp, 0.0),), length, (force, 0, 0, 0, 0, 0)).at(length)[0, 0] / found[0] - 1)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.01)
    assert abs(errors[1] + (errors[1] - errors[0]) / 3) < 1e-7


def test_a_bearing_with_ribs_locates_the_shaft_and_gives_way_as_one_without():
    floats, locates = (BearingPart.model_validate({"designation": f"{kind}207"}).build() for kind in ("NU", "NUP"))
    shaft, force = _shaft((0.4, 0.035)), (800.0, -3000.0, 700.0, 0, 0, 0)
    found = _one(shaft, ((locates, 0.02), (floats, 0.38)), 0.15, force)
    assert found.bearing_forces[:, 2] == pytest.approx([-700.0, 0.0], abs=1e-6)
    assert found.rings[0, 2] == 0.0
    fixed = stiff(0.0, INF)  # the force along the axis apart from the rollers
    other = _one(shaft, ((floats, 0.02), (floats, 0.38), (fixed, 0.02)), 0.15, force)
    np.testing.assert_allclose(found.bearing_forces[:, :2], other.bearing_forces[:2, :2], rtol=1e-9)
    np.testing.assert_allclose(found.rings[:, :2], other.rings[:2, :2], rtol=1e-9)
    assert not floats.rigid.any()
    with pytest.raises(InputError, match="axially"):
        _one(shaft, ((floats, 0.02), (floats, 0.38)), 0.15, force)


def test_tension_and_twist():
    clamp = stiff(INF, INF, INF)
    loads = [(0, 0, 700.0, 0, 0, -50.0), (0, 0, 0, 0, 0, 50.0)]
    found = _one(_shaft((0.3, 0.03, 0.01)), ((clamp, 0.0),), (0.3, 0.1), *loads).at(0.3)[0]
    area, polar = math.pi / 4 * (0.03**2 - 0.01**2), math.pi / 32 * (0.03**4 - 0.01**4)
    assert found[2] == pytest.approx(700 * 0.3 / (E * area), rel=1e-12)
    assert found[5] == pytest.approx(-50 * 0.2 / (E / 2.6 * polar), rel=1e-12)


def test_places_next_to_each_other_lose_no_digits():
    shaft = _shaft((0.4, 0.05))
    seats = ((PIN, 0.0), (ROLLER, 0.4))
    plain = _one(shaft, seats, 0.2, (1e3, 0, 0, 0, 0, 0)).at(0.2)[0, 0]
    close = _one(shaft, seats, (0.2, 0.2 + 1e-12), (500, 0, 0, 0, 0, 0), (500, 0, 0, 0, 0, 0)).at((0.2, 0.2 + 1e-12))
    assert close[:, 0] == pytest.approx(plain, rel=1e-10)


def test_stiffness_to_infinity_converges_with_order_one():
    shaft, load = Shaft((Section(0.4, 0.05),), INF), (1e3, 300, 200, 0, 0, 0)
    rigid = _one(shaft, ((PIN, 0.0), (ROLLER, 0.4)), 0.1, load)
    assert np.abs(rigid.at((0.0, 0.1, 0.4))).max() == 0.0
    moved = [_one(shaft, ((stiff(k, k), 0.0), (stiff(k), 0.4)), 0.1, load).at(0.1)[0, 0] for k in (1e8, 1e9, 1e20)]
    assert moved == pytest.approx([1e3 * (0.75**2 + 0.25**2) / k for k in (1e8, 1e9, 1e20)], rel=1e-10)


def test_a_clearance_is_passed_before_the_bearing_carries():
    k, c, force = 2e8, 30e-6, 1000.0
    bearing = LooseBearing(k, 1e8, 0.0, c, 10e-6)
    found = _one(
        Shaft((Section(0.2, 0.05),), INF),
        ((bearing, 0.0), (bearing, 0.2)),
        0.1,
        (0.6 * force, 0.8 * force, 500, 0, 0, 0),
    )
    across = c + force / 2 / k
    assert found.at(0.1)[0, :2] == pytest.approx([0.6 * across, 0.8 * across], rel=1e-9)
    assert found.at(0.1)[0, 2] == pytest.approx(10e-6 + 500 / 2e8, rel=1e-9)


@pytest.mark.parametrize("off", [0.0, 20e-6, 70e-6])
@pytest.mark.parametrize("clearance", [0.0, 30e-6])
def test_a_loose_bearing_pushes_back_by_what_is_beyond_its_clearance_and_its_stiffness_is_the_derivative(
    off, clearance
):
    k, axial, tilting = 2e8, 5e7, 3e4
    bearing = LooseBearing(k, axial, tilting, clearance, 10e-6)
    u = np.array([0.6 * off, -0.8 * off, -off, 1e-4, -2e-4])
    force, stiffness = bearing.reaction(u)
    beyond = max(off - clearance, 0.0)
    assert force == pytest.approx(
        [0.6 * k * beyond, -0.8 * k * beyond, -axial * max(off - 10e-6, 0.0), tilting * 1e-4, -tilting * 2e-4],
        rel=1e-12,
        abs=1e-9,
    )
    step = np.diag([1e-9, 1e-9, 1e-9, 1e-7, 1e-7])
    slopes = [(bearing.reaction(u + one)[0] - bearing.reaction(u - one)[0]) / (2 * one.sum()) for one in step]
    np.testing.assert_allclose(stiffness, np.array(slopes).T, rtol=1e-6, atol=1e-5 * k)
    assert np.diag(bearing.usual) == pytest.approx([k, k, axial, tilting, tilting])
    assert not bearing.rigid.any()


def test_a_bearing_carries_only_what_it_was_given_a_stiffness_for():
    np.testing.assert_array_equal(stiff(3.0).matrix, np.diag([3.0, 3.0, 0.0, 0.0, 0.0]))
    np.testing.assert_array_equal(LooseBearing(3.0).usual, stiff(3.0).matrix)
    np.testing.assert_array_equal(LooseBearing(3.0).reaction(np.array([0.0, 2.0, 5.0, 7.0, 9.0]))[0], [0, 6, 0, 0, 0])
    assert LooseBearing(1.0, 1.0).reaction(np.array([0, 0, 1e-9, 0, 0]))[0][2] == 1e-9  # no clearance unless given
    with pytest.raises(FegearError, match="axial_clearance"):
        LooseBearing(1.0, axial_clearance=-1e-9)
    with pytest.raises(FegearError, match="radial"):
        LooseBearing(math.inf)


def test_a_matrix_is_symmetric_and_takes_no_energy_but_for_round_off():
    def matrix(beside=0.0, tilt=3e4):
        found = np.diag([2e8, 2e8, 1e8, tilt, tilt])
        found[0, 4], found[4, 0] = 1e6, 1e6 * (1.0 + beside)
        return found

    StiffBearing(matrix(1e-12))
    StiffBearing(np.zeros((5, 5)))
    StiffBearing(matrix(tilt=1e12 / 2e8))  # 1e6^2 = 2e8 * 5e3: energy nil in one motion
    with pytest.raises(InputError, match="must be symmetric"):
        StiffBearing(matrix(1e-7))
    with pytest.raises(InputError, match="not positive semi-definite"):
        StiffBearing(matrix(tilt=0.99 * 1e12 / 2e8))


def test_a_torque_is_balanced_to_round_off():
    shaft, seats = _shaft((0.2, 0.05)), ((PIN, 0.0), (ROLLER, 0.2))
    for off, word in ((1e-11, ""), (1e-6, "is an unbalanced torque")):
        loads = (0, 0, 0, 0, 0, 500.0), (0, 0, 0, 0, 0, -500.0 * (1.0 + off))
        if not word:
            twist = _one(shaft, seats, [0.05, 0.15], *loads).at(0.2)[0, 5]
            assert twist == pytest.approx(-500.0 * 0.1 / (_bending(0.05) / (1 + NU)), rel=1e-9)
        else:
            with pytest.raises(InputError, match=word):
                _one(shaft, seats, [0.05, 0.15], *loads)


@pytest.mark.parametrize("length", [1e-3, 0.2, 30.0])
def test_what_is_loose_does_not_hang_on_the_size_of_the_shaft(length):
    """Two bearings hold a shaft of any length, and a short seat on one side does not hold its tilt."""
    shaft, load = _shaft((length, 0.2 * length)), (1.0, 0, 0, 0, 0, 0)
    soft = stiff(1e6 * length, 1e6 * length)
    found = _one(shaft, ((soft, 0.0), (stiff(1e6 * length), length)), 0.5 * length, load)
    assert found.bearing_forces[:, 0] == pytest.approx([-0.5, -0.5])
    assert _one(shaft, ((PIN, 0.0), (ROLLER, length)), 0.5 * length, load).bearing_forces[:, 0] == pytest.approx(
        [-0.5, -0.5]
    )
    with pytest.raises(InputError, match=r"1 in number.*in tilt about [xy]"):
        _one(shaft, ((soft, 0.3 * length),), 0.5 * length, load)


def test_housing_and_bearing_are_springs_in_series_and_seats_push_each_other():
    shaft = Shaft((Section(0.4, 0.05),), INF)
    held = LoadedShaft(
        shaft, (Seat(stiff(1e8, 1e8), 0.0), Seat(stiff(1e8), 0.4)), np.array([0.2]), np.array([[1e3, 0, 0, 0, 0, 0.0]])
    )
    housing = np.zeros((10, 10))
    housing[0, 0] = housing[5, 5] = 2e-9
    housing[0, 5] = housing[5, 0] = 1e-9
    assert deflect((held,), housing)[0].at(0.2)[0, 0] == pytest.approx(500 * (1e-8 + 2e-9 + 1e-9), rel=1e-12)


def test_a_matrix_couples_force_and_tilt():
    matrix = np.diag([2e8, 2e8, 1e8, 3e4, 3e4])
    matrix[0, 4] = matrix[4, 0] = 5e5
    found = _one(Shaft((Section(0.1, 0.05),), INF), ((StiffBearing(matrix), 0.0),), 0.1, (100, 0, 0, 0, 0, 0))
    assert found.left_end[[0, 4]] == pytest.approx(np.linalg.solve([[2e8, 5e5], [5e5, 3e4]], [100, 10.0]), rel=1e-10)


@pytest.mark.parametrize(
    ("seats", "at", "load", "word"),
    [
        ((), 0.1, (1, 0, 0, 0, 0, 0), "do not support the shaft"),
        (((PIN, 0.1),), 0.1, (1, 0, 0, 0, 0, 0), "in tilt"),
        (((ROLLER, 0.1), (ROLLER, 0.2)), 0.1, (1, 0, 0, 0, 0, 0), "axially"),
        (((PIN, 0.1), (ROLLER, 0.3)), 0.1, (1, 0, 0, 0, 0, 0), "is outside the shaft, 0 to"),
        (((PIN, 0.0), (ROLLER, 0.2)), 0.3, (1, 0, 0, 0, 0, 0), "is outside the shaft, 0 to"),
        (((PIN, 0.0), (ROLLER, 0.2)), 0.1, (0, 0, 0, 0, 0, 5.0), "is an unbalanced torque about the shaft axis"),
    ],
)
def test_what_does_not_hold_is_refused_in_one_sentence(seats, at, load, word):
    with pytest.raises(InputError, match=word):
        _one(_shaft((0.2, 0.05)), seats, at, load)


def test_shafts_without_sections_or_wall_are_refused():
    with pytest.raises(FegearError, match="specify no shaft"):
        Shaft(())
    with pytest.raises(FegearError, match="no wall"):
        Section(0.1, 0.05, 0.05)


def test_what_a_bearing_carries_is_told_column_by_column():
    """A hypotenuse of its own for radial force, shift and tilt; lives by radial and axial force."""
    shaft, bearing = _shaft((0.3, 0.04)), StiffBearing(np.diag([1e8, 2e8, 5e7, 2e4, 4e4]))
    held = LoadedShaft(
        shaft, (Seat(bearing, 0.03), Seat(bearing, 0.26)), np.array([0.11]),
        np.array([[3000.0, -1700.0, 900.0, 12.0, -31.0, 0.0]]),
    )  # fmt: skip
    found = deflect((held,))[0]
    rating = LifeRating(30e3, "ball", 0.56, 1.6, 0.05)
    told = found.bearing_loads((rating, None))
    np.testing.assert_array_equal(told.at, [0.03, 0.26])
    forces = np.column_stack([told.force_x, told.force_y, told.force_axial])
    np.testing.assert_array_equal(forces, found.bearing_forces[:, :3])
    assert len({*np.abs(forces).ravel()}) == 6
    np.testing.assert_allclose(told.force_radial**2, forces[:, 0] ** 2 + forces[:, 1] ** 2, rtol=1e-12)
    # moments about x and y through the left end, those of the bearings beside those of their forces
    assert 12.0 + 1700.0 * 0.11 + (told.moment_x - told.at * told.force_y).sum() == pytest.approx(0.0, abs=1e-9)
    assert -31.0 + 3000.0 * 0.11 + (told.moment_y + told.at * told.force_x).sum() == pytest.approx(0.0, abs=1e-9)
    assert np.abs([told.moment_x, told.moment_y]).min() > 1.0
    moved = found.at([0.03, 0.26])
    np.testing.assert_allclose(told.shift**2, moved[:, 0] ** 2 + moved[:, 1] ** 2, rtol=1e-9)
    np.testing.assert_allclose(told.tilt**2, moved[:, 3] ** 2 + moved[:, 4] ** 2, rtol=1e-9)
    assert told.life[0] == rating.revolutions(told.force_radial[0], forces[0, 2])
    assert told.life[0] != pytest.approx(rating.revolutions(told.force_radial[0], 0.0), rel=0.1)
    assert math.isnan(told.life[1])
    assert found.balance.max() < 1e-12
    # What is left over is said as a share of the largest force, and of the largest moment about the left end.
    more = held.loads + np.array([5.0, 0, 0, 0, 25.0, 0])
    moments = [0.03 * forces[0], 0.26 * forces[1], 0.11 * more[0, :3]]
    largest = max(np.abs(one[:2]).max() for one in moments)
    off = replace(found, loaded=replace(held, loads=more)).balance
    assert off[0] == pytest.approx(5.0 / 3005.0, rel=1e-9)
    assert off[1] == pytest.approx((25.0 + 0.11 * 5.0) / largest, rel=0.15)


def _sag(length, a, z, force, d, h):
    """Of a force at `a` on a shaft between rigid bearings at its ends, at z."""
    a, z = (a, z) if z <= a else (length - a, length - z)
    b = length - a
    bent = force * b * z * (length**2 - b**2 - z**2) / (6.0 * _bending(d, h) * length)
    return bent + force * b * z / length / _shear(d, h)


def test_a_shaft_on_bearings_within_another_one():
    """A shaft whose bearings both sit in a hollow one, and a sleeve that turns on a pin."""
    at, low, high, force, k = 0.25, 0.1, 0.3, 4e3, 2e8
    outer, inner = _shaft((0.4, 0.08, 0.05)), _shaft((0.4, 0.03))
    held, none = (Seat(PIN, 0.0), Seat(ROLLER, 0.4)), (np.empty(0), np.empty((0, 6)))
    loads = np.array([at]), np.array([[force, 0.0, 0.0, 0.0, 0.0, 0.0]])
    within = tuple(Seat(stiff(k, along), z, around=Around(0, z)) for z, along in ((low, INF), (high, 0.0)))
    first, second = deflect((LoadedShaft(outer, held, *none), LoadedShaft(inner, within, *loads)))
    share = force * (high - at) / (high - low), force * (at - low) / (high - low)
    assert -second.bearing_forces[:, 0] == pytest.approx(share, rel=1e-11)
    for z, one in zip((low, high), share, strict=True):
        expected = sum(_sag(0.4, a, z, f, 0.08, 0.05) for a, f in zip((low, high), share, strict=True))
        assert first.at(z)[0, 0] == pytest.approx(expected, rel=1e-11)
        assert second.at(z)[0, 0] == pytest.approx(expected + one / k, rel=1e-11)
    assert max(first.balance.max(), second.balance.max()) < 1e-12
    assert first.bearing_forces[:, 0].sum() == pytest.approx(-force, rel=1e-12)
    # The same two turned inside out: the sleeve carries the force and has no bearing of its own.
    on_pin = tuple(Seat(stiff(k, along), z, around=Around(1, z)) for z, along in ((low, INF), (high, 0.0)))
    pin, sleeve = deflect((LoadedShaft(inner, (*held, *on_pin), *none), LoadedShaft(outer, (), *loads)))
    assert pin.bearing_forces[2:, 0] == pytest.approx(share, rel=1e-11)
    for z, one in zip((low, high), share, strict=True):
        expected = sum(_sag(0.4, a, z, f, 0.03, 0.0) for a, f in zip((low, high), share, strict=True))
        assert sleeve.at(z)[0, 0] == pytest.approx(expected + one / k, rel=1e-11)
    assert max(pin.balance.max(), sleeve.balance.max()) < 1e-12


def test_shafts_that_hold_each_other_alone_are_refused():
    seats = Seat(PIN, 0.0, around=Around(1, 0.0)), Seat(ROLLER, 0.2, around=Around(1, 0.2))
    one = LoadedShaft(_shaft((0.2, 0.02)), seats, np.empty(0), np.empty((0, 6)), "one")
    other = LoadedShaft(_shaft((0.2, 0.06, 0.04)), (), np.empty(0), np.empty((0, 6)), "other")
    with pytest.raises(InputError, match="do not support the shaft"):
        deflect((one, other))
