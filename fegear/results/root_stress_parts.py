"""What the results of root stress share: where ``pair.NAME.root_stress`` takes it from, and how that is told."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.models.root_stress_source import FINITE_ELEMENTS
from fegear.results.gear_solution import needs_solution
from fegear.results.sources import ROOT_STRESS_CITATIONS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.case.reading import Scene
    from fegear.engine.citation import Citation
    from fegear.engine.stage import Task

#: Seconds of a formula's table over one flank; those that look for a place on the trochoid take longer.
_FORMULA_SECONDS = {"cornell-trochoid": 0.2, "heywood": 0.15, "agma-908": 0.12, "dolan-broghamer": 0.1}


def stress_sources(scene: Scene, pair: str) -> tuple[str, ...]:
    """Names of a pair's sources of root stress; the first is the result, the others stand beside it."""
    return scene.case.pair[pair].root_stress.source


def needs_sources(scene: Scene, pair: str) -> tuple[Task, ...]:
    """The finite-element solutions that they ask for."""
    part = scene.case.pair[pair]
    return needs_solution(part.driver, part.driven) if FINITE_ELEMENTS in part.root_stress.source else ()


def cited_sources(scene: Scene, pair: str) -> Iterator[Citation]:
    """What they rest on."""
    for source in stress_sources(scene, pair):
        yield from ROOT_STRESS_CITATIONS[source]


def seconds_of(sources: tuple[str, ...]) -> float:
    """What the formulas among them take for both gears."""
    return 2.0 * sum(_FORMULA_SECONDS.get(source, 0.03) for source in sources if source != FINITE_ELEMENTS)


def ending(sources: tuple[str, ...], k: int) -> str:
    """What the names of columns and values of the k-th source end in: nothing for the first."""
    return f"_{sources[k].replace('-', '_')}" if k else ""


def told(source: str) -> str:
    """A source in words."""
    return "finite elements" if source == FINITE_ELEMENTS else source


def formula_remarks(pair: str, notes: Mapping[str, Mapping[str, tuple[str, ...]]], *, coupled: bool) -> tuple[str, ...]:
    """What formulas say of their own values, and that they leave the neighbours' loads out where those count.

    Parameters
    ----------
    pair : str
    notes : mapping of str to mapping of str to tuple of str
        What each source says of itself, by gear and source.
    coupled : bool
        Whether the case counts the loads of neighbouring teeth.
    """
    remarks = [
        f"Pair {pair}, gear {gear}, root stress by {source}: {note}."
        for gear, sources in notes.items()
        for source, found in sources.items()
        for note in found
    ]
    alone = dict.fromkeys(source for found in notes.values() for source in found if source != FINITE_ELEMENTS)
    if coupled and alone:
        remarks.append(f"Pair {pair}: root stress by {', '.join(alone)} is that of a tooth's own load alone.")
    return tuple(remarks)
