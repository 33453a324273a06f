"""Every choice that trades accuracy against time in the finite-element part, in modules."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Literal, get_args

import numpy as np

from fegear.base.errors import InputError
from fegear.base.given import given

#: What assembles a sector and eliminates its inner unknowns: nested dissection of its elements (`condensation`), or
#: scikit-fem's own `asm`, `condense` and `solve` (`scikit_fem_solver`).
Solver = Literal["condensed", "scikit-fem"]
SOLVERS: tuple[Solver, ...] = get_args(Solver)
#: Unknowns of a sector beyond which neither time nor memory suffices: some 20 GB.
_MOST_UNKNOWNS = 3e6
#: No pressure on the mesh of a level is wider [modules].
_WIDEST_PATCH = 0.36


@dataclass(frozen=True, slots=True)
class MeshSettings:
    """Edge lengths and order of the sector's mesh; all lengths in modules, so one choice serves every size.

    Bounds are those of what a case may ask for; `scaled` sets may go beyond them.
    """

    root_edge_length: float = given(
        meaning="Maximum edge length along the fillet, in modules.", default=0.055, at_least=1e-5, at_most=2.0
    )
    root_fraction: float = given(
        meaning="Maximum edge length along a fillet relative to its radius of curvature.",
        default=0.08, at_least=1e-4, at_most=2.0,
    )  # fmt: skip
    flank_edge_length: float = given(
        meaning="Edge length along the flank, in modules.", default=0.055, at_least=1e-5, at_most=2.0
    )
    tip_edge_length: float = given(
        meaning="Edge length at the tip, in modules.", default=0.003, at_least=1e-5, at_most=2.0
    )
    #: In proportion to the length of fillets shorter than 0.1 modules.
    junction_edge_length: float = given(
        meaning="Edge length at the transition from flank to fillet, in modules.",
        default=0.00075, at_least=1e-5, at_most=2.0,
    )  # fmt: skip
    back_edge_length: float = given(
        meaning="Edge length on the unloaded flank, in modules.", default=0.3, at_least=1e-5, at_most=2.0
    )
    growth: float = given(
        meaning="Growth rate of edge lengths away from the fillet.", default=0.28, at_least=1e-5, at_most=2.0
    )
    tip_growth: float = given(
        meaning="Growth rate of edge lengths away from the tip corner.", default=0.155, at_least=1e-5, at_most=2.0
    )
    side_growth: float = given(
        meaning="Growth rate of edge lengths away from the tooth outline.", default=0.4, at_least=1e-5, at_most=2.0
    )
    body_fraction: float = given(
        meaning="Maximum edge length in the body relative to the sector width.",
        default=1.4, at_least=1e-3, at_most=10.0,
    )  # fmt: skip
    rim_fraction: float = given(
        meaning="Maximum edge length in the body relative to the rim thickness.",
        default=0.45, at_least=1e-3, at_most=1.0,
    )  # fmt: skip
    #: Also the half-width of the narrowest pressure that loads the mesh.
    corner_distance: float = given(
        meaning="Distance from a flank corner below which c_0 is extrapolated with the wedge solution [modules].",
        default=0.006, above=0.0, at_most=0.5,
    )  # fmt: skip
    patch_half_width: float = given(
        meaning="Half-width of the wider of the two pressure patches applied to the mesh, in modules.",
        default=0.18, above=0.0, at_most=0.5,
    )  # fmt: skip
    order: int = given(meaning="Polynomial order of the elements, 2 to 4.", default=4, at_least=2, at_most=4)
    solver: Solver = given(
        meaning="Solver of the tooth sector: `condensed` (nested dissection) or `scikit-fem` (its own asm, "
        "condense and solve). Results agree to round-off; `scikit-fem` takes several times as long.",
        default="condensed",
    )

    def __post_init__(self) -> None:
        """Refuse settings that make no mesh."""
        if self.solver not in SOLVERS:
            raise InputError("accuracy.solver", self.solver, f"must be one of {', '.join(SOLVERS)}")
        for f in fields(self):
            value = getattr(self, f.name)
            if f.name != "solver" and not (math.isfinite(value) and value > 0.0):
                raise InputError(f"accuracy.{f.name}", value, "must be positive and finite")
        if self.order not in (2, 3, 4):
            raise InputError("accuracy.order", self.order, "must be 2, 3 or 4")

        triangles = self.expected_triangles
        if triangles * self.order**2 > _MOST_UNKNOWNS:
            raise InputError(
                "accuracy", "(edge lengths)", f"requires about {triangles:.1g} triangles of order {self.order}",
                f"increase the edge length: the limit is about {_MOST_UNKNOWNS / self.order**2:.1g}",
            )  # fmt: skip

    @property
    def expected_triangles(self) -> float:
        """About how many triangles a sector gets, half to three times as many: rows along each edge, longer row by row.

        Around the flank's ends the rows are half rings whose edges grow with the distance.
        """
        # Modules: both fillets, their sharpest parts, the loaded flank, the ends' reach.
        fillet, sharpest, flank, ring = 2.5, 0.7, 2.3, 0.3
        rows = sharpest / (self.growth * min(self.root_edge_length, 0.3 * self.root_fraction))
        rows += (fillet - sharpest) / (self.growth * self.root_edge_length)
        rows += flank / (self.side_growth * min(self.flank_edge_length, self.back_edge_length))
        grown = [self.tip_growth * ring / edge for edge in (self.tip_edge_length, self.junction_edge_length)]
        ends = sum(math.pi / self.tip_growth**2 * (math.log1p(g) - g / (1.0 + g)) for g in grown)
        body = 2.0 / min(self.body_fraction, self.rim_fraction) ** 2
        return 2.3 * (rows + ends + body)

    def scaled(self, factor: float) -> MeshSettings:
        """Return a coarser (factor > 1) or finer set: every edge length and the corner distance times `factor`.

        Patch and order stay.
        """
        return replace(
            self,
            root_edge_length=self.root_edge_length * factor,
            root_fraction=self.root_fraction * factor,
            flank_edge_length=self.flank_edge_length * factor,
            tip_edge_length=self.tip_edge_length * factor,
            junction_edge_length=self.junction_edge_length * factor,
            back_edge_length=self.back_edge_length * factor,
            growth=self.growth * factor,
            tip_growth=self.tip_growth * factor,
            side_growth=self.side_growth * factor,
            body_fraction=self.body_fraction * factor,
            rim_fraction=self.rim_fraction * factor,
            corner_distance=self.corner_distance * factor,
        )

    def refined(self, factor: float) -> MeshSettings:
        """Return a finer (factor < 1) or coarser set for another accuracy.

        Edge lengths go with `factor`. How fast edges grow goes with its root, and so does the patch: a pressure on a
        mesh has two errors, how well the mesh resolves it and its own width's, and both must fall; and a mesh of few
        elements whose edges grow by more than their own length spoils what its short edges are there for.
        """
        root = math.sqrt(factor)
        return replace(
            self.scaled(factor),
            growth=self.growth * root,
            tip_growth=self.tip_growth * root,
            side_growth=self.side_growth * root,
            patch_half_width=min(self.patch_half_width * root, _WIDEST_PATCH),
        )


#: Edge lengths of neighbouring levels differ by this factor.
LEVEL_RATIO = math.sqrt(2.0)
#: Levels that can be asked for: edge lengths 8 to 0.25 times the default.
COARSEST_LEVEL, FINEST_LEVEL = -6.0, 4.0
#: Levels that hold a relative tolerance with their own estimate, from random gears (docs/numerics.md); the next half
#: level is taken. Half a level coarser a fifth of the gears misses 1e-2 or 1e-3 and is solved twice.
_LEVELS = ((1e-1, -6.0), (1e-2, -4.34), (1e-3, -2.0), (1e-4, 0.0), (1e-5, 2.0), (1e-6, 4.0))
#: So little above the half level below most gears hold a tolerance there.
_ALL_BUT = 0.17


def settings_at(level: float) -> MeshSettings:
    """Settings of a level: 0 the default, every further one with edges shorter by the square root of two."""
    return MeshSettings().refined(LEVEL_RATIO**-level)


def level_for(tolerance: float) -> float:
    """Level of `settings_at` that usually meets a relative tolerance, a multiple of a half: -2 for 1e-3, 0 for 1e-4."""
    return min(max(0.5 * math.ceil(2.0 * _level_between(tolerance) - 1e-9), COARSEST_LEVEL), FINEST_LEVEL)


def all_but_met_coarser(tolerance: float) -> bool:
    """Whether most gears meet a tolerance half a level below `level_for`: it all but takes the half level below."""
    level = level_for(tolerance)
    return level > COARSEST_LEVEL and _level_between(tolerance) - (level - 0.5) <= _ALL_BUT


def _level_between(tolerance: float) -> float:
    decades, levels = zip(*((-math.log10(known), level) for known, level in _LEVELS), strict=True)
    return float(np.interp(-math.log10(tolerance), decades, levels))
