# shellcheck shell=sh
# Functions that make the folder ready to run: a Python 3.11, a virtual environment in .venv, the packages at
# the versions of constraints.txt, and the system libraries that Blender's module links to. Sourced by task.sh
# with the working directory at the root of the repository. POSIX sh: a bare Debian has nothing more.
#
# Environment variables that change what happens:
#   PYTHON             the Python 3.11 to use
#   WHACAMOLE_NO_APT   set to 1 to never install a system package, only to print the line that would

say() { printf 'setup: %s\n' "$*" >&2; }

stop() {
  say "$*"
  exit 1
}

# --- System packages -------------------------------------------------------------------------------------

# True where packages can be installed without asking anybody for a password.
may_install() {
  [ "${WHACAMOLE_NO_APT:-0}" != 1 ] || return 1
  command -v apt-get >/dev/null 2>&1 || return 1
  [ "$(id -u)" -eq 0 ] || sudo -n true 2>/dev/null
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo -n "$@"; fi
}

# Ubuntu 24.04 and Debian 13 renamed part of their libraries to NAMEt64.
name_here() {
  if ! apt-cache show "$1" >/dev/null 2>&1 && apt-cache show "$1t64" >/dev/null 2>&1; then
    echo "$1t64"
  else
    echo "$1"
  fi
}

install_line() {
  if [ "$(id -u)" -eq 0 ]; then echo "apt-get install --no-install-recommends $*"
  else echo "sudo apt-get install --no-install-recommends $*"; fi
}

# apt_install PACKAGE...  installs them; returns 1, with apt's own words above, where it cannot.
apt_install() {
  say "installing system packages: $*"
  as_root apt-get update -qq || say "apt-get update failed; trying with the lists that are here"
  names=""
  for package in "$@"; do names="$names $(name_here "$package")"; done
  # shellcheck disable=SC2086  # a list of names, one word each
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $names >/dev/null
}

# need_packages WHY PACKAGE...  installs them, or prints the exact line and stops.
need_packages() {
  why=$1
  shift
  if may_install && apt_install "$@"; then return; fi
  say "$why"
  if command -v apt-get >/dev/null 2>&1; then
    say "install what is missing with this line, then run the same command again:"
    printf '\n    %s\n\n' "$(install_line "$@")" >&2
  else
    say "this system has no apt-get; these are the Debian names of what is missing: $*"
  fi
  exit 1
}

# --- Python ----------------------------------------------------------------------------------------------

is_python_311() {
  "$1" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' >/dev/null 2>&1
}

# Prints the path of a Python 3.11; prints nothing where there is none.
find_python() {
  if [ -n "${PYTHON:-}" ]; then
    is_python_311 "$PYTHON" || stop "PYTHON=$PYTHON is not a Python 3.11; unset it or name another one"
    echo "$PYTHON"
    return
  fi
  for candidate in python3.11 python3 python; do
    if is_python_311 "$candidate"; then
      command -v "$candidate"
      return
    fi
  done
}

need_python() {
  python=$(find_python)
  [ -z "$python" ] || return 0
  if may_install; then
    as_root apt-get update -qq || true
    if apt-cache show python3.11-venv >/dev/null 2>&1; then
      need_packages "Python 3.11 is missing." python3.11-venv
      python=$(find_python)
    fi
  fi
  [ -n "$python" ] || stop "no Python 3.11 found (Blender's module exists for 3.11 only). Debian 12:" \
    "'sudo apt-get install python3.11-venv'; elsewhere 'uv python install 3.11' or pyenv. Where it is not" \
    "on PATH, name it: PYTHON=/path/to/python3.11 make demo"
}

# --- Virtual environment ---------------------------------------------------------------------------------

# A virtual environment holds absolute paths: one that was moved, or whose Python is gone, is made anew.
need_venv() {
  if is_python_311 .venv/bin/python && [ "$(cat .venv/root 2>/dev/null)" = "$PWD" ]; then return; fi
  need_python
  need_system_packages "$python"
  say "making a virtual environment in .venv with $python"
  "$python" -m venv --clear .venv || stop "$python could not make .venv; its message is above"
  printf '%s\n' "$PWD" >.venv/root
}

# need_system_packages PYTHON  all system packages this Python lacks, in one go and before the large download.
# What Blender's module links to must be there; what only the OpenGL engines open may be missing.
need_system_packages() {
  required=$("$1" -P render_jobs/system_libraries.py --required)
  optional=$("$1" -P render_jobs/system_libraries.py --optional)
  "$1" -c 'import ensurepip, venv' >/dev/null 2>&1 || required="python3.11-venv $required"
  # shellcheck disable=SC2086  # lists of names, one word each
  if [ -n "$required" ]; then
    need_packages "Python's venv module or libraries that Blender's module links to are missing." \
      $required $optional
  elif [ -n "$optional" ]; then
    { may_install && apt_install $optional; } ||
      say "the OpenGL engines will not run (Cycles will); to add them: $(install_line "$optional")"
  fi
}

# need_python_packages EXTRAS  installs the project with these extras ('' for none), once for each state of the
# files that say which.
need_python_packages() {
  stamp=".venv/installed-${1:-core}"
  state=$(cat pyproject.toml constraints.txt | cksum)
  [ "$(cat "$stamp" 2>/dev/null)" != "$state" ] || return 0
  say "installing Python packages (${1:-core}); the first time this downloads some hundred megabytes"
  PIP_ROOT_USER_ACTION=ignore PIP_DISABLE_PIP_VERSION_CHECK=1 \
    .venv/bin/python -m pip install --quiet --use-pep517 --constraint constraints.txt --editable ".${1:+[$1]}" ||
    stop "pip could not install the packages; its message is above"
  printf '%s\n' "$state" >"$stamp"
}

# Asked once more of the installed module itself, and proved by loading it.
need_blender() {
  [ ! -e .venv/blender-loads ] || return 0
  need_system_packages .venv/bin/python
  message=$(.venv/bin/python -c 'import bpy' 2>&1) || {
    printf '%s\n' "$message" >&2
    stop "Blender's module does not load; its message is above. docs/troubleshooting.md lists the known causes"
  }
  : >.venv/blender-loads
}

# prepare EXTRAS  the whole of it; does nothing, fast, where all is there.
prepare() {
  need_venv
  need_python_packages "$1"
  need_blender
}
