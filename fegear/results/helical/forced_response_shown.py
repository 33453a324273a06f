"""Mesh and bearing forces of an excited helical pair as they are shown: over speed, and their lines at one speed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Complex
from fegear.base.shown import shown, shows
from fegear.dynamics.helical_pair.transmissibility import Line, PairForces, rms
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.family import ramp
from fegear.results.helical.drawn_curves import DrawnCurve, DrawnPanel, ends

if TYPE_CHECKING:
    from numpy.typing import NDArray


#: Forces and moments with their keys and units in tables, and as figures write them.
COMPONENTS = (
    ("y", "F_{y}", "N"), ("z", "F_{z}", "N"),
    ("theta_x", "T_{x}", "N.m"), ("theta_y", "T_{y}", "N.m"), ("theta_z", "T_{z}", "N.m"),
)  # fmt: skip
_RPM = 30.0 / math.pi
#: Lines that are drawn over speed, the strongest ones; what is weaker than this share of the strongest is none.
_MOST_LINES, _NONE = 5, 1e-9


#: Where forces act.
_PLACES = ("mesh", "bearing_driver", "bearing_driven")


@dataclass(frozen=True, eq=False)
class PairForcesData:
    """Forces at the speeds of the case, at speeds that show every peak, and at the speed of the spectrum.

    Parameters
    ----------
    asked, drawn, spectrum : PairForces
    undamped : ndarray
        Speeds at which a line meets a resonance that nothing damps [rad/s].
    errors : tuple of PairForces
        What the estimated errors of the transmission error's harmonics make, those of each coordinate by themselves:
        sizes without a sign would cancel for one hand and not for the other. Empty where they are unknown or nothing.
    known : bool
        Whether the excitation is given, or its errors are estimated.
    """

    asked: PairForces
    drawn: PairForces
    spectrum: PairForces
    undamped: Array
    errors: tuple[PairForces, ...]
    known: bool


@dataclass(frozen=True)
class Component:
    """A force or a moment, in rows."""

    name: str
    force: Array | None = shown("N", "amplitude")
    moment: Array | None = shown("N.m", "amplitude")

    @classmethod
    def of(cls, where: str, k: int, values: Array) -> Component:
        """Component number k of what acts at a place."""
        key, _, unit = COMPONENTS[k]
        return cls(f"{where}_{key}", *(values if unit == own else None for own in ("N", "N.m")))


@dataclass(frozen=True)
class ForcesOverSpeed:
    """Sums over all lines at the speeds of the case, arrays of shape (S,)."""

    found: PairForces
    teeth: int
    mesh_normal_error: Array | None = shown("N", "estimated error, from that of the transmission error")

    @property
    @shows("rpm", "speed of the driver")
    def speed(self) -> Array:
        """[rad/s]."""
        return self.found.speed

    @property
    @shows("Hz", "mesh frequency (number of teeth times speed)")
    def mesh_frequency(self) -> Array | None:
        """None without transmission error."""
        return self.teeth * self.found.speed / (2.0 * math.pi) if self.teeth else None

    @cached_property
    @shows("N", "rms force along the tooth normal")
    def mesh_normal(self) -> Array:
        """[N]."""
        return rms(self.found.normal)

    @property
    def components(self) -> list[Component]:
        """Of mesh and bearings."""
        return [
            Component.of(where, k, rms(getattr(self.found, where)[:, :, k]))
            for where in _PLACES
            for k in range(len(COMPONENTS))
        ]


@dataclass(frozen=True)
class LinesOverSpeed:
    """Every line at every speed of the case, in rows, the speed fastest."""

    found: PairForces

    def _each(self, values: list[float] | list[str]) -> NDArray[np.generic]:
        return np.repeat(np.array(values), self.found.speed.size)

    @property
    @shows("rpm", "speed of the driver")
    def speed(self) -> Array:
        """[rad/s]."""
        return np.tile(self.found.speed, len(self.found.lines))

    @property
    @shows("", "order (frequency / driver speed); 0 if independent of speed")
    def order(self) -> NDArray[np.generic]:
        """Of the line."""
        return self._each([line.order for line in self.found.lines])

    @property
    @shows("", "source of excitation")
    def source(self) -> NDArray[np.generic]:
        """In words."""
        return self._each([line.source for line in self.found.lines])

    @property
    @shows("Hz", "frequency of the spectral line")
    def frequency(self) -> Array:
        """[Hz]."""
        return self.found.frequency.ravel() / (2.0 * math.pi)

    @property
    @shows("N", "force amplitude along the tooth normal")
    def mesh_normal(self) -> Array:
        """[N]."""
        return np.abs(self.found.normal).ravel()

    @property
    def components(self) -> list[Component]:
        """Of mesh and bearings."""
        return [
            Component.of(where, k, np.abs(getattr(self.found, where)[:, :, k]).ravel())
            for where in _PLACES
            for k in range(len(COMPONENTS))
        ]


@dataclass(frozen=True)
class DrawnLines:
    """Lines of one force at the speed of the spectrum."""

    label: str
    role: str
    notes: tuple[str, ...]
    frequency: Array = shown("", "frequency in kHz")
    size: Array = shown("N", "force amplitude")


@dataclass(frozen=True)
class SpectrumPanel:
    """Lines of some forces."""

    title: str
    rows: list[DrawnLines]


@dataclass(frozen=True)
class LargestForce:
    """Largest of a force over the speeds of the case, and its estimated error."""

    error: float | None
    normal: float | None = shown("N", "rms force along the tooth normal", name="largest_mesh_force")
    speed: float | None = shown("rpm", "driver speed of the maximum", name="largest_mesh_force_speed")
    radial: float | None = shown("N", "rms force along the line of action", name="largest_bearing_force")


@dataclass(frozen=True)
class ShownForces:
    """Forces of a pair over speed, drawn and tabulated."""

    data: PairForcesData
    teeth: int

    @cached_property
    def off(self) -> Array | None:
        """Estimated error of the force along the tooth normal at the speeds of the case [N]; None if unknown."""
        return np.sum([rms(one.normal) for one in self.data.errors], axis=0) if self.data.errors else None

    @property
    def over_speed(self) -> ForcesOverSpeed:
        """Sums over all lines."""
        return ForcesOverSpeed(self.data.asked, self.teeth, self.off)

    @property
    def lines(self) -> LinesOverSpeed:
        """Every line."""
        return LinesOverSpeed(self.data.asked)

    def _error(self, of: Array | None, place: int) -> float | None:
        return None if not self.data.known else 0.0 if of is None else float(of[place])

    @property
    def largest(self) -> LargestForce:
        """Along the tooth normal."""
        normal = rms(self.data.asked.normal)
        top = int(np.argmax(normal))
        return LargestForce(
            self._error(self.off, top), float(normal[top]), float(self.data.asked.speed[top]), None
        )  # fmt: skip

    @property
    def bearings(self) -> dict[str, LargestForce]:
        """Along the line of action, on both gears."""
        found = {}
        for gear in ("driver", "driven"):
            radial, *off = (
                rms(getattr(one, f"bearing_{gear}")[:, :, 0]) for one in (self.data.asked, *self.data.errors)
            )
            place = int(np.argmax(radial))
            error = self._error(np.sum(off, axis=0) if off else None, place)
            found[gear] = LargestForce(error, None, None, float(radial[place]))
        return found

    @property
    def several(self) -> bool:
        """Whether there is more than one speed."""
        return self.data.asked.speed.size > 1

    @property
    def force_panels(self) -> list[DrawnPanel]:
        """Mesh force by lines, and forces of both bearings, at speeds that show every peak."""
        forces, teeth = self.data.drawn, self.teeth
        speed, poles = forces.speed * _RPM, self.data.undamped * _RPM
        axis = Axis("speed of the driver", "rpm", limits=(float(speed[0]), float(speed[-1])))
        size = np.abs(forces.normal)
        strong = [k for k in np.argsort(-size.max(axis=1), kind="stable") if size[k].max() > _NONE * size.max()]
        strong = strong[:_MOST_LINES]
        rows = [
            (_line_name(forces.lines[k], teeth), size[k] / math.sqrt(2.0), role)
            for k, role in zip(strong, ramp(len(strong)), strict=True)
        ]
        if len(forces.lines) > 1:
            rows.append(("all lines", rms(forces.normal), "grey"))
        panels = [_over_speed(axis, ("normal mesh force, rms", "N"), speed, rows, poles)]
        for where, word in (("bearing_driver", "driver bearings"), ("bearing_driven", "driven gear bearings")):
            found: Complex = getattr(forces, where)
            for unit, label in (("N", "force, rms"), ("N.m", "moment, rms")):
                rows = [
                    (symbol, rms(found[:, :, k]), f"series:{k}")
                    for k, (_, symbol, own) in enumerate(COMPONENTS)
                    if own == unit
                ]
                panels.append(_over_speed(axis, (label, unit), speed, rows, poles, f"On the {word}"))
        return panels

    @property
    @shows("rpm", "speed of the spectrum")
    def spectrum_speed(self) -> float:
        """[rad/s]."""
        return float(self.data.spectrum.speed[0])

    @property
    def spectrum_panels(self) -> list[SpectrumPanel]:
        """Lines of mesh force and bearing forces at one speed."""
        forces = self.data.spectrum
        frequency = forces.frequency[:, 0] / (2.0e3 * math.pi)
        notes = tuple(line.source for line in forces.lines)
        panels = []
        for title, rows in (
            ("Mesh", (("along the tooth normal", forces.normal[:, 0]),)),
            ("Driver bearings", tuple((COMPONENTS[k][1], forces.bearing_driver[:, 0, k]) for k in range(2))),
            ("Driven gear bearings", tuple((COMPONENTS[k][1], forces.bearing_driven[:, 0, k]) for k in range(2))),
        ):
            largest = max(float(np.abs(row).max()) for _, row in rows)
            drawn = []
            for k, (label, row) in enumerate(rows):
                size = np.abs(row)
                on = size > _NONE * largest
                if on.any():
                    named = tuple(note for note, one in zip(notes, on, strict=True) if one)
                    role = f"series:{k + 1 if len(rows) > 1 else 0}"
                    drawn.append(DrawnLines(label, role, named, frequency[on], size[on]))
            panels.append(SpectrumPanel(title, drawn))
        return panels


def _line_name(line: Line, teeth: int) -> str:
    harmonic = line.order / teeth if teeth else 0.0
    if harmonic >= 1.0 and harmonic % 1.0 == 0.0:
        return f"harmonic {harmonic:.0f} of the mesh"
    return f"order {line.order:.4g}" if line.order else f"{line.frequency / (2.0 * math.pi):.4g} Hz"


def _over_speed(
    axis: Axis, force: tuple[str, str], speed: Array, rows: list[tuple[str, Array, str]], poles: Array, title: str = ""
) -> DrawnPanel:
    """What is something of some forces, on a logarithmic ordinate."""
    largest = max((float(row.max()) for _, row, _ in rows), default=0.0)
    drawn = [one for one in rows if one[1].max() > _NONE * largest]
    curves = [
        DrawnCurve.on_log(label, role, speed, row, poles, 3.4 if role == "grey" else 1.8) for label, row, role in drawn
    ]
    limits = ends([row for _, row, _ in drawn]) if poles.size else None
    return DrawnPanel(axis, Axis(*force, log=True, limits=limits), curves, title)
