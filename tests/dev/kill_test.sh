#!/usr/bin/env bash
# tests/dev/kill_test.sh: kills the real server at random moments of a 1x run and checks that at most
# 1.1 s are lost, the file is intact, and the run is marked interrupted at the next start. With `post`
# the server is storing a batch of 10,000 runs at that moment.
#
# tests/dev/kill_test.sh PROGRAM [KILLS] [post]
set -euo pipefail
program=$1
kills=${2:-20}
load=${3:-}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
worst=0

for ((i = 1; i <= kills; ++i)); do
  : >"$folder/log" # so that the last server's address is not read
  "$program" serve --port 0 --db "$folder/runs.db" --scenario case1 >"$folder/log" 2>&1 &
  server=$!
  until url=$(grep -o 'http://[^ ]*' "$folder/log" | head -n 1) && [ -n "$url" ]; do sleep 0.02; done
  sleep "$(awk -v r="$RANDOM" 'BEGIN{print 1.2 + 2.5 * r / 32768}')"
  if [ "$load" = post ]; then
    curl -s -o "$folder/answer" -H 'Content-Type: application/json' "${url%/}/api/v1/runs" \
      -d '{"scenario":"case1","vehicle":"kinematic","repeats":10000}' &
    sleep "$(awk -v r="$RANDOM" 'BEGIN{print 1.0 * r / 32768}')"
  fi
  # The newest tick sent to a viewer just before the end.
  curl -s "${url%/}/api/v1/session" >"$folder/seen"
  kill -9 "$server"
  wait "$server" 2>/dev/null || true
  read -r run stamp < <(python3 -c 'import json,sys; d=json.load(sys.stdin); print(d["run"]["id"], d["stamp"])' <"$folder/seen")
  check=$(sqlite3 "$folder/runs.db" 'PRAGMA integrity_check')
  stored=$(sqlite3 "$folder/runs.db" "SELECT coalesce(max(t), 0) FROM tick WHERE run = $run")
  lost=$(awk -v a="$stamp" -v b="$stored" 'BEGIN{printf "%.3f", a - b}')
  worst=$(awk -v a="$worst" -v b="$lost" 'BEGIN{print (b > a) ? b : a}')
  printf 'kill %2d: run %s shown up to %.2f s, stored up to %.2f s, lost %s s, integrity %s\n' \
    "$i" "$run" "$stamp" "$stored" "$lost" "$check"
  [ "$check" = ok ] || exit 1
  awk -v l="$lost" 'BEGIN{exit !(l <= 1.1)}' || { echo "More than 1.1 s lost."; exit 1; }
done

"$program" serve --port 0 --db "$folder/runs.db" --scenario case1 >"$folder/log" 2>&1 &
server=$!
until grep -q http "$folder/log"; do sleep 0.02; done
interrupted=$(sqlite3 "$folder/runs.db" "SELECT count(*) FROM run WHERE status = 'interrupted'" 2>/dev/null ||
  curl -s "$(grep -o 'http://[^ ]*' "$folder/log" | head -n 1)api/v1/runs?status=interrupted" | grep -o '"status":"interrupted"' | wc -l)
kill "$server"
wait "$server" 2>/dev/null || true
echo "worst loss $worst s of $kills; $interrupted runs marked interrupted"
