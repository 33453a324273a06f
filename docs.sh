#!/bin/sh
# The site with the example gallery, into site/: ./docs.sh [options of mkdocs build]. Sets itself up in .venv on first use.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$root/setup.sh"
fegear_setup "${FEGEAR_VENV:-$root/.venv}" docs
cd "$root"
# Pages and cases start the program some hundred times: its bytecode is kept.
unset PYTHONDONTWRITEBYTECODE
# The theme speaks of its successor at each build.
export NO_MKDOCS_2_WARNING=1
exec "${FEGEAR_VENV:-$root/.venv}/bin/python" -m mkdocs build --strict "$@"
