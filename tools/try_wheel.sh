#!/bin/sh
# Build the wheel and use it as a newcomer would: in an empty environment, outside the repository, without Snakemake.
#   PYTHON=python3 sh tools/try_wheel.sh    where there is no .venv
set -eu

repository=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-$repository/.venv/bin/python}
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

left() { git -C "$repository" status --porcelain --ignored | sed '/egg-info/d'; }
before=$(left)
"$python" -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir "$place" "$repository"
[ "$before" = "$(left)" ] || { echo "error: building the wheel left files in the repository" >&2; exit 1; }

"$python" -m venv --without-pip "$place/venv"
programs=$place/venv/bin
[ -d "$programs" ] || programs=$place/venv/Scripts # on Windows
# Versions as locked, so that the trial does not depend on what was released today.
sed -n '/^[a-zA-Z0-9]/s/ *\\$//p' "$repository/requirements.txt" >"$place/locked.txt" # without the hashes
"$python" -m pip --python "$programs/python" install --quiet --disable-pip-version-check \
    --constraint "$place/locked.txt" "$place"/asphalt_nscd-*.whl

cp -r "$repository/data/tutorial/exports" "$place/exports"
cd "$place"
unset PYTHONPATH
PATH="$programs:/usr/bin:/bin"
python -c "import importlib.util as u; assert not any(map(u.find_spec, ('snakemake', 'numba', 'matplotlib'))), 'an extra came along'"
python -c "import asphalt_nscd as an; print(an.diagnose('exports', draws=an.Draws(500)))" | grep '^Data ' >/dev/null
asphalt-nscd --version
asphalt-nscd diagnose exports --output out --draws 500 | grep "Written to out"
asphalt-nscd export out/law.json --format abaqus --output mix.inp
asphalt-nscd figure --help >/dev/null
grep -q '^\*VISCOELASTIC' mix.inp
echo "The wheel works without the repository and without Snakemake."
