"""Which loading functions are looked at, what comes of them, and as their sheet reads it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.case.loading import LoadingPart
from fegear.design.loading import LoadingFunction, SlopeTradeOff, ToothResponse
from fegear.engine.figure.family import few
from fegear.geometry.pair import GearPair, Member

#: Positions on a ramp, in its table and in its picture.
_RAMP, _DRAWN = 201, 401
#: Panels of one figure.
_MOST_PANELS = 8


@dataclass(frozen=True)
class LoadingInputs:
    """Which loading functions are looked at.

    Parameters
    ----------
    part : LoadingPart
    length, base_pitch, centre : float
        L, A and the middle of the path [m]; without a pair in base pitches, A = 1, about zero.
    load : float
        Design load [N]; 1 where loads are fractions of it.
    path : float
        Length of the pair's path of contact [m]; nan without a pair.
    name : str
        Of the pair, empty without one.
    gears : GearPair or None
        The pair, where the case gives it a speed.
    """

    part: LoadingPart
    length: float
    base_pitch: float
    centre: float
    load: float
    path: float
    name: str = field(compare=False)
    gears: GearPair | None = None


@dataclass(frozen=True)
class OwnVibration:
    """What the teeth of one gear of the pair do by themselves at the case's speed.

    `response` is that to each loading function, arrays of shape (1,).
    """

    response: tuple[ToothResponse, ...]
    member: Member = shown("", "driver or driven", name="gear")
    frequency: float = shown("Hz", "lowest natural frequency of a tooth")
    order: float = shown("", "natural frequency of the tooth / mesh frequency")


@dataclass(frozen=True)
class LoadingData:
    """F loading functions with their loads and spectra.

    `x` has shape (P,) [m], `load` (F, P) as shares of the design load, `order` and `q` (G,), spectra (F, G) as moduli.
    `factor` and `factor_asymptote` are the braces of (4.15b) and (4.16). `response` is that of a tooth to each function
    over its natural frequency in `order`; `teeth` are those of both gears at the case's speed, empty without one.
    """

    functions: tuple[LoadingFunction, ...]
    x: Array
    load: Array
    trade_off: SlopeTradeOff
    response: tuple[ToothResponse, ...]
    teeth: tuple[OwnVibration, ...]
    order: Array = shown("", "frequency / mesh frequency")
    spectrum: Array = shown(
        "", "modulus / (design load times base pitch)", label="spectrum / (design load times base pitch)"
    )
    asymptote: Array = shown("", "high-frequency asymptote (4.20)")
    envelope: Array = shown("", "envelope of the asymptote (4.22)")
    q: Array = shown("", "cycles over the width of the ramp", label="q = (L - A) g")
    factor: Array = shown("", "1 at q = 0", label="modulus of the factor")
    factor_asymptote: Array = shown("", "s sinc(q)", name="asymptote")
    sum_misfit: float = shown(
        "", "maximum relative deviation of the total load of all pairs from the design load", name="loading_sum_misfit"
    )


@dataclass(frozen=True)
class OnRamp:
    """Loading of a ramp; arrays of shape (R,)."""

    x: Array = shown("", "roll distance / half ramp length, from its middle")
    load: Array = shown("", "2 (load / design load) - 1")


@dataclass(frozen=True)
class OnPath:
    """Load of one tooth pair over its path, as lengths and forces of a pair, or per base pitch and design load."""

    x: Array | None = shown("mm", "roll distance")
    in_pitches: Array | None = shown("", "roll distance in base pitches, from the middle of contact", name="x")
    load: Array | None = shown("N", "")
    share: Array | None = shown("", "load / design load", name="load")


@dataclass(frozen=True)
class OneLoading:
    """One of the loading functions.

    Parameters
    ----------
    asked : LoadingInputs
    data : LoadingData
    number : int
        Among all.
    label : str
        What tells it apart from the others.
    """

    asked: LoadingInputs
    data: LoadingData
    number: int
    label: str

    @property
    def function(self) -> LoadingFunction:
        """Itself."""
        return self.data.functions[self.number]

    @property
    @shows("", "r; 0: sinusoidal family")
    def exponent(self) -> int:
        """Of the ramps."""
        return self.function.ramp.exponent or 0

    def on_ramp(self, positions: int) -> OnRamp:
        """Of its outer ramp."""
        x = np.linspace(-1.0, 1.0, positions)
        return OnRamp(x, self.function.ramp.load(x))

    @property
    def listed_ramp(self) -> OnRamp:
        """As the table has it."""
        return self.on_ramp(_RAMP)

    @property
    def drawn_ramp(self) -> OnRamp:
        """As the picture has it."""
        return self.on_ramp(_DRAWN)

    def _along(self, x: Array, share: Array) -> OnPath:
        if self.asked.name:
            return OnPath(x, None, share * self.asked.load, None)
        return OnPath(None, x, None, share * self.asked.load)

    @property
    def on_path(self) -> OnPath:
        """Over the path of the pair."""
        return self._along(self.data.x, self.data.load[self.number])

    @property
    def adjacent(self) -> Iterator[OnPath]:
        """Of the pairs before and after."""
        pitch, first, x = self.asked.base_pitch, self.data.functions[0], self.data.x
        for side in (-1, 1):
            near = np.abs(x + side * pitch - first.centre) <= 0.5 * (first.length + pitch)
            yield self._along(x + side * pitch, np.where(near, self.data.load[self.number], np.nan))

    @property
    def response(self) -> ToothResponse:
        """Of a tooth over its natural frequency."""
        return self.data.response[self.number]

    @property
    def asymptotic(self) -> bool:
        """Whether its spectrum has an asymptote of second order."""
        return self.function.ramp.slope > 0.0

    @property
    @shows("", "envelope of the asymptote")
    def factor_envelope(self) -> Array | None:
        """Of the ramp's spectrum factor."""
        return self.function.ramp.slope / (np.pi * self.data.q) if self.asymptotic else None

    @property
    def _inside(self) -> Array:
        return self.data.envelope[self.number] <= self.data.spectrum[self.number].max()

    @property
    def seen_envelope(self) -> Array | None:
        """The envelope of the spectrum below its largest value."""
        envelope = self.data.envelope[self.number]
        return envelope[self._inside] if np.any(envelope > 0.0) else None

    @property
    def seen_order(self) -> Array:
        """The frequencies of that."""
        return self.data.order[self._inside]

    @property
    @shows("1/mm", "slope of load / design load at initiation", name="initial_slope")
    def slope_per_length(self) -> float | None:
        """[1/m]."""
        return self._traded("initial_slope", paired=True)

    @property
    @shows("", "slope of load / design load at initiation, per base pitch", name="initial_slope")
    def slope_per_pitch(self) -> float | None:
        """Without a pair."""
        return self._traded("initial_slope", paired=False)

    @property
    @shows("mm", "change of the loaded length for a relative load change of 1")
    def length_per_load(self) -> float | None:
        """[m]."""
        return self._traded("length_per_load", paired=True)

    @property
    @shows(
        "", "change of the loaded length for a relative load change of 1, in base pitches", name="length_per_load"
    )  # fmt: skip
    def pitches_per_load(self) -> float | None:
        """Without a pair."""
        return self._traded("length_per_load", paired=False)

    @property
    @shows("", "root mean square of the spectrum")
    def high_frequency_content(self) -> float:
        """Above the order that the case asks for."""
        return float(self.data.trade_off.high_frequency_content[self.number])

    def _traded(self, quantity: str, *, paired: bool) -> float | None:
        return float(getattr(self.data.trade_off, quantity)[self.number]) if paired == bool(self.asked.name) else None


@dataclass(frozen=True)
class OwnResponse:
    """Answer of the teeth of one gear to one loading function at the case's speed."""

    own: OwnVibration
    loading: OneLoading

    @property
    def response(self) -> ToothResponse:
        """Arrays of shape (1,)."""
        return self.own.response[self.loading.number]


@dataclass(frozen=True)
class LoadingShown:
    """Loading functions as their sheet reads them."""

    data: LoadingData
    asked: LoadingInputs

    @property
    def end(self) -> str:
        """Of names of tables and figures."""
        return f"_{self.asked.name}" if self.asked.name else ""

    @property
    def of_pair(self) -> str:
        """Of titles."""
        return f" of pair {self.asked.name}" if self.asked.name else ""

    @cached_property
    def functions(self) -> list[OneLoading]:
        """All of them."""
        labels = _labels(self.data.functions)
        return [OneLoading(self.asked, self.data, k, label) for k, label in enumerate(labels)]

    @property
    def first(self) -> LoadingFunction:
        """The first."""
        return self.data.functions[0]

    @property
    def adjacent(self) -> Iterator[OnPath]:
        """Of the first function."""
        return self.functions[0].adjacent

    @property
    def panelled(self) -> list[OneLoading]:
        """Those with a panel of their own."""
        return [self.functions[i] for i in few(len(self.functions), most=_MOST_PANELS)]

    @property
    def has_factors(self) -> bool:
        """Whether there is one ramp: two, above a contact ratio of 2, have spectra that only count together."""
        return self.first.order == 1 and self.first.terms[0][2] > 0.0

    @property
    def own(self) -> list[OwnResponse]:
        """Answers of the teeth of both gears at the case's speed."""
        return [OwnResponse(own, loading) for own in self.data.teeth for loading in self.functions]

    @property
    def highest(self) -> float:
        """Of the spectra that are drawn, doubled."""
        return 2.0 * float(max(self.data.spectrum[i].max() for i in few(len(self.functions))))

    @property
    @shows("", "length of the loaded path / base pitch")
    def contact_ratio(self) -> float:
        """Of the loading."""
        return self.asked.length / self.asked.base_pitch

    @property
    @shows("mm", "A")
    def base_pitch(self) -> float:
        """[m]."""
        return self.asked.base_pitch

    @property
    @shows("mm", "path of contact of the pair")
    def path(self) -> float:
        """[m]."""
        return self.asked.path

    @property
    @shows("mm", "L, loaded length of a pair")
    def length(self) -> float:
        """[m]."""
        return self.asked.length

    @property
    @shows("mm", "ramp length at initiation")
    def ramp(self) -> float:
        """[m]."""
        return self.first.terms[0][2]


def _labels(functions: tuple[LoadingFunction, ...]) -> list[str]:
    """What tells the functions apart; all of it where there is only one."""
    rows = [
        (f"s = {f.ramp.slope:g}", f"r = {f.ramp.exponent}" if f.ramp.exponent else "", f"F = {f.peak:.4g}")
        for f in functions
    ]
    differ = [len({row[k] for row in rows}) > 1 for k in range(3)]
    keep = [k for k in range(3) if differ[k]] or [k for k in range(3) if k < 2 or functions[0].order > 1]
    return [", ".join(row[k] for k in keep if row[k]) for row in rows]
