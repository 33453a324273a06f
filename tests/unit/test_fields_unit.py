"""Fields of a run: files that other programs read, named where a user sees them, and the loaded tooth in space."""

from __future__ import annotations

import re

import meshio
import numpy as np
import pytest
import pyvista
from in_process import fegear

from fegear.case.reading import build_scene
from fegear.engine.figure.figure import Figure
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.output.fields import field_file, in_space
from fegear.results.catalogue import STAGES

CASE = """
results = ["root-stress"]
accuracy = { tolerance = 0.1 }

[gear.a]
teeth = 17
module = "2 mm"
bore_radius = "8 mm"
face_width = "12 mm"

[stiffness]
positions = 3
contact_half_width = "0.05 mm"
"""


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """What a run without pictures says, and its folder."""
    folder = tmp_path_factory.mktemp("fields")
    (folder / "case.toml").write_text(CASE)
    return fegear("run", "case.toml", "--fields", "--no-plots", "--out", "out", cwd=folder), folder / "out"


@pytest.fixture(scope="module")
def deformed(tmp_path_factory) -> tuple[Figure, object]:
    """The figure of the deformed gear, and the gear."""
    document = {
        "results": ["root-stress"],
        "accuracy": {"tolerance": 0.1},
        "gear": {"a": {"teeth": 17, "module": "2 mm", "bore_radius": "8 mm", "face_width": "12 mm"}},
        "stiffness": {"positions": 3, "contact_half_width": "0.05 mm"},
    }
    scene = build_scene(document, "fields", tmp_path_factory.mktemp("deformed"))
    outcome = run_plan(scene, make_plan(scene, STAGES)).outcomes[Task("root-stress", "a")]
    (figure,) = (one for one in outcome.figures if one.name == "deformed_a")
    return figure.made(), scene.gears["a"]


def test_a_run_names_the_file_of_a_field_and_what_it_holds(written):
    said, folder = written
    assert said.returncode == 0, said.stderr
    (line,) = re.findall(r"^Field .*$", said.stdout, re.MULTILINE)
    assert "fields/a.vtu: displacement [mm], von_mises [MPa] at the nodes under" in line
    assert [path.name for path in (folder / "fields").iterdir()] == ["a.vtu"]
    assert not (folder / "plots").exists()


def test_meshio_and_pyvista_read_the_same_field_from_it(written):
    path = written[1] / "fields" / "a.vtu"
    one, other = meshio.read(path), pyvista.read(path)
    np.testing.assert_array_equal(one.points, other.points)
    assert set(one.cells_dict) == {"triangle6"}
    assert len(one.cells_dict["triangle6"]) == other.n_cells
    for name in ("displacement", "von_mises"):
        np.testing.assert_array_equal(one.point_data[name], other.point_data[name])
    radius = np.hypot(*one.points.T[:2])
    moved = np.hypot(*one.point_data["displacement"].T[:2])
    assert radius.min() == pytest.approx(8.0, rel=1e-6)
    assert moved[radius < 8.0 * (1.0 + 1e-6)].max() == 0.0  # the bore is fixed
    # The loaded tooth stands along +y: it moves most, and the stress is where its fillets and the contact are.
    x, y, _ = one.points[moved.argmax()]
    assert y > 0.9 * radius.max()
    assert abs(x) < 2.0
    assert one.points[one.point_data["von_mises"].argmax()][1] > 12.0


def test_without_a_field_a_note_says_what_to_request(tmp_path):
    (tmp_path / "case.toml").write_text(CASE.replace("root-stress", "geometry"))
    said = fegear("run", "case.toml", "--fields", "--no-plots", "--out", "out", cwd=tmp_path)
    assert said.returncode == 0
    assert (
        "No requested result has a field: request root-stress, or stiffness with face_positions."
    ) in said.stdout + said.stderr


def test_the_report_names_the_field(written):
    page = (written[1] / "report.html").read_text("utf-8")
    assert "fields/a.vtu: displacement [mm], von_mises [MPa] at the nodes under" in page


def test_the_loaded_tooth_in_space_is_a_closed_body_as_wide_as_the_face(deformed):
    figure, gear = deformed
    spatial = in_space(figure, gear)
    (skin,) = spatial.panels[0].items
    assert spatial.key == "deformed_a_in_space"
    assert spatial.field is None
    assert sorted(set(skin.points[2].tolist())) == [-6.0, 6.0]
    sides = np.hstack([skin.triangles[[a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    _, times = np.unique(np.sort(sides, axis=0), axis=1, return_counts=True)
    assert set(times.tolist()) == {2}  # closed
    assert skin.values.max() > 0.5 * skin.top  # the loaded tooth is among those that are shown
    front, back = np.split(skin.values, 2)
    assert (front == back).all()
    assert skin.values.size == skin.points.shape[1]
    assert skin.points[1].min() > 0.0


def test_a_figure_without_a_field_has_nothing_in_space(deformed):
    _, gear = deformed
    assert in_space(Figure("none", "None", ""), gear) is None
    assert field_file(Figure("none", "None", "")) is None
