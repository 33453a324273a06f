"""Result ``planet-vibration-revolution``: a planetary set with odd teeth in motion at its speed.

Dynamic transmission error and mesh forces of all planets in time until the same teeth mesh again, with loss of contact;
their orders, condition indicators, and the sidebands that a pick-up on the ring sees as planets pass it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from fegear.base.effects import ODD_TEETH
from fegear.base.errors import InputError
from fegear.base.shown import declared, shown, shown_as
from fegear.case.built.planetary import planetary_part
from fegear.case.planetary import MESHES, set_pair
from fegear.dynamics.planetary.set_motion_over_revolution import SetMotionOverRevolution
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task
from fegear.results.pair.loaded_teeth import pair_over_revolution
from fegear.results.pair.mesh_stiffness_revolution import INDICATORS
from fegear.results.planetary.planet_load_sharing import effects_of_set, given_or_wide_springs
from fegear.results.planetary.planet_motion import check_moving, unlimited
from fegear.results.planetary.planet_revolution import (
    ODD_REMARKS,
    SetRevolutionInputs,
    check_revolution,
    needs_revolution,
    odd_gears_of_set,
    orders_and_lines,
    revolution_inputs,
)
from fegear.results.planetary.planet_set import planetary_sets

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.planetary import Mesh
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.set_response import LinearSet
    from fegear.dynamics.planetary.set_signals import RingLines
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: Seconds of a steady motion over one base pitch, and planet.
_SECONDS = 0.04


@dataclass(frozen=True)
class SetVibrationInputs:
    """What the motion of a set with odd teeth depends on besides its pairs and modes.

    Parameters
    ----------
    revolution : SetRevolutionInputs
    backlash : float
        Of every mesh along the line of action [m].
    tolerance : float
        Of the largest forces, over the mean force.
    """

    revolution: SetRevolutionInputs
    backlash: float
    tolerance: float

    @property
    def name(self) -> str:
        """Of the set."""
        return self.revolution.name


def _inputs(scene: Scene, name: str) -> SetVibrationInputs:
    backlash = planetary_part(scene, name).backlash
    return SetVibrationInputs(revolution_inputs(scene, name), unlimited(backlash), scene.case.dynamics.tolerance)


def _compute(inputs: SetVibrationInputs, upstream: Upstream, work: Work) -> SetMotionOverRevolution:
    from fegear.dynamics.motion.steady_state import steady_state
    from fegear.dynamics.planetary.set_motion import OddMeshes, SetMotion
    from fegear.dynamics.planetary.set_motion_over_revolution import set_motion_over_revolution

    asked = inputs.revolution
    linear = cast("LinearSet", upstream[Task("planet-modes", inputs.name)])
    sun, ring = (
        _teeth(asked, mesh, force, upstream) for mesh, force in zip(MESHES, linear.meshed.mean_forces, strict=True)
    )
    odd = OddMeshes((sun, ring), asked.delays)
    run = SetMotion(linear, asked.asked.run.mesh_frequency, asked.errors, inputs.backlash, odd)
    state = steady_state(run, tolerance=inputs.tolerance, progress=work.progress)
    return set_motion_over_revolution(run, state, asked.odd_planet, asked.teeth, asked.clockwise)


def _teeth(asked: SetRevolutionInputs, mesh: Mesh, force: float, upstream: Upstream) -> tuple[MeshExcitation, ...]:
    """Teeth of a mesh of every planet as springs about the mean force."""
    from fegear.dynamics.train.mesh_excitation import mesh_excitation

    found = given_or_wide_springs(asked.asked, mesh, upstream)
    if found is not None:
        return (found,) * asked.asked.model.count
    odd = pair_over_revolution(upstream, set_pair(asked.name, mesh)).engagement
    return asked.of_planets(mesh, [odd], lambda each: mesh_excitation(each[0], force))


@dataclass(frozen=True)
class PlanetForces:
    """Dynamic mesh forces of one planet over all base pitches, shape (M,)."""

    s: Array = shown_as(declared(SetMotionOverRevolution, "s"))
    load: Array = shown("N", "dynamic mesh force of this planet with the sun, along the line of action")
    load_ring: Array = shown("N", "dynamic mesh force of this planet with the ring, along the line of action")


@dataclass(frozen=True)
class ShownMotionOver:
    """What is shown of a moving set over all base pitches."""

    found: SetMotionOverRevolution

    @property
    def planets(self) -> dict[str, PlanetForces]:
        """By number, from 1."""
        sun, ring = self.found.mesh_force
        both = enumerate(zip(sun, ring, strict=True))
        return {str(n + 1): PlanetForces(self.found.s, *forces) for n, forces in both}

    @property
    def at_ring(self) -> RingLines | None:
        """Lines at the ring; None where the planets' forces cancel, as four about a floating sun do."""
        lines = self.found.at_ring
        return lines if lines.order.size else None

    @property
    def odd_number(self) -> int:
        """Number of the planet with odd teeth, from 1."""
        return self.found.signals.odd_planet + 1


def _answer(seen: Seen) -> Iterator[str]:
    data: SetMotionOverRevolution = seen.data.found
    if data.base_pitches > 1:
        yield (
            f"Set {seen.name}: residual of the dynamic transmission error up to "
            f"{data.dynamic_te_residual_max * 1e6:.3g} µm, maximum mesh force {data.mesh_force_max:.4g} N "
            f"({data.mesh_force_max / data.signals.mean_force:.3g} of the equal share); the odd teeth mesh again after "
            f"{data.base_pitches} base pitches."
        )


_OVER, _PLAIN = Axis("mesh cycle, in base pitches"), {"markers": False}
_TABLES, _FIGURES = orders_and_lines(
    "planet_vibration_revolution", "found.orders", "dynamic transmission error"
)  # fmt: skip
_SHEET = Sheet(
    of=lambda data, _inputs: ShownMotionOver(data),
    name=lambda inputs: inputs.name,
    tables=(
        Rows(
            "planet_vibration_revolution_{name}",
            "Motion of set {name} over {d.found.base_pitches} base pitches",
            (
                "found.s", "found.time", "found.te", "found.te_residual", "found.acceleration",
                Cell("load", each="planets", ending="_{key}"),
                Cell("load_ring", each="planets", ending="_{key}"),
            ),
            matlab=True,
        ),
        *_TABLES,
    ),
    values=(
        Number("found.mesh_force_max", name="set_mesh_force_max"),
        Number("found.dynamic_te_residual_max", name="set_dynamic_te_residual_max"),
        *(Number(key, of="found.indicators", name="set_dynamic_" + key) for key in INDICATORS),
    ),
    figures=(
        Chart(
            "planet_vibration_revolution_{name}",
            "Dynamic transmission error and mesh forces of set {name} over all base pitches",
            "Set {name}: dynamic transmission error, its residual (without mesh harmonics), and mesh forces of the "
            "planets with the sun over {d.found.base_pitches} base pitches, until the same teeth mesh again.",
            (
                Over(
                    _OVER,
                    (
                        Line("found.te", "transmission error", x="found.s", look=_PLAIN),
                        Line("found.te_residual", "residual", "red", x="found.s", look=_PLAIN),
                    ),
                    Axis("dynamic transmission error", "um"),
                ),
                Over(
                    _OVER,
                    (Line("load", x="s", each=Family("planets", "planet {key}", most=None), look=_PLAIN),),
                    Axis("mesh force", "N", zero=True),
                ),
            ),
        ),
        *_FIGURES,
    ),
    answer=Answer(_answer, figure="planet_vibration_revolution_{name}"),
    remarks=(
        *ODD_REMARKS,
        Remark("Set {name}: same damping ratio for all modes, also during loss of contact."),
        Remark(
            "Set {name}: loss of contact in up to {d.found.apart:.3g} of the time.",
            when=lambda seen: seen.data.found.apart > 0.0,
        ),
        Remark(
            "Set {name}: the motion does not repeat ({d.found.kind}); one cycle of the teeth is shown.",
            when=lambda seen: seen.data.found.kind != "periodic",
        ),
    ),
    settings={
        "base_pitches": "found.base_pitches", "odd_planet": "odd_number", "averaged": "found.averaged",
        "tolerance": lambda seen: seen.asked.tolerance,
    },
)  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    check_revolution(scene, name)
    check_moving(scene, name)
    if planetary_part(scene, name).speed is None:
        raise InputError(
            f"planetary.{name}.speed", "(not given)", "is required for this result", 'set speed = "1500 rpm"'
        )


def _forecast(scene: Scene, name: str) -> Forecast:
    odd = [scene.gears[gear].teeth for gear in odd_gears_of_set(scene, name)]
    pitches = math.lcm(*odd) if odd else 1
    planets = planetary_part(scene, name).count
    return Forecast({"base pitches": pitches, "planets": planets}, _SECONDS * pitches * planets)


PLANET_VIBRATION_REVOLUTION = Stage(
    subjects=planetary_sets,
    needs=lambda scene, name: (Task("planet-modes", name), *needs_revolution(scene, name)),
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    effects_of=lambda scene, name: (*effects_of_set(scene, name), ODD_TEETH.name),
    cites=citing(
        Citation("lin-parker", "model of the planetary set"),
        Citation("lin-huston-coy", "contact, loss of contact, back-side contact", "Eqs. 19 to 24"),
        Citation("mcfadden-smith", "sidebands of planets passing a sensor"),
        Citation("zakrajsek-townsend-decker", "condition indicators FM0, FM4, energy ratio"),
    ),
    forecast=_forecast,
)
