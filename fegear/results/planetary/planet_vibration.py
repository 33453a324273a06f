"""Stages ``planet-modes`` and ``planet-vibration``: natural modes of a set by kind, and what its meshes excite."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.shown import declared
from fegear.case.built.planetary import body_masses, check_masses, planetary_part, set_inputs
from fegear.case.planetary import MESHES, set_pair
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of, columns_of, error_column
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage, Task
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.pair.loaded_flanks import loaded_flanks
from fegear.results.pair.loaded_teeth import loaded_pair
from fegear.results.planetary.planet_load_sharing import meshed_set, needs_meshed, needs_teeth
from fegear.results.planetary.planet_set import planetary_sets

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.set_modes import SetModes
    from fegear.dynamics.planetary.set_response import ForcedResponse, LinearSet
    from fegear.engine.stage import Upstream, Work

#: Of the largest motion about the axes, and in any case [m]: what moves less across them is drawn as standing still.
#: Where nothing excites the set the motion about the axes is round-off too.
_ROUND_OFF, _NO_MOTION = 1e-9, 1e-15
#: Coordinates of a central body.
_ALONG = ("x", "y", "turn")


@dataclass(frozen=True)
class VibrationInputs:
    """What the vibration of a set depends on besides its teeth.

    Parameters
    ----------
    speeds : ndarray
        Of the driving member [rad/s].
    teeth_per_turn : float
        Mesh cycles per turn of the driving member.
    damping_ratio : float
    driving, name : str
    bodies : tuple of (str, float, float, str)
        Member, mass [kg], inertia [kg m^2] and where they come from.
    """

    speeds: Array
    teeth_per_turn: float
    damping_ratio: float
    driving: str
    name: str
    bodies: tuple[tuple[str, float, float, str], ...] = ()


def _inputs(scene: Scene, name: str) -> VibrationInputs:
    part, run = planetary_part(scene, name), set_inputs(scene, name).run
    speeds = np.zeros(0) if part.speeds is None else part.speeds.array
    per_turn = run.mesh_frequency * 2.0 * math.pi / abs(run.speed[run.input])
    return VibrationInputs(speeds, per_turn, part.damping_ratio, part.input, name, body_masses(scene, name))


def _linear(inputs: VibrationInputs, upstream: Upstream, _work: Work) -> LinearSet:
    from fegear.dynamics.planetary.set_response import SHOWN_HARMONICS, linear_set

    meshed = meshed_set(upstream, inputs.name)
    sun, ring = (
        _exactness(upstream, set_pair(inputs.name, mesh), meshed.mean_force, SHOWN_HARMONICS) for mesh in MESHES
    )
    return linear_set(meshed, inputs.damping_ratio, exactness=(sun, ring))


def _exactness(upstream: Upstream, name: str, load: float, harmonics: int) -> tuple[float, Array]:
    """Errors of a mesh's mean stiffness and of the amplitudes of its transmission error, as shares of them."""
    from fegear.contact.plane.base_pitch import mean_secant_stiffness
    from fegear.contact.plane.shifted_loads import transmission_error_shift
    from fegear.contact.plane.transmission_error import transmission_error

    none = 0.0, np.zeros(harmonics)
    if Task("loaded-flanks", name) in upstream:
        flanks = loaded_flanks(upstream, name)
        over = flanks.transmission_error(lambda _done: None)
        if over.shift is None or not flanks.estimated:
            return none
        return over.shift.stiffness / over.mesh_stiffness_mean, _shares(
            over.shift.amplitude, over.series[over.at].amplitude, harmonics
        )
    if Task("loaded-pair", name) not in upstream:
        return none
    pair = loaded_pair(upstream, name)
    te = transmission_error(pair.engagement, load, harmonics)
    shift = transmission_error_shift(te, pair.shifted)
    if shift is None:
        return none
    return shift.stiffness / mean_secant_stiffness(te), _shares(shift.amplitude, te.series.amplitude, harmonics)


def _shares(error: Array, amplitude: Array, harmonics: int) -> Array:
    """Errors of amplitudes as shares of them, one at most, and one where roll positions do not show the harmonic."""
    share = np.divide(error, amplitude, out=np.zeros_like(amplitude), where=amplitude > 0.0)[:harmonics]
    return np.pad(np.minimum(share, 1.0), (0, harmonics - share.size), constant_values=1.0)


def _present_modes(linear: LinearSet, inputs: VibrationInputs) -> Outcome:
    data, name = linear.modes, inputs.name
    number = np.arange(data.frequency.size)
    columns = (
        Column("mode", number, "", "mode number, increasing frequency"),
        *columns_of(data, "frequency"),
        *columns_of(linear, "frequency_error"),
        Column("kind", np.array(data.kind), "", declared(type(data), "kind").meaning),
        Column("speed", data.frequency / inputs.teeth_per_turn * 2.0 * math.pi, "rpm",
               f"speed of the {inputs.driving} at which the mesh frequency coincides"),
        *columns_of(data, "turning", "moving", "sun_mesh", "ring_mesh"),
    )  # fmt: skip
    values = tuple(
        Value(f"{name}.natural_frequency_{k}", float(data.frequency[k]), "Hz", float(linear.frequency_error[k]),
              f"undamped natural frequency, {data.kind[k]}")
        for k in number if data.frequency[k] > 0.0
    ) + tuple(
        Value(f"{name}.{member}.{what}", number, unit, None, f"{meaning}, {source}")
        for member, mass, inertia, source in inputs.bodies
        for what, number, unit, meaning in (
            ("mass", mass, "kg", "mass"), ("inertia", inertia, "kg.m^2", "moment of inertia about its axis"),
        )
    )  # fmt: skip
    counted = ", ".join(f"{count} of type {kind}" for kind, count in Counter(data.kind).items())
    table = Table(f"planet_modes_{name}", columns, f"Natural modes of set {name}", printed=True)
    said = f"Set {name}: {counted}; gyroscopic forces of the carrier's rotation are neglected."
    return Outcome(linear, (table,), values, {}, (said,), (_modes_figure(name, data),))


def _modes_figure(name: str, data: SetModes) -> Figure:
    moving = data.frequency > 0.0
    other = np.append(True, np.diff(data.frequency) > 1e-8 * data.frequency[-1])  # pairs of one frequency stand once
    own = np.flatnonzero(moving & other)
    words = tuple(f"{data.frequency[k] * 1e-3:.3g}\n{data.kind[k][0].upper()}" for k in own)
    parts = {"sun meshes": data.sun_mesh, "ring meshes": data.ring_mesh}
    parts["pins and bearings"] = 1.0 - data.sun_mesh - data.ring_mesh
    bars = tuple(
        Bars(np.arange(own.size), one[own], word, f"series:{k}") for k, (word, one) in enumerate(parts.items())
    )
    return Figure(
        f"planet_modes_{name}", f"Natural modes of set {name}",
        f"Set {name}: strain energy distribution of the modes. R: rotational, T: translational (double), P: planet, "
        "M: mixed mode.",
        (Panel(
            Axis("natural frequency [kHz] and type", categories=words),
            Axis("strain energy share", limits=(0.0, 1.0)), bars, stacked=True,
        ),),
    )  # fmt: skip


PLANET_MODES = Stage(
    subjects=planetary_sets,
    needs=lambda scene, name: (*needs_meshed(scene, name), *needs_teeth(scene, name)),
    inputs=_inputs,
    compute=_linear,
    present=_present_modes,
    check=check_masses,
    cites=citing(Citation("lin-parker", "model of the planetary set and mode types")),
    forecast=lambda _scene, _name: forecasts.constant(0.3),
)


def check_vibration(scene: Scene, name: str) -> None:
    """Refuse vibration without masses or speeds."""
    check_masses(scene, name)
    if planetary_part(scene, name).speeds is None:
        raise InputError(
            f"planetary.{name}.speeds", "(not given)", "is required for this result",
            'set speeds = { start = "200 rpm", stop = "6000 rpm", count = 200 }',
        )  # fmt: skip


def _vibration(inputs: VibrationInputs, upstream: Upstream, _work: Work) -> ForcedResponse:
    from fegear.dynamics.planetary.set_response import forced_response

    linear = cast("LinearSet", upstream[Task("planet-modes", inputs.name)])
    frequency = inputs.speeds * inputs.teeth_per_turn / (2.0 * math.pi)
    return forced_response(linear, frequency)


def _present_vibration(data: ForcedResponse, inputs: VibrationInputs) -> Outcome:
    name = inputs.name
    speed = Column("speed", inputs.speeds, "rpm", f"speed of the {inputs.driving}")
    columns = [speed, *columns_of(data, "mesh_frequency")]
    for key in ("sun_force", "ring_force", "least_share"):
        column = column_of(data, key)
        columns += [column, error_column(column, data.shift(lambda one, key=key: getattr(one, key)))]  # type: ignore[misc]
    for member in CENTRALS:
        for axis, word in enumerate(_ALONG):
            said = "amplitude: root of the sum of squares of its harmonics" + (
                "; at the base circle or the pins" if axis == 2 else "")  # fmt: skip
            column = Column(f"{member}_{word}", data.amplitude(member, axis), "um", said)
            off = data.shift(lambda one, member=member, axis=axis: one.amplitude(member, axis))  # type: ignore[misc]
            columns += [column, error_column(column, off)]
    top = int(np.argmax(data.largest_force))
    off = data.shift(lambda one: one.largest_force)
    values = (
        Value(f"{name}.dynamic_force", float(data.largest_force[top]), "N", float(off[top]),
              "maximum dynamic mesh force over all speeds"),
        Value(f"{name}.dynamic_force_speed", float(inputs.speeds[top]), "rpm", None,
            "speed at which the maximum occurs"),
    )  # fmt: skip
    remarks = [f"Set {name}: linearised at the mean load, damping ratio of all modes {inputs.damping_ratio:.3g}."]
    low = int(np.argmin(data.least_share))
    if data.least_share[low] < 0.0:
        remarks.append(
            f"Set {name}: linear mesh force falls to {data.least_share[low]:.3g} of its mean at "
            f"{inputs.speeds[low] * 30.0 / math.pi:.5g} rpm (loss of contact, not modelled here); use planet-motion."
        )
    table = Table(f"planet_vibration_{name}", tuple(columns), f"Vibration of set {name} over speed")
    return Outcome(
        data,
        (table,),
        values,
        {},
        tuple(remarks),
        (_figure(name, data, inputs),),
        "reduce accuracy.tolerance",
    )


def _figure(name: str, data: ForcedResponse, inputs: VibrationInputs) -> Figure:
    rpm = inputs.speeds * 30.0 / math.pi
    x = Axis(f"speed of the {inputs.driving}", "rpm")
    forces = tuple(
        Curve(rpm, force, f"{one} mesh", role, markers=False)
        for force, one, role in ((data.sun_force, "sun", "series:0"), (data.ring_force, "ring", "series:1"))
    )
    across = [np.hypot(data.amplitude(member, 0), data.amplitude(member, 1)) for member in CENTRALS]
    around = max(float(data.amplitude(member, 2).max()) for member in CENTRALS)
    still = max(_ROUND_OFF * around, _NO_MOTION)
    moves = tuple(
        Curve(rpm, np.where(size < still, 0.0, size) * 1e6, member, f"series:{k}", markers=False)
        for k, (member, size) in enumerate(zip(CENTRALS, across, strict=True))
    )
    return Figure(
        f"planet_vibration_{name}", f"Vibration of set {name} over speed",
        f"Set {name}: maximum dynamic mesh force above the mean of {data.mean_force:.5g} N, and radial motion "
        "amplitude of sun, ring and carrier, excited by the transmission errors of the meshes with their phases.",
        (
            Panel(x, Axis("dynamic mesh force", "N", zero=True), forces),
            Panel(x, Axis("radial motion", "um", zero=True), moves),
        ),
    )  # fmt: skip


PLANET_VIBRATION = Stage(
    subjects=planetary_sets,
    needs=lambda _scene, name: (Task("planet-modes", name),),
    inputs=_inputs,
    compute=_vibration,
    present=_present_vibration,
    check=check_vibration,
    cites=citing(
        Citation("lin-parker", "model of the planetary set"),
        Citation("mark", "linear train with transmission errors", "2.9b"),
    ),
    forecast=lambda _scene, _name: forecasts.constant(3.0),
)
