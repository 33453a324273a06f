"""A solid gear with odd teeth as pairs take it: solved, and once more coarser, which shows its error."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.base.plain import read_only
from fegear.base.solution_cache import SolutionCache
from fegear.fem.plane.bore import check_bore
from fegear.fem.plane.odd.odd_ring import OddRing
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import shape_codec
from fegear.fem.plane.trace import LoadedFlank
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.fillet import SolidFillet
from fegear.fem.solid.odd.odd_solid import OddSolid
from fegear.fem.solid.odd.odd_solid_solution import solve_odd_solid
from fegear.fem.solid.odd.odd_window import OddWindow
from fegear.fem.solid.odd.solid_kind import KindOfMotion, SolidKind
from fegear.fem.solid.settings import SolidSettings, check_solid
from fegear.fem.solid.solution import SolidSolution
from fegear.geometry.gear_body import GearBody

if TYPE_CHECKING:
    from fegear.fem.solid.odd.odd_solid_solution import SolidOddity
    from fegear.geometry.involute_tooth import InvoluteTooth

#: What a solution consists of, for those that keep it.
_KINDS = (
    OddSolid, OddWindow, SolidKind, KindOfMotion, OddRing, SolidSolution, FaceFunctions, LoadedFlank, SolidFillet,
    SolidSettings, MeshSettings, GearBody,
)  # fmt: skip


@dataclass(frozen=True)
class OddSolidInfluence:
    """c_ij and fillet stress of a solid gear with odd teeth.

    Parameters
    ----------
    fine : OddSolid
        The solution that every number comes from.
    coarse : OddSolid or None
        A cheaper one whose difference shows the error of `fine`.
    seconds : mapping of str to float
    """

    fine: OddSolid
    coarse: OddSolid | None
    seconds: Mapping[str, float] = field(compare=False)

    @property
    def settings(self) -> SolidSettings:
        """What `fine` was solved with."""
        return self.fine.settings


def odd_solid_influence(
    section: InvoluteTooth,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings,
    odd: Mapping[int, SolidOddity],
    *,
    reach: int = 1,
    body: GearBody | None = None,
    estimate_error: bool = True,
    cache: SolutionCache | None = None,
) -> OddSolidInfluence:
    """Solve a gear with a width and odd teeth.

    Parameters
    ----------
    section, tau, width, poisson_ratio, bore_radius, settings, reach, body
        As of `fegear.fem.solid.influence.solid_influence`.
    odd : mapping of int to Crack or Missing
        By the number of the tooth.
    estimate_error : bool
        Whether to spend a part again on a coarser solution.
    cache : SolutionCache, optional
        Where solved gears are recalled from and kept.

    Raises
    ------
    InputError
        If odd teeth do not fit the gear.
    RangeError
        If the gear cannot be meshed.
    """
    check_bore(section, bore_radius)
    check_solid(section, tau, width, poisson_ratio, settings, None, reach)
    known = SolutionCache() if cache is None else cache

    def solve(chosen: SolidSettings) -> OddSolid:
        found: OddSolid = known.call_kept(
            shape_codec(section, _KINDS), solve_odd_solid, section, tau, width, poisson_ratio, bore_radius, chosen,
            odd=dict(odd), reach=reach, body=body,
        ).value  # fmt: skip
        return found

    fine = solve(settings)
    coarse = solve(settings.coarser(width)) if estimate_error else None
    return OddSolidInfluence(fine, coarse, read_only(dict(fine.seconds)))
