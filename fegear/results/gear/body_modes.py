"""Stage ``body-modes``: natural frequencies of a gear with its width, rim, web and hub, its bore held."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.solid_influence import check_solid_gear, solid_settings_of
from fegear.engine.citation import citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import TriangleField
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.geometry.outline import turned
from fegear.results.forecasts import RING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.solid.body_modes import BodyMode, BodyModes
    from fegear.fem.solid.settings import SolidSettings
    from fegear.geometry.gear import Gear

#: Nodal diameters up to which modes are looked for, and how many with each.
_DIAMETERS, _EACH = 3, 3
#: Quadratic elements as many times as long as those of loaded teeth, and again for the solution that shows the error,
#: in which layers and polynomials are as many times fewer.
_COARSER, _AGAIN, _FEWER = 2.0, 1.35, 0.6
#: What is stated: so many times the difference of both, and a share of the frequency; the corners between rim, web and
#: hub let frequencies converge slowly, and twice the layers on finer meshes moved them by .1 to .5 %.
_TIMES, _FLOOR = 2.5, 3e-3
#: Motion as drawn, in modules.
_DRAWN = 1.0
#: Processor seconds of a usual gear.
_SECONDS = 60.0


@dataclass(frozen=True)
class BodyToSolve:
    """A gear, and how finely its body is solved; the ring gears of the case, which are passed over."""

    gear: Gear
    settings: SolidSettings
    name: str
    rings: tuple[str, ...] = field(default=(), compare=False)


@dataclass(frozen=True)
class SolvedBody:
    """Modes of a body; and what a coarser solution says of their frequencies."""

    found: BodyModes
    other: BodyModes

    @property
    def errors(self) -> Array:
        """Estimated errors of the frequencies, of one module and unit material, shape (modes,)."""
        pairs = zip(self.found.modes, self.other.modes, strict=True)
        return np.array([_TIMES * abs(a.frequency - b.frequency) + _FLOOR * a.frequency for a, b in pairs])

    @property
    def frequencies(self) -> Array:
        """Of one module and unit material, shape (modes,)."""
        return np.array([mode.frequency for mode in self.found.modes])

    @property
    def lowest(self) -> BodyMode:
        """The mode with the lowest frequency."""
        return self.found.modes[int(np.argmin(self.frequencies))]


def _inputs(scene: Scene, name: str) -> BodyToSolve:
    gear, settings = scene.gears[name], solid_settings_of(scene, name)
    if gear.body is not None and gear.body.holes is not None:
        raise InputError(
            f"gear.{name}.body.holes", gear.body.holes.count, "are not supported "
                                                              "by body-modes", "remove body-modes or the holes",
        )  # fmt: skip
    section = replace(settings.section.scaled(_COARSER), order=2)
    return BodyToSolve(gear, replace(settings, section=section), name, _gears(scene, internal=True))


def _gears(scene: Scene, *, internal: bool) -> tuple[str, ...]:
    return tuple(name for name, part in scene.case.gear.items() if part.internal is internal)


def _compute(asked: BodyToSolve, _upstream: Upstream, work: Work) -> SolvedBody:
    from fegear.fem.solid.body_modes import body_modes

    gear, m = asked.gear, asked.gear.module
    found = []
    for edges, fineness in ((1.0, 1.0), (_AGAIN, _FEWER)):
        settings = replace(asked.settings, section=asked.settings.section.scaled(edges))
        found.append(body_modes(
            gear.symmetric_tooth, gear.twist * m, gear.face_width / m, gear.material.poisson_ratio,
            gear.bore_radius / m, settings, gear.body_in_modules,
            diameters=min(_DIAMETERS, gear.teeth // 2), each=_EACH, fineness=fineness,
        ))  # fmt: skip
        work.progress(len(found) / 2)
    return SolvedBody(*found)


def _unit(asked: BodyToSolve) -> float:
    """Frequency [Hz] of omega = 1 of one module, Young's modulus and density."""
    gear = asked.gear
    return math.sqrt(gear.material.young_modulus / gear.material.density) / gear.module / (2.0 * math.pi)


def _figure(seen: Seen) -> Iterator[Figure]:
    """The lowest mode with each number of nodal diameters, seen along the axis."""
    known, asked, unit = seen.data, seen.asked, _unit(seen.asked)
    gear, m, mesh = asked.gear, asked.gear.module * 1e3, known.found.mesh
    corners, count = mesh.triangles[:3], mesh.vertex_count
    panels = []
    for n in sorted({mode.diameters for mode in known.found.modes}):
        mode = min((one for one in known.found.modes if one.diameters == n), key=lambda one: one.frequency)
        points, moved = [], []
        for k in range(gear.teeth):
            place = mesh.points[:, :count]
            motion = (mode.shape * np.exp(2j * math.pi * n * k / gear.teeth)).real
            out = place / np.hypot(*place)
            there = place + _DRAWN * (motion[0] * out + motion[1] * np.stack([out[1], -out[0]]))
            points.append(turned(there, 2.0 * math.pi * k / gear.teeth))
            moved.append(np.sqrt((motion**2).sum(axis=0)))
        triangles = np.hstack([corners + k * count for k in range(gear.teeth)])
        field = TriangleField(
            np.hstack(points) * m, triangles, np.concatenate(moved), 1.0, "motion relative to the maximum"
        )
        end = 1.06 * gear.tip_radius * 1e3
        panels.append(Panel(
            Axis("x", "mm", limits=(-end, end)), Axis("y", "mm", limits=(-end, end)), (field,),
            title=f"{n} nodal diameters: {unit * mode.frequency:.0f} Hz, {mode.kind}", equal=True,
        ))  # fmt: skip
    yield Figure(
        f"body_modes_{asked.name}", f"Mode shapes of gear {asked.name}",
        f"The lowest mode of gear {asked.name} with each number of nodal diameters, seen along the axis: axial "
        "(colour) and in-plane displacement of the web centre plane.",
        tuple(panels), columns=2,
    )  # fmt: skip


def _on_the_body(seen: Seen) -> str:
    held = "bore" if seen.asked.gear.body is None else "hub"
    return (
        f"Gear {seen.name}: natural frequencies of the gear body only, {held} fixed over its width; no "
        f"mesh, shaft or bearings. Up to {seen.data.found.modes[-1].diameters} nodal diameters, {_EACH} modes each; "
        "modes with nodal diameters occur in pairs."
    )


_SHEET = Sheet(
    tables=(
        Rows(
            "body_modes_{name}", "Natural frequencies of gear {name}, bore fixed",
            (
                "diameters", Cell("frequency", si=lambda seen: _unit(seen.asked) * seen.data.frequencies),
                Off("frequency", lambda seen: _unit(seen.asked) * seen.data.errors),
                "kind", "axial", "radial", "tangential",
            ),
            of="found.modes",
        ),
    ),
    values=(
        Number(
            "frequency", lambda seen: _unit(seen.asked) * seen.data.errors[int(np.argmin(seen.data.frequencies))],
            "lowest", si=lambda seen: _unit(seen.asked) * seen.data.lowest.frequency, name="lowest_body_frequency",
            meaning=lambda seen: f"{seen.data.lowest.kind}, {seen.data.lowest.diameters} nodal diameters",
        ),
    ),
    figures=(_figure,),
    remarks=(
        Remark(
            _on_the_body
        ),
        lambda seen: [
            f"Gear {ring}: internal gear; natural frequencies of gear bodies are computed for external gears only."
            for ring in seen.asked.rings
        ],
    ),
    settings={"unknowns": "found.unknowns"},
)  # fmt: skip


BODY_MODES = Stage(
    subjects=lambda scene: _gears(scene, internal=False) or _gears(scene, internal=True),  # rings alone are refused
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_solid_gear,
    cites=citing(*RING),
    forecast=lambda scene, name: Forecast(asdict(solid_settings_of(scene, name)), _SECONDS),
)
