"""Tables, values and remarks of deviations drawn inside tolerances.

What draws inside tolerances tell in sentences: what a percentile is worth, what matters, how reliefs were found.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.printed import percent
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.pair import MEMBERS
from fegear.results.relief.tolerance_benches import (
    DrawInputs,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.base.arrays import Array
    from fegear.design.robustness.draw_statistics import Influence, Percentile
    from fegear.design.robustness.tolerance_draws import Deviations
    from fegear.design.tip_relief.robust import RobustRelief


#: How states of relief are called, and their columns' endings.
OWN, NOMINAL, ROBUST = "as in the case", "best without deviations", "best percentile"


_ENDING = {OWN: "", NOMINAL: "_nominal_best", ROBUST: "_robust_best"}


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


class Shown(NamedTuple):
    """How an outcome is shown."""

    unit: str
    label: str
    meaning: str


#: Of every outcome, by its name in `OUTCOMES` of `fegear.design.robustness.deviated_pair`, `FLANK_OUTCOMES` of
#: `deviated_flanks`.
SHOWN = {
    "te_peak_to_peak": Shown("um", "peak-to-peak transmission error", "over the base pitch with teeth 0 in mesh"),
    "te_mean": Shown("um", "mean transmission error", "over this base pitch"),
    **{
        f"te_harmonic_{n}": Shown("um", f"transmission error, harmonic {n}", "amplitude, over this base pitch")
        for n in range(1, 5)
    },
    "driver_root_tension": Shown("MPa", "root stress of the driver", "maximum of tooth 0 over the engagement"),
    "driven_root_tension": Shown("MPa", "root stress of the driven gear", "maximum of tooth 0"),
    "hertz_pressure": Shown("MPa", "Hertzian pressure", "maximum between teeth 0, smooth flanks"),
    "largest_load": Shown("N", "load on one tooth pair", "maximum on teeth 0"),
    "face_load_factor": Shown("", "face load factor K_Hbeta", "maximum / mean load over the face width"),
    "largest_line_load": Shown("N/mm", "line load", "maximum over the face width"),
}


#: Outcomes that are drawn and whose influences are reported.
_TOLD = (
    "te_peak_to_peak", "te_harmonic_1", "face_load_factor", "driver_root_tension", "driven_root_tension",
    "hertz_pressure",
)  # fmt: skip


def told(data: ToleranceData) -> tuple[str, ...]:
    """Outcomes of a pair that are given in addition to its tables."""
    return tuple(name for name in _TOLD if name in data.outcomes)


def outcome(data: ToleranceData, name: str, state: str = OWN) -> Array:
    """An outcome of all draws of a state of relief, shape (D,)."""
    return np.asarray(data.values[state][:, data.outcomes.index(name)])


def nominal(data: ToleranceData, name: str, state: str = OWN) -> float:
    """The outcome without deviations."""
    return float(data.nominal[state][data.outcomes.index(name)])


def percentiles(data: ToleranceData, name: str, state: str = OWN) -> list[Percentile]:
    """Of an outcome, at `PERCENTS`."""
    from fegear.design.robustness.draw_statistics import percentile

    values = outcome(data, name, state)
    return [percentile(values, percent) for percent in PERCENTS]


def deviation_columns(data: ToleranceData, gears: tuple[str, str]) -> Iterator[Column]:
    """Every deviation that was drawn, as columns."""
    d = data.deviations
    yield Column("centre_distance", d.centre_distance, "um", "deviation from nominal")
    for i, member in enumerate(MEMBERS):
        of = f"of {gears[i]}"
        yield Column(
            f"{member}_profile_slope",
            d.profile_slope[:, i],
            "um",
            f"f_Halpha {of}, positive: excess material at the tip",
        )
        yield Column(f"{member}_profile_form", d.profile_form[:, i], "um", f"band of the profile form {of}, f_falpha")
        yield Column(f"{member}_form_waves", d.waves[:, i], "", f"number of waves over the active profile {of}")
        yield Column(f"{member}_form_phase", d.phase[:, i], "deg", f"phase of the waves at the start of contact {of}")
        yield Column(
            f"{member}_helix_slope", d.helix_slope[:, i], "um", f"f_Hbeta {of}, positive: less material at end II"
        )
        for k in range(d.pitch.shape[2]):
            gap = -(k // 2 + 1) if k % 2 == 0 else k // 2 + 1
            end, inner = abs(gap), abs(gap) - 1
            sign = "-" if gap < 0 else ""
            names = f"{sign}{inner}" if inner else "0", f"{sign}{end}"
            word = f"{'before' if gap < 0 else 'after'}_{end}"
            yield Column(
                f"{member}_pitch_{word}",
                d.pitch[:, i, k],
                "um",
                f"f_p cos(alpha_t) between teeth {names[0]} and {names[1]} {of}",
            )


def varied(data: ToleranceData, gears: tuple[str, str]) -> list[Column]:
    """Deviations that differ from draw to draw; waves and phases only where a form deviation has a size."""
    found = []
    for column in deviation_columns(data, gears):
        if np.ptp(np.asarray(column.si, dtype=float)) == 0.0:
            continue
        member, _, what = column.name.partition("_")
        if what in ("form_waves", "form_phase"):
            form = data.deviations.profile_form[:, MEMBERS.index(member)]
            if not form.any():
                continue
        found.append(column)
    return found


def influence_table(data: ToleranceData, gears: tuple[str, str]) -> list[tuple[Column, dict[str, Influence]]]:
    """How every varied deviation goes with every told outcome."""
    from fegear.design.robustness.draw_statistics import influences

    columns = varied(data, gears)
    arrays = [np.asarray(column.si, dtype=float) for column in columns]
    by_outcome = {name: influences(arrays, outcome(data, name)) for name in told(data)}
    return [(column, {name: by_outcome[name][i] for name in told(data)}) for i, column in enumerate(columns)]


def shared_together(data: ToleranceData, gears: tuple[str, str], name: str) -> tuple[float, float]:
    """Share of an outcome's variance that deviations have together (interactions), and its standard error."""
    from fegear.design.robustness.draw_statistics import together

    return together([found[name] for _, found in influence_table(data, gears)])


def tolerance_tables(data: ToleranceData, asked: DrawInputs) -> tuple[Table, ...]:
    """Draws, percentiles, influences, and the reliefs that were compared."""
    tables = [_draws(data, asked), _percentiles(data, asked), _influences(data, asked)]
    if data.relief is not None:
        tables.append(_reliefs(data, asked))
    return tuple(tables)


def _draws(data: ToleranceData, asked: DrawInputs) -> Table:
    count = len(data.deviations)
    columns = [Column("draw", np.arange(count), "", "sample number"), *varied(data, asked.gears)]
    for state in data.values:
        columns += [
            Column(f"{name}{_ENDING[state]}", outcome(data, name, state), one.unit, f"{one.label}, relief {state}")
            for name, one in ((key, SHOWN[key]) for key in data.outcomes)
            if state == OWN or name in told(data)
        ]
    if data.reasons:
        why = np.array([data.reasons.get(row, "") for row in range(count)])
        columns.append(Column("failure", why, "", "reason for missing result"))
    return Table(f"robustness_draws_{asked.name}", tuple(columns), f"All samples of {asked.name}")


def _percentiles(data: ToleranceData, asked: DrawInputs) -> Table:
    columns = [Column("percentile", np.array(PERCENTS), "", "percentile of the samples")]
    for name, one in ((key, SHOWN[key]) for key in data.outcomes):
        found = percentiles(data, name)
        columns += [
            Column(name, np.array([p.value for p in found]), one.unit, f"{one.label}: {one.meaning}"),
            Column(f"{name}_low", np.array([p.low for p in found]), one.unit, "95 % interval by order statistics"),
            Column(f"{name}_high", np.array([p.high for p in found]), one.unit, "95 % interval by order statistics"),
        ]
    return Table(f"robustness_percentiles_{asked.name}", tuple(columns), f"Percentiles of the samples of {asked.name}")


def _influences(data: ToleranceData, asked: DrawInputs) -> Table:
    rows = influence_table(data, asked.gears)
    columns = [
        Column("deviation", np.array([column.name for column, _ in rows]), "", "sampled deviation"),
        Column("meaning", np.array([column.meaning for column, _ in rows]), "", "description"),
    ]
    for name in told(data):
        label = SHOWN[name].label
        columns += [
            Column(
                f"{name}_rank", np.array([found[name].rank_correlation for _, found in rows]), "",
                f"rank correlation with {label}",
            ),
            Column(
                f"{name}_share", np.array([found[name].share for _, found in rows]), "",
                f"share of the variance of {label} by this deviation only; values around zero: none",
            ),
            Column(
                f"{name}_share_error", np.array([found[name].error for _, found in rows]), "",
                f"standard error of {name}_share",
            ),
        ]  # fmt: skip
    return Table(f"robustness_influences_{asked.name}", tuple(columns), f"Ranking of the deviations of {asked.name}")


def _reliefs(data: ToleranceData, asked: DrawInputs) -> Table:
    states = list(data.values)
    relief, part = data.relief, asked.part.reliefs
    if relief is None or part is None:
        raise AssertionError("a table of reliefs without any")
    numbers = [(np.nan,) * 4, data.nominal_relief, relief.numbers]
    columns = [Column("relief", np.array(states), "", "state of both gears")]
    for i, member in enumerate(MEMBERS):
        of = f"tip relief of {asked.gears[i]}"
        columns += [
            Column(f"{member}_amount", np.array([n[2 * i] for n in numbers]), "um", f"{of} ({part.shape})"),
            Column(f"{member}_length", np.array([n[2 * i + 1] for n in numbers]), "", f"{of} / path of contact"),
        ]
    for name in told(data):
        one = SHOWN[name]
        columns.append(
            Column(
                f"{name}_nominal", np.array([nominal(data, name, s) for s in states]), one.unit, "without deviations"
            )
        )
        found = [percentiles(data, name, s) for s in states]
        columns += [
            Column(f"{name}_{percent:g}", np.array([f[k].value for f in found]), one.unit, f"percentile {percent:g}")
            for k, percent in enumerate(PERCENTS)
        ]
    return Table(f"robustness_reliefs_{asked.name}", tuple(columns), f"Tip reliefs of {asked.name} over the samples")


def _position_error(data: ToleranceData, name: str) -> float | None:
    """What the roll positions of a draw miss in the nominal pair; None where it is not known."""
    known = name == "te_peak_to_peak" and np.isfinite(data.exact)
    return abs(nominal(data, name) - data.exact) if known else None


def tolerance_values(data: ToleranceData, asked: DrawInputs) -> tuple[Value, ...]:
    """Nominal and percentiles of what is told, half their 95 % intervals and what positions miss as errors; reliefs."""
    name, values = asked.name, []
    for key in told(data):
        one, error = SHOWN[key], _position_error(data, key)
        values.append(
            Value(f"{name}.{key}_nominal", nominal(data, key), one.unit, error, f"{one.label}, no deviations")
        )
        for p in percentiles(data, key)[1:]:
            half = 0.5 * (p.high - p.low) + (error or 0.0)
            values.append(
                Value(
                    f"{name}.{key}_{p.percent:g}", p.value, one.unit, half if np.isfinite(half) else None,
                    f"{one.label}, percentile {p.percent:g} of the samples",
                )
            )  # fmt: skip
    for key in told(data) if varied(data, asked.gears) else ():
        share, error = shared_together(data, asked.gears, key)
        if np.isfinite(share):
            values.append(
                Value(
                    f"{name}.{key}_interactions", share, "", error,
                    f"{SHOWN[key].label}: share of the variance due to interactions of deviations",
                )
            )  # fmt: skip
    if data.relief is not None:
        for state in (NOMINAL, ROBUST):
            p = percentiles(data, "te_peak_to_peak", state)[-1]
            error = 0.5 * (p.high - p.low) + (_position_error(data, "te_peak_to_peak") or 0.0)
            values.append(
                Value(
                    f"{name}.te_peak_to_peak_{p.percent:g}{_ENDING[state]}", p.value, "um", error,
                    f"percentile {p.percent:g}, tip reliefs {state}",
                )
            )  # fmt: skip
        for i, member in enumerate(MEMBERS):
            gear = asked.gears[i]
            values += [
                Value(f"{name}.{member}.robust_amount", data.relief.numbers[2 * i], "um", None, f"at the tip, {gear}"),
                Value(
                    f"{name}.{member}.robust_length", data.relief.numbers[2 * i + 1], "", None,
                    f"length of this relief of {gear} / path of contact",
                ),
            ]  # fmt: skip
    return tuple(values)


def tolerance_remarks(data: ToleranceData, asked: DrawInputs) -> tuple[str, ...]:
    """What a percentile is worth here, what matters most, how the relief was found, and what is left out."""
    name, part = asked.name, asked.part
    p = percentiles(data, "te_peak_to_peak")[-1]
    spread = (
        "tolerance = 3 standard deviations, truncated"
        if part.distribution == "normal" else "uniform over the tolerance"
    )  # fmt: skip
    told = (
        f"Pair {name}: {part.draws} draws ({part.sequence}, seed {part.seed}; {part.distribution}, {spread}). "
        "Profile deviations are identical on all teeth of a gear, pitch deviations are individual. Peak-to-peak "
        f"transmission error, {p.percent:g}th percentile: {p.value * 1e6:.4g} um (95 % confidence interval "
        f"{p.low * 1e6:.4g} to {p.high * 1e6:.4g} um); without deviations "
        f"{nominal(data, 'te_peak_to_peak') * 1e6:.4g} um."
    )
    found = [told, *asked.untold]
    if asked.own_spacing:
        found.append(f"Pair {name}: spacing_errors of its gears are not used (pitch deviations are sampled).")
    if data.reasons:
        first = min(data.reasons)
        found.append(
            f"Pair {name}: {len(data.reasons)} of {part.draws} samples have no result and are ignored, the first "
            f"(sample {first}): {data.reasons[first]}"
        )
    if data.relief is not None and part.reliefs is not None:
        found.append(_held_against_nominal(data, name, part.reliefs.percentile))
    return tuple(found)


def leading_told(data: ToleranceData, gears: tuple[str, str]) -> str:
    """Which deviations alone explain most of the variance of the peak-to-peak transmission error."""
    key = "te_peak_to_peak"

    def share(row: tuple[Column, dict[str, Influence]]) -> float:
        return float(np.nan_to_num(row[1][key].share))

    rows = influence_table(data, gears)
    leading = [row for row in sorted(rows, key=share, reverse=True) if row[1][key].resolved][:3]
    if not leading:
        return " No variance shares of the peak-to-peak transmission error resolved with so few samples."
    shares = ", ".join(
        f"{row[0].name.replace('_', ' ')} {percent(share(row), whole=True)} +- {percent(row[1][key].error, whole=True)}"
        for row in leading
    )
    rest, error = shared_together(data, gears, key)
    return (
        f" Variance shares of the peak-to-peak transmission error: {shares}; interactions "
        f"{percent(rest, whole=True)} +- {percent(error, whole=True)}."
    )


def search_told(data: ToleranceData, asked: DrawInputs) -> str:
    """How the relief was found that is best in a percentile."""
    from fegear.design.tip_relief.robust import LED, SCREENING

    r = data.relief
    if r is None:
        return ""
    return (
        f" Search with linear contact laws: all {r.candidates} combinations of a grid over {min(SCREENING, r.draws)} "
        f"samples, the best tenth over {r.draws}, the best {LED} and the nominal optimum refined; difference from "
        f"exact load sharing at most {r.quick_error * 1e6:.2g} um. Result over these samples {r.left * 1e6:.4g} um, "
        f"nominal optimum {r.nominal_left * 1e6:.4g} um; curves from {asked.part.draws} other samples."
    )


def _held_against_nominal(data: ToleranceData, name: str, percent: float) -> str:
    """Whether the relief that was found over some draws is better over others, and how sure that is."""
    from fegear.design.robustness.draw_statistics import sure_of_less

    robust, other = (outcome(data, "te_peak_to_peak", state) for state in (ROBUST, NOMINAL))
    here, there, sure = sure_of_less(robust, other, percent)
    verdict = (
        f"Pair {name}: percentile {percent:g} over independent samples is {here * 1e6:.4g} um with the tip reliefs "
        f"optimised for it, {there * 1e6:.4g} um with the nominal optimum"
    )
    if here < there:
        return f"{verdict}; it is lower in {sure * 100.0:.0f} % of resampled sets."
    return f"{verdict}: no significant difference (or increase robustness.reliefs.draws)."
