"""Stage ``mesh-force-spectrum``: lines of the mesh forces of the linearised train, at a speed and over speeds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, column_of, repeated
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Points, Stems
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.train.gear_train import RPM, gear_train, meshes, needs_one_speed, needs_train, pull_remarks
from fegear.results.train.ripple_spectrum import (
    ripple_points,
    ripple_stems,
    ripple_table,
    ripple_values,
    ripple_waterfall_table,
)

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.dynamics import DynamicsPart
    from fegear.case.reading import Scene
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.spectra import MeshForceSpectrum
    from fegear.dynamics.train.tooth_force import Pull
    from fegear.dynamics.train.torque_response import RippleSpectrum


#: Harmonics of the waterfall at most.
_WATERFALL_LINES = 64
#: Lines weaker than these shares of the strongest are not drawn in spectrum and waterfall.
_WEAKEST, _WEAKEST_OVER_SPEED = 1e-3, 1e-2
#: Whole harmonics that are stronger than this share of the strongest line bear their number.
_NUMBERED = 1e-2
#: Lines are drawn until this share of the mean square is left, within these harmonics of the highest mesh frequency.
_LEFT, _LEAST_HARMONICS, _MOST_HARMONICS = 1e-3, 8, 24
#: Force that is none [N].
_NO_FORCE = 1e-12


@dataclass(frozen=True)
class SpectrumInputs:
    """How the train is run, M of Mark's series where its lines are wanted as well, and the name of the mesh."""

    part: DynamicsPart
    terms: int | None
    name: str


@dataclass(frozen=True)
class SpectrumData:
    """Forces in one mesh at the case's speed, over its speeds (the waterfall) where it gives a range, and its pull.

    `series` has the lines by Mark's series, None where they are not wanted or the series does not apply; `ripple` and
    `ripple_waterfall` are the same of torque ripple; None without it.
    """

    train: GearTrain
    mesh: int
    spectrum: MeshForceSpectrum
    waterfall: MeshForceSpectrum | None
    pull: Pull | None
    ripple: RippleSpectrum | None = None
    ripple_waterfall: RippleSpectrum | None = None
    series: MeshForceSpectrum | None = None


def _compute(asked: SpectrumInputs, upstream: Upstream, _work: Work) -> SpectrumData:
    from fegear.dynamics.train.mark_lines import has_series, series_error
    from fegear.dynamics.train.spectra import mesh_force_spectrum
    from fegear.dynamics.train.tooth_force import largest_pull
    from fegear.dynamics.train.torque_response import ripple_spectrum

    data, part = gear_train(upstream), asked.part
    i, speed, speeds = data.train.mesh_index(asked.name), part.one_speed / data.speed_ratio, part.speed_values
    found = mesh_force_spectrum(data.train, data.errors, [speed], part.harmonics, rotational=True, phases=data.phases)
    waterfall, ripple, rippled = None, None, None
    if data.ripple:
        ripple = ripple_spectrum(data.train, data.ripple, [speed])
    if speeds.size > 1:
        harmonics = min(part.harmonics, _WATERFALL_LINES)
        waterfall = mesh_force_spectrum(data.train, data.errors, speeds / data.speed_ratio, harmonics)
        if data.ripple:
            rippled = ripple_spectrum(data.train, data.ripple, speeds / data.speed_ratio)
    pull = largest_pull(data, i, [speed], part.harmonics)
    series = None
    if asked.terms is not None and all(has_series(mesh.excitation) for mesh in data.meshes):
        errors = [series_error(mesh.excitation, mesh.force, part.harmonics, asked.terms) for mesh in data.meshes]
        series = mesh_force_spectrum(data.train, errors, [speed], part.harmonics, phases=data.phases)
    return SpectrumData(data, i, found, waterfall, pull, ripple, rippled, series)


def _present(made: SpectrumData, asked: SpectrumInputs) -> Outcome:
    name, data, i, found = asked.name, made.train, made.mesh, made.spectrum
    amplitude = found.amplitudes[i, :, :, 0]
    table = Table(
        f"mesh_force_spectrum_{name}",
        (*_lines(found, data), column_of(found, "amplitudes", amplitude[found.present]),
         column_of(found, "power_lines", found.power_lines[i, :, :, 0][found.present])),
        f"Spectrum of the force in mesh {name}",
    )  # fmt: skip
    values = tuple(
        value for j, other in enumerate(data.names) for value in (
            Value(f"{name}.largest_line_from_{other}", float(amplitude[j].max()), "N", None,
                  f"amplitude, harmonic {found.orders[int(amplitude[j].argmax())]:.6g}"),
            Value(f"{name}.rms_from_{other}", math.sqrt(found.power_lines[i, j, :, 0].sum()), "N", None,
                  "root mean square of all spectral lines"),
        )
    )  # fmt: skip
    tables = [table]
    if made.waterfall is not None:
        tables.append(_waterfall_table(name, i, made.waterfall, data))
    if made.ripple is not None:
        values = (*ripple_values(name, i, made.ripple), *values)
        tables.append(ripple_table(name, i, made.ripple))
    if made.ripple_waterfall is not None:
        tables.append(ripple_waterfall_table(name, i, made.ripple_waterfall, data))
    remarks = pull_remarks(made.pull)
    if made.series is not None and asked.terms is not None:
        more, table = _by_series(name, made, made.series, asked.terms)
        values, tables = (*values, *more), [*tables, table]
    elif asked.terms is not None:
        none = "no lines by Mark's series, which includes neither coupled teeth nor spacing errors."
        remarks = (f"Mesh {name}: {none}", *remarks)
    settings: dict[str, object] = {"harmonics": asked.part.harmonics, "speed": asked.part.one_speed}
    return Outcome(made, tuple(tables), values, settings, remarks, _spectrum_figures(made))


def _by_series(name: str, made: SpectrumData, series: MeshForceSpectrum, terms: int) -> tuple[tuple[Value, ...], Table]:
    """The lines by M terms of Mark's series, with products of as many harmonics, beside the exact ones."""
    data, i = made.train, made.mesh
    exact = made.spectrum.power_lines[i, :, made.spectrum.orders % 1.0 == 0.0, 0].T
    power = series.power_lines[i, :, :, 0]
    columns = (
        *_lines(series, data),
        column_of(series, "power_lines", power[series.present], meaning=f"by Mark's series, M = {terms}"),
        Column("power_exact", exact[series.present], "N^2", "by quadrature between all discontinuities"),
    )
    values = tuple(
        Value(f"{name}.rms_by_series_from_{other}", math.sqrt(power[j].sum()), "N", None,
              f"root mean square of all spectral lines by Mark's series, M = {terms}")
        for j, other in enumerate(data.names)
    )  # fmt: skip
    return values, Table(f"mesh_force_series_{name}", columns, f"Lines of the force in mesh {name} by Mark's series")


def _lines(found: MeshForceSpectrum, data: GearTrain) -> tuple[Column, ...]:
    """Number, excitation and frequency of the lines at the first speed; fractions are rotational harmonics."""
    from_pair, line = np.nonzero(found.present)
    order = found.orders[line]
    whole = order.astype(int) if np.all(found.orders % 1.0 == 0.0) else order
    return (
        column_of(found, "orders", whole),
        Column(
            "from_pair",
            np.array(data.names, dtype=str)[from_pair],
            "",
            "mesh whose transmission error excites the line",
        ),
        column_of(found, "frequencies", found.frequencies[from_pair, line, 0]),
    )


def _waterfall_table(name: str, i: int, found: MeshForceSpectrum, data: GearTrain) -> Table:
    speeds = found.speeds.size
    every = np.tile(found.speeds * data.speed_ratio, found.present.sum())
    columns = (
        column_of(found, "speeds", every, meaning=f"speed of {data.speed_of}"),
        *repeated(_lines(found, data)[:2], speeds),
        column_of(found, "frequencies", found.frequencies[found.present].ravel()),
        column_of(found, "amplitudes", found.amplitudes[i][found.present].ravel()),
    )
    return Table(f"mesh_force_waterfall_{name}", columns, f"Spectrum of the force in mesh {name} over speed")


def _spectrum_figures(data: SpectrumData) -> tuple[Figure, ...]:
    train, found = data.train, data.spectrum
    name, amplitudes = train.names[data.mesh], found.amplitudes[data.mesh, :, :, 0]
    strongest = float(amplitudes.max())
    top, left = _highest_shown(found, amplitudes)
    lines = []
    for j, other in enumerate(train.names):
        shown = (amplitudes[j] > max(_WEAKEST * strongest, _NO_FORCE)) & (found.frequencies[j, :, 0] <= top)
        orders, size = found.orders[shown], amplitudes[j, shown]
        whole = (orders % 1.0 == 0.0) & (size > _NUMBERED * strongest)
        lines.append(
            Stems(found.frequencies[j, shown, 0] * 1e-3, size, f"from mesh {other}", f"series:{j}",
                  tuple(f"harmonic {n:.6g}" for n in orders),
                  tuple(f"{n:.0f}" if known else "" for n, known in zip(orders, whole, strict=True)))
        )  # fmt: skip
    if data.ripple is not None:
        lines += ripple_stems(data.mesh, data.ripple, len(train.names))
    above = f" Lines above {top * 1e-3:.4g} kHz hold {left:.2g} of the mean square; the table has them."
    beyond = above if left > 0.0 else ""
    force, rpm = axis_of(found, "amplitudes", log=True), float(found.speeds[0]) * train.speed_ratio * RPM
    spectrum = Figure(
        f"mesh_force_spectrum_{name}",
        f"Spectrum of the force in mesh {name}",
        f"Mesh {name} at {rpm:.6g} rpm of {train.speed_of}: lines by {_exciter(train)}, with harmonic number; lines "
        f"above {_WEAKEST:g} of the maximum.{beyond}",
        (Panel(Axis("frequency", "kHz", zero=True), force, tuple(lines)),),
        under=f"{rpm:.6g} rpm",
    )
    figures = (spectrum, _power_figure(data, rpm))
    over = data.waterfall
    if over is None:
        return figures
    size = over.amplitudes[data.mesh]
    strong = size > max(_WEAKEST_OVER_SPEED * float(size.max()), _NO_FORCE)
    if not strong.any():
        return figures
    speed = np.broadcast_to(over.speeds * train.speed_ratio * RPM, size.shape)[strong]
    points = [Points(
        over.frequencies[strong] * 1e-3, speed, shade=size[strong], shade_label="mesh force amplitude [N]", size=4.5,
        notes=tuple(f"{force:.4g} N" for force in size[strong]),
    )]  # fmt: skip
    if data.ripple_waterfall is not None:
        points += ripple_points(data.mesh, data.ripple_waterfall, train)
    crosses = "" if data.ripple_waterfall is None else " Crosses: lines of torque ripple."
    waterfall = Figure(
        f"mesh_force_waterfall_{name}",
        f"Waterfall of the force in mesh {name}",
        f"Mesh {name}: lines of the mesh force over speed, above 1 % of the maximum.{crosses}",
        (Panel(Axis("frequency", "kHz"), Axis(f"speed of {train.speed_of}", "rpm"), tuple(points)),),
    )
    return *figures, waterfall


def _exciter(train: GearTrain) -> str:
    return "exciting mesh or torque ripple" if train.ripple else "exciting mesh"


def _power_figure(data: SpectrumData, rpm: float) -> Figure:
    """Every mesh harmonic as one-sided power, a panel for each exciting mesh: how the paper draws them."""
    train, found = data.train, data.spectrum
    name, panels = train.names[data.mesh], []
    power = found.power_lines[data.mesh, :, :, 0]
    mean = float(found.static[data.mesh]) ** 2
    order = (data.mesh, *(j for j in range(len(train.names)) if j != data.mesh))
    whole, top = found.orders % 1.0 == 0.0, float(found.frequencies[:, -1, 0].max())
    between = "" if whole.all() else " Rotational harmonics due to pitch deviations are in the table."
    ends = (-0.02e-3 * top, 1.02e-3 * top)  # the mean stands on the ordinate
    for j in order:
        shown = found.present[j] & (power[j] > _NO_FORCE**2) & whole
        kilohertz = found.frequencies[j, shown, 0] * 1e-3
        lines = Stems(kilohertz, power[j, shown], f"from mesh {train.names[j]}", f"series:{j}",
                      tuple(f"harmonic {n:.6g}" for n in found.orders[shown]))  # fmt: skip
        steady = Points([0.0], [mean], "mean force", "ink", "x", notes=("mean force squared",))
        items = (lines, steady) if j == data.mesh else (lines,)
        x = Axis("frequency", "kHz", limits=ends)
        panels.append(Panel(x, axis_of(found, "power_lines", log=True), items, title=f"From mesh {train.names[j]}"))
    return Figure(
        f"mesh_force_power_{name}",
        f"Power of the lines of the force in mesh {name}",
        f"Mesh {name}: one-sided power of every mesh harmonic, by exciting mesh; cross at zero frequency: square of "
        f"the mean force.{between}",
        tuple(panels),
        under=f"{rpm:.6g} rpm",
    )


def _highest_shown(found: MeshForceSpectrum, amplitudes: Array) -> tuple[float, float]:
    """Frequency up to which lines are drawn [Hz], and the share of the mean square that those above it hold."""
    frequencies, power = found.frequencies[:, :, 0], amplitudes**2
    total, pitch = float(power.sum()), float(np.max(frequencies[:, 0] / found.orders[0]))
    order = np.argsort(frequencies, axis=None)
    held = np.cumsum(power.ravel()[order])
    enough = float(frequencies.ravel()[order][min(int(np.searchsorted(held, (1.0 - _LEFT) * total)), held.size - 1)])
    top = min(max(enough, _LEAST_HARMONICS * pitch), _MOST_HARMONICS * pitch)
    return top, float(power[frequencies > top].sum()) / total if total > 0.0 else 0.0


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Harmonics at the one speed, and over all speeds."""
    part, (meshes, bodies) = scene.case.dynamics, forecasts.sizes(scene)
    over = part.speed_values.size * min(part.harmonics, 64)
    seconds = 0.1 + 2e-6 * (over + part.harmonics) * meshes * bodies
    return Forecast({"harmonics": part.harmonics, "speeds": int(part.speed_values.size)}, seconds)


def _inputs(scene: Scene, name: str) -> SpectrumInputs:
    asked = scene.case.transmission_error
    return SpectrumInputs(scene.case.dynamics, asked.terms if asked.method == "mark-series" else None, name)


MESH_FORCE_SPECTRUM = Stage(
    subjects=meshes,
    needs=needs_train,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=needs_one_speed,
    cites=citing(Citation("mark", "spectra of the mesh force", "Eqs. 3.1 to 3.11")),
    forecast=_forecast,
)
