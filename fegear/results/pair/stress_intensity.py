"""Result ``stress-intensity``: K_I and K_II of the cracks of a pair's gears over the mesh, under shared load."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from fegear.base.arrays import Array
from fegear.base.notes import neglecting
from fegear.base.shown import shown
from fegear.case.built.odd_gears import cracked_gears, odd_gears_of
from fegear.contact.plane.crack_in_mesh import CrackInMesh, crack_in_mesh
from fegear.contact.plane.over_revolution import over_revolution
from fegear.engine.citation import citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.fem.alike_teeth import meshing_order
from fegear.geometry.pair import MEMBERS
from fegear.results.forecasts import HERTZ
from fegear.results.gear.odd_gear import CRACKS, needs_odd_solution_in, odd_solution_of
from fegear.results.pair.loaded_teeth import ODD, check_teeth, plane_pairs
from fegear.results.pair.mesh_stiffness_revolution import POSITIONS, RevolutionInputs, inputs_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.engine.sheet.seen import Seen

#: Seconds of a crack.
_SECONDS = 1.5


@dataclass(frozen=True)
class CrackOverMesh:
    """A crack on its way through the mesh, and its extremes."""

    gear: str
    rows: CrackInMesh
    k_1_max: float = shown("MPa.m^(1/2)", "maximum K_I of the crack", name="K_I_max")
    k_2_there: float = shown("MPa.m^(1/2)", "K_II at the maximum of K_I", name="K_II_at_K_I_max")
    k_1_min: float = shown("MPa.m^(1/2)", "minimum K_I of the crack (open faces)", name="K_I_min")

    @property
    def tooth(self) -> int:
        """In meshing order."""
        return self.rows.tooth

    @property
    def errors(self) -> tuple[Array | None, Array | None]:
        """Of K_I and K_II along the rows."""
        return self.rows.k_1_error, self.rows.k_2_error

    def off(self, mode: int, row: int) -> float | None:
        """Estimated error of one mode in one row."""
        error = self.errors[mode]
        return None if error is None else float(error[row])

    @property
    def k_1_max_error(self) -> float | None:
        """Estimated."""
        return self.off(0, self.rows.largest)

    @property
    def k_2_there_error(self) -> float | None:
        """Estimated."""
        return self.off(1, self.rows.largest)

    @property
    def k_1_min_error(self) -> float | None:
        """Estimated."""
        return self.off(0, self.rows.least)

    @property
    def closes(self) -> bool:
        """Whether K_I is negative somewhere by more than a hundredth of its maximum."""
        return self.k_1_min < -0.01 * self.k_1_max


@dataclass(frozen=True)
class StressIntensityData:
    """All cracks of a pair."""

    cracks: tuple[CrackOverMesh, ...]


def _compute(asked: RevolutionInputs, upstream: Upstream, _work: Work) -> StressIntensityData:
    loaded = cast("LoadedPair", upstream[Task(ODD, asked.name)])
    over = over_revolution(loaded.engagement, loaded.nominal, POSITIONS)
    found = []
    for member, teeth in asked.cracked:
        gear = asked.gears[MEMBERS.index(member)]
        known = odd_solution_of(upstream, gear)
        for order in teeth:
            number = meshing_order(order, known.gear.teeth, member)
            rows = crack_in_mesh(loaded.engagement, over, member, known, number)
            high, low = rows.largest, rows.least
            found.append(CrackOverMesh(gear, rows, float(rows.k_1[high]), float(rows.k_2[high]), float(rows.k_1[low])))
    return StressIntensityData(tuple(found))


def _answer(seen: Seen) -> Iterator[str]:
    for one in cast("StressIntensityData", seen.data).cracks:
        off = one.k_1_max_error
        stated = "" if off is None else f" ± {off * 1e-6:.1g}"
        yield (
            f"Pair {seen.name}, crack of tooth {one.tooth} of gear {one.gear}: K_I up to {one.k_1_max * 1e-6:.4g}"
            f"{stated} MPa·√m, with K_II {one.k_2_there * 1e-6:.3g} MPa·√m; minimum K_I {one.k_1_min * 1e-6:.3g} "
            "MPa·√m."
        )


def _figure(seen: Seen) -> str:
    """That of the largest K_I."""
    worst = max(cast("StressIntensityData", seen.data).cracks, key=lambda one: one.k_1_max)
    return f"stress_intensity_{seen.name}_{worst.gear}_{worst.tooth}"


def _rank(seen: Seen) -> float:
    return -max(one.k_1_max for one in cast("StressIntensityData", seen.data).cracks)


_SHEET = Sheet(
    tables=(
        Rows(
            "stress_intensity_{name}_{one.gear}_{one.tooth}",
            "Stress intensity of the crack of tooth {one.tooth} of gear {one.gear} in {name}",
            (
                Every("crack"), Off("k_1", lambda seen: seen.one.errors[0]),
                Off("k_2", lambda seen: seen.one.errors[1]),
            ),
            of="rows", each="cracks", matlab=True,
        ),
    ),
    values=tuple(
        Number(key, f"{key}_error", each="cracks", ending="_{one.gear}_{one.tooth}")
        for key in ("k_1_max", "k_2_there", "k_1_min")
    ),
    figures=(
        Chart(
            "stress_intensity_{name}_{one.gear}_{one.tooth}",
            "Stress intensity of the crack of tooth {one.tooth} of gear {one.gear}",
            "Pair {name}: stress intensity factors of the crack of tooth {one.tooth} of gear {one.gear} over its "
            "rotation under shared load, open crack faces, and load on the cracked tooth.",
            (
                Over(
                    "gear_angle",
                    (
                        Line("k_1", "K_I", error="rows.k_1_error"),
                        Line("k_2", "K_II", "orange", error="rows.k_2_error"),
                    ),
                ),
                Over("gear_angle", ("load",)),
            ),
            of="rows", each="cracks",
        ),
    ),
    answer=Answer(_answer, figure=_figure, rank=_rank, among="the largest of {count} pairs"),
    remarks=(
        Remark(
            neglecting(
                "Pair {name}: the crack of tooth {one.tooth} of gear {one.gear} closes where K_I is negative; open "
                "faces are assumed; in reality the faces close, K_I is zero and K_II smaller."
            ),
            each="cracks", when="closes",
        ),
    ),
)  # fmt: skip


def _cracked(scene: Scene, name: str) -> tuple[str, ...]:
    """Gears of a pair with cracks."""
    cracked = cracked_gears(scene)
    return tuple(gear for gear in odd_gears_of(scene, name) if gear in cracked)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (Task(ODD, name), *needs_odd_solution_in(scene, name, *_cracked(scene, name)))


def _forecast(scene: Scene, name: str) -> Forecast:
    cracks = sum(len(scene.case.gear[gear].odd_tooth) for gear in _cracked(scene, name))
    return Forecast({"positions": POSITIONS}, _SECONDS * cracks)


STRESS_INTENSITY = Stage(
    subjects=lambda scene: tuple(name for name in plane_pairs(scene) if _cracked(scene, name)),
    needs=_needs,
    inputs=inputs_of,
    compute=_compute,
    present=_SHEET.present,
    check=check_teeth,
    cites=citing(*CRACKS, HERTZ),
    forecast=_forecast,
)
