#!/usr/bin/env bash
# tests/dev/slurm.sh: an experiment on a real Slurm with two nodes on this machine, which are then
# troubled: a task is killed, the job is cancelled, a node is lost.
#
#   tests/dev/slurm.sh [whole] [killed] [cancelled] [lost]      (default: all four)
#
# Run by hand, as root, on a Debian; installs slurm-wlm and munge if they are missing. It wants
# build/release/server/tautline, or TAUTLINE=FILE. Each step ends with the result files of the local
# run, byte for byte. WORK=FOLDER keeps everything there.
set -euo pipefail

repository=$(cd -- "$(dirname -- "$0")/../.." && pwd -P)
tautline=${TAUTLINE:-$repository/build/release/server/tautline}
work=${WORK:-$(mktemp -d)}
mkdir -p -- "$work"
export SLURM_CONF=$work/etc/slurm.conf TMPDIR=$work/tmp

say() { printf '== %s\n' "$*"; }
fail() { printf 'slurm: %s\n' "$*" >&2; exit 1; }
((EUID == 0)) || fail "needs root, for slurmd"
[[ -x $tautline ]] || fail "$tautline is missing; build it, or set TAUTLINE"

# ---- the cluster ---------------------------------------------------------------------------------

pid_of() { cat -- "$work/$1.pid" 2>/dev/null || true; }
stop_one() {
  local pid
  pid=$(pid_of "$1")
  [[ -z $pid ]] || kill "$pid" 2>/dev/null || true
}
finish() {
  scancel --quiet --user=root 2>/dev/null || true
  local daemon
  for daemon in slurmd.n1 slurmd.n2 slurmctld munged; do stop_one "$daemon"; done
  [[ -n ${WORK:-} ]] || { sleep 2; rm -rf --one-file-system -- "$work"; }
}

write_configuration() {
  mkdir -p -- "$work"/{etc,state,spool.n1,spool.n2,log,munge,tmp}
  chmod 755 "$work" "$work/munge"
  dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 status=none
  chmod 400 "$work/munge/key"
  cat >"$SLURM_CONF" <<CONF
ClusterName=sweep
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
SlurmctldPort=${PORT:-17817}
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.%n.pid
SlurmdSpoolDir=$work/spool.%n
StateSaveLocation=$work/state
SlurmctldLogFile=$work/log/slurmctld
SlurmdLogFile=$work/log/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
SlurmdTimeout=30
NodeName=n1 NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=$((${PORT:-17817} + 1)) CPUs=1 State=UNKNOWN
NodeName=n2 NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=$((${PORT:-17817} + 2)) CPUs=1 State=UNKNOWN
PartitionName=main Nodes=n1,n2 Default=YES State=UP
CONF
}

start_cluster() {
  if ! command -v slurmctld munged >/dev/null; then
    apt-get install -y --no-install-recommends slurm-wlm munge
  fi
  write_configuration
  munged --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munged.pid" \
    --log-file="$work/munge/log" --seed-file="$work/munge/seed"
  slurmctld -f "$SLURM_CONF"
  local node
  for node in n1 n2; do slurmd -f "$SLURM_CONF" -N "$node"; done
  wait_for 30 "both nodes idle" two_idle
}

two_idle() { [[ $(sinfo --noheader --Node --format=%t | grep -c '^idle$') == 2 ]]; }

# wait_for SECONDS WHAT COMMAND...
wait_for() {
  local patience=$1 what=$2 start=$SECONDS
  shift 2
  until "$@"; do
    ((SECONDS - start < patience)) || fail "waited $patience s in vain: $what"
    sleep 0.5
  done
}

# ---- the experiment ------------------------------------------------------------------------------

write_document() {
  cat >"$work/document.json" <<'JSON'
{"name": "layouts", "scenarios": [{"random_layouts": {"count": 12}}],
 "controllers": ["original", "strip"], "repeats": 10, "physics": "bullet",
 "comparisons": {"baseline": "original"}}
JSON
}

tasks=8
out=  # folder of the current step
# The command of a user, to be repeated until its status is 0.
sweep() {
  local status=0
  "$tautline" sweep "$work/document.json" --slurm --tasks "$tasks" --out "$out" \
    --sbatch=--cpus-per-task=1 >"$out.txt" 2>&1 || status=$?
  grep '^submitted' -- "$out.txt" || true
  [[ $status == 0 || $status == 4 ]] || { cat -- "$out.txt"; fail "the command ended with status $status"; }
  return "$status"
}
saved() { compgen -G "$out/shards/*/runs.jsonl" >/dev/null; }

same_as_local() {
  local file
  for file in results.json runs.csv report.md report.tex report.html pictures scenarios; do
    diff -r -- "$work/local/$file" "$out/$file" >/dev/null || fail "$file differs from the local run's"
  done
}

begin() {
  say "$1"
  out=$work/$1
  rm -rf -- "$out"
  began=$SECONDS
  if sweep; then fail "nothing was submitted"; fi
}
end() {
  wait_for 600 "the report" sweep
  same_as_local
  say "$1: the same files as the local run, after $((SECONDS - began)) s"
}

whole() {
  begin whole
  end whole
}

# The processes of the first running task.
process_of_task() { pgrep -f -- "$out/document.json --shard" | head -n1; }
a_task_runs() { [[ -n $(process_of_task) ]]; }

killed() {
  begin killed
  wait_for 60 "a running task" a_task_runs
  kill -KILL "$(process_of_task)"
  end killed
}

cancelled() {
  begin cancelled
  wait_for 120 "a task that has ended" saved
  wait_for 60 "a running task" a_task_runs
  scancel --name="$(squeue --noheader --format=%j | head -n1)"
  end cancelled
}

# Everything of a node: its daemon, the daemons of its steps, and their children.
kill_tree() {
  local child
  for child in $(pgrep -P "$1"); do kill_tree "$child"; done
  kill -KILL "$1" 2>/dev/null || true
}
steps_of_node() {
  local job
  for job in $(squeue --noheader --array --states=running --nodelist="$1" --format=%A); do
    pgrep -f "slurmstepd: \[$job\." || true
  done
}
node_has_step() { [[ -n $(steps_of_node "$1") ]]; }
node_back() { [[ $(sinfo --noheader --Node --nodes="$1" --format=%t) =~ ^(idle|alloc|mix)$ ]]; }
node_down() { [[ $(sinfo --noheader --Node --nodes="$1" --format=%t) == down* ]]; }

lost() {
  begin lost
  wait_for 60 "a task on n2" node_has_step n2
  local steps step
  steps=$(steps_of_node n2)
  kill -KILL "$(pid_of slurmd.n2)"
  for step in $steps; do kill_tree "$step"; done
  wait_for 120 "n2 down" node_down n2
  say "n2 is down after $((SECONDS - began)) s; Slurm queues its task again"
  slurmd -f "$SLURM_CONF" -N n2
  wait_for 60 "n2 back" node_back n2
  end lost
}

trap finish EXIT
(($# > 0)) || set -- whole killed cancelled lost
start_cluster
write_document
began=$SECONDS
"$tautline" sweep "$work/document.json" --workers 1 --out "$work/local" >/dev/null
say "local, one worker: $((SECONDS - began)) s"
for step in "$@"; do
  case $step in
    whole | killed | cancelled | lost) "$step" ;;
    *) fail "there is no step '$step'; the steps are whole, killed, cancelled and lost" ;;
  esac
done
say "All of it works on Slurm: $*"
