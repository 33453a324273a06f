"""Every choice that trades accuracy against time in the finite-element part, in modules."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

from fegear.errors import InputError


@dataclass(frozen=True, slots=True)
class MeshSettings:
    """Edge lengths and order of the sector's mesh; all lengths in modules, so one choice serves every size.

    Parameters
    ----------
    root_edge_length : float
        Edges along both fillets.
    flank_edge_length : float
        Edges along the loaded flank.
    tip_edge_length, junction_edge_length : float
        Edges at the ends of the loaded flank: at its tip corner, and where it joins the fillet.
    back_edge_length : float
        Longest edge along the other flank and the tip.
    growth, tip_growth, side_growth : float
        How fast edges grow with distance from fillet, tip corner and outline.
    body_fraction : float
        Longest edge in the body as a fraction of the sector's width there.
    rim_fraction : float
        Longest edge in the body as a fraction of the rim's thickness (outline to bore).
    corner_distance : float
        Contacts nearer than this to a corner of the flank are modelled at this distance.
    patch_half_width : float
        Half-width of the semi-elliptic pressure that loads the mesh.
    order : int
        Polynomial order of the displacement, 2 to 4.
    """

    root_edge_length: float = 0.04
    flank_edge_length: float = 0.035
    tip_edge_length: float = 0.008
    junction_edge_length: float = 0.008
    back_edge_length: float = 0.3
    growth: float = 0.25
    tip_growth: float = 0.15
    side_growth: float = 0.35
    body_fraction: float = 2.0
    rim_fraction: float = 0.3
    corner_distance: float = 0.02
    patch_half_width: float = 0.08
    order: int = 2

    def __post_init__(self) -> None:
        """Refuse settings that make no mesh."""
        for f in fields(self):
            value = getattr(self, f.name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"accuracy.{f.name}", value, "must be positive and finite")
        if self.order not in (2, 3, 4):
            raise InputError("accuracy.order", self.order, "must be 2, 3 or 4")

    def scaled(self, factor: float) -> MeshSettings:
        """Return a coarser (factor > 1) or finer set: every edge length times `factor`; patch and order stay."""
        return replace(
            self,
            root_edge_length=self.root_edge_length * factor,
            flank_edge_length=self.flank_edge_length * factor,
            tip_edge_length=self.tip_edge_length * factor,
            junction_edge_length=self.junction_edge_length * factor,
            back_edge_length=self.back_edge_length * factor,
            growth=self.growth * factor,
            tip_growth=self.tip_growth * factor,
            side_growth=self.side_growth * factor,
            body_fraction=self.body_fraction * factor,
            rim_fraction=self.rim_fraction * factor,
        )
