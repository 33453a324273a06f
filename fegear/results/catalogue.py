"""Every stage that fegear knows, by subject, as plain data: its module is imported when a plan asks for it."""

from __future__ import annotations

import copyreg
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from fegear.case.effects import PLANE_EFFECTS, WIDE_EFFECTS
from fegear.engine.catalogue import Catalogue, Entry
from fegear.engine.stage import Stage

# fmt: off
#: Every stage by the subject of its results, in the order in which plans list those that they skip.
SUBJECTS: Mapping[str, tuple[Entry, ...]] = MappingProxyType({
    "A gear and its teeth": (
        Entry("geometry", "gear.geometry.GEOMETRY", "Geometry", ("geometry",),
              "what a drawing states and what follows from it: circles, span over teeth, contact ratio, backlash"),
        Entry("tooth-geometry-check", "gear.tooth_geometry_check.TOOTH_GEOMETRY_CHECK",
              "Drawing against rules of thumb", ("tooth-geometry-check",),
              "tip thickness, rim, undercut, contact ratio and clearances against rules of thumb"),
        Entry("measured-flanks", "gear.measured_flanks.MEASURED_FLANKS", "Measured flanks", ("measured-flanks",),
              "slope, form and total deviation of measured profiles and helices, and the tolerance class they keep"),
        Entry("gear-solution", "gear.solved_gear.GEAR_SOLUTION", "Influence functions of a gear"),
        Entry("stiffness", "gear.stiffness.STIFFNESS", "Compliance and root stress, whole gear", ("stiffness",),
              "compliance of a loaded tooth and its neighbours, and its root stress, over load positions"),
        Entry("solid-solution", "gear.solved_gear.SOLID_SOLUTION",
              "Influence functions of a gear with its width"),
        Entry("stiffness-over-face", "gear.stiffness_over_face.SOLID_STIFFNESS",
              "Compliance and root stress over the face", ("stiffness",),
              "compliance of a loaded tooth and its neighbours, and its root stress, over load positions",
              extra="space"),
        Entry("body-modes", "gear.body_modes.BODY_MODES", "Natural frequencies of a gear's body", ("body-modes",),
              "natural frequencies and mode shapes of a gear with its width, rim, web and hub, its bore held"),
        Entry("root-stress", "gear.root_stress.ROOT_STRESS", "Root stress along the fillets", ("root-stress",),
              "stress along both fillets of a tooth, for every load position"),
        Entry("crosscheck", "gear.crosscheck.CROSSCHECK", "Closed forms against finite elements", ("crosscheck",),
              "closed forms for stiffness and root stress (ISO 6336, AGMA 908, ...) compared with finite elements"),
        Entry("root-stress-study", "gear.root_stress_study.ROOT_STRESS_STUDY",
              "Root-stress formulas against finite elements over many gears", ("root-stress-study",),
              "where each root-stress formula is high or low, over many gears"),
    ),
    "A pair under load": (
        Entry("loaded-pair", "pair.loaded_pair.LOADED_PAIR", "Compliances of a loaded pair", effects=PLANE_EFFECTS),
        Entry("load-sharing", "pair.load_sharing.LOAD_SHARING", "Load sharing", ("load-sharing",),
              "load, deflection and contact pressure of a tooth pair over the path of contact", effects=WIDE_EFFECTS),
        Entry("transmission-error", "pair.transmission_error.TRANSMISSION_ERROR",
              "Transmission error", ("transmission-error",),
              "loaded transmission error, mesh stiffness, their harmonics, and both over load", effects=WIDE_EFFECTS),
        Entry("root-stress-history", "pair.root_stress_history.ROOT_STRESS_HISTORY",
              "Root stress through the mesh", ("root-stress-history",),
              "root stress of both gears as a tooth passes through the mesh", effects=WIDE_EFFECTS),
        Entry("stress-in-mesh", "pair.stress_in_mesh.STRESS_IN_MESH", "Root stress of the gears in mesh",
              effects=WIDE_EFFECTS),
        Entry("outline-motion", "pair.deformed_in_mesh.OUTLINE_MOTION", "Motion of a gear's outline"),
        Entry("deformed-in-mesh", "pair.deformed_in_mesh.DEFORMED_IN_MESH", "Deformed teeth of the gears in mesh",
              effects=PLANE_EFFECTS),
        Entry("inner-stress", "pair.stress_inside.INNER_STRESS", "Stress inside a gear's teeth under unit loads"),
        Entry("stress-inside", "pair.stress_inside.STRESS_INSIDE", "Stress inside the teeth of the gears in mesh"),
        Entry("loaded-flanks", "pair.loaded_flanks.LOADED_FLANKS", "Contact over the flanks", effects=WIDE_EFFECTS),
        Entry("load-distribution", "pair.load_distribution.LOAD_DISTRIBUTION",
              "Load over the flanks", ("load-distribution",),
              "line load and pressure over the flanks of a spur or helical pair with its width, load factors K",
              effects=WIDE_EFFECTS),
        Entry("flank-load-factors", "pair.load_factors.FLANK_LOAD_FACTORS",
              "Load factors over the flanks", ("load-distribution",),
              "line load and pressure over the flanks of a spur or helical pair with its width, load factors K",
              effects=WIDE_EFFECTS),
        Entry("contact-pattern", "pair.contact_pattern.CONTACT_PATTERN", "Contact pattern", ("load-distribution",),
              "line load and pressure over the flanks of a spur or helical pair with its width, load factors K",
              effects=WIDE_EFFECTS),
        Entry("mesh-stiffness-matrix", "pair.mesh_stiffness_matrix.MESH_STIFFNESS_MATRIX",
              "Stiffness matrix of the mesh", ("mesh-stiffness-matrix",),
              "stiffness of a loaded mesh against translation and tilt of its gears: K_M, kappa and mu",
              effects=WIDE_EFFECTS),
        Entry("rating", "rating.rating.RATING", "Load capacity", ("rating",),
              "safeties of flanks and roots by ISO 6336, every factor; computed ones and AGMA 2101 for comparison",
              effects=WIDE_EFFECTS),
        Entry("flank-fracture", "rating.flank_fracture.FLANK_FRACTURE",
              "Flank fracture and case depth", ("flank-fracture",),
              "exposure of surface-hardened flanks over depth by ISO/TS 6336-4, and the case depth they need"),
        Entry("flank-surface", "pair.flank_surface.FLANK_SURFACE", "Flank surface", ("flank-surface",),
              "sliding, pressure, temperatures, lubricant film and safeties of the flanks from A to E", extra="space",
              effects=WIDE_EFFECTS),
        Entry("gear-mesh-power-loss", "pair.gear_mesh_power_loss.GEAR_MESH_POWER_LOSS",
              "Gear mesh power loss", ("gear-mesh-power-loss",),
              "friction loss of the teeth, H_V compared with Ohlendorf and Wimmer, efficiency of pair and train",
              formerly="tooth-loss", effects=WIDE_EFFECTS),
    ),
    "Profile relief": (
        Entry("relief", "relief.relief.RELIEF", "Relief for least excitation", ("relief",),
              "profile relief of both gears that minimises transmission error, and its grindable approximation",
              effects=("corner_contact", "neighbour_coupling", "hertz")),
        Entry("relief-curves", "relief.relief_curves.RELIEF_CURVES",
              "Transmission error and load, relief by relief", ("relief-curves",),
              "transmission error and load of a tooth pair over the roll angle for a family of tip reliefs",
              effects=("corner_contact", "neighbour_coupling", "hertz")),
        Entry("relief-chart", "relief.relief_chart.RELIEF_CHART", "Chart of tip reliefs", ("relief-chart",),
              "transmission error over amount and length of tip relief, at several loads",
              effects=("corner_contact", "neighbour_coupling", "hertz")),
        Entry("robustness", "relief.relief_chart.ROBUSTNESS", "Robustness of the reliefs", ("robustness",),
              "sensitivity of a designed relief to other loads, spacing errors and grinding errors",
              effects=("corner_contact", "neighbour_coupling", "hertz")),
        Entry("tolerance-robustness", "relief.tolerance_robustness.TOLERANCE_ROBUSTNESS",
              "Deviations inside the tolerances", ("robustness",),
              "transmission error, root stress, pressure and K_Hbeta of pairs drawn inside their tolerances",
              effects=WIDE_EFFECTS),
        Entry("loading-spectrum", "relief.loading_spectrum.LOADING_SPECTRUM",
              "Tooth loading functions and their spectra", ("loading-spectrum",),
              "how a tooth pair may be loaded so that all pairs add up, and what that excites in the teeth"),
        Entry("flank-design", "relief.flank_design.FLANK_DESIGN", "Relief of loaded flanks", ("flank-design",),
              "relief over profile and face for least loaded transmission error, and its grindable approximation",
              effects=("neighbour_coupling", "hertz", "misalignment")),  # the gears' own reliefs are replaced
    ),
    "Helical pairs": (
        Entry("tooth-contact", "helical.tooth_contact.TOOTH_CONTACT", "Tooth contact analysis", ("tooth-contact",),
              "unloaded contact of helical flanks, misaligned or not: transmission error, path, ellipses",
              extra="space", effects=("misalignment",)),
        Entry("contact-lines", "helical.contact_lines.CONTACT_LINES", "Contact lines", ("contact-lines",),
              "lines along which the flanks of an aligned helical pair touch, and their total length over a cycle",
              extra="space", effects=("misalignment",)),
        Entry("flank-generation", "helical.flank_generation.FLANK_GENERATION",
              "Generation of helical flanks", ("flank-generation",),
              "rack cutters of a helical pair, the flanks that they generate, and the design parameters",
              extra="space", effects=("misalignment",)),
        Entry("transmissibility", "helical.transmissibility.TRANSMISSIBILITY",
              "Force transmissibility", ("transmissibility",),
              "forces that a helical pair passes from its mesh to its bearings, over frequency"),
        Entry("mode-tracking", "helical.mode_tracking.MODE_TRACKING",
              "Modes tracked over a parameter", ("mode-tracking",),
              "modes of a helical pair followed over bearing stiffness, helix angle or mesh parameters",
              formerly="followed-modes"),
        Entry("pair-forced-response", "helical.pair_forced_response.PAIR_FORCED_RESPONSE",
              "Mesh and bearing forces", ("pair-forced-response",),
              "mesh and bearing forces of a helical pair over speed, by transmission error and external forces",
              formerly="pair-forces"),
    ),
    "Planetary sets": (
        Entry("planet-set", "planetary.planet_set.PLANET_SET", "Planetary set", ("planet-set",),
              "speeds, torques, frequencies and mesh phases of a planetary set, and what phasing cancels"),
        Entry("set-cycle", "planetary.planet_load_sharing.SET_CYCLE", "Meshes of a planetary set over their cycle",
              effects=WIDE_EFFECTS),
        Entry("meshed-set", "planetary.planet_load_sharing.MESHED_SET", "Teeth of a planetary set",
              effects=WIDE_EFFECTS),
        Entry("planet-load-sharing", "planetary.planet_load_sharing.PLANET_LOAD_SHARING",
              "Load sharing of planets", ("planet-load-sharing",),
              "load of each planet over the mesh cycle, K_gamma, transmission error and forces of a planetary set"),
        Entry("planet-root-stress", "planetary.planet_root_stress.PLANET_ROOT_STRESS",
              "Root stress of planets over a turn", ("planet-root-stress",),
              "root stress of a planet's tooth bent to either side by sun and ring, of sun and ring: range, mean, R"),
        Entry("planet-modes", "planetary.planet_vibration.PLANET_MODES",
              "Natural modes of a planetary set", ("planet-modes",),
              "natural frequencies of a planetary set: rotational, translational and planet modes"),
        Entry("planet-vibration", "planetary.planet_vibration.PLANET_VIBRATION",
              "Vibration of a planetary set", ("planet-vibration",),
              "dynamic forces in the meshes of a planetary set over speed, excited with their phases"),
        Entry("planet-motion", "planetary.planet_motion.PLANET_MOTION",
              "Motion of a planetary set with contact loss", ("planet-motion",),
              "steady motions of a planetary set over speed in which teeth part and meet again", extra="motion"),
    ),
    "Shafts and bearings": (
        Entry("loaded-shafts", "shafts.loaded_shafts.LOADED_SHAFTS", "Shafts under all meshes", effects=WIDE_EFFECTS),
        Entry("shaft-deflection", "shafts.shaft_deflection.SHAFT_DEFLECTION",
              "Shafts on their bearings", ("shaft-deflection",),
              "deflection of shafts under all meshes, bearing forces and lives"),
        Entry("misalignment", "shafts.misalignment.MISALIGNMENT", "Misalignment of the meshes", ("misalignment",),
              "how far shafts, bearings and housing misalign each mesh, by cause, and what opens over its face"),
    ),
    "Gear trains in motion": (
        Entry("gear-train", "train.gear_train.GEAR_TRAIN", "Gear train", ("gear-train",),
              "bodies, shafts, meshes, speeds and mean forces of the train, as fegear takes them",
              effects=PLANE_EFFECTS),
        Entry("natural-modes", "train.natural_modes.NATURAL_MODES",
              "Natural frequencies and Campbell diagram", ("natural-modes", "campbell"),
              "natural frequencies and modes, and the speeds at which the meshes excite them",
              effects=("torque_ripple",)),
        Entry("torque-ripple", "train.torque_ripple.TORQUE_RIPPLE", "Torque ripple", ("torque-ripple",),
              "mesh forces and shaft torques by torques that fluctuate, per unit of torque and at the speed",
              effects=("torque_ripple",)),
        Entry("dynamic-increments", "train.dynamic_increments.DYNAMIC_INCREMENTS",
              "Dynamic increment functions", ("dynamic-increments",),
              "dynamic increment functions of every mesh over frequency, with what they tend to (Mark)"),
        Entry("mesh-force-spectrum", "train.mesh_force_spectrum.MESH_FORCE_SPECTRUM",
              "Mesh force spectra", ("mesh-force-spectrum",),
              "harmonics of the force in every mesh at a speed, and which mesh each comes from",
              effects=("torque_ripple",)),
        Entry("tooth-force", "train.tooth_force.TOOTH_FORCE", "Force on one tooth pair", ("tooth-force",),
              "force on one tooth pair in motion, with and without the other meshes", effects=("torque_ripple",)),
        Entry("dynamic-root-stress", "train.dynamic_root_stress.DYNAMIC_ROOT_STRESS",
              "Dynamic root stress", ("dynamic-root-stress",),
              "root stress of one tooth in motion", effects=("neighbour_coupling",)),
        Entry("tooth-friction", "pair.tooth_friction.TOOTH_FRICTION",
              "Tooth friction over the path", ("tooth-friction",),
              "friction coefficient, friction torques and loss of a tooth pair over its path of contact",
              effects=("friction",)),
        Entry("train-loss", "pair.gear_mesh_power_loss.TRAIN_LOSS",
              "Gear mesh power loss of the train", ("gear-mesh-power-loss",),
              "friction loss of the teeth, H_V compared with Ohlendorf and Wimmer, efficiency of pair and train"),
        Entry("motion", "train.motion.MOTION", "Motion over the speeds", extra="motion",
              effects=("contact_loss", "friction", "parametric", "torque_ripple")),
        Entry("dynamic-factor", "train.dynamic_factor.DYNAMIC_FACTOR", "Dynamic factor over speed", ("dynamic-factor",),
              "largest tooth force over the static one, over speed, with loss of contact and friction",
              effects=("contact_loss", "friction", "parametric", "torque_ripple")),
        Entry("design-chart", "train.design_chart.DESIGN_CHART", "Design chart of tip relief", ("design-chart",),
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
