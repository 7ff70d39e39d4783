# The guest's end of the Octopus' USB cable (one_cable_board), shared by the tests of it. Source it after lab.sh, of whose
# programs kinebus-usb-port must be one.
[[ -n ${LAB_PORT:-} ]] || fail "the emulated board is missing: tools/vm/run --beside 'vcan_tests/vcan/one_cable_board BIN'"
bus=can0
plug=$work/plugged  # the cable is in the board's connector while this file exists
for module in usb/usbip/usbip-core usb/usbip/vhci-hcd net/can/usb/gs_usb; do
  insmod "$LAB_MODULES/drivers/$module.ko" || { echo "SKIPPED: this guest's kernel has no $module"; exit 77; }
done
chrt -f 95 "$bin/kinebus-usb-port" "$LAB_PORT" "$plug" > "$work/usb-port.log" 2>&1 & pids+=($!)

is_there() { [[ -e /sys/class/net/$bus ]]; }
is_gone() { ! is_there; }
plug_in() { touch "$plug"; until_true 120 "$bus of gs_usb" is_there; }
pull() { rm "$plug"; until_true 20 "end of $bus" is_gone; }
# As kinebusd advises; restart-ms is refused by Linux, and the boards need none.
up() { ip link set "$bus" up type can bitrate "$1"; }
