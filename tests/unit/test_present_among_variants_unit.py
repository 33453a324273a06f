"""Where a present design stands among sized variants: by counting, and in the units in which criteria are read."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.results.sizing import placed

CRITERIA = ("safety", "mass", "centre-distance")


def place(monkeypatch, costs, known, *, ratio=2.0, formulas=None, chosen=(), mask=False):
    """A design with these costs (larger is better of the first: negative) beside others."""
    known = np.array(known, dtype=float)
    monkeypatch.setattr(placed, "present_pair", lambda *_: "pairs")
    monkeypatch.setattr(placed, "reasons_of_rating", lambda *_: ((("flank", [mask]),), "margin"))
    monkeypatch.setattr(placed, "broken", lambda *_: (("undercut", [False]),))
    monkeypatch.setattr(placed, "_of_rounded_shifts", lambda limits: limits)
    by_formulas = np.array([costs if formulas is None else formulas], dtype=float)
    monkeypatch.setattr(placed, "costs_of", lambda *_: by_formulas)
    duty = SimpleNamespace(material=SimpleNamespace(density=7850.0))
    part = SimpleNamespace(present=None, ratio=2.0, ratio_tolerance=0.02)
    asked = SimpleNamespace(part=part, duty=duty, limits=None, by_formulas=CRITERIA, criteria=CRITERIA)
    own = SimpleNamespace(teeth_1=100, teeth_2=100 * ratio, costs=costs)
    lives = SimpleNamespace(criteria=known)
    return placed.placed_present(asked, own, chosen, lives, known)


def test_each_criterion_has_its_unit_its_best_and_how_many_are_better(monkeypatch):
    """Safeties 1.4 and 1.6 beside 1.5, masses 3 and 2 kg beside 2.5, distances 90 and 80 mm beside 100."""
    found = place(monkeypatch, (-1.5, 2.5, 0.1), [[-1.4, 3.0, 0.09], [-1.6, 2.0, 0.08]])
    safety, mass, distance = found.placed
    assert (safety.unit, mass.unit, distance.unit) == ("", "kg", "mm")
    own, best = ([getattr(one, key) for one in (safety, mass, distance)] for key in ("present", "best"))
    assert own == pytest.approx([1.5, 2.5, 100.0])
    assert best == pytest.approx([1.6, 2.0, 80.0])
    assert [(one.better, one.compared) for one in (safety, mass, distance)] == [(1, 2), (1, 2), (2, 2)]


@pytest.mark.parametrize(("known", "better"), [
    ([[-1.5, 2.5, 0.1]], 0), ([[-1.5, 2.5, 0.09]], 1), ([[-1.6, 2.6, 0.09]], 0), ([[-1.6, 2.4, 0.09]] * 3, 3),
])  # fmt: skip
def test_a_variant_dominates_where_it_is_nowhere_worse_and_somewhere_better(monkeypatch, known, better):
    chosen = [SimpleNamespace(costs=tuple(known[0]))]
    found = place(monkeypatch, (-1.5, 2.5, 0.1), known, chosen=chosen)
    assert found.dominating == better
    assert (found.better is chosen[0]) is bool(better)


def test_what_is_not_known_of_all_is_compared_by_formulas(monkeypatch):
    found = place(monkeypatch, (-1.5, math.nan, 0.1), [[-1.6, math.nan, 0.09], [-1.4, 2.0, 0.08]],
                  formulas=(-1.5, 2.5, 0.1))  # fmt: skip
    assert found.by_all is False
    mass = found.placed[1]
    assert (mass.better, mass.compared) == (1, 1)  # what is not known of the design is worse than all that are known
    assert mass.best == 2.0
    assert place(monkeypatch, (-1.5, 2.5, 0.1), [[-1.6, 2.6, 0.09]]).by_all is True


@pytest.mark.parametrize(
    ("ratio", "mask", "reasons"),
    [(2.0, False, ()), (2.0399, False, ()), (2.0401, False, ("ratio",)), (1.9599, True, ("ratio", "flank"))],
)
def test_a_design_off_its_ratio_or_limits_is_told_why(monkeypatch, ratio, mask, reasons):
    assert place(monkeypatch, (-1.5, 2.5, 0.1), [[-1.4, 3.0, 0.09]], ratio=ratio, mask=mask).reasons == reasons
