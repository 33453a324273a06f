"""Write names.json: keys of case files, results and names at the top of Python that somebody may rely on.

python tests/architecture/names.py, at a release: what the file has that is no name any more needs an entry in
fegear/case/renamed.py (docs/stability.md).
"""

import json
from pathlib import Path

import fegear
from fegear.case.schema import case_schema
from fegear.case.schema_nodes import SchemaNodes
from fegear.results.catalogue import RESULTS

FILE = Path(__file__).with_name("names.json")


def names():
    nodes = SchemaNodes(case_schema(dict.fromkeys(RESULTS, "")))
    tables = [key for key, node in nodes.top.items() if nodes.table(nodes.named(node) or node) is not None]
    user_named = {key for key in tables if nodes.named(nodes.top[key]) is not None}
    keys = [one.key for one in nodes.keys("")]
    for table in tables:
        head = f"{table}.NAME." if table in user_named else f"{table}."
        keys += [head + one.key for one in nodes.keys(table)]
    return {"keys": sorted(keys), "results": sorted(RESULTS), "python": sorted(fegear.__all__)}


if __name__ == "__main__":
    FILE.write_text(json.dumps(names(), indent=0) + "\n")
