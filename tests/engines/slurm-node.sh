#!/usr/bin/env bash
# A Slurm of one node on this machine, for tests: all that it writes is in one folder, and nothing of the system's own Slurm is
# touched. Needs root and Debian's packages:
#
#   apt-get install --no-install-recommends slurm-wlm
#   eval "$(tests/engines/slurm-node.sh start)"     # sets SLURM_CONF, which sbatch and its kin read
#   cargo test --release --test engines -- --nocapture
#   tests/engines/slurm-node.sh stop
set -euo pipefail

folder=${SLURM_NODE_DIR:-/tmp/sahlab-slurm}

start() {
    for tool in munged slurmctld slurmd sbatch; do
        PATH=$PATH:/usr/sbin command -v "$tool" >/dev/null || { echo "no $tool; install slurm-wlm" >&2; exit 2; }
    done
    rm -rf "$folder"
    mkdir -p "$folder"/{state,spool,munge}
    chmod 0755 "$folder" "$folder/munge"
    head -c 1024 /dev/urandom >"$folder/munge/key"
    chmod 0600 "$folder/munge/key"
    # Its own key and socket; --force, as it would rather not run as root.
    PATH=$PATH:/usr/sbin munged --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
        --pid-file="$folder/munge/pid" --log-file="$folder/munge/log" --seed-file="$folder/munge/seed" >&2
    local host
    host=$(hostname -s)
    cat >"$folder/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=1000 State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF="$folder/slurm.conf"
    PATH=$PATH:/usr/sbin slurmctld >&2
    sleep 1
    PATH=$PATH:/usr/sbin slurmd >&2
    for _ in $(seq 50); do
        sinfo --noheader --states=idle,mixed,allocated --format=%N 2>/dev/null | grep -q . && break
        sleep 0.2
    done
    sinfo >&2
    echo "export SLURM_CONF='$SLURM_CONF'"
}

stop() {
    SLURM_CONF="$folder/slurm.conf" scontrol shutdown || true
    sleep 1
    for pid in "$folder"/slurmd.pid "$folder"/slurmctld.pid "$folder"/munge/pid; do
        if [ -f "$pid" ]; then kill "$(cat "$pid")" 2>/dev/null || true; fi
    done
    rm -rf "$folder"
}

case ${1:-} in
start | stop) "$1" ;;
*)
    echo "usage: $0 start|stop" >&2
    exit 2
    ;;
esac
