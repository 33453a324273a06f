#!/bin/sh
# The main job: ./run.sh [CASE.toml] [options of `fegear run`]. Sets itself up in .venv on first use.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$root/setup.sh"
fegear_setup "${FEGEAR_VENV:-$root/.venv}" ""
[ $# -gt 0 ] || set -- "$root/cases/nasa_four_square.toml"
fegear_extras "${FEGEAR_VENV:-$root/.venv}" "$@"
exec "${FEGEAR_VENV:-$root/.venv}/bin/fegear" run "$@"
