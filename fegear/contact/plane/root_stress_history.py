"""Root stress of a tooth on its way through the mesh, from its own load and its neighbours'."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.contact.plane.closing_faces import faces_of
from fegear.contact.plane.compliance import RootStressInfluence, Side
from fegear.contact.plane.root_stress import Felt, RootStress
from fegear.fem.alike_teeth import together

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement, Loaded
    from fegear.contact.plane.odd_compliance import OddCompliance
    from fegear.contact.plane.stress_rows import Rows
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
    place : ndarray, shape (n, P, L), or None
        Where along the fillet that is, as `RootStress.largest_and_place` has it.
    """

    member: Member
    side: Side
    x: Array
    stress: Array
    place: Array | None = None

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
    roots = RootStress.of(engagement.compliance, member, side, source)
    along = list(_along_fillets(engagement, loaded, roots, beyond))  # (P, L, points) each
    touching = touching_radius(loaded, member, beyond)
    contacts = loaded.grid.contacts
    places = np.arange(-beyond, contacts.x.shape[0] + beyond)
    x = contacts.x[0] + places[:, None] * engagement.pair.base_pitch
    low, high = within or (-np.inf, np.inf)
    asked = (x > low) & (x < high)
    stress, place = np.full((2, *touching.shape), np.nan)
    teeth = [engagement.compliance.tooth(member, int(contacts.number[0] + at), loaded.cycle) for at in places]
    for rows in together([roots.source.same_as(tooth, 1) for tooth in teeth]):
        wanted = asked[rows]
        flat = np.stack([along[row] for row in rows])[wanted]
        found = roots.largest_and_place(
            teeth[rows[0]], flat.reshape(-1, flat.shape[-1]), touching[rows][wanted].ravel()
        )
        for values, new in zip((stress, place), found, strict=True):
            part = values[rows]
            part[wanted] = new.reshape(-1, touching.shape[2])
            values[rows] = part
    return RootStressHistory(member, side, x, stress, place)


def touching_radius(loaded: Loaded, member: Member, beyond: int = 0) -> Array:
    """Radii at which the teeth of a gear are pressed, infinite where they are not, shape (n + 2 beyond, P, L) [m].

    A tooth on the path that carries no load is not pressed: no contact hides anything of its fillet.

    Parameters
    ----------
    loaded, member, beyond
        See `root_stress_history`.
    """
    contacts = loaded.grid.contacts
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    found = np.where(loaded.loads > 0.0, radius[:, :, None], np.inf)
    return np.pad(found, ((beyond, beyond), (0, 0), (0, 0)), constant_values=np.inf)


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
    yield from _along_fillets(engagement, loaded, RootStress.of(engagement.compliance, member, side, source), beyond)


class PressedFaces(NamedTuple):
    """Forces between faces of a gear's cracks that may close, (N, P, L) [N/m], and its source with free faces."""

    line_force: Array
    source: OddCompliance


def _pressed_faces(loaded: Loaded, roots: RootStress, face_width: float) -> PressedFaces | None:
    """Of a gear whose root stress comes from where its compliance does; None without such cracks."""
    faces, source = loaded.grid.matrices.faces, faces_of(roots.source)
    if faces is None or source is None or roots.member not in faces.of:
        return None
    forces = faces.forces(loaded.loads)[faces.of[roots.member]]
    return PressedFaces(forces / face_width, source.with_free_faces)


def _along_fillets(engagement: Engagement, loaded: Loaded, roots: RootStress, beyond: int) -> Iterator[Array]:
    compliance, contacts = engagement.compliance, loaded.grid.contacts
    radius = contacts.radius_driver if roots.member == "driver" else contacts.radius_driven
    n = radius.shape[0]
    pressed = _pressed_faces(loaded, roots, compliance.face_width)
    if pressed is not None:
        roots = replace(roots, source=pressed.source)
    reach = min(roots.reach, n - 1 + beyond)
    line_load = loaded.loads / compliance.face_width
    carries = np.asarray((line_load > 0.0).any(axis=2))
    numbers = [compliance.tooth(roots.member, int(j), loaded.cycle) for j in contacts.number]
    carrying: list[Carrying] = []
    for like in together([roots.source.same_as(number - reach, 2 * reach + 1) for number in numbers]):
        rows = roots.rows(numbers[like[0]], radius[like][carries[like]], reach)
        first = np.concatenate([[0], np.cumsum(carries[like].sum(axis=1))])
        for i, j in enumerate(like):
            if carries[j].any():
                of_pair = slice(first[i], first[i + 1])
                at = np.flatnonzero(carries[j])
                own = {k: row[of_pair] for k, row in rows.items()}
                carrying.append(Carrying(numbers[j], at, line_load[j, at], own))
    for place in range(-beyond, n + beyond):
        tooth = numbers[0] + roots.tooth(place)
        felt = [
            Felt(one.line_load, one.rows[tooth - one.tooth][:, None, :], one.at)
            for one in carrying if tooth - one.tooth in one.rows
        ]  # fmt: skip
        points = felt[0].row.shape[-1] if felt else roots.rows(tooth, radius[:1, 0], 0)[0].shape[1]
        stress = roots.superposed(felt, (*line_load.shape[1:], points))
        row = None if pressed is None else pressed.source.stress_by_faces(tooth, roots.side)
        yield stress if pressed is None or row is None else stress + np.einsum("kpl,sk->pls", pressed.line_force, row)


class Carrying(NamedTuple):
    """A loaded tooth, and what it does to those around it.

    Attributes
    ----------
    tooth : int
    at : ndarray of int, shape (Q,)
        Roll positions at which it carries load.
    line_load : ndarray, shape (Q, L)
        [N/m].
    rows : dict of int to ndarray, shape (Q, points)
        Stress along the fillets of teeth per unit line load [1/m], by how far they are from it.
    """

    tooth: int
    at: NDArray[np.intp]
    line_load: Array
    rows: Rows
