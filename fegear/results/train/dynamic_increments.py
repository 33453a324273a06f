"""Result ``dynamic-increments``: what the motion of the train adds to the transmission error of its meshes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.shown import shown, shows
from fegear.case.reading import Scene
from fegear.dynamics.train.gear_train import GearTrain
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import ALL, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
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
class Increment:
    """Q_ij over frequency with its asymptotes; two meshes that share no body have none at high frequency.

    Parameters
    ----------
    first, second : str
        Mesh whose increment it is, and mesh whose transmission error excites it.
    role : str
        Of the second.
    """

    first: str
    second: str
    role: str
    frequency: Array = shown("Hz", "frequency of the static transmission error")
    q: Complex = shown()
    low: Complex | None = shown("", "first power of the frequency (Mark 2.62, 2.65)")
    high: Complex | None = shown("", "bodies turn as free inertias (2.64, 2.66)")

    @property
    @shows("", "modulus of the dynamic increment")
    def modulus(self) -> Array:
        """|Q|."""
        return np.abs(self.q)

    @property
    @shows("", "largest modulus")
    def largest(self) -> float:
        """Over the frequencies."""
        return float(self.modulus.max())

    @property
    @shows("Hz", "its frequency")
    def resonance(self) -> float:
        """[Hz]."""
        return float(self.frequency[int(np.argmax(self.modulus))])

    @property
    def top(self) -> float:
        """Upper end of the ordinate of its parts."""
        return _ROOM * self.largest or 1.0

    @property
    def log_limits(self) -> tuple[float, float]:
        """Ends of the ordinate of its modulus."""
        least = float(self.modulus[self.modulus > 0.0].min(initial=self.top))
        return 0.5 * least, 2.0 * self.top


@dataclass(frozen=True)
class OfMesh:
    """Increments of one mesh."""

    name: str
    increments: list[Increment]


@dataclass(frozen=True)
class Difference:
    """How far one form of an increment is from the elimination."""

    key: str
    words: str
    frequency: Array
    off: Array = shown("", "relative deviation")

    @property
    @shows("", "maximum over the frequencies")
    def largest(self) -> float:
        """Over the frequencies."""
        return float(self.off.max())

    @property
    @shows("Hz", "its frequency")
    def worst(self) -> float:
        """[Hz]."""
        return float(self.frequency[int(np.argmax(self.off))])


@dataclass(frozen=True)
class Determinants:
    """Mark's determinants, the increments that they give, and how far these are from the elimination's.

    Parameters
    ----------
    own, cross : str
        Names of both increments.
    """

    own: str
    cross: str
    differences: tuple[Difference, ...]
    d: Complex = shown("", "determinant by its polynomial (2.57) [(N m)^3]", name="D")
    off: Array = shown("", "relative deviation of (2.57) from the elements (2.46c)", name="difference_D")
    own_numerator: Complex = shown("", "N_1,I + N_2,I (2.55) [N (N m)^2]")
    cross_numerator: Complex = shown("", "N_1,II + N_2,II (2.56) [N (N m)^2]")
    own_printed: Complex = shown("", "R N/D - 1 as printed (2.58)")
    own_ratio: Complex = shown("", "as -D(mesh removed)/D (no cancellation)")
    cross_printed: Complex = shown("", "R N/D (2.59)")
    own_eliminated: Complex = shown("", "by elimination")
    cross_eliminated: Complex = shown("", "by elimination")

    @classmethod
    def of(cls, rig: FourSquare, own: Increment, cross: Increment) -> Determinants:
        """Of the rig at the frequencies of its increments."""
        from fegear.dynamics.train.four_square import relative_difference

        omega = 2.0 * math.pi * own.frequency
        d, (printed, by_cross), ratio = rig.determinant(omega), rig.as_printed(omega), rig.own_by_ratio(omega)
        i, j = f"{own.first}_{own.second}", f"{cross.first}_{cross.second}"
        rows = (
            (f"printed_{i}", printed, own, "(2.58) as printed"), (i, ratio, own, "the ratio of determinants"),
            (j, by_cross, cross, "(2.59)"),
        )  # fmt: skip
        differences = tuple(
            Difference(
                key, f"relative deviation of {what} from the elimination", own.frequency,
                relative_difference(found, exact.q),
            )
            for key, found, exact, what in rows
        )  # fmt: skip
        off = relative_difference(d, rig.determinant_of_elements(omega))
        return cls(i, j, differences, d, off, *rig.numerators(omega), printed, ratio, by_cross, own.q, cross.q)


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

    def _named(self, i: int, j: int) -> Increment:
        high = None if self.high is None or not np.any(self.high[i, j]) else self.high[i, j]
        return Increment(
            self.train.names[i], self.train.names[j], f"series:{j}", self.frequencies, self.increments[i, j],
            None if self.low is None else self.low[i, j], high,
        )  # fmt: skip

    @cached_property
    def meshes(self) -> list[OfMesh]:
        """Increments of every mesh by the transmission error of every mesh."""
        names = self.train.names
        return [OfMesh(name, [self._named(i, j) for j in range(len(names))]) for i, name in enumerate(names)]

    @property
    def pairs(self) -> list[Increment]:
        """Of every pair of meshes."""
        return [one for mesh in self.meshes for one in mesh.increments]

    @property
    @shows("", "which", name="increment")
    def peak_names(self) -> NDArray[np.str_]:
        """Of every peak: with damping they lie off the undamped modes."""
        names = self.train.names
        return np.array([f"Q_{names[p.mesh]}_{names[p.source]}" for p in self.peaks])

    @cached_property
    def determinants(self) -> Determinants | None:
        """Of Mark's rig."""
        return None if self.rig is None else Determinants.of(self.rig, self.pairs[0], self.pairs[1])


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


#: What is drawn of an increment: its attribute, label, role and dash.
_DRAWN = (
    ("q", "increment", "blue", ""), ("low", "low-frequency asymptote", "orange", "dash"),
    ("high", "high-frequency asymptote", "green", "dashdot"),
)  # fmt: skip


def _part(of: Callable[[Complex], Array], y: Callable[[Seen], Axis]) -> Over:
    """Modulus, real or imaginary part of an increment with its asymptotes."""

    def part(attribute: str) -> Callable[[Seen], Array | None]:
        def found(seen: Seen) -> Array | None:
            z = getattr(seen.one, attribute)
            return None if z is None else of(z)

        return found

    lines = tuple(
        Line(
            "q", label, role, x="frequency", si=part(attribute),
            look={"dash": dash, "markers": False, "width": 1.3 if dash else 2.0},
        )
        for attribute, label, role, dash in _DRAWN
    )  # fmt: skip
    return Over(Axis("frequency", "Hz", log=True), lines, y)


def _whose(seen: Seen) -> str:
    one: Increment = seen.one
    whose = "of the same mesh" if one.first == one.second else f"that of mesh {one.second}"
    return (
        f"Mesh {one.first}: complex amplitude that the motion of the train adds to its transmission error, per unit "
        f"static transmission error, {whose}; exp(+i w t). Asymptotes: rigid-body motion at low frequency, free "
        "inertias at high frequency."
    )


def _complex(quantity: str, name: str = "") -> Cell:
    return Cell(quantity, name=name, parts=True)


_FREQUENCY = Cell("frequency", of=lambda seen: seen.data.pairs[0])
_PAIR = "{one.first}_{one.second}"
_OWN, _CROSS = "{d.determinants.own}", "{d.determinants.cross}"
_SHEET = Sheet(
    name=lambda _asked: "",
    tables=(
        Rows(
            "dynamic_increments", "Dynamic increment functions",
            (
                _FREQUENCY,
                Cell(
                    "q", name=f"Q_{_PAIR}", parts=True, each="pairs",
                    meaning="dynamic increment of mesh {one.first} per static transmission error of mesh {one.second}",
                ),
            ),
        ),
        Rows(
            "dynamic_increments_asymptotes", "Moduli of the dynamic increments and asymptotes",
            (
                _FREQUENCY,
                Each(
                    "pairs", Cell("modulus", name=f"modulus_{_PAIR}"), _complex("low", f"low_{_PAIR}"),
                    _complex("high", f"high_{_PAIR}"),
                ),
            ),
            when="low",
        ),
        Rows(
            "dynamic_increments_peaks", "Peaks of the dynamic increments",
            (Cell("peak_names", of=lambda seen: seen.data), "frequency", "modulus"), of="peaks", when="peaks",
        ),
        Rows(
            "dynamic_increments_determinants", "Determinants of the four-square rig",
            (
                _FREQUENCY, _complex("d"), "off",
                _complex("own_numerator", f"N_{_OWN}"), _complex("cross_numerator", f"N_{_CROSS}"),
                _complex("own_printed", f"Q_{_OWN}_printed"), _complex("own_ratio", f"Q_{_OWN}_ratio"),
                _complex("cross_printed", f"Q_{_CROSS}_printed"), _complex("own_eliminated", f"Q_{_OWN}"),
                _complex("cross_eliminated", f"Q_{_CROSS}"),
                Cell("off", name="difference_{one.key}", meaning="{one.words}", each="determinants.differences"),
            ),
            of="determinants",
        ),
    ),
    values=(
        Number(
            "largest", name=f"Q_{_PAIR}_largest", meaning="modulus, at {one.resonance:.6g!} Hz", each="pairs"
        ),
        Number(
            "largest", name="determinants_difference_{one.key}", each="determinants.differences",
            further=", {one.words}, at {one.worst:.6g!} Hz",
        ),
    ),
    figures=(
        Chart(
            "dynamic_increments", "Dynamic increment functions",
            "Dynamic increment functions: difference between the force of one mesh (divided by its stiffness) and its "
            "quasi-static value, for a static transmission error of the same or another mesh.",
            (
                Over(
                    Axis("frequency", "Hz", log=True),
                    (
                        Line(
                            "modulus", "error of mesh {one.second}", x="frequency",
                            each=Family("increments", role="{one.role}", most=ALL),
                        ),
                    ),
                    lambda seen: Axis(f"|Q| of mesh {seen.one.name}", log=True), each="meshes",
                ),
            ),
        ),
        Chart(
            f"dynamic_increment_{_PAIR}", "Dynamic increment of mesh {one.first} by the error of mesh {one.second}",
            _whose,
            (
                _part(np.abs, lambda seen: Axis("|Q|", log=True, limits=seen.one.log_limits)),
                _part(np.real, lambda seen: Axis("Re Q", limits=(-seen.one.top, seen.one.top))),
                _part(np.imag, lambda seen: Axis("Im Q", limits=(-seen.one.top, seen.one.top))),
            ),
            each="pairs", when="low",
        ),
    ),
)  # fmt: skip


def _inputs(scene: Scene, _subject: str) -> FrequencyInputs:
    part = scene.case.dynamics
    return FrequencyInputs(part.frequencies.array, part.determinants)


def _check(scene: Scene, _subject: str) -> None:
    """Refuse determinants of a train that is not Mark's rig."""
    if scene.case.dynamics.determinants:
        from fegear.case.built.train import train_inputs
        from fegear.dynamics.train.four_square import FourSquare
        from fegear.dynamics.train.train_spec import build_train

        FourSquare.of(build_train(train_inputs(scene).spec))


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
    present=_SHEET.present,
    cites=citing(Citation("mark", "transmission-error dynamic increment functions", "Eqs. 2.57 to 2.66")),
    forecast=_forecast,
)
