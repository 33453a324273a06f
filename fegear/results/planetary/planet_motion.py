"""Stage ``planet-motion``: steady motions of a planetary set over speed, in which teeth part and meet again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.case.built.planetary import check_masses, pin_errors, planetary_part, set_inputs
from fegear.case.planetary import MESHES
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task
from fegear.results.planetary.planet_set import planetary_sets
from fegear.results.planetary.planet_vibration import check_vibration

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.set_motion import SetSweep
    from fegear.dynamics.planetary.set_response import LinearSet
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: Seconds of one steady motion and planet.
_SECONDS = 0.5
_RPM = 30.0 / math.pi


@dataclass(frozen=True)
class SetMotionInputs:
    """What the motions of a set depend on besides its teeth and bodies.

    Parameters
    ----------
    speeds : ndarray
        Of the driving member [rad/s].
    teeth_per_turn : float
        Mesh cycles per turn of the driving member.
    errors : ndarray, shape (2, planets)
        Of the pins, radial and counter-clockwise [m].
    backlash : float
        Of every mesh along the line of action [m].
    direction : str
        In which the speeds are swept.
    tolerance : float
        Of the largest forces, over the mean force.
    driving, name : str
    """

    speeds: Array
    teeth_per_turn: float
    errors: Array
    backlash: float
    direction: Literal["up", "down", "static", "rest"]
    tolerance: float
    driving: str
    name: str


def unlimited(backlash: float | Literal["unlimited"]) -> float:
    """Backlash of a set [m], infinite where back flanks never touch."""
    return math.inf if backlash == "unlimited" else backlash


def _inputs(scene: Scene, name: str) -> SetMotionInputs:
    part, run, dynamics = planetary_part(scene, name), set_inputs(scene, name).run, scene.case.dynamics
    speeds = np.zeros(0) if part.speeds is None else np.sort(part.speeds.array)
    per_turn = run.mesh_frequency * 2.0 * math.pi / abs(run.speed[run.input])
    return SetMotionInputs(
        speeds, per_turn, pin_errors(part), unlimited(part.backlash), dynamics.direction, dynamics.tolerance,
        part.input, name,
    )  # fmt: skip


def _compute(asked: SetMotionInputs, upstream: Upstream, work: Work) -> SetSweep:
    from fegear.dynamics.planetary.set_motion import SetMotion, set_sweep

    linear = cast("LinearSet", upstream[Task("planet-modes", asked.name)])
    frequency = asked.speeds * asked.teeth_per_turn / (2.0 * math.pi)
    run = SetMotion(linear, float(frequency[0]), asked.errors, asked.backlash)
    return set_sweep(run, frequency, asked.tolerance, asked.direction, work.progress)


@dataclass(frozen=True)
class ShownMotion:
    """Motions of a set over the speeds of its driving member, shape (N,)."""

    found: SetSweep
    speed: Array = shown("rpm", "speed of the driving member")

    @property
    @shows("", "periodic (stable), or type of non-periodic motion")
    def motion(self) -> NDArray[np.str_]:
        """In one word."""
        return np.array([state.kind for state in self.found.states])

    @property
    def top(self) -> int:
        """Where a tooth force is largest."""
        return int(np.argmax(self.found.tooth_factor))

    @property
    def apart(self) -> Array:
        """Longest time without contact of any mesh, as a fraction."""
        return np.maximum(self.found.apart_sun, self.found.apart_ring)


def _known_error(seen: Seen) -> float | None:
    error = float(seen.data.found.error[seen.data.top])
    return None if math.isnan(error) else error


def _apart(seen: Seen) -> str:
    apart, rpm = seen.data.apart, seen.data.speed * _RPM
    return (
        f"Set {seen.name}: loss of contact at {np.count_nonzero(apart)} of {rpm.size} speeds, longest at "
        f"{rpm[int(np.argmax(apart))]:.5g} rpm."
    )


def _odd(seen: Seen) -> str:
    odd, kinds = seen.data.motion != "periodic", seen.data.motion
    where = ", ".join(f"{at:.5g} rpm {kind}" for at, kind in zip(seen.data.speed[odd] * _RPM, kinds[odd], strict=True))
    return (
        f"Set {seen.name}: non-periodic motion at {np.count_nonzero(odd)} speeds: {where}; factors there are the "
        "maximum of the evaluated periods."
    )


def _over_speed(quantity: str, y: Axis) -> Over:
    """A curve of either mesh; few speeds are marked."""

    def look(seen: Seen) -> dict[str, bool]:
        return {"markers": seen.data.speed.size < _FEW}

    lines = tuple(
        Line(f"found.{quantity.format(mesh=mesh)}", f"mesh with the {mesh}", f"series:{k}", x="speed", look=look)
        for k, mesh in enumerate(MESHES)
    )
    return Over(lambda seen: Axis(f"speed of the {seen.asked.driving}", "rpm"), lines, y)


#: Fewer speeds are drawn as points.
_FEW = 40
_SHEET = Sheet(
    of=lambda data, asked: ShownMotion(data, asked.speeds),
    tables=(
        Rows(
            "planet_motion_{name}", "Motion of set {name} over speed",
            (
                Cell("speed", meaning="speed of the {asked.driving}"),
                *(
                    f"found.{one}" for one in (
                        "mesh_frequency", "sun_factor", "ring_factor", "tooth_factor", "error", "apart_sun",
                        "apart_ring", "behind", "periods",
                    )
                ),
                "motion",
            ),
        ),
    ),
    values=(
        Number(
            "found.tooth_factor", _known_error, si=lambda seen: seen.data.found.tooth_factor[seen.data.top],
            name="motion_tooth_factor", further=", over all speeds",
        ),
        Number(
            "speed", si=lambda seen: seen.data.speed[seen.data.top], name="motion_tooth_factor_speed",
            meaning="speed at which the maximum occurs",
        ),
    ),
    figures=(
        Chart(
            "planet_motion_{name}", "Motion of set {name} over speed",
            "Set {name}: maximum mesh force / equal share, and maximum fraction of time without contact.",
            (
                _over_speed("{mesh}_factor", Axis("force / equal share")),
                _over_speed("apart_{mesh}", Axis("time fraction without contact", zero=True)),
            ),
        ),
    ),
    remarks=(
        Remark("Set {name}: same damping ratio for all modes, also during loss of contact."),
        Remark(_apart, when=lambda seen: seen.data.apart.any()),
        Remark(_odd, when=lambda seen: (seen.data.motion != "periodic").any()),
    ),
    settings={"tolerance": lambda seen: seen.asked.tolerance, "direction": lambda seen: seen.asked.direction},
)  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    part = planetary_part(scene, name)
    speeds = 0 if part.speeds is None else int(part.speeds.array.size)
    return Forecast({"speeds": speeds, "planets": part.count}, _SECONDS * part.count * speeds)


def _check(scene: Scene, name: str) -> None:
    check_vibration(scene, name)
    check_moving(scene, name)


def check_moving(scene: Scene, name: str) -> None:
    """Refuse sets that the integration of a motion does not take."""
    check_masses(scene, name)
    part = planetary_part(scene, name)
    if part.backlash != "unlimited" and scene.gears[part.planet].asymmetric:
        raise InputError(
            f"planetary.{name}.backlash", f"{part.backlash * 1e3:.6g} mm",
            "must be unlimited for asymmetric teeth (back-side contact is not available)", 'set backlash = "unlimited"',
        )  # fmt: skip
    if scene.case.dynamics.method != "shooting":
        raise InputError(
            "dynamics.method", scene.case.dynamics.method, "applies to gear trains, not to planetary gear sets",
            'set dynamics.method = "shooting"',
        )  # fmt: skip


PLANET_MOTION = Stage(
    subjects=planetary_sets,
    needs=lambda _scene, name: (Task("planet-modes", name),),
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(
        Citation("lin-parker", "model of the planetary set"),
        Citation("lin-huston-coy", "contact, loss of contact, back-side contact", "Eqs. 19 to 24"),
    ),
    forecast=_forecast,
)
