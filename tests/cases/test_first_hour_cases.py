"""A first hour: one drawing by ``fegear new``, in the window's form and in Python; the same answers, no refusal."""

from __future__ import annotations

import json
import sys
import tomllib
from pathlib import Path

import pytest

import fegear
import fegear.cli
from fegear.case.changed_text import as_typed
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.text import draft
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES
from fegear.window.document import Desk
from fegear.window.form import fields, form

pytestmark = pytest.mark.long

#: Of the drawing, and of the helical pair that it becomes.
DRAWING = ("--teeth", "21", "53", "--module", "3mm", "--profile-shift", ".3", ".1", "--face-width", "30 mm",
           "--tip-relief", "20 um", "4 mm", "--torque", "260 N m")  # fmt: skip
HELICAL = ("--helix-angle", "15 deg", "--lead-error", "10 um")
#: So coarse that both fit into seconds.
COARSE = {"accuracy.tolerance": "0.05", "load_distribution.positions": "6", "load_distribution.panels": "4"}
RELIEF = {"tip": {"amount": "20 um", "length": "4 mm"}}
STEEL = {"material": "case-hardened-steel"}
NAMES = ("I.te_peak_to_peak", "I.te_mean", "I.mesh_stiffness_mean")


@pytest.fixture
def say(tmp_path, monkeypatch, capfd):
    """Run a command line in a fresh folder: what it prints; nothing is refused."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> str:
        monkeypatch.setattr(sys, "argv", ["fegear", *arguments])
        with pytest.raises(SystemExit) as end:
            fegear.cli.main()
        captured = capfd.readouterr()
        assert int(end.value.code or 0) == 0, captured.err
        return captured.out

    return run


def computed(name: str) -> float:
    """With all its digits; what is printed has those that its error allows."""
    found = json.loads(Path("results", "drive", "summary.json").read_text("utf-8"))["results"]
    return float(found[name]["value"])


def bores() -> dict[str, str]:
    """What the draft assumes of the gears' bodies, which nobody types."""
    drafted = tomllib.loads(Path("drive.toml").read_text("utf-8"))["gear"]
    return {name: drafted[name]["bore_radius"] for name in ("pinion", "wheel")}


def by_form(kind: str, typed: dict[str, str]) -> dict[str, float]:
    """A template, its fields typed one after the other; no field refuses while the others are old."""
    desk = Desk(draft(Answers(kind, {}), kind), kind, Path.cwd())
    for key, text in typed.items():
        path = tuple(key.split("."))
        known = {one.path: one for one in fields(form(desk.document))}
        desk.set(path, known[path].written(text) if path in known else as_typed(text))
    assert desk.refusal is None, desk.refusal
    scene = build_scene(desk.document, "drive", Path.cwd())
    results = run_plan(scene, make_plan(scene, STAGES))
    return {one.name: one.value for one in results.values}


def test_one_drawing_has_the_same_answers_however_it_is_told(say, tmp_path):
    say("new", "drive", *DRAWING)
    say("run", "drive.toml", "--no-plots", "--set", "accuracy.tolerance=0.05")
    commands = {name: computed(name) for name in NAMES}
    both = ("pinion", "wheel")
    each = {"module": "3 mm", "face_width": "30 mm", "relief.tip.amount": "20 um", "relief.tip.length": "4 mm"}
    typed = {f"gear.{gear}.{key}": text for gear in both for key, text in each.items()}
    typed |= {"gear.pinion.teeth": "21", "gear.wheel.teeth": "53", "gear.pinion.profile_shift": "0.3",
              "gear.wheel.profile_shift": "0.1", "pair.I.torque": "260 N m", "effects.relief": "true",
              "accuracy.tolerance": "0.05"}  # fmt: skip
    assert len(typed) <= 15  # fields typed, none of them twice
    gears = [
        fegear.Gear(
            teeth,
            "3 mm",
            name=name,
            profile_shift=shift,
            face_width="30 mm",
            relief=RELIEF,
            strength=STEEL,
            bore_radius=bores()[name],
        )
        for teeth, name, shift in ((21, "pinion", 0.3), (53, "wheel", 0.1))
    ]
    found = fegear.transmission_error(fegear.Pair(*gears), torque="260 N m", tolerance=0.05)
    window = by_form("pair", typed | {f"gear.{name}.bore_radius": text for name, text in bores().items()})
    for name in NAMES:
        assert window[name] == pytest.approx(commands[name], rel=1e-8)
        assert found.values[name].value == pytest.approx(commands[name], rel=1e-8)

    steel = [word for gear in both for word in ("--set", f'gear.{gear}.strength={{material="case-hardened-steel"}}')]
    say("run", "drive.toml", "--no-plots", "--results", "rating", "--set", "accuracy.tolerance=0.05", *steel)
    rated = fegear.rating(fegear.Pair(*gears), torque="260 N m", speed="1500 rpm", tolerance=0.05)
    for name in ("I.driver.S_F", "I.driven.S_F", "I.driver.S_H", "I.driven.S_H"):
        assert rated.values[name].value == pytest.approx(computed(name), rel=1e-8)
    say("export", "drive.toml", "--format", "dxf")
    assert len(list((tmp_path / "results" / "drive_export").glob("*.dxf"))) >= 4


def test_the_helical_pair_that_it_becomes_has_the_same_answers(say):
    say("new", "drive", *DRAWING, *HELICAL)
    say("run", "drive.toml", "--no-plots", *(word for key in COARSE for word in ("--set", f"{key}={COARSE[key]}")))
    commands = {name: computed(name) for name in (*NAMES, "I.K_Hbeta")}
    typed = {f"gear.{gear}.{key}": text for gear in ("pinion", "wheel") for key, text in {
        "normal_module": "3 mm", "face_width": "30 mm", "helix_angle": "15 deg", "relief.tip.amount": "20 um",
        "relief.tip.length": "4 mm", "relief.tip.shape": "linear"}.items()}  # fmt: skip
    typed |= {"gear.pinion.teeth": "21", "gear.wheel.teeth": "53", "gear.pinion.profile_shift": "0.3",
              "gear.wheel.profile_shift": "0.1", "pair.I.torque": "260 N m", "pair.I.line_error.over_face": "10 um",
              "gear.pinion.lead.crowning": "0 um", "effects.relief": "true", "effects.misalignment": "true",
              **COARSE}  # fmt: skip
    window = by_form("helical", typed | {f"gear.{name}.bore_radius": text for name, text in bores().items()})
    for name, value in commands.items():
        assert window[name] == pytest.approx(value, rel=1e-8)
    gears = [
        fegear.Gear(teeth, name=name, normal_module="3 mm", helix_angle="15 deg", hand=hand, profile_shift=shift,
                    face_width="30 mm", relief=RELIEF, bore_radius=bores()[name])
        for teeth, name, hand, shift in ((21, "pinion", "right", 0.3), (53, "wheel", "left", 0.1))
    ]  # fmt: skip
    pair = fegear.Pair(*gears, line_error={"over_face": "10 um"}, load_distribution={"positions": 6, "panels": 4})
    effects = {"corner_contact": False}  # the template does not name it, and a question of Python starts with it
    found = fegear.transmission_error(pair, torque="260 N m", tolerance=0.05, effects=effects)
    for name in NAMES:
        assert found.values[name].value == pytest.approx(commands[name], rel=1e-8)
