"""``fegear new``: a case to start from."""

from __future__ import annotations

import os
import stat
import sys
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fegear.base.errors import PATH, InputError, shown
from fegear.commands.arguments import Quiet
from fegear.commands.help_texts import two_columns
from fegear.commands.schema import SCHEMA_FILE, write_schema
from fegear.commands.terminal import Voice, leave

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.notes import Note
    from fegear.case.drafts.answers import Answers


def complete_kinds(incomplete: str) -> list[str]:
    """What a kind that is being typed may become."""
    from fegear.case.drafts.kinds import KINDS

    return [name for name in KINDS if name.startswith(incomplete)]


def complete_examples(incomplete: str) -> list[str]:
    """What an example that is being typed may become."""
    from fegear.case.examples import names

    return [name for name in names() if name.startswith(incomplete)]


def new(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Name of the case: NAME.toml is written.", show_default=False)
    ],
    kind: Annotated[
        str | None,
        typer.Option(
            "--kind",
            help="gear, pair, relief, helical, gearbox, two-stage-gearbox, three-stage-gearbox, train, planetary, "
            "ring, rack or study. Default: from the numbers of teeth; a gearbox of four has two stages, of six three.",
            autocompletion=complete_kinds,
        ),
    ] = None,
    teeth: Annotated[
        list[str] | None,
        typer.Option(
            "--teeth", metavar="N [N]", help="Of driver and driven gear, of two stages all four, of three all six."
        ),
    ] = None,
    ratio: Annotated[
        str | None,
        typer.Option(
            "--ratio",
            help="Total ratio in place of --teeth, e.g. 14; of a gearbox above 6 by two stages, above 36 by three.",
        ),
    ] = None,
    module: Annotated[str | None, typer.Option("--module", metavar="LENGTH", help='E.g. "3 mm".')] = None,
    pressure_angle: Annotated[str | None, typer.Option("--pressure-angle", metavar="ANGLE", help="20 deg.")] = None,
    profile_shift: Annotated[
        list[str] | None,
        typer.Option(
            "--profile-shift",
            metavar="X [X]",
            help="Profile shift coefficients of driver and driven gear; of several stages two (for each) or all.",
        ),
    ] = None,
    rack: Annotated[str | None, typer.Option("--rack", metavar="A..D", help="Basic rack of ISO 53.")] = None,
    helix_angle: Annotated[str | None, typer.Option("--helix-angle", metavar="ANGLE", help="Helical pairs.")] = None,
    face_width: Annotated[str | None, typer.Option("--face-width", metavar="LENGTH", help='E.g. "30 mm".')] = None,
    torque: Annotated[
        str | None,
        typer.Option(
            "--torque",
            help='Torque on the driver, e.g. "260 N m"; for --kind relief also a range, "120 to 320 N m".',
        ),
    ] = None,
    power: Annotated[
        str | None, typer.Option("--power", help='Power at the speed of the driver instead of a torque, e.g. "5 kW".')
    ] = None,
    speed: Annotated[str | None, typer.Option("--speed", help='Speed of the driver, e.g. "1480 rpm".')] = None,
    tip_relief: Annotated[
        tuple[str, str] | None,
        typer.Option("--tip-relief", metavar="AMOUNT LENGTH", help='Tip relief of both gears, e.g. "20 um" "4 mm".'),
    ] = None,
    lead_error: Annotated[
        str | None,
        typer.Option(
            "--lead-error", metavar="LENGTH", help='Helical pairs: helix deviation over the face width, e.g. "10 um".'
        ),
    ] = None,
    life: Annotated[
        str | None,
        typer.Option("--life", help='Gearboxes: required life of gears and bearings. Default: "20000 h".'),
    ] = None,
    example: Annotated[
        str | None,
        typer.Option("--example", help="Copy an example case of fegear.", autocompletion=complete_examples),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
    no_schema: Annotated[bool, typer.Option("--no-schema", help="Do not write a schema file for editors.")] = False,
    quiet: Quiet = False,
) -> None:
    """Write a commented case that runs; on a terminal and without options, ask for what it needs.

    For example: fegear new drive --teeth 21 53 --profile-shift 0.3 0.1 --module 3mm --torque "260 N m"
    """
    from fegear.case.drafts.answers import ASSUMED_SPEED, Answers, kind_of, with_torque_of_power
    from fegear.case.drafts.first_size import with_teeth_of_ratio
    from fegear.case.drafts.sized import sized
    from fegear.case.drafts.text import draft
    from fegear.case.text_file import write_file

    voice = Voice(quiet)
    path = case_file(name, force=force)
    given = {
        "teeth": " ".join(teeth or ()),
        "ratio": ratio,
        "module": module,
        "pressure_angle": pressure_angle,
        "profile_shift": " ".join(profile_shift or ()),
        "rack": rack,
        "helix_angle": helix_angle,
        "face_width": face_width,
        "torque": torque,
        "power": power,
        "speed": speed,
        "tip_relief": tip_relief and tip_relief[0],
        "relief_length": tip_relief and tip_relief[1],
        "lead_error": lead_error,
        "life": life,
    }
    told = {key: text for key, text in given.items() if text}
    if example is not None:
        if told or kind:
            raise InputError(
                "--example",
                shown(example),
                "is a complete case",
                "use it without other options and edit the keys afterwards",
            )
        _copy_example(example, path, voice, force=force)
        return
    if not told and kind is None and sys.stdin.isatty() and sys.stdout.isatty():
        answers = _asked()
    else:
        kind, told, chosen = with_teeth_of_ratio(kind, with_torque_of_power(told))
        if chosen:
            voice.say(chosen)
        answers = Answers(kind_of(kind, told), told)
        if power and not speed:
            if not answers.has("speed"):
                raise InputError("--power", shown(power), "requires a speed, which this kind has not", "use --torque")
            voice.say(f"Torque of --power at an assumed speed of {ASSUMED_SPEED}; specify --speed")
    text = draft(answers, path.stem, "" if no_schema else SCHEMA_FILE)
    for line in sized(text):
        voice.say(line)
    for note in _check(text, path):
        voice.note(note)
    if not no_schema:
        beside = path.with_name(SCHEMA_FILE)
        write_schema(beside, "schema", remedy="move it, or use --no-schema")
        voice.say(f"Wrote {beside}, for completion and checks in editors")
    write_file(path, text.encode(), "NAME")
    voice.say(f"Wrote {path}; next: fegear run {path}")


def _copy_example(name: str, path: Path, voice: Voice, *, force: bool) -> None:
    """Write an example, and below its folder the files that it names: all of them, or nothing."""
    from fegear.case.examples import example
    from fegear.case.text_file import write_file

    text, files = example(name)
    beside = {path.parent / named: content for named, content in files.items()}
    for place, content in beside.items():
        _check_place(place, content, force=force)
    with ExitStack() as undone:
        for place, content in {**beside, path: text.encode()}.items():
            if not place.parent.is_dir():  # an example keeps its files one folder below
                _make_folder(place.parent)
                undone.callback(place.parent.rmdir)
            new = not os.path.lexists(place)
            write_file(place, content, "NAME")
            if new:
                undone.callback(place.unlink)
        undone.pop_all()
    for place in beside:
        voice.say(f"Wrote {place} (input of the case)")
    voice.say(f"Wrote {path}; next: fegear run {path}")


def _check_place(place: Path, content: bytes, *, force: bool) -> None:
    """Refuse a place where something else stands than what is to be written there."""
    told = shown(str(place), PATH)
    try:
        state = place.stat()
        if not stat.S_ISREG(state.st_mode):
            raise InputError("NAME", told, "is not a file, but required by the example", "rename or move it")
        same = state.st_size == len(content) and place.read_bytes() == content
    except FileNotFoundError:
        return
    except OSError as error:
        raise InputError("NAME", told, f"cannot be read ({error.strerror})", "choose another folder") from None
    if not same and not force:
        raise InputError(
            "NAME", told, "already exists and differs from the example", "rename it, or overwrite it with --force"
        )


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir()
    except OSError as error:
        rule = f"cannot be used as a folder ({error.strerror})"
        raise InputError("NAME", shown(str(folder), PATH), rule, "choose another folder for the case") from None


def case_file(name: str, *, force: bool) -> Path:
    """The file of a new case, below a folder that is there and in nobody's place."""
    from fegear.case.text_file import named_path

    path = named_path(name, "NAME")
    if path.name in ("", ".."):
        raise InputError("NAME", shown(name), "is a folder, not the name of a case", "for example drive")
    path = path if path.name.endswith(".toml") and path.stem != ".toml" else path.with_name(f"{path.name}.toml")
    told = shown(str(path), PATH)
    try:
        state = path.lstat()
    except FileNotFoundError:
        state = None
    except OSError as error:
        raise InputError("NAME", told, f"cannot be used as a file ({error.strerror})", "choose another name") from None
    if state is not None and stat.S_ISDIR(state.st_mode):
        raise InputError("NAME", told, "is a folder", "choose another name")
    if state is not None and not force:
        raise InputError("NAME", told, "already exists", "choose another name, or overwrite it with --force")
    if not path.parent.is_dir():
        raise InputError("NAME", told, "is in a folder that does not exist", "create it first")
    return path


def _asked() -> Answers:
    """Ask on the terminal; every answer is checked before the next question."""
    from fegear.case.drafts.answers import Answers, check, questions
    from fegear.case.drafts.kinds import KINDS

    def ask(prompt: str, default: str, judge: Callable[[str], object]) -> str:
        while text := input(f"{prompt} [{default}]: ").strip():
            try:
                judge(text)
            except InputError as error:
                typer.echo(f"  {error}")
            else:
                break
        return text

    for line in two_columns([(name, kind.about) for name, kind in KINDS.items()], max(map(len, KINDS))):
        typer.echo(line)
    typer.echo("Press Enter to accept the value in brackets.")
    try:
        kind = ask("Kind", "pair", lambda text: Answers(text, {})) or "pair"
        told: dict[str, str] = {}
        for number in range(len(questions(kind, {}))):
            question = questions(kind, told)[number]  # a default follows the answers before it
            if question.optional:
                continue
            text = ask(question.prompt, question.default, partial(check, question, len(KINDS[kind].gears)))
            told |= {question.name: text} if text else {}
    except KeyboardInterrupt:
        leave("interrupted; nothing was written.", 130)
    except EOFError:
        leave("input ended; nothing was written.", 2)
    return Answers(kind, told)


def _check(text: str, path: Path) -> tuple[Note, ...]:
    """Refuse numbers that make no case, before anything is written; what of a gearbox cannot be built.

    A module, teeth and bearings for a life may ask for more room than there is between two shafts.
    """
    import tomllib

    from fegear.case.built.bearing_room import said_of_room
    from fegear.case.reading import build_scene
    from fegear.engine.plan import make_plan
    from fegear.results.catalogue import STAGES

    scene = build_scene(tomllib.loads(text), path.stem, path.parent)
    make_plan(scene, STAGES)
    return said_of_room(scene)
