"""Contacts of a pair some of whose flanks differ from the others: missing, with a lower tip, pits, another profile.

They change which pairs touch, where, over how much of the face and after which gap; compliances of teeth are those of
their sources. A pit over a share s of the face leaves a line load of w / (1 - s) on what is left of the contact line.
A contact approaches by kappa w (ln(2 h / b) - nu / (2 - 2 nu)) against the tooth's centre line, which lies h below it
along the normal (Weber and Banaschek); of each tooth this becomes, with the half-width b of the larger line load,

    kappa w / (1 - s) (ln(2 h / b(w / (1 - s))) - nu / (2 - 2 nu)).

A formula whose contact is linear in the load divides its part by 1 - s: the Hertzian stiffness of the literature on
pitting, pi E (L - Delta L) / (4 (1 - nu^2)), with what is left of the contact line's length L.

The floor of such a pit carries no load. One over the whole face leaves its depth as a gap.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.arrays import same
from fegear.base.errors import InputError
from fegear.contact.plane.meshing import Contacts, Meshing
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.base.arrays import Array, Index
    from fegear.contact.odd_flank import OddFlank
    from fegear.contact.plane.coupled_teeth import PairMatrices
    from fegear.contact.plane.pair_compliance import PairCompliance
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair
    from fegear.geometry.relief import Relief


@dataclass(frozen=True)
class OddContacts:
    """Contacts of a pair some of whose flanks are odd.

    Parameters
    ----------
    pair : GearPair
    driver, driven : mapping of int to OddFlank
        By the number of the tooth in meshing order.
    corner_contact : bool
    """

    pair: GearPair
    driver: Mapping[int, OddFlank]
    driven: Mapping[int, OddFlank]
    corner_contact: bool = False

    def on(self, number: Index, cycle: int) -> tuple[tuple[OddFlank | None, OddFlank | None], ...]:
        """Odd flanks of both gears on each pair in a base pitch; empty where all are ordinary."""
        orders = [cycle - int(j) for j in number]
        found = tuple(
            (self.driver.get(order % self.pair.driver.teeth), self.driven.get(order % self.pair.driven.teeth))
            for order in orders
        )
        return found if any(flank is not None for both in found for flank in both) else ()

    def kinds(self, number: Index, cycle: int) -> tuple[tuple[int, int], ...]:
        """What tells such pairs from others: the first tooth with the same flank, -1 of ordinary ones."""
        if not self.on(number, cycle):
            return ()
        z, (driver, driven) = (self.pair.driver.teeth, self.pair.driven.teeth), self._first
        orders = [cycle - int(j) for j in number]
        return tuple((driver.get(order % z[0], -1), driven.get(order % z[1], -1)) for order in orders)

    @cached_property
    def _first(self) -> tuple[dict[int, int], ...]:
        """Of each odd tooth of both gears the first one that is as it is."""
        found = []
        for flanks in (self.driver, self.driven):
            first: dict[int, int] = {}
            for tooth, flank in flanks.items():
                known = dict.fromkeys(first.values())
                first[tooth] = next((one for one in known if same(flanks[one], flank)), tooth)
            found.append(first)
        return tuple(found)

    def modified(self, removal: Array, contacts: Contacts, cycle: int, reliefs: tuple[Relief, Relief]) -> Array:
        """Removals of both flanks together where their gears' reliefs give `removal`, shape (n, P) [m]."""
        found = removal
        for row, both in enumerate(self.on(contacts.number, cycle)):
            if not any(flank is not None and flank.profiled for flank in both):
                continue
            if found is removal:
                found = removal.copy()
            rolls = contacts.roll_driver[row], contacts.roll_driven[row]
            if any(flank is not None and flank.relief is not None for flank in both):
                own = [
                    usual if flank is None or flank.relief is None else flank.relief
                    for usual, flank in zip(reliefs, both, strict=True)
                ]
                found[row] = sum(relief.removal(roll) for relief, roll in zip(own, rolls, strict=True))
            for flank, roll in zip(both, rolls, strict=True):
                if flank is not None:
                    found[row] += flank.deviation.removal(roll)
        return found

    def changed(self, contacts: Contacts, cycle: int) -> Contacts:
        """The contacts with the odd flanks of a base pitch; the same ones where only pits are odd."""
        rows = {}
        for row, both in enumerate(self.on(contacts.number, cycle)):
            outline = tuple(
                (flank.missing, flank.tip_radius) if flank is not None else (False, math.nan) for flank in both
            )
            if any(missing or not math.isnan(tip) for missing, tip in outline):
                rows[row] = outline
        if not rows:
            return contacts
        names = ("present", "radius_driver", "radius_driven", "roll_driver", "roll_driven", "relative_radius")
        arrays = {name: np.array(getattr(contacts, name)) for name in (*names, "edge", "gap")}
        for row, outline in rows.items():
            meshing = None if any(missing for missing, _ in outline) else self._meshing([tip for _, tip in outline])
            if meshing is None:
                new: dict[str, Any] = {"present": False, "edge": -np.inf, "gap": np.inf}
            else:
                found = meshing.touching(contacts.x[row])
                rb1, rb2 = self.pair.driver.base_radius, self.pair.driven.base_radius
                new = {
                    "present": found.gap < np.inf, "radius_driver": np.hypot(rb1, found.driver_length),
                    "radius_driven": np.hypot(rb2, found.driven_length), "roll_driver": found.driver_length / rb1,
                    "roll_driven": found.driven_length / rb2, "relative_radius": found.relative_radius,
                    "edge": found.edge, "gap": found.gap,
                }  # fmt: skip
            for name, values in new.items():
                arrays[name][row] = values
        return replace(contacts, **arrays)

    def _meshing(self, tips: list[float]) -> Meshing | None:
        """Of a pair of gears that end at these radii [m], NaN for their own; None where their flanks do not meet."""
        pair = _with_tips(self.pair, tips)
        return Meshing(pair, self.corner_contact, single=True) if pair.x_end > pair.x_start else None

    def gap(self, contacts: Contacts, cycle: int) -> Array:
        """Gaps by pits over the whole face, shape (n, P) [m]."""
        total = np.zeros(contacts.x.shape)
        for row, flank, radius in self._flanks(contacts, cycle):
            total[row] += flank.gap(radius)
        return total

    def bearing_share(self, contacts: Contacts, cycle: int) -> Array:
        """Share of the face that pits leave, the smaller one of both flanks, shape (n, P)."""
        left = np.ones(contacts.x.shape)
        for row, flank, radius in self._flanks(contacts, cycle):
            left[row] = np.minimum(left[row], flank.bearing_share(radius))
        return left

    def _flanks(self, contacts: Contacts, cycle: int) -> Iterator[tuple[int, OddFlank, Array]]:
        for row, both in enumerate(self.on(contacts.number, cycle)):
            for flank, radius in zip(both, (contacts.radius_driver, contacts.radius_driven), strict=True):
                if flank is not None and flank.pits:
                    yield row, flank, radius[row]

    @property
    def places(self) -> list[float]:
        """Where odd flanks begin and end along the line of action [m]."""
        found = []
        for member, flanks in zip(MEMBERS, (self.driver, self.driven), strict=True):
            for flank in flanks.values():
                radii = [radius for pit in flank.pits for radius in (pit.low, pit.high)]
                if not math.isnan(flank.tip_radius):
                    radii.append(_with_tip(self.pair.gear(member), flank.tip_radius).involute_tip_radius)
                low, high = self.pair.gear(member).involute_radii
                found += [float(self.pair.x_of_radius(radius, member)) for radius in np.clip(radii, low, high)]
                found += [float(self.pair.x_of_roll(roll, member)) for roll in flank.kinks]
        return found


def _with_tips(pair: GearPair, tips: list[float]) -> GearPair:
    driver, driven = (_with_tip(pair.gear(member), tip) for member, tip in zip(MEMBERS, tips, strict=True))
    return replace(pair, driver=driver, driven=driven)


def _with_tip(gear: Gear, radius: float) -> Gear:
    from fegear.geometry.custom_fillet_tooth import with_tip  # late: few teeth are odd

    if math.isnan(radius):
        return gear
    return replace(gear, tooth=with_tip(gear.symmetric_tooth, radius / gear.module))


def refuse_no_contact(separation: Array) -> None:
    """Refuse roll positions at which odd flanks leave no pair in contact.

    Raises
    ------
    InputError
    """
    if np.isinf(separation).all(axis=0).any():
        raise InputError(
            "odd_tooth", "(given)", "leaves no tooth pair in contact at some roll positions",
            "set effects.corner_contact = true, or lower its tip less",
        )  # fmt: skip


def on_less_face(matrices: PairMatrices, share: Array, at: Contacts, compliance: PairCompliance) -> PairMatrices:
    """Compliances of pairs whose contact lines are shorter, at shares of the face, shape (n, P)."""
    from fegear.formulas.weber_banaschek import contact_approach  # late: few teeth are odd

    if (share >= 1.0).all():
        return matrices
    # formulas only: contact as a spring, whatever its load
    spring = sum(getattr(source, "linear_contact", 0.0) for source in compliance.both) / compliance.face_width
    if spring > 0.0:
        c, each = matrices.compliance.copy(), np.arange(share.shape[0])
        c[each, each] += np.where(at.present, spring * (1.0 / share - 1.0), 0.0)
        return replace(matrices, compliance=c)
    if compliance.hertz == "none":
        return matrices
    load, face = compliance.contact_load, compliance.face_width
    c, each = matrices.compliance.copy(), np.arange(share.shape[0])
    line_load, less = load / face, share < 1.0
    usual = compliance.half_width(np.asarray(load), at.relative_radius)
    narrower = compliance.half_width(load / share, at.relative_radius)
    for member, radius in zip(MEMBERS, (at.radius_driver, at.radius_driven), strict=True):
        gear = compliance.pair.gear(member)
        if compliance.contact_slope(member) > 0.0:
            r = np.clip(radius, *gear.involute_radii)
            harder = contact_approach(gear, r, line_load / share, narrower)
            added = (harder - contact_approach(gear, r, line_load, usual)) / load
            c[each, each] += np.where(at.present & less, added, 0.0)
    law = matrices.law
    if np.any(law.log_slope):
        law = replace(law, log_slope=law.log_slope / share)
    return replace(matrices, compliance=c, law=law)
