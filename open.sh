#!/bin/sh
# The live workbench: ./open.sh [CASE.toml] [options of `fegear open`]. Sets itself up in .venv on first use.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$root/setup.sh"
fegear_setup "${FEGEAR_VENV:-$root/.venv}" workbench
exec "${FEGEAR_VENV:-$root/.venv}/bin/fegear" open "$@"
