"""What comes of deviations drawn inside tolerances: outcomes of every draw, and what each deviation does to them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.shown import declared, shown, shows
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.design.robustness.draw_statistics import Influence, Percentile
    from fegear.design.robustness.tolerance_draws import Deviations
    from fegear.design.tip_relief.robust import RobustRelief
    from fegear.results.relief.tolerance_benches import DrawInputs

#: How states of relief are called, and their columns' endings.
OWN, NOMINAL, ROBUST = "as in the case", "best without deviations", "best percentile"


ENDING = {OWN: "", NOMINAL: "_nominal_best", ROBUST: "_robust_best"}


#: Percentiles that are reported.
PERCENTS = (5.0, 50.0, 95.0)


@dataclass(frozen=True)
class ToleranceData:
    """What came of the draws.

    Parameters
    ----------
    outcomes : tuple of str
        Names of the numbers of a draw.
    deviations : Deviations
    values : mapping of str to ndarray, shape (D, outcomes)
        By the state of relief; NaN for draws without a result.
    nominal : mapping of str to ndarray, shape (outcomes,)
        Without deviations.
    reasons : mapping of int to str
        Why draws have no result.
    exact : float
        Peak-to-peak transmission error of the nominal pair with points at its jumps [m]; NaN where it is not known.
    relief : RobustRelief or None
    nominal_relief : tuple of floats
        Numbers of the nominal optimum, see `RobustRelief`; empty where none is asked for.
    """

    outcomes: tuple[str, ...]
    deviations: Deviations
    values: Mapping[str, Array]
    nominal: Mapping[str, Array]
    reasons: Mapping[int, str]
    exact: float
    relief: RobustRelief | None
    nominal_relief: tuple[float, ...]


@dataclass(frozen=True)
class DrawOutcomes:
    """How outcomes of draws are shown, `OUTCOMES` of `deviated_pair` and `FLANK_OUTCOMES` of `deviated_flanks`.

    Arrays of shape (D,); the shares are of the draws.
    """

    te_peak_to_peak: Array = shown(
        "um", "over the base pitch with teeth 0 in mesh", label="peak-to-peak transmission error"
    )
    te_mean: Array = shown("um", "over this base pitch", label="mean transmission error")
    te_harmonic_1: Array = shown("um", "amplitude, over this base pitch", label="transmission error, harmonic 1")
    te_harmonic_2: Array = shown("um", "amplitude, over this base pitch", label="transmission error, harmonic 2")
    te_harmonic_3: Array = shown("um", "amplitude, over this base pitch", label="transmission error, harmonic 3")
    te_harmonic_4: Array = shown("um", "amplitude, over this base pitch", label="transmission error, harmonic 4")
    driver_root_tension: Array = shown(
        "MPa", "maximum of tooth 0 over the engagement", label="root stress of the driver"
    )
    driven_root_tension: Array = shown("MPa", "maximum of tooth 0", label="root stress of the driven gear")
    hertz_pressure: Array = shown("MPa", "maximum between teeth 0, smooth flanks", label="Hertzian pressure")
    largest_load: Array = shown("N", "maximum on teeth 0", label="load on one tooth pair")
    face_load_factor: Array = shown("", "maximum / mean load over the face width", label="face load factor K_Hbeta")
    largest_line_load: Array = shown("N/mm", "maximum over the face width", label="line load")
    in_class: Array = shown("%", "samples per class")
    below: Array = shown("%", "fraction of samples below")
    interactions: float = shown("", "share of the variance due to interactions of deviations")


#: Outcomes that are drawn and whose influences are reported.
_TOLD = (
    "te_peak_to_peak", "te_harmonic_1", "face_load_factor", "driver_root_tension", "driven_root_tension",
    "hertz_pressure",
)  # fmt: skip
#: Deviations that the picture of influences has, and classes of a histogram.
_MOST, _LEAST_CLASSES, _MOST_CLASSES = 12, 8, 60


@dataclass(frozen=True)
class OneDeviation:
    """A deviation that was drawn.

    Parameters
    ----------
    quantity : str
        Of `Deviations`.
    name, meaning : str
        Of its column.
    drawn : ndarray, shape (D,)
    """

    quantity: str
    name: str
    meaning: str
    drawn: Array


@dataclass(frozen=True)
class Sampled:
    """An outcome of all draws with the relief in one state.

    Parameters
    ----------
    name, state : str
    values : ndarray, shape (D,)
        NaN without a result.
    nominal : float
        Without deviations.
    missed : float or None
        What the roll positions of a draw miss in the nominal pair; None where it is not known.
    """

    name: str
    state: str
    values: Array
    nominal: float
    missed: float | None

    @property
    def label(self) -> str:
        """What it is."""
        return declared(DrawOutcomes, self.name).label

    @property
    def meaning(self) -> str:
        """Where it is taken."""
        return declared(DrawOutcomes, self.name).meaning

    @property
    def column(self) -> str:
        """Name of its column."""
        return f"{self.name}{ENDING[self.state]}"

    @cached_property
    def percentiles(self) -> list[Percentile]:
        """At `PERCENTS`."""
        from fegear.design.robustness.draw_statistics import percentile

        return [percentile(self.values, percent) for percent in PERCENTS]

    def error(self, which: int) -> float | None:
        """Of a percentile: half its 95 % interval and what positions miss; None without an interval."""
        found = self.percentiles[which]
        half = 0.5 * (found.high - found.low) + (self.missed or 0.0)
        return half if np.isfinite(half) else None

    @property
    def rising(self) -> Array:
        """Those with a result, in their order."""
        return np.sort(self.values[np.isfinite(self.values)])

    @property
    def below(self) -> Array:
        """Share of the draws below each of these."""
        count = self.rising.size
        return (np.arange(count) + 0.5) / count

    @cached_property
    def histogram(self) -> tuple[Array, Array]:
        """Middles and shares of classes as wide as Freedman and Diaconis ask for."""
        values = self.rising
        low, high = float(values.min()), float(values.max())
        if high - low <= 1e-9 * abs(high):
            low, high = low - 5e-4 * abs(low), high + 5e-4 * abs(high)
        quartiles = np.quantile(values, [0.25, 0.75])
        width = 2.0 * float(quartiles[1] - quartiles[0]) / np.cbrt(values.size)
        classes = int(np.clip(np.ceil((high - low) / width) if width > 0.0 else 1, _LEAST_CLASSES, _MOST_CLASSES))
        counts, edges = np.histogram(values, classes, (low, high))
        return 0.5 * (edges[1:] + edges[:-1]), counts / values.size


@dataclass(frozen=True)
class Ranked:
    """Deviations in the order in which they matter for one outcome; the last matters most."""

    label: str
    names: tuple[str, ...]
    place: Array = shown("", "deviation")
    share: Array = shown("%", "share of the variance (single deviation)")
    rank: Array = shown("", "rank correlation")


@dataclass(frozen=True)
class TipsOfStates:
    """Tip relief of one gear in each state of relief."""

    gear: str
    amount: Array = shown("um", "amount of tip relief")
    length: Array = shown("", "length of tip relief / path of contact")


@dataclass(frozen=True)
class ToleranceShown:
    """Draws as their sheet reads them."""

    data: ToleranceData
    asked: DrawInputs

    def sampled(self, name: str, state: str = OWN) -> Sampled:
        """An outcome with the relief in one state."""
        data, column = self.data, self.data.outcomes.index(name)
        nominal = float(data.nominal[state][column])
        # Positions miss what they miss with the case's own relief; reliefs that were found are stated with it too.
        own = float(data.nominal[OWN][column])
        missed = abs(own - data.exact) if name == "te_peak_to_peak" and np.isfinite(data.exact) else None
        return Sampled(name, state, np.asarray(data.values[state][:, column]), nominal, missed)

    @cached_property
    def outcomes(self) -> dict[str, Sampled]:
        """All, with the relief of the case."""
        return {name: self.sampled(name) for name in self.data.outcomes}

    @cached_property
    def told(self) -> dict[str, Sampled]:
        """Those that are given in addition to the tables."""
        return {name: self.outcomes[name] for name in _TOLD if name in self.outcomes}

    @property
    def in_columns(self) -> dict[str, Sampled]:
        """Of every state of relief; all outcomes of the case's own."""
        found = [
            self.sampled(name, state)
            for state in self.data.values
            for name in self.data.outcomes
            if state == OWN or name in self.told
        ]
        return {one.column: one for one in found}

    @property
    def distributed(self) -> list[Sampled]:
        """Those with a picture of their distribution."""
        return [one for name, one in self.told.items() if name != "te_harmonic_1"]

    @property
    def found_reliefs(self) -> list[Sampled]:
        """Transmission error with the reliefs that were found; none where none were asked for."""
        states = () if self.data.relief is None else (NOMINAL, ROBUST)
        return [self.sampled("te_peak_to_peak", state) for state in states]

    @property
    def any_result(self) -> bool:
        """Whether any draw has one."""
        return bool(np.isfinite(self.told["te_peak_to_peak"].values).any())

    @property
    @shows("", "sample number")
    def draw(self) -> Index:
        """Shape (D,)."""
        return np.asarray(np.arange(len(self.data.deviations)))

    @property
    @shows("", "reason for missing result")
    def failure(self) -> Array | None:
        """Of each draw; None where all have a result."""
        reasons = self.data.reasons
        return np.array([reasons.get(row, "") for row in self.draw.tolist()]) if reasons else None

    @property
    @shows("", "percentile of the samples")
    def percentile(self) -> Array:
        """Those that are reported."""
        return np.array(PERCENTS)

    @cached_property
    def varied(self) -> list[OneDeviation]:
        """Deviations that differ from draw to draw; waves and phases only where a form deviation has a size."""
        form = self.data.deviations.profile_form
        return [
            one
            for one in _deviations(self.data.deviations, self.asked.gears)
            if np.ptp(one.drawn)
            and not (one.quantity in ("waves", "phase") and not form[:, MEMBERS.index(_member(one.name))].any())
        ]

    @cached_property
    def influences(self) -> dict[str, tuple[Influence, ...]]:
        """How every varied deviation goes with every told outcome."""
        from fegear.design.robustness.draw_statistics import influences

        drawn = [one.drawn for one in self.varied]
        return {name: influences(drawn, one.values) for name, one in self.told.items()}

    @property
    @shows("", "sampled deviation")
    def deviation(self) -> list[str]:
        """Their names."""
        return [one.name for one in self.varied]

    @property
    @shows("", "description")
    def meaning(self) -> list[str]:
        """What they are."""
        return [one.meaning for one in self.varied]

    @cached_property
    def together(self) -> dict[str, tuple[float, float]]:
        """Share of each told outcome's variance that deviations have together, and its error; where both are known."""
        from fegear.design.robustness.draw_statistics import together

        if not self.varied:
            return {}
        found = {name: together(self.influences[name]) for name in self.told}
        return {name: one for name, one in found.items() if np.isfinite(one[0])}

    @property
    def ranked(self) -> list[Ranked]:
        """The deviations that matter most for each told outcome."""
        found = []
        for name, one in self.told.items():
            rows = list(zip(self.varied, self.influences[name], strict=True))
            rows = sorted(rows, key=lambda row: np.nan_to_num(row[1].share))[-_MOST:]
            found.append(Ranked(
                one.label, tuple(deviation.name.replace("_", " ") for deviation, _ in rows),
                np.arange(len(rows), dtype=float), np.array([np.nan_to_num(i.share) for _, i in rows]),
                np.array([i.rank_correlation for _, i in rows]),
            ))  # fmt: skip
        return found

    @property
    @shows("", "state of both gears", name="relief")
    def states(self) -> list[str]:
        """Of the reliefs that were compared."""
        return list(self.data.values)

    def by_state(self, name: str) -> list[Sampled]:
        """An outcome with each relief."""
        return [self.sampled(name, state) for state in self.data.values]

    @property
    def tips(self) -> dict[str, TipsOfStates]:
        """Tip reliefs that were compared; none where none were asked for."""
        relief = self.data.relief
        if relief is None:
            return {}
        numbers = np.array([(np.nan,) * 4, self.data.nominal_relief, relief.numbers], dtype=float)
        return {
            member: TipsOfStates(self.asked.gears[i], numbers[:, 2 * i], numbers[:, 2 * i + 1])
            for i, member in enumerate(MEMBERS)
        }


def _member(name: str) -> str:
    return name.partition("_")[0]


def _deviations(drawn: Deviations, gears: tuple[str, str]) -> list[OneDeviation]:
    """Every deviation that was drawn."""
    found = [OneDeviation("centre_distance", "centre_distance", "deviation from nominal", drawn.centre_distance)]
    for i, member in enumerate(MEMBERS):
        of = f"of {gears[i]}"
        for quantity, name, meaning in (
            ("profile_slope", "profile_slope", f"f_Halpha {of}, positive: excess material at the tip"),
            ("profile_form", "profile_form", f"band of the profile form {of}, f_falpha"),
            ("waves", "form_waves", f"number of waves over the active profile {of}"),
            ("phase", "form_phase", f"phase of the waves at the start of contact {of}"),
            ("helix_slope", "helix_slope", f"f_Hbeta {of}, positive: less material at end II"),
        ):
            found.append(OneDeviation(quantity, f"{member}_{name}", meaning, getattr(drawn, quantity)[:, i]))
        for k in range(drawn.pitch.shape[2]):
            end, before = k // 2 + 1, k % 2 == 0
            sign, word = ("-", "before") if before else ("", "after")
            near = f"{sign}{end - 1}" if end > 1 else "0"
            meaning = f"f_p cos(alpha_t) between teeth {near} and {sign}{end} {of}"
            found.append(OneDeviation("pitch", f"{member}_pitch_{word}_{end}", meaning, drawn.pitch[:, i, k]))
    return found
