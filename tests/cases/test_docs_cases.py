"""The site builds with one command, every page is in its navigation, and a case's page shows what its run made."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_the_site_builds_without_a_warning(tmp_path):
    pytest.importorskip("mkdocs")
    environment = {**os.environ, "FEGEAR_GALLERY": "litvin_lead", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path / "site")],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )
    # Pages that name other cases link to pages which this shortened gallery leaves out.
    faults = [line for line in done.stderr.splitlines() if line.startswith("WARNING") and "'gallery/" not in line]
    assert faults == []
    start = (tmp_path / "site" / "index.html").read_text("utf-8")
    assert [p.name for p in (ROOT / "docs").glob("*.md") if f'href="{p.stem}/"' not in start] == []
    page = (tmp_path / "site" / "gallery" / "litvin_lead" / "index.html").read_text("utf-8")
    assert "fegear run cases/litvin_lead.toml" in page
    assert page.count("<img") >= 1
    assert '<h2 id="numbers">' in page
