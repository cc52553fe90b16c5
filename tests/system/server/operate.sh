#!/bin/sh
# operate.sh PAGE RUGO PORT: runs the blocks of shell commands of server/operate.md, one after the other, in this folder.
# Its folders are folders here, and its port is PORT. Stand-ins take the place of what changes a machine: sudo leaves out
# the right and the user, systemctl starts and stops a server of this program with the options of the unit.
set -eu
unset RUGO_TOKEN RUGO_CA_FILE RUGO_FINGERPRINT
page=$1 program=$2 port=$3 here=$PWD
mkdir -p "$here/lib" "$here/backups"
sed -n '/^```sh$/,/^```$/p' "$page" | grep -v '^```' | sed "s|/var/lib/rugo|$here/lib|g; s|/var/backups/rugo|$here/backups|g; \
    s|127.0.0.1:8080|127.0.0.1:$port|g; s|0.0.0.0:8080|0.0.0.0:$port|g; s|/etc/default/rugo|$here/default|g" >commands
[ "$(wc -l <commands)" -ge 25 ] || { echo "the page has too few commands"; exit 1; }

rugo() {
    if [ "$*" = health ]; then set -- health --server "http://127.0.0.1:$port"; fi
    "$program" "$@"
}
sudo() {
    if [ "$1" = -u ]; then shift 2; fi
    "$@"
}
install() { # without the owner
    if [ "$1" = -d ]; then command install -d -m "$7" "$8"; else command install -m "$6" "$7" "$8"; fi
}
make() { [ "$1" = install ]; }
systemd_sysusers() { :; }
journalctl() { cat "$here/server.log"; }
start() {
    options="--listen 127.0.0.1:$port"
    if [ -f "$here/default" ]; then options=$(sed 's/^RUGO_OPTIONS=//' "$here/default"); fi
    : >"$here/serve.out"
    # shellcheck disable=SC2086
    (cd "$here/lib" && exec "$program" serve --db rugo.db $options) >"$here/serve.out" 2>>"$here/server.log" &
    server=$!
    for _ in $(seq 1200); do
        grep -q '^listening' "$here/serve.out" && return 0
        sleep 0.05
    done
    echo "the server does not start"
    return 1
}
stop() { kill "$server"; wait "$server"; server=; }
systemctl() {
    echo "$*" >>"$here/asked"
    case "$*" in
    daemon-reload) ;;
    "enable --now rugo" | "start rugo") start ;;
    "stop rugo") stop ;;
    "restart rugo") stop && start ;;
    "enable --now rugo-snapshot.timer") ;;
    "start rugo-snapshot") rugo snapshot --db "$here/lib/rugo.db" "$here/backups" --keep 7 ;;
    *) echo "systemctl $* is not known"; return 1 ;;
    esac
}
server=
trap 'if [ -n "$server" ]; then kill "$server"; fi' EXIT

# A study between setting up and the rest, so that there is something to work on, to keep and to delete.
sed 's/systemd-sysusers/systemd_sysusers/; /systemctl enable/a\
rugo submit --server http://127.0.0.1:'"$port"' '"$here"'/study.json >submitted' commands >run
. ./run
rugo wait --server "https://127.0.0.1:$port" --ca-file "$here/lib/tls/certificate.pem" \
    --token-file "$here/lib/cluster.token" "$(cat "$here/submitted")"
stop
[ "$(tr '\n' ' ' <"$here/asked")" = "daemon-reload enable --now rugo enable --now rugo-snapshot.timer start rugo-snapshot \
stop rugo start rugo restart rugo restart rugo " ]
# The restored store had the study done, and nothing was so old that it went.
rugo status --db "$here/lib/rugo.db" "$(cat "$here/submitted")" | grep -q done
ls "$here"/backups/rugo-*T*Z.db "$here/backups/before-upgrade.db" "$here"/lib/rugo.db.before-restore-*/rugo.db >/dev/null
[ -z "$(find "$here" -name '*.part-*')" ]
echo "operate: all done"
