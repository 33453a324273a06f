"""What each stage's results rest on: papers and standards with the equations that were used.

A source is named for the effects that are on and the compliances that were chosen, not for all that fegear could do.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fegear.engine.run import Results
    from fegear.engine.stage import Task


@dataclass(frozen=True)
class Work:
    """A paper, a book or a standard."""

    key: str
    authors: str
    year: int
    published: str
    title: str = ""

    @property
    def short(self) -> str:
        """``Mark 1982``, ``Lin and others 1987``, ``ISO 6336-3:2006``."""
        if self.authors.startswith("ISO"):
            return f"{self.authors}:{self.year}"
        if self.authors.startswith("AGMA"):
            return self.authors
        names = [name.rsplit(" ", 1)[-1] for name in self.authors.removesuffix(" and others").split(", ")]
        if len(names) > 2 or self.authors.endswith(" and others"):
            return f"{names[0]} and others {self.year}"
        return f"{' and '.join(names)} {self.year}"

    @property
    def full(self) -> str:
        """``W. D. Mark (1982): The Transfer ... NASA Contractor Report 3626.``."""
        return f"{self.authors} ({self.year}): {f'{self.title}. ' if self.title else ''}{self.published}."


class Citation(NamedTuple):
    """A source of a stage: which work, where in it, and what for."""

    key: str
    what: str
    where: str = ""


@cache
def bibliography() -> dict[str, Work]:
    """All works, by key."""
    told = resources.files("fegear.output.report").joinpath("bibliography.toml").read_text("utf-8")
    return {key: Work(key, **entry) for key, entry in tomllib.loads(told).items()}


_RING = (
    Citation("thomas", "one tooth sector stands for the whole ring: harmonics of a cyclic structure"),
    Citation("gmsh", "mesh of the tooth"),
)
_PATCH = Citation("johnson", "the contact's own deformation, and the swap of its half-width", "sections 4.2(c) and 5.6")
_HERTZ = Citation("hertz", "half-width and pressure of the contact")
_INVOLUTE = Citation("iso-21771", "names and geometry of involute gears and pairs")
_CLOSED: dict[str, tuple[Citation, ...]] = {
    "cornell": (
        Citation("cornell", "compliance of tooth and foundation"),
        Citation("lin-huston-coy", "the form in which it is computed", "Eqs. 5 to 11"),
        Citation("lundberg-palmgren", "approach of the teeth"),
    ),
    "weber-banaschek": (Citation("weber-banaschek", "compliance of tooth, foundation and contact"),),
    "potential-energy": (
        Citation("yang-lin", "bending, axial and contact compliance"),
        Citation("tian", "shear compliance"),
        Citation("wan", "beam that starts on the root circle and follows the fillet"),
        Citation("sainsot", "compliance of the gear body", "Eqs. 14 and 15, Table 1"),
    ),
}
_ROOT_FORMULAS = (
    Citation("cornell", "root stress"),
    Citation("mark", "the form in which Cornell's formula is computed", "Eqs. B.1 to B.10"),
    Citation("heywood", "fillet stress of a loaded projection"),
    Citation("kelley-pedersen", "Heywood's formula for gear teeth"),
    Citation("iso-6336-3", "Y_F, Y_S and nominal root stress", "method B, clauses 5 to 9"),
    Citation("agma-908", "geometry factor J", "section 5"),
    Citation("dolan-broghamer", "stress concentration in the fillet"),
    Citation("lewis", "section of a beam of uniform strength"),
)


def _geometry(_results: Results, _task: Task) -> Iterator[Citation]:
    yield _INVOLUTE
    yield Citation("iso-53", "standard basic racks", "Table 1")


def _solution(_results: Results, _task: Task) -> Iterator[Citation]:
    yield from _RING


def _stiffness(_results: Results, _task: Task) -> Iterator[Citation]:
    yield from _RING
    yield _PATCH
    yield _HERTZ


def _root_stress(_results: Results, _task: Task) -> Iterator[Citation]:
    yield from _RING
    yield Citation("iso-6336-3", "the 30 degree tangent that the place is compared with", "clause 6")


def _crosscheck(_results: Results, _task: Task) -> Iterator[Citation]:
    yield from _ROOT_FORMULAS
    for group in _CLOSED.values():
        yield from group
    yield Citation("iso-6336-1", "single tooth stiffness c'", "clause 9, method B")
    yield from _RING


def _study(_results: Results, _task: Task) -> Iterator[Citation]:
    yield from _ROOT_FORMULAS
    yield from _RING


def _loaded_pair(results: Results, task: Task) -> Iterator[Citation]:
    source = results.scene.case.pair[task.subject].compliance.source if task.subject in results.scene.case.pair else ""
    if source == "fe":
        yield from _RING
    yield from _CLOSED.get(source, ())
    if results.scene.case.effects.hertz != "none":
        yield _HERTZ
        yield _PATCH


def _load_sharing(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("mark", "load sharing of the tooth pairs in reach", "Appendix A")
    yield _HERTZ


def _transmission_error(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("mark", "static transmission error, its Fourier series and the mean compliance", "1.1 to 1.11, A.11")
    yield Citation("lin-townsend-oswald", "effective error A_e")
    yield Citation("harris", "transmission error over the mesh cycle for a family of loads")


def _root_history(_results: Results, _task: Task) -> Iterator[Citation]:
    yield from _RING
    yield Citation("mark", "root stress of a tooth on its way through the mesh", "section 3, Appendix B")


def _relief(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("mark", "relief that leaves no transmission error at the design load", "Eqs. 4.6 to 4.16, 5.4")
    yield Citation("lin-townsend-oswald", "linear and parabolic tip relief")
    yield Citation("harris", "Harris maps")


def _relief_chart(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("lin-townsend-oswald", "charts of tip relief, normalised length and amount, effective error A_e")


def _helical(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("litvin", "surfaces, tooth contact analysis, edge contact", "Appendices 1 to 5")
    yield Citation("johnson", "contact ellipses")


def _train(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("mark", "gear train of rotors, shafts and meshes", "section 2")
    yield Citation("lin-huston-coy", "four-inertia model, damping", "Eqs. 1 to 4 and 16")


def _increments(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("mark", "transmission-error dynamic increment functions", "Eqs. 2.57 to 2.66")


def _spectrum(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("mark", "spectra of the mesh force", "Eqs. 3.1 to 3.11")


def _tooth_force(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("mark", "force on a single tooth pair", "Eqs. 3.23 to 3.29")


def _dynamic_root(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("mark", "root stress of a single tooth in motion", "section 3")


def _motion(results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("lin-huston-coy", "contact, its loss, and contact on the back flanks", "Eqs. 19 to 24")
    if results.scene.case.effects.is_on("friction"):
        yield Citation("lin-huston-coy", "tooth friction", "Eqs. 17 and 18")


def _dynamic_factor(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("lin-townsend-oswald", "dynamic factor over speed")


def _design_chart(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("lin-townsend-oswald", "design charts of tip relief by dynamic factor")


def _transmissibility(_results: Results, _task: Task) -> Iterator[Citation]:
    yield Citation("blankenship-singh", "stiffness, transmissibility and modal indices", "Eqs. 2 to 30 and 37 to 39")


#: For each stage, what its results rest on.
SOURCES: dict[str, Callable[[Results, Task], Iterator[Citation]]] = {
    "geometry": _geometry,
    "gear-solution": _solution,
    "stiffness": _stiffness,
    "root-stress": _root_stress,
    "crosscheck": _crosscheck,
    "root-stress-study": _study,
    "loaded-pair": _loaded_pair,
    "load-sharing": _load_sharing,
    "transmission-error": _transmission_error,
    "root-stress-history": _root_history,
    "relief": _relief,
    "relief-chart": _relief_chart,
    "robustness": _relief_chart,
    "tooth-contact": _helical,
    "gear-train": _train,
    "natural-modes": _train,
    "dynamic-increments": _increments,
    "mesh-force-spectrum": _spectrum,
    "tooth-force": _tooth_force,
    "dynamic-root-stress": _dynamic_root,
    "motion": _motion,
    "dynamic-factor": _dynamic_factor,
    "design-chart": _design_chart,
    "transmissibility": _transmissibility,
}


def citations(results: Results, task: Task) -> tuple[Citation, ...]:
    """Return the sources of one task; none for a stage without an entry."""
    found = SOURCES.get(task.stage)
    return tuple(dict.fromkeys(found(results, task))) if found else ()
