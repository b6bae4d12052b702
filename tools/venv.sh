#!/bin/sh
# Make the environment .venv, with the newest suitable Python and plain pip.
#   sh tools/venv.sh study    from requirements-study.txt
#   sh tools/venv.sh tools    add the rest of requirements.txt to it: tests, checks, documents
#   sh tools/venv.sh          both
set -eu

LOWEST_MINOR=11 # requires-python of pyproject.toml
VENV=.venv

fail() {
    echo "error: $*" >&2
    exit 2
}

suitable() {
    "$1" -c "import sys; sys.exit(not (3, $LOWEST_MINOR) <= sys.version_info < (4,))" >/dev/null 2>&1
}

# Newest version first; PYTHON=/path/to/python make overrides the search.
find_python() {
    if [ -n "${PYTHON:-}" ]; then
        suitable "$PYTHON" || fail "PYTHON=$PYTHON is not a Python 3.$LOWEST_MINOR or newer."
        echo "$PYTHON"
        return
    fi
    names=$(
        IFS=:
        for folder in $PATH; do ls "$folder" 2>/dev/null; done |
            sed -n 's/^python3\.\([0-9][0-9]*\)$/\1/p' | sort -rnu | sed 's/^/python3./'
    )
    for name in $names python3 python; do
        if suitable "$name"; then
            command -v "$name"
            return
        fi
    done
    fail "no Python 3.$LOWEST_MINOR or newer on PATH; install one (Debian: apt install python3-venv)" \
        "or name it with make PYTHON=/path/to/python3."
}

# Debian ships Python without ensurepip unless python3-venv is installed; a pip outside serves as well.
choose_pip() {
    if "$python" -c "import ensurepip" >/dev/null 2>&1; then
        pip="$VENV/bin/python -m pip" without=
    elif "$python" -m pip --version >/dev/null 2>&1; then
        pip="$python -m pip --python $VENV/bin/python" without=--without-pip
    else
        fail "$python has neither ensurepip nor pip; install them (Debian: apt install python3-venv)" \
            "and run make again."
    fi
}

add() {
    $pip install --quiet --disable-pip-version-check --compile --require-hashes --requirement "$1"
}

cd "$(dirname "$0")/.."
python=$(find_python)
choose_pip
if [ "${1:-}" != tools ]; then
    echo "Setting up $VENV with $("$python" --version)."
    rm -rf "$VENV"
    "$python" -m venv $without "$VENV"
    add requirements-study.txt
    $pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable . \
        --editable plugins/snakemake-logger-plugin-steps --editable plugins/snakemake-executor-plugin-slurm-chunks
    "$VENV/bin/python" -m compileall -q src
    pwd >"$VENV/.ready"
fi
if [ "${1:-}" != study ]; then
    echo "Adding tests, checks and documents to $VENV."
    add requirements.txt
    : >"$VENV/.tools"
fi
