# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Sourced by the scripts in tools/: installs what is missing. Needs steps.sh.

# The names in package lists, one a line.
listed_packages() { # FILE...
  sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$@"
}

is_installed() { # PACKAGE
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# Installs Debian packages, as root or with sudo. Output goes to the log packages.log.
apt_install() { # PACKAGE...
  local as_root=()
  if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null 2>&1 || fail 4 "packages are missing and there is no sudo. As root: \
apt-get install --no-install-recommends $*"
    as_root=(sudo)
    sudo -v || fail 4 "sudo refused. As root: apt-get install --no-install-recommends $*"
  fi
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300)
  printf '      %d packages: %s\n' $# "$*"
  logged package_lists "${apt[@]}" update
  logged packages "${apt[@]}" install --yes --no-install-recommends "$@"
}

# Installs what is missing of package lists; asks the network only then.
install_packages() { # FILE...
  local package missing=()
  command -v dpkg-query >/dev/null 2>&1 ||
    fail 4 "this is not Debian. Install the like of: $(listed_packages "$@" | paste -sd ' ')"
  for package in $(listed_packages "$@"); do
    is_installed "$package" || missing+=("$package")
  done
  [[ ${#missing[@]} -eq 0 ]] || apt_install "${missing[@]}"
}

# Node and npm: those on PATH, else Debian's. Debian's npm is never put beside another Node.
install_node() {
  if ! command -v node >/dev/null 2>&1; then
    apt_install nodejs npm
  elif ! command -v npm >/dev/null 2>&1; then
    fail 4 "$(command -v node) has no npm beside it. Install the npm that belongs to it"
  fi
}
