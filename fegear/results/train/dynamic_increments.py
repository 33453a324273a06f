"""Result ``dynamic-increments``: what the motion of the train adds to the transmission error of its meshes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Complex
from fegear.case.reading import Scene
from fegear.dynamics.train.gear_train import GearTrain
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.train.gear_train import gear_train, needs_train, the_train

if TYPE_CHECKING:
    from fegear.dynamics.train.four_square import FourSquare
    from fegear.dynamics.train.peaks import IncrementPeak

#: Most meshes of a train whose pairs each have a figure and asymptotes of their own.
_MOST_MESHES = 3
#: How far beyond an increment the ordinate of its parts goes.
_ROOM = 1.15


@dataclass(frozen=True)
class FrequencyInputs:
    """Frequencies of the static transmission error [Hz], and whether Mark's determinants are wanted."""

    frequencies: NDArray[np.float64]
    determinants: bool = False


@dataclass(frozen=True)
class IncrementsData:
    """Q_ij over frequency, shape (meshes, meshes, F), with what each tends to; None for trains of many meshes."""

    train: GearTrain
    frequencies: NDArray[np.float64]
    increments: Complex
    low: Complex | None
    high: Complex | None
    peaks: tuple[IncrementPeak, ...] = ()
    rig: FourSquare | None = None


def _compute(asked: FrequencyInputs, upstream: Upstream, _work: Work) -> IncrementsData:
    from fegear.dynamics.train.increments import dynamic_increments, high_frequency_increments, low_frequency_increments
    from fegear.dynamics.train.peaks import increment_peaks

    data, omega = gear_train(upstream), 2.0 * math.pi * asked.frequencies
    found = dynamic_increments(data.train, omega)
    low = high = None
    peaks: tuple[IncrementPeak, ...] = ()
    if len(data.names) <= _MOST_MESHES:
        low, high = low_frequency_increments(data.train, omega), high_frequency_increments(data.train, omega)
        peaks = increment_peaks(data.train, omega, found)
    rig = None
    if asked.determinants:
        from fegear.dynamics.train.four_square import FourSquare

        rig = FourSquare.of(data.train)
    return IncrementsData(data, asked.frequencies, found, low, high, peaks, rig)


def _present(known: IncrementsData, _asked: FrequencyInputs) -> Outcome:
    names, frequencies, found = known.train.names, known.frequencies, known.increments
    frequency = Column("frequency", frequencies, "Hz", "frequency of the static transmission error")
    columns, values = [frequency], []
    for i, first in enumerate(names):
        for j, second in enumerate(names):
            q, name = found[i, j], f"Q_{first}_{second}"
            meaning = f"dynamic increment of mesh {first} per static transmission error of mesh {second}"
            columns += _parts(name, q, meaning)
            at = int(np.argmax(np.abs(q)))
            where = f"modulus, at {frequencies[at]:.6g} Hz"
            values.append(Value(f"{name}_largest", float(abs(q[at])), "", None, where))
    tables = [Table("dynamic_increments", tuple(columns), "Dynamic increment functions")]
    figures = [_overview(known)]
    if known.low is not None and known.high is not None:
        tables.append(_asymptotes(frequency, names, found, known.low, known.high))
        figures += [
            _figure(known, i, j, known.low[i, j], known.high[i, j])
            for i in range(len(names))
            for j in range(len(names))
        ]
    if known.peaks:
        tables.append(_peaks(names, known.peaks))
    if known.rig is not None:
        table, more = _determinants(frequency, names, known, known.rig)
        tables.append(table)
        values += more
    return Outcome(known, tuple(tables), tuple(values), figures=tuple(figures))


def _peaks(names: tuple[str, ...], peaks: tuple[IncrementPeak, ...]) -> Table:
    """Resonances as the increments show them: with damping these lie off the undamped modes."""
    return Table(
        "dynamic_increments_peaks",
        (
            Column("increment", np.array([f"Q_{names[p.mesh]}_{names[p.source]}" for p in peaks]), "", "which"),
            Column("resonance", np.array([p.frequency for p in peaks]), "Hz", "frequency of the maximum modulus"),
            Column("modulus", np.array([p.modulus for p in peaks]), "", "there"),
        ),
        "Peaks of the dynamic increments",
    )


def _determinants(
    frequency: Column, names: tuple[str, ...], known: IncrementsData, rig: FourSquare
) -> tuple[Table, list[Value]]:
    """Mark's determinants, the increments that they give, and how far these are from the elimination's."""
    from fegear.dynamics.train.four_square import relative_difference

    omega, found = 2.0 * math.pi * known.frequencies, known.increments
    d, (own, cross) = rig.determinant(omega), rig.numerators(omega)
    (printed, by_cross), ratio = rig.as_printed(omega), rig.own_by_ratio(omega)
    i, j = f"{names[0]}_{names[0]}", f"{names[0]}_{names[1]}"
    off = {
        "D": relative_difference(d, rig.determinant_of_elements(omega)),
        f"printed_{i}": relative_difference(printed, found[0, 0]),
        i: relative_difference(ratio, found[0, 0]),
        j: relative_difference(by_cross, found[0, 1]),
    }
    said = {
        f"printed_{i}": "relative deviation of (2.58) as printed from the elimination",
        i: "relative deviation of the ratio of determinants from the elimination", j:
            "relative deviation of (2.59) from the elimination",
    }  # fmt: skip
    columns = [
        frequency,
        *_parts("D", d, "determinant by its polynomial (2.57) [(N m)^3]"),
        Column("difference_D", off["D"], "", "relative deviation of (2.57) from the elements (2.46c)"),
        *_parts(f"N_{i}", own, "N_1,I + N_2,I (2.55) [N (N m)^2]"),
        *_parts(f"N_{j}", cross, "N_1,II + N_2,II (2.56) [N (N m)^2]"),
        *_parts(f"Q_{i}_printed", printed, "R N/D - 1 as printed (2.58)"),
        *_parts(f"Q_{i}_ratio", ratio, "as -D(mesh removed)/D (no cancellation)"),
        *_parts(f"Q_{j}_printed", by_cross, "R N/D (2.59)"),
        *_parts(f"Q_{i}", found[0, 0], "by elimination"),
        *_parts(f"Q_{j}", found[0, 1], "by elimination"),
        *(Column(f"difference_{key}", off[key], "", words) for key, words in said.items()),
    ]
    values = [
        Value(f"determinants_difference_{key}", float(off[key].max()), "", None,
              f"maximum over the frequencies, {words}, at {known.frequencies[int(np.argmax(off[key]))]:.6g} Hz")
        for key, words in said.items()
    ]  # fmt: skip
    return Table("dynamic_increments_determinants", tuple(columns), "Determinants of the four-square rig"), values


def _parts(name: str, q: Complex, meaning: str) -> list[Column]:
    return [Column(f"{name}_re", q.real, "", meaning), Column(f"{name}_im", q.imag, "", meaning)]


def _asymptotes(frequency: Column, names: tuple[str, ...], found: Complex, low: Complex, high: Complex) -> Table:
    """Modulus and both asymptotes for every pair of meshes; two that share no body have none at high frequency."""
    columns = [frequency]
    for i, first in enumerate(names):
        for j, second in enumerate(names):
            columns.append(
                Column(f"modulus_{first}_{second}", np.abs(found[i, j]), "", "modulus of the dynamic increment")
            )
            columns += _parts(f"low_{first}_{second}", low[i, j], "first power of the frequency (Mark 2.62, 2.65)")
            if np.any(high[i, j]):
                columns += _parts(f"high_{first}_{second}", high[i, j], "bodies turn as free inertias (2.64, 2.66)")
    return Table("dynamic_increments_asymptotes", tuple(columns), "Moduli of the dynamic increments and asymptotes")


def _overview(data: IncrementsData) -> Figure:
    names = data.train.names
    panels = tuple(
        Panel(
            Axis("frequency", "Hz", log=True), Axis(f"|Q| of mesh {first}", log=True),
            tuple(
                Curve(data.frequencies, np.abs(data.increments[i, j]), f"error of mesh {second}", f"series:{j}")
                for j, second in enumerate(names)
            ),
        )
        for i, first in enumerate(names)
    )  # fmt: skip
    return Figure(
        "dynamic_increments", "Dynamic increment functions",
        "Dynamic increment functions: difference between the force of one mesh (divided by its stiffness) and its "
        "quasi-static value, for a static transmission error of the same or another mesh.",
        panels,
    )  # fmt: skip


def _figure(data: IncrementsData, i: int, j: int, low: Complex, high: Complex) -> Figure:
    """Modulus, real and imaginary part of one increment with its asymptotes."""
    f, q = data.frequencies, data.increments[i, j]
    first, second = data.train.names[i], data.train.names[j]
    drawn = [("increment", q, "blue", ""), ("low-frequency asymptote", low, "orange", "dash")]
    if np.any(high):
        drawn.append(("high-frequency asymptote", high, "green", "dashdot"))

    def curves(part: str) -> tuple[Curve, ...]:
        shown: dict[str, Callable[[Complex], Array]] = {"|Q|": np.abs, "Re Q": np.real, "Im Q": np.imag}
        rows = [(word, shown[part](z), role, dash) for word, z, role, dash in drawn]
        return tuple(
            Curve(f, y, word, role, dash=dash, markers=False, width=2.0 if word == "increment" else 1.3)
            for word, y, role, dash in rows
        )  # fmt: skip

    top = _ROOM * float(np.abs(q).max()) or 1.0
    x, least = Axis("frequency", "Hz", log=True), float(np.abs(q[np.abs(q) > 0.0]).min(initial=top))
    panels = [Panel(x, Axis("|Q|", log=True, limits=(0.5 * least, 2.0 * top)), curves("|Q|"))]
    panels += [Panel(x, Axis(part, limits=(-top, top)), curves(part)) for part in ("Re Q", "Im Q")]
    whose = "of the same mesh" if i == j else f"that of mesh {second}"
    return Figure(
        f"dynamic_increment_{first}_{second}", f"Dynamic increment of mesh {first} by the error of mesh {second}",
        f"Mesh {first}: complex amplitude that the motion of the train adds to its transmission error, per unit "
        f"static transmission error, {whose}; exp(+i w t). Asymptotes: rigid-body motion at low frequency, free "
        "inertias at high frequency.",
        tuple(panels),
    )  # fmt: skip


def _inputs(scene: Scene, _subject: str) -> FrequencyInputs:
    part = scene.case.dynamics
    return FrequencyInputs(part.frequencies.array, part.determinants)


def _check(scene: Scene, _subject: str) -> None:
    """Refuse determinants of a train that is not Mark's rig."""
    if scene.case.dynamics.determinants:
        from fegear.case.built.train import build_train, train_inputs
        from fegear.dynamics.train.four_square import FourSquare

        FourSquare.of(build_train(train_inputs(scene)))


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """One small solution for each frequency and pair of meshes."""
    count, (meshes, bodies) = scene.case.dynamics.frequencies.count, forecasts.sizes(scene)
    return Forecast({"frequencies": count}, 0.005 + 1.3e-6 * count * meshes**2 * bodies)


DYNAMIC_INCREMENTS = Stage(
    subjects=the_train,
    needs=needs_train,
    inputs=_inputs,
    check=_check,
    compute=_compute,
    present=_present,
    cites=citing(Citation("mark", "transmission-error dynamic increment functions", "Eqs. 2.57 to 2.66")),
    forecast=_forecast,
)
