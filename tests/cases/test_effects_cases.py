"""An effect that is off runs none of its kernels, by count; and the page of effects says what the code does."""

from __future__ import annotations

import base64
import csv
import functools
import importlib.util
import io
import json
import zipfile
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fegear.base.effects import EFFECTS
from fegear.base.errors import InputError
from fegear.base.tally import KERNELS, note, tallied, tallying
from fegear.case.reading import read_scene
from fegear.cli import program
from fegear.results.catalogue import STAGES
from fegear.studies.effects import Switched, effect_study, kernel_table, stage_table

ROOT = Path(__file__).parents[2]
CASES = ROOT / "cases"
TE = ('results=["transmission-error"]', "pair.I.loads=['8890 N']")
#: Scenes in which nothing but the effect calls for its kernels.
SCENES = {name: (effect.scene[0], effect.scene[1:]) for name, effect in EFFECTS.items()}


@functools.cache
def study(effect: str) -> Switched:
    name, overrides = SCENES[effect]
    _, (found,), fixed = effect_study(CASES / f"{name}.toml", overrides, (effect,))
    assert not fixed
    return found


@pytest.mark.dear("misalignment", "friction", "contact_loss", "parametric", "odd_teeth")
@pytest.mark.parametrize("effect", SCENES)
def test_what_is_off_runs_none_of_its_kernels(effect):
    found = study(effect)
    for kernel in EFFECTS[effect].kernels:
        assert found.with_it.kernels.get(kernel, 0) > 0, kernel
        assert found.without.kernels.get(kernel, 0) == 0, kernel


@pytest.mark.dear("misalignment", "friction", "contact_loss", "parametric", "odd_teeth")
@pytest.mark.parametrize("effect", SCENES)
def test_switching_an_effect_off_calls_no_other_effect_s_kernels(effect):
    """Kernels that belong to other effects run with them, on or off alike: none appears that was not there."""
    found = study(effect)
    others = {k for other, fact in EFFECTS.items() if other != effect for k in fact.kernels}
    for kernel in others:
        if found.with_it.kernels.get(kernel, 0) == 0:
            assert found.without.kernels.get(kernel, 0) == 0, kernel


@pytest.mark.dear
def test_every_effect_changes_an_answer_and_every_kernel_counts_somewhere():
    seen = set()
    for effect in SCENES:
        found = study(effect)
        assert any(abs(pair.share) > 1e-9 for pair in found.changes()), effect
        seen |= set(found.with_it.kernels) | set(found.without.kernels)
    assert seen == set(KERNELS) - {"neglected effects"}  # which effect studies do not size


def test_the_linearised_train_moves_nothing_in_time():
    name, overrides = SCENES["contact_loss"]
    _, (found,), _ = effect_study(CASES / f"{name}.toml", (*overrides, "effects.parametric=false"), ("contact_loss",))
    assert found.with_it.kernels["steady motions"] == 2
    assert found.without.kernels.get("steady motions", 0) == 0
    assert found.without.kernels.get("passages", 0) == 0


def test_without_coupling_no_neighbours_of_neighbours_are_solved():
    from fegear.case.built.tooth_influence import needed_reach

    with_it = read_scene(CASES / "calculix_pair.toml")
    without = read_scene(CASES / "calculix_pair.toml", ("effects.neighbour_coupling=false",))
    assert needed_reach(with_it, "a") == 3
    assert needed_reach(without, "a") == 1


def test_the_command_writes_a_table_a_picture_and_a_summary(tmp_path):
    case, options = str(CASES / "lin_tip_relief.toml"), ("--set", TE[0], "--set", TE[1])
    out = tmp_path / "found"
    done = CliRunner().invoke(program(), ["effects", case, *options, "--effect", "relief", "--out", str(out)])
    assert done.exit_code == 0, done.output
    assert "relief: largest change in I.te_" in done.output
    assert (out / "plots" / "effect_relief.png").read_bytes().startswith(b"\x89PNG")
    rows = list(csv.DictReader((out / "tables" / "effects.csv").read_text("utf-8").splitlines()))
    peak = next(row for row in rows if row["result"] == "I.te_peak_to_peak")
    assert float(peak["without"]) + float(peak["change"]) == pytest.approx(float(peak["with"]))
    assert (peak["in_the_case"], peak["unit"]) == ("on", "um")
    assert "reliefs 0 -> " in peak["kernels"]
    told = json.loads((out / "summary.json").read_text("utf-8"))
    assert told["effects"]["relief"]["processor_seconds"]["with"] > 0.0
    assert set(told["files"]) == {
        "plots/effect_relief.png", "report.html", "tables/effects.csv", "summary.json",
    }  # fmt: skip
    page = (out / "report.html").read_text("utf-8")
    assert "relief (on in the case)" in page
    assert "id='plot-effect_relief'" in page
    packed = zipfile.ZipFile(io.BytesIO(base64.b64decode(page.split("data:application/zip;base64,")[1].split("'")[0])))
    assert packed.read("tables/effects.csv") == (out / "tables" / "effects.csv").read_bytes()
    assert {"tables/relief_without.csv", "tables/relief_with.csv", "lin_tip_relief.toml"} <= set(packed.namelist())


def test_an_effect_that_influences_no_result_is_refused():
    with pytest.raises(InputError, match="is not an effect that influences the requested"):
        effect_study(CASES / "lin_tip_relief.toml", TE, ("friction",))


def test_an_effect_that_cannot_be_switched_says_why():
    _, switched, fixed = effect_study(CASES / "lin_tip_relief.toml", TE, ("neighbour_coupling",))
    assert switched == []
    assert "is not available with" in fixed[0].reason


def test_counting_ends_with_its_block_and_inner_counts_keep_their_own():
    work = tallied("load sharing")(lambda: None)
    work()
    with tallying() as outer:
        work()
        with tallying() as inner:
            work()
            note("reliefs", 3)
        note("reliefs", 0)
    work()
    assert outer == {"load sharing": 1}
    assert inner == {"load sharing": 1, "reliefs": 3}
    with pytest.raises(KeyError):
        tallied("no such kernel")


@pytest.mark.dear
def test_the_page_of_effects_says_what_the_code_does():
    page = (ROOT / "docs" / "effects.md").read_text("utf-8")
    again = "docs/effects.md: python docs/effect_pictures.py --tables writes its tables"
    assert stage_table(read_scene(path) for path in sorted(CASES.glob("*.toml"))) in page, again
    assert kernel_table() in page, again
    for effect in SCENES:
        assert f"images/effects/{effect}.png" in page, "its picture belongs into the grid of docs/effects.md"
        assert (ROOT / "docs" / "images" / "effects" / f"{effect}.png").is_file()
    assert {effect for stage in STAGES for effect in stage.effects} == set(EFFECTS)


def test_the_page_can_be_made_again():
    spec = importlib.util.spec_from_file_location("effect_pictures", ROOT / "docs" / "effect_pictures.py")
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    assert sorted(effect for _, _, effects in made.studies() for effect in effects) == sorted(EFFECTS)
    page = (ROOT / "docs" / "effects.md").read_text("utf-8")
    assert made.replaced(page, "kernels", kernel_table()) == page
