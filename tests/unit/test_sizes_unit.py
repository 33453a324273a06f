"""What is too large to be computed is refused before anything is solved, and the refusal says how large it is."""

from __future__ import annotations

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.settings import FINEST_LEVEL, MeshSettings, settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.table import stiffness_table
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.studies.sweep import Axis, sweep_case

CASE = {
    "results": ["geometry"],
    "gear": {"a": {"teeth": 20, "module": "1 mm"}},
    "pair": {"I": {"driver": "a", "driven": "a", "load": "100 N"}},
}


def lengths(n: int) -> list[str]:
    return [f"{i + 1} um" for i in range(n)]


@pytest.mark.dear("part4-100,001 load positions")
@pytest.mark.parametrize(
    ("part", "words"),
    [
        ({"pair": {"I": {"driver": "a", "driven": "a", "loads": [f"{i + 1} N" for i in range(2000)]}}}, "2,000 loads"),
        ({"design": {"chart": {"amounts": lengths(500), "lengths": [0.1 + i / 1000 for i in range(500)]}}},
         "500 x 500 = 250,000 candidates"),
        ({"design": {"robustness": {"load_factors": [1 + i / 1e3 for i in range(400)],
                                    "spacing_errors": lengths(400)}}}, "400 x 400 x 3 = 480,000 combinations"),
        ({"study": {"teeth": list(range(20, 220)), "profile_shift": [i / 1000 for i in range(100)]}},
         "200 x 100 = 20,000 gears"),
        ({"stiffness": {"gear": "a", "radii": ["1 mm"] * 100_001}}, "100,001 load positions"),
        ({"accuracy": {"tip_edge_length": 1e-9}}, "greater than or equal to"),
    ],
)  # fmt: skip
def test_requests_beyond_measure_are_refused_with_their_size(part, words, tmp_path):
    with pytest.raises(InputError, match=words):
        build_scene(CASE | part, "case", tmp_path)


def test_meshes_beyond_measure_are_refused_with_their_size():
    for one in ({"root_edge_length": 1e-5}, {"flank_edge_length": 1e-5}, {"body_fraction": 1e-3}, {"growth": 1e-5}):
        with pytest.raises(InputError, match=r"requires about .* triangles"):
            MeshSettings(**one)
    settings_at(FINEST_LEVEL)


@pytest.mark.parametrize(
    "settings",
    [MeshSettings(), settings_at(-3), MeshSettings(root_edge_length=0.01), MeshSettings(flank_edge_length=0.01),
     MeshSettings(growth=0.05), MeshSettings(tip_growth=0.1), MeshSettings(tip_edge_length=1e-4)],
)  # fmt: skip
def test_the_expected_number_of_triangles_is_near(settings):
    made = mesh_sector(Tooth(28), 5.0, settings).triangles.shape[1]
    assert made / 2 < settings.expected_triangles < 3 * made


def test_a_sweep_beyond_measure_is_refused_before_its_grid_is_made(tmp_path):
    (tmp_path / "case.toml").write_text('results = ["geometry"]\n[gear.a]\nteeth = 20\nmodule = "1 mm"\n')
    axes = [Axis(f"gear.a.{key}", tuple(range(1000)), None) for key in ("teeth", "profile_shift")]
    with pytest.raises(InputError, match="1,000 x 1,000 = 1,000,000"):
        sweep_case(tmp_path / "case.toml", axes)


def test_many_positions_take_memory_by_the_block(monkeypatch):
    """All at once 100,000 positions would take 75 GB for each neighbour, which comes as a matrix."""
    gear = Gear(Tooth(20, BasicRack()), 1e-3, 5e-3, 1e-3)
    known = solve_gear(gear, MeshSettings().scaled(2.0))
    radii, sizes, neighbour = np.linspace(9.8e-3, 10.8e-3, 1500), [], Influence.neighbour

    def spied(self, k, p, q, patch, *more):
        sizes.append(np.size(p))
        return neighbour(self, k, p, q, patch, *more)

    monkeypatch.setattr(Influence, "neighbour", spied)
    table = stiffness_table(gear, radii, 2e-5, influence=known)
    assert max(sizes) <= 512
    assert sum(sizes) >= 3 * radii.size  # both neighbours, and one of them by the coarser solution
    few = stiffness_table(gear, radii[::250], 2e-5, influence=known)
    for name in ("c_self", "c_prev", "c_next", "root_tension", "root_compression_radius"):
        np.testing.assert_allclose(getattr(table, name)[::250], getattr(few, name), rtol=1e-12)
    assert set(table.errors) == {"c_self", "c_neighbour", "root_tension", "root_compression"}
