"""Cheap runs with nearly every result: they give what is kept, and their columns agree with each other."""

import importlib.util
import math
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.notes import OPEN, NoteClass, class_of
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.kinds import KINDS
from fegear.case.drafts.text import draft
from fegear.engine.run import Silence
from fegear.output.figures import described
from fegear.output.report.blocks import Group, Notes
from fegear.output.report.run import run_page
from fegear.results.catalogue import RESULTS

_SPEC = importlib.util.spec_from_file_location("small_net", Path(__file__).with_name("small_net.py"))
small_net = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(small_net)


def close(one, other, slack=1e-9):
    np.testing.assert_allclose(
        one, other, rtol=slack, atol=slack * np.abs(np.asarray(other, dtype=float)).max(initial=0)
    )


def columns(table):
    return {column.name: column.si for column in table.columns}


def number_of(found, name):
    return {value.name: value.si for value in found.values}[name]


# ---- what holds of every table


def check_any(table):
    for column in table.columns:
        if column.si.dtype.kind != "f":
            continue
        known = column.si[np.isfinite(column.si)]
        name = column.name
        if name.endswith("_error") and name not in {"tangential_error", "radial_error"}:
            assert (known >= 0.0).all(), f"{table.name}.{name}: an error below zero"
        if not name.endswith(("_rank", "_share")) and name.startswith(
            ("S_H", "S_F", "life", "hertz_pressure", "half_width", "frequency", "mesh_stiffness")
        ):
            assert (known >= 0.0).all(), f"{table.name}.{name}: below zero"
        if name.startswith(("share_", "printed_share", "energy_")) or name == "share":
            assert ((known >= -1e-9) & (known <= 1.3)).all(), f"{table.name}.{name}: no share"
    data = columns(table)
    for name in data:
        if name.endswith("_re") and f"{name[:-3]}_abs" in data:
            close(data[f"{name[:-3]}_abs"], np.hypot(data[name], data[f"{name[:-3]}_im"]))


# ---- what holds of tables of one kind


def check_load_sharing(data, name, found):
    pair = name.removeprefix("load_sharing_")
    total = data["load"][data["share"] > 0.5].mean() / data["share"][data["share"] > 0.5].mean()
    close(data["load"], data["share"] * total)
    assert ((data["hertz_pressure"] > 0.0) == (data["load"] > 0.0)).all()
    assert (np.diff(data["x"]) >= 0.0).all()
    steps = np.diff(data["roll_angle"]) / np.maximum(np.diff(data["x"]), 1e-12)
    steps = steps[(data["corner"][1:] == 0) & (data["corner"][:-1] == 0) & (np.diff(data["x"]) > 0.0)]
    close(steps, np.full(steps.size, steps[0]), 1e-6)  # along the line of action the roll angle grows evenly
    close(np.nanmax(data["load"]), number_of(found, f"{pair}.largest_load"), 1e-6)
    close(np.nanmax(data["share"]), number_of(found, f"{pair}.largest_share"), 1e-6)


def check_transmission_error(data, name, found):
    pair = name.removeprefix("transmission_error_")
    te, values = data["te"], {value.name: value.si for value in found.values}
    if f"{pair}.te_peak_to_peak" in values:
        close(np.ptp(te), values[f"{pair}.te_peak_to_peak"], 0.03)
        assert te.min() <= values[f"{pair}.te_mean"] <= te.max()
    assert (np.diff(data["x"]) >= 0.0).all()
    assert set(np.unique(data["pairs_in_contact"])) <= set(range(1, 5))
    assert (data["local_stiffness"] >= data["mesh_stiffness"] * 0.8).all()


def check_harmonics(data, name, found):
    close(data["amplitude"], np.hypot(data["cosine"], data["sine"]))
    assert (data["n"] == 1 + np.arange(data["n"].size)).all()
    pair = name.removeprefix("transmission_error_harmonics_")
    close(data["amplitude"][0], number_of(found, f"{pair}.te_first_harmonic"))


def check_bearing_forces(data, _name, _found):
    close(data["force_radial"], np.hypot(data["force_x"], data["force_y"]))
    assert (data["life"][np.isfinite(data["life"])] > 0.0).all()
    assert (data["shift"] >= 0.0).all()
    assert (data["tilt"] >= 0.0).all()


def check_modes(data, _name, _found):
    assert (np.diff(data["frequency"]) >= 0.0).all()
    energies = [data[key] for key in data if key.startswith("energy_")]
    if energies:
        assert (np.sum(energies, axis=0) <= 1.0 + 1e-9).all()  # the rest is in the shafts


def check_spectrum(data, name, found):
    """Largest line and root mean square of each pair's part of the force, as the values say them."""
    pair = name.removeprefix("mesh_force_spectrum_")
    for other in np.unique(data["from_pair"]):
        one = data["from_pair"] == other
        close(data["force"][one].max(), number_of(found, f"{pair}.largest_line_from_{other}"))
        steps = data["frequency"][one] / data["n"][one]
        close(steps, np.full(steps.size, steps[0]))
        close(data["power"][one], 0.5 * data["force"][one] ** 2)
        rms = number_of(found, f"{pair}.rms_from_{other}")
        assert math.sqrt(data["power"][one].sum()) == pytest.approx(rms, rel=1e-6)


def check_safety(data, _name, _found):
    """S times the stress is what is borne: one number by each method for both gears of one material."""
    for part in ("H", "F"):
        for gear in ("driver", "driven"):
            known = data[f"S_{part}_{gear}"] * data[f"sigma_{part}_{gear}"]
            assert (known[np.isfinite(known)] > 0.0).all()


def check_levels(data, _name, found):
    close(data["share"].sum(), 1.0)
    said = {value.name for value in found.values}  # above the static strength there is no damage to add
    for gear in ("driver", "driven"):
        for part in ("H", "F"):
            if f"I.{gear}.damage_{part}" not in said:
                assert not np.isfinite(data[f"damage_{part}_{gear}"]).all()
                continue
            total = number_of(found, f"I.{gear}.damage_{part}")
            close(data[f"damage_{part}_{gear}"].sum(), total, 1e-6)
    ratio = data["cycles_driver"] / data["cycles_driven"]
    close(ratio, np.full(ratio.size, ratio[0]))


def check_geometry(data, _name, _found):
    for smaller, larger in (("root_radius", "form_radius"), ("form_radius", "involute_tip_radius"),
                            ("involute_tip_radius", "tip_radius"), ("bore_radius", "root_radius")):  # fmt: skip
        external = data["bore_radius"] < data["tip_radius"]
        assert (data[smaller][external] <= data[larger][external] * (1.0 + 1e-9)).all()
    close(data["pitch_radius"] / data["module"] * 2.0, np.abs(data["teeth"]), 0.07)  # helical: over cos(beta)


def check_surface(data, _name, found):
    pair = "I"
    close(data["relative_radius"], np.abs(1.0 / (1.0 / data["radius_driver"] + 1.0 / data["radius_driven"])), 0.05)
    assert (np.abs(data["sliding_velocity"]) <= data["sum_velocity"]).all()
    for kind in ("", "_iso"):
        rise = data[f"contact_temperature{kind}"] - data[f"flash_temperature{kind}"]
        close(rise, np.full(rise.size, rise[0]), 1e-6)
    roughness = data["film_thickness"] / data["film_ratio"]
    close(roughness, np.full(roughness.size, roughness[0]), 1e-6)
    close(data["contact_temperature"].max(), number_of(found, f"{pair}.largest_contact_temperature"), 1e-6)
    close(np.abs(data["sliding_velocity"]).max(), number_of(found, f"{pair}.largest_sliding_velocity"), 1e-3)


def check_loss(data, name, found):
    """Power is the load times friction times sliding; over a base pitch it adds to the loss."""
    pair = name.removeprefix("tooth_loss_")
    assert (data["power_loss"] >= 0.0).all()
    loss, transmitted = number_of(found, f"{pair}.tooth_loss"), number_of(found, f"{pair}.transmitted_power")
    assert number_of(found, f"{pair}.tooth_efficiency") == pytest.approx(1.0 - loss / transmitted, rel=1e-9)
    mean = number_of(found, f"{pair}.mean_friction")
    assert data["friction_coefficient"].min() <= mean * (1 + 1e-9)
    assert mean <= data["friction_coefficient"].max() * (1 + 1e-9)
    assert loss / transmitted == pytest.approx(mean * number_of(found, f"{pair}.loss_factor"), rel=1e-6)


def check_stiffness_study(data, _name, _found):
    known = data["reason"] == ""
    assert (data["stiffness"][known] > 0.0).all()
    np.testing.assert_allclose(data["ratio_to_fe"], data["stiffness"] / data["stiffness_fe"], rtol=1e-9)


def check_stiffness_quantiles(data, _name, _found):
    ordered = [data[key] for key in ("lowest", "percentile_5", "median", "percentile_95", "highest")]
    assert (np.diff(ordered, axis=0) >= 0.0).all()


def check_stiffness(data, _name, _found):
    assert (data["c_self"] > 0.0).all()
    assert (data["root_tension"] > 0.0).all()
    assert (data["root_compression"] < 0.0).all()
    assert (data["c_next"] < data["c_self"]).all()


def check_members(data, _name, _found):
    """Torques of a set balance, and so do powers but for the losses."""
    close(data["power"], data["torque"] * data["speed"], 1e-6)
    assert abs(data["torque"].sum()) <= 1e-6 * np.abs(data["torque"]).max()


def check_planets(data, _name, _found):
    assert data["shares"].mean() == pytest.approx(1.0, rel=1e-6) or data["shares"].sum() == pytest.approx(1.0, rel=1e-6)
    assert ((data["apart_sun"] >= 0.0) & (data["apart_sun"] <= 1.0)).all()


def check_over_face(data, name, found):
    assert (data["least_line_load"] <= data["mean_line_load"]).all()
    assert (data["mean_line_load"] <= data["largest_line_load"] * (1 + 1e-12)).all()
    close(
        data["factor"] / data["mean_line_load"], np.full(data["z"].size, data["factor"][0] / data["mean_line_load"][0])
    )
    assert (np.diff(data["z"]) > 0.0).all()
    assert data["factor"].max() <= number_of(found, f"{name.removeprefix('load_over_face_')}.K_Hbeta") * (1.0 + 1e-6)


def check_over_roll(data, _name, _found):
    shares = [data[key] for key in data if key.startswith("share_") and not key.endswith("_error")]
    close(np.nansum(shares, axis=0), np.ones(data["roll"].size), 1e-6)
    assert (data["equilibrium"] <= 1e-6).all()
    assert (data["te"] >= data["te_unloaded"]).all()


def check_gauge(data, name, found):
    """The peak is the largest strain of its sign; stress follows strain; the gear turns evenly along the path."""
    gauge = name.removeprefix("gauge_")
    strain, peak = data["strain"], number_of(found, f"{gauge}.peak_strain")
    at = np.abs(strain).argmax()
    assert peak == strain[at]
    assert number_of(found, f"{gauge}.peak_stress") == data["stress"][at]
    assert number_of(found, f"{gauge}.peak_angle") == data["angle"][at]
    assert number_of(found, f"{gauge}.peak_x") == data["x"][at]
    close(np.ptp(strain), number_of(found, f"{gauge}.strain_range"))
    other = data["strain_opposite"][np.abs(data["strain_opposite"]).argmax()]
    assert other == number_of(found, f"{gauge}.peak_strain_opposite")
    pulled, pressed = sorted([peak, other], reverse=True)
    assert number_of(found, f"{gauge}.fillet_ratio") == pytest.approx(pressed / pulled)
    assert pulled > 0.0 > pressed  # one fillet is pulled and the other pressed
    assert np.ptp(data["stress"] / strain) < 1e-9 * data["stress"][at] / peak
    assert data["stress"][at] / peak > 0.0
    close(data["angle"] - data["angle"][0], (data["x"] - data["x"][0]) / _slope(data["x"], data["angle"]))
    close(np.abs(data["roll_angle"] - data["roll_angle"][0]), data["angle"] - data["angle"][0], 1e-7)
    if "t" in data:
        close(data["t"], (data["angle"] - data["angle"][0]) * data["t"][-1] / np.ptp(data["angle"]))
    if "strain_towards_tip" in data:  # at the ends of the tolerance the peak is on either side of its present one
        places = columns(next(table for table in found.tables if table.name == f"gauge_places_{gauge}"))
        ends = [np.abs(data[f"strain_towards_{end}"]).max() for end in ("root", "tip")]
        close(np.abs(places["peak_strain"][[0, -1]]), ends, 1e-9)
        close(places["displacement"], -places["displacement"][::-1])
        moved = np.abs(places["peak_strain"] - peak).max()
        assert moved == pytest.approx(number_of(found, f"{gauge}.peak_change_by_placement"))


def _slope(x, angle):
    """Length of the path for each angle: the base radius."""
    return (x[-1] - x[0]) / (angle[-1] - angle[0])


def check_gauge_loads(data, name, found):
    """Under the nominal load the curves are those of the gauge; a lower load strains less."""
    gauge = columns(next(t for t in found.tables if t.name == name.replace("_loads", "")))
    loads = np.unique(data["total_load"])
    largest = data["total_load"] == loads[-1]
    for key in ("x", "angle", "roll_angle", "strain", "strain_opposite", "strain_towards_root", "strain_towards_tip"):
        assert (data[key][largest] == gauge[key]).all()
    peaks = [np.abs(data["strain"][data["total_load"] == load]).max() for load in loads]
    close(peaks / loads, np.full(loads.size, peaks[-1] / loads[-1]), 0.02)  # nearly linear


def check_gauge_measured(data, name, found):
    gauge = name.removeprefix("gauge_measured_")
    close(data["residual"], data["measured"] - data["computed"], 1e-9)
    rms = number_of(found, f"{gauge}.residual_rms")
    assert math.sqrt((data["residual"] ** 2).mean()) == pytest.approx(rms, rel=0.3)  # of those that are drawn
    assert np.corrcoef(data["measured"], data["computed"])[0, 1] == pytest.approx(
        number_of(found, f"{gauge}.correlation"), abs=2e-3
    )


def check_dynamic_strain(data, name, found):
    """The static part is what the gauge sees at rest; of one mesh nothing comes from others; t is x over speed."""
    gauge = name.removeprefix("dynamic_strain_")
    still = columns(next(table for table in found.tables if table.name == f"gauge_{gauge}"))
    peak = np.abs(still["strain"]).max()
    assert np.median(np.abs(data["static_strain"] - np.interp(data["x"], still["x"], still["strain"]))) < 0.02 * peak
    close(data["strain"], data["strain_own_mesh"])
    x = data["x"] - data["x"][0]
    close(data["t"] - data["t"][0], x * np.ptp(data["t"]) / np.ptp(x), 1e-7)
    close(data["angle"] - data["angle"][0], x / _slope(still["x"], still["angle"]), 1e-7)
    dynamic = number_of(found, f"{gauge}.dynamic_peak_strain")
    at = np.abs(data["strain"]).argmax()
    assert (dynamic, number_of(found, f"{gauge}.dynamic_peak_angle")) == (data["strain"][at], data["angle"][at])
    ratio = number_of(found, f"{gauge}.dynamic_strain_ratio")
    assert ratio == pytest.approx(dynamic / data["static_strain"][np.abs(data["static_strain"]).argmax()], rel=0.02)


def check_rack_geometry(data, name, found):
    """Rolling line, clearances, path and stroke of rack and pinion from each other."""
    pitch, height = data["pitch"], data["height"]
    close(data["length"] / pitch, np.round(data["length"] / pitch))
    close(data["mounting_distance"] - data["distance"], height - 2e-3)  # one module of addendum
    reference = data["travel_per_turn"] / (2.0 * math.pi)
    close(data["distance"], reference + data["rolling_height"])
    base_pitch = (data["path_end"] - data["path_start"]) / data["contact_ratio"]
    close(base_pitch / pitch, np.full(1, math.cos(math.radians(20.0))))
    teeth = data["length"] / pitch
    close(data["stroke"], (teeth - 1.0) * pitch + data["contact_ratio"] * pitch)
    sine, cosine = math.sin(math.radians(20.0)), math.cos(math.radians(20.0))
    close(data["lowest_contact"], data["rolling_height"] - data["path_end"] * sine)
    close(data["start_radius"], np.hypot(reference * cosine, reference * sine + data["path_start"]))


def check_rack_stiffness(data, name, _found):
    """First and last tooth have one neighbour; what a load lowers it lowers most where it is; teeth are elastic."""
    tooth = int(name.rsplit("_", 1)[1])
    assert np.isnan(data["c_prev"]).all() == (tooth == 1)
    assert np.isnan(data["c_next"]).all() == (tooth == 6)
    assert (np.diff(data["height"]) > 0.0).all()
    for key in ("c_self", "root_tension"):
        assert (data[key] > 0.0).all()
    assert (data["root_compression"] < 0.0).all()


def check_rack_error(data, name, found):
    rack = name.removeprefix("rack_transmission_error_")
    assert data["te"].max() == pytest.approx(number_of(found, f"{rack}.te_max"))
    assert data["pinion_root_stress"].max() == pytest.approx(number_of(found, f"{rack}.pinion_root_stress"))
    assert set(np.diff(data["tooth"])) <= {0, 1}
    assert (data["tooth"][0], data["tooth"][-1]) == (1, 2 if found.scene.case.title == "Helical rack" else 6)
    close(data["largest_share"][data["pairs_in_contact"] == 1], 1.0)
    assert (data["largest_share"] * data["pairs_in_contact"] >= 1.0 - 1e-9).all()
    if f"{rack}.pitch" in {value.name for value in found.values}:
        pitch, begins = number_of(found, f"{rack}.pitch"), data["travel"][np.flatnonzero(np.diff(data["tooth"]))]
        close(begins, pitch * np.round(begins / pitch), 0.05)  # a tooth comes each pitch, the first at zero
        close(data["travel"][-1], number_of(found, f"{rack}.stroke"), 1e-6)


def check_rack_roots(data, name, found):
    rack = name.removeprefix("rack_root_stress_")
    assert data["root_tension"].max() == pytest.approx(number_of(found, f"{rack}.rack_root_stress"))
    assert data["tooth"].tolist() == list(range(1, data["tooth"].size + 1))


def check_idler(data, name, found):
    """Range, mean and ratio of the extremes of each fillet; both are pulled and pressed once a revolution."""
    high, low = data["stress_highest"], data["stress_lowest"]
    close(data["stress_range"], high - low)
    close(data["stress_mean"], 0.5 * (high + low))
    close(data["stress_ratio"], low / high)
    assert ((low < 0.0) & (high > 0.0)).all()
    gear = name.removeprefix("idler_root_stress_")
    for fillet, mesh in (("driven_side", "I.driven"), ("driving_side", "J.driver")):
        row = data["fillet"].tolist().index(fillet)
        assert high[row] == pytest.approx(number_of(found, f"{mesh}.largest_root_tension"), rel=0.01)
        for key in ("range", "mean", "ratio"):
            assert number_of(found, f"{gear}.{fillet}.stress_{key}") == data[f"stress_{key}"][row]


def check_crack_path(data, name, found):
    """Steps along the path add up, stiffness is lost, cycles are what the growth rates take."""
    x, y, length = data["x"], data["y"], data["length"]
    close(np.hypot(np.diff(x), np.diff(y)), np.diff(length), 1e-6)
    heading = np.unwrap(np.arctan2(np.diff(y), np.diff(x)))
    close(np.diff(heading), data["turn"][1:-1], 1e-6)
    close(data["stiffness_loss"], 1.0 - data["stiffness"] / data["stiffness"][0])
    assert (np.diff(data["stiffness"]) < 0.0).all()
    assert (data["K_I"] > np.abs(data["K_II"])).all()
    slow, fast = data["growth_rate"][:-1], data["growth_rate"][1:]
    assert (
        (np.diff(data["cycles"]) <= np.diff(length) / slow) & (np.diff(data["cycles"]) >= np.diff(length) / fast)
    ).all()
    crack = name.removeprefix("crack_path_I_")
    assert number_of(found, f"I.final_length_{crack}") == length[-1]
    assert number_of(found, f"I.cycles_{crack}") == data["cycles"][-1]


def check_stress_intensity(data, name, found):
    crack = name.removeprefix("stress_intensity_I_")
    at = data["K_I"].argmax()
    assert number_of(found, f"I.K_I_max_{crack}") == data["K_I"][at]
    assert number_of(found, f"I.K_II_at_K_I_max_{crack}") == data["K_II"][at]
    assert number_of(found, f"I.K_I_min_{crack}") == data["K_I"].min()
    assert set(np.diff(data["base_pitch"])) <= {0, 1}
    assert (np.diff(data["gear_angle"]) > 0.0).all()
    assert data["load"][data["base_pitch"] < -1].max(initial=0.0) == 0.0


def beside_the_maximum(of_samples, largest):
    """The largest value of all is looked for between the samples of a table, too."""
    assert 0.998 * largest < of_samples <= largest * (1.0 + 1e-9)


def check_vibration(data, _name, found):
    """Over a revolution of the driver; its largest values are those said; the residual has no mesh harmonics."""
    turn = 2.0 * math.pi
    close(data["driver_angle"], turn * np.arange(data["t"].size) / data["t"].size)
    beside_the_maximum(data["force"].max(), number_of(found, "I.mesh_force_max"))
    residual = data["te_residual"]
    beside_the_maximum(np.abs(residual).max(), number_of(found, "I.dynamic_te_residual_max"))
    ordinary = np.median(data["te"].reshape(25, -1), axis=0)
    close(data["te_change"], (data["te"].reshape(25, -1) - ordinary).ravel())
    beside_the_maximum(np.abs(data["te_change"]).max(), number_of(found, "I.dynamic_te_change_max"))
    assert math.sqrt((residual**2).mean()) == pytest.approx(number_of(found, "I.dynamic_residual_rms"))
    moments = ((residual - residual.mean()) ** np.array([[2], [4]])).mean(axis=1)
    assert moments[1] / moments[0] ** 2 == pytest.approx(number_of(found, "I.dynamic_residual_kurtosis"))
    assert np.abs(residual.reshape(25, -1).mean(axis=0)).max() < 1e-9 * np.abs(residual).max()
    lines = columns(next(table for table in found.tables if table.name == "vibration_orders_I"))
    for key in ("te", "force", "acceleration"):
        close(lines[key], 2.0 * np.abs(np.fft.rfft(data[key]))[1 : lines[key].size + 1] / data[key].size, 1e-9)
    close(lines["mesh_order"], lines["n"] / 25.0)
    close(lines["frequency"] * (data["t"][-1] + data["t"][1]), lines["n"])


def check_measured_error(data, name, found):
    rig = name.removeprefix("measured_te_summary_")
    close(data["ratio"], data["measured_peak_to_peak"] / data["computed_peak_to_peak"])
    close(data["load"] / data["torque"], np.full(data["load"].size, data["load"][-1] / data["torque"][-1]))
    assert number_of(found, f"{rig}.measured_to_computed") == data["ratio"][-1]
    curves, lines = (
        columns(next(table for table in found.tables if table.name == f"measured_te{kind}_{rig}"))
        for kind in ("", "_harmonics")
    )
    for torque, rms, largest in zip(data["torque"], data["residual_rms"], data["largest_amplitude"], strict=True):
        mine = curves["torque"] == torque
        residual = curves["residual"][mine]
        close(residual, curves["measured"][mine] - curves["computed"][mine])
        assert math.sqrt((residual**2).mean()) == pytest.approx(rms)
        one = lines["torque"] == torque
        assert lines["n"][one].tolist() == list(range(1, one.sum() + 1))
        assert largest > lines["measured_amplitude"][one].max()  # eccentricity of the rig
    close(lines["measured_amplitude"], lines["computed_amplitude"], 0.05)


def check_gearbox(data, _name, _found):
    """What is lowest stands first; causes add up to the whole misalignment."""
    assert (np.diff(data["load_margin"]) >= 0.0).all()
    flank, root = (data["S_H"] / data["S_H_min"]) ** 2, data["S_F"] / data["S_F_min"]
    close(data["load_margin"], np.minimum(flank, root))
    close(
        sum(data[f"misalignment_{cause}"] for cause in ("bearings", "housing", "bending", "torsion")),
        data["misalignment"],
        1e-6,
    )


def check_bearings_of_gearbox(data, _name, _found):
    """A tenth of the load has a thousand times the life of balls; first the least margin of life and of tilt."""
    known = np.isfinite(data["life"])
    margin, hours, life = (data[key][known] for key in ("load_margin", "life_hours", "life"))
    tilt = (data["tilt_permissible"] / data["tilt"])[known]
    assert (np.diff(np.minimum(margin, tilt)) >= 0.0).all()
    close(margin**3, hours / (5000.0 * 3600.0), 1e-6)
    assert (np.diff(life[np.argsort(data["force_radial"][known])]) < 0.0).all()


def check_sizing(data, _name, found):
    """Variants by what they are: distance, tip circles, safety and mass of each from its own columns."""
    beta = data["helix_angle"]
    tangential = data["normal_module"] / np.cos(beta)
    alpha = np.arctan(np.tan(data["pressure_angle"]) / np.cos(beta))
    z = data["z_1"] + data["z_2"]
    working = np.arccos(z * tangential * np.cos(alpha) / (2.0 * data["centre_distance"]))
    inv = np.tan(working) - working - np.tan(alpha) + alpha
    close(data["x_1"] + data["x_2"], z * inv / (2.0 * np.tan(data["pressure_angle"])), 1e-6)
    close(data["overlap_ratio"], data["face_width"] * np.sin(beta) / (math.pi * data["normal_module"]))
    base = [data[f"z_{k}"] * tangential * np.cos(alpha) / 2.0 for k in (1, 2)]
    tips = [np.sqrt((data[f"tip_diameter_{k}"] / 2.0) ** 2 - base[k - 1] ** 2) for k in (1, 2)]
    path = tips[0] + tips[1] - data["centre_distance"] * np.sin(working)
    assert (data["contact_ratio"] <= path / (math.pi * tangential * np.cos(alpha)) * (1.0 + 1e-9)).all()
    close(data["contact_ratio"], path / (math.pi * tangential * np.cos(alpha)), 0.05)  # tips may be rounded
    assert (np.abs(data["z_2"] / data["z_1"] / 2.5 - 1.0) <= 0.0101).all()
    assert data["place"].tolist() == sorted(data["place"].tolist())
    assert number_of(found, "sizing.load_margin") == data["load_margin"][0]
    assert number_of(found, "sizing.mass") == data["mass"][0]
    counts = columns(next(table for table in found.tables if table.name == "excluded_variants"))["variants"].sum()
    assert counts + number_of(found, "sizing.variants_feasible") == number_of(found, "sizing.variants")


def check_leads(data, _name, _found):
    """A correction never makes the face load factor larger, nor less than one; one lead serves all loads."""
    assert (data["K_Hbeta_after"] <= data["K_Hbeta_before"]).all()
    assert (data["K_Hbeta_after"] >= 1.0).all()
    for pair in np.unique(data["pair"]):
        for key in ("slope", "crowning"):
            assert np.ptp(data[key][data["pair"] == pair]) == 0.0
    grades = data["slope"] / 0.5e-6
    close(grades, np.round(grades))


def check_fillet_stress(data, _name, found):
    """Of each fillet the largest stress is the one said, and the designed one is the lowest of them."""
    largest = {}
    for fillet in np.unique(data["fillet"]):
        mine = data["fillet"] == fillet
        assert (np.diff(data["arc"][mine]) > 0.0).all()
        assert (np.diff(data["diameter"][mine]) > -1e-9).all()
        largest[fillet] = data["stress"][mine].max()
        said = number_of(found, f"I.b.root_stress_{'full_rounded' if fillet.startswith('full') else fillet}")
        assert largest[fillet] == pytest.approx(said, rel=1e-3)
    assert largest["optimum"] == min(largest.values())
    gain = number_of(found, "I.b.gain")
    assert gain == pytest.approx(
        1.0 - number_of(found, "I.b.root_stress_optimum") / number_of(found, "I.b.root_stress_present")
    )


#: Checks by how a table's name begins; the longest that fits counts.
OF_TABLES = {
    "load_sharing_loads": None, "load_sharing": check_load_sharing,
    "transmission_error_summary": None, "transmission_error_loads": None,
    "transmission_error_rotational": None, "transmission_error_series": None, "transmission_error_convergence": None,
    "transmission_error_harmonics": check_harmonics, "transmission_error": check_transmission_error,
    "bearing_forces": check_bearing_forces, "natural_modes": check_modes, "planet_modes": check_modes,
    "mesh_force_spectrum": check_spectrum, "rating_safety": check_safety, "rating_spectrum": check_levels,
    "geometry": check_geometry, "flank_surface": check_surface, "tooth_loss": check_loss, "stiffness": check_stiffness,
    "stiffness_study": check_stiffness_study, "stiffness_study_quantiles": check_stiffness_quantiles,
    "planet_members": check_members, "planet_shares": check_planets, "load_over_face": check_over_face,
    "load_distribution_roll": check_over_roll,
    "gauge": check_gauge, "gauge_loads": check_gauge_loads, "gauge_places": None,
    "gauge_measured": check_gauge_measured, "dynamic_strain": check_dynamic_strain,
    "rack_geometry": check_rack_geometry, "rack_stiffness": check_rack_stiffness,
    "rack_stiffness_over_face": None,
    "rack_transmission_error": check_rack_error, "rack_root_stress": check_rack_roots, "idler_root_stress": check_idler,
    "crack_path": check_crack_path, "stress_intensity": check_stress_intensity, "vibration_revolution": check_vibration,
    "measured_te_summary": check_measured_error, "gearbox_meshes": check_gearbox,
    "gearbox_bearings": check_bearings_of_gearbox, "sizing": check_sizing, "lead_correction": check_leads,
    "fillet_stress": check_fillet_stress,
}  # fmt: skip


def check_first_screen(found):
    """The report begins with the wanted answer, has at most three open notes, and its first values are wanted ones."""
    page = run_page(found, described(found), list(found.remarks))
    assert [section.title for section in page.sections[:3]] == ["Answer", "Notes", "Results"]
    said, notes, values = (section.blocks for section in page.sections[:3])
    wanted = {step.task for step in found.plan.steps if step.wanted}
    lines = [line for sentence in found.answer.sentences for line in sentence.splitlines()]
    assert lines == [line for block in said if isinstance(block, Notes) for line in block.sentences]  # about a table
    outcomes = [found.outcomes[task] for task in wanted]
    assert said or not any(outcome.values or outcome.figures for outcome in outcomes)
    fails = sum(class_of(note) is NoteClass.FAILS for note in found.notes(list(found.remarks), information=False))
    assert sum(len(block.notes) for block in notes if hasattr(block, "notes")) <= max(OPEN, fails) + 1
    groups = [block for block in values if isinstance(block, Group)]
    if any(outcome.values for outcome in outcomes):
        first = groups[0].blocks[1].values[0]
        assert any(value.name == first.name for outcome in outcomes for value in outcome.values)


#: Results that no run of the net has, and the tests that compute them.
ELSEWHERE: dict[str, str] = {}


def test_every_result_has_a_run_in_the_net_or_a_test_elsewhere():
    wanted = {result for name in small_net.RUNS for result in small_net.wanted(name)}
    how = "give each a run in RUNS of small_net.py and accept it, or name the test that computes it in ELSEWHERE"
    assert {*RESULTS} - wanted == {*ELSEWHERE}, how
    tests = Path(__file__).resolve().parents[1]
    assert [name for name, test in ELSEWHERE.items() if f'"{name}"' not in (tests / test).read_text("utf-8")] == []


#: Takes 20 s; the same search with other options is tried at every change.
LONG = {"flank_design"}


@pytest.mark.dear(
    "flank_design_options", "gearbox_misaligned", "helical_set", "lead_correction", "robustness", "spur_misaligned"
)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.long) if name in LONG else name for name in small_net.RUNS]
)
def test_a_cheap_run_gives_what_is_kept_and_its_columns_agree(name, monkeypatch):
    done = []
    monkeypatch.setattr(Silence, "advance", lambda _self, fraction: done.append(fraction))
    found = small_net.computed(name)
    assert all(0.0 <= fraction <= 1.0 + 1e-9 for fraction in done)
    for table in found.tables:
        check_any(table)
        kind = max((kind for kind in OF_TABLES if f"{table.name}_".startswith(f"{kind}_")), key=len, default=None)
        if kind and OF_TABLES[kind]:
            OF_TABLES[kind](columns(table), table.name, found)
    assert small_net.differences(small_net.kept()[name], small_net.of_run(found)) == []
    assert small_net.differences(small_net.kept(small_net.LOOKS)[name], small_net.looks_of(found)) == []
    check_first_screen(found)


#: Cases that no cheap run takes, with what makes them as cheap as they get.
FURTHER = {
    "calculix_pair": {"accuracy.tolerance": 0.1},
    "fillet_design": {"accuracy.tolerance": 0.1, "fillet_design.searches": 1},
    "four_square_fe": {"accuracy.tolerance": 0.1},
    "helical_load": small_net.ROUGH,
    "helical_pair": small_net.ROUGH,
    "helical_planet_and_ring": small_net.ROUGH,
    "inclined_web": {"accuracy.tolerance": 0.3},
    "khbeta_helical": small_net.ROUGH,
    "khbeta_spur": small_net.ROUGH,
    "lin_dynamic_factor": {"dynamics.speeds": ["6000 rpm", "9000 rpm"]},
    "litvin_lead": {},
    "litvin_shaft_angle": {},
    "litvin_under_load": small_net.ROUGH,
    "measured_transmission_error": {"accuracy.tolerance": 0.1},
    "nasa_four_square": {"accuracy.tolerance": 0.1},
    "nasa_relief_design": {"accuracy.tolerance": 0.1, "design.grind": ["linear"]},
    "relief_torque_range": {"accuracy.tolerance": 0.1},
    "root_stress_validation": {"accuracy.tolerance": 0.1},
    "spur_over_the_face": {"accuracy.tolerance": 0.3},
    "strain_gauges": {"accuracy.tolerance": 0.1},
    "torque_ripple": {"accuracy.tolerance": 0.1},
    "typed_drawing": {"accuracy.tolerance": 0.1},
    "web_holes": {"accuracy.tolerance": 0.3},
}  # fmt: skip


#: With what the first sentence of some begins.
BEGINS = {
    "helical_load": "Pair I: K_Hβ", "helical_pair": "Pair I: K_Hβ", "khbeta_helical": "Pair I: K_Hβ",
    "khbeta_spur": "Pair I: K_Hβ", "relief_torque_range": "Pair I: grind ",
    "strain_gauges": "Gauge tension: measured strain is ",
    "spur_over_the_face": "Gear a, force on one band of the flank: self-compliance",
}  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("name", FURTHER)
def test_the_first_screen_of_further_cases_has_the_answer(name):
    found = fegear.run(small_net.ROOT / "cases" / f"{name}.toml", FURTHER[name], progress=False)
    check_first_screen(found)
    assert found.answer.sentences[0].startswith(BEGINS.get(name, ""))


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_a_fresh_template_has_no_open_note(kind, tmp_path):
    """All that stands open on a report are failures, tolerances, neglected effects and assumptions.

    Bearings of a drafted gearbox are known by their designations: that C and the law of rollers are estimated is open.
    """
    path = tmp_path / f"{kind}.toml"
    path.write_text(draft(Answers(kind, {}), kind), encoding="utf-8")
    found = fegear.run(path, progress=False)
    check_first_screen(found)
    open_notes = [one for one in found.notes(information=False) if not one.startswith(("Bearings ", "Shafts: roller"))]
    assert open_notes == []
    assert "gearbox" in kind or found.notes(information=False) == ()
