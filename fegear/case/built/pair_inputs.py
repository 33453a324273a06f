"""From a case's pair to plain inputs: gears, loads, effects, and whatever its files hold.

Where a pair's root stress comes from, as ``pair.NAME.root_stress`` says.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.case.built.table_ends import relief_table_notes
from fegear.case.csv_file import read_columns
from fegear.case.effects import AT_REST, PLANE_EFFECTS, EffectsPart
from fegear.case.part import at
from fegear.case.relief import ReliefPart, ReliefTablePart
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.plausible_flanks import heavy_load, refuse_spacing_errors
from fegear.geometry.relief import TabulatedRelief, roll_of_radius

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.case.pair import CompliancePart
    from fegear.case.reading import Scene
    from fegear.contact.plane.compliance import RootStressInfluence
    from fegear.contact.plane.formula_root_stress import FormulaRootStress
    from fegear.fem.plane.gear import GearInfluence
    from fegear.geometry.gear import Gear


class ComplianceTable(NamedTuple):
    """Positions on the line of action [m] and compliances [m/N] that a file of the case gives."""

    x: Array
    compliance: Array


@dataclass(frozen=True)
class Flanks:
    """What a case says of the flanks of one gear of a pair.

    Parameters
    ----------
    relief : ReliefPart or None
    tables : tuple of TabulatedRelief
        The tables of the relief, read.
    spacing : ndarray, shape (teeth,)
        Spacing error of each tooth [m]; empty for none.
    gear : str
        Name of the gear, for messages.
    wrong : mapping of str to InputError
        What is wrong with the data of an effect that is off, by its name: it stops nothing.
    """

    relief: ReliefPart | None
    tables: tuple[TabulatedRelief, ...]
    spacing: Array
    gear: str = field(compare=False)
    wrong: Mapping[str, InputError] = field(default_factory=dict, compare=False)

    @property
    def wants_delta(self) -> bool:
        """Whether the relief's amount is given in Welbourn's Delta."""
        part = self.relief
        return part is not None and any(end.amount_over_delta is not None for end in (*part.tip, *part.root))

    def table_notes(self, pair: GearPair, member: Member) -> tuple[str, ...]:
        """Where tables of the relief end before the active profile of a pair does."""
        measured = self.relief is not None and not self.relief.table
        return relief_table_notes(pair, member, self.gear, self.tables, measured=measured)


@dataclass(frozen=True)
class PairInputs:
    """All that the loaded teeth of a pair depend on, besides the gears' influence functions.

    Parameters
    ----------
    pair : GearPair
    compliance : CompliancePart
    table : ComplianceTable or None
        Where the compliances come from a file.
    effects : EffectsPart
        Those of load sharing; all others are off.
    flanks : tuple of (Flanks, Flanks)
        Of driver and driven.
    loads : tuple of float
        Every load of the case [N], ascending.
    nominal : float
        The load that the contract's tables are for [N].
    assumed : tuple of str
        Sentences about data that the effects neglect and values that the case does not give.
    name : str
        Of the pair.
    """

    pair: GearPair
    compliance: CompliancePart
    table: ComplianceTable | None
    effects: EffectsPart
    flanks: tuple[Flanks, Flanks]
    loads: tuple[float, ...]
    nominal: float
    assumed: tuple[str, ...] = field(default=(), compare=False)
    name: str = field(default="", compare=False)

    def flank(self, member: Member) -> Flanks:
        """Those of driver or driven."""
        return self.flanks[0] if member == "driver" else self.flanks[1]

    @property
    def gears(self) -> tuple[str, str]:
        """Names of driver and driven."""
        return self.flanks[0].gear, self.flanks[1].gear

    @property
    def at_rest(self) -> PairInputs:
        """The same of perfect flanks and teeth, under no load but the one that a contact's width is taken at."""
        driver, driven = (Flanks(None, (), np.empty(0), gear) for gear in self.gears)
        return replace(
            self, effects=self.effects.only(AT_REST), flanks=(driver, driven), loads=(), assumed=(),
            nominal=self.nominal if self.effects.hertz == "linear" else math.nan,
        )  # fmt: skip


def gear_name(scene: Scene, pair: str, member: Member) -> str:
    """Name of the driver or the driven gear of a pair."""
    part = scene.case.pair[pair]
    return part.driver if member == "driver" else part.driven


def pair_inputs(scene: Scene, name: str) -> PairInputs:
    """Collect what a case says of a loaded pair.

    Raises
    ------
    InputError
        If a file is missing or has not what it is named for.
    """
    part, pair, effects = scene.case.pair[name], scene.pairs[name], scene.case.effects
    first, second = (gear_flanks(scene, gear_name(scene, name, member)) for member in MEMBERS)
    own = effects.only(PLANE_EFFECTS)
    table = pair_compliance_table(scene, name) if part.compliance.source == "table" else None
    nominal = part.normal_load(pair) or math.nan
    assumed = effect_remarks(scene, name)
    if effects.relief:
        for member, flank in zip(MEMBERS, (first, second), strict=True):
            assumed += flank.table_notes(pair, member)
        assumed = tuple(dict.fromkeys(assumed))
    if table is not None:
        from fegear.contact.plane.table_compliance import table_note

        if sentence := table_note(pair, table.x, part.compliance.of or "tooth"):
            assumed += (f"Pair {name}: {sentence}",)
    return PairInputs(
        pair, part.compliance, table, own, (first, second), part.all_loads(pair), nominal, assumed, name
    )  # fmt: skip


def gear_flanks(scene: Scene, gear: str, *, drawn: bool = False) -> Flanks:
    """What a case says of the flanks of a gear; data of effects that are off may be wrong.

    Parameters
    ----------
    scene : Scene
    gear : str
    drawn : bool
        Whether the relief is wanted that is drawn, where another one is measured.
    """
    part, effects = scene.case.gear[gear], scene.case.effects
    tables: tuple[TabulatedRelief, ...] = ()
    relief = part.relief
    spacing, wrong = np.empty(0), {}
    try:
        if part.measured is not None and not drawn:
            from fegear.case.built.measured_flanks import measured_gear

            measured = measured_gear(scene, gear)
            tables = () if measured.relief is None or measured.topography is not None else (measured.relief,)
            if tables or measured.topography is not None:
                relief = ReliefPart.model_construct() if tables else None
        tables = tables or tuple(
            _table_relief(scene, scene.gears[gear], table, f"gear.{gear}.relief.table[{i}]")
            for i, table in enumerate(relief.table if relief else ())
        )
    except InputError as error:
        if effects.relief:
            raise
        wrong["relief"] = error
    try:
        spacing = _spacing_errors(scene, gear)
    except InputError as error:
        if effects.spacing_errors:
            raise
        wrong["spacing_errors"] = error
    return Flanks(relief, tables, spacing, gear, wrong)


def effect_remarks(scene: Scene, name: str) -> tuple[str, ...]:
    """Data of the pair that its effects neglect, values assumed for what is not given, corners that cannot touch."""
    from fegear.case.built.rated_duty import bore_remarks, width_remarks
    from fegear.geometry.tip_interference import interference

    remarks, effects = [], scene.case.effects
    for gear in dict.fromkeys(gear_name(scene, name, member) for member in MEMBERS):
        part = scene.case.gear[gear]
        if part.relieved and not effects.relief:
            remarks.append(f"Gear {gear}: relief ignored because effects.relief is off (unmodified involute flanks).")
        if part.spacing_errors is not None and not effects.spacing_errors:
            remarks.append(f"Gear {gear}: spacing_errors ignored because the effect is off (uniform pitch).")
        if part.over_face:
            remarks.append(
                f"Gear {gear}: {' and '.join(part.over_face)} ignored in the plane (2D) model, which has no "
                f'variation along the face; set width = "solid" for pair {name}.'
            )
        remarks += width_remarks(scene, gear)
        if scene.case.pair[name].compliance.source == "fe":
            remarks += bore_remarks(scene, gear)
    given = [key for key in ("misalignment", "line_error", "modification") if getattr(scene.case.pair[name], key)]
    if given:
        remarks.append(
            f"Pair {name}: {' and '.join(given)} ignored in the plane (2D) model, which has no variation along the "
            'face; set width = "solid".'
        )
    pair = scene.pairs[name]
    if sentence := heavy_load(pair, max(scene.case.pair[name].all_loads(pair), default=0.0)):
        remarks.append(f"Pair {name}: {sentence}")
    if effects.corner_contact:
        remarks += [
            f"Pair {name}: tip of the {member} gear reaches below the root form circle of the mating gear "
            "(interference); the path of contact ends there and no corner contact is computed at that end."
            for member in MEMBERS
            if interference(pair, member).below_form_circle
        ]
    return tuple(remarks)


def pair_compliance_table(scene: Scene, name: str) -> ComplianceTable:
    """Positions [m] and compliances [m/N] of the file that a pair names.

    Raises
    ------
    InputError
        If it has not the columns, both kinds of positions or of compliances, or is none of this pair's teeth.
    """
    from fegear.contact.plane.table_compliance import refuse_table

    part, pair = scene.case.pair[name].compliance, scene.pairs[name]
    key = f"pair.{name}.compliance.file"
    dimensions = {
        "x": "length", "roll_angle": "angle", "compliance": "compliance", "load": "force", "deflection": "length"
    }  # fmt: skip
    columns = read_columns(scene.file(part.file or "", key), key, dimensions)
    if "compliance" in columns:
        if "deflection" in columns:
            raise InputError(key, f'"{part.file}"', "has both compliance and deflection", "remove one of the columns")
        c = columns["compliance"]
    elif "load" in columns and "deflection" in columns:
        if not (columns["load"] > 0.0).all():
            raise InputError(key, f'"{part.file}"', "contains a load that is not positive: compliance is undefined")
        c = columns["deflection"] / columns["load"]
    else:
        raise InputError(key, f'"{part.file}"', "has neither a column compliance nor load and deflection")
    place = one_column(columns, ("x", "roll_angle"), key, part.file)
    x = columns[place]
    if place == "roll_angle":
        rb = pair.driver.base_radius
        x = x * rb - rb * math.tan(pair.working_pressure_angle)
    try:
        refuse_table(pair, x, c, part.of or "tooth", part.fit or "cubic")
    except InputError as error:
        raise at(f"pair.{name}", error) from None
    return ComplianceTable(x, c)


def one_column(columns: Mapping[str, Array], names: tuple[str, ...], key: str, file: str | None) -> str:
    """The one name of several of which a file has a column.

    Raises
    ------
    InputError
        If it has none of them, or two that may contradict each other.
    """
    found = [name for name in names if name in columns]
    if not found:
        raise InputError(key, f'"{file}"', f"requires a column {' or '.join(names)}")
    if len(found) > 1:
        raise InputError(
            key, f'"{file}"', f"must have only one of the columns {' and '.join(found)}", f"remove column {found[1]}"
        )
    return found[0]


def _table_relief(scene: Scene, gear: Gear, part: ReliefTablePart, key: str) -> TabulatedRelief:
    if part.file is not None:
        columns = read_columns(
            scene.file(part.file, f"{key}.file"), f"{key}.file",
            {"roll_angle": "angle", "radius": "length", "relief": "length"},
        )  # fmt: skip
        if "relief" not in columns or not ("roll_angle" in columns or "radius" in columns):
            raise InputError(f"{key}.file", f'"{part.file}"', "requires the columns relief and roll_angle or radius")
        one_column(columns, ("roll_angle", "radius"), f"{key}.file", part.file)
        values = columns["relief"]
        roll = columns["roll_angle"] if "roll_angle" in columns else _rolls(gear, columns["radius"], key)
    else:
        values = np.array(part.removals)
        roll = np.array(part.roll_angles) if part.roll_angles else _rolls(gear, np.array(part.radii), key)
    order = np.argsort(roll)
    return TabulatedRelief(roll[order], values[order], part.interpolation)


def _rolls(gear: Gear, radii: Array, key: str) -> Array:
    if (radii < gear.base_radius).any():
        raise InputError(f"{key}.radii", f"{radii.min() * 1e3:.6g} mm", "lies inside the base circle")
    return roll_of_radius(gear, radii)


def _spacing_errors(scene: Scene, gear: str) -> Array:
    """Spacing error of each tooth of a gear [m]; empty for none."""
    part, key = scene.case.gear[gear].spacing_errors, f"gear.{gear}.spacing_errors"
    if part is None:
        return np.empty(0)
    if part.values is not None:
        errors = np.array(part.values)
    else:
        columns = read_columns(scene.file(part.file or "", f"{key}.file"), f"{key}.file", {"spacing_error": "length"})
        if "spacing_error" not in columns:
            raise InputError(f"{key}.file", f'"{part.file}"', "has no column spacing_error")
        errors = columns["spacing_error"]
    teeth, module = scene.gears[gear].teeth, scene.gears[gear].module
    if errors.size != teeth:
        raise InputError(key, f"{errors.size} errors", f"must be one for each of the {teeth} teeth")
    try:
        refuse_spacing_errors(errors, module)
    except InputError as error:
        raise at(f"gear.{gear}", error) from None
    return errors


#: Name of the source that is no formula.
FINITE_ELEMENTS = "fe"


#: Loads at which a formula is tried before anything is computed.
_TRIED = 4


def root_stress_source(
    source: str,
    name: str,
    gear: str,
    pair: GearPair,
    member: Member,
    solved: Mapping[str, GearInfluence],
    *,
    tips: bool,
    whole: bool = False,
) -> RootStressInfluence:
    """One gear's root stress from finite elements or from a formula.

    Parameters
    ----------
    source : str
        ``"fe"`` or the name of a formula.
    name, gear : str
        Of the pair and of the gear in the case.
    pair : GearPair
    member : {"driver", "driven"}
    solved : mapping of str to GearInfluence
        Gears solved by finite elements, by name; needed for ``"fe"``.
    tips : bool
        Whether tip corners may touch the flank beyond the path of contact.
    whole : bool
        Whether a formula must hold on all of the flank where loads act.

    Raises
    ------
    RangeError
        If a formula that must does not, under its key in the case.
    """
    from fegear.contact.plane.fe_compliance import finite_element_compliance

    if source == FINITE_ELEMENTS:
        return finite_element_compliance(solved[gear])
    found = _formula(source, pair, member, tips)
    if whole and found.missing:
        raise _does_not_hold(found, source, name, gear)
    return found


def refuse_formulas(scene: Scene, name: str) -> None:
    """Refuse formulas of external teeth as the source of an internal pair's compliance or root stress."""
    part = scene.case.pair[name]
    if not scene.pairs[name].internal:
        return
    ring = part.driver if scene.gears[part.driver].tooth.internal else part.driven
    for key, sources in (("compliance", (part.compliance.source,)), ("root_stress", part.root_stress.source)):
        for source in sources:
            if source not in ("fe", "table"):
                raise InputError(
                    f"pair.{name}.{key}.source", f'"{source}"', f"is valid for external gears only; {ring} is internal",
                    'set source = "fe"',
                )  # fmt: skip


def check_formulas(scene: Scene, name: str, *, tips: bool) -> None:
    """Refuse a pair of which no source knows a root stress: from a few loads over each flank, then from all.

    A formula that does not hold somewhere, or anywhere, leaves blanks where another one gives values.
    """
    refuse_formulas(scene, name)
    sources, pair = scene.case.pair[name].root_stress.source, scene.pairs[name]
    if FINITE_ELEMENTS in sources:
        return
    for member in MEMBERS:
        if any(
            _formula(source, pair, member, tips, *tried).over_length for tried in ((_TRIED,), ()) for source in sources
        ):
            continue
        raise _does_not_hold(_formula(sources[0], pair, member, tips), sources[0], name, gear_name(scene, name, member))


def _formula(source: str, pair: GearPair, member: Member, tips: bool, *points: int) -> FormulaRootStress:
    from fegear.contact.plane.formula_root_stress import formula_root_stress

    own = pair.gear(member)
    low, high = sorted(float(pair.radius(x, member)) for x in (pair.x_start, pair.x_end))
    if tips:
        low, high = own.form_radius, own.involute_tip_radius
    return formula_root_stress(own, source, low, high, *points)


def _does_not_hold(found: FormulaRootStress, source: str, name: str, gear: str) -> RangeError:
    """What a formula lacks, as a refusal of its key."""
    from fegear.formulas.sources import ROOT_STRESS_SOURCES

    others = ", ".join(f'"{other}"' for other in ROOT_STRESS_SOURCES if other != source)
    rule = f"is not valid on the flank: {found.missing[0]} (gear {gear})"
    remedy = f'choose "fe" or another formula ({others})'
    return RangeError(f"pair.{name}.root_stress.source", f'"{source}"', rule, remedy)
