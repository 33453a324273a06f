"""Children of a test run that has last-bit noise have the same noise: Python imports this file when it starts."""

import os

import last_bit

if "FEGEAR_LAST_BIT" in os.environ:
    last_bit.install(int(os.environ["FEGEAR_LAST_BIT"]))
