"""A gear with its width: edges of its section and functions along the face, one at a time."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.solid import SolidSettings
from fegear.fem.solid.slices import solver_of
from fegear.fem.solid.table import band_numbers, bands_of_table
from fegear.results.solid_stiffness import face_positions
from fegear.studies.cost.quantities import miss
from fegear.studies.cost.result import make_knob
from fegear.studies.cost.timing import timed

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.result import Knob

#: Edges over the usual ones, and functions per module of face; the last of each is what the others are held against.
_FACTORS, _WAVES = (1.5, 1.25, 1.0, 0.8, 0.6), (0.75, 1.0, 1.5, 2.0, 3.0)
#: Edges of slices over the usual ones, then those of the solid gear that shows how far off slices are.
_OF_SLICES = np.array([*_FACTORS[:-1], 1.0])
#: What is looked at, and what it is called.
_NAMES = {"c_self": "c_0 over the face", "c_next": "c_1 over the face", "root_tension": "root tension over the face"}


def solid_knobs(asked: Asked) -> list[Knob]:
    """What edges of the section and functions along the face cost, for the bands of ``[stiffness] face_positions``.

    Parameters
    ----------
    asked : Asked

    Returns
    -------
    list of Knob
    """
    usual, edge = SolidSettings(), SolidSettings().section.root_edge_length
    by_edge = [replace(usual, section=usual.section.scaled(factor)) for factor in _FACTORS]
    by_wave = [replace(usual, waves_per_module=waves, least_degree=3) for waves in _WAVES]
    by_slice = [replace(one, source="slices") for one in by_edge[:-1]]
    return [
        *_varied(asked, by_edge, "edges of the section", f"{usual.waves_per_module:g} functions per module of face",
                 edge * np.array(_FACTORS), edge * np.array(_FACTORS)),
        *_varied(asked, by_wave, "functions per module of face", f"edges of {edge:g} modules", np.array(_WAVES),
                 1.0 / np.array(_WAVES)),
        *_varied(asked, [*by_slice, usual], "edges of the section, slices", "coupled slices of the plane section",
                 edge * _OF_SLICES, edge * _OF_SLICES, "the solid gear"),
    ]  # fmt: skip


def _varied(
    asked: Asked, settings: list[SolidSettings], name: str, others: str, setting: Array, step: Array, against: str = ""
) -> list[Knob]:
    """Knobs of one setting, its last value the one that the others are held against."""
    answers, spent = zip(*(timed(partial(_answer, asked, one), repeat=False) for one in settings), strict=True)
    seconds = [one.cpu for one in spent[:-1]]
    at = f"{others}, against {against or f'{setting[-1]:.3g}'}; largest of the bands"
    return [
        make_knob(
            quantity, name, at, setting[:-1], step[:-1],
            [miss("c_0", one[key].ravel(), answers[-1][key].ravel()).largest for one in answers[:-1]], 0.0, seconds,
        )
        for key, quantity in _NAMES.items()
    ]  # fmt: skip


def _answer(asked: Asked, settings: SolidSettings) -> dict[str, Array]:
    """Compliances and root stresses of the bands of the case."""
    scene, gear = asked.scene, asked.scene.gears[asked.gear]
    m = gear.module
    solution = solver_of(settings)(
        gear.tooth, gear.twist * m, gear.face_width / m, gear.material.poisson_ratio, gear.bore_radius / m, settings
    )
    places = face_positions(scene, asked.gear) / m
    return band_numbers(solution, bands_of_table(solution, asked.radii / m, places, asked.half_width / m))
