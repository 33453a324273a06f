"""Root stress of one 3D tooth in a vibrating train: that under the mean force, and its slope times the increments.

The forces along the contact lines change with the transmission error, each station's by its part of the tangent mesh
stiffness (`fegear.contact.wide.roots_about_load`). Stress at every place is linear in what vibration adds to that
error; the largest of all places is not, and may move along the face.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.train.single_tooth import ToothRootStress
from fegear.dynamics.train.tooth_force import tooth_force

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.wide.roots_about_load import RootsAboutLoad
    from fegear.dynamics.train.gear_train import GearTrain


def stress_on_face(
    train: GearTrain, mesh: int, known: RootsAboutLoad, x: Array, speed: float, harmonics: int
) -> ToothRootStress:
    """Root stress of a 3D tooth at places of its contact, at one speed.

    Parameters
    ----------
    train : GearTrain
    mesh : int
    known : RootsAboutLoad
        About the mean force of the mesh; its x is that of the pair as it is named.
    x : ndarray, shape (n,)
        As the mesh runs [m].
    speed : float
        Of the body that speeds refer to [rad/s].
    harmonics : int
    """
    made = train.meshes[mesh]
    roots = known.at(x, mirrored=not made.a_drives)
    # the force on a spring of 1 N/m that always carries is the transmission error
    error = tooth_force(
        train.train, train.errors, mesh, speed / train.speed_ratio, x, np.ones(x.size), np.zeros(x.size),
        made.pair.base_pitch, harmonics=harmonics, phases=train.phases, ripple=train.ripple,
    )  # fmt: skip
    total, own, static = (
        roots.largest(closer) for closer in (error.with_others - error.static, error.own, np.zeros(x.size))
    )
    # at each place stress is linear in the error: the largest of all is largest at one end of its range
    ends = (error.own + part.sum(axis=0) for part in (error.cross_least, error.cross_reach))
    worst = np.maximum.reduce([total.tension, *(roots.largest(closer).tension for closer in ends)])
    return ToothRootStress(
        total.tension, worst, own.tension, static.tension, roots.share * np.abs(own.tension).max(), total.z, static.z
    )
