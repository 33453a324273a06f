"""What draws inside tolerances tell in sentences: what a percentile is worth, what matters, how reliefs were found."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import neglecting
from fegear.base.printed import percent
from fegear.results.relief.tolerance_data import NOMINAL, ROBUST, OneDeviation, ToleranceShown

if TYPE_CHECKING:
    from fegear.design.robustness.draw_statistics import Influence
    from fegear.engine.sheet.seen import Seen


def tolerance_remarks(seen: Seen) -> tuple[str, ...]:
    """What a percentile is worth here, what matters most, how the relief was found, and what is left out."""
    found: ToleranceShown = seen.data
    data, asked = found.data, found.asked
    name, part, te = asked.name, asked.part, found.told["te_peak_to_peak"]
    p = te.percentiles[-1]
    spread = (
        "tolerance = 3 standard deviations, truncated"
        if part.distribution == "normal" else "uniform over the tolerance"
    )  # fmt: skip
    told = (
        f"Pair {name}: {part.draws} draws ({part.sequence}, seed {part.seed}; {part.distribution}, {spread}). "
        "Profile deviations are identical on all teeth of a gear, pitch deviations are individual. Peak-to-peak "
        f"transmission error, {p.percent:g}th percentile: {p.value * 1e6:.4g} um (95 % confidence interval "
        f"{p.low * 1e6:.4g} to {p.high * 1e6:.4g} um); without deviations "
        f"{te.nominal * 1e6:.4g} um."
    )
    remarks = [told, *asked.untold]
    if asked.own_spacing:
        remarks.append(
            neglecting(f"Pair {name}: spacing_errors of its gears are not used (pitch deviations are sampled).")
        )
    if data.reasons:
        first = min(data.reasons)
        remarks.append(
            f"Pair {name}: {len(data.reasons)} of {part.draws} samples have no result and are ignored, the first "
            f"(sample {first}): {data.reasons[first]}"
        )
    if data.relief is not None and part.reliefs is not None:
        remarks.append(_held_against_nominal(found, part.reliefs.percentile))
    return tuple(remarks)


def leading_told(found: ToleranceShown) -> str:
    """Which deviations alone explain most of the variance of the peak-to-peak transmission error."""
    key = "te_peak_to_peak"

    def share(row: tuple[OneDeviation, Influence]) -> float:
        return float(np.nan_to_num(row[1].share))

    rows = zip(found.varied, found.influences[key], strict=True)
    leading = [row for row in sorted(rows, key=share, reverse=True) if row[1].resolved][:3]
    if not leading:
        return " No variance shares of the peak-to-peak transmission error resolved with so few samples."
    shares = ", ".join(
        f"{row[0].name.replace('_', ' ')} {percent(share(row), whole=True)} +- {percent(row[1].error, whole=True)}"
        for row in leading
    )
    rest, error = found.together[key]
    return (
        f" Variance shares of the peak-to-peak transmission error: {shares}; interactions "
        f"{percent(rest, whole=True)} +- {percent(error, whole=True)}."
    )


def search_told(found: ToleranceShown) -> str:
    """How the relief was found that is best in a percentile."""
    from fegear.design.tip_relief.robust import LED, SCREENING

    r = found.data.relief
    if r is None:
        return ""
    return (
        f" Search with linear contact laws: all {r.candidates} combinations of a grid over {min(SCREENING, r.draws)} "
        f"samples, the best tenth over {r.draws}, the best {LED} and the nominal optimum refined; difference from "
        f"exact load sharing at most {r.quick_error * 1e6:.2g} um. Result over these samples {r.left * 1e6:.4g} um, "
        f"nominal optimum {r.nominal_left * 1e6:.4g} um; curves from {found.asked.part.draws} other samples."
    )


def _held_against_nominal(found: ToleranceShown, percent: float) -> str:
    """Whether the relief that was found over some draws is better over others, and how sure that is."""
    from fegear.design.robustness.draw_statistics import sure_of_less

    robust, other = (found.sampled("te_peak_to_peak", state).values for state in (ROBUST, NOMINAL))
    here, there, sure = sure_of_less(robust, other, percent)
    verdict = (
        f"Pair {found.asked.name}: percentile {percent:g} over independent samples is {here * 1e6:.4g} um with the "
        f"tip reliefs optimised for it, {there * 1e6:.4g} um with the nominal optimum"
    )
    if here < there:
        return f"{verdict}; it is lower in {sure * 100.0:.0f} % of bootstrap samples."
    return f"{verdict}: no significant difference (or increase robustness.reliefs.draws)."
