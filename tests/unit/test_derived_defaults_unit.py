"""Defaults that follow from other keys, as pages say: written out, the answer is the same.

Each row says how its default follows, by the equations here or from another part of the case. Where the stages of both
cases read the same numbers nothing is computed; else both run, and every value and table is the same.
"""

from __future__ import annotations

import copy
import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from case_laws import columns
from written_defaults import Schema, without, written
from written_out import written_out

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.geometry.inspection import chord, span_teeth
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
#: Numbers that are written and read again, with a unit.
SAME = 1e-9
GEAR = {"teeth": 21, "module": "3 mm", "face_width": "12 mm"}
PAIR = {
    "gear": {"a": GEAR, "b": {**GEAR, "teeth": 34, "profile_shift": 0.2}},
    "pair": {"I": {"driver": "a", "driven": "b", "load": "2 kN", "compliance": {"source": "weber-banaschek"}}},
    "effects": {"relief": True},
}
LOADED = {**PAIR, "results": ["load-sharing", "transmission-error"], "effects": {}}
RING = {
    "results": ["geometry"],
    "gear": {"r": {"internal": True, "teeth": 62, "module": "3 mm", "cutter": {"teeth": 25}, "face_width": "12 mm",
                   "tip_diameter": "181 mm"}},
}  # fmt: skip
RIPPLE = {"one": {"body": "two", "order": 2.0, "amplitude": "1 N*m"}}


def shipped(name, *results):
    document = tomllib.loads((CASES / f"{name}.toml").read_text("utf-8"))
    return document | ({"results": list(results)} if results else {})


def joined(document, more):
    """A document with keys written at dotted paths, or taken out."""
    made = copy.deepcopy(document)
    for path, value in more.items():
        place = tuple(path.split("."))
        made = without(made, place) if value is None else written(made, place, value)
    return made


def metres(value):
    return f"{float(value)!r} m"


def ends(scene, member="driver"):
    """Radii of the active profile."""
    pair = scene.pairs["I"]
    return sorted(float(r) for r in pair.radius(np.array([pair.x_start, pair.x_end]), member))


def _root(scene):
    gear = scene.gears["a"]
    return metres(0.5 * gear.root_radius)


TRAIN = {
    **joined(PAIR, {"pair.I.load": None, "pair.I.torque": "40 N*m"}), "effects": {},
    "results": ["gear-train", "natural-modes", "mesh-force-spectrum", "dynamic-factor"],
    "train": {"body": {"one": {"gears": ["a"]}, "two": {"gears": ["b"]}}, "torque": {"one": "40 N*m"}, "balance": "two",
              "mesh": {"I": {"driver": "one", "driven": "two", "damping_ratio": 0.1}}},
    "dynamics": {"speed": "1500 rpm", "harmonics": 8},
}  # fmt: skip
RELIEF = {"tip": {"amount": "10 um", "length": "1 mm"}, "root": {"amount": "5 um", "length": "0.6 mm"},
          "crowning": {"amount": "4 um"}}  # fmt: skip
RELIEVED = joined(LOADED, {"gear.a.relief": RELIEF, "effects": {"relief": True}})
DESIGN = joined(PAIR, {"results": ["relief"], "effects": {}, "design": {"grind": []}})
FOR_RANGE = {"pair.I.load": None, "pair.I.torques": ["40 N*m", "80 N*m"]}
GAUGE = joined(LOADED, {"results": ["gauge"], "gauge": {"g": {"gear": "a"}}, "accuracy": {"tolerance": 0.03}})
LOADING = {"results": ["loading-spectrum"], "loading": {"contact_ratio": 1.6}}
OF_PAIR = joined(PAIR, {"results": ["loading-spectrum"], "effects": {}, "loading": {"pair": "I"}})
RATING = shipped("rating_spur", "rating")
ROUGH = joined(RATING, {"gear.pinion.roughness": {"flank": "0.8 um", "root": "3 um"}})
SET = shipped("planetary_set", "planet-set", "planet-modes")
COMPOUND = shipped("ravigneaux_set", "compound-set")
RACK = joined(shipped("rack_and_pinion", "rack-geometry"), {"rack.axis.backlash": None})
ON_PINS = joined(RACK, {"rack.axis.support": "pins", "results": ["rack-stiffness"]})
GROWTH = joined(shipped("cracked_tooth", "crack-path"), {"crack_growth": {"steps": 2}})
SURFACE = joined(
    shipped("surface_and_loss", "flank-surface"), {"pair.I.compliance": {"source": "weber-banaschek"}, "effects": {}}
)
LOSS = joined(SURFACE, {"results": ["gear-mesh-power-loss"]})

ELLIPSE = joined(PAIR, {"results": ["geometry"], "gear.a.fillet": {"kind": "ellipse"}, "pair.I.compliance": None})
ASYMMETRIC = joined(PAIR, {"results": ["geometry"], "gear.a.coast_pressure_angle": "22 deg",
                           "gear.b.coast_pressure_angle": "22 deg", "pair.I.compliance": None})  # fmt: skip

FILLET = joined(LOADED, {"results": ["fillet-design"], "pair.I.compliance": None, "fillet_design": {"searches": 1}})

#: Key, case, where it is written, and what is written: a value, or how it follows from the case as it was built.
ROWS = {
    "DoubleHelicalPart.floating": (
        joined(shipped("double_helical"), {"pair.I.double_helical.floating": None}), "pair.I.double_helical.floating",
        "driver"),
    "CrackGrowthPart.load_factors": (GROWTH, "crack_growth.load_factors", [1.0]),
    "CrowningPart.start_radius": (RELIEVED, "gear.a.relief.crowning.start_radius", lambda s: metres(ends(s)[0])),
    "CrowningPart.end_radius": (RELIEVED, "gear.a.relief.crowning.end_radius", lambda s: metres(ends(s)[1])),
    "RootReliefPart.end_radius": (RELIEVED, "gear.a.relief.root.end_radius", lambda s: metres(ends(s)[0])),
    "TipReliefPart.at_radius": (
        RELIEVED, "gear.a.relief.tip.at_radius", lambda s: metres(s.gears["a"].involute_tip_radius)),
    "GearPart.tip_diameter": (LOADED, "gear.b.tip_diameter", f"{3.0 * 34 + 2.0 * 1.2 * 3.0!r} mm"),
    "GearPart.bore_radius": (
        joined(PAIR, {"results": ["geometry"]}), "gear.a.bore_radius", _root),
    "GearPart.coast_lead": (
        joined(ASYMMETRIC, {"gear.a.lead": {"slope": "5 um"}, "pair.I.flank": "coast", "pair.I.width": "slices"}),
        "gear.a.coast_lead", {"slope": "5 um"}),
    "GearPart.coast_pressure_angle": (
        joined(PAIR, {"results": ["geometry"]}), "gear.a.coast_pressure_angle", "20 deg"),
    "FilletDesignPart.pair": (FILLET, "fillet_design.pair", "I"),
    "FilletDesignPart.gear": (FILLET, "fillet_design.gear", "a"),
    "FilletDesignPart.clearance": (FILLET, "fillet_design.clearance", f"{0.02 * 3.0!r} mm"),
    "FilletDesignPart.minimum_radius": (FILLET, "fillet_design.minimum_radius", f"{0.1 * 3.0!r} mm"),
    "FilletDesignPart.minimum_tool_radius": (
        joined(FILLET, {"fillet_design": {"generated": True}}), "fillet_design.minimum_tool_radius",
        f"{0.1 * 3.0!r} mm"),
    "FilletPart.form_diameter": (
        ELLIPSE, "gear.a.fillet.form_diameter", lambda s: metres(2.0 * s.gears["a"].form_radius)),
    "FilletPart.root_diameter": (
        ELLIPSE, "gear.a.fillet.root_diameter", lambda s: metres(2.0 * s.gears["a"].root_radius)),
    "RackPart.coast_tip_radius": (
        joined(PAIR, {"results": ["geometry"], "gear.a.rack": {"tip_radius": 0.3}}),
        "gear.a.rack.coast_tip_radius", 0.3),
    "CutterPart.coast_tip_radius": (
        joined(RING, {"gear.r.cutter": {"teeth": 25, "tip_radius": 0.15}}), "gear.r.cutter.coast_tip_radius", 0.15),
    "PairPart.flank": (ASYMMETRIC, "pair.I.flank", "drive"),
    "GearPart.face_width": ({"results": ["geometry"], "gear": {"a": {"teeth": 21, "module": "3 mm"}}},
                            "gear.a.face_width", "1 mm"),
    "GearPart.rim_thickness": (RING, "gear.r.rim_thickness", f"{3.5 * 3.0!r} mm"),
    "CutterPart.addendum": (RING, "gear.r.cutter.addendum", 1.25),
    "GearPart.ball_diameter": (
        joined(PAIR, {"results": ["geometry"]}), "gear.a.ball_diameter",
        lambda s: f"{ran(joined(PAIR, {'results': ['geometry']})).tables['geometry']['ball_diameter'][0]!r} mm".replace(
            "np.float64(", "").replace(")", "")),
    "GearPart.span_teeth": (
        joined(PAIR, {"results": ["geometry"]}), "gear.a.span_teeth", lambda s: span_teeth(s.gears["a"])),
    "GearPart.chordal_height": (
        {"results": ["geometry"], "gear": {"a": {**GEAR, "tip_diameter": "70 mm", "chordal_thickness": "4.9 mm"}}},
        "gear.a.chordal_height", lambda s: metres(chord(s.gears["a"])[1])),
    "GearPart.flank_treatment": (
        joined(SURFACE, {"gear.pinion.flank_treatment": None, "pair.I.lubricant.micropitting_load_stage": None}),
        "gear.pinion.flank_treatment", "through-hardened"),
    "RackPart.profile": (joined(LOADED, {"gear.a.rack": {"addendum": 1.0}}), "gear.a.rack.profile", "ISO 53 C"),
    "RackPart.addendum": (joined(LOADED, {"gear.a.rack": {"dedendum": 1.3}}), "gear.a.rack.addendum", 1.0),
    "RackPart.dedendum": (joined(LOADED, {"gear.a.rack": {"addendum": 1.0}}), "gear.a.rack.dedendum", 1.25),
    "RackPart.tip_radius": (joined(LOADED, {"gear.a.rack": {"addendum": 1.0}}), "gear.a.rack.tip_radius", 0.25),
    "PairPart.centre_distance": (LOADED, "pair.I.centre_distance", lambda s: metres(without_backlash(21, 34, 0.2))),
    "PairPart.width": (LOADED, "pair.I.width", "plane"),
    "PairPart.load": (joined(LOADED, {"pair.I.load": None, "pair.I.loads": ["1 kN", "2 kN"]}), "pair.I.load", "2 kN"),
    "GaugePart.pair": (GAUGE, "gauge.g.pair", "I"),
    "GaugePart.member": (GAUGE, "gauge.g.member", "driver"),
    "GaugePart.tangent_angle": (GAUGE, "gauge.g.tangent_angle", "30 deg"),
    "MeasuredStrainPart.shaft": (
        joined(shipped("strain_gauges"), {"accuracy": {"tolerance": 0.03}}), "gauge.tension.measured.shaft", "driver"),
    "EncodersPart.pair": (
        joined(shipped("measured_transmission_error"), {"accuracy": {"tolerance": 0.03}}), "encoders.rig.pair", "test"),
    "DesignPart.pair": (DESIGN, "design.pair", "I"),
    "DesignPart.load": (DESIGN, "design.load", "2 kN"),
    "DesignPart.length": (DESIGN, "design.length", lambda s: metres(s.pairs["I"].x_end - s.pairs["I"].x_start)),
    "DesignPart.centre": (DESIGN, "design.centre", lambda s: metres(0.5 * (s.pairs["I"].x_end + s.pairs["I"].x_start))),
    "DesignPart.over": (joined(DESIGN, FOR_RANGE), "design.over", "torques"),
    "PairPart.weights": (joined(DESIGN, FOR_RANGE), "pair.I.weights", [1.0, 1.0]),
    "TipTolerancePart.amount": (
        joined(DESIGN, {f"gear.{name}.deviations": {"profile_slope": "4 um"} for name in "ab"}),
        "design.tolerances.amount", "4 um"),
    "DesignPart.exponent": (joined(DESIGN, {"design.family": "polynomial"}), "design.exponent", 7),
    "ChartPart.loads": (
        joined(PAIR, {"results": ["relief-chart"], "effects": {}, "design": {
            "chart": {"lengths": [0.5, 1.0], "amounts_over_delta": [1.0]}}}),
        "design.chart.loads", ["2 kN"]),
    "LoadingPart.exponents": (joined(LOADING, {"loading.family": "polynomial"}), "loading.exponents", [7]),
    "LoadingPart.load": (OF_PAIR, "loading.load", "2 kN"),
    "LoadingPart.length": (OF_PAIR, "loading.length", lambda s: metres(s.pairs["I"].x_end - s.pairs["I"].x_start)),
    "TrainMeshPart.pair": (TRAIN, "train.mesh.I.pair", "I"),
    "TrainMeshPart.backlash": (
        joined(TRAIN, {"gear.a.thickness_allowance": "80 um", "effects": {"contact_loss": True, "parametric": True}}),
        "train.mesh.I.backlash", f"{80e-6 * math.cos(math.radians(20.0))!r} m"),
    "DynamicsPart.speeds": (TRAIN, "dynamics.speeds", ["1500 rpm"]),
    "DynamicsPart.speed": (
        joined(TRAIN, {"dynamics": {"speeds": ["1500 rpm"], "harmonics": 8}}), "dynamics.speed", "1500 rpm"),
    "DynamicsPart.speed_of": (TRAIN, "dynamics.speed_of", "one"),
    "DynamicsPart.loss_taken_by": (
        joined(TRAIN, {"effects": {"friction": True, "parametric": True}}), "dynamics.loss_taken_by", "two"),
    "TorqueRipplePart.order_of": (
        joined(TRAIN, {"train.torque_ripple": RIPPLE, "effects": {"torque_ripple": True}}),
        "train.torque_ripple.one.order_of", "two"),
    "OperationPart.mesh_load_factor": (RATING, "pair.I.operation.mesh_load_factor", 1.0),
    "OperationPart.contacts": (RATING, "pair.I.operation.contacts", [1, 1]),
    "IsoPart.edition": (RATING, "pair.I.iso_6336.edition", 2019),
    "SpectrumPart.speed": (
        joined(RATING, {"pair.I.operation.spectrum": [{"load_factor": 1.0, "share": 1.0}]}),
        "pair.I.operation.spectrum", [{"load_factor": 1.0, "share": 1.0, "speed": "1480 rpm"}]),
    "RoughnessPart.flank_rz": (ROUGH, "gear.pinion.roughness.flank_rz", f"{6.0 * 0.8!r} um"),
    "RoughnessPart.root_rz": (ROUGH, "gear.pinion.roughness.root_rz", "18 um"),
    "PairPart.friction": (LOSS, "pair.I.friction", {"law": "schlenk"}),
    "StrengthPart.hardness": (joined(RATING, {"gear.wheel.strength.hardness": None}), "gear.wheel.strength.hardness",
                              "730 HV"),
    "CompoundShaftPart.gears": (COMPOUND, "compound.R.shaft.ring.gears", "ring"),
    "CompoundPlanetPart.gears": (COMPOUND, "compound.R.planet.long.gears", ["long"]),
    "CompoundPlanetPart.centre_distance": (COMPOUND, "compound.R.planet.short.centre_distance", "35.25 mm"),
    "CompoundPlanetPart.first_angle": (
        COMPOUND, "compound.R.planet.long.first_angle",
        f"{math.acos((35.25**2 + 40.5**2 - 30.75**2) / (2.0 * 35.25 * 40.5))!r} rad"),
    "CompoundPart.output": (
        {"results": ["compound-set"], "gear": {name: {"teeth": teeth, "module": "2 mm"} for name, teeth in (
            ("one", 25), ("two", 27), ("first", 30), ("second", 28))}, "compound": {"S": {
                "fixed": "two", "input": "one", "torque": "1 N*m", "shaft": {"one": {}, "two": {}, "carrier": {}},
                "planet": {"step": {"carrier": "carrier", "gears": ["first", "second"], "planets": 1}},
                "mesh": [{"gears": ["one", "step.first"]}, {"gears": ["two", "step.second"]}]}}},
        "compound.S.output", "carrier"),
    "RackAndPinionPart.face_width": (RACK, "rack.axis.face_width", "20 mm"),
    "RackAndPinionPart.width": (RACK, "rack.axis.width", "plane"),
    "RackAndPinionPart.positions": (RACK, "rack.axis.positions", 32),
    "RackAndPinionPart.basic_rack": (RACK, "rack.axis.basic_rack", "ISO 53 C"),
    "RackAndPinionPart.material": (RACK, "rack.axis.material", {"young_modulus": "206.8 GPa"}),
    "RackAndPinionPart.distance": (RACK, "rack.axis.distance", "20.6 mm"),
    "RackAndPinionPart.backlash": (RACK, "rack.axis.backlash", "0 mm"),
    "RackAndPinionPart.pin_every": (ON_PINS, "rack.axis.pin_every", 10),
    "RackAndPinionPart.first_pin": (ON_PINS, "rack.axis.first_pin", 5),
    "RackAndPinionPart.pin_width": (ON_PINS, "rack.axis.pin_width", "4 mm"),
    "PlanetaryPart.centre_distance": (SET, "planetary.P.centre_distance", "54 mm"),
    "PlanetaryPart.harmonics": (SET, "planetary.P.harmonics", 12),
    "MeshStiffnessPart.mu": (
        {"results": ["transmissibility"], "transmissibility": {"I": {
            "mesh": {"stiffness": "285 N/um", "kappa": 0.4}, "unity_ratio": {
                "mass": "2.882 kg", "aspect_ratio": 0.3, "alpha_y": 0.2, "alpha_z": 0.5, "alpha_theta": 0.4}}}},
        "transmissibility.I.mesh.mu", 0.4**2 + 0.6**2 / 3.0),
    "StiffnessPart.positions": ({"results": ["stiffness"], "gear": {"a": {"teeth": 21, "module": "3 mm"}},
                                 "accuracy": {"tolerance": 0.1}}, "stiffness.positions", 100),
    "StiffnessPart.contact_half_width": ({"results": ["stiffness"], "gear": {"a": {"teeth": 21, "module": "3 mm"}},
                                          "accuracy": {"tolerance": 0.1}}, "stiffness.contact_half_width", "0.06 mm"),
    "StudyPart.gear": (STUDY := {"results": ["root-stress-study"], "gear": {"a": {
        "teeth": 21, "module": "3 mm", "profile_shift": 0.1}}, "study": {"load_position": [1.0]},
        "accuracy": {"tolerance": 0.1}}, "study.gear", "a"),
    "StudyPart.teeth": (STUDY, "study.teeth", [21]),
    "StudyPart.profile_shift": (STUDY, "study.profile_shift", [0.1]),
    "StudyPart.rack_tip_radius": (STUDY, "study.rack_tip_radius", [0.25]),
}  # fmt: skip


def without_backlash(z_1, z_2, x):
    """Of two gears of 3 mm and 20 degrees, by inv alpha_w = inv alpha + 2 tan alpha (x_1 + x_2)/(z_1 + z_2) [m]."""
    from scipy.optimize import brentq

    alpha = math.radians(20.0)
    wanted = math.tan(alpha) - alpha + 2.0 * math.tan(alpha) * x / (z_1 + z_2)
    angle = brentq(lambda a: math.tan(a) - a - wanted, 0.01, 1.0, xtol=1e-15)
    return 1.5e-3 * (z_1 + z_2) * math.cos(alpha) / math.cos(angle)


def planned(document):
    scene = build_scene(document, "case", CASES)
    return scene, make_plan(scene, STAGES)


def ran(document):
    return run_plan(*planned(document))


def numbers(scene, plan):
    """All numbers that stages read, in order; rounded, for a length that is written in text may lose its last digit."""
    text = " ".join(written_out(step.inputs(scene)) for step in plan.steps)
    return [float(one) for one in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e[-+]?\d+)?", text)]


def off(one, other):
    """The largest difference of two runs by name, over the size of what is around; infinite where there is another."""
    a, b = columns(one), columns(other)
    if a.keys() != b.keys():
        return dict.fromkeys(a.keys() ^ b.keys(), math.inf)
    found = {}
    for name, (x, _, size) in a.items():
        y = b[name][0]
        if x.shape != y.shape:
            found[name] = math.inf
            continue
        same = (x == y) | (np.isnan(x) & np.isnan(y))
        with np.errstate(invalid="ignore"):
            apart = np.where(same, 0.0, np.abs(x - y)) / (size or 1.0)
        if not (apart <= SAME).all():
            found[name] = float(apart.max())
    return found


#: Where a page derives what no row writes: what is not there (a rigid bearing, no film), or has no value of its own ...
NOT_THERE = {
    "AccuracyPart.corner_distance", "BearingPlacePart.around", "Case.neglected",
    "CompoundPart.input", "CompoundPlanetPart.pin", "CompoundShaftPart.bearing", "CompoundShaftPart.turning",
    "CrackGrowthPart.paris_coefficient", "CrackGrowthPart.paris_exponent", "CrackGrowthPart.toughness",
    "CostPart.quantities", "DamperPart.b",
    "DesignPart.limits", *(f"fegear__case__design__LimitsPart.{key}" for key in (
        "amount", "driven_start_diameter", "driver_start_diameter", "length",
    )),
    "DesignPart.film", "DoubleHelicalPart.axial_play", "DoubleHelicalPart.second_driven",
    "DoubleHelicalPart.second_driver", "DoubleHelicalPart.torque_in", "DoubleHelicalPart.torque_out",
    "FlankDesignPart.largest_face_load_factor", "GearBodyPart.hub_radius", "GearPart.body",
    "FilletDesignPart.other_pair",
    "FilletPart.scatter", "GearPart.coast_fillet",
    "GearPart.fillet", "GearPart.helix_angle", "GearPart.rim_support", "GearPart.tooth_mesh",
    "GearPart.web_thickness",
    "LoadingPart.contact_ratio", "LoadingPart.pair", "OperationPart.life", "PairPart.double_helical",
    "PairPart.loads", "PitPart.depth",
    "SetBodiesPart.carrier",
    "SetStiffnessPart.carrier", "SetStiffnessPart.pin", "SetStiffnessPart.ring", "SetStiffnessPart.sun",
    "SetStiffnessPart.turning", "ShaftInSpacePart.coupling", "StiffnessPart.face_positions", "StiffnessPart.gear",
    "ToothContactPart.load", "TrainPart.balance", "WebHolesPart.tooth", "fegear__case__shaft__BearingPart.axial",
    "fegear__case__shaft__BearingPart.housing_axial", "fegear__case__shaft__BearingPart.housing_radial",
    "fegear__case__shaft__BearingPart.permissible_tilt", "fegear__case__shaft__BearingPart.radial",
}  # fmt: skip
#: ... or needs a formula, a search or solid gears of its own.
NOT_WRITTEN = {
    *(f"SizingPart.{key}" for key in (
        "centre_distance", "helix_angles", "material", "normal_modules", "pinion_shifts", "pressure_angles",
        "roughness", "shift_sums", "torques", "verified", "wheel_strength",
    )), "PresentPart.tip_diameter",
    *(f"AccuracyPart.{key}" for key in (
        "order", "root_edge_length", "root_fraction", "flank_edge_length", "tip_edge_length", "junction_edge_length",
        "back_edge_length", "growth", "tip_growth", "side_growth", "body_fraction", "rim_fraction",
        "patch_half_width")),
    *(f"CataloguePart.{key}" for key in (
        "kind", "bore", "outside_diameter", "width", "contact_angle", "dynamic_rating")),
    *(f"BearingLifePart.{key}" for key in ("dynamic_rating", "kind", "radial_factor", "axial_factor", "limit")),
    "BiasPart.end_radius", "BiasPart.start_radius", "ChartPart.amounts_over_delta", "ChartPart.lengths",
    "CompoundPlanetPart.body", "CompoundShaftPart.body",
    "CostPart.gear", "CostPart.pair", "CrackGrowthPart.cycle_shares",
    "CrackGrowthPart.step", "CrackPart.tangent_angle", "CutterPart.teeth", "DesignChartPart.mesh",
    "DesignPart.peak", "EncodersPart.speed", "ErrorTracePart.torque",
    "ExcitationPart.speed", "FlankDesignPart.centre", "FlankDesignPart.grid", "FlankDesignPart.length",
    "FlankDesignPart.load", "FlankDesignPart.loads", "FlankDesignPart.pair", "FlankMapPart.over_face",
    "GearBodyPart.hub_width", "GearPlacePart.seat", "IsoPart.micropitting_material_factor",
    "IsoPart.tip_relief_factor", "KeywayPart.depth", "KeywayPart.width",
    "LoadDistributionPart.panels", "LoadingPart.peaks", "LoadingPart.tooth_frequency",
    "LubricantPart.permissible_film", "LubricantPart.scuffing_temperature", "LubricantPart.viscosity_100",
    "MeasuredPart.lead_range", "MeasuredPart.profile_range", "MeasuredStrainPart.speed",
    "MeshErrorPart.flanks", "MeshErrorPart.harmonic",
    "MeshErrorPart.harmonics", "OperationPart.dynamic_factor", "OperationPart.face_load_factor",
    "OperationPart.mean_stress_factor", "OperationPart.transverse_load_factor", "PairFrictionPart.law",
    "PairFrictionPart.viscosity", "RigidGearPart.damping", "RobustReliefPart.amounts", "RobustReliefPart.lengths",
    "SetBodiesPart.planet", "SetBodiesPart.ring", "SetBodiesPart.sun", "SetStiffnessPart.ring_mesh",
    "SetStiffnessPart.sun_mesh", "ShaftsPart.misalignment", "ShaftsPart.modification", "StiffnessPart.pair",
    "StrengthPart.agma_bending", "StrengthPart.agma_contact", "StrengthPart.bending", "StrengthPart.contact",
    "StrengthPart.residual_stress", "StrengthPart.yield_strength",
    "StudyPart.pressure_angle", "StudyPart.rack_dedendum", "TolerancePart.deviations", "TolerancePart.pair",
    "TrainMeshPart.stiffness", "TransmissibilityPart.driven", "TransmissibilityPart.driver",
    "fegear__case__helical__ShaftPart.over", "TipTolerancePart.length",
    "TipTolerancePart.crowning", "TipTolerancePart.helix_slope",
}  # fmt: skip
_DERIVED = re.compile(r"[Ww]ithout|[Dd]efault\b|unless specified")


def derived():
    """Keys without a stated default of which the page says what is taken."""
    schema, found = Schema(), set()
    for part, key, node in schema.every():
        ident, said = f"{part}.{key}", node.get("description", "")
        if _DERIVED.search(said) and schema.default(ident, node) is None:
            found.add(ident)
    return found


def test_every_default_that_is_derived_has_a_row_or_a_reason():
    found = derived()
    assert len(found) > 130
    new = found - ROWS.keys() - NOT_THERE - NOT_WRITTEN
    assert new == set(), "their descriptions say what is taken without them: a row in ROWS tries it, or other words"
    assert found - ROWS.keys() == NOT_THERE | NOT_WRITTEN


#: A second or two.
DEAR = {"TrainMeshPart.backlash", "ChartPart.loads"}


@pytest.mark.parametrize("ident", [pytest.param(one, marks=[pytest.mark.dear] if one in DEAR else []) for one in ROWS])
def test_a_derived_default_that_is_written_out_changes_nothing(ident):
    document, path, value = ROWS[ident]
    scene, plan = planned(document)
    other, plan_of_other = planned(joined(document, {path: value(scene) if callable(value) else value}))
    assert [step.task for step in plan.steps] == [step.task for step in plan_of_other.steps]
    a, b = numbers(scene, plan), numbers(other, plan_of_other)
    if len(a) != len(b) or not np.allclose(a, b, rtol=SAME, atol=1e-15):
        assert off(run_plan(scene, plan), run_plan(other, plan_of_other)) == {}
