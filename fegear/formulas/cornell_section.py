"""Lengths and angles of Cornell's root section over load positions: what Figs. B.1 and B.2 of NASA CR-3626 show.

Source: W. D. Mark, NASA CR-3626 (1982), Appendix B, Eqs. B.2 to B.10, in the symbols of `cornell_heywood`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.formulas.cornell_heywood import RootSection, critical_angle, lever
from fegear.formulas.load_line import load_line

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.geometry import Tooth


@dataclass(frozen=True, slots=True)
class SectionLengths:
    """A section and what belongs to each of N loads; arrays of shape (N,), lengths as those of the section.

    Parameters
    ----------
    section : RootSection
    roll : ndarray
        epsilon [rad].
    load_angle : ndarray
        phi' (B.5) [rad].
    load_half_angle : ndarray
        gamma (B.10), between the tooth's centre line and the load point [rad].
    load_thickness : ndarray
        h_W (B.6).
    arm : ndarray
        l_0 (B.9), from R_m to where the line of action crosses the centre line.
    place : ndarray
        gamma_s (B.2) [rad].
    a, b : ndarray
        A (B.3) and B (B.4) there.
    thickness : ndarray
        h_s.
    to_load, to_line : ndarray
        l_s (B.7) and l_s' (B.8): from the section to the load point and to that crossing.
    """

    section: RootSection
    roll: Array
    load_angle: Array
    load_half_angle: Array
    load_thickness: Array
    arm: Array
    place: Array
    a: Array
    b: Array
    thickness: Array
    to_load: Array
    to_line: Array


def section_lengths(section: RootSection, roll: ArrayLike) -> SectionLengths:
    """Lengths and angles of a section for loads at roll angles eps [rad].

    Raises
    ------
    RangeError
        If a load acts below the root section or the roll angle is none of the flank's.
    """
    eps, r = np.atleast_1d(np.asarray(roll, dtype=float)), section.fillet_radius
    angle, half, arm = lever(section, eps)
    place, _ = critical_angle(section, eps)
    thickness = section.root_thickness + 2.0 * r * (1.0 - np.cos(place))
    to_line = arm + r * np.sin(place)
    return SectionLengths(
        section, eps, angle, section.base_half_angle - eps + np.arctan(eps), 2.0 * half, arm, place, thickness / r,
        to_line / r, thickness, to_line + half * np.tan(angle), to_line,
    )  # fmt: skip


def radial_section_lengths(tooth: Tooth, radii: ArrayLike) -> SectionLengths:
    """The same of a generated tooth replaced by Cornell's, for loads at `radii`; lengths in modules."""
    return section_lengths(RootSection.radial_of(tooth), load_line(tooth, radii).roll)
