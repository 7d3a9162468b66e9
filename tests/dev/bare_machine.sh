#!/usr/bin/env bash
# tests/dev/bare_machine.sh: a new user's first commands in a fresh, minimal Debian 12.
#
#   tests/dev/bare_machine.sh [run] [test] [check]      (default: run test)
#
# Run by hand, as root, on a Debian with mmdebstrap, git and curl. The bare system gets only the
# host's access to package sources (certificates, proxies, apt and npm settings). BARE=FOLDER keeps
# the system there; otherwise a temporary folder is used and removed.
set -euo pipefail

if [[ -z "${BARE_MACHINE_INSIDE:-}" ]]; then
  ((EUID == 0)) || { echo "bare_machine.sh needs root, for mmdebstrap and chroot." >&2; exit 1; }
  # A separate mount namespace, so that no mount stays behind.
  exec env BARE_MACHINE_INSIDE=1 unshare --mount --propagation private -- bash "$0" "$@"
fi

repository=$(cd -- "$(dirname -- "$0")/../.." && pwd -P)
bare=${BARE:-$(mktemp -d)}
port=${PORT:-18080}
patience=${PATIENCE:-1200}  # [s] that the first ./dev run may take
server=
finish() {
  [[ -z "$server" ]] || kill "$server" 2>/dev/null || true
  umount -R "$bare"/{proc,dev/shm,dev/pts} 2>/dev/null || true
  [[ -n "${BARE:-}" ]] || rm -rf --one-file-system -- "$bare"
}
trap finish EXIT

say() { printf '== %s\n' "$*"; }
fail() { printf 'bare_machine: %s\n' "$*" >&2; exit 1; }

# ---- the bare system, with the host's access to package sources -----------------------------------

make_bare() {
  local sources=() file
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/debian*.sources; do
    [[ ! -s $file ]] || sources+=("$file")
  done
  apt-config dump | grep '^Acquire::' >"$bare.apt" || true
  say "A bare Debian 12 in $bare"
  mmdebstrap --quiet --variant=minbase --include=ca-certificates --aptopt="$bare.apt" \
    bookworm "$bare" "${sources[@]}"
  rm -f -- "$bare.apt"
  cp /etc/resolv.conf "$bare/etc/resolv.conf"
  cp /usr/local/share/ca-certificates/*.crt "$bare/usr/local/share/ca-certificates/" 2>/dev/null || true
  chroot "$bare" update-ca-certificates >/dev/null 2>&1
  if command -v npm >/dev/null; then
    cat -- "$(npm config get globalconfig)" "$(npm config get userconfig)" >"$bare/root/.npmrc" 2>/dev/null || true
  fi
  mount -t proc proc "$bare/proc"
  mkdir -p "$bare/dev/shm" "$bare/dev/pts"
  mount -t tmpfs tmpfs "$bare/dev/shm"
  mount -t devpts -o newinstance,ptmxmode=0666 devpts "$bare/dev/pts"
  git clone --quiet --no-hardlinks "$repository" "$bare/root/tautline"
}

# The environment of a fresh login, plus only our access to package sources.
lent=()
while IFS= read -r name; do
  lent+=("$name=${!name}")
done < <(compgen -e | grep -E '^(https?_proxy|no_proxy|HTTPS?_PROXY|NO_PROXY|NODE_EXTRA_CA_CERTS|SSL_CERT_FILE)$' || true)

# inside [--userspec=USER] COMMAND...: replaces this process, so that the command has its pid.
inside() {
  local options=()
  while [[ $1 == --* ]]; do options+=("$1") && shift; done
  exec chroot "${options[@]}" "$bare" /usr/bin/env -i HOME=/root TERM=dumb LANG=C.UTF-8 \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${lent[@]}" "$@"
}

# ---- a new user's commands ------------------------------------------------------------------------

# Without root and sudo, ./dev prints one line to run, and breaks nothing.
try_without_root() {
  local words status=0
  cp -a "$bare/root/tautline" "$bare/tmp/tautline"
  chroot "$bare" chown -R nobody: /tmp/tautline
  words=$(inside --userspec=nobody /tmp/tautline/dev run </dev/null 2>&1) || status=$?
  rm -rf -- "$bare/tmp/tautline"
  printf '%s\n' "$words"
  [[ $status == 1 ]] || fail "without root, ./dev run ended with status $status instead of 1"
  grep -q '^ *apt-get update && apt-get install .*g++' <<<"$words" || fail "the line to run was not printed"
}

# ./dev run until its URL answers; prints how long that took.
try_run() {
  local log start=$SECONDS url=
  log=$(mktemp)
  (inside /root/tautline/dev run --port "$port" </dev/null) >"$log" 2>&1 &
  server=$!
  until url=$(grep -om1 'http://[^ ]*' "$log") && curl -fsS "${url%/}/api/v1/healthz"; do
    kill -0 "$server" 2>/dev/null || { cat -- "$log"; fail "./dev run ended before it served"; }
    ((SECONDS - start < patience)) || { cat -- "$log"; fail "./dev run did not serve within $patience s"; }
    sleep 0.2
  done
  printf '\n'
  cat -- "$log"
  curl -fsS "${url%/}/" | grep -qi '<html' || fail "$url is no page"
  say "$1: served after $((SECONDS - start)) s"
  kill "$server"
  wait "$server" || say "the server ended with status $?"
  server=
  rm -f -- "$log"
}

try_verb() {
  local start=$SECONDS
  (inside env CI=true /root/tautline/dev "$1" </dev/null) || fail "./dev $1 failed after $((SECONDS - start)) s"
  say "./dev $1: $((SECONDS - start)) s"
}

(($# > 0)) || set -- run test
make_bare
for step in "$@"; do
  case $step in
    run)
      try_without_root
      try_run "First ./dev run"
      try_run "Second ./dev run"
      ;;
    test | check) try_verb "$step" ;;
    *) fail "there is no step '$step'; the steps are run, test and check" ;;
  esac
done
say "All of it works on a bare machine: $*"
