"""Safety factors S_H and S_F of arrays of pairs by ISO 6336, under one load or a spectrum; what is refused and why.

The same numbers as `fegear.formulas.iso6336.safety`: `rate_pair` and `rate_spectrum` of each pair, some fifty times as
fast. What these refuse for one pair is a mask with its reason here, and NaN.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.formulas.iso6336.part2_pitting import life_knots
from fegear.formulas.iso6336.part3_root_stress import LEAST_RIM, LEAST_RING
from fegear.formulas.many.flanks import contact_stresses, flank_lines
from fegear.formulas.many.lives import ManyBins, ManyKnots, damages, spectrum_safeties
from fegear.formulas.many.loads import ManyLoadFactors, contact_ratio_square, load_factors
from fegear.formulas.many.roots import ManyForms, bending_stresses, root_forms, root_lines
from fegear.formulas.many.shared import ManyConditions, ManyDuties

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Mask
    from fegear.formulas.many.pairs import ManyPairs

#: By how much the line of annex C goes on below the load cycles of static strength.
_ABOVE = 10.0
#: Sizes of ISO 1328-1, with the slack of a conversion of units [m].
_SIZES = {"d": (5e-3, 15.0), "m_n": (0.5e-3, 70e-3), "b": (4e-3, 1.2)}
_SLACK = 1e-9


@dataclass(frozen=True)
class ManyRatings:
    """Ratings of pairs; arrays of pinion and wheel have the shape (2, N).

    Parameters
    ----------
    contact_stress, contact_permissible, contact_safety : ndarray, shape (2, N)
        sigma_H, sigma_HG [Pa], S_H; NaN where a pair is not rated.
    bending_stress, bending_permissible, bending_safety : ndarray, shape (2, N)
        sigma_F, sigma_FG [Pa], S_F.
    factors : ManyLoadFactors
    forms : ManyForms
    refused : tuple of (str, ndarray)
        Why pairs are not rated, the first reason first, and which of them.
    """

    contact_stress: Array
    contact_permissible: Array
    contact_safety: Array
    bending_stress: Array
    bending_permissible: Array
    bending_safety: Array
    factors: ManyLoadFactors
    forms: ManyForms
    refused: tuple[tuple[str, Mask], ...]

    @property
    def rated(self) -> Mask:
        """Which pairs are rated."""
        return ~np.any([mask for _, mask in self.refused], axis=0)


def _outside(name: str, values: Array) -> Mask:
    low, high = _SIZES[name]
    return np.asarray((values < low * (1.0 - _SLACK) - _SLACK * high) | (values > high * (1.0 + _SLACK)))


def _refused(pairs: ManyPairs, factors: ManyLoadFactors, forms: ManyForms) -> tuple[tuple[str, Mask], ...]:
    """What ISO 6336 does not cover."""
    ratio = pairs.contact_ratio
    sizes = (
        _outside("d", np.abs(pairs.diameters)).any(axis=0) | _outside("m_n", pairs.module)
        | _outside("b", pairs.face_widths).any(axis=0)
    )  # fmt: skip
    spur = pairs.helix_angle == 0.0
    thin = np.where(
        pairs.teeth < 0.0, pairs.rim_thickness / pairs.module <= LEAST_RING,
        pairs.rim_thickness / pairs.depth <= LEAST_RIM,
    )  # fmt: skip
    found = (
        ("contact ratio below 1", ratio < 1.0),
        ("size outside ISO 1328-1", sizes),
        ("helix angle above 45 deg", pairs.helix_angle > np.radians(45.0)),
        ("contact ratio beyond ISO 6336-1", (spur & (ratio >= 2.5)) | (contact_ratio_square(pairs) <= 0.0)),
        ("virtual contact ratio of 3 or more", pairs.virtual_contact_ratio >= 3.0),
        ("rim too thin for ISO 6336-3", thin.any(axis=0)),
        ("no root section of ISO 6336-3", ~forms.exists.all(axis=0)),
        ("notch parameter q_s outside 1 to 8", ~forms.notch_in_range.all(axis=0)),
        (
            "load factors outside ISO 6336-1",
            ~np.isfinite(factors.K_v * factors.K_Hbeta) | (factors.single_stiffness <= 0.0),
        ),
    )
    return tuple((words, np.asarray(mask)) for words, mask in found)


def rate_many(asked: ManyConditions) -> ManyRatings:
    """Rate every pair by ISO 6336, parts 1, 2 and 3."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        forms = root_forms(asked.pairs)
        return _rated(asked, forms, flank_lines(asked), root_lines(asked, forms))


def _rated(
    asked: ManyConditions,
    forms: ManyForms,
    flanks: tuple[ManyKnots, ManyKnots],
    roots: tuple[ManyKnots, ManyKnots],
) -> ManyRatings:
    factors = load_factors(asked)
    cycles = asked.duty.cycles
    stress_h, stress_f = contact_stresses(asked, factors), bending_stresses(asked, factors, forms)
    bear_h, bear_f = (np.array([line.at(n) for line, n in zip(two, cycles, strict=True)]) for two in (flanks, roots))
    refused = _refused(asked.pairs, factors, forms)
    off = ~np.isfinite(stress_h).all(axis=0) | ~np.isfinite(stress_f).all(axis=0)
    refused = (*refused, ("single pair contact below a base circle", np.asarray(off)))
    lost = np.any([mask for _, mask in refused], axis=0)
    found = [np.where(lost, np.nan, one) for one in (stress_h, bear_h, stress_f, bear_f)]
    stress_h, bear_h, stress_f, bear_f = found
    return ManyRatings(
        stress_h, bear_h, bear_h / stress_h, stress_f, bear_f, bear_f / stress_f, factors, forms, refused
    )


@dataclass(frozen=True)
class ManySpectrumRatings:
    """Safeties and Miner sums under a spectrum, shape (2, N)."""

    contact_safety: Array
    bending_safety: Array
    contact_damage: Array
    bending_damage: Array
    refused: tuple[tuple[str, Mask], ...]


@dataclass(frozen=True, slots=True)
class ManyLevels:
    """One level of a spectrum: F_t [N] and speed of the pinion [rad/s], shape (N,); load cycles, shape (2, N)."""

    tangential: Array
    speed: Array
    cycles: Array


def _curves(asked: ManyConditions, forms: ManyForms) -> tuple[tuple[ManyKnots, ManyKnots], tuple[ManyKnots, ManyKnots]]:
    """S-N lines of flanks and roots."""
    flanks = flank_lines(asked)
    if asked.annex_c:
        one, other = (_annex_c(line, s) for line, s in zip(flanks, asked.strength, strict=True))
        flanks = one, other
    return flanks, root_lines(asked, forms)


def _annex_c(line: ManyKnots, strength: object) -> ManyKnots:
    """The line of ISO 6336-6, annex C: all film factors at all load cycles, up to ten times fewer of them."""
    life = life_knots(strength)  # type: ignore[arg-type]  # arrays of strengths in place of one
    (n_0, n_1), (z_0, z_1) = life.cycles[:2], life.values[:2]
    first = z_0 * (z_0 / z_1) ** (np.log(_ABOVE) / np.log(n_1 / n_0))
    scale = line.values[-2] / life.values[-2]
    return ManyKnots((n_0 / _ABOVE, *life.cycles), tuple(scale * z for z in (first, *life.values)))


def rate_many_spectra(asked: ManyConditions, levels: Sequence[ManyLevels]) -> ManySpectrumRatings:
    """Rate every pair under a spectrum (ISO 6336-6): the S-N line of a level is that of its speed."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        forms = root_forms(asked.pairs)
        flanks: tuple[list[ManyBins], list[ManyBins]] = ([], [])
        roots: tuple[list[ManyBins], list[ManyBins]] = ([], [])
        refused: tuple[tuple[str, Mask], ...] = ()
        for level in levels:
            if not (level.tangential > 0.0).any():
                continue
            duty: ManyDuties = replace(asked.duty, tangential=level.tangential, speed=level.speed, cycles=level.cycles)
            at = replace(asked, duty=duty)
            lines = _curves(at, forms)
            found = _rated(at, forms, *lines)
            refused = refused or found.refused
            for i in (0, 1):
                flanks[i].append(ManyBins(found.contact_stress[i], level.cycles[i], lines[0][i]))
                roots[i].append(ManyBins(found.bending_stress[i], level.cycles[i], lines[1][i]))
        return ManySpectrumRatings(
            np.array([spectrum_safeties(one) for one in flanks]), np.array([spectrum_safeties(one) for one in roots]),
            np.array([damages(one) for one in flanks]), np.array([damages(one) for one in roots]), refused,
        )  # fmt: skip
