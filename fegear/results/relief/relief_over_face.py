"""Result ``relief`` of teeth with a width: the tip reliefs of both gears to grind for one load or a range.

Plane teeth have a profile that leaves no transmission error at the design load (`fegear.results.relief.relief`); that
of teeth with a width is a topography, which ``flank-design`` finds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from fegear.base.errors import InputError
from fegear.base.printed import figures
from fegear.case.built.design_range import design_range
from fegear.case.built.members import gear_name
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.tip_tolerances import tip_tolerances
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.results.forecasts import HERTZ, INVOLUTE, RING
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.relief.relief import design_part
from fegear.results.relief.relief_over_face_data import TipReliefData, TipReliefInputs
from fegear.results.relief.relief_over_face_sheet import RELIEF_OVER_FACE_SHEET

if TYPE_CHECKING:
    from fegear.case.reading import Scene

#: Keys of the design of plane teeth only.
_PLANE = (
    "length", "contact_ratio", "centre", "family", "slope", "exponent", "inner_slope", "peak", "allowable", "film",
    "roll_angles",
)  # fmt: skip
#: Keys of the search for tip reliefs of plane teeth only.
_PLANE_SEARCH = ("relieve", "limits")
#: Seconds of a contact line on both gears, and of what one shape takes under one load at 24 stations.
_LINE, _SHAPE = 0.02, 7.0
#: Contact lines of reading and of the search, over those of one base pitch.
_READ, _SEARCHED = 192.0, 48.0


def pairs_over_face(scene: Scene) -> tuple[str, ...]:
    """The pair of ``[design]`` where it has a width, or the only such pair of a case without plane ones."""
    named = design_part(scene).pair
    wide = tuple(scene.wide_pairs)
    if named is not None:
        return (named,) if named in wide else ()
    if scene.plane_pairs:
        return ()
    if len(wide) > 1:
        raise InputError("design.pair", "(not given)", "is required with several pairs", "specify one of them")
    return wide


def check_over_face(scene: Scene, name: str) -> None:
    """Refuse designs of teeth with a width that have no meaning."""
    part = design_part(scene)
    for key in _PLANE:
        if key in part.given:
            raise InputError(
                f"design.{key}", "(given)", f"is defined for the plane (2D) model; pair {name} is 3D",
                "remove it; use flank-design for the exact topography",
            )  # fmt: skip
    for key in _PLANE_SEARCH:
        if key in part.given:
            raise InputError(
                f"design.{key}", "(given)",
                f"is defined for tip relief of the plane (2D) model; pair {name} is 3D", "remove it",
            )  # fmt: skip
    if part.metric != "peak_to_peak":
        raise InputError(
            "design.metric", f'"{part.metric}"', f"is defined for the plane (2D) model; pair {name} is 3D",
            'set metric = "peak_to_peak"',
        )  # fmt: skip
    design_range(scene, name)


def needs_over_face(scene: Scene, name: str) -> tuple[Task, ...]:
    """The loaded pair and both of its gears."""
    gears = tuple(gear_name(scene, name, member) for member in MEMBERS)
    return (*needs_flanks(scene, name), *needs_solid_solution(*gears))


def _inputs(scene: Scene, name: str) -> TipReliefInputs:
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    return TipReliefInputs(
        design_part(scene), design_range(scene, name), tip_tolerances(scene, name), scene.case.effects.relief, name,
        gears, misaligned(scene, name),
    )  # fmt: skip


def misaligned(scene: Scene, name: str) -> str:
    """The misalignment that a design counts as given, in words: its sign is that of the case."""
    part, said = scene.case.pair[name], []
    if not scene.case.effects.misalignment:
        return ""
    if part.line_error is not None and part.line_error.over_face:
        said.append(f"line_error.over_face = {figures(part.line_error.over_face * 1e6, signed=True)} um")
    if part.line_error is not None and part.line_error.file is not None:
        said.append("line_error.file")
    if part.misalignment is not None:
        said.append("misalignment")
    return " and ".join(f"pair.{name}.{one}" for one in said)


def _compute(inputs: TipReliefInputs, upstream: Upstream, work: Work) -> TipReliefData:
    from fegear.design.flanks.flank_tolerance import FlankTolerance
    from fegear.design.flanks.tip_design import TipDesignTask, design_tips

    found, part = loaded_flanks(upstream, inputs.name), inputs.part
    load = part.load or found.nominal
    task = TipDesignTask(load, inputs.over, tuple(part.grind), FlankTolerance(inputs.tolerances), tuple(found.loads))
    solved = {member: solid_solution_of(upstream, inputs.gears[member]) for member in MEMBERS}
    coarse = {member: one.coarse or one.fine for member, one in solved.items()}
    design = design_tips(
        found.flanks, coarse, found.known, found.gaps, task, present=inputs.present, progress=work.progress
    )
    present = (found.gaps.driver_relief, found.gaps.driven_relief) if inputs.present else None
    return TipReliefData(found.flanks.pair, design, present, found.gaps.shafts.given)


def over_face_forecast(scene: Scene, name: str, shapes: float, loads: float) -> Forecast:
    """Contact lines on which reliefs are tried and read, and the search for so many shapes under so many loads."""
    asked = pair_spec(scene, name, over_face=True)
    pair = asked.placed
    stations = asked.panel_count * (1.0 + pair.contact_ratio)
    lines = (_READ + _SEARCHED) * (1.0 + pair.total_contact_ratio)
    seconds = _LINE * lines * (stations / 34.0) + _SHAPE * shapes * loads * (stations / 34.0) ** 1.5
    return Forecast({"positions": asked.face.positions, "panels": asked.panel_count}, seconds)


def _forecast(scene: Scene, name: str) -> Forecast:
    over = design_range(scene, name)
    loads = 1 if over is None else len(over.loads) + 1  # and for the design load only
    return over_face_forecast(scene, name, len(design_part(scene).grind), loads)


def relief_data(upstream: Upstream) -> TipReliefData:
    """What this stage computed, among what a task needs."""
    return cast("TipReliefData", next(one for task, one in upstream.items() if task.stage == "relief-over-face"))


RELIEF_OVER_FACE = Stage(
    subjects=pairs_over_face,
    inputs=_inputs,
    compute=_compute,
    present=RELIEF_OVER_FACE_SHEET.present,
    needs=needs_over_face,
    check=check_over_face,
    instead_of=("flank-design",),
    cites=citing(Citation("lin-townsend-oswald", "linear and parabolic tip relief"), *RING, HERTZ, INVOLUTE),
    forecast=_forecast,
)
