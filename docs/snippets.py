"""Run what a page of the docs asks its reader to type, and compare what is printed with what the page says.

``python docs/snippets.py PAGE FOLDER`` goes through the fenced blocks of the page in their order, in FOLDER:

- a block whose first line is ``# name.ext`` is a file of that name (a case, a table, a program), and with
  ``# name.ext, continued`` the rest of it;
- ``sh`` is run by the shell and ``python`` in one namespace for the whole page; a block that starts with
  ``# needs NAME`` is passed over where no program and no Python package of that name is installed;
- ``text`` is what the block before it prints. Numbers may differ in the last printed digit or by 0.4 %, error estimates
  (after ``+-``) by a factor of five; ``...`` stands for anything in a line, alone for any lines but notes: a command
  that has notes for its reader (``Note: ...``) is followed by a block with all of them, whole; their numbers may differ
  by 5 %, errors in them by a factor of five. Columns may stand elsewhere: a number that ends in a zero is shorter.
- a number of the prose that comes from a run is followed by a comment that no reader sees and that says where from:
  ``229<!-- loaded: I.driver.largest_root_tension -->`` is a value of ``results/loaded``, ``41<!-- = EXPRESSION -->``
  whatever Python makes of the names of the page's programs, of ``value("loaded", "I.te_mean")``, ``error`` and
  ``printed(r"REGEX")``, the number that a run of the page has printed as the regular expression's first group.

Commands end with code 0 unless the page shows the refusal (a line that starts with ``fegear: ``).

``python docs/snippets.py --accept PAGE FOLDER`` writes the numbers that are printed now into the page; words stay, and
notes of the run that are missing are put in; other lines that are new or gone are refused: they are for a writer.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import traceback
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).resolve().parents[1]
_FENCE = re.compile(r"^```([\w-]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_FILE = re.compile(r"# ([\w.-]+\.(?:toml|csv|py))(, continued)?$")
_NEEDS = re.compile(r"# needs ([\w-]+)$")
_NUMBER = r"-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?"
_RELATIVE, _ESTIMATE = 4e-3, 5.0
#: What a note says of sizes may differ by this part: they are of what is neglected, and of searches.
_OF_NOTES = 5e-2
_NOTE = "Note: "
_FILLED = re.compile(rf"({_NUMBER})<!-- (?:= (.+?)|([\w.-]+): ([\w.-]+)) -->")


class DifferentError(AssertionError):
    """What a block prints is not what its page says."""


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text and the line of the page where it starts."""

    kind: str
    text: str
    line: int

    @property
    def file(self) -> str | None:
        """Name of the file that the block is, if it is one."""
        found = _FILE.match(self.text.partition("\n")[0])
        return found[1] if found else None

    def write(self) -> None:
        """Write the file, or what comes after an earlier block of it."""
        found = _FILE.match(self.text.partition("\n")[0])
        if found:
            before = Path(found[1]).read_text("utf-8") if found[2] else ""
            Path(found[1]).write_text(before + self.text, "utf-8")

    @property
    def missing(self) -> bool:
        """True if the block needs a program or a package that is not installed."""
        found = _NEEDS.match(self.text.partition("\n")[0])
        return bool(found) and shutil.which(found[1]) is None and importlib.util.find_spec(found[1]) is None


def blocks(page: Path) -> list[Block]:
    """Fenced blocks of a page in their order."""
    text = page.read_text("utf-8")
    return [Block(m[1], m[2], text.count("\n", 0, m.start()) + 1) for m in _FENCE.finditer(text)]


def runs(page: Path) -> bool:
    """True if the page has something to run."""
    return any(b.kind in ("sh", "python") and b.file is None for b in blocks(page))


def compare(expected: str, got: str) -> None:
    """Raise `DifferentError` unless `got` is what a page says (see the module)."""
    _aligned(expected, got, _same_numbers)


def accepted(expected: str, got: str) -> str:
    """What a page says, with the numbers that are printed now where they are not the same, and with every note.

    Raises
    ------
    DifferentError
        If more than numbers and notes differs.
    """
    pairs = _aligned(expected, got, lambda _expected, _got: True, notes_may_lack=True)
    return "".join(line + "\n" if found is None else _renewed(line, found) + "\n" for line, found in pairs)


@dataclass
class _Reading:
    """How far what is printed has been read along a page: pairs of lines, none for ``...`` and for notes put in."""

    have: list[str]
    notes_may_lack: bool
    pairs: list[tuple[str, str | None]] = field(default_factory=list)
    where: int = 0

    @property
    def ended(self) -> bool:
        return self.where >= len(self.have)

    def skip(self) -> None:
        """Pass over a line that the page elides."""
        line = self.have[self.where]
        if line.startswith(_NOTE):
            if not self.notes_may_lack:
                raise DifferentError(f"the page does not have the run's\n  {line}")
            self.pairs.append((line, None))
        elif not self.pairs or self.pairs[-1][0] != "...":
            self.pairs.append(("...", None))
        self.where += 1

    def take(self, line: str, *, same: Callable[[str, str], bool]) -> bool:
        """Whether a line of the page stands for the next one that is printed, which then counts as read."""
        if self.ended or _numbers(line, self.have[self.where]) is None:
            return False
        printed = self.have[self.where]
        elided = line.startswith(_NOTE) and "..." in line and "..." not in printed
        if not same(line, printed) or (elided and not self.notes_may_lack):
            return False
        self.pairs.append((printed, None) if elided else (line, printed))
        self.where += 1
        return True


def _aligned(
    expected: str, got: str, same: Callable[[str, str], bool], *, notes_may_lack: bool = False
) -> list[tuple[str, str | None]]:
    """Lines of a page with the printed lines that they stand for; none for ``...`` alone, and for notes put in."""
    reading = _Reading([line.rstrip() for line in got.strip("\n").splitlines()], notes_may_lack)
    skipping = False
    for line in expected.strip("\n").splitlines():
        if line.strip() == "...":
            skipping = True
            continue
        while not reading.take(line, same=same):
            if reading.ended or not skipping:
                found = "(the end)" if reading.ended else reading.have[reading.where]
                raise DifferentError(f"expected\n  {line}\nprinted\n  {found}\nin\n{got}")
            reading.skip()
        skipping = False
    while skipping and not reading.ended:
        reading.skip()
    if not reading.ended:
        raise DifferentError(f"more is printed than expected:\n{chr(10).join(reading.have[reading.where :])}")
    return reading.pairs


def _parts(expected: str) -> list[str]:
    """A line of a page cut at its numbers and ``...``, which are the odd parts."""
    return re.split(rf"((?<![\w.]){_NUMBER}|\.\.\.)", expected.rstrip())


def _texts(part: str) -> str:
    """Pattern of a line's words: columns of a table move as their numbers have a digit more or less."""
    return "  +".join(re.escape(words) for words in re.split(r"  +", part))


def _printed(expected: str, got: str) -> list[str] | None:
    """Another line cut as that of the page, if both are the same but for numbers; None for other lines."""
    pattern = "".join(
        f"({_texts(part) if i % 2 == 0 else '.*?' if part == '...' else _NUMBER})"
        for i, part in enumerate(_parts(expected))
    )
    found = re.fullmatch(pattern, got)
    return list(found.groups()) if found else None


def _numbers(expected: str, got: str) -> list[tuple[str, str, str]] | None:
    """Numbers of two lines that are the same but for them, each with the words before it; None for other lines."""
    said, printed = _parts(expected), _printed(expected, got)
    if printed is None:
        return None
    return [(said[i - 1], said[i], printed[i]) for i in range(1, len(said), 2) if said[i] != "..."]


def _same_numbers(expected: str, got: str) -> bool:
    same = _same_in_note if expected.startswith(_NOTE) else _same_number
    return all(same(*one) for one in _numbers(expected, got) or ())


def _same_in_note(before: str, expected: str, got: str) -> bool:
    """Errors stand in notes as `+- 0.2 um (34 %)` and as `reaches 8e-02`."""
    a, b = float(expected), float(got)
    estimate = before.rstrip().endswith(("+-", "(", "reaches")) and a > 0.0 and 1.0 / _ESTIMATE < b / a < _ESTIMATE
    return estimate or abs(a - b) <= _OF_NOTES * abs(a) or _same_number(before, expected, got)


def _renewed(expected: str, got: str) -> str:
    same = _same_in_note if expected.startswith(_NOTE) else _same_number
    said, printed = _parts(expected), _printed(expected, got) or ()
    stays = [part == "..." or same(said[i - 1], part, printed[i]) for i, part in enumerate(said) if i % 2]
    if all(stays) or "..." in said:
        return "".join(part if i % 2 == 0 or stays[i // 2] else printed[i] for i, part in enumerate(said))
    # The columns of a line with a new number are those that are printed.
    return "".join(
        said[i] if i % 2 and stays[i // 2] and len(said[i]) == len(part) else part for i, part in enumerate(printed)
    )


def _same_number(before: str, expected: str, got: str) -> bool:
    a, b = float(expected), float(got)
    if before.rstrip().endswith("+-"):
        return a == b or (a > 0.0 and 1.0 / _ESTIMATE < b / a < _ESTIMATE)
    mantissa, _, exponent = expected.lower().partition("e")
    if "." not in mantissa and not exponent:
        return a == b or (abs(a) >= 1000.0 and abs(a - b) <= _RELATIVE * abs(a))
    digits = len(mantissa.partition(".")[2])
    last = 10.0 ** (int(exponent or 0) - digits)
    return abs(a - b) <= max(1.5 * last, _RELATIVE * abs(a))


def run_page(page: Path, *, accept: bool = False) -> int:
    """Run a page in the current folder; the number of blocks that were run or compared.

    With `accept` the numbers that are printed now are written into the page.

    Raises
    ------
    DifferentError
        With the page's line, if a block does not do what the page says.
    """
    names: dict[str, object] = {"__name__": "__main__"}
    printed: str | None = None
    refused = ""
    everything = ""
    done = inserted = 0
    found = blocks(page)
    for number, block in enumerate(found):
        where = f"{page.name}, line {block.line}"
        if block.kind == "text":
            if printed is not None:
                _answer(page, number + inserted, where, printed, refused, accept=accept)
                done += 1
            printed, refused = None, ""
            continue
        if refused:
            raise DifferentError(refused)
        printed = None
        if block.missing:
            continue
        if block.file:
            block.write()
        elif block.kind == "sh":
            printed, refused = _shell(block, where)
            done += 1
            if [after.kind for after in found[number + 1 : number + 2]] != ["text"]:
                inserted += _unshown_notes(page, number + inserted, where, printed, accept=accept)
        elif block.kind == "python":
            printed = _python(block, names, where)
            done += 1
        everything += printed or ""
    if refused:
        raise DifferentError(refused)
    _fill(page, names, everything, accept=accept)
    return done


def _shell(block: Block, where: str) -> tuple[str, str]:
    """What a command prints, and what it complains of."""
    ran = subprocess.run(["sh", "-eu", "-c", block.text], capture_output=True, text=True, check=False)
    if not ran.returncode:
        return ran.stdout, ""
    return ran.stdout + ran.stderr, f"{where}: ends with {ran.returncode}: {ran.stderr}{ran.stdout}"


def _answer(page: Path, number: int, where: str, printed: str, refused: str, *, accept: bool) -> None:
    """Compare a block of a page with what is printed, or renew it."""
    said = blocks(page)[number].text
    try:
        _accept(page, number, printed) if accept else compare(said, printed)
    except DifferentError as error:
        raise DifferentError(f"{where}: {error}") from None
    if refused and not re.search(r"^fegear: ", said, re.MULTILINE):
        raise DifferentError(f"{where}: {refused}")


def _unshown_notes(page: Path, number: int, where: str, printed: str, *, accept: bool) -> int:
    """Refuse a command without a block for its notes, or put one in; how many were put in."""
    if not re.search(f"^{_NOTE}", printed, re.MULTILINE):
        return 0
    if not accept:
        raise DifferentError(f"{where}: the page shows no note of\n{printed}")
    block = blocks(page)[number]
    lines = page.read_text("utf-8").splitlines(keepends=True)
    end = block.line + block.text.count("\n") + 1
    lines[end:end] = ["\n", "```text\n", *accepted("...", printed).splitlines(keepends=True), "```\n"]
    page.write_text("".join(lines), "utf-8")
    return 1


def _accept(page: Path, number: int, printed: str) -> None:
    """Write the numbers that are printed now into a block of a page."""
    block = blocks(page)[number]
    lines = page.read_text("utf-8").splitlines(keepends=True)
    lines[block.line : block.line + block.text.count("\n")] = accepted(block.text, printed).splitlines(keepends=True)
    page.write_text("".join(lines), "utf-8")


def _fill(page: Path, names: dict[str, object], everything: str, *, accept: bool) -> None:
    """Compare the numbers of the prose with what the page's runs found, or write them anew."""

    def of(run: str, name: str, what: str) -> float:
        return float(json.loads(Path("results", run, "summary.json").read_text("utf-8"))["results"][name][what])

    def value(run: str, name: str) -> float:
        return of(run, name, "value")

    def error(run: str, name: str) -> float:
        return of(run, name, "error")

    def printed(pattern: str) -> float:
        found = re.search(pattern, everything)
        if not found:
            raise DifferentError(f"{page.name}: nothing that is printed fits {pattern}")
        return float(found[1])

    known = {"value": value, "error": error, "printed": printed}

    def renewed(place: re.Match[str]) -> str:
        said, expression, run, name = place.groups()
        try:
            now = eval(expression, {**names, **known}) if expression else value(run, name)
        except (ArithmeticError, LookupError, NameError, OSError, TypeError, ValueError) as fault:
            raise DifferentError(f"{page.name}: {place[0]} cannot be filled: {fault!r}") from None
        digits = len(said.partition(".")[2])
        room = max(0.6 * 10.0**-digits, _RELATIVE * abs(float(said)))
        estimate = "error(" in (expression or "") and 1.0 / _ESTIMATE < float(now) / float(said) < _ESTIMATE
        if estimate or abs(float(now) - float(said)) <= room:
            return place[0]
        if not accept:
            raise DifferentError(f"{page.name}: the prose has {place[0]}, the run {now:.6g}")
        return f"{now:.{digits}f}" + place[0].removeprefix(said)

    text = page.read_text("utf-8")
    filled = _FILLED.sub(renewed, text)
    if accept and filled != text:
        page.write_text(filled, "utf-8")


def _python(block: Block, names: dict[str, object], where: str) -> str:
    out = io.StringIO()
    try:
        with contextlib.redirect_stdout(out):
            exec(compile(block.text, where, "exec"), names)
    except Exception:  # noqa: BLE001  (whatever the page's program raises is the page's fault)
        raise DifferentError(f"{where}: {traceback.format_exc(limit=-3)}") from None
    return out.getvalue()


def prepare(folder: Path) -> dict[str, str]:
    """Make `folder` an empty one as a user's; the environment to run a page in."""
    shutil.rmtree(folder, ignore_errors=True)
    programs = folder / ".bin"
    programs.mkdir(parents=True)
    for name, module in (("fegear", " -m fegear"), ("dask", " -m dask"), ("python", "")):
        script = programs / name
        script.write_text(f'#!/bin/sh\nexec "{sys.executable}"{module} "$@"\n')
        script.chmod(0o755)
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    return {
        **os.environ,
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": path,
        "FEGEAR_CACHE": str(folder / ".cache"),
        "OMP_NUM_THREADS": "1",
        "MPLBACKEND": "agg",
    }


def execute(page: Path, folder: Path, *, accept: bool = False) -> str:
    """Run a page in a folder of its own, in a process of its own; what went wrong, or nothing.

    What the page's commands left running in the background, a cluster for example, ends with it.
    """
    environment = prepare(folder)
    command = [sys.executable, str(Path(__file__)), *(["--accept"] if accept else []), str(page)]
    pipe = subprocess.PIPE
    running = subprocess.Popen(
        command, cwd=folder, env=environment, stdout=pipe, stderr=pipe, text=True, start_new_session=True
    )
    try:
        _, complaint = running.communicate()
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(running.pid, signal.SIGTERM)
    return complaint or f"ends with {running.returncode}" if running.returncode else ""


if __name__ == "__main__":
    accepts = sys.argv[1] == "--accept"
    asked, *into = sys.argv[2:] if accepts else sys.argv[1:]
    if into:
        made = Path(into[0]).resolve()
        if made.exists() and not (made / ".bin").is_dir():
            sys.exit(f"{made} is there and not from an earlier run of a page; it would be emptied")
        sys.exit(execute(Path(asked).resolve(), made, accept=accepts) or 0)
    try:
        run_page(Path(asked), accept=accepts)
    except DifferentError as difference:
        sys.exit(str(difference))
