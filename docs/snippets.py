"""Run what a page of the docs asks its reader to type, and hold what is printed against what the page says.

``python docs/snippets.py PAGE FOLDER`` goes through the fenced blocks of the page in their order, in FOLDER:

- a block whose first line is ``# name.ext`` is a file of that name (a case, a table, a program), and with
  ``# name.ext, continued`` the rest of it;
- ``sh`` is run by the shell and ``python`` in one namespace for the whole page; a block that starts with
  ``# needs PROGRAM`` is passed over where that program is not installed;
- ``text`` is what the block before it prints. Numbers may differ in the last printed digit or by 0.4 %, error estimates
  (after ``+-``) by a factor of five; ``...`` stands for anything in a line, and alone for any lines.

Commands end with code 0 unless the page shows the refusal (a line that starts with ``fegear: ``).

``python docs/snippets.py --accept PAGE FOLDER`` writes the numbers that are printed now into the page; words stay, and
lines that are new or gone are refused: they are for a writer. Numbers in the prose of the page are for a writer, too.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shutil
import signal
import subprocess
import sys
import traceback
from dataclasses import dataclass
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
        """True if the block needs a program that is not installed."""
        found = _NEEDS.match(self.text.partition("\n")[0])
        return bool(found) and shutil.which(found[1]) is None


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
    """What a page says, with the numbers that are printed now where they are not the same.

    Raises
    ------
    DifferentError
        If more than numbers differs.
    """
    pairs = _aligned(expected, got, lambda _expected, _got: True)
    return "".join(line + "\n" if found is None else _renewed(line, found) + "\n" for line, found in pairs)


def _aligned(expected: str, got: str, same: Callable[[str, str], bool]) -> list[tuple[str, str | None]]:
    """Lines of a page with the printed lines that they stand for; none for ``...`` alone."""
    have = [line.rstrip() for line in got.strip("\n").splitlines()]
    pairs: list[tuple[str, str | None]] = []
    where = 0
    skipping = False

    def fits(line: str) -> bool:
        return _numbers(line, have[where]) is not None and same(line, have[where])

    for line in expected.strip("\n").splitlines():
        if line.strip() == "...":
            skipping = True
            pairs.append((line, None))
            continue
        while skipping and where < len(have) and not fits(line):
            where += 1
        if where >= len(have) or not fits(line):
            found = have[where] if where < len(have) else "(the end)"
            raise DifferentError(f"expected\n  {line}\nprinted\n  {found}\nin\n{got}")
        pairs.append((line, have[where]))
        where, skipping = where + 1, False
    if where < len(have) and not skipping:
        raise DifferentError(f"more is printed than expected:\n{chr(10).join(have[where:])}")
    return pairs


def _parts(expected: str) -> list[str]:
    """A line of a page cut at its numbers and ``...``, which are the odd parts."""
    return re.split(rf"((?<![\w.]){_NUMBER}|\.\.\.)", expected.rstrip())


def _numbers(expected: str, got: str) -> list[tuple[str, str, str]] | None:
    """Numbers of two lines that are the same but for them, each with the words before it; None for other lines."""
    parts = _parts(expected)
    pattern = "".join(
        re.escape(part) if i % 2 == 0 else (".*?" if part == "..." else f"({_NUMBER})") for i, part in enumerate(parts)
    )
    found = re.fullmatch(pattern, got)
    if not found:
        return None
    said = [(parts[i - 1], part) for i, part in enumerate(parts) if i % 2 and part != "..."]
    return [(before, part, printed) for (before, part), printed in zip(said, found.groups(), strict=True)]


def _same_numbers(expected: str, got: str) -> bool:
    return all(_same_number(*one) for one in _numbers(expected, got) or ())


def _renewed(expected: str, got: str) -> str:
    numbers = iter(_numbers(expected, got) or ())
    parts = _parts(expected)
    for i in range(1, len(parts), 2):
        if parts[i] != "...":
            before, said, printed = next(numbers)
            parts[i] = said if _same_number(before, said, printed) else printed
    return "".join(parts)


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
    done = 0
    for block in blocks(page):
        where = f"{page.name}, line {block.line}"
        if block.kind == "text":
            if printed is not None:
                try:
                    (_accept if accept else _compare)(page, block, printed)
                except DifferentError as error:
                    raise DifferentError(f"{where}: {error}") from None
                if refused and not re.search(r"^fegear: ", block.text, re.MULTILINE):
                    raise DifferentError(f"{where}: {refused}")
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
            ran = subprocess.run(["sh", "-eu", "-c", block.text], capture_output=True, text=True, check=False)
            printed = ran.stdout + (ran.stderr if ran.returncode else "")
            refused = f"{where}: ends with {ran.returncode}: {ran.stderr}{ran.stdout}" if ran.returncode else ""
            done += 1
        elif block.kind == "python":
            printed = _python(block, names, where)
            done += 1
    if refused:
        raise DifferentError(refused)
    return done


def _compare(_page: Path, block: Block, printed: str) -> None:
    compare(block.text, printed)


def _accept(page: Path, block: Block, printed: str) -> None:
    """Write the numbers that are printed now into a block of a page."""
    text = accepted(block.text, printed)
    lines = page.read_text("utf-8").splitlines(keepends=True)
    lines[block.line : block.line + block.text.count("\n")] = text.splitlines(keepends=True)
    page.write_text("".join(lines), "utf-8")


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
