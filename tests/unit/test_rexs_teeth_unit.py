"""Numbers of a REXS gear's teeth that may be said in one way or another; the model is made up."""

import math
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.exchange.rexs import teeth
from fegear.exchange.rexs.teeth import _cut, _in_modules, module_of, profile_shift


class Said:
    """Components are dicts of what is said of them."""

    def __init__(self, linked=None):
        self.notes, self._linked = [], linked or {}

    def number(self, component, kind, name):
        value = component.values.get(name)
        return None if value is None else value

    def needed(self, component, kind, name):
        if (value := self.number(component, kind, name)) is None:
            raise InputError(name, "(not given)", "is missing")
        return value

    def linked(self, component, relation, own, other, *types):
        return self._linked.get((component.id, other), [])


def part(number, kind="cylindrical_gear", **values):
    return SimpleNamespace(id=number, type=kind, said=f"{kind} {number}", values=values)


def test_a_transverse_module_is_turned_into_the_normal_one_by_the_helix():
    assert module_of(Said(), part(1, normal_module=3e-3, transverse_module=9.0)) == 3e-3
    helix = math.radians(20.0)
    found = module_of(Said(), part(1, transverse_module=3e-3, helix_angle_reference_diameter=-helix))
    assert found == pytest.approx(3e-3 * math.cos(helix))
    assert module_of(Said(), part(1, transverse_module=3e-3)) == pytest.approx(3e-3)
    with pytest.raises(InputError, match="is missing"):
        module_of(Said(), part(1))
    with pytest.raises(InputError, match="must be positive"):
        module_of(Said(), part(1, normal_module=0.0))


@pytest.fixture
def flank(monkeypatch):
    own = part(5, "flank")
    monkeypatch.setattr(teeth, "flank_of", lambda said, gear: own)
    return own


def test_a_shift_is_a_factor_or_a_length_of_the_flank_or_else_of_the_gear(flank):
    gear = part(1, normal_module=4e-3, addendum_modification_coefficient=0.7)
    assert profile_shift(Said(), gear) == 0.7
    flank.values["addendum_modification"] = 1e-3
    assert profile_shift(Said(), gear) == pytest.approx(0.25)
    flank.values["addendum_modification_coefficient"] = -0.2
    assert profile_shift(Said(), gear) == -0.2
    flank.values.clear()
    assert profile_shift(Said(), part(1, normal_module=4e-3, addendum_modification=2e-3)) == pytest.approx(0.5)
    assert profile_shift(Said(), part(1, normal_module=4e-3)) is None


def test_a_length_is_counted_in_modules_where_no_factor_is_said():
    one = part(1, factor=1.2, length=8e-3)
    assert _in_modules(Said(), one, 2e-3, "factor", "length") == 1.2
    assert _in_modules(Said(), part(1, length=8e-3), 2e-3, "factor", "length") == 4.0
    assert _in_modules(Said(), part(1), 2e-3, "factor", "length") is None


def test_a_root_diameter_gives_the_dedendum_of_the_rack_and_an_edge_its_tip_radius(monkeypatch):
    monkeypatch.setattr(teeth, "_tool", lambda said, gear, flank: None)
    module, count, shift, helix = 3e-3, 20, 0.25, math.radians(15.0)
    root = module * count / math.cos(helix) - 2.0 * (1.3 - shift) * module
    (rack,) = _cut(Said(), part(1, root_diameter=root), None, module, count, shift, helix)
    text = str(rack)
    assert "dedendum" in text
    assert "1.3" in text
    assert "root_diameter; tip radius of ISO 53 C assumed" in text
    edge = part(5, "flank", tool_edge_radius=0.9e-3)
    (rack,) = _cut(Said(), part(1), edge, module, count, shift, helix)
    text = str(rack)
    assert "0.3" in text
    assert "tool_edge_radius; else ISO 53 A" in text
    said = Said()
    _cut(said, part(1), None, module, count, shift, helix)
    assert said.notes == ["cylindrical_gear 1: tool not specified; basic rack ISO 53 A assumed."]
