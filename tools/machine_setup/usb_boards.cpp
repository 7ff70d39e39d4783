#include "tools/machine_setup/usb_boards.hpp"

#ifdef KINEBUS_HAS_LIBUSB
#include <libusb.h>
#endif

#include <algorithm>
#include <array>
#include <memory>

namespace kinebus {
namespace {

struct UsbNumbers {
  std::uint16_t vendor, product;
};
/// As Linux's gs_usb driver lists them.
constexpr std::array kGsUsb{UsbNumbers{0x1D50, 0x606F}, UsbNumbers{0x1209, 0x2323},
                            UsbNumbers{0x1CD2, 0x606F}, UsbNumbers{0x16D0, 0x10B8},
                            UsbNumbers{0x16D0, 0x0F30}, UsbNumbers{0x1209, 0xCA01}};
constexpr UsbNumbers kStDfu{0x0483, 0xDF11}, kStSerial{0x0483, 0x5740}, kKlipperSerial{0x1D50, 0x614E};

#ifdef KINEBUS_HAS_LIBUSB
std::string text_of(libusb_device_handle* device, std::uint8_t index) {
  std::array<unsigned char, 128> text{};
  const int length =
      index == 0 ? 0 : libusb_get_string_descriptor_ascii(device, index, text.data(), int{text.size()});
  return length > 0 ? std::string(text.begin(), text.begin() + length) : std::string();
}

UsbBoard board_of(libusb_device* device) {
  libusb_device_descriptor about{};
  if (libusb_get_device_descriptor(device, &about) != LIBUSB_SUCCESS) return {};
  UsbBoard board{.vendor = about.idVendor,
                 .product = about.idProduct,
                 .bus = libusb_get_bus_number(device),
                 .address = libusb_get_device_address(device)};
  if (libusb_device_handle* open = nullptr; libusb_open(device, &open) == LIBUSB_SUCCESS) {
    board.name = text_of(open, about.iProduct);
    board.serial = text_of(open, about.iSerialNumber);
    libusb_close(open);
  }
  board.kind = usb_kind(board.vendor, board.product, board.name);
  return board;
}
#endif

}  // namespace

const char* words_of(UsbKind kind) {
  static constexpr std::array kWords{"other", "CAN adapter (gs_usb)", "boot loader of an STM32 (DFU)",
                                     "console of a node", "board with Klipper's program"};
  return kWords[static_cast<std::size_t>(kind)];
}

UsbKind usb_kind(std::uint16_t vendor, std::uint16_t product, std::string_view name) {
  const auto is = [&](UsbNumbers n) { return n.vendor == vendor && n.product == product; };
  if (std::any_of(kGsUsb.begin(), kGsUsb.end(), is)) return UsbKind::kCanAdapter;
  if (is(kStDfu)) return UsbKind::kBootLoader;
  if (is(kStSerial) && name.find("Kinebus") != std::string_view::npos) return UsbKind::kNodeConsole;
  if (is(kKlipperSerial)) return UsbKind::kKlipper;
  return UsbKind::kOther;
}

std::string usb_advice(const UsbBoard& board) {
  switch (board.kind) {
    case UsbKind::kBootLoader:
      return "waits for a program: kinebus-flash --dfu IMAGE (for the F405 card; the other boards: their "
             "page "
             "says how)";
    case UsbKind::kKlipper:
      return "is no Kinebus board before it has its program: the board's page says how it gets in";
    default:
      return {};
  }
}

UsbBoards find_usb_boards() {
#ifdef KINEBUS_HAS_LIBUSB
  libusb_context* context = nullptr;
  if (const int error = libusb_init(&context); error != LIBUSB_SUCCESS)
    return {{}, std::string("USB cannot be asked: ") + libusb_strerror(static_cast<libusb_error>(error))};
  const std::unique_ptr<libusb_context, decltype(&libusb_exit)> ends(context, &libusb_exit);
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  if (count < 0)
    return {{}, std::string("USB cannot be asked: ") + libusb_strerror(static_cast<libusb_error>(count))};
  UsbBoards found;
  for (ssize_t i = 0; i < count; ++i)
    if (UsbBoard board = board_of(list[i]); board.kind != UsbKind::kOther)
      found.boards.push_back(std::move(board));
  libusb_free_device_list(list, 1);
  return found;
#else
  return {{}, "this program was built without libusb: lsusb lists what is on USB"};
#endif
}

}  // namespace kinebus
