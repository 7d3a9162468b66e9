# tests/dev/image.sh: builds the image, runs it by docker/compose.yaml, kills it and checks its runs;
# sourced by ./dev.
# shellcheck shell=bash
# shellcheck disable=SC2154 # root, work, say, fail and the package lists are those of ./dev

image_packages=(docker.io docker-compose containerd mmdebstrap)

# Uses the running engine, or starts a temporary one, which needs root and the right to mount. Without
# an engine it prints why and returns 1.
start_engine() {
  docker=/usr/bin/docker
  [[ -x $docker ]] || docker=$(command -v docker || true)
  if [[ -n $docker ]] && "$docker" version >/dev/null 2>&1; then return; fi
  ((EUID == 0)) || { say "No container engine runs here, and starting one needs root."; return 1; }
  need "${image_packages[@]}"
  docker=/usr/bin/docker
  engine=$(mktemp -d /tmp/tautline-engine.XXXXXX)
  export DOCKER_HOST=unix://$engine/sock
  setsid dockerd --data-root "$engine/data" --exec-root "$engine/exec" --pidfile "$engine/pid" \
    -H "$DOCKER_HOST" --iptables=false --ip6tables=false --bridge=none >"$work/dockerd.log" 2>&1 9>&- &
  for _ in {1..60}; do
    "$docker" version >/dev/null 2>&1 && return
    read -rt 0.5 <> <(:) || true
  done
  tail -n 5 "$work/dockerd.log" >&2
  say "A container engine cannot be started here (the whole reason is in $work/dockerd.log)."
  return 1
}

stop_engine() {
  [[ -n "${engine:-}" ]] || return 0
  kill "$(cat "$engine/pid")" 2>/dev/null || true
  for _ in {1..40}; do
    [[ -e $engine/pid ]] || break
    read -rt 0.25 <> <(:) || true
  done
  umount "$engine"/exec/netns/* 2>/dev/null || true
  umount "$engine/data" 2>/dev/null || true
  rm -rf --one-file-system -- "$engine"
}

# The published base image, or without a registry a similar one from Debian's archive, with this host's
# access to package sources.
base_image() {
  "$docker" image inspect debian:bookworm-slim >/dev/null 2>&1 && return
  timeout 60 "$docker" pull -q debian:bookworm-slim >/dev/null 2>&1 && return
  local base change=()
  base=$(mktemp -d)
  apt-config dump | grep '^Acquire::' >"$base/apt.conf" || true
  mmdebstrap --quiet --variant=minbase --include=ca-certificates --aptopt="$base/apt.conf" \
    --customize-hook="copy-in /etc/resolv.conf /etc" \
    --customize-hook="if ls /usr/local/share/ca-certificates/*.crt >/dev/null 2>&1; then
      cp /usr/local/share/ca-certificates/*.crt \"\$1/usr/local/share/ca-certificates/\"
      chroot \"\$1\" update-ca-certificates >/dev/null 2>&1; fi" \
    --customize-hook="cat \"$(npm config get globalconfig)\" \"$(npm config get userconfig)\" \
      >\"\$1/root/.npmrc\" 2>/dev/null || true" \
    --customize-hook="rm -rf \"\$1\"/usr/share/{doc,man,info,locale}/* \
      \"\$1\"/var/cache/apt/* \"\$1\"/var/lib/apt/lists/*" \
    bookworm "$base/base.tar"
  change=(--change 'ENV NODE_EXTRA_CA_CERTS=/etc/ssl/certs/ca-certificates.crt')
  "$docker" import "${change[@]}" "$base/base.tar" debian:bookworm-slim >/dev/null
  rm -rf -- "$base"
}

compose() { docker-compose -f docker/compose.yaml -p "$project" "$@"; }
container() { compose ps -q tautline; }
state_of() { "$docker" inspect -f "$1" "$(container)"; }

# wait_for WHAT SECONDS COMMAND...
wait_for() {
  local what=$1 left=$(($2 * 4))
  shift 2
  until "$@"; do
    ((left-- > 0)) || { compose logs --tail 20 >&2; fail "$what did not happen in time"; }
    read -rt 0.25 <> <(:) || true
  done
}
healthy() { [[ $(state_of '{{.State.Health.Status}}') == healthy ]]; }
restarted() { (($(state_of '{{.RestartCount}}') > $1)) && healthy; }

# Drives through the API, kills the container, and checks that its runs are back.
try_image() {
  local bytes before after pid
  bytes=$("$docker" image inspect -f '{{.Size}}' tautline)
  say "The image takes $((bytes / 1000000)) MB."
  ((bytes < 250000000)) || fail "that is more than 250 MB"
  compose up -d >"$work/compose.log" 2>&1 || { cat "$work/compose.log" >&2; fail "it did not start"; }
  wait_for "a healthy container" 60 healthy
  say "It is healthy."
  TAUTLINE_URL=http://127.0.0.1:$TAUTLINE_PORT node --test tests/web/image/*.mjs
  before=$(curl_json "runs?limit=500" | count_runs)
  pid=$(state_of '{{.State.Pid}}')
  kill -9 "$pid"
  wait_for "the restart after kill -9" 60 restarted 0
  after=$(curl_json "runs?limit=500" | count_runs)
  say "Killed with $before runs, back with $after."
  ((after >= before && before > 0)) || fail "runs were lost"
  curl_json "runs?status=interrupted" | grep -q '"interrupted"' || fail "the cut run is not marked interrupted"
}
curl_json() { node -e 'fetch(process.argv[1]).then((r) => r.text()).then((t) => console.log(t))' \
  "http://127.0.0.1:$TAUTLINE_PORT/api/v1/$1"; }
count_runs() { node -e 'let t = ""; process.stdin.on("data", (d) => (t += d)).on("end", () =>
  console.log(JSON.parse(t).items.length))'; }

verb_image() {
  # Not local: the trap at the end still needs them.
  docker='' engine='' project=tautline-check$$
  need "${run_packages[@]}" "${test_packages[@]}"
  install_modules
  start_engine || return 0
  trap 'compose down -v >/dev/null 2>&1 || true; stop_engine' EXIT
  export TAUTLINE_PORT=${TAUTLINE_PORT:-18090}
  quietly image-base.log "The base image" base_image
  quietly image.log "Building the image" "$docker" build --network host -t tautline -f docker/Dockerfile .
  try_image
  say "The image works. It is called tautline."
}
