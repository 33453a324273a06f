"""Relief that removes the transmission error at the design load (Mark 4.6a, b), with the full influence matrix.

Each gear's tooth is relieved by the largest of its deflections less its deflection under the design loads on itself and
on its neighbours, so that the loaded flanks are perfect involutes: m(x) = const - sum_j' c_jj'(x) W_j'(x). Beyond the
design zone, where the tooth carries nothing at the design load, the part from its own load goes on as a straight line
(the paper's extrapolation) and the part from its neighbours' loads as it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.contact.plane.engagement import Engagement
from fegear.design.excitation_relief import MinimumExcitationRelief
from fegear.design.loading import LoadingFunction
from fegear.design.oil_film import OilFilm
from fegear.design.relief_bound import refuse_deeper_than_the_tooth
from fegear.geometry.relief import TabulatedRelief

#: Largest distance of a tabulated relief from the designed one, over the pair's largest deflection.
_CHORD = 1e-6


#: Nodes no nearer than this fraction of the path: nearer ones would print as the same roll angle.
_NEAREST = 1e-7


def minimum_excitation(
    engagement: Engagement,
    loading: LoadingFunction,
    load: float,
    *,
    full_matrix: bool = True,
    film: OilFilm | None = None,
) -> Engagement:
    """Give both gears of a pair the relief of (4.6) for a design load.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs are replaced.
    loading : LoadingFunction
        How the pairs are to share the load.
    load : float
        W_d [N].
    full_matrix : bool
        Whether the design counts what a loaded tooth does to its neighbours; False is the paper's (5.4).
    film : OilFilm, optional
        Between the flanks at the design load.

    Raises
    ------
    RangeError
        If a relief is deeper than its tooth can take: a design contact ratio at or just above a whole number loads a
        tooth almost at once, and the straight line beyond the design zone is then all but vertical.
    """
    c = engagement.compliance if full_matrix else replace(engagement.compliance, coupling=False)
    driver = MinimumExcitationRelief(c, "driver", loading, load, film)
    driven = MinimumExcitationRelief(c, "driven", loading, load, film)
    refuse_deeper_than_the_tooth(driver, driven)
    return replace(engagement, driver_relief=driver, driven_relief=driven)


@dataclass(frozen=True, slots=True)
class ReliefTable:
    """Relief of one gear over its path, as a drawing gives it; arrays of shape (P,)."""

    x: Array = shown("mm", "position on the line of action, positive towards the driver's tip", table="flank")
    radius: Array = shown("mm", "radius of the flank point", table="flank")
    roll_angle: Array = shown("deg", "roll angle of the flank point", label="roll angle", table="flank")
    load: Array = shown("N", "design load on the tooth pair", label="load", table="flank")
    relief: Array = shown(
        "um", "amount of modification, normal to the flank", label="amount of modification", table="flank"
    )
    deflection: Array = shown(
        "um",
        "deflection of this flank under the design load (compensated by the relief)",
        label="deflection of the flank",
        table="flank",
    )

    def relieved(self) -> TabulatedRelief:
        """The relief that straight lines between the nodes make."""
        order = np.argsort(self.roll_angle)
        return TabulatedRelief(self.roll_angle[order], self.relief[order])


def relief_nodes(*reliefs: MinimumExcitationRelief, tolerance: float | None = None) -> Array:
    """Positions at which designed reliefs are to be tabulated so that straight lines between them keep to the design.

    Every kink of the loading and of a table of compliances is a node, and pieces are cut until the straight line
    over each is near enough: nodes crowd where the load starts, W ln W having an infinite slope there.

    Parameters
    ----------
    reliefs : MinimumExcitationRelief
        Of one pair.
    tolerance : float, optional
        Largest distance from any of them [m]; by default 1e-6 of the pair's largest deflection.

    Returns
    -------
    ndarray, shape (P,)
        From the start to the end of the path of contact [m].
    """
    pair = reliefs[0].compliance.pair
    bound = _CHORD * sum(r.offset for r in reliefs) if tolerance is None else tolerance
    places = [pair.x_start, pair.x_end]
    for r in reliefs:
        places += [float(x) for x in pair.x_of_roll(np.array(r.kinks), r.member)]
        radii = np.array(r.compliance.source(r.member).kinks)
        places += [float(x) for x in pair.x_of_radius(radii, r.member)]
    x = np.unique(np.clip(places, pair.x_start, pair.x_end))
    nearest = _NEAREST * pair.path_length
    x = x[np.concatenate([[True], np.diff(x) > nearest])]
    x[-1] = pair.x_end
    inside = np.array([0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95])
    left, right, done = x[:-1], x[1:], [x]
    while left.size:
        trial = left + np.multiply.outer(inside, right - left)
        off = np.zeros(left.size)
        for r in reliefs:
            a, b = r.at(left), r.at(right)
            off = np.maximum(off, np.abs(r.at(trial) - a - np.multiply.outer(inside, b - a)).max(axis=0))
        split = (off > bound) & (right - left > 4.0 * nearest)
        left, right = left[split], right[split]
        # Halved while far off; near the goal into just as many pieces as the square of their length asks for.
        pieces = np.where(off > 16.0 * bound, 2, np.ceil(np.sqrt(off / bound)))[split].astype(int)
        cuts = [np.linspace(a, b, n + 1) for a, b, n in zip(left, right, pieces, strict=True)]
        done += [cut[1:-1] for cut in cuts]
        left, right = np.concatenate([x[:0], *(c[:-1] for c in cuts)]), np.concatenate([x[:0], *(c[1:] for c in cuts)])
    return np.sort(np.concatenate(done))


def relief_table(relief: MinimumExcitationRelief, positions: int | ArrayLike | None = None) -> ReliefTable:
    """Tabulate a designed relief over the whole path of contact.

    Parameters
    ----------
    relief : MinimumExcitationRelief
    positions : int or array_like, optional
        Positions on the line of action [m], or how many, evenly spaced; by default `relief_nodes`.
    """
    pair = relief.compliance.pair
    if positions is None:
        x = relief_nodes(relief)
    elif np.ndim(positions) == 0:
        x = np.linspace(pair.x_start, pair.x_end, int(np.asarray(positions)))
    else:
        x = np.array(positions, dtype=float)
    return ReliefTable(
        x,
        np.asarray(pair.radius(x, relief.member)),
        np.asarray(pair.roll_angle(x, relief.member)),
        relief.load * relief.loading.fraction(x),
        relief.at(x),
        relief.deflection(x),
    )
