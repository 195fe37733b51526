# Steps of the station's commands. Sourced by ./station with the project's root as working directory.

say() { printf '\n== %s\n' "$*"; }
give_up() {
  printf 'station: %s\n' "$*" >&2
  exit 1
}

# packages GROUP..: the package names of these sections of packages.txt.
packages() {
  local group
  for group in "$@"; do
    awk -v want="[$group]" '
      { sub(/#.*/, "") }
      /^\[/ { inside = ($1 == want); found = found || inside; next }
      inside && NF { print $1 }
      END { exit !found }' packages.txt || give_up "packages.txt has no section [$group]"
  done
}

# install GROUP..: installs missing packages. If none is missing it changes nothing and needs no network.
install() {
  command -v dpkg-query >/dev/null || give_up "this needs Debian 12 (dpkg is missing); packages.txt lists what to install by other means"
  local wanted missing as_root=()
  wanted=$(packages "$@" | sort -u)
  # shellcheck disable=SC2086  # one word a package
  missing=$(comm -23 <(echo "$wanted") <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' $wanted 2>/dev/null |
    awk '$2 == "installed" { print $1 }' | sort -u))
  [ -z "$missing" ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || give_up "these packages are missing, and there is neither root nor sudo to install them:" $missing
    as_root=(sudo)
  fi
  say "Installing" $missing
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq </dev/null ||
    echo "station: the package lists could not be refreshed; the present ones are used" >&2
  # shellcheck disable=SC2086
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends --no-remove $missing </dev/null ||
    give_up "the packages above could not be installed"
}

# configure_and_build PRESET [cmake arguments] -- [ninja targets]
configure_and_build() {
  local preset=$1 options=()
  shift
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    options+=("$1")
    shift
  done
  [ $# -gt 0 ] && shift
  cmake --preset "$preset" -Wno-dev --log-level=WARNING "${options[@]}" >/dev/null || return 1
  cmake --build --preset "$preset" ${1:+--target "$@"}
}

# build_release [TESTS [BENCHMARKS]]: builds the programs; with ON also tests or benchmarks, which need the test packages.
build_release() {
  say "Building"
  configure_and_build release "-DPRISMESH_TESTS=${1:-OFF}" "-DPRISMESH_BENCH=${2:-OFF}"
}

# sources: prints every C++ file of the project, one a line.
sources() {
  local folder folders=()
  for folder in base mesh drivers ipc daemon kiosk cli tests scripts; do
    [ ! -d "$folder" ] || folders+=("$folder")  # find fails if one of its folders is missing
  done
  find "${folders[@]}" -name '*.h' -o -name '*.cpp' | sort
}

run_tidy() {
  # In a folder of its own: clang can't read the headers that GCC has precompiled, and each source is compiled by itself there.
  cmake --preset release -B build/tidy -Wno-dev --log-level=WARNING -DPRISMESH_BENCH=ON -DPRISMESH_PRECOMPILED=OFF -DPRISMESH_UNITY=OFF \
    -DPRISMESH_RUNS= >/dev/null
  local files
  [ $# -gt 0 ] || mapfile -t files < <(sources | grep '\.cpp$' | grep -v '^tests/fuzz/')
  [ $# -gt 0 ] && files=("$@")
  printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy-14 -p build/tidy --quiet
}

run_benchmarks() {
  local bench
  for bench in build/bin/*_bench; do
    [ -x "$bench" ] || give_up "there are no benchmarks in build/bin"
    say "$(basename "$bench")"
    "$bench" --benchmark_filter="$1"
  done
}
