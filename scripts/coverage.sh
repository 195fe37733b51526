# Measures which lines and branches tests reach in the modules that hold users' data. Sourced by ./station.

coverage_modules=(base/file mesh/deck mesh/document daemon/modeld)
coverage_tests=(base_test mesh_deck_test mesh_deck_{lsdyna,nastran,radioss,abaqus}_test mesh_document_test modeld_test faults_test cli_test)

# run_coverage [MODULE..]: runs the tests built with counters and prints what they reach of these modules (default: those that hold users'
# data), and each error branch that no test takes and that has no reason in tests/untested_errors.txt. It writes every branch that goes one way
# only to out/coverage/one_way.txt. The counts are in a mapped file (%c), so that programs that a test kills leave theirs too.
run_coverage() {
  local name objects=()
  [ $# -gt 0 ] || set -- "${coverage_modules[@]}"
  say "Building with counters"
  configure_and_build coverage -DPRISMESH_TESTS=ON -- "${coverage_tests[@]}" prismesh prismesh-modeld || return 1
  rm -rf out/coverage
  mkdir -p out/coverage
  say "Running the tests"
  for name in "${coverage_tests[@]}"; do
    LLVM_PROFILE_FILE=$PWD/out/coverage/%c%m.profraw "build/coverage/bin/$name" --gtest_brief=1 </dev/null >"out/coverage/$name.log" 2>&1 ||
      echo "$name failed: out/coverage/$name.log"
  done
  llvm-profdata-14 merge -sparse out/coverage/*.profraw -o out/coverage/all.profdata
  for name in "${coverage_tests[@]}" prismesh prismesh-modeld; do objects+=(-object "build/coverage/bin/$name"); done
  llvm-cov-14 export -format=text -skip-expansions -instr-profile=out/coverage/all.profdata "${objects[@]:1}" >out/coverage/all.json
  python3 scripts/coverage.py out/coverage/all.json tests/untested_errors.txt out/coverage/one_way.txt "$@" | tee out/coverage/report.txt
}
