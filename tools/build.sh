#!/bin/sh
# Wheel and sdist into a folder: sh tools/build.sh dist
set -eu
output=$(mkdir -p "$1" && cd "$1" && pwd)
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
"$python" -m pip install --quiet --disable-pip-version-check build
"$python" -m build --outdir "$output" .
