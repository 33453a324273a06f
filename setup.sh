# Shared set-up, sourced by run.sh, test.sh, docs.sh and .ci/run; it never touches the system's own Python.
#   fegear_setup VENV EXTRA   makes the virtual environment VENV, installs fegear[EXTRA] into it (an empty EXTRA
#                             means the program alone) and looks after the system libraries. Quick when all is there.
#   fegear_extras VENV CASE   adds the libraries that only some results need, where this case asks for such
# What only some tests need (CalculiX, Chromium, a C compiler) is installed where that is allowed; otherwise those tests are skipped.

fegear_libraries() { # prints the Debian packages whose libraries are missing
    libraries=$(PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null || true)
    [ -n "$libraries" ] || return 0 # no ldconfig, no Debian: the program itself then says what it misses
    for pair in libGLU.so.1:libglu1-mesa libXcursor.so.1:libxcursor1 libXft.so.2:libxft2 libXinerama.so.1:libxinerama1 \
        libGL.so.1:libgl1 libEGL.so.1:libegl1 libXrender.so.1:libxrender1 libXfixes.so.3:libxfixes3 libgomp.so.1:libgomp1; do
        case "$libraries" in *"${pair%%:*}"*) ;; *) printf ' %s' "${pair##*:}" ;; esac
    done
}

fegear_test_programs() { # prints the Debian packages of programs that only tests need
    command -v ccx >/dev/null 2>&1 || printf ' calculix-ccx'
    command -v chromium >/dev/null 2>&1 || command -v chromium-browser >/dev/null 2>&1 || printf ' chromium'
    command -v cc >/dev/null 2>&1 || command -v gcc >/dev/null 2>&1 || printf ' gcc libc6-dev' # meshes as FMUs
}

fegear_apt_get() { # installs Debian packages, if this user may
    [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1 || return 1
    echo "Installing system packages:$*" >&2
    { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@"; } >&2
}

fegear_pip() { # runs uv where it is, which takes a fifth of pip's time
    if command -v uv >/dev/null 2>&1; then
        uv pip install --python "$venv/bin/python" "$@" >&2 || return 1
    else
        fegear_plain_pip "$@"
    fi
}

fegear_plain_pip() { # runs pip: shows what is fetched and how much it has been; of what else pip says only the reason of a failure
    {
        PYTHONUNBUFFERED=1 "$venv/bin/python" -m pip install --disable-pip-version-check --progress-bar off --no-compile "$@" 2>&1
        echo $? >"$venv/pip.code"
    } | tee "$venv/pip.log" | awk '
        $1 == "Downloading" && /[kM]B\)$/ && !/\.metadata / {
            size = substr($(NF - 1), 2) / ($NF == "kB)" ? 1000 : 1)
            total += size
            if (size < 1) next
            split($2, part, "-")
            printf "  fetched %s %s, %.0f MB; %.0f MB in all\n", part[1], part[2], size, total
            fflush()
        }
        /^Installing collected packages/ { printf "  unpacking %d packages\n", NF - 3; fflush() }' >&2
    [ "$(cat "$venv/pip.code")" != 0 ] || return 0
    reason=$(grep '^ERROR' "$venv/pip.log" | tail -n 1)
    [ -n "$reason" ] || reason=$(grep -v '^ *$' "$venv/pip.log" | tail -n 1)
    echo "fegear: the libraries could not be installed (${reason#ERROR: }); pip's own words are in $venv/pip.log" >&2
    return 1
}

fegear_extras() { # VENV CASE...: installs the libraries that a case of `fegear run` needs beside the program, and no others
    venv=$1
    shift
    # Where the case is refused, the run says why.
    extras=$("$venv/bin/fegear" run --needs "$@" 2>/dev/null) && [ -n "$extras" ] || return 0
    echo "Fetching what this case needs beside the program: $extras" >&2
    fegear_pip --editable "$root[$extras]" || return 1
    fegear_prepare
}

fegear_prepare() { # the equations of motion become machine code now, half a minute, not in the first run that needs them
    "$venv/bin/python" -I -m fegear.dynamics.motion.prepare >/dev/null 2>&1 || :
}

fegear_bytecode() { # keeps what every worker of the first run would make for itself: the bytecode of tests and of what they load,
    # and, as one random property is tried, what hypothesis reads out of every module; of 12,000 modules that are installed the tests
    # load a third, so that compiling all of them would take longer than it saves
    (
        unset PYTHONDONTWRITEBYTECODE PYTHONPYCACHEPREFIX
        cd "$root" && "$venv/bin/python" -m pytest -n 0 -qq -k test_different_names_stay_different >/dev/null 2>&1
    ) || :
}

fegear_setup() {
    venv=$1 extra=${2:-}
    missing=$(fegear_libraries)
    if ! command -v python3 >/dev/null 2>&1 || ! python3 -c 'import ensurepip, venv' >/dev/null 2>&1; then
        missing="$missing python3-venv"
    fi
    if [ -n "$missing" ] && ! fegear_apt_get $missing; then
        echo "fegear needs system packages that are missing; install them with: sudo apt-get install$missing" >&2
        return 1
    fi
    case "$extra" in test | dev)
        missing=$(fegear_test_programs)
        if [ -n "$missing" ] && ! fegear_apt_get $missing; then
            echo "Tests that need these are skipped; to run them too: sudo apt-get install$missing" >&2
        fi
        ;;
    esac
    if ! python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
        echo "fegear needs Python 3.11 or newer; python3 here is $(python3 --version 2>&1)" >&2
        return 1
    fi
    stamp="$venv/.fegear-${extra:-program}"
    state="$(cksum <"$root/pyproject.toml") $root"
    if [ "$(cat "$stamp" 2>/dev/null)" = "$state" ] && "$venv/bin/python" -I -c 'import fegear' 2>/dev/null; then
        return 0
    fi
    echo "Setting up $venv (once; a minute or two)" >&2
    # An environment is of no use without its Python (removed or replaced by another since) or without pip.
    if ! "$venv/bin/python" -I -c 'import pip' 2>/dev/null; then
        if [ -e "$venv" ] && [ ! -e "$venv/pyvenv.cfg" ] && [ -n "$(ls -A "$venv")" ]; then
            echo "fegear: $venv is there and is no virtual environment; move it away" >&2
            return 1
        fi
        rm -rf "$venv"
        if ! python3 -m venv "$venv" >&2; then
            echo "fegear: python3 could not make the virtual environment $venv" >&2
            return 1
        fi
    fi
    fegear_pip --editable "$root${extra:+[$extra]}" || return 1
    case "$extra" in test | dev) fegear_bytecode & ;; esac # on another processor, beside what takes one
    fegear_prepare
    wait
    # What an extra holds of others is not set up once more: tests have all that the site and the window need.
    case "$extra" in
    dev) served="dev test docs workbench program" ;;
    test) served="test docs workbench program" ;;
    docs) served="docs workbench program" ;;
    *) served="$extra program" ;;
    esac
    for each in $served; do printf '%s\n' "$state" >"$venv/.fegear-$each"; done
}
