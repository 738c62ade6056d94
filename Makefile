# Every target sets up what it needs first: a virtual environment in .venv, the Python packages and the system
# libraries. The work is in tools/setup/task.sh, which also runs where make is not installed.
TASKS := demo test lint bench docs assets setup help

.DEFAULT_GOAL := help
.PHONY: $(TASKS)

$(TASKS):
	@sh tools/setup/task.sh $@
