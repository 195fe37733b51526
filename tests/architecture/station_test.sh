#!/usr/bin/env bash
# The station command itself: its usage, its package list, and that its closing line counts what CTest said.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0
expect() {  # expect WHAT ACTUAL EXPECTED
  [ "$2" = "$3" ] && return
  printf '%s: got "%s", expected "%s"\n' "$1" "$2" "$3"
  bad=1
}

"$root/station" help >/dev/null
expect "help's status" $? 0
"$root/station" no-such-command >/dev/null 2>&1
expect "an unknown command's status" $? 2

# A CTest that says what the test wants it to say.
mkdir "$folder/bin" "$folder/out"
cat >"$folder/bin/ctest" <<'FAKE'
#!/usr/bin/env bash
while [ $# -gt 0 ]; do [ "$1" = --output-junit ] && junit=$2; shift; done
[ -n "$FAKE_JUNIT" ] && printf '%s\n' "$FAKE_JUNIT" >"$junit"
exit "$FAKE_STATUS"
FAKE
chmod +x "$folder/bin/ctest"

closing() {  # closing STATUS JUNIT: the closing line and the exit status after one run
  (
    cd "$folder" || exit
    mkdir -p out/test
    source "$root/scripts/steps.sh"
    source "$root/scripts/test.sh"
    export PATH=$folder/bin:$PATH FAKE_STATUS=$1 FAKE_JUNIT=$2
    run_ctest fake nowhere >/dev/null 2>&1
    closing_line >line
    printf '%s / %s' "$(tail -n 1 line)" $?
    closing_line >/dev/null
    printf '%s' " / $?"
  )
}
suite='<?xml version="1.0"?>
<testsuite name="x"
	tests="12" failures="%s"
	disabled="0"
	skipped="3" hostname="" time="1" timestamp="now">
	<testcase name="failures=&quot;9&quot;" status="run"/>
</testsuite>'
# shellcheck disable=SC2059  # the suite is a format
expect "a good run" "$(closing 0 "$(printf "$suite" 0)")" "9 passed, 0 failed, 3 skipped / 0 / 0"
# shellcheck disable=SC2059
expect "a run with failures" "$(closing 8 "$(printf "$suite" 2)")" "7 passed, 2 failed, 3 skipped / 0 / 1"
expect "a run that found nothing" "$(closing 8 "")" "0 passed, 1 failed, 0 skipped / 0 / 1"

said=$(
  cd "$folder" || exit
  mkdir -p out/test
  source "$root/scripts/steps.sh"
  source "$root/scripts/test.sh"
  export PATH=$folder/bin:$PATH FAKE_STATUS=0
  # shellcheck disable=SC2059
  FAKE_JUNIT=$(printf "$suite" 0 | sed 's|</testsuite>|<testcase name="b" status="notrun"><system-out>SKIPPED: b: no valgrind\n</system-out></testcase></testsuite>|')
  export FAKE_JUNIT
  run_ctest fake nowhere >/dev/null 2>&1
  closing_line | grep SKIPPED
)
expect "the reason of a skipped test" "$said" "SKIPPED: b: no valgrind"

warned=$(
  cd "$folder" || exit
  mkdir -p out/test tests
  printf '# name, seconds\nyardstick\t2\nsame\t100\ndearer\t100\n' >tests/cpu_seconds.txt
  source "$root/scripts/steps.sh"
  source "$root/scripts/test.sh"
  stages=(same dearer new) stage_seconds=([same]=215 [dearer]=225 [new]=1000)
  cpu_report 4 | awk '/WARNING/ { printf "%s;", $1 }'
)
expect "what is dearer by more than a tenth on a machine half as fast" "$warned" "dearer;"
timed=$(
  cd "$folder" || exit
  source "$root/scripts/steps.sh"
  source "$root/scripts/test.sh"
  stage work awk 'BEGIN { for (i = 0; i < 3e7; ++i) x += i }'
  stage refusal false || printf 'status %s, ' $?
  awk -v seconds="${stage_seconds[work]}" 'BEGIN { print(seconds > 0.05 && seconds < 30 ? "counted" : "not counted: " seconds) }'
)
expect "a stage" "$timed" "status 1, counted"

expect "the section run" "$(cd "$root" && source scripts/steps.sh && packages run | grep -c '^libtbb12$')" 1
(cd "$root" && source scripts/steps.sh && packages no-such-section) >/dev/null 2>&1
expect "an unknown section's status" $? 1
exit $bad
