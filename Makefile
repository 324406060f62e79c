# Every target sets up .venv first and repeats nothing that is up to date.
PYTHON ?= python3
BIN := .venv/bin
RUN := $(BIN)/python
CONFIG ?= pipeline/config.toml
STAGES := $(RUN) -m pipeline --config $(CONFIG)
# Python compiles the modules that it imports; pip would compile all.
INSTALL := $(BIN)/pip install --no-compile --quiet --disable-pip-version-check -c constraints.txt
# Stages and tests start many processes: without bytecode each of them compiles anew what it imports.
export PYTHONDONTWRITEBYTECODE :=
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help setup demo tables validate corners figures runtime ensemble benchmark bench numbers prove same test evidence fuzz mutate torture matrix check clean interop interop-tools peer-tools debian-lists docs test-site site-tools release-check

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | awk -F':.*## ' '{printf "  make %-14s %s\n", $$1, $$2}'

setup: .venv/dev ## create .venv with everything pinned in constraints.txt
# What the stages of the demo need, and then what tests and checks need.
.venv/runs: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.version_info < (3, 11) and sys.exit("viscoroll needs Python 3.11 or newer, $(PYTHON) is %d.%d: make PYTHON=..." % sys.version_info[:2])'
	$(PYTHON) -m venv .venv
	$(INSTALL) -e '.[runs]'
	touch $@
.venv/dev: .venv/runs
	$(INSTALL) -e '.[dev]'
	touch $@

demo: .venv/runs ## tables, motions from them, validation, a benchmark, an ensemble of 10^6, figures and a page over all
	$(STAGES)
	@echo "Everything on one page: out/index.html"

tables: .venv/runs ## build data/tables/*.nc: the law of every alpha, of the paper's material, of a rubber, and of that on steel; a grid of Q, M, beta, lam and epsilon
	$(STAGES) offline

validate: .venv/runs ## tables and motions against direct solves; exit code 1 beyond a stated tolerance
	$(STAGES) validate

figures: .venv/runs ## the paper's figures and more, as PNG under out/figures
	$(STAGES) figures

runtime ensemble benchmark: .venv/runs
	$(STAGES) $@

corners: setup ## law and motions at the ends of what the package takes: out/corners.csv (a minute or two)
	$(RUN) -m pipeline.validate --corners --config $(CONFIG)

bench: setup peer-tools ## run time against error beside the peers, which it installs (long)
	$(RUN) -m pipeline.evidence.bench
	$(RUN) -m pipeline.evidence.figures
	$(RUN) -m pipeline.evidence.document

numbers: setup figures benchmark ## measure again what README and docs state, and put it there (about half an hour)
	$(RUN) -m pipeline.evidence.measure
	$(RUN) -m pipeline.evidence.measure.ensembles
	$(RUN) -m pipeline.evidence.measure.grids
	-$(RUN) -m pipeline.evidence.measure.outside
	-$(RUN) -m pipeline.evidence.measure.identification
	$(RUN) -m pipeline.evidence.measure.fits
	$(RUN) -m pipeline.evidence.measure.covers
	$(RUN) -m pipeline.evidence.document
	for name in geometry rolling-equilibria wheel-spin reversal slope; do cp out/figures/$$name.png docs/figures/; done
	$(BIN)/viscoroll sensitivity src/viscoroll/datasets/sensitivity.toml -o out/sensitivity.nc
	$(BIN)/viscoroll plot out/sensitivity.nc -o docs/figures/sensitivity.png

prove: setup ## law and motions against enclosures and extended precision: data/results/proofs.json (about 15 minutes)
	$(RUN) -m pipeline.evidence.prove
	$(RUN) -m pipeline.evidence.prove.independent
	$(RUN) -m pipeline.evidence.prove.unsteady
	$(RUN) -m pipeline.evidence.figures
	$(RUN) -m pipeline.evidence.prove.layer
	$(RUN) -m pipeline.evidence.prove.formulas
	$(RUN) -m pipeline.evidence.measure.large
	$(RUN) -m pipeline.evidence.document

BASE ?= HEAD
same: setup ## whether this tree computes the same bits as BASE, a commit (HEAD)
	$(RUN) -m pipeline.evidence.same --base $(BASE)

# Two processes of tests would wait for each other's kernels.  The cache has them until a kernel changes.
.venv/warm: .venv/runs $(shell find src/viscoroll/kernels -name '*.py' -o -name '*.npy')
	$(BIN)/viscoroll warmup
	touch $@

test: setup .venv/warm ## the test suite: what users meet
	$(BIN)/pytest -n 2 --dist worksteal -m "not long" --ignore tests/evidence $(TEST)

evidence: setup ## tests of what a release rests on: pipeline stages at small sizes, clusters, results that are kept
	$(BIN)/pytest -n 2 --dist worksteal tests/evidence
	$(BIN)/pytest -n 2 --dist worksteal -m long --ignore tests/evidence

SUDO := $(shell test $$(id -u) = 0 || echo sudo -n)
debian-lists:
	$(SUDO) apt-get update -qq || echo "Debian's lists of packages stay as they are"

# Of the peers of bench/, as interop-tools: the paper's method calls GSL, numbalsoda is built from Fortran and C++.
PEERS := libgsl-dev pkg-config gfortran g++ cmake
peer-tools: setup debian-lists
	$(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends $(PEERS) >/dev/null \
	  || echo "bench: not installed: $(PEERS)"
	$(INSTALL) -e '.[bench]' \
	  || echo "bench: not installed: numbalsoda"

DEBIAN := gcc g++ gfortran netcdf-bin libnetcdf-dev libnetcdff-dev octave octave-netcdf r-base-core r-cran-ncdf4 nodejs
interop: interop-tools ## laws in C, C++, Fortran, Octave, R, Node, FMUs, ncdump and the CF checker, which it installs
	$(BIN)/pytest -rs tests/evidence/test_interop.py tests/fmu

# What cannot be installed, without a network say, is told here, and its tests are skipped with that reason.
interop-tools: setup debian-lists
	$(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends $(DEBIAN) >/dev/null \
	  || echo "interop: not installed: $(DEBIAN)"
	$(INSTALL) -e '.[interop]' \
	  || echo "interop: not installed: compliance-checker, fmpy"

docs: .venv/docs ## the site, every example of it run: docs/_build/html/index.html (a minute or two)
	rm -rf docs/_build docs/api docs/gallery docs/tutorial
	$(RUN) -m sphinx -W --keep-going -n -E -q -b html docs docs/_build/html
.venv/docs: .venv/dev
	$(RUN) -c 'import fmpy, sphinx_gallery, pydata_sphinx_theme' 2>/dev/null \
	  || $(INSTALL) -e '.[docs]'
	touch $@

test-site: .venv/docs ## build the site without a warning; every public name and every picture is there, every example runs
	$(BIN)/pytest -rs tests/evidence/test_site.py tests/docs tests/cli

site-tools:
	command -v chromium chromium-browser google-chrome >/dev/null || { $(SUDO) apt-get update -qq; \
	  $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends chromium >/dev/null; } \
	  || echo "site-tools: not installed: chromium"

FUZZ_SECONDS ?= 600
fuzz: setup ## look for inputs that break the interface (10 minutes, FUZZ_SECONDS)
	FUZZ_SECONDS=$(FUZZ_SECONDS) $(BIN)/pytest tests/test_properties.py

mutate: setup ## plant defects in the kernels and see which the tests notice (half an hour)
	$(RUN) -m pipeline.evidence.mutate

torture: setup tables ## kill, flip, cut and starve files and count what goes unnoticed (about 5 minutes)
	$(RUN) -m pipeline.evidence.torture
	$(RUN) -m pipeline.evidence.document

matrix: setup ## wheel and sdist in fresh environments: every Python, newest and lowest dependencies (about 20 minutes; PYTHONS names others)
	$(RUN) -m pipeline.evidence.matrix

release-check: setup ## sdist and wheel, metadata, the README as a package page, licences, age of the numbers; what is left to the owner
	$(RUN) -m pipeline.evidence.release

check: setup ## ruff, mypy, the import contract, and zizmor on the workflows
	$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/mypy && $(BIN)/lint-imports
	$(BIN)/zizmor --offline --quiet .github
	MYPYPATH=src $(BIN)/mypy --strict --config-file= --follow-imports=silent --cache-dir .mypy_cache/user tests/typing

clean: ## remove what was built (tables, out, site, caches), keep .venv
	rm -rf data/tables out build dist docs/_build docs/api docs/gallery docs/tutorial .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -not -path './.venv/*' -prune -exec rm -rf {} +
