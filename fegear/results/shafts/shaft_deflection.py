"""Result ``shaft-deflection``: how the shafts bend under all meshes, forces and lives of their bearings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import neglecting
from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage
from fegear.results import forecasts
from fegear.results.shafts.checked_shafts import ShaftChecks, checked_shafts, checks_of, said_of_checks
from fegear.results.shafts.loaded_shafts import LOADED_SHAFTS_TASK, loaded_shafts, shafts_of
from fegear.shafts.deflection import BearingLoads
from fegear.shafts.stress import ShaftStress, nominal_stress

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.base.arrays import Array
    from fegear.base.notes import Note
    from fegear.case.reading import Scene
    from fegear.contact.wide.on_shafts import LoadedShafts
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work
    from fegear.shafts.deflection import Deflection
    from fegear.shafts.life import LifeRating


@dataclass(frozen=True)
class DeflectionInputs:
    """Names of the bearings, ratings of their lives and errors of their stiffness, by shafts and bearings.

    Errors are relative; None where what rolls in a bearing is not estimated from a catalogue.
    """

    bearings: tuple[tuple[str, ...], ...]
    lives: tuple[tuple[LifeRating | None, ...], ...]
    errors: tuple[tuple[float | None, ...], ...]
    checks: ShaftChecks


@dataclass(frozen=True)
class DeflectedShaft:
    """A shaft under the nominal loads, with the loads of its bearings."""

    bent: Deflection
    loads: BearingLoads
    stress: ShaftStress
    name: str = shown("", "name of the shaft", name="shaft")
    bearings: tuple[str, ...] = shown("", "name", name="bearing")
    stiffness: Array | None = shown("N/um", "slope of the radial bearing force", name="radial_stiffness", default=None)
    stiffness_error: Array | None = None


def _inputs(scene: Scene, _name: str) -> DeflectionInputs:
    names = tuple(tuple(one.bearing for one in part.bearings) for part in scene.case.shaft.values())
    known = scene.case.bearing
    lives = tuple(tuple(known[one].rating for one in row) for row in names)
    errors = tuple(tuple(printed.error if (printed := known[one].printed) else None for one in row) for row in names)
    return DeflectionInputs(names, lives, errors, checks_of(scene))


def _compute(_inputs: DeflectionInputs, upstream: Upstream, _work: Work) -> LoadedShafts:
    return loaded_shafts(upstream)


def _deflected(data: LoadedShafts, asked: DeflectionInputs) -> list[DeflectedShaft]:
    """Every shaft; stiffness with its error where a bearing is estimated."""
    estimated = any(error is not None for row in asked.errors for error in row)
    found = []
    for name, bent, drawn, bearings, lives, errors in zip(
        data.gearbox.names, data.nominal.bent, asked.checks.drawn, asked.bearings, asked.lives, asked.errors,
        strict=True,
    ):  # fmt: skip
        slope = bent.radial_stiffness if estimated else None
        off = None if slope is None else slope * np.array([np.nan if one is None else one for one in errors])
        loads = bent.bearing_loads(lives)
        found.append(DeflectedShaft(bent, loads, nominal_stress(bent, drawn), name, bearings, slope, off))
    return found


def overlooked(
    names: Sequence[Sequence[str]], lives: Sequence[Sequence[LifeRating | None]], bent: Sequence[Deflection]
) -> list[Note]:
    """Bearings of which the axial force is missing in the life, for want of factors.

    Parameters
    ----------
    names, lives : sequence of sequence
        Of every bearing by shafts: its name and rating.
    bent : sequence of Deflection
        The shafts.
    """
    found = []
    for of_names, of_lives, shaft in zip(names, lives, bent, strict=True):
        for name, life, force in zip(of_names, of_lives, shaft.bearing_forces, strict=True):
            radial, axial = float(np.hypot(*force[:2])), abs(float(force[2]))
            if life is not None and life.overlooks(radial, axial):
                found.append(
                    neglecting(
                        f"Bearing {name}: axial force of {figures(axial)} N (radial {figures(radial)} N) not included "
                        "in its life; specify life.radial_factor, axial_factor and limit, or its catalogue or elements"
                    )
                )
    return found


def _most_bent(seen: Seen) -> DeflectedShaft:
    return max(seen.data, key=lambda one: float(np.hypot(one.bent.line.x, one.bent.line.y).max()))


def _sentences(seen: Seen) -> Iterator[str]:
    """Shortest life of a bearing, largest deflection, largest bearing force, the weakest shaft."""
    of_bearings = [(one, k) for one in seen.data for k in range(len(one.bearings))]
    lives = [(one.loads.life[k], one, k) for one, k in of_bearings if np.isfinite(one.loads.life[k])]
    if lives:
        life, one, k = min(lives, key=lambda found: found[0])
        yield (
            f"Bearing {one.bearings[k]} of shaft {one.name}: basic rating life L_10 {figures(life * 1e-6)} million "
            f"revolutions{_of(len(lives), 'the shortest of')}."
        )
    bent = _most_bent(seen)
    shift = float(np.hypot(bent.bent.line.x, bent.bent.line.y).max()) * 1e6
    yield f"Shaft {bent.name}: displacement up to {figures(shift)} µm{_of(len(seen.data), 'the largest of')}."
    if of_bearings:
        one, k = max(of_bearings, key=lambda found: float(found[0].loads.force_radial[found[1]]))
        yield (
            f"Bearing {one.bearings[k]} of shaft {one.name}: radial force {figures(one.loads.force_radial[k] * 1e-3)} "
            f"kN{_of(len(of_bearings), 'the largest of')}."
        )
    yield from _strained(seen)


def _strained(seen: Seen) -> Iterator[str]:
    """The shaft that is nearest to yielding."""
    checked = checked_shafts(seen.asked.checks, [one.bent for one in seen.data])
    yield f"Shaft {checked[0].shaft}{_of(len(checked), 'the weakest of')}: {checked[0].found}."


def _of(count: int, words: str) -> str:
    return f", {words} {count}" if count > 1 else ""


_SHEET = Sheet(
    answer=Answer(_sentences, figure=lambda seen: f"shaft_deflection_{_most_bent(seen).name}"),
    of=_deflected,
    name=lambda _asked: "",
    tables=(
        Rows(
            "shaft_deflection_{one.name}", "Deflection of shaft {one.name}",
            ("z", "x", "y", "along", "turn_x", "turn_y", "twist"), of="bent.line", each="",
        ),
        Rows(
            "shaft_stress_{one.name}", "Nominal stress of shaft {one.name}",
            ("z", "diameter", "bending", "torsion", "axial", "equivalent"), of="stress", each="",
        ),
        Rows(
            "bearing_forces", "Forces and lives of the bearings",
            (
                "name", "bearings", *(f"loads.{key}" for key in BearingLoads.__dataclass_fields__),
                Cell("stiffness", error="stiffness_error"),
            ),
            stacked="",
        ),
    ),
    remarks=(
        lambda seen: overlooked(seen.asked.bearings, seen.asked.lives, [one.bent for one in seen.data]),
        lambda seen: said_of_checks(seen.asked.checks, [one.bent for one in seen.data]),
    ),
    figures=(
        Chart(
            "shaft_deflection_{one.name}", "Deflection of shaft {one.name}",
            "Shaft {one.name}: displacement of its axis along x and y under the forces of all meshes.",
            (
                Over(
                    "z",
                    tuple(Line(key, key, f"series:{n}", look={"markers": False}) for n, key in enumerate(("x", "y"))),
                    options={"label": "displacement of the axis"},
                ),
            ),
            of="bent.line", each="",
        ),
        Chart(
            "shaft_stress_{one.name}", "Nominal stress of shaft {one.name}",
            "Shaft {one.name}: nominal stress of its sections from bending, torsion and axial force, without notches; "
            "bending alternates with the rotation.",
            (
                Over(
                    "z",
                    tuple(
                        Line(key, words, f"series:{n}", look={"markers": False})
                        for n, (key, words) in enumerate(
                            (("equivalent", "equivalent (von Mises)"), ("bending", "bending"), ("torsion", "torsion"))
                        )
                    ),
                    options={"label": "nominal stress"},
                ),
            ),
            of="stress", each="",
        ),
    ),
)  # fmt: skip


SHAFT_DEFLECTION = Stage(
    subjects=shafts_of,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    needs=lambda _scene, _name: (LOADED_SHAFTS_TASK,),
    cites=citing(Citation("cowper", "shear coefficient of hollow circles")),
    forecast=lambda _scene, _name: forecasts.constant(0.01),
)
