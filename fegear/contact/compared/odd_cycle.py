"""Mesh stiffness while a cracked or pitted tooth passes the mesh, by formulas and by finite elements.

The figure of papers on diagnosis: ordinary and odd teeth over the rotation. As over the mesh cycle (`mesh_cycle`)
flanks are perfect but for pits, touch on the path of contact only, and all have the same load and roll positions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.contact.odd_flank import OddFlank
from fegear.contact.plane.base_pitch import roll_positions, secant_stiffness
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.odd_formula_compliance import CRACKED, odd_formula_compliance
from fegear.contact.plane.over_revolution import refuse_too_many
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.formulas.outcome import Outcome, attempt
from fegear.geometry.pair import MEMBERS, GearPair, Member

if TYPE_CHECKING:
    from fegear.contact.plane.compliance import GearCompliance

#: Even steps over a base pitch.
_POSITIONS = 100


class OddTooth(NamedTuple):
    """One cracked or pitted tooth: its gear's role and name, its number in meshing order, what it is in words."""

    member: Member
    gear: str
    tooth: int
    what: str


@dataclass(frozen=True)
class OddTeethOfPair:
    """Which teeth of a pair are cracked or pitted.

    Parameters
    ----------
    teeth : tuple of OddTooth
    tips : mapping of member to mapping of int to (float, float)
        Tips of cracks for formulas, by the tooth's own number, as of `odd_formula_compliance`.
    flanks : mapping of member to mapping of int to OddFlank
        Pits, by the number in meshing order.
    """

    teeth: tuple[OddTooth, ...] = ()
    tips: Mapping[Member, Mapping[int, tuple[float, float]]] = field(default_factory=dict)
    flanks: Mapping[Member, Mapping[int, OddFlank]] = field(default_factory=dict)


@dataclass(frozen=True)
class OddAndOrdinary:
    """Mesh stiffness over P roll positions with the odd teeth of a pair and with ordinary ones, shape (P,)."""

    odd: Array = shown("N/um", label="mesh stiffness")
    ordinary: Array = shown("N/um", label="mesh stiffness")

    @property
    @shows("%", "reduction of the minimum mesh stiffness by the odd tooth")
    def loss(self) -> float:
        """Of one."""
        return float(1.0 - self.odd.min() / self.ordinary.min())


@dataclass(frozen=True)
class OddPassage:
    """A pair under one load while an odd tooth passes: a base pitch before it comes into mesh to one after it.

    Parameters
    ----------
    pair : GearPair
    tooth : OddTooth
    x : ndarray, shape (P,)
        Roll positions from where the tooth is at the pitch point [m].
    fe, uncoupled : OddAndOrdinary
        Finite elements with and without the coupling of neighbouring teeth.
    formulas : mapping of str to Outcome
        `OddAndOrdinary` by each formula that has such teeth, or why it gives none.
    """

    pair: GearPair
    tooth: OddTooth
    fe: OddAndOrdinary
    uncoupled: OddAndOrdinary
    formulas: Mapping[str, Outcome[OddAndOrdinary]]
    x: Array = shown("mm", "position of the odd tooth on the line of action, from the pitch point")

    @property
    @shows("deg", "rotation of the driver from where the odd tooth is at the pitch point")
    def driver_angle(self) -> Array:
        """x over the base radius of the driver, shape (P,) [rad]."""
        return self.x / self.pair.driver.base_radius


def odd_passages(
    pair: GearPair,
    odd: Sequence[GearCompliance],
    ordinary: Sequence[GearCompliance],
    line_load: float,
    known: OddTeethOfPair,
) -> tuple[OddPassage, ...]:
    """Follow each odd tooth of a pair through the mesh.

    Parameters
    ----------
    pair : GearPair
    odd, ordinary : sequence of GearCompliance
        Finite elements of driver and driven gear with their odd teeth, and without.
    line_load : float
        Of all tooth pairs together, along the line of action [N/m].
    known : OddTeethOfPair

    Raises
    ------
    InputError
        If no tooth pair is on the path somewhere, or the same teeth meet again after too many base pitches.
    """
    load = line_load * pair.face_width
    fe = _both(pair, odd, ordinary, known, coupling=True)
    refuse_too_many(fe[0])
    apart = _both(pair, odd, ordinary, known, coupling=False)
    by = {name: attempt(partial(_formula, pair, name, known)) for name in CRACKED}
    x = roll_positions(fe[0], _POSITIONS)
    pitches = np.arange(-1, int(np.ceil(pair.contact_ratio)) + 1)
    along = np.concatenate([x + pair.base_pitch * pitch for pitch in pitches])
    found = []
    for tooth in known.teeth:
        follow = partial(_follow, x, [int(tooth.tooth + pitch) % fe[0].cycles for pitch in pitches], load)
        formulas = {
            name: Outcome(follow(one.value)) if one.value is not None else Outcome(None, one.reason)
            for name, one in by.items()
        }
        found.append(OddPassage(pair, tooth, follow(fe), follow(apart), formulas, along))
    return tuple(found)


_Both = tuple[Engagement, Engagement]


def _both(
    pair: GearPair,
    odd: Sequence[GearCompliance],
    ordinary: Sequence[GearCompliance],
    known: OddTeethOfPair,
    *,
    coupling: bool,
) -> _Both:
    """With odd teeth and without."""
    first, second = (dict(known.flanks.get(member, {})) for member in MEMBERS)
    return (
        Engagement(PairCompliance(pair, odd[0], odd[1], coupling), driver_odd=first, driven_odd=second),
        Engagement(PairCompliance(pair, ordinary[0], ordinary[1], coupling)),
    )


def _formula(pair: GearPair, name: str, known: OddTeethOfPair) -> _Both:
    odd, ordinary = (
        tuple(odd_formula_compliance(pair.gear(member), name, tips.get(member, {})) for member in MEMBERS)
        for tips in (known.tips, {})
    )
    return _both(pair, odd, ordinary, known, coupling=False)


def _follow(x: Array, cycles: list[int], load: float, both: _Both) -> OddAndOrdinary:
    """Both over successive base pitches at the same roll positions of each."""
    found = []
    for one in both:
        grid = one.grid(x)
        found.append(np.concatenate([secant_stiffness(one.solve(grid, [load], cycle))[:, 0] for cycle in cycles]))
    return OddAndOrdinary(*found)
