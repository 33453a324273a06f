"""Regions that grow for compliances alone: which gears are solved, how many, and that the fit is theirs.

Compliances are made up: of products that a region has from the start, beside what the body turns by.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.atlas import refining
from fegear.atlas.domain import Domain
from fegear.atlas.family import Family, place_of
from fegear.atlas.finer import Finer, kept
from fegear.atlas.polynomials import products
from fegear.atlas.refining import refined
from fegear.atlas.shipped import shipped_atlas

FAMILY = Family()
DOMAIN, OTHER = Domain((24, 48), (0.1, 0.3)), Domain((30, 31), (0.2, 0.4))
DEGREES = np.array([[0, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]])
TRUE = np.array([[3.0, -1.0], [0.9, 0.2], [0.1, 0.7]])
REACH, SETTINGS = 1, "settings"


class Layout:
    """Two compliances and a stress behind them; a turn of the body is added to both compliances."""

    compliances = 2

    def turned(self, rows, by):
        rows[:, :2] += by[:, None]


class Made:
    """A cache that knows all gears of a domain."""

    def __init__(self, domains):
        self.domains, self.gears = list(domains), []

    def call_kept(self, codec, function, gear, settings, reach):
        assert (function, settings, reach) == (refining.compliances, SETTINGS, REACH)
        self.gears.append(gear)
        place = np.array(place_of(gear), dtype=float)[:, None]
        domain = next(one for one in self.domains if one.holds(FAMILY, place).all())
        known = products(DEGREES, domain.coordinates(FAMILY, place)) @ TRUE + FAMILY.turning(place)[:, None]
        return SimpleNamespace(value={"compliances": known[0]})


def of_domains(*domains):
    """An atlas whose rows are off by a tenth, in parts that its regions have in common."""
    atlas, known = shipped_atlas("A"), np.array([[1.0, 0.0, 5.0], [0.0, 1.0, 7.0]])
    pieces = tuple(replace(atlas.pieces[0], domain=one, degrees=DEGREES, coefficients=1.1 * TRUE) for one in domains)
    return SimpleNamespace(
        pieces=pieces, family=FAMILY, layout=Layout(), settings=SETTINGS, reach=REACH,
        common=SimpleNamespace(rows=known),
    )  # fmt: skip


@pytest.fixture(autouse=True)
def replaced(monkeypatch):
    monkeypatch.setattr(refining, "replace", lambda one, **new: SimpleNamespace(**{**vars(one), **new}))
    monkeypatch.setattr(refining, "_CANDIDATES", 40)


def grown(*domains):
    cache, told = Made(domains), []
    found = refined(of_domains(*domains), cache=cache, progress=lambda *how: told.append(how))
    return [one.finer for one in found.pieces], cache.gears, told


def test_compliances_are_those_of_the_gears_without_what_the_body_turns_by():
    (finer,), gears, told = grown(DOMAIN)
    at = np.random.default_rng(1).uniform(-1.0, 1.0, (4, 9)) * np.array([[1.0], [1.0], [0.0], [0.0]])
    np.testing.assert_allclose(finer.compliances(at), products(DEGREES, at) @ TRUE, atol=1e-12)
    # three products become 4 and 5, for which 10 and 11 gears are solved, none of them twice
    assert finer.degrees.shape == (5, 4)
    assert [tuple(one) for one in finer.degrees.tolist()][:3] == [tuple(one) for one in DEGREES.tolist()]
    assert told == [*((k, 10) for k in range(1, 11)), (11, 11)]
    assert len({tuple(place_of(one)) for one in gears}) == len(gears) == 11


def test_each_region_is_told_with_what_the_others_may_take_yet(monkeypatch):
    (first, second), _, told = grown(DOMAIN, OTHER)
    assert told[0] == (1, 10 + refining._MOST)
    assert told[10] == (11, 11 + refining._MOST)
    assert told[11] == (12, 21)
    assert told[-1][0] == told[-1][1] == len(told)
    # of two numbers of teeth nothing but a straight line is known
    assert first.degrees[:, 0].max() > 1
    assert second.degrees[:, 0].max() == 1
    monkeypatch.setattr(refining, "_HIGHEST", (1, 9, 0, 0))
    assert grown(DOMAIN)[0][0].degrees.max(axis=0).tolist() == [1, 2, 0, 0]


@pytest.mark.parametrize(
    ("name", "value", "products_of", "solved"),
    [
        ("_CANDIDATES", 0, 3, 0),  # its 9 corners and middles: fewer gears than the first round wants
        ("_CANDIDATES", 1, 4, 10),
        ("_MOST", 9, 3, 0),
        ("_MOST", 10, 4, 10),
        ("_HIGHEST", (1, 0, 4, 4), 3, 0),  # nothing left to grow along
        ("_ROUNDS", 1, 4, 10),
    ],
)
def test_a_region_that_cannot_grow_keeps_what_it_has(monkeypatch, name, value, products_of, solved):
    monkeypatch.setattr(refining, name, value)
    domain = replace(DOMAIN, shift=(0.2, 0.2)) if name == "_HIGHEST" else DOMAIN
    (finer,), gears, told = grown(domain)
    assert (len(finer.degrees), len(gears), len(told)) == (products_of, solved, solved)
    if not solved:
        np.testing.assert_array_equal(finer.coefficients, 1.1 * TRUE)
        np.testing.assert_array_equal(finer.degrees, DEGREES)


def test_a_file_keeps_few_common_rows_and_whole_steps_of_their_parts():
    """Of two regions whose compliances are sums of three rows, and of others a millionth as large."""
    chance = np.random.default_rng(3)
    rows = np.linalg.qr(chance.normal(size=(20, 3)))[0].T * np.array([[900.0], [20.0], [0.5]])
    regions = [
        Finer(
            chance.integers(0, 9, (count, 4)),
            chance.normal(size=(count, 3)) @ rows + 1e-7 * chance.normal(size=(count, 20)),
        )
        for count in (6, 9)
    ]
    found = kept(regions)
    assert found["finer"].shape == (3, 20)
    assert {one.dtype.name for name, one in found.items() if "degrees" not in name} == {"float32"}
    largest = max(np.abs(one.coefficients).max() for one in regions)
    for number, one in enumerate(regions):
        np.testing.assert_array_equal(found[f"finer_degrees_{number}"], one.degrees)
        parts = found[f"finer_parts_{number}"].astype(float)
        off = np.abs(parts @ found["finer"].astype(float) - one.coefficients).max()
        assert off < 4e-7 * largest
        steps = np.unique(np.abs(parts))
        step = 2.0 ** np.floor(np.log2(1e-7 * largest))
        assert not np.any(steps % step)
        assert np.any(steps % (2.0 * step))
    assert kept([]) == {}
    one = kept([Finer(np.zeros((1, 4), dtype=int), np.full((1, 20), 5.0))])
    assert one["finer"].shape == (1, 20)
