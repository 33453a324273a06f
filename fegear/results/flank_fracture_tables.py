"""Tables, values and remarks of the result ``flank-fracture``."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column, Table, Value
from fegear.formulas.iso6336.part4_flank_fracture import CALIBRATION, HARDNESS_FACTOR, PERMISSIBLE
from fegear.formulas.iso6336.part5_case_depth import recommended
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.results.flank_fracture import FlankFractureData, FlankFractureInputs

#: Depths in a table by point and depth: every so manyth.
_EVERY = 4


def fracture_tables(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[Table, ...]:
    """Pressure and largest exposure over the path; both gears below the points A to E; case depths and their limits."""
    return _path(data, inputs), *_below(data, inputs), _depths(data, inputs)


def _path(data: FlankFractureData, inputs: FlankFractureInputs) -> Table:
    name = inputs.asked.name
    columns = [
        Column("x", data.x, "mm", "on the line of action, from the pitch point"),
        Column("load_sharing", data.sharing, "", "X_CP, that of ISO/TS 6336-22 without relief"),
        Column("relative_radius", data.radius, "mm", "rho_red,CP in the normal section"),
        Column("hertz_pressure", data.pressure, "MPa", "p_dyn,CP with all load factors"),
        Column("half_width", data.half_width, "mm", "b_H of the contact"),
    ]
    for member in MEMBERS:
        gear = data.gears[member]
        counted = np.where(gear.depth >= data.half_width[:, None], gear.found.exposure, -np.inf)
        columns.append(Column(f"exposure_{member}", counted.max(axis=1), "", f"A_FF, largest below b_H, {member} gear"))
    return Table(f"flank_fracture_{name}", tuple(columns), f"Flank fracture of pair {name} over the path of contact")


def _below(data: FlankFractureData, inputs: FlankFractureInputs) -> Iterator[Table]:
    for member, gear_name in zip(MEMBERS, inputs.asked.gears, strict=True):
        gear = data.gears[member]
        shown = slice(0, None, _EVERY)
        columns = [
            Column("depth", gear.depth[shown], "mm", "y, below the flank"),
            Column("hardness", gear.hardness[shown], "", "HV(y), Vickers"),
            Column("residual_stress", gear.residual[shown], "MPa", "sigma_RS(y) along profile and face"),
            Column("strength", gear.found.strength[shown], "MPa", "tau_per(y)"),
        ]
        for letter, i in data.points.items():
            key = letter.translate(str.maketrans("", "", "_{}"))
            columns += [
                Column(f"load_stress_{key}", gear.found.load_stress[i, shown], "MPa", f"tau_eff,L below {letter}"),
                Column(f"stress_{key}", gear.found.stress[i, shown], "MPa", f"tau_eff below {letter}"),
                Column(f"exposure_{key}", gear.found.exposure[i, shown], "", f"A_FF below {letter}"),
            ]
        title = f"Below the flanks of gear {gear_name} ({member}) of pair {inputs.asked.name}"
        yield Table(f"flank_fracture_{inputs.asked.name}_{member}", tuple(columns), title)


def _depths(data: FlankFractureData, inputs: FlankFractureInputs) -> Table:
    name, pair = inputs.asked.name, inputs.asked.pair
    limits = [recommended(pair.gear(member).module) for member in MEMBERS]
    least, most, largest = (np.array(values) for values in zip(*limits, strict=True))
    gears = [data.gears[member] for member in MEMBERS]
    columns = (
        Column("gear", np.array(inputs.asked.gears), "", "driver, driven"),
        Column("case_depth", np.array([case.case_depth for case in inputs.cases]), "mm", "CHD at 550 HV, of the case"),
        Column("usual_from", least, "mm", "least usual one, .15 normal modules"),
        Column("usual_to", most, "mm", "largest usual one, .25 normal modules"),
        Column("largest", largest, "mm", "not to exceed: .4 normal modules, at most 6 mm"),
        Column(
            "crushing", np.array([one.crushing for one in gears]), "mm", "Eht_c of ISO 6336-5, least against crushing"
        ),
        Column(
            "least_agma", np.array([one.least_agma for one in gears]), "mm", "h_e,min of AGMA 2101 with ISO's sigma_H"
        ),
    )
    return Table(f"case_depth_{name}", columns, f"Case depths of pair {name} and their limits", printed=True)


def fracture_values(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[Value, ...]:
    """Largest exposure of either gear with its place, its safety, and case depth with what it needs."""
    found = []
    for member, case in zip(MEMBERS, inputs.cases, strict=True):
        key, gear = f"{inputs.asked.name}.{member}", data.gears[member]
        found += [
            Value(f"{key}.A_FF", gear.most, "", None, f"largest material exposure, {PERMISSIBLE:g} at most"),
            Value(f"{key}.S_FF", 1.0 / gear.most, "", None, f"its inverse, {1.0 / PERMISSIBLE:g} at least"),
            Value(f"{key}.A_FF_load", gear.most_load, "", None, "largest exposure without residual stress, its bound"),
            Value(f"{key}.A_FF_depth", gear.at_depth, "mm", None, "how deep the largest exposure is"),
            Value(f"{key}.case_depth", case.case_depth, "mm", None, "at 550 HV, of the case"),
            Value(f"{key}.case_depth_crushing", gear.crushing, "mm", None, "least against crushing, ISO 6336-5"),
            Value(f"{key}.case_depth_agma", gear.least_agma, "mm", None, "least of AGMA 2101, with sigma_H of ISO"),
        ]  # fmt: skip
    return tuple(value for value in found if math.isfinite(value.si))


def fracture_remarks(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[str, ...]:
    """What falls short, then what is assumed and what is recalled."""
    name, told = inputs.asked.name, []
    for i, (member, gear) in enumerate(zip(MEMBERS, inputs.asked.gears, strict=True)):
        found, case = data.gears[member], inputs.cases[i]
        if found.most > PERMISSIBLE:
            told.append(
                f"Pair {name}: A_FF = {found.most:.4g} of gear {gear} ({member}) at a depth of "
                f"{found.at_depth * 1e3:.3g} mm is above {PERMISSIBLE:g}."
            )
        largest = recommended(inputs.asked.pair.gear(member).module)[2]
        needed = float(np.nanmax([found.crushing, found.least_agma, 0.0]))
        if case.case_depth < needed:
            told.append(
                f"Gear {gear}: the case depth of {case.case_depth * 1e3:.3g} mm is less than the {needed * 1e3:.3g} mm "
                "needed against crushing."
            )
        if case.case_depth > largest:
            told.append(
                f"Gear {gear}: the case depth of {case.case_depth * 1e3:.3g} mm is more than {largest * 1e3:.3g} mm, "
                ".4 normal modules and 6 mm at most."
            )
        if inputs.materials[i] != "case-hardened-steel":
            told.append(
                f"Gear {gear}: ISO/TS 6336-4 is for case-carburized steel; of {inputs.materials[i]} its exposure is an "
                "extrapolation."
            )
        for what, measured, rule in (
            ("hardness over depth", case.measured, "hardness_profile"),
            ("residual stress", case.residual, "residual_stress"),
        ):
            if measured is None:
                told.append(f"Gear {gear}: {what} is by Lang's rule, which is recalled ({rule} of strength).")
    if inputs.asked.levels:
        told.append(
            f"Pair {name}: exposure and case depths are those of the largest level of the spectrum, "
            f"{data.load / inputs.asked.load:.4g} times the load, for which they are meant as for endurance."
        )
    told += inputs.said
    told.append(
        f"Pair {name}: of ISO/TS 6336-4 print at hand backs the structure of A_FF, its symbols and the scope, "
        f"case-carburized external gears. Recalled are K_tau,per = {HARDNESS_FACTOR * 1e-6:g} MPa per HV, c_1 = "
        f"{CALIBRATION:g}, A_FF <= {PERMISSIBLE:g}, and that A_FF counts from the half-width on; K_material = "
        f"{inputs.material_factor:g} (flank_fracture_material_factor of iso_6336). tau_eff is the mean shear over all "
        "planes below a Hertzian contact without friction, in the place of the standard's fitted formulas. "
        "What the residual stress takes off decides within the case: A_FF_load "
        "is without it."
    )
    told.append(
        f"Pair {name}: limits of the case depth are recalled: .15 to .25 and .4 m_n, U_H of ISO 6336-5 (66,000 N/mm^2 "
        "of MQ and ME, 44,000 of ML) and of AGMA 2101 (44,000 carburized, 30,000 induction-hardened)."
    )
    return tuple(dict.fromkeys(told))
