"""How flank and fillets of a condensed sector follow its sides, and loads on its own flank with the sides held.

That is all that a ring of unlike sectors asks of one. The plain ring keeps it of its sector, so that a ring with odd
teeth need not assemble and condense the ordinary one again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.fem.plane.sector_sides import ports_of

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.root_stress import FilletStrain
    from fegear.fem.plane.sector_sides import BetweenSides
    from fegear.fem.plane.trace import LoadedFlank
    from fegear.geometry.gear import Plane

    Side = Literal["tension", "compression"]


@dataclass(frozen=True)
class SectorRows:
    """A sector seen from its sides; E = 1, lengths in modules.

    Parameters
    ----------
    held : ndarray, shape (2 m, 2 m)
        Stiffness between the sides.
    flank_follows : ndarray, shape (2n, 2m)
        Motion of the unknowns of the loaded run under that of sides A and B.
    flank_own : ndarray, shape (2n, 2n)
        The same under forces on itself, the sides held.
    stress_follows, stress_own : mapping of side to ndarray, shape (points, 2m) and (points, 2n)
        Tangential stress of the fillets likewise.
    """

    held: Array
    flank_follows: Array
    flank_own: Array
    stress_follows: Mapping[Side, Array]
    stress_own: Mapping[Side, Array]


def stress_modulus(poisson_ratio: float, plane: Plane) -> float:
    """Stress per strain along a free surface, E = 1."""
    return 1.0 / (1.0 - poisson_ratio**2) if plane == "strain" else 1.0


def sector_rows(
    part: BetweenSides, flank: LoadedFlank, fillets: Mapping[Side, FilletStrain], poisson_ratio: float, plane: Plane
) -> SectorRows:
    """Gather what of a condensed sector is loaded and looked at."""
    follow = np.hstack([part.follow_a, part.follow_b])
    run = ports_of(part.sector, flank.dofs)
    modulus = stress_modulus(poisson_ratio, plane)
    rows = {side: ports_of(part.sector, fillet.dofs) for side, fillet in fillets.items()}
    return SectorRows(
        held=part.held,
        flank_follows=follow[run],
        flank_own=part.own[np.ix_(run, run)],
        stress_follows={side: modulus * (fillet.strain @ follow[rows[side]]) for side, fillet in fillets.items()},
        stress_own={
            side: modulus * (fillet.strain @ part.own[np.ix_(rows[side], run)]) for side, fillet in fillets.items()
        },
    )
