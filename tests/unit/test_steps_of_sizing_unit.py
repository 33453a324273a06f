"""Steps of a sizing: who is estimated, who is verified, in which order, and what is said of each."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.design.sizing.feasible import BARE, RELIEVED, ROOT
from fegear.results.sizing import sizing


@dataclass(frozen=True)
class One:
    """A variant with what the steps look at."""

    number: int
    costs: tuple[float, ...] = ()
    place: int = 0
    te: float = math.nan
    te_relieved: float = math.nan
    root_stress: float = math.nan
    estimate: object = None
    relief: object = None
    verified: object = None
    verified_relieved: object = None
    on_bounds: tuple[str, ...] = ()

    @property
    def variant(self) -> str:
        return f"variant {self.number}"

    @property
    def relieved_variant(self) -> str:
        return f"relieved {self.number}"

    @property
    def estimated_by(self) -> str:
        return "" if self.estimate is None else self.estimate.by

    @property
    def te_estimated(self) -> float:
        return math.nan if self.estimate is None else self.estimate.te


def by(source: str, te: float = 1.0, reason: str = "") -> Space:
    return Space(by=source, te=te, reason=reason)


def asked_of(**given) -> Space:
    part = Space(present=None, verified_count=2, estimated=10, relieved=3, screened=4, verified_width="slices",
                 tolerance=0.01, tolerances=Space(states=((0.0, 0.0),)))  # fmt: skip
    of_part = given.keys() & part.__dict__.keys() - {"relieved"}
    part.__dict__.update({key: given[key] for key in of_part})
    rest = {key: value for key, value in given.items() if key not in of_part}
    usual = {"space": "space", "limits": "limits", "duty": "duty", "by_formulas": ("mass",), "atlas": "atlas",
             "criteria": (BARE,), "with_fe": True, "bare": True, "relieved": False, "asked": "asked",
             "folder": "folder"}  # fmt: skip
    return Space(part=part, **(usual | rest))


@pytest.fixture
def steps(monkeypatch):
    """Steps of `_compute` that note what they are asked; a verified variant has a hundred times its cost."""
    seen = Space(progress=[], verified=[], present=None, shares=[])
    lives = Space(count=50, numbers=np.arange(7), reasons={"undercut": 30, "pitting": 13})
    known = Space(costs=np.array([[1.0], [2.0], [math.nan]]), bare=Space(te=np.array([1.0, math.nan, 2.0])),
                  rows=np.arange(5))  # fmt: skip
    estimates = {4: by("atlas", reason="no"), 3: by("atlas"), 2: by("FE", math.nan), 1: by("FE")}
    chosen = [One(n, (float(n),), te=float(n), estimate=one) for n, one in estimates.items()]

    def sieve(space, limits, duty, by_formulas, progress):
        assert (space, limits, duty, by_formulas) == ("space", "limits", "duty", ("mass",))
        progress(1.0)
        return lives

    def estimated(space, found, criteria, atlas, counts, work, progress):
        assert (space, found, criteria, atlas, counts, work) == ("space", lives, (BARE,), "atlas", (10, 3), seen)
        progress(0.5)
        return known

    def in_order(criteria, ones):
        assert criteria == (BARE,)
        ones = sorted(ones, key=lambda one: one.costs)
        return [replace(one, place=k + 1 if k < 3 else 0) for k, one in enumerate(ones)]

    def verified(_asked, ones, _work):
        seen.verified = [one.number for one in ones]
        relieved = None if len(ones) % 2 else by("FE", reason="relief failed" * (ones[-1].number == 0))
        return [
            replace(one, te=100.0 * one.number, verified=by("FE", reason="failed" * (one.number == 1)),
                    verified_relieved=relieved) for one in ones
        ]  # fmt: skip

    def placed(_asked, own, ones, found, filled):
        assert found is lives
        seen.present = own, [one.number for one in ones], filled
        return "placed"

    work = seen
    work.progress = lambda to: seen.shares.append(to)
    for name, step in {
        "sieve": sieve, "estimated": estimated, "_chosen": lambda *_: chosen, "in_order": in_order,
        "_present": lambda _asked: One(0, (9.0,), estimate=by("atlas")), "_verified": verified,
        "_screened": lambda _asked, ones, own, _work: (ones, own), "placed_present": placed,
        "with_shown": lambda costs, _ones, _lives: np.append(costs, [[0.5]], axis=0),
    }.items():  # fmt: skip
        monkeypatch.setattr(sizing, name, step)
    return seen


def test_the_best_are_verified_and_put_in_order_again(steps):
    asked = asked_of()
    found = sizing._compute(asked, {}, steps)
    assert steps.verified == [1, 2]
    assert steps.shares == pytest.approx([0.1, 0.3])  # a tenth until enumerated, half until looked up
    # with verified numbers the first two are at 100 and 200: the others are ahead now
    assert [one.number for one in found.chosen] == [3, 4, 1, 2]
    assert [one.place for one in found.chosen] == [1, 2, 3, 0]
    assert [one.costs for one in found.chosen] == [(3.0,), (4.0,), (100.0,), (200.0,)]
    assert (found.count, found.feasible, found.on_front) == (50, 7, 1)  # 0.5 is the front of one criterion
    assert (found.known, found.by_atlas, found.relieved) == (2 + 1, True, 5)  # one of two FE estimates has a number
    assert [(one.reason, one.variants) for one in found.reasons] == [("undercut", 30), ("pitting", 13)]
    assert found.failed == ((4, "no"), (1, "failed"))
    assert (found.present, steps.present) == (None, None)


def test_the_present_design_is_verified_with_the_best_and_placed_with_its_own_costs(steps):
    found = sizing._compute(asked_of(present="present"), {}, steps)
    assert steps.verified == [1, 2, 0]
    assert found.present == "placed"
    own, order, filled = steps.present
    assert (own.number, own.te, own.costs) == (0, 0.0, (0.0,))
    assert order == [3, 4, 1, 2]
    assert filled.shape == (5, 1)  # once before verification, once after
    assert 0 not in [one.number for one in found.chosen]
    # an even number of them fails with its relief, too
    found = sizing._compute(asked_of(present="present", verified_count=1), {}, steps)
    assert found.failed == ((4, "no"), (1, "failed"), (1, "relief failed"), (0, "relief failed"))


def test_without_finite_elements_costs_stay_and_all_the_time_is_the_enumeration_s(steps):
    asked = asked_of(present="present", with_fe=False, verified_count=0)
    found = sizing._compute(asked, {}, steps)
    assert steps.verified == []
    assert steps.shares == pytest.approx([1.0, 0.3])
    assert [one.costs for one in found.chosen] == [(1.0,), (2.0,), (3.0,), (4.0,)]
    assert steps.present[0].costs == (9.0,)
    asked.part.verified_count = 2
    found = sizing._compute(asked, {}, steps)
    assert steps.shares[2:] == pytest.approx([0.1, 0.3])
    assert [(one.number, one.costs) for one in found.chosen] == [(n, (float(n),)) for n in (1, 2, 3, 4)]
    assert [one.verified is not None for one in found.chosen] == [True, True, False, False]


def test_where_nothing_is_chosen_the_front_is_that_of_what_is_known(steps, monkeypatch):
    monkeypatch.setattr(sizing, "_chosen", lambda *_: [])
    monkeypatch.setattr(sizing, "with_shown", lambda *_: pytest.fail("nothing is shown"))
    found = sizing._compute(asked_of(), {}, steps)
    assert (found.on_front, found.chosen, steps.verified) == (1, (), [])


def test_costs_by_finite_elements_take_the_place_of_those_by_formulas():
    one = One(1, (1.0, 2.0, 3.0, 4.0), te=10.0, te_relieved=20.0, root_stress=30.0)
    asked = Space(criteria=(ROOT, "mass", BARE, RELIEVED))
    assert sizing._costs(asked, one) == (30.0, 2.0, 10.0, 20.0)


def test_only_those_without_an_estimate_are_screened(monkeypatch):
    jobs = []

    def fe(_asked, variants, _work, span, verified=None):
        jobs.append((list(variants), span, verified))
        return tuple(by("FE", float(n)) for n, _ in enumerate(variants))

    monkeypatch.setattr(sizing, "_fe", fe)
    ones = [One(3, (math.nan, 5.0), te=7.0), One(2, (math.nan, 6.0), te=8.0, estimate=by("atlas"))]
    own = One(0, (math.nan, 4.0), te=9.0)
    asked = asked_of(criteria=(BARE, "mass"))
    found, present = sizing._screened(asked, ones, own, "work")
    assert jobs == [(["variant 3", "variant 0"], (0.5, 0.7), None)]
    assert [one.estimate.by for one in found] == ["FE", "atlas"]
    assert [one.estimate.te for one in found] == [0.0, 1.0]
    assert (present.number, present.estimate.te) == (0, 1.0)
    assert [one.costs for one in (*found, present)] == [(7.0, 5.0), (8.0, 6.0), (9.0, 4.0)]
    found, present = sizing._screened(asked, ones[1:], None, "work")
    assert len(jobs) == 1
    assert (present, [one.costs for one in found]) == (None, [(8.0, 6.0)])
    for asked in (asked_of(with_fe=False), asked_of(relieved=True)):
        assert sizing._screened(asked, ones, own, "work") == (ones, own)


@pytest.mark.parametrize(("bare", "relieved"), [(True, False), (False, True), (True, True)])
def test_unmodified_and_relieved_variants_are_verified_as_the_criteria_want(monkeypatch, bare, relieved):
    jobs = []

    def fe(_asked, variants, work, span, verified):
        jobs.append((list(variants), work, span, verified))
        return tuple(variants)

    monkeypatch.setattr(sizing, "_fe", fe)
    ones = [One(1, relief="short"), One(2), One(3, relief="long")]
    asked = asked_of(bare=bare, relieved=relieved)
    found = sizing._verified(asked, ones, "work")
    wanted = [f"variant {n}" for n in (1, 2, 3)] * bare + ["relieved 1", "relieved 3"] * relieved
    assert jobs == [(wanted, "work", (0.7, 1.0), ("slices", 0.01))]
    assert [one.verified for one in found] == [f"variant {n}" if bare else None for n in (1, 2, 3)]
    assert [one.verified_relieved for one in found] == [
        "relieved 1" if relieved else None, None, "relieved 3" if relieved else None
    ]  # fmt: skip


def test_screened_variants_are_shown_besides_where_no_relief_is_asked_for(monkeypatch):
    shown = []

    def shown_rows(costs, known, count, *, compared):
        shown.append((costs, known, count, compared))
        return np.array([4, 1])

    monkeypatch.setattr(sizing, "shown_rows", shown_rows)
    monkeypatch.setattr(sizing, "screened_rows", lambda *given: np.array([2, 4]) if given[-1] == 4 else None)
    monkeypatch.setattr(sizing, "_one_of_lives", lambda _asked, _lives, _known, row: row)
    known = Space(costs="costs", known="known")
    for given, rows, count in (
        ({}, [1, 2, 4], 2), ({"screened": 0}, [1, 4], 2), ({"with_fe": False}, [1, 4], 2),
        ({"verified_count": 0}, [1, 2, 4], 1),
    ):  # fmt: skip
        asked = asked_of(**given)
        assert sizing._chosen(asked, "lives", known) == rows
        assert shown[-1] == ("costs", "known", count, asked.with_fe)
    assert sizing._chosen(asked_of(relieved=True), "lives", known) == [1, 4]


def test_a_variant_that_is_shown_has_its_number_its_estimate_and_the_ends_it_lies_at(monkeypatch):
    monkeypatch.setattr(
        sizing, "_sized", lambda _asked, number, pairs: One(number, (math.nan, 3.0), on_bounds=(pairs,), te=5.0)
    )
    lives = Space(numbers=np.array([11, 17, 23]))
    known = Space(estimate="estimate {}".format, relief="relief {}".format, at_limit=lambda row: (f"limit {row}",))
    space = Space(pairs=lambda numbers: f"pairs {numbers.tolist()}")
    asked = asked_of(criteria=(BARE, "mass"), space=space)
    found = sizing._one_of_lives(asked, lives, known, 1)
    assert (found.number, found.estimate, found.relief) == (17, "estimate 1", "relief 1")
    assert found.on_bounds == ("pairs [17]", "limit 1")
    assert found.costs == (5.0, 3.0)
    asked.with_fe = False
    assert math.isnan(sizing._one_of_lives(asked, lives, known, 1).costs[0])


def test_the_present_design_is_looked_up_where_there_is_an_atlas(monkeypatch):
    monkeypatch.setattr(sizing, "present_pair", lambda part, present: (part, present))
    monkeypatch.setattr(sizing, "_sized", lambda _asked, number, _pairs: One(number or 0, (math.nan, 3.0), te=6.0))
    monkeypatch.setattr(sizing, "of_one", lambda pairs, atlas, relieved: (f"{pairs[1]} {atlas}", f"{relieved}"))
    asked = asked_of(present="present", criteria=(BARE, "mass"))
    found = sizing._present(asked)
    assert (found.number, found.estimate, found.relief, found.costs) == (0, "present atlas", "False", (6.0, 3.0))
    asked.atlas = None
    found = sizing._present(asked)
    assert (found.estimate, found.relief) == (None, None)
    assert math.isnan(found.costs[0])
