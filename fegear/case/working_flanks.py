"""Gears of a case seen from the flanks that its pairs load: the key `flank` of ``[pair.NAME]``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.model import Case
    from fegear.geometry.gear import Gear
    from fegear.geometry.involute_side import Flank

#: Sources of compliance that hold for asymmetric teeth: finite elements, and numbers of the user.
_SOURCES = ("fe", "table")


def with_working_flanks(case: Case, gears: Mapping[str, Gear]) -> dict[str, Gear]:
    """The gears, asymmetric ones seen from the flank that their pairs load; from the drive flank in no pair.

    Parameters
    ----------
    case : Case
    gears : mapping
        Asymmetric ones seen from their drive flanks.

    Raises
    ------
    InputError
        If a gear would be loaded on both flanks, or a pair of equal flanks names one.
    """
    loaded: dict[str, tuple[str, Flank]] = {}
    roles: dict[str, tuple[str, str]] = {}
    for name, part in case.pair.items():
        both = [gear for gear in dict.fromkeys((part.driver, part.driven)) if gears[gear].asymmetric]
        if not both:
            _check_symmetric(case, name)
            continue
        _check_plane(case, name, both[0])
        flank: Flank = part.flank or "drive"
        for gear in both:
            role = "both" if part.driver == part.driven else "driver" if gear == part.driver else "driven"
            other, known = roles.setdefault(gear, (name, role))
            if known != role:
                raise InputError(
                    f"pair.{name}.{role if role != 'both' else 'driver'}", f'"{gear}"',
                    f"is an idler with asymmetric teeth (see pair {other}), loaded on both flanks: not available yet",
                    'use one case for each pair, with flank = "coast" for one of them',
                )  # fmt: skip
            first, before = loaded.setdefault(gear, (name, flank))
            if before != flank:
                raise InputError(
                    f"pair.{name}.flank", f'"{flank}"',
                    f"contradicts the {before} flank of gear {gear} in pair {first}", "use one case for each pair",
                )  # fmt: skip
    return {
        name: gear.from_the_back if loaded.get(name, ("", "drive"))[1] == "coast" else gear
        for name, gear in gears.items()
    }


def _check_symmetric(case: Case, name: str) -> None:
    """Refuse a working flank of a pair whose gears are not described by both flanks."""
    part = case.pair[name]
    gears = (case.gear[part.driver], case.gear[part.driven])
    if part.flank is not None and not any(gear.describes_both_flanks for gear in gears):
        raise InputError(
            f"pair.{name}.flank", f'"{part.flank}"', "requires asymmetric teeth",
            "set coast_pressure_angle of both gears, or remove it",
        )  # fmt: skip


def _check_plane(case: Case, name: str, gear: str) -> None:
    """Refuse what is for equal flanks only in a pair of an asymmetric gear."""
    part = case.pair[name]
    if part.width not in (None, "plane"):
        raise InputError(
            f"pair.{name}.width", f'"{part.width}"', f"is not available for the asymmetric teeth of gear {gear}",
            'set width = "plane", or remove it',
        )  # fmt: skip
    if part.compliance.source not in _SOURCES:
        raise InputError(
            f"pair.{name}.compliance.source", f'"{part.compliance.source}"',
            f"is not available for the asymmetric teeth of gear {gear}", 'set source = "fe"',
        )  # fmt: skip
    if part.root_stress.source != ("fe",):
        raise InputError(
            f"pair.{name}.root_stress.source", list(part.root_stress.source),
            f"is not available for the asymmetric teeth of gear {gear}", 'set source = "fe"',
        )  # fmt: skip
