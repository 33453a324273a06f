"""The finite-element solution of a gear, once for every stage that needs it.

``gear.NAME.tooth_mesh``: a user's own mesh in place of the generated one.

From ``[accuracy]`` to the settings of the finite-element part.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any

from fegear.base.errors import RangeError
from fegear.base.notes import exceeding, neglecting
from fegear.base.printed import percent
from fegear.case.accuracy import AccuracyPart
from fegear.case.built.atlas_teeth import why_solved
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.fem.plane.settings import MeshSettings, Solver, level_for, settings_at
from fegear.geometry.gear import Gear
from fegear.geometry.shaped_side import ShapedSide

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.base.solution_cache import SolutionCache
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.mesh import SectorMesh


def needed_reach(scene: Scene, name: str) -> int:
    """How many neighbours on either side a gear's solution must know: as many as share the load in any of its pairs.

    All stages ask for the same number, so that they find the same solution. Without neighbour coupling it is one, which
    comes with the solution: the size of what is neglected follows from it.
    """
    reach = 1
    if not scene.case.effects.neighbour_coupling:
        return reach
    for key, part in scene.case.pair.items():
        if key in scene.pairs and name in (part.driver, part.driven):
            ratio = scene.pairs[key].contact_ratio
            # A corner in contact before and after the path adds a pair at either end.
            extra = 1 if scene.case.effects.corner_contact else 0
            # A root's stress is followed from a base pitch before contact to one after it.
            reach = max(reach, min(math.ceil(ratio * (1.0 - 1e-12)) + extra, scene.gears[name].teeth // 2 - 1))
    if any(rack.pinion == name for rack in scene.case.rack.values()):
        reach = max(reach, min(2, scene.gears[name].teeth // 2 - 1))
    return reach


@dataclass(frozen=True)
class GearToSolve:
    """All that the influence functions of a gear depend on.

    Parameters
    ----------
    gear : Gear
    tolerance : float
        Relative; met by finer settings while the error estimate misses it.
    settings : MeshSettings or None
        Given by the case, or for its own tooth mesh: taken as they are.
    reach : int
        K: neighbours -K..K.
    mesh : SectorMesh or None
        A user's own.
    name : str
        Of the gear, for messages.
    draft : bool
        Whether the first settings for the tolerance are enough, without an error estimate.
    solver : {"condensed", "scikit-fem"}
        What assembles and eliminates where the settings are chosen by the tolerance.
    why : str
        Why it is not taken from an atlas, where it might be.
    """

    gear: Gear
    tolerance: float
    settings: MeshSettings | None
    reach: int
    mesh: SectorMesh | None = None
    name: str = field(default="", compare=False)
    draft: bool = False
    solver: Solver = "condensed"
    why: str = field(default="", compare=False)


def gear_to_solve(scene: Scene, name: str) -> GearToSolve:
    """What the case asks of the influence functions of a gear.

    Raises
    ------
    InputError
        If the gear's own mesh cannot be read.
    """
    mesh, accuracy = own_sector_mesh(scene, name), scene.case.accuracy
    given = mesh is not None or bool(given_settings(accuracy))
    settings = mesh_settings(accuracy) if given else None
    draft, reach = None if given else scene.drafts.get(name), needed_reach(scene, name)
    tolerance = draft or accuracy.tolerance
    why = why_solved(scene, name)
    return GearToSolve(
        scene.gears[name], tolerance, settings, reach, mesh, name, draft is not None, accuracy.solver, why
    )


def check_plane_gear(scene: Scene, name: str) -> None:
    """Refuse a bore, or the outer circle of a ring gear, that no plane gear is solved with.

    Raises
    ------
    RangeError
        Under its key in the case.
    """
    from fegear.fem.plane.bore import check_bore

    gear = scene.gears[name]
    if scene.case.gear[name].tooth_mesh is None:
        try:
            check_bore(gear.tooth, gear.bore_radius / gear.module, gear.module)
        except RangeError as error:
            raise at(f"gear.{name}", error) from None


def solve_influence_functions(
    asked: GearToSolve, cache: SolutionCache | None = None, progress: Callable[[str], None] | None = None
) -> GearInfluence:
    """Solve a gear for its influence functions, or recall its shapes from a cache.

    Parameters
    ----------
    asked : GearToSolve
    cache : SolutionCache, optional
    progress : callable, optional
        Called with the name of each step as it starts.

    Raises
    ------
    RangeError
        If the gear's bore cannot be meshed, under its key in the case.
    """
    from fegear.fem.plane.solution import first_level, solve_gear, solve_to_tolerance

    gear, reach = asked.gear, asked.reach
    try:
        if asked.draft:
            first = replace(settings_at(first_level(gear.tooth, asked.tolerance)), solver=asked.solver)
            return solve_gear(gear, first, reach=reach, estimate_error=False, cache=cache, lasting=False)
        if asked.settings is None:
            return solve_to_tolerance(
                gear, asked.tolerance, reach=reach, solver=asked.solver, progress=progress, cache=cache
            )
        return solve_gear(gear, asked.settings, reach=reach, mesh=asked.mesh, progress=progress, cache=cache)
    except RangeError as error:
        raise at(f"gear.{asked.name}", error) from None


def solution_settings(influence: GearInfluence) -> dict[str, object]:
    """Settings of a gear's solution and what they cost, for the summary."""
    found: dict[str, object] = {
        **asdict(influence.settings),
        "unknowns": influence.fine.unknowns,
        "mesh": influence.fine.mesh.origin,
        "plane": influence.gear.plane_assumption,
        "seconds": {key: round(seconds, 6) for key, seconds in influence.seconds.items()},
    }
    if influence.rounds:
        found["rounds"] = [
            {
                "root_edge_length": one.settings.root_edge_length,
                "unknowns": one.unknowns,
                "estimated_error": {key: float(f"{error:.3g}") for key, error in one.errors.items()},
                "seconds": round(one.seconds, 6),
            }
            for one in influence.rounds
        ]
    return found


def solution_remarks(name: str, influence: GearInfluence, tolerance: float) -> tuple[str, ...]:
    """Say where a tolerance took more than one solution, and where the last of them still misses it."""
    return (
        *fillet_remarks(name, influence.gear), *support_remarks(name, influence),
        *_tolerance_remarks(name, influence, tolerance),
    )  # fmt: skip


def fillet_remarks(name: str, gear: Gear) -> tuple[str, ...]:
    """That points of a fillet scatter, where its curvature swings."""
    return tuple(
        f"Gear {name}: curvature of the specified {tooth.fillet_key.replace('_', ' ')} has {tooth.swings} maxima "
        f"between root circle and flank. Root stress follows them; set {tooth.fillet_key}.scatter to the accuracy of "
        "the points."
        for tooth in ((gear.tooth, gear.tooth.back) if gear.asymmetric else (gear.tooth,))
        if isinstance(tooth, ShapedSide) and tooth.fillet_key is not None and tooth.swings > _SWINGS
    )


def support_remarks(name: str, influence: GearInfluence) -> tuple[str, ...]:
    """How the teeth of a rim on pins differ, and what a rim that is not held all round leaves out."""
    support = influence.gear.support
    if support is None or support.kind == "web":
        return ()
    if support.kind == "free_arc":
        return (always_above_the_arc(name, support.free_teeth),)
    apart = (planets_taken_alone(name),) if influence.gear.tooth.internal else ()
    if influence.fine.pins is None:
        return apart
    low, high = influence.gear.involute_radii
    each = influence.over_the_teeth([0.5 * (low + high)], [influence.reference_half_width])
    c, tension = each["c_self"][:, 0], each["root_tension"][:, 0]
    what = "rollers" if support.rollers else "pins"
    pulled = rollers_that_pull(name, influence) if support.rollers else ()
    return teeth_on_pins_differ(name, support.pins, "at half tooth height", c, tension, what), *pulled, *apart


def rollers_that_pull(name: str, influence: GearInfluence) -> tuple[str, ...]:
    """That rollers hold a rim both ways, and how strongly."""
    from fegear.fem.plane.tooth_on_pins import pulled_share

    share = pulled_share(influence.fine)
    if share < _PULLS:
        return ()
    said = neglecting(
        f"Gear {name}: rollers are assumed to carry tension as well, up to {percent(share)} of the maximum force for a "
        "load on one tooth. A rim that loses contact with its rollers is less stiff."
    )
    return (said,)


def always_above_the_arc(name: str, teeth: int) -> str:
    """That every tooth is taken for the one in the middle of a free arc."""
    return neglecting(
        f"Gear {name}: bore free below {teeth} {'tooth' if teeth == 1 else 'teeth'}. Each loaded tooth is computed as "
        "the one in the middle of the free arc; the other teeth are stiffer."
    )


def teeth_on_pins_differ(name: str, pins: int, where: str, c: Array, tension: Array, what: str = "pins") -> str:
    """How far c_self and root tension of teeth on pins, shape (T,), depart from their means."""
    return (
        f"Gear {name}: compliance varies over {c.size} consecutive teeth because of its {pins} {what}. Load {where}: "
        f"c_self {percent(c.min() / c.mean() - 1.0, signed=True)} to "
        f"{percent(c.max() / c.mean() - 1.0, signed=True)} from the mean, root stress, tension side, "
        f"{percent(tension.min() / tension.mean() - 1.0, signed=True)} to "
        f"{percent(tension.max() / tension.mean() - 1.0, signed=True)}. Tables, pairs and planetary sets use the "
        "mean of all teeth."
    )


def planets_taken_alone(name: str) -> str:
    """What a ring that is not held all round leaves out."""
    return neglecting(
        f"Gear {name}: flexible ring rim; each planet-ring mesh is computed separately, rim deflection at one planet "
        "due to the others is neglected."
    )


def _tolerance_remarks(name: str, influence: GearInfluence, tolerance: float) -> tuple[str, ...]:
    rounds = influence.rounds
    if not rounds or (len(rounds) == 1 and rounds[0].error <= tolerance):
        return ()
    steps = ", ".join(f"{percent(one.error)} with {one.unknowns} unknowns per tooth" for one in rounds)
    last = rounds[-1]
    if last.error <= tolerance:
        end = "the last mesh is used."
    else:
        worst = max(last.errors, key=lambda key: last.errors[key])
        end = f"the last mesh (finest allowed) is used although {worst} exceeds the tolerance."
    times = "once" if len(rounds) == 2 else f"{len(rounds) - 1} times"
    how = f"mesh refined {times}" if len(rounds) > 1 else "solved"
    said = f"Gear {name}: {how} for tolerance {100.0 * tolerance:g} %; maximum estimated errors: {steps}; {end}"
    return (exceeding(said) if last.error > tolerance else said,)


def own_sector_mesh(scene: Scene, name: str) -> SectorMesh | None:
    """Read the tooth mesh that the case names for a gear, in millimetres; None if it names none.

    Parameters
    ----------
    scene : Scene
    name : str
        Name of the gear.

    Raises
    ------
    InputError
        If the file is missing or its mesh cannot be used.
    """
    part = scene.case.gear[name]
    file = part.tooth_mesh
    if file is None:
        return None
    from fegear.fem.plane.imported_mesh import read_sector_mesh

    gear, key = scene.gears[name], f"gear.{name}.tooth_mesh"
    own = part.tooth_mesh_fillet == "own"
    return read_sector_mesh(
        scene.file(file, key), gear.symmetric_tooth, gear.module, gear.bore_radius, key=key, own_fillet=own
    )


#: Largest values of a smooth fillet's curvature between its ends.
_SWINGS = 3
#: Share of the largest force of a roller beyond which others that pull are mentioned.
_PULLS = 0.01
#: Processor seconds of one gear with the default settings and its error estimate, and how they grow with 1 / edge
#: length and with the order: one core of a server, 20 to 200 teeth, edges of 4 to 1 times the default.
_SECONDS, _GROWTH, _ORDER_GROWTH = 0.55, 1.3, 2.2


def settings_for(tolerance: float) -> MeshSettings:
    """Return the settings with which a solution for a relative tolerance starts.

    They are the cheapest of the levels of `fegear.fem.plane.settings.settings_at` whose true errors (c_0, c_1 over c_0,
    largest root tension and compression, over the whole flank) usually meet the tolerance; docs/numerics.md has the
    measurements.

    Parameters
    ----------
    tolerance : float

    Returns
    -------
    MeshSettings
    """
    return settings_at(level_for(tolerance))


def given_settings(accuracy: AccuracyPart) -> dict[str, Any]:
    """Settings that the case gives itself; with any of them nothing is refined. The solver decides about no error."""
    found = {field.name: getattr(accuracy, field.name) for field in fields(MeshSettings) if field.name != "solver"}
    return {name: value for name, value in found.items() if value is not None}


def mesh_settings(accuracy: AccuracyPart) -> MeshSettings:
    """Settings for a tolerance, with explicitly given ones taking their place."""
    given = given_settings(accuracy)
    return replace(settings_for(accuracy.tolerance), solver=accuracy.solver, **given)


def seconds_of_gear(settings: MeshSettings) -> float:
    """About how many seconds the influence functions of one gear take, with their error estimate, from nothing."""
    usual = MeshSettings()
    finer = usual.root_edge_length / settings.root_edge_length * usual.flank_edge_length / settings.flank_edge_length
    return float(_SECONDS * finer ** (0.5 * _GROWTH) * (settings.order / usual.order) ** _ORDER_GROWTH)
