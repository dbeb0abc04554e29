#!/bin/sh
# Checks that Rust and Python can build bipenalty: silent if they can, one clear sentence if they cannot.
#
#   check_toolchain.sh [rust] [python]      both when nothing is named
#
# `python` prints the interpreter to use: $PYTHON if set, else the first of python3, python3.13, ... that is
# new enough and has what a virtual environment needs. The limits are read from Cargo.toml and pyproject.toml.
# Uses shell built-ins only, because the tools it looks for may be all that is installed.
set -u
root=${0%/*}/..

fail() {
    printf '%s\n' "$1" >&2
    exit 1
}

# setting FILE KEY: the quoted value of the first `KEY = "value"` line, without a leading >=
setting() {
    while IFS= read -r line; do
        case $line in
            "$2 "*\"*\" | "$2="*\"*\")
                line=${line#*\"}
                line=${line%%\"*}
                printf '%s' "${line#>=}"
                return
                ;;
        esac
    done <"$1"
    fail "$1 has no line '$2 = \"...\"', which says the version that bipenalty needs: restore the file."
}

# at_least FOUND NEEDED: compares major.minor
at_least() {
    case $1 in
        [0-9]*.[0-9]*) ;;
        *) return 1 ;;
    esac
    found_rest=${1#*.}
    found_minor=${found_rest%%[!0-9]*}
    needed_rest=${2#*.}
    needed_minor=${needed_rest%%[!0-9]*}
    [ "${1%%.*}" -gt "${2%%.*}" ] || { [ "${1%%.*}" -eq "${2%%.*}" ] && [ "$found_minor" -ge "$needed_minor" ]; }
}

check_rust() {
    needed=$(setting "$root/Cargo.toml" rust-version) || exit 1
    if ! command -v cargo >/dev/null 2>&1; then
        if [ -x "${HOME:-}/.cargo/bin/cargo" ]; then
            fail "cargo is in ~/.cargo/bin but not on PATH: bipenalty needs Rust $needed or newer, so run '. ~/.cargo/env' and try again."
        fi
        fail "cargo was not found: bipenalty needs Rust $needed or newer, so install it (https://rustup.rs) and try again."
    fi
    version=$(rustc --version 2>/dev/null) ||
        fail "cargo was found but 'rustc --version' fails: bipenalty needs Rust $needed or newer, so install it (rustup default stable, or https://rustup.rs) and try again."
    found=${version#rustc }
    found=${found%% *}
    at_least "$found" "$needed" ||
        fail "rustc is version $found: bipenalty needs Rust $needed or newer, so update it (rustup update stable, or https://rustup.rs) and try again."
}

check_python() {
    needed=$(setting "$root/pyproject.toml" requires-python) || exit 1
    reason=
    for candidate in ${PYTHON:-python3 python3.13 python3.12 python3.11 python3.14}; do
        command -v "$candidate" >/dev/null 2>&1 || continue
        found=$("$candidate" -c 'import sys; print("%d.%d.%d" % sys.version_info[:3])' 2>/dev/null) || continue
        if ! at_least "$found" "$needed"; then
            : "${reason:="$candidate is version $found: bipenalty needs Python $needed or newer, so install one (python$needed on PATH is found by itself) or name it with 'make PYTHON=/path/to/python ...'."}"
        elif ! "$candidate" -c 'import venv, ensurepip' >/dev/null 2>&1 &&
            ! "$candidate" -c 'import venv, pip' >/dev/null 2>&1; then
            : "${reason:="$candidate (version $found) has no venv or no pip: bipenalty needs both for its .venv, so install them (Debian and Ubuntu: apt install python3-venv python3-pip) and try again."}"
        else
            command -v "$candidate"
            return
        fi
    done
    fail "${reason:-"${PYTHON:-python3} was not found or does not run: bipenalty needs Python $needed or newer with venv and pip, so install it (https://www.python.org/downloads) or name it with 'make PYTHON=/path/to/python ...'."}"
}

for part in "${@:-all}"; do
    case $part in
        rust) check_rust ;;
        python) check_python ;;
        all) check_rust && check_python ;;
        *) fail "check_toolchain.sh: '$part' is not a part of the toolchain: name rust, python or nothing." ;;
    esac
done
