"""Loaded flanks with deviations of manufacture: compliances over the face stay, contact is found anew."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.fourier import Panels
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.load_sharing import solve_contact
from fegear.contact.wide.loaded import LoadedFlanks
from fegear.contact.wide.root_stress import RootInfluence
from fegear.design.robustness.deviated_pair import HARMONICS
from fegear.design.robustness.tolerance_draws import Deviations, HelixDeviation, ProfileDeviation
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.relief import CombinedRelief

#: What is kept of a draw, in the order of its numbers.
FLANK_OUTCOMES = (
    "te_peak_to_peak", "te_mean", *(f"te_harmonic_{n}" for n in range(1, HARMONICS + 1)), "face_load_factor",
    "driver_root_tension", "driven_root_tension", "hertz_pressure", "largest_line_load",
)  # fmt: skip


@dataclass(frozen=True)
class FlankBenches:
    """A pair at the drawing's centre distance, and at those of its largest deviations.

    Parameters
    ----------
    nominal : FlankBench
    nearer, farther : FlankBench, optional
        At the least and the largest centre distance; None where it is not drawn.
    largest : float
        Largest deviation of the centre distance [m].
    """

    nominal: FlankBench
    nearer: FlankBench | None = None
    farther: FlankBench | None = None
    largest: float = 0.0

    @property
    def load(self) -> float:
        """Along the transverse line of action [N]."""
        return self.nominal.load

    @property
    def teeth(self) -> int:
        """Teeth on either side of tooth 0 that are in reach in one base pitch."""
        return self.nominal.teeth

    @property
    def names(self) -> tuple[str, ...]:
        """Of the numbers that are kept of a draw."""
        return FLANK_OUTCOMES

    @property
    def exact(self) -> float:
        """None is known: points stand where contact lines do."""
        return np.nan

    def of_draw(self, deviations: Deviations, row: int) -> Array:
        """Numbers of one draw."""
        return self.outcomes(deviated_gaps(self.nominal, deviations, row), float(deviations.centre_distance[row]))

    def outcomes(self, gaps: FlankGaps, moved: float) -> Array:
        """What comes of a pair whose centre distance is off by `moved` [m], in the order of `FLANK_OUTCOMES`.

        Straight between the centre distances that are solved: contact lines move along the teeth by about three times
        as much as the gears do, which is little compared with what they cross.
        """
        found = flank_outcomes(self.nominal, gaps)
        beside = self.nearer if moved < 0.0 else self.farther
        if moved == 0.0 or beside is None:
            return found
        return np.asarray(found + abs(moved) / self.largest * (flank_outcomes(beside, gaps) - found))


@dataclass(frozen=True)
class FlankBench:
    """A pair with a width set up for deviations: small enough to be sent to other processes.

    Parameters
    ----------
    pair : GearPair
    known : FlankCompliance
        At all roll positions.
    gaps : FlankGaps
        Of the drawing, without spacing errors.
    points : Panels
        The roll positions with their weights.
    load : float
        Along the transverse line of action [N].
    roots : tuple of (RootInfluence, RootInfluence)
        Root tension of driver and driven gear.
    """

    pair: GearPair
    known: FlankCompliance
    gaps: FlankGaps
    points: Panels
    load: float
    roots: tuple[RootInfluence, RootInfluence]

    @property
    def teeth(self) -> int:
        """Teeth on either side of tooth 0 that are in reach in one base pitch."""
        lines = self.known.lines
        return int(np.abs(lines.pair[lines.present]).max())


def deviated_gaps(bench: FlankBench, deviations: Deviations, row: int) -> FlankGaps:
    """What keeps the flanks of one draw apart; profiles are evaluated over what is active in the drawing."""
    pair, gaps, reliefs, flanks = bench.pair, bench.gaps, [], []
    own = (gaps.driver_relief, gaps.driver_flank), (gaps.driven_relief, gaps.driven_flank)
    for i, (member, (relief, over_face)) in enumerate(zip(MEMBERS, own, strict=True)):
        low, high = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
        off = ProfileDeviation(
            low, high, float(deviations.profile_slope[row, i]), float(deviations.profile_form[row, i]),
            float(deviations.waves[row, i]), float(deviations.phase[row, i]),
        )  # fmt: skip
        reliefs.append(CombinedRelief((relief, off)))
        lead = HelixDeviation(float(deviations.helix_slope[row, i]), pair.gear(member).face_width)
        flanks.append((*over_face, lead))
    driver, driven = (deviations.spacing(row, i, pair.gear(member).teeth) for i, member in enumerate(MEMBERS))
    return replace(
        gaps, driver_relief=reliefs[0], driven_relief=reliefs[1], driver_flank=flanks[0], driven_flank=flanks[1],
        driver_spacing=driver, driven_spacing=driven, base_pitch=0,
    )  # fmt: skip


def flank_outcomes(bench: FlankBench, gaps: FlankGaps) -> Array:
    """What comes of a deviated pair, in the order of `FLANK_OUTCOMES`.

    Parameters
    ----------
    bench : FlankBench
    gaps : FlankGaps
        From `deviated_gaps`.
    """
    load = np.array([bench.load])
    contact = solve_contact(bench.known, gaps.at(bench.pair, bench.known.lines), load)
    found = LoadedFlanks(bench.pair, bench.known, contact, load, {})
    te = np.ascontiguousarray(found.transmission_error[:, 0])
    points = bench.points
    share = points.weights / points.period
    waves = np.exp(-2j * np.pi / points.period * np.multiply.outer(np.arange(1, HARMONICS + 1), points.x))
    amplitudes = 2.0 * np.abs((waves * (share * te)).sum(axis=1))
    roots = [root.largest(contact.force[:, :, 0]) for root in bench.roots]
    return np.array([
        np.ptp(te), (share * te).sum(), *amplitudes, found.face_load_factor[0], *roots, found.largest_pressure[0],
        found.largest_line_load[0],
    ])  # fmt: skip
