"""The report and the pictures of a whole run: self-contained, readable, with every number that was computed."""

from __future__ import annotations

import base64
import html.parser
import io
import json
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import matplotlib.image
import meshio
import numpy as np
import pytest
import xarray as xr

from fegear.base.errors import MissingLibraryError
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import Silence, run_plan
from fegear.geometry import outline
from fegear.output.figures import described
from fegear.output.new_for_old import RECORD
from fegear.output.report.blocks import value_cells
from fegear.output.report.run import write_report
from fegear.output.run_files import write_results
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"


class PageParser(html.parser.HTMLParser):
    """Every attribute and every text of a page, and whether its tags close."""

    VOID = ("meta", "img", "br", "link", "input")

    def __init__(self, text: str):
        super().__init__()
        self.links, self.texts, self.open, self.images, self.plots = [], [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.links += [value for name, value in attrs if name in ("src", "href")]
        told = dict(attrs)
        if tag == "img":
            self.images.append(told["alt"])
        if tag == "div" and told.get("class") == "plot":
            self.plots.append(told["id"].removeprefix("plot-"))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    scene = read_scene(CASES / "lin_table1.toml", ["stiffness.positions=12"])
    results = run_plan(scene, make_plan(scene, STAGES))
    folder = tmp_path_factory.mktemp("run")
    write_results(results, folder, Silence())
    return results, folder


def report(folder: Path) -> PageParser:
    return PageParser((folder / "report.html").read_text(encoding="utf-8"))


def carried(page: PageParser) -> dict[str, bytes]:
    (link,) = (link for link in page.links if link.startswith("data:application/zip;base64,"))
    with zipfile.ZipFile(io.BytesIO(base64.b64decode(link.split(",")[1]))) as packed:
        return {name: packed.read(name) for name in packed.namelist()}


def test_the_page_stands_alone(made):
    _, folder = made
    page = report(folder)
    assert page.open == []
    assert all(link.startswith(("data:", "#")) for link in page.links)
    text = (folder / "report.html").read_text(encoding="utf-8")
    style = text.split("</style>")[0]
    assert "@import" not in style
    assert "url(" not in style
    assert "@media print" in style
    assert "prefers-color-scheme: dark" in style


def test_the_page_says_what_was_asked_computed_and_how_well(made):
    results, folder = made
    text = " ".join(report(folder).texts)
    for words in (
        "geometry, stiffness, root-stress",
        "Reason",
        "effects that are off",
        "Seconds",
        "Estimated error",
        "root edge length",
        "To cite fegear itself",
        results.scene.case.title,
    ):
        assert words in text
    for value in results.values:
        assert value.name in text
        told, error = value_cells(value)
        assert told in text
        assert error in text
    assert all(remark in text for remark in results.remarks)


def test_the_files_in_the_page_are_the_files(made):
    _, folder = made
    files = carried(report(folder))
    assert list(files) == [
        "tables/geometry.csv", "tables/mass_and_inertia.csv", "tables/gear_data_I.csv", "tables/stiffness_a.csv",
        "tables/neighbour_compliance_a.csv", "tables/neighbour_compliance_a.mat", "tables/root_stress_a.csv",
        "lin_table1.toml",
    ]  # fmt: skip
    for name, content in files.items():
        if name.startswith("tables/"):
            assert content == (folder / name).read_bytes()
    case = files["lin_table1.toml"].decode()
    assert case == "# --set stiffness.positions=12\n" + (CASES / "lin_table1.toml").read_text("utf-8")


def test_curves_are_plots_and_fields_are_pictures(made):
    _, folder = made
    page = report(folder)
    # the figure of the answer first, once; then those of the stages in their order
    assert page.plots == ["compliance_a", "tooth_a", "root_stress_a", "fillet_a", "gear_data_I", "estimated_errors"]
    assert [alt.split(".")[0] for alt in page.images] == ["Deformed gear a, 350 N/mm"]


def test_the_page_of_the_same_results_is_the_same_bytes(made, tmp_path):
    results, folder = made
    write_report(tmp_path / "again.html", results, described(results), [])
    write_report(tmp_path / "twice.html", results, described(results), [])
    assert (tmp_path / "again.html").read_bytes() == (tmp_path / "twice.html").read_bytes()
    assert carried(PageParser((tmp_path / "again.html").read_text("utf-8"))) == carried(report(folder))


@pytest.mark.dear
def test_the_report_needs_neither_plotly_nor_matplotlib_and_plane_gears_are_drawn_without_pyvista_and_plotly(tmp_path):
    (tmp_path / "report").mkdir()
    probe = (
        "import sys; from pathlib import Path; from fegear.case.reading import read_scene;"
        "from fegear.engine.run import *;"
        "from fegear.engine.plan import make_plan; from fegear.results.catalogue import STAGES;"
        "from fegear.output.run_files import write_results;"
        f"scene = read_scene({str(CASES / 'litvin_lead.toml')!r}, ['tooth_contact.positions=20']);"
        "results = run_plan(scene, make_plan(scene, STAGES));"
        f"write_results(results, Path({str(tmp_path / 'report')!r}), Silence(), plots=False);"
        "print(*[name for name in ('plotly', 'matplotlib', 'pyvista') if name in sys.modules]);"
        f"case = {str(CASES / 'lin_table1.toml')!r};"
        "scene = read_scene(case, ['stiffness.positions=3', 'accuracy.tolerance=0.5']);"
        f"write_results(run_plan(scene, make_plan(scene, STAGES)), Path({str(tmp_path)!r}), Silence());"
        "print(*[name for name in ('plotly', 'pyvista', 'vtkmodules') if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert run.stdout.split() == []
    assert (tmp_path / "report" / "report.html").is_file()
    assert (tmp_path / "plots" / "deformed_a.png").is_file()
    assert (tmp_path / "fields" / "a.vtu").is_file()


@pytest.mark.dear
def test_pictures_are_there_and_not_empty(made):
    _, folder = made
    names = {path.stem for path in (folder / "plots").iterdir()}
    assert names == {"gear_data_I", "tooth_a", "compliance_a", "root_stress_a", "fillet_a", "deformed_a"}
    for path in (folder / "plots").iterdir():
        image = matplotlib.image.imread(path)
        assert min(image.shape[:2]) > 500
        colours = np.unique((image[::3, ::3, :3].reshape(-1, 3) * 255).astype(int), axis=0)
        assert len(colours) > 40, path.name
        assert (image[..., :3].min(axis=2) < 0.97).mean() > 0.02, path.name


def test_fields_and_dataset_hold_the_same_run(made):
    results, folder = made
    field = meshio.read(folder / "fields" / "a.vtu")
    # 350 N/mm: the fillets carry about what the table says for a load at the pitch point.
    radius = np.hypot(field.points[:, 0], field.points[:, 1])
    below = (field.points[:, 1] > 0) & (radius < 41.5) & (np.abs(field.points[:, 0]) < 5) & (radius > 40.0)
    assert 200 < field.point_data["von_mises"][below].max() < 400
    with xr.open_dataset(folder / "results.nc") as data:
        assert data["stiffness_a.c_self"].sizes == {"stiffness_a": 12}
        assert data["stiffness_a.c_self"].attrs["units"] == "um.mm/N"
        for value in results.values:
            assert float(data[value.name]) == pytest.approx(value.value, rel=1e-15)


def test_the_summary_lists_every_file(made):
    _, folder = made
    listed = json.loads((folder / "summary.json").read_text())["files"]
    assert sorted(listed) == sorted(
        p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file() and p.name != RECORD
    )


def test_the_tool_envelops_the_tooth(made):
    results, _ = made
    shape = results.scene.gears["a"].tooth
    fillet = shape.fillet.points(np.linspace(shape.fillet.start, shape.fillet.end, 40))
    # Over all rolling positions the tool comes to within its own drawing's resolution of the fillet, never inside it.
    corner = np.hstack([outline.rack_in_gear(shape, phi)[:, 1:-1] for phi in np.linspace(-0.25, 0.25, 801)])
    distance = np.hypot(fillet[0][:, None] - corner[0], fillet[1][:, None] - corner[1]).min(axis=1)
    assert distance.max() < 0.02


@pytest.mark.dear
def test_a_picture_that_cannot_be_drawn_is_a_remark_not_a_failure(made, tmp_path, monkeypatch):
    def missing(*_arguments):
        raise MissingLibraryError("the deformed gear cannot be drawn; run: apt-get install libegl1")

    monkeypatch.setattr("fegear.fem.plane.loaded_gear.loaded_gear", missing)
    remarks = write_results(made[0], tmp_path, Silence())
    assert remarks[-1] == "the deformed gear cannot be drawn; run: apt-get install libegl1."
    assert re.search("apt-get install libegl1", (tmp_path / "report.html").read_text(encoding="utf-8"))
    assert not (tmp_path / "plots" / "deformed_a.png").exists()
