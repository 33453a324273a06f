"""What the result ``crosscheck`` reads and what it finds, by the names of gears and pairs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array
    from fegear.contact.crosscheck import ComplianceAnswers, PairReference, RootStressAnswers
    from fegear.contact.iso_check import RatedPair
    from fegear.fem import StiffnessTable
    from fegear.formulas.cornell_section import SectionLengths
    from fegear.formulas.iso6336.part1_stiffness import Stiffness
    from fegear.formulas.outcome import Outcome as Answer
    from fegear.geometry import Gear, GearPair
    from fegear.results.crosscheck_iso import IsoInputs


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
        [N/m].
    chosen : bool
        Whether the line load had to be chosen.
    """

    pair: GearPair
    gears: tuple[str, str]
    positions: int
    line_load: float
    chosen: bool


@dataclass(frozen=True, slots=True)
class CrosscheckInputs:
    """Gears and pairs that are compared, and spur and helical pairs that ISO 6336 rates, by name."""

    gears: Mapping[str, Gear]
    pairs: Mapping[str, PairCheck]
    iso: Mapping[str, IsoInputs]


@dataclass(frozen=True, slots=True)
class GearAnswers:
    """Closed forms of a gear beside its finite elements, and Cornell's root section or why it has none."""

    table: StiffnessTable
    root_stress: Mapping[str, RootStressAnswers]
    compliance: Mapping[str, ComplianceAnswers]
    contact_zone: Array
    cornell: Answer[SectionLengths]


@dataclass(frozen=True, slots=True)
class PairAnswers:
    """Closed forms of a pair beside its finite elements; ISO's stiffness or the reason why there is none."""

    reference: PairReference
    compliance: Mapping[str, ComplianceAnswers]
    iso: Answer[Stiffness]


@dataclass(frozen=True, slots=True)
class CrosscheckData:
    """Everything that is compared, by the names of gears and pairs."""

    gears: Mapping[str, GearAnswers]
    pairs: Mapping[str, PairAnswers]
    iso: Mapping[str, RatedPair]
