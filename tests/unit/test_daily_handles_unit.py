"""Options that every command has, output folders, help in narrow terminals, completion, errors that list choices."""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import subprocess
import sys

import pytest
from in_process import compute_points_here

import fegear.cli
from fegear.results.catalogue import RESULTS

CASE = """
results = ["geometry"]
[gear.a]
teeth = 28
module = "3.175 mm"
bore_radius = "20 mm"
[gear.b]
teeth = 35
module = "3.175 mm"
[pair.I]
driver = "a"
driven = "b"
load = "1000 N"
compliance = { source = "cornell" }
[design]
pair = "I"
"""
COMMANDS = ("run", "plan", "cost", "sweep", "effects", "export")


@pytest.fixture
def say(tmp_path, monkeypatch, capfd):
    """Run a command line in a folder with the case ``one.toml``: exit code, stdout, stderr."""
    (tmp_path / "one.toml").write_text(CASE)
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["fegear", *arguments])
        with pytest.raises(SystemExit) as end:
            fegear.cli.main()
        captured = capfd.readouterr()
        return int(end.value.code or 0), captured.out, captured.err

    return run


def test_results_are_named_without_quotes(say, tmp_path):
    code, out, _ = say("run", "one.toml", "--results", "load-sharing, tooth-geometry-check", "--no-plots", "--quiet")
    assert (code, out) == (0, "")
    names = {path.stem for path in (tmp_path / "results" / "one" / "tables").iterdir()}
    assert "load_sharing_I" in names
    code, _, err = say("plan", "one.toml", "--results", "load-shring")
    assert code == 2
    assert 'did you mean "load-sharing"' in err


def test_json_is_the_summary_and_nothing_else(say, tmp_path):
    code, out, err = say("run", "one.toml", "--results", "load-sharing", "--no-plots", "--json")
    told = json.loads(out)
    assert (code, told.pop("folder")) == (0, "results/one")
    assert told == json.loads((tmp_path / "results" / "one" / "summary.json").read_text())
    assert "Load sharing" in err
    assert say("run", "one.toml", "--json", "--quiet", "--no-plots")[2] == ""


def test_quiet_keeps_the_notes(say):
    _, words, _ = say("run", "one.toml", "--results", "load-sharing", "--no-plots")
    notes = [line for line in words.splitlines() if line.startswith("Note: ")]
    assert notes  # an assumed face width, for one
    assert say("run", "one.toml", "--results", "load-sharing", "--no-plots", "-q") == (0, "", "\n".join(notes) + "\n")


def test_a_plan_as_json_has_tasks_reasons_and_seconds(say):
    told = json.loads(say("plan", "one.toml", "--results", "load-sharing", "--json")[1])
    (first, second) = told["steps"]
    assert second["task"] == "load-sharing of I"
    assert first["seconds"] > 0.0
    assert {"stage", "reason"} == set(told["skipped"][0])


def test_every_command_writes_below_results_in_a_folder_named_after_the_case(say, tmp_path, monkeypatch):
    compute_points_here(monkeypatch)
    for arguments in (
        ("run", "one.toml", "--no-plots"),
        ("sweep", "one.toml", "--over", "gear.a.profile_shift=0,0.1", "--no-plots", "--no-cache"),
        ("export", "one.toml", "--format", "dxf", "--gear", "a"),
    ):
        assert say(*arguments, "--quiet")[0] == 0
    assert sorted(path.name for path in (tmp_path / "results").iterdir()) == ["one", "one_export", "one_sweep"]
    for command in ("cost", "effects", "export", "sweep"):
        assert f"results/<case>_{command}" in " ".join(say(command, "-h")[1].split())


def test_export_as_json_names_its_files(say, tmp_path):
    told = json.loads(say("export", "one.toml", "--format", "dxf", "--gear", "a", "--json")[1])
    assert all((tmp_path / told["folder"] / name).is_file() for name in told["files"])
    assert len(told["files"]) == 4


@pytest.mark.dear("40")
@pytest.mark.parametrize("columns", [40, 80, 200])
def test_help_shows_every_option_whole(columns):
    program = "import sys\nfrom fegear.cli import main\nsys.argv[0] = 'fegear'\nmain()"
    for command in COMMANDS if columns == 40 else ("sweep",):
        done = subprocess.run(
            [sys.executable, "-c", program, command, "-h"], env=os.environ | {"COLUMNS": str(columns)},
            capture_output=True, text=True, check=True, timeout=60,
        )  # fmt: skip
        assert max(map(len, done.stdout.splitlines())) <= min(columns, 100)
        assert "…" not in done.stdout
        options = set(re.findall(r"--[a-z-]+", done.stdout))
        assert options >= {"--set", "--json", "--help"}
        if command == "sweep":
            assert options >= {"--scheduler", "--workers", "--no-plots", "--no-cache", "--over", "--results"}
            assert "KEY=START:STOP:COUNT" in done.stdout


@pytest.mark.dear("fegear run one.toml --results stif-offered1", "fegear effects one.toml --effect cont-offered3")
@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("fegear ru", {"run"}),
        ("fegear run one.toml --results stif", {"stiffness", "stiffness-study"}),
        ("fegear run one.toml --results stiffness,load-s", {"stiffness,load-sharing"}),
        ("fegear effects one.toml --effect cont", {"contact_loss"}),
    ],
)
def test_bash_completes_commands_results_and_effects(typed, offered):
    program = "import sys\nfrom fegear.cli import main\nsys.argv[0] = 'fegear'\nmain()"
    asked = {"_FEGEAR_COMPLETE": "complete_bash", "COMP_WORDS": typed, "COMP_CWORD": str(typed.count(" "))}
    done = subprocess.run(
        [sys.executable, "-c", program], env=os.environ | asked, capture_output=True, text=True, check=False, timeout=60
    )
    assert set(done.stdout.split()) == offered, done.stderr


@pytest.mark.dear("zsh-.zfunc/_fegear", "fish-.config/fish/completions/fegear.fish")
@pytest.mark.parametrize(
    ("shell", "file"),
    [
        ("bash", ".bash_completions/fegear.sh"),
        ("zsh", ".zfunc/_fegear"),
        ("fish", ".config/fish/completions/fegear.fish"),
    ],
)
def test_completion_installs_in_every_shell(shell, file, tmp_path):
    """The shell is known by its name, so that a copy of the system's under that name stands for it."""
    stand_in = tmp_path / "bin" / shell
    stand_in.parent.mkdir()
    shutil.copy(shutil.which("bash"), stand_in)
    program = "import sys; from fegear.cli import main; sys.argv[0] = 'fegear'; main()"
    command = f'"{sys.executable}" -c "{program}" --install-completion; exit $?'
    done = subprocess.run(
        [stand_in, "-c", command], env=os.environ | {"HOME": str(tmp_path)}, capture_output=True, text=True,
        check=False, timeout=60,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "fegear" in (tmp_path / file).read_text()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ('results=["stifness"]', f'did you mean "stiffness"? "fegear results" lists all {len(RESULTS)}.'),
        ("gear.a.plane=strian", "must be 'strain', 'stress' or 'auto'"),
        ('gear.a.rack={tip_radius="ful"}', "gear.a.rack.tip_radius = \"ful\": must be a number or 'full'."),
        ("design.peak=leest", "design.peak = \"leest\": must be a number or 'least-root-stress' or 'least-stress'."),
        ("design.peak=-1.0", "design.peak = -1.0: must be greater than 0."),
        ("pair.I.iso_6336.edition=2005", "must be 2006 or 2019"),
        ('design.grind=["linar"]', "design.grind[0] = \"linar\": must be 'linear' or 'parabolic'"),
        ("effects.frction=true", "known here: contact_loss, corner_contact, friction"),
        ("pair.I.driver=c", "is not a gear of this case; known here: a, b"),
    ],
)
def test_an_error_lists_the_choices(say, change, words):
    code, out, err = say("plan", "one.toml", "--set", change)
    assert (code, out) == (2, "")
    assert words in err
    assert "function-" not in err


def test_numbers_that_toml_refuses_are_numbers(say):
    for written in (".05", "5e-2", "+.05", "0.05"):
        code, out, err = say("plan", "one.toml", "--set", f"accuracy.tolerance={written}", "--json")
        assert (code, err) == (0, ""), written
        assert out == say("plan", "one.toml", "--set", "accuracy.tolerance=0.05", "--json")[1]


def test_results_are_listed_by_subject_with_a_line_each(say):
    code, out, _ = say("results")
    assert code == 0
    assert out.startswith("Gears and teeth:\n")
    told = json.loads(say("results", "--json")[1])
    assert set(told) == set(RESULTS)
    for name, found in told.items():
        assert re.search(rf"^  {name} +\S", out, re.MULTILINE)
        assert 15 < len(found["about"]) <= 100
    assert told["design-chart"]["needs_effects"] == ["contact_loss", "parametric"]


def test_a_geometry_run_prints_the_numbers_of_its_gears(say, tmp_path):
    _, out, _ = say("run", "one.toml", "--no-plots")
    lines = {line.split("  ")[0]: line.split()[-2:] for line in out.splitlines() if " = " not in line}
    assert lines["gear"] == ["a", "b"]
    assert lines["teeth"] == ["28", "35"]
    table = (tmp_path / "results" / "one" / "tables" / "geometry.csv").read_text().splitlines()
    rows = list(zip(*(line.split(",") for line in table), strict=True))
    assert len(rows) >= 13
    for head, *cells in rows[1:]:
        assert [float(cell) for cell in lines[head]] == pytest.approx([float(cell) for cell in cells], rel=1e-6)


def test_slips_in_command_lines_are_refused_and_leave_nothing(say, tmp_path):
    """A letter more, less or changed in a command, an option or a value: none is taken for another."""
    lines = [
        ["run", "one.toml", "--results", "geometry", "--no-plots", "--set", "gear.a.teeth=30"],
        ["plan", "one.toml", "--results", "load-sharing", "--set", "gear.a.plane=stress"],
        ["sweep", "one.toml", "--over", "gear.a.teeth=20,21", "--workers", "1", "--no-cache", "--no-plots"],
        ["effects", "one.toml", "--effect", "hertz", "--results", "load-sharing"],
        ["export", "one.toml", "--gear", "a", "--format", "dxf"],
        ["cost", "one.toml", "--quick", "--no-plots"],
        ["compare", "one.toml", "one.toml", "--results", "geometry", "--no-plots"],
        ["new", "drive", "--kind", "pair", "--module", "3mm", "--no-schema"],
    ]
    #: Words of which another is as good: a name of the user's choice, a number.
    free = {"1", "20,21", "a", "drive"}
    before = sorted(tmp_path.rglob("*"))
    chance = random.Random(3)  # noqa: S311
    tried = 0
    while tried < 40:
        line = list(chance.choice(lines))
        place = chance.randrange(len(line))
        word = line[place]
        key, equals, value = word.partition("=")
        if key in free:
            continue
        at, letter = chance.randrange(len(key)), chance.choice("abcdefghijklmnopqrstuvwxyz-_")
        slip = chance.choice(
            [key[:at] + key[at + 1 :], key[:at] + letter + key[at:], key[:at] + letter + key[at + 1 :]]
        )
        if slip == key or (key == "3mm" and slip in ("mm", "3m")):
            continue
        line[place] = slip + equals + value
        code, out, err = say(*line)
        assert code == 2, (line, out)
        assert "Traceback" not in err
        assert sorted(tmp_path.rglob("*")) == before, line
        tried += 1
