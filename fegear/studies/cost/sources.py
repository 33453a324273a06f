"""Where a configuration's numbers come from: finite elements, a formula, or the case's table."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.contact import closed_form_compliance, finite_element_compliance, table_sources
from fegear.contact.closed_form_compliance import ConstantCompliance
from fegear.errors import RangeError
from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
from fegear.formulas.outcome import attempt
from fegear.formulas.root_stress_sources import ROOT_STRESS_SOURCES
from fegear.formulas.sources import source as formula_source
from fegear.geometry import GearPair
from fegear.models.pair_inputs import gear_name, pair_compliance_table
from fegear.studies.cost.configuration import ISO_STIFFNESS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array
    from fegear.contact import GearCompliance
    from fegear.fem import GearInfluence
    from fegear.geometry.pair import Member
    from fegear.studies.cost.asked import Asked


_PAIR = frozenset({"te-peak-to-peak", "tooth-force", "dynamic-factor"})


class Source(Protocol):
    """Answers of one configuration."""

    @property
    def answers(self) -> frozenset[str]:
        """Quantities that it knows anything of."""

    def of_gear(self, quantity: str, asked: Asked) -> Array:
        """Values of c_0, c_1 or the root stress at the load positions, NaN where out of range."""

    def compliance(self, pair: str, member: Member, asked: Asked) -> GearCompliance:
        """Compliance of one gear of a pair, made anew at each call."""


@dataclass(frozen=True)
class FiniteElements:
    """Solved gears.

    Parameters
    ----------
    solved : mapping of str to GearInfluence
    """

    solved: Mapping[str, GearInfluence]

    answers = frozenset({"c_0", "c_1", "root-stress"}) | _PAIR

    def of_gear(self, quantity: str, asked: Asked) -> Array:
        """At the case's load positions."""
        known, r = self.solved[asked.gear], asked.radii
        if quantity == "c_0":
            return known.self_compliance(r, asked.half_width)
        if quantity == "c_1":
            return np.diagonal(known.neighbour(1, r, r))
        return known.largest_root_stress(0, "tension", r)[0]

    def compliance(self, pair: str, member: Member, asked: Asked) -> GearCompliance:
        """Tabulated over the flank."""
        return finite_element_compliance(self.solved[gear_name(asked.scene, pair, member)])


@dataclass(frozen=True)
class ComplianceFormula:
    """A closed form for the compliance of one tooth."""

    name: str

    answers = frozenset({"c_0", "c_1"}) | _PAIR

    def of_gear(self, quantity: str, asked: Asked) -> Array:
        """No formula knows the neighbours: c_1 is zero."""
        if quantity == "c_1":
            return np.zeros(asked.radii.shape)
        gear, w = asked.scene.gears[asked.gear], asked.line_load
        if self.name == ISO_STIFFNESS:
            return np.full(asked.radii.shape, self._constant(GearPair(gear, gear), w).compliance)
        formula = formula_source(self.name)
        tooth = formula.tooth(gear, asked.radii).total
        return tooth + formula.contact(gear, asked.radii, w, asked.half_width) / w

    def compliance(self, pair: str, member: Member, asked: Asked) -> GearCompliance:
        """The same for both gears of a pair by ISO 6336, else of that gear."""
        if self.name == ISO_STIFFNESS:
            return self._constant(asked.scene.pairs[pair], asked.line_load)
        return closed_form_compliance(asked.scene.pairs[pair].gear(member), self.name)

    @staticmethod
    def _constant(pair: GearPair, line_load: float) -> ConstantCompliance:
        return ConstantCompliance(compliance=0.5 / pair_stiffness(pair, line_load).single, source="c' of ISO 6336-1")


@dataclass(frozen=True)
class StressFormula:
    """A closed form for the root stress."""

    name: str

    answers = frozenset({"root-stress"})

    def of_gear(self, quantity: str, asked: Asked) -> Array:
        """NaN where the formula refuses or finds no tension."""
        gear, formula = asked.scene.gears[asked.gear], ROOT_STRESS_SOURCES[self.name].formula
        found = [attempt(partial(formula, gear.tooth, float(r))) for r in asked.radii / gear.module]
        values = np.array([np.nan if one.value is None else one.value.stress for one in found]) / gear.module
        if not np.isfinite(values).any():
            raise RangeError(quantity, self.name, found[0].reason)
        return np.where(values > 0.0, values, np.nan)

    def compliance(self, pair: str, member: Member, asked: Asked) -> GearCompliance:  # noqa: ARG002  (the interface)
        """None: it is a formula for stress."""
        raise RangeError("compliance", f"{self.name}, {pair}, {member}", "is not known to a root-stress formula")


@dataclass(frozen=True)
class CaseTable:
    """The compliances that the case reads from a file: nothing is more accurate than they are."""

    answers = _PAIR

    def of_gear(self, quantity: str, asked: Asked) -> Array:
        """None: the table is of a pair."""
        raise RangeError(quantity, asked.gear, "is not in the pair's table")

    def compliance(self, pair: str, member: Member, asked: Asked) -> GearCompliance:
        """Read and fitted."""
        part = asked.scene.case.pair[pair].compliance
        x, c = pair_compliance_table(asked.scene, pair)
        driver, driven = table_sources(asked.scene.pairs[pair], x, c, part.of or "tooth", part.fit or "cubic")
        return driver if member == "driver" else driven


def without_neighbours(asked: Asked) -> Asked:
    """The same for a source that knows one tooth alone: the effect that couples neighbours is off."""
    effects = asked.scene.case.effects.model_copy(update={"neighbour_coupling": False})
    return replace(asked, scene=replace(asked.scene, case=asked.scene.case.model_copy(update={"effects": effects})))
