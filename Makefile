# The two README commands (make sweep, make test) and the developers' habits. Needs cargo, Python and make only.
#
# Everything is set up once, in .venv, from requirements.lock; the extension is rebuilt when a Rust file changes.
# Another interpreter: make clean, then make PYTHON=/path/to/python test

VENV      := .venv
RUN       := $(VENV)/bin/python
EXTENSION := python/bipenalty/_core.abi3.so
SOURCES   := Cargo.toml Cargo.lock pyproject.toml $(shell find rust -type f)

MPLBACKEND ?= Agg
export MPLBACKEND
export PIP_DISABLE_PIP_VERSION_CHECK := 1
export PIP_NO_INPUT := 1
# What another environment left behind must not reach into .venv.
unexport CONDA_PREFIX PYTHONHOME PYTHONPATH

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help sweep stability charts test check bench peers figures setup clean toolchain

help:
	@echo "make sweep     the colliding-cylinder study: tables and figures into out/"
	@echo "make stability maps of where each method holds, into out/"
	@echo "make charts    speed against accuracy on seven scenes, into out/ and docs/charts.md"
	@echo "make test      all Rust and Python tests"
	@echo "make check     formatting, lints, types and stubs"
	@echo "make bench     the measurements behind the performance claims"
	@echo "make peers     the same collision in other programs, into docs/peers.md; options in PEERS=..."
	@echo "make figures   the figures of the README, into docs/figures/"
	@echo "make setup     only .venv and the extension, as the others do first"
	@echo "make clean     remove everything that was built, installed or written"

sweep: setup
	$(RUN) examples/penalty_sweep.py

stability: setup
	$(RUN) examples/stability.py

charts: setup
	$(RUN) examples/charts.py

test: setup
	cargo test --locked
	$(RUN) -m pytest

check: export PYO3_PYTHON := $(CURDIR)/$(RUN)
check: setup
	cargo fmt --all --check
	cargo clippy --locked --workspace --all-targets -- -D warnings
	$(RUN) -m ruff check
	$(RUN) -m mypy
	$(RUN) -m mypy.stubtest --mypy-config-file pyproject.toml bipenalty._core

bench: setup
	$(RUN) benchmarks/run.py

peers: setup
	$(RUN) benchmarks/peers/run.py $(PEERS)

figures: sweep stability charts
	mkdir -p docs/figures
	cp out/*.png docs/figures/

setup: $(EXTENSION)

clean:
	rm -rf $(VENV) target dist out .mypy_cache .pytest_cache .ruff_cache python/bipenalty/_core.*so
	find python tests examples benchmarks -name __pycache__ -prune -exec rm -rf {} + 2>/dev/null || true

toolchain:
	@sh scripts/check_toolchain.sh rust

# A virtual environment works only where it was made: one that was moved, copied or lost its Python is made anew.
ifneq ($(shell test -x $(RUN) && cat $(VENV)/.place 2>/dev/null),$(CURDIR))
.PHONY: $(VENV)/.place
endif

# Some distributions ship pip without ensurepip: then their own pip puts one into the environment.
$(VENV)/.place: | toolchain
	@python=$$(sh scripts/check_toolchain.sh python) || exit 1; \
	echo "Setting up $(VENV) with $$python"; \
	rm -rf $(VENV); \
	if "$$python" -c 'import ensurepip' 2>/dev/null; then "$$python" -m venv $(VENV); \
	else "$$python" -m venv --without-pip $(VENV) && \
	     "$$python" -m pip --python $(RUN) install --quiet pip; fi && \
	echo "$(CURDIR)" > $@

$(VENV)/.packages: requirements.lock $(VENV)/.place
	@echo "Installing the packages of requirements.lock"
	@$(RUN) -m pip install --quiet --requirement requirements.lock || \
	{ echo "The packages of requirements.lock could not be installed: the first run needs a network." >&2; exit 1; }
	@touch $@

$(EXTENSION): $(SOURCES) $(VENV)/.packages
	VIRTUAL_ENV="$(CURDIR)/$(VENV)" PIP_QUIET=1 $(VENV)/bin/maturin develop --release --locked
	@touch -c $@
