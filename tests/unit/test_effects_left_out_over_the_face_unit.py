"""What an effect that is off would change of a pair with its width: made-up flanks, of which each answer is known."""

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.effects import CORNER_CONTACT, GAPS, WIDE_EFFECTS
from fegear.base.errors import InputError
from fegear.contact.wide import neglected_effects as neglected


def solution(mean, factor):
    return SimpleNamespace(mean_transmission_error=np.array(mean), face_load_factor=np.array(factor))


def test_sizes_are_those_of_the_nominal_load_beside_what_was_solved_alike(monkeypatch):
    """Along tip edges beside what is stated; others beside the same positions; shares are of what is stated."""
    spec = SimpleNamespace(loads=(100.0, 400.0, 900.0), nominal=400.0)
    over = SimpleNamespace(
        stated=SimpleNamespace(mean=np.array([1e-6, 4e-6, 9e-6]), face_load_factor=np.array([3.0, 2.0, 1.5])),
        found=solution([1.1e-6, 4.2e-6, 9.3e-6], [3.3, 2.1, 1.6]),
    )
    monkeypatch.setattr(neglected, "effects_off", lambda _spec: [CORNER_CONTACT.name, "friction", "relief"])

    def made(effect, *given):
        assert given == (spec, "flanks", "gaps", over)
        if effect == "relief":
            raise InputError("relief", "-1 um", "must be positive")
        return solution([5e-6], [2.5])

    monkeypatch.setattr(neglected, "flanks_with", made)
    found = neglected.neglected_effects(spec, "flanks", "gaps", over)
    assert set(found.changes) == {CORNER_CONTACT.name, "friction"}
    assert [*found.wrong] == ["relief"]
    for effect, differences in ((CORNER_CONTACT.name, (1e-6, 0.5)), ("friction", (0.8e-6, 0.4))):
        te, factor = found.changes[effect]
        assert (te.size, te.scale, te.load) == (pytest.approx(differences[0]), 4e-6, 400.0)
        assert (factor.size, factor.scale, factor.load) == (pytest.approx(differences[1]), 2.0, 400.0)


def test_effects_are_off_that_are_not_on_and_have_data():
    on, data = set(WIDE_EFFECTS[::2]), set(WIDE_EFFECTS[1::2][:-1])
    spec = SimpleNamespace(is_on=on.__contains__, has_data=lambda one: one in data or one in on)
    off = neglected.effects_off(spec)
    assert off == [one for one in WIDE_EFFECTS if one in data]
    assert off


@dataclass(frozen=True)
class Known:
    name: str
    fixed_half_width: float | None = 1e-4


@dataclass(frozen=True)
class Flanks:
    """They say what they were asked to solve."""

    pair: str = "pair"
    coupling: bool = True
    hertz: str = "constant"
    positions: int = 12
    most_gap: float = 0.0

    def compliance(self, load):
        return Known(f"of {self.pair}, {self.coupling} at {load}")

    def solve(self, loads, gaps, known=None):
        return SimpleNamespace(flanks=self, loads=loads, gaps=gaps, known=known)


@dataclass(frozen=True)
class Spec:
    nominal: float = 400.0
    placed: str = "placed"
    more: str = ""
    both: tuple = field(default_factory=lambda: (SimpleNamespace(wrong={}), SimpleNamespace(wrong={})))

    def with_effect(self, effect):
        return replace(self, more=effect)


@pytest.fixture
def asked(monkeypatch):
    """How the flanks of a specification are made: changes of them by the test."""
    changes = {}
    monkeypatch.setattr(neglected, "as_specified", lambda spec, flanks: replace(flanks, **changes))
    monkeypatch.setattr(neglected, "open_gaps", lambda spec: f"gaps with {spec.more}")
    monkeypatch.setattr(neglected, "usual_gap", lambda pair, load: {"placed": 1e-6}[pair] * load)
    over = SimpleNamespace(found=SimpleNamespace(
        known=Known("as solved"), lines=SimpleNamespace(roll=np.arange(30.0)),
    ))  # fmt: skip
    return changes, lambda effect, spec=None: neglected.flanks_with(effect, spec or Spec(), Flanks(), "gaps", over)


def test_tip_edges_are_followed_at_few_positions_with_the_gaps_as_they_are(asked):
    found = asked[1](CORNER_CONTACT.name)
    assert (found.loads, found.gaps, found.known) == ([400.0], "gaps", None)
    assert found.flanks == Flanks(positions=24, most_gap=pytest.approx(4e-4))


@pytest.mark.parametrize("effect", ["friction", *GAPS])
def test_an_effect_changes_gaps_or_flanks_and_what_is_known_is_used_again_where_it_holds(asked, effect):
    changes, with_effect = asked
    gaps = f"gaps with {effect}" if effect in GAPS else "gaps"
    same = with_effect(effect)
    assert (same.flanks, same.known, same.gaps, same.loads) == (Flanks(positions=30), Known("as solved"), gaps, [400.0])
    changes["hertz"] = "load-dependent"  # contacts then have widths of their own
    wider = with_effect(effect)
    assert (wider.flanks, wider.known) == (Flanks(positions=30), Known("as solved", None))
    for change in ({"pair": "apart"}, {"coupling": False}):
        changes.clear()
        changes.update(change)
        new = with_effect(effect)
        assert new.flanks == Flanks(positions=30, **change)
        assert new.known == new.flanks.compliance(400.0)
        assert new.gaps == gaps


@pytest.mark.parametrize("which", [0, 1])
def test_wrong_data_of_either_flank_are_said(asked, which):
    problem = InputError("relief", "-1 um", "must be positive")
    flanks = [SimpleNamespace(wrong={}), SimpleNamespace(wrong={})]
    flanks[which] = SimpleNamespace(wrong={"relief": problem})
    with pytest.raises(InputError) as found:
        asked[1]("relief", Spec(both=tuple(flanks)))
    assert found.value is problem
    assert asked[1]("spacing_errors", Spec(both=tuple(flanks))).loads == [400.0]
