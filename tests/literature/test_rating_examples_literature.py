"""Published ratings by ISO 6336: every printed factor against fegear's, as docs/rating-examples.md shows them."""

import importlib.util
from dataclasses import replace
from pathlib import Path

import pytest

from fegear.formulas.iso6336.safety import rate_pair
from fegear.verify import iso6336_examples as rows
from fegear.verify.kept import examples

DOCS = Path(__file__).parents[2] / "docs"


def _page():
    spec = importlib.util.spec_from_file_location("rating_rows", DOCS / "rating_rows.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", examples())
def test_every_printed_factor_holds_or_has_its_reason(name):
    assert rows.faults(name, examples()[name]) == []


@pytest.mark.parametrize("name", examples())
def test_a_factor_that_is_off_is_found(name):
    example = examples()[name]
    printed = example["printed"] | {"Z_H": {"values": ["2.99"]}}
    assert any("Z_H is off without a reason" in f for f in rows.faults(name, example | {"printed": printed}))


def test_the_page_shows_what_is_computed():
    page = _page()
    assert page.page() == page.PAGE.read_text("utf-8"), "run: python docs/rating_rows.py"


def test_reasons_of_the_third_stage():
    # with the depth of the tooth as cut (mean root diameters printed, 319.266/319.101 and 1333.592/1333.318 mm) the
    # report's K_Fbeta comes out
    asked, given = rows.conditions(examples()["kisssoft_stage_3"])
    cut = [replace(g, root_diameter=d) for g, d in zip(asked.geometry.gears, (0.3191835, 1.333455), strict=True)]
    rated = rate_pair(replace(asked, geometry=replace(asked.geometry, gears=tuple(cut))), given)
    assert rated["K_Fbeta"].value == pytest.approx(1.136, abs=5e-4)


@pytest.mark.parametrize(
    ("name", "roots", "printed"),
    [
        ("kisssoft_stage_1", (0.724101, 0.797439), (168.90, 175.90)),
        ("kisssoft_stage_2", (0.3413985, 0.724072), (209.38, 210.14)),
    ],
)
def test_reasons_of_the_planetary_stages(name, roots, printed):
    # the depth of the tooth as cut, from the mean of the printed manufactured root diameters
    asked, given = rows.conditions(examples()[name])
    cut = [replace(g, root_diameter=d) for g, d in zip(asked.geometry.gears, roots, strict=True)]
    rated = rate_pair(replace(asked, geometry=replace(asked.geometry, gears=tuple(cut))), given)
    for found, known in zip(rated.bending_stress, printed, strict=True):
        assert found / 1e6 == pytest.approx(known, abs=0.01)  # the last digit; profile shifts are printed to 5e-5
