# Everything is made inside this folder: the environment in .venv, all caches in .cache.
# Paths in recipes are relative, so the checkout may lie in a folder with spaces in its name.

.DEFAULT_GOAL := help
.PHONY: help setup demo-setup robot-setup demo reproduce test long parity robot robot-faults faults fuzz
.PHONY: cancels lint types bench soak dist clean
.SUFFIXES:

BIN := .venv/bin
CACHE := $(CURDIR)/.cache
JOBS ?= 2
OUT ?= results
ARGS ?=
MESSAGES ?= 100000
FILES ?= 20000
SEED ?= 0

export XDG_CACHE_HOME := $(CACHE)/xdg
export PIP_CACHE_DIR := $(CACHE)/pip
export UV_CACHE_DIR := $(CACHE)/uv
export MPLCONFIGDIR := $(CACHE)/matplotlib
export ROS_HOME := $(CACHE)/ros
export ROS_LOG_DIR := $(CACHE)/ros/log
export HYPOTHESIS_STORAGE_DIRECTORY := $(CACHE)/hypothesis
export MYPY_CACHE_DIR := $(CACHE)/mypy
export RUFF_CACHE_DIR := $(CACHE)/ruff
export PYTEST_DEBUG_TEMPROOT := $(CACHE)/tmp
# uv does not compile what it installs: without a cache of bytecode each of the many processes of a
# graph or a test compiles a few hundred modules again.
export PYTHONPYCACHEPREFIX := $(CACHE)/python
unexport PYTHONDONTWRITEBYTECODE

# A sourced ROS installation, or a ROS process of another environment that calls make, must not
# be mixed into this one.
ifneq ($(AMENT_PREFIX_PATH)$(_ROS_WHEELS_BOOTSTRAP_COMPLETE),)
unexport LD_LIBRARY_PATH
endif
unexport PYTHONPATH PYTHONHOME AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE

help:  ## Show this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-9s  %s\n", $$1, $$2 }' Makefile

setup:  ## Make .venv, or bring it up to date (PYTHON=... picks the interpreter)
	@sh requirements/setup.sh

demo-setup:
	@sh requirements/setup.sh demo

demo: demo-setup  ## Rebuild three towers through the ROS graph, with a bag and a picture
	rm -rf demo
	$(BIN)/blocks-planning run config/trials/demo.yaml --out demo --bag demo/bag --pace 0.15
	$(BIN)/blocks-planning verify demo/bag
	$(BIN)/blocks-planning draw demo/bag --record 2 --out demo/tower.png
	@echo 'The second tower is in demo/tower.png.'

robot-setup:
	@sh requirements/setup.sh robot

robot: robot-setup  ## Let a simulated robot build a tower through the graph, and film it
	rm -rf robot
	$(BIN)/blocks-planning run config/trials/robot.yaml --out robot --robot
	$(BIN)/blocks-planning verify robot/trials.jsonl
	$(BIN)/python -m benchmarks.robot --tower 13 --film robot/robot.gif
	@echo 'The film is in robot/robot.gif.'

reproduce: setup  ## Run every experiment of the paper (OUT=folder, ARGS=--quick)
	$(BIN)/blocks-planning reproduce --out $(OUT) $(ARGS)

test: setup  ## Run the tests (ARGS='-k word' for some, JOBS=4 for more processes)
	$(BIN)/python test/compile_kernels.py
	$(BIN)/pytest -n $(JOBS) $(ARGS)

parity: setup  ## Compare 388 trials through the graph with the same in one process
	$(BIN)/pytest -n $(JOBS) -m '' test/parity $(ARGS)

long: setup  ## Run the tests that take long (ARGS='-k word' for some)
	$(BIN)/python test/compile_kernels.py
	$(BIN)/pytest -n $(JOBS) -m long $(ARGS)

faults: setup  ## Kill nodes while trials run (ARGS='--kills 200 --trials 60 --seed 0')
	PYTHONPATH=test $(BIN)/python -m faults $(ARGS)

robot-faults: setup robot-setup  ## Cancel the robot 100 times, kill its node 50 times (ARGS='--seed 0')
	PYTHONPATH=test $(BIN)/python -m faults.robot $(ARGS)

fuzz: setup  ## Send 100,000 hostile messages, read 20,000 spoilt files (MESSAGES, FILES, SEED)
	cd test && ../$(BIN)/python -m faults.fuzz_messages $(MESSAGES) $(SEED)
	cd test && ../$(BIN)/python -m faults.fuzz_files $(FILES) $(SEED)

cancels: setup  ## Cancel 1,000 goals, each at a moment of its own (ARGS='COUNT SEED')
	cd test && ../$(BIN)/python -m faults.cancels $(ARGS)

lint: setup  ## Check style and format
	$(BIN)/ruff check
	$(BIN)/ruff format --check

types: setup  ## Check types
	$(BIN)/mypy

bench: setup  ## Measure speed
	$(BIN)/python -m benchmarks $(ARGS)

soak: setup  ## Run 20 000 trials through one graph, and see what grows (ARGS='--trials N')
	$(BIN)/python -m benchmarks.soak $(ARGS)

dist: setup  ## Build the distributions of the package into dist/, and check them
	rm -rf dist
	$(BIN)/python -m build --no-isolation --outdir dist .
	$(BIN)/twine check --strict dist/*

clean:  ## Remove everything that was made here
	rm -f .venv/.stamp-*
	rm -rf .venv .cache .hypothesis build install log *.egg-info
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
