#!/bin/sh
# The tasks behind the Makefile, for machines without make: sh tools/setup/task.sh TASK
# Each task first sets up what it needs (see environment.sh), which takes no time once it is there.
set -eu
cd "$(dirname "$0")/../.."
. tools/setup/environment.sh

help() {
  cat <<'TEXT'
make demo     set everything up, render three of the embedded motions, name their page to open
make test     set everything up, run the tests
make lint     ruff, mypy --strict, import rules
make bench    run the benchmarks and print their ratios
make docs     build the documentation into build/site, strictly, and see that it loads nothing from elsewhere
make assets   build the embedded data again from its sources
make setup    only set up; afterwards .venv/bin/whacamole is the command
make help     this text

Without make: sh tools/setup/task.sh demo, and so on.
Settings: PYTHON=/path/to/python3.11, WHACAMOLE_NO_APT=1 (install no system package), PYTEST_ADDOPTS="-k name".
TEXT
}

demo() {
  prepare ""
  # A runner to track, a dancer and a pair to circle: what each shot is for.
  for motion in run dance_a duet_00; do
    .venv/bin/whacamole render --motions "whacamole/assets/motions/$motion.npz" --out demo \
      --shots arc,tracking --size 320x180 --frames 24 --quality draft
  done
  .venv/bin/whacamole page demo --videos 3
}

run_tests() {
  prepare test
  # One file's tests stay in one process, so that what they render is rendered once; a test may start Blender,
  # which takes about a gigabyte, so there are never more than four processes.
  .venv/bin/python -m pytest -n logical --maxprocesses 4 --dist loadfile
}

lint() {
  prepare lint
  .venv/bin/ruff check .
  .venv/bin/ruff format --check .
  .venv/bin/mypy
  .venv/bin/lint-imports --no-cache
}

bench() {
  prepare test
  for name in rendering evaluation; do
    printf '\n== %s\n' "$name"
    .venv/bin/python -m "benchmarks.$name"
  done
}

docs() {
  prepare docs
  .venv/bin/python -m tools.docs.build
}

assets() {
  prepare ""
  .venv/bin/python -m pip download --quiet --no-deps --dest build/motions pybullet==3.2.7
  .venv/bin/python -m tools.motions.build build/motions/pybullet-*.whl
  .venv/bin/python tools/assets/build.py --work build/people --out whacamole/assets
}

case "${1:-help}" in
  setup) prepare "" ;;
  test) run_tests ;;
  demo | lint | bench | docs | assets | help) "$1" ;;
  *)
    help >&2
    stop "there is no task '$1'"
    ;;
esac
