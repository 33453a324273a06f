"""One tooth of a ring on pins, and all of them: what differs from the mean over the teeth that `Influence` holds."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.influence import SIDES, Influence, Side

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array


def tooth_on_pins(influence: Influence, tooth: int) -> Influence:
    """The influence functions with one tooth of the ring loaded, counted clockwise from tooth 0; its errors unknown."""
    pins = influence.pins
    if pins is None:
        return influence
    loaded, seen = slice(0, influence.flank.dofs.size), _fillet_ports(influence)

    def less(k: int, watched: slice) -> Array:
        return pins.mean(k, watched, loaded) - pins.given(k, tooth, watched, loaded)

    compliance = {k: c + less(k, loaded) for k, c in influence.compliance.items()}
    stress = {
        (k, side): s + _modulus(influence) * (influence.fillets[side].strain @ less(k, seen[side]))
        for (k, side), s in influence.stress.items()
    }
    return replace(influence, compliance=compliance, stress=stress, lower=None, pins=None)


def pulled_share(influence: Influence) -> float:
    """Largest forces of rollers of either sense, the smaller by the larger one, of loads amid the flank of any tooth.

    Rollers that press and others that pull, which none does: zero where all are of one sense.
    """
    pins = influence.pins
    if pins is None or influence.support is None or not influence.support.rollers:
        return 0.0
    radius = 0.5 * (influence.flank.lowest_radius + influence.flank.highest_radius)
    load = influence.remote(np.array([radius]), REFERENCE_HALF_WIDTH)[:, 0]
    count, worst = influence.support.pins, 0.0
    for moved in pins.by_tooth[pins.reach : pins.reach + pins.teeth]:
        force = (pins.inverse @ (moved[:, : load.size] @ load))[:count]
        of_both = np.sort([float(force.max(initial=0.0)), float(-force.min(initial=0.0))])
        worst = max(worst, float(of_both[0] / of_both[1]))
    return worst


def over_the_teeth(influence: Influence, radius: ArrayLike, patch: float, half_width: ArrayLike) -> dict[str, Array]:
    """c_self, root_tension and root_compression of each tooth that stands differently to the pins, shape (T, P).

    As of `tooth_on_pins`, but from what the pins make of the loads alone.

    Parameters
    ----------
    influence : Influence
    radius, patch, half_width
        As of `Influence.self_compliance`.
    """
    mean, pins = influence.self_compliance(radius, patch, half_width), influence.pins
    loads, above, width = influence.fillet_loads(radius, half_width)
    stress = {side: (loads @ influence.stress[0, side].T).T for side in SIDES}
    approach, off = np.zeros((1, above.size)), {side: np.zeros((1, *stress[side].shape)) for side in SIDES}
    if pins is not None:
        moved = pins.by_tooth[pins.reach : pins.reach + pins.teeth]
        by_load = np.stack([(loads @ part[:, : loads.shape[1]].T).T for part in moved])
        forces = pins.inverse @ by_load
        approach = -(by_load * forces).sum(axis=1)
        for side, ports in _fillet_ports(influence).items():
            strain = influence.fillets[side].strain @ (moved[:, :, ports].transpose(0, 2, 1) @ forces)
            off[side] = -_modulus(influence) * strain
    found = {"c_self": mean + approach - approach.mean(axis=0)}
    for side in SIDES:
        each, curve = stress[side] + off[side] - off[side].mean(axis=0), influence.fillet_curve(side)
        found[f"root_{side}"] = np.stack([curve.largest_below(part, above, width)[0] for part in each])
    return found


def _modulus(influence: Influence) -> float:
    """Stress in a free surface over its strain, E = 1."""
    return 1.0 / (1.0 - influence.poisson_ratio**2) if influence.plane == "strain" else 1.0


def _fillet_ports(influence: Influence) -> dict[Side, slice]:
    """Where the fillets' unknowns stand among those that pins move, after the flank's."""
    first = influence.flank.dofs.size
    second = first + influence.fillets["tension"].dofs.size
    return {"tension": slice(first, second), "compression": slice(second, None)}
