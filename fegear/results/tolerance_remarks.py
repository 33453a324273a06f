"""What draws inside tolerances tell in sentences: what a percentile is worth, what matters, how reliefs were found."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.results.tolerance_tables import (
    NOMINAL,
    ROBUST,
    influence_table,
    nominal,
    outcome,
    percentiles,
    shared_together,
)

if TYPE_CHECKING:
    from fegear.design.draw_statistics import Influence
    from fegear.engine.outcome import Column
    from fegear.results.tolerance_robustness import ToleranceData
    from fegear.results.tolerance_tables import PairDrawn


def tolerance_remarks(data: ToleranceData, asked: PairDrawn) -> tuple[str, ...]:
    """What a percentile is worth here, what matters most, how the relief was found, and what is left out."""
    name, part = asked.name, asked.part
    p = percentiles(data, "te_peak_to_peak")[-1]
    spread = (
        "the tolerance is three standard deviations and the end"
        if part.distribution == "normal" else "even over the tolerance"
    )  # fmt: skip
    told = (
        f"Pair {name}: {part.draws} draws ({part.sequence}, seed {part.seed}; {part.distribution}, {spread}). Profile "
        "deviations are alike on all teeth of a gear, pitch deviations differ from tooth to tooth. Percentile "
        f"{p.percent:g} of the peak-to-peak transmission error is {p.value * 1e6:.4g} um, with 95 % confidence "
        f"{p.low * 1e6:.4g} to {p.high * 1e6:.4g} um, {nominal(data, 'te_peak_to_peak') * 1e6:.4g} um without "
        "deviations."
    )
    found = [told, *asked.untold]
    if asked.own_spacing:
        found.append(
            f"Pair {name}: spacing_errors of its gears do not count in the draws, which have pitches of their own."
        )
    if data.reasons:
        first = min(data.reasons)
        found.append(
            f"Pair {name}: {len(data.reasons)} of {part.draws} draws have no result and do not count, the first (draw "
            f"{first}): {data.reasons[first]}"
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
        return " Of the peak-to-peak transmission error no share is resolved by so few draws."
    shares = ", ".join(
        f"{row[0].name.replace('_', ' ')} {share(row):.0%} +- {row[1][key].error:.0%}" for row in leading
    )
    rest, error = shared_together(data, gears, key)
    return f" Of the peak-to-peak transmission error: {shares}; together (interactions) {rest:.0%} +- {error:.0%}."


def search_told(data: ToleranceData, asked: PairDrawn) -> str:
    """How the relief was found that is best in a percentile."""
    from fegear.design.robust_relief import LED, SCREENING

    r = data.relief
    if r is None:
        return ""
    return (
        f" Those were found with straight contact laws by trying all {r.candidates} combinations of a grid over "
        f"{min(SCREENING, r.draws)} draws, the best tenth over {r.draws}, and leading the best {LED} and the nominal "
        f"optimum on; at their ends exact sharing differs by at most {r.quick_error * 1e6:.2g} um. Over these draws "
        f"they leave {r.left * 1e6:.4g} um, the nominal optimum {r.nominal_left * 1e6:.4g} um; the curves are "
        f"those of {asked.part.draws} others."
    )


def _held_against_nominal(data: ToleranceData, name: str, percent: float) -> str:
    """Whether the relief that was found over some draws is better over others, and how sure that is."""
    from fegear.design.draw_statistics import sure_of_less

    robust, other = (outcome(data, "te_peak_to_peak", state) for state in (ROBUST, NOMINAL))
    here, there, sure = sure_of_less(robust, other, percent)
    verdict = (
        f"Pair {name}: percentile {percent:g} over draws that the search has not seen is {here * 1e6:.4g} um with the "
        f"tip reliefs that are best in it, {there * 1e6:.4g} um with the nominal optimum"
    )
    if here < there:
        return f"{verdict}; it is less in {sure:.0%} of resampled sets of draws."
    return f"{verdict}, which serves as well (or raise robustness.reliefs.draws)."
