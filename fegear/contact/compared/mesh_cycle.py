"""Mesh stiffness over the mesh cycle by formulas and by finite elements, at the same roll positions.

Perfect involutes that touch on the path of contact only, the same load, the same definition (secant, sum over the tooth
pairs in contact). A formula knows one tooth at a time and takes all pairs as springs side by side; finite elements
are given with coupled neighbours, and without for what the coupling alone changes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.contact.plane.base_pitch import mean_secant_stiffness, roll_positions, secant_stiffness
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import SolvedTeeth, finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.formulas.outcome import Outcome, attempt
from fegear.formulas.sources import SOURCES
from fegear.geometry.pair import GearPair

#: Even steps over the base pitch.
_POSITIONS = 100


@dataclass(frozen=True)
class OverCycle:
    """Mesh stiffness over P roll positions of one base pitch, shape (P,), and its mean over the whole of it [N/m]."""

    stiffness: Array = shown("N/um", label="mesh stiffness")
    mean: float = shown("N/um", "secant mesh stiffness, mean over the base pitch")


@dataclass(frozen=True)
class MeshCycle:
    """A pair under one load: finite elements, and every formula that covers both gears.

    Parameters
    ----------
    pair : GearPair
    x : ndarray, shape (P,)
        Roll positions, even and on both sides of the points where pairs come into or out of contact [m].
    fe, uncoupled : OverCycle
        Finite elements with and without the coupling of neighbouring teeth.
    formulas : mapping of str to Outcome
        `OverCycle` by each formula, or why it gives none.
    """

    pair: GearPair
    fe: OverCycle
    uncoupled: OverCycle
    formulas: Mapping[str, Outcome[OverCycle]]
    x: Array = shown("mm", "mesh position: position of the last tooth pair to come into contact")

    @property
    @shows("deg", "rotation of the driver from where this tooth pair is at the pitch point")
    def driver_angle(self) -> Array:
        """x over the base radius of the driver, shape (P,) [rad]."""
        return self.x / self.pair.driver.base_radius


def mesh_cycle(pair: GearPair, driver: SolvedTeeth, driven: SolvedTeeth, line_load: float) -> MeshCycle:
    """Follow both kinds over one base pitch.

    Parameters
    ----------
    pair : GearPair
    driver, driven : SolvedTeeth
    line_load : float
        Of all tooth pairs together, along the line of action [N/m].

    Raises
    ------
    InputError
        If no tooth pair is on the path at some roll positions.
    """
    load = line_load * pair.face_width
    by_fe = finite_element_compliance(driver), finite_element_compliance(driven)
    coupled = PairCompliance(pair, *by_fe)
    # where pairs come and go is the same of all: the flanks are perfect
    x = roll_positions(Engagement(coupled), _POSITIONS)
    formulas = {name: attempt(partial(_by_formula, pair, name, load, x)) for name in SOURCES}
    uncoupled = PairCompliance(pair, *by_fe, coupling=False)
    return MeshCycle(pair, _over(coupled, load, x), _over(uncoupled, load, x), formulas, x)


def _by_formula(pair: GearPair, name: str, load: float, x: Array) -> OverCycle:
    driver, driven = (closed_form_compliance(gear, name) for gear in (pair.driver, pair.driven))
    return _over(PairCompliance(pair, driver, driven), load, x)


def _over(teeth: PairCompliance, load: float, x: Array) -> OverCycle:
    engagement = Engagement(teeth)
    curve = secant_stiffness(engagement.solve(engagement.grid(x), [load]))[:, 0]
    return OverCycle(curve, mean_secant_stiffness(transmission_error(engagement, load)))
