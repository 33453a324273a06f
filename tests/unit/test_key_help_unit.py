"""What a key of a case means is said once, at the key; form, schema and reference show that sentence."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fegear.case.known_keys import part_models
from fegear.case.model import Case
from fegear.window.form import fields, form

if TYPE_CHECKING:
    from pydantic import BaseModel

DOCS = Path(__file__).parents[2] / "docs"


def _parts() -> list[type[BaseModel]]:
    found: list[type[BaseModel]] = [Case]
    for part in found:
        for field in part.model_fields.values():
            found += [one for one in part_models(field.annotation) if one not in found]
    return found


@pytest.mark.parametrize("part", _parts(), ids=lambda part: f"{part.__module__.rpartition('.')[2]}-{part.__name__}")
def test_every_key_says_what_it_means(part):
    untold = [name for name, field in part.model_fields.items() if len(field.description or "") < 5]
    assert not untold, (
        f"{part.__module__}.{part.__name__}: {', '.join(untold)} has no help. Write one sentence for who fills "
        f'in the form, {untold[0]}: ... = Field(..., description="..."), then run: python docs/case_keys.py'
    )
    long = [name for name, field in part.model_fields.items() if len(field.description or "") > 240]
    assert not long, f"{part.__name__}: the help of {', '.join(long)} is longer than a sentence that is read in a form"


def test_the_reference_of_case_files_has_the_tables_of_the_model():
    spec = importlib.util.spec_from_file_location("case_keys", DOCS / "case_keys.py")
    case_keys = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(case_keys)
    page = case_keys.PAGE.read_text("utf-8")
    assert "| `teeth` | Number of teeth, 5 to 1000. | a whole number | required |" in page
    assert case_keys.page_with_keys(page) == page, "docs/case-files.md is not of this model: python docs/case_keys.py"
    tables = {name for name in Case.model_fields if part_models(Case.model_fields[name].annotation)}
    missing = [name for name in tables if f"<!-- keys of {name} -->" not in page]
    assert not missing, f"docs/case-files.md has no section <!-- keys of {missing[0]} --> <!-- end of keys -->"


def test_the_form_shows_the_sentence_and_what_may_be_typed():
    document = {"gear": {"a": {"teeth": 20, "rack": {"tip_radius": 0.3}}}, "effects": {}}
    found = {field.key: field for field in fields(form(document))}
    assert found["gear.a.module"].about == ("Module m; alternatively diametral_pitch or circular_pitch.")
    assert found["gear.a.module"].hint.startswith("length with its unit: mm, um, m, inch")
    assert found["effects.relief"].about == "Include profile and flank line modifications."
    assert found["gear.a.rack.tip_radius"].about.startswith("Tip radius of the basic rack")
    assert all(field.about for field in found.values())
    (rack,) = next(section for section in form(document) if section.path == ("gear", "a")).sections
    assert rack.about.startswith("Basic rack (tool)")
