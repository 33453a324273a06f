"""Formats that ``fegear export`` writes, each a row: what it holds, and who writes it if not fegear itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Literal

from fegear.base.extensions import added
from fegear.case.reading import Scene

#: Of the gears, as drawings and tables with their relief; their meshes, as generated; what holds no single gear.
Holds = Literal["flanks", "plane mesh", "solid mesh", "case"]
#: Writes files into an empty folder: ``write(scene, folder, gears)`` -> their paths, and sentences for the user.
Writer = Callable[[Scene, Path, Sequence[str]], tuple[Sequence[Path], Sequence[str]]]


@dataclass(frozen=True)
class Format:
    """A format of an export.

    Parameters
    ----------
    holds : {"flanks", "plane mesh", "solid mesh", "case"}
    about : str
        What its files are, for lists.
    write : callable, optional
        Of a format that another distribution adds (entry points of ``fegear.formats``):
        ``write(scene, folder, gears)`` -> paths, and sentences for the user; the gears are those that were asked for.
    """

    holds: Holds
    about: str
    write: Writer | None = None


#: Formats of fegear by their names, in the order in which messages list them.
FORMATS: Mapping[str, Format] = MappingProxyType({
    "dxf": Format("flanks", "drawing of a tooth and of the gear"),
    "step": Format("flanks", "solid of the gear"),
    "relief": Format("flanks", "relief to grind, as tables"),
    "msh": Format("plane mesh", "mesh of one tooth sector, Gmsh"),
    "vtu": Format("plane mesh", "mesh of the gear, ParaView"),
    "inp": Format("plane mesh", "mesh of the gear, Abaqus and CalculiX"),
    "solid-inp": Format("solid mesh", "mesh of the gear with its width, Abaqus and CalculiX"),
    "solid-vtu": Format("solid mesh", "mesh of the gear with its width, ParaView"),
    "fmu": Format("case", "each loaded pair as a force element, FMI 2.0"),
    "rexs": Format("case", "the gearbox as a REXS model"),
})  # fmt: skip


def formats() -> Mapping[str, Format]:
    """Those of fegear, and those that other distributions add.

    Raises
    ------
    InputError
        See `fegear.base.extensions.added`.
    """
    return MappingProxyType({**FORMATS, **added("formats", Format, FORMATS)})


def of_kind(holds: Holds) -> frozenset[str]:
    """Names of fegear's formats of a kind."""
    return frozenset(name for name, one in FORMATS.items() if one.holds == holds)
