#!/bin/sh
# Did `make smoke` leave what it promises? With Chromium, also whether the report works in a browser.
set -eu
cd "$(dirname "$0")/.."

report=results/smoke/report.html
table=results/smoke/simulations.csv
[ -s "$report" ] || { echo "error: make smoke left no $report" >&2; exit 1; }
rows=$(($(wc -l <"$table") - 1))
[ "$rows" -eq 4 ] || { echo "error: $table has $rows rows, not 4" >&2; exit 1; }
PYTHONPATH=trials .venv/bin/python -m browser "$report"
