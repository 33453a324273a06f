"""Rows against other programs: what they gave is kept, or they run now where they are libraries (scikit-fem, scipy)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, cast

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.plane.estimate import Estimate
from fegear.fem.plane.influence import Influence, Side
from fegear.geometry.gear import Gear
from fegear.studies.check import Checked
from fegear.verify.kept import kept
from fegear.verify.row import Compared, Rows, near

ROWS = Rows()
_ALONE = "scikit-fem 12 alone, run now: the whole gear in one system, no ring closure, no reference elements"
_DIN = "github.com/hanslhansl/din3990, tests/test_1.py: 19/104 teeth, m 4 mm"


# ---- a ring by a prototype ----------------------------------------------------------------------------------------
_PROTOTYPE = "a prototype of the project, own elements: ring of 60 teeth, five positions"


@cache
def _ring_of_60() -> tuple[Estimate, dict[str, Any], Array]:
    from dataclasses import replace

    from fegear.fem.plane.estimate import Estimate
    from fegear.fem.plane.settings import settings_at
    from fegear.fem.plane.solved_ring import solve_influence
    from fegear.fem.plane.tooth_meshing import mesh_sector
    from fegear.geometry.internal_tooth import InternalTooth, PinionCutter

    known = kept("ring_prototype")["case"]
    given, settings, coarser = known["inputs"], settings_at(0), settings_at(-1)
    cut = given["cutter"]
    cutter = PinionCutter(cut["z0"], cut["x0"], cut["ha0"], tip_radius=cut["rho"])
    tooth = InternalTooth(given["z"], cutter, profile_shift=given["x"], tip_radius=given["ra"])
    mesh = mesh_sector(tooth, tooth.root_radius + given["rim"], settings)
    fine = solve_influence(
        tooth, mesh, known["nu"], "strain", order=settings.order, reach=1,
        corner_distance=settings.corner_distance, two_orders=True,
    )  # fmt: skip
    lower = replace(cast("Influence", fine.lower), corner_distance=coarser.corner_distance)
    estimate = Estimate(fine, lower, settings.patch_half_width, coarser.patch_half_width)
    return estimate, known, np.array([row["R"] for row in known["rows"]])


def _column(known: dict[str, Any], name: str) -> Array:
    return np.array([row[name] for row in known["rows"]])


@ROWS.add("tooth compliance of a ring", "program", _PROTOTYPE)
def ring_compliance() -> Iterator[Compared]:
    """c_0 over the flank, with the stated error."""
    estimate, known, radii = _ring_of_60()
    value, error, _ = estimate.contact(radii, np.asarray(0.02))
    yield from near(value, _column(known, "c0_fegear"), 2e-4, stated=error)


@ROWS.add("tooth coupling of a ring", "program", _PROTOTYPE)
def ring_neighbours() -> Iterator[Compared]:
    """Both neighbours at all pairs of positions, of c_0."""
    estimate, known, radii = _ring_of_60()
    scale = float(_column(known, "c0_fegear").min())
    for k, name in ((1, "next"), (-1, "prev")):
        value, error = estimate.neighbour(k, radii, radii)
        yield from near(value, known["neighbour_matrices"][name], 2e-4, scale=scale, stated=error)


@ROWS.add("root stress of a ring", "program", _PROTOTYPE)
def ring_root_stress() -> Iterator[Compared]:
    """Root tension and compression by position, with the stated errors."""
    estimate, known, radii = _ring_of_60()
    sides: tuple[Side, ...] = ("tension", "compression")
    for side in sides:
        value, _, error = estimate.root_stress(0, side, radii, np.asarray(0.02))
        yield from near(value, _column(known, f"root_{side}"), 2e-4, stated=error)


# ---- one gear, whole, by scikit-fem alone -----------------------------------------------------------------------
@cache
def _whole() -> Checked:
    from fegear.case.reading import build_scene
    from fegear.studies.check import check_gear

    gears = {"pinion": {"teeth": 17, "profile_shift": 0.35, "module": "3 mm", "bore_radius": "14 mm"}}
    scene = build_scene({"results": ["stiffness"], "gear": gears, "accuracy": {"tolerance": 1e-2}}, "case", Path())
    return check_gear(scene, "pinion", 3)


def _quantities(*names: str) -> Iterator[Compared]:
    for one in _whole().compared:
        if one.quantity in names:
            yield Compared(one.difference, 0.0, 1.0, one.stated_error, one.stated_error)


@ROWS.add("tooth compliance and coupling", "program", _ALONE)
def whole_gear_compliance() -> Iterator[Compared]:
    """c_0 and both neighbours of a gear at a tolerance of 1 %; what is allowed is the stated error."""
    yield from _quantities("c_self", "c_next", "c_prev")


@ROWS.add("root stress", "program", _ALONE)
def whole_gear_root_stress() -> Iterator[Compared]:
    """Root tension and compression of a gear at a tolerance of 1 %; what is allowed is the stated error."""
    yield from _quantities("root_tension", "root_compression")


@ROWS.add("rings on pins and in a spline", "program", _ALONE)
def ring_supports() -> Iterator[Compared]:
    """Compliance and root stress of an internal gear on pins (tooth 0) and in a spline; what is stated is allowed."""
    from fegear.case.reading import build_scene
    from fegear.studies.check import check_gear

    ring = {
        "internal": True, "teeth": 30, "module": "2 mm", "rim_thickness": "5 mm", "tip_diameter": "57.4 mm",
        "cutter": {"teeth": 15},
    }  # fmt: skip
    pins = {"kind": "pins", "pins": 4, "width": "6 mm", "angle": "17 deg"}
    for support in (pins, {"kind": "splined"}):
        gears = {"ring": ring | {"rim_support": support}}
        scene = build_scene({"results": ["stiffness"], "gear": gears, "accuracy": {"tolerance": 5e-2}}, "case", Path())
        for one in check_gear(scene, "ring", 1).compared:
            yield Compared(one.difference, 0.0, 1.0, one.stated_error, one.stated_error)


# ---- formulas ---------------------------------------------------------------------------------------------------
@ROWS.add("geometry and contact stress of ISO 6336-2", "program", _DIN)
def din3990_contact_stress() -> Iterator[Compared]:
    """Working angle, contact ratio, base circles, Z factors and nominal contact stress."""
    from fegear.formulas.iso6336 import part2_pitting as contact

    pair = _din_pair()
    yield from near(math.degrees(pair.working_pressure_angle), 21.531902292465457, 1e-11)
    yield from near(pair.contact_ratio, 1.5363235945832296, 1e-11)
    yield from near(pair.signed_base_diameters, (71.41663917972905e-3, 390.9121302469379e-3), 1e-11)
    yield from near(contact.single_pair_factors(pair)[0], (1.00554704549864, 0.8835590102280203), 1e-11)
    factors = contact.zone_factor(pair), contact.contact_ratio_factor(pair.contact_ratio, 0.0)
    yield from near(factors, (2.3959406670899934, 0.906214912960638), 1e-11)
    stress = contact.nominal_contact_stress(pair, 14103.41869503906, (*factors, 189.8e3))
    yield from near(stress, 875.3827378988153e6, 1e-11)


def _din_pair() -> Any:
    from fegear.formulas.iso6336.pair_geometry import GearShape, PairGeometry

    gears = (
        GearShape(19, 0.5, 88e-3, 70e-3, 48.64e-3, 1.25, 0.25),
        GearShape(104, 0.15, 425.2e-3, 407.2e-3, 48.64e-3, 1.25, 0.25),
    )
    return PairGeometry(gears, 4e-3, math.radians(20.0), 0.0, 248.506843355171e-3)


@ROWS.add("face load factor of ISO 6336-1", "program", _DIN)
def din3990_face_load() -> Iterator[Compared]:
    """Deformation of the pinion shaft, K_Hbeta, running-in and K_Fbeta."""
    from fegear.formulas.iso6336.part1_face_load import PinionShaft, face_load_factor, root_exponent, shaft_deformation
    from fegear.formulas.iso6336.part1_transverse import helix_allowance, mean
    from fegear.formulas.iso6336.rated import Strength

    steel, specific_load = Strength("Eh", 1500e6, 430e6), 25368.536123904036 / 48.64e-3
    found, _ = shaft_deformation(PinionShaft("a", 0.2, 0.0, 0.06), specific_load, 48.64e-3, 76e-3)
    yield from near(found, 4.913484891366676e-6, 1e-11)
    factor = face_load_factor(5.550790414924349e-6, 20e9, specific_load)
    yield from near(factor, 1.1064272863295082, 1e-11)
    # That program's K_v, and so F_betax, differ between the gears; y_beta is their mean.
    worn = [helix_allowance(steel, f, 3.9) for f in (1.33 * found, 6.586991635726722e-6)]
    yield from near(mean((worn[0], worn[1])), 0.9841444905933301e-6, 1e-9)
    yield from near(factor ** root_exponent((48.64, 48.64), (9.0, 9.0)), 1.0864854433487987, 1e-11)


@ROWS.add("tooth form factors of ISO 6336-3", "program", _DIN)
def din3990_root_form() -> Iterator[Compared]:
    """Root chord, moment arm, fillet radius, Y_F, Y_S and static Y_delrel; that program stops its iteration at 1e-4."""
    from fegear.formulas.iso6336.part3_root_stress import RackTooth, root_form
    from fegear.formulas.iso6336.part3_strength import static_notch_sensitivity
    from fegear.formulas.iso6336.rated import Strength

    pair = _din_pair()
    for gear, wanted in zip(pair.gears, (
        (8.748743355951145, 8.174657642839318, 1.3161477577049423, 2.246336378902072, 1.9147262565947287),
        (9.239504610725831, 7.834245947926714, 1.325999192893118, 2.1616566798058514, 2.008781657562889),
    ), strict=True):  # fmt: skip
        form = root_form(RackTooth(gear.teeth, gear.profile_shift, 1.25, 0.25), gear.tip_diameter / pair.module)
        found = 4.0 * form.root_chord, 4.0 * form.moment_arm, 4.0 * form.fillet_radius, form.Y_F, form.Y_S
        yield from near(found, wanted, 1.1e-4)
    hard = Strength("Eh", 1500e6, 430e6)
    for y_s, wanted_y in ((2.3254914040266397, 1.1432162177717213), (2.439724457289684, 1.1934787612074609)):
        yield from near(static_notch_sensitivity(hard, y_s), wanted_y, 1e-11)


@ROWS.add(
    "tooth stiffness by potential energy", "program", "ROSS, github.com/petrobras/ross, GearElementTVMS, 62/62 teeth"
)
def ross_potential_energy() -> Iterator[Compared]:
    """Contact ratio and contact stiffness; mesh stiffness within 5 %, since the codes draw the root on their own."""
    from fegear.formulas.sources import pair_compliance, source
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear, Material
    from fegear.geometry.pair import GearPair
    from fegear.geometry.rack import BasicRack

    tooth = Tooth(62, BasicRack(1.0, 1.25, 0.38))
    gear: Gear = Gear(tooth, 2e-3, 17.5e-3, 20e-3, Material(206e9, 0.3, 7810.0), "stress")
    pair = GearPair(gear, gear)
    found = pair_compliance(source("potential-energy"), pair, pair.x_start + np.array([0.0, pair.base_pitch]), 1e5)
    yield from near(pair.contact_ratio, 1.7897798668330458, 1e-12)
    yield from near(20e-3 / found.contact, 3555868607.9093266, 1e-9)
    yield from near((20e-3 / found.total).sum(), 396622921.3581085, 0.05)


@ROWS.add("flank tolerances of ISO 1328", "program", "an open-source calculator: d 120 mm, m_n 3 mm, class 6")
def iso1328_class_6() -> Iterator[Compared]:
    """f_pT, F_pT and F_alphaT as that program rounds them."""
    from fegear.formulas.iso1328 import flank_tolerances

    found = flank_tolerances(6, 0.12, 3e-3, 30e-3).rounded
    values = found.single_pitch, found.cumulative_pitch, found.profile_total
    yield from near(np.array(values) * 1e6, (9.0, 29.0, 12.0), 1e-9)
