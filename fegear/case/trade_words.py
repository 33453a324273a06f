"""Words of the trade for keys and results: other English words, those of other programs and of AGMA, German, symbols.

Whoever types one of them means a certain key, and spelling would lead to another: `bore_diameter` is no misspelt
`ball_diameter`. What cannot be described at all is told here too.
"""

from __future__ import annotations

import difflib
from collections.abc import Collection, Iterator
from dataclasses import dataclass

#: How alike a misspelt word is to one of the trade, 0 to 1.
_MISSPELT = 0.9


@dataclass(frozen=True, slots=True)
class Meaning:
    """What somebody who types a word looks for.

    Parameters
    ----------
    keys : tuple of str
        Keys with the tables in which they are, ``gear.NAME.bore_radius``, or names of results; the first that is known
        where the word was typed is meant, or else the first.
    how : str
        What is to be known of it: "half the diameter".
    """

    keys: tuple[str, ...] = ()
    how: str = ""

    def remedy(self, known: Collection[str]) -> str:
        """What to write instead, where these names are known."""
        here = next((name for key in self.keys if (name := key.rpartition(".")[2]) in known), "")
        if here:
            return f'did you mean "{here}"' + (f" ({self.how})" if self.how else "")
        if self.keys:
            return f"use {self.keys[0]}" + (f" ({self.how})" if self.how else "")
        return self.how


def of_key(word: str, known: Collection[str] = ()) -> Meaning | None:
    """What a word means among the keys of a case, also one that is misspelt, unless a known key is as near to it.

    None for one that is not in the list.
    """
    typed = plain(word)
    for key, (words, meaning) in _BESIDE.items():
        if key in known and typed in words:
            return meaning
    if typed in _KEYS:
        return None if known and _a_table_of_others(_KEYS[typed], known) else _KEYS[typed]
    near = difflib.get_close_matches(typed, [*_KEYS, *map(plain, known)], n=1, cutoff=_MISSPELT)
    return _KEYS.get(near[0]) if near and near[0] not in map(plain, known) else None


def _a_table_of_others(meaning: Meaning, known: Collection[str]) -> bool:
    """Whether a word means tables of the case, which have no place beside these keys."""
    kinds = [key.partition(".") for key in meaning.keys]
    return bool(kinds) and all(rest == "NAME" and kind not in known for kind, _, rest in kinds)


def of_result(word: str) -> Meaning | None:
    """What a word means among the results."""
    return _RESULTS.get(plain(word))


def of_value(key: str, value: object) -> str:
    """What is to be known of a value that is refused, by the last name of its key; empty where nothing is."""
    name = key.rpartition(".")[2]
    if name == "planet" and isinstance(value, list):
        return _STEPPED
    return _VALUES.get(name, {}).get(plain(value), "") if isinstance(value, str) else ""


def plain(word: str) -> str:
    """A word without capitals, umlauts and what joins its parts: sigma_Hlim and sigmaHlim are one."""
    return word.strip().lower().translate(_LETTERS)


_LETTERS = str.maketrans({
    "ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "α": "alpha", "β": "beta", "ρ": "rho", "ν": "nu", "σ": "sigma",
    "-": "", " ": "", "_": "", "'": "",
})  # fmt: skip
_RACK = "a rack has a table of its own, with its pinion: [rack.NAME]"
_STEPPED = "stepped planets are groups with two gears in compound.NAME.planet"
_DOUBLE = "the gears are the half at end I, with its hand and face width"
_KEYWAY = "a keyway is not described; a hole within one pitch is (hole in [[gear.NAME.odd_tooth]])"
_WORN = "wear is not computed; specify worn flanks as measured flanks (gear.NAME.measured)"
_CROSSED = "only cylindrical gears on parallel axes are supported"
_UNEVEN = "pressure_angle is that of the drive flank, coast_pressure_angle that of the coast flank"
_SPACING = "specify it as gear.NAME.spacing_errors, one value for each tooth"
_HEAT = (
    "of the material, with modulus_over_temperature; thermal expansion is not computed, flank-surface computes flank "
    "temperatures"
)

_THICKNESS = "reduction of the tooth thickness at the reference circle from (pi/2 + 2 x tan(alpha)) m"
_BACKLASH = (
    ("pair.NAME.normal_backlash",),
    "made by thickness_allowance of the gears; of a train train.mesh.NAME.backlash",
)
_FOLLOWS = "calculated from the gears, see geometry"

#: Words, the keys that they mean, and what is to be known.
_OF_KEYS: tuple[tuple[str, tuple[str, ...], str], ...] = (
    # a gear
    ("z z1 z2 number_of_teeth tooth_number teeth_number tooth_count num_teeth no_of_teeth n_teeth zaehnezahl np ng",
     ("gear.NAME.teeth",), ""),
    ("m modul", ("gear.NAME.module",), ""),
    ("mn m_n normalmodul", ("gear.NAME.normal_module", "gear.NAME.module"), ""),
    ("mt m_t stirnmodul radial_module", ("gear.NAME.transverse_module",), ""),
    ("dp p_d pd diametral transverse_diametral_pitch", ("gear.NAME.diametral_pitch",), ""),
    ("pnd p_nd", ("gear.NAME.normal_diametral_pitch",), ""),
    ("pitch p teilung tooth_pitch cp", ("gear.NAME.circular_pitch",), ""),
    ("base_pitch p_b pb eingriffsteilung", ("gear.NAME.module",), "the base pitch over pi cos(alpha)"),
    ("p_n pn normal_pitch normalteilung", ("gear.NAME.normal_circular_pitch",), ""),
    ("alpha_t alphat stirneingriffswinkel radial_pressure_angle", ("gear.NAME.transverse_pressure_angle",), ""),
    ("d pitch_diameter reference_diameter pitch_circle pitch_radius teilkreis teilkreisdurchmesser",
     ("gear.NAME.module",), "the reference diameter over the number of teeth"),
    ("alpha alpha_n phi phi_n normal_pressure_angle eingriffswinkel", ("gear.NAME.pressure_angle",), ""),
    ("beta psi helix schraegungswinkel spiral_angle", ("gear.NAME.helix_angle",), ""),
    ("helix_hand hand_of_helix helix_direction flankenrichtung lead_direction", ("gear.NAME.hand",), ""),
    (("x x1 x2 shift addendum_modification addendum_shift profile_shift_coefficient shift_coefficient "
     "profilverschiebung profilverschiebungsfaktor"), ("gear.NAME.profile_shift",), ""),
    ("b width facewidth zahnbreite breite gear_width", ("gear.NAME.face_width",), ""),
    (("d_a da od do tip_circle tip_circle_diameter outside_diameter outer_diameter addendum_diameter kopfkreis "
     "kopfkreisdurchmesser"), ("gear.NAME.tip_diameter",), ""),
    ("ra_tip tip_circle_radius outside_radius", ("gear.NAME.tip_diameter",), "twice the radius"),
    ("d_f df root_circle root_circle_diameter fusskreis fusskreisdurchmesser root_diameter",
     ("gear.NAME.cutter.root_diameter", "gear.NAME.rack.dedendum"), "d_f = m (z + 2 x - 2 h_fP*)"),
    (("bore bore_diameter bore_dia d_i di inner_diameter inside_diameter shaft_hole hole_diameter bohrung "
     "bohrungsdurchmesser"), ("gear.NAME.bore_diameter",), ""),
    ("start_diameter relief_diameter tip_relief_diameter", ("gear.NAME.relief.tip.start_radius",), "half the diameter"),
    ("end_diameter", ("gear.NAME.relief.tip.at_radius",), "half the diameter"),
    ("start_angle", ("gear.NAME.relief.tip.start_roll_angle",), ""),
    ("length_on_path", ("gear.NAME.relief.tip.length",), ""),
    ("hub_diameter nabendurchmesser", ("gear.NAME.body.hub_radius",), "half the diameter"),
    ("s_n sn s_t s thickness circular_tooth_thickness normal_tooth_thickness zahndicke",
     ("gear.NAME.tooth_thickness",), "normal to the teeth at the reference diameter"),
    ("tooth_thickness_tolerance zahndickenabmass zahndickentoleranz a_sn asn e_sn esn t_sn allowance",
     ("gear.NAME.thickness_allowance",), _THICKNESS),
    ("chordal_tooth_thickness chord_thickness zahndickensehne s_c sc caliper",
     ("gear.NAME.chordal_thickness",), "with chordal_height"),
    ("chordal_addendum h_c hc zahnhoehe_ueber_sehne", ("gear.NAME.chordal_height",), ""),
    ("span_measurement base_tangent base_tangent_length w_k wk zahnweite w", ("gear.NAME.span",), "with span_teeth"),
    ("k spanned_teeth teeth_spanned messzaehnezahl", ("gear.NAME.span_teeth",), ""),
    ("measurement_over_balls dimension_over_balls between_balls m_dk mdk kugelmass", ("gear.NAME.over_balls",),
     "with ball_diameter"),
    (("measurement_over_pins dimension_over_pins between_pins over_wires over_rollers mop m_dr mdr rollenmass "
      "dimension_over_rollers"), ("gear.NAME.over_pins",), "with ball_diameter"),
    ("d_m dm ball pin pin_diameter wire_diameter roller_diameter messkugel messrolle",
     ("gear.NAME.ball_diameter",), ""),
    ("backlash j_bn jbn j_n flankenspiel play clearance_of_flanks", *_BACKLASH),
    ("j_t jt j_wt jwt drehflankenspiel", ("pair.NAME.circumferential_backlash",), ""),
    ("tip_relief kopfruecknahme c_a ca cay",
     ("gear.NAME.relief.tip.amount", "gear.NAME.relief"), "with its amount and length"),
    ("root_relief fussruecknahme c_f cf", ("gear.NAME.relief.root", "gear.NAME.relief"), "with its amount and length"),
    ("profile_crowning c_alpha barrelling hoehenballigkeit", ("gear.NAME.relief.crowning", "gear.NAME.relief"), ""),
    ("crowning lead_crowning c_beta cb cbeta breitenballigkeit helix_crowning",
     ("gear.NAME.lead.crowning", "gear.NAME.lead"), ""),
    ("end_relief endruecknahme", ("gear.NAME.lead.end_relief", "gear.NAME.lead"), ""),
    ("helix_correction helix_modification c_hb chb schraegungswinkelkorrektur lead_correction",
     ("gear.NAME.lead.slope", "gear.NAME.lead"), ""),
    ("chamfer kantenbruch tip_edge_break", ("gear.NAME.tip_chamfer",), ""),
    ("tip_rounding edge_radius kopfkantenrundung", ("gear.NAME.tip_radius_rounding",), ""),
    ("addendum h_ap hap ha kopfhoehe addendum_coefficient addendum_factor kopfhoehenfaktor",
     ("gear.NAME.rack.addendum",), "in modules"),
    ("dedendum h_fp hfp hf fusshoehe dedendum_coefficient dedendum_factor fusshoehenfaktor",
     ("gear.NAME.rack.dedendum",), "in modules"),
    (("rho_fp rhofp rho_f fillet fillet_radius root_fillet root_radius hob_tip_radius cutter_tip_radius "
     "fussrundung fussrundungsradius"), ("gear.NAME.rack.tip_radius",), "in modules"),
    ("tool hob basic_rack reference_profile profile bezugsprofil werkzeug", ("gear.NAME.rack",), ""),
    ("pinion_cutter shaper_cutter shaper schneidrad", ("gear.NAME.cutter",), ""),
    ("ring internal_gear hohlrad inner_gear", ("gear.NAME.internal",), "`internal = true`"),
    ("accuracy_class accuracy_grade quality q agma_quality iso_quality grade toleranzklasse verzahnungsqualitaet",
     ("gear.NAME.tolerance_class", "pair.NAME.iso_6336.accuracy_grade"), ""),
    ("ra rz surface_roughness surface_finish rauheit", ("gear.NAME.roughness",), ""),
    ("rim s_r sr rim_height kranzdicke zahnkranzdicke", ("gear.NAME.rim_thickness",), ""),
    ("web bs b_s stegdicke", ("gear.NAME.web_thickness",), ""),
    ("e youngs_modulus elastic_modulus elasticity e_modul e_modulus modulus_of_elasticity elastizitaetsmodul",
     ("gear.NAME.material.young_modulus",), ""),
    ("nu poisson poissons_ratio querkontraktionszahl querdehnzahl", ("gear.NAME.material.poisson_ratio",), ""),
    ("rho dichte mass_density", ("gear.NAME.material.density",), ""),
    ("steel werkstoff material_name stahl", ("gear.NAME.strength.steel", "gear.NAME.material"), ""),
    ("hb hbw hrc hv haerte surface_hardness hardness", ("gear.NAME.strength.hardness",), ""),
    ("sigma_hlim shlim sac s_ac allowable_contact_stress contact_fatigue_limit", ("gear.NAME.strength.contact",), ""),
    ("sigma_flim sflim sat s_at allowable_bending_stress bending_fatigue_limit", ("gear.NAME.strength.bending",), ""),
    ("chd eht case_hardening_depth einsatzhaertungstiefe", ("gear.NAME.strength.case_depth",), ""),
    ("pitch_error pitch_errors spacing_error f_pt fpt teilungsfehler teilungsabweichung index_errors",
     ("gear.NAME.spacing_errors",), ""),
    # a pair
    ("a a_w aw c center_distance centre_dist axis_distance achsabstand", ("pair.NAME.centre_distance",), ""),
    ("pinion ritzel gear_1 gear1 input_gear", ("pair.NAME.driver",), ""),
    ("wheel rad gear_2 gear2 output_gear gear", ("pair.NAME.driven",), ""),
    ("t t1 torque input_torque torque_1 pinion_torque moment drehmoment", ("pair.NAME.torque", "train.torque"), ""),
    ("leistung p_kw kw hp ps transmitted_power", ("pair.NAME.power",), "with speed"),
    ("shift_sum sum_of_profile_shifts sum_x x_sum profilverschiebungssumme distribution_of_shift",
     ("pair.NAME.shift_distribution",), "with centre_distance"),
    ("f_t ft w_t wt force tangential_force transmitted_load umfangskraft normal_force f_n fn",
     ("pair.NAME.load",), "along the line of action: F_t / cos(alpha_wt)"),
    ("n n1 n_1 rpm speed drehzahl input_speed pinion_speed rotational_speed angular_velocity omega",
     ("pair.NAME.speed", "dynamics.speed"), ""),
    ("ratio gear_ratio i u uebersetzung", ("gear.NAME.teeth",), "of both gears, from which the ratio follows"),
    ("k_a ka k_o ko overload_factor anwendungsfaktor application_factor service_factor",
     ("pair.NAME.operation.application_factor", "pair.NAME.operation"), ""),
    ("k_v kv dynamikfaktor dynamic_factor", ("pair.NAME.operation.dynamic_factor", "pair.NAME.operation"), ""),
    ("k_hbeta khbeta khb kh_beta k_m km load_distribution_factor breitenlastfaktor face_load_factor",
     ("pair.NAME.operation.face_load_factor", "pair.NAME.operation"), ""),
    ("k_halpha khalpha kha transverse_load_factor stirnlastfaktor",
     ("pair.NAME.operation.transverse_load_factor", "pair.NAME.operation"), ""),
    ("k_gamma kgamma kgam mesh_load_factor", ("pair.NAME.operation.mesh_load_factor", "pair.NAME.operation"), ""),
    ("lifetime l_h lh hours required_life lebensdauer service_life life",
     ("pair.NAME.operation.life", "pair.NAME.operation"), ""),
    ("s_hmin shmin required_safety_contact", ("pair.NAME.operation.safety_contact", "pair.NAME.operation"), ""),
    ("s_fmin sfmin required_safety_root", ("pair.NAME.operation.safety_root", "pair.NAME.operation"), ""),
    ("load_spectrum lastkollektiv duty_cycle spectrum", ("pair.NAME.operation.spectrum", "pair.NAME.operation"), ""),
    ("oil lube lubrication schmierstoff oel viscosity iso_vg",
     ("pair.NAME.lubricant.viscosity_40", "pair.NAME.lubricant"), ""),
    ("mu friction_coefficient coefficient_of_friction reibungszahl",
     ("pair.NAME.friction.coefficient", "pair.NAME.friction"), ""),
    ("lead_error helix_error f_hbeta fhbeta helix_deviation flankenlinienabweichung helix_slope_deviation",
     ("gear.NAME.deviations.helix_slope", "pair.NAME.line_error.over_face", "pair.NAME.line_error"), ""),
    ("profile_error f_falpha ffalpha profilabweichung profile_deviation",
     ("gear.NAME.deviations.profile_form", "gear.NAME.deviations"), ""),
    ("shaft_misalignment alignment_error achsneigung achsschraenkung axis_error",
     ("pair.NAME.misalignment",), ""),
    ("mesh_stiffness c_gamma cgamma eingriffssteifigkeit",
     ("train.mesh.NAME.stiffness",), "default: from the teeth, see transmission-error"),
    (("contact_ratio epsilon_alpha eps_alpha profilueberdeckung overlap_ratio working_pressure_angle alpha_w alpha_wt "
     "betriebseingriffswinkel base_circle d_b base_diameter base_radius grundkreis tip_clearance"), (), _FOLLOWS),
    # the case
    ("gears raeder", ("gear.NAME",), "a table for each: [gear.a]"),
    ("pairs gear_pair gear_pairs stage stages stufe", ("pair.NAME",), "a table for each: [pair.I]"),
    ("shafts wellen", ("shaft.NAME",), "a table for each: [shaft.in]"),
    ("bearings lager", ("bearing.NAME",), "a table for each: [bearing.ball]"),
    ("yield_point yield_stress streckgrenze dehngrenze r_p02 rp02 r_e", ("shaft.NAME.yield_strength",), ""),
    ("tilt_limit permissible_misalignment schiefstellung kippwinkel", ("bearing.NAME.permissible_tilt",), ""),
    ("planets planetary_set planet_set planetengetriebe epicyclic", ("planetary.NAME",), "a table: [planetary.P]"),
    (("ravigneaux simpson wolfrom wolfrom_set compound_set compound_planetary coupled_sets plusgetriebe "
      "koppelgetriebe"), ("compound.NAME",), "tables of shafts, planets and meshes: [compound.R]"),
    ("outputs output result wanted ergebnisse", ("results",), ""),
    ("tolerance mesh_size element_size elements refinement netz", ("accuracy.tolerance", "accuracy"), ""),
    ("headline titel", ("title",), ""),
    ("coupling_between_teeth coupled_teeth", ("effects.neighbour_coupling", "effects"), ""),
    ("tip_contact premature_contact off_line_contact vorzeitiger_eingriff", ("effects.corner_contact", "effects"), ""),
    ("gravity weight_of_gears", (), "weight is not included; specify forces as shaft.NAME.loads"),
    # what is not there
    ("rack_gear gear_rack rack_and_pinion zahnstange rack_teeth", ("rack.NAME",), _RACK),
    ("herringbone double_helical double_helix pfeilverzahnung pfeilrad", ("pair.NAME.double_helical",), _DOUBLE),
    ("gap_width groove_width nutbreite", ("pair.NAME.double_helical.gap",), ""),
    ("apex apex_error apex_point pfeilspitze", ("pair.NAME.double_helical.apex_offset",), ""),
    ("stepped_planet compound_planet stufenplanet", ("compound.NAME",), _STEPPED),
    ("crack cracks tooth_crack cracked_tooth crack_length riss", ("gear.NAME.odd_tooth",),
     "[[gear.NAME.odd_tooth]], one table for each tooth"),
    ("broken_tooth missing_tooth", ("gear.NAME.odd_tooth.missing",), "[[gear.NAME.odd_tooth]], with missing = true"),
    ("spall spalling pit pits gruebchen", ("gear.NAME.odd_tooth.pits",), "[[gear.NAME.odd_tooth]], with pits = [...]"),
    ("keyway keyseat passfedernut", (), _KEYWAY),
    ("wear wear_depth verschleiss", (), _WORN),
    (("bevel bevel_gear worm worm_gear hypoid crossed_axes shaft_angle_of_axes cone_angle kegelrad schnecke "
     "achsenwinkel"), (), _CROSSED),
    ("drive_pressure_angle asymmetric pressure_angle_2 asymmetrisch", ("gear.NAME.coast_pressure_angle",), _UNEVEN),
    ("runout run_out eccentricity rundlauf f_r exzentrizitaet wobble", (), _SPACING),
    ("temperature thermal_expansion thermal temperatur waermeausdehnung", ("gear.NAME.material.temperature",), _HEAT),
)  # fmt: skip
_OF_RESULTS: tuple[tuple[str, tuple[str, ...], str], ...] = (
    ("mass inertia weight dimensions span tip_diameter contact_ratio backlash drawing base_tangent geometrie",
     ("geometry",), ""),
    (("te loaded_transmission_error static_transmission_error ste pte drehwegabweichung drehfehler mesh_stiffness tvms "
     "gear_mesh_stiffness time_varying_mesh_stiffness stiffness_of_mesh eingriffssteifigkeit c_gamma"),
     ("transmission-error",), ""),
    ("tooth_stiffness single_tooth_stiffness compliance c_prime zahnfedersteifigkeit", ("stiffness",), ""),
    ("load_share load_distribution_between_teeth lastaufteilung", ("load-sharing",), ""),
    ("contact_stress hertz hertz_pressure hertzian_stress pressure pressung flankenpressung", ("load-sharing",),
     "over the face width: load-distribution"),
    ("bending_stress tooth_root_stress fillet_stress root_bending zahnfussspannung", ("root-stress",),
     "in the mesh root-stress-history"),
    (("safety safety_factor safety_factors iso_6336 iso6336 agma agma_2101 din_3990 strength life lifetime s_h s_f "
     "pitting tragfaehigkeit"), ("rating",), ""),
    (("scuffing micropitting flash_temperature temperature film film_thickness fressen graufleckigkeit sliding "
     "gleitgeschwindigkeit"), ("flank-surface",), ""),
    ("efficiency power_loss losses friction_loss wirkungsgrad verlustleistung", ("gear-mesh-power-loss",), ""),
    ("contact_pattern tragbild face_load_factor k_hbeta khbeta line_load", ("load-distribution",),
     "of unloaded flanks tooth-contact"),
    ("ltca loaded_tooth_contact_analysis", ("load-distribution",), ""),
    ("tca tooth_contact_analysis", ("tooth-contact",), ""),
    ("natural_frequencies eigenfrequencies modal modes eigenfrequenzen critical_speeds", ("natural-modes",), ""),
    ("dynamics vibration dynamic_load dynamic_response k_v kv dynamic_transmission_error dte", ("dynamic-factor",), ""),
    ("shaft_strength shaft_stress shaft_safety din_743 wellenfestigkeit", ("shaft-deflection",),
     "nominal stress and yielding; notches and fatigue are not evaluated"),
    ("bearing_life bearings bearing_forces deflection shaft_deflections biegelinie lagerkraefte",
     ("shaft-deflection",), ""),
    ("tip_relief profile_modification microgeometry micro_geometry profilkorrektur", ("relief",),
     "over the face flank-design"),
    ("undercut clearance interference tip_thickness plausibility", ("tooth-geometry-check",), ""),
    ("tolerance_analysis monte_carlo sensitivity", ("robustness",), ""),
    ("planet_load_share k_gamma lastverteilung", ("planet-load-sharing",), ""),
    ("herringbone double_helix half_load_sharing apex_error", ("double-helical",), ""),
    ("crack stress_intensity_factor sif riss", ("stress-intensity",), ""),
    ("crack_propagation crack_growth paris_law rissfortschritt", ("crack-path",), ""),
    ("wear wear_depth verschleiss", (), _WORN),
    ("noise sound_power sound_pressure acoustics geraeusch", (),
     "noise is not computed; see transmission-error and dynamic-factor for its excitation"),
)  # fmt: skip
_VALUES = {
    "hand": dict.fromkeys(
        ("double", "doublehelical", "herringbone", "both"), f"set pair.NAME.double_helical; {_DOUBLE}"
    ),
}


def _rows(rows: tuple[tuple[str, tuple[str, ...], str], ...]) -> Iterator[tuple[str, Meaning]]:
    for words, keys, how in rows:
        yield from ((plain(word), Meaning(keys, how)) for word in words.split())


_KEYS = dict(_rows(_OF_KEYS))
#: What words mean in a table that has a key: this key.
_BESIDE = {
    "driver_start_diameter": (("startdiameter",), Meaning(("driver_start_diameter",), "or driven_start_diameter")),
    "samples": (("pairs", "gears", "count", "number"), Meaning(("samples",), "number of random pairs or gears")),
}
_RESULTS = dict(_rows(_OF_RESULTS))
