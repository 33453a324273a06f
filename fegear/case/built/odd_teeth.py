"""From ``[[gear.NAME.odd_tooth]]`` to the mechanics: cracks, outlines and flanks of teeth by their numbers."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.gear_flanks import tooth_profile
from fegear.case.built.odd_gears import odd_gears_of, on_other_flank
from fegear.case.built.tooth_influence import mesh_settings
from fegear.case.odd_tooth import STARTS
from fegear.contact.odd_flank import OddFlank, Pit, ToothProfile
from fegear.fem.alike_teeth import meshing_order
from fegear.fem.plane.odd.crack import Crack
from fegear.fem.plane.odd.hole import Hole, hole_at, refuse_hole
from fegear.fem.plane.odd.keyway import Keyway, din_6885, refuse_keyway
from fegear.fem.plane.odd.other_outline import SHORTEST_FLANK, Missing, OtherTip

if TYPE_CHECKING:
    from fegear.case.odd_tooth import CrackPart, HolePart, KeywayPart, OddToothPart, PitPart
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import Member

#: Where a crack starts unless the case says it: the tangent of ISO 6336-3.
_USUAL_TANGENT = math.radians(30.0)
_IN_MODULES = re.compile(r"(\d[\d.e+-]*)( to (\d[\d.e+-]*))? modules")


@dataclass(frozen=True)
class OddTeeth:
    """The odd teeth of a gear, by their number in meshing order.

    Parameters
    ----------
    cracks : tuple of (int, Crack)
    outlines : tuple of (int, OtherTip, Missing, Hole or Keyway)
    flanks : tuple of (int, OddFlank)
    profiles : tuple of (int, ToothProfile)
    member : {"driver", "driven"}
        What it is in its pairs: its teeth mesh the other way round.
    name : str
    """

    cracks: tuple[tuple[int, Crack], ...]
    outlines: tuple[tuple[int, OtherTip | Missing | Hole | Keyway], ...]
    flanks: tuple[tuple[int, OddFlank], ...]
    profiles: tuple[tuple[int, ToothProfile], ...]
    member: Member
    name: str = field(compare=False)

    def by_number(self, teeth: int) -> dict[int, Crack | OtherTip | Missing | Hole | Keyway]:
        """Cracks and outlines by the tooth's own number, as of `fegear.fem.alike_teeth`."""
        return {meshing_order(tooth, teeth, self.member): one for tooth, one in (*self.cracks, *self.outlines)}

    def in_solid(self, teeth: int) -> dict[int, Crack | Missing]:
        """Cracked and missing teeth by the tooth's own number: those of which a 3D gear's body differs."""
        return {number: one for number, one in self.by_number(teeth).items() if isinstance(one, Crack | Missing)}

    def crack_tips(self, teeth: int) -> dict[int, tuple[float, float]]:
        """Tips of its cracks by the tooth's own number, as formulas take them: begun in the fillet at x > 0 [modules].

        A beam loses the same whichever fillet a crack begins in.
        """
        tips = {tooth: (-crack.corners[-1][0] if crack.back else crack.corners[-1][0], crack.corners[-1][1])
                for tooth, crack in self.cracks}  # fmt: skip
        return {meshing_order(tooth, teeth, self.member): tip for tooth, tip in tips.items()}

    def on_other_flank(self) -> OddTeeth:
        """The same teeth as the gear that they drive loads them, on the flank that is not said to be loaded.

        Pits and profiles are of the loaded flank; cracks that one flank opens the other presses together: their faces
        may close.
        """
        cracks = tuple((tooth, crack.mirrored()) for tooth, crack in self.cracks)
        flanks = tuple(
            (tooth, replace(flank, pits=()))
            for tooth, flank in self.flanks
            if flank.missing or not math.isnan(flank.tip_radius)
        )
        outlines = tuple(
            (tooth, one.mirrored() if isinstance(one, Hole | Keyway) else one) for tooth, one in self.outlines
        )
        return OddTeeth(cracks, outlines, flanks, (), "driver", self.name)

    @property
    def numbers(self) -> tuple[int, ...]:
        """Of all of them, rising."""
        return tuple(sorted({tooth for tooth, _ in (*self.cracks, *self.outlines, *self.flanks, *self.profiles)}))

    @property
    def described(self) -> str:
        """Which teeth are what, in words."""
        known = dict(self.flanks)
        of = {
            "cracked": [tooth for tooth, _ in self.cracks],
            "missing": [tooth for tooth, flank in known.items() if flank.missing],
            "shorter": [tooth for tooth, flank in known.items() if not math.isnan(flank.tip_radius)],
            "pitted": [tooth for tooth, flank in known.items() if flank.pits],
            "above a hole": [tooth for tooth, one in self.outlines if isinstance(one, Hole)],
            "above a keyway": [tooth for tooth, one in self.outlines if isinstance(one, Keyway)],
            "with another profile": [tooth for tooth, _ in self.profiles],
        }
        return ", ".join(
            f"{'tooth' if len(teeth) == 1 else 'teeth'} {', '.join(map(str, sorted(teeth)))} {what}"
            for what, teeth in of.items()
            if teeth
        )


def odd_teeth_in(scene: Scene, pair: str, gear: str) -> OddTeeth:
    """The odd teeth of a gear as a pair loads them."""
    found = odd_teeth_of(scene, gear)
    return found.on_other_flank() if on_other_flank(scene, pair, gear) else found


def odd_teeth_of(scene: Scene, name: str) -> OddTeeth:
    """The odd teeth of a gear as the case describes them: by the flank that carries where it is driven, if it is.

    Raises
    ------
    InputError
        If a crack, a tip or a pit does not fit its tooth.
    """
    gear, cracks, flanks, profiles = scene.gears[name], [], [], []
    outlines: list[tuple[int, OtherTip | Missing | Hole | Keyway]] = []
    for n, part in enumerate(scene.case.gear[name].odd_tooth):
        prefix = f"gear.{name}.odd_tooth[{n}]"
        if part.crack is not None:
            cracks.append((part.tooth, crack_of(gear, part.crack, f"{prefix}.crack")))
        outline = _outline(gear, part, prefix)
        if outline is not None:
            outlines.append((part.tooth, outline))
        if part.hole is not None:
            outlines.append((part.tooth, hole_of(gear, part.hole)))
        if part.keyway is not None:
            outlines.append((part.tooth, keyway_of(gear, part.keyway, f"{prefix}.keyway")))
        pits = tuple(_pit(gear, pit, f"{prefix}.pits[{at}]") for at, pit in enumerate(part.pits))
        if outline is not None or pits:
            tip = outline.radius * gear.module if isinstance(outline, OtherTip) else math.nan
            flanks.append((part.tooth, OddFlank(isinstance(outline, Missing), tip, pits)))
        if part.profiled:
            profiles.append((part.tooth, tooth_profile(scene, name, part, prefix)))
    driven = any(name == part.driven for part in scene.case.pair.values())
    member: Member = "driven" if driven else "driver"
    return OddTeeth(tuple(cracks), tuple(outlines), tuple(flanks), tuple(profiles), member, name)


def _outline(gear: Gear, part: OddToothPart, prefix: str) -> OtherTip | Missing | None:
    """Another outline of a tooth than the gear's, if it has one."""
    if part.missing:
        return Missing()
    key = "broken_at" if part.broken_at is not None else "tip_diameter"
    diameter = getattr(part, key)
    if diameter is None:
        return None
    tooth, m = gear.tooth, gear.module
    root, shortest, tip = 2.0 * m * np.array([tooth.root_radius, tooth.form_radius + SHORTEST_FLANK, tooth.tip_radius])
    least = root if key == "broken_at" else shortest
    if not least <= diameter <= tip * (1.0 + 1e-12):
        raise InputError(
            f"{prefix}.{key}", f"{diameter * 1e3:.6g} mm",
            f"must be between {least * 1e3:.6g} and {tip * 1e3:.6g} mm, the tip diameter of the gear",
        )  # fmt: skip
    return OtherTip(min(0.5 * diameter / m, tooth.tip_radius)) if diameter >= shortest else Missing()


def hole_of(gear: Gear, part: HolePart) -> Hole:
    """A hole beside a gear's tooth, lengths in modules."""
    return hole_at(0.5 * part.diameter / gear.module, part.position_radius / gear.module, part.angle)


def keyway_of(gear: Gear, part: KeywayPart, prefix: str) -> Keyway:
    """A keyway below a gear's tooth, lengths in modules.

    Raises
    ------
    InputError
        If a dimension is not given and DIN 6885-1 has none for the bore.
    """
    width, depth = part.width, part.depth
    if width is None or depth is None:
        try:
            usual = din_6885(2.0 * gear.bore_radius)
        except InputError as error:
            key = "width" if width is None else "depth"
            raise InputError(
                f"{prefix}.{key}", f"(not specified, bore diameter {error.value})", error.rule, error.remedy
            ) from None  # fmt: skip
        width, depth = usual[0] if width is None else width, usual[1] if depth is None else depth
    return Keyway(width / gear.module, depth / gear.module, part.angle)


def check_keyway(scene: Scene, gear: str, number: int) -> None:
    """Refuse a keyway that its gear has no room for, or that is not the only odd tooth, before anything is solved.

    Raises
    ------
    InputError
        Under its key in the case.
    """
    made, described = scene.gears[gear], scene.case.gear[gear]
    part, key = described.odd_tooth[number].keyway, f"gear.{gear}.odd_tooth[{number}].keyway"
    if part is None:
        return
    keyway = keyway_of(made, part, key)
    if sum(one.reshaped for one in described.odd_tooth) > 1:
        raise InputError(
            key, "(given)", "is not available beside other teeth with a different body", "remove one of them"
        )
    if described.rim_support is not None:
        raise InputError(key, "(given)", "is not available with rim_support (the bore is fixed)", "remove rim_support")
    if made.tooth.internal:
        raise InputError(key, "(given)", "is available for external gears only", "remove it")
    try:
        refuse_keyway(made.symmetric_tooth, made.bore_radius / made.module, keyway)
    except InputError as error:
        value, rule = (_in_mm(text, 1e3 * made.module) for text in (error.value, error.rule))
        raise InputError(f"{key}.{error.key}", value, rule, error.remedy) from None


def check_hole(scene: Scene, gear: str, number: int) -> None:
    """Refuse a hole that does not lie within the sector of its tooth, before anything is solved.

    Raises
    ------
    InputError
        Under its key in the case.
    """
    part, made = scene.case.gear[gear].odd_tooth[number].hole, scene.gears[gear]
    if part is None:
        return
    try:
        refuse_hole(
            made.symmetric_tooth, made.bore_radius / made.module, mesh_settings(scene.case.accuracy),
            hole_of(made, part),
        )  # fmt: skip
    except InputError as error:
        value, rule = (_in_mm(text, 1e3 * made.module) for text in (error.value, error.rule))
        raise InputError(
            f"gear.{gear}.odd_tooth[{number}].hole.{error.key}", value, rule, error.remedy
        ) from None  # fmt: skip


def _pit(gear: Gear, part: PitPart, prefix: str) -> Pit:
    low, high = part.radii
    start, end = gear.involute_radii
    if high <= start or low >= end:
        key, scale = ("radius", 1e3) if part.radius is not None else ("diameter", 2e3)
        raise InputError(
            f"{prefix}.{key}", f"{low * scale:.6g} to {high * scale:.6g} mm",
            f"is outside the flank, {start * scale:.6g} to {end * scale:.6g} mm",
        )  # fmt: skip
    off = abs(part.face_position)
    if off > 0.0 and off >= 0.5 * (1.0 + part.face_share) * gear.face_width:
        half = 0.5e3 * gear.face_width
        raise InputError(
            f"{prefix}.face_position", f"{part.face_position * 1e3:.6g} mm",
            f"places the whole pit outside the face, {-half:.6g} to {half:.6g} mm from its middle",
            "choose a position on the face",
        )  # fmt: skip
    return Pit(low, high, part.face_share, part.depth or 0.0, part.face_position)


def crack_of(gear: Gear, part: CrackPart, prefix: str) -> Crack:
    """A crack of a gear's tooth, lengths in modules.

    Raises
    ------
    InputError
        If it does not start on the fillet, or does not run into the tooth.
    """
    from fegear.fem.plane.odd.crack import Crack, mouth_at_radius, mouth_at_tangent, straight_crack

    tooth, m = gear.symmetric_tooth, gear.module
    start = next((key for key in STARTS if getattr(part, key) is not None), "tangent_angle")
    given, back, closing = getattr(part, start), part.fillet == "compression", part.crack_faces == "closing"
    try:
        if start == "arc":
            mouth = given / m
        elif start == "tangent_angle":
            mouth = mouth_at_tangent(tooth, _USUAL_TANGENT if given is None else given)
        else:
            mouth = mouth_at_radius(tooth, given / m * (0.5 if start == "diameter" else 1.0))
        if part.path is not None:
            return Crack(mouth, tuple((x / m, y / m) for x, y in part.path), back, closing)
        straight = straight_crack(
            tooth, mouth, part.angle, depth=(part.depth or 0.0) / m, share=part.depth_ratio or 0.0, back=back
        )
        return replace(straight, closing=closing)
    except InputError as error:
        raise _as_given(error, part, start, m).under(prefix) from None


def check_crack(scene: Scene, gear: str, number: int) -> None:
    """Refuse a crack that leaves its tooth or comes too near a surface, before anything is solved.

    Raises
    ------
    InputError
        Under its key in the case.
    """
    from fegear.fem.plane.odd.cracked_sector import refuse_crack

    part, made = scene.case.gear[gear].odd_tooth[number].crack, scene.gears[gear]
    if part is None:
        return
    prefix = f"gear.{gear}.odd_tooth[{number}].crack"
    crack = crack_of(made, part, prefix)
    start = next((key for key in STARTS if getattr(part, key) is not None), "tangent_angle")
    try:
        refuse_crack(made.symmetric_tooth, made.bore_radius / made.module, mesh_settings(scene.case.accuracy), crack)
    except InputError as error:
        raise _as_given(error, part, start, made.module).under(prefix) from None


def check_odd_gear(scene: Scene, name: str) -> None:
    """Refuse what no tooth has, and gears whose teeth are loaded on both flanks.

    Raises
    ------
    InputError
    """
    pairs = {key: part for key, part in scene.case.pair.items() if key in scene.plane_pairs}
    drives = next((key for key, part in pairs.items() if part.driver == name), None)
    driven = next((key for key, part in pairs.items() if part.driven == name), None)
    key = f"gear.{name}.odd_tooth"
    if drives is not None and driven == drives:
        raise InputError(
            key, "(given)", f"is ambiguous: gear {name} is driver and driven gear of pair {drives}",
            "describe the mating gear as a separate gear",
        )  # fmt: skip
    if drives is not None and driven is not None and not _is_planet(scene, name):
        raise InputError(
            key, "(given)", f"is not available for idlers yet: pairs {driven} and {drives} load opposite flanks",
            "use one case for each pair",
        )  # fmt: skip
    odd_teeth_of(scene, name)
    for n in range(len(scene.case.gear[name].odd_tooth)):
        check_crack(scene, name, n)
        check_hole(scene, name, n)
        check_keyway(scene, name, n)


def _is_planet(scene: Scene, name: str) -> bool:
    """Whether a gear is in mesh as the planet of one set only: its flanks' order is known."""
    if not scene.case.planetary:
        return False
    from fegear.case.planetary import MESHES, set_pair

    pairs = {key for key, one in scene.case.pair.items() if name in (one.driver, one.driven)}
    return any(
        part.planet == name and pairs <= {set_pair(key, mesh) for mesh in MESHES}
        for key, part in scene.case.planetary.items()
    )


def check_left_contact(scene: Scene, pair: str) -> None:
    """Refuse a missing tooth where no other pair is in contact.

    Raises
    ------
    InputError
    """
    meshed = scene.pairs[pair]
    flanks = (flank for gear in odd_gears_of(scene, pair) for _, flank in odd_teeth_of(scene, gear).flanks)
    gone = any(flank.missing for flank in flanks)
    if gone and not scene.case.effects.corner_contact and meshed.contact_ratio < 2.0:
        raise InputError(
            "effects.corner_contact", "false",
            f"leaves no tooth pair in contact at a missing tooth (contact ratio {meshed.contact_ratio:.3f})",
            "set effects.corner_contact = true",
        )  # fmt: skip


def check_plane_pits(scene: Scene, pair: str) -> None:
    """Refuse pits of a plane pair beside mid-face: there the face has no places.

    Raises
    ------
    InputError
    """
    for gear in odd_gears_of(scene, pair):
        for n, part in enumerate(scene.case.gear[gear].odd_tooth):
            for at, pit in enumerate(part.pits):
                if pit.face_position != 0.0:
                    raise InputError(
                        f"gear.{gear}.odd_tooth[{n}].pits[{at}].face_position", f"{pit.face_position * 1e3:.6g} mm",
                        "has no effect in plane (2D) pairs, whose pits are at mid-face",
                        f'set pair.{pair}.width = "solid", or remove face_position',
                    )  # fmt: skip


def _as_given(error: InputError, part: CrackPart, start: str, module: float) -> InputError:
    """An error of the mechanics in keys and millimetres of the case."""
    end = next(key for key in ("depth", "depth_ratio", "path") if getattr(part, key) is not None)
    key = {"mouth": start, "radius": start, "share": end, "depth": end}.get(error.key, error.key)
    scale = 1e3 * module * (2.0 if key == "diameter" else 1.0)

    def in_mm(text: object) -> str:
        return _in_mm(text, scale).replace("must be a radius of", f"must be a {key} on")

    if key == "depth_ratio":
        length = f"(length {error.value}) " if error.value else ""
        return InputError(key, f"{part.depth_ratio:.4g}", in_mm(length + error.rule), error.remedy)
    if key == "path":
        corners = np.array(part.path) * 1e3
        value = "[" + ", ".join(f"[{x:.4g}, {y:.4g}]" for x, y in corners.tolist()) + "] mm"
        return InputError(key, value, in_mm(error.rule), error.remedy)
    return InputError(key, in_mm(error.value), in_mm(error.rule), in_mm(error.remedy))


def _in_mm(text: object, scale: float) -> str:
    """Lengths of a text that are in modules, in millimetres."""

    def length(found: re.Match[str]) -> str:
        upto = f" to {float(found[3]) * scale:.4g}" if found[3] else ""
        return f"{float(found[1]) * scale:.4g}{upto} mm"

    return _IN_MODULES.sub(length, str(text))
