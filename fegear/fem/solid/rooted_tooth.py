"""What is asked of the fillets of a tooth with a width: of any of a solid ring, or of one that is odd."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Side
    from fegear.fem.solid.bands import Bands
    from fegear.fem.solid.fillet import SolidFillet


class RootedTooth(Protocol):
    """What tells of the fillets of a tooth under loads on it and on those beside it: see `SolidSolution`."""

    @property
    def tau(self) -> float:
        """Twist [rad/module]."""

    @property
    def reach(self) -> int:
        """K: teeth -K..K beside it are known."""

    @property
    def fillets(self) -> Mapping[Side, SolidFillet]:
        """Its fillets."""

    def moved(self, k: int, side: Side, loads: Array) -> Array:
        """Displacements of a fillet under loads on the flank of the tooth of which this one is tooth k."""

    def surface_stress(self, side: Side, moved: Array, zeta: ArrayLike) -> Array:
        """Stress by such displacements."""

    def root_end(self, k: int, side: Side, pressed: Bands) -> Array:
        """Arc length up to which root stress is looked for."""
