#!/usr/bin/env bash
# farm_hosts.sh - loopback "hosts" for GNU Parallel's --sshlogin: one sshd per host name,
# all on 127.0.0.1, each with its own port, so that one can be killed like a machine.
#   farm_hosts.sh up             start; prints "export PARALLEL_SSH=..." on stdout
#   farm_hosts.sh down           stop all, delete the folder
#   farm_hosts.sh kill-host H    kill -9 H's sshd and everything under it (power cut)
#   farm_hosts.sh start-host H   start H's sshd (again)
#   farm_hosts.sh install        apt-get install what this needs (Debian 12)
# Settings: FARM_SSH_DIR (/tmp/farm_hosts.$UID), FARM_HOSTS ("nodeA nodeB")
set -euo pipefail
export LC_ALL=C PATH=$PATH:/usr/sbin
D=${FARM_SSH_DIR:-/tmp/farm_hosts.$(id -u)}
HOSTS=${FARM_HOSTS:-nodeA nodeB}

free_port() {
  local p
  for p in $(shuf -i 20000-32000 -n 50); do
    (exec 3<>/dev/tcp/127.0.0.1/$p) 2>/dev/null || { echo $p; return; }
  done
}
tree() { local c; for c in $(pgrep -P "$1" || true); do tree $c; done; echo "$1"; }   # none: a leaf
kill_host() {
  local p; p=$(cat $D/$1.pid 2>/dev/null) || return 0
  tr '\0' ' ' </proc/$p/cmdline 2>/dev/null | grep -q "$D/$1.conf" || return 0
  kill -STOP $p; kill -KILL $(tree $p) 2>/dev/null || true   # some ended
}
# FARM_ENV_nodeA="NAME=VALUE ...": variables of that host. FARM_HIDE_nodeA=FOLDER: that host finds an empty folder there.
start_host() {
  local hidden=FARM_HIDE_$1; rm -f $D/$1.pid
  if [ -n "${!hidden:-}" ]; then
    unshare -m bash -c "mount -t tmpfs none '${!hidden}' && exec $(command -v sshd) -f $D/$1.conf -E $D/$1.log"
  else
    $(command -v sshd) -f $D/$1.conf -E $D/$1.log
  fi
}
up() {
  [ ! -e $D ] || { echo "farm_hosts: already up in $D (run: $0 down)" >&2; exit 1; }
  command -v sshd parallel >/dev/null || { echo "farm_hosts: run: $0 install" >&2; exit 1; }
  mkdir -p -m 700 $D; [ $(id -u) != 0 ] || mkdir -p -m 755 /run/sshd
  ssh-keygen -q -t ed25519 -N '' -f $D/host; ssh-keygen -q -t ed25519 -N '' -f $D/id
  echo "farm $(cut -d' ' -f1,2 $D/host.pub)" >$D/known_hosts
  local h port
  for h in $HOSTS; do
    port=$(free_port)
    # SetEnv tells a job which "host" it runs on: they share one uname -n
    cat >$D/$h.conf <<C
ListenAddress 127.0.0.1
Port $port
HostKey $D/host
PidFile $D/$h.pid
AuthorizedKeysFile $D/id.pub
StrictModes no
UsePAM no
PasswordAuthentication no
KbdInteractiveAuthentication no
PermitRootLogin prohibit-password
AllowUsers $(id -un)
SetEnv FARM_HOST=$h $(eval echo "\${FARM_ENV_$h:-}")
MaxStartups 100
C
    cat >>$D/ssh_config <<C
Host $h
  HostName 127.0.0.1
  Port $port
C
    start_host $h
  done
  cat >>$D/ssh_config <<C
Host *
  User $(id -un)
  IdentityFile $D/id
  IdentitiesOnly yes
  UserKnownHostsFile $D/known_hosts
  HostKeyAlias farm
  BatchMode yes
  ConnectTimeout 5
  ServerAliveInterval 5
  ServerAliveCountMax 2
  LogLevel ERROR
C
  for h in $HOSTS; do
    for i in $(seq 50); do ssh -F $D/ssh_config $h true && continue 2; sleep 0.1; done
    echo "farm_hosts: $h does not answer" >&2; cat $D/$h.log >&2; exit 1
  done
  echo "export PARALLEL_SSH='ssh -F $D/ssh_config'"
}
down() {
  [ -e $D/ssh_config ] || return 0
  local f; for f in $D/*.conf; do f=${f##*/}; kill_host ${f%.conf}; done
  rm -rf $D
}
case ${1:-} in
  up) up ;;
  down) down ;;
  kill-host) kill_host ${2:?host} ;;
  start-host) start_host ${2:?host} ;;
  install) export DEBIAN_FRONTEND=noninteractive
    apt-get update -q; apt-get install -qy --no-install-recommends openssh-server parallel ;;
  *) sed -n '2,9s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
