"""Stiffness formulas over pairs of drawn gears: one tooth pair, and the mean over the mesh, against finite elements.

Both sides have perfect flanks, contact on the path only, the same line load and the same definition (secant, along the
line of action, per face width). Formulas know a tooth by itself: what they miss of the mesh is the coupling through the
gear bodies, which the finite elements of the whole gear have.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.contact.compared.crosscheck import (
    mean_mesh_stiffness,
    mean_stiffness_of,
    pair_compliance_answers,
    pair_reference,
    positions_on_flanks,
)
from fegear.contact.compared.population import drawn_gears, tooth_of
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.fe_compliance import SolvedTeeth
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
from fegear.formulas.outcome import Outcome, attempt
from fegear.formulas.sources import SOURCES
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair

#: What is compared: the stiffest position of one tooth pair, and the mean of all pairs over a base pitch.
SINGLE, MESH = "single_stiffness", "mesh_stiffness"
#: The standard among the formulas.
ISO = "iso-6336-1"
#: Contact ratios of pairs that mesh, with one or two tooth pairs in contact.
_CONTACT_RATIO = (1.05, 2.0)
#: Gears that are drawn for one of a pair: of those that do not mesh others are taken.
_SPARE = 4
#: Contacts over the path of which the stiffest is taken.
_POSITIONS = 25


@dataclass(frozen=True, slots=True)
class StiffnessAnswer:
    """One formula of one pair beside finite elements, per face width.

    Parameters
    ----------
    quantity : {"single_stiffness", "mesh_stiffness"}
    formula : str
    value : float
        NaN exactly where `reason` has words [Pa].
    fe, fe_error : float
        Finite elements and their estimated error [Pa].
    """

    quantity: str
    formula: str
    value: float
    fe: float
    fe_error: float
    reason: str = ""


@dataclass(frozen=True, slots=True)
class PairOfStudy:
    """A pair that was drawn, and what formulas and finite elements say of it."""

    pair: GearPair
    answers: tuple[StiffnessAnswer, ...]


def drawn_pairs(
    base: Gear, bounds: Mapping[str, tuple[float, float]], samples: int, seed: int = 0
) -> tuple[GearPair, ...]:
    """Draw pairs without backlash, evenly over the part of a box in which gears can be cut and mesh.

    The first gear of each pair is one of `drawn_gears`, its mate has the rack of the first, and teeth and profile shift
    of the gear that was drawn next.

    Parameters
    ----------
    base : Gear
    bounds : mapping of str to (float, float)
        As those of `drawn_gears`.
    samples : int
    seed : int

    Raises
    ------
    InputError
        If hardly any draw gives a pair that meshes with a contact ratio between 1.05 and 2 and clear of the roots.
    """
    drawn = drawn_gears(base, bounds, 2 * _SPARE * samples, seed).gears
    found: list[GearPair] = []
    for first, next_one in zip(drawn[::2], drawn[1::2], strict=True):
        made = attempt(partial(_meshing, first.gear, next_one.gear))
        if made.value is not None:
            found.append(made.value)
        if len(found) == samples:
            return tuple(found)
    raise InputError("study", f"{len(found)} of {len(drawn) // 2} samples", "gave a pair that meshes",
                     "choose narrower ranges")  # fmt: skip


def _meshing(first: Gear, drawn: Gear) -> GearPair:
    own, rack = drawn.external_tooth, first.external_tooth.rack
    numbers = {
        "teeth": own.teeth, "profile_shift": own.profile_shift, "rack_tip_radius": rack.tip_radius,
        "rack_dedendum": rack.dedendum, "pressure_angle": rack.pressure_angle,
    }  # fmt: skip
    tooth = tooth_of(first.external_tooth, numbers)
    if tooth is None:
        raise RangeError("teeth", own.teeth, "cannot be cut by the rack of the mate")
    bore = drawn.bore_radius / drawn.root_radius * tooth.root_radius * drawn.module
    pair = GearPair(first, Gear(tooth, drawn.module, bore, drawn.face_width, drawn.material, drawn.plane))
    low, high = _CONTACT_RATIO
    if not low <= pair.contact_ratio < high:
        raise RangeError("contact ratio", f"{pair.contact_ratio:.4g}", f"must be between {low:g} and {high:g}")
    if min(pair.tip_clearance("driver"), pair.tip_clearance("driven")) <= 0.0:
        raise RangeError("tip clearance", "", "must be positive")
    return pair


def compare_stiffness(pair: GearPair, solved: Callable[[Gear], SolvedTeeth], line_load: float) -> PairOfStudy:
    """Every stiffness formula of one pair.

    Parameters
    ----------
    pair : GearPair
    solved : callable
        Finite elements of a gear, solved or from an atlas.
    line_load : float
        w = F_bt / b [N/m].
    """
    known = [solved(gear) for gear in (pair.driver, pair.driven)]
    reference = pair_reference(pair, known[0], known[1], positions_on_flanks(pair, line_load, _POSITIONS), line_load)
    at = int(np.argmin(reference.total))
    x, width = reference.x[[at]], reference.half_width[[at]]
    errors = [
        float(one.self_error(pair.radius(x, member), width)[0]) for one, member in zip(known, MEMBERS, strict=True)
    ]
    compliance = float(reference.total[at])
    single, share = 1.0 / compliance, sum(errors) / compliance
    mesh = mean_mesh_stiffness(pair, known[0], known[1], line_load)
    fe = {SINGLE: (single, single * share), MESH: (mesh, mesh * share)}
    answers = _by_formula(pair, line_load, reference.x)
    return PairOfStudy(
        pair,
        tuple(
            StiffnessAnswer(quantity, name, np.nan if one.value is None else one.value, *fe[quantity], one.reason)
            for quantity, name, one in answers
        ),
    )


def _by_formula(pair: GearPair, line_load: float, x: np.ndarray) -> Iterator[tuple[str, str, Outcome[float]]]:
    """Stiffness of one tooth pair at its stiffest position, and mean over the mesh, by every formula."""
    iso = attempt(partial(pair_stiffness, pair, specific_load=pair.tangential_load(line_load)))
    yield SINGLE, ISO, Outcome(None if iso.value is None else iso.value.single, iso.reason)
    yield MESH, ISO, Outcome(None if iso.value is None else iso.value.mesh_alpha, iso.reason)
    for name, one in pair_compliance_answers(pair, x, line_load).items():
        given = one.total[np.isfinite(one.total)]
        reason = next((words for words in one.reasons if words), "")
        yield SINGLE, name, Outcome(float(1.0 / given.min()) if given.size else None, "" if given.size else reason)
    for name in SOURCES:
        yield MESH, name, attempt(partial(_mean, pair, name, line_load))


def _mean(pair: GearPair, name: str, line_load: float) -> float:
    teeth = PairCompliance(pair, closed_form_compliance(pair.driver, name), closed_form_compliance(pair.driven, name))
    return mean_stiffness_of(teeth, line_load)
