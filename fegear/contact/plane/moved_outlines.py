"""The outlines of two gears in mesh under their shared load: how far every point of the teeth near the mesh moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.fem.plane.outline_motion import OutlineMotion
from fegear.geometry.pair import Member
from fegear.geometry.relief import Relief


@dataclass(frozen=True)
class MovedOutline(ReadOnlyArrays):
    """One gear's teeth near the mesh at P roll positions.

    Parameters
    ----------
    pairs : ndarray of int, shape (T,)
        Pairs that the teeth belong to, as `Contacts.number` counts them.
    points : ndarray, shape (2, N)
        Outline of a tooth at rest in its own frame, centre line along +y, loaded flank at x > 0 [m].
    displacement : ndarray, shape (P, T, 2, N)
        Of these points in the frame of their own tooth [m]: by the loads, and by what modifications and spacing errors
        remove.
    """

    pairs: Array
    points: Array
    displacement: Array

    @property
    def largest(self) -> float:
        """Largest displacement [m]."""
        return float(np.sqrt((self.displacement**2).sum(axis=2).max()))


def moved_outline(
    e: Engagement, state: Loaded, member: Member, motion: OutlineMotion, patch: float, pairs: Sequence[int]
) -> MovedOutline:
    """Superpose what the loads on all pairs do to the teeth of one gear.

    Turned on by the transmission error over its base radius, the driver then touches the driven gear where pairs are
    loaded: the drawn gap is transmission error less modifications, errors and deflections, which load sharing makes
    zero there. Without coupling a load moves its own tooth alone, as load sharing then has it.

    Parameters
    ----------
    e : Engagement
        With compliances by finite elements.
    state : Loaded
        Under one load.
    member : {"driver", "driven"}
    motion : OutlineMotion
        Of the gear.
    patch : float
        See `OutlineMotion.displacement` [modules].
    pairs : sequence of int
        Whose teeth are wanted.
    """
    gear, contacts = e.pair.gear(member), state.grid.contacts
    m, towards_load = gear.module, 1 if member == "driver" else -1
    line_load = state.loads[:, :, 0] / e.compliance.face_width
    moved = np.zeros((line_load.shape[1], len(pairs), 2, motion.points.shape[1]))
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    width = _half_width(e, state, member)
    for row, number in enumerate(contacts.number.tolist()):
        at = np.flatnonzero(line_load[row] > 0.0)
        if not at.size:
            continue
        unit = motion.displacement(radius[row, at] / m, patch, width[row, at] / m)
        per_load = line_load[row, at] / gear.material.young_modulus
        for t, pair in enumerate(pairs):
            k = towards_load * (pair - number)
            if k in unit and (k == 0 or e.compliance.coupling):
                moved[at, t] += (unit[k] * per_load).transpose(2, 0, 1)
    moved += _removed(e, member, motion.points, pairs)
    return MovedOutline(np.asarray(pairs), motion.points * m, moved)


def _half_width(e: Engagement, state: Loaded, member: Member) -> Array:
    """Half-widths of the contacts that the case's compliances are for, shape (n, P) [m]."""
    c, contacts = e.compliance, state.grid.contacts
    if c.hertz == "none":
        radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
        return c.source(member).reference_half_width(radius)
    load = state.loads[:, :, 0] if c.hertz == "load-dependent" else np.full(contacts.x.shape, c.nominal_load)
    return c.half_width(load, contacts.relative_radius)


def _removed(e: Engagement, member: Member, points: Array, pairs: Sequence[int]) -> Array:
    """What modifications take off both flanks, and spacing errors off whole teeth, as displacements (T, 2, N) [m]."""
    gear = e.pair.gear(member)
    relief: Relief = e.driver_relief if member == "driver" else e.driven_relief
    errors = e.driver_spacing if member == "driver" else e.driven_spacing
    radius, tooth = np.hypot(*points), gear.tooth
    angle, taken = np.arctan2(*points), np.zeros(points.shape)
    sides = ((tooth, 1.0),) if gear.asymmetric else ((tooth, 1.0), (tooth, -1.0))  # equal flanks are ground alike
    for flank, sign in sides:
        reached = np.maximum(radius, flank.base_radius)
        roll, half = flank.roll(reached), flank.flank_angle(reached)
        on = (flank.side * radius >= flank.side * flank.form_radius * (1.0 - flank.side * 1e-9)) & (
            np.abs(sign * angle - half) < 1e-4
        )
        lean = flank.base_half_angle - roll
        taken += np.where(on, relief.removal(roll), 0.0) * np.stack([-sign * np.cos(lean), np.sin(lean)])
    found = np.tile(taken, (len(pairs), 1, 1))
    if errors.size:  # a whole tooth stands back, turned about the centre; its fillets hold on to the body
        above = np.clip((radius - tooth.root_radius) / (tooth.form_radius - tooth.root_radius), 0.0, 1.0)
        back = np.stack([-points[1], points[0]]) / tooth.base_radius * above
        found += errors[np.mod(-np.asarray(pairs), errors.size)][:, None, None] * back
    return found
