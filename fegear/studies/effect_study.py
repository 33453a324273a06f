"""What each effect changes in a case and what it costs: the case run with each effect switched, one at a time."""

from __future__ import annotations

import math
import os
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from fegear.case.effects import EffectsPart
from fegear.case.names import nearest
from fegear.case.reading import build_scene, case_text, read_document
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.errors import InputError
from fegear.results.catalogue import STAGES
from fegear.studies.comparison.values import paired
from fegear.tally import tallying

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from fegear.case.reading import Scene
    from fegear.engine.run import Results
    from fegear.studies.comparison.values import Pairing

    Document = dict[str, Any]

#: Curves that show an effect, the clearest first: start of the table's name, its abscissa and ordinate.
CURVES = (
    ("dynamic_factor_", "speed", "dynamic_factor"),
    ("tooth_contact_", "phi1", "te"),
    ("transmission_error_", "x", "te"),
    ("tooth_force_", "x", "force"),
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
    known = {effect for step in make_plan(scene, STAGES).steps for effect in step.stage.effects}
    return tuple(effect for effect in EffectsPart.model_fields if effect in known)


def switch(document: Document, effect: str, *, on: bool) -> Document:
    """A case's document with an effect switched; data that have a meaning only with it go when it is switched off."""
    effects = dict(document.get("effects", {}))
    if effect == "hertz":
        effects[effect] = "load-dependent" if on else "none"
    else:
        effects[effect] = on
    changed = {**document, "effects": effects}
    if effect == "misalignment" and not on:
        changed["pair"] = _without(document["pair"], "misalignment")
    if effect == "contact_loss" and not on and "train" in document:
        train = document["train"]
        changed["train"] = {**train, "mesh": _without(train.get("mesh", {}), "backlash")}
    return changed


def _without(tables: Document, key: str) -> Document:
    return {name: {k: v for k, v in table.items() if k != key} for name, table in tables.items()}


def measure(scene: Scene) -> Measured:
    """Run a scene from nothing, with its processor seconds (worker processes included) and its kernels counted."""
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
                "--effect", f'"{effect}"', "is no effect that influences the wanted results", nearest(effect, felt)
            )
    effects = tuple(only) or felt
    say = progress or (lambda _title, _fraction: None)
    say("as it is", 0.0)
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
