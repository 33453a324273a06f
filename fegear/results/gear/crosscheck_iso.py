"""ISO 6336 part of the result ``crosscheck``: what a case asks for, and its table of factors and root stresses.

Cornell's root section: its table, and a drawing of it on the tooth that it stands for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.engine.declared import column_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Points, outline
from fegear.engine.figure.panel import Panel
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.gear_data import GearData
from fegear.geometry.outline import tooth_outline

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.compared.rated_gears import HelicalCheck, RatedPair
    from fegear.fem.plane.settings import MeshSettings
    from fegear.fem.plane.table import StiffnessTable
    from fegear.formulas.cornell import SectionLengths
    from fegear.formulas.iso6336.part3_pair import RatingChoice
    from fegear.geometry.gear import Gear


#: Tangential load per face width of helical pairs when the case names none [N/m].
USUAL_SPECIFIC_LOAD = 100e3


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
    from fegear.contact.compared.rated_gears import HelicalCheck
    from fegear.formulas.iso6336.part3_pair import RatingChoice

    choice = RatingChoice(part.iso_6336.edition or 2006, part.iso_6336.accuracy_grade)
    said: list[str] = []
    rims = (_rim(scene, names[0], said), _rim(scene, names[1], said))
    told = tuple(dict.fromkeys(said))
    if name in scene.spur_pairs:
        return IsoInputs(names, choice, rims, said=told)
    pair = scene.helical_pairs[name]
    width = pair.overlap[1] - pair.overlap[0]
    design = pair.design
    load = part.normal_load(design)
    specific_load = USUAL_SPECIFIC_LOAD if load is None else design.tangential_load(load) / width
    factor = 1.0 if load is None else part.operation.applied_factor
    check = HelicalCheck(design, pair.overlap_ratio, specific_load, factor)
    return IsoInputs(names, choice, rims, check, settings, load is None, told)


def _rim(scene: Scene, gear: str, said: list[str]) -> float | None:
    """s_R of a gear; Y_B refuses one that is too thin, as it does in a rating."""
    from fegear.case.built.rated_body import gear_body

    try:
        return gear_body(scene, gear, said).rim_thickness
    except InputError as error:
        said.append(f"{error.key} {error.rule}: crosscheck gives no root stress of ISO 6336 for gear {gear}.")
        return scene.case.gear[gear].rim(scene.gears[gear].root_radius)


def load_of_stiffness(applied_load: float, load_factor: float) -> str:
    """Name the specific load [N/m] that c' of ISO 6336-1 is for; K_A K_gamma in it only where it is not 1."""
    symbol = "F_t/b" if load_factor == 1.0 else "F_t K_A K_gamma/b"
    return f"{symbol} = {applied_load * 1e-3:.6g} N/mm"


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
        column_of(GearData, "name", np.array(asked.names)),
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
        remarks.append(f"Pair {name}: no load was given; ISO 6336 takes F_t/b = {USUAL_SPECIFIC_LOAD * 1e-3:.6g} N/mm.")
    if found.stiffness is not None:
        iso = found.stiffness.value
        if iso is None:
            remarks.append(f"Pair {name}: ISO 6336-1 gives no c': {found.stiffness.reason}")
        else:
            unit, check = "N/(mm.um)", asked.helical
            under = load_of_stiffness(check.applied_load, check.load_factor) if check else ""
            values += [
                Value(f"{name}.single_stiffness_iso", iso.single, unit, None, f"ISO 6336-1 c', solid blank, {under}"),
                Value(f"{name}.mesh_stiffness_iso", iso.mesh_alpha, unit, None, "ISO 6336-1 c_gamma_alpha"),
            ]
        remarks.append(
            f"Crosscheck of pair {name}: the helical teeth are compared through their virtual spur teeth; finite "
            "elements are interpolated between the whole numbers of teeth next to z_n and know no helix."
        )
    return table, tuple(values), tuple(remarks)


#: How far chords may lie off the curves [modules], and points on an arc.
_CHORD, _ARC = 1e-3, 41


def section_table(name: str, gear: Gear, radius: Array, found: SectionLengths) -> tuple[Table, tuple[Value, ...]]:
    """Table of the section over load positions, and the numbers that do not depend on them."""
    m, s = gear.module, found.section
    columns = (
        Column("radius", radius, "mm", "radius of the load point"),
        Column("roll_angle", found.roll, "deg", "epsilon"),
        Column("load_angle", found.load_angle, "deg", "phi' (B.5), of the load against the normal to the centre line"),
        Column("load_point_angle", found.load_half_angle, "deg", "gamma (B.10), of the load point to the centre line"),
        Column("load_thickness", found.load_thickness * m, "mm", "h_W (B.6), tooth thickness at the load point"),
        Column("arm", found.arm * m, "mm", "l_0 (B.9), line of action on the centre line above R_m"),
        Column("place_angle", found.place, "deg", "gamma_s (B.2), tangent at the section to the centre line"),
        Column("a", found.a, "", "A (B.3) = h_s/r"),
        Column("b", found.b, "", "B (B.4) = l_s'/r"),
        Column("section_thickness", found.thickness * m, "mm", "h_s"),
        Column("section_to_load", found.to_load * m, "mm", "l_s (B.7)"),
        Column("section_to_line", found.to_line * m, "mm", "l_s' (B.8)"),
    )
    values = (
        Value(f"{name}.cornell.base_half_angle", s.base_half_angle, "deg", 0.0, "beta"),
        Value(f"{name}.cornell.fillet_radius", s.fillet_radius * m, "mm", 0.0, "r, the trochoid's smallest"),
        Value(f"{name}.cornell.fillet_height", s.fillet_height * m, "mm", 0.0, "R_m, where it meets the radial flank"),
        Value(f"{name}.cornell.root_thickness", s.root_thickness * m, "mm", 0.0, "h_0, tooth thickness there"),
    )
    return Table(f"cornell_section_{name}", columns, f"Cornell's root section of gear {name}"), values


def section_figure(name: str, gear: Gear, fe: StiffnessTable, found: SectionLengths) -> Figure:
    """Cornell's tooth over the generated one, with the load that stresses it most and both places of the stress."""
    tooth, s, mm = gear.tooth, found.section, gear.module * 1e3
    i = int(np.argmax(fe.root_tension))
    r, r_b, beta, phi = s.fillet_radius, s.base_radius, s.base_half_angle, float(found.load_angle[i])
    arc = np.linspace(0.0, 0.5 * math.pi, _ARC)
    circle = np.stack([0.5 * s.root_thickness + r * (1.0 - np.cos(arc)), s.fillet_height - r * np.sin(arc)])
    flank = np.array([[r_b * math.sin(beta)], [r_b * math.cos(beta)]])
    half = np.hstack([flank, circle])
    both = np.hstack([half * np.array([[-1.0], [1.0]]), np.full((2, 1), math.nan), half])
    turn = np.linspace(-2.2 * beta - phi, 2.2 * beta, _ARC)
    base = r_b * np.stack([np.sin(turn), np.cos(turn)])
    gamma, width = float(found.place[i]), 0.5 * float(found.thickness[i])
    height = s.fillet_height - r * math.sin(gamma)
    load = float(fe.radius[i]) / gear.module
    at = load * np.array([math.sin(found.load_half_angle[i]), math.cos(found.load_half_angle[i])])
    foot, apex = r_b * np.array([-math.sin(phi), math.cos(phi)]), np.array([0.0, r_b / math.cos(phi)])
    beyond = at + 1.0 * np.array([math.cos(phi), math.sin(phi)])
    low, high = tooth.root_radius - 0.25, tooth.tip_radius + 0.3
    across = 1.15 * float(np.abs(both[0][np.isfinite(both[0])]).max())
    fe_at, fe_angle = _fe_place(gear, fe, i)
    section = outline(mm * np.array([[-width, width], [height, height]]), "section h_{s}", "green", 2.2)
    items = (
        outline(mm * tooth_outline(tooth, _CHORD), "generated tooth", "ink", 1.2),
        outline(mm * both, "Cornell's tooth", "orange", 2.2),
        outline(mm * base, "base circle", "grey", 1.0, "dash"),
        outline(mm * np.stack([foot, beyond], axis=1), "line of action", "red", 1.4),
        section,
        Curve(mm * np.zeros(2), mm * np.array([height, apex[1]]), "arm l_{s}'", "purple", dash="dot", markers=False),
        Points([mm * at[0]], [mm * at[1]], "load", "red", "circle", notes=("load",)),
        Points([mm * width], [mm * height], f"place by B.2, {math.degrees(gamma):.1f}°", "green", "diamond"),
        Points([fe_at[0] * 1e3], [fe_at[1] * 1e3], f"place by finite elements, {fe_angle:.1f}°", "blue", "square"),
    )
    x, y = Axis("x", "mm", limits=(-across * mm, across * mm)), Axis("y", "mm", limits=(low * mm, high * mm))
    return Figure(
        f"cornell_section_{name}",
        f"Cornell's root section of gear {name}",
        f"Gear {name}: the tooth with the load that stresses its root most by finite elements, at radius "
        f"{load * mm:.6g} mm; Cornell's tooth has a radial flank below the base circle and a circular fillet. Angles "
        "are those of the fillet's tangent to the centre line.",
        (Panel(x, y, items, height=1.6, equal=True),),
    )


def _fe_place(gear: Gear, fe: StiffnessTable, i: int) -> tuple[Array, float]:
    """Where finite elements put the largest tension of contact `i`: the point [m] and its tangent angle [deg]."""
    from fegear.formulas.root_section import fillet_parameter, fillet_point, tangent_range

    angle = float(fe.root_tension_angle[i])
    tooth = gear.external_tooth
    p = fillet_point(tooth, fillet_parameter(tooth, float(np.clip(angle, *tangent_range(tooth)))))
    return np.array([p.half_thickness, p.height]) * gear.module, math.degrees(angle)
