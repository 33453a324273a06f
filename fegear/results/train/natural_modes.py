"""Stage ``natural-modes``: natural frequencies of the train and where harmonics of its meshes meet them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.case.dynamics import DynamicsPart
from fegear.dynamics.train.gear_train import GearTrain
from fegear.dynamics.train.modes import Campbell, Modes, ripple_critical
from fegear.engine.colours import DASHES
from fegear.engine.declared import column_of, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve, Mark, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Reads, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.results import forecasts
from fegear.results.train.gear_train import TRAIN_SOURCES, gear_train, needs_train, the_train

_RPM = 30.0 / math.pi
#: A share of energy below this is none.
_ROUND_OFF = 1e-6
#: Share of the height of a Campbell diagram that the word of a mode takes.
_ROOM_OF_MODES = 0.05


@dataclass(frozen=True)
class ModesData:
    """Modes, and the Campbell diagram where the case gives speeds (in rad/s of the first body)."""

    train: GearTrain
    modes: Modes
    campbell: Campbell | None


def _modes(asked: Reads[DynamicsPart], upstream: Upstream, _work: Work) -> ModesData:
    from fegear.dynamics.train.modes import campbell, modes

    data = gear_train(upstream)
    speeds = asked.part.speed_values / data.speed_ratio
    return ModesData(data, modes(data.train), campbell(data.train, speeds, asked.part.lines) if speeds.size else None)


def _present_modes(known: ModesData, asked: Reads[DynamicsPart]) -> Outcome:
    data, found, diagram = known.train, known.modes, known.campbell
    train = data.train
    count = np.arange(found.frequencies.size)
    columns = [
        Column("mode", count, "", "mode number; 0: rigid-body motion"),
        column_of(found, "frequencies"),
        *(
            column_of(found, "mesh_energy", found.mesh_energy[:, m], name=f"energy_{mesh.name}")
            for m, mesh in enumerate(train.meshes)
        ),
        *(
            column_of(found, "shapes", found.shapes[train.dof[body.name]], name=f"shape_{body.name}")
            for body in train.bodies
        ),
    ]
    tables = [Table("natural_modes", tuple(columns), "Natural frequencies and mode shapes")]
    if diagram is not None:
        line, mode = (1 + one for one in np.indices(diagram.critical.shape)[1:])
        mesh = np.repeat(np.array(data.names, dtype=str), line[0].size)
        columns = [
            Column("mesh", mesh, "", "mesh of the harmonic"),
            Column("n", line.ravel(), "", "harmonic of the mesh frequency"),
            Column("mode", mode.ravel(), "", "natural mode"),
            Column("speed", diagram.critical.ravel() * data.speed_ratio, "rpm", f"speed of {data.speed_of}"),
        ]
        title = "Critical speeds of the mesh harmonics"
        tables.append(Table("critical_speeds", tuple(columns), title))
        tables += _ripple_table(data, diagram)
    values = tuple(
        value_of(found, "frequencies", "", si=found.frequencies[k], name=f"natural_frequency_{k}") for k in count[1:]
    )
    return Outcome(
        known,
        tuple(tables),
        values,
        figures=_modes_figures(known, math.nan if asked.part.speed is None else asked.part.speed),
    )


def _ripple_table(data: GearTrain, diagram: Campbell) -> list[Table]:
    """Speeds at which torque ripple meets natural frequencies; of a fixed frequency there is none."""
    found = [(one, ripple_critical(one, diagram.natural)) for one in data.ripple if one.order is not None]
    if not found:
        return []
    place = [1 + np.indices(critical.shape) for _, critical in found]
    columns = (
        Column("ripple", np.array([one.name for one, c in found for _ in range(c.size)], dtype=str), "", "name"),
        Column("n", np.concatenate([one.harmonics[p[0].ravel() - 1] for (one, _), p in zip(found, place, strict=True)]),
               "", "harmonic number"),
        Column("mode", np.concatenate([p[1].ravel() for p in place]), "", "natural mode"),
        Column("speed", np.concatenate([c.ravel() for _, c in found]) * data.speed_ratio, "rpm",
               f"speed of {data.speed_of}"),
    )  # fmt: skip
    title = "Critical speeds of the torque ripple"
    return [Table("torque_ripple_critical_speeds", columns, title)]


def _ripple_curves(train: GearTrain, speed: NDArray[np.float64], top: float) -> list[Curve]:
    """Frequencies of torque ripple over speed, below the upper end of the diagram [Hz]."""
    drawn = []
    for k, one in enumerate(train.ripple):
        for n, line in zip(one.harmonics, one.frequencies(speed / train.speed_ratio / _RPM), strict=True):
            if line.min() > top:
                continue
            label = f"torque ripple {one.name}" + (f", harmonic {n}" if len(one.harmonics) > 1 else "")
            role = f"series:{len(train.names) + k}"
            drawn.append(Curve(speed, line * 1e-3, label, role, dash="dot", width=1.4, markers=False))
    return drawn


def _modes_figures(data: ModesData, speed: float) -> tuple[Figure, ...]:
    """Where each mode deforms, and where harmonics of the meshes meet the modes; the rigid motion is not drawn."""
    frequencies, energy = data.modes.frequencies[1:], data.modes.mesh_energy[1:]
    if not frequencies.size:
        return ()
    place, shafts = np.arange(frequencies.size), 1.0 - energy.sum(axis=1)
    bars = [Bars(place, energy[:, m], f"mesh {name}", f"series:{m}") for m, name in enumerate(data.train.names)]
    if shafts.max() > _ROUND_OFF:
        bars.append(Bars(place, shafts, "shafts", "grey"))
    x = Axis("mode and natural frequency", categories=tuple(f"{k + 1}\n{f:.5g} Hz" for k, f in enumerate(frequencies)))
    modes = Figure(
        "natural_modes", "Natural modes",
        "Strain energy distribution of the modes in meshes and shafts.",
        (Panel(x, Axis("strain energy share", limits=(0.0, 1.0)), tuple(bars), stacked=True),),
    )  # fmt: skip
    if data.campbell is None or data.campbell.speeds.size < 2:
        return (modes,)
    return modes, _campbell_figure(data.train, data.campbell, speed), *_critical_figure(data.train, data.campbell)


def _campbell_figure(train: GearTrain, diagram: Campbell, operating: float) -> Figure:
    speed = diagram.speeds * train.speed_ratio * _RPM
    low, high, top = float(speed.min()), float(speed.max()), 1.25e-3 * float(diagram.natural.max())
    items: list[Curve | Points] = []
    for m, name in enumerate(train.names):
        for h in range(diagram.lines.shape[1]):
            label, dash = f"mesh {name}, harmonic {h + 1}", DASHES[h % len(DASHES)]
            line = diagram.lines[m, h] * 1e-3
            items.append(Curve(speed, line, label, f"series:{m}", dash=dash, width=1.4, markers=False))
    items += _ripple_curves(train, speed, 1e3 * top)
    for m, name in enumerate(train.names):
        line, mode = np.indices(diagram.critical[m].shape)
        met = diagram.critical[m] * train.speed_ratio * _RPM
        inside = np.isfinite(met) & (met >= low) & (met <= high)
        notes = tuple(
            f"mesh {name}, harmonic {h + 1}, mode {k + 1}: {at:.5g} rpm"
            for h, k, at in zip(line[inside], mode[inside], met[inside], strict=True)
        )
        natural = diagram.natural[mode[inside]] * 1e-3
        items.append(Points(met[inside], natural, "", f"series:{m}", "circle", size=6.0, notes=notes))
    marks = [Mark("y", at * 1e-3, word) for at, word in _mode_words(diagram.natural, _ROOM_OF_MODES * 1e3 * top)]
    if low <= operating * _RPM <= high:
        marks.append(Mark("x", operating * _RPM, f"operating speed {operating * _RPM:.5g} rpm"))
    rippled = " Dotted: torque ripple; torque_ripple_critical_speeds.csv has its speeds." if train.ripple else ""
    return Figure(
        "campbell", "Campbell diagram",
        "Intersections of mesh harmonics (inclined) and undamped natural frequencies (horizontal); speeds in "
        f"critical_speeds.csv.{rippled}",
        (Panel(
            Axis(f"speed of {train.speed_of}", "rpm", limits=(low, high)), Axis("frequency", "kHz", limits=(0.0, top)),
            tuple(items), tuple(marks), height=1.3,
        ),),
    )  # fmt: skip


def _mode_words(natural: NDArray[np.float64], room: float) -> list[tuple[float, str]]:
    """Each natural frequency [Hz] with its word; modes closer than the room of a word share that of the highest."""
    found, together = [], []
    for k, at in enumerate(natural):
        together.append(f"{k + 1}: {at:.4g} Hz")
        last = k + 1 == natural.size or natural[k + 1] - at >= room
        found.append((float(at), f"mode{'s' if len(together) > 1 else ''} {', '.join(together)}" if last else ""))
        together = [] if last else together
    return found


def _critical_figure(train: GearTrain, diagram: Campbell) -> tuple[Figure, ...]:
    points = []
    for m, name in enumerate(train.names):
        line, mode = np.indices(diagram.critical[m].shape)
        speed = diagram.critical[m] * train.speed_ratio * _RPM
        known = np.isfinite(speed) & (speed > 0.0)
        notes = tuple(f"mode {k + 1}" for k in mode[known])
        points.append(Points(speed[known], line[known] + 1, f"mesh {name}", f"series:{m}", size=8, notes=notes))
    if not any(np.size(row.x) for row in points):
        return ()
    axes = Axis(f"speed of {train.speed_of}", "rpm", log=True), Axis("harmonic of the mesh frequency", whole=True)
    return (Figure(
        "critical_speeds", "Critical speeds",
        "Speeds at which a mesh harmonic coincides with a natural frequency.", (Panel(*axes, tuple(points)),),
    ),)  # fmt: skip


NATURAL_MODES = Stage(
    subjects=the_train,
    needs=needs_train,
    inputs=Reads.of(lambda scene: scene.case.dynamics),
    compute=_modes,
    present=_present_modes,
    cites=TRAIN_SOURCES,
    forecast=lambda _scene, _subject: forecasts.constant(0.005),
)
