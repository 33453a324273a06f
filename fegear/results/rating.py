"""Result ``rating``: safeties against pitting and tooth breakage by ISO 6336, computed ones and AGMA 2101 beside."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.errors import RangeError
from fegear.geometry.pair import MEMBERS
from fegear.models.loaded_flanks import FLANK_EFFECTS, check_flanks_to_load
from fegear.results.drawn_rating import rating_figures
from fegear.results.gear_solution import needs_solution, solution_of
from fegear.results.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.rating_remarks import rating_remarks, shortfalls
from fegear.results.rating_tables import agma_table, factor_table, rating_values, safety_table, spectrum_table
from fegear.results.solid_solution import needs_solid_solution, solid_solution_of
from fegear.results.sources import RING

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.flank.rated import Computed
    from fegear.engine.stage import Upstream, Work
    from fegear.formulas.agma2101 import AgmaRating
    from fegear.formulas.iso6336.pair_rating import PairRating, Replacement
    from fegear.formulas.iso6336.rated import Both, Duty
    from fegear.formulas.iso6336.safety import Conditions
    from fegear.formulas.iso6336.spectrum_rating import Curves, SpectrumRating
    from fegear.models.agma_pair import AgmaInputs
    from fegear.models.rated_pair import PairToRate

#: Transverse contact ratio from which a plane pair has no point of single pair contact.
_SINGLE = 2.0
_NO_SINGLE = (
    "plane teeth with a contact ratio of 2 and more have no single pair contact, at which their root stress would be "
    'computed. Write width = "solid" for it.'
)
#: Seconds of the formulas, and of one load on computed flanks.
_FORMULAS, _FLANKS = 0.02, 1.0


@dataclass(frozen=True)
class RatingInputs:
    """What the stage reads.

    Parameters
    ----------
    asked : PairToRate
    agma : AgmaInputs or None
    computed : bool
        Whether load distribution and root stress are computed.
    said : tuple of str
        What AGMA 2101 assumes, or why there is nothing of it.
    """

    asked: PairToRate
    agma: AgmaInputs | None
    computed: bool
    said: tuple[str, ...]


@dataclass(frozen=True)
class RatingData:
    """What the stage finds.

    Parameters
    ----------
    formula : PairRating
        By ISO 6336 alone.
    curves : Curves
        S-N curves at the nominal speed.
    spectrum : SpectrumRating or None
    computed : Computed or None
    by_computed : PairRating or None
        With what was computed in the place of formulas.
    spectrum_computed : SpectrumRating or None
    agma : AgmaRating or None
    why_not : tuple of str
        Why something that was asked for is missing.
    """

    formula: PairRating
    curves: Curves
    spectrum: SpectrumRating | None
    computed: Computed | None
    by_computed: PairRating | None
    spectrum_computed: SpectrumRating | None
    agma: AgmaRating | None
    why_not: tuple[str, ...]


def _inputs(scene: Scene, name: str) -> RatingInputs:
    from fegear.models.agma_pair import agma_inputs
    from fegear.models.rated_pair import pair_to_rate

    asked = pair_to_rate(scene, name)
    beside = scene.case.rating.beside
    agma, said = agma_inputs(scene, asked) if "agma-2101" in beside else (None, ())
    return RatingInputs(asked, agma, "computed" in beside, said)


def _check(scene: Scene, name: str) -> None:
    from fegear.models.rated_pair import check_pair_to_rate

    check_pair_to_rate(scene, name)
    if "computed" in scene.case.rating.beside and _wide(scene, name):
        check_flanks_to_load(scene, name)


def _wide(scene: Scene, name: str) -> bool:
    return scene.case.pair[name].width_in(scene.pairs[name]) != "plane"


def rated(asked: PairToRate) -> Conditions:
    """Conditions of a pair with the mean-stress factors Y_M: as given, or of teeth bent to either side, of Y_S."""
    from fegear.formulas.iso6336.part3_strength import mean_stress_factor, mean_stress_ratio
    from fegear.formulas.iso6336.safety import rate_pair

    if asked.mean_stress is not None:
        own = replace(asked.conditions.duty, mean_stress=asked.mean_stress, mean_stress_static=asked.mean_stress)
        return replace(asked.conditions, duty=own)
    if not any(asked.stress_ratio):
        return asked.conditions
    correction = rate_pair(asked.conditions, given(asked))["Y_S"].values

    def factors(*, static: bool) -> Both:
        one, two = (
            mean_stress_factor(mean_stress_ratio(one.group, y_s, static=static), ratio) if ratio else 1.0
            for one, y_s, ratio in zip(asked.conditions.strength, correction, asked.stress_ratio, strict=True)
        )
        return one, two

    duty = replace(asked.conditions.duty, mean_stress=factors(static=False), mean_stress_static=factors(static=True))
    return replace(asked.conditions, duty=duty)


def given(asked: PairToRate) -> Replacement:
    """Load factors that the case gives in the place of formulas."""
    from fegear.formulas.iso6336.pair_rating import Replacement

    k_v, across = asked.given.get("K_v"), asked.given.get("K_Halpha")
    return Replacement(K_v=k_v, K_Halpha=across, K_Falpha=None if across is None else (across, across))


def _compute(inputs: RatingInputs, upstream: Upstream, _work: Work) -> RatingData:
    try:
        return _rate(inputs, upstream)
    except RangeError as error:  # a formula's own words, under the name of the pair
        raise at(f"pair.{inputs.asked.name}", error) from None


def _rate(inputs: RatingInputs, upstream: Upstream) -> RatingData:
    from fegear.formulas.iso6336.safety import rate_pair
    from fegear.formulas.iso6336.spectrum_rating import rate_spectrum, sn_curves

    asked, own = inputs.asked, given(inputs.asked)
    conditions = rated(asked)
    formula = rate_pair(conditions, own)
    levels = [(_duty(conditions, level.tangential, level.speed), level.cycles) for level in asked.levels]
    spectrum = rate_spectrum(conditions, levels, own) if levels else None
    found = by_found = spectrum_found = None
    single = asked.width != "plane" or asked.pair.contact_ratio < _SINGLE
    if inputs.computed and single:
        found, of_levels = _computed(asked, formula, spectrum, upstream)
        by_found = rate_pair(conditions, _standing(found, own))
        stands = [None if one is None else _standing(one, own) for one in of_levels]
        spectrum_found = rate_spectrum(conditions, levels, stands) if levels else None
    agma, why_not = _agma(inputs)
    reasons = [f"no rating by AGMA 2101: {why_not}"] if why_not else []
    if inputs.computed and not single:
        reasons.append(_NO_SINGLE)
    return RatingData(
        formula, sn_curves(conditions, own), spectrum, found, by_found, spectrum_found, agma, tuple(reasons)
    )  # fmt: skip


def _standing(found: Computed, own: Replacement) -> Replacement:
    """What stands in for the formulas: the computed values, and those that the case gives where nothing is computed."""
    stands = replace(found.replacement, K_v=own.K_v)
    return stands if stands.K_Halpha is not None else replace(stands, K_Halpha=own.K_Halpha, K_Falpha=own.K_Falpha)


def _duty(conditions: Conditions, tangential: float, speed: float) -> Duty | None:
    return None if tangential == 0.0 else replace(conditions.duty, tangential=tangential, speed=speed)


def _agma(inputs: RatingInputs) -> tuple[AgmaRating | None, str]:
    from fegear.formulas.agma2101 import rate

    if inputs.agma is None:
        return None, ""
    try:
        return rate(inputs.asked.pair, inputs.agma.service, inputs.agma.allowed), ""
    except RangeError as error:
        return None, str(error)


def _computed(
    asked: PairToRate, formula: PairRating, spectrum: SpectrumRating | None, upstream: Upstream
) -> tuple[Computed, list[Computed | None]]:
    """What is computed at the nominal load, and at that of every level of the spectrum; None for idle ones."""
    from fegear.contact.flank.rated import SolvedFlanks, computed_flanks, computed_plane
    from fegear.results.flank_root_stress import places_along

    members = asked.conditions.geometry.members
    ratings = [] if spectrum is None else [level.rating for level in spectrum.levels]
    if asked.width == "plane":
        known = {member: solution_of(upstream, gear) for member, gear in zip(MEMBERS, asked.gears, strict=True)}
        plane = computed_plane(asked.pair, members, known)
        return plane, [None if one is None else plane for one in ratings]
    loaded = loaded_flanks(upstream, asked.name)
    solids = {member: solid_solution_of(upstream, gear) for member, gear in zip(MEMBERS, asked.gears, strict=True)}
    solved = SolvedFlanks(
        loaded.flanks, loaded.gaps, loaded.found.known, loaded.error.coarse.known, solids, places_along(loaded),
        loaded.asked.effects.neighbour_coupling,
    )  # fmt: skip
    nominal = asked.conditions.duty.tangential
    loads = [_applied(asked, formula, nominal)]
    loads += [_applied(asked, one, of.tangential) for one, of in zip(ratings, asked.levels, strict=True) if one]
    distinct = tuple(dict.fromkeys(loads))
    found = dict(zip(distinct, computed_flanks(solved, members, distinct), strict=True))
    if asked.width == "slices":
        found = {load: _with_misses(one, asked) for load, one in found.items()}
    rest = iter(loads[1:])
    return found[loads[0]], [None if one is None else found[next(rest)] for one in ratings]


def _applied(asked: PairToRate, rating: PairRating, tangential: float) -> Both:
    """Load along the line of action and at the reference circle with K_A, K_gamma and K_v [N]."""
    duty = asked.conditions.duty
    load = tangential * duty.application_factor * duty.mesh_load_factor * rating["K_v"].value
    return load * asked.load / duty.tangential, load


def _with_misses(found: Computed, asked: PairToRate) -> Computed:
    """The same with what slices are known to miss, which no coarser solution shows."""
    from fegear.fem.solid.slice_laws import missed_by_slices

    missed = missed_by_slices(asked.pair.driver.twist)
    # Load factors follow the unevenness of the load, at most by what the compliances miss; stress follows their root.
    uneven = sum(abs(1.0 - 1.0 / (k or 1.0)) for k in (found.replacement.K_Hbeta, found.replacement.K_Halpha))
    one, other = found.bending_error
    return replace(
        found, contact_error=found.contact_error + 0.5 * missed["contact"] * uneven,
        bending_error=(one + missed["root_tension"], other + missed["root_tension"]),
    )  # fmt: skip


def _present(data: RatingData, inputs: RatingInputs) -> Outcome:
    tables = [factor_table(data, inputs.asked), safety_table(data, inputs.asked)]
    if data.agma is not None:
        tables.append(agma_table(data.agma, inputs.asked))
    if data.spectrum is not None:
        tables.append(spectrum_table(data.spectrum, inputs.asked, data.spectrum_computed))
    return Outcome(
        data, tuple(tables), rating_values(data, inputs.asked), _settings(data, inputs),
        (*shortfalls(data, inputs.asked), *inputs.asked.assumed, *inputs.said, *rating_remarks(data, inputs.asked)),
        rating_figures(data, inputs.asked),
    )  # fmt: skip


def _settings(data: RatingData, inputs: RatingInputs) -> dict[str, object]:
    settings: dict[str, object] = {"edition": inputs.asked.conditions.edition}
    if data.computed is not None and inputs.asked.width != "plane":
        settings["computed_at_load"] = data.computed.load
    return settings


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    if "computed" not in scene.case.rating.beside:
        return ()
    part = scene.case.pair[name]
    if not _wide(scene, name):
        return needs_solution(part.driver, part.driven)
    return (*needs_flanks(scene, name), *needs_solid_solution(part.driver, part.driven))


def _forecast(scene: Scene, name: str) -> Forecast:
    computed = "computed" in scene.case.rating.beside and _wide(scene, name)
    return Forecast({}, _FORMULAS + (_FLANKS if computed else 0.0))


def _cites(scene: Scene, _name: str) -> tuple[Citation, ...]:
    found = [
        Citation("iso-6336-1", "load factors K", "clauses 5 to 9"),
        Citation("iso-6336-2", "contact stress and what flanks bear"),
        Citation("iso-6336-3", "root stress and what roots bear"),
        Citation("iso-6336-5", "stress numbers of materials", "table 1"),
        Citation("iso-1328-1", "deviations by tolerance class"),
    ]
    if any(part.operation.spectrum for part in scene.case.pair.values()):
        found.append(Citation("iso-6336-6", "load spectra", "clauses 4 and 5, annex A"))
    if "agma-2101" in scene.case.rating.beside:
        found.append(Citation("agma-2101", "the same by AGMA"))
    if "computed" in scene.case.rating.beside:
        found += citing(*RING)(scene, _name)
    return tuple(found)


RATING = Stage(
    subjects=lambda scene: tuple(scene.pairs),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    needs=_needs,
    check=_check,
    effects=FLANK_EFFECTS,
    cites=_cites,
    forecast=_forecast,
)
