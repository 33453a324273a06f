"""Branches of imports, ratings and forecasts that few cases take."""

from __future__ import annotations

from types import SimpleNamespace as Space

import pytest

from fegear.engine.table import Table
from fegear.exchange.rexs import shafts
from fegear.formulas.iso6336 import part6_spectrum
from fegear.formulas.iso6336.life import Knots
from fegear.results.pair import gauges_together
from fegear.results.rating import rated_methods


def test_a_table_without_rows_is_a_table_all_the_same():
    table = Table("name", (), "caption")
    assert (len(table), bool(table)) == (0, True)


# ---- torques on shafts of REXS ---------------------------------------------------------------------------------------
def coupled(monkeypatch, *loads, joints=()):
    """The coupling of loads (number, torque, transmits, defines, place)."""
    known = [Space(id=n, torque=t, transmits_torque=through, defines_torque=defines, at=at)
             for n, t, through, defines, at in loads]  # fmt: skip
    said = Space(
        linked=lambda *_links: known, number=lambda one, *_names: one.torque, needed=lambda one, *_names: one.at,
        yes=getattr, notes=[],
    )  # fmt: skip
    monkeypatch.setattr(shafts, "joints_of", lambda _said, _shaft: joints)
    return (*shafts.coupling_of(said, Space(said="shaft")), said.notes)


def test_the_torque_of_a_shaft_enters_where_the_model_leaves_it_open(monkeypatch):
    assert coupled(monkeypatch) == (None, frozenset(), [])
    assert coupled(monkeypatch, (1, 0.0, False, None, 0.1)) == (None, frozenset(), [])
    given, open_end = (1, 50.0, False, True, 0.1), (2, None, True, None, 0.3)
    assert coupled(monkeypatch, given) == (0.1, frozenset(), [])
    assert coupled(monkeypatch, given, open_end) == (0.3, frozenset({1}), [])
    # a torque that is transmitted and not defined balances, one that is defined does not
    assert coupled(monkeypatch, given, (2, 50.0, True, False, 0.3))[:2] == (0.3, frozenset({1}))
    assert coupled(monkeypatch, given, (2, 50.0, True, True, 0.3))[:2] == (0.1, frozenset({2}))
    assert coupled(monkeypatch, given, joints=(0.25,))[:2] == (0.25, frozenset({1}))
    # of two places that are open one takes all, and the other is named
    _, _, notes = coupled(monkeypatch, open_end, (3, None, True, None, 0.4), joints=(0.5,))
    assert notes == [
        f"shaft: torque input at {at} mm not specified; total torque assumed at 300 mm." for at in (400, 500)
    ]


# ---- methods of a rating ---------------------------------------------------------------------------------------------
def rating(k):
    names = ("contact_stress", "contact_safety", "bending_stress", "bending_safety", "contact_damage", "bending_damage")
    return Space(**{name: (k + 2 * n, k + 2 * n + 1) for n, name in enumerate(names)})


def found(**given):
    usual = {"formula": rating(0), "by_computed": None, "computed": None, "agma": None, "spectrum": None,
             "spectrum_computed": None, "curves": None}  # fmt: skip
    geometry = Space(members=("driven", "driver"), diameters=(0.06, 0.15))
    levels = [Space(tangential=1000.0, cycles=(1e6, 4e5)), Space(tangential=400.0, cycles=(1e7, 4e6))]
    asked = Space(conditions=Space(edition=2019, geometry=geometry), halves=2, levels=levels, of={"driver": 1}.get)
    return {method.name: (method, of) for method, of in rated_methods.methods(Space(**usual | given), asked)}


@pytest.mark.parametrize(("k_h_beta", "flanks"), [(1.2, True), (None, False)])
def test_every_method_has_its_own_numbers_and_what_is_not_computed_is_none(k_h_beta, flanks):
    computed = Space(replacement=Space(K_Hbeta=k_h_beta), bending_error=(0.01, 0.02), contact_error=0.03)
    agma = Space(contact=(1.0, 2.0), S_H=(3.0, 4.0), bending=(5.0, 6.0), S_F=(7.0, 8.0), members=("driver", "driven"))
    methods = found(by_computed=rating(100), computed=computed, agma=agma, spectrum_computed=rating(200))
    assert list(methods) == ["ISO 6336, edition 2019", "computed", "AGMA 2101-D04", "FE, spectrum"]
    assert methods["ISO 6336, edition 2019"][1] == {
        "contact_stress": (0, 1), "contact_safety": (2, 3), "bending_stress": (4, 5), "bending_safety": (6, 7)
    }  # fmt: skip
    of = methods["computed"][1]
    assert (of["bending_stress"], of["bending_safety"], of["bending_error"]) == ((104, 105), (106, 107), (0.01, 0.02))
    assert ("contact_stress" in of, of.get("contact_error")) == (flanks, (0.03, 0.03) if flanks else None)
    assert [method.estimated for method, _ in methods.values()] == [False, True, False, False]
    # AGMA names driver and driven, the others pinion and wheel, of which the first is driven here
    assert methods["AGMA 2101-D04"][1] == {
        "contact_stress": (2.0, 1.0), "contact_safety": (4.0, 3.0), "bending_stress": (6.0, 5.0),
        "bending_safety": (8.0, 7.0),
    }  # fmt: skip
    safeties = {"bending_safety": (206, 207)} | ({"contact_safety": (202, 203)} if flanks else {})
    assert methods["FE, spectrum"][1] == safeties


def test_equivalent_torques_are_of_the_driver_and_both_halves(monkeypatch):
    seen = []

    def equivalent(torque, cycles, exponent, limit):
        seen.append((torque.tolist(), cycles.tolist(), exponent, limit))
        return float(len(seen))

    monkeypatch.setattr(part6_spectrum, "equivalent_torque", equivalent)
    lines = [Knots((1e4, 10.0**n, 1e10), (1e9, 1e8, 9e7)) for n in (6, 7, 8, 9)]
    curves = Space(contact=lines[:2], bending=lines[2:])
    of = found(spectrum=rating(300), curves=curves)["ISO 6336, spectrum"][1]
    assert (of["contact_safety"], of["bending_damage"]) == ((302, 303), (310, 311))
    torques = [2 * 1000.0 * 0.075, 2 * 400.0 * 0.075]
    for n, (torque, cycles, exponent, limit) in enumerate(seen):
        assert torque == pytest.approx(torques)
        assert cycles == [[1e6, 1e7], [4e5, 4e6]][n % 2]
        assert exponent == pytest.approx((n + 2) * (0.5 if n < 2 else 1.0))  # decades of cycles to one of stress
        assert limit == pytest.approx(10.0 ** (n + 6))
    assert (of["contact_torque"], of["bending_torque"]) == ((1.0, 2.0), (3.0, 4.0))
    assert (of["contact_cycles"], of["bending_cycles"]) == ((1e6, 1e7), (1e8, 1e9))


# ---- gauges together -------------------------------------------------------------------------------------------------
def test_a_trace_belongs_to_the_other_fillet_where_that_alone_describes_it():
    def other(*changes, side="tension"):
        better = tuple(Space(changes=one) for one in changes)
        gauge = Space(pair="I", gear="a", tooth=3, side=side)
        return gauges_together._other_fillet(gauge, Space(otherwise=Space(better=better)))

    assert other(("curve",)) == ("I", "a", 3, "compression")
    assert other(("curve",), ("sign",), side="compression") == ("I", "a", 3, "tension")
    assert other() is other(("sign",), ("curve",)) is other(("curve", "sign")) is None
