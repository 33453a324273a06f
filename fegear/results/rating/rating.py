"""Result ``rating``: safeties against pitting and tooth breakage by ISO 6336, computed ones and AGMA 2101 beside.

Safeties of a pair for its gear data, where a rating was asked for.

Remarks of the result ``rating``: what falls short first, then what is doubtful.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError, RangeError
from fegear.base.printed import percent
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
from fegear.results.rating.rating_tables import (
    agma_table,
    factor_table,
    rating_figures,
    rating_values,
    remark_of,
    safety_table,
    spectrum_table,
)
from fegear.results.rating.shared_load import (
    NotRated,
    bending_said,
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
    from fegear.formulas.iso6336.conditions import Conditions, Factor, PairRating, Replacement
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
    if isinstance(data, NotRated):
        return Outcome(data, remarks=(data.remark,))
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


#: K_v above which the load is a trifle beside what flank deviations excite: teeth part and meet again.
_SHAKEN = 10.0


#: How near to an axial contact ratio of 1 the jump of AGMA's J is reported, and from which size.
_NEAR_ONE, _WORTH_SAYING = 0.1, 0.05


#: Which S-N line the flanks have under a spectrum.
_SPECTRUM_LINE = {
    "part-2": (
        "Pair {name}: pitting under the load spectrum uses the S-N curve of ISO 6336-2, in which Z_L Z_v Z_R apply "
        "in full only at the reference life; ISO 6336-6 annex C applies them at all load cycles (lower if they are "
        'below 1): operation.spectrum_line = "annex-c".'
    ),
    "annex-c": "Pair {name}: pitting under the load spectrum uses the S-N curve of the example in annex C of ISO "
    "6336-6.",
}


def shortfalls(data: RatingData, asked: PairToRate) -> tuple[str, ...]:
    """What a reader must know before anything else: safeties below the required ones, and a load of no account."""
    found, told = data.spectrum, []
    if found is not None:
        told = [
            f"Pair {asked.name}: {what} of gear {gear} exceed the static strength at one level of the spectrum."
            for what, sums in (("flanks", found.contact_damage), ("roots", found.bending_damage))
            for member, gear in zip(MEMBERS, asked.gears, strict=True)
            if math.isinf(sums[asked.of(member)])
        ]
    contact = data.formula.contact_safety if found is None else found.contact_safety
    bending = data.formula.bending_safety if found is None else found.bending_safety
    under = "" if found is None else " under the load spectrum"
    for member, gear in zip(MEMBERS, asked.gears, strict=True):
        for symbol, safety, least in zip(("S_H", "S_F"), (contact, bending), asked.conditions.required, strict=True):
            value = safety[asked.of(member)]
            if value < least:
                told.append(
                    f"Pair {asked.name}: {symbol} = {value:.4g} of gear {gear} ({member}){under} is below the "
                    f"minimum {least:g}."
                )
    levels = [] if found is None else [one.rating for one in found.levels if one.rating is not None]
    most = max(one["K_v"].value for one in (levels or [data.formula]))
    if most > _SHAKEN and "K_v" not in asked.given:
        told.append(
            f"Pair {asked.name}: K_v = {most:.4g} of ISO 6336-1 is above {_SHAKEN:g}: dynamic forces from flank "
            "deviations are many times the load (loss of contact), outside the scope of the formula; check the load "
            "or set operation.dynamic_factor."
        )
    return tuple(told)


def rating_remarks(data: RatingData, asked: PairToRate) -> tuple[str, ...]:
    """What lies outside a range, and what the computed safeties count."""
    told = [f"Pair {asked.name}: {remark_of(one, asked)}." for one in data.formula.factors if _shown(one, asked)]
    told += [f"Pair {asked.name}: {reason}" for reason in data.why_not]
    told += _recalled(data, asked)
    if data.spectrum is not None:
        told.append(_SPECTRUM_LINE[asked.conditions.spectrum_line].format(name=asked.name))
    if data.agma is not None:
        told += _beside_the_jump(asked)
    if data.computed is None:
        return tuple(dict.fromkeys(told))
    if asked.width == "plane":
        told.append(
            f"Pair {asked.name}: FE root stress (2D) at the outer point of single pair contact replaces Y_F Y_S Y_B; "
            'load factors from the formulas. Set width = "solid" for an FE load distribution.'
        )
        if data.bent is not None and data.by_computed is not None:
            told.append(bending_said(asked.name, data.bent, data.by_computed["Y_M"].values))
    else:
        load, pressure = data.computed.load, data.computed.pressure * 1e-6
        told.append(
            f"Pair {asked.name}: load distribution and root stress computed by FE at {load:.5g} N along the line of "
            f"action (including K_A, K_gamma, K_v), maximum pressure {pressure:.4g} MPa. The FE root stress replaces "
            "Y_F Y_S Y_beta Y_B Y_DT K_Fbeta K_Falpha."
        )
        told += _aligned(data, asked)
    return tuple(dict.fromkeys(told))


def _recalled(data: RatingData, asked: PairToRate) -> list[str]:
    """Say which numbers of a rating are those of no printed source, beside those that a factor remarks on itself."""
    if asked.mean_stress is not None or not any(asked.stress_ratio):
        return []
    values = ", ".join(f"{value:.3g}" for value in data.formula["Y_M"].values)
    told = (
        f"Pair {asked.name}: Y_M = {values} (pinion, wheel): mean stress ratios M of ISO 6336-3 annex B are not "
        "verified against a printed source, except 0.7 for idlers (operation.mean_stress_factor)."
    )
    return [told]


def _beside_the_jump(asked: PairToRate) -> list[str]:
    """Say where J of AGMA 908 jumps near the pair's axial contact ratio."""
    from fegear.formulas.agma.agma908 import jump_of_bending_factor

    ratio = asked.pair.overlap_ratio
    if ratio == 0.0 or abs(ratio - 1.0) > _NEAR_ONE:
        return []
    try:
        jumps = {
            gear: jump_of_bending_factor(asked.pair, member) - 1.0
            for member, gear in zip(MEMBERS, asked.gears, strict=True)
        }
    except RangeError:  # a face that narrow or wide is none of its pairs
        return []
    if max(abs(jump) for jump in jumps.values()) < _WORTH_SAYING:
        return []
    sizes = ", ".join(f"{percent(jump, signed=True)} (gear {gear})" for gear, jump in jumps.items())
    told = (
        f"Pair {asked.name}: axial contact ratio {ratio:.3f}: at 1, J of AGMA 908 and S_F change abruptly by {sizes} "
        "with increasing face width (load at the tip with C_h and K_psi above, single tooth contact with C_psi "
        "below)."
    )
    return [told]


def _aligned(data: RatingData, asked: PairToRate) -> list[str]:
    """Say what misalignment the standard counts and the computed flanks do not have."""
    counted = [one.value for one in data.formula.factors if one.symbol == "F_betay"]
    if asked.misaligned or not counted:
        return []
    gap = f"{counted[0] * 1e6:.3g} um"
    told = (
        f"Pair {asked.name}: the FE load distribution has no misalignment, ISO 6336 uses F_betay = {gap}. For the "
        f'same input set pair.{asked.name}.line_error = {{ over_face = "{gap}" }} and effects.misalignment = true.'
    )
    return [told]


def _shown(one: Factor, asked: PairToRate) -> bool:
    """Whether a factor's remark is the reader's: not that the case gave it."""
    return bool(one.remark) and remark_of(one, asked) == one.remark and "as specified" not in one.remark


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
