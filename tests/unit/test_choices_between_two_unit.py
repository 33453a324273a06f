"""Which of two things a line takes: which mesh, which end, which side of a limit; by values that differ."""

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import GeometryError, InputError
from fegear.base.printed import in_words
from fegear.contact.many import changes as many_changes
from fegear.contact.many.corners import PITCH, START
from fegear.contact.plane.edge_law import EdgeContacts
from fegear.dynamics.compound import assembly
from fegear.engine.processes import Job, opened
from fegear.fem.plane.ring_closure import close_ring
from fegear.formulas.agma import agma2101
from fegear.formulas.iso6336 import part2_pitting as pitting
from fegear.formulas.iso6336.rated import Strength
from fegear.geometry.balls_on_two_flanks import BallOnTwoFlanks
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.shaped_side import ShapedSide
from fegear.results.helical import drawn_rack_cutters
from fegear.results.pair import error_otherwise
from fegear.results.planetary import planet_load_sharing
from fegear.results.shafts.gearbox_overview import _designation
from fegear.results.train import dynamic_factor
from fegear.shafts.deflection import Deflection
from fegear.shafts.designations import envelope_of
from fegear.window import document


def summed(*given):
    return sum(one if isinstance(one, int) else 100 for one in given)


@pytest.mark.parametrize(("shares", "result"), [(False, 21), (True, 121)])
def test_a_job_computes_its_point_in_this_process_too_with_its_cache_or_without(shares, result):
    assert opened(Job(summed, shares, False, None)(21).payload) == result


@pytest.mark.parametrize(("given", "source"), [(None, "8"), (1.31, "given")])
def test_the_dynamic_factor_of_agma_says_whose_it_is(given, source):
    gear, wheel = (Gear(Tooth(z), 3e-3, 0.02, 0.03) for z in (21, 43))
    service = agma2101.Service(2000.0, 5.0, dynamic=given)
    allowed = (agma2101.allowable_stress("carburized", 2, 350.0),) * 2
    rating = agma2101.rate(GearPair(gear, wheel), service, allowed)
    assert rating.factor("K_v").clause.endswith(source)
    assert rating.factor("K_v").values[0] == (given or agma2101.dynamic_factor(5.0, 8))


def test_flanks_of_unknown_hardness_are_not_hardened():
    """Two through-hardened gears: Z_W = 1 of both, for any life, and a remark."""
    (group, *_) = pitting.groups.THROUGH_HARDENED
    known, unknown = Strength(group, 8e8, 3e8, hardness=250.0), Strength(group, 8e8, 3e8)
    pair = SimpleNamespace(relative_curvature_radius=0.02, signed_ratio=3.0)
    for strength in ((known, unknown), (unknown, known), (unknown, unknown)):
        reference, static, remark = pitting.work_hardening(pair, strength, (3e-6, 3e-6), 220e-6, 5.0)
        assert reference == static == (1.0, 1.0)
        assert "hardness of the gears not specified" in remark


@pytest.mark.parametrize(("reach", "sectors"), [(1, 2), (2, 4), (3, 6), (3, 29)])
def test_a_row_of_sectors_has_room_for_the_neighbours_on_both_sides(reach, sectors):
    with pytest.raises(InputError, match=f"must be between {2 * reach + 1} and 28"):
        close_ring(SimpleNamespace(teeth=28), None, None, reach, sector_teeth=sectors)


def test_the_mesh_with_the_highest_dynamic_factor_is_first():
    def rank(factor):
        seen = SimpleNamespace(data=SimpleNamespace(chart=object(), largest=SimpleNamespace(factor=factor)))
        return dynamic_factor._SHEET.answer.rank(seen)

    assert rank(2.7) < rank(1.4) < rank(1.1)


def test_a_bearing_has_its_own_designation_before_that_of_its_dimensions():
    ball = SimpleNamespace(kind="ball", bore=0.05, outside_diameter=0.11, width=0.027, given_angle=0.0)
    assert _designation(SimpleNamespace(designation="6310-2RS", printed=ball)) == "6310-2RS"
    assert _designation(SimpleNamespace(designation=None, printed=ball)) == "6310"
    assert _designation(SimpleNamespace(designation=None, printed=None)) == ""


@pytest.mark.parametrize("count", [1, 3, 5, 7, 9, 13])
def test_all_changes_of_one_cell_are_found_but_of_one_that_hovers(monkeypatch, count):
    """Two pairs whose nearness is known: beyond eight changes in a cell only the first and the last count."""
    first = 0.13 + 0.24 * (np.arange(count) + 0.5) / count  # between two samples, at 0.125 and 0.375
    second, at = 0.2603, [0.0]

    def solved(*given):
        at[0] = given[9]
        return 0.0, 1.0

    def nearness(n, load, numbers, error, state, c, v, out):
        out[0] = math.prod(math.sin(0.5 * (at[0] - place)) for place in first) * 1e2**count
        out[1] = at[0] - second

    for name, function in list(vars(many_changes).items()):
        monkeypatch.setattr(many_changes, name, getattr(function, "py_func", function))
    for name, function in (("solved", solved), ("nearness", nearness)):
        monkeypatch.setattr(many_changes, name, function)
    n = np.zeros(64)
    n[PITCH], n[START] = 1.0, 0.0
    found = np.full(40, math.nan)
    none = (None,) * 4
    known = many_changes.changes(n, None, *none, 1.0, 2, 0, 4, np.array([0.0]), 1, *none, found)
    wanted = np.sort([*first, second])
    assert found[:known] == pytest.approx(wanted if count < 8 else wanted[[0, -1]], abs=1e-5)


@pytest.mark.parametrize("count", range(16))
def test_counts_are_words_up_to_twelve(count):
    words = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"]
    assert in_words(count) == (words[count] if count <= 12 else str(count))


@pytest.mark.parametrize(("first", "second", "said"), [("p", "p", "planets of p"), ("p", "q", "planets of p and q")])
def test_planets_whose_tips_overlap_are_named(monkeypatch, first, second, said):
    monkeypatch.setattr(assembly, "clearances", lambda of: [
        assembly.Clearance("p", "q", -1.0, certain=False), assembly.Clearance(first, second, -2e-3, certain=True)
    ])  # fmt: skip
    with pytest.raises(GeometryError, match=f"{said}: interfere: tip circles overlap by 2 mm"):
        assembly.check_neighbours(None)


@pytest.mark.parametrize(("teeth", "mate"), [(20, 40), (20, 20), (19, 43)])
@pytest.mark.parametrize("of", ["own", "mate"])
def test_mesh_orders_are_of_the_mate_only_where_the_trace_has_them(teeth, mate, of):
    """Of teeth that go into each other no order tells which shaft it was: none is said to be the other's."""
    order = np.arange(1.0, 400.0)
    lines = np.zeros(order.size)
    for n, size in ((1, 3e-6), (2, 1e-6), (3, 0.4e-6)):
        lines[n * (teeth if of == "own" else mate) - 1] = size
    spectrum = SimpleNamespace(order=order, amplitude=lines + 1e-9, turns=3.0)
    found = error_otherwise.orders_of_mate(SimpleNamespace(spectrum=spectrum, teeth=teeth), mate)
    assert found is (of == "mate" and mate % teeth != 0)


@pytest.mark.parametrize(("centre", "said"), [(10.9, "root circle"), (11.1, ""), (14.2, "below the tip circle")])
def test_a_ball_touches_neither_the_root_circle_nor_lies_below_the_tips(centre, said):
    """A ball of diameter 2 in a space from radius 10 to 12.5: it stands out from 11.5 on."""
    tooth = SimpleNamespace(root_radius=10.0, tip_radius=12.5)
    side = SimpleNamespace(form_radius=10.1, involute_tip_radius=12.4)
    ball = SimpleNamespace(
        tooth=tooth, centre=centre if centre < 14.0 else 11.4, diameter=2.0, _sides=(side, side),
        roll_lengths=(3.0, 3.0), contact_radii=(11.0, 11.0),
    )  # fmt: skip
    assert said in BallOnTwoFlanks.trouble.fget(ball)


def test_contacts_beside_no_edge_have_no_part_of_it():
    none = EdgeContacts.none((2, 3))
    for root in (1e-3, 1.0, 30.0):
        psi, slope = none.law(np.full((2, 3), root))
        assert psi.tolist() == slope.tolist() == np.zeros((2, 3)).tolist()
    assert none.rise(np.ones((2, 3)), np.ones((2, 3)), np.ones((2, 3))) == pytest.approx(np.zeros((2, 3)))


def test_planets_that_lose_contact_on_either_side_are_named():
    lifted = np.array([[0.0, 0.2, 0.0, 0.05], [0.1, 0.0, 0.0, 0.3]])  # of the sun and of the ring
    seen = SimpleNamespace(data=SimpleNamespace(loads=SimpleNamespace(lifted=lifted)))
    said = planet_load_sharing._apart(seen)
    assert said == "planet 1 (10 % of the cycle), planet 2 (20 % of the cycle), planet 4 (30 % of the cycle)"


def test_the_smallest_radius_of_a_fillet_is_where_it_bends_most():
    bends = SimpleNamespace(start=0.0, end=1.0, curvatures=lambda u: -2.0 - 2.0 * np.sin(math.pi * u))
    assert ShapedSide.smallest_radius.fget(SimpleNamespace(fillet=bends)) == pytest.approx(0.25, rel=1e-3)


@pytest.mark.parametrize("part", range(6))
def test_what_is_out_of_balance_on_a_shaft_is_seen_in_every_direction(part):
    """Two equal and opposite loads at one place, of which one is a hundredth larger in one direction."""
    load = np.array([3.0, -2.0, 5.0, 7.0, 4.0, 6.0])
    other = -load
    other[part] *= 1.01
    force, moment = Deflection.balance.fget(SimpleNamespace(acting=(np.zeros(2), np.array([load, other]))))
    size = 0.01 * abs(load[part])
    assert force == pytest.approx(size / 5.05 if part == 2 else size / 5.0 if part < 3 else 0.0, abs=1e-12)
    assert moment == pytest.approx(size / 7.07 if part == 3 else size / 7.0 if part >= 3 else 0.0, abs=1e-12)


@pytest.mark.parametrize(("last", "bore"), [("00", 10), ("01", 12), ("02", 15), ("03", 17), ("04", 20), ("05", 25)])
def test_the_last_digits_of_a_designation_are_its_bore(last, bore):
    assert envelope_of(f"62{last}").bore == pytest.approx(bore * 1e-3)


def test_a_departure_of_a_rack_cutter_is_drawn_a_round_number_of_times_as_large():
    @dataclass(frozen=True)
    class Cutter:
        parabola: float
        gear: SimpleNamespace

    gear = SimpleNamespace(module=4e-3)
    places = np.array([-5e-3, 5e-3])  # the parabola departs by 25e-6 times its coefficient [m]
    drawn, words = drawn_rack_cutters._drawn(Cutter(0.2, gear), places, 0.1)  # 5 um; 80 of it are a tenth of the module
    assert (drawn.parabola, words) == (pytest.approx(0.2 * 50), " (deviation magnified 50 times)")
    assert drawn_rack_cutters._drawn(Cutter(9.0, gear), places, 0.1) == (Cutter(9.0, gear), "")
    assert drawn_rack_cutters._drawn(Cutter(0.0, gear), places, 0.1) == (Cutter(0.0, gear), "")


def test_of_long_texts_the_oldest_states_go_first(monkeypatch, tmp_path):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))
    monkeypatch.setattr(document, "_CHARACTERS", 5000)
    desk = document.Desk("# 0", "c", tmp_path)
    texts = [f"# {number}" + "x" * 1500 for number in range(1, 6)]
    for text in texts:
        desk.change(text)
    for text in texts[-2:-4:-1]:
        desk.undo()
        assert desk.text == text
    before = desk.text
    desk.undo()
    assert desk.text == before  # nothing older is kept
