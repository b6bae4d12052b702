#!/bin/sh
# A clone as one meets it who knows Snakemake and not `make`: their own Snakemake, without our plugins.
#   sh tools/try_snakemake.sh [snakemake==9.19.0]
set -eu

repository=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-$(command -v "$repository/.venv/bin/python" || command -v python3)}
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
unset PYTHONPATH

git clone --quiet "$repository" "$place/clone"
cd "$place/clone"
"$python" -m venv "$place/venv"
pip="$place/venv/bin/python -m pip --quiet --disable-pip-version-check"
snakemake=$place/venv/bin/snakemake

echo "Snakemake alone plans the study, as it does where jobs have an environment of their own."
$pip install "${1:-snakemake==9.19.0}"
"$snakemake" --version
"$snakemake" --dry-run --configfile config/smoke.yaml --quiet rules | grep '^total ' >/dev/null

echo "Any Snakemake plans it."
