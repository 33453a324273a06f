"""A second process draws: the same bytes, nothing depends on it, and it outlives nobody."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from fegear.base.errors import InputError, MissingLibraryError
from fegear.cli import program
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Surface, TriangleField
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Task
from fegear.output.draw_png import draw_pictures
from fegear.output.figures import Drawing
from fegear.output.picture_process import PictureProcess, _line_to_copy

CASE = Path(__file__).parents[2] / "cases" / "lin_table1.toml"
#: A case of which nothing costs anything to compute.
QUICK = ["--set", 'results=["geometry"]']


def figure(key: str = "wave", count: int = 50) -> Figure:
    x = np.linspace(0.0, 6.0, count)
    return Figure(key, "A wave", "A sine.", (Panel(Axis("x", "mm"), Axis("y", "um"), (Curve(x, np.sin(x)),)),))


@contextlib.contextmanager
def started():
    """A process, started although matplotlib is loaded here."""
    with contextlib.ExitStack() as stack:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("fegear.output.picture_process._pays", lambda: True)
            process = stack.enter_context(PictureProcess())
        assert process._child is not None
        yield process


@pytest.fixture(scope="module")
def process():
    with started() as one:
        yield one


def pictures(drawing: Drawing, *figures: object) -> tuple[list, list[str]]:
    drawing.begin(Task("some"), Outcome(None, figures=figures))  # type: ignore[arg-type]
    return drawing.finish(lambda _fraction: None)


@pytest.mark.dear
def test_it_draws_the_same_bytes_in_the_same_order(process, tmp_path):
    there, here = tmp_path / "there", tmp_path / "here"
    there.mkdir()
    here.mkdir()
    sent = [process.draw(figure(name), there) for name in "abc"]
    for one, name in zip(sent, "abc", strict=True):
        answer = one.result()
        assert answer is not None, "drawn there"
        (drawn,) = answer
        (own,) = draw_pictures(figure(name), here)
        assert (drawn.path, drawn.title, drawn.caption) == (there / f"{name}.png", own.title, own.caption)
        assert drawn.path.read_bytes() == own.path.read_bytes()


def test_its_copy_draws_the_same_bytes(process, tmp_path):
    if sys.platform == "linux":
        assert len(process._lines) == 2
    drawn = []
    for number, line in enumerate(process._lines):
        (tmp_path / str(number)).mkdir()
        (picture,) = line.drawn(figure(), tmp_path / str(number)) or ()
        drawn.append(picture.path.read_bytes())
    assert len(set(drawn)) == 1


@pytest.mark.dear
def test_what_it_cannot_draw_is_drawn_here_or_fails_here_in_its_own_words(process, tmp_path, monkeypatch):
    unsent = Figure("lambda", "", "", (Panel(Axis("x"), Axis("y"), (lambda: None,)),))  # type: ignore[arg-type]
    wrong = Figure("wrong", "", "", (Panel(Axis("x"), Axis("y"), (Curve([0.0, 1.0], [0.0]),)),))
    assert process.draw(unsent, tmp_path).result() is None
    assert process.draw(wrong, tmp_path).result() is None
    answer = process.draw(figure(), tmp_path).result()
    assert answer is not None, "it went on"
    with pytest.raises(ValueError, match="first dimension"):
        pictures(Drawing(tmp_path / "wrong", process), wrong)

    def without(*_arguments):
        raise MissingLibraryError("no library draws surfaces")

    monkeypatch.setattr("fegear.output.draw_space.draw_space", without)
    solid = Figure("solid", "", "", (Panel(Axis("x"), Axis("y"), (Surface(np.zeros((3, 2)), "tooth"),)),))
    found, missing = pictures(Drawing(tmp_path / "solid", process), solid, figure())
    assert missing == ["no library draws surfaces."]
    assert [one.figure.key for one in found] == ["wave"]


def test_when_it_dies_the_pictures_are_drawn_here(tmp_path):
    with started() as process:
        process._child.kill()
        process._child.wait()
        found, missing = pictures(Drawing(tmp_path / "plots", process), figure("a"), figure("b"))
    assert not missing
    assert [picture.path.name for one in found for picture in one.pictures] == ["a.png", "b.png"]
    assert all(picture.path.stat().st_size > 5000 for one in found for picture in one.pictures)


@pytest.mark.dear
def test_leaving_ends_it_whatever_it_draws(monkeypatch, tmp_path):
    monkeypatch.setattr("fegear.output.picture_process._pays", lambda: True)
    with PictureProcess() as process:
        waiting = [process.draw(figure(str(i), 200_000), tmp_path) for i in range(50)]
    assert process._child is not None
    assert process._child.poll() is not None
    # Pictures that take seconds each: whoever waited for them would have them.
    assert all(one.cancelled() or one.result() is None for one in waiting[5:])


@pytest.mark.parametrize("left", [0, 1])
def test_where_no_pipe_is_left_there_is_no_copy(left, monkeypatch):
    made, closed, pipe = [], [], os.pipe

    def few():
        if len(made) == left:
            raise OSError(24, "Too many open files")
        made.append(pipe())
        return made[-1]

    monkeypatch.setattr("fegear.output.picture_process.os.pipe", few)
    assert _line_to_copy() == ((), [])
    for end in (end for both in made for end in both):
        with pytest.raises(OSError, match="Bad file descriptor"):
            os.fstat(end)
        closed.append(end)
    assert len(closed) == 2 * left


@pytest.mark.parametrize("held", ["cores", "matplotlib", "system"])
def test_where_no_process_is_to_be_had_everything_is_drawn_here(held, monkeypatch, tmp_path):
    def refuse(*_arguments, **_more):
        raise OSError(11, "no more processes")

    monkeypatch.setattr("fegear.engine.processes.cores", lambda: 1 if held == "cores" else 2)
    if held != "matplotlib":
        monkeypatch.delitem(sys.modules, "matplotlib", raising=False)
    else:
        import matplotlib as mpl

        assert mpl
    if held == "system":
        monkeypatch.setattr("fegear.output.picture_process.subprocess.Popen", refuse)
    with PictureProcess() as process:
        monkeypatch.undo()
        assert process._child is None
        found, _ = pictures(Drawing(tmp_path / "plots", process), figure())
    assert found[0].pictures[0].path.is_file()


def test_without_plots_none_is_started(monkeypatch, tmp_path):
    def refuse(*_arguments):
        raise AssertionError("started")

    monkeypatch.setattr("fegear.output.picture_process._started", refuse)
    arguments = ["run", str(CASE), *QUICK, "--out", str(tmp_path / "out")]
    result = CliRunner().invoke(program(), [*arguments, "--no-plots"], catch_exceptions=False)
    assert result.exit_code == 0
    with pytest.raises(AssertionError, match="started"):
        CliRunner().invoke(program(), arguments, catch_exceptions=False)


@pytest.mark.dear("pdf")
@pytest.mark.parametrize("kind", ["svg", "pdf"])
def test_figures_are_drawn_in_the_wanted_format_and_what_a_report_embeds_as_png(kind, process, tmp_path):
    x = np.array([0.0, 1.0, 0.0])
    field = Figure("field", "A field", "", (Panel(Axis("x"), Axis("y"), (
        TriangleField(np.array([x, x[::-1]]), np.array([[0], [1], [2]]), x, 1.0, "stress", "MPa"),
    )),))  # fmt: skip
    for name, of in (("there", process), ("here", None)):
        found, missing = pictures(Drawing(tmp_path / name, of, kind=kind), figure(), field)
        assert [one.pictures[0].path.name for one in found] == [f"wave.{kind}", "field.png"]
        assert missing == []
    first, second = ((tmp_path / name / f"wave.{kind}").read_bytes() for name in ("there", "here"))
    assert first == second
    assert first.lstrip().startswith(b"<?xml" if kind == "svg" else b"%PDF")


def test_the_command_takes_a_format_and_refuses_others(tmp_path):
    arguments = ["run", str(CASE), *QUICK, "--out", str(tmp_path / "out")]
    assert CliRunner().invoke(program(), [*arguments, "--plots", "svg"], catch_exceptions=False).exit_code == 0
    assert {path.suffix for path in (tmp_path / "out" / "plots").iterdir()} == {".svg"}
    for more, said in (
        (["--plots", "gif"], "is not a supported figure format; choose png, svg or pdf"),
        (["--plots", "svg", "--no-plots"], "contradicts --no-plots"),
    ):
        with pytest.raises(InputError, match=said):
            CliRunner().invoke(program(), [*arguments, *more], catch_exceptions=False)


@pytest.mark.dear
def test_none_outlives_a_killed_parent_nor_complains(tmp_path):
    program = (
        "import time\n"
        "from fegear.output.picture_process import PictureProcess\n"
        "with PictureProcess() as process:\n"
        "    if process._child is not None:\n"
        "        process._child.stdin.write(bytes([128, 4, 149]))\n"  # the first bytes of a figure
        "        process._child.stdin.flush()\n"
        "    print(process._child is not None, flush=True)\n"
        "    time.sleep(600)\n"
    )
    parent = subprocess.Popen(
        [sys.executable, "-c", program], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert parent.stdout is not None
    started = parent.stdout.readline().strip() == "True"
    parent.kill()
    # The process has the parent's stderr: that ends when both have ended.
    _, errors = parent.communicate(timeout=60)
    assert errors == ""
    if not started:
        pytest.skip("one core: no second process")
