"""Gears of a case seen from the flanks that its pairs load: the key `flank` of ``[pair.NAME]``.

A gear between two mates, an idler or a planet, is loaded on one flank by the gear that drives it and on the other one
by the gear that it drives. With asymmetric teeth these are two solutions: the gear has its name as it is seen from its
drive flank, and another one, `coast_name`, as it is seen from its coast flank.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from fegear.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.case.model import Case
    from fegear.geometry.gear import Gear
    from fegear.geometry.involute_side import Flank

    Role = Literal["driver", "driven"]

#: Sources of compliance that hold for asymmetric teeth: finite elements, and numbers of the user.
_SOURCES = ("fe", "table")
#: What the name of a gear goes on with where it is seen from its coast flank, and its drive flank is loaded, too.
_COAST = "-coast"


def coast_name(gear: str) -> str:
    """Name of a gear that is loaded on both flanks, seen from its coast flank."""
    return gear + _COAST


def with_working_flanks(case: Case, gears: Mapping[str, Gear]) -> tuple[Case, dict[str, Gear], dict[str, str]]:
    """The gears, asymmetric ones seen from the flank that their pairs load; from the drive flank in no pair.

    Parameters
    ----------
    case : Case
    gears : mapping
        Asymmetric ones seen from their drive flanks.

    Returns
    -------
    case : Case
        With those gears twice that are loaded on both flanks, and pairs that name the one they load.
    gears : dict of str to Gear
    written : dict of str to str
        Names in the case file of gears that have a second one.

    Raises
    ------
    InputError
        If the flanks of pairs that share a gear contradict each other, or a pair of equal flanks names one.
    """
    asymmetric = []
    for name, part in case.pair.items():
        both = [gear for gear in (part.driver, part.driven) if gears[gear].asymmetric]
        if both:
            _check_plane(case, name, both[0])
            asymmetric.append(name)
        else:
            _check_symmetric(case, name)
    flanks = _flanks(case, asymmetric)
    loaded: dict[str, set[Flank]] = {}
    for name, flank in flanks.items():
        for gear in (case.pair[name].driver, case.pair[name].driven):
            loaded.setdefault(gear, set()).add(flank)
    seen = {
        name: gear.from_the_back if loaded.get(name) == {"coast"} else gear for name, gear in gears.items()
    }  # fmt: skip
    twice = [gear for gear, own in loaded.items() if len(own) > 1 and gears[gear].asymmetric]
    if not twice:
        return case, seen, {}
    for gear in twice:
        if coast_name(gear) in case.gear:
            raise InputError(
                f"gear.{coast_name(gear)}", "(given)", f"is the name of the coast flank of gear {gear}", "rename it"
            )
        seen[coast_name(gear)] = gears[gear].from_the_back
    return _with_twice(case, twice, flanks), seen, {coast_name(gear): gear for gear in twice}


def _with_twice(case: Case, twice: list[str], flanks: Mapping[str, Flank]) -> Case:
    """The case with a second name for the coast flanks of some gears, in the pairs that load these."""
    parts = {**case.gear, **{coast_name(gear): case.gear[gear] for gear in twice}}
    pairs, stiffness = dict(case.pair), case.stiffness
    for name, flank in flanks.items():
        named = {role: getattr(pairs[name], role) for role in ("driver", "driven")}
        other = {role: coast_name(gear) for role, gear in named.items() if gear in twice and flank == "coast"}
        pairs[name] = pairs[name].model_copy(update=other)
        if other and stiffness.pair == name and stiffness.gear in twice:
            stiffness = stiffness.model_copy(update={"gear": coast_name(stiffness.gear)})
    return case.model_copy(update={"gear": parts, "pair": pairs, "stiffness": stiffness})


def _flanks(case: Case, asymmetric: list[str]) -> dict[str, Flank]:
    """Working flanks of the pairs of asymmetric gears: as given, else as a mate leaves them, else the drive flanks.

    All mates that drive a gear load one of its flanks, and all mates that it drives the other one.
    """
    found: dict[str, Flank] = {}
    known = [name for name in asymmetric if case.pair[name].flank is not None]
    for first in dict.fromkeys((*known, *asymmetric)):
        if first in found:
            continue
        found[first] = case.pair[first].flank or "drive"
        waiting = [first]
        while waiting:
            name = waiting.pop()
            for other, gear, same in _beside(case, asymmetric, name):
                flank = found[name] if same else _other(found[name])
                given = case.pair[other].flank
                if found.get(other, given or flank) != flank:
                    raise _contradiction(case, name, other, gear, found[name], same=same)
                if other not in found:
                    found[other] = flank
                    waiting.append(other)
    return found


def _beside(case: Case, asymmetric: list[str], name: str) -> Iterator[tuple[str, str, bool]]:
    """Other pairs of the gears of a pair, the gear, and whether it has the same role there."""
    roles: tuple[Role, Role] = ("driver", "driven")
    part = case.pair[name]
    if part.driver == part.driven:  # two gears of one name
        return
    for role in roles:
        gear = getattr(part, role)
        for other in asymmetric:
            mate = case.pair[other]
            if other != name and gear in (mate.driver, mate.driven) and mate.driver != mate.driven:
                yield other, gear, getattr(mate, role) == gear


def _other(flank: Flank) -> Flank:
    return "coast" if flank == "drive" else "drive"


def _contradiction(case: Case, name: str, other: str, gear: str, flank: Flank, *, same: bool) -> InputError:
    """That a gear would be loaded on flanks on which no two mates can load it."""
    given = case.pair[other].flank
    value = f'"{given}"' if given else "(not given)"
    if same:
        return InputError(
            f"pair.{other}.flank", value, f"contradicts the {flank} flank of gear {gear} in pair {name}",
            "use one case for each pair",
        )  # fmt: skip
    return InputError(
        f"pair.{other}.flank", value,
        f"contradicts pair {name}, which loads the {flank} flank of idler {gear}; its mates load opposite flanks",
        f'set flank = "{_other(flank)}", or remove it',
    )  # fmt: skip


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
