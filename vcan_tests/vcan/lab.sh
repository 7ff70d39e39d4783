# Shared by the tests of this folder: a vcan interface of its own, the programs under test, and a capture that stays.
# Source it with the folder of the programs as $1; $programs names others than daemon, CLI and virtual node.
set -euo pipefail
work=$(mktemp -d)
# The programs and their libraries run from memory: a page that comes late from the host's disk would halt one node
# for as long as the guest's virtual time likes.
bin=$work/bin
mkdir "$bin" "$work/lib"
for program in ${programs:-kinebusd kinebus kinebus-vnode}; do cp "$1/$program" "$bin/"; done
ldd "$bin"/* | awk '$2 == "=>" && $3 ~ "^/" { print $3 }' | sort -u | xargs -I{} cp {} "$work/lib/"
export LD_LIBRARY_PATH=$work/lib
# What the scripts call, read once before anything moves, for the same reason.
for tool in bash cangen cangw cansend cat cp dd grep ip ls mkdir mount mv rm tail umount wc; do
  path=$(type -P "$tool") && cat "$path" > /dev/null
done
keep=${LAB_KEEP:-$work}
log=$work/kinebusd.log
interface=kbv$(( $$ % 1000 ))
export KINEBUS_SOCKET=$work/kinebus.sock
pids=()
nodes=()  # by node id - 1

finish() {
  local status=$?
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  wait 2>/dev/null || true
  ip link del "$interface" 2>/dev/null || true
  [[ -z ${gateway_interface:-} ]] || ip link del "$gateway_interface" 2>/dev/null || true
  sync_traces
  cp "$work"/*.log "$work"/*.trace "$keep"/ 2>/dev/null || true
  [[ $status == 0 ]] || { echo "--- daemon's log"; tail -n 40 "$work/kinebusd.log"; echo "--- last frames"; tail -n 30 "$work/bus.log"; } 2>/dev/null
  exit "$status"
}
trap finish EXIT

# Nodes that are still there write their traces when they end.
sync_traces() { local pid; for pid in "${nodes[@]}"; do wait "$pid" 2>/dev/null || true; done; }
# wait_ms N: of the test's own choice, such as the moment of a fault; never instead of a condition.
wait_ms() { read -rt "$(( $1 / 1000 )).$(printf %03d $(( $1 % 1000 )))" <> <(:) || true; }
fail() { echo "FAILED: $*"; exit 1; }
# until_true SECONDS WHAT COMMAND...: polls a condition; the time is only the limit.
until_true() {
  local limit=$((SECONDS + $1)) what=$2; shift 2
  until "$@" >/dev/null 2>&1; do
    (( SECONDS < limit )) || fail "no $what in time"
    read -rt 0.05 <> <(:) || true
  done
}

say() { echo "--- $*"; }
ask() { "$bin/kinebus" "$@" > "$work/ask.log" 2>&1 || fail "kinebus $*: $(cat "$work/ask.log")"; }
# logged COUNT WORDS: the daemon's log has them so often.
# What the daemon says when the job moves again; its answer to clear already speaks of going on.
goes_on="the job [^ ]* goes on"
count_of() { grep -c -- "$1" "$log" || true; }
logged() { (( $(count_of "$2") >= $1 )); }
# expect SECONDS WORDS BEFORE: the words come once more than BEFORE times.
expect() { until_true "$1" "\"$2\" in the daemon's log" logged $(( $3 + 1 )) "$2"; }

# What the guest needs for its disk (tools/vm/run --disk), /dev/vda.
insert_disk() {
  local module
  for module in crypto/crc32c_generic fs/jbd2/jbd2 fs/mbcache lib/crc16 fs/ext4/ext4 drivers/block/virtio_blk; do
    insmod "$LAB_MODULES/$module.ko"
  done
}
start_bus() {
  ip link add dev "$interface" type vcan && ip link set "$interface" up
  chrt -f 85 candump -L "$interface${capture_only:-}" > "$work/bus.log" & pids+=($!)
}
# The gateway on an interface of its own, joined to the nodes' by rules that a test may change.
split_bus() {
  gateway_interface=${interface}g
  ip link add dev "$gateway_interface" type vcan && ip link set "$gateway_interface" up
  cangw -A -s "$interface" -d "$gateway_interface" -e
  cangw -A -s "$gateway_interface" -d "$interface" -e
}
start_nodes() {
  local node
  for node in 1 2 3; do
    start_node "$node" "$@"
  done
}
start_node() {
  local node=$1; shift
  "$bin/kinebus-vnode" --interface "$interface" --node "$node" --priority 90 --trace "$work/node$node.trace" "$@" \
    >> "$work/node$node.log" 2>&1 & pids+=($!); nodes[node - 1]=$!
}
start_daemon() {
  "$bin/kinebusd" --bus "${gateway_interface:-$interface}" --jobs "${jobs:-$work/jobs}" "$@" > "$work/kinebusd.log" 2>&1 & pids+=($!); daemon=$!
  until_true 60 "daemon" test -S "$KINEBUS_SOCKET"
}
