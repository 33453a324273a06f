"""From a case file and ``--set`` options to a checked scene; every error is one sentence with key, value and remedy."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from fegear.base.brief import Brief
from fegear.base.effects import Described
from fegear.base.errors import PATH, InputError, shown
from fegear.base.unit_text import plain_number
from fegear.case.effects import started
from fegear.case.known_keys import keys_at
from fegear.case.model import Case
from fegear.case.nearest import nearest
from fegear.case.part import BARE_SI
from fegear.case.references import check_references
from fegear.case.renamed import current, current_key, without_old
from fegear.case.settled import settled
from fegear.case.text_file import is_below, read_text
from fegear.case.working_flanks import with_working_flanks

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.case.pair import Width
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class Scene(Brief):
    """A checked case with its gears and pairs built.

    Attributes
    ----------
    case : Case
        What the user wrote, in SI.
    name : str
        Name of the case, from its file.
    folder : Path
        Where relative file names in the case start.
    gears : dict of str to Gear
        Spur and helical ones.
    pairs : dict of str to GearPair
        Of either.
    helical_pairs : dict of str to HelicalPair
        The flanks of those pairs whose gears are described with a helix angle, zero included, and their errors.
    text : str
        The case file as it was written, with the ``--set`` options as comments in front; empty for a case that was
        never a file.
    document : mapping
        The same as plain tables, ``--set`` options included.
    estimates : bool
        Whether errors are estimated with the numbers of loaded pairs, which do not depend on that: a first answer while
        a value is being moved does without.
    neglects : bool
        Whether the sizes of neglected effects are estimated where the case does not say (`sizes_neglected`).
    drafts : mapping of str to float
        Gears of which a draft is enough, with its relative tolerance: their teeth are solved once, as that tolerance
        usually wants, and not compared with it.
    previews : collection of str
        Gears whose teeth come from an atlas though the case has them solved: for a first answer.
    renamed : tuple of str
        A sentence about every name of the case that is another one now.
    derived : tuple of str
        A sentence about every number that was made of another dimension.
    within : tuple of str, optional
        Real folders below which the files lie that the case may name; None for anywhere.
    written : mapping of str to str
        Names in the case file of gears that have a second one, for their coast flanks.
    """

    case: Case
    name: str
    folder: Path
    gears: dict[str, Gear]
    pairs: dict[str, GearPair]
    helical_pairs: dict[str, HelicalPair] = field(default_factory=dict)
    text: str = ""
    document: Mapping[str, object] = field(default_factory=dict)
    estimates: bool = True
    neglects: bool = True
    drafts: Mapping[str, float] = field(default_factory=dict)
    previews: frozenset[str] = frozenset()
    renamed: tuple[str, ...] = ()
    derived: tuple[str, ...] = ()
    within: tuple[str, ...] | None = None
    written: Mapping[str, str] = field(default_factory=dict)

    @property
    def sizes_neglected(self) -> bool:
        """Whether it is estimated what effects that are off would change; never without estimates of errors."""
        given = self.case.neglected
        return self.estimates and (self.neglects if given is None else given is not False)

    @property
    def spur_gears(self) -> dict[str, Gear]:
        """The gears without a helix: those that results of plane teeth are about."""
        return {name: gear for name, gear in self.gears.items() if gear.helix_angle == 0.0}

    @property
    def spur_pairs(self) -> dict[str, GearPair]:
        """The pairs of spur gears."""
        return {name: pair for name, pair in self.pairs.items() if pair.driver.helix_angle == 0.0}

    def width_of(self, pair: str) -> Width:
        """In which width a pair is loaded: as its key says, else plane for spur and solid for helical gears."""
        return self.case.pair[pair].width_in(self.pairs[pair])

    @property
    def plane_pairs(self) -> dict[str, GearPair]:
        """The pairs whose teeth are loaded in the plane."""
        return {name: pair for name, pair in self.pairs.items() if self.width_of(name) == "plane"}

    @property
    def wide_pairs(self) -> dict[str, GearPair]:
        """The pairs whose teeth are loaded with their width."""
        return {name: pair for name, pair in self.pairs.items() if self.width_of(name) != "plane"}

    def file(self, text: str, key: str) -> Path:
        """Return the path of a file that the case names, or refuse if it is not there or must not be read."""
        return _file(self.folder, self.within, text, key)


def _file(folder: Path, within: tuple[str, ...] | None, text: str, key: str) -> Path:
    path = folder / text
    if within is not None and not is_below(path, within):
        raise InputError(
            key, shown(text, PATH), f"is outside the open folders ({', '.join(within)})",
            "start fegear open with --folder FOLDER",
        )  # fmt: skip
    if not path.is_file():
        raise InputError(key, f'"{text}"', "file not found", f"searched at {path}")
    return path


def read_scene(path: str | Path, overrides: Sequence[str] = ()) -> Scene:
    """Read a case file, apply ``--set`` options, check everything.

    Parameters
    ----------
    path : path of a TOML case file
    overrides : sequence of "dotted.key=value"
        Values are TOML; what is no TOML is taken as text.

    Raises
    ------
    InputError
        If the file cannot be read or anything in it breaks a rule.
    """
    path = Path(path)
    scene = build_scene(read_document(path, overrides), path.stem, path.parent)
    return replace(scene, text=case_text(path, overrides))


def case_text(path: Path, overrides: Sequence[str] = ()) -> str:
    """Return a case file as it is written, with the ``--set`` options as comments in front."""
    return "".join(f"# --set {override}\n" for override in overrides) + read_text(path, "case")


def read_document(path: Path, overrides: Sequence[str] = ()) -> dict[str, Any]:
    """Read a case file as plain tables and apply ``--set`` options, without checking more than that."""
    document = parse_document(read_text(path, "case"), f'"{path}"')
    for override in overrides:
        apply_override(document, override)
    return document


def parse_document(text: str, name: str) -> dict[str, Any]:
    """Read the text of a case file, called `name` in messages, as plain tables."""
    try:
        document = tomllib.loads(text)
    except (
        ValueError,
        RecursionError,
    ) as error:  # besides what TOML forbids, numbers and nests that Python cannot hold
        from fegear.case.toml_remedy import toml_remedy

        raise InputError("case", name, f"invalid TOML: {error}", toml_remedy(text, error)) from None
    _refuse_decimal_commas(text)
    return document


#: A list of plain numbers behind a key.
_NUMBERS = re.compile(r"(?:^|[{,])[ \t]*([\w-]+)[ \t]*=\s*\[([-+.,\w\s]*)\]", re.MULTILINE)


def _refuse_decimal_commas(text: str) -> None:
    """Refuse lists such as ``[0.1, 0,25]``, where one comma is followed by a blank and one stands amid digits."""
    for found in _NUMBERS.finditer(text):
        glued = re.search(r"(?<![\w.])[-+]?\d+,\d+(?![\w.])", found[2])
        if glued and re.search(r",\s", found[2]):
            point, two = glued[0].replace(",", "."), glued[0].replace(",", ", ")
            raise InputError(
                found[1], f"[{' '.join(found[2].split())}]", f"may contain a decimal comma ({glued[0]})",
                f"use {point}, or {two} for two numbers",
            )  # fmt: skip


def build_scene(
    document: Mapping[str, object],
    name: str,
    folder: Path,
    *,
    bare_si: bool = False,
    within: tuple[str, ...] | None = None,
) -> Scene:
    """Check a case given as a plain mapping and build its gears and pairs.

    Parameters
    ----------
    document : mapping
    name : str
    folder : Path
        Where relative file names in the case start.
    bare_si : bool
        Whether numbers without a unit are SI; a case file has none.
    within : tuple of str, optional
        Real folders below which the files lie that the case may name.

    Raises
    ------
    InputError
        If anything in it breaks a rule.
    """
    document, renamed = current(document)
    try:
        case = Case.model_validate(document, context={BARE_SI: bare_si})
    except ValidationError as error:
        from fegear.case.refusal import refusal  # late: it knows the words of the trade

        raise refusal(error, document) from None
    case, derived = settled(case)
    gears = {key: part.build(f"gear.{key}", partial(_file, folder, within)) for key, part in case.gear.items()}
    if case.planetary:
        from fegear.case.set_pairs import with_set_pairs  # few cases have sets

        case = with_set_pairs(case, gears)
    for key, pair in case.pair.items():
        for role in ("driver", "driven"):
            if (gear := getattr(pair, role)) not in case.gear:
                rule, remedy = "is not a gear of this case", nearest(gear, case.gear)
                raise InputError(f"pair.{key}.{role}", f'"{gear}"', rule, remedy)
        if (gears[pair.driver].helix_angle == 0.0) != (gears[pair.driven].helix_angle == 0.0):
            raise InputError(
                f"pair.{key}.driven", f'"{pair.driven}"', "only one of the two gears is helical",
                "specify the same helix_angle and opposite hands",
            )  # fmt: skip
    case, gears, written = with_working_flanks(case, gears)
    pairs = {key: pair.build(gears, f"pair.{key}") for key, pair in case.pair.items()}
    case = _with_effects(case, pairs)
    if any(pair.double_helical is not None for pair in case.pair.values()):
        from fegear.case.halves import check_double_helical  # few cases have such pairs

        check_double_helical(case, gears)
    helical_pairs = {
        key: pair.build_helical(
            pairs[key],
            f"pair.{key}",
            misaligned=case.effects.misalignment,
        )
        for key, pair in case.pair.items()
        if case.gear[pair.driver].is_helical
        and case.gear[pair.driven].is_helical
        and not (pairs[key].internal or pairs[key].asymmetric)
    }
    scene = Scene(
        case,
        name,
        folder,
        gears,
        pairs,
        helical_pairs,
        document=document,
        renamed=renamed,
        derived=derived,
        within=within,
        written=written,
    )
    check_references(
        scene.case,
        {"gear": scene.gears, "spur gear": scene.spur_gears, "pair": scene.pairs, "spur pair": scene.spur_pairs},
    )
    return scene


def _with_effects(case: Case, pairs: Mapping[str, GearPair]) -> Case:
    """The case with the effects that its pairs call for, where ``effects.start`` asks for them."""
    described = [
        Described(
            case.gear[part.driver].model_fields_set | case.gear[part.driven].model_fields_set,
            part.model_dump(exclude_unset=True), part.width_in(pairs[key]) != "plane",
            {part.driver, part.driven} <= {one.gear for shaft in case.shaft.values() for one in shaft.gears},
            case.train is not None, case.train is not None and bool(case.train.torque_ripple),
        )
        for key, part in case.pair.items()
    ]  # fmt: skip
    effects = started(case.effects, described)
    return case if effects is case.effects else case.model_copy(update={"effects": effects})


def apply_override(document: dict[str, Any], override: str) -> None:
    """Set one ``dotted.key=value`` in a case document, or refuse a path that does not exist.

    Parameters
    ----------
    document : dict
        Changed in place.
    override : str
    """
    path, equals, text = override.partition("=")
    steps = path.strip().split(".")
    if not equals or not all(steps):
        raise InputError("--set", f'"{override}"', "must have the form KEY=VALUE", "for example --set gear.a.teeth=30")
    value = typed_value(text)
    if isinstance(value, list):
        _refuse_decimal_commas(f"{steps[-1]} = {text.strip()}")
    set_key(document, path.strip(), value)


def typed_value(text: str) -> object:
    """Somebody's value of a key: TOML; else a number that TOML refuses (.05, 5.), or a text as it stands."""
    try:
        read = tomllib.loads(f"value = {text.strip()}")
    except (ValueError, RecursionError):
        read = {}
    if set(read) == {"value"}:  # not TOML of several keys
        return read["value"]
    number = plain_number(text)
    return text.strip() if number is None else number


def set_key(document: dict[str, Any], path: str, value: object, option: str = "--set") -> None:
    """Set ``dotted.key`` in a case document, or refuse a path that does not exist.

    Parameters
    ----------
    document : dict
        Changed in place.
    path : str
    value : object
    option : str
        Name of the option for error messages.
    """
    path = current_key(path)
    without_old(document, path)
    steps = path.split(".")
    table = document
    for depth, step in enumerate(steps[:-1]):
        if step not in table:
            known = keys_at(steps[:depth]) if depth else sorted(Case.model_fields)
            if not known:  # a misspelt name would otherwise begin a gear, a body or a shaft of its own
                raise InputError(option, f'"{path}"', f'"{step}" is not in this case', nearest(step, table))
            if step not in known:
                raise _unknown(option, path, step, known)
            table[step] = {}
        if not isinstance(table[step], dict):
            raise InputError(option, f'"{path}"', f'"{step}" is not a table')
        table = table[step]
    known = keys_at(steps[:-1])
    if known and steps[-1] not in known and steps[-1] not in table:
        raise _unknown(option, path, steps[-1], known)
    table[steps[-1]] = value


def _unknown(option: str, path: str, step: str, known: Sequence[str]) -> InputError:
    from fegear.case.refusal import meant  # late: it knows the words of the trade

    return InputError(option, f'"{path}"', f'"{step}" is an unknown key', nearest(step, known, words=meant))
