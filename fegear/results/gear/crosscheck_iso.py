"""ISO 6336 part of the result ``crosscheck``, factors and root stresses of each pair; and Cornell's root section."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.base.shown import shows
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Points, outline
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, Rows
from fegear.engine.value import Value
from fegear.geometry.gear_data import GearData
from fegear.geometry.outline import tooth_outline

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.compared.rated_gears import HelicalCheck, RatedGear, RatedPair
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.settings import MeshSettings
    from fegear.fem.plane.table import StiffnessTable
    from fegear.formulas.cornell import SectionLengths
    from fegear.formulas.iso6336.part1_stiffness import Stiffness
    from fegear.formulas.iso6336.part3_pair import RatingChoice, RootRating
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
        said.append(f"{error.key} {error.rule}: no ISO 6336 root stress in crosscheck for gear {gear}.")
        return scene.case.gear[gear].rim(scene.gears[gear].root_radius)


def load_of_stiffness(applied_load: float, load_factor: float) -> str:
    """Name the specific load [N/m] that c' of ISO 6336-1 is for; K_A K_gamma in it only where it is not 1."""
    symbol = "F_t/b" if load_factor == 1.0 else "F_t K_A K_gamma/b"
    return f"{symbol} = {applied_load * 1e-3:.6g} N/mm"


@dataclass(frozen=True)
class IsoRow:
    """Factors and root stresses of one gear by ISO 6336, beside its finite elements; nan where there is none."""

    gear: RatedGear
    role: str
    name: str

    @property
    def rating(self) -> RootRating | None:
        """None where the standard gives none."""
        return self.gear.rating.value

    def _of(self, *path: str) -> float:
        value: Any = self.rating
        for step in path:
            value = None if value is None else getattr(value, step)
        return math.nan if value is None else float(value)

    @property
    @shows("", "number of teeth of the virtual spur gear")
    def z_n(self) -> float:
        """z_n."""
        return self._of("teeth")

    @property
    @shows("", "form factor without f_epsilon")
    def Y_F(self) -> float:
        """Y_F."""
        return self._of("form", "Y_F")

    @property
    @shows("", "load distribution, edition 2019")
    def f_epsilon(self) -> float:
        """f_epsilon."""
        return self._of("load_distribution")

    @property
    @shows("", "stress correction factor")
    def Y_S(self) -> float:
        """Y_S."""
        return self._of("form", "Y_S")

    @property
    @shows("", "helix angle factor")
    def Y_beta(self) -> float:
        """Y_beta."""
        return self._of("helix")

    @property
    @shows("", "rim thickness factor")
    def Y_B(self) -> float:
        """Y_B."""
        return self._of("rim")

    @property
    @shows("", "deep tooth factor")
    def Y_DT(self) -> float:
        """Y_DT."""
        return self._of("deep_tooth")

    @property
    @shows("MPa", "nominal root stress with every factor")
    def sigma_f0(self) -> float:
        """[Pa]."""
        return self._of("stress")

    @property
    @shows("MPa", "F_t/(b m_n) Y_F Y_S")
    def form_stress(self) -> float:
        """[Pa]."""
        return self.gear.form_stress

    @property
    @shows("MPa", "maximum root stress of the same (virtual) spur tooth, FE")
    def root_tension_fe(self) -> float:
        """[Pa]."""
        return self.gear.fe

    @property
    @shows("", "form_stress / FE")
    def ratio_to_fe(self) -> float:
        """Of both."""
        return self.gear.form_stress / self.gear.fe

    @property
    @shows("", "reason, if no value")
    def reason(self) -> str:
        """Empty where there is something."""
        return self.gear.reason


@dataclass(frozen=True)
class IsoPair:
    """What ISO 6336 gives for one pair, and what it was asked."""

    asked: IsoInputs
    found: RatedPair

    @property
    def rows(self) -> tuple[IsoRow, ...]:
        """Driver first."""
        parts = zip(self.found.gears, ("driver", "driven"), self.asked.names, strict=True)
        return tuple(IsoRow(gear, role, name) for gear, role, name in parts)

    @property
    def rated(self) -> tuple[IsoRow, ...]:
        """Gears that the standard rates."""
        return tuple(row for row in self.rows if row.rating is not None)

    @property
    def stiffness(self) -> Stiffness | None:
        """Of helical pairs; None where there is none."""
        return None if self.found.stiffness is None else self.found.stiffness.value

    @property
    @shows("N/(mm.um)")
    def single(self) -> float | None:
        """c' [Pa]."""
        return None if self.stiffness is None else self.stiffness.single

    @property
    def face_width(self) -> float | None:
        """Of helical pairs, the common one [m]."""
        return None if self.asked.helical is None else self.asked.helical.pair.face_width

    @property
    def under(self) -> str:
        """The load that c' is for, in words."""
        check = self.asked.helical
        return load_of_stiffness(check.applied_load, check.load_factor) if check else ""


def on_iso(seen: Seen) -> Iterator[str]:
    """Say what was chosen, and what is not given of one pair."""
    one: IsoPair = seen.one
    yield from one.asked.said
    if one.asked.chosen:
        load = f"F_t/b = {USUAL_SPECIFIC_LOAD * 1e-3:.6g} N/mm"
        yield assuming(f"Pair {seen.key}: no load was given; ISO 6336 takes {load}.")
    if one.found.stiffness is None:
        return
    if one.stiffness is None:
        yield f"Pair {seen.key}: ISO 6336-1 gives no c': {one.found.stiffness.reason}"
    yield (
        f"Crosscheck of pair {seen.key}: the helical teeth are compared through their virtual spur teeth; finite "
        "elements are interpolated between the integers next to z_n, without helix angle."
    )


#: Of an `IsoPair` whose name is the key.
ISO_TABLE = Rows(
    "crosscheck_iso_6336_{key}",
    lambda seen: f"ISO 6336-3:{seen.one.asked.choice.edition} root stress of pair {seen.key}",
    (
        Cell("name", si=lambda seen: np.array(seen.one.asked.names), of=lambda _: GearData),
        "z_n", "Y_F", "f_epsilon", "Y_S", "Y_beta", "Y_B", "Y_DT", "sigma_f0", "form_stress", "root_tension_fe",
        "ratio_to_fe", "reason",
    ),
    of="rows",
)  # fmt: skip


def _rated(seen: Seen) -> Iterator[Value]:
    """Nominal root stress of the gears that the standard rates."""
    edition = seen.one.asked.choice.edition
    number = Number(
        "sigma_f0", owner=f"{seen.key}.{{one.role}}", name="sigma_f0_iso", each="rated",
        meaning=f"ISO 6336-3:{edition} nominal root stress",
    )  # fmt: skip
    return number.values(seen)


ISO_VALUES = (
    _rated,
    Number("single", owner="{key}", name="single_stiffness_iso", meaning="ISO 6336-1 c', solid blank, {one.under}"),
)


#: How far chords may lie off the curves [modules], and points on an arc.
_CHORD, _ARC = 1e-3, 41


@dataclass(frozen=True)
class CornellSection:
    """Cornell's root section of a gear over load positions, shape (N,), in SI; lengths scaled by its module."""

    found: SectionLengths
    gear: Gear
    stiffness: StiffnessTable

    @property
    @shows("mm", "radius of the load point", table="section")
    def radius(self) -> Array:
        """[m]."""
        return self.stiffness.radius

    @property
    @shows("deg", "epsilon", table="section")
    def roll_angle(self) -> Array:
        """[rad]."""
        return self.found.roll

    @property
    @shows("deg", "phi' (B.5), of the load against the normal to the centre line", table="section")
    def load_angle(self) -> Array:
        """[rad]."""
        return self.found.load_angle

    @property
    @shows("deg", "gamma (B.10), of the load point to the centre line", table="section")
    def load_point_angle(self) -> Array:
        """[rad]."""
        return self.found.load_half_angle

    @property
    @shows("mm", "h_W (B.6), tooth thickness at the load point", table="section")
    def load_thickness(self) -> Array:
        """[m]."""
        return self.found.load_thickness * self.gear.module

    @property
    @shows("mm", "l_0 (B.9), line of action on the centre line above R_m", table="section")
    def arm(self) -> Array:
        """[m]."""
        return self.found.arm * self.gear.module

    @property
    @shows("deg", "gamma_s (B.2), tangent at the section to the centre line", table="section")
    def place_angle(self) -> Array:
        """[rad]."""
        return self.found.place

    @property
    @shows("", "A (B.3) = h_s/r", table="section")
    def a(self) -> Array:
        """A."""
        return self.found.a

    @property
    @shows("", "B (B.4) = l_s'/r", table="section")
    def b(self) -> Array:
        """B."""
        return self.found.b

    @property
    @shows("mm", "h_s", table="section")
    def section_thickness(self) -> Array:
        """[m]."""
        return self.found.thickness * self.gear.module

    @property
    @shows("mm", "l_s (B.7)", table="section")
    def section_to_load(self) -> Array:
        """[m]."""
        return self.found.to_load * self.gear.module

    @property
    @shows("mm", "l_s' (B.8)", table="section")
    def section_to_line(self) -> Array:
        """[m]."""
        return self.found.to_line * self.gear.module

    @property
    @shows("deg", "beta")
    def base_half_angle(self) -> float:
        """[rad]."""
        return self.found.section.base_half_angle

    @property
    @shows("mm", "r, minimum radius of the trochoid")
    def fillet_radius(self) -> float:
        """[m]."""
        return self.found.section.fillet_radius * self.gear.module

    @property
    @shows("mm", "R_m, junction with the radial flank")
    def fillet_height(self) -> float:
        """[m]."""
        return self.found.section.fillet_height * self.gear.module

    @property
    @shows("mm", "h_0, tooth thickness at R_m")
    def root_thickness(self) -> float:
        """[m]."""
        return self.found.section.root_thickness * self.gear.module


#: Of what has a `CornellSection` as ``cornell``, and the gear's name as the key.
SECTION_TABLE = Rows("cornell_section_{key}", "Cornell's root section of gear {key}", (Every("section"),), of="cornell")
SECTION_VALUES = tuple(
    Number(key, lambda _: 0.0, "cornell", owner="{key}.cornell")
    for key in ("base_half_angle", "fillet_radius", "fillet_height", "root_thickness")
)


def section_figure(seen: Seen) -> Iterator[Figure]:
    """Cornell's tooth over the generated one, with the load that stresses it most and both places of the stress."""
    shown = seen.one.cornell
    name, gear, fe, found = seen.key, shown.gear, shown.stiffness, shown.found
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
        Points([mm * width], [mm * height], f"position by B.2, {math.degrees(gamma):.1f}°", "green", "diamond"),
        Points([fe_at[0] * 1e3], [fe_at[1] * 1e3], f"position by FE, {fe_angle:.1f}°", "blue", "square"),
    )
    x, y = Axis("x", "mm", limits=(-across * mm, across * mm)), Axis("y", "mm", limits=(low * mm, high * mm))
    yield Figure(
        f"cornell_section_{name}",
        f"Cornell's root section of gear {name}",
        f"Gear {name}: tooth with the load position of maximum root stress (FE), radius {load * mm:.6g} mm; "
        "Cornell's tooth has a radial flank below the base circle and a circular fillet. Angles are those of the "
        "fillet's tangent to the centre line.",
        (Panel(x, y, items, height=1.6, equal=True),),
    )


def _fe_place(gear: Gear, fe: StiffnessTable, i: int) -> tuple[Array, float]:
    """Where finite elements put the largest tension of contact `i`: the point [m] and its tangent angle [deg]."""
    from fegear.formulas.root_section import fillet_parameter, fillet_point, tangent_range

    angle = float(fe.root_tension_angle[i])
    tooth = gear.external_tooth
    p = fillet_point(tooth, fillet_parameter(tooth, float(np.clip(angle, *tangent_range(tooth)))))
    return np.array([p.half_thickness, p.height]) * gear.module, math.degrees(angle)
