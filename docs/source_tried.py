"""Runs what was tried where a number of a paper differs, and holds it against what the list says that it gave.

    python docs/source_tried.py [PAPER [ITEM]]

A list of sources says in ``[[row.tried]]`` which readings of the text and which choices of what it leaves open were
tried, and what the numbers came to with each. Each is a case with something set in it; a test runs them again.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, NamedTuple, cast

from source_numbers import near
from source_rows import CASES, sources
from source_runs import Run

from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

if TYPE_CHECKING:
    from collections.abc import Iterator

    from source_rows import Row, Tried

    from fegear.workbench.results import Results


class Trial(NamedTuple):
    """Something tried, with the row that it belongs to."""

    paper: str
    row: Row
    tried: Tried

    @property
    def name(self) -> str:
        """Paper, item and what was tried."""
        return f"{self.paper}, {self.row.covers[0]}: {self.tried.what}"

    def run(self) -> Run:
        """What the case gives with what is set in it."""
        scene = read_scene(CASES / f"{self.row.case_of(self.tried)}.toml", (*self.row.trial, *self.tried.set))
        return Run.of(cast("Results", run_plan(scene, make_plan(scene, STAGES))))

    def gives(self) -> dict[str, float]:
        """What each of the numbers that it names comes to."""
        run = self.run()
        return {what: self.row.reading(self.tried, what).read(run).value for what in self.tried.gave}

    def faults(self) -> list[str]:
        """Where that is not what the list says."""
        return [
            f"{self.name}: {what} is {got:.6g}, the list says {self.tried.gave[what]:.6g}"
            for what, got in self.gives().items()
            if not near(got, self.tried.gave[what], self.tried.tolerance)
        ]


def trials(paper: str = "", item: str = "") -> Iterator[Trial]:
    """Everything that was tried by running a case, of all papers or of one."""
    for name, source in sources().items():
        for row in source.row:
            if paper in ("", name) and (not item or item in row.covers):
                yield from (Trial(name, row, tried) for tried in row.tried if tried.runs)


def main() -> None:
    """Print what each gives beside what the list says."""
    for trial in trials(*sys.argv[1:3]):
        for what, got in trial.gives().items():
            print(f"{trial.name}\n    {what}: {got:.6g} (the list says {trial.tried.gave[what]:.6g})", flush=True)


if __name__ == "__main__":
    main()
