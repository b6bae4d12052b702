#!/bin/sh
# Build sdist and wheel of the last commit, and use the wheel as a newcomer would: in an empty environment, outside the repository, without
# Snakemake, with each Python from 3.11 on that this machine has.
#   PYTHON=python3 sh tools/try_wheel.sh [dist]    keeps both in a folder; PYTHON is needed where there is no .venv
set -eu

repository=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-$repository/.venv/bin/python}
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
dist=$(mkdir -p "${1:-$place/dist}" && cd "${1:-$place/dist}" && pwd)

"$python" -m pip install --quiet --disable-pip-version-check --target "$place/uv" uv
uv=$place/uv/bin/uv
git clone --quiet "$repository" "$place/clone"
"$uv" build --quiet --out-dir "$dist" "$place/clone" # the wheel from the sdist
left=$(git -C "$place/clone" status --porcelain --ignored | sed '/egg-info/d')
[ -z "$left" ] || { echo "error: building the wheel left $left in the clone" >&2; exit 1; }

# Versions as locked, so that the trial does not depend on what was released today.
sed -n '/^[a-zA-Z0-9]/s/ *\\$//p' "$repository/requirements.txt" >"$place/locked.txt" # without the hashes
commit=$(git -C "$repository" describe --always --abbrev=40)

try() { (
    "$uv" venv --quiet --python "$1" "$place/venv"
    programs=$place/venv/bin
    [ -d "$programs" ] || programs=$place/venv/Scripts # on Windows
    "$uv" pip install --quiet --python "$programs/python" --constraint "$place/locked.txt" "$dist"/asphalt_nscd-*.whl
    rm -rf "$place/desk"
    mkdir "$place/desk"
    cp -r "$repository/data/tutorial/exports" "$place/desk/exports"
    cd "$place/desk"
    unset PYTHONPATH
    PATH="$programs:/usr/bin:/bin"
    python -c "import importlib.util as u; assert not any(map(u.find_spec, ('snakemake', 'numba'))), 'an extra came along'"
    python -c "import asphalt_nscd as an; print(an.diagnose('exports', draws=an.Draws(500)))" | grep '^Data ' >/dev/null
    asphalt-nscd --version | grep "commit $commit" >/dev/null
    asphalt-nscd diagnose exports --output out --draws 500 | grep "Written to out" >/dev/null
    asphalt-nscd export out/law.json --format abaqus --output mix.inp
    asphalt-nscd figure --help >/dev/null
    grep -q '^\*VISCOELASTIC' mix.inp
    echo "The wheel works with $(python --version), without the repository and without Snakemake."
); rm -rf "$place/venv"; }

try "$python"
for minor in 11 12 13 14; do
    other=$("$uv" python find --no-python-downloads "3.$minor" 2>/dev/null ||
        ls "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$minor".*/bin/python 2>/dev/null | tail -n 1)
    [ -z "$other" ] || [ "$("$other" -V)" = "$("$python" -V)" ] || try "$other"
done
