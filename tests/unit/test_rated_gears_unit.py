"""Helical pairs compared with ISO 6336 through their virtual spur teeth: which number goes where; formulas made up."""

import math
from types import SimpleNamespace

import pytest

from fegear.base.errors import RangeError
from fegear.contact.compared import rated_gears
from fegear.contact.compared.rated_gears import HelicalCheck, rated_helical_pair

OF_VIRTUAL = {"a": 0.9, "b": 0.8}


def gear(name, module):
    return SimpleNamespace(
        name=name, module=module, helix_angle=0.3, normal_pressure_angle=math.radians(20.0 if name == "a" else 25.0)
    )


@pytest.fixture
def pair(monkeypatch):
    rated = SimpleNamespace(refused=())
    monkeypatch.setattr(rated_gears.rating, "virtual_contact_ratio", lambda one, ratio: ratio * OF_VIRTUAL[one.name])

    def rate(one, load, choice, rim):
        if one.name in rated.refused:
            raise RangeError("rim", rim, "is too thin")
        assert (load.specific_load, load.overlap_ratio, load.helix_angle) == (400e3, 1.3, 0.3)
        assert load.contact_ratio == 1.6 * OF_VIRTUAL[one.name]
        assert (choice, rim) == ("choice", {"a": None, "b": 0.01}[one.name])
        form = SimpleNamespace(Y_F={"a": 1.5, "b": 1.2}[one.name], Y_S=2.0)
        return SimpleNamespace(form=form, load_diameter={"a": 20.0, "b": 40.0}[one.name])

    def fem(one, diameter, settings, cache):
        assert (settings, cache) == ("settings", "cache")
        assert diameter == {"a": 20.0, "b": 40.0}[one.name]
        return SimpleNamespace(tension={"a": 3.0, "b": 2.5}[one.name], compression=-99.0)

    monkeypatch.setattr(rated_gears.rating, "rate_helical", rate)
    monkeypatch.setattr(rated_gears, "virtual_root_stress", fem)
    monkeypatch.setattr(rated_gears, "pair_stiffness", lambda known, *, specific_load: (known, specific_load))
    known = SimpleNamespace(driver=gear("a", 2e-3), driven=gear("b", 4e-3), contact_ratio=1.6)
    return known, rated


def test_each_gear_is_rated_by_its_own_numbers_and_the_stiffness_by_the_load_that_it_takes(pair):
    known, _ = pair
    found = rated_helical_pair(HelicalCheck(known, 1.3, 400e3, 1.25), "choice", (None, 0.01), "settings", "cache")
    for one, module, form, tension, angle in zip(
        found.gears, (2e-3, 4e-3), (3.0, 2.4), (3.0, 2.5), (20.0, 25.0), strict=True
    ):
        assert one.reason == ""
        assert one.rating.value.form.Y_S == 2.0
        assert one.form_stress == pytest.approx(400e3 / module * form)
        # The normal load of the virtual tooth is the tangential one over the cosine of the normal pressure angle.
        assert one.fe == pytest.approx(400e3 / math.cos(math.radians(angle)) * tension / module)
    assert found.stiffness.value == (known, 500e3)  # c' takes K_A


def test_a_gear_that_has_no_rating_says_why_and_leaves_the_other_its_own(pair):
    known, rated = pair
    rated.refused = ("a",)
    one, other = rated_helical_pair(HelicalCheck(known, 1.3, 400e3), "choice", (None, 0.01), "settings", "cache").gears
    assert math.isnan(one.form_stress)
    assert math.isnan(one.fe)
    assert "is too thin" in one.reason
    assert one.rating.value is None
    assert other.fe > 0.0
    assert other.reason == ""
