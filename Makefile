# Every command runs in the environment that scripts/env finds or makes; `make` lists the targets.
ENV = scripts/env
CACHE = $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/thermowear
CORES = $(shell nproc)
RUFF = $(CACHE)/ruff-0.14/bin/ruff
WHOLE = THERMOWEAR_WITH=studies $(ENV)
PYTEST = OMP_NUM_THREADS=1 $(WHOLE) python3 -m pytest

.PHONY: help demo demos gallery docs links verification test verify test-next lint types package image meshes clean

help: ## this list
	@sed -n 's/^\([a-z-]*\):[^#]*## /\1\t/p' Makefile | expand -t 12

demo: ## one case, a hot ring on a plate, into results/
	$(ENV) python3 -m thermowear run demos/annular_punch.toml -o results/annular_punch --overwrite
	@echo 'look at results/annular_punch/bodies.png and interface.png; make demos computes all cases'

demos: ## all demo cases into results/, one on each core
	mkdir -p results
	ls demos/*.toml | $(ENV) xargs -P $(CORES) -I CASE sh -c ' \
	    name=$$(basename CASE .toml); \
	    python3 -m thermowear run CASE -o results/$$name --overwrite >results/$$name.log 2>&1 \
	        && echo results/$$name || { cat results/$$name.log; exit 255; }'

gallery: ## demos/README.md: what each demo case shows, with pictures
	$(ENV) python3 demos/gallery.py

docs: ## the site in docs/_build/html; warnings are errors
	THERMOWEAR_WITH=docs $(ENV) python3 -m sphinx -W --keep-going -q -d docs/_build/doctrees docs docs/_build/html
	@$(ENV) python3 docs/extensions/check_links.py docs/_build/html
	@echo docs/_build/html/index.html

links: ## the links of the site to other sites, asked one by one (needs the internet)
	THERMOWEAR_WITH=docs $(ENV) python3 -m sphinx -b linkcheck -q -d docs/_build/doctrees docs docs/_build/links

verification: ## the numbers of the verification book, docs/verification/checks.json
	$(ENV) python3 docs/extensions/write_checks.py

test: ## the tests but the slow ones
	$(PYTEST) -n 2 --dist worksteal -m "not slow" --durations=20

verify: ## all tests, with the slow ones and random examples
	HYPOTHESIS_PROFILE=explore $(PYTEST) -n 2 --dist worksteal

test-next: ## the tests with the dolfinx of Debian unstable
	THERMOWEAR_SUITE=unstable $(PYTEST) -n 2 --dist worksteal -m "not slow"

lint: $(RUFF) ## ruff, and shellcheck where it is installed
	$(RUFF) check .
	$(RUFF) format --check .
	if command -v shellcheck >/dev/null; then shellcheck scripts/env scripts/image scripts/package; fi

types: ## mypy
	$(WHOLE) mypy

package: ## the wheel, in build/package, tried in a clean environment
	scripts/package

image: ## the container image thermowear
	scripts/image

meshes: ## make the meshes in meshes/ anew
	$(ENV) python3 meshes/regenerate.py

clean: ## remove results and tool caches; the environment stays
	rm -rf results demos/out docs/_build build .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# ruff is not in Debian; pinned, as a new one may ask for new things
$(RUFF):
	python3 -m venv $(CACHE)/ruff-0.14
	$(CACHE)/ruff-0.14/bin/pip install --quiet 'ruff==0.14.*'
