"""How the program ends: the exit code and the sentence of every way that it can be stopped or can fail."""

import errno
import signal
import sys

import pytest

import fegear.cli
from fegear.base.errors import InputError
from fegear.commands.terminal import INTERRUPTED

CASE = """results = ["stiffness"]
[gear.a]
teeth = 20
module = "3 mm"
face_width = "10 mm"
"""


def ended(monkeypatch, capsys, *words):
    """Exit code and what stands on stderr of a command."""
    monkeypatch.setattr(sys, "argv", ["fegear", *map(str, words)])
    with pytest.raises(SystemExit) as end:
        fegear.cli.main()
    return end.value.code, capsys.readouterr().err


@pytest.fixture
def case(tmp_path):
    (path := tmp_path / "a.toml").write_text(CASE)
    return path


def raising(error):
    def stopped(*_, **__):
        raise error

    return stopped


@pytest.mark.parametrize(
    ("command", "place"),
    [
        ("run", "fegear.engine.run.run_plan"),
        ("export", "fegear.output.export.export_gears"),
        ("cost", "fegear.studies.cost.study.study_cost"),
        ("effects", "fegear.studies.effects.effect_study"),
        ("check", "fegear.studies.check.check_gear"),
        ("compare", "fegear.studies.comparison.compare.compare"),
    ],
)
def test_ctrl_c_in_a_command_is_130_and_leaves_no_folder(monkeypatch, capsys, case, tmp_path, command, place):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(place, raising(KeyboardInterrupt()))
    words = [command, case, case] if command == "compare" else [command, case]
    code, said = ended(monkeypatch, capsys, *words)
    assert code == 130
    assert said.endswith(f"fegear: {INTERRUPTED}\n")
    assert [one.name for one in tmp_path.iterdir()] == ["a.toml"]


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (KeyboardInterrupt(), 130, INTERRUPTED),
        (fegear.cli._Stopped(signal.SIGTERM), 143, "stopped by SIGTERM; results of earlier runs are unchanged."),
        (InputError("gear.a.teeth", 3, "is below 5", "use 5"), 2, "gear.a.teeth = 3: is below 5; use 5."),
        (MemoryError(), 2, fegear.cli._NO_MEMORY),
        (ImportError("failed to map segment from shared object: Cannot allocate memory"), 2, fegear.cli._NO_MEMORY),
        (OSError(errno.ENOMEM, "Cannot allocate memory"), 2, fegear.cli._NO_MEMORY),
        (
            OSError(errno.ENOSPC, "No space left on device", "out/x.csv"), 2,
            "cannot write to out/x.csv (No space left on device); existing output folders are intact.",
        ),
        (
            OSError(errno.EROFS, "Read-only file system"), 2,
            "cannot write (Read-only file system); existing output folders are intact.",
        ),
    ],
)  # fmt: skip
def test_what_ends_the_program_is_one_sentence_with_its_code(monkeypatch, capsys, error, code, words):
    monkeypatch.setattr(fegear.cli, "program", raising(error))
    monkeypatch.setattr(fegear.cli, "give_up", lambda _stream: None)
    assert ended(monkeypatch, capsys) == (code, f"fegear: {words}\n")


@pytest.mark.parametrize("error", [ImportError("no module"), OSError(errno.EINVAL, "Invalid argument"), ValueError()])
def test_what_nobody_foresaw_is_not_hidden(monkeypatch, error):
    monkeypatch.setattr(fegear.cli, "program", raising(error))
    monkeypatch.setattr(fegear.cli, "give_up", lambda _stream: None)
    with pytest.raises(type(error)):
        fegear.cli.main()


def test_a_folder_that_is_gone_is_said(monkeypatch, capsys):
    monkeypatch.setattr(fegear.cli, "program", raising(FileNotFoundError(errno.ENOENT, "No such file or directory")))
    monkeypatch.setattr(fegear.cli, "give_up", lambda _stream: None)
    monkeypatch.setattr(fegear.cli, "_nowhere", lambda: True)
    sentence = "fegear: the current folder no longer exists; change to another one.\n"
    assert ended(monkeypatch, capsys) == (2, sentence)
