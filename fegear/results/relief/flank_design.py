"""Result ``flank-design``: relief of loaded flanks in two dimensions, exact and as it can be ground."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.built.design_range import design_range
from fegear.case.built.members import gear_name
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.tip_tolerances import flank_tolerance
from fegear.case.flank_design import FlankDesignPart
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.results.forecasts import HERTZ, INVOLUTE, RING
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.relief.flank_design_data import FlankDesignData, FlankDesignInputs
from fegear.results.relief.flank_design_sheet import FLANK_DESIGN_SHEET
from fegear.results.relief.relief_over_face import misaligned

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.design.flanks.designed_flanks import FlankDesignTask
    from fegear.design.flanks.flank_tolerance import FlankTolerance
    from fegear.design.flanks.grid import ReliefGrid
    from fegear.design.load_range import LoadRange


#: Misalignments of a map: over the standard deviation of the scatter, or [m] without one.
_MAPPED, _MAPPED_ALONE = (-2.0, -1.0, 0.0, 1.0, 2.0), (-10e-6, -5e-6, 0.0, 5e-6, 10e-6)


#: Seconds of a contact line on both gears, of one combination of a grid and of the exact loads of one family.
_LINE, _COMBINATION, _FAMILY = 0.05, 4e-4, 7.0


def _part(scene: Scene) -> FlankDesignPart:
    return scene.case.flank_design or FlankDesignPart()


def _pairs(scene: Scene) -> tuple[str, ...]:
    named, wide = _part(scene).pair, tuple(scene.wide_pairs)
    if named is not None:
        if named not in scene.pairs:
            raise InputError("flank_design.pair", f'"{named}"', "is not a pair of this case")
        return (named,)
    if len(wide) > 1:
        raise InputError("flank_design.pair", "(not given)", "is required with several 3D pairs", "name one of them")
    return wide or tuple(scene.pairs)


def _check(scene: Scene, name: str) -> None:
    if name not in scene.wide_pairs:
        raise InputError(
            f"pair.{name}.width", '"plane"', "is not available for flank design (3D)",
            f'set pair.{name}.width = "solid", or request relief',
        )  # fmt: skip
    design_range(scene, name)
    _task(_part(scene), scene.pairs[name], 1.0)


def _inputs(scene: Scene, name: str) -> FlankDesignInputs:
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    over = None if _part(scene).loads else design_range(scene, name)
    tolerance = flank_tolerance(scene, name)
    return FlankDesignInputs(_part(scene), name, gears, over, tolerance, misaligned(scene, name))


def _grid(part: FlankDesignPart) -> ReliefGrid | None:
    from fegear.design.flanks.grid import ReliefGrid

    if part.grid is None:
        return None
    g = part.grid
    return ReliefGrid(
        tuple(g.tip_amounts), tuple(g.tip_lengths), tuple(g.crownings), tuple(g.end_amounts), tuple(g.end_lengths),
        tuple(g.slopes), tuple(g.biases),
    )  # fmt: skip


def _task(
    part: FlankDesignPart, pair: GearPair, nominal: float, over: LoadRange | None = None,
    tolerance: FlankTolerance | None = None,
) -> FlankDesignTask:  # fmt: skip
    from fegear.design.flanks.designed_flanks import FlankDesignTask
    from fegear.design.flanks.scatter import NOMINAL, normal_scatter
    from fegear.design.flanks.topography import FlankLoading
    from fegear.design.loading import LoadingFunction, Ramp

    length = part.length or (part.contact_ratio * pair.base_pitch if part.contact_ratio else pair.path_length)
    if length > pair.path_length * (1.0 + 1e-9):
        raise InputError(
            "flank_design.length", f"{length * 1e3:.6g} mm",
            f"is longer than the path of contact, {pair.path_length * 1e3:.6g} mm "
            f"({pair.contact_ratio:.5g} base pitches)",
        )  # fmt: skip
    centre = 0.5 * (pair.x_start + pair.x_end) if part.centre is None else part.centre
    ramp = Ramp(part.slope)
    loading = FlankLoading(LoadingFunction(length, pair.base_pitch, centre, ramp, ramp), pair.face_width,
                           part.end_length)  # fmt: skip
    zone = loading.over_path
    slack = 1e-9 * pair.base_pitch
    if zone.x_start < pair.x_start - slack or zone.x_end > pair.x_end + slack:
        raise InputError(
            "flank_design.centre", f"{centre * 1e3:.6g} mm", "places the loading outside the path of contact",
            "choose a shorter design length, or remove centre",
        )  # fmt: skip
    load = part.load or nominal
    loads = over.loads if over is not None else tuple(sorted(part.loads)) if part.loads else (load,)
    scatter = normal_scatter(part.scatter.over_face, part.scatter.levels) if part.scatter else NOMINAL
    over_face = part.map.over_face
    if over_face is None:
        over_face = [k * part.scatter.over_face for k in _MAPPED] if part.scatter else list(_MAPPED_ALONE)
    return FlankDesignTask(
        loading, load, loads, tuple(part.families), _grid(part), part.largest_face_load_factor or math.inf, scatter,
        part.scatter.over_face if part.scatter else 0.0, part.positions, tuple(sorted(set(over_face))),
        tuple(sorted({load * f for f in part.map.load_factors})), None if over is None else over.weights, tolerance,
    )  # fmt: skip


def _compute(inputs: FlankDesignInputs, upstream: Upstream, work: Work) -> FlankDesignData:
    from fegear.design.flanks.flank_design import design_flanks

    found = loaded_flanks(upstream, inputs.name)
    flanks, apart = found.flanks, found.unrelieved
    task = _task(inputs.part, flanks.pair, found.nominal, inputs.over, inputs.tolerance)
    solved = {member: solid_solution_of(upstream, inputs.gears[member]) for member in MEMBERS}
    coarse = {member: one.coarse or one.fine for member, one in solved.items()}
    design = design_flanks(flanks, coarse, found.known, apart, task, work.progress)
    return FlankDesignData(flanks.pair, design, apart.shafts.given)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gears = tuple(gear_name(scene, name, member) for member in MEMBERS)
    return (*needs_flanks(scene, name), *needs_solid_solution(*gears))


def _forecast(scene: Scene, name: str) -> Forecast:
    from fegear.design.flanks.grid import usual_grid

    part, asked = _part(scene), pair_spec(scene, name, over_face=True)
    pair = asked.placed
    grid = _grid(part) or usual_grid(1.0, pair.path_length, pair.face_width, pair.base_pitch)
    counts = [len(grid.combinations(family)) for family in part.families]
    levels = part.scatter.levels if part.scatter else 0
    over = None if part.loads else design_range(scene, name)
    loads = len(part.loads or ()) or (1 if over is None else len(over.loads))
    combinations = (sum(counts) + levels * max(counts)) * loads
    stations = asked.panel_count * (1.0 + pair.contact_ratio)
    lines = part.positions * (1.0 + pair.total_contact_ratio)
    exact = _FAMILY * (len(counts) + levels) * (stations / 34.0) ** 1.5 * loads
    seconds = _LINE * lines + _COMBINATION * combinations * part.positions / 24.0 + exact
    return Forecast({"combinations": combinations, "positions": part.positions}, seconds)


FLANK_DESIGN = Stage(
    subjects=_pairs,
    inputs=_inputs,
    compute=_compute,
    present=FLANK_DESIGN_SHEET.present,
    needs=_needs,
    check=_check,
    cites=citing(
        Citation("mark", "relief with zero transmission error at the design load", "Eqs. 4.6 to 4.14"),
        *RING, HERTZ, INVOLUTE,
    ),
    forecast=_forecast,
)  # fmt: skip
