"""Result ``rating``: safeties against pitting and tooth breakage by ISO 6336, computed ones and AGMA 2101 beside."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError, RangeError
from fegear.case.built.pair_checks import check_wide_pair
from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.results.forecasts import RING
from fegear.results.gear.solved_gear import needs_solid_solution, needs_solution, solid_solution_of, solution_of
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.rating.rating_data import RatingData, RatingInputs
from fegear.results.rating.rating_sheet import RATING_SHEET
from fegear.results.rating.shared_load import (
    NotRated,
    bent_ratio,
    bent_so,
    inputs_with_shares,
    needs_bending,
    needs_shares,
    rated_pairs,
)

if TYPE_CHECKING:
    from fegear.case.built.rated_pair import PairToRate
    from fegear.case.reading import Scene
    from fegear.contact.wide.rated import Computed
    from fegear.formulas.agma.agma2101 import AgmaRating
    from fegear.formulas.iso6336.conditions import Conditions, PairRating, Replacement
    from fegear.formulas.iso6336.rated import Both, Duty
    from fegear.formulas.iso6336.safety import SpectrumRating


#: Transverse contact ratio from which a plane pair has no point of single pair contact.
_SINGLE = 2.0


_NO_SINGLE = (
    "no single pair contact for root stress in the plane (2D) model with contact ratio 2 and above. Set width = "
    '"solid".'
)


#: Seconds of the formulas, and of one load on computed flanks.
_FORMULAS, _FLANKS = 0.02, 1.0


def _inputs(scene: Scene, name: str) -> RatingInputs:
    from fegear.case.built.agma_pair import agma_inputs
    from fegear.case.built.rated_pair import pair_to_rate

    asked = pair_to_rate(scene, name)
    beside = scene.case.rating.beside
    agma, said = agma_inputs(scene, asked) if "agma-2101" in beside else (None, ())
    return RatingInputs(asked, agma, "computed" in beside, said, len(rated_pairs(scene)) == 1)


def _check(scene: Scene, name: str) -> None:
    from fegear.case.built.rated_pair import check_formulas, check_pair_to_rate

    check_pair_to_rate(scene, name)
    if "computed" in scene.case.rating.beside and _wide(scene, name):
        check_wide_pair(scene, name)
    if len(rated_pairs(scene)) == 1:
        check_formulas(scene, name)


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
    from fegear.formulas.iso6336.conditions import Replacement

    k_v, across = asked.given.get("K_v"), asked.given.get("K_Halpha")
    return Replacement(K_v=k_v, K_Halpha=across, K_Falpha=None if across is None else (across, across))


def _compute(inputs: RatingInputs, upstream: Upstream, _work: Work) -> RatingData | NotRated:
    try:
        return _rate(inputs, upstream)
    except InputError as error:  # a formula's own words, under the name of the pair
        named = at(f"pair.{inputs.asked.name}", error)
        if inputs.alone:
            raise named from None
        return NotRated(f"Pair {inputs.asked.name} not rated: {named}")


def _rate(inputs: RatingInputs, upstream: Upstream) -> RatingData:
    from fegear.formulas.iso6336.safety import rate_pair, rate_spectrum, sn_curves

    inputs = inputs_with_shares(inputs, upstream)
    asked, own = inputs.asked, given(inputs.asked)
    conditions = rated(asked)
    formula = rate_pair(conditions, own)
    levels = [(_duty(conditions, level.tangential, level.speed), level.cycles) for level in asked.levels]
    spectrum = found = by_found = spectrum_found = bent = None
    reasons = []
    try:
        spectrum = rate_spectrum(conditions, levels, own) if levels else None
    except RangeError as error:  # a level outside of a formula's range leaves the rating at the nominal load
        reasons.append(f"rating with load spectrum not possible: {error}")
        asked, levels = replace(asked, levels=()), []
    single = asked.width != "plane" or asked.pair.contact_ratio < _SINGLE
    if inputs.computed and single:
        found, of_levels = _computed(asked, formula, spectrum, upstream)
        bent = bent_ratio(asked, upstream)
        of_found = conditions if bent is None else rated(bent_so(asked, bent))
        by_found = rate_pair(of_found, _standing(found, own))
        stands = [None if one is None else _standing(one, own) for one in of_levels]
        spectrum_found = rate_spectrum(of_found, levels, stands) if levels else None
    agma, why_not = _agma(inputs)
    reasons += [f"rating to AGMA 2101 not possible: {why_not}"] if why_not else []
    if inputs.computed and not single:
        reasons.append(_NO_SINGLE)
    return RatingData(
        formula, sn_curves(conditions, own), spectrum, found, by_found, spectrum_found, agma, tuple(reasons), bent
    )  # fmt: skip


def _standing(found: Computed, own: Replacement) -> Replacement:
    """What stands in for the formulas: the computed values, and those that the case gives where nothing is computed."""
    stands = replace(found.replacement, K_v=own.K_v)
    return stands if stands.K_Halpha is not None else replace(stands, K_Halpha=own.K_Halpha, K_Falpha=own.K_Falpha)


def _duty(conditions: Conditions, tangential: float, speed: float) -> Duty | None:
    return None if tangential == 0.0 else replace(conditions.duty, tangential=tangential, speed=speed)


def _agma(inputs: RatingInputs) -> tuple[AgmaRating | None, str]:
    from fegear.formulas.agma.agma2101 import rate

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
    from fegear.contact.wide.rated import SolvedFlanks, computed_flanks, computed_plane

    members = asked.conditions.geometry.members
    ratings = [] if spectrum is None else [level.rating for level in spectrum.levels]
    if asked.width == "plane":
        known = {member: solution_of(upstream, gear) for member, gear in zip(MEMBERS, asked.gears, strict=True)}
        plane = computed_plane(asked.pair, members, known)
        return plane, [None if one is None else plane for one in ratings]
    loaded = loaded_flanks(upstream, asked.name)
    solids = {member: solid_solution_of(upstream, gear) for member, gear in zip(MEMBERS, asked.gears, strict=True)}
    solved = SolvedFlanks(
        loaded.flanks, loaded.gaps, loaded.found.known, loaded.error.coarse.known, solids, loaded.places_along,
        loaded.coupling,
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


def _present(data: RatingData | NotRated, inputs: RatingInputs) -> Outcome:
    return Outcome(data, remarks=(data.remark,)) if isinstance(data, NotRated) else RATING_SHEET.present(data, inputs)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    shares = needs_shares(scene, name)
    if "computed" not in scene.case.rating.beside:
        return shares
    part = scene.case.pair[name]
    if not _wide(scene, name):
        return (*shares, *needs_bending(scene, name), *needs_solution(part.driver, part.driven))
    return (*shares, *needs_flanks(scene, name), *needs_solid_solution(part.driver, part.driven))


def _forecast(scene: Scene, name: str) -> Forecast:
    computed = "computed" in scene.case.rating.beside and _wide(scene, name)
    return Forecast({}, _FORMULAS + (_FLANKS if computed else 0.0))


def _cites(scene: Scene, name: str) -> tuple[Citation, ...]:
    part = scene.case.pair.get(name)
    old = part is not None and part.iso_6336.edition == 2006
    found = [
        Citation("iso-6336-1", "load factors K", "clauses 5 to 9"),
        Citation("iso-6336-2-2006" if old else "iso-6336-2", "contact stress and permissible contact stress"),
        Citation("iso-6336-3" if old else "iso-6336-3-2019", "tooth root stress and permissible tooth root stress"),
        Citation("iso-6336-5", "stress numbers of materials", "table 1"),
        Citation("iso-1328-1", "tolerances by class"),
    ]
    if any(part.operation.spectrum for part in scene.case.pair.values()):
        found.append(Citation("iso-6336-6", "load spectra", "clauses 4 and 5, annex A"))
    if "agma-2101" in scene.case.rating.beside:
        found.append(Citation("agma-2101", "geometry factors of AGMA"))
    if "computed" in scene.case.rating.beside:
        found += citing(*RING)(scene, name)
    return tuple(found)


RATING = Stage(
    subjects=rated_pairs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    needs=_needs,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
