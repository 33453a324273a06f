"""Laws of all commands: what is not asked for is off, and each option reaches what it is for."""

import contextlib
from pathlib import Path
from types import SimpleNamespace

import pytest
import typer

from fegear.cli import program
from fegear.commands import size
from fegear.commands.terminal import Voice


@pytest.fixture(scope="module")
def commands():
    return typer.main.get_command(program()).commands


class StopError(Exception):
    """Far enough."""


def called(commands, name, *arguments):
    """Call a command in this process as the program does; what it needs besides is made up."""
    command = commands[name]
    needed = [one for one in command.params if one.required and not set(one.opts) & set(arguments)]
    made = [
        part for one in needed for part in ((one.opts[0], "gear.a.teeth=9:9:1") if one.opts[0][0] == "-" else ("a",))
    ]
    return command([*made, *arguments], standalone_mode=False)


def stopped(monkeypatch, place, name, seen):
    """Have a function note what it is called with, and stop."""

    def noted(*given, **more):
        seen.append((given, more))
        raise StopError

    monkeypatch.setattr(f"{place}.{name}", noted)


def test_what_can_be_switched_on_is_off_where_nobody_does(commands):
    flags = {(name, one.name): one.default for name, command in commands.items() for one in command.params
             if getattr(one, "is_flag", False)}  # fmt: skip
    assert len(flags) > 30
    undecided = {("import", "spectrum")}  # the model's load cases decide
    assert {flag for flag, default in flags.items() if default is not False} == undecided
    assert all(flags[flag] is None for flag in undecided)
    # Besides these only what help texts say by their numbers is given.
    given = {(name, one.name): one.default for name, command in commands.items() for one in command.params
             if one.default not in (None, False, "")}  # fmt: skip
    assert given == {
        ("check", "positions"): 3, ("compare", "tolerance"): 1e-9, ("export", "formats"): "dxf,msh,vtu,inp",
    }  # fmt: skip
    hidden = {
        (name, one.name)
        for name, command in commands.items()
        for one in command.params
        if getattr(one, "hidden", False)
    }
    assert hidden == {("run", "only_needs")}


def test_repeatable_options_are_those_that_name_several_things(commands):
    several = {one.name for command in commands.values() for one in command.params if getattr(one, "multiple", False)}
    assert several == {"overrides", "over", "only", "gear", "folder", "teeth", "profile_shift"}


@pytest.mark.parametrize("option", ["--quiet", "--json"])
def test_every_voice_is_quiet_or_speaks_json_as_it_is_asked(commands, monkeypatch, option):
    seen = []

    def made(self, quiet=False, as_json=False):
        seen.append((quiet, as_json))
        raise StopError

    monkeypatch.setattr(Voice, "__init__", made)
    asked = [name for name, command in commands.items() if any(option in one.opts for one in command.params)]
    assert len(asked) >= 11
    for name in asked:
        with pytest.raises(StopError):
            called(commands, name, option)
        assert seen.pop() == (option == "--quiet", option == "--json"), name


def test_a_sizing_runs_as_asked(commands, monkeypatch):
    seen = []
    monkeypatch.setattr(size, "run_case", lambda *given, **more: seen.append((given, more)))
    called(commands, "size")
    (case, asked, out, voice), more = seen.pop()
    assert (case, asked, out) == (Path("a"), ['results=["sizing"]'], None)
    assert (voice.quiet, voice.as_json) == (False, False)
    assert more == {"scheduler": None, "workers": None, "plots": True, "cache": True}
    called(
        commands, "size", "--no-plots", "--no-cache", "--workers", "3", "--scheduler", "s", "--out", "o", "--set", "b=1"
    )
    (_, asked, out, _), more = seen.pop()
    assert (asked, out) == (["b=1", 'results=["sizing"]'], Path("o"))
    assert more == {"scheduler": "s", "workers": 3, "plots": False, "cache": False}


def test_a_run_is_made_as_asked(commands, monkeypatch):
    seen = []
    monkeypatch.setattr("fegear.commands.run.run_case", lambda *given, **more: seen.append((given, more)))
    called(commands, "run")
    (_, asked, out, _), more = seen.pop()
    plain = {"scheduler": None, "plots": True, "kind": "png", "cache": False, "with_fields": False, "only_needs": False}
    assert (asked, out, more) == ([], None, plain)
    for options, changed in (
        (["--no-plots"], {"plots": False}), (["--plots", "svg"], {"kind": "svg"}), (["--cache"], {"cache": True}),
        (["--fields"], {"with_fields": True}), (["--needs"], {"only_needs": True}),
        (["--scheduler", "s"], {"scheduler": "s"}),
    ):  # fmt: skip
        called(commands, "run", *options)
        assert seen.pop()[1] == plain | changed


def test_a_window_is_opened_as_asked(commands, monkeypatch):
    pytest.importorskip("nicegui", reason="nicegui is missing; pip install 'fegear[workbench]'")
    seen = []
    monkeypatch.setattr("fegear.window.server.serve", lambda *given, **more: seen.append((given, more)))
    called(commands, "open")
    assert seen.pop() == ((None, None), {"browser": True, "say": typer.echo, "folders": (), "look": False})
    called(
        commands, "open", "c.toml", "--port", "81", "--no-browser", "--folder", "f", "--folder", "g", "--read-only-link"
    )
    assert seen.pop() == (
        (Path("c.toml"), 81),
        {"browser": False, "say": typer.echo, "folders": [Path("f"), Path("g")], "look": True},
    )


@pytest.fixture
def folder(monkeypatch):
    """The folders that commands write to, by name; nothing is written."""
    made = []
    monkeypatch.setattr(
        "fegear.output.folder.whole_or_nothing", lambda target: made.append(target) or contextlib.nullcontext(target)
    )
    return made


def test_a_sweep_is_made_as_asked(commands, monkeypatch, folder):
    seen = []
    stopped(monkeypatch, "fegear.studies.sweep", "sweep_case", seen)
    with pytest.raises(StopError):
        called(commands, "sweep", "--over", "gear.a.teeth=20:22:3", "--quiet")
    ((case, axes, asked), more) = seen.pop()
    assert (case, [len(axis) for axis in axes], asked) == (Path("a"), [3], [])
    assert folder.pop() == Path("results") / "a_sweep"
    assert (more["executor"].scheduler, more["executor"].workers) == (None, None)
    assert more["cache"].disk is not None
    with pytest.raises(StopError):
        called(commands, "sweep", "--over", "gear.a.teeth=20:22:3", "--over", "gear.b.teeth=20:21:2", "--no-cache",
               "--workers", "2", "--out", "o", "--results", "geometry", "--quiet")  # fmt: skip
    ((case, axes, asked), more) = seen.pop()
    assert ([len(axis) for axis in axes], asked) == ([3, 2], ['results=["geometry"]'])
    assert folder.pop() == Path("o")
    assert more["executor"].workers == 2
    assert more["cache"].disk is None


def test_a_study_of_effects_is_made_of_those_that_are_named(commands, monkeypatch, folder):
    seen = []
    stopped(monkeypatch, "fegear.studies.effects", "effect_study", seen)
    for options, only in (([], ()), (["--effect", "friction", "--effect", "gear_body"], ["friction", "gear_body"])):
        with pytest.raises(StopError):
            called(commands, "effects", "--quiet", *options)
        ((case, asked, wanted, _), _) = seen.pop()
        assert (case, asked, wanted) == (Path("a"), [], only)
        assert folder.pop() == Path("results") / "a_effects"


def test_what_a_study_of_cost_asks_for(commands, monkeypatch, folder):
    seen = []
    monkeypatch.setattr("fegear.case.reading.read_scene", lambda case, asked: SimpleNamespace(gears={"a": 1}))
    monkeypatch.setattr("fegear.studies.cost.asked.asked", lambda scene: SimpleNamespace(quantities=()))
    ladder = SimpleNamespace(configurations=())
    monkeypatch.setattr("fegear.studies.cost.study.ladder_of", lambda studied, quick: seen.append(quick) or ladder)
    monkeypatch.setattr("fegear.studies.cost.study.forecast", lambda studied, ladder, quick: seen.append(quick) or 1.0)
    results = SimpleNamespace(solvers="", remarks=(), seconds=1.0, complete=False, finished=2, planned=5)
    monkeypatch.setattr(
        "fegear.studies.cost.study.study_cost", lambda studied, quick, watcher: seen.append(quick) or results
    )
    monkeypatch.setattr("fegear.output.cost.write_cost", lambda found, scratch, plots: seen.append((found, plots)))
    monkeypatch.setattr("fegear.output.cost.cheapest_lines", lambda found: [])
    for options, quick, plots in (([], False, True), (["--quick"], True, True), (["--no-plots"], False, False)):
        with pytest.raises(SystemExit) as left:
            called(commands, "cost", *options)
        assert left.value.code == 130  # what is there of an interrupted study is kept, and said to be a part
        assert seen == [quick, quick, quick, (results, plots)]
        seen.clear()
    results.complete = True
    called(commands, "cost")
