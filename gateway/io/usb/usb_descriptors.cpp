#include "gateway/io/usb/usb_descriptors.hpp"

#include <linux/usb/ch9.h>
#include <linux/usb/functionfs.h>

#include <string_view>

#include "protocol/joblink/usb_ids.hpp"

namespace kinebus {
namespace {

using namespace usb_ids;

class Bytes {
 public:
  void u8(unsigned value) { bytes_.push_back(static_cast<std::uint8_t>(value)); }
  void u16(unsigned value) {
    u8(value & 0xFF);
    u8(value >> 8);
  }
  void u32(std::size_t value) {
    u16(static_cast<unsigned>(value & 0xFFFF));
    u16(static_cast<unsigned>(value >> 16 & 0xFFFF));
  }
  /// With a NUL behind it, or filled with NULs up to `width`.
  void text(std::string_view value, std::size_t width) {
    for (std::size_t i = 0; i < width; ++i) u8(i < value.size() ? static_cast<unsigned char>(value[i]) : 0U);
  }
  /// The length of all goes to where a length was left out.
  std::vector<std::uint8_t> finish(std::size_t length_at) {
    for (std::size_t i = 0; i < 4; ++i)
      bytes_[length_at + i] = static_cast<std::uint8_t>(bytes_.size() >> (8 * i));
    return std::move(bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

void interface(Bytes& out) {
  out.u8(USB_DT_INTERFACE_SIZE);
  out.u8(USB_DT_INTERFACE);
  out.u8(0);  // number: the gadget's
  out.u8(0);
  out.u8(2);
  out.u8(kLinkClass);
  out.u8(kLinkSubclass);
  out.u8(kLinkProtocol);
  out.u8(1);  // string
}

void endpoint(Bytes& out, unsigned address, unsigned packet) {
  out.u8(USB_DT_ENDPOINT_SIZE);
  out.u8(USB_DT_ENDPOINT);
  out.u8(address);
  out.u8(USB_ENDPOINT_XFER_BULK);
  out.u16(packet);
  out.u8(0);
}

void companion(Bytes& out) {
  out.u8(USB_DT_SS_EP_COMP_SIZE);
  out.u8(USB_DT_SS_ENDPOINT_COMP);
  out.u8(8);  // packets a burst, less one
  out.u8(0);
  out.u16(0);
}

// Microsoft OS 1.0 descriptors, as the kernel's FunctionFS wants them (version written as 1).
void compatible_id(Bytes& out) {
  constexpr std::size_t kHeader = 11, kFunction = 24;
  out.u8(0);
  out.u32(kHeader + kFunction);
  out.u16(1);
  out.u16(4);  // extended compat id
  out.u8(1);
  out.u8(0);
  out.u8(0);  // first interface
  out.u8(1);
  out.text(kMicrosoftCompatibleId, 8);
  out.text({}, 8);
  out.text({}, 6);
}

void interface_guid(Bytes& out) {
  constexpr std::string_view kName = "DeviceInterfaceGUID";
  const std::string_view guid = kMicrosoftInterfaceGuid;
  const std::size_t property = 14 + kName.size() + 1 + guid.size() + 1;
  constexpr std::size_t kHeader = 11;
  out.u8(0);
  out.u32(kHeader + property);
  out.u16(1);
  out.u16(5);  // extended properties
  out.u16(1);
  out.u32(property);
  out.u32(1);  // text
  out.u16(static_cast<unsigned>(kName.size() + 1));
  out.text(kName, kName.size() + 1);
  out.u32(guid.size() + 1);
  out.text(guid, guid.size() + 1);
}

}  // namespace

std::vector<std::uint8_t> function_descriptors() {
  Bytes out;
  out.u32(FUNCTIONFS_DESCRIPTORS_MAGIC_V2);
  out.u32(0);
  out.u32(FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC | FUNCTIONFS_HAS_SS_DESC |
          FUNCTIONFS_HAS_MS_OS_DESC);
  out.u32(3);
  out.u32(3);
  out.u32(5);
  out.u32(2);
  for (const unsigned packet : {unsigned{kFullSpeedPacket}, unsigned{kHighSpeedPacket}}) {
    interface(out);
    endpoint(out, kBulkOutAddress, packet);
    endpoint(out, kBulkInAddress, packet);
  }
  interface(out);
  endpoint(out, kBulkOutAddress, kSuperSpeedPacket);
  companion(out);
  endpoint(out, kBulkInAddress, kSuperSpeedPacket);
  companion(out);
  compatible_id(out);
  interface_guid(out);
  return out.finish(4);
}

std::vector<std::uint8_t> function_strings() {
  Bytes out;
  const std::string_view name = kLinkName;
  out.u32(FUNCTIONFS_STRINGS_MAGIC);
  out.u32(0);
  out.u32(1);
  out.u32(1);
  out.u16(0x0409);
  out.text(name, name.size() + 1);
  return out.finish(4);
}

}  // namespace kinebus
