"""Stage ``root-stress-study``: a sweep of teeth that shows where each formula is high, low or breaks down."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import InputError
from fegear.base.printed import figures, percent
from fegear.base.shown import shown, shows
from fegear.case.built.tooth_influence import mesh_settings, seconds_of_gear
from fegear.engine.citation import citing
from fegear.engine.declared import drawn
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import RING, ROOT_STRESS_FORMULAS
from fegear.results.gear.crosscheck_rows import HIGH
from fegear.results.gear.formula_names import ROOT_FORMULAS, formula_called
from fegear.results.gear.root_stress_spread import WORDS, fe_error, sentences, spread_figure
from fegear.results.gear.root_stress_varied import ratios_figure, tiles_figure

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.case.studies import StudyPart
    from fegear.contact.compared.root_stress_study import VariantStress
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Gear


#: Steps and end of the histogram.
_BIN, _WIDEST = 0.05, 2.0
#: A formula without a value at this share of the points: one that an answer mentions, and one that it puts last.
_SELDOM, _OFTEN = 0.005, 0.05


#: Of the time of a gear with its neighbours that of one without.
_EACH = 0.5


def _gear(scene: Scene) -> str:
    study = scene.case.study
    return (study.gear if study else None) or next(iter(scene.spur_gears))


def _study(scene: Scene, result: str = "root-stress-study") -> StudyPart:
    if scene.case.study is None:
        raise InputError("study", "(not given)", f"is required for {result}", "add a table [study]")
    return scene.case.study


def check_study(scene: Scene, _subject: str, result: str = "root-stress-study") -> None:
    """Refuse a case without one gear to vary, or with keys of it that a study does not use."""
    study = _study(scene, result)
    if study.gear is None and len(scene.spur_gears) > 1:
        raise InputError(
            "study.gear", "(not given)", "must specify the gear to vary", f"one of {', '.join(scene.spur_gears)}"
        )
    name = _gear(scene)
    for key in ("tip_diameter", "tooth_mesh"):
        if getattr(scene.case.gear[name], key) is not None:
            raise InputError(f"gear.{name}.{key}", "(given)", "is not used in a study of many gears", f"remove {key}")


@dataclass(frozen=True)
class StudyInputs:
    """What the study depends on.

    Parameters
    ----------
    base : Gear
        The gear that is varied.
    study : StudyPart
    settings : MeshSettings
    """

    base: Gear
    study: StudyPart
    settings: MeshSettings


def study_inputs(scene: Scene, _subject: str) -> StudyInputs:
    """As `Stage.inputs`."""
    return StudyInputs(scene.gears[_gear(scene)], _study(scene), mesh_settings(scene.case.accuracy))


def _compute(asked: StudyInputs, _upstream: Upstream, work: Work) -> tuple[VariantStress, ...]:
    from fegear.contact.compared.population import drawn_gears
    from fegear.contact.compared.root_stress_study import of_population, root_stress_study, variants

    study, tooth = asked.study, asked.base.external_tooth
    if study.samples:
        population = of_population(drawn_gears(asked.base, study.bounds, study.samples, study.seed))
        settings, progress, cache = asked.settings, work.progress, work.cache
        return tuple(root_stress_study(population, (), settings, progress, cache, estimate_error=True))
    gears = variants(
        asked.base,
        study.teeth or [tooth.teeth],
        study.profile_shift or [tooth.profile_shift],
        study.rack_tip_radius or [tooth.rack.tip_radius],
    )
    return tuple(
        root_stress_study(gears, study.load_position, asked.settings, work.progress, work.cache, estimate_error=True)
    )


@dataclass(frozen=True)
class StudyRows:
    """A row for each gear, formula and load position; None what is known of drawn gears only."""

    teeth: NDArray[np.intp] = shown("", "number of teeth", table="study")
    profile_shift: Array = shown("", "profile shift coefficient", table="study")
    rack_tip_radius: Array = shown("", "of the basic rack, in modules", table="study")
    load_position: Array = shown(
        "", "load position: fraction of roll angle from start (0) to end (1) of the involute", table="study"
    )
    load_radius: Array = shown("mm", "radius of the load", table="study")
    formula: NDArray[np.str_] = shown("", "name of the formula", table="study")
    stress: Array = shown("MPa.mm/N", "root stress per line load, formula", table="study")
    stress_fe: Array = shown("MPa.mm/N", "root stress per line load, FE", table="study")
    ratio_to_fe: Array = shown("", "formula / FE", table="study")
    place_angle: Array = shown("deg", "angle of the fillet tangent at the critical section, formula", table="study")
    place_angle_fe: Array = shown("deg", "angle of the fillet tangent at the maximum, FE", table="study")
    verdict: NDArray[np.str_] = shown("", "high, low, within 5 %, or no result", table="study")
    reason: NDArray[np.str_] = field(kw_only=True)
    rack_dedendum: Array | None = shown("", "of the basic rack, in modules", default=None)
    pressure_angle: Array | None = shown("deg", "of the basic rack", default=None)
    stress_fe_error: Array | None = shown("MPa.mm/N", "estimated error of FE", default=None)

    def varied(self) -> dict[str, NDArray[Any]]:
        """Columns over which ratios are drawn, none of which has a unit."""
        keys = ("teeth", "profile_shift", "rack_tip_radius", "load_position", "formula", "ratio_to_fe")
        return {key: getattr(self, key) for key in keys}

    def read(self) -> dict[str, NDArray[Any]]:
        """What is said of drawn gears, in the units in which it is read; without what is known of these only."""
        keys = (*WORDS, "ratio_to_fe", "stress_fe", "stress_fe_error")
        keys = tuple(key for key in keys if getattr(self, key) is not None)
        return {"formula": self.formula, **{key: drawn(self, key) for key in keys}}


def _rows(found: tuple[VariantStress, ...], names: tuple[str, ...], module: float, *, of_drawn: bool) -> StudyRows:
    from fegear.contact.compared.root_stress_study import verdict

    rows = []
    for one in found:
        v, dedendum, pressure_angle = one.variant, math.nan, math.nan
        if v.gear is not None:
            dedendum, pressure_angle = (rack := v.gear.external_tooth.rack).dedendum, rack.pressure_angle
        for name in names:
            answers = one.answers.get(name)
            for i, position in enumerate(one.position):
                stress, angle, reason = math.nan, math.nan, v.reason
                if answers:
                    stress, angle, reason = answers.stress[i], answers.tangent_angle[i], answers.reasons[i]
                ratio = stress / one.fe[i]
                rows.append((
                    v.teeth, v.profile_shift, v.rack_tip_radius, position, one.radius[i], name, stress / module,
                    one.fe[i] / module, ratio, angle, one.fe_angle[i], verdict(ratio), reason, dedendum,
                    pressure_angle, one.fe_error[i] / module,
                ))  # fmt: skip
    *columns, reasons, dedendums, angles, errors = (np.array(column) for column in zip(*rows, strict=True))
    of_racks = {"rack_dedendum": dedendums, "pressure_angle": angles} if of_drawn else {}
    more = {"reason": reasons, "stress_fe_error": errors, **of_racks}
    return StudyRows(*columns, **more)


@dataclass(frozen=True)
class Share:
    """How often a formula has one verdict."""

    name: str
    formula: str
    error: float
    share: float = shown("", "fraction of all points")


@dataclass(frozen=True)
class OfFormula:
    """How far one formula is off over the points of the study.

    Parameters
    ----------
    shares : mapping of str to Share
        By verdict.
    edge, count : ndarray
        Steps of the histogram, and points in each.
    """

    shares: dict[str, Share]
    ratio: Array = shown("", "formula / FE")
    edge: Array = shown("", "formula / FE, start of the step")
    count: NDArray[np.intp] = shown("", "points")

    def _of_known(self, answer: Callable[[Array], float]) -> float | None:
        known = self.ratio[np.isfinite(self.ratio)]
        return float(answer(known)) if known.size else None

    @property
    @shows("", "minimum formula / FE in the study")
    def lowest_ratio(self) -> float | None:
        """None where it answers nowhere."""
        return self._of_known(np.min)

    @property
    @shows("", "median formula / FE in the study")
    def median_ratio(self) -> float | None:
        """None where it answers nowhere."""
        return self._of_known(np.median)

    @property
    @shows("", "maximum formula / FE in the study")
    def highest_ratio(self) -> float | None:
        """None where it answers nowhere."""
        return self._of_known(np.max)


@dataclass(frozen=True)
class ShownStudy:
    """What is shown of a study, by formula; `drawn` is whether its gears were drawn from a box."""

    rows: StudyRows
    formulas: dict[str, OfFormula]
    drawn: bool
    gears: int

    @property
    def answered(self) -> bool:
        """Whether any formula gives anything."""
        return bool(np.isfinite(self.rows.ratio_to_fe).any())


def _shown(found: tuple[VariantStress, ...], asked: StudyInputs) -> ShownStudy:
    from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES

    names, of_drawn = tuple(ROOT_STRESS_SOURCES), asked.study.samples is not None
    rows = _rows(found, names, asked.base.module, of_drawn=of_drawn)
    of = {name: _of_formula(rows, name, of_drawn=of_drawn) for name in names}
    return ShownStudy(rows, of, of_drawn, len(found))


def _of_formula(rows: StudyRows, name: str, *, of_drawn: bool) -> OfFormula:
    """Shares of drawn gears have a standard error."""
    from fegear.contact.compared.population import LOADS, share_error

    own, shares = rows.formula == name, {}
    for key in ("high", "low", "within 5 %", "breaks down"):
        hits = rows.verdict[own] == key
        error = share_error(hits.reshape(-1, LOADS)) if of_drawn else 0.0
        shares[key] = Share(key.replace(" %", "_percent").replace(" ", "_"), name, error, float(np.mean(hits)))
    ratio = rows.ratio_to_fe[own]
    edges = np.arange(0.0, _WIDEST + 0.5 * _BIN, _BIN)
    count, _ = np.histogram(ratio[np.isfinite(ratio)], edges)
    return OfFormula(shares, ratio, edges, np.append(count, 0))


def _binned(ratio: Array) -> tuple[float, float]:
    """Axis about 1 and all known ratios, in whole steps of the histogram with an empty one at either end."""
    known = np.clip(ratio[np.isfinite(ratio)], 0.0, _WIDEST)
    low, high = min(1.0, *known), max(1.0, *known)
    return max(0.0, _BIN * (math.floor(low / _BIN) - 1)), min(_WIDEST, _BIN * (math.ceil(high / _BIN) + 1))


def _about(seen: Seen) -> str:
    """What all gears have in common, and how exact the finite elements are."""
    base, off = seen.asked.base, fe_error(seen.data.rows.read())
    return (
        f"The bore follows the number of teeth: {base.bore_radius / base.root_radius:.4g} of the root radius in all "
        f"gears. Estimated error of the finite elements: {percent(off)} at 95 % of the points."
    )


def _ratios(seen: Seen) -> tuple[Figure, ...]:
    """A tile for every gear, load position and formula, and all ratios over what is varied; none of drawn gears."""
    if seen.data.drawn:
        return ()
    table, about = seen.data.rows.varied(), _about(seen)
    return tiles_figure(table, about), ratios_figure(table, about)


def _spread(seen: Seen) -> tuple[Figure, ...]:
    return (spread_figure(seen.data.rows.read()),) if seen.data.drawn else ()


def _closest(seen: Seen) -> Iterator[str]:
    """How far every formula is off the finite elements, the closest first; one sentence for each half of the flank.

    Formulas rate loads at the tip or at the outer point of single pair contact: near the form circle they are off by
    far more, and a range over all loads would be one of loads that no rating has. Those that often give no value come
    last: their medians are of the gears that they suit.
    """
    rows = seen.data.rows
    high = rows.load_position >= HIGH
    for half, loads in (("upper", high), ("lower", ~high)):
        found = []
        for name in seen.data.formulas:
            ratio = rows.ratio_to_fe[(rows.formula == name) & loads]
            known = ratio[np.isfinite(ratio)]
            if known.size:
                silent, middle = 1.0 - known.size / ratio.size, float(np.median(known))
                found.append((silent > _OFTEN, abs(math.log(middle)), _ratio_said(name, known, middle, silent)))
        if found:
            said = ", ".join(words for _, _, words in sorted(found))
            yield (
                f"Root stress by formula over FE for loads on the {half} half of the flank, median (minimum to "
                f"maximum): {said}."
            )


def _ratio_said(name: str, known: Array, middle: float, silent: float) -> str:
    """One formula over finite elements where it gives a value, and at how many points it gives none."""
    ends = f"{figures(float(known.min()))} to {figures(float(known.max()))}"
    none = f"; no value at {percent(silent, whole=True)} of the points" if silent >= _SELDOM else ""
    return f"{ROOT_FORMULAS.get(name, name)} {figures(middle)} ({ends}{none})"


def _remarks(seen: Seen) -> tuple[str, ...]:
    from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES

    base = seen.asked.base
    about = (
        "Study of root stress: one tooth of the full gear, load normal to the flank, no friction; FE: maximum "
        "tangential stress in the fillet of the loaded flank, including radial compression; ratio of bore to root "
        f"radius {base.bore_radius / base.root_radius:.4g} in all gears. A stress per line load is the same in plane "
        "stress and plane strain."
    )
    drawn_gears = sentences(seen.data.rows.read()) if seen.data.drawn else ()
    return (
        about,
        *drawn_gears,
        *(f"{ROOT_FORMULAS.get(s.name, s.name)} ({s.citation}): {s.compared}." for s in ROOT_STRESS_SOURCES.values()),
    )


def _answers(_seen: Seen) -> type:
    from fegear.contact.compared.crosscheck import RootStressAnswers

    return RootStressAnswers


_SHEET = Sheet(
    of=_shown,
    name=lambda _asked: "",
    tables=(
        Rows(
            "root_stress_study", "Over- and underestimation of each root-stress formula",
            (
                Every("study"), Cell("reasons", "rows.reason", of=_answers), "rack_dedendum", "pressure_angle",
                "stress_fe_error",
            ),
            of="rows",
        ),
    ),
    values=(
        Each(
            "formulas",
            *(Number(f"{one}_ratio", owner="{key}") for one in ("lowest", "median", "highest")),
            Each(
                "shares",
                Number("share", "error", owner="{one.formula}", ending="_{one.name}", further=": {key}"),
            ),
        ),
    ),
    figures=(
        _ratios,
        Chart(
            "root_stress_histogram", "Distribution of formula / FE",
            f"Distribution of the ratio formula / FE over the points of the study, in steps of {_BIN:g}.",
            (
                Over(
                    lambda seen: Axis("formula / FE", limits=_binned(seen.data.rows.ratio_to_fe)),
                    (
                        Line(
                            "count", x="edge", each=Family("formulas", formula_called, most=None),
                            look={"dash": "steps", "markers": False},
                        ),
                    ),
                    Axis("points", zero=True), lambda _seen: (Mark("x", 1.0, "agreement"),),
                ),
            ),
            when=lambda seen: not seen.data.drawn and seen.data.answered,
        ),
        _spread,
    ),
    answer=Answer(
        _closest, figure=lambda seen: "root_stress_spread" if seen.data.drawn else "root_stress_histogram"
    ),
    remarks=(_remarks,),
    sharper_by="increase study.samples",
    settings=lambda seen: {**asdict(seen.asked.settings), "gears": seen.data.gears},
)  # fmt: skip


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """One gear without neighbours for each combination."""
    study, settings = scene.case.study, mesh_settings(scene.case.accuracy)
    if study is None:
        return Forecast()
    count = math.prod(len(values or [0]) for values in (study.teeth, study.profile_shift, study.rack_tip_radius))
    count = study.samples or count
    seconds = forecasts.LIBRARIES + _EACH * count * seconds_of_gear(settings)
    return Forecast({"gears": count, **asdict(settings)}, seconds)


ROOT_STRESS_STUDY = Stage(
    subjects=lambda scene: ("",) if scene.spur_gears else (),
    inputs=study_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_study,
    cites=citing(*ROOT_STRESS_FORMULAS, *RING),
    forecast=_forecast,
)
