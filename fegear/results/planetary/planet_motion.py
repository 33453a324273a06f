"""Stage ``planet-motion``: steady motions of a planetary set over speed, in which teeth part and meet again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.shown import declared
from fegear.case.built.planetary import pin_errors, planetary_part, set_inputs
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import columns_of, drawn
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.planetary.planet_set import planetary_sets
from fegear.results.planetary.planet_vibration import check_vibration

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.set_motion import SetSweep
    from fegear.dynamics.planetary.set_response import LinearSet
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


def _inputs(scene: Scene, name: str) -> SetMotionInputs:
    part, run, dynamics = planetary_part(scene, name), set_inputs(scene, name).run, scene.case.dynamics
    speeds = np.zeros(0) if part.speeds is None else np.sort(part.speeds.array)
    per_turn = run.mesh_frequency * 2.0 * math.pi / abs(run.speed[run.input])
    backlash = math.inf if part.backlash == "unlimited" else part.backlash
    return SetMotionInputs(
        speeds, per_turn, pin_errors(part), backlash, dynamics.direction, dynamics.tolerance, part.input, name
    )  # fmt: skip


def _compute(asked: SetMotionInputs, upstream: Upstream, work: Work) -> SetSweep:
    from fegear.dynamics.planetary.set_motion import SetMotion, set_sweep

    linear = cast("LinearSet", upstream[Task("planet-modes", asked.name)])
    frequency = asked.speeds * asked.teeth_per_turn / (2.0 * math.pi)
    run = SetMotion(linear, float(frequency[0]), asked.errors, asked.backlash)
    return set_sweep(run, frequency, asked.tolerance, asked.direction, work.progress)


def _present(data: SetSweep, asked: SetMotionInputs) -> Outcome:
    name, rpm = asked.name, asked.speeds * _RPM
    kinds = np.array([state.kind for state in data.states])
    columns = (
        Column("speed", asked.speeds, "rpm", f"speed of the {asked.driving}"),
        *columns_of(
            data, "mesh_frequency", "sun_factor", "ring_factor", "tooth_factor", "error", "apart_sun", "apart_ring",
            "behind", "periods",
        ),
        Column("motion", kinds, "", "periodic (stable), or type of non-periodic motion"),
    )  # fmt: skip
    top = int(np.argmax(data.tooth_factor))
    error = float(data.error[top])
    values = (
        Value(f"{name}.motion_tooth_factor", float(data.tooth_factor[top]), "", None if math.isnan(error) else error,
              declared(type(data), "tooth_factor").meaning + ", over all speeds"),
        Value(f"{name}.motion_tooth_factor_speed", float(asked.speeds[top]), "rpm", None,
            "speed at which the maximum occurs"),
    )  # fmt: skip
    said = [f"Set {name}: same damping ratio for all modes, also during loss of contact."]
    apart = np.maximum(data.apart_sun, data.apart_ring)
    if apart.any():
        said.append(f"Set {name}: loss of contact at {np.count_nonzero(apart)} of {rpm.size} speeds, longest at "
                    f"{rpm[int(np.argmax(apart))]:.5g} rpm.")  # fmt: skip
    odd = kinds != "periodic"
    if odd.any():
        where = ", ".join(f"{at:.5g} rpm {kind}" for at, kind in zip(rpm[odd], kinds[odd], strict=True))
        said.append(f"Set {name}: non-periodic motion at {np.count_nonzero(odd)} speeds: {where}; factors there are "
                    "the maximum of the evaluated periods.")  # fmt: skip
    table = Table(f"planet_motion_{name}", columns, f"Motion of set {name} over speed")
    settings: dict[str, object] = {"tolerance": asked.tolerance, "direction": asked.direction}
    return Outcome(data, (table,), values, settings, tuple(said), (_figure(name, data, asked),))


def _figure(name: str, data: SetSweep, asked: SetMotionInputs) -> Figure:
    rpm = asked.speeds * _RPM
    x = Axis(f"speed of the {asked.driving}", "rpm")

    def curves(*keys: str) -> tuple[Curve, ...]:
        return tuple(
            Curve(rpm, drawn(data, key), word, f"series:{k}", markers=rpm.size < _FEW)
            for k, (key, word) in enumerate(zip(keys, ("mesh with the sun", "mesh with the ring"), strict=True))
        )

    return Figure(
        f"planet_motion_{name}", f"Motion of set {name} over speed",
        f"Set {name}: maximum mesh force / equal share, and maximum fraction of time without contact.",
        (
            Panel(x, Axis("force / equal share"), curves("sun_factor", "ring_factor")),
            Panel(x, Axis("time fraction without contact", zero=True), curves("apart_sun", "apart_ring")),
        ),
    )  # fmt: skip


#: Fewer speeds are drawn as points.
_FEW = 40


def _forecast(scene: Scene, name: str) -> Forecast:
    part = planetary_part(scene, name)
    speeds = 0 if part.speeds is None else int(part.speeds.array.size)
    return Forecast({"speeds": speeds, "planets": part.count}, _SECONDS * part.count * speeds)


def _check(scene: Scene, name: str) -> None:
    check_vibration(scene, name)
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
    present=_present,
    check=_check,
    cites=citing(
        Citation("lin-parker", "model of the planetary set"),
        Citation("lin-huston-coy", "contact, loss of contact, back-side contact", "Eqs. 19 to 24"),
    ),
    forecast=_forecast,
)
