"""Stage ``flank-tolerance-robustness``: a pair with a width, its gears deviating inside the drawing's tolerances."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.flank_errors import (
    chosen_pair,
    limits_of,
    refuse_jammed,
    refuse_no_tolerance,
    tolerance_part,
    untold,
)
from fegear.case.built.loaded_flanks import FLANK_EFFECTS, flanks_to_load
from fegear.case.built.pair_inputs import gear_name
from fegear.case.built.solid_influence import solid_gear_to_solve
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage
from fegear.geometry.pair import MEMBERS
from fegear.results.forecasts import HERTZ
from fegear.results.gear.stiffness_over_face import needs_solid_solution, solid_solution_of
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.relief.tolerance_robustness import ToleranceData, drawn, present_draws, together
from fegear.results.relief.tolerance_tables import OWN

if TYPE_CHECKING:
    from fegear.case.built.loaded_flanks import FlanksToLoad
    from fegear.case.reading import Scene
    from fegear.case.studies import TolerancePart
    from fegear.design.robustness.deviated_pair import FlankBench, FlankBenches
    from fegear.design.robustness.tolerance_draws import Deviations, Kind, Limits
    from fegear.engine.stage import Task, Upstream, Work

#: Kinds that are drawn of teeth with a width unless the case names others.
_OVER_FACE: tuple[Kind, ...] = ("centre-distance", "profile-slope", "profile-form", "helix-slope", "pitch")
#: Draws that a process is given at a time: influences over the face are larger than those of plane teeth.
_CHUNK = 100
#: Processor seconds of a draw at one roll position, and of setting up the roots at one, over the panels squared.
_AT_A_POSITION, _ROOTS = 0.001, 6e-4


@dataclass(frozen=True)
class FlankDrawInputs:
    """What the draws of a pair with a width depend on.

    Parameters
    ----------
    part : TolerancePart
    asked : FlanksToLoad
    limits : Limits
    solved : tuple
        What the gears' solutions depend on.
    name : str
        Of the pair.
    gears : tuple of (str, str)
    untold : tuple of str
        Sentences on deviations that the case does not tell.
    """

    part: TolerancePart
    asked: FlanksToLoad
    limits: Limits
    solved: tuple[object, ...]
    name: str = field(compare=False)
    gears: tuple[str, str] = field(compare=False)
    untold: tuple[str, ...] = field(compare=False)

    @property
    def load(self) -> float:
        """[N]."""
        return self.asked.nominal

    @property
    def own_spacing(self) -> bool:
        """Whether the case has spacing errors, which draws replace."""
        return self.asked.effects.spacing_errors


@dataclass(frozen=True)
class FlankChunk:
    """Some draws: all that a process needs."""

    inputs: FlankDrawInputs
    benches: FlankBenches
    deviations: Deviations


def compute_flank_chunk(chunk: FlankChunk) -> dict[str, object]:
    """Outcomes of some draws, as plain data."""
    from fegear.base.one_thread import one_thread
    from fegear.design.robustness.deviated_pair import drawn_flank_outcomes

    with one_thread():
        found = drawn_flank_outcomes(chunk.benches, chunk.deviations)
    return {"values": found.values, "reasons": found.reasons}


def flank_chunk_content(chunk: FlankChunk) -> object:
    """All that the numbers of a chunk depend on: its own draws, not how many there are besides."""
    return chunk.inputs.asked, chunk.inputs.solved, chunk.benches.largest, chunk.deviations


def _subjects(scene: Scene) -> tuple[str, ...]:
    return tuple(name for name in chosen_pair(scene) if name in scene.wide_pairs)


def _check(scene: Scene, name: str) -> None:
    part, limits = tolerance_part(scene), limits_of(scene, name, _OVER_FACE)
    if part.reliefs is not None:
        raise InputError(
            "robustness.reliefs", "a table", "is for plane teeth",
            "leave it out; flank-design finds reliefs over the face, for misalignment that scatters too",
        )  # fmt: skip
    refuse_no_tolerance(scene, name, limits)
    refuse_jammed(flanks_to_load(scene, name).pair, name, limits)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gears = gear_name(scene, name, "driver"), gear_name(scene, name, "driven")
    return (*needs_flanks(scene, name), *needs_solid_solution(*gears))


def _inputs(scene: Scene, name: str) -> FlankDrawInputs:
    gears = gear_name(scene, name, "driver"), gear_name(scene, name, "driven")
    solved = tuple(solid_gear_to_solve(scene, gear) for gear in dict.fromkeys(gears))
    return FlankDrawInputs(
        tolerance_part(scene), flanks_to_load(scene, name), limits_of(scene, name, _OVER_FACE), solved, name, gears,
        untold(scene, gears, _OVER_FACE),
    )  # fmt: skip


def _bench(inputs: FlankDrawInputs, upstream: Upstream, moved: float = 0.0) -> FlankBench:
    """The pair set up for draws, at a centre distance that is off by `moved` [m]."""
    from fegear.contact.wide.root_stress import rooted_lines
    from fegear.design.robustness.deviated_pair import FlankBench

    loaded, none = loaded_flanks(upstream, inputs.name), np.empty(0)
    flanks, known = loaded.flanks, loaded.known
    if moved:
        pair = replace(flanks.pair, centre_distance=flanks.pair.centre_distance + moved)
        flanks = replace(flanks, pair=pair)
        known = flanks.compliance(inputs.load)
    gaps = replace(loaded.gaps, driver_spacing=none, driven_spacing=none)
    z, coupling = loaded.places_along, loaded.coupling
    one, other = (
        rooted_lines(
            flanks.pair, member, known.lines, solid_solution_of(upstream, gear).fine, coupling=coupling
        ).influence("tension", z)
        for member, gear in zip(MEMBERS, inputs.gears, strict=True)
    )
    return FlankBench(flanks.pair, known, gaps, flanks.points, inputs.load, (one, other))


def _compute(inputs: FlankDrawInputs, upstream: Upstream, work: Work) -> ToleranceData:
    from fegear.base.one_thread import one_thread
    from fegear.design.robustness.deviated_pair import FLANK_OUTCOMES, FlankBenches, drawn_flank_outcomes
    from fegear.design.robustness.tolerance_draws import NO_LIMITS, draw

    part, largest = inputs.part, inputs.limits.centre_distance
    benches = FlankBenches(_bench(inputs, upstream))
    if largest:
        nearer, farther = (_bench(inputs, upstream, moved) for moved in (-largest, largest))
        benches = FlankBenches(benches.nominal, nearer, farther, largest)
    teeth = benches.nominal.teeth
    deviations = draw(inputs.limits, part.draws, part.seed, teeth, part.sequence, part.distribution)
    with one_thread():
        nominal = drawn_flank_outcomes(benches, draw(NO_LIMITS, 1, 0, teeth)).values[0]
    chunks = [
        FlankChunk(inputs, benches, deviations.rows(slice(first, first + _CHUNK)))
        for first in range(0, part.draws, _CHUNK)
    ]
    values, reasons = together(drawn(compute_flank_chunk, chunks, flank_chunk_content, inputs.name, work), _CHUNK)
    return ToleranceData(FLANK_OUTCOMES, deviations, {OWN: values}, {OWN: nominal}, reasons, math.nan, None, ())


def _forecast(scene: Scene, name: str) -> Forecast:
    part, asked = tolerance_part(scene), flanks_to_load(scene, name)
    chunks = math.ceil(part.draws / _CHUNK)
    roots, draws = asked.positions * asked.panels**2 * _ROOTS, part.draws * asked.positions * _AT_A_POSITION
    if limits_of(scene, name, _OVER_FACE).centre_distance:  # three centre distances, of which a draw stands between two
        roots, draws = 3.0 * roots, 2.0 * draws
    return Forecast({"draws": part.draws, "chunks": chunks}, roots + draws)


FLANK_TOLERANCE_ROBUSTNESS = Stage(
    subjects=_subjects,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=present_draws,
    check=_check,
    effects=tuple(FLANK_EFFECTS),
    cites=citing(
        Citation("iso-1328-1", "tolerances that deviations are drawn inside", "5.3, formulas (5) to (12)"), HERTZ
    ),
    forecast=_forecast,
)
