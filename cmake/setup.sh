# What ./run, ./test and .ci/run share: packages, configuration, build. Sourced from the repository's root.

fail() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

# Standard output is for the program's own answers: what the set-up says goes to standard error.
say() {
  printf '%s\n' "$*" >&2
}

# The latest line of a long command: in place on a terminal, else one every ten seconds.
show_progress() {
  local line shown=$SECONDS width
  width=$(stty size <&2 2>/dev/null | cut -d ' ' -f 2) || true
  while IFS= read -r line; do
    if [[ -t 2 ]]; then
      printf '\r\033[K%.*s' "$((${width:-80} - 1))" "$line" >&2
    elif ((SECONDS - shown >= 10)); then
      say "  $line"
      shown=$SECONDS
    fi
  done
  if [[ -t 2 ]]; then printf '\r\033[K' >&2; fi
}

# quietly WHAT COMMAND...: its output goes to build/setup.log and is shown only if it fails.
quietly() {
  local what=$1
  shift
  mkdir -p build
  if ! "$@" 2>&1 </dev/null | tee build/setup.log | show_progress; then
    tail -n 60 build/setup.log >&2
    fail "$what failed; all of its output is in build/setup.log"
  fi
}

# packages_of SECTION...: the names in these sections of packages.txt, sorted.
packages_of() {
  awk -v wanted=" $* " '
    /^# \[/ { section = substr($2, 2, length($2) - 2) }
    /^[^#]/ && index(wanted, " " section " ") { print $1 }' packages.txt | sort -u
}

# install_packages SECTION...: what is missing of these sections of packages.txt.
install_packages() {
  local wanted present missing
  local -a as_root=()
  wanted=$(packages_of "$@")
  command -v dpkg-query >/dev/null ||
    fail "can install packages on Debian and its relatives only; elsewhere install what packages.txt names" \
      "by other means, then: cmake --preset release && cmake --build --preset release"
  # dpkg-query fails when it does not know a package, which is an answer here.
  # shellcheck disable=SC2086 # one word per package
  present=$({ dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null || true; } |
    sed -n 's/^installed //p' | sort -u)
  missing=$(comm -23 <(echo "$wanted") <(echo "$present") | xargs)
  if [[ -z $missing ]]; then return; fi

  if ((EUID != 0)); then
    command -v sudo >/dev/null || fail "these packages are missing, and there is no sudo to install them;" \
      "as root: apt-get install $missing"
    as_root=(sudo)
    sudo -v || fail "these packages are missing: $missing"
  fi
  say "Installing $missing"
  quietly "apt-get update" "${as_root[@]}" apt-get update
  # shellcheck disable=SC2086
  quietly "apt-get install" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends -o DPkg::Lock::Timeout=300 $missing
}

# configure PRESET CMAKE_ARGUMENT...: its build directory, if that was never done or done with other values of the
# arguments (-DNAME=VALUE); for anything else ninja does it again when it must.
configure() {
  local preset=$1 directory argument
  shift
  directory=$(build_directory "$preset")
  if [[ -f $directory/build.ninja ]]; then
    local is_same=true
    for argument in "$@"; do
      grep -q -- "^${argument/#-D/}$" <(sed 's/:[A-Z]*=/=/' "$directory/CMakeCache.txt") || is_same=false
    done
    if $is_same; then return; fi
  fi
  say "Configuring ($directory/)"
  quietly "cmake" cmake --preset "$preset" "$@"
}

# Where CMakePresets.json puts a preset's build.
build_directory() {
  if [[ $1 == release ]]; then echo build; else echo "build-$1"; fi
}

# build PRESET TARGET...
build() {
  local preset=$1
  shift
  quietly "the build" ninja -C "$(build_directory "$preset")" -j "$(nproc)" "$@"
}
