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

# tidy_keys: "KEY<tab>FILE" for each of our sources in the release build; tests are only formatted,
# since clang-tidy needs more time for GoogleTest's macros than for all the rest. KEY is a hash over the
# file, our headers that it includes (as the compiler saw them) and the options of clang-tidy.
tidy_keys() {
  local pairs rules source
  rules=$(sha256sum .clang-tidy CMakeLists.txt tests/dev/check.sh; clang-tidy-16 --version)
  pairs=$(ninja -C build/release -t deps | awk -v root="$root/" '
    /^[^ ]/ { source = ""; next }
    NF {
      path = substr($0, 5)
      if (index(path, root) == 1) path = substr(path, length(root) + 1)
      else if (!sub(/^\.\.\/\.\.\//, "", path) && path !~ /^\//) path = "build/release/" path
      if (path ~ /^\//) next
      if (source == "") source = path
      if (source !~ /^(build|tests)\//) print source "\t" path
    }' | sort -u)
  while IFS= read -r source; do
    printf '%s\t%s\n' "$({ printf '%s\n' "$rules"
      awk -F '\t' -v s="$source" '$1 == s { print $2 }' <<<"$pairs" | xargs -d '\n' sha256sum; } |
      sha256sum | cut -c 1-32)" "$source"
  done < <(cut -f 1 <<<"$pairs" | sort -u)
}

# tidy_file KEY FILE: quiet, and cached when clean. The analyzer runs only for the mathematics and the
# storage: for JSON and Beast it doubles the time and has found nothing.
tidy_file() {
  local checks=() log=$work/tidy/$1.log
  if [[ $2 == server/* ]]; then
    checks=(--checks='-clang-analyzer-*')
  fi
  if clang-tidy-16 -p "$work/tidy" --quiet "${checks[@]}" "$2" >"$log" 2>&1; then
    mv -- "$log" "$work/tidy/$1.ok"
  else
    grep -vE '^[0-9]+ warnings? (and [0-9]+ errors? )?generated' -- "$log" || true
    return 1
  fi
}

tidy_all() {
  local keys key source todo=()
  mkdir -p "$work/tidy"
  # The compiler's options, except those for g++ only: precompiled headers, its memory.
  sed -E 's/ (-fpch-preprocess|-Winvalid-pch -include [^ ]+cmake_pch\.hxx|--param ggc-[^ ]+)//g' \
    build/release/compile_commands.json >"$work/tidy/compile_commands.json"
  keys=$(tidy_keys)
  [[ -n "$keys" ]] || { echo "the release build knows no source of ours"; return 1; }
  while IFS=$'\t' read -r key source; do
    [[ -f $work/tidy/$key.ok ]] || todo+=("$key" "$source")
  done <<<"$keys"
  ((${#todo[@]} > 0)) || return 0
  export -f tidy_file
  export work
  # shellcheck disable=SC2016 # the inner shell expands them
  printf '%s\0' "${todo[@]}" | xargs -0 -n 2 -P "$(job_count)" bash -c 'tidy_file "$1" "$2"' tidy
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
  build_all release # clang-tidy needs the generated headers and the compiler's list of includes
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

# ThreadSanitizer runs only the tests with threads; the others would only take time.
verb_sanitize() {
  local targets=() only=()
  case "${1:-}" in
    asan) targets=(tests_algo tests_sim tests_drivers tests_db tests_server fuzz) only=(-E '_NOT_BUILT$|^Dev\.|^Bench\.') ;;
    tsan) targets=(tests_server tests_db) only=(-E '_NOT_BUILT$|^Dev\.|^Bench\.|^fuzz_') ;;
    *) fail "sanitize asan or sanitize tsan" ;;
  esac
  need clang-16 libclang-rt-16-dev
  build_all "$1" "${targets[@]}"
  export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1}
  export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
  export TSAN_OPTIONS=${TSAN_OPTIONS:-halt_on_error=1:second_deadlock_stack=1:suppressions=$root/tests/dev/tsan.supp}
  run_ctest "$1" "${only[@]}"
  closing_line
}

# CMake target `fuzz` builds tests/fuzz/fuzz_NAME for each NAME, in the asan build; tests/fuzz/seeds/NAME
# are its kept inputs. They run first, then a short search from them. New inputs stay in
# build/asan/found.
verb_fuzz() {
  local target name seconds=${1:-5} status=0
  need clang-16 libclang-rt-16-dev
  build_all asan fuzz
  for target in build/asan/tests/fuzz/fuzz_*; do
    [[ -x $target && -f $target ]] || continue
    name=${target##*/fuzz_}
    mkdir -p "build/asan/found/$name"
    quietly "fuzz-$name.log" "Fuzzing $name" "$target" -max_total_time="$seconds" -timeout=10 \
      -artifact_prefix="$work/" "build/asan/found/$name" "tests/fuzz/seeds/$name" || status=1
  done
  return "$status"
}

verb_check() {
  local stage stages=(lint "sanitize asan" "sanitize tsan" fuzz) broken=() times=() start
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
