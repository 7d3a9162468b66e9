#!/usr/bin/env bash
# tests/dev/mrpt_peer.sh [FOLDER]: an independent client, MRPT's rawlog-grabber with its SICK driver,
# reads scans from `tautline emulate lms200`, and every range is compared with the one sent.
#
# Needs the built program, python3, and Debian's package sources: mrpt-apps is fetched into FOLDER
# (default: a temporary one that is deleted) and unpacked there; nothing is installed.
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
program=${TAUTLINE_PROGRAM:-$root/build/release/server/tautline}
seconds=${SECONDS_OF_SCANS:-15}
folder=${1:-}
[[ -x $program ]] || { echo "There is no $program: ./dev tautline --help builds it." >&2; exit 1; }
if [[ -z $folder ]]; then
  folder=$(mktemp -d)
  temporary=$folder
fi
work=$(mktemp -d)
emulator=
keyboard=
# shellcheck disable=SC2317
finish() {
  kill ${emulator:+"$emulator"} ${keyboard:+"$keyboard"} 2>/dev/null || true
  rm -rf "$work" ${temporary:+"$temporary"}
}
trap finish EXIT
# rawlog-grabber ends at the end of its standard input, so give it one that stays open and empty.
mkfifo "$work/keys"
sleep infinity >"$work/keys" &
keyboard=$!

# ---- MRPT, unpacked ------------------------------------------------------------------------------
if [[ ! -x $folder/root/usr/bin/rawlog-grabber ]]; then
  mkdir -p "$folder/partial" "$folder/root"
  apt-get install -y -q -d --no-install-recommends -o Dir::Cache::archives="$folder" \
    -o Debug::NoLocking=1 mrpt-apps >"$work/apt.log" 2>&1 || { cat "$work/apt.log" >&2; exit 1; }
  for package in "$folder"/*.deb; do dpkg -x "$package" "$folder/root"; done
  rm -f "$folder"/*.deb
fi
libraries=$(find "$folder/root/usr/lib" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
mrpt() {
  local tool=$1
  shift
  LD_LIBRARY_PATH=$libraries "$folder/root/usr/bin/$tool" "$@"
}

# grab NAME SECONDS EMULATOR_OPTIONS... -- MRPT_LINES...: one session; its scans end in NAME.txt.
grab() {
  local name=$1 span=$2 options=()
  shift 2
  while [[ $1 != -- ]]; do options+=("$1") && shift; done
  shift
  "$program" emulate lms200 --link "$work/$name.port" --record "$work/$name.truth" \
    --scenario case3 "${options[@]}" >"$work/$name.emulator" 2>&1 </dev/null &
  emulator=$!
  for _ in $(seq 100); do [[ -L $work/$name.port ]] && break; sleep 0.1; done
  {
    printf '[global]\nrawlog_prefix = %s\ntime_between_launches = 50\n' "$work/$name"
    printf 'use_sensoryframes = 0\nGRABBER_PERIOD_MS = 10\nrawlog_GZ_compress_level = 0\n'
    printf '[LASER]\ndriver = CSickLaserSerial\nsensorLabel = LASER\nprocess_rate = 200\n'
    printf 'COM_port_LIN = %s\n' "$work/$name.port"
    printf '%s\n' "$@"
  } >"$work/$name.ini"
  LD_LIBRARY_PATH=$libraries timeout -s INT -k 10 "$span" \
    "$folder/root/usr/bin/rawlog-grabber" "$work/$name.ini" >"$work/$name.log" 2>&1 <"$work/keys" || true
  kill "$emulator"
  wait "$emulator" || true
  emulator=
}

# compare NAME: every scan MRPT stored against the record of the emulator.
compare() {
  local name=$1 rawlog
  rawlog=$(find "$work" -maxdepth 1 -name "$name*.rawlog" | head -n 1)
  if [[ -z $rawlog ]]; then
    tail -n 20 "$work/$name.log" >&2
    echo "$name: MRPT stored nothing." >&2
    return 1
  fi
  (cd "$work" && mrpt rawlog-edit --export-2d-scans-txt -i "$(basename "$rawlog")" --out-dir . -w \
    >"$work/$name.edit" 2>&1) || { cat "$work/$name.edit" >&2; return 1; }
  python3 "$root/tests/dev/mrpt_compare.py" "$name" "$work/$name.truth" "$work" || return 1
  rm -f "$work"/*LASER*.txt
}

status=0
for resolution in 50 100; do
  for unit in 1 0; do
    name=r$resolution.mm$unit
    grab "$name" "$seconds" -- 'COM_baudRate = 38400' "mm_mode = $unit" 'FOV = 180' \
      "resolution = $resolution"
    compare "$name" || status=1
  done
done
# 401 values make a telegram of 812 bytes, and that client drops those above 800.
grab f100 "$seconds" -- 'COM_baudRate = 38400' 'mm_mode = 1' 'FOV = 100' 'resolution = 50'
compare f100 || status=1

# Cases that MRPT cannot handle, but our driver must: a device with an address, and one that starts
# up for nine seconds.
for case in '--address 1' '--boot 9'; do
  # shellcheck disable=SC2086
  grab refused 8 $case -- 'COM_baudRate = 38400' 'mm_mode = 1' 'FOV = 180' 'resolution = 50'
  if grep -q '^scan .* sent ' "$work/refused.truth"; then
    echo "MRPT connected with $case" && status=1
  else
    echo "MRPT does not connect with $case (expected)"
  fi
done
exit "$status"
