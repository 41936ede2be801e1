# Two commands are enough: `make run` and `make test`.
# Needs python3 (3.11 or newer) with pip, make and git; no venv module, no root, no compiler.
.DEFAULT_GOAL := help
SHELL := /bin/sh

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
# The C sources are told by what is in them: a copy or an archive may keep the time of an older file.
NATIVE := $(shell cksum rotctl/native/*.[ch] | cksum | cut -d ' ' -f 1)
STAMP  := $(VENV)/.installed-$(NATIVE)
CODE   := $(VENV)/.compiled

# uv makes the environment: a bare Debian has no venv module. One wheel, pinned by hash
# (Linux x86-64 and arm64, macOS x86-64 and arm64: where MuJoCo runs and make is at home).
UV_VERSION := 0.13.9
UV_HASHES  := \
	d7f459fe4fd247d830351c75686d3996ace3c6f3f728eb0e85a30b7ada0cef19 \
	5435c5ce14a56431208ca0996416d310f1598e8c2c8ba707688985a16bb82dbe \
	c16ed11e013557536b3e60065f1b912f6407bd6518e041b961e23ef9e6b4fbf5 \
	66c512266d633bef48384a1f53003f41f2a8e7b36fe6e7fbfd3e0fd52d96fa63
UV_DIR := .tools/uv-$(UV_VERSION)
UV     := $(UV_DIR)/bin/uv
export UV_PYTHON_DOWNLOADS := never
# Trust what the system's pip trusts: uv's own list lacks the certificates of company proxies.
ifneq ($(wildcard /etc/ssl/certs/ca-certificates.crt),)
export UV_SYSTEM_CERTS := true
endif

# The matrices are small: more threads make it slower, and runs less repeatable.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS      := 1
export MKL_NUM_THREADS      := 1

.PHONY: help
help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "  make %-9s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))

.PHONY: run
run: setup ## simulate a forward roll, with a progress bar; writes the log and a filmstrip into runs/
	$(BIN)/rotctl run behaviour=forward_roll_1 --out runs --filmstrip

.PHONY: test
test: lint ## lint, types, floors, then the fast tests
	$(BIN)/python -m pytest --numprocesses auto --dist worksteal

.PHONY: readme
readme: setup ## put what `make run` and the notebook print into them, after a change that rolls otherwise
	$(BIN)/python tests/cells.py
	$(BIN)/python tests/readme_sample.py

.PHONY: torture
torture: setup ## the long tests: sweeps of 200 runs whose processes are killed again and again
	$(BIN)/python -m pytest -m slow

.PHONY: fuzz
fuzz: setup ## give 2,000 hostile inputs to the commands (FUZZ='--seed 1' others, FUZZ='--only 1:23' one)
	$(BIN)/python tests/fuzz $(FUZZ)

.PHONY: setup
setup: $(STAMP) $(CODE) ## make .venv from requirements.lock (a second call does nothing)

.PHONY: format
format: setup ## lay the code out and sort the imports
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .

.PHONY: lint
lint: setup ## style, layout, types, floors: changes nothing
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# Three starts a row take minutes on two cores: make reproduce QUICK=1
# The same commit goes on where it was interrupted; another one must not mix its runs with the old.
# All of them make some twelve thousand runs, in hours on two cores; Table 1 comes first.
FIRST     = table1 contrasts
EVERY     = $(sort $(basename $(notdir $(wildcard experiments/*.yaml))))
STUDIES   = $(FIRST) $(if $(QUICK),,$(filter-out $(FIRST),$(EVERY)))
REPRODUCE = sweeps/reproduce$(if $(QUICK),-quick)/$(or $(shell git describe --always --dirty 2>/dev/null),unversioned)
.PHONY: reproduce
reproduce: setup ## run all experiments, build the page site/index.html (QUICK=1: two of them, three starts a row)
	number=10; for study in $(STUDIES); do number=$$((number + 1)); \
		$(BIN)/rotctl sweep +experiment=$$study $(if $(QUICK),'seed=range(0,3)') \
			--out $(REPRODUCE)/$$number-$$study || [ $$? -eq 1 ] || exit; done # 1: a run failed; the page says so
	$(BIN)/rotctl report $(REPRODUCE) --out site

.PHONY: docs
docs: setup ## make a site of docs/ with search and a reference: docs/_build/html/index.html
	$(BIN)/sphinx-build --quiet --fail-on-warning --keep-going docs docs/_build/html

.PHONY: bench
bench: setup ## time the control tick
	$(BIN)/rotctl bench

# placo pins Pinocchio, and Pinocchio an older numpy: they get an environment of their own.
PEERS = placo==0.10.2 proxsuite==0.8.0 daqp==0.11.0 qpsolvers==4.13.0
.PHONY: peers
peers: setup ## time the control step beside placo and Pinocchio, in .tools/peers
	test -x .tools/peers/bin/python || $(UV) venv --quiet .tools/peers
	$(UV) pip install --quiet --python .tools/peers/bin/python $(PEERS) --requirements pyproject.toml
	PYTHONPATH=. .tools/peers/bin/python -c 'from rotctl.bench import peers; print(peers.compare())'

ELSEWHERE = pin==4.1.0 gymnasium==1.4.0 imageio==2.37.0 mujoco==4.0.0 pytest
.PHONY: elsewhere
elsewhere: setup ## load an exported model into Pinocchio and gymnasium, in .tools/elsewhere
	test -x .tools/elsewhere/bin/python || $(UV) venv --quiet .tools/elsewhere
	$(UV) pip install --quiet --python .tools/elsewhere/bin/python $(ELSEWHERE)
	rm -rf .tools/elsewhere/runs
	$(BIN)/rotctl run duration=0.1 --quiet --out .tools/elsewhere/runs
	$(BIN)/rotctl export .tools/elsewhere/runs/*/run.h5 --to mjcf --out .tools/elsewhere/adult.xml
	ROTCTL_EXPORTED=.tools/elsewhere/adult.xml .tools/elsewhere/bin/python -m pytest --noconftest \
		--override-ini addopts= -p no:cacheprovider tests/elsewhere.py

# The old pins are kept where they still fit; `make lock LOCKFLAGS=--upgrade` renews them all.
.PHONY: lock
lock: $(UV) ## remake requirements.lock from pyproject.toml (hashed, free of index addresses)
	$(UV) pip compile pyproject.toml --extra dev --quiet --universal --python-version 3.11 \
		--fork-strategy fewest --generate-hashes --no-emit-index-url --no-emit-find-links \
		--custom-compile-command 'make lock' --output-file requirements.lock $(LOCKFLAGS)
	@! grep -nE '://|index-url|find-links' requirements.lock

.PHONY: clean
clean: ## remove the environment, caches and builds (runs/, sweeps/ and site/ stay)
	rm -rf $(VENV) .tools dist build docs/_build .pytest_cache .mypy_cache .ruff_cache .import_linter_cache
	find rotctl tests experiments -name __pycache__ -type d -prune -exec rm -rf {} + 2>/dev/null || true

# ---------------------------------------------------------------- set-up

$(UV):
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
		echo "rotctl needs Python 3.11 or newer; '$(PYTHON)' is missing or older." >&2; \
		echo "Name another one: make $(or $(MAKECMDGOALS),setup) PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -m pip --version >/dev/null 2>&1 || { \
		echo "rotctl needs pip for $(PYTHON); on Debian: apt install python3-pip" >&2; exit 1; }
	rm -rf $(UV_DIR) && mkdir -p .tools
	@printf 'uv==$(UV_VERSION)$(foreach h,$(UV_HASHES), --hash=sha256:$(h))\n' > .tools/uv.txt
	PIP_ROOT_USER_ACTION=ignore $(PYTHON) -m pip install --quiet --disable-pip-version-check \
		--no-deps --only-binary :all: --require-hashes --target $(UV_DIR) -r .tools/uv.txt

# `sync` removes what the lock no longer names. antlr4-python3-runtime (of hydra-core) has no
# wheel: --build-constraints holds its build tools to the lock's hashes too. rotctl itself goes
# in last, as a link to this folder, built by the hatchling just installed.
$(STAMP): requirements.lock pyproject.toml hatch_build.py | $(UV)
	test -x $(BIN)/python || $(UV) venv --quiet --clear \
		--python "$$($(PYTHON) -c 'import sys; print(sys.executable)')" $(VENV)
	$(UV) pip sync --quiet --python $(BIN)/python --require-hashes --compile-bytecode \
		--build-constraints requirements.lock requirements.lock
	$(UV) pip install --quiet --python $(BIN)/python --no-deps --no-build-isolation --editable .
	@rm -f $(VENV)/.installed*
	@touch $@

# Byte-code is made here, that of the packages above. A container or a read-only folder keeps none
# that a run makes: each start would compile all it imports, which doubles its time.
$(CODE): $(STAMP) $(shell find rotctl -name '*.py')
	$(BIN)/python -m compileall -q rotctl
	@touch $@
