# Shared set-up, sourced by run.sh, test.sh and .ci/run; it never touches the system's own Python.
#   fegear_setup VENV EXTRA   makes the virtual environment VENV, installs fegear[EXTRA] into it (an empty EXTRA
#                             means the program alone) and looks after the system libraries. Quick when all is there.

fegear_system_packages() { # prints the Debian packages whose libraries are missing
    libraries=$(PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null || true)
    [ -n "$libraries" ] || return 0 # no ldconfig, no Debian: the program itself then says what it misses
    for pair in libGLU.so.1:libglu1-mesa libXcursor.so.1:libxcursor1 libXft.so.2:libxft2 libXinerama.so.1:libxinerama1 \
        libGL.so.1:libgl1 libEGL.so.1:libegl1 libXrender.so.1:libxrender1 libXfixes.so.3:libxfixes3 libgomp.so.1:libgomp1; do
        case "$libraries" in *"${pair%%:*}"*) ;; *) printf ' %s' "${pair##*:}" ;; esac
    done
    [ "${1:-}" = test ] || return 0
    command -v ccx >/dev/null 2>&1 || printf ' calculix-ccx'
    command -v chromium >/dev/null 2>&1 || command -v chromium-browser >/dev/null 2>&1 || printf ' chromium'
}

fegear_setup() {
    venv=$1 extra=${2:-}
    case "$extra" in test | dev) wants=test ;; *) wants= ;; esac
    missing=$(fegear_system_packages "$wants")
    if ! command -v python3 >/dev/null 2>&1 || ! python3 -c 'import ensurepip, venv' >/dev/null 2>&1; then
        missing="$missing python3-venv"
    fi
    if [ -n "$missing" ]; then
        if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1; then
            echo "Installing system packages:$missing" >&2
            { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing; } >&2 || {
                echo "fegear: apt-get could not install:$missing" >&2
                return 1
            }
        else
            echo "fegear needs system packages that are missing; install them with: sudo apt-get install$missing" >&2
            return 1
        fi
    fi
    if ! python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
        echo "fegear needs Python 3.11 or newer; python3 here is $(python3 --version 2>&1)" >&2
        return 1
    fi
    stamp="$venv/.fegear-${extra:-program}"
    state="$(cksum <"$root/pyproject.toml") $root"
    if [ ! -x "$venv/bin/fegear" ] || [ "$(cat "$stamp" 2>/dev/null)" != "$state" ]; then
        echo "Setting up $venv (once; a minute or two)" >&2
        [ -x "$venv/bin/python" ] || python3 -m venv "$venv" || return 1
        "$venv/bin/python" -m pip install --quiet --editable "$root${extra:+[$extra]}" >&2 || return 1
        printf '%s\n' "$state" >"$stamp"
    fi
}
