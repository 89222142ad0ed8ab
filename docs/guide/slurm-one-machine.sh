#!/bin/bash
# Slurm with one node, this machine, and the array of docs/guide/slurm-array.sh in it: to try what a
# cluster would do. As root, once Debian's packages are there and `lamplight` is on the path:
#
#     apt-get install -y slurmd slurmctld slurm-client munge
#     docs/guide/slurm-one-machine.sh shaderlib/lamplight.toml /tmp/slurm/bundle 8
#
# The daemons stop with the script.
set -euo pipefail

manifest=$(realpath "$1")
out=$(realpath -m "$2")
shards=$3
script=$(dirname "$(realpath "$0")")/slurm-array.sh
state=$(mktemp -d)
name=$(hostname -s)

# Whom to trust: one key for all daemons.
key=$state/munge.key
head -c 1024 /dev/urandom > "$key"
chown munge: "$key" && chmod 400 "$key" && chmod 755 "$state"
mkdir -p "$state/munge" && chown munge: "$state/munge" && chmod 755 "$state/munge"
socket=$state/munge/socket
runuser -u munge -- munged --foreground --key-file="$key" --socket="$socket" --pid-file="$state/munge/pid" \
    --seed-file="$state/munge/seed" --log-file="$state/munge/log" 2> "$state/munge.err" &

cat > "$state/slurm.conf" <<END
ClusterName=one
SlurmctldHost=$name
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MailProg=/bin/true
StateSaveLocation=$state/controller
SlurmdSpoolDir=$state/node
SlurmctldPidFile=$state/slurmctld.pid
SlurmdPidFile=$state/slurmd.pid
SlurmctldLogFile=$state/slurmctld.log
SlurmdLogFile=$state/slurmd.log
NodeName=$name CPUs=$(nproc) RealMemory=$(($(grep -Po '^MemTotal: *\K[0-9]+' /proc/meminfo) / 1024)) State=UNKNOWN
PartitionName=all Nodes=$name Default=YES State=UP
END
export SLURM_CONF=$state/slurm.conf
mkdir "$state/controller" "$state/node"
slurmctld -D 2> "$state/slurmctld.err" &
slurmd -D 2> "$state/slurmd.err" &
trap 'kill $(jobs -p) 2> "$state/kill" || true; wait' EXIT

for _ in $(seq 100); do
    [ "$(sinfo --noheader --format=%T 2> "$state/sinfo" || true)" = idle ] && break
    sleep 0.2
done
sinfo
mkdir -p "$out.log"
cd "$out.log"
sbatch --array="1-$shards" "$script" "$manifest" "$out"
while [ -n "$(squeue --noheader --states=all --format='%T' | grep -Ev 'COMPLETED|FAILED|CANCELLED|TIMEOUT' || true)" ]; do
    sleep 0.5
done
squeue --states=all --sort=i --format='%.8i %.16j %.10T %.8M'
tail -n +1 -- *.out
