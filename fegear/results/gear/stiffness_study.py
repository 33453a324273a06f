"""Stage ``stiffness-study``: how far stiffness formulas are off finite elements, over random pairs of gears."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import exceeding
from fegear.base.printed import percent
from fegear.base.shown import shown, shows
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import CLOSED_FORM_COMPLIANCES, RING
from fegear.results.gear.formula_names import COMPLIANCES
from fegear.results.gear.root_stress_spread import SomeLoads, spread, spread_chart, spread_limits
from fegear.results.gear.root_stress_study import StudyInputs, check_study, study_inputs

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.compared.stiffness_study import PairOfStudy
    from fegear.contact.plane.fe_compliance import SolvedTeeth
    from fegear.engine.figure.figure import Figure
    from fegear.engine.value import Value
    from fegear.geometry.gear import Gear

#: Line load where the case names none [N/m].
USUAL_LINE_LOAD = 100e3
#: Seconds of a pair from an atlas, and of one that is solved.
_KNOWN, _SOLVED = 0.2, 2.0
#: What is compared, in words; formulas by the names that people use.
_QUANTITIES = {"single_stiffness": "stiffness c' of one tooth pair", "mesh_stiffness": "mean mesh stiffness c_gamma"}
_FORMULAS = {"iso-6336-1": "ISO 6336-1", **COMPLIANCES}
#: Errors of quantiles above this share are noted, as those of any value.
_DRAWN = 0.01


@dataclass(frozen=True, slots=True)
class StiffnessStudyInputs:
    """Gears that are drawn, and the load of their pairs [N/m]; `solve` is whether atlases are passed over."""

    study: StudyInputs
    line_load: float
    solve: bool
    atlases: str


@dataclass(frozen=True)
class StiffnessRows:
    """A row for each pair, quantity and formula."""

    pair: NDArray[np.intp] = shown("", "number of the pair", table="study")
    driver_teeth: NDArray[np.intp] = shown("", "number of teeth, driver", table="study")
    driven_teeth: NDArray[np.intp] = shown("", "number of teeth, driven", table="study")
    driver_shift: Array = shown("", "profile shift coefficient, driver", table="study")
    driven_shift: Array = shown("", "profile shift coefficient, driven", table="study")
    contact_ratio: Array = shown("", "contact ratio", table="study")
    quantity: NDArray[np.str_] = shown("", "single_stiffness or mesh_stiffness", table="study")
    formula: NDArray[np.str_] = shown("", "name of the formula", table="study")
    stiffness: Array = shown("N/(mm.um)", "stiffness per face width by the formula", table="study")
    stiffness_fe: Array = shown("N/(mm.um)", "stiffness per face width, FE (secant)", table="study")
    stiffness_fe_error: Array = shown("N/(mm.um)", "estimated error of FE", table="study")
    ratio_to_fe: Array = shown("", "formula / FE", table="study")
    reason: NDArray[np.str_] = shown("", "reason if the formula gives no value", table="study")


@dataclass(frozen=True)
class OfStiffness:
    """One formula for one quantity over all pairs that it suits: ratios to finite elements, shape (N,)."""

    quantity: str = shown("", "single_stiffness or mesh_stiffness", table="quantiles")
    formula: str = shown("", "name of the formula", table="quantiles")
    pairs: int = shown("", "pairs for which the formula gives a value", table="quantiles")
    percentile_5: float = shown("", "formula / FE, 5th percentile", table="quantiles")
    median: float = shown("", "formula / FE, median", table="quantiles")
    percentile_95: float = shown("", "formula / FE, 95th percentile", table="quantiles")
    lowest: float = shown("", "formula / FE, minimum", table="quantiles")
    highest: float = shown("", "formula / FE, maximum", table="quantiles")
    median_error: float = shown("", "standard error of the median, from sampling and FE", table="quantiles")
    percentile_5_error: float = shown("", "standard error of the 5th percentile", table="quantiles")
    percentile_95_error: float = shown("", "standard error of the 95th percentile", table="quantiles")

    @classmethod
    def of(cls, quantity: str, formula: str, ratio: Array, fe_error: float) -> OfStiffness:
        """Of known ratios; `fe_error` is the relative error of the finite elements."""
        low, middle, high = (float(np.quantile(ratio, share)) for share in (0.05, 0.5, 0.95))
        errors = (_quantile_error(ratio, share, fe_error) for share in (0.5, 0.05, 0.95))
        return cls(quantity, formula, ratio.size, low, middle, high, float(ratio.min()), float(ratio.max()), *errors)


def _quantile_error(ratio: Array, share: float, fe_error: float) -> float:
    """Half of what lies between the quantiles one standard error of their share apart; and of the reference."""
    off = math.sqrt(share * (1.0 - share) / ratio.size)
    ends = np.quantile(ratio, np.clip([share - off, share + off], 0.0, 1.0))
    return math.hypot(0.5 * float(ends[1] - ends[0]), fe_error * float(np.quantile(ratio, share)))


@dataclass(frozen=True)
class ShownStiffness:
    """What is shown of a study."""

    rows: StiffnessRows
    pairs: int

    @property
    @shows("%", "estimated error of the finite elements at 95 % of the pairs", name="fe_error")
    def fe_error(self) -> float:
        """95th percentile, relative."""
        return float(np.quantile(self.rows.stiffness_fe_error / self.rows.stiffness_fe, 0.95))

    def ratios(self, quantity: str, formula: str) -> Array:
        """Of one formula for one quantity, all pairs."""
        of = (self.rows.quantity == quantity) & (self.rows.formula == formula)
        return self.rows.ratio_to_fe[of]

    @cached_property
    def quantiles(self) -> tuple[OfStiffness, ...]:
        """Formula by formula, those that suit any pair."""
        found = []
        for quantity in _QUANTITIES:
            for formula in dict.fromkeys(map(str, self.rows.formula)):
                ratio = self.ratios(quantity, formula)
                if (known := ratio[np.isfinite(ratio)]).size:
                    found.append(OfStiffness.of(quantity, formula, known, self.fe_error))
        return tuple(found)

    @property
    def loads(self) -> list[SomeLoads]:
        """Cumulative distributions of each quantity."""
        return [
            SomeLoads(words.replace("c_gamma", "c_γ"), {
                _FORMULAS.get(name, name): spread(self.ratios(quantity, name))
                for name in dict.fromkeys(map(str, self.rows.formula))
            })
            for quantity, words in _QUANTITIES.items()
        ]  # fmt: skip


def _check(scene: Scene, subject: str) -> None:
    check_study(scene, subject, "stiffness-study")
    if scene.case.study is not None and scene.case.study.samples is None:
        raise InputError("study.samples", "(not given)", "is required for stiffness-study", "set samples (pairs)")


def _inputs(scene: Scene, subject: str) -> StiffnessStudyInputs:
    from fegear.atlas.shipped import fingerprint

    accuracy, load = scene.case.accuracy, scene.case.stiffness.load
    solve = "source" in accuracy.model_fields_set and accuracy.source == "solve"
    return StiffnessStudyInputs(study_inputs(scene, subject), load or USUAL_LINE_LOAD, solve, fingerprint())


def _compute(asked: StiffnessStudyInputs, _upstream: Upstream, work: Work) -> tuple[PairOfStudy, ...]:
    from fegear.atlas.shipped import atlas_of
    from fegear.contact.compared.stiffness_study import compare_stiffness, drawn_pairs
    from fegear.fem.plane.solution import solve_gear

    def solved(gear: Gear) -> SolvedTeeth:
        known = None if asked.solve else atlas_of(gear)
        return solve_gear(gear, asked.study.settings, cache=work.cache) if known is None else known.gear(gear)

    study = asked.study.study
    pairs = drawn_pairs(asked.study.base, study.bounds, study.samples or 0, study.seed)
    found = []
    for pair in pairs:
        found.append(compare_stiffness(pair, solved, asked.line_load))
        work.progress(len(found) / len(pairs))
    return tuple(found)


def _shown(found: tuple[PairOfStudy, ...], _asked: StiffnessStudyInputs) -> ShownStiffness:
    rows = []
    for number, one in enumerate(found, start=1):
        pair = one.pair
        gears = (
            number, pair.driver.teeth, pair.driven.teeth, pair.driver.tooth.profile_shift,
            pair.driven.tooth.profile_shift, pair.contact_ratio,
        )  # fmt: skip
        rows += [
            (*gears, a.quantity, a.formula, a.value, a.fe, a.fe_error, a.value / a.fe, a.reason) for a in one.answers
        ]
    return ShownStiffness(StiffnessRows(*(np.array(column) for column in zip(*rows, strict=True))), len(found))


def _values(seen: Seen) -> Iterator[Value]:
    """Median and ends of the middle nine tenths of each formula."""
    for one in seen.data.quantiles:
        at = replace(seen, one=one)
        what = f"{_FORMULAS.get(one.formula, one.formula)} / FE, {_QUANTITIES[one.quantity]}"
        for key, words in (("median", "median"), ("percentile_5", "5th percentile"), ("percentile_95", "95th")):
            yield from Number(
                key, f"{key}_error", "", owner=f"{one.quantity}.{one.formula}",
                meaning=f"{what}: {words}" if key != "percentile_95" else f"{what}: 95th percentile",
            ).values(at)  # fmt: skip


def _closest(seen: Seen) -> Iterator[str]:
    """Of each quantity all formulas, the closest in the median first."""
    for quantity, words in _QUANTITIES.items():
        known = [one for one in seen.data.quantiles if one.quantity == quantity]
        known.sort(key=lambda one: abs(math.log(one.median)))
        said = ", ".join(
            f"{_FORMULAS.get(one.formula, one.formula)} {one.median:.3f} ({one.percentile_5:.3f} to "
            f"{one.percentile_95:.3f})" for one in known
        )  # fmt: skip
        yield (
            f"{words[0].upper()}{words[1:]} by formula / FE, {seen.data.pairs} random pairs, median (5 % to 95 % of "
            f"the pairs): {said}."
        )


def _spread(seen: Seen) -> tuple[Figure, ...]:
    off = seen.data.fe_error
    chart = spread_chart(
        "stiffness_spread", "Distribution of the errors of the stiffness formulas",
        f"{seen.data.pairs} random pairs at {seen.asked.line_load * 1e-3:.6g} N/mm. Right of 1: stiffness "
        f"overestimated. Estimated error of the finite elements (grey band about 1): {percent(off)} at 95 % of the "
        "pairs.",
        "stiffness, formula / FE", lambda _seen: off, lambda _seen: spread_limits(seen.data.rows.ratio_to_fe),
    )  # fmt: skip
    return tuple(chart.figures(seen))


def _remarks(seen: Seen) -> tuple[str, ...]:
    silent = [
        f"Study of stiffness: {_FORMULAS.get(name, name)} gives no value for "
        f"{percent(float(np.isnan(ratio).mean()), whole=True)} of the pairs (column reason)."
        for name in dict.fromkeys(map(str, seen.data.rows.formula))
        if np.isnan(ratio := seen.data.ratios("single_stiffness", name)).any()
    ]
    about = (
        "Study of stiffness: perfect flanks, secant stiffness per face width along the line of action, contact on the "
        f"path of contact only, {seen.asked.line_load * 1e-3:.6g} N/mm; mates have the rack of the first gear, teeth "
        "and profile shift of another drawn one, no backlash. FE: full gears with coupling of neighbouring teeth."
    )
    return about, *silent, *_few_pairs(seen.data)


def _few_pairs(data: ShownStiffness) -> tuple[str, ...]:
    """What to do about quantiles that hang on the draw, where a finer solution of the teeth would not help."""
    off = [
        error / ratio
        for one in data.quantiles
        for error, ratio in (
            (one.median_error, one.median), (one.percentile_5_error, one.percentile_5),
            (one.percentile_95_error, one.percentile_95),
        )
    ]  # fmt: skip
    worst = max(off, default=0.0)
    if worst <= max(_DRAWN, 2.0 * data.fe_error):
        return ()
    return (
        exceeding(
            f"Study of stiffness: estimated errors of medians and percentiles, up to {percent(worst)}, are due to the "
            f"number of pairs ({data.pairs}; finite elements {percent(data.fe_error)}); increase study.samples "
            "to reduce them."
        ),
    )


_SHEET = Sheet(
    of=_shown,
    name=lambda _asked: "",
    tables=(
        Rows("stiffness_study_quantiles", "Quantiles of formula / FE", (Every("quantiles"),), of="quantiles"),
        Rows("stiffness_study", "Stiffness by formulas and FE of each random pair", (Every("study"),), of="rows"),
    ),
    values=(_values, Number("fe_error", owner="")),
    figures=(_spread,),
    answer=Answer(_closest, figure="stiffness_spread"),
    remarks=(_remarks,),
    sharper_by="increase study.samples",
    settings={"pairs": "pairs"},
)  # fmt: skip


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """Pairs from an atlas, or with both gears solved."""
    count = (scene.case.study.samples if scene.case.study else None) or 0
    each = _SOLVED if scene.case.accuracy.source == "solve" else _KNOWN
    return Forecast({"pairs": count}, forecasts.LIBRARIES + each * count)


STIFFNESS_STUDY = Stage(
    subjects=lambda scene: ("",) if scene.spur_gears else (),
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(
        *(citation for group in CLOSED_FORM_COMPLIANCES.values() for citation in group),
        Citation("iso-6336-1", "single tooth stiffness c' and mesh stiffness c_gamma_alpha", "clause 9, method B"),
        *RING,
    ),
    forecast=_forecast,
)
