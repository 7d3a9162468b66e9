# tests/dev/check.sh: lint, sanitizers and fuzzing; sourced by ./dev.
# shellcheck shell=bash
# shellcheck disable=SC2154 # root, work and the package lists are those of ./dev

# ---- lint -----------------------------------------------------------------------------------------

cpp_files() {
  local folder folders=()
  for folder in algo sim drivers db server tests; do
    [[ ! -d $folder ]] || folders+=("$folder")
  done
  find "${folders[@]}" \( -name '*.cpp' -o -name '*.hpp' \) -print0
}

# format_check: prints every file that is not in our format, with the number of places.
format_check() {
  local words
  words=$(cpp_files | xargs -0 clang-format-14 --dry-run -Werror 2>&1) && return
  printf '%s\n' "$words" | sed -nE 's/^([^:]+):[0-9]+:[0-9]+: error: .*/\1/p' | uniq -c |
    sed -E 's/^ *([0-9]+) (.*)/\2: \1 places not in our format/'
  return 1
}

# tidy_all: clang-tidy over the sources in groups, from a build folder of its own. Of the build only the commands
# that make headers and sources run: asked for these files, ninja would first compile the rooms below them.
tidy_all() {
  local made command
  while read -r made; do
    command=$(ninja -C build/lint -t commands -s "$made") && bash -c "$command" || return
  done < <(ninja -C build/lint -t targets rule CUSTOM_COMMAND | grep -E '^/.*\.(cpp|h|bfbs)$')
  python3 -B tests/dev/tidy.py build/lint "$work/tidy" "$(job_count)"
}

# types_of_page: type-checks the page when it has changed.
types_of_page() {
  local key
  key=$(hash_page)
  [[ "$(cat "$work/types" 2>/dev/null)" == "$key" ]] && return
  npm --prefix web run --silent typecheck && printf '%s' "$key" >"$work/types"
}

verb_lint() {
  local status=0
  need "${run_packages[@]}" "${test_packages[@]}" "${check_packages[@]}"
  build_page # the page's packages hold schemas that a generated source embeds
  configure lint OFF
  quietly format.log "clang-format" format_check || status=1
  quietly tidy.log "clang-tidy" tidy_all || status=1
  quietly types.log "Types of the page" types_of_page || status=1
  quietly shellcheck.log "shellcheck" shellcheck -x dev .ci/run tests/dev/*.sh || status=1
  ((status == 0)) || fail "lint found something; \`./dev fmt\` repairs what is format alone."
  say "lint: clean"
}

verb_fmt() {
  need clang-format-14
  cpp_files | xargs -0 clang-format-14 -i
}

# ---- sanitizers and fuzzing -----------------------------------------------------------------------

# Long drives and heavy loads, whose code shorter tests run as well. A sanitizer would make minutes of each.
long_tests=(AppTest.ABatchOfTenThousand\* AppTest.BothRuns\* ArmInverse.EveryBranch\* ArmRun.APersonWho\*
  ArmRun.TheHandFollows\* ArmStudy.\* BodyFollower.Passes\* BodyStrip.TheArmYields\*
  Buildings.{HaveEveryKind,ATimedDoor}\* BuildingStudy.RunsTheChosen\* Compare.TheBlindOne\*
  CrowdCrossing.{TheSame,SomebodyWho}\* Determinism.SeveralRobots\* FilterStudy.RepeatsExactly\*
  FleetRobot.{EachRobot,SoItDoes,TheSameSpec}\* GroundCourses.ARobotClimbs\* GroundCourses.TenDegrees\*
  GroundDrive.RefusesSteps\* LocateStudy.\* MapData.\* MapPlan.{KeepsOut,ReachesAGoal}\*
  MapRobot.{IsRepeated,ReachesIts}\*
  MasudaStudy.{BandsCanFail,DocumentsName,DownwardSlopes,HasTheLines,PrintedRules}\* Operator.IsTheSame\*
  PeopleRun.TheRobotCrosses\* Physics/RecordedSwap.\* ReachStudy.CountsEach\*
  RobhazStudy.{AFailure,AFinding,EachRule,NoReading,RepeatsBit,TheConditions}\* RunListLoadTest.\*
  RunQueueTest.WaitingWorlds\* SlopeStudy.TheGuardKeeps\* TightPlaces.\* Tour.AShortOne\* TourStudy.HasARow\*
  Turnover.BeginsWhere\* WheelWatch.TenHours\*)

# build_sanitized NAME: sets `targets`, the tests that run under the sanitizer NAME, and builds them. ThreadSanitizer
# has only the rooms that start threads; the others would only take time.
build_sanitized() {
  case "$1" in
    asan) targets=(test_{algo,sim,drivers,db} test_server_{run,record,experiment,lab,external,serve,emulate,cli} fuzz) ;;
    tsan) targets=(test_db test_server_{run,record,experiment,external,serve,emulate}) ;;
    *) fail "there is no sanitizer '$1': asan or tsan" ;;
  esac
  need clang-16 libclang-rt-16-dev
  build_all "$1" "${targets[@]}"
}

verb_build() {
  local name targets
  for name in "${@:-release}"; do
    if [[ $name == release ]]; then build_all release; else build_sanitized "$name"; fi
  done
}

# Tests run in shards here, many in a process.
verb_sanitize() {
  local targets
  build_sanitized "${1:-}"
  export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1}
  export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
  export TSAN_OPTIONS=${TSAN_OPTIONS:-halt_on_error=1:second_deadlock_stack=1:suppressions=$root/tests/dev/tsan.supp}
  GTEST_FILTER="-$(IFS=: && printf '%s' "${long_tests[*]}")"
  export GTEST_FILTER
  run_ctest "$1" -R "^($(IFS='|' && printf '%s' "${targets[*]}"))[._]"
  closing_line
}

# A search of SECONDS by libFuzzer for each target, from its kept inputs in tests/fuzz/seeds/NAME. New inputs stay
# in build/fuzz/found. The counters that guide the search would slow down every sanitized test, so they have a
# build of their own.
verb_fuzz() {
  local target name seconds=${1:-5} status=0
  need clang-16 libclang-rt-16-dev
  build_all fuzz fuzz
  for target in build/fuzz/tests/fuzz/fuzz_*; do
    [[ -x $target && -f $target ]] || continue
    name=${target##*/fuzz_}
    mkdir -p "build/fuzz/found/$name"
    quietly "fuzz-$name.log" "Fuzzing $name" "$target" -max_total_time="$seconds" -timeout=10 \
      -artifact_prefix="$work/" "build/fuzz/found/$name" "tests/fuzz/seeds/$name" || status=1
  done
  return "$status"
}

verb_check() {
  local stage stages=(lint "sanitize asan" "sanitize tsan") broken=() times=() start
  if docker version >/dev/null 2>&1; then
    stages+=(image)
  else
    say "The image is not tried: no container engine runs here. ./dev image starts one of its own."
  fi
  need "${run_packages[@]}" "${test_packages[@]}" "${check_packages[@]}"
  for stage in "${stages[@]}"; do
    printf '== %s\n' "$stage"
    start=$SECONDS
    # One process each, so that `set -e` stays in force inside.
    # shellcheck disable=SC2086
    bash "$root/dev" $stage || broken+=("$stage")
    times+=("$stage $((SECONDS - start)) s")
  done
  printf 'check: %s\n' "$(printf '%s, ' "${times[@]}" | sed 's/, $//')"
  ((${#broken[@]} == 0)) || fail "check failed in: $(printf '%s, ' "${broken[@]}" | sed 's/, $//')"
}
