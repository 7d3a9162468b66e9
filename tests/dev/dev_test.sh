#!/usr/bin/env bash
# tests/dev/dev_test.sh: ./dev must not report a failed run as passed, nor install present packages.
set -euo pipefail
shopt -s inherit_errexit # as strict within $( ) as at the top of ./dev

# shellcheck source=dev
source "$(dirname -- "${BASH_SOURCE[0]}")/../../dev"
scratch=$(mktemp -d)
trap 'rm -rf -- "$scratch"' EXIT
cd -- "$scratch"
work=$scratch # the log folder of ./dev
mkdir -p "$scratch/bin"

wrong=0
# expect WHAT WANTED GOT
expect() {
  if [[ "$2" != "$3" ]]; then
    printf '%s\n  wanted: %s\n  got:    %s\n' "$1" "$2" "$3" >&2
    wrong=$((wrong + 1))
  fi
}

# sum_of COMMAND...: the final line and status after the suites of COMMAND, in a subshell.
sum_of() {
  ("$@" >/dev/null 2>&1; closing_line && echo status 0 || echo status 1) | paste -sd ' '
}

# ---- suites of node --test: figures read from their output ----
tap() { printf 'TAP version 13\nok 1 - a # pass 7\n# tests 4\n# pass %d\n# fail %d\n# cancelled 0\n# skipped 1\n# todo 0\n' "$1" "$2"; }
spec() { printf '✔ reads # pass 9 (1 ms)\nℹ tests 3\nℹ pass 3\nℹ fail 0\nℹ cancelled 0\nℹ skipped 0\nℹ todo 0\n'; }
failing_tap() { tap 2 1; return 1; }
broken() { printf 'SyntaxError: Unexpected token\n'; return 1; }
dies_late() { tap 3 0; return 1; }

# `timeout` runs only programs, and these are functions.
timeout() { shift 3; "$@"; }

expect "TAP figures" "3 passed, 0 failed, 1 skipped status 0" "$(sum_of run_node t tap 3 0)"
expect "spec figures" "3 passed, 0 failed status 0" "$(sum_of run_node t spec)"
expect "a failure" "2 passed, 1 failed, 1 skipped status 1" "$(sum_of run_node t failing_tap)"
expect "a suite that does not start" "0 passed, 1 failed status 1" "$(sum_of run_node t broken)"
expect "status 1 without a failed test" "3 passed, 1 failed, 1 skipped status 1" \
  "$(sum_of run_node t dies_late)"
expect "a suite without tests" "0 passed, 1 failed, 1 skipped status 1" "$(sum_of run_node t tap 0 0)"
two_suites() { run_node a spec; run_node b failing_tap; }
expect "suites are summed" "5 passed, 1 failed, 1 skipped status 1" "$(sum_of two_suites)"
expect "nothing at all" "0 passed, 0 failed status 1" "$(sum_of true)"

# ---- the browser's suites: a suite that fails beside another one runs again alone ----
# fake_browser FAILURES: the failed tests of the second run; the first run has one of four, in layout.mjs.
# shellcheck disable=SC2317 # run_browser calls these functions through timeout
fake_browser() {
  fake=("$@")
  mkdir -p tests/web && touch tests/web/{layout,world}.mjs
  node() {
    if [[ $2 == --test-concurrency=1 ]]; then
      [[ "${*:3}" == /there/tests/web/layout.mjs ]] || return 3
      tap $((2 - fake[0])) "${fake[0]}"
      return $((fake[0] > 0))
    fi
    printf "not ok 1 - late\n  location: '/there/tests/web/layout.mjs:3:1'\n"
    tap 3 1
    return 1
  }
  root='' run_browser
}
expect "a late suite passes alone" "4 passed, 0 failed, 1 skipped status 0" "$(sum_of fake_browser 0)"
expect "a suite fails alone too" "3 passed, 1 failed, 1 skipped status 1" "$(sum_of fake_browser 1)"
# shellcheck disable=SC2317
broken_browser() {
  node() { broken; }
  root='' run_browser
}
expect "no suite starts" "0 passed, 1 failed status 1" "$(sum_of broken_browser)"

# ---- ctest: figures read from its report ----
# fake_ctest TESTS FAILURES DISABLED SKIPPED STATUS
fake_ctest() {
  ctest() {
    printf '<testsuite name="x"\n\ttests="%s"\n\tfailures="%s"\n\tdisabled="%s"\n\tskipped="%s"\n>\n' \
      "${fake[@]:0:4}" >"${*: -1}"
    return "${fake[4]}"
  }
  fake=("$@")
  root='' run_ctest release
}
expect "ctest, all well" "9 passed, 0 failed, 1 skipped status 0" "$(sum_of fake_ctest 10 0 0 1 0)"
expect "ctest, two failed" "8 passed, 2 failed status 1" "$(sum_of fake_ctest 10 2 0 0 8)"
expect "ctest, a test not run" "9 passed, 1 failed, 1 skipped status 1" "$(sum_of fake_ctest 10 0 0 1 8)"
expect "ctest, no test" "0 passed, 1 failed status 1" "$(sum_of fake_ctest 0 0 0 0 0)"
no_report() { ctest() { return 1; }; root='' run_ctest release; }
expect "ctest, no report" "0 passed, 1 failed status 1" "$(sum_of no_report)"

# ---- long work: quiet on success, output on failure ----
expect "quiet success" "" "$(quietly a.log "A" echo hidden 2>&1)"
loud() { echo "the reason"; return 3; }
words=$(quietly b.log "Building" loud 2>&1) && status=0 || status=$?
expect "the status comes through" 3 "$status"
expect "the reason is shown" "the reason" "$(head -n 1 <<<"$words")"
expect "the work is named" yes "$([[ $words == *"Building: failed"* ]] && echo yes)"

# ---- packages: found by dpkg, or by their program if it may have other sources ----
dpkg-query() { printf 'installed g++\nconfig-files cmake\n'; return 1; }
printf '#!/bin/sh\n' >"$scratch/bin/node"
chmod +x "$scratch/bin/node"
expect "missing packages" "cmake npm" "$(PATH=$scratch/bin:/usr/bin:/bin
  # shellcheck disable=SC2317
  command() { [[ $2 != npm ]] && builtin command "$@"; }
  missing g++ cmake nodejs npm | paste -sd ' ')"

((wrong == 0)) || { echo "$wrong expectations failed" >&2; exit 1; }
echo "dev: all expectations hold"
