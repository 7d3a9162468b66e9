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
  {
    printf 'name = "emulated"\nemulated = true\nperiod = 0.026\n[hull]\nradius = 0.35\n[limits]\nspeed = 0.1\n'
    printf '[[laser]]\nname = "front laser"\nport = "%s"\nrate = 500000\nstep_deg = 0.5\n' \
      "$links/scanner"
    printf '[base]\nport = "%s"\ntrack = 0.50\n' "$links/base"
    if [[ $base == p2os ]]; then
      printf 'type = "pioneer"\nwatchdog = 2.0\n'
    elif [[ $base == analog ]]; then
      printf 'type = "analog"\nlibrary = "%s"\nwheel_radius = 0.10\ncounts_per_turn = 2000\n' \
        "$root/${program%/*}/libemulated_comedi.so"
      printf 'speed_per_volt = 0.1\nrelay_closed_line = 1\nstop_line = 2\nfault_line = 3\n'
      printf 'bumper_lines = [4]\nenable_line = 5\n'
    else
      printf 'type = "roboteq"\nwatchdog = 0.5\nwheel_radius = 0.10\ngear = 20\n'
      printf 'encoder_lines = 500\nfull_speed_rpm = 1000\nbumper_inputs = [1]\nrear_bumper_inputs = [2]\n'
    fi
  } >"$links/robot.toml"
  "$root/$program" emulate robot --scenario demo --base "$base" --links "$links" </dev/null >&2 &
  emulator=$!
  say "The robot's file is $links/robot.toml; its devices are emulated."
  (cd -- "$caller" && exec "$root/$program" serve --robot "$links/robot.toml" "$@") || status=$?
  kill "$emulator" 2>/dev/null || true
  wait "$emulator" 2>/dev/null || true
  rm -rf -- "$links"
  return "$status"
}
