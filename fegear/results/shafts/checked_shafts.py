"""Shafts against yielding and bearings against tilting, for what shows shafts: the weakest first, and notes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import Note, assuming, exceeding, failing
from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.case.built.gears_on_shafts import strained
from fegear.shafts.permissible_tilt import PermissibleTilt
from fegear.shafts.stress import ShaftStress, diameter_for, nominal_stress

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.shafts.beam import Shaft
    from fegear.shafts.deflection import Deflection
    from fegear.shafts.shaft_strength import ShaftStrength


@dataclass(frozen=True)
class ShaftChecks:
    """What shafts and their bearings are held against, in the order of the case.

    Parameters
    ----------
    names : tuple of str
        Of the shafts.
    drawn : tuple of Shaft
        Their sections, no thicker than root circles that are cut into them.
    strengths : tuple of ShaftStrength
    assumed : tuple of bool
        Whether the yield strength is the default.
    factors : tuple of float
        Largest application factor K_A of the pairs on each shaft.
    bearings : tuple of tuple of str
    tilts : tuple of tuple of PermissibleTilt or None
        Of every bearing by shafts.
    """

    names: tuple[str, ...]
    drawn: tuple[Shaft, ...]
    strengths: tuple[ShaftStrength, ...]
    assumed: tuple[bool, ...]
    factors: tuple[float, ...]
    bearings: tuple[tuple[str, ...], ...]
    tilts: tuple[tuple[PermissibleTilt | None, ...], ...]


@dataclass(frozen=True)
class CheckedShaft:
    """The most stressed place of a shaft under the nominal load, and its safety against yielding.

    Parameters
    ----------
    stress : ShaftStress
        Along the shaft.
    factor : float
        Application factor in the safety.
    assumed : bool
        Whether the yield strength is the default.
    """

    stress: ShaftStress
    factor: float
    assumed: bool
    shaft: str = shown("", "name of the shaft")
    margin: float = shown("", "load at the minimum safety factor over the present one", name="load_margin")
    safety: float = shown("", "safety factor against yielding by nominal stress at K_A times the load", name="S_yield")
    required: float = shown("", "its minimum", name="S_yield_min")
    strength: float = shown("MPa", "yield strength", name="yield_strength")
    equivalent: float = shown("MPa", "maximum nominal equivalent stress (von Mises), without notches",
                              name="equivalent_stress")  # fmt: skip
    bending: float = shown("MPa", "nominal bending stress there", name="bending_stress")
    torsion: float = shown("MPa", "nominal torsional stress there", name="torsional_stress")
    axial: float = shown("MPa", "nominal axial stress there", name="axial_stress")
    at: float = shown("mm", "distance of that place from the left shaft end")
    diameter: float = shown("mm", "outer diameter there")

    @property
    def needed(self) -> float:
        """Outer diameter there that would suffice [m]."""
        return diameter_for(self.stress, self.safety, self.required)

    @property
    def found(self) -> str:
        """Stress, place and safety in words."""
        factor = f" at K_A {figures(self.factor)}" if self.factor != 1.0 else ""
        return (
            f"nominal equivalent stress {figures(self.equivalent * 1e-6)} MPa (bending {figures(self.bending * 1e-6)}, "
            f"torsion {figures(self.torsion * 1e-6)}) at {figures(self.at * 1e3)} mm, diameter "
            f"{figures(self.diameter * 1e3, 4)} mm; S_yield {self.safety:.2f}{factor} "
            f"(minimum {figures(self.required)})"
        )


@dataclass(frozen=True)
class TiltedBearing:
    """A bearing and its tilt under the nominal load [rad]."""

    bearing: str
    shaft: str
    tilt: float
    permissible: PermissibleTilt | None

    @property
    def margin(self) -> float:
        """Permissible tilt over the present one; infinite where none is known or the bearing is not tilted."""
        if self.permissible is None or not self.tilt > 0.0:
            return np.inf
        return self.permissible.high / self.tilt

    @property
    def found(self) -> str:
        """Tilt and what is permissible in words."""
        assert self.permissible is not None  # noqa: S101  (for mypy: asked only of those that have one)
        kind, low, high = self.permissible.kind, self.permissible.low, self.permissible.high
        limits = figures(high * _MINUTES) if low == high else f"{figures(low * _MINUTES)} to {figures(high * _MINUTES)}"
        of = f"guide value of {kind} bearings" if kind else "permissible"
        return f"tilt {figures(self.tilt * _MINUTES)}' ({of} {limits}')"


#: Minutes of arc in a radian.
_MINUTES = 10800.0 / np.pi


def checks_of(scene: Scene) -> ShaftChecks:
    """What the shafts of a case are held against.

    Parameters
    ----------
    scene : Scene
    """
    shafts, bearings = scene.case.shaft, scene.case.bearing
    factors = dict.fromkeys(shafts, 1.0)
    for pair in scene.case.pair.values():
        for name, part in shafts.items():
            if {place.gear for place in part.gears} & {pair.driver, pair.driven}:
                factors[name] = max(factors[name], pair.operation.application_factor)
    names = tuple(tuple(place.bearing for place in part.bearings) for part in shafts.values())
    return ShaftChecks(
        tuple(shafts), tuple(strained(scene, name) for name in shafts),
        tuple(part.strength for part in shafts.values()),
        tuple("yield_strength" not in part.given for part in shafts.values()), tuple(factors.values()), names,
        tuple(tuple(bearings[one].tilt for one in row) for row in names),
    )  # fmt: skip


def checked_shafts(checks: ShaftChecks, bent: Sequence[Deflection]) -> tuple[CheckedShaft, ...]:
    """Every shaft, the least margin first.

    Parameters
    ----------
    checks : ShaftChecks
    bent : sequence of Deflection
        The shafts under the nominal load.
    """
    found = []
    for name, one, drawn, strength, assumed, factor in zip(
        checks.names, bent, checks.drawn, checks.strengths, checks.assumed, checks.factors, strict=True
    ):
        stress = nominal_stress(one, drawn)
        k, most = stress.most, float(stress.equivalent.max())
        safety = strength.yield_strength / (factor * most) if most > 0.0 else np.inf
        found.append(CheckedShaft(
            stress, factor, assumed, name, safety / strength.safety_yield, safety, strength.safety_yield,
            strength.yield_strength, most, float(stress.bending[k]), float(stress.torsion[k]), float(stress.axial[k]),
            float(stress.z[k]), float(stress.diameter[k]),
        ))  # fmt: skip
    return tuple(sorted(found, key=lambda one: one.margin))


def tilted_bearings(checks: ShaftChecks, bent: Sequence[Deflection]) -> tuple[tuple[TiltedBearing, ...], ...]:
    """Every bearing by shafts, in the order of the case.

    Parameters
    ----------
    checks : ShaftChecks
    bent : sequence of Deflection
    """
    return tuple(
        tuple(
            TiltedBearing(bearing, name, float(np.hypot(*ring[3:5])), tilt)
            for bearing, ring, tilt in zip(bearings, one.rings, tilts, strict=True)
        )
        for name, one, bearings, tilts in zip(checks.names, bent, checks.bearings, checks.tilts, strict=True)
    )


def said_of_checks(checks: ShaftChecks, bent: Sequence[Deflection]) -> Iterator[Note]:
    """What yields, what is tilted too far, and what is assumed.

    Parameters
    ----------
    checks : ShaftChecks
    bent : sequence of Deflection
    """
    for one in checked_shafts(checks, bent):
        if one.margin < 1.0:
            yield failing(
                f"Shaft {one.shaft}: {one.found}; increase the diameter there to {figures(one.needed * 1e3)} mm or "
                f"shaft.{one.shaft}.yield_strength.",
                one.margin,
            )
        if one.assumed:
            yield assuming(
                f"Shaft {one.shaft}: yield strength {figures(one.strength * 1e-6)} MPa assumed (S355 up to 250 mm, "
                "EN 10025-2); specify shaft.NAME.yield_strength."
            )
    for row in tilted_bearings(checks, bent):
        for tilted in row:
            if (limit := tilted.permissible) is None or tilted.tilt <= limit.low:
                continue
            text = f"Bearing {tilted.bearing}: {tilted.found} on shaft {tilted.shaft}"
            if tilted.tilt > limit.high:
                yield failing(f"{text}; {STRAIGHTER}.", tilted.margin)
            else:
                yield exceeding(f"{text}; specify permissible_tilt of the catalogue, or {STRAIGHTER}.")


#: What tilts bearings less.
STRAIGHTER = "thicken the shaft, move the bearing closer to the gear, or choose a self-aligning bearing"
