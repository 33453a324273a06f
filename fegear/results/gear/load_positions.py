"""Where and how widely the teeth of one gear are loaded for its table: ``[stiffness]``, read and checked."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import cast

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.case.built.rated_duty import bore_remarks
from fegear.case.reading import Scene
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair, Member

#: Half-width of the contact in modules when the case gives neither a width nor a load.
USUAL_HALF_WIDTH = 0.02


#: Share of the flank's length at either end where bands on a solid gear want a finer section than the usual one.
END_SHARE = 0.07


def chosen_gears(scene: Scene) -> tuple[str, ...]:
    """The spur gear that ``[stiffness]`` names; every spur gear of the case if it names none."""
    named = scene.case.stiffness.gear
    if named is not None and named not in scene.spur_gears:
        raise InputError(
            "stiffness.gear",
            f'"{named}"',
            "is helical; the plane (2D) model applies to spur gears only",
            "specify a spur gear",
        )
    return tuple(scene.spur_gears) if named is None else (named,)


def _pair_of(scene: Scene, name: str) -> tuple[GearPair, Member] | None:
    """The pair in which the gear's contact is looked at, and its role there; None if it meshes with nothing."""
    for key, part in scene.case.pair.items():
        if scene.case.stiffness.pair in (None, key) and name in (part.driver, part.driven):
            return scene.pairs[key], "driver" if part.driver == name else "driven"
    return None


def check_contacts_of(scene: Scene, name: str) -> None:
    """Refuse loads without a mate, and contacts that lie off the flank or are wider than it."""
    part = scene.case.stiffness
    if part.pair is not None and _pair_of(scene, name) is None:
        raise InputError(
            "stiffness.pair", f'"{part.pair}"', f"does not contain gear {name}", "specify a pair with this gear"
        )
    if part.load is not None and _pair_of(scene, name) is None:
        raise InputError(
            "stiffness.load",
            f"{part.load * 1e-3:.6g} N/mm",
            "requires a mating flank for the contact width",
            f"specify a pair with gear {name}, or contact_half_width",
        )
    gear = scene.gears[name]
    for i, radius in enumerate(part.radii or ()):
        low, high = gear.involute_radii
        if not low * (1 - 1e-9) <= radius <= high * (1 + 1e-9):
            raise InputError(
                f"stiffness.radii[{i}]",
                f"{radius * 1e3:.9g} mm",
                f"is outside the involute flank of gear {name}",
                f"valid range {low * 1e3:.6g} mm to {high * 1e3:.6g} mm",
            )
    if part.contact_half_width is not None:
        from fegear.fem.plane.table import check_contacts

        check_contacts(gear, load_radii(scene, name), part.contact_half_width, "stiffness.contact_half_width")


def load_radii(scene: Scene, name: str) -> Array:
    """Radii of the table [m]: those of the case, or positions equally spaced in roll angle over the active profile.

    Those of a solid's bands keep off the very ends of the flank.
    """
    part, gear = scene.case.stiffness, scene.gears[name]
    if part.radii is not None:
        return np.array(part.radii)
    found = _pair_of(scene, name)
    if found:
        pair, member = found
        ends = np.sort(pair.radius(np.array([pair.x_start, pair.x_end]), member))
    else:
        ends = np.array(gear.involute_radii)
    low, high = np.clip(ends, *gear.involute_radii)
    first, last = (float(np.sqrt((r - gear.base_radius) * (r + gear.base_radius))) for r in (low, high))
    if part.face_positions is None:
        return np.clip(np.hypot(gear.base_radius, np.linspace(first, last, part.load_positions)), low, high)
    # Arc lengths go with the squares; within this share of the flank's ends a solid's bands are poorly resolved.
    low_2, high_2 = (r**2 - gear.base_radius**2 for r in gear.involute_radii)
    inner = [np.sqrt(low_2 + share * (high_2 - low_2)) for share in (END_SHARE, 1.0 - END_SHARE)]
    return np.hypot(gear.base_radius, np.linspace(max(first, inner[0]), min(last, inner[1]), part.band_radii))


def contact_half_width(scene: Scene, name: str, radii: Array) -> Array:
    """Half-width of the contact at every radius [m]: given, from Hertz for a load and a mate, or 0.02 modules."""
    part, gear = scene.case.stiffness, scene.gears[name]
    if part.contact_half_width is not None:
        return np.full(radii.shape, part.contact_half_width)
    if part.load is None:
        return np.full(radii.shape, USUAL_HALF_WIDTH * gear.module)
    from fegear.formulas.hertz import line_contact, relative_curvature

    pair, member = cast("tuple[GearPair, Member]", _pair_of(scene, name))
    mate: Member = "driven" if member == "driver" else "driver"
    x = np.clip(pair.x_of_radius(radii, member), pair.x_start, pair.x_end)
    curvature = relative_curvature(pair.flank_curvature_radius(x, member), pair.flank_curvature_radius(x, mate))
    modulus = 1.0 / (1.0 / gear.plane_modulus + 1.0 / pair.gear(mate).plane_modulus)
    return line_contact(part.load, curvature, modulus).half_width


def face_positions(scene: Scene, name: str) -> Array:
    """Places along the face [m]: those of the case, or so many equally spaced from end to end."""
    wanted, half = scene.case.stiffness.face_positions, 0.5 * scene.gears[name].face_width
    if isinstance(wanted, int):
        return np.linspace(-half, half, wanted) if wanted > 1 else np.zeros(1)
    return np.array(wanted)


@dataclass(frozen=True)
class StiffnessInputs:
    """What the table of a gear depends on besides its influence functions.

    Parameters
    ----------
    gear : Gear
    radii, half_widths : ndarray, shape (R,)
        Of the contacts [m].
    positions : ndarray, shape (Z,), or None
        Places along the face of a gear that is solved with its width [m].
    tolerance : float
        That estimated errors are compared with.
    assumed : tuple of str
        Sentences about values that the case does not give.
    name : str
        Of the gear.
    """

    gear: Gear
    radii: Array
    half_widths: Array
    positions: Array | None
    tolerance: float
    assumed: tuple[str, ...] = field(default=(), compare=False)
    name: str = field(default="", compare=False)


def stiffness_inputs(scene: Scene, name: str) -> StiffnessInputs:
    """Contacts of a gear, and what is said of those that the case leaves open."""
    part, gear, radii = scene.case.stiffness, scene.gears[name], load_radii(scene, name)
    wide = part.face_positions is not None
    assumed = () if wide and gear.body else bore_remarks(scene, name)
    if part.contact_half_width is None and part.load is None:
        usual = f"c_self is for a contact half-width of {USUAL_HALF_WIDTH} modules."
        assumed = (assuming(f"Gear {name}: contact_half_width or load not specified; {usual}"), *assumed)
    places, tolerance = face_positions(scene, name) if wide else None, scene.case.accuracy.tolerance
    return StiffnessInputs(gear, radii, contact_half_width(scene, name, radii), places, tolerance, assumed, name)
