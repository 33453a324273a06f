"""From a source to the value of a quantity, by the stages that a run uses.

Where a configuration's numbers come from: finite elements, a formula, or the case's table.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.base.effects import NEIGHBOUR_COUPLING
from fegear.base.errors import RangeError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.members import gear_name
from fegear.case.built.pair_spec import pair_compliance_table, pair_spec
from fegear.case.built.train import motion_spec, train_inputs
from fegear.contact.plane.closed_form_compliance import ConstantCompliance, closed_form_compliance
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.maker import load_plane
from fegear.contact.plane.table_compliance import table_sources
from fegear.contact.plane.transmission_error import TransmissionError, transmission_error
from fegear.dynamics.motion.moving_train import motion_model, steady_motion
from fegear.dynamics.train.single_tooth import force_history
from fegear.engine.executor import Executor
from fegear.engine.stage import Task, Work
from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
from fegear.formulas.outcome import attempt
from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES
from fegear.formulas.sources import source as formula_source
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results.train.gear_train import compute_train
from fegear.studies.cost.ladder import ISO_STIFFNESS
from fegear.studies.cost.quantities import Quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import GearCompliance
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.fem.plane.gear import GearInfluence
    from fegear.studies.cost.asked import Asked


#: Places over the base pitch at which compliances of pairs are compared.
_PLACES = 12


#: Harmonics of the transmission error and of the forces that a run sums.
HARMONICS, FORCE_HARMONICS = 64, 256


def loaded(asked: Asked, source: Source, name: str) -> LoadedPair:
    """A pair with the compliances of a source."""
    gears = [source.compliance(name, member, asked) for member in MEMBERS]
    return load_plane(pair_spec(asked.scene, name), gears, estimates=False)


def pair_error(asked: Asked, source: Source, order: int = 16) -> TransmissionError:
    """Transmission error of the pair that is studied; `order` is the number of Gauss points between jumps."""
    pair = loaded(asked, source, asked.pair)
    return transmission_error(pair.engagement, pair.nominal, HARMONICS, order=order)


def pair_compliance(asked: Asked, source: Source) -> Array:
    """c_0 of both gears of the pair together where its tooth pairs stand over the path of contact, shape (P,) [m/N].

    Under the nominal load on one tooth pair; for every source at the same places.
    """
    pair = loaded(asked, source, asked.pair)
    e = pair.engagement
    grid = e.grid(e.pair.x_start + e.pair.base_pitch * (np.arange(_PLACES) + 0.5) / _PLACES)
    on = grid.contacts.present & (grid.contacts.gap == 0.0)
    alone = grid.matrices.at_load(np.full((*on.shape, 1), pair.nominal))[..., 0]
    return np.einsum("jjp->jp", alone)[on]


def train_of(asked: Asked, source: Source) -> GearTrain:
    """The train with the compliances of a source in all its meshes."""
    done = {Task("loaded-pair", name): loaded(asked, source, name) for name in asked.pairs}
    work = Work(lambda _fraction: None, SolutionCache(), Executor(here=True))
    return compute_train(train_inputs(asked.scene), done, work)


def largest_force(asked: Asked, data: GearTrain, harmonics: int = FORCE_HARMONICS, positions: int = 0) -> float:
    """Largest force on one tooth pair [N], without the other meshes' share."""
    part = asked.scene.case.dynamics
    found = force_history(
        data, data.train.mesh_index(asked.mesh), part.one_speed, positions or part.positions,
        max(harmonics, part.harmonics) if harmonics == FORCE_HARMONICS else harmonics,
    )  # fmt: skip
    return float(found.total.max())


def factor_at(asked: Asked, data: GearTrain, speed: float, tolerance: float) -> float:
    """Dynamic factor of steady motion at a speed of the reference body [rad/s], started from static deflection."""
    i = data.train.mesh_index(asked.mesh)
    motion = motion_spec(asked.scene)
    state = steady_motion(motion, motion_model(motion, data, speed / data.speed_ratio), "static", tolerance)
    if state.kind == "growing":
        raise RangeError(
            "dynamics.speed", f"{speed:.9g} rad/s", f"gives an unstable motion (multiplier {state.multiplier:.4g} "
                                                    "per period)",
            "specify mesh damping, allow loss of contact (effects.contact_loss), or change the speed",
        )  # fmt: skip
    return float(state.tooth_force[i]) / float(data.forces[i])


def speed_looked_at(asked: Asked) -> float:
    """The case's one speed, else the middle of its speeds [rad/s]."""
    part = asked.scene.case.dynamics
    return part.one_speed if np.isfinite(part.one_speed) else float(np.median(part.speed_values))


def answer(asked: Asked, quantity: Quantity, source: Source, order: int = 16) -> Array:
    """Values of a quantity, shape (P,) for a gear's, (1,) for a pair's; SI."""
    if quantity.of_gear:
        return source.of_gear(quantity.name, asked)
    if quantity.name == "te-peak-to-peak":
        return np.array([pair_error(asked, source, order).peak_to_peak])
    if quantity.name == "dynamic-factor":
        tolerance = asked.scene.case.dynamics.tolerance
        return np.array([factor_at(asked, train_of(asked, source), speed_looked_at(asked), tolerance)])
    if asked.mesh and quantity.subject == asked.mesh:
        return np.array([largest_force(asked, train_of(asked, source))])
    return np.array([float(pair_error(asked, source, order).loaded.loads.max())])


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
        single = pair_stiffness(pair, specific_load=pair.tangential_load(line_load)).single
        return ConstantCompliance(compliance=0.5 / single, source="c' of ISO 6336-1")


@dataclass(frozen=True)
class StressFormula:
    """A closed form for the root stress."""

    name: str

    answers = frozenset({"root-stress"})

    def of_gear(self, quantity: str, asked: Asked) -> Array:
        """NaN where the formula refuses or finds no tension."""
        gear, formula = asked.scene.gears[asked.gear], ROOT_STRESS_SOURCES[self.name].formula
        found = [attempt(partial(formula, gear.external_tooth, float(r))) for r in asked.radii / gear.module]
        values = np.array([np.nan if one.value is None else one.value.stress for one in found]) / gear.module
        if not np.isfinite(values).any():
            raise RangeError(quantity, self.name, found[0].reason)
        return np.where(values > 0.0, values, np.nan)

    def compliance(self, pair: str, member: Member, asked: Asked) -> GearCompliance:  # noqa: ARG002  (the interface)
        """None: it is a formula for stress."""
        raise RangeError("compliance", f"{self.name}, {pair}, {member}", "is not available with a root-stress formula")


@dataclass(frozen=True)
class CaseTable:
    """The compliances that the case reads from a file: nothing is more accurate than they are."""

    answers = _PAIR

    def of_gear(self, quantity: str, asked: Asked) -> Array:
        """None: the table is of a pair."""
        raise RangeError(quantity, asked.gear, "is not in the pair's table")

    def compliance(self, pair: str, member: Member, asked: Asked) -> GearCompliance:
        """Read and fitted."""
        driver, driven = table_sources(asked.scene.pairs[pair], *pair_compliance_table(asked.scene, pair))
        return driver if member == "driver" else driven


def without_neighbours(asked: Asked) -> Asked:
    """The same for a source that knows one tooth alone: the effect that couples neighbours is off."""
    effects = asked.scene.case.effects.model_copy(update={NEIGHBOUR_COUPLING.name: False})
    return replace(asked, scene=replace(asked.scene, case=asked.scene.case.model_copy(update={"effects": effects})))
