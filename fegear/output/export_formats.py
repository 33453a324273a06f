"""Formats that ``fegear export`` writes, each a row: what it holds, what its files are, and what writes them.

Help, messages, the window's menu and the page on exports read the rows, so a format is one function and its row. The
functions of fegear's own rows are named as entry points are, and imported when a file of theirs is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

from fegear.base.extensions import Added, Guarded, added

if TYPE_CHECKING:
    from fegear.base.solution_cache import SolutionCache
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear
    from fegear.studies.comparison.compare import Side

#: Of the gears, as drawings and tables with their relief; their meshes, as generated; what holds no single gear.
Holds = Literal["flanks", "plane mesh", "solid mesh", "case"]


@dataclass(frozen=True)
class Request:
    """What a format is to write, and where.

    Parameters
    ----------
    scene : Scene
    folder : Path
        Empty, but for the files of other formats.
    gears : tuple of str
        One gear; of a format that holds a case all those that were asked for.
    results : Side or None
        Of a run of the case, where it was given instead of the case.
    cache : SolutionCache
        For what several formats of a gear need: ``cache.call(function, *args).value``.
    """

    scene: Scene
    folder: Path
    gears: tuple[str, ...]
    results: Side | None
    cache: SolutionCache

    @property
    def name(self) -> str:
        """Name of the gear."""
        return self.gears[0]

    @property
    def gear(self) -> Gear:
        """The gear."""
        return self.scene.gears[self.name]


#: What a format wrote: paths below the folder, and sentences for the user.
Written = tuple[Sequence[Path], Sequence[str]]


@dataclass(frozen=True)
class Format:
    """A format of an export.

    Parameters
    ----------
    holds : {"flanks", "plane mesh", "solid mesh", "case"}
        One that holds a gear is asked for each gear, plane meshes for spur gears, solid ones for external gears.
    about : str
        What its files are, for lists.
    write : callable or str
        ``write(request)`` -> paths, and sentences for the user; or its place, ``"module:function"``.
    files : str
        Names of its files, for the page on exports.
    contents : str
        What is in them, for the page on exports.
    needs : callable or str
        Called without arguments before anything is written: refuses where something is not installed.
    seconds : callable or str
        ``seconds(gear)`` -> about the CPU time that a gear's file takes; said before it starts if it is long.
    takes_results : bool
        Whether the folder of a run may stand in the place of the case.
    asymmetric : bool
        Whether it holds teeth with two different flanks; gears with such teeth are refused by the others.
    racks : callable or str
        ``racks(request)`` as `write`, for a rack of the case; empty where the format holds none.
    """

    holds: Holds
    about: str
    write: Callable[[Request], Written] | str
    files: str = ""
    contents: str = ""
    needs: Callable[[], object] | str = ""
    seconds: Callable[[Gear], float] | str = ""
    takes_results: bool = False
    asymmetric: bool = False
    racks: Callable[[Request], Written] | str = ""

    def written(self, request: Request) -> Written:
        """Write what is asked for."""
        found: Written = _called(self.write)(request)
        return found

    def written_rack(self, request: Request) -> Written:
        """Write the rack that is asked for."""
        found: Written = _called(self.racks)(request)
        return found

    def require(self) -> None:
        """Refuse where something that it needs is not there."""
        if self.needs:
            _called(self.needs)()

    def predicted(self, gear: Gear) -> float:
        """About how many seconds of CPU time a gear's file takes; 0 where nothing is said."""
        return float(_called(self.seconds)(gear)) if self.seconds else 0.0


def _called(function: Callable[..., Any] | str) -> Callable[..., Any]:
    """A function, or the one that stands in a place."""
    if not isinstance(function, str):
        return function
    module, _, name = function.partition(":")
    found: Callable[..., Any] = getattr(import_module(module), name)
    return found


#: Formats of fegear by their names, in the order in which lists have them and a gear's files are written.
FORMATS: Mapping[str, Format] = MappingProxyType({
    "dxf": Format(
        "flanks", "drawing of a tooth and of the gear, or of a rack", "fegear.output.dxf:written_dxf",
        "*_spline.dxf, *_polyline.dxf",
        "CAD, wire erosion: the exact outline of tooth and gear, or of a rack, with its relief, mm", asymmetric=True,
        racks="fegear.output.rack_dxf:written_rack",
    ),
    "step": Format(
        "flanks", "solid of the gear, or of a rack", "fegear.output.step:written_step", "*.step",
        "CAD, printing: the solid gear, spur or helical, with its bore and its relief, as a disc (a `body` is "
        "neglected, with a note), or rack, mm; the axis is z, the middle of the face z = 0",
        seconds="fegear.output.step:seconds_of", asymmetric=True, racks="fegear.output.rack_step:written_rack",
    ),
    "relief": Format(
        "flanks", "modifications for grinding, as tables",
        "fegear.output.grinding_tables:written_relief", "*_relief.csv, *_k_chart.csv",
        "for the grinder: material to remove over diameter, roll angle and roll length, from the start to the end of "
        "the involute, finely and as the points of a profile chart (K-chart)",
    ),
    "msh": Format(
        "plane mesh", "mesh of the gear or rack, Gmsh", "fegear.output.plane_mesh_files:written_msh", "*.msh",
        "gmsh: the whole gear, or spur rack, with named groups", asymmetric=True,
        racks="fegear.output.rack_mesh_files:written_msh",
    ),
    "vtu": Format(
        "plane mesh", "mesh of the gear or rack, ParaView", "fegear.output.plane_mesh_files:written_vtu", "*.vtu",
        "ParaView: the same with displacement and stress under 1 N/mm", asymmetric=True,
        racks="fegear.output.rack_mesh_files:written_vtu",
    ),
    "inp": Format(
        "plane mesh", "mesh of the gear or rack, Abaqus and CalculiX", "fegear.output.plane_mesh_files:written_inp",
        "*.inp",
        "CalculiX, Abaqus: complete input deck: six-node plane elements, bore fixed, contact pressure of "
        "1 N/mm on tooth 0; of a spur rack back or pins fixed, on the middle tooth", asymmetric=True,
        racks="fegear.output.rack_mesh_files:written_inp",
    ),
    "solid-inp": Format(
        "solid mesh", "3D mesh of the gear or rack, Abaqus and CalculiX",
        "fegear.output.solid_mesh_files:written_inp",
        "*_solid.inp",
        "CalculiX, Abaqus: the 3D gear, or rack, spur or helical: hexahedra and wedges of second order (C3D20, C3D15), "
        "bore (back or pins) fixed, 1 kN on a band at mid-face of tooth 0 (the middle tooth)", asymmetric=True,
        racks="fegear.output.rack_mesh_files:written_solid_inp",
    ),
    "solid-vtu": Format(
        "solid mesh", "3D mesh of the gear or rack, ParaView", "fegear.output.solid_mesh_files:written_vtu",
        "*_solid.vtu", "ParaView: the same mesh and its nodal forces", asymmetric=True,
        racks="fegear.output.rack_mesh_files:written_solid_vtu",
    ),
    "svg": Format(
        "case", "gears in mesh with stress and loads, SVG", "fegear.output.drawn_mesh:written_svg", "mesh_PAIR_*.svg",
        "slides: both gears of every loaded plane (2D) pair at points A to E of the path of contact, with the von "
        "Mises stress inside their teeth and the load of each tooth pair",
    ),
    "pdf": Format(
        "case", "gears in mesh with stress and loads, PDF", "fegear.output.drawn_mesh:written_pdf", "mesh_PAIR_*.pdf",
        "the same on paper",
    ),
    "fmu": Format(
        "case", "each loaded pair as a force element, FMI 3.0", "fegear.output.fmu:written_fmu", "mesh_PAIR.fmu",
        "Simulink, OpenModelica, Adams and other programs that run FMUs: every loaded pair, see below",
        needs="fegear.output.fmu:c_compiler",
    ),
    "rexs": Format(
        "case", "the gearbox as a REXS model", "fegear.output.rexs_model:written_rexs", "CASE.rexs",
        "the gearbox as a REXS 1.7 model: [there and back](import-rexs.md#back-to-rexs)", takes_results=True,
    ),
})  # fmt: skip


def formats() -> Mapping[str, Format]:
    """Those of fegear, and those that other distributions add and that can be used."""
    return MappingProxyType({**FORMATS, **added_formats().found})


def added_formats() -> Added[Format]:
    """Those that other distributions add by entry points of ``fegear.formats``; what fails in them is a sentence."""
    others = added("formats", Format, FORMATS)

    def guarded(name: str, row: Format) -> Format:
        def of(function: Callable[..., Any], right: Callable[[Any], object] | None = None) -> Guarded:
            return Guarded(function, "formats", others.whose[name], right)

        return replace(
            row, write=of(row.written, _paths_and_sentences), needs=of(row.require), seconds=of(row.predicted)
        )

    return replace(others, found={name: guarded(name, row) for name, row in others.found.items()})


def _paths_and_sentences(answer: Any) -> None:
    files, said = answer
    for many, kind in ((files, Path), (said, str)):
        if isinstance(many, str) or not all(isinstance(one, kind) for one in many):
            raise TypeError(f"write() must answer a list of paths and one of sentences, and answered {answer!r}")
