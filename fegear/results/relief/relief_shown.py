"""A designed relief as its sheet reads it: the reliefs, the loads they are for, and what each of them leaves."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.shown import shown, shows
from fegear.engine.declared import drawn
from fegear.engine.figure.items import Zone
from fegear.geometry.pair import MEMBERS, Member
from fegear.geometry.path_of_contact import active_profile
from fegear.results.gear.path_marks import roll_marks
from fegear.results.relief.grinding import Grinding, tip_row
from fegear.results.relief.ground_tips import GroundTip, tips_of
from fegear.results.relief.harris import HarrisMap
from fegear.results.relief.left_errors import LeftError, left_error
from fegear.results.relief.profile_charts import ProfileChart, profile_chart
from fegear.results.relief.recommended import recommended_design
from fegear.results.relief.relief_over_range import LeftOverRange, left_over_range

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.design.minimum_excitation import ReliefTable
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.engine.figure.items import Mark
    from fegear.geometry.relief import Shape
    from fegear.results.relief.relief_data import ReliefData, ReliefInputs

#: Views of the Harris map in their order; others stand behind.
_VIEWS = ("designed", "linear tip relief", "parabolic tip relief", "no relief", "diagonal only")
#: A transmission error below this is written as none [um].
_NOTHING = 1e-6


@dataclass(frozen=True)
class FlankRelief:
    """Relief of one gear over its flank, or at the angles that a case asks for.

    Parameters
    ----------
    label, gear : str
        Of its tables, and name of the gear.
    member : {"driver", "driven"}
    table : ReliefTable
    diagonal, error : ndarray or None
        As those of `MemberRelief`.
    ground : mapping of str to ReliefTable
        The same flank with each relief that is ground.
    marks : tuple
        Points of the path of contact by roll angle.
    """

    label: str
    gear: str
    member: Member
    table: ReliefTable
    diagonal: Array | None
    error: Array | None
    ground: Mapping[str, ReliefTable]
    marks: tuple[Mark, ...]

    @property
    def above_least(self) -> Array:
        """The relief minus its minimum [m]."""
        return self.table.relief - self.table.relief.min()

    @property
    def marked(self) -> tuple[Mark | Zone, ...]:
        """The design zone, where the tooth is loaded at the design load, and the points of the path of contact."""
        loaded = drawn(self.table, "roll_angle")[self.table.load > 0.0]
        return Zone("x", float(loaded.min()), float(loaded.max())), *self.marks


@dataclass(frozen=True)
class Leaves:
    """What one relief leaves.

    Parameters
    ----------
    te : TransmissionError
        At the design load.
    error : LeftError
        Of its peak-to-peak and its effective value.
    map : HarrisMap
        Of all loads.
    searched : float or None
        Repeatability of a relief that was searched for [m].
    """

    te: TransmissionError
    error: LeftError
    map: HarrisMap
    searched: float | None

    @property
    def map_error(self) -> Array | None:
        """Of every point of the map [m]."""
        return None if self.searched is None else np.full(self.map.transmission_error.shape, self.searched)

    @property
    @shows("mm", "mesh position over one base pitch")
    def x(self) -> Array:
        """Shape (P,)."""
        return self.map.x

    @property
    @shows("um", "transmission error minus mean")
    def minus_mean(self) -> Array:
        """At the design load, shape (P,)."""
        return self.map.transmission_error[self.map.nearest[0]] - self.te.mean

    @property
    def peak_to_peak(self) -> str:
        """As a legend says it."""
        size = self.te.peak_to_peak * 1e6
        return f"{size:.3g} µm" if size > _NOTHING else "0"


@dataclass(frozen=True)
class TriedLoading:
    """A family of loadings with its best peak, tried for the least stress at the design load."""

    family: str = shown("", "family of the ramps")
    peak: float = shown("", "F, best of its family")
    root_tension: float = shown("MPa", "maximum of both gears")
    hertz_pressure: float = shown("MPa", "maximum over the path of contact")


@dataclass(frozen=True)
class ReliefShown:
    """A designed relief as its sheet reads it."""

    data: ReliefData
    asked: ReliefInputs

    @property
    def load(self) -> float:
        """Design load [N]."""
        return self.data.design.task.load

    @cached_property
    def tried(self) -> tuple[TriedLoading, ...]:
        """Loadings tried for the least stress; empty where none was searched for."""
        chosen, root = self.data.design.chosen, math.sqrt(self.load)
        return () if chosen is None else tuple(
            TriedLoading("sinusoidal" if r is None else f"polynomial, r = {r}", peak, s * self.load, p * root)
            for r, peak, s, p in chosen.candidates
        )  # fmt: skip

    @property
    def least_stress(self) -> TriedLoading | None:
        """Stresses of the loading that was chosen."""
        chosen, task = self.data.design.chosen, self.data.design.task
        return None if chosen is None else TriedLoading(
            "", task.loading.peak, chosen.stress * self.load, chosen.pressure * math.sqrt(self.load)
        )  # fmt: skip

    def _flank(
        self, member: Member, table: ReliefTable, diagonal: Array | None = None, error: Array | None = None
    ) -> FlankRelief:  # fmt: skip
        ground = {
            f"{shape} tip relief": replace(table, relief=getattr(one, member).removal(table.roll_angle))
            for shape, one in self.data.design.ground.items()
        }
        return FlankRelief(
            self.asked.labels[member], self.asked.gears[member], member, table, diagonal, error, ground,
            roll_marks(self.data.pair.pair, member),
        )  # fmt: skip

    @cached_property
    def reliefs(self) -> dict[Member, FlankRelief]:
        """Of each gear, where it has a table of its own, over its flank."""
        found = self.data.design.reliefs
        return {m: self._flank(m, found[m].table, found[m].diagonal, found[m].error) for m in self.asked.labels}

    @cached_property
    def points(self) -> dict[Member, FlankRelief]:
        """At the roll angles that the case asks for."""
        return {m: self._flank(m, table) for m, table in self.data.points.items()}

    @cached_property
    def tips(self) -> tuple[GroundTip, ...]:
        """Tip reliefs to grind, by shape and gear."""
        design, pair = self.data.design, self.data.pair.pair
        return tuple(
            tip
            for shape, ground in design.ground.items()
            for te in (design.te[f"{shape} tip relief"],)
            for tip in tips_of(ground, pair, shape, te, self._left_error(te, ground).larger)
        )

    @property
    def best_first(self) -> dict[str, Leaves]:
        """What each relief leaves: the one to be ground, none, then the others."""
        shapes = [f"{shape} tip relief" for shape in self.data.design.shapes]
        order = dict.fromkeys((*shapes[:1], "no relief", "present relief", *shapes, *self.left))
        return {label: self.left[label] for label in order if label in self.left}

    @property
    def best_tips(self) -> tuple[GroundTip, ...]:
        """Tip reliefs of the shape to be ground."""
        return tuple(tip for tip in self.tips if tip.shape == next(iter(self.data.design.shapes)))

    @property
    def other_tips(self) -> tuple[GroundTip, ...]:
        """Those of the other shapes."""
        return tuple(tip for tip in self.tips if tip not in self.best_tips)

    @property
    def rounded(self) -> float | None:
        """What the relief to be ground leaves at the design load with the rounded numbers of the drawing [m]."""
        design = self.data.design
        return float(design.rounded[design.shapes[0]][self.at_design_load]) if design.rounded else None

    @property
    def rounded_error(self) -> float | None:
        """Of this: that of the relief itself [m]."""
        return next(iter(self.best_first.values())).error.peak_to_peak

    @cached_property
    def over_range(self) -> dict[str, LeftOverRange]:
        """What each relief leaves at each torque."""
        return left_over_range(self.data.design, self.data.pair.pair, self.data.pair.shifted)

    def _left_error(self, te: TransmissionError, ground: TipReliefPair | None) -> LeftError:
        return left_error(te, self.data.pair.shifted, None if ground is None else ground.objective_error)

    @property
    def at_design_load(self) -> int:
        """Number of the design load among those of `over_range`."""
        return self.data.design.task.over_loads.index(self.load)

    @property
    def for_range(self) -> bool:
        """Whether the reliefs to grind are for a range of torques."""
        return self.data.design.task.over is not None and bool(self.data.design.ground)

    @cached_property
    def grinding(self) -> tuple[Grinding, ...]:
        """The reliefs to grind, those of the best shape first."""
        order, allowed = self.data.design.shapes, dict(zip(MEMBERS, self.asked.tolerances, strict=True))
        rows = [tip_row(tip, self.asked.gears[tip.member], allowed[tip.member]) for tip in self.tips]
        return tuple(sorted(rows, key=lambda row: order.index(cast("Shape", row.shape))))

    @cached_property
    def profile_charts(self) -> dict[str, tuple[ProfileChart, ...]]:
        """Of both gears for each shape of relief to grind, the best first."""
        pair, allowed = self.data.pair.engagement, self.asked.tolerances
        present = pair.driver_relief, pair.driven_relief
        found = [(shape, self.data.design.ground[shape]) for shape in self.data.design.shapes]
        recommended = recommended_design(self.grinding, self.over_range)
        return {
            f"{shape} tip relief": tuple(
                profile_chart(
                    self.asked.gears[member], pair.pair.gear(member), getattr(ground, member), allowed[i],
                    present[i] if "present relief" in self.data.design.te else None,
                    active_profile(pair.pair, member), recommended=f"{shape} tip relief" == recommended,
                )
                for i, member in enumerate(MEMBERS)
            )
            for shape, ground in found
        }  # fmt: skip

    @cached_property
    def left(self) -> dict[str, Leaves]:
        """What each relief leaves."""
        design, pair, found = self.data.design, self.data.pair.pair, {}
        over = () if design.task.over is None else (design.task.over.loads[0], design.task.over.loads[-1])
        searched = {f"{shape} tip relief": one for shape, one in design.ground.items()}
        searched |= {f"{shape} tip relief for one load": one for shape, one in design.for_one_load.items()}
        for label, te in design.te.items():
            curve, ground = design.curves[label], searched.get(label)
            error = self._left_error(te, ground)
            harris = HarrisMap(
                pair, curve.x, curve.load, curve.transmission_error.T, at=self.load, word="design", over=over
            )
            found[label] = Leaves(te, error, harris, None if ground is None else ground.removal_error)
        return found

    @property
    def maps(self) -> dict[str, HarrisMap]:
        """Of what each leaves, in the order of the views."""
        order = sorted(self.left, key=lambda label: _VIEWS.index(label) if label in _VIEWS else len(_VIEWS))
        return {label: self.left[label].map for label in order}
