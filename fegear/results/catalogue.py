"""Every stage that fegear knows, by subject, as plain data: its module is imported when a plan asks for it."""

from __future__ import annotations

import copyreg
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from fegear.contact.effects import PLANE_EFFECTS, WIDE_EFFECTS
from fegear.engine.catalogue import Catalogue, Entry
from fegear.engine.stage import Stage

# fmt: off
#: Every stage by the subject of its results, in the order in which plans list those that they skip.
SUBJECTS: Mapping[str, tuple[Entry, ...]] = MappingProxyType({
    "Gears and teeth": (
        Entry("geometry", "gear.geometry.GEOMETRY", "Geometry", ("geometry",),
              "gear data for drawings: diameters, span measurement, dimension over balls, contact ratio, backlash",
              internal=True),
        Entry("tooth-geometry-check", "gear.tooth_geometry_check.TOOTH_GEOMETRY_CHECK",
              "Design check (rules of thumb)", ("tooth-geometry-check",),
              "tip thickness, rim thickness, undercut, contact ratio and clearances compared with "
              "usual limits", internal=True),
        Entry("measured-flanks", "gear.measured_flanks.MEASURED_FLANKS", "Measured flanks", ("measured-flanks",),
              "profile and helix slope, form and total deviations of measured flanks, and the resulting tolerance "
              "class (ISO 1328-1)",
              internal=True),
        Entry("gear-solution", "gear.solved_gear.GEAR_SOLUTION", "Influence functions of a gear (2D)", internal=True),
        Entry("stiffness", "gear.stiffness.STIFFNESS", "Compliance and root stress (2D, full gear)", ("stiffness",),
              "compliance of a loaded tooth and its neighbours, and root stress, over load positions",
              quantities=("c_0", "c_1"), internal=True),
        Entry("solid-solution", "gear.solved_gear.SOLID_SOLUTION",
              "Influence functions of a gear (3D)", internal=True),
        Entry("stiffness-over-face", "gear.stiffness_over_face.SOLID_STIFFNESS",
              "Compliance and root stress over the face width (3D)", ("stiffness",),
              "compliance of a loaded tooth and its neighbours, and root stress, over load positions",
              extra="space", internal=True),
        Entry("body-modes", "gear.body_modes.BODY_MODES", "Natural frequencies of the gear body", ("body-modes",),
              "natural frequencies and mode shapes of the gear body (3D, rim, web, hub), bore fixed"),
        Entry("root-stress", "gear.root_stress.ROOT_STRESS", "Root stress along the fillets", ("root-stress",),
              "stress along both fillets of a tooth for every load position", quantities=("root-stress",),
              internal=True),
        Entry("crosscheck", "gear.crosscheck.CROSSCHECK", "Analytical formulas compared with FE", ("crosscheck",),
              "formulas for stiffness and root stress (ISO 6336, AGMA 908, ...) compared with finite elements",
              quantities=("c_0", "root-stress")),
        Entry("root-stress-study", "gear.root_stress_study.ROOT_STRESS_STUDY",
              "Root-stress formulas compared with FE for many gears", ("root-stress-study",),
              "where each root-stress formula over- or underestimates the FE result", internal=True),
    ),
    "Gear pairs under load": (
        Entry("loaded-pair", "pair.loaded_pair.LOADED_PAIR", "Compliances of a loaded pair", effects=PLANE_EFFECTS,
              internal=True),
        Entry("load-sharing", "pair.load_sharing.LOAD_SHARING", "Load sharing", ("load-sharing",),
              "load, deflection and contact pressure of a tooth pair over the path of contact", effects=WIDE_EFFECTS,
              quantities=("tooth-force",), internal=True),
        Entry("transmission-error", "pair.transmission_error.TRANSMISSION_ERROR",
              "Transmission error", ("transmission-error",),
              "loaded transmission error, mesh stiffness, their harmonics, and both over load", effects=WIDE_EFFECTS,
              quantities=("te-peak-to-peak",), internal=True),
        Entry("root-stress-history", "pair.root_stress_history.ROOT_STRESS_HISTORY",
              "Root stress over the mesh cycle", ("root-stress-history",),
              "root stress history of both gears during one engagement", effects=WIDE_EFFECTS,
              quantities=("root-stress",), internal=True),
        Entry("stress-in-mesh", "pair.stress_in_mesh.STRESS_IN_MESH", "Root stress of the gears in mesh",
              effects=WIDE_EFFECTS, internal=True),
        Entry("outline-motion", "pair.deformed_in_mesh.OUTLINE_MOTION",
            "Displacement of the tooth outline", internal=True),
        Entry("deformed-in-mesh", "pair.deformed_in_mesh.DEFORMED_IN_MESH", "Deformed teeth of the gears in mesh",
              effects=PLANE_EFFECTS, internal=True),
        Entry("inner-stress", "pair.stress_inside.INNER_STRESS", "Stress inside the teeth under unit loads",
              internal=True),
        Entry("stress-inside", "pair.stress_inside.STRESS_INSIDE", "Stress inside the teeth of the gears in mesh",
              internal=True),
        Entry("loaded-flanks", "pair.loaded_flanks.LOADED_FLANKS", "Flank contact (3D)", effects=WIDE_EFFECTS,
              internal=True),
        Entry("load-distribution", "pair.load_distribution.LOAD_DISTRIBUTION",
              "Load distribution on the flanks", ("load-distribution",),
              "line load and contact pressure over profile and face width, K_Hbeta, K_Halpha, K_Fbeta, K_Falpha "
              "(spur and helical)",
              effects=WIDE_EFFECTS, internal=True),
        Entry("flank-load-factors", "pair.load_factors.FLANK_LOAD_FACTORS",
              "Load factors", ("load-distribution",),
              "line load and contact pressure over profile and face width, K_Hbeta, K_Halpha, K_Fbeta, K_Falpha "
              "(spur and helical)",
              effects=WIDE_EFFECTS, internal=True),
        Entry("contact-pattern", "pair.contact_pattern.CONTACT_PATTERN", "Contact pattern", ("load-distribution",),
              "line load and contact pressure over profile and face width, K_Hbeta, K_Halpha, K_Fbeta, K_Falpha "
              "(spur and helical)",
              effects=WIDE_EFFECTS, internal=True),
        Entry("mesh-stiffness-matrix", "pair.mesh_stiffness_matrix.MESH_STIFFNESS_MATRIX",
              "Mesh stiffness matrix", ("mesh-stiffness-matrix",),
              "mesh stiffness for translation and tilting of the gears: K_M, kappa, mu",
              effects=WIDE_EFFECTS),
        Entry("rating", "rating.rating.RATING", "Rating (load capacity)", ("rating",),
              "safety factors for pitting and tooth breakage to ISO 6336 with all factors; FE-based and AGMA 2101 "
              "values for comparison",
              effects=WIDE_EFFECTS, internal=True),
        Entry("flank-fracture", "rating.flank_fracture.FLANK_FRACTURE",
              "Tooth flank fracture and case depth", ("flank-fracture",),
              "material exposure over depth to ISO/TS 6336-4 (tooth flank fracture) and required case depth"),
        Entry("flank-surface", "pair.flank_surface.FLANK_SURFACE", "Scuffing, micropitting, "
                                                                   "lubricant film", ("flank-surface",),
              "sliding, pressure, flash temperature, film thickness; safety against scuffing and micropitting over A "
              "to E", extra="space",
              effects=WIDE_EFFECTS, internal=True),
        Entry("gear-mesh-power-loss", "pair.gear_mesh_power_loss.GEAR_MESH_POWER_LOSS",
              "Gear mesh power loss", ("gear-mesh-power-loss",),
              "gear mesh power loss, tooth loss factor H_V (also Ohlendorf, Wimmer), mesh efficiency",
              formerly="tooth-loss", effects=WIDE_EFFECTS, internal=True),
    ),
    "Profile modification": (
        Entry("relief", "relief.relief.RELIEF", "Profile modification for minimum excitation", ("relief",),
              "profile modification of both gears for zero transmission error at the design load, and the best "
              "grindable tip relief",
              effects=("corner_contact", "neighbour_coupling", "hertz"), quantities=("te-peak-to-peak",),
              internal=True),
        Entry("relief-curves", "relief.relief_curves.RELIEF_CURVES",
              "Transmission error and load sharing for a series of tip reliefs", ("relief-curves",),
              "transmission error and load of a tooth pair over the roll angle for a family of tip reliefs",
              effects=("corner_contact", "neighbour_coupling", "hertz"), internal=True),
        Entry("relief-chart", "relief.relief_chart.RELIEF_CHART", "Tip relief chart", ("relief-chart",),
              "transmission error over amount and length of tip relief, at several loads",
              effects=("corner_contact", "neighbour_coupling", "hertz"), quantities=("te-peak-to-peak",),
              internal=True),
        Entry("robustness", "relief.relief_chart.ROBUSTNESS", "Robustness of reliefs", ("robustness",),
              "sensitivity of a designed relief to load, pitch deviations and grinding deviations",
              effects=("corner_contact", "neighbour_coupling", "hertz"), quantities=("te-peak-to-peak",),
              internal=True),
        Entry("tolerance-robustness", "relief.tolerance_robustness.TOLERANCE_ROBUSTNESS",
              "Effect of tolerances", ("robustness",),
              "scatter of transmission error, root stress, pressure and K_Hbeta within the tolerance class (Monte "
              "Carlo)",
              effects=WIDE_EFFECTS, internal=True),
        Entry("loading-spectrum", "relief.loading_spectrum.LOADING_SPECTRUM",
              "Tooth loading functions and spectra", ("loading-spectrum",),
              "tooth loading functions with constant total load, and their excitation spectra",
              internal=True),
        Entry("flank-design", "relief.flank_design.FLANK_DESIGN", "Flank modification design (3D)", ("flank-design",),
              "profile and lead modification for minimum loaded transmission error, exact and grindable",
              effects=("neighbour_coupling", "hertz", "misalignment")),  # the gears' own reliefs are replaced
    ),
    "Helical pairs": (
        Entry("tooth-contact", "helical.tooth_contact.TOOTH_CONTACT", "Tooth contact analysis", ("tooth-contact",),
              "unloaded contact of helical flanks with or without misalignment: transmission error, path, ellipses",
              extra="space", effects=("misalignment",)),
        Entry("contact-lines", "helical.contact_lines.CONTACT_LINES", "Contact lines", ("contact-lines",),
              "contact lines of an aligned helical pair and their total length over a mesh cycle",
              extra="space", effects=("misalignment",)),
        Entry("flank-generation", "helical.flank_generation.FLANK_GENERATION",
              "Generation of helical flanks", ("flank-generation",),
              "rack cutters of a helical pair, generated flanks and design parameters",
              extra="space", effects=("misalignment",)),
        Entry("transmissibility", "helical.transmissibility.TRANSMISSIBILITY",
              "Force transmissibility", ("transmissibility",),
              "transfer functions from mesh to bearing forces of a helical pair over frequency"),
        Entry("mode-tracking", "helical.mode_tracking.MODE_TRACKING",
              "Mode tracking", ("mode-tracking",),
              "natural modes of a helical pair versus bearing stiffness, helix angle or mesh parameters",
              formerly="followed-modes"),
        Entry("pair-forced-response", "helical.pair_forced_response.PAIR_FORCED_RESPONSE",
              "Mesh and bearing forces", ("pair-forced-response",),
              "forced response: mesh and bearing forces over speed due to transmission error and external forces",
              formerly="pair-forces"),
    ),
    "Planetary gear sets": (
        Entry("planet-set", "planetary.planet_set.PLANET_SET", "Planetary gear set", ("planet-set",),
              "speeds, torques, frequencies and mesh phases of a planetary gear set, and the harmonics cancelled by "
              "phasing",
              internal=True),
        Entry("set-cycle", "planetary.planet_load_sharing.SET_CYCLE", "Meshes of a planetary gear set over the mesh "
                                                                      "cycle",
              effects=WIDE_EFFECTS, internal=True),
        Entry("meshed-set", "planetary.planet_load_sharing.MESHED_SET", "Teeth of a planetary gear set",
              effects=WIDE_EFFECTS, internal=True),
        Entry("planet-load-sharing", "planetary.planet_load_sharing.PLANET_LOAD_SHARING",
              "Planet load sharing", ("planet-load-sharing",),
              "planet loads over the mesh cycle, K_gamma, transmission error and forces of a planetary gear set",
              internal=True),
        Entry("planet-root-stress", "planetary.planet_root_stress.PLANET_ROOT_STRESS",
              "Root stress of planet teeth over one revolution", ("planet-root-stress",),
              "root stress of planet (alternating bending by sun and ring), sun and ring: range, mean, stress ratio R",
              internal=True),
        Entry("planet-modes", "planetary.planet_vibration.PLANET_MODES",
              "Natural modes of a planetary gear set", ("planet-modes",),
              "natural frequencies of a planetary gear set: rotational, translational and planet modes", internal=True),
        Entry("planet-vibration", "planetary.planet_vibration.PLANET_VIBRATION",
              "Vibration of a planetary gear set", ("planet-vibration",),
              "dynamic mesh forces of a planetary gear set over speed (linear, with mesh phasing)", internal=True),
        Entry("planet-motion", "planetary.planet_motion.PLANET_MOTION",
              "Motion of a planetary gear set with loss of contact", ("planet-motion",),
              "steady-state response of a planetary gear set over speed with loss of contact (time "
              "domain)", extra="motion",
              internal=True),
    ),
    "Shafts and bearings": (
        Entry("loaded-shafts", "shafts.loaded_shafts.LOADED_SHAFTS", "Shafts under all meshes", effects=WIDE_EFFECTS,
              internal=True),
        Entry("shaft-deflection", "shafts.shaft_deflection.SHAFT_DEFLECTION",
              "Shaft deflection and bearing forces", ("shaft-deflection",),
              "shaft deflection under all mesh forces, bearing forces and bearing life (ISO 281)", internal=True),
        Entry("misalignment", "shafts.misalignment.MISALIGNMENT", "Mesh misalignment", ("misalignment",),
              "mesh misalignment from shafts, bearings and housing, by cause, and the resulting gap over the face "
              "width",
              internal=True),
    ),
    "Drive train dynamics": (
        Entry("gear-train", "train.gear_train.GEAR_TRAIN", "Gear train", ("gear-train",),
              "model data of the gear train: inertias, shafts, meshes, speeds, mean mesh forces",
              effects=PLANE_EFFECTS, internal=True),
        Entry("natural-modes", "train.natural_modes.NATURAL_MODES",
              "Natural frequencies and Campbell diagram", ("natural-modes", "campbell"),
              "natural frequencies and modes, and the speeds at which the meshes excite them",
              effects=("torque_ripple",), internal=True),
        Entry("torque-ripple", "train.torque_ripple.TORQUE_RIPPLE", "Torque ripple", ("torque-ripple",),
              "mesh forces and shaft torques due to torque ripple, per unit torque and at the operating speed",
              effects=("torque_ripple",), internal=True),
        Entry("dynamic-increments", "train.dynamic_increments.DYNAMIC_INCREMENTS",
              "Dynamic increment functions", ("dynamic-increments",),
              "dynamic increment functions of every mesh over frequency, with asymptotes (Mark)",
              internal=True),
        Entry("mesh-force-spectrum", "train.mesh_force_spectrum.MESH_FORCE_SPECTRUM",
              "Mesh force spectra", ("mesh-force-spectrum",),
              "harmonics of every mesh force at one speed, by exciting mesh",
              effects=("torque_ripple",), quantities=("tooth-force",), internal=True),
        Entry("tooth-force", "train.tooth_force.TOOTH_FORCE", "Tooth pair force", ("tooth-force",),
              "dynamic force on one tooth pair, with and without the other meshes", effects=("torque_ripple",),
              quantities=("tooth-force",), internal=True),
        Entry("dynamic-root-stress", "train.dynamic_root_stress.DYNAMIC_ROOT_STRESS",
              "Dynamic root stress", ("dynamic-root-stress",),
              "dynamic root stress of one tooth during engagement", effects=("neighbour_coupling",),
              quantities=("root-stress", "tooth-force"), internal=True),
        Entry("tooth-friction", "pair.tooth_friction.TOOTH_FRICTION",
              "Tooth friction over the path of contact", ("tooth-friction",),
              "coefficient of friction, friction torques and power loss of a tooth pair over the path of contact",
              effects=("friction",), internal=True),
        Entry("train-loss", "pair.train_power_loss.TRAIN_LOSS",
              "Gear mesh power loss of the train", ("gear-mesh-power-loss",),
              "gear mesh power loss, tooth loss factor H_V (also Ohlendorf, Wimmer), mesh efficiency",
              internal=True),
        Entry("motion", "train.motion.MOTION", "Motion over speed", extra="motion",
              effects=("contact_loss", "friction", "parametric", "torque_ripple"), internal=True),
        Entry("dynamic-factor", "train.dynamic_factor.DYNAMIC_FACTOR", "Dynamic factor over speed", ("dynamic-factor",),
              "dynamic factor (maximum tooth force / mean mesh force) over speed, with loss of contact and friction",
              effects=("contact_loss", "friction", "parametric", "torque_ripple"), quantities=("dynamic-factor",),
              internal=True),
        Entry("design-chart", "train.design_chart.DESIGN_CHART", "Tip relief design chart", ("design-chart",),
              "dynamic factor over amount and length of tip relief", extra="motion",
              effects=("contact_loss", "friction", "parametric", "torque_ripple")),
    ),
})
# fmt: on

#: Every stage.
STAGES = Catalogue([entry for entries in SUBJECTS.values() for entry in entries], "fegear.results", "results")


def stage_called(name: str) -> Stage:
    """A stage by its name."""
    return STAGES.called(name)


def _reduced(stage: Stage) -> str | tuple[Any, ...]:
    """How a stage travels between processes: by its name, for its functions have none."""
    return (stage_called, (stage.name,)) if STAGES.holds(stage) else stage.__reduce_ex__(4)


copyreg.pickle(Stage, _reduced)

#: Every name by which a case may ask for a result.
RESULTS: tuple[str, ...] = tuple(dict.fromkeys(name for entry in STAGES.entries for name in entry.results))
