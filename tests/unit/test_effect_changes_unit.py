"""What `fegear effects` says of changes: those below the errors of both runs are called not resolved."""

from types import SimpleNamespace

import pytest

from fegear.engine.named import Named
from fegear.engine.value import Value
from fegear.output.effects import effects_page, effects_table, sentence
from fegear.studies import effects
from fegear.studies.effects import Measured, Switched


def run(*values: Value) -> Measured:
    return Measured(SimpleNamespace(values=Named(values), tables=()), 1.0, {})


def te(value: float, error: float | None) -> Value:
    return Value("I.te_peak_to_peak", value * 1e-6, "um", None if error is None else error * 1e-6)


def mean(value: float, error: float | None) -> Value:
    return Value("I.te_mean", value * 1e-6, "um", None if error is None else error * 1e-6)


def test_a_change_below_the_errors_of_both_runs_is_called_not_resolved():
    found = Switched("hertz", True, run(te(8.0, 1.2), mean(20.0, 0.1)), run(te(8.216, 2.5), mean(20.05, 0.1)))
    said = sentence(found)
    assert "hertz: no change above the estimated error" in said
    assert "I.te_peak_to_peak: +0.216 um, not resolved (+- 1.2 and +- 2.5)" in said
    assert effects_table([found])["resolved"].tolist() == ["no", "no"]
    assert effects_table([found])["error_with"].tolist() == pytest.approx([2.5, 0.1])


def test_the_largest_change_is_taken_of_those_that_are_resolved():
    found = Switched("hertz", True, run(te(8.0, 1.2), mean(20.0, 0.1)), run(te(9.0, 2.5), mean(20.5, 0.1)))
    assert sentence(found).startswith("hertz: largest change in I.te_mean: 20 -> 20.5 um")
    assert effects_table([found])["resolved"].tolist() == ["no", "yes"]


@pytest.mark.parametrize(("share", "resolved"), [(1e-10, "no"), (1e-8, "yes")])
def test_a_value_without_an_error_has_round_off(share, resolved):
    found = Switched("hertz", False, run(te(8.0, None)), run(te(8.0 * (1.0 + share), None)))
    assert effects_table([found])["resolved"].tolist() == [resolved]
    assert ("not resolved (round-off)" in sentence(found)) == (resolved == "no")


def test_the_page_names_what_is_not_resolved():
    found = Switched("hertz", True, run(te(8.0, 1.2)), run(te(8.216, 2.5)))
    scene = SimpleNamespace(case=SimpleNamespace(title="A pair"), name="pair", text="")
    page = effects_page(scene, [found], [], effects_table([found]), {"hertz": None}, {"hertz": None}, {"hertz": ""})
    assert "not resolved (+- 1.2 and +- 2.5)" in str(page.sections)
    assert "none above the estimated error" in str(page.sections)


def test_the_share_that_is_done_grows_from_nothing_by_one_run_after_the_other(monkeypatch, tmp_path):
    monkeypatch.setattr(effects, "measure", lambda _scene: run(te(8.0, 0.1)))
    path, told = tmp_path / "drive.toml", []
    path.write_text("""results = ["transmission-error"]
[gear.a]
teeth = 23
module = "3 mm"
face_width = "20 mm"
[pair.I]
driver = "a"
driven = "a"
load = "5 kN"
""")
    only = ("hertz", "corner_contact", "neighbour_coupling")
    effects.effect_study(path, only=only, progress=lambda title, done: told.append((title, done)))
    assert told == [("unchanged", 0.0), (only[0], 0.25), (only[1], 0.5), (only[2], 0.75)]
