"""cases/litvin_under_load.toml: rigid and loaded flanks of one misaligned drive in one run."""

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES
from fegear.results.helical.tooth_contact import TOOTH_CONTACT

ARCSEC = math.pi / 648000.0
CASE = Path(__file__).parents[2] / "cases" / "litvin_under_load.toml"


@pytest.fixture(scope="module")
def analysis():
    asked = TOOTH_CONTACT.inputs(read_scene(CASE, ("tooth_contact.positions=24",)), "I")
    return TOOTH_CONTACT.compute(asked, {}, None)


def names_of(analysis, *options):
    """Values and figures of the tooth contact analysis, and its remarks."""
    asked = TOOTH_CONTACT.inputs(read_scene(CASE, options), "I")
    outcome = TOOTH_CONTACT.present(analysis, asked)
    return {v.name for v in outcome.values}, {f.key for f in outcome.figures}, outcome.remarks


@pytest.mark.parametrize("options", [(), ('results=["tooth-contact"]',)])
def test_what_loaded_flanks_have_too_is_called_unloaded(analysis, options):
    """Whatever else the case asks for: two results may not have one name, and none may change with another."""
    values, figures, remarks = names_of(analysis, *options)
    assert {"I.unloaded_te_peak_to_peak", "I.unloaded_te_max", "I.unloaded_te_min"} <= values
    assert {"unloaded_transmission_error_I", "unloaded_contact_pattern_I"} <= figures
    assert any("load is ignored in tooth contact analysis" in remark for remark in remarks)


@pytest.mark.long
def test_edge_contacts_relax_into_bands():
    scene = read_scene(CASE)
    results = run_plan(scene, make_plan(scene, STAGES))
    tables = {t.name: {c.name: np.asarray(c.values) for c in t.columns} for t in results.tables}
    loads = tables["load_distribution_loads_I"]
    assert (np.diff(loads["load"]) > 0.0).all()
    assert (np.diff(loads["K_Hbeta"]) < 0.0).all()
    assert loads["K_Hbeta"][0] > 10.0
    assert loads["K_Hbeta"][-1] < 1.5
    # Under the lightest load the transmission error is that of rigid flanks and some deflection of edges.
    values = {v.name: v.value for v in results.values}
    rigid = values["I.unloaded_te_peak_to_peak"] * ARCSEC * scene.helical_pairs["I"].gear.base_radius
    assert loads["te_peak_to_peak"][0] * 1e-6 == pytest.approx(rigid, rel=0.1)
