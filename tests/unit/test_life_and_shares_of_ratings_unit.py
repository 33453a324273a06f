"""Life, damage, power and load sharing of rated pairs: each as its definition has it, of a straight S-N curve."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace as Space

import pytest

from fegear.engine.stage import Task
from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.part6_spectrum import Bin
from fegear.results.rating import rated_life, rating_remarks, shared_load

#: 1000 MPa up to 1e4 load cycles, 100 MPa from 1e10 on: each sixfold of ten cycles a tenth of the strength.
CURVE = Knots((1e4, 1e10), (1e9, 1e8))


def cycles_of(stress: float) -> float:
    return 1e4 * (1e9 / stress) ** 6


def asked_of(**given) -> Space:
    duty = Space(speed=100.0, tangential=2000.0, cycles=(1e8, 4e7), meshes=(1, 3))
    geometry = Space(turns=(1.0, 0.4), pitch_line_velocity=lambda speed: 0.05 * speed)
    conditions = Space(duty=duty, geometry=geometry, required=(1.2, 1.5))
    usual = {"name": "I", "gears": ("a", "b"), "conditions": conditions, "halves": 1, "life": None, "given": (),
             "of": {"driver": 0, "driven": 1}.get}  # fmt: skip
    return Space(**usual | given)


def data_of(**given) -> Space:
    formula = Space(contact_stress=(2e8, 3e8), bending_stress=(1.5e8, 2.5e8), contact_safety=(1.3, 1.1),
                    bending_safety=(2.0, 1.8))  # fmt: skip
    usual = {"formula": formula, "curves": Space(contact=(CURVE, CURVE), bending=(CURVE, CURVE)), "spectrum": None}
    return Space(**usual | given)


def test_the_power_that_may_be_transmitted_follows_from_the_safeties():
    """Contact stress goes with the root of the load; both halves of a double helical pair transmit."""
    for halves in (1, 2):
        asked = asked_of(halves=halves)
        power = halves * 2000.0 * 0.05 * 100.0
        assert rated_life.power_of(asked) == pytest.approx(power)
        flank, root = rated_life.transmittable_power(data_of(), asked)
        assert flank == pytest.approx(power * (1.1 / 1.2) ** 2)
        assert root == pytest.approx(power * 1.8 / 1.5)
    spectrum = Space(contact_safety=(0.9, 1.0), bending_safety=(1.2, 1.4))
    flank, root = rated_life.transmittable_power(data_of(spectrum=spectrum), asked_of())
    assert (flank, root) == pytest.approx((1e4 * (0.9 / 1.2) ** 2, 1e4 * 1.2 / 1.5))


def test_a_life_ends_where_the_curve_meets_the_stress_at_the_required_safety():
    for member, i, turns, meshes in (("driver", 0, 1.0, 1), ("driven", 1, 0.4, 3)):
        rate = 100.0 * turns / (2.0 * math.pi) * meshes
        found = rated_life.service_life(data_of(), asked_of(), member)
        assert found.flank == pytest.approx(cycles_of((2e8, 3e8)[i] * 1.2) / rate)
        assert found.root == pytest.approx(cycles_of((1.5e8, 2.5e8)[i] * 1.5) / rate)
        damage = rated_life.nominal_damage(data_of(), asked_of(), member)
        cycles = (1e8, 4e7)[i]
        assert damage == pytest.approx((cycles / cycles_of((2e8, 3e8)[i]), cycles / cycles_of((1.5e8, 2.5e8)[i])))
    over = data_of(formula=Space(contact_stress=(1.1e9, 0.0), bending_stress=(0.5e8, 2e9)))
    assert rated_life.nominal_damage(over, asked_of(), "driver") == (math.inf, 0.0)
    assert rated_life.nominal_damage(over, asked_of(), "driven") == (0.0, math.inf)


def test_a_spectrum_ends_the_life_where_its_damage_at_the_required_safety_is_one():
    def level(stress, root, cycles):
        return Space(contact=[Bin(0.5 * stress, 1.0, CURVE), Bin(stress, cycles, CURVE)],
                     bending=[Bin(0.5 * root, 1.0, CURVE), Bin(root, cycles, CURVE)])  # fmt: skip

    spectrum = Space(levels=[level(3e8, 2e8, 1e5), level(2e8, 1.5e8, 1e6)])
    found = rated_life.service_life(data_of(spectrum=spectrum), asked_of(life=7200.0), "driven")
    wanted = [
        sum(n / cycles_of(s * safety) for s, n in zip(stresses, (1e5, 1e6), strict=True))
        for stresses, safety in (((3e8, 2e8), 1.2), ((2e8, 1.5e8), 1.5))
    ]
    assert (found.flank, found.root) == pytest.approx(tuple(7200.0 / one for one in wanted))
    found = rated_life.service_life(data_of(spectrum=spectrum), asked_of(), "driven")
    assert math.isnan(found.flank)
    assert math.isnan(found.root)
    idle = Space(levels=[level(0.0, 1e7, 1e6)])
    found = rated_life.service_life(data_of(spectrum=idle), asked_of(life=7200.0), "driven")
    assert (found.flank, found.root) == (math.inf, math.inf)


# ---- K_gamma ---------------------------------------------------------------------------------------------------------
@dataclass(frozen=True)
class _Duty:
    mesh_load_factor: float


@dataclass(frozen=True)
class _Conditions:
    duty: _Duty


@dataclass(frozen=True)
class _Service:
    overload: float


@dataclass(frozen=True)
class _Agma:
    service: _Service


@dataclass(frozen=True)
class _Asked:
    conditions: _Conditions
    name: str = "I"
    uneven: bool = False
    shares: str = ""
    stress_ratio: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class _Inputs:
    asked: _Asked
    agma: _Agma | None = None


@pytest.mark.parametrize(("factor", "taken"), [(1.3, 1.3), (0.9, 1.0)])
def test_the_largest_share_of_halves_or_planets_is_k_gamma_of_both_standards(factor, taken):
    asked = _Asked(_Conditions(_Duty(1.04)))
    upstream = {
        Task("double-helical", "I"): Space(load_factor=factor),
        Task("planet-load-sharing", "P"): Space(mesh_load_factor=factor),
    }
    assert shared_load.with_shares(asked, upstream) is asked
    for changed in ({"uneven": True}, {"shares": "P"}):
        one = replace(asked, **changed)
        assert shared_load.with_shares(one, upstream).conditions.duty.mesh_load_factor == taken
        found = shared_load.inputs_with_shares(_Inputs(one, _Agma(_Service(1.5))), upstream)
        assert found.asked.conditions.duty.mesh_load_factor == taken
        assert found.agma.service.overload == pytest.approx(1.5 * taken / 1.04)
        assert shared_load.inputs_with_shares(_Inputs(one), upstream).agma is None
    assert shared_load.inputs_with_shares(_Inputs(asked, _Agma(_Service(1.5))), upstream).agma.service.overload == 1.5


@pytest.mark.parametrize(("pair", "side"), [("P.sun", "sun"), ("P.ring", "ring")])
def test_only_planets_take_the_stress_ratio_of_their_own_side(monkeypatch, pair, side):
    monkeypatch.setattr(shared_load, "set_pair", lambda name, mesh: f"{name}.{mesh}")
    ratios = {"planet_sun_side": Space(ratio=-0.9), "planet_ring_side": Space(ratio=-1.4)}
    upstream = {Task("root-stress-history", pair): None, Task("planet-root-stress", "P"): Space(found=ratios)}
    asked = _Asked(_Conditions(_Duty(1.0)), name=pair, stress_ratio=(0.0, -1.2))
    found = shared_load.bent_ratio(asked, upstream)
    assert found == (0.0, ratios[f"planet_{side}_side"].ratio)
    asked = replace(asked, stress_ratio=(-1.2, 0.0))
    assert shared_load.bent_ratio(asked, upstream) == found[::-1]
    assert shared_load.bent_ratio(asked, {}) is None
    # annex B ends at -1.2
    assert shared_load.bent_so(asked, (-1.4, -1.0)).stress_ratio == (-1.2, -1.0)
    assert shared_load.bent_so(asked, (-1.0, -1.4)).stress_ratio == (-1.0, -1.2)
    told = shared_load.bending_said("I", (-1.4, 0.0), (0.7, 1.0))
    assert told == (
        "Pair I: Y_M of the FE rating is 0.7, 1 (pinion, wheel) with R = -1.4 of the planet from planet-root-stress, "
        "instead of -1.2; limited to R = -1.2 (annex B)."
    )
    assert "limited" not in shared_load.bending_said("I", (-1.2, 0.0), (0.7, 1.0))


def test_bending_of_planets_is_needed_where_it_can_be_taken(monkeypatch):
    monkeypatch.setattr(shared_load, "set_pair", lambda name, mesh: f"{name}.{mesh}")
    monkeypatch.setattr(shared_load, "set_of_pair", lambda _case, name: "P" if name.startswith("P") else None)

    def needed(name="P.sun", idler="driven", given=None, plane=("P.sun", "P.ring"), source="fe", other="fe"):
        operation = Space(idler=idler, mean_stress_factor=given)
        of = {"P.sun": source, "P.ring": other, "I": source}
        parts = {key: Space(operation=operation, root_stress=Space(source=(one, "fe"))) for key, one in of.items()}
        return shared_load.needs_bending(Space(case=Space(pair=parts), plane_pairs=plane), name)

    assert needed() == needed("P.ring") == (Task("planet-root-stress", "P"),)
    for without in ({"name": "I"}, {"idler": None}, {"given": 0.7}, {"plane": ("P.sun",)}, {"plane": ("P.ring",)},
                    {"source": "heywood"}, {"other": "heywood"}):  # fmt: skip
        assert needed(**without) == ()


# ---- what a reader must know first -----------------------------------------------------------------------------------
class _Rating:
    def __init__(self, k_v):
        self.k_v = k_v

    def __getitem__(self, symbol):
        assert symbol == "K_v"
        return Space(value=self.k_v)


def test_safeties_below_the_required_ones_are_said_with_their_load_margin():
    formula = _Rating(1.1)
    formula.contact_safety, formula.bending_safety = (1.2, 0.9), (1.4999, 1.5)
    told = rating_remarks.shortfalls(Space(spectrum=None, formula=formula), asked_of())
    assert [str(one) for one in told] == [
        "Pair I: S_F = 1.5 of gear a (driver) is below the minimum 1.5.",
        "Pair I: S_H = 0.9 of gear b (driven) is below the minimum 1.2.",
    ]
    assert rating_remarks._load_margin("S_H", 0.75) == pytest.approx(0.5625)
    assert rating_remarks._load_margin("S_F", 0.75) == 0.75


def test_a_spectrum_is_judged_by_its_own_safeties_and_its_largest_k_v():
    formula = _Rating(50.0)
    formula.contact_safety = formula.bending_safety = (0.1, 0.1)
    levels = [Space(rating=None), Space(rating=_Rating(10.0)), Space(rating=_Rating(2.0))]
    spectrum = Space(levels=levels, contact_damage=(0.5, math.inf), bending_damage=(math.inf, 2.0),
                     contact_safety=(1.2, 1.1), bending_safety=(1.5, 1.6))  # fmt: skip
    data = Space(spectrum=spectrum, formula=formula)
    told = [str(one) for one in rating_remarks.shortfalls(data, asked_of())]
    assert told == [
        "Pair I: flanks of gear b exceed the static strength at one level of the spectrum.",
        "Pair I: roots of gear a exceed the static strength at one level of the spectrum.",
        "Pair I: S_H = 1.1 of gear b (driven) under the load spectrum is below the minimum 1.2.",
    ]
    levels[1].rating = _Rating(10.1)
    assert "K_v = 10.1 of ISO 6336-1 is above 10" in str(rating_remarks.shortfalls(data, asked_of())[-1])
    assert len(rating_remarks.shortfalls(data, asked_of(given=("K_v",)))) == 3
    levels[:] = [Space(rating=None)]  # then that of the nominal load
    assert "K_v = 50 of" in str(rating_remarks.shortfalls(data, asked_of())[-1])
