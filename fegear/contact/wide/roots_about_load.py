"""Root stress of a tooth with a width while its gears vibrate about a load: that under the load, and its tangent.

As the transmission error grows by d, every station that touches carries more by its part of the tangent mesh stiffness
times d (`fegear.contact.wide.mesh_matrix`), and stress is linear in the forces on the stations: at every point up the
fillet and along the face it is that under the load plus its slope times d. The largest of them may move.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays, first_of_largest
from fegear.contact.wide.mesh_matrix import mesh_stiffness

if TYPE_CHECKING:
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.fem.solid.fillet import SolidFillet
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.geometry.pair import Member


class LargestAlongFace(NamedTuple):
    """Largest root tension of a tooth at N of its positions, and where along the face it is.

    Attributes
    ----------
    tension : ndarray, shape (N,)
        [Pa].
    z : ndarray, shape (N,)
        From the middle of the common face [m].
    """

    tension: Array
    z: Array


@dataclass(frozen=True)
class RootsAboutLoad(ReadOnlyArrays):
    """Root stress of a loaded flank's fillet; T positions of its tooth, Z places along the face, S points up it.

    Parameters
    ----------
    x : ndarray, shape (T,)
        Of the tooth's contact at mid-face, ascending [m].
    z : ndarray, shape (Z,)
        From the middle of the common face [m].
    stress, slope : ndarray, shape (S, Z, T)
        Along the fillet in the transverse section [Pa], and its change per change of the transmission error [Pa/m].
    end : ndarray, shape (Z, T)
        How far up the fillet stress is root stress [modules].
    share : ndarray, shape (T,)
        Estimated error of the largest stress over the largest one of all positions; NaN if unknown.
    fillet : SolidFillet
    """

    x: Array
    z: Array
    stress: Array
    slope: Array
    end: Array
    share: Array
    fillet: SolidFillet

    def at(self, x: Array, *, mirrored: bool = False) -> RootsAboutLoad:
        """The same at other positions, by straight lines between those of this one.

        Parameters
        ----------
        x : ndarray, shape (N,)
            [m].
        mirrored : bool
            Whether they count the other way, as where the named driven gear drives.
        """
        wanted = -x if mirrored else x
        right = np.clip(np.searchsorted(self.x, wanted), 1, self.x.size - 1)
        left = right - 1
        part = np.clip((wanted - self.x[left]) / (self.x[right] - self.x[left]), 0.0, 1.0)

        def between(values: Array) -> Array:
            return np.asarray(values[..., left] * (1.0 - part) + values[..., right] * part)

        # between two positions stress may be that of a contact where it is at either of them; at one of them it is not
        ends = np.minimum(
            np.where(part < 1.0, self.end[:, left], np.inf), np.where(part > 0.0, self.end[:, right], np.inf)
        )
        return RootsAboutLoad(
            x, self.z, between(self.stress), between(self.slope), ends, between(self.share), self.fillet
        )

    def largest(self, closer: Array) -> LargestAlongFace:
        """Largest tension up the fillet and along the face, with so much more transmission error, shape (T,) [m]."""
        total = self.stress + self.slope * closer
        value = self.fillet.largest(total.reshape(total.shape[0], -1), 1.0, self.end.ravel())[0]
        value = value.reshape(self.z.size, -1)
        at = first_of_largest(value, axis=0), np.arange(self.x.size)
        return LargestAlongFace(value[at], self.z[at[0]])


def roots_about_load(loaded: LoadedWidePair, member: Member, influence: SolidInfluence, load: float) -> RootsAboutLoad:
    """Root stress of one gear about a load [N], at the roll positions of the whole base pitch.

    The error is that of the root stress at the nominal load, as a share of the largest one.

    Parameters
    ----------
    loaded : LoadedWidePair
    member : {"driver", "driven"}
    influence : SolidInfluence
        Of that gear.
    load : float
    """
    many, z, module = loaded.over.found, loaded.places_along, loaded.pair.driver.module
    finer = replace(loaded.flanks, positions=many.lines.roll.size)
    about = finer.solve([load], loaded.gaps, many.known)
    rooted = loaded.rooted(member, about, influence.fine)
    force = about.contact.force[:, :, 0]
    more = mesh_stiffness(about, loaded.over.points).stations[:, :, 0]
    stress, slope = (rooted.surface("tension", one, z)[0] / module**2 for one in (force, more))
    share = np.full(rooted.x.size, np.nan)
    if loaded.estimated:
        known = loaded.tooth_stress(member, influence)
        at, largest = loaded.at, float(known.largest_tension[loaded.at])
        off = np.interp(rooted.x, known.x, known.tension_error[:, at])
        share = np.maximum(off, known.error(at) or 0.0) / largest
    return RootsAboutLoad(
        rooted.x, z, stress, slope, rooted.ends("tension").at(z / module, force), share,
        rooted.solution.fillets["tension"],
    )  # fmt: skip
