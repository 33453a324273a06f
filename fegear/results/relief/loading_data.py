"""Which loading functions are looked at, and what comes of them."""

from __future__ import annotations

from dataclasses import dataclass, field

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.case.loading import LoadingPart
from fegear.design.loading import LoadingFunction, SlopeTradeOff, ToothResponse
from fegear.geometry.pair import GearPair, Member


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
