"""Settings of the finite elements one at a time, from a fine base: how the error falls with each."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.settings import MeshSettings
from fegear.studies.cost.answers import answer
from fegear.studies.cost.quantities import miss
from fegear.studies.cost.result import make_knob
from fegear.studies.cost.sources import FiniteElements

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fegear.arrays import Array
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.configuration import Configuration
    from fegear.studies.cost.ladder import Ladder
    from fegear.studies.cost.measure import Found
    from fegear.studies.cost.quantities import Quantity
    from fegear.studies.cost.result import Knob


#: Widths in equal ratio: their successive differences fall at the order of the error itself.
_PATCHES = tuple(2.0 * MeshSettings().patch_half_width / 2.0 ** (i / 2.0) for i in range(6))


def ladder_knobs(found: Found, ladder: Ladder, best: FiniteElements) -> list[Knob]:
    """Edge length for each order, width of the pressure, teeth of a sector.

    Parameters
    ----------
    found : Found
        Answers of the ladder.
    ladder : Ladder
    best : FiniteElements
        The reference's gears; its mesh with another patch costs no new solution.

    Returns
    -------
    list of Knob
    """
    knobs: list[Knob] = []
    asked, values, rows = found.asked, found.values, found.rows
    quantities = [q for q in asked.quantities if asked.solves(q)]
    seconds = {(row.configuration, row.quantity): row.seconds.cpu for row in rows}
    for quantity in quantities:
        name = quantity.name
        fine = _by_patch(asked, quantity, best)
        for group in _edge_groups(ladder):
            settings = group[0].settings
            there = [configuration for configuration in group if (configuration, name) in values]
            if settings is None or len(there) < 2:
                continue
            exact = fine(settings.patch_half_width)
            factors = np.array([configuration.factor for configuration in there])
            edges = factors * MeshSettings().root_edge_length
            errors = [miss(name, values[configuration, name], exact).rms for configuration in there]
            at = f"patch {settings.patch_half_width:g} modules, against the reference's mesh with it; root mean square"
            spent = [seconds[configuration, name] for configuration in there]
            knob = f"edge length, order {settings.order}"
            knobs.append(make_knob(name, knob, at, edges, factors, errors, found.mesh_floors[name], spent))
        known = [fine(a) for a in _PATCHES]
        change = [miss(name, a, b).rms for a, b in pairwise(known)]
        at = "the reference's mesh, change to the next narrower of equal ratio"
        knobs.append(make_knob(name, "patch half-width", at, _PATCHES[:-1], _PATCHES[:-1], change))
        sectors = [row for row in rows if row.configuration.family == "sector" and row.quantity == name]
        teeth = np.array([row.configuration.teeth for row in sectors], dtype=float)
        if teeth.size > 1:
            at = "against the whole gear; root mean square"
            errors = [row.miss.rms for row in sectors]
            spent = [row.seconds.cpu for row in sectors]
            floor = found.floors[name]
            knob = "teeth of a sector with free sides"
            knobs.append(make_knob(name, knob, at, teeth, 1.0 / teeth, errors, floor, spent))
    return knobs


def _by_patch(asked: Asked, quantity: Quantity, best: FiniteElements) -> Callable[[float], Array]:
    """Answers of the reference's mesh under pressures of other widths, each computed once."""
    known: dict[float, Array] = {}

    def answers(patch: float) -> Array:
        if patch not in known:
            solved = {
                name: replace(one, settings=replace(one.settings, patch_half_width=patch))
                for name, one in best.solved.items()
            }
            known[patch] = answer(asked, quantity, FiniteElements(solved))
        return known[patch]

    return answers


def _edge_groups(ladder: Ladder) -> Iterable[list[Configuration]]:
    """Whole-gear configurations of one order and one patch: the narrowest that every mesh of the order has."""
    by_order: dict[int, list[tuple[Configuration, ...]]] = {}
    for group in ladder.meshes:
        settings = group[0].settings
        if settings is not None and group[0].family == "ring":
            by_order.setdefault(settings.order, []).append(group)
    for groups in by_order.values():
        widths = [{r.settings.patch_half_width: r for r in group if r.settings is not None} for group in groups]
        common = set(widths[0]).intersection(*widths[1:])
        if common:
            yield [w[min(common)] for w in widths]
