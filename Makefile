# The doorway: sets up .venv and hands over to Snakemake, which does the work.
#
#   make            the paper study
#   make smoke      the same chain at reduced size, in minutes
#   make test       the tests
#   make test-fast  the tests without the slow ones
#   make lint       ruff, snakefmt and mypy
#   make attack     hidden faults, found or not: in tables as laboratories produce them, in measured ones (also those of
#                   the folder that ASPHALT_NSCD_TABLES names) and inside NSCD runs: an hour of a core;
#                   config/attack.yaml says how many tables
#   make verify     the core against theory: results/verification/verification.csv
#   make check      published results made again where that is cheap, and compared: minutes
#   make faults     what must not lose or falsify a result: results/faults/faults.csv, half an hour
#   make fuzz       a hundred thousand inputs to all readers, a thousand wild tables to the diagnosis, ten thousand calls
#   make cluster    the smoke study through a Slurm started here, where Debian's is installed
#   make docs       these documents and the reference of all modules as a site: site/index.html
#   make api        the reference alone, from docstrings: docs/api
#   make benchmark  how fast it is beside its peers: results/benchmark/benchmark.csv
#   make study CONFIG=my.yaml     any other study
#
# CORES=1 limits the cores; PYTHON=/path/to/python3.12 chooses the Python.

CORES ?= all
# Named one by one: of the package itself, pdoc shows only the names in its __all__ (among them specimen).
ROOMS := $(filter-out asphalt_nscd.cli asphalt_nscd.specimen,$(patsubst src/asphalt_nscd/%/__init__.py,asphalt_nscd.%,\
	$(wildcard src/asphalt_nscd/*/__init__.py)))
CONFIG ?=
READY := .venv/.ready
TOOLS := .venv/.tools

# Packages compile their bytecode once, at installation, not in every job.
unexport PYTHONDONTWRITEBYTECODE

# An environment that was moved, or that does not start any more, is made again.
ifneq ($(shell cat $(READY) 2>/dev/null),$(CURDIR))
.PHONY: $(READY)
else ifneq ($(shell .venv/bin/asphalt-nscd --version >/dev/null 2>&1 && echo works),works)
.PHONY: $(READY)
endif

# Said at once: Snakemake answers a missing configuration with a traceback.
ifeq ($(filter study,$(MAKECMDGOALS))$(shell test -f "$(CONFIG)" && echo found),study)
$(error $(or $(CONFIG),CONFIG): no such file; give a study with CONFIG=my.yaml)
endif

.PHONY: paper smoke attack study test lint verify check faults fuzz cluster benchmark api docs test-fast

paper: $(READY)
	@.venv/bin/snakemake --logger steps --cores $(CORES) --configfile config/paper.yaml

smoke: $(READY)
	@.venv/bin/snakemake --logger steps --cores $(CORES) --configfile config/smoke.yaml

attack: $(READY)
	@.venv/bin/snakemake attack publish_machines publish_inside --logger steps --cores $(CORES) --configfile config/paper.yaml config/attack.yaml
	@cat results/attack/summary.csv results/attack/inside_summary.csv

study: $(READY)
	@.venv/bin/snakemake --logger steps --cores $(CORES) --configfile $(CONFIG)

verify: $(TOOLS)
	@.venv/bin/snakemake --logger steps --cores $(CORES) verify
	@echo "Table: $(CURDIR)/results/verification/verification.csv"

benchmark: $(READY)
	@.venv/bin/snakemake benchmark --logger steps --cores 1 --configfile config/paper.yaml
	@echo "Tables: $(CURDIR)/results/benchmark/benchmark.csv, growth.csv"

test: $(TOOLS)
	.venv/bin/python -m pytest -n auto --dist loadfile

test-fast: $(TOOLS)
	.venv/bin/python -m pytest -n auto --dist loadfile -m "not slow"

check: $(TOOLS)
	@.venv/bin/python tools/check.py

faults: $(TOOLS)
	@PYTHONPATH=trials .venv/bin/python -m faults

fuzz: $(TOOLS)
	@PYTHONPATH=trials:tests .venv/bin/python -m fuzz
	@OPENBLAS_NUM_THREADS=1 PYTHONPATH=trials:tests .venv/bin/python -m fuzz.diagnoses 1000 \
		$(if $(filter all,$(CORES)),,--jobs $(CORES)) --output results/fuzz
	@OPENBLAS_NUM_THREADS=1 PYTHONPATH=trials:tests .venv/bin/python -m fuzz.calls --output results/calls

cluster: $(TOOLS)
	@PYTHONPATH=trials .venv/bin/python -m cluster

api: $(TOOLS)
	@.venv/bin/pdoc --docformat numpy --output-directory docs/api asphalt_nscd $(ROOMS)
	@echo "Reference: $(CURDIR)/docs/api/index.html"

docs: $(TOOLS) api
	@NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --strict # with --quiet it would be silent on dead links
	@echo "Site: $(CURDIR)/site/index.html"

lint: $(TOOLS)
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/snakefmt --check --compact-diff Snakefile workflow
	.venv/bin/mypy

$(READY): requirements-study.txt pyproject.toml
	@sh tools/venv.sh study

$(TOOLS): $(READY) requirements.txt
	@sh tools/venv.sh tools
