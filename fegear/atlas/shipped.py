"""The atlases that come with fegear: gears of steel cut by racks of ISO 53 at 20 degrees, in plane strain.

`python -m fegear.atlas A` builds one again: some 800 gears, and 1,300 for compliances only, eight minutes of one core;
stopped, it goes on where it was. Made like others fewer are enough: B from A and C by 326 gears.
"""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from importlib.resources import as_file, files
from typing import TYPE_CHECKING

from fegear.atlas.build import build_atlas
from fegear.atlas.domain import Domain
from fegear.atlas.family import Family
from fegear.atlas.interpolation import load_atlas
from fegear.atlas.refining import refined
from fegear.base.errors import InputError, RangeError

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.atlas.interpolation import Atlas
    from fegear.base.solution_cache import SolutionCache
    from fegear.geometry.gear import Gear

#: h_fP and rho_fP of the basic racks of ISO 53 [modules].
RACKS = {"A": (1.25, 0.38), "B": (1.25, 0.3), "C": (1.25, 0.25), "D": (1.4, 0.39)}
#: Those whose atlas comes with fegear.
SHIPPED = ("A", "B", "C", "D")
#: Those that are made like others.
_LIKE = {"B": ("A", "C")}
#: Tooth numbers, profile shift (at the fewest teeth below the most), depth below the undercut line, tip height, bore.
_FEWEST, _MANY, _MOST = 12, 150, 400
_LOWEST, _HIGHEST, _AT_FEWEST, _AT_SPLIT = -0.3, 0.7, 0.45, 0.6
_DEEPEST, _AT_LINE = -0.3, -0.002
_TIP_HEIGHT, _BORE = (0.88, 1.05), (0.35, 0.65)
#: Neighbours to either side: as many as bear load with a tooth, corners included.
_REACH = 2


def family_of(rack: str) -> Family:
    """Gears of a rack of ISO 53.

    Raises
    ------
    InputError
        If there is no such rack.
    """
    if rack not in RACKS:
        raise InputError("rack", f'"{rack}"', f"must be one of {', '.join(RACKS)}")
    return Family(*RACKS[rack])


def domains_of(family: Family) -> list[Domain]:
    """Where an atlas that comes with fegear holds: gears from 12 to 400 teeth, with undercut and without."""
    split = next(z for z in range(_FEWEST + 1, _MANY) if family.least_shift(z) <= _LOWEST)
    return [
        Domain((split, _MANY), (_LOWEST, _HIGHEST), _TIP_HEIGHT, _BORE, highest_at_first=_AT_SPLIT),
        Domain((_FEWEST, split - 1), (_LOWEST, _AT_SPLIT), _TIP_HEIGHT, _BORE, highest_at_first=_AT_FEWEST),
        Domain((_FEWEST, split - 1), (_DEEPEST, _AT_LINE), _TIP_HEIGHT, _BORE, side="undercut"),
        Domain((_MANY, _MOST), (_LOWEST, _HIGHEST), _TIP_HEIGHT, _BORE),
    ]


def built(
    rack: str, *, cache: SolutionCache | None = None, progress: Callable[[int, int], None] | None = None
) -> Atlas:
    """Build the atlas of a rack; see `build_atlas`."""
    family, like = family_of(rack), [shipped_atlas(one) for one in _LIKE.get(rack, ())]
    found = build_atlas(family, domains_of(family), reach=_REACH, cache=cache, progress=progress, like=like)
    return refined(found, cache=cache, progress=progress)


@cache
def shipped_atlas(rack: str = "A") -> Atlas:
    """The atlas of a rack of ISO 53 that comes with fegear.

    Parameters
    ----------
    rack : str
        Letter of the rack.

    Raises
    ------
    InputError
        If fegear comes with none of it.
    """
    if rack not in SHIPPED:
        racks = ", ".join(SHIPPED)
        raise InputError("rack", f'"{rack}"', f"comes without an atlas (with one: {racks})", _BUILD)
    with as_file(files("fegear.atlas").joinpath(file_name(rack))) as path:
        return load_atlas(path)


_BUILD = "build it: python -m fegear.atlas RACK"


def file_name(rack: str) -> str:
    """Of the atlas of a rack."""
    return f"iso53_{rack.lower()}.npz"


@cache
def fingerprint() -> str:
    """Digest of the atlases that come with fegear."""
    contents = (files("fegear.atlas").joinpath(file_name(rack)).read_bytes() for rack in SHIPPED)
    return sha256(b"".join(contents)).hexdigest()


def atlas_of(gear: Gear) -> Atlas | None:
    """The shipped atlas that holds a gear; None where none does."""
    try:
        nearest = nearest_atlas(gear)
    except RangeError:
        return None
    return nearest if nearest.holds(gear) else None


def nearest_atlas(gear: Gear) -> Atlas:
    """The shipped atlas of a gear's family, whether it holds the gear or not; else the one that differs least.

    Raises
    ------
    RangeError
        If the gear is of no family that an atlas could have.
    """
    family = Family.of(gear)
    found = next((rack for rack in SHIPPED if not family_of(rack).unlike(family)), None)
    return shipped_atlas(found or min(SHIPPED, key=lambda rack: len(family_of(rack).unlike(family))))
