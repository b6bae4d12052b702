#!/bin/sh
# The commands of README as printed, in a fresh clone and environment, to the report of a study of one's own. Left out are
# those of make, which .ci/run calls itself with the study that they repeat, and `serve`, which waits for a user.
set -eu

repository=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-$(command -v "$repository/.venv/bin/python" || command -v python3)}
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
unset PYTHONPATH

git clone --quiet "$repository" "$place/clone"
cd "$place/clone"
"$python" -m venv "$place/venv"
export PATH="$place/venv/bin:$PATH" PIP_QUIET=1 PIP_DISABLE_PIP_VERSION_CHECK=1
awk '/^```sh/ { printed = 1; next } /^```/ { printed = 0 } printed' README.md |
    sed "/^make/d; / serve /d; /smoke.yaml/d; s#/tmp/#$place/#g" >"$place/commands"
bash -exuo pipefail "$place/commands"
for made in mix/diagnosis.html law.inp mixes forecast clone/results/mine/report.html; do
    [ -s "$place/$made" ] || { echo "error: README's commands left no $made" >&2; exit 1; }
done
echo "README's commands work as printed."
