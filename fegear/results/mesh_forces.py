"""Stages ``mesh-force-spectrum`` and ``tooth-force``: forces in the linearised train."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel, Points, Stems
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.errors import InputError
from fegear.models.neglected_effects import percent
from fegear.models.train import train_part
from fegear.results import forecasts
from fegear.results.gear_train import gear_train, needs_train

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.dynamics.spectra import MeshForceSpectrum
    from fegear.dynamics.tooth_force import ToothForce
    from fegear.engine.stage import Done, Progress
    from fegear.models.train import GearTrain

    Array = NDArray[np.float64]

#: Lines that tooth forces are summed from, at least.
_LINES = 256
#: Places over the path at which the static force of every tooth pair is looked at.
_LOOKED_AT = 101
#: How near to the ends of the path the last positions are, in base pitches.
_INSIDE = 1e-9


#: Lines weaker than these shares of the strongest are not drawn in spectrum and waterfall.
_WEAKEST, _WEAKEST_OVER_SPEED = 1e-5, 1e-2
#: Force that is none [N].
_NO_FORCE = 1e-12
_RPM = 30.0 / math.pi


@dataclass(frozen=True)
class SpectrumData:
    """Forces in one mesh at the case's speed, and over its speeds (the waterfall) where it gives a range."""

    train: GearTrain
    mesh: int
    spectrum: MeshForceSpectrum
    waterfall: MeshForceSpectrum | None


@dataclass(frozen=True)
class ToothForceData:
    """Force on one tooth pair through its engagement."""

    train: GearTrain
    mesh: int
    force: ToothForce
    number: int = 0


def meshes(scene: Scene) -> tuple[str, ...]:
    """All meshes of the train, by name."""
    return () if scene.case.train is None else tuple(scene.case.train.mesh)


def own_meshes(scene: Scene) -> tuple[str, ...]:
    """Meshes whose teeth are described by their own pair."""
    return tuple(name for name in meshes(scene) if train_part(scene).mesh[name].like is None)


def needs_one_speed(scene: Scene, _subject: str) -> None:
    """Refuse histories without a speed."""
    if math.isnan(scene.case.dynamics.one_speed):
        raise InputError("dynamics.speed", "(not given)", "is needed for this result", 'write speed = "10000 rpm"')


def needs_speeds(scene: Scene, _subject: str) -> None:
    """Refuse sweeps without speeds."""
    if not scene.case.dynamics.speed_values.size:
        raise InputError(
            "dynamics.speeds", "(not given)", "is needed for this result",
            'write speeds = { start = "2000 rpm", stop = "16000 rpm", count = 57 }',
        )  # fmt: skip


def _run_spectrum(scene: Scene, name: str, done: Done, _progress: Progress) -> Outcome:
    from fegear.dynamics.spectra import mesh_force_spectrum

    data, part = gear_train(done), scene.case.dynamics
    i = data.train.mesh_index(name)
    found = mesh_force_spectrum(
        data.train, data.errors, [part.one_speed / data.speed_ratio], part.harmonics, rotational=True,
        phases=data.phases,
    )  # fmt: skip
    amplitude = found.amplitudes[i, :, :, 0]
    table = Table(
        f"mesh_force_spectrum_{name}",
        (*_lines(found, data), Column("force", amplitude[found.present], "N", "0-peak"),
         Column("power", found.power_lines[i, :, :, 0][found.present], "N^2", "one-sided power of the line")),
        f"Spectrum of the force in mesh {name}",
    )  # fmt: skip
    values = tuple(
        Value(f"{name}.largest_line_from_{other}", float(amplitude[j].max()), "N", None,
              f"0-peak, harmonic {found.orders[int(amplitude[j].argmax())]:.6g}")
        for j, other in enumerate(data.names)
    )  # fmt: skip
    speeds = part.speed_values / data.speed_ratio
    waterfall = None
    tables = [table]
    if speeds.size > 1:
        waterfall = mesh_force_spectrum(data.train, data.errors, speeds, min(part.harmonics, 64))
        tables.append(_waterfall_table(name, i, waterfall, data))
    settings: dict[str, object] = {"harmonics": part.harmonics, "speed": part.one_speed}
    remarks = pull_remarks(data, i, [part.one_speed / data.speed_ratio], part.harmonics)
    made = SpectrumData(data, i, found, waterfall)
    return Outcome(made, tuple(tables), values, settings, remarks, _spectrum_figures(made))


def _lines(found: MeshForceSpectrum, data: GearTrain) -> tuple[Column, ...]:
    """Number, excitation and frequency of the lines at the first speed; fractions are rotational harmonics."""
    from_pair, line = np.nonzero(found.present)
    order = found.orders[line]
    whole = order.astype(int) if np.all(found.orders % 1.0 == 0.0) else order
    return (
        Column("n", whole, "", "harmonic of the mesh frequency of from_pair"),
        Column("from_pair", np.array(data.names, dtype=str)[from_pair], "", "whose transmission error excites it"),
        Column("frequency", found.frequencies[from_pair, line, 0], "Hz", "n times the mesh frequency"),
    )


def _waterfall_table(name: str, i: int, found: MeshForceSpectrum, data: GearTrain) -> Table:
    speeds = found.speeds.size
    columns = (
        Column("speed", np.tile(found.speeds * data.speed_ratio, found.present.sum()), "rpm", f"of {data.speed_of}"),
        *(Column(c.name, np.repeat(c.values, speeds), c.unit, c.meaning) for c in _lines(found, data)[:2]),
        Column("frequency", found.frequencies[found.present].ravel(), "Hz", "n times the mesh frequency"),
        Column("force", found.amplitudes[i][found.present].ravel(), "N", "0-peak"),
    )
    return Table(f"mesh_force_waterfall_{name}", columns, f"Spectrum of the force in mesh {name} over speed")


def summed_harmonics(scene: Scene, data: GearTrain) -> int:
    """Mesh harmonics of a tooth force: 256 lines at least, the rotational ones among them."""
    longest = max(error.pitches for error in data.errors)
    return max(scene.case.dynamics.harmonics, -(-_LINES // longest))


def heaviest_pair(data: GearTrain, i: int) -> int:
    """Number of the tooth pair that carries the largest static force; 0 where all teeth are alike."""
    from fegear.dynamics.mesh_excitation import tooth_pair_at

    error, pair = data.meshes[i].error, data.meshes[i].pair
    if error.pitches == 1:
        return 0
    x = np.linspace(pair.x_start, pair.x_end, _LOOKED_AT)
    largest = []
    for number in range(error.pitches):
        k, m = tooth_pair_at(data.meshes[i].excitation, x, pair.base_pitch, number)
        largest.append(float(np.max(k * (error(x / pair.base_pitch + number) - m))))
    return int(np.argmax(largest))


def positions(data: GearTrain, i: int, count: int, number: int = 0) -> Array:
    """Places of one tooth pair: evenly over its path, and on either side of every jump [m]."""
    pair, found = data.meshes[i].pair, data.meshes[i].excitation
    pitch = pair.base_pitch
    low, high = pair.x_start + _INSIDE * pitch, pair.x_end - _INSIDE * pitch
    functions = (data.meshes[i].error, *found.stiffness)
    cuts = np.concatenate([(f.breaks + j) * f.pitches - number % f.pitches for f in functions for j in range(-4, 5)])
    near = np.unique(cuts[(cuts * pitch > low) & (cuts * pitch < high)])
    beside = np.sort(np.concatenate([near - 1e-7, near + 1e-7])) * pitch
    jumps = _jumps(data, i, beside[(beside > low) & (beside < high)], number)
    return np.unique(np.concatenate([np.linspace(low, high, count), jumps]))


def _jumps(data: GearTrain, i: int, x: Array, number: int) -> Array:
    """Places beside true corners of the transmission error; ends of fitted pieces are none."""
    pitch = data.meshes[i].pair.base_pitch
    slope = data.meshes[i].error.slope(x / pitch + number)
    near = np.abs(np.diff(x)) < 3e-7 * pitch
    kink = near & (np.abs(np.diff(slope)) > 1e-3 * np.max(np.abs(slope), initial=1e-30))
    keep = np.zeros(x.size, dtype=bool)
    keep[:-1] |= kink
    keep[1:] |= kink
    return x[keep]


def force_history(data: GearTrain, i: int, speed: float, count: int, harmonics: int, number: int = 0) -> ToothForce:
    """Force on one tooth pair of mesh `i` at a speed of the reference body [rad/s]."""
    return force_at(data, i, speed, positions(data, i, count, number), harmonics, number)


def force_at(
    data: GearTrain, i: int, speed: float, x: Array, harmonics: int, number: int = 0, other_phases: int = 64
) -> ToothForce:
    """Force on tooth pair `number` at places x [m], others at the case's phases; zero off the path of contact."""
    from fegear.dynamics.mesh_excitation import tooth_pair_at
    from fegear.dynamics.tooth_force import tooth_force

    pitch = data.meshes[i].pair.base_pitch
    k, m = tooth_pair_at(data.meshes[i].excitation, x, pitch, number)
    # linear about the mean load: a tooth pair that its modification holds apart at rest is no spring
    k = np.where(data.meshes[i].error(x / pitch + number) > m, k, 0.0)
    return tooth_force(
        data.train, data.errors, i, speed / data.speed_ratio, x, k, m, pitch, number=number, harmonics=harmonics,
        other_phases=other_phases, phases=data.phases,
    )  # fmt: skip


def mesh_force_range(data: GearTrain, i: int, speed: float, harmonics: int) -> tuple[float, float]:
    """Smallest and largest force of mesh `i` at a speed of the first body [rad/s], others at their worst phase."""
    from fegear.dynamics.spectra import mesh_force_spectrum

    found = mesh_force_spectrum(data.train, data.errors, [speed], harmonics, rotational=True)
    size = 16 * found.orders.size
    spectra = [np.concatenate([[0.0], found.coefficients[i, j, :, 0]]) for j in range(len(data.names))]
    parts = [size * np.fft.irfft(np.pad(row, (0, size // 2 + 1 - row.size)), size) for row in spectra]
    mean = float(data.forces[i])
    return mean + sum(float(p.min()) for p in parts), mean + sum(float(p.max()) for p in parts)


def pull_remarks(data: GearTrain, i: int, speeds: Sequence[float] | Array, harmonics: int) -> tuple[str, ...]:
    """Say how far the linearised force of mesh `i` falls below zero over speeds of the first body [rad/s], if it does.

    The force that pulls is what contact loss would take away; it is as large a share of the mean force as the
    amplitude of the dynamic mesh deflection exceeds the static one by.
    """
    least = [mesh_force_range(data, i, float(speed), harmonics)[0] for speed in speeds]
    mean, worst = float(data.forces[i]), int(np.argmin(least))
    if not mean > 0.0 > least[worst]:
        return ()
    name, speed = data.names[i], float(speeds[worst]) * data.speed_ratio * 30.0 / math.pi
    told = (
        f"Mesh {name}: the linearised mesh force falls to {least[worst]:.4g} N ({percent(-least[worst] / mean)} of the "
        f"mean force, at {speed:.5g} rpm of {data.speed_of}), so teeth part, which this result leaves out; ask for "
        "dynamic-factor and write contact_loss = true under [effects]."
    )
    return (told,)


def _run_force(scene: Scene, name: str, done: Done, _progress: Progress) -> Outcome:
    data, part = gear_train(done), scene.case.dynamics
    i = data.train.mesh_index(name)
    looked_at = heaviest_pair(data, i)
    force = force_history(data, i, part.one_speed, part.positions, summed_harmonics(scene, data), looked_at)
    cross = force.cross.sum(axis=0)
    table = Table(
        f"tooth_force_{name}",
        (
            Column("t", force.time, "s", "from the mesh's phase zero"),
            Column("x", force.x, "mm", "place of the tooth pair on the line of action"),
            Column("force", force.total, "N", "on one tooth pair, without the other meshes' share"),
            Column("force_with_others", force.total + cross, "N", "with the other meshes' share, at the case's phases"),
            Column("static", force.static, "N", "static part"),
            Column("own_increment", force.own, "N", "from this mesh's transmission error"),
            *(
                Column(f"increment_from_{other}", force.cross[j], "N", "from the other mesh, at the case's phases")
                for j, other in enumerate(data.names)
                if j != i
            ),
        ),
        f"Force on one tooth pair of mesh {name}",
    )
    worst = int(np.argmax(force.total))
    values = [
        Value(f"{name}.largest_tooth_force", float(force.total[worst]), "N", None,
              f"without the other meshes, at x = {force.x[worst] * 1e3:.5g} mm"),
        Value(f"{name}.largest_static_tooth_force", float(force.static.max()), "N", None, "quasi-static"),
        *(
            Value(f"{name}.largest_increment_from_{other}", float(force.cross_peak[j]), "N", None,
                  "over the engagement and all relative phases")
            for j, other in enumerate(data.names) if j != i
        ),
    ]  # fmt: skip
    remarks = pull_remarks(data, i, [part.one_speed / data.speed_ratio], part.harmonics)
    uneven = data.meshes[i].error.pitches
    if uneven > 1:
        told = (
            f"Mesh {name}: teeth stand unevenly; of the {uneven} tooth pairs that meet, the force is "
            f"that on number {looked_at}, which carries most at rest (number 0 is at the pitch point at phase zero)."
        )
        remarks = (*remarks, told)
    settings: dict[str, object] = {"harmonics": summed_harmonics(scene, data), "speed": part.one_speed}
    made = ToothForceData(data, i, force, looked_at)
    return Outcome(made, (table,), tuple(values), settings, remarks, (_tooth_force_figure(made),))


def _spectrum_figures(data: SpectrumData) -> tuple[Figure, ...]:
    train, found = data.train, data.spectrum
    name, amplitudes = train.names[data.mesh], found.amplitudes[data.mesh, :, :, 0]
    lines = []
    for j, other in enumerate(train.names):
        shown = amplitudes[j] > max(_WEAKEST * float(amplitudes.max()), _NO_FORCE)
        lines.append(
            Stems(found.frequencies[j, shown, 0] * 1e-3, amplitudes[j, shown], f"from mesh {other}", f"series:{j}",
                  tuple(f"harmonic {n:.6g}" for n in found.orders[shown]))
        )  # fmt: skip
    force, rpm = Axis("mesh force, 0-peak", "N", log=True), float(found.speeds[0]) * train.speed_ratio * _RPM
    spectrum = Figure(
        f"mesh_force_spectrum_{name}",
        f"Spectrum of the force in mesh {name}",
        f"Mesh {name} at {rpm:.6g} rpm of {train.speed_of}: harmonics by the mesh that excites them.",
        (Panel(Axis("frequency", "kHz"), force, tuple(lines)),),
    )
    over = data.waterfall
    if over is None:
        return (spectrum,)
    size = over.amplitudes[data.mesh]
    strong = size > max(_WEAKEST_OVER_SPEED * float(size.max()), _NO_FORCE)
    speed = np.broadcast_to(over.speeds * train.speed_ratio * _RPM, size.shape)[strong]
    points = Points(
        over.frequencies[strong] * 1e-3, speed, shade=size[strong], shade_label="mesh force, 0-peak [N]", size=4.5,
        notes=tuple(f"{force:.4g} N" for force in size[strong]),
    )  # fmt: skip
    waterfall = Figure(
        f"mesh_force_waterfall_{name}",
        f"Waterfall of the force in mesh {name}",
        f"Mesh {name}: lines of the mesh force over speed, down to a hundredth of the strongest.",
        (Panel(Axis("frequency", "kHz"), Axis(f"speed of {train.speed_of}", "rpm"), (points,)),),
    )
    return spectrum, waterfall


def _tooth_force_figure(data: ToothForceData) -> Figure:
    force, names = data.force, data.train.names
    name, x, place = names[data.mesh], force.x * 1e3, Axis("place of the tooth pair on the line of action", "mm")
    top = [Curve(x, force.static, "static", "static"), Curve(x, force.total, "static and own increment", "own force")]
    if len(names) > 1:
        top.append(Curve(x, force.total + force.cross.sum(axis=0), "with the other meshes", "with other meshes"))
    parts = {j: force.own if j == data.mesh else force.cross[j] for j in range(len(names))}
    below = [Curve(x, part, f"from mesh {names[j]}", f"series:{j + 2}") for j, part in parts.items()]
    mean = Mark("y", float(data.train.forces[data.mesh]), "mean mesh force")
    return Figure(
        f"tooth_force_{name}",
        f"Force on one tooth pair of mesh {name}",
        f"Mesh {name}: force on one tooth pair from first to last contact; the level line is the mean mesh force. "
        "Below: what the vibration adds, by the mesh that excites it.",
        (
            Panel(place, Axis("tooth force", "N", zero=True), tuple(top), (mean,), height=1.2),
            Panel(place, Axis("increment", "N"), tuple(below), height=0.8),
        ),
    )


def _spectrum_forecast(scene: Scene, _name: str) -> Forecast:
    """Harmonics at the one speed, and over all speeds."""
    part, (meshes, bodies) = scene.case.dynamics, forecasts.sizes(scene)
    over = part.speed_values.size * min(part.harmonics, 64)
    seconds = 0.1 + 2e-6 * (over + part.harmonics) * meshes * bodies
    return Forecast({"harmonics": part.harmonics, "speeds": int(part.speed_values.size)}, seconds)


def _force_forecast(scene: Scene, _name: str) -> Forecast:
    """At least 256 harmonics at one speed."""
    part = scene.case.dynamics
    harmonics = max(part.harmonics, 256)
    return Forecast({"harmonics": harmonics, "positions": part.positions}, 0.06 * harmonics / 256)


MESH_FORCE_SPECTRUM = Stage(
    name="mesh-force-spectrum",
    title="Mesh force spectra",
    results=("mesh-force-spectrum",),
    subjects=meshes,
    run=_run_spectrum,
    needs=needs_train,
    check=needs_one_speed,
    cites=citing(Citation("mark", "spectra of the mesh force", "Eqs. 3.1 to 3.11")),
    forecast=_spectrum_forecast,
)

TOOTH_FORCE = Stage(
    name="tooth-force",
    title="Force on one tooth pair",
    results=("tooth-force",),
    subjects=own_meshes,
    run=_run_force,
    needs=needs_train,
    check=needs_one_speed,
    cites=citing(Citation("mark", "force on a single tooth pair", "Eqs. 3.23 to 3.29")),
    forecast=_force_forecast,
)
