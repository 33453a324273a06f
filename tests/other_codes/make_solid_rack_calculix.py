"""Solve a helical rack by CalculiX and keep its answers: `python tests/other_codes/make_solid_rack_calculix.py`."""

import json
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import solid_rack_by_calculix as calculix

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        found = calculix.told(Path(folder), *calculix.MESH)
    Path(__file__).with_name("solid_rack_calculix.json").write_text(json.dumps(found, indent=1) + "\n")
