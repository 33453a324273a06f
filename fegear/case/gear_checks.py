"""Which keys of a gear go together: internal, asymmetric, helical, odd teeth, webs; each refusal names its key."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import shown
from fegear.case.gear_teeth import MEASURES
from fegear.case.part import refuse

if TYPE_CHECKING:
    from fegear.case.gear_keys import GearKeys

_AT_ITS_OUTSIDE = "set outer_radius or rim_thickness: the body of an internal gear is fixed at its outside"
#: Keys of gears that an internal one has not, and what it has instead.
_EXTERNAL_ONLY = {
    "rack": "specify its cutter",
    "bore_radius": _AT_ITS_OUTSIDE,
    "bore_diameter": _AT_ITS_OUTSIDE,
    "web_thickness": "remove it",
    "body": "write outer_radius or rim_thickness",
    "tooth_mesh": "remove it: its mesh is generated",
    "tooth_mesh_fillet": "remove it",
}

#: Keys that are for gears with equal flanks only, and what to do with them.
_SYMMETRIC_ONLY = {
    "transverse_pressure_angle": "remove it",
    "tooth_mesh": "remove it: its mesh is generated",
    "body": "remove it: gears with asymmetric teeth are solid discs",
    "rim_support": "remove it: asymmetric teeth are fixed all round the bore",
    "odd_tooth": "remove it",
    "bias": "remove it",
    "topography": "remove it",
    "span_teeth": "remove it: no span can be measured over flanks of two base circles",
    **dict.fromkeys(MEASURES, "set profile_shift"),
}


def check_internal(part: GearKeys) -> None:
    """Refuse keys of external gears on internal ones, and of internal gears on external ones."""
    if not part.internal:
        for key in ("cutter", "outer_radius"):
            if getattr(part, key) is not None:
                raise refuse("applies only to internal gears", "set internal = true", key=key)
        return
    for key, remedy in _EXTERNAL_ONLY.items():
        if key in part.given:
            raise refuse("is not used for an internal gear", remedy, key=key)
    if part.cutter is None:
        raise refuse(
            "is required for an internal gear",
            "set cutter = { teeth = 20, addendum = 1.25, tip_radius = 0.2 }", key="cutter",
        )  # fmt: skip
    if part.outer_radius is not None and part.rim_thickness is not None:
        raise refuse("contradicts outer_radius", "specify either rim_thickness or outer_radius", key="rim_thickness")


def check_asymmetric(part: GearKeys) -> None:
    """Refuse keys of equal flanks on others."""
    if part.rack.coast_tip_radius is not None and not isinstance(part.rack.tip_radius, float):
        raise refuse(
            "is required for rack.coast_tip_radius", "set rack.tip_radius = 0.25", key="rack.tip_radius",
            value=part.rack.tip_radius,
        )  # fmt: skip
    if not part.asymmetric:
        for key in ("coast_relief", "coast_lead", "coast_measured", "coast_fillet"):
            if getattr(part, key) is not None:
                both = key.removeprefix("coast_")
                raise refuse("requires asymmetric teeth", f"specify {both} (both flanks)", key=key)
        return
    for key, remedy in _SYMMETRIC_ONLY.items():
        if key in part.given:
            raise refuse("is not available for asymmetric teeth", remedy, key=key)
    for key in ("protuberance", "grinding_allowance"):
        if getattr(part.rack, key):
            raise refuse("is not available for asymmetric teeth", "remove it", key=f"rack.{key}")
    if isinstance(part.profile_shift, str):
        raise refuse(
            "is not available for asymmetric teeth", "give the profile shift as a number", key="profile_shift",
            value=shown(part.profile_shift),
        )  # fmt: skip


def check_odd_teeth(part: GearKeys) -> None:
    """Refuse odd teeth of gears that are not solved with them, that are no teeth of theirs, and twice given."""
    if not part.odd_tooth:
        return
    from fegear.case.odd_tooth import OUTLINES  # late: few gears have odd teeth

    for n, one in enumerate(part.odd_tooth if part.internal else []):
        outline = next((key for key in OUTLINES if getattr(one, key)), None)
        if outline is not None:
            raise refuse(
                "is not available for internal gears yet",
                "describe a crack or pits",
                key=f"odd_tooth[{n}].{outline}",
            )
    if part.tooth_mesh is not None:
        raise refuse("requires the generated mesh", "remove tooth_mesh", key="odd_tooth")
    numbers = [one.tooth for one in part.odd_tooth]
    for n, number in enumerate(numbers):
        if number >= part.teeth:
            raise refuse(
                f"must be less than {part.teeth}, the number of teeth (the first tooth is 0)",
                f"specify at most {part.teeth - 1}", key=f"odd_tooth[{n}].tooth", value=number,
            )  # fmt: skip
        if number in numbers[:n]:
            raise refuse(
                "is specified twice", "merge both tables, or change one number", key=f"odd_tooth[{n}].tooth",
                value=number,
            )  # fmt: skip


def check_web(part: GearKeys) -> None:
    """Refuse webs of no rim, wider than any, and twice given."""
    if part.body is not None:
        for key in ("rim_thickness", "web_thickness"):
            if getattr(part, key) is not None:
                raise refuse(f"contradicts body.{key}", f"specify {key} in body only", key=key)
        for key, given in (("bore_radius", part.bore), ("face_width", part.face_width)):
            if given is None:
                raise refuse("is required for a gear with a body", f'set {key} = "20 mm"', key=key)
    if part.web_thickness is None:
        return
    if part.rim_thickness is None and part.bore is None:
        raise refuse(
            "is required for C_R of a gear with web_thickness", 'set rim_thickness = "20 mm"',
            key="rim_thickness",
        )  # fmt: skip
    if part.face_width is None or part.web_thickness > 2.0 * part.face_width:
        raise refuse(
            "must be at most twice the face_width", "check it, or remove it for a solid disc",
            key="web_thickness", value=f"{part.web_thickness * 1e3:.6g} mm",
        )  # fmt: skip


def check_helical(part: GearKeys) -> None:
    """Refuse keys of what is computed in a plane, and what a helical gear cannot do without."""
    for key in ("plane", "tooth_mesh", "tooth_mesh_fillet"):
        if part.has_helix and getattr(part, key) != type(part).model_fields[key].default:
            raise refuse("is not available for helical gears", f"remove {key} (not needed for results)", key=key)
    for key in ("hand", "face_width"):
        if getattr(part, key) is None:
            raise refuse("is required for a helical gear", f"specify {key}", key=key)
