"""Root stress of a tooth on its way through the mesh, from its own load and its neighbours'."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.contact.plane.compliance import RootStressInfluence, Side, largest_stress
from fegear.contact.plane.stress_rows import Rows, StressRows

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement, Loaded
    from fegear.geometry.pair import Member


@dataclass(frozen=True)
class RootStressHistory:
    """Largest fillet stress of each pair's tooth at each roll position.

    Parameters
    ----------
    member : {"driver", "driven"}
    side : {"tension", "compression"}
    x : ndarray, shape (n, P)
        Position of the pair's contact [m]; beyond the path the tooth is unloaded but feels its neighbours.
    stress : ndarray, shape (n, P, L)
        Largest tension, or most negative compression [Pa].
    """

    member: Member
    side: Side
    x: Array
    stress: Array

    @property
    def largest(self) -> Array:
        """Over the whole engagement, shape (L,) [Pa]."""
        flat = self.stress.reshape(-1, self.stress.shape[-1])
        extreme = np.fmax if self.side == "tension" else np.fmin  # over the positions at which there is a stress
        return np.asarray(extreme.reduce(flat, axis=0))


def root_stress_history(
    engagement: Engagement,
    loaded: Loaded,
    member: Member,
    side: Side = "tension",
    beyond: int = 0,
    source: RootStressInfluence | None = None,
    within: tuple[float, float] | None = None,
) -> RootStressHistory:
    """Superpose the fillet stress of a tooth's own load and of its neighbours' loads, then take the extreme.

    Between the points of a fillet where its source knows how (`FilletCurve`), as `Influence.largest_root_stress` does.

    Parameters
    ----------
    engagement : Engagement
    loaded : Loaded
    member : {"driver", "driven"}
    side : {"tension", "compression"}
        The tension fillet lies below the loaded flank.
    beyond : int
        Teeth before the first and after the last pair that can touch, in addition: they feel their neighbours' loads.
    source : RootStressInfluence, optional
        Where this gear's root stress comes from; by default where its compliance does.
    within : (float, float), optional
        Stress is looked for where x lies between these [m], and is NaN elsewhere; by default everywhere.

    Raises
    ------
    InputError
        If the source knows no root stress.
    """
    known = source or engagement.compliance.source(member)
    along = np.stack(list(superposed_stress(engagement, loaded, member, side, beyond, known)))  # (teeth, P, L, points)
    touching = np.broadcast_to(touching_radius(loaded, member, beyond)[:, :, None], along.shape[:3])
    contacts = loaded.grid.contacts
    teeth = np.arange(-beyond, contacts.x.shape[0] + beyond)
    x = contacts.x[0] + teeth[:, None] * engagement.pair.base_pitch
    low, high = within or (-np.inf, np.inf)
    asked = (x > low) & (x < high)
    stress = np.full(touching.shape, np.nan)
    flat = along[asked].reshape(-1, along.shape[3]).T
    found = largest_stress(known.fillet_curve(side), flat, side, touching[asked].ravel())
    stress[asked] = found.reshape(-1, touching.shape[2])
    return RootStressHistory(member, side, x, stress)


def touching_radius(loaded: Loaded, member: Member, beyond: int = 0) -> Array:
    """Radii at which the teeth of a gear are touched, infinite where they are not, shape (n + 2 beyond, P) [m].

    Parameters
    ----------
    loaded, member, beyond
        See `root_stress_history`.
    """
    contacts = loaded.grid.contacts
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    found = np.where(contacts.present, radius, np.inf)
    return np.pad(found, ((beyond, beyond), (0, 0)), constant_values=np.inf)


def superposed_stress(
    engagement: Engagement,
    loaded: Loaded,
    member: Member,
    side: Side = "tension",
    beyond: int = 0,
    source: RootStressInfluence | None = None,
) -> Iterator[Array]:
    """Stress along the fillet of one tooth after the other, from its own load and its neighbours', (P, L, points) [Pa].

    Parameters
    ----------
    engagement, loaded, member, side, beyond, source
        See `root_stress_history`; teeth come in its order.
    """
    source = source or engagement.compliance.source(member)
    contacts = loaded.grid.contacts
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    n = radius.shape[0]
    reach = min(source.reach, n - 1 + beyond) if engagement.compliance.coupling else 0
    towards_load = 1 if member == "driver" else -1  # tooth +1 is ahead of a driving tooth and behind a driven one
    line_load = loaded.loads / engagement.compliance.face_width
    carries = np.asarray((line_load > 0.0).any(axis=2))
    rows = _rows(source, reach, radius[carries], side)
    first = np.concatenate([[0], np.cumsum(carries.sum(axis=1))])
    carrying = [(j, np.flatnonzero(carries[j]), slice(first[j], first[j + 1])) for j in range(n) if carries[j].any()]
    for tooth in range(-beyond, n + beyond):
        total = np.zeros((*line_load.shape[1:], rows[0].shape[1]))
        for other, at, of_other in carrying:
            k = towards_load * (tooth - other)
            if k in rows:
                load, row = line_load[other, at, :, None], rows[k][of_other, None, :]
                # a formula may give nothing for a load at this place, which is no matter where there is none
                total[at] += load * row if np.isfinite(row).all() else np.where(load > 0.0, load * row, 0.0)
        yield total


def _rows(source: RootStressInfluence, reach: int, radius: Array, side: Side) -> Rows:
    """Stress along the fillet of teeth -reach..reach per unit line load at radii, shape (Q, points) each [1/m]."""

    def evaluate(at: Array) -> Rows:
        found = {}
        for k in range(-reach, reach + 1):
            stress = source.root_stress(k, at, side)
            if stress is None:
                raise InputError(
                    "results",
                    '"root-stress"',
                    "cannot come from a compliance source that knows deflections alone",
                    'set pair.root_stress.source = "fe" or a formula',
                )
            found[k] = np.ascontiguousarray(stress.T)
        return found

    kept: dict[tuple[Side, int], StressRows] | None = getattr(source, "stress_rows", None)
    return evaluate(radius) if kept is None else kept.setdefault((side, reach), StressRows()).at(radius, evaluate)
