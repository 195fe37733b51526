# Everything `./station test` runs, and the counting. Sourced by ./station after steps.sh.

passed=0 failed=0 skipped=0
failures=()
skip_reasons=()  # of tests that say why

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
    mapfile -t -O "${#skip_reasons[@]}" skip_reasons < <(sed -n 's/.*\(SKIPPED: .*\)/\1/p' "$junit")
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

# --- processor time ---

stages=()  # names
declare -A stage_seconds

# spent_seconds: sets `spent` to the processor time of everything that this shell has run and waited for. `times` must not run in a subshell,
# which has run nothing.
spent_seconds() {
  mkdir -p out/test
  times >out/test/times
  spent=$(awk 'NR == 2 { for (i = 1; i <= 2; ++i) { split($i, part, "[ms]"); sum += 60 * part[1] + part[2] } printf "%.1f", sum }' out/test/times)
}

# stage NAME command..: runs the command and records its processor time.
stage() {
  local name=$1 before status=0
  shift
  spent_seconds
  before=$spent
  "$@" || status=$?
  spent_seconds
  [ -n "${stage_seconds[$name]:-}" ] || stages+=("$name")
  stage_seconds[$name]=$(awk -v a="${stage_seconds[$name]:-0}" -v b="$before" -v c="$spent" 'BEGIN { printf "%.1f", a + c - b }')
  return "$status"
}

# measure_yardstick: sets `yardstick` to the processor time of compiling a fixed text. Machines and their load differ by a factor of two, so
# stages are compared as multiples of it.
measure_yardstick() {
  local before
  spent_seconds
  before=$spent
  c++ -std=c++20 -O1 -c -o /dev/null scripts/yardstick.cpp
  c++ -std=c++20 -O1 -c -o /dev/null scripts/yardstick.cpp
  spent_seconds
  yardstick=$(awk -v a="$before" -v b="$spent" 'BEGIN { printf "%.2f", (b - a) / 2 }')
}

# cpu_report YARDSTICK: prints processor minutes by stage beside those that tests/cpu_seconds.txt notes for a cold run, and warns of a stage
# that has grown by more than a tenth.
cpu_report() {
  local name
  printf '\nProcessor minutes by stage (noted: for a cold run, scaled to this machine; see docs/building.md)\n'
  for name in "${stages[@]}"; do printf '%s\t%s\n' "$name" "${stage_seconds[$name]}"; done |
    awk -F '\t' -v now="$1" '
      FNR == NR { if ($0 !~ /^#/ && NF > 1) noted[$1] = $2; next }
      {
        expected = noted["yardstick"] > 0 ? noted[$1] * now / noted["yardstick"] : 0
        grown = expected > 0 && $2 > 1.1 * expected && $2 - expected > 6
        printf "  %-24s %6.1f   noted %6.1f%s\n", $1, $2 / 60, expected / 60, grown ? "   WARNING: grown by more than a tenth" : ""
        sum += $2; all += expected
      }
      END { printf "  %-24s %6.1f   noted %6.1f   (yardstick %.2f s, noted %.2f)\n", "all", sum / 60, all / 60, now, noted["yardstick"] }
    ' tests/cpu_seconds.txt -
}

# step NAME command..: runs a build or check that counts as one failed test when it fails; its status says whether to go on.
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

# fuzz_one TARGET SECONDS: writes its output to out/fuzz/NAME.log and its status to out/fuzz/NAME.status.
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

# run_fuzzers SECONDS: runs every target from its seeds, one on each processor. New inputs stay in build/corpus, failing ones in out/fuzz.
run_fuzzers() {
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
  [ "${#skip_reasons[@]}" -eq 0 ] || printf '%s\n' "${skip_reasons[@]}"
  [ "$skipped" -eq 0 ] || [ -n "${PRISMESH_MODELS:-}" ] || echo "PRISMESH_MODELS is not set: the tests on real decks were skipped."
  echo "$passed passed, $failed failed, $skipped skipped"
  [ "$failed" -eq 0 ]
}

run_all_tests() {
  mkdir -p out/test
  measure_yardstick
  local first=$yardstick
  if stage "release: build" step "build: release" build_release ON; then stage "release: tests" run_ctest release build; fi
  say "Building with AddressSanitizer and UndefinedBehaviorSanitizer"
  if stage "asan: build" step "build: asan" configure_and_build asan; then
    UBSAN_OPTIONS=print_stacktrace=1 stage "asan: tests" run_ctest asan build/asan
    stage "fuzz" run_fuzzers 5
  fi
  say "Building with ThreadSanitizer"
  if stage "tsan: build" step "build: tsan" configure_and_build tsan; then stage "tsan: tests" run_ctest tsan build/tsan; fi
  stage "format" check_format
  measure_yardstick
  cpu_report "$(awk -v a="$first" -v b="$yardstick" 'BEGIN { print (a + b) / 2 }')"
  closing_line
}

# run_soak MINUTES: runs what takes too long for every change. For half of the time the fuzz targets run; for the other half sanitized tests
# run in random order and with new random numbers: random edits, daemons killed in the middle. Besides, it tries states of the disk after a
# power cut: some 1,700 for each minute (100,800 in an hour), 500 power cuts of a machine in an hour and 1,800 states of its disk, 100 million ticks of the haptic pen's safety, and 10
# million steps of the pen on real decks, and random input on the kiosk of an exhibition.
run_soak() {
  local seconds=$(($1 * 60)) targets name end seed=$RANDOM status
  mkdir -p out/test out/soak
  step "build: asan" configure_and_build asan || { closing_line; return; }
  export UBSAN_OPTIONS=print_stacktrace=1 PRISMESH_UNPLUGS=10000 PRISMESH_KILL_CYCLES=450
  end=$((SECONDS + seconds / 2))
  say "All sanitized tests in random order"
  run_ctest asan build/asan --schedule-random
  say "New random numbers until half of the time is over"
  while [ "$SECONDS" -lt "$end" ]; do
    for name in "mesh_document_test *RandomEdits*:Shaping*" "modeld_test Killing*:*CutOff*"; do
      status=0
      PRISMESH_SEED=$seed "build/asan/bin/${name% *}" --gtest_filter="${name#* }" --gtest_shuffle --gtest_brief=1 \
        </dev/null >"out/soak/${name% *}.log" 2>&1 || status=$?
      [ "$status" -eq 0 ] || { cat "out/soak/${name% *}.log"; cp "out/soak/${name% *}.log" "out/soak/${name% *}-$seed.log"; }
      count_one "${name% *} with PRISMESH_SEED=$seed" "$status"
    done
    seed=$((seed + 1))
  done
  say "States of the disk after a power cut"
  status=0
  if step "build: release" configure_and_build release -DPRISMESH_TESTS=ON -- faults_test prismesh prismesh-modeld; then
    PRISMESH_SEED=$seed PRISMESH_POWER_CUTS=$((seconds * 28)) build/bin/faults_test --gtest_brief=1 </dev/null || status=$?
    count_one "faults_test with PRISMESH_SEED=$seed" "$status"
  fi
  say "Power cuts of a machine under user-mode Linux"
  status=0
  if step "build: release" configure_and_build release -DPRISMESH_TESTS=ON -- prismesh prismesh-modeld prismesh-intake plants_preload; then
    tests/power/cut.py build/bin --cuts $((seconds / 7 < 500 ? seconds / 7 : 500)) --images $((seconds / 2)) --seed "$seed" --jobs "$(nproc)" || status=$?
    if [ "$status" -eq 77 ]; then skipped=$((skipped + 1)); else count_one "tests/power/cut.py --seed $seed" "$status"; fi
    say "Planted faults of durability"
    status=0
    tests/power/planted.py build/bin build/bin/libplants_preload.so --seed "$seed" || status=$?
    if [ "$status" -eq 77 ]; then skipped=$((skipped + 1)); else count_one "tests/power/planted.py --seed $seed" "$status"; fi
  fi
  say "A hundred million random ticks of the haptic pen's safety"
  status=0
  if step "build: release" configure_and_build release -DPRISMESH_TESTS=ON -- drivers_haptics_test; then
    PRISMESH_SEED=$seed PRISMESH_SAFETY_TICKS=100000000 build/bin/drivers_haptics_test --gtest_filter='*Long*' --gtest_brief=1 </dev/null || status=$?
    count_one "drivers_haptics_test with PRISMESH_SEED=$seed" "$status"
  fi
  say "Ten million steps of the haptic pen on real decks"
  status=0
  if step "build: release" configure_and_build release -DPRISMESH_TESTS=ON -- touch_test; then
    PRISMESH_SEED=$seed PRISMESH_TOUCH_STEPS=2000000 build/bin/touch_test --gtest_brief=1 </dev/null || status=$?
    count_one "touch_test with PRISMESH_SEED=$seed" "$status"
  fi
  say "Random input on the kiosk of an exhibition for half of the time"
  status=0
  if step "build: release" configure_and_build release -DPRISMESH_TESTS=ON -- station_test prismesh-kiosk prismesh-modeld; then
    PRISMESH_SEED=$seed PRISMESH_MONKEY_S=$((seconds / 2)) build/bin/station_test --gtest_filter='ExhibitionTest.input_at_random*' --gtest_brief=1 \
      </dev/null || status=$?
    count_one "station_test at random with PRISMESH_SEED=$seed" "$status"
  fi
  say "A study of 1,000 variants on a real Slurm: killed workers, a restarted controller, a full disk"
  status=0
  if step "build: release" configure_and_build release -DPRISMESH_TESTS=ON -- prismesh; then
    python3 -B tests/batch/batch_soak.py build/bin </dev/null || status=$?
    if [ "$status" -eq 77 ]; then skipped=$((skipped + 1)); else count_one "batch_soak.py" "$status"; fi
  fi
  say "Models of a vault over a line that fails at random, by programs that are killed"
  status=0
  if step "build: release" configure_and_build release -DPRISMESH_TESTS=ON -- prismesh; then
    python3 -B tests/vault/vault_soak.py build/bin --seed "$seed" </dev/null || status=$?
    if [ "$status" -eq 77 ]; then skipped=$((skipped + 1)); else count_one "vault_soak.py --seed $seed" "$status"; fi
  fi
  say "The demo on every real deck with shells"
  status=0
  tests/checker/demo_decks.py || status=$?
  if [ "$status" -eq 77 ]; then skipped=$((skipped + 1)); else count_one "demo_decks.py" "$status"; fi
  targets=$(find build/asan/bin -name '*_fuzz' | wc -l)
  run_fuzzers $((seconds * $(nproc) / 2 / targets + 1))
  closing_line
}
