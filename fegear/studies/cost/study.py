"""A whole study: the reference, every configuration, the knobs; what is finished survives Ctrl-C."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from fegear.base.one_thread import one_thread
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.solid_influence import seconds_of_solid_gear
from fegear.case.built.tooth_influence import seconds_of_gear
from fegear.engine.run import Silence, Watcher
from fegear.fem.solid.settings import SolidSettings
from fegear.studies.cost.answers import CaseTable, FiniteElements, Source, answer
from fegear.studies.cost.asked import Asked
from fegear.studies.cost.knobs import ladder_knobs, pair_knobs, solid_knobs
from fegear.studies.cost.ladder import Ladder, flank_ladder, flank_seconds, make_ladder
from fegear.studies.cost.measure import (
    Found,
    answered,
    finite_elements,
    largest,
    measure_alone,
    measure_flanks,
    measure_meshes,
    refer,
    refer_flanks,
    solve_gears,
)
from fegear.studies.cost.result import CostResults, Measured

#: What answering takes from a solved gear, about [s].
_ANSWER_SECONDS = {"te-peak-to-peak": 0.1, "tooth-force": 0.2, "dynamic-factor": 2.0}
_KNOB_SECONDS = 3.0
#: How many gears with their width the knobs solve, in seconds of one with the usual settings; of a quick study.
_SOLIDS, _QUICK_SOLIDS = 12.0, 5.0


def forecast(asked: Asked, ladder: Ladder, *, quick: bool = False) -> float:
    """About how long a study takes on one core [s]."""
    if asked.over_face:
        return flank_seconds(asked, ladder)
    own = sum(_ANSWER_SECONDS.get(q.name, 0.02) for q in asked.quantities)
    total = _KNOB_SECONDS * bool(asked.pair) + own * (len(ladder.configurations) + 2)
    if asked.scene.case.stiffness.face_positions is not None and asked.gear:
        gear = asked.scene.gears[asked.gear]
        solids = _QUICK_SOLIDS if quick else _SOLIDS
        total += solids * seconds_of_solid_gear(SolidSettings(), gear.face_width / gear.module)
    for configuration in [ladder.reference, ladder.check, *(group[0] for group in ladder.meshes)]:
        if configuration.settings is not None:
            one = seconds_of_gear(configuration.settings)
            total += one * len(asked.gears) * (3.0 if one < 0.3 else 1.0)
    return total


def internal_gears(asked: Asked) -> list[str]:
    """Names of the gears that are studied and internal."""
    return [name for name in asked.gears if asked.scene.gears[name].tooth.internal]


def ladder_of(asked: Asked, *, quick: bool = False) -> Ladder:
    """The ladder for what is asked."""
    if asked.over_face:
        panels = pair_spec(asked.scene, asked.pair, over_face=True).panel_count
        return flank_ladder(panels, quick=quick, internal=bool(internal_gears(asked)))
    teeth = min((asked.scene.gears[name].teeth for name in asked.gears), default=0)
    solved = [q.name for q in asked.quantities if asked.solves(q)]
    return make_ladder(asked.usual_half_width, solved, teeth, tabled=asked.tabled, quick=quick)


def study_cost(asked: Asked, *, quick: bool = False, watcher: Watcher | None = None) -> CostResults:
    """Run the ladder of settings for every quantity that is asked.

    Parameters
    ----------
    asked : Asked
    quick : bool
        A few configurations instead of all.
    watcher : Watcher, optional

    Returns
    -------
    CostResults
        After Ctrl-C those of the configurations that were finished, if the reference was.
    """
    watcher = watcher or Silence()
    started = time.perf_counter()
    ladder = ladder_of(asked, quick=quick)
    found = Found(asked)
    steps = _flank_steps(found, ladder) if asked.over_face else _steps(found, ladder, quick=quick)
    try:
        with one_thread():
            for number, (title, work) in enumerate(steps, start=1):
                watcher.begin(title, number, len(steps))
                clock = time.perf_counter()
                work()
                watcher.end(time.perf_counter() - clock)
    except KeyboardInterrupt:
        if not found.rows:
            raise
        found.remarks.append("Interrupted: only completed configurations are listed.")
    found.remarks.extend(asked.notes)
    if quick:
        found.remarks.append(
            f"Quick study: fewer configurations and a coarser reference ({ladder.reference.label}), whose error "
            "limits each quantity."
        )
    if asked.over_face and (rings := internal_gears(asked)):
        found.remarks.append(
            f"Coupled slices omitted: available for external gears only, gear {', '.join(rings)} is internal."
        )
    whole = {one: len(answered(asked, one)) for one in ladder.configurations}
    done = [one for one, count in whole.items() if sum(row.configuration == one for row in found.rows) == count]
    return CostResults(
        asked, ladder.reference, {name: largest(v) for name, v in found.reference.items()}, found.floors,
        tuple(row for row in found.rows if row.configuration in done), tuple(found.knobs), len(ladder.configurations),
        time.perf_counter() - started, tuple(found.remarks), _saved_by_condensation(found.rows),
    )  # fmt: skip


def _saved_by_condensation(rows: Sequence[Measured]) -> str:
    """What the nested dissection saves beside scikit-fem's own assembly and elimination, on one mesh."""
    for row in rows:
        if row.configuration.family != "scikit-fem" or row.configuration.settings is None:
            continue
        settings = replace(row.configuration.settings, solver="condensed")
        like = (one for one in rows if one.quantity == row.quantity and one.configuration.family == "ring")
        same = next((one for one in like if one.configuration.settings == settings), None)
        if same is not None and same.seconds.cpu > 0.0:
            plain, dissected = row.seconds.cpu, same.seconds.cpu
            return (
                f"accuracy.solver: the sector assembled, condensed and solved by scikit-fem takes {plain:.2g} s of "
                f"CPU time, {plain / dissected:.1f} times the {dissected:.2g} s of nested dissection, for the same "
                "results."
            )
    return ""


def _steps(found: Found, ladder: Ladder, *, quick: bool) -> list[tuple[str, Callable[[], None]]]:
    """Everything that will be done, in order, with the words for the watcher."""
    asked = found.asked
    kept: dict[str, FiniteElements] = {}

    def reference() -> None:
        kept["reference"] = refer(found, ladder)

    def vary() -> None:
        found.knobs += ladder_knobs(found, ladder, kept["reference"])

    steps: list[tuple[str, Callable[[], None]]] = [
        ("Warm-up", lambda: _warm_up(asked, ladder)),
        (f"Reference: {ladder.reference.label}", reference),
    ]
    steps += [(one.label, partial(measure_alone, found, one)) for one in ladder.others if one.formula]
    for group in ladder.meshes:
        more = f" and {len(group) - 1} more" if len(group) > 1 else ""
        steps.append((group[0].label + more, partial(measure_meshes, found, group)))
    steps += [(one.label, partial(measure_alone, found, one)) for one in ladder.others if not one.formula]
    steps.append(("Settings of the finite elements", vary))
    if asked.pair:
        steps.append(
            (
                "Settings of load sharing and dynamics",
                lambda: found.knobs.extend(pair_knobs(asked, _of_pair(asked, kept))),
            )
        )
    if asked.scene.case.stiffness.face_positions is not None and asked.gear:
        steps.append(("Settings of 3D gears", partial(_vary_width, found, quick=quick)))
    return steps


def _flank_steps(found: Found, ladder: Ladder) -> list[tuple[str, Callable[[], None]]]:
    """The same for a pair that is loaded over its face; its reference warms everything up."""
    steps: list[tuple[str, Callable[[], None]]] = [
        (f"Reference: {ladder.reference.label}", partial(refer_flanks, found, ladder))
    ]
    for group in ladder.meshes:
        more = f" and {len(group) - 1} more" if len(group) > 1 else ""
        steps.append((group[0].label + more, partial(measure_flanks, found, group)))
    return steps


def _vary_width(found: Found, *, quick: bool) -> None:
    found.knobs += solid_knobs(found.asked, quick=quick)


def _of_pair(asked: Asked, kept: Mapping[str, Source]) -> Source:
    return CaseTable() if asked.tabled else kept["reference"]


def _warm_up(asked: Asked, ladder: Ladder) -> None:
    """Import and compile everything once: no configuration is charged for that."""
    coarse = ladder.meshes[0][0] if ladder.meshes else ladder.check
    source = finite_elements(asked, coarse, solve_gears(asked, coarse)[0])
    for quantity in asked.quantities:
        answer(asked, quantity, source if asked.solves(quantity) else CaseTable())
