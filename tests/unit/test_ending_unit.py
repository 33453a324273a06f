"""The program's end while a thread that nobody waits for is within a library."""

import subprocess
import sys

import pytest

#: A thread that goes on calling Python from within pydantic's core, which is written in Rust.
BUSY = """
import threading, time
from pydantic import BaseModel, model_validator

class Slow(BaseModel):
    x: int = 1

    @model_validator(mode="after")
    def wait(self):
        sum(range(3000))
        return self

def busy():
    while True:
        Slow()

threading.Thread(target=busy, daemon=True).start()
time.sleep(0.1)
"""


@pytest.mark.parametrize(
    ("work", "code"), [("", 0), ("raise SystemExit(7)", 7), ("raise SystemExit('word')", 1), ("1 / 0", 1)],
    ids=["done", "left", "said", "failed"],
)  # fmt: skip
def test_a_thread_that_is_left_takes_no_exit_code(work, code):
    """The window aborted (signal 6) where it ended while a long case was being read: Rust is not to be unwound."""
    program = "from fegear.base.ending import leaving_with\nwith leaving_with():\n"
    program += "".join(f"    {line}\n" for line in (BUSY + "print('said')\n" + work).splitlines())
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (code, "said\n")
    assert "fatal runtime error" not in done.stderr
    assert ("ZeroDivisionError" in done.stderr) is (work == "1 / 0")


def test_the_program_is_started_where_its_end_is_seen_to():
    """Both ways to start it; `main` is for whoever goes on after it."""
    import tomllib
    from pathlib import Path

    from fegear import __main__ as begin

    project = Path(__file__).parents[2] / "pyproject.toml"
    if project.is_file():
        assert tomllib.loads(project.read_text())["project"]["scripts"]["fegear"] == "fegear.__main__:program"
    assert begin.program is not begin.main
