#!/bin/sh
# All tests: ./test.sh [options of pytest]. Sets itself up in .venv on first use. What cannot run here is skipped, and named at
# the end; with --no-skips that counts as a failure.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$root/setup.sh"
fegear_setup "${FEGEAR_VENV:-$root/.venv}" test
cd "$root"
# Each worker is one process of one thread: the solves are too small for threads to help. Tests of one file stay together, so that
# what they share is made once. Many tests start the program: bytecode is kept where Python keeps it, that of the
# libraries too, which is made where it is used first.
unset PYTHONDONTWRITEBYTECODE PYTHONPYCACHEPREFIX
OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 exec "${FEGEAR_VENV:-$root/.venv}/bin/python" -m pytest -n 2 --dist worksteal "$@"
