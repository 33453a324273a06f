"""Power that tooth friction takes, from the computed load on the flanks and a friction law.

Friction is normal force times coefficient against the sliding of the flanks; it is averaged over a base pitch. The
loads are those without friction: what friction changes in them is neglected, a few per cent of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.formulas.flank_speeds import flank_speeds
from fegear.formulas.friction import computed

if TYPE_CHECKING:
    from fegear.contact.plane.pair_history import PairHistory
    from fegear.contact.surface import FrictionLaw
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class ToothLoss:
    """What tooth friction takes of the power of a pair.

    Parameters
    ----------
    x, load, coefficient, power : ndarray, shape (N,)
        The coefficient is weighted with the load along the contact line.
    loss : float
        Mean over time of all pairs in contact.
    transmitted : float
        Of the pair.
    loss_factor : float
        That a coefficient of 1 would take over the power transmitted.
    """

    x: Array = shown("mm", "position of the tooth pair on the line of action, from the pitch point")
    load: Array = shown("N", "load on the tooth pair", label="load on the pair")
    coefficient: Array = shown("", "friction coefficient", name="friction_coefficient")
    power: Array = shown("W", "power loss of this tooth pair", name="power_loss", label="power lost")
    loss: float = shown("W", "mean gear mesh power loss", name="tooth_loss")
    transmitted: float = shown("W", "", name="transmitted_power")
    loss_factor: float = shown("", "tooth loss factor H_V with FE load")

    @property
    @shows("", "equivalent constant friction coefficient (same loss)", name="mean_friction")
    def mean_coefficient(self) -> float:
        """Coefficient that would take as much, were it the same everywhere."""
        return self.loss / (self.loss_factor * self.transmitted) if self.loss_factor else 0.0

    @property
    @shows("", "efficiency of the gear mesh only")
    def efficiency(self) -> float:
        """Of the teeth alone."""
        return 1.0 - self.loss / self.transmitted


def loss_over_path(pair: GearPair, history: PairHistory, case: int, speed: float, law: FrictionLaw) -> ToothLoss:
    """Of plane teeth, one tooth pair followed over its path.

    Parameters
    ----------
    pair : GearPair
    history : PairHistory
        Whose positions stand on either side of every jump of the load.
    case : int
        Number of the load.
    speed : float
        Of the driver [rad/s].
    law : callable
    """
    x, load = _with_pitch_point(history.x, history.load[:, case])
    at = flank_speeds(pair, x, speed)
    mu = np.asarray(law(at, load / pair.face_width))
    power = mu * load * np.abs(at.sliding)
    pitch = pair.base_pitch
    total = float(load.sum())
    transmitted = float(history.load[:, case].max() / history.share[:, case].max()) * speed * pair.driver.base_radius
    if not total > 0.0:
        transmitted = math.nan
    mean = float(np.trapezoid(load * np.abs(x), x)) / pitch / (transmitted / (speed * pair.driver.base_radius))
    return ToothLoss(
        x, load, mu, power, float(np.trapezoid(power, x)) / pitch, transmitted, computed(pair, mean)
    )  # fmt: skip


def _with_pitch_point(x: Array, load: Array) -> tuple[Array, Array]:
    """Positions with the pitch point among them, where sliding has a kink."""
    if not x[0] < 0.0 < x[-1] or (x == 0.0).any():
        return x, load
    at = int(np.searchsorted(x, 0.0))
    return np.insert(x, at, 0.0), np.insert(load, at, float(np.interp(0.0, x, load)))


def loss_over_face(found: LoadedFlanks, case: int, speed: float, law: FrictionLaw) -> ToothLoss:
    """Of teeth with a width, every station of the contact lines with its own load and sliding.

    Parameters
    ----------
    found : LoadedFlanks
    case : int
        Number of the load.
    speed : float
        Of the driver [rad/s].
    law : callable
    """
    pair, lines = found.pair, found.lines
    force = np.where(lines.present, found.contact.force[:, :, case], 0.0)
    at = flank_speeds(pair, lines.x, speed)
    tilt = math.cos(pair.driver.base_helix_angle)  # the normal force is that much larger
    mu = np.asarray(law(at, np.where(lines.present, found.line_load[:, :, case], 0.0)))
    power = mu * force * np.abs(at.sliding) / tilt
    load = float(found.load[case])
    mean = float(lines.mean((force * np.abs(lines.x)).sum(axis=1))) / load
    where = [(p, s) for p in range(lines.roll.size) for s in lines.at(p)]
    place = np.array([lines.roll[p] + lines.pair[p, s.start] * pair.base_pitch for p, s in where])
    order = np.argsort(place)
    borne = np.array([force[p, s].sum() for p, s in where])[order]
    rub = np.array([(mu[p, s] * force[p, s]).sum() for p, s in where])[order]
    return ToothLoss(
        place[order], borne, np.divide(rub, borne, out=np.zeros_like(rub), where=borne > 0.0),
        np.array([power[p, s].sum() for p, s in where])[order], float(lines.mean(power.sum(axis=1))),
        load * speed * pair.driver.base_radius, computed(pair, mean),
    )  # fmt: skip


def change_of_loss(found: ToothLoss, other: ToothLoss) -> float:
    """Larger share of two by which loss factor and loss change from one solution to another of it."""
    error = abs(other.loss_factor / found.loss_factor - 1.0)
    return max(error, abs(other.loss / found.loss - 1.0)) if found.loss else error


def moved_at_most(found: LoadedFlanks, case: int, speed: float, law: FrictionLaw) -> float:
    """By how much the loss changes at most where compliances change by up to a share, over the loss and that share.

    The force of a roll position stays; it moves from stations that get softer to those that get stiffer, and loses
    more where flanks slide faster. It moves furthest where all change that slide faster than the mean, and no others.

    Parameters
    ----------
    found : LoadedFlanks
    case : int
        Number of the load.
    speed : float
        Of the driver [rad/s].
    law : callable
    """
    lines = found.lines
    force = np.where(lines.present, found.contact.force[:, :, case], 0.0)
    at = flank_speeds(found.pair, lines.x, speed)
    rub = np.asarray(law(at, np.where(lines.present, found.line_load[:, :, case], 0.0))) * np.abs(at.sliding)
    shares = []
    for each in (rub, np.abs(lines.x)):  # the loss, and what it is without a coefficient
        lost = np.where(lines.present, each, 0.0)
        mean = (force * lost).sum(axis=1, keepdims=True) / force.sum(axis=1, keepdims=True)
        moved = force * np.maximum(lost - mean, 0.0)
        whole = float(lines.mean((force * lost).sum(axis=1)))
        shares.append(float(lines.mean(moved.sum(axis=1))) / whole if whole > 0.0 else 0.0)
    return max(shares)
