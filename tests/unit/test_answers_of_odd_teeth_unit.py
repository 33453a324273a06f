"""Stiffness of odd teeth: where on the flank it is sampled, in which order teeth come, which neighbour is which."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.results.gear import odd_tooth_stiffness
from fegear.results.gear.odd_tooth_stiffness import _compute
from fegear.results.planetary.compound_modes import _remarks

BASE = 0.03


class Known:
    """A gear of 7 teeth meshed with 5 around its middle one (2); tooth 1 from it is cracked, -1 is missing."""

    middle, touched = 2, (-2, 0, 1)

    def __init__(self, low=0.031, high=0.039):
        self.gear = SimpleNamespace(involute_radii=(0.032, 0.038), base_radius=BASE, teeth=7)
        self.ordinary = SimpleNamespace(
            lowest_radius=low, highest_radius=high, reference_half_width=1e-4,
            self_compliance=lambda r, b: 2.0 + 0.0 * r,
            neighbour_with_error=lambda k, r, s: (np.diag(100.0 + k + r), np.diag(0.5 + 0.0 * r)),
        )  # fmt: skip
        self.fine = SimpleNamespace(missing={-1}, odd={}, closing=())
        self.known = {1, -2}

    def from_middle(self, number):
        return (number - self.middle + 3) % 7 - 3 if number >= 0 else number

    def own(self, number, r, b):
        return (4.0 if number == 3 else 2.5) + 0.0 * r

    def own_error(self, number, r, b):
        return 0.01 * number + 0.0 * r

    def ends(self, near):
        return 0.0, 0.0325  # no flank above it

    def between(self, there, number, seen, loaded):
        return 10.0 * there + number + 0.1 * np.add.outer(seen, loaded)

    def between_error(self, there, number, seen, loaded):
        return 0.2 + np.zeros((seen.size, loaded.size))


def asked(member):
    crack = SimpleNamespace()
    return SimpleNamespace(name="g", member=member, cracks=((3, crack),), by_number=lambda teeth: ())


@pytest.mark.parametrize("member", ["driver", "driven"])
@pytest.mark.parametrize(
    ("ends", "wanted"),
    [((0.031, 0.039), (0.032, 0.038)), ((0.033, 0.037), (0.033, 0.037)), ((0.033, 0.04), (0.033, 0.038))],
)
def test_odd_teeth_are_sampled_on_what_flank_and_solution_have_in_common(monkeypatch, member, ends, wanted):
    monkeypatch.setattr(odd_tooth_stiffness, "odd_solution_of", lambda upstream, name: Known(*ends))
    found = _compute(asked(member), {}, None)
    first, last = (np.sqrt((r / BASE) ** 2 - 1.0) for r in wanted)
    for one in found.teeth:
        steps = np.diff(one.roll_angle)
        np.testing.assert_allclose(steps, steps[0], rtol=1e-9)
        assert (one.roll_angle[0] - first, last - one.roll_angle[-1]) == pytest.approx(
            (0.02 * (last - first), 0.02 * (last - first))
        )
        np.testing.assert_allclose(one.radius, BASE * np.sqrt(1.0 + one.roll_angle**2))
        assert (one.contact_half_width == 1e-4).all()
        np.testing.assert_allclose(one.stiffness * one.c_self, 1.0)
        np.testing.assert_allclose(one.stiffness_loss, 1.0 - 2.0 / one.c_self)


@pytest.mark.parametrize(
    ("member", "order", "behind", "ahead"), [("driver", (4, 5, 0), 1, -1), ("driven", (0, 2, 3), -1, 1)]
)
def test_teeth_come_in_meshing_order_with_their_neighbours_in_it(monkeypatch, member, order, behind, ahead):
    known = Known()
    monkeypatch.setattr(odd_tooth_stiffness, "odd_solution_of", lambda upstream, name: known)
    found = _compute(asked(member), {}, None)
    numbers = {"driver": {0: 0, 2: 5, 3: 4}, "driven": {0: 0, 2: 2, 3: 3}}[member]
    assert tuple(one.number for one in found.teeth) == order
    by_number = {one.number: one for one in found.teeth}
    cracked = by_number[numbers[3] if member == "driven" else 4]
    assert [one.number for one in found.teeth if one.cracked] == [3] * (member == "driven")
    # Of the tooth beside the middle: its neighbours are the middle one, which is ordinary, and one that is, too.
    r = cracked.radius
    for k, column in ((behind, cracked.c_prev), (ahead, cracked.c_next)):
        np.testing.assert_allclose(column, 100.0 + k + r)
    middle = by_number[numbers[2]]
    for k, column in ((behind, middle.c_prev), (ahead, middle.c_next)):
        if k == -1:
            assert (column == 0.0).all()  # it is missing
        else:
            # Above its own flank it is seen at its end.
            np.testing.assert_allclose(column, 10.0 * 3 + 2 + 0.1 * (np.minimum(r, 0.0325) + r))
    assert (middle.c_next_error == 0.2).all()
    assert (cracked.c_next_error == 0.5).all()
    assert (cracked.c_self_error == 0.03).all()


@pytest.mark.parametrize(("member", "left"), [("driver", [4, 5]), ("driven", [2, 3])])
def test_teeth_that_are_missing_or_shorter_are_not_what_is_asked_for(monkeypatch, member, left):
    monkeypatch.setattr(odd_tooth_stiffness, "odd_solution_of", lambda upstream, name: Known())
    given = asked(member)
    given.by_number = lambda teeth: (0, 3 if member == "driven" else 4)  # a cracked one of them stays
    given.cracks = ((3, SimpleNamespace()),)
    assert [one.number for one in _compute(given, {}, None).teeth if one.number] == left


# ---- modes of compound sets ------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("counts", "carriers", "said"),
    [((2, 3), "cd", True), ((3, 3), "cd", False), ((3, 1), "cd", True), ((2, 2), "c", False)],
)
def test_modes_depend_on_the_angle_between_carriers_where_a_set_has_fewer_than_three_planets(counts, carriers, said):
    planets = [SimpleNamespace(name=f"p{n}", count=n) for n in counts]
    asked = SimpleNamespace(drive="sun", found=SimpleNamespace(planets=planets, carriers=lambda: iter(carriers)))
    seen = SimpleNamespace(
        asked=asked, name="P", data=SimpleNamespace(found=SimpleNamespace(kind=["mixed", "planet", "mixed"]))
    )
    sentences = list(_remarks(seen))
    assert sentences[0].startswith("Set P: 2 of type mixed, 1 of type planet; ")
    assert any("angle between carriers c, d" in one for one in sentences) == said
    asked.drive = None
    assert any("compound.P.input" in str(one) for one in _remarks(seen))
    assert len(list(_remarks(seen))) == len(sentences) + 1
