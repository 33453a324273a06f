"""No name that a case file or a script may hold vanishes: it is there, or read as another one (docs/stability.md)."""

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from names import FILE, names

from fegear.case.renamed import KEYS
from fegear.results.catalogue import STAGES


def test_every_name_of_before_is_still_taken():
    before, now = json.loads(FILE.read_text()), names()
    old = {renamed.old for renamed in KEYS}
    gone = [key for key in before["keys"] if key not in now["keys"] and key not in old]
    assert gone == [], "give them to KEYS of fegear/case/renamed.py, and count SCHEMA_VERSION up"
    assert [name for name in before["results"] if name not in now["results"] and name not in STAGES.former()] == []
    assert [name for name in before["python"] if name not in now["python"]] == []


def test_old_names_lead_to_names_of_now_and_hide_none():
    now = names()
    assert [renamed.new for renamed in KEYS if renamed.new and renamed.new not in now["keys"]] == []
    assert [renamed.old for renamed in KEYS if renamed.old in now["keys"]] == []
    assert [name for name in STAGES.former().values() if name not in now["results"]] == []
    assert [name for name in STAGES.former() if name in now["results"]] == []
