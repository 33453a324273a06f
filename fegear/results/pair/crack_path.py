"""Result ``crack-path``: how the cracks of a pair's gears grow: path, cycles, and stiffness on the way."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.notes import neglecting
from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.case.built.odd_teeth import odd_teeth_in
from fegear.case.crack_growth import CrackGrowthPart
from fegear.contact.plane.crack_in_mesh import crack_in_mesh
from fegear.contact.plane.growing_crack import GrowingCrack, growing_crack
from fegear.contact.plane.over_revolution import over_revolution
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import outline
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.fem.alike_teeth import meshing_order
from fegear.geometry.outline import tooth_outline, turned
from fegear.geometry.pair import MEMBERS
from fegear.results.forecasts import HERTZ
from fegear.results.gear.odd_gear import CRACKS, odd_solution_of
from fegear.results.pair.loaded_teeth import ODD, check_teeth
from fegear.results.pair.mesh_stiffness_revolution import POSITIONS, RevolutionInputs, inputs_of
from fegear.results.pair.stress_intensity import STRESS_INTENSITY

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.odd.crack import Crack
    from fegear.geometry.gear import Gear

#: Seconds of one step.
_SECONDS = 0.4
#: Usual step [modules].
_STEP = 0.1
#: K_min over K_max, downward, from which a run says that the crack closes.
_PRESSED = 0.02


@dataclass(frozen=True)
class GrowthInputs:
    """What this stage reads of the case."""

    revolution: RevolutionInputs
    cracks: tuple[tuple[str, int, Crack], ...]
    part: CrackGrowthPart

    @property
    def name(self) -> str:
        """Of the pair."""
        return self.revolution.name


@dataclass(frozen=True)
class Path:
    """The crack of one tooth."""

    gear: str
    made: Gear
    tooth: int
    found: GrowingCrack

    @property
    def through(self) -> str:
        """Tooth or rim."""
        return self.found.end

    @property
    def closed(self) -> bool:
        """Whether the loads of its tooth do not open it."""
        return self.found.stopped == "closed"

    @property
    def pressed(self) -> bool:
        """Whether loads on other teeth press the open crack of the case together."""
        return self.k_1_min < -_PRESSED * self.k_1_max

    @property
    def ratio(self) -> str:
        """K_min over K_max, for readers."""
        return percent(self.k_1_min / self.k_1_max)

    final_length: float = shown("mm", "length of the crack after the last step", default=0.0)
    cycles: float | None = shown("", "load cycles to fracture, or to the last step", default=None)
    cycles_error: float | None = None
    k_1_max: float = 0.0
    k_1_min: float = shown(
        "MPa.m^(1/2)", "minimum K_I of the crack of the case over the mesh (negative: closed)",
        name="K_I_min_start", default=0.0,
    )  # fmt: skip


@dataclass(frozen=True)
class CrackPathData:
    """All cracks of a pair."""

    paths: tuple[Path, ...]


def _compute(asked: GrowthInputs, upstream: Upstream, work: Work) -> CrackPathData:
    revolution, part = asked.revolution, asked.part
    loaded = cast("LoadedPair", upstream[Task(ODD, revolution.name)])
    over = over_revolution(loaded.engagement, loaded.nominal, POSITIONS)
    found = []
    for n, (name, order, crack) in enumerate(asked.cracks):
        member = MEMBERS[revolution.gears.index(name)]
        known = odd_solution_of(upstream, name)
        gear = known.gear
        number = meshing_order(order, gear.teeth, member)
        rows = crack_in_mesh(loaded.engagement, over, member, known, number)
        # From the pitch point toward the driver's tip, which is toward the driven gear's root.
        way = 1.0 if member == "driver" else -1.0
        roll = gear.base_radius * (math.tan(loaded.pair.working_pressure_angle) + way * rows.gear_angle)
        bears = rows.load > 0.0
        radius = np.hypot(gear.base_radius, roll[bears])
        radius = np.clip(radius, known.ordinary.lowest_radius, known.ordinary.highest_radius)
        grown = growing_crack(
            gear, crack, (radius, rows.load[bears] / loaded.engagement.compliance.face_width),
            step=_STEP * gear.module if part.step is None else part.step, steps=part.steps, law=part.law,
            toughness=None if part.toughness is None else part.toughness * 1e6, factors=part.load_factors,
            shares=part.shares,
        )  # fmt: skip
        found.append(
            Path(
                name, gear, order, grown, float(grown.length[-1]), grown.cycles_to_fracture,
                grown.cycles_to_fracture_error, float(rows.k_1.max()), float(rows.k_1.min()),
            )
        )  # fmt: skip
        work.progress((n + 1) / len(asked.cracks))
    return CrackPathData(tuple(found))


def _answer(seen: Seen) -> Iterator[str]:
    for one in cast("CrackPathData", seen.data).paths:
        grown, what = one.found, f"Pair {seen.name}, crack of tooth {one.tooth} of gear {one.gear}"
        if one.closed:
            yield f"{what}: no growth, the loads on its tooth do not open it."
            continue
        reached = "breaks through" if grown.stopped == "surface" else "heads through"
        text = f"{what}: {reached} the {one.through}, {grown.length[0] * 1e3:.3g} to {grown.length[-1] * 1e3:.3g} mm"
        if grown.fracture is not None:
            text += f", fracture at {grown.fracture * 1e3:.3g} mm"
        if one.cycles is not None:
            text += f", {one.cycles:.3g} load cycles" if math.isfinite(one.cycles) else ", stops below the threshold"
        yield f"{text}; stiffness of the tooth decreases by {percent(float(grown.stiffness_loss[-1]))}."


def _drawing(seen: Seen) -> Iterator[DeferredFigure]:
    """Path of every crack in its tooth and rim."""
    for one in cast("CrackPathData", seen.data).paths:
        name = f"crack_path_{seen.name}_{one.gear}_{one.tooth}"
        title = f"Path of the crack of tooth {one.tooth} of gear {one.gear}"
        yield DeferredFigure(name, title, partial(path_figure, name, title, one))


def path_figure(name: str, title: str, one: Path) -> Figure:
    """A tooth, its neighbours and the rim below them, with the path of the crack."""
    gear, path = one.made, one.found.path * 1e3
    m, pitch = gear.module * 1e3, 2.0 * math.pi / gear.teeth
    shape = tooth_outline(gear.tooth) * m
    bore = gear.bore_radius * 1e3
    angle = np.linspace(-1.5 * pitch, 1.5 * pitch, 61)
    circle = bore * np.stack([np.sin(angle), np.cos(angle)])
    begun = one.found.path.shape[1] - one.found.length.size + 1
    teeth = [
        outline(turned(shape, k * pitch), "" if k else "teeth", "outline", width=2.0 if k == 0 else 1.2)
        for k in (-1, 0, 1)
    ]
    low = max(bore, float(path[1].min()) - 2.0 * m, 0.0) - 0.3 * m
    top = float(shape[1].max()) + 0.2 * m
    half = 0.62 * max(top - low, 3.0 * m)
    return Figure(
        name, title,
        f"Gear {one.gear}: path of the crack of tooth {one.tooth} in meshing order, loaded flank on the right, "
        f"in {one.found.length.size - 1} steps by the maximum tangential stress.",
        (
            Panel(
                Axis("x", "mm", limits=(-half, half)), Axis("y", "mm", limits=(low, top)),
                (
                    *teeth,
                    outline(circle, "bore", "grey", 1.5),
                    outline(path[:, begun - 1 :], f"growth to {one.found.length[-1] * 1e3:.4g} mm", "red", 2.2),
                    outline(path[:, :begun], f"crack of the case, {one.found.length[0] * 1e3:.4g} mm", "orange", 3.0),
                ),
                title=f"Through the {one.through}", equal=True, height=1.8,
            ),
        ),
    )  # fmt: skip


_SHEET = Sheet(
    tables=(
        Rows(
            "crack_path_{name}_{one.gear}_{one.tooth}",
            "Growth of the crack of tooth {one.tooth} of gear {one.gear} in {name}",
            (
                Every("path"), Off("k_1", lambda seen: seen.one.found.k_1_error),
                Off("k_2", lambda seen: seen.one.found.k_2_error),
                Off("stiffness", lambda seen: seen.one.found.stiffness_error),
                Off("cycles", lambda seen: seen.one.found.cycles_error),
            ),
            of="found", each="paths", matlab=True,
        ),
    ),
    values=(
        Number("final_length", each="paths", ending="_{one.gear}_{one.tooth}"),
        Number("cycles", "cycles_error", each="paths", ending="_{one.gear}_{one.tooth}"),
        Number("k_1_min", each="paths", ending="_{one.gear}_{one.tooth}"),
    ),
    figures=(
        _drawing,
        Chart(
            "crack_growth_{name}_{one.gear}_{one.tooth}",
            "Growth of the crack of tooth {one.tooth} of gear {one.gear}",
            "Pair {name}: stress intensity factors at the nominal load, loss of stiffness of the tooth and load cycles "
            "over the length of the crack of tooth {one.tooth} of gear {one.gear}.",
            (
                Over(
                    "length",
                    (
                        Line("k_1", "K_I", error="found.k_1_error"),
                        Line("k_2", "K_II", "orange", error="found.k_2_error"),
                    ),
                ),
                Over("length", ("stiffness_loss",)),
            ),
            of="found", each="paths",
        ),
    ),
    answer=Answer(
        _answer, figure=lambda seen: "crack_path_{}_{}_{}".format(seen.name, *_first(seen)),
        rank=lambda seen: -max(float(one.found.stiffness_loss[-1]) for one in seen.data.paths),
        among="the largest of {count} pairs",
    ),
    remarks=(
        Remark(
            neglecting(
                "Pair {name}: growth of the crack of tooth {one.tooth} of gear {one.gear} under the loads on its own "
                "tooth, shared as with the crack of the case; loads on the next teeth are neglected."
            ),
            each="paths",
        ),
        Remark(
            "Pair {name}: loads on the next teeth close the crack of tooth {one.tooth} of gear {one.gear} (K_I down to "
            "{one.ratio} of its maximum); ΔK begins at zero.",
            each="paths", when="pressed",
        ),
    ),
)  # fmt: skip


def _first(seen: Seen) -> tuple[str, int]:
    one = cast("CrackPathData", seen.data).paths[0]
    return one.gear, one.tooth


def _growth(scene: Scene) -> CrackGrowthPart:
    """How cracks are followed; as usual where the case does not say it."""
    return scene.case.crack_growth or CrackGrowthPart()


def _inputs(scene: Scene, name: str) -> GrowthInputs:
    revolution = inputs_of(scene, name)
    cracks = []
    for member, _ in revolution.cracked:
        gear = revolution.gears[MEMBERS.index(member)]
        cracks += [(gear, tooth, crack) for tooth, crack in odd_teeth_in(scene, name, gear).cracks]
    return GrowthInputs(revolution, tuple(cracks), _growth(scene))


def _forecast(scene: Scene, name: str) -> Forecast:
    part = _growth(scene)
    return Forecast({"steps": part.steps}, _SECONDS * part.steps * len(_inputs(scene, name).cracks))


CRACK_PATH = Stage(
    subjects=STRESS_INTENSITY.subjects,
    needs=STRESS_INTENSITY.needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_teeth,
    cites=citing(
        *CRACKS, HERTZ,
        Citation("erdogan-sih", "direction of crack growth by the maximum tangential stress"),
        Citation("paris-erdogan", "growth per load cycle"),
    ),
    forecast=_forecast,
)  # fmt: skip
