"""Root stress of one tooth of either gear under the forces of a moving train."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.single_tooth import force_at
from fegear.dynamics.tooth_force import root_stress

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact.compliance import RootStressInfluence
    from fegear.dynamics.gear_train import GearTrain
    from fegear.dynamics.tooth_force import ToothForce
    from fegear.geometry.pair import GearPair, Member

#: Positions over the flank at which the source's own error is asked for.
_FEW = 9


@dataclass(frozen=True)
class ToothRootStress:
    """Largest root tension of one tooth, over the positions of the force on it, shape (n,) [Pa].

    Parameters
    ----------
    total : ndarray
        With all meshes' shares, at the phases given.
    any_phase : ndarray
        What it does not exceed, whatever the phases of the other meshes.
    own : ndarray
        Without the other meshes' share.
    static : ndarray
        Quasi-static.
    error : ndarray
        What the source leaves in `own`; NaN where it does not know.
    """

    total: Array
    any_phase: Array
    own: Array
    static: Array
    error: Array


def tooth_root_stress(
    source: RootStressInfluence, pair: GearPair, member: Member, around: dict[int, ToothForce]
) -> ToothRootStress:
    """Root stress of a tooth under its own force and those on the teeth around it.

    Parameters
    ----------
    source : RootStressInfluence
        Of its gear: `fegear.contact.finite_element_compliance` or `fegear.contact.formula_root_stress`.
    pair : GearPair
        As it runs.
    member : {"driver", "driven"}
        What the gear is as the pair runs.
    around : mapping of int to ToothForce
        See `forces_around`.
    """
    kernels = _kernels(source, pair, member, around)
    return ToothRootStress(
        root_stress({k: f.with_others for k, f in around.items()}, kernels),
        _at_worst_phases(around, kernels),
        root_stress({k: f.total for k, f in around.items()}, kernels),
        root_stress({k: f.static for k, f in around.items()}, kernels),
        _own_error(source, pair, member, around[0]),
    )


def forces_around(
    train: GearTrain, mesh: int, force: ToothForce, number: int, speed: float, harmonics: int, reach: int
) -> dict[int, ToothForce]:
    """Forces on a tooth pair and on those around it at the same moment, by their place beside it.

    Parameters
    ----------
    train : GearTrain
    mesh : int
    force : ToothForce
        On tooth pair `number`.
    number : int
    speed : float
        Of the body that speeds refer to [rad/s].
    harmonics : int
    reach : int
        How many tooth pairs on either side; 0 for the one alone.
    """
    around = {0: force}
    for k in range(-reach, reach + 1):
        if k:
            # k base pitches ahead at the same moment: it was at the pitch point that much earlier
            ahead = force.x + k * train.meshes[mesh].pair.base_pitch
            around[k] = force_at(train, mesh, speed, ahead, harmonics, number - k)
    return around


def _kernels(
    source: RootStressInfluence, pair: GearPair, member: Member, around: dict[int, ToothForce]
) -> dict[int, Array]:
    """Stress along the fillet of the tooth looked at per unit force on each tooth around it, (points, n) [Pa/N]."""
    width = pair.face_width
    ahead = 1 if member == "driver" else -1  # tooth +1 is ahead of a driving tooth and behind a driven one
    found = {}
    for k, force in around.items():
        on_path = np.clip(force.x, pair.x_start, pair.x_end)
        found[k] = np.asarray(source.root_stress(-ahead * k, pair.radius(on_path, member), "tension")) / width
    return found


def _at_worst_phases(around: dict[int, ToothForce], kernels: dict[int, Array]) -> Array:
    """Bound of the root tension: each other mesh does its worst to each force, in the sense that each point feels."""
    fillet = 0.0
    for k, force in around.items():
        push, pull = force.cross_reach.sum(axis=0), force.cross_least.sum(axis=0)
        fillet = fillet + kernels[k] * force.total + np.maximum(kernels[k] * push, kernels[k] * pull)
    return np.asarray(np.max(fillet, axis=0))


def _own_error(source: RootStressInfluence, pair: GearPair, member: Member, force: ToothForce) -> Array:
    """What the source leaves in the stress of the tooth's own load [Pa]."""
    x = np.linspace(pair.x_start, pair.x_end, _FEW)
    width = pair.face_width
    usual = source.root_stress_error(pair.radius(x, member)) / width
    return np.asarray(np.interp(force.x, x, usual) * np.abs(force.total))
