"""Pairs set up for draws inside their tolerances: what a kind of pair lets deviate, its bench, and what it takes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.members import gear_name
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.root_stress_sources import FINITE_ELEMENTS, check_formulas, root_stress_source
from fegear.case.built.solid_influence import solid_gear_to_solve
from fegear.case.built.tolerances import (
    chosen_pair,
    limits_of,
    refuse_jammed,
    refuse_no_tolerance,
    tolerance_part,
    untold,
)
from fegear.case.built.tooth_influence import gear_to_solve
from fegear.engine.stage import Forecast, Task, Upstream
from fegear.geometry.pair import MEMBERS
from fegear.results.gear.solved_gear import solid_solution_of, teeth_of
from fegear.results.pair.loaded_flanks import loaded_flanks
from fegear.results.pair.loaded_teeth import check_teeth, loaded_pair, needs_gears, needs_teeth
from fegear.results.pair.root_stress_history import needs_sources, stress_sources

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.case.studies import TolerancePart
    from fegear.contact.pair_spec import PairSpec
    from fegear.design.robustness.deviated_flanks import FlankBench
    from fegear.design.robustness.deviated_pair import Bench, DrawBench
    from fegear.design.robustness.tolerance_draws import Kind, Limits

#: Kinds that are drawn of plane teeth, and of teeth with a width, unless the case names others.
_PLANE: tuple[Kind, ...] = ("centre-distance", "profile-slope", "profile-form", "pitch")
_OVER_FACE: tuple[Kind, ...] = ("centre-distance", "profile-slope", "profile-form", "helix-slope", "pitch")
#: Draws that a process is given at a time; each is computed alone, so that the number changes no bit. Influences over
#: the face are larger than those of plane teeth.
_CHUNK, _WIDE_CHUNK = 25, 100
#: Processor seconds of a draw without and with corner contact, and of the search over its draws.
_DRAW, _DRAW_CORNERS, _SEARCH = 0.005, 0.014, 0.035
#: Processor seconds of a draw at one roll position, and of setting up the roots at one, over the panels squared.
_AT_A_POSITION, _ROOTS = 0.001, 6e-4


@dataclass(frozen=True)
class DrawInputs:
    """What the draws of a pair depend on.

    Parameters
    ----------
    part : TolerancePart
    teeth : PairSpec
        The pair, plane or with its width.
    limits : Limits
    source : str
        Of root stress.
    solved : tuple
        What the solutions of those gears depend on whose finite elements are behind compliances or root stress.
    name : str
        Of the pair.
    gears : tuple of (str, str)
        Driver and driven.
    untold : tuple of str
        Sentences on deviations that the case does not give.
    wide : bool
    """

    part: TolerancePart
    teeth: PairSpec
    limits: Limits
    source: str
    solved: tuple[object, ...]
    name: str = field(compare=False)
    gears: tuple[str, str] = field(compare=False)
    untold: tuple[str, ...] = field(compare=False)
    wide: bool

    @property
    def load(self) -> float:
        """[N]."""
        return self.teeth.nominal

    @property
    def own_spacing(self) -> bool:
        """Whether the case has spacing errors, which draws replace."""
        return self.teeth.spacing_errors

    @property
    def chunk(self) -> int:
        """Draws that a process is given at a time."""
        return _WIDE_CHUNK if self.wide else _CHUNK

    @property
    def moved(self) -> float:
        """Largest deviation of the centre distance between whose ends draws of a wide pair are interpolated [m]."""
        return self.limits.centre_distance if self.wide else 0.0


def pairs_to_draw(scene: Scene) -> tuple[str, ...]:
    """The pair of ``[robustness]``, where it can be loaded."""
    return tuple(name for name in chosen_pair(scene) if name in scene.plane_pairs or name in scene.wide_pairs)


def _kinds(scene: Scene, name: str) -> tuple[Kind, ...]:
    return _OVER_FACE if name in scene.wide_pairs else _PLANE


def check_draws(scene: Scene, name: str) -> None:
    """Refuse draws of a pair that have no meaning, no tolerance, or jam its teeth."""
    part, limits, wide = tolerance_part(scene), limits_of(scene, name, _kinds(scene, name)), name in scene.wide_pairs
    if wide and part.reliefs is not None:
        raise InputError(
            "robustness.reliefs", "a table", "is defined for the plane (2D) model",
            "remove it; use flank-design for 3D flanks, including scatter of misalignment",
        )  # fmt: skip
    if not wide and part.deviations and "helix-slope" in part.deviations:
        raise InputError(
            "robustness.deviations", '"helix-slope"', "is not used in the plane (2D) model",
            f'remove it, or set pair.{name}.width = "solid"',
        )  # fmt: skip
    refuse_no_tolerance(scene, name, limits)
    refuse_jammed(pair_spec(scene, name).placed if wide else scene.pairs[name], name, limits)
    check_teeth(scene, name)
    if not wide:
        check_formulas(scene, name, tips=scene.case.effects.corner_contact)


def needs_of_draws(scene: Scene, name: str) -> tuple[Task, ...]:
    """The loaded pair, and what its root stress comes from."""
    if name in scene.wide_pairs:
        return needs_gears(scene, name)
    return (*needs_teeth(scene, name), *needs_sources(scene, name))


def draw_inputs(scene: Scene, name: str) -> DrawInputs:
    """Collect what a case says of the draws of a pair."""
    wide, kinds = name in scene.wide_pairs, _kinds(scene, name)
    gears = gear_name(scene, name, "driver"), gear_name(scene, name, "driven")
    teeth = pair_spec(scene, name)
    if wide:
        source = FINITE_ELEMENTS
        solved: tuple[object, ...] = tuple(solid_gear_to_solve(scene, gear) for gear in dict.fromkeys(gears))
    else:
        source = stress_sources(scene, name)[0]
        behind = teeth.gears if FINITE_ELEMENTS in (source, teeth.compliance) else ()
        solved = tuple(gear_to_solve(scene, gear) for gear in dict.fromkeys(behind))
    return DrawInputs(
        tolerance_part(scene), teeth, limits_of(scene, name, kinds), source, solved, name, gears,
        untold(scene, gears, kinds), wide,
    )  # fmt: skip


def set_up(asked: DrawInputs, upstream: Upstream) -> DrawBench:
    """The pair set up for draws, at those centre distances that they need."""
    from fegear.design.robustness.deviated_flanks import FlankBenches

    if not asked.wide:
        return _plane_bench(asked, upstream)
    nominal, largest = _wide_bench(asked, upstream), asked.moved
    if not largest:
        return FlankBenches(nominal)
    nearer, farther = (_wide_bench(asked, upstream, moved) for moved in (-largest, largest))
    return FlankBenches(nominal, nearer, farther, largest)


def _plane_bench(asked: DrawInputs, upstream: Upstream) -> Bench:
    from fegear.design.robustness.deviated_pair import bench

    engagement = loaded_pair(upstream, asked.name).engagement
    fe = asked.source == FINITE_ELEMENTS
    solved = {gear: teeth_of(upstream, gear) for gear in dict.fromkeys(asked.gears)} if fe else {}
    driver, driven = (
        root_stress_source(
            asked.source, asked.name, gear, engagement.pair, member, solved, tips=engagement.corner_contact, whole=True
        )
        for gear, member in zip(asked.gears, MEMBERS, strict=True)
    )
    return bench(engagement, asked.teeth.nominal, (driver, driven))


def _wide_bench(inputs: DrawInputs, upstream: Upstream, moved: float = 0.0) -> FlankBench:
    """The pair set up for draws, at a centre distance that is off by `moved` [m]."""
    from fegear.contact.wide.root_stress import rooted_lines
    from fegear.design.robustness.deviated_flanks import FlankBench

    loaded, none = loaded_flanks(upstream, inputs.name), np.empty(0)
    flanks, known = loaded.flanks, loaded.known
    if moved:
        pair = replace(flanks.pair, centre_distance=flanks.pair.centre_distance + moved)
        flanks = replace(flanks, pair=pair)
        known = flanks.compliance(inputs.load)
    gaps = replace(loaded.gaps.under(inputs.load), driver_spacing=none, driven_spacing=none)
    z, coupling = loaded.places_along, loaded.coupling
    one, other = (
        rooted_lines(
            flanks.pair, member, known.lines, solid_solution_of(upstream, gear).fine, coupling=coupling
        ).influence("tension", z)
        for member, gear in zip(MEMBERS, inputs.gears, strict=True)
    )
    return FlankBench(flanks.pair, known, gaps, flanks.points, inputs.load, (one, other))


def forecast_draws(scene: Scene, name: str) -> Forecast:
    """Draws of every state of relief, and the search for the best; for teeth with a width their roots besides."""
    part = tolerance_part(scene)
    if name in scene.wide_pairs:
        asked = pair_spec(scene, name)
        chunks = math.ceil(part.draws / _WIDE_CHUNK)
        roots, draws = (
            asked.face.positions * asked.panel_count**2 * _ROOTS,
            part.draws * asked.face.positions * _AT_A_POSITION,
        )
        if limits_of(scene, name, _OVER_FACE).centre_distance:  # three centre distances, a draw stands between two
            roots, draws = 3.0 * roots, 2.0 * draws
        return Forecast({"draws": part.draws, "chunks": chunks}, roots + draws)
    each = _DRAW_CORNERS if scene.case.effects.corner_contact else _DRAW
    states, search = (3, part.reliefs.draws * _SEARCH) if part.reliefs else (1, 0.0)
    chunks = math.ceil(part.draws / _CHUNK) * states
    return Forecast({"draws": part.draws, "chunks": chunks}, part.draws * states * each + search)
