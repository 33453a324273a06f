"""What each effect changes in a case and what it costs: the case run with each effect switched, one at a time.

What each effect needs, which stages know it and which kernels run only with it, as tables for the effects' page.

The figure of one effect: the curve that it changes most, without it and with it, the change, and the seconds.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fegear.base.arrays import Array
from fegear.base.effects import EFFECTS
from fegear.base.errors import InputError
from fegear.base.tally import tallying
from fegear.case.nearest import nearest
from fegear.case.reading import Scene, build_scene, case_text, read_document
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.plan import make_plan
from fegear.engine.run import Results, run_plan
from fegear.engine.table import Table
from fegear.results.catalogue import STAGES
from fegear.studies.comparison.compare import Pairing, paired

Document = dict[str, Any]
EffectCurve = tuple[Table, Table, str, str]


#: Curves that show an effect, the clearest first: start of the table's name, its abscissa and ordinate.
CURVES = (
    ("dynamic_factor_", "speed", "dynamic_factor"),
    ("tooth_contact_", "phi1", "te"),
    ("transmission_error_", "x", "te"),
    ("tooth_force_", "x", "force"),
    ("mesh_stiffness_revolution_", "driver_angle", "te"),
    ("load_sharing_", "x", "load"),
    ("root_stress_history_", "x", "stress"),
    ("relief_", "x", "relief"),
)


@dataclass(frozen=True)
class Measured:
    """One run: what it found, the processor seconds and the calls of each kernel that it took."""

    results: Results
    seconds: float
    kernels: Mapping[str, int]


@dataclass(frozen=True)
class Switched:
    """An effect with and without; `named`: whether the case has it on."""

    effect: str
    named: bool
    without: Measured
    with_it: Measured

    def changes(self) -> list[Pairing]:
        """Values of the same name and unit, without the effect and with it."""
        return [
            pair
            for pair in paired(dict(self.without.results.values.items()), dict(self.with_it.results.values.items()))
            if math.isfinite(pair.change)
        ]

    def largest_change(self) -> Pairing | None:
        """The value that the effect changes most, of those by more than their estimated errors."""
        return max((pair for pair in self.changes() if pair.resolved), key=lambda pair: abs(pair.share), default=None)


@dataclass(frozen=True)
class Fixed:
    """An effect that cannot be switched in this case, and why."""

    effect: str
    reason: str


def felt_effects(scene: Scene) -> tuple[str, ...]:
    """Effects that the stages of a scene's plan know, on or off."""
    steps = make_plan(scene, STAGES).steps
    known = {effect for step in steps for effect in step.stage.effects_on(scene, step.task.subject)}
    return tuple(effect for effect in EFFECTS if effect in known)


def switch(document: Document, effect: str, *, on: bool) -> Document:
    """A case's document with an effect switched; data that have a meaning only with it go when it is switched off."""
    row = EFFECTS[effect]
    changed = {**document, "effects": {**document.get("effects", {}), effect: row.on if on else row.off}}
    return changed if on or not row.alone_with_it else _without(changed, *row.alone_with_it)


def _without(document: Document, table: str, *path: str) -> Document:
    """A document without a key of all entries of a table, whose names lie before it."""
    if table not in document:
        return document
    *inner, key = path
    if inner:
        return {**document, table: _without(document[table], *path)}
    entries = document[table].items()
    return {**document, table: {name: {k: v for k, v in one.items() if k != key} for name, one in entries}}


def measure(scene: Scene) -> Measured:
    """Run a scene from nothing, with its processor seconds (worker processes included) and its kernels counted.

    What an effect that is off would change is estimated only where the case asks for it: it would count, too.
    """
    scene = replace(scene, neglects=False)
    plan = make_plan(scene, STAGES)
    with tallying() as counts:
        children, own = sum(os.times()[2:4]), time.process_time()
        results = run_plan(scene, plan)
        seconds = time.process_time() - own + sum(os.times()[2:4]) - children
    return Measured(results, seconds, dict(counts))


def effect_study(
    path: Path,
    overrides: Sequence[str] = (),
    only: Sequence[str] = (),
    progress: Callable[[str, float], None] | None = None,
) -> tuple[Scene, list[Switched], list[Fixed]]:
    """Run a case with each effect that influences its results switched, one at a time.

    Parameters
    ----------
    path : Path
        Case file.
    overrides : sequence of str
        ``--set`` options.
    only : sequence of str
        Effects to look at; by default all that a stage of the plan knows.
    progress : callable, optional
        Called with the effect that is next and the fraction done.

    Returns
    -------
    scene : Scene
        The case as it is.
    switched : list of Switched
    fixed : list of Fixed
        Effects whose switched case is refused.
    """
    document = read_document(path, overrides)
    scene = replace(build_scene(document, path.stem, path.parent), text=case_text(path, overrides))
    felt = felt_effects(scene)
    for effect in only:
        if effect not in felt:
            raise InputError(
                "--effect",
                f'"{effect}"',
                "is not an effect that influences the requested results",
                nearest(effect, felt),
            )
    effects = tuple(only) or felt
    say = progress or (lambda _title, _fraction: None)
    say("unchanged", 0.0)
    measure(scene)  # loads libraries and compiles, which is no effect's cost
    as_it_is = measure(scene)
    switched: list[Switched] = []
    fixed: list[Fixed] = []
    for number, effect in enumerate(effects, start=1):
        named = scene.case.effects.is_on(effect)
        say(effect, number / (len(effects) + 1))
        try:
            other = measure(build_scene(switch(document, effect, on=not named), path.stem, path.parent))
        except InputError as error:
            fixed.append(Fixed(effect, str(error)))
            continue
        pair = (other, as_it_is) if named else (as_it_is, other)
        switched.append(Switched(effect, named, *pair))
    return scene, switched, fixed


def _table(heads: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)])


def felt_by(scenes: Iterable[Scene]) -> dict[str, set[str]]:
    """Results that each effect may change: those whose plan holds a stage that knows the effect.

    Parameters
    ----------
    scenes : iterable of Scene
        Cases that ask for the results, for which stages of others a stage needs depends on the scene.
    """
    found: dict[str, set[str]] = {effect: set() for effect in EFFECTS}
    for scene in scenes:
        for result in scene.case.results:
            case = scene.case.model_copy(update={"results": [result]})
            for effect in felt_effects(replace(scene, case=case)):
                found[effect].add(result)
    return found


def stage_table(scenes: Iterable[Scene]) -> str:
    """Effects against the stages that know them, in Markdown, from the stages' own words."""
    rows, felt = [], felt_by(scenes)
    for effect, fact in EFFECTS.items():
        stages = [f"`{stage.name}`" for stage in STAGES if effect in stage.effects]
        results = ", ".join(f"`{result}`" for result in sorted(felt[effect])) or "none"
        rows.append((f"`{effect}`", fact.about, fact.without, fact.needs, ", ".join(stages) or "none", results))
    heads = ("effect", "meaning", "assumed without it", "requirement")
    return _table((*heads, "stages that include it", "results it may change"), rows)


def kernel_table() -> str:
    """Kernels that run only with an effect, in Markdown."""
    rows = [
        (f"`{effect}`", "; ".join(f"{kernel} ({what})" for kernel, what in fact.kernels.items()) or "none")
        for effect, fact in EFFECTS.items()
    ]
    return _table(("effect", "kernels that run only with it"), rows)


_TITLES = {
    "dynamic_factor": "dynamic factor",
    "te": "transmission error",
    "force": "force on one tooth pair",
    "load": "load on one tooth pair",
    "stress": "root stress",
    "relief": "relief",
}


_ABSCISSAE = {
    "x": "position on the line of action",
    "speed": "speed",
    "phi1": "pinion angle",
    "driver_angle": "rotation of the driver",
}


_SMALLEST_CHANGE = 1e-9


def curves_of(measured: Measured) -> dict[str, Table]:
    """Tables of a run by name."""
    return {table.name: table for table in measured.results.tables}


def clearest_curve(found: Switched) -> EffectCurve | None:
    """The curve to draw: of the first kind that the runs have, the table that the effect changes most."""
    before, after = curves_of(found.without), curves_of(found.with_it)
    for start, x, y in CURVES:
        shared = [name for name in before if name.startswith(start) and name in after and _is_curve(before[name], x, y)]
        changed = [(_change(before[name], after[name], x, y), name) for name in shared]
        if changed and max(changed)[0] > _SMALLEST_CHANGE:
            name = max(changed)[1]
            return before[name], after[name], x, y
    return None


def _is_curve(table: Table, x: str, y: str) -> bool:
    """Whether a table holds one curve, and not one for each of several loads."""
    names = {column.name for column in table.columns}
    return {x, y} <= names and "total_load" not in names


def _change(before: Table, after: Table, x: str, y: str) -> float:
    """Largest change of a curve over its largest value, where both reach."""
    xa, ya, xb, yb = (np.asarray(table[column], dtype=float) for table in (before, after) for column in (x, y))
    inside = (xa >= xb[0]) & (xa <= xb[-1])
    scale = float(np.nanmax(np.abs(ya), initial=0.0))
    if not inside.any():
        return 0.0
    change = float(np.nanmax(np.abs(np.interp(xa[inside], xb, yb) - ya[inside])))
    return change / scale if scale > 0.0 else change


def _shown(table: Table, name: str) -> Array:
    return np.asarray(table[name], dtype=float)


def effect_figure(found: Switched, curve: EffectCurve | None, title: str) -> Figure:
    """Describe one effect.

    Parameters
    ----------
    found : Switched
    curve : tuple, optional
        What `clearest_curve` gives.
    title : str
        Of the case.
    """
    name = EFFECTS[found.effect].said
    name = f"{name[0].upper()}{name[1:]}"
    panels, what = _compared(curve, f"{name}\n{title}"), "CPU time" if curve is None else "change"
    seconds = (
        Bars([0.0], [found.without.seconds], "", "without"), Bars([1.0], [found.with_it.seconds], "", "with")
    )  # fmt: skip
    labels = tuple(
        f"{word}: {one.seconds:.2g} s" for word, one in (("without", found.without), ("with", found.with_it))
    )
    none = f"{name}\n{title} (no curve of this case changes)" if curve is None else ""
    panels.append(
        Panel(Axis("CPU time of the run", categories=labels), Axis("time", "s", zero=True), seconds,
              title=none, height=0.5, stacked=True)
    )  # fmt: skip
    drawn = "no curve" if curve is None else _TITLES.get(curve[3], curve[3])
    return Figure(
        f"effect_{found.effect}",
        f"Effect of {name[0].lower()}{name[1:]}",
        f"{name}: {drawn} with it and without it, {what}, and the CPU time of the run.",
        tuple(panels),
    )


def _compared(curve: EffectCurve | None, title: str) -> list[Panel]:
    if curve is None:
        return []
    before, after, x, y = curve
    unit = after.column(y).unit
    axis = Axis(_ABSCISSAE.get(x, x), after.column(x).unit)
    both = tuple(
        Curve(_shown(table, x), _shown(table, y), word, word, markers=False)
        for table, word in ((before, "without"), (after, "with"))
    )
    a, b = _shown(before, x), _shown(after, x)
    at = a[(a >= b[0]) & (a <= b[-1])]
    change = np.interp(at, b, _shown(after, y)) - np.interp(at, a, _shown(before, y))
    difference = Curve(at, change, "", "with", width=1.2, fill=True, markers=False)
    return [
        Panel(axis, Axis(_TITLES.get(y, y), unit), both, title=title, height=1.3),
        Panel(axis, Axis("change", unit), (difference,), height=0.6),
    ]
