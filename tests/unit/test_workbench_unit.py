"""fegear from Python: what a run gives, and how it is refused; no finite elements are solved here."""

from __future__ import annotations

import ast
import json
import math
import os
import re
import subprocess
import sys
import tomllib
import types
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError, MissingLibraryError
from fegear.base.units import from_si, registry
from fegear.engine.stage import Task
from fegear.workbench.mesh_curve import curve_of

CASE = Path(__file__).parents[2] / "cases" / "pinion_and_wheel.toml"
QUICK = {"pair.I.compliance": {"source": "weber-banaschek"}, "effects.neighbour_coupling": False}
WANTED = ["geometry", "tooth-geometry-check", "load-sharing", "transmission-error"]


@pytest.fixture(scope="module")
def found():
    return fegear.run(CASE, QUICK, results=WANTED)


@pytest.fixture(scope="module")
def folder(found, tmp_path_factory):
    return found.save(tmp_path_factory.mktemp("saved") / "run", plots=False)


def test_the_top_shows_its_names_and_each_is_there():
    assert dir(fegear) == sorted(fegear.__all__)
    for name in fegear.__all__:
        assert getattr(fegear, name) is not None
    with pytest.raises(AttributeError, match="has no attribute 'runn'"):
        fegear.runn  # noqa: B018


def test_type_checkers_know_the_names_of_the_top():
    tree = ast.parse(Path(fegear.__file__).read_text("utf-8"))
    block = next(node for node in tree.body if isinstance(node, ast.If))
    typed = {name.name: node.module for node in block.body for name in node.names if node.module != "typing"}
    assert typed == {name: f"fegear.{home}" for name, home in fegear._HOMES.items()}
    assert {*typed, "__version__"} == set(fegear.__all__)


def test_results_are_had_by_name_or_a_default(found):
    for named in (found.values, found.tables, found.figures):
        name = named.keys()[0]
        assert named.get(name) is named[name]
        assert named.get("no such thing") is None
        assert named.get("no such thing", 7.0) == 7.0


def test_importing_fegear_loads_none_of_its_own_packages():
    probe = (
        "import sys, fegear; dir(fegear);"
        "print([name for name in sys.modules if name.startswith('fegear.') or name == 'typing'])"
    )
    ran = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert ran.stdout.strip() == "[]"


def test_a_case_is_a_file_a_text_or_a_mapping(found):
    text = CASE.read_text("utf-8")
    for case in (str(CASE), text, tomllib.loads(text)):
        again = fegear.run(case, QUICK, results=["transmission-error"])
        assert again.values["I.te_mean"].si == found.values["I.te_mean"].si
    assert fegear.run(text, {"gear.pinion.teeth": 24}, results="geometry").scene.text.startswith("# changed: gear.")


def test_the_mapping_of_the_caller_stays_as_it_was():
    document = tomllib.loads(CASE.read_text("utf-8"))
    before = json.dumps(document)
    fegear.run(document, {**QUICK, "gear.pinion.teeth": 24}, results=["geometry"])
    assert json.dumps(document) == before


def test_changes_take_numbers_texts_and_pint(found):
    import pint

    torque = pint.UnitRegistry().Quantity(90.0, "newton * meter")
    again = fegear.run(CASE, {**QUICK, "pair.I.torque": torque}, results=["transmission-error"])
    assert again.values["I.te_mean"].si == found.values["I.te_mean"].si
    with pytest.raises(InputError, match="is not a torque"):
        fegear.run(CASE, {**QUICK, "pair.I.torque": pint.UnitRegistry().Quantity(90.0, "newton")})


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"pair.I.torqe": "90 N*m"}, r'"torqe" is an unknown key; did you mean "torque"'),
        ({"pair.I.torque": 90.0}, "has no unit; a torque requires one"),
        ({"results": ["transmision-error"]}, 'did you mean "transmission-error"'),
    ],
)
def test_a_slip_is_refused_with_the_remedy(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        fegear.run(CASE, changes)


def test_things_are_found_by_name_and_place(found):
    assert found.tables["geometry"] is not None
    assert found.tables["geometry"].name == found.tables[0].name == found["geometry"].name
    assert found["I.contact_ratio"].value == found.values["I.contact_ratio"].value
    assert "geometry" in found.tables
    assert "nothing" not in found.tables
    assert found.figures["load_sharing_I"].made().title
    for wrong, right in (("I.contact_rato", "I.contact_ratio"), ("geomtry", "geometry")):
        with pytest.raises(KeyError, match=f'did you mean "{right}"'):
            found[wrong]


def test_short_forms_are_short(found):
    assert len(repr(found).splitlines()) < 25
    assert repr(found).startswith("Pinion and wheel")
    assert "I.centre_distance = 120.589 mm" in repr(found)
    assert all(len(repr(table)) < 400 for table in found.tables)
    assert "Note: " in repr(found)
    assert repr(found.plot("load_sharing_I")).startswith("1 figure; ")


def test_a_notebook_shows_values_tables_and_figures(found, monkeypatch):
    page = found._repr_html_()
    assert "I.centre_distance" in page
    assert all(table.name in page for table in found.tables)
    table = found.tables["transmission_error_I"]._repr_html_()
    assert table.count("<tr>") == 11
    assert "x [mm]" in table
    plots = found.plot("load_sharing_I", "transmission_error_I")
    assert plots._repr_html_().count("data:image/png;base64,") == 2
    drawn = []
    monkeypatch.setitem(sys.modules, "IPython", types.ModuleType("IPython"))
    display = types.ModuleType("IPython.display")
    display.display = drawn.append
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    plots._ipython_display_()
    assert [figure.key for figure in drawn] == ["load_sharing_I", "transmission_error_I"]
    assert set(drawn[0]._repr_mimebundle_()) == {"text/html", "application/vnd.plotly.v1+json"}


def test_a_notebook_shows_the_progress_in_one_line(monkeypatch):
    class Handle:
        said: list[str] = []  # noqa: RUF012

        def update(self, data, raw):
            assert raw
            self.said.append(data["text/plain"])

    display = types.ModuleType("IPython.display")
    display.display = lambda *given, **how: Handle()
    monkeypatch.setitem(sys.modules, "IPython", types.ModuleType("IPython"))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    monkeypatch.setitem(sys.modules, "ipykernel", types.ModuleType("ipykernel"))
    fegear.run(CASE, QUICK, results=["geometry", "transmission-error"])
    assert Handle.said[0] == "[1/3] Geometry"
    assert re.fullmatch(r"3 steps in [\d.]+ s", Handle.said[-1])


def test_pandas_has_what_the_csv_has(found, folder):
    pandas = pytest.importorskip("pandas")
    for table in found.tables:
        numbers = {c.head: [""] for c in table.columns if c.si.dtype.kind == "f"}
        written = pandas.read_csv(folder / "tables" / f"{table.name}.csv", keep_default_na=False, na_values=numbers)
        pandas.testing.assert_frame_equal(
            table.to_pandas(), written, check_dtype=False, check_exact=False, rtol=1e-11, atol=0.0
        )


def test_every_number_is_in_the_unit_beside_it(found, folder):
    """The contract's files and what Python hands out agree, number for number."""
    summary = json.loads((folder / "summary.json").read_text("utf-8"))["results"]
    assert set(summary) == set(found.values.keys())
    for value in found.values:
        assert (summary[value.name]["value"], summary[value.name]["unit"]) == (value.value, value.unit)
        assert summary[value.name]["error"] == value.error
        assert value.value == pytest.approx(value.si * (from_si(value.unit) if value.unit else 1.0), rel=1e-15)
        assert value.quantity.to_base_units().magnitude == pytest.approx(value.si, rel=1e-12, abs=0.0)
    for table in found.tables:
        head, *rows = (folder / "tables" / f"{table.name}.csv").read_text("utf-8").splitlines()
        assert head.split(",")[0] == table.columns[0].head
        for column in table.columns:
            if column.unit:
                written = [float(row.split(",")[table.columns.index(column)]) for row in rows]
                assert written == pytest.approx(table[column.name], rel=1e-11)
                assert column.si * from_si(column.unit) == pytest.approx(table[column.name], rel=1e-15)


def test_pandas_has_every_value(found):
    pytest.importorskip("pandas")
    frame = found.to_pandas()
    assert frame.loc["I.te_mean", "value"] == found.values["I.te_mean"].value
    assert frame.loc["I.te_mean", "unit"] == "um"
    assert len(fegear.Gear(20, "3 mm").data.to_pandas()) == len(fegear.Gear(20, "3 mm").data.values)


def test_xarray_has_every_table_and_value(found):
    pytest.importorskip("xarray")
    data = found.to_xarray()
    for value in found.values:
        assert float(data[value.name]) == pytest.approx(value.value, rel=1e-15)
    te = found.tables["transmission_error_I"]
    assert np.array_equal(data["transmission_error_I.te"].values, te["te"])


@pytest.mark.dear
def test_xarray_finds_a_row_of_a_table_by_its_place(found):
    pytest.importorskip("xarray")
    data, te = found.to_xarray("transmission_error_I"), found.tables["transmission_error_I"]
    assert list(data.indexes) == ["x"]
    nearest = int(np.abs(te["x"] - 1.5).argmin())
    assert data["te"].sel(x=1.5, method="nearest").item() == te["te"][nearest]
    assert data["te"].attrs["units"] == "um"
    assert list(found.to_xarray("tooth_geometry_check").sizes) == ["row"]
    with pytest.raises(KeyError, match='did you mean "transmission_error_I"'):
        found.to_xarray("transmission_eror_I")


def test_any_table_is_written_for_spreadsheets_and_for_matlab_and_read_without_pandas(found, tmp_path):
    from scipy.io import loadmat

    (tmp_path / "mine.txt").write_text("mine", "utf-8")
    made = found.save_tables(tmp_path, "csv, mat", ("transmission_error_I",))
    assert [path.name for path in made] == ["transmission_error_I.csv", "transmission_error_I.mat"]
    assert (tmp_path / "mine.txt").exists()
    table, read = found.tables["transmission_error_I"], loadmat(made[1], simplify_cells=True)
    np.testing.assert_array_equal(read["te"], table["te"])
    assert read["units"]["te"] == "um"
    assert len(found.save_tables(tmp_path / "all", "mat")) == len(found.tables)
    rows = table.rows()
    assert (len(rows), rows[3]["te [um]"]) == (len(table), table["te"][3])
    with pytest.raises(InputError, match='use "csv", "mat"'):
        found.save_tables(tmp_path, "xls")


def test_names_of_columns_become_variables_of_matlab(tmp_path):
    from io import BytesIO

    from scipy.io import loadmat

    from fegear.engine.table import Column, Table
    from fegear.output.tables import table_bytes

    names = ["te.peak to peak", "te_peak_to_peak", "2nd", "title", "n" * 70, "n" * 69 + "o", "α"]
    table = Table("t", tuple(Column(name, np.array([float(k)])) for k, name in enumerate(names)))
    read = loadmat(BytesIO(table_bytes(table, "mat")), simplify_cells=True)
    found = {name: int(value) for name, value in read.items() if isinstance(value, float)}
    assert found == {
        "te_peak_to_peak": 0, "te_peak_to_peak_2": 1, "x2nd": 2, "title_2": 3, "n" * 63: 4, "n" * 61 + "_2": 5, "x_": 6,
    }  # fmt: skip


def test_few_rows_of_many_columns_stand_on_their_side_in_a_notebook():
    from fegear.engine.table import Column, Table

    wide = Table("t", tuple(Column(f"c{k}", np.array([1.0, 2.0]), "mm") for k in range(9)))
    assert wide._repr_html_().count("<tr>") == 10
    assert "<td style='text-align:left'>c8 [mm]</td>" in wide._repr_html_()
    assert Table("t", wide.columns[:8])._repr_html_().count("<tr>") == 3


@pytest.mark.parametrize(
    ("library", "ask"), [("pandas", lambda r: r.tables[0].to_pandas()), ("xarray", lambda r: r.to_xarray())]
)
def test_a_missing_library_is_one_sentence(found, library, ask, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingLibraryError, match=rf"^{library} is not installed; install it with: pip install"):
        ask(found)


def test_figures_are_written_and_opened(found, tmp_path, monkeypatch):
    made = found.plot("load_sharing_I").save(tmp_path / "pictures", "svg")
    assert [path.name for path in made] == ["load_sharing_I.svg"]
    assert made[0].read_text("utf-8").lstrip().startswith("<?xml")
    with pytest.raises(InputError, match='choose "png", "svg" or "pdf"'):
        found.plot("load_sharing_I").save(tmp_path, "eps")
    (printed,) = found.plot("load_sharing_I").save(tmp_path, "pdf")
    assert printed.read_bytes().startswith(b"%PDF")
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    found.plot("load_sharing_I", "transmission_error_I").show()
    page = Path(opened[0].removeprefix("file://"))
    assert page.read_text("utf-8").count("plotly.js v") == 1  # the library once for both
    assert page.read_text("utf-8").count("Plotly.newPlot(") == 2
    page.unlink()


def test_drawings_are_exported(found, tmp_path):
    made = found.export(tmp_path / "drawings", "dxf", ("pinion",))
    assert [path.name for path in made] == [
        "pinion_tooth_polyline.dxf", "pinion_gear_polyline.dxf", "pinion_tooth_spline.dxf", "pinion_gear_spline.dxf",
    ]  # fmt: skip
    assert all(path.is_file() for path in made)


def test_a_run_keeps_linear_algebra_to_one_thread_and_gives_it_back():
    """scipy's own library too, which a script has not loaded when it calls fegear for the first time."""
    probe = (
        "import numpy, fegear, fegear.workbench.run as module\n"
        "from threadpoolctl import threadpool_info\n"
        "def threads():\n"
        "    import scipy.linalg\n"
        "    return sorted({pool['num_threads'] for pool in threadpool_info()})\n"
        "plan, inside = module.run_plan, []\n"
        "module.run_plan = lambda *given, **how: (inside.append(threads()), plan(*given, **how))[1]\n"
        "fegear.Gear(20, '3 mm').data\n"
        "print(inside, threads())\n"
    )
    threads = {f"{library}_NUM_THREADS": "2" for library in ("OMP", "OPENBLAS", "MKL")}
    ran = subprocess.run(
        [sys.executable, "-c", probe], capture_output=True, text=True, check=True, env={**os.environ, **threads}
    )
    assert ran.stdout.strip() == "[[1]] [2]"


def test_a_silent_run_writes_nothing(capfd):
    fegear.run(CASE, QUICK, results=["geometry"])
    assert capfd.readouterr() == ("", "")
    fegear.run(CASE, QUICK, results=["geometry"], progress=True)
    assert "Geometry" in capfd.readouterr().err


def test_an_exact_value_has_an_error_of_zero(found):
    assert found.values["I.contact_ratio"].error == 0.0
    assert math.isfinite(found.values["I.te_mean"].value)


def test_flanks_of_a_pair_are_divided_as_it_says():
    helical = {"normal_module": "3 mm", "helix_angle": "15 deg", "face_width": "12 mm"}
    gears = [fegear.Gear(20, hand=hand, name=hand, **helical) for hand in ("right", "left")]
    fine = fegear.Pair(*gears, load_distribution={"positions": 24})
    assert fine.document(load="1 kN")["load_distribution"] == {"positions": 24}
    assert "load_distribution" not in fegear.Pair(*gears).document(load="1 kN")
    assert fine != fegear.Pair(*gears)
    assert "load_distribution={'positions': 24}" in repr(fine)
    with pytest.raises(InputError, match="load_distribution"):
        fegear.Pair(*gears, load_distribution={"places": 24})


def test_mesh_stiffness_and_transmission_error_are_functions_of_the_rotation(found):
    """At the rows of the table, and a number of teeth later; the straight line between two of them."""
    table = found.tables["transmission_error_I"]
    pair = found.scene.pairs["I"]
    columns = {column.name: column.si for column in table.columns}
    x, slope, secant, te = (columns[name] for name in ("x", "local_stiffness", "mesh_stiffness", "te"))
    middle = slice(5, 60)
    # the zero is that of the column driver_angle, the pitch point: the curve was counted from its first row
    angle = columns["driver_angle"][middle] + 3.0 * 2.0 * np.pi / pair.driver.teeth
    assert found.transmission_error(0.0) == pytest.approx(np.interp(0.0, x, te), rel=1e-6)
    np.testing.assert_allclose(found.mesh_stiffness(angle), slope[middle], rtol=1e-6)
    np.testing.assert_allclose(found.mesh_stiffness(angle, "I", secant=True), secant[middle], rtol=1e-6)
    np.testing.assert_allclose(found.transmission_error(angle), te[middle], rtol=1e-6)
    with pytest.raises(InputError, match='pair = "II": has no mesh stiffness in these results; known here: I'):
        found.mesh_stiffness(0.0, "II")


def test_rotations_have_units(found):
    """Degrees of pint were taken for radians, None for an angle of its own."""
    wanted = found.mesh_stiffness(np.radians([[3.0, 5.0]]))
    degrees = registry().Quantity(np.array([[3.0, 5.0]]), "deg")
    for given in (degrees, [["3 deg", degrees[0, 1]]], np.radians([[3.0, 5.0]]).tolist()):
        np.testing.assert_allclose(found.mesh_stiffness(given), wanted, rtol=1e-12)
    assert found.transmission_error("5 deg") == pytest.approx(found.transmission_error(math.radians(5.0)), rel=1e-12)
    assert found.transmission_error(np.float32(0.0)) == found.transmission_error(0) == found.transmission_error(0.0)
    for wrong in (None, [0.1, None], True, [[0.1], [0.1, 0.2]], "5", "5 mm", registry().Quantity(5.0, "mm"), 1j):
        with pytest.raises(InputError, match="driver_angle"):
            found.mesh_stiffness(wrong)


def test_over_a_revolution_the_curve_with_the_odd_teeth_is_taken(found):
    over = SimpleNamespace(stiffness_at=lambda angle, secant: (angle, secant), error_at=lambda angle: -angle)
    tasks = {Task("mesh-stiffness-revolution", "I"): over, Task("transmission-error", "I"): None}
    outcomes = {task: SimpleNamespace(data=SimpleNamespace(found=one)) for task, one in tasks.items()}
    results = SimpleNamespace(outcomes=outcomes, scene=SimpleNamespace(name="drive"))
    curve = curve_of(results, "")
    assert (curve.stiffness(2.0, secant=True), curve.error(2.0)) == ((2.0, True), -2.0)
    with pytest.raises(InputError, match='request "transmission-error" or "mesh-stiffness-revolution"'):
        curve_of(SimpleNamespace(outcomes={}, scene=results.scene), "")
    outcomes[Task("transmission-error", "II")] = SimpleNamespace(data=SimpleNamespace(found=over))
    with pytest.raises(InputError, match="is required: 2 pairs have a curve; I, II"):
        curve_of(results, "")
