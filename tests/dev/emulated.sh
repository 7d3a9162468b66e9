# tests/dev/emulated.sh: part of ./dev: a robot of emulated devices on pseudo-terminals.
# shellcheck shell=bash
# shellcheck disable=SC2154 # root, caller and program are ./dev's

# run_emulated [--base p2os|analog] [ARGS]: emulates base and scanner and serves them; ARGS as for serve.
run_emulated() {
  local base=roboteq links emulator status=0
  if [[ "${1:-}" == --base ]]; then
    base=${2:-}
    shift 2
  fi
  [[ $base =~ ^(roboteq|p2os|analog)$ ]] || fail "--base is roboteq, p2os or analog, not '$base'"
  build_program release tautline
  links=$(mktemp -d)
  "$root/$program" emulate robot --scenario demo --base "$base" --links "$links" </dev/null >&2 &
  emulator=$!
  until [[ -s $links/robot.toml ]]; do
    kill -0 "$emulator" 2>/dev/null || fail "The emulator ended."
    sleep 0.1
  done
  (cd -- "$caller" && exec "$root/$program" serve --robot "$links/robot.toml" "$@") || status=$?
  kill "$emulator" 2>/dev/null || true
  wait "$emulator" 2>/dev/null || true
  rm -rf -- "$links"
  return "$status"
}
