"""Root stress of a tooth on its way through the mesh, from its own load and its neighbours'."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.arrays import Array
    from fegear.contact.compliance import RootStressInfluence, Side
    from fegear.contact.engagement import Engagement, Loaded
    from fegear.contact.meshing import Contacts
    from fegear.geometry.pair import Member

    Kernels = dict[int, Array]


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
        return np.asarray(flat.max(axis=0) if self.side == "tension" else flat.min(axis=0))


def root_stress_kernels(
    engagement: Engagement,
    contacts: Contacts,
    member: Member,
    side: Side = "tension",
    beyond: int = 0,
    source: RootStressInfluence | None = None,
) -> Kernels:
    """Stress along the fillet of tooth k per unit line load at each contact, (points, n, P) for each k [1/m].

    It is zero where the pair is out of reach and carries nothing.

    Parameters
    ----------
    engagement, contacts, member, side, beyond
        See `root_stress_history`.
    source : RootStressInfluence, optional
        Where this gear's root stress comes from; by default where its compliance does.

    Raises
    ------
    InputError
        If the source knows no root stress.
    """
    source = source or engagement.compliance.source(member)
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    n = radius.shape[0]
    reach = min(source.reach, n - 1 + beyond) if engagement.compliance.coupling else 0
    kernels: Kernels = {}
    for k in range(-reach, reach + 1):
        kernel = source.root_stress(k, radius[contacts.present], side)
        if kernel is None:
            raise InputError(
                "results",
                '"root-stress"',
                "cannot come from a compliance source that knows deflections alone",
                'set pair.root_stress.source = "fe" or a formula',
            )
        kernels[k] = np.zeros((kernel.shape[0], *radius.shape))
        kernels[k][:, contacts.present] = kernel
    return kernels


def root_stress_history(
    engagement: Engagement,
    loaded: Loaded,
    member: Member,
    side: Side = "tension",
    beyond: int = 0,
    kernels: Kernels | None = None,
) -> RootStressHistory:
    """Superpose the fillet stress of a tooth's own load and of its neighbours' loads, then take the extreme.

    Parameters
    ----------
    engagement : Engagement
    loaded : Loaded
    member : {"driver", "driven"}
    side : {"tension", "compression"}
        The tension fillet lies below the loaded flank.
    beyond : int
        Teeth before the first and after the last pair that can touch, in addition: they feel their neighbours' loads.
    kernels : dict, optional
        From `root_stress_kernels` with the same arguments, when many loads are superposed at the same contacts.

    Raises
    ------
    InputError
        If the compliance source of this gear knows no root stress.
    """
    contacts = loaded.grid.contacts
    if kernels is None:
        kernels = root_stress_kernels(engagement, contacts, member, side, beyond)
    signed = np.max if side == "tension" else np.min
    stress = np.stack(
        [signed(total, axis=0) for total in superposed_stress(engagement, loaded, member, beyond, kernels)]
    )
    teeth = np.arange(-beyond, contacts.x.shape[0] + beyond)
    return RootStressHistory(member, side, contacts.x[0] + teeth[:, None] * engagement.pair.base_pitch, stress)


def superposed_stress(
    engagement: Engagement, loaded: Loaded, member: Member, beyond: int, kernels: Kernels
) -> Iterator[Array]:
    """Stress along the fillet of one tooth after the other, from its own load and its neighbours', (points, P, L) [Pa].

    Parameters
    ----------
    engagement, loaded, member, beyond
        See `root_stress_history`; teeth come in its order.
    kernels : dict
        From `root_stress_kernels` at the contacts of `loaded`.
    """
    n = loaded.loads.shape[0]
    towards_load = 1 if member == "driver" else -1  # tooth +1 is ahead of a driving tooth and behind a driven one
    line_load = loaded.loads / engagement.compliance.face_width
    carrying = [other for other in range(n) if (line_load[other] > 0.0).any()]
    for tooth in range(-beyond, n + beyond):
        total = np.zeros((kernels[0].shape[0], *line_load.shape[1:]))
        for other in carrying:
            k = towards_load * (tooth - other)
            if k in kernels:
                total += kernels[k][:, other, :, None] * line_load[other][None]
        yield total
