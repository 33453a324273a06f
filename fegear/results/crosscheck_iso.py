"""ISO 6336 part of the result ``crosscheck``: what a case asks for, and its table of factors and root stresses."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column, Table, Value
from fegear.errors import InputError

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.iso_check import HelicalCheck, RatedPair
    from fegear.fem.settings import MeshSettings
    from fegear.formulas.iso6336.part3_pair import RatingChoice

#: Tangential load per face width of helical pairs when the case names none [N/m].
USUAL_LINE_LOAD = 100e3


@dataclass(frozen=True, slots=True)
class IsoInputs:
    """What ISO 6336 is asked for one pair; `helical` is None for spur pairs."""

    names: tuple[str, str]
    choice: RatingChoice
    rims: tuple[float | None, float | None]
    helical: HelicalCheck | None = None
    settings: MeshSettings | None = None
    chosen: bool = False
    said: tuple[str, ...] = field(default=(), compare=False)


def iso_inputs(scene: Scene, name: str, settings: MeshSettings) -> IsoInputs:
    """Take from a scene what ISO 6336 needs of one pair."""
    part = scene.case.pair[name]
    names = (part.driver, part.driven)
    from fegear.contact.iso_check import HelicalCheck
    from fegear.formulas.iso6336.part3_pair import RatingChoice

    choice = RatingChoice(part.iso_6336.edition or 2006, part.iso_6336.accuracy_grade)
    said: list[str] = []
    rims = (_rim(scene, names[0], said), _rim(scene, names[1], said))
    told = tuple(dict.fromkeys(said))
    if name in scene.spur_pairs:
        return IsoInputs(names, choice, rims, said=told)
    pair = scene.helical_pairs[name]
    width = pair.overlap[1] - pair.overlap[0]
    driver = pair.pinion
    force = None if part.load is None else part.load * math.cos(driver.transverse_pressure_angle)
    if part.torque is not None:
        force = part.torque / driver.pitch_radius
    load = USUAL_LINE_LOAD if force is None else force / width
    check = HelicalCheck(pair.design, pair.overlap_ratio, load)
    return IsoInputs(names, choice, rims, check, settings, force is None, told)


def _rim(scene: Scene, gear: str, said: list[str]) -> float | None:
    """s_R of a gear; one whose bore leaves less than Y_B knows counts as solid, which is said."""
    from fegear.models.rated_body import gear_body

    try:
        return gear_body(scene, gear, said).rim_thickness
    except InputError as error:
        said.append(f"{error.key} {error.rule}: the gear counts as solid, Y_B = 1.")
        return None


def iso_table(name: str, asked: IsoInputs, found: RatedPair) -> tuple[Table, tuple[Value, ...], tuple[str, ...]]:
    """Table, values and remarks of one pair."""
    ratings = [gear.rating.value for gear in found.gears]

    def column(head: str, unit: str, meaning: str, *path: str) -> Column:
        values = []
        for one in ratings:
            value: object = one
            for step in path:
                value = None if value is None else getattr(value, step)
            values.append(math.nan if value is None else value)
        return Column(head, np.array(values, dtype=float), unit, meaning)

    form, fe = (np.array([getattr(gear, key) for gear in found.gears]) for key in ("form_stress", "fe"))
    stress = column("sigma_f0", "MPa", "nominal root stress with every factor", "stress")
    columns = (
        Column("gear", np.array(asked.names), "", "name of the gear"),
        column("z_n", "", "number of teeth of the virtual spur gear", "teeth"),
        column("Y_F", "", "form factor without f_epsilon", "form", "Y_F"),
        column("f_epsilon", "", "load distribution, edition 2019", "load_distribution"),
        column("Y_S", "", "stress correction factor", "form", "Y_S"),
        column("Y_beta", "", "helix angle factor", "helix"),
        column("Y_B", "", "rim thickness factor", "rim"),
        column("Y_DT", "", "deep tooth factor", "deep_tooth"),
        stress,
        Column("form_stress", form, "MPa", "F_t/(b m_n) Y_F Y_S alone"),
        Column("root_tension_fe", fe, "MPa", "largest root tension of the same (virtual) spur tooth by FE"),
        Column("ratio_to_fe", form / fe, "", "form_stress over FE"),
        Column("reason", np.array([gear.reason for gear in found.gears]), "", "why there is nothing"),
    )
    edition = asked.choice.edition
    table = Table(f"crosscheck_iso_6336_{name}", columns, f"ISO 6336-3:{edition} root stress of pair {name}")
    values = [
        Value(f"{name}.{role}.sigma_f0_iso", one.stress, "MPa", None, f"ISO 6336-3:{edition} nominal root stress")
        for role, one in zip(("driver", "driven"), ratings, strict=True)
        if one is not None
    ]
    remarks = list(asked.said)
    if asked.chosen:
        remarks.append(f"Pair {name}: no load was given; ISO 6336 takes F_t/b = {USUAL_LINE_LOAD * 1e-3:.6g} N/mm.")
    if found.stiffness is not None:
        iso = found.stiffness.value
        if iso is None:
            remarks.append(f"Pair {name}: ISO 6336-1 gives no c': {found.stiffness.reason}")
        else:
            unit = "N/(mm.um)"
            values += [
                Value(f"{name}.single_stiffness_iso", iso.single, unit, None, "ISO 6336-1 c', solid blank"),
                Value(f"{name}.mesh_stiffness_iso", iso.mesh_alpha, unit, None, "ISO 6336-1 c_gamma_alpha"),
            ]
        remarks.append(
            f"Crosscheck of pair {name}: the helical teeth are compared through their virtual spur teeth; finite "
            "elements are interpolated between the whole numbers of teeth beside z_n and know no helix."
        )
    return table, tuple(values), tuple(remarks)
