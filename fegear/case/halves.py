"""Double helical pairs of a case: which of them are none, where they must not stand, and what their results are of."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.nearest import nearest

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.model import Case
    from fegear.case.pair import PairPart
    from fegear.geometry.gear import Gear

#: Largest difference of what both halves must have in common, as a share of it.
_EQUAL = 1e-9


def halves_share(case: Case, name: str) -> bool:
    """Whether K_gamma of a pair follows from how its halves share: not given, and not 1 whatever they are."""
    part = case.pair[name]
    return part.double_helical is not None and not part.double_helical.even and part.operation.mesh_load_factor is None


def double_gears(case: Case) -> frozenset[str]:
    """Gears that are one half of a double helical gear."""
    double = (part for part in case.pair.values() if part.double_helical is not None)
    return frozenset(gear for part in double for gear in (part.driver, part.driven))


def half_notes(case: Case, name: str) -> tuple[str, ...]:
    """What results of the pair are of, where it is double helical."""
    if case.pair[name].double_helical is None:
        return ()
    from fegear.case.set_pairs import set_of_pair  # late: few pairs are double helical

    said = f"Pair {name}: one half (end I) of a double helical pair under half of the load"
    return (f"{said}." if set_of_pair(case, name) is not None else f"{said}; see double-helical.",)


def check_double_helical(case: Case, gears: Mapping[str, Gear]) -> None:
    """Refuse double helical pairs that are none, or in places that take a pair for a single helical one.

    Raises
    ------
    InputError
    """
    carried = {one.gear for shaft in case.shaft.values() for one in shaft.gears}
    for name, part in case.pair.items():
        if part.double_helical is None:
            continue
        from fegear.case.set_pairs import set_of_pair  # late: few pairs are double helical

        in_set = set_of_pair(case, name)
        prefix = f"pair.{name}" if in_set is None else f"planetary.{in_set}"
        for role in ("driver", "driven"):
            gear = getattr(part, role)
            _check_gear(f"{prefix}.{role if in_set is None else _role(case, in_set, gear)}", gear, gears, in_set)
        for role, other in part.double_helical.others.items():
            if other is not None:
                _check_other(f"{prefix}.double_helical.second_{role}", other, getattr(part, role), gears)
        if part.line_error is not None:
            raise InputError(
                f"pair.{name}.line_error", "(given)", "is not available with double_helical (a gap of one half only)",
                "specify misalignment of the axes, or lead of second_driver and second_driven",
            )  # fmt: skip
        if part.axial_offset:
            raise InputError(
                f"pair.{name}.axial_offset", f"{part.axial_offset * 1e3:.6g} mm",
                "is not available with double_helical",
                "specify double_helical.apex_offset",
            )  # fmt: skip
        on_shaft = next((gear for gear in (part.driver, part.driven) if gear in carried), None)
        if on_shaft is not None:
            raise InputError(
                f"{prefix}.double_helical", "(given)", f"is not available for gears on shafts (gear {on_shaft})",
                "remove the shafts, or describe both halves as separate pairs",
            )  # fmt: skip
        _check_places(case, name, part)


def _check_in_train(case: Case, key: str, part: PairPart) -> None:
    """Refuse halves that are not two equal meshes side by side, which is what a train can be given."""
    double = part.double_helical
    if double is None:
        return
    equal = "requires equal halves with equal load sharing (a train has no axial motion)"
    tilted = part.misalignment is not None and bool(part.misalignment.given) and case.effects.misalignment
    for wrong, what, value, remedy in (
        (not double.even, "floating", double.floating or "(limited)", "let a member float freely"),
        (double.stagger > 0.0, "stagger", double.stagger, "set stagger = 0"),
        (double.second_driver is not None, "second_driver", double.second_driver, "remove second_driver"),
        (double.second_driven is not None, "second_driven", double.second_driven, "remove second_driven"),
        (tilted, "gap", f"{double.gap * 1e3:.6g} mm", "set effects.misalignment = false"),
    ):
        if wrong:
            raise InputError(f"{key}.{what}", value, f"is not available in a train, which {equal}", remedy)


def _role(case: Case, in_set: str, gear: str) -> str:
    """Of a gear in a planetary set."""
    part = case.planetary[in_set]
    return next((role for role in ("sun", "ring") if getattr(part, role) == gear), "planet")


def _check_gear(key: str, name: str, gears: Mapping[str, Gear], in_set: str | None = None) -> None:
    gear = gears[name]
    if gear.helix_angle == 0.0:
        raise InputError(key, f'"{name}"', "is a spur gear: double_helical requires helical gears", "set helix_angle")
    if gear.tooth.internal and in_set is None:
        raise InputError(
            key, f'"{name}"', "is an internal gear: double_helical is available for external pairs only",
            "remove double_helical; model one half with half the torque",
        )  # fmt: skip
    if gear.body is not None and not gear.body.even:
        raise InputError(
            key, f'"{name}"', "has a body that differs between its ends, which double_helical does not include",
            "remove web_offset, web_inclination and hub_offset",
        )  # fmt: skip


def _check_other(key: str, other: str, name: str, gears: Mapping[str, Gear]) -> None:
    """Refuse a gear at end II that cannot be the other half of one at end I."""
    if other not in gears:
        raise InputError(key, f'"{other}"', "is not a gear of this case", nearest(other, gears))
    one, two = gears[name], gears[other]
    _check_gear(key, other, gears)
    if one.hand == two.hand:
        wanted = "left" if one.hand == "right" else "right"
        raise InputError(
            key, f'"{other}"', f"must be of the other hand than {name}", f'set gear.{other}.hand = "{wanted}"'
        )
    for what, first, second in (
        ("teeth", float(one.teeth), float(two.teeth)), ("module", one.module, two.module),
        ("helix_angle", abs(one.helix_angle), abs(two.helix_angle)), ("face_width", one.face_width, two.face_width),
        ("pressure_angle", one.tooth.base_radius, two.tooth.base_radius),
        ("bore_radius", one.bore_radius, two.bore_radius),
    ):  # fmt: skip
        if abs(first - second) > _EQUAL * abs(first):
            raise InputError(
                key, f'"{other}"', f"must have the {what} of {name}",
                f"make gear.{other}.{what} and gear.{name}.{what} agree",
            )  # fmt: skip


def _check_places(case: Case, name: str, part: PairPart) -> None:
    """Refuse what takes the pair for a single helical one."""
    key = f"pair.{name}.double_helical"
    train, taken = case.train, "remove it; use one half with half the face width and torque"
    if train is not None and any(name in (train.pair_of(one), train.loaded_pair_of(one)) for one in train.mesh):
        _check_in_train(case, key, part)
    if any(name == one.mesh.pair for one in case.transmissibility.values()):
        raise InputError(key, "(given)", "is not available with transmissibility", taken)
    if part.shafts is not None and part.shafts.deformation is None:
        raise InputError(
            f"pair.{name}.shafts.arrangement", f'"{part.shafts.arrangement}"',
            "is not available with double_helical (f_sh of ISO 6336-1 for double helical pinions is not included)",
            "specify shafts.deformation, or operation.face_load_factor",
        )  # fmt: skip
