"""The mesh table of the gears of ROSS' own example, given to ROSS, has the example's natural frequencies.

What ROSS 2.3.0 answers over the mesh stiffness is kept (make_ross_frequencies.py): between the kept stiffnesses its
frequencies are smooth. The case is that of docs/how-to/mesh-in-ross.md.
"""

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator
from scipy.io import loadmat

import fegear

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "how-to" / "mesh-in-ross.md"
KEPT = json.loads((HERE / "ross_frequencies.json").read_text())


def test_ross_fed_with_the_table_keeps_its_example_s_frequencies(tmp_path):
    case = tomllib.loads(re.search(r"```toml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)[1])
    fegear.run(case, progress=False).save(tmp_path, plots=False)
    mesh = loadmat(tmp_path / "tables" / "mesh_table_I.mat", simplify_cells=True)
    assert mesh["units"]["local_stiffness"] == "N/um"
    stiffness = 1e6 * mesh["local_stiffness"].mean()
    assert stiffness == pytest.approx(1e8, rel=2e-3)  # the face width is chosen so
    grid = np.array([float(k) for k in KEPT["frequencies"]])
    example = np.array(KEPT["frequencies"]["1e+08"])
    found = PchipInterpolator(np.log(grid), np.array([*KEPT["frequencies"].values()]))(np.log(stiffness))
    assert found[0] == pytest.approx(KEPT["printed"], abs=1e-3)
    np.testing.assert_allclose(found, example, rtol=1e-4)
    # the fifth would not be kept by a table in other units or of half the gears: half the stiffness moves it by 4 %
    assert KEPT["frequencies"]["5e+07"][4] == pytest.approx(0.959 * example[4], rel=2e-3)
