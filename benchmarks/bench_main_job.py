"""What the main job costs, with its peers beside it: run ``pytest benchmarks/bench_main_job.py``.

The job: 100 load positions with c_-1, c_0, c_1 and both root stresses of a 28-tooth gear. Peers solve the same gear
whole, on the same mesh: scikit-fem assembles and factors all 28 teeth, CalculiX solves the exported deck (one load).
Beside it: one tooth's mesh, one sparse factorization and the triangular solves for 100 loads.
"""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.plane.elasticity import assemble
from fegear.fem.plane.loaded_gear import loaded_gear
from fegear.fem.plane.settings import level_for, settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.table import stiffness_table
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.whole_gear import whole_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.output.plane_mesh_files import write_inp

CASE = Path(__file__).parents[1] / "cases" / "lin_table1.toml"
SETTINGS = settings_at(level_for(1e-3))


def gear_of(teeth: int) -> Gear:
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25))
    return Gear(tooth, 3.175e-3, 0.5 * tooth.root_radius * 3.175e-3, 25.4e-3)


def radii(gear: Gear) -> np.ndarray:
    return np.linspace(gear.form_radius, gear.tip_radius, 100)


@pytest.mark.parametrize("plots", [False, True], ids=["without pictures", "with pictures"])
def test_cold_run(benchmark, tmp_path, plots):
    command = [sys.executable, "-c", "from fegear.cli import main; main()", "run", str(CASE), "--out", str(tmp_path)]
    if not plots:
        command.append("--no-plots")
    benchmark.pedantic(lambda: subprocess.run(command, check=True, capture_output=True), rounds=3)
    benchmark.extra_info["largest resident set of all runs so far [MB]"] = (
        resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
    )
    assert (tmp_path / "summary.json").is_file()


@pytest.mark.parametrize("teeth", [20, 28, 200])
@pytest.mark.parametrize("estimate", [False, True], ids=["one solution", "with error estimate"])
def test_numerical_core(benchmark, teeth, estimate):
    gear = gear_of(teeth)
    positions = radii(gear)

    def job():
        return stiffness_table(gear, positions, 0.08e-3, influence=solve_gear(gear, SETTINGS, estimate_error=estimate))

    table = benchmark.pedantic(job, rounds=5, warmup_rounds=1)
    assert np.isfinite(table.c_self).all()


def test_bare_limit(benchmark):
    """Mesh one tooth, factor once, solve for 100 loads."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.linalg import splu

    gear = gear_of(28)

    def job():
        mesh = mesh_sector(gear.tooth, gear.bore_radius / gear.module, SETTINGS)
        elasticity = assemble(mesh, 0.3, "strain", 2)
        held = np.unique(elasticity.edge_dofs["bore"])
        inner = np.setdiff1d(np.arange(elasticity.size), held)
        dofs, k = elasticity.element_dofs, elasticity.stiffness
        rows, columns = (np.broadcast_to(d, k.shape).reshape(-1) for d in (dofs[:, :, None], dofs[:, None]))
        whole = coo_matrix((k.reshape(-1), (rows, columns))).tocsc()
        matrix = whole[inner][:, inner].tocsc()
        options = {"SymmetricMode": True}
        factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", options=options, diag_pivot_thresh=0.0)
        return factor.solve(np.eye(inner.size, 100))

    assert np.isfinite(benchmark.pedantic(job, rounds=5, warmup_rounds=1)).all()


def test_peer_scikit_fem_on_the_whole_gear(benchmark):
    """Assemble and factor all 28 teeth on the same mesh, solve for 100 loads."""
    import skfem
    from scipy.sparse.linalg import splu
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    gear = gear_of(28)
    whole = whole_gear(mesh_sector(gear.tooth, gear.bore_radius / gear.module, SETTINGS))

    def job():
        corners, local = np.unique(whole.triangles[:3], return_inverse=True)
        grid = skfem.MeshTri(whole.points[:, corners], local.reshape(3, -1))
        basis = skfem.Basis(grid, skfem.ElementVector(skfem.ElementTriP2()))
        stiffness = linear_elasticity(*lame_parameters(1.0, 0.3)).assemble(basis)
        bore = float(gear.bore_radius / gear.module)
        held = basis.get_dofs(lambda x: np.hypot(*x) < bore * 1.0001).all()
        inner = np.setdiff1d(np.arange(stiffness.shape[0]), held)
        factor = splu(stiffness[inner][:, inner].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        return factor.solve(np.eye(inner.size, 100))

    assert np.isfinite(benchmark.pedantic(job, rounds=1)).all()


def test_peer_calculix_on_the_whole_gear_one_load(benchmark, tmp_path):
    ccx = shutil.which("ccx")
    assert ccx, "install calculix-ccx"
    whole, field = loaded_gear(gear_of(28), SETTINGS)
    write_inp(tmp_path / "g.inp", gear_of(28), whole, field.forces)
    benchmark.pedantic(lambda: subprocess.run([ccx, "g"], cwd=tmp_path, check=True, capture_output=True), rounds=1)
    assert (tmp_path / "g.frd").is_file()
