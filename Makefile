# Everything a fresh machine needs: Python 3.11 or newer, git and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
export JAX_PLATFORMS ?= cpu

.PHONY: reproduce test test-slow lint data clean

reproduce: $(VENV)/installed
	$(BIN)/hemma reproduce $(ARGS)

test: $(VENV)/developing lint
	$(BIN)/pytest -q -n 2 -m "not slow"

test-slow: $(VENV)/developing
	$(BIN)/pytest -q -m slow

lint: $(VENV)/developing
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright
	$(BIN)/lint-imports

data: $(VENV)/developing
	$(BIN)/python scripts/make_austin2021.py

$(VENV)/bin/python:
	$(PYTHON) -c 'import sys; sys.exit("Hemma needs Python 3.11 or newer, this is " + sys.version if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(VENV)

$(VENV)/installed: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install -q --disable-pip-version-check -e '.[nlp]'
	touch $@

$(VENV)/developing: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install -q --disable-pip-version-check -e '.[dev,maintainer]'
	touch $@ $(VENV)/installed

clean:
	rm -rf $(VENV) build dist *.egg-info
