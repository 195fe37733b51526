# Everything `./station test` runs, and the counting. Sourced by ./station after steps.sh.

passed=0 failed=0 skipped=0
failures=()

count_one() {  # count_one NAME STATUS: a check that isn't a CTest test
  if [ "$2" -eq 0 ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    failures+=("$1")
  fi
}

attribute() { sed -n "s/.*<testsuite.*[[:space:]]$2=\"\([0-9]*\)\".*/\1/p; t" "$1" | head -n 1; }

# run_ctest NAME BUILD_FOLDER [ctest arguments]
run_ctest() {
  local name=$1 folder=$2 status=0 junit=out/test/$1.xml total=0 bad=0 left=0 which=
  shift 2
  say "Tests: $name"
  rm -f "$junit"
  ctest --test-dir "$folder" --parallel 2 --timeout 300 --no-tests=error --output-on-failure --output-junit "$PWD/$junit" "$@" </dev/null ||
    status=$?
  if [ -f "$junit" ]; then
    # JUnit's element spreads over lines; put it on one for the counting.
    tr '\n' ' ' <"$junit" | sed 's/>/>\n/g' >"$junit.flat"
    total=$(attribute "$junit.flat" tests)
    bad=$(attribute "$junit.flat" failures)
    left=$(($(attribute "$junit.flat" skipped) + $(attribute "$junit.flat" disabled)))
    which=$(sed -n 's/.*<testcase.* name="\([^"]*\)".*status="fail".*/\1/p' "$junit.flat")
    rm -f "$junit.flat"
  fi
  # A run that ended badly without a failed test (no test found, a crash of the runner) is a failure all the same.
  if [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; then
    bad=1
    total=$((total + 1))
  fi
  passed=$((passed + total - bad - left))
  failed=$((failed + bad))
  skipped=$((skipped + left))
  [ "$bad" -gt 0 ] && failures+=("$name: $bad${which:+$(printf '\n        %s' $which)}")
  return 0
}

# step NAME command..: a build or check that counts as one test when it fails, and tells whether the rest makes sense.
step() {
  local name=$1
  shift
  if "$@"; then return 0; fi
  count_one "$name" 1
  return 1
}

check_format() {
  say "clang-format"
  local status=0
  sources | xargs -r clang-format-14 --dry-run -Werror || status=1
  count_one "clang-format" "$status"
}

# fuzz_one TARGET SECONDS: what it said lies in out/fuzz/NAME.log, how it ended in out/fuzz/NAME.status.
fuzz_one() {
  local target=$1 name seeds=() status=0
  name=$(basename "$target")
  [ -d "tests/fuzz/seeds/$name" ] && seeds=("tests/fuzz/seeds/$name")
  [ -f "tests/fuzz/${name%_fuzz}.dict" ] && seeds+=("-dict=tests/fuzz/${name%_fuzz}.dict")
  mkdir -p "build/corpus/$name"
  "$target" -max_total_time="$2" -timeout=20 -rss_limit_mb=2048 -malloc_limit_mb=1024 -artifact_prefix="out/fuzz/$name-" -print_final_stats=0 -verbosity=0 \
    "build/corpus/$name" "${seeds[@]}" </dev/null >"out/fuzz/$name.log" 2>&1 || status=$?
  echo "$status" >"out/fuzz/$name.status"
}

# run_fuzzers SECONDS: every target from its seeds, as many at a time as there are processors; what it finds stays in build/corpus,
# what breaks it in out/fuzz.
run_fuzzers() {
  step "build: fuzz" configure_and_build asan -- fuzz_targets || return 0
  local target name status
  mkdir -p out/fuzz
  rm -f out/fuzz/*.status
  say "Fuzzing each target for $1 s"
  for target in build/asan/bin/*_fuzz; do
    [ -x "$target" ] || continue
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n || true; done
    fuzz_one "$target" "$1" &
  done
  wait
  for target in build/asan/bin/*_fuzz; do
    [ -x "$target" ] || continue
    name=$(basename "$target")
    status=$(cat "out/fuzz/$name.status" 2>/dev/null || echo 1)
    [ "$status" -eq 0 ] || tail -n 40 "out/fuzz/$name.log"
    count_one "$name" "$status"
  done
}

closing_line() {
  local failure
  printf '\n'
  for failure in "${failures[@]}"; do echo "FAILED  $failure"; done
  [ "$skipped" -eq 0 ] || [ -n "${PRISMESH_MODELS:-}" ] || echo "PRISMESH_MODELS is not set: the tests on real decks were skipped."
  echo "$passed passed, $failed failed, $skipped skipped"
  [ "$failed" -eq 0 ]
}

run_all_tests() {
  mkdir -p out/test
  step "build: release" build_release ON && run_ctest release build
  say "Building with AddressSanitizer and UndefinedBehaviorSanitizer"
  step "build: asan" configure_and_build asan &&
    UBSAN_OPTIONS=print_stacktrace=1 run_ctest asan build/asan -L 'unit|threads'
  say "Building with ThreadSanitizer"
  step "build: tsan" configure_and_build tsan -- drivers_port_test ipc_test modeld_test deviced_test &&
    run_ctest tsan build/tsan -L threads
  run_fuzzers 10
  check_format
  closing_line
}
