"""Stage ``natural-modes``: natural frequencies of the train and where harmonics of its meshes meet them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.printed import figures, percent
from fegear.base.shown import shown, shows
from fegear.case.dynamics import DynamicsPart
from fegear.dynamics.train.gear_train import GearTrain
from fegear.engine.colours import DASHES
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import ALL, Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen, itself
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Reads, Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.train.beside_modes import beside, causes_of, explained, measured_beside
from fegear.results.train.gear_train import RPM, TRAIN_SOURCES, gear_train, needs_train, the_train

if TYPE_CHECKING:
    from fegear.dynamics.train.measured_modes import MeasuredModes
    from fegear.dynamics.train.modes import Campbell, Modes
    from fegear.dynamics.train.one_cause import OneCause
    from fegear.engine.figure.items import Mark

#: A share of energy below this is none.
_ROUND_OFF = 1e-6
#: Share of the height of a Campbell diagram that the word of a mode takes.
_ROOM_OF_MODES = 0.05
#: Upper end of a Campbell diagram over the highest natural frequency.
_ABOVE = 1.25


@dataclass(frozen=True)
class Shares:
    """Share of the strain energy of every flexible mode in one mesh, or in the shafts."""

    name: str
    role: str
    energy: Array = shown("", "strain energy share")

    @property
    @shows("", "number of the mode")
    def place(self) -> NDArray[np.int64]:
        """From 0."""
        return np.arange(self.energy.size)


@dataclass(frozen=True)
class HarmonicLine:
    """A harmonic over speed, a curve of the Campbell diagram."""

    name: str
    role: str
    dash: str
    speed: Array = shown("rpm", "speed")
    frequency: Array = shown("kHz", "frequency")


@dataclass(frozen=True)
class Meetings:
    """Where harmonics of one mesh, or of one torque ripple, meet natural modes: a row for each harmonic and mode."""

    name: str
    role: str
    n: NDArray[np.int64] = shown("", "harmonic of the mesh frequency")
    mode: NDArray[np.int64] = shown("", "natural mode")
    speed: Array = shown("rpm", "speed of coincidence")
    natural: Array = shown("kHz", "natural frequency")

    @classmethod
    def of(cls, name: str, role: str, harmonics: NDArray[np.int64], critical: Array, natural: Array) -> Meetings:
        """Of speeds [rad/s], shape (harmonics, modes)."""
        line, mode = np.indices(critical.shape).reshape(2, -1)
        return cls(name, role, harmonics[line], mode + 1, critical.ravel(), natural[mode])

    @property
    @shows("", "mesh of the harmonic", name="mesh")
    def owner(self) -> NDArray[np.str_]:
        """Name, in every row."""
        return np.full(self.n.shape, self.name)

    def at(self, which: NDArray[np.bool_]) -> Meetings:
        """Only some of them."""
        return Meetings(
            self.name, self.role, self.n[which], self.mode[which], self.speed[which], self.natural[which]
        )  # fmt: skip


@dataclass(frozen=True)
class ModesData:
    """Modes, the Campbell diagram where the case gives speeds (of the first body, in rad/s), and what was measured."""

    train: GearTrain
    modes: Modes
    campbell: Campbell | None
    measured: MeasuredModes | None = None
    causes: OneCause | None = None

    @property
    def shapes(self) -> dict[str, Array]:
        """Angle of every body in every mode."""
        train = self.train.train
        return {body.name: self.modes.shapes[train.dof[body.name]] for body in train.bodies}

    @property
    def flexible(self) -> dict[str, float]:
        """Natural frequencies above zero [Hz], by the number of the mode."""
        return {str(k): f for k, f in enumerate(self.modes.frequencies) if k > 0}

    @property
    def shares(self) -> list[Shares]:
        """Where the flexible modes deform."""
        energy = self.modes.mesh_energy[1:]
        found = [Shares(f"mesh {name}", f"series:{m}", energy[:, m]) for m, name in enumerate(self.train.names)]
        shafts = 1.0 - energy.sum(axis=1)
        return [*found, Shares("shafts", "grey", shafts)] if shafts.max(initial=0.0) > _ROUND_OFF else found

    @cached_property
    def meetings(self) -> list[Meetings]:
        """Of the meshes; none without speeds."""
        diagram, train = self.campbell, self.train
        if diagram is None:
            return []
        harmonics, speeds = 1 + np.arange(diagram.critical.shape[1]), diagram.critical * train.speed_ratio
        return [
            Meetings.of(name, f"series:{m}", harmonics, speeds[m], diagram.natural)
            for m, name in enumerate(train.names)
        ]

    @property
    def of_ripple(self) -> list[Meetings]:
        """Of the torque ripple; of a fixed frequency there is none."""
        from fegear.dynamics.train.modes import ripple_critical

        diagram, train = self.campbell, self.train
        return [] if diagram is None else [
            Meetings.of(one.name, "", one.harmonics, ripple_critical(one, diagram.natural) * train.speed_ratio,
                        diagram.natural)
            for one in train.ripple if one.order is not None
        ]  # fmt: skip

    @property
    def diagram(self) -> Campbell | None:
        """Where there are several speeds and flexible modes."""
        found = self.campbell
        return found if found is not None and found.speeds.size > 1 and self.flexible else None

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest speed of the diagram [rpm]."""
        speed = self.lines[0].speed * RPM
        return float(speed.min()), float(speed.max())

    @property
    def top(self) -> float:
        """Upper end of the diagram [Hz]."""
        return _ABOVE * max(self.flexible.values())

    @cached_property
    def lines(self) -> list[HarmonicLine]:
        """Harmonics of the meshes, and of torque ripple below the upper end of the diagram."""
        diagram, train = self.campbell, self.train
        if diagram is None:
            return []
        speed = diagram.speeds * train.speed_ratio
        found = [
            HarmonicLine(f"mesh {name}, harmonic {h + 1}", f"series:{m}", DASHES[h % len(DASHES)], speed, line)
            for m, name in enumerate(train.names)
            for h, line in enumerate(diagram.lines[m])
        ]
        for k, one in enumerate(train.ripple, start=len(train.names)):
            for n, line in zip(one.harmonics, one.frequencies(diagram.speeds), strict=True):
                label = f"torque ripple {one.name}" + (f", harmonic {n}" if len(one.harmonics) > 1 else "")
                if line.min() <= self.top:
                    found.append(HarmonicLine(label, f"series:{k}", "dot", speed, line))
        return found

    @property
    def crossings(self) -> list[Meetings]:
        """Meetings of the meshes within the speeds of the diagram."""
        low, high = self.ends
        return [one.at((one.speed * RPM >= low) & (one.speed * RPM <= high)) for one in self.meetings]

    @property
    def critical(self) -> list[Meetings]:
        """Meetings of the meshes at a speed."""
        found = [one.at(np.isfinite(one.speed) & (one.speed > 0.0)) for one in self.meetings]
        return found if self.diagram is not None and any(one.n.size for one in found) else []


def _modes(asked: Reads[DynamicsPart], upstream: Upstream, _work: Work) -> ModesData:
    from fegear.dynamics.train.modes import campbell, modes

    data = gear_train(upstream)
    speeds = asked.part.speed_values / data.speed_ratio
    found = modes(data.train)
    measured = measured_beside(asked.part.measured_frequencies, found.frequencies[1:])
    return ModesData(
        data, found, campbell(data.train, speeds, asked.part.lines) if speeds.size else None, measured,
        causes_of(data, measured),
    )  # fmt: skip


def _mode_words(natural: Array, room: float) -> list[tuple[float, str]]:
    """Each natural frequency [Hz] with its word; modes closer than the room of a word share that of the highest."""
    found, together = [], []
    for k, at in enumerate(natural):
        together.append(f"{k + 1}: {at:.4g} Hz")
        last = k + 1 == natural.size or natural[k + 1] - at >= room
        found.append((float(at), f"mode{'s' if len(together) > 1 else ''} {', '.join(together)}" if last else ""))
        together = [] if last else together
    return found


def _marks(seen: Seen) -> list[Mark]:
    """Natural frequencies with their numbers, and the speed of the case."""
    from fegear.engine.figure.items import Mark

    data: ModesData = seen.data
    at, (low, high) = math.nan if seen.asked.part.speed is None else seen.asked.part.speed * RPM, data.ends
    natural = np.array(list(data.flexible.values()))
    marks = [Mark("y", f * 1e-3, word) for f, word in _mode_words(natural, _ROOM_OF_MODES * data.top)]
    return [*marks, Mark("x", at, f"operating speed {at:.5g} rpm")] if low <= at <= high else marks


def _crossing_notes(seen: Seen) -> dict[str, object]:
    one = seen.one
    met = zip(one.n, one.mode, one.speed * RPM, strict=True)
    notes = tuple(f"mesh {one.name}, harmonic {n}, mode {k}: {at:.5g} rpm" for n, k, at in met)
    return {"notes": notes, "symbol": "circle", "size": 6.0}


_SPEED = Cell("speed", meaning="speed of {d.train.speed_of}")


def _frequencies(seen: Seen) -> Iterator[str]:
    """How many natural frequencies there are, and from where to where."""
    natural = list(seen.data.flexible.values())
    if len(natural) == 1:
        yield f"One natural frequency above zero: {figures(natural[0])} Hz."
    elif natural:
        yield f"{len(natural)} natural frequencies above zero, {figures(natural[0])} to {figures(natural[-1])} Hz."


def _critical(seen: Seen) -> Iterator[str]:
    """The critical speed nearest to the speed of the case, or else the highest of the first harmonics."""
    speed = seen.asked.part.speed
    met = [
        (float(at), int(n), int(mode), one.name)
        for one in seen.data.critical for n, mode, at in zip(one.n, one.mode, one.speed, strict=True)
    ]  # fmt: skip
    if not met:
        return
    if speed is None:
        at, n, mode, mesh = max((one for one in met if one[1] == 1), default=max(met))
        yield f"Highest critical speed of the mesh frequency: {figures(at * RPM)} rpm (mesh {mesh}, mode {mode})."
        return
    at, n, mode, mesh = min(met, key=lambda one: abs(one[0] - speed))
    yield (
        f"Critical speed nearest to {figures(speed * RPM, 4)} rpm: {figures(at * RPM, 4)} rpm "
        f"({percent(at / speed - 1.0, signed=True)}), harmonic {n} of mesh {mesh} with mode {mode}."
    )


_SHEET = Sheet(
    answer=Answer(
        explained, beside, _frequencies, _critical,
        figure=lambda seen: "campbell" if seen.data.diagram is not None else "natural_modes",
    ),
    name=lambda _asked: "",
    tables=(
        Rows(
            "natural_modes", "Natural frequencies and mode shapes",
            (
                "number", "frequencies",
                Cell(
                    "mesh_energy", itself, lambda seen: seen.data.modes, "energy_{key}",
                    each=lambda seen: dict(zip(seen.data.train.names, seen.data.modes.mesh_energy.T, strict=True)),
                ),
                Cell(
                    "shapes", itself, lambda seen: seen.data.modes, "shape_{key}", each=lambda seen: seen.data.shapes
                ),
            ),
            of="modes",
        ),
        Rows(
            "critical_speeds", "Critical speeds of the mesh harmonics", ("owner", "n", "mode", _SPEED),
            stacked="meetings", when="meetings",
        ),
        Rows(
            "torque_ripple_critical_speeds", "Critical speeds of the torque ripple",
            (
                Cell("owner", name="ripple", meaning="name"), Cell("n", meaning="harmonic number"), "mode", _SPEED,
            ),
            stacked="of_ripple", when="of_ripple",
        ),
        Rows(
            "measured_frequencies", "Measured and computed natural frequencies",
            ("mode", "measured", "computed", "ratio"), of="measured",
        ),
        Rows(
            "measured_frequency_causes", "Stiffnesses and inertias that would explain the measured natural frequencies",
            (
                "number", "part", "factor", "left", "rms",
                Cell("shares", itself, lambda seen: seen.data.causes, "share_{key}", further=" {key}",
                     each="causes.shares_by_mode"),
            ),
            of="causes",
        ),
    ),
    values=(
        Number(
            "frequencies", of=lambda seen: seen.data.modes, si=itself, name="natural_frequency_{key}", each="flexible"
        ),
        Number("mean_ratio", of="measured"),
        Number("scatter", of="measured"),
    ),
    figures=(
        Chart(
            "natural_modes", "Natural modes", "Strain energy distribution of the modes in meshes and shafts.",
            (
                Over(
                    lambda seen: Axis(
                        "mode and natural frequency",
                        categories=tuple(f"{k}\n{f:.5g} Hz" for k, f in seen.data.flexible.items()),
                    ),
                    (
                        Line(
                            "energy", "{one.name}", x="place", kind="bars",
                            each=Family("shares", role="{one.role}", most=ALL),
                        ),
                    ),
                    Axis("strain energy share", limits=(0.0, 1.0)), panel={"stacked": True},
                ),
            ),
            when="flexible",
        ),
        Chart(
            "campbell", "Campbell diagram",
            lambda seen: "Intersections of mesh harmonics (inclined) and undamped natural frequencies (horizontal); "
            "speeds in critical_speeds.csv."
            + (
                " Dotted: torque ripple; torque_ripple_critical_speeds.csv has its speeds."
                if seen.data.train.ripple else ""
            ),
            (
                Over(
                    lambda seen: Axis(f"speed of {seen.data.train.speed_of}", "rpm", limits=seen.data.ends),
                    (
                        Line(
                            "frequency", "{one.name}", x="speed", each=Family("lines", role="{one.role}", most=ALL),
                            look=lambda seen: {"dash": seen.one.dash, "width": 1.4, "markers": False},
                        ),
                        Line(
                            "natural", x="speed", kind="points", look=_crossing_notes,
                            each=Family("crossings", "", "{one.role}", most=ALL),
                        ),
                    ),
                    lambda seen: Axis("frequency", "kHz", limits=(0.0, seen.data.top * 1e-3)), _marks,
                    panel={"height": 1.3},
                ),
            ),
            when="diagram",
        ),
        Chart(
            "critical_speeds", "Critical speeds",
            "Speeds at which a mesh harmonic coincides with a natural frequency.",
            (
                Over(
                    lambda seen: Axis(f"speed of {seen.data.train.speed_of}", "rpm", log=True),
                    (
                        Line(
                            "n", "mesh {one.name}", x="speed", kind="points",
                            each=Family("critical", role="{one.role}", most=ALL),
                            look=lambda seen: {"size": 8, "notes": tuple(f"mode {k}" for k in seen.one.mode)},
                        ),
                    ),
                    Axis("harmonic of the mesh frequency", whole=True),
                ),
            ),
            when="critical",
        ),
        Chart(
            "measured_frequencies", "Measured natural frequencies",
            "Measured and computed (undamped) natural frequencies over the mode.",
            (
                Over(
                    "mode",
                    (
                        Line("computed", "computed", kind="points", look={"symbol": "square", "size": 8.0}),
                        Line("measured", "measured", "series:1", kind="points", look={"symbol": "circle", "size": 6.0}),
                    ),
                    x_options={"whole": True},
                ),
            ),
            of="measured",
        ),
    ),
    remarks=(
        Remark(lambda seen: next(beside(seen)), when="measured"), Remark(lambda seen: seen.one, each=explained),
    ),
)  # fmt: skip


NATURAL_MODES = Stage(
    subjects=the_train,
    needs=needs_train,
    inputs=Reads.of(lambda scene: scene.case.dynamics),
    compute=_modes,
    present=_SHEET.present,
    cites=TRAIN_SOURCES,
    forecast=lambda _scene, _subject: forecasts.constant(0.005),
)
