"""Results flank-surface and gear-mesh-power-loss on pairs whose compliances are closed forms: no finite elements."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.tooth_loss import moved_at_most
from fegear.dynamics.train.friction_law import buckingham
from fegear.formulas.flank_speeds import flank_speeds
from fegear.formulas.friction import ohlendorf
from fegear.formulas.hertz import contact_modulus
from fegear.workbench.run import run

GEAR = {"module": "3 mm", "face_width": "20 mm", "roughness": {"flank": "0.5 um"}}
OIL = {
    "viscosity_40": "220 mm^2/s", "viscosity_100": "19 mm^2/s", "temperature": "70 degC", "scuffing_load_stage": 12,
    "micropitting_load_stage": 9,
}  # fmt: skip


def case(*results, gear=None, effects=None, **changes):
    pair = {
        "driver": "a", "driven": "b", "torque": "150 N*m", "speed": "1500 rpm",
        "compliance": {"source": "weber-banaschek"}, "lubricant": OIL,
    }  # fmt: skip
    pair = {key: value for key, value in (pair | changes).items() if value is not None}
    common = {key: value for key, value in (GEAR | (gear or {})).items() if value is not None}
    return {
        "results": list(results),
        "gear": {"a": {"teeth": 23, "profile_shift": 0.2} | common, "b": {"teeth": 47} | common},
        "pair": {"I": pair},
        "effects": effects or {"hertz": "load-dependent"},
    }


def numbers(*results, **changes):
    found = run(case(*results, **changes), progress=False)
    return {value.name.removeprefix("I."): value.value for value in found.values}, found


def columns(found, name):
    (table,) = (table for table in found.tables if table.name == name)
    return {column.name: np.asarray(column.si) for column in table.columns}


def test_flanks_of_a_spur_pair_from_a_to_e():
    values, found = numbers("flank-surface")
    (data,) = (one.data for one in found.outcomes.values() if hasattr(one.data, "computed"))
    pair, path = data.pair, columns(found, "flank_surface_I")
    x = path["x"]
    assert [x[0], x[-1]] == pytest.approx([pair.x_start, pair.x_end])
    at = flank_speeds(pair, x, 1500 * math.pi / 30)
    assert path["sliding_velocity"] == pytest.approx(at.sliding)
    alone = (x > pair.x_lpstc * (1 - 1e-6)) & (x < pair.x_hpstc * (1 - 1e-6))
    load = 150.0 / pair.driver.base_radius / 0.02
    assert path["line_load"][alone] == pytest.approx(load)
    assert path["line_load_iso"][alone] == pytest.approx(load)
    # Hertz by the other formula of this program: p = sqrt(w E* / (pi R))
    e = contact_modulus(206.8e9, 0.3, 206.8e9, 0.3)
    assert path["hertz_pressure"] == pytest.approx(np.sqrt(path["line_load"] * e / math.pi / at.relative_radius))
    pitch = int(np.argmin(np.abs(x)))
    assert abs(path["flash_temperature"][pitch]) < 1.0
    assert values["largest_contact_temperature"] == pytest.approx(np.nanmax(path["contact_temperature"]))
    assert values["least_film_ratio"] == pytest.approx(np.nanmin(path["film_ratio"]))
    assert path["film_thickness"] == pytest.approx(path["film_ratio"] * 0.5e-6)
    assert values["S_B"] > 1.0
    assert values["S_lambda_iso"] == pytest.approx(values["least_film_ratio_iso"] / data.permissible_film)
    assert [figure.name for figure in found.figures] == [
        f"surface_{what}_I" for what in ("sliding", "pressure", "temperature", "film")
    ]


def test_oil_hotter_than_it_scuffs_is_said():
    hot = {key: value for key, value in OIL.items() if key != "scuffing_load_stage"}
    values, found = numbers(
        "flank-surface", lubricant=hot | {"temperature": "120 degC", "scuffing_temperature": "110 degC"}
    )
    assert values["S_B"] < 0.0
    assert any("is not below the scuffing temperature" in remark for remark in found.remarks)


def test_load_factors_heat_the_flanks_and_ones_change_nothing():
    plain, _ = numbers("flank-surface")
    ones = {"application_factor": 1.0, "dynamic_factor": 1.0, "face_load_factor": 1.0, "transverse_load_factor": 1.0}
    same, found = numbers("flank-surface", operation=ones)
    assert same == plain
    assert not any(
        "= 1 for scuffing and micropitting. Specify strength of "
        "both gears (ISO 6336-1) or operation.dynamic_factor, "
        "face_load_factor, transverse_load_factor." in remark
        for remark in found.remarks
    )
    more, _ = numbers("flank-surface", operation=ones | {"application_factor": 1.5})
    assert more["S_B"] < plain["S_B"]
    assert more["S_intS_iso"] < plain["S_intS_iso"]
    assert more["least_film_ratio"] < plain["least_film_ratio"]


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"lubricant": None}, "pair.I.lubricant"),
        ({"gear": {"roughness": None}}, "gear.a.roughness"),
        ({"gear": {"roughness": {"root": "3 um"}}}, "gear.a.roughness"),
        ({"speed": None}, "pair.I.speed"),
        ({"speed": "0 rpm"}, "pair.I.speed"),
        ({"torque": None}, "pair.I.load"),
        ({"lubricant": OIL | {"temperature": "600 degC"}}, "pair.I.lubricant.temperature"),
        ({"gear": {"roughness": {"flank": "0.5 mm"}}}, "gear.a.roughness.flank"),
        ({"gear": {"roughness": {"flank": "5 um", "flank_rz": "2 um"}}}, "gear.a.roughness.flank_rz"),
        ({"lubricant": OIL | {"viscosity_40": "220 m^2/s"}}, "pair.I.lubricant.viscosity_40"),
        ({"lubricant": OIL | {"viscosity_100": "300 mm^2/s"}}, "pair.I.lubricant.viscosity_100"),
        ({"friction": {"law": "constant"}}, "pair.I.friction.coefficient"),
        ({"friction": {"law": "schlenk", "coefficient": 0.05}}, "pair.I.friction.coefficient"),
        ({"friction": {"coefficient": 0.05, "local": True}}, "pair.I.friction.local"),
    ],
)
def test_what_is_missing_or_contradicts_is_named(changes, key):
    with pytest.raises(InputError) as caught:
        run(case("flank-surface", **changes), progress=False)
    assert caught.value.key == key


def test_without_tests_of_the_oil_there_are_no_safeties_but_a_remark():
    oil = {key: value for key, value in OIL.items() if "stage" not in key}
    values, found = numbers("flank-surface", lubricant=oil)
    assert not {"S_B", "S_B_iso", "S_intS_iso", "S_lambda", "S_lambda_iso"} & set(values)
    for damage, key in (("scuffing", "scuffing_load_stage"), ("micropitting", "micropitting_load_stage")):
        text = f"safety factor for {damage} not computed: lubricant.{key} or "
        assert sum(text in remark for remark in found.remarks) == 1


def test_constant_friction_and_loss_factor_and_power():
    values, found = numbers("gear-mesh-power-loss", friction={"coefficient": 0.06}, lubricant=None)
    assert values["transmitted_power"] == pytest.approx(150.0 * 1500 * math.pi / 30)
    assert values["tooth_loss"] == pytest.approx(0.06 * values["loss_factor"] * values["transmitted_power"])
    assert values["mean_friction"] == pytest.approx(0.06)
    assert values["tooth_efficiency"] == pytest.approx(1.0 - 0.06 * values["loss_factor"])
    assert 0.7 < values["loss_factor"] / values["loss_factor_ohlendorf"] < 1.05
    path = columns(found, "tooth_loss_I")
    assert path["power_loss"] == pytest.approx(
        0.06 * path["load"] * np.abs(flank_speeds(found.scene.pairs["I"], path["x"], 1500 * math.pi / 30).sliding)
    )
    frictionless, _ = numbers("gear-mesh-power-loss", friction={"coefficient": 0.0}, lubricant=None)
    assert frictionless["tooth_loss"] == 0.0
    assert frictionless["tooth_efficiency"] == 1.0


def test_teeth_alike_everywhere_share_alike_and_lose_as_ohlendorf_says(tmp_path):
    """A pair compliance that is the same at every place gives shares of one half, so H_V is Ohlendorf's."""
    table = tmp_path / "even.csv"
    table.write_text("x [mm],compliance [um/N]\n" + "".join(f"{x},0.003\n" for x in np.linspace(-30.0, 30.0, 61)))
    asked = case("gear-mesh-power-loss", friction={"coefficient": 0.05}, effects={"hertz": "none"},
                 compliance={"source": "table", "of": "pair", "file": str(table)})  # fmt: skip
    found = run(asked, progress=False)
    values = {value.name.removeprefix("I."): value.value for value in found.values}
    assert values["loss_factor"] == pytest.approx(ohlendorf(found.scene.pairs["I"]), rel=1e-5)
    assert values["loss_factor_wimmer"] == pytest.approx(values["loss_factor_ohlendorf"], rel=1e-12)


def test_local_laws_are_integrated_over_the_path():
    values, found = numbers("gear-mesh-power-loss", friction={"law": "buckingham"})
    path = columns(found, "tooth_loss_I")
    pair = found.scene.pairs["I"]
    at = flank_speeds(pair, path["x"], 1500 * math.pi / 30)
    assert path["friction_coefficient"] == pytest.approx(buckingham(at.sliding))
    mean = np.trapezoid(buckingham(at.sliding) * path["load"] * np.abs(at.sliding), path["x"]) / pair.base_pitch
    assert values["tooth_loss"] == pytest.approx(mean, rel=1e-9)
    whole, _ = numbers("gear-mesh-power-loss", friction={"law": "iso-6336-22"})
    local, _ = numbers("gear-mesh-power-loss", friction={"law": "iso-6336-22", "local": True})
    assert local["loss_factor"] == pytest.approx(whole["loss_factor"], rel=1e-12)
    assert local["mean_friction"] == pytest.approx(whole["mean_friction"], rel=0.15)
    assert local["mean_friction"] != whole["mean_friction"]


def test_losses_of_a_train_are_those_of_friction_in_motion():
    """Buckingham's law at one speed: the same loss as tooth-friction, which integrates springs of the teeth."""
    from pathlib import Path

    friction = {f"pair.{name}.friction": {"law": "buckingham"} for name in ("first", "second")}
    path = Path(__file__).parents[2] / "cases" / "two_stage_gearbox.toml"
    found = run(
        path,
        {**friction, "dynamics.speeds": ["3000 rpm"]},
        results=["gear-mesh-power-loss", "tooth-friction"],
        progress=False,
    )
    values = {value.name: value.value for value in found.values}
    for name in ("first", "second"):
        assert values[f"{name}.tooth_loss"] == pytest.approx(values[f"{name}.friction_loss"], rel=1e-4)
    total = values["first.tooth_loss"] + values["second.tooth_loss"]
    assert values["train.tooth_loss"] == pytest.approx(total, rel=1e-6)
    assert values["train.tooth_efficiency"] == pytest.approx(1.0 - total / values["train.power"], rel=1e-9)
    assert values["train.power"] == pytest.approx(80.0 * 3000 * math.pi / 30)


@pytest.mark.long
def test_flanks_with_a_width_tend_to_the_plane_and_carry_the_whole_load():
    """Wide spur teeth as solids: loss factor within 5 % of the plane's, film and temperature near it in the middle."""
    gear = {"face_width": "24 mm"}
    plane, _ = numbers(
        "flank-surface", "gear-mesh-power-loss", gear=gear, compliance=None, friction={"coefficient": 0.05}
    )
    wide, found = numbers(
        "flank-surface",
        "gear-mesh-power-loss",
        gear=gear,
        compliance=None,
        friction={"coefficient": 0.05},
        width="slices",
    )
    assert wide["loss_factor"] == pytest.approx(plane["loss_factor"], rel=0.05)
    path = columns(found, "flank_surface_I")
    assert np.nanmax(path["flash_temperature_mean"]) < np.nanmax(path["flash_temperature"])
    assert wide["largest_contact_temperature"] == pytest.approx(plane["largest_contact_temperature"], rel=0.25)
    assert "surface_map_I" in [figure.name for figure in found.figures]


def test_load_factors_come_from_iso_6336_where_gears_have_a_strength():
    """K_v, K_Hbeta and K_Halpha are those of the rating; without a strength they count as 1, and a note says so."""
    plain, without = numbers("flank-surface")
    assert any(
        "= 1 for scuffing and micropitting. Specify strength of both "
        "gears (ISO 6336-1) or operation.dynamic_factor, "
        "face_load_factor, transverse_load_factor." in remark
        for remark in without.remarks
    )
    gear = {"strength": {"material": "case-hardened-steel"}, "tolerance_class": 8}
    values, found = numbers("flank-surface", gear=gear)
    assert not any(
        "= 1 for scuffing and micropitting. Specify strength of "
        "both gears (ISO 6336-1) or operation.dynamic_factor, "
        "face_load_factor, transverse_load_factor." in remark
        for remark in found.remarks
    )
    table = columns(found, "surface_factors_I")
    factors = dict(zip(table["factor"].tolist()[:4], table["value"].tolist()[:4], strict=True))
    assert min(factors["K_v"], factors["K_Hbeta"], factors["K_Halpha"]) > 1.0
    assert values["S_B_iso"] < plain["S_B_iso"]
    given, told = numbers("flank-surface", gear=gear, operation={"dynamic_factor": 1.5})
    assert columns(told, "surface_factors_I")["value"][1] == 1.5
    assert given["S_B"] < values["S_B"]


def test_losses_under_every_load_are_those_of_each_load_alone():
    law = {"law": "schlenk"}
    alone, _ = numbers("gear-mesh-power-loss", friction=law, torque="60 N*m")
    values, found = numbers("gear-mesh-power-loss", friction=law, torque="60 N*m", loads=["500 N", "8000 N"])
    assert {key: values[key] for key in alone} == pytest.approx(alone, rel=1e-9)
    table = columns(found, "tooth_loss_loads_I")
    assert table["load"].size == 3
    assert (np.diff(table["tooth_loss"]) > 0.0).all()
    assert (np.diff(table["mean_friction"]) > 0.0).all()  # as load to the fifth root
    assert table["mean_friction"][2] / table["mean_friction"][0] == pytest.approx((8000.0 / 500.0) ** 0.2, rel=1e-9)
    assert table["tooth_loss"][1] == pytest.approx(alone["tooth_loss"], rel=1e-9)


@pytest.mark.dear
def test_a_helical_pair_shares_the_load_as_its_overlap_says():
    """X_Y of ISO/TS 6336-22 over the path: spur teeth's trapezium without buttressed ends was taken for any helix."""
    gear = {"module": None, "normal_module": "3 mm", "helix_angle": "15 deg", "face_width": "24 mm"}
    asked = case("flank-surface", gear=gear, width="slices", compliance=None)
    asked["gear"]["a"]["hand"], asked["gear"]["b"]["hand"] = "left", "right"
    asked["accuracy"] = {"tolerance": 1e-2}
    found = run(asked, progress=False)
    pair, path = found.scene.pairs["I"], columns(found, "flank_surface_I")
    peak = 1.0 + 0.3 * pair.overlap_ratio
    assert pair.overlap_ratio < 0.8
    near = (path["x"][0] - pair.x_start) / (pair.x_end - pair.base_pitch - pair.x_start)
    assert path["load_sharing_iso"][0] == pytest.approx(peak * (1.0 + near) / 3.0, rel=0.01)
    assert path["load_sharing_iso"].max() == pytest.approx(1.0)
    ratio = path["hertz_pressure_iso"] / path["hertz_pressure_nominal_iso"]
    assert ratio == pytest.approx(1.0)  # no load factors in this case
    assert any("overlap ratio 0.659" in text for text in found.remarks)


@pytest.mark.parametrize(("helix", "width", "solid"), [(None, "20 mm", 193.51), ("25 deg", "40 mm", 228.0)])
@pytest.mark.dear
def test_the_error_of_a_loss_by_coupled_slices_covers_the_loss_of_solid_gears(helix, width, solid):
    """Slices miss compliances, which no coarser solution of them shows: the stated error was 1e-6 of the loss."""
    size = {"module": "3 mm"} if helix is None else {"normal_module": "3 mm", "helix_angle": helix}
    asked = case(
        "gear-mesh-power-loss",
        gear={"module": None, "face_width": width} | size,
        effects={"hertz": "load-dependent", "neighbour_coupling": True},
        friction={"coefficient": 0.06},
        width="slices",
        compliance=None,
    )
    if helix is not None:
        asked["gear"]["a"]["hand"], asked["gear"]["b"]["hand"] = "left", "right"
    asked["accuracy"] = {"tolerance": 2e-2}
    found = run(asked, progress=False)
    values = {value.name: value for value in found.values}
    loss, factor = values["I.tooth_loss"], values["I.loss_factor"]
    assert abs(loss.value - solid) < loss.error < 0.06 * loss.value
    assert factor.error / factor.value == pytest.approx(loss.error / loss.value)


def test_force_that_moves_between_stations_changes_the_loss_by_no_more_than_stated():
    """Random softening of stations by up to 10 %, force from softer to stiffer: an own computation."""
    rng = np.random.default_rng(5)
    _, found = numbers("gear-mesh-power-loss", friction={"coefficient": 0.06})
    pair = found.scene.pairs["I"]
    x = rng.uniform(pair.x_start, pair.x_end, (3, 7))
    force = rng.uniform(0.0, 1.0, x.shape)
    lines = SimpleNamespace(x=x, present=np.ones(x.shape, dtype=bool), mean=lambda one: one.mean(axis=0))
    flanks = SimpleNamespace(
        lines=lines, pair=pair, contact=SimpleNamespace(force=force[:, :, None]), line_load=force[:, :, None]
    )
    bound = moved_at_most(flanks, 0, 150.0, lambda at, _load: np.full(at.sliding.shape, 0.06))
    sliding = np.abs(flank_speeds(pair, x, 150.0).sliding)
    loss = (force * sliding).sum()
    worst = 0.0
    for _ in range(200):
        softer = np.where(rng.uniform(size=x.shape) < 0.5, 0.1, 0.0)
        moved = -force * (softer - (force * softer).sum(axis=1, keepdims=True) / force.sum(axis=1, keepdims=True))
        assert moved.sum(axis=1) == pytest.approx(0.0, abs=1e-12)
        worst = max(worst, abs((moved * sliding).sum()) / loss)
    slow = sliding < ((force * sliding).sum(axis=1) / force.sum(axis=1))[:, None]
    moved = -force * 0.1 * (slow - (force * slow).sum(axis=1, keepdims=True) / force.sum(axis=1, keepdims=True))
    assert worst < 0.1 * bound
    assert (moved * sliding).sum() / loss == pytest.approx(0.1 * bound)  # and that much it can be
