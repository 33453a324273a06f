"""Makes a loaded pair of plane teeth of its spec and its gears: sources of compliance, their errors, the engagement."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeGuard

from fegear.base.errors import InputError
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import FiniteElementCompliance, SolvedTeeth, finite_element_compliance
from fegear.contact.plane.flanks import as_specified, with_flanks
from fegear.contact.plane.loaded_pair import LoadedPair
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.shifted_compliance import neighbours_shifted_by_error, shifted_by_error
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.solution_cache import SolutionCache
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.plane.compliance import GearCompliance
    from fegear.contact.plane.odd_compliance import OddCompliance
    from fegear.fem.plane.odd.odd_gear import OddGearInfluence

    Sources = tuple[GearCompliance, GearCompliance]
    Solved = SolvedTeeth | OddGearInfluence


def load_plane(
    spec: PairSpec,
    gears: Sequence[Solved | GearCompliance] = (),
    *,
    cache: SolutionCache | None = None,
    estimates: bool = True,
) -> LoadedPair:
    """Make a loaded pair of plane teeth; see `fegear.contact.load.load`."""
    at_rest = (
        engagement_at_rest(spec.at_rest, *gears)
        if cache is None
        else cache.call(engagement_at_rest, spec.at_rest, *gears).value
    )
    compliance = replace(at_rest.compliance, nominal_load=spec.nominal)
    engagement = with_flanks(spec, replace(at_rest, compliance=compliance))
    first, second = compliance.driver, compliance.driven
    shifted = shifted_sources(first, second, coupling=spec.neighbour_coupling) if estimates else ()
    others = tuple(
        replace(engagement, compliance=replace(compliance, driver=driver, driven=driven)) for driver, driven in shifted
    )
    described = tuple(dict.fromkeys(source.describe() for source in (first, second)))
    return LoadedPair(engagement, others, spec, described, exact=estimates)


def engagement_at_rest(spec: PairSpec, *gears: Solved | GearCompliance) -> Engagement:
    """The engagement of perfect flanks, the same one for every load and relief: it keeps what these do not change."""
    sources = compliance_sources(spec, gears)
    return as_specified(spec, Engagement(PairCompliance(spec.pair, *sources, nominal_load=spec.nominal)))


def compliance_sources(spec: PairSpec, gears: Sequence[Solved | GearCompliance]) -> Sources:
    """The sources of driver and driven: those that are given, a table's, a formula's, or of solved gears.

    Raises
    ------
    InputError
        If a table or a formula does not fit the gears, or gears that are to be solved are not.
    """
    if gears and not _is_solved(gears[0]):
        first, second = gears
        return first, second  # type: ignore[return-value]  # both are sources where the first is
    pair = spec.pair
    try:
        if spec.table is not None:
            from fegear.contact.plane.table_compliance import table_sources  # late: as what no solved gear needs

            return table_sources(pair, *spec.table)
        if spec.compliance != "fe":
            from fegear.contact.plane.closed_form_compliance import closed_form_compliance  # late: all formulas

            driver, driven = (closed_form_compliance(pair.gear(member), spec.compliance) for member in MEMBERS)
            return driver, driven
    except InputError as error:
        raise error.under(spec.prefix) if error.key.startswith("compliance") else error from None
    if len(gears) != len(MEMBERS):
        raise InputError(
            "gears", f"{len(gears)} given", "must be both solved gears, driver and driven",
            "give solve_gear(pair.driver) and solve_gear(pair.driven), or a formula as compliance",
        )  # fmt: skip
    solved = {id(gear): _tabulated(gear) for gear in gears if _is_solved(gear)}
    first, second = (solved[id(gear)] for gear in gears)
    return first, second


def _is_solved(gear: Solved | GearCompliance) -> TypeGuard[Solved]:
    if isinstance(gear, SolvedTeeth):
        return True
    from fegear.fem.plane.odd.odd_gear import OddGearInfluence  # late: cracks, which most gears do not have

    return isinstance(gear, OddGearInfluence)


def _tabulated(gear: Solved) -> FiniteElementCompliance | OddCompliance:
    if isinstance(gear, SolvedTeeth):
        return finite_element_compliance(gear)
    from fegear.contact.plane.odd_compliance import odd_compliance  # late: as above

    return odd_compliance(gear)


def shifted_sources(first: GearCompliance, second: GearCompliance, *, coupling: bool) -> tuple[Sources, ...]:
    """The pairs of sources that are off by their estimated errors; none where the sources state none."""
    if not (_states_error(first) and _states_error(second)):
        return ()
    own1 = _shifted(first)
    own2 = own1 if second is first else _shifted(second)
    shifted: list[Sources] = [(own1, second), (first, own2)]
    if coupling:
        beside1 = _neighbours_shifted(first)
        shifted.append((beside1, beside1 if second is first else _neighbours_shifted(second)))
    return tuple(shifted)


def _states_error(source: GearCompliance) -> TypeGuard[FiniteElementCompliance | OddCompliance]:
    return getattr(source, "states_error", False)


def _shifted(source: FiniteElementCompliance | OddCompliance) -> GearCompliance:
    if isinstance(source, FiniteElementCompliance):
        return shifted_by_error(source)
    from fegear.contact.plane.odd_compliance import odd_shifted_by_error  # late: as above

    return odd_shifted_by_error(source)


def _neighbours_shifted(source: FiniteElementCompliance | OddCompliance) -> GearCompliance:
    if isinstance(source, FiniteElementCompliance):
        return neighbours_shifted_by_error(source)
    from fegear.contact.plane.odd_compliance import odd_neighbours_shifted_by_error  # late: as above

    return odd_neighbours_shifted_by_error(source)
