"""Root stress of a tooth on its way through the mesh, from its own load and its neighbours'."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import InputError
from fegear.contact.plane.compliance import RootStressInfluence, Side, largest_stress
from fegear.contact.plane.stress_rows import Rows, StressRows
from fegear.fem.teeth import together

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

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
    along = list(superposed_stress(engagement, loaded, member, side, beyond, known))  # (P, L, points) each
    radius = touching_radius(loaded, member, beyond)[:, :, None]
    touching = np.broadcast_to(radius, (*radius.shape[:2], loaded.load.size))
    contacts = loaded.grid.contacts
    places = np.arange(-beyond, contacts.x.shape[0] + beyond)
    x = contacts.x[0] + places[:, None] * engagement.pair.base_pitch
    low, high = within or (-np.inf, np.inf)
    asked = (x > low) & (x < high)
    stress = np.full(touching.shape, np.nan)
    teeth = [engagement.compliance.tooth(member, int(contacts.number[0] + at), loaded.cycle) for at in places]
    for rows in together([known.same_as(tooth, 1) for tooth in teeth]):
        wanted = asked[rows]
        flat = np.stack([along[row] for row in rows])[wanted]
        curve = known.fillet_curve(teeth[rows[0]], side)
        found = largest_stress(curve, flat.reshape(-1, flat.shape[-1]).T, side, touching[rows][wanted].ravel())
        part = stress[rows]
        part[wanted] = found.reshape(-1, touching.shape[2])
        stress[rows] = part
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
    line_load = loaded.loads / engagement.compliance.face_width
    carries = np.asarray((line_load > 0.0).any(axis=2))
    numbers = [engagement.compliance.tooth(member, int(j), loaded.cycle) for j in contacts.number]
    step = engagement.compliance.tooth(member, 1, 0) - engagement.compliance.tooth(member, 0, 0)
    carrying: list[tuple[int, Felt]] = []
    for like in together([source.same_as(number - reach, 2 * reach + 1) for number in numbers]):
        rows = _rows(source, reach, numbers[like[0]], radius[like][carries[like]], side)
        first = np.concatenate([[0], np.cumsum(carries[like].sum(axis=1))])
        for i, j in enumerate(like):
            if carries[j].any():
                of_pair = slice(first[i], first[i + 1])
                at = np.flatnonzero(carries[j])
                carrying.append((numbers[j], Felt(at, line_load[j, at], {k: row[of_pair] for k, row in rows.items()})))
    for place in range(-beyond, n + beyond):
        tooth = numbers[0] + step * place
        felt = [(one, tooth - other) for other, one in carrying if tooth - other in one.rows]
        points = felt[0][0].rows[felt[0][1]].shape[1] if felt else _points(source, tooth, radius[:1, 0], side)
        total = np.zeros((*line_load.shape[1:], points))
        for one, k in felt:
            load, row = one.line_load[:, :, None], one.rows[k][:, None, :]
            # a formula may give nothing for a load at this place, which is no matter where there is none
            total[one.at] += load * row if np.isfinite(row).all() else np.where(load > 0.0, load * row, 0.0)
        yield total


class Felt(NamedTuple):
    """What a loaded tooth does to those around it.

    Attributes
    ----------
    at : ndarray of int, shape (Q,)
        Roll positions at which it carries load.
    line_load : ndarray, shape (Q, L)
        [N/m].
    rows : dict of int to ndarray, shape (Q, points)
        Stress along the fillets of teeth per unit line load [1/m], by how far they are from it.
    """

    at: NDArray[np.intp]
    line_load: Array
    rows: Rows


def _points(source: RootStressInfluence, tooth: int, radius: Array, side: Side) -> int:
    """Points along the fillet of a tooth at which no load is felt."""
    return _rows(source, 0, tooth, radius, side)[0].shape[1]


def _rows(source: RootStressInfluence, reach: int, tooth: int, radius: Array, side: Side) -> Rows:
    """Stress along fillets per unit line load at radii of a tooth, by how far their teeth are from it: -reach..reach.

    Of shape (Q, points) each [1/m].
    """

    def evaluate(at: Array) -> Rows:
        found = {}
        for k in range(-reach, reach + 1):
            stress = source.root_stress(tooth + k, tooth, at, side)
            if stress is None:
                raise InputError(
                    "results",
                    '"root-stress"',
                    "is not available with this compliance source (deflections only)",
                    'set pair.root_stress.source = "fe" or a formula',
                )
            found[k] = np.ascontiguousarray(stress.T)
        return found

    kept: dict[tuple[Side, int, int], StressRows] | None = getattr(source, "stress_rows", None)
    if kept is None:
        return evaluate(radius)
    like = source.same_as(tooth - reach, 2 * reach + 1)
    return kept.setdefault((side, reach, like), StressRows()).at(radius, evaluate)
