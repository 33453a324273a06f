"""Rows against numbers in print: standards, books, reports. What only came back from an input is in none of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import partial

import numpy as np

from fegear.geometry.gear import Gear, Hand
from fegear.geometry.pair import GearPair
from fegear.verify.iso6336_examples import rows as example_rows
from fegear.verify.kept import examples, kept
from fegear.verify.row import Compared, Row, Rows, near, printed

ROWS = Rows()
INCH, PSI = 0.0254, 6894.757
_AGMA = "AGMA 908-B89, tables of I and J as textbooks of machine design reprint them"
_SDP = "SDP/SI, Elements of Metric Gear Technology, section 10"
#: Parts of ISO 6336 by the beginnings of symbols.
_PARTS = {
    "load-factors": (
        "load factors and mesh stiffness of ISO 6336-1",
        ("K_", "c'", "c_", "C_", "N", "m_red", "F_", "v"),
    ),
    "flank": ("contact stress and safety of ISO 6336-2", ("Z_", "sigma_H", "S_H", "rho", "eps")),
    "root": ("root stress and safety of ISO 6336-3", ("Y_", "sigma_F", "S_F", "s_F", "h_F", "alpha_F")),
}


def _of_example(name: str, begins: tuple[str, ...]) -> Iterator[Compared]:
    """Printed factors of a published rating by the beginnings of their symbols; not those that were put in."""
    for row in example_rows(examples()[name]):
        if row.symbol.startswith(begins) and not row.used:
            for text, found, moved in zip(row.printed, row.found, row.moved, strict=True):
                one = printed(found, text, moved)
                yield one if one.holds else one.known(row.reason)


def _rating_rows() -> list[Row]:
    """A row for each part of the standard of each published rating."""
    made = []
    for name, example in examples().items():
        for part, (capability, begins) in _PARTS.items():
            if not any(symbol.startswith(begins) for symbol in example["printed"]):
                continue
            title, source = f"{name.replace('_', '-')}-{part}", f"{example['source']} ({example['kind']})"
            compare = partial(_of_example, name, begins)
            made.append(Row(title, capability, "printed", source, f"{example['title']}.", compare))
    return made


def _pair(z1: int, z2: int, helix: float = 0.0, face: float = 1.5 * INCH) -> GearPair:
    """Gears of AGMA's tables: 20 degrees, h_ao 1.25, r_ao .25, thinning .024, ten teeth per inch."""
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear, Material
    from fegear.geometry.pair import GearPair
    from fegear.geometry.rack import BasicRack

    # E that makes Z_E the 2300 sqrt(psi) of Shigley, with nu = .3.
    steel = Material(young_modulus=2300.0**2 * PSI * 2.0 * math.pi * 0.91, poisson_ratio=0.3)
    beta, gears = math.radians(helix), []
    hands: tuple[tuple[int, Hand], ...] = ((z1, "right"), (z2, "left"))
    for z, hand in hands:
        tooth = Tooth(z, BasicRack(1.0, 1.25, 0.25), thickness_allowance=0.024, helix_angle=beta)
        bore = 0.3 * tooth.root_radius * INCH / 10
        gears.append(Gear(tooth, INCH / 10, bore, face, steel, hand=hand if helix else "spur"))
    return GearPair(gears[0], gears[1])


def _bending(pair: GearPair, *texts: float) -> Iterable[Compared]:
    from fegear.formulas.agma.agma908 import bending_factor
    from fegear.geometry.pair import MEMBERS

    return [printed(bending_factor(pair, m).J, f"{t:.2f}") for m, t in zip(MEMBERS, texts, strict=True)]


@ROWS.add("bending geometry factor J of spur gears", "printed", _AGMA)
def agma_j_spur() -> Iterator[Compared]:
    """J of fifteen pairs loaded at the HPSTC; 55/135 teeth come to .464 for the printed .47."""
    for z1, z2, *texts in kept("agma908")["spur"]:
        for one in _bending(_pair(z1, z2), *texts):
            yield one.known("the reprint rounds up") if (z1, z2) == (55, 135) and not one.holds else one


@ROWS.add("bending geometry factor J of spur gears loaded at the tip", "printed", _AGMA)
def agma_j_tip() -> Iterator[Compared]:
    """J of five gears loaded at the tip; 55 teeth come to .274 for the printed .28."""
    from fegear.formulas.agma.agma908 import pair_geometry_factor

    for z, text in kept("agma908")["spur_tip"]:
        one = printed(pair_geometry_factor(_pair(z, z), "driver", tip=True).J, f"{text:.2f}")
        yield one.known("the reprint rounds up") if z == 55 and not one.holds else one


@ROWS.add("geometry factors I and J of helical gears", "printed", _AGMA)
def agma_helical() -> Iterator[Compared]:
    """I and J of six pairs of 10 degrees of helix with an axial contact ratio of 2."""
    from fegear.formulas.agma.agma908 import pitting_factor

    face = 2.0 * math.pi / math.sin(math.radians(10.0)) * INCH / 10
    for z1, z2, text, *texts in kept("agma908")["helical"]:
        pair = _pair(z1, z2, 10.0, face)
        yield printed(pitting_factor(pair), f"{text:.3f}")
        yield from _bending(pair, *texts)


@ROWS.add("rating by ANSI/AGMA 2101", "printed", "Shigley's Mechanical Engineering Design, 8th edition, example 14-4")
def shigley_14_4() -> Iterator[Compared]:
    """Factors, stresses and safeties of a spur pair; the book goes on with rounded factors, so stresses to .1 %."""
    from fegear.formulas.agma import agma2101
    from fegear.formulas.agma.agma2101_factors import Mounting

    pair, turning = _pair(17, 52), 1800.0 * math.pi / 30.0
    v = turning * pair.driver.pitch_radius
    service = agma2101.Service(
        4.0 * 745.69987 / v, v, (1e8, 1e8 * 17 / 52), accuracy=11, reliability=0.9, size=(1.043, 1.052),
        mounting=Mounting("commercial"),
    )  # fmt: skip
    steels = tuple(agma2101.allowable_stress("through-hardened", 1, hardness) for hardness in (240.0, 200.0))
    found = agma2101.rate(pair, service, (steels[0], steels[1]), agma2101.Geometry(0.121, (0.30, 0.40)))
    for symbol, texts in (
        ("K_H", ("1.22",)), ("Y_Z", ("0.85",)), ("Y_N", ("0.977", "0.996")), ("Z_N", ("0.948", "0.973")),
    ):  # fmt: skip
        yield from map(printed, found.factor(symbol).values, texts)
    yield from near([s / PSI for s in found.bending], [6417.0, 4854.0], 1e-3)
    yield from near([s / PSI for s in found.contact], [70360.0, 70660.0], 1e-3)
    yield from map(printed, found.S_H, ("1.69", "1.52"))


@ROWS.add("load spectra by ISO 6336-6", "printed", "ISO 6336-6:2019, annex C, table C.2")
def iso6336_6_annex_c() -> Iterator[Compared]:
    """Load cycles to pitting of 42 levels within the digits of stress, Z_v and cycles, and their damage of 1."""
    from fegear.formulas.iso6336.life import Knots
    from fegear.formulas.iso6336.part6_spectrum import Bin, annex_c_line, cycles_to_failure, damage

    def line(film: float) -> Knots:
        return annex_c_line(Knots((1e5, 5e7, 1e10), (1.6, 1.0, 0.85)), 1500e6 * 1.02 * film * 1.01)

    levels = kept("iso6336_6_annex_c")["levels"]
    for stress, _, borne, _ in levels:
        found = cycles_to_failure(line(0.943), stress * 1e6)
        # What half a unit of the stress' last digit moves it by, of Z_v's, and of its own three digits.
        by_stress = 0.5 * abs(np.diff([cycles_to_failure(line(0.943), (stress + d) * 1e6) for d in (-0.5, 0.5)])[0])
        by_film = 0.5 * abs(np.diff([cycles_to_failure(line(0.943 + d), stress * 1e6) for d in (-5e-4, 5e-4)])[0])
        by_digit = 0.5 * 10.0 ** (math.floor(math.log10(borne)) - 2)
        yield from near(found, borne, (by_stress + by_film + by_digit) / borne)
    yield from near(damage([Bin(stress * 1e6, cycles, line(0.943)) for stress, cycles, *_ in levels]), 1.0, 3e-3)


def _spur(z: int, shift: float = 0.0, module: float = 1e-3) -> Gear:
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear
    from fegear.geometry.rack import BasicRack

    return Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25), shift), module, 0.2 * z * module)


@ROWS.add("measures over pins and over teeth", "printed", _SDP)
def pins_and_span() -> Iterator[Compared]:
    """Over pins of 1.7 mm, span over four teeth, and pins that touch at the V circle."""
    from fegear.geometry.inspection import span
    from fegear.geometry.over_balls import over_balls, touching_ball

    yield printed(over_balls(_spur(20), 1.7e-3).dimension * 1e3, "22.2941")
    yield printed(span(_spur(24, 0.4, 3e-3), 4) * 1e3, "32.8266")
    for shift, text in ((0.0, "1.7886"), (0.2, "1.9979"), (0.4, "2.2687")):
        yield printed(touching_ball(_spur(10, shift)) * 1e3, text)


@ROWS.add("geometry of a planetary set", "printed", "KISSsoft 03/2017 report on the NREL 5 MW gearbox, stage 2")
def planetary_set_18_36_93() -> Iterator[Compared]:
    """Working angle and contact ratio of planet and ring, tip circle of the ring."""
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear
    from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
    from fegear.geometry.pair import GearPair

    planet, ring = (
        Tooth(36, profile_shift=0.5039, tip_radius=815.66 / 42),
        InternalTooth(93, PinionCutter(30), profile_shift=0.1171),
    )
    module, width = 21e-3, 0.55
    gears = (
        Gear(planet, module, 0.5 * planet.root_radius * module, width),
        Gear(ring, module, (ring.root_radius + 4.0) * module, width),
    )
    pair = GearPair(*gears, 0.584)
    angle = printed(math.degrees(pair.working_pressure_angle), "15.630")
    yield angle if angle.holds else angle.known("15.62949: 3e-5 mm of the centre distance of 584 mm would round it up")
    yield printed(pair.contact_ratio, "1.618")
    yield printed(2.0 * ring.tip_radius * module * 1e3, "1906.081", 5e-4)  # the shift is printed to 5e-5


@ROWS.add("root of two ring gears by ISO 6336", "printed", "KISSsoft 03/2017 reports on the NREL 5 MW gearbox")
def rings_of_5_mw() -> Iterator[Compared]:
    """Y_F, Y_S, chord, lever, fillet radius and angle of the load; c_gamma_alpha over c' of planet and ring."""
    from fegear.formulas.iso6336.part1_stiffness import stiffness
    from fegear.formulas.iso6336.part3_internal import RingTooth, ring_root_form

    for teeth, shift, cutter, tip, path, texts in (
        (56, -0.5013, 36, 2475.118 / 45.0, 169.815 / 45.0, ("1.27", "2.13", "2.875", "1.742", "0.494", "19.59")),
        (93, 0.1171, 30, 1906.081 / 21.0, 100.284 / 21.0, ("1.20", "2.34", "2.703", "1.444", "0.418", "18.63")),
    ):
        ring = RingTooth(teeth, shift, 1.25, cutter, 0.0, 0.3)
        form = ring_root_form(ring, ring.load_diameter(tip, path / (math.pi * math.cos(math.radians(20.0)))))
        angle = math.degrees(form.load_angle)
        found = form.Y_F, form.Y_S, form.root_chord, form.moment_arm, form.fillet_radius, angle
        yield from map(printed, found, texts)
    mesh = stiffness((36, -93), 1.6176, profile_shift=(0.5039, 0.1171), dedendum=(1.25, 1.25))
    yield printed(mesh.mesh_alpha / mesh.single, f"{20.563 / 14.053:.4f}", 1e-4)


@ROWS.add(
    "natural frequencies and modes of a planetary set", "printed", "Lin and Parker (1999), example, three planets"
)
def lin_and_parker() -> Iterator[Compared]:
    """Eighteen natural frequencies of a set of three planets."""
    from fegear.dynamics.planetary.set_modes import set_modes
    from fegear.verify.planetary_sets import lin_parker

    rotation = ("0.0", "1475.7", "1930.3", "2658.3", "7462.8", "11775.3")
    translation = ("743.2", "1102.4", "1896.0", "2276.4", "6986.3", "9647.9")
    asked = sorted((*rotation, *translation, *translation), key=float)
    yield from map(printed, set_modes(lin_parker(3), 5e8, 5e8).frequency, asked)


_LUBRICATED = "KISSsoft 03/2017 reports of 26.02.2020 on the NREL 5 MW gearbox, stages 1 and 2, rings of 240 HB"


@ROWS.add("film, work hardening and life factors of through-hardened gears", "printed", _LUBRICATED)
def through_hardened_factors() -> Iterator[Compared]:
    """Z_L, Z_v, Z_R, Z_W, Y_X, Y_R and life factors that whole examples of hard gears do not have."""
    from fegear.formulas.iso6336 import part2_pitting as flank
    from fegear.formulas.iso6336 import part3_strength as root
    from fegear.formulas.iso6336.rated import Strength

    soft = Strength("V", 700e6, 290e6, hardness=240.0, yield_strength=1000e6)
    for diameters, angle, v, texts in (
        ((718.865, 2368.025), 17.161, math.pi * 0.855 * 35.6632 / 60.0, ("0.916", "1.025")),
        ((710.408, 1835.220), 15.630, math.pi * 0.378 * 246.776 / 60.0, ("0.961", "1.026")),
    ):
        one, other = (0.5e-3 * s * d * math.tan(math.radians(angle)) for s, d in zip((1, -1), diameters, strict=True))
        rho = one * other / (one + other)
        yield printed(flank.lubricant_factor(soft.contact, 220e-6), "1.038")
        yield printed(flank.velocity_factor(soft.contact, v), texts[0])
        yield printed(flank.roughness_factor(soft.contact, (4.8e-6, 8e-6), rho), texts[1])
        equivalent = flank.equivalent_roughness((4.8e-6, 8e-6), rho, 220e-6, v)
        yield printed(flank.surface_hardened_factor(240.0, equivalent)[0], "1.135")
    yield printed(root.size_factor("V", 21e-3), "0.904")
    yield printed(root.size_factor("V", 45e-3), "0.850")
    yield printed(root.surface_factor("V", 20e-6)[0], "0.957")
    for cycles, flank_text, root_text in ((381.6e6, "0.940", "0.907"), (1506.3e6, "0.901", "0.883")):
        yield printed(flank.life_knots(soft).at(cycles), flank_text)
        yield printed(root.life_knots(soft).at(cycles), root_text)


@ROWS.add("loads on rolling elements", "printed", "Stribeck and Palmgren: Q_max = 4.37 F_r/Z of balls, 4.08 of rollers")
def stribeck() -> Iterator[Compared]:
    """Largest load on an element of a bearing without clearance (4.08 is of n = 1, here 10/9)."""
    from fegear.shafts.rolling_bearing import RollingBearing

    balls = RollingBearing("ball", 40, 4e-3, 60e-3)
    rollers = RollingBearing("roller", 40, 4e-3, 60e-3, roller_length=8e-3)
    for bearing, wanted, allowed in ((balls, 4.37, 2e-3), (rollers, 4.08, 1e-2)):
        moved = np.array([20e-6, 0.0, 0.0, 0.0, 0.0])
        yield from near(bearing.loads(moved).max() * 40 / bearing.reaction(moved)[0][0], wanted, allowed)


@ROWS.add(
    "tooth loss factors and pressure of the FZG test gears", "printed",
    "C. Fernandes (FEUP), reports of the program GEARpie on the gears C14, C40 and H501",
)  # fmt: skip
def fzg_losses() -> Iterator[Compared]:
    """Contact ratio, Ohlendorf's H_V, Wimmer's integral, which is a sum of few places there, load and pressure."""
    from fegear.formulas.flank_speeds import flank_speeds
    from fegear.formulas.flash_temperature import reduced_modulus
    from fegear.formulas.friction import ohlendorf, wimmer
    from fegear.formulas.iso6336.part22_micropitting import pressure

    spur = (16, 24), 4.5e-3, (0.1817, 0.1715)
    oblique = (20, 30), 3.5e-3, (0.1809, 0.0891), (40.336e-3, 58.132e-3), math.radians(15.0), 23e-3
    pair = _fzg(*spur, (41.228e-3, 59.182e-3))
    for one, ratio, closed, summed in (
        (pair, "1.44", "0.1950", 0.1945),
        (_fzg(*spur, (41.318e-3, 59.272e-3)), "1.46", "0.1986", 0.1984),
        (_fzg(*oblique), "1.46", "0.1639", 0.1869),
    ):
        yield printed(one.contact_ratio, ratio)
        yield printed(ohlendorf(one), closed, input_moves=1e-4)
        yield from near(wimmer(one), summed, 5e-3)
    load = 200.0 / pair.driver.base_radius
    yield printed(load, "5912.1", input_moves=0.06)
    found = pressure(flank_speeds(pair, 0.0, 157.1), load / 14e-3, reduced_modulus((206e9, 206e9), (0.3, 0.3)))
    yield printed(float(found) * 1e-6, "1347.3", input_moves=0.45)


def _fzg(
    teeth: tuple[int, int], module: float, shifts: tuple[float, float], tips: tuple[float, float], helix: float = 0.0,
    face: float = 14e-3,
) -> GearPair:  # fmt: skip
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.rack import BasicRack

    rack, gears = BasicRack.named("A", math.radians(20.0)), []
    hands: tuple[Hand, Hand] = ("right", "left") if helix else ("spur", "spur")
    for z, x, tip, hand in zip(teeth, shifts, tips, hands, strict=True):
        tooth = Tooth(z, rack, profile_shift=x, thickness_allowance=0.01, tip_radius=tip / module, helix_angle=helix)
        gears.append(Gear(tooth, module, 0.4 * module / math.cos(helix) * z, face, hand=hand))
    return GearPair(gears[0], gears[1], 91.5e-3)


@ROWS.add(
    "basic rating life of bearings by ISO 281", "printed", "worked examples: hchbearing.com, sarthaks.com 2642436"
)
def bearing_lives() -> Iterator[Compared]:
    """Equivalent load and revolutions of two ball bearings under combined load, and of a rating of eight loads."""
    from fegear.shafts.life import LifeRating

    # Ratings printed to four digits, of which the third power makes three times the error.
    for rating, radial, axial, equivalent, speed in (
        (LifeRating(19730.0, "ball", 0.56, 1.6, 0.2), 2000.0, 300.0, 2000.0, 1600.0),
        (LifeRating(51280.0, "ball", 0.56, 1.6, 0.2), 4000.0, 2400.0, 6080.0, 1000.0),
    ):
        yield from near(rating.equivalent_load(radial, axial), equivalent, 1e-9)
        yield from near(rating.revolutions(radial, axial), 60.0 * speed * 10_000.0, 1e-3)
    yield from near(LifeRating(16e3).revolutions(2e3, 0.0), 512e6, 1e-9)


ROWS.all[:0] = _rating_rows()
