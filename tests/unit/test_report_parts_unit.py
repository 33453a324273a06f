"""Parts of reports: digits that the error leaves, citations of every stage, pages that other commands make."""

from __future__ import annotations

import ast
import base64
import html
import html.parser
import json
import re
from importlib import resources
from pathlib import Path

import jinja2
import numpy as np
import pytest

from fegear.base.notes import failing
from fegear.base.printed import unit_said
from fegear.base.spoken_names import spoken
from fegear.case.reading import read_scene
from fegear.engine.citation import bibliography
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Points
from fegear.engine.figure.panel import Panel
from fegear.engine.inexact import inexact_values
from fegear.engine.plan import make_plan
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output.draw_png import Picture
from fegear.output.numbers import plain_number, pretty_unit, with_error
from fegear.output.report.blocks import (  # fmt: skip
    Bars,
    Block,
    ClassifiedNotes,
    Code,
    DataTable,
    Download,
    Facts,
    Folded,
    Grid,
    Group,
    Heading,
    Listed,
    Notes,
    Paragraph,
    Plot,
    Sheet,
    SheetGroup,
    Still,
    Switch,
    Values,
    as_words,
)
from fegear.output.report.page import Page, Section, fragment, page_text, render, write_page
from fegear.results.catalogue import STAGES
from fegear.results.pair.loaded_pair import LOADED_PAIR

ROOT = Path(__file__).parents[2]
CASES = sorted((ROOT / "cases").rglob("*.toml"))


@pytest.mark.parametrize(
    ("value", "error", "told"),
    [
        (0.0391477505, 2.98e-5, ("0.039148", "0.000030")),
        (1234.567, 0.9, ("1234.57", "0.90")),
        (-1.4868472, 0.0011954, ("−1.4868", "0.0012")),
        (3.388e-14, 0.0107, ("0.000", "0.011")),
        (5.3165476e-6, 3.9e-9, ("5.3165·10⁻⁶", "0.0039·10⁻⁶")),
        (2.5e8, 1.3e5, ("2.5000·10⁸", "0.0013·10⁸")),
        (350.0, 40.0, ("350", "40")),
        (1.0, 1e-14, ("1.0000000000", "1e-14")),
    ],
)
def test_values_have_the_digits_that_their_errors_leave(value, error, told):
    assert with_error(value, error) == told


def test_values_that_are_known_less_well_than_asked_are_named_the_worst_first():
    values = [
        Value("I.te_peak_to_peak", 1.221e-6, "um", 0.26e-6),
        Value("I.te_mean", 20e-6, "um", 0.1e-6),
        Value("I.te_peak_to_peak.designed", 3.7e-20, "um", 1.7e-9),  # round-off of zero
        Value("I.largest_load", 5e3, "N"),
        Value("I.largest_line_load", 406.9e3, "N/mm", 740e3),
    ]
    assert inexact_values(values, 0.02) == (
        "Estimated errors above the tolerance of 2 %: I.largest_line_load = 410 +- 740 N/mm (182 %); "
        "I.te_peak_to_peak = 1.22 +- 0.26 um (21 %)."
    )
    several = inexact_values(values[:2] + values[:1] * 5, 0.001)
    assert several.startswith("Estimated errors above 1 % (tolerance 0.1 %): I.te_peak_to_peak")
    assert several.endswith("; and 2 more.")
    assert inexact_values(values, 2.0) == ""
    halves = [Value("end_I", 306e6, "MPa", 28e6), Value("end_II", 306e6, "MPa", 28e6 * (1.0 + 1e-15))]
    assert inexact_values(halves, 0.05).index("end_I =") < inexact_values(halves, 0.05).index("end_II =")


def test_numbers_and_units_are_written_for_people():
    assert [plain_number(x) for x in (0.5477378, -2.0, 1e-7, float("nan"), float("inf"))] == [
        "0.547738", "−2", "1·10⁻⁷", "none", "∞",
    ]  # fmt: skip
    assert [pretty_unit(u) for u in ("um.mm/N", "deg", "N/(mm.um)", "")] == ["µm·mm/N", "°", "N/(mm·µm)", ""]


@pytest.mark.dear
def test_every_stage_names_its_sources_and_every_work_is_used():
    cited = set()
    for scene in [
        *map(read_scene, CASES),
        read_scene(ROOT / "cases" / "cracked_tooth.toml", ['results=["crack-path"]']),
    ]:
        for step in make_plan(scene, STAGES).steps:
            sources = {c.key for c in step.stage.cites(scene, step.task.subject)}
            assert sources or step.task.stage == "loaded-pair", step.task  # whose source may be a table of the user's
            cited |= sources
    assert cited <= set(bibliography())
    assert set(bibliography()) - cited == set()


def test_sources_follow_what_the_case_chose():
    def keys(*overrides: str) -> set[str]:
        scene = read_scene(ROOT / "cases" / "calculix_pair.toml", overrides)
        return {c.key for c in LOADED_PAIR.cites(scene, "I")}

    assert {"gmsh", "hertz"} <= keys()
    closed = keys('pair.I.compliance.source="cornell"', 'effects.hertz="none"')
    assert "cornell" in closed
    assert not {"gmsh", "hertz", "weber-banaschek"} & closed


def test_what_the_formulas_name_as_their_source_is_in_the_bibliography():
    known = " ".join(work.full for work in bibliography().values())
    for path in sorted((ROOT / "fegear" / "formulas").glob("*.py")):
        told = " ".join((ast.get_docstring(ast.parse(path.read_text("utf-8"))) or "").split())
        for name in (
            "Cornell",
            "Heywood",
            "Banaschek",
            "Sainsot",
            "Broghamer",
            "Palmgren",
            "Lewis",
            "Pedersen",
            "Tian",
        ):
            if name in told and "Source" in told:
                assert name in known, path.name


def test_titles_of_works_are_unlike_and_short_names_are_readable():
    works = bibliography()
    assert works["lin-townsend-oswald"].short == "Lin and others 1987"
    assert works["iso-6336-3"].short == "ISO 6336-3:2006"
    assert works["weber-banaschek"].short == "Weber and Banaschek 1953"
    assert len({work.full for work in works.values()}) == len(works)


def test_another_command_can_make_a_page(tmp_path):
    table = Table(
        "cost", (Column("seconds", np.array([0.1, 1.0]), "s"), Column("error", np.array([1e-2, 1e-4]))), "Cost"
    )
    points = Points([0.1, 1.0], [1e-2, 1e-4], "</script><b>finite elements</b>", "blue", notes=("a", "<i>b</i>"))
    panel = Panel(Axis("time", "s", log=True), Axis("error", log=True), (points,))
    figure = Figure("cost", "Error against time", "Each point is a setting.", (panel,))
    page = Page("What it costs & why", "A note.", (
        Section("Prices", (Plot(figure), DataTable(table), Facts({"knob <a>": [{"size": 1.0}, {"size": 0.5}]}))),
        Section("Nothing", ()),
        Section("Numbers", (Values((Value("c", 2.0, "mm", 0.04 * 2.0),), tolerance=1e-4),)),
    ), (table,))  # fmt: skip
    write_page(tmp_path / "cost.html", page)
    text = (tmp_path / "cost.html").read_text("utf-8")
    assert "What it costs &amp; why" in text
    assert "knob &lt;a&gt;" in text
    assert ">Nothing<" not in text
    assert "<span class='over'>± 4 %</span>" in text
    (told,) = json.loads(text.split("id='figures'>")[1].split("</script>")[0])
    (trace,) = told["data"]
    assert np.frombuffer(base64.b64decode(trace["x"]["bdata"])).tolist() == [0.1, 1.0]
    assert trace["name"] == "&lt;/script&gt;&lt;b&gt;finite elements&lt;/b&gt;"  # plotly takes names for HTML
    assert trace["text"] == ["a", "&lt;i&gt;b&lt;/i&gt;"]
    assert "id='plotly'" in text


class Parsed(html.parser.HTMLParser):
    """What a browser makes of a page: its tags with their attributes, its texts, and the texts of its scripts."""

    def __init__(self, text: str):
        super().__init__()
        self.tags, self.values, self.texts, self.scripts = [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, tuple(name for name, _ in attrs)))
        self.values += [value for _, value in attrs if value is not None]

    def handle_data(self, data):
        (self.scripts if self.cdata_elem == "script" else self.texts).append(data)


def page_of_every_block(name: str, folder: Path) -> Page:
    """A page that holds a text in every place that takes one."""
    picture = folder / "picture.png"
    picture.write_bytes(b"no picture")
    columns = (Column(name, np.array([0.5, 1.0]), "mm", name), Column("text", np.array([name, name])))
    table = Table("t", columns, name)
    figure = Figure("key", name, name, (Panel(Axis(name), Axis(name), (Points([1.0], [1.0], name, notes=(name,)),)),))
    rows = SheetGroup(name, (Column("c", np.array([name]), "", "d_b"),))
    sheet = Sheet((name,), (rows,), (("what", name, "mm"),))
    value = Value("v", 2.0, "mm", 0.3e-3, meaning=name)
    blocks = (
        Paragraph(name), Heading(name), Notes((name,)), Listed((name, 1.5, True)), Bars({name: 1.0}, name), Code(name),
        Facts({name: [{name: 1.0}, {name: name}], "list": [name, {name: name}], "none": []}),
        Grid((name,), ((name,),)), Folded(name, (Paragraph(name),)), Group((Paragraph(name),)),
        Download(f"{name}.toml"), Values((value,), 1e-9), ClassifiedNotes((failing(name),)), Switch("s", name),
        DataTable(table), Plot(figure), sheet, Still(Picture(picture, name, name)),
    )  # fmt: skip
    return Page(name, name, (Section(name, blocks),), (table,), {f"{name}.toml": b""})


HOSTILE = (
    "<b>a</b>",
    "a & b &lt;c",
    "'a' \"b\"",
    "<!--<script>",
    "</script></style>",
    "{{ 7 * 7 }}{% raw %}",
    "a_b.c",
)


@pytest.mark.parametrize("name", HOSTILE)
def test_no_name_becomes_part_of_the_page(name, tmp_path):
    harmless, hostile = (Parsed(page_text(page_of_every_block(each, tmp_path))) for each in ("NAME", name))
    assert hostile.tags == harmless.tags
    found = hostile.texts.count(name), sum(name in value for value in hostile.values)
    assert found == (harmless.texts.count("NAME"), sum("NAME" in value for value in harmless.values))
    assert min(found) > 4
    assert len(hostile.scripts) == len(harmless.scripts)
    figures = json.loads(hostile.scripts[0])
    assert "<" not in hostile.scripts[0]
    assert figures[0]["layout"]["xaxis"]["title"]["text"] == html.escape(name, quote=False)  # plotly takes it for HTML


def test_a_value_is_for_people_first_and_orange_only_where_a_decision_could_change():
    values = (
        Value("I.driver.S_F", 1.05113431, "", 0.0005, "safety factor; tooth breakage"),
        Value("I.driven.S_F", 1.2, "", 0.1, "safety factor"),
        Value("I.ratio", 1.638, "", 0.0, "contact ratio"),
        Value("I.te", 7.6187e-6, "um", 0.0034e-6),
    )
    rows = Values(values, 1e-4).rows
    several = Values((Value("cornell.median_ratio", 0.98), Value("heywood.median_ratio", 0.93)), 1e-4).rows
    assert [row.what for row in several] == ["cornell: median ratio", "heywood: median ratio"]
    assert [(row.what, row.more) for row in rows] == [
        ("driver: safety factor; tooth breakage", ""), ("driven: safety factor", ""),
        ("ratio", "contact ratio"), ("transmission error", ""),
    ]  # fmt: skip
    assert [row.short for row in rows] == ["1.05", "1.2", "1.638", "7.62"]
    assert [row.shown for row in rows] == ["1.05113", "1.20", "1.638", "7.6187"]
    assert [row.rough for row in rows] == [
        "",
        "± 8.3 %",
        "",
        "",
    ]  # 0.05 % decides nothing
    assert [row.error for row in rows] == ["± 0.00050", "± 0.10", "", "± 0.0034"]


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("I.te_peak_to_peak", "transmission error, peak to peak"),
        ("I.unloaded_te_peak_to_peak", "unloaded transmission error, peak to peak"),
        ("I.driver.largest_root_tension", "driver: maximum root stress, tension side"),
        ("I.te_peak_to_peak.linear_tip_relief", "transmission error, peak to peak: linear tip relief"),
        ("rules_checked", "rules checked"),
        ("I.te_peak_to_peak_95", "transmission error, peak to peak, 95th percentile"),
        ("I.hertz_pressure_50", "Hertzian pressure, median"), ("a.stiffness_loss_tooth_50", "stiffness loss tooth 50"),
        ("I.fm0", "FM0"), ("I.m6a", "M6A"), ("I.mesh_stiffness_min", "minimum mesh stiffness"),
        ("I.mesh_stiffness_min_ordinary", "minimum mesh stiffness of ordinary teeth"),
        ("I.te_residual_max", "maximum residual of the transmission error"),
        ("I.dynamic_te_residual_max", "maximum residual of the dynamic transmission error"),
        ("I.dynamic_te_change_max", "maximum change of the dynamic transmission error"),
        ("I.mesh_force_max", "maximum mesh force"),
        ("I.mesh_force_max_ordinary", "maximum mesh force in an ordinary base pitch"),
        ("I.driver.S_F", ""), ("a.c_self_at_pitch", ""), ("I.K_Hbeta", ""),
    ],
)  # fmt: skip
def test_an_identifier_is_said_in_words(name, said):
    assert spoken(name) == said


@pytest.mark.parametrize(
    ("name", "said", "spelled"),
    [
        ("K_Hbeta", "K_Hβ", "K<sub>Hβ</sub>"), ("K_Hbeta_before", "K_Hβ before", "K<sub>Hβ</sub> before"),
        ("S_H_min", "S_H min", "S<sub>H</sub> min"), ("sigma_F_driver", "σ_F driver", "σ<sub>F</sub> driver"),
        ("load_margin", "load margin", "load margin"), ("a.K_Hbeta", "a.K_Hbeta", "a.K<sub>Hbeta</sub>"),
        ("x_start", "x start", "x start"), ("TE_mean", "TE mean", "TE mean"),
    ],
)  # fmt: skip
def test_a_head_has_the_symbols_of_the_trade(name, said, spelled):
    assert as_words(name) == said
    assert "".join(fragment([Paragraph(as_words(name))]).split("\n")) == f"<p>{spelled}</p>"


def test_a_sentence_has_them_too():
    text = "".join(fragment([Paragraph("helix slope C_Hβ and crowning C_β of gear a_1: S_H")]).split("\n"))
    assert text == "<p>helix slope C<sub>Hβ</sub> and crowning C<sub>β</sub> of gear a_1: S<sub>H</sub></p>"


def test_the_arrow_of_a_change_does_not_break_over_two_lines():
    text = "".join(fragment([Paragraph("K_Hβ 1.26 -> 1.13, x->y")]).split("\n"))
    assert text == "<p>K<sub>Hβ</sub> 1.26\N{NO-BREAK SPACE}→ 1.13, x-&gt;y</p>"


@pytest.mark.parametrize(
    ("sentence", "spelled"),
    [
        ("at most 7 µm (390 N m, amount -20 %)", "at most 7 µm (390 N m, amount −20 %)"),
        ("(-3.2 to -.5)", "(−3.2 to −.5)"),
        ("set profile_shift = -0.2 or [-1, 2]", "set profile_shift = -0.2 or [-1, 2]"),  # pasted into a case
        ("ISO 6336-1, 1e-3, 10-20, +- 5 and --over", "ISO 6336-1, 1e-3, 10-20, +- 5 and --over"),
    ],
)
def test_a_sentence_has_minus_signs(sentence, spelled):
    assert "".join(fragment([Paragraph(sentence)]).split("\n")) == f"<p>{spelled}</p>"


def test_a_stress_intensity_has_the_root_of_a_metre():
    assert pretty_unit("MPa.m^(1/2)") == unit_said("MPa.m^(1/2)") == "MPa·√m"
    assert unit_said("N.m") == "N m"


def test_every_block_has_its_macro(tmp_path):
    shown = {type(block) for block in page_of_every_block("name", tmp_path).sections[0].blocks}
    assert shown == set(Block.__subclasses__())
    folder = resources.files("fegear.output.report") / "templates"
    drawn = set(re.findall(r"macro ([A-Z]\w+)\(", (folder / "blocks.html").read_text("utf-8")))
    assert drawn == {kind.__name__ for kind in shown}


def test_a_name_that_a_template_misses_is_an_error():
    with pytest.raises(jinja2.UndefinedError, match="page"):
        render("page.html")


def test_a_page_without_plots_carries_no_library(tmp_path):
    write_page(tmp_path / "small.html", Page("T", "n", (Section("S", (Facts({"a": 1}),)),)))
    assert (tmp_path / "small.html").stat().st_size < 60_000
