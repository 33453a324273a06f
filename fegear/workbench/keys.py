"""What a script may write for a quantity."""

from __future__ import annotations

import reprlib
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypedDict

from fegear.units import as_text, to_si
from fegear.workbench.given import taken

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pint

#: A text with its unit (``"3 mm"``), a quantity of pint, or a number in SI.
Quantity: TypeAlias = "str | float | pint.Quantity[Any]"
Length: TypeAlias = Quantity
Torque: TypeAlias = Quantity
Force: TypeAlias = Quantity
Speed: TypeAlias = Quantity


class GearKeys(TypedDict, total=False):
    """Keys of ``[gear.NAME]`` of a case file besides ``teeth`` and ``module``; lists and tables as there."""

    diametral_pitch: Quantity
    pressure_angle: Quantity
    profile_shift: float
    rack: str | Mapping[str, Any]
    thickness_allowance: Quantity
    tip_diameter: Quantity
    tip_radius_rounding: Quantity
    tip_chamfer: Quantity
    bore_radius: Quantity
    rim_thickness: Quantity
    web_thickness: Quantity
    face_width: Quantity
    ball_diameter: Quantity
    plane: Literal["strain", "stress", "auto"]
    material: Mapping[str, Any]
    strength: Mapping[str, Any]
    roughness: Mapping[str, Any]
    flank_treatment: str
    tooth_mesh: str
    tooth_mesh_fillet: Literal["rack", "own"]
    relief: Mapping[str, Any]
    lead: Mapping[str, Any]
    bias: Quantity | Mapping[str, Any]
    topography: Mapping[str, Any]
    spacing_errors: Sequence[Quantity] | Mapping[str, Any]
    tolerance_class: int
    deviations: Mapping[str, Any]
    helix_angle: Quantity
    hand: Literal["left", "right", "spur"]
    normal_module: Quantity
    normal_diametral_pitch: Quantity


class PairKeys(TypedDict, total=False):
    """Keys of ``[pair.NAME]`` of a case file besides its gears, its load, the centre distance and the compliance."""

    speed: Quantity
    width: Literal["plane", "slices", "solid"]
    root_stress: Mapping[str, Any]
    misalignment: Mapping[str, Any]
    line_error: Mapping[str, Any]
    modification: Mapping[str, Any]
    axial_offset: Quantity
    iso_6336: Mapping[str, Any]
    lubricant: Mapping[str, Any]
    friction: Mapping[str, Any]
    operation: Mapping[str, Any]
    shafts: Mapping[str, Any]


_brief = reprlib.Repr()
_brief.maxlist = _brief.maxdict = 4
_brief.maxstring = _brief.maxother = 60


def brief(value: object) -> str:
    """Write what was given, long lists cut short."""
    return _brief.repr(value)


def in_si(value: Quantity, dimension: str, key: str) -> float:
    """A quantity in SI.

    Raises
    ------
    InputError
        If it has another dimension or cannot be read.
    """
    return to_si(as_text(value, dimension, bare_si=True), dimension, key)


def listed(value: Any, key: str) -> list[Any] | None:
    """The members of a list, tuple, range or array of quantities; None for a single one."""
    found = taken(value, key)
    return found if isinstance(found, list) else None
