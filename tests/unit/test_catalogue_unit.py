"""The catalogue: plain data, from which modules are imported when a plan asks for them."""

import subprocess
import sys
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case.model import Case
from fegear.case.reading import build_scene
from fegear.engine.catalogue import Catalogue
from fegear.engine.plan import make_plan
from fegear.engine.stage import Stage
from fegear.results.catalogue import RESULTS, STAGES, SUBJECTS

CASE = Path(__file__).parents[2] / "cases" / "nasa_four_square.toml"

LOADED = """
import sys
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES
scene = read_scene(sys.argv[1], ['results=["stiffness"]'])
assert not [m for m in sys.modules if m.startswith("fegear.results.") and m != "fegear.results.catalogue"]
make_plan(scene, STAGES)
print(*(m.removeprefix("fegear.results.") for m in sys.modules if m.startswith("fegear.results.")))
"""

PLANNED = """
import sys
from fegear.case.part import Part
from fegear.case.reading import read_scene
scene = read_scene(sys.argv[1], [])
def below(part):
    return {part}.union(*map(below, part.__subclasses__()))
print(*(part.__name__ for part in below(Part) if part.__pydantic_complete__))
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import plan_lines
from fegear.results.catalogue import STAGES
list(plan_lines(scene, make_plan(scene, STAGES)))
print(*(m.removeprefix("fegear.") for m in sys.modules if m.startswith("fegear.")))
"""

LISTED = """
import sys
from fegear.commands.schema import results
results()
assert not [m for m in sys.modules if m.startswith(("fegear.results.", "fegear.case.part", "fegear.contact"))
            and m != "fegear.results.catalogue"]
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import plan_lines
from fegear.results.catalogue import STAGES
scene = read_scene(sys.argv[1], ['results=["dynamic-factor"]'])
list(plan_lines(scene, make_plan(scene, STAGES)))
print(*(m.removeprefix("fegear.") for m in sys.modules if m.startswith("fegear.")))
"""


@pytest.fixture(scope="module")
def planned():
    """Tables whose rules are compiled when a case has been read, and modules that are loaded when it is planned."""
    ran = subprocess.run([sys.executable, "-c", PLANNED, str(CASE)], capture_output=True, text=True, check=True)
    return [line.split() for line in ran.stdout.splitlines()]


#: Results that are made for external teeth only, or for pairs of external gears.
EXTERNAL = {
    "atlas-gear", "body-modes", "contact-lines", "crack-path", "crosscheck", "design-chart", "double-helical",
    "flank-design", "flank-fracture", "flank-generation",
    "mesh-stiffness-matrix", "mode-tracking", "odd-gear-other-flank", "odd-solid-solution", "pair-forced-response",
    "rack-geometry", "rack-solution", "solid-rack-solution",
    "rack-stiffness", "rack-transmission-error", "sizing", "stiffness-study",
    "tooth-contact", "transmissibility",
}  # fmt: skip


def test_which_results_refuse_internal_gears_is_decided_and_no_accident():
    now = {entry.name for entry in STAGES.entries if not entry.internal}
    assert now == EXTERNAL, "an Entry takes ring gears, too (internal=True), or is listed in EXTERNAL"


def test_every_entry_finds_a_stage_that_is_named_after_it():
    homes = [entry.home for entry in STAGES.entries]
    assert len(set(homes)) == len(homes) == len(STAGES) == len({entry.name for entry in STAGES.entries})
    for entry, stage in zip(STAGES.entries, STAGES, strict=True):
        assert isinstance(stage, Stage)
        assert (stage.name, stage.title, stage.results, stage.about, stage.internal) == (
            entry.name, entry.title, entry.results, entry.about, entry.internal,
        )  # fmt: skip
        assert stage is STAGES.called(entry.name)
        # What serves other stages alone has no line in lists of results; whatever can be asked for has one.
        assert bool(entry.results) == bool(entry.about)
    assert {name for entries in SUBJECTS.values() for entry in entries for name in entry.results} == set(RESULTS)
    assert STAGES[0] is STAGES.called(STAGES.entries[0].name)
    assert STAGES[1:3] == tuple(STAGES)[1:3]
    with pytest.raises(KeyError):
        STAGES.called("stifness")


def test_a_plan_imports_no_result_that_it_does_not_need():
    """138 such modules were imported at every start, for .25 to .3 s."""
    ran = subprocess.run([sys.executable, "-c", LOADED, str(CASE)], capture_output=True, text=True, check=True)
    loaded = set(ran.stdout.split())
    assert "gear.solved_gear" in loaded
    homes = {entry.home.rpartition(".")[0] for entry in STAGES.entries}
    # Both stages of the wanted table, and what says where the contacts of its pairs are.
    assert loaded & homes <= {"gear.solved_gear", "gear.stiffness", "gear.stiffness_over_face", "pair.loaded_pair"}


def test_a_plan_of_plane_gears_imports_no_mechanics_of_other_cases(planned):
    """Shafts, measured flanks, wide pairs and motion took a tenth of the start of a case that has none of them."""
    _, loaded = planned
    assert "case.reading" in loaded
    others = ("shafts.", "dynamics.", "contact.wide.", "formulas.iso1328", "case.built.measured_flanks")
    # What only holds the inputs of a table of a case.
    specs = {"shafts.section", "shafts.printed_bearing", "shafts.life"}
    assert [name for name in loaded if name.startswith(others) and name not in specs] == []


def test_results_are_listed_without_what_computes_them_and_motions_planned_without_their_integrator():
    """Listing loaded every result (1 s); a plan of motions loaded 60 modules that only a run needs."""
    case = CASE.with_name("two_stage_gearbox.toml")
    ran = subprocess.run([sys.executable, "-c", LISTED, str(case)], capture_output=True, text=True, check=True)
    *listed, loaded = ran.stdout.splitlines()
    assert any(line.split()[:1] == ["dynamic-factor"] for line in listed)
    assert "(requires the effect odd_teeth)" in " ".join(ran.stdout.split())
    assert "results.train.motion" in loaded.split()
    run_only = ("dynamics.motion.kernel", "dynamics.motion.moving_train", "contact.plane.engagement")
    assert [name for name in loaded.split() if name.startswith(run_only)] == []


def test_reading_a_case_loads_no_table_that_it_does_not_have(planned):
    """Of 40 ms for all tables of a case a quarter is left out."""
    _, loaded = planned
    assert {"case.gear", "case.train"} <= set(loaded)
    others = {
        "sizing",
        "compound",
        "planetary",
        "shaft",
        "transmissibility",
        "flank_design",
        "fillet_design",
        "design",
        "gauge",
    }
    assert not {f"case.{one}" for one in (*others, "set_pairs", "trade_words")} & set(loaded)


def test_reading_a_case_compiles_the_rules_of_no_table_that_it_does_not_have(planned):
    """The rules of all ninety tables took a fifth of the processor time of a plan."""
    compiled = set(planned[0])
    assert {"Case", "GearPart", "ReliefPart"} <= compiled
    assert not compiled & {"StrengthPart", "PlanetaryPart", "TransmissibilityPart", "DesignPart", "MeasuredPart"}


def test_stages_at_hand_are_a_catalogue_too():
    own = Stage(tuple, len, max, min, name="own", results=("one", "two"))
    made = Catalogue.of([own])
    assert made.called("own") is own
    assert made.by_result() == {"one": ["own"], "two": ["own"]}
    assert Catalogue.of(made) is made
    assert made.holds(own)
    assert not STAGES.holds(own)


def test_a_result_of_a_table_that_is_not_there_says_which():
    """Forty results asked for "the required gear, pair or train" whatever they are of."""
    known = STAGES.by_result()
    tables = {name: {STAGES.table_of(stage) for stage in stages} for name, stages in known.items()}
    for name, of in tables.items():
        if of == {""}:
            continue
        gear = {"teeth": 20, "module": "2 mm", "face_width": "10 mm"}
        case = {"gear": {"a": gear, "b": gear}, "pair": {"I": {"driver": "a", "driven": "b", "load": "1 kN"}}}
        with pytest.raises(InputError) as refused:
            make_plan(build_scene({**case, "results": [name]}, "case", Path()), STAGES)
        table = next(iter(of))
        assert refused.value.remedy == (f"add {table}" if table.startswith("[") else f"add [{table}]")
    assert tables["measured-transmission-error"] == {"encoders.NAME"}
    keys = {table.lstrip("[").split(".")[0] for of in tables.values() for table in of} - {""}
    assert keys < set(Case.model_fields)
