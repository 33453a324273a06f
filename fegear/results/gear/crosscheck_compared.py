"""What a crosscheck asks, what it finds, and both beside each other: gears, pairs, and pairs as ISO 6336 rates them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from fegear.base.shown import shown, shows
from fegear.results.gear.crosscheck_answer import MeanStiffness
from fegear.results.gear.crosscheck_cycle import CycleCompared
from fegear.results.gear.crosscheck_iso import CornellSection, IsoInputs, IsoPair, load_of_stiffness
from fegear.results.gear.crosscheck_odd import PassageCompared
from fegear.results.gear.crosscheck_rows import (
    GearComplianceRows,
    PairComplianceRows,
    RootStressRows,
    SingleContactRows,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.base.arrays import Array
    from fegear.contact.compared.crosscheck import ComplianceAnswers, PairReference, RootStressAnswers
    from fegear.contact.compared.mesh_cycle import MeshCycle
    from fegear.contact.compared.odd_cycle import OddPassage, OddTeethOfPair
    from fegear.contact.compared.rated_gears import RatedPair
    from fegear.contact.compared.single_contact import AtSingleContact
    from fegear.fem.plane.table import StiffnessTable
    from fegear.formulas.cornell import SectionLengths
    from fegear.formulas.iso6336.part1_stiffness import Stiffness
    from fegear.formulas.outcome import Outcome
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair


@dataclass(frozen=True, slots=True)
class PairCheck:
    """One pair whose compliance is compared.

    Parameters
    ----------
    pair : GearPair
    gears : tuple of str
        Names of driver and driven.
    positions : int
        Over the path of contact.
    line_load : float
        w = F_bt / b, along the line of action [N/m].
    chosen : bool
        Whether the line load had to be chosen.
    load_factor : float
        K_A K_gamma of the case's own load, which c' of ISO 6336-1 takes.
    loaded : bool
        Whether the pair carries a load in the case.
    """

    pair: GearPair
    gears: tuple[str, str]
    positions: int
    line_load: float
    chosen: bool
    load_factor: float = 1.0
    loaded: bool = False

    @property
    def applied_load(self) -> float:
        """F_t K_A K_gamma / b of ISO 6336-1 [N/m]."""
        return self.load_factor * self.pair.tangential_load(self.line_load)


@dataclass(frozen=True, slots=True)
class CrosscheckInputs:
    """Gears and pairs that are compared, and spur and helical pairs that ISO 6336 rates, by name.

    `odd`: which teeth of pairs are cracked or pitted.
    """

    gears: Mapping[str, Gear]
    pairs: Mapping[str, PairCheck]
    iso: Mapping[str, IsoInputs]
    odd: Mapping[str, OddTeethOfPair] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class GearAnswers:
    """Closed forms of a gear compared with its finite elements, and Cornell's root section or why it has none."""

    table: StiffnessTable
    root_stress: Mapping[str, RootStressAnswers]
    compliance: Mapping[str, ComplianceAnswers]
    contact_zone: Array
    cornell: Outcome[SectionLengths]


@dataclass(frozen=True, slots=True)
class PairAnswers:
    """Closed forms of a pair compared with its finite elements; ISO's stiffness or the reason why there is none.

    `cycle`: mesh stiffness over the mesh cycle; None where no pair is on the path somewhere.
    `outer`: root stress of both gears at their outer points of single pair contact; empty where there are none.
    `odd`: mesh stiffness while each cracked or pitted tooth passes.
    """

    reference: PairReference
    compliance: Mapping[str, ComplianceAnswers]
    iso: Outcome[Stiffness]
    cycle: MeshCycle | None
    outer: tuple[AtSingleContact, ...] = ()
    odd: tuple[OddPassage, ...] = ()


@dataclass(frozen=True, slots=True)
class CrosscheckData:
    """Everything that is compared, by the names of gears and pairs."""

    gears: Mapping[str, GearAnswers]
    pairs: Mapping[str, PairAnswers]
    iso: Mapping[str, RatedPair]


@dataclass(frozen=True)
class GearCompared:
    """One gear: its formulas over finite elements, and Cornell's section of it.

    `rated_loads`: names and roll angles [rad] of its outer points of single pair contact, one for each of its pairs.
    """

    gear: Gear
    answers: GearAnswers
    rated_loads: tuple[tuple[str, float], ...] = ()

    @cached_property
    def root_stress(self) -> RootStressRows:
        """Formula by formula."""
        return RootStressRows.of(self.answers.root_stress, self.answers.table, self.gear.module)

    @cached_property
    def compliance(self) -> GearComplianceRows:
        """Formula by formula."""
        return GearComplianceRows.of(self.answers.compliance, self.answers.table, self.answers.contact_zone)

    @property
    def cornell(self) -> CornellSection | None:
        """None where there is none."""
        found = self.answers.cornell.value
        return None if found is None else CornellSection(found, self.gear, self.answers.table)


@dataclass(frozen=True)
class PairCompared:
    """One pair: its formulas over finite elements, and c' of ISO 6336-1."""

    check: PairCheck
    answers: PairAnswers

    @cached_property
    def compliance(self) -> PairComplianceRows:
        """Formula by formula."""
        return PairComplianceRows.of(self.answers.compliance, self.answers.reference)

    @cached_property
    def single_contact(self) -> SingleContactRows | None:
        """Both gears at their outer points of single pair contact; None where there are none."""
        found = self.answers.outer
        return SingleContactRows.of(found, self.check.pair, self.check.gears) if found else None

    @property
    def cycle(self) -> CycleCompared | None:
        """Mesh stiffness over the mesh cycle; None where there is none."""
        found, iso = self.answers.cycle, self.answers.iso.value
        if found is None:
            return None
        return CycleCompared(found, None if iso is None else iso.mesh_alpha * found.pair.face_width)

    @property
    def mean_stiffness(self) -> float | None:
        """Of the mesh by finite elements per face width [Pa]; None where there is none."""
        cycle = self.answers.cycle
        return None if cycle is None else cycle.fe.mean / cycle.pair.face_width

    @property
    @shows("N/(mm.um)", "maximum stiffness of one tooth pair, FE")
    def single_stiffness_fe(self) -> float:
        """[Pa]."""
        return float(1.0 / self.answers.reference.total.min())

    @property
    @shows("N/(mm.um)")
    def single_stiffness_iso(self) -> float | None:
        """c' [Pa]."""
        iso = self.answers.iso.value
        return None if iso is None else iso.single

    @property
    @shows("N/(mm.um)", "ISO 6336-1 c'_th")
    def theoretical_stiffness_iso(self) -> float | None:
        """c'_th [Pa]."""
        iso = self.answers.iso.value
        return None if iso is None else iso.theoretical

    @property
    @shows("", "c' / FE")
    def ratio_to_fe(self) -> float | None:
        """Of both."""
        c = self.single_stiffness_iso
        return None if c is None else c / self.single_stiffness_fe

    @property
    def under(self) -> str:
        """The load that c' is for, in words."""
        return load_of_stiffness(self.check.applied_load, self.check.load_factor)

    @property
    def remark(self) -> str:
        """What is to be said of c'; empty if nothing."""
        iso = self.answers.iso
        if iso.value is None:
            return f"ISO 6336-1 gives no c': {iso.reason}"
        return f"{iso.value.remark}." if iso.value.remark else ""


@dataclass(frozen=True)
class Everything:
    """All that is compared, by the names of gears and pairs."""

    gears: dict[str, GearCompared]
    pairs: dict[str, PairCompared]
    iso: dict[str, IsoPair]
    mean_stiffness: dict[str, MeanStiffness]

    @classmethod
    def of(cls, data: CrosscheckData, asked: CrosscheckInputs) -> Everything:
        """What was found beside what was asked."""
        pairs = {name: PairCompared(check, data.pairs[name]) for name, check in asked.pairs.items()}
        iso = {name: IsoPair(wanted, data.iso[name]) for name, wanted in asked.iso.items()}
        mean = {
            name: MeanStiffness.of(pairs[name].answers.iso.value, pairs[name].mean_stiffness)
            if name in pairs else MeanStiffness.of(one.stiffness, None, one.face_width)
            for name, one in iso.items()
        }  # fmt: skip
        gears = {
            name: GearCompared(gear, data.gears[name], tuple(_rated_loads(name, pairs)))
            for name, gear in asked.gears.items()
        }
        return cls(gears, pairs, iso, mean)

    @property
    def cycles(self) -> dict[str, CycleCompared]:
        """Mesh stiffness of the pairs over the mesh cycle, where there is one."""
        return {name: one.cycle for name, one in self.pairs.items() if one.cycle is not None}

    @property
    def passages(self) -> dict[str, PassageCompared]:
        """Mesh stiffness while odd teeth pass, by pair, gear and number of the tooth."""
        found = (PassageCompared(name, odd) for name, one in self.pairs.items() for odd in one.answers.odd)
        return {one.key: one for one in found}

    @property
    def sources(self) -> tuple[FormulaSource, ...]:
        """Where each closed form comes from."""
        from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES
        from fegear.formulas.sources import SOURCES

        stress = (FormulaSource(s.name, "root stress", s.citation, s.compared) for s in ROOT_STRESS_SOURCES.values())
        return (*stress, *(FormulaSource(s.name, "compliance", s.citation, s.remark) for s in SOURCES.values()))


def _rated_loads(gear: str, pairs: Mapping[str, PairCompared]) -> Iterator[tuple[str, float]]:
    """Names and roll angles [rad] of the outer points of single pair contact of one gear."""
    for name, one in pairs.items():
        for outer, its in zip(one.answers.outer, one.check.gears, strict=False):
            if its == gear:
                pair = one.check.pair
                at = float(pair.x_of_radius(outer.radius, outer.member))
                yield f"HPSTC {name}", float(pair.roll_angle(at, outer.member))


@dataclass(frozen=True)
class FormulaSource:
    """Where one closed form comes from and what it compares."""

    formula: str = shown("", table="sources")
    gives: str = shown("", table="sources")
    source: str = shown("", table="sources")
    what_is_compared: str = shown("", table="sources")
