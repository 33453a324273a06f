"""A gearbox at a glance: its meshes, bearings and shafts, the weakest first, and what to change."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

from fegear.base.notes import Note, failing
from fegear.contact.wide.on_shafts import LoadedShafts
from fegear.results.shafts.at_glance import BearingAtGlance, MeshAtGlance
from fegear.results.shafts.checked_shafts import CheckedShaft
from fegear.results.shafts.drawn_gearbox import DrawnGearbox
from fegear.results.shafts.gearbox_changes import (
    Change,
    change_of_failure,
    change_of_life,
    change_of_load,
    change_of_mesh,
    change_of_shaft,
    change_of_tilt,
    gain_of_lead,
    least_safe,
    shortest_life,
)

#: Changes that are named, if so many do not fail.
_FIRST = 3


@dataclass(frozen=True)
class GearboxData:
    """What the result found; meshes and bearings the weakest first.

    Parameters
    ----------
    shafts : LoadedShafts
    drawn : DrawnGearbox
    meshes : tuple of MeshAtGlance
    bearings : tuple of BearingAtGlance
    required_hours : float
        Largest life that a pair is rated for [s]; NaN where none is.
    failures : tuple of Note
        Why the gearbox cannot be built, the worst first: bodies that cut each other, bores that are not their shaft's.
    checked : tuple of CheckedShaft
        Shafts against yielding, the weakest first.
    turned_by : tuple of str
        Keys of the case that turn it the other way.
    """

    shafts: LoadedShafts
    drawn: DrawnGearbox
    meshes: tuple[MeshAtGlance, ...]
    bearings: tuple[BearingAtGlance, ...]
    required_hours: float
    failures: tuple[Note, ...] = ()
    checked: tuple[CheckedShaft, ...] = ()
    turned_by: tuple[str, ...] = ()

    @cached_property
    def changes(self) -> tuple[Change, ...]:
        """What cannot be built and all that fails; up to three with what limits the load, then what evens it out.

        Of what fails, the weakest mesh, shaft and bearing come before a second one of their kind: three short-lived
        bearings would hide what a mesh needs.
        """
        lives = (change_of_life(one, self.required_hours) for one in self.bearings)
        kinds = (
            _in_order(map(change_of_mesh, self.meshes)), _in_order(map(change_of_shaft, self.checked)),
            _in_order((*map(change_of_tilt, self.bearings), *lives)),
        )  # fmt: skip
        ranked = [(n, one) for kind in kinds for n, one in enumerate(kind)]
        urgent = [one for _, one in sorted(ranked, key=lambda found: (found[0], found[1].margin))]
        named = {one.part for one in urgent}
        found = [*map(change_of_failure, self.failures), *urgent]
        for one in self._improvements():
            if one.part not in named:
                found.append(one)
                named.add(one.part)
        return tuple(found[: max(_FIRST, len(self.failures) + len(urgent))])

    def said_of_lives(self) -> Iterator[Note]:
        """Bearings whose life is too short, the least margin first, with what to change."""
        for one in self.bearings:
            if (change := change_of_life(one, self.required_hours)) is not None:
                finding = f"basic rating {change.finding} required on shaft {one.shaft}"
                yield failing(f"Bearing {one.bearing}: {finding}; {change.remedy}.", one.margin)

    def _improvements(self) -> Iterator[Change]:
        """What limits the load although it suffices: least safety, shortest life, and loads over the face to even."""
        rated = [one for one in self.meshes if math.isfinite(one.margin) and one.safety is not None]
        yield from (least_safe(one, one.safety) for one in rated[:1] if one.safety is not None)
        lasting = [one for one in self.bearings if math.isfinite(one.margin)]
        yield from (shortest_life(one, self.required_hours) for one in lasting[:1])
        loads = map(change_of_load, sorted(self.meshes, key=gain_of_lead, reverse=True))
        yield from (one for one in loads if one is not None)


def _in_order(changes: Iterable[Change | None]) -> list[Change]:
    """Those that are necessary, the least margin first."""
    return sorted((one for one in changes if one is not None), key=lambda one: one.margin)
