# Shared by the USB tests: a guest's kernel is device and host (dummy_hcd). Source it with
#   BIN FOLDER SOURCE PROGRAM...      the test's own programs, run from memory like the others
source "$(dirname "${BASH_SOURCE[0]}")/../vcan/lab.sh" "$1"
folder=$2; gadget=$3/gateway/io/package/kinebus-usb-gadget
for program in "${@:4}"; do
  cp "$1/$program" "$bin/"
  ldd "$bin/$program" | awk '$2 == "=>" && $3 ~ "^/" { print $3 }' | sort -u | xargs -I{} cp -n {} "$work/lib/"
done
export KINEBUS_FFS=$work/ffs KINEBUS_USER=root KINEBUS_USB_SERIAL=LAB1
mkdir -p /sys/kernel/config; mount -t configfs none /sys/kernel/config 2>/dev/null || true
udc=$(ls /sys/class/udc | head -n 1); [[ -n $udc ]] || fail "no USB device controller: dummy_hcd is not loaded"
udc_file=/sys/kernel/config/usb_gadget/kinebus/UDC
lab() { "$bin/kinebus-usb-lab" --udc-file "$udc_file" --udc "$udc" --seed "${KINEBUS_SEED:-1}" "$@"; }
