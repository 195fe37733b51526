# `./station package` and `./station package-test`. Sourced by ./station after steps.sh.

# build_packages: builds the packages from a copy of what git knows, so that nothing else of this folder gets into them. The compiler's cache
# stays the user's: debhelper would give it a fresh home folder.
build_packages() {
  local out=build/packages
  say "Building the packages"
  rm -rf "$out/source" "$out"/*.deb "$out"/*.buildinfo "$out"/*.changes
  mkdir -p "$out/source"
  git ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do [ ! -e "$file" ] || printf '%s\0' "$file"; done |
    tar --null --files-from=- --create | tar --extract --directory="$out/source"
  (
    CCACHE_DIR=$(ccache --get-config=cache_dir 2>/dev/null) && export CCACHE_DIR
    export DEB_BUILD_OPTIONS="nocheck parallel=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)} ${DEB_BUILD_OPTIONS:-}"
    cd "$out/source" && dpkg-buildpackage --build=binary --no-sign >../build.log 2>&1
  ) || {
    tail -n 40 "$out/build.log" >&2
    give_up "the packages couldn't be built; all that was said is in $out/build.log"
  }
  rm -rf "$out/source"
  ls -sh1 "$out"/*.deb
}

# test_packages: what tests/packages says of them. A test that can't run here has failed.
test_packages() {
  say "Testing the packages"
  tests/packages/run.sh build/packages
}
