# Needs Python 3.11 or newer and make, nothing else: each target creates .venv when it is missing or stale, from
# requirements.lock where it only runs, and adds requirements-dev.lock where it tests or builds.
# Another Python: make report PYTHON=python3.12

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check --no-input

# Work is parallel over processes; threads of the linear algebra would only compete with them.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
export MKL_NUM_THREADS ?= 1

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

##@ What the project is for

.PHONY: report
report: $(VENV)/.ready ## recompute every exhibit and write build/report/index.html
	$(BIN)/replicate report

.PHONY: handouts
handouts: $(VENV)/.ready ## build the handouts of all papers, build/handouts/*.pdf
	$(BIN)/replicate handout

##@ Does it still hold?

.PHONY: test
test: $(VENV)/.developed ## run the tests and the examples in the docstrings: make test [ARGS=--cov]
	@# Once, and not in each of the processes that the tests start, where Python is not to write what it compiles.
	@$(BIN)/python -m compileall -q replicate
	$(BIN)/python -m pytest -n auto --dist loadscope --no-loadscope-reorder --durations=10 --durations-min=1 $(ARGS)

.PHONY: check
check: $(VENV)/.ready ## every printed value holds or is explained, and nothing has moved
	$(BIN)/replicate check

.PHONY: diff
diff: $(VENV)/.ready ## say what differs from the accepted state: make diff [ONLY=khan/fig-4]
	$(BIN)/replicate diff $(ONLY)

.PHONY: accept
accept: $(VENV)/.ready ## make the present state the accepted one: make accept REASON="why" [ONLY=...]
	$(BIN)/replicate accept $(ONLY) --reason "$$REASON"

.PHONY: drift
drift: $(VENV)/.developed build/drift/.ready ## papers and gallery under an older matplotlib and other BLAS kernels: no alarm
	@build/drift/bin/python -c 'import matplotlib; print("matplotlib", matplotlib.__version__, "and kernels for", "$(DRIFT_CORE)")'
	$(BIN)/python tests/gallery_drift.py write build/drift/gallery
	OPENBLAS_CORETYPE=$(DRIFT_CORE) build/drift/bin/python tests/gallery_drift.py compare build/drift/gallery
	OPENBLAS_CORETYPE=$(DRIFT_CORE) build/drift/bin/replicate diff $(ONLY) --out build/drift/run

.PHONY: torture
torture: $(VENV)/.developed ## attack every promise and count what held: killed, interrupted, damaged, misused
	$(BIN)/python -m pytest tests/torture --torture -n auto --dist load -q $(ARGS)

.PHONY: bench
bench: $(VENV)/.developed ## measure speed and error beside python-control and others: build/bench.md; a report, too: ARGS=--report
	$(BIN)/python -m benchmarks $(ARGS)

.PHONY: scaling
scaling: $(VENV)/.developed ## how sweeps of up to a million loops grow, on a cluster of one and of two workers
	$(BIN)/python tools/sweep_scaling.py

.PHONY: units
units: $(VENV)/.developed ## try 1,000 random loops in other units of time and gain (about two minutes)
	$(BIN)/python tests/loops/equivariance.py 1000

.PHONY: conformance
conformance: $(VENV)/.developed ## exact values of hard loops: ours must have nine digits, python-control's are shown
	$(BIN)/python -m replicate.loops.conformance --library replicate --loops --require 9
	$(BIN)/python -m replicate.loops.conformance --library python-control

.PHONY: goldens
goldens: $(VENV)/.developed ## compute the exact values of replicate/loops/goldens.json again: make goldens [ARGS="--check ID ..."]
	$(BIN)/python tools/goldens/make.py $(ARGS)

##@ Working on it

.PHONY: lint
lint: $(VENV)/.developed ## ruff (rules and format), mypy --strict, and oxlint for the script of the what-if page
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/oxlint --deny-warnings templates/whatif
	$(BIN)/mypy

COMPILE := --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
    --custom-compile-command "make lock"

.PHONY: docs
docs: $(VENV)/.developed ## build the documentation as a site that needs no network: build/docs/index.html
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

.PHONY: lock
lock: $(VENV)/.developed ## remake both locks from pyproject.toml: make lock [ARGS=--upgrade]
	$(BIN)/uv pip compile pyproject.toml --group build --output-file requirements.lock $(COMPILE) $(ARGS)
	$(BIN)/uv pip compile pyproject.toml --group dev --all-extras --constraint requirements.lock \
	    --output-file requirements-dev.lock $(COMPILE) $(ARGS)
	$(BIN)/python .ci/date_lock.py $(BIN)/uv requirements.lock requirements-dev.lock

.PHONY: dist
dist: $(VENV)/.ready ## build the source archive and the wheel in dist/
	$(BIN)/hatchling build

.PHONY: clean
clean: ## remove what runs leave behind (build/ and caches); .venv stays
	rm -rf build dist .coverage .hypothesis .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -not -path './.venv/*' -prune -exec rm -rf {} +

.PHONY: help
help: ## list the targets
	@awk 'BEGIN { FS = ":.*## " } \
	    /^##@/ { printf "%s%s\n", (n++ ? "\n" : ""), substr($$0, 5) } \
	    /^[a-z]+:.*## / { printf "  make %-11s  %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))

# ------------------------------------------------------------------------------------------- environments

# A Python named on the command line that is not the one .venv was made with makes .venv stale.
ifeq ($(origin PYTHON),command line)
ifneq ($(shell cat $(VENV)/.locked 2>/dev/null),$(PYTHON))
.PHONY: $(VENV)/.locked
endif
endif

# $(call create,folder): an environment with exactly what the lock names, every file checked by its hash.
define create
	@$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed, $(PYTHON) is " \
	    + sys.version.split()[0] if sys.version_info < (3, 11) else 0)'
	@echo "creating $(1) from requirements.lock"
	@$(PYTHON) -m venv --clear $(1)
	@$(1)/bin/python -m pip --quiet --disable-pip-version-check --no-input \
	    install --require-hashes --only-binary :all: -r requirements.lock
endef

$(VENV)/.locked: requirements.lock
	$(call create,$(VENV))
	@echo $(PYTHON) > $@

$(VENV)/.ready: $(VENV)/.locked pyproject.toml
	@$(PIP) install --no-deps --no-build-isolation --editable .
	@touch $@

$(VENV)/.developed: requirements-dev.lock $(VENV)/.ready
	@echo "adding to $(VENV) what requirements-dev.lock names"
	@$(PIP) install --require-hashes --only-binary :all: -r requirements-dev.lock
	@touch $@

# Not from the lock, on purpose: the point is to run with another matplotlib than the locked one.
DRIFT_MATPLOTLIB ?= 3.9.*
DRIFT_CORE ?= $(if $(filter x86_64,$(shell uname -m)),Prescott,ARMV8)

build/drift/.ready: requirements.lock pyproject.toml
	$(call create,build/drift)
	@build/drift/bin/python -m pip --quiet --disable-pip-version-check --no-input \
	    install --only-binary :all: 'matplotlib==$(DRIFT_MATPLOTLIB)'
	@build/drift/bin/python -m pip --quiet --disable-pip-version-check --no-input \
	    install --no-deps --no-build-isolation --editable .
	@touch $@
