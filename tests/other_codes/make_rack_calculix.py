"""Solve a rack by CalculiX and keep its answers: `python tests/other_codes/make_rack_calculix.py`."""

import json
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import rack_by_calculix as calculix

if __name__ == "__main__":
    found = {}
    for loaded in calculix.LOADED:
        with tempfile.TemporaryDirectory() as folder:
            found[str(loaded)] = calculix.solve(Path(folder), loaded)
    Path(__file__).with_name("rack_calculix.json").write_text(json.dumps(found, indent=1) + "\n")
