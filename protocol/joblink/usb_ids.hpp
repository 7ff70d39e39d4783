#pragma once
// The gateway as a USB device: what its gadget says of itself and what a host looks for.
//
// One configuration, two functions: a vendor interface with two bulk endpoints (the job link, FunctionFS),
// and a CDC-ACM serial port (Marlin's dialect). A host finds the job link by the class triple of the
// interface, never by its number; the ids are those of the Linux Foundation's composite gadget and shared
// with other devices.
//
// A bulk endpoint carries the job link's bytes as a stream: where a transfer ends means nothing to the
// frames. But a receiver that asked for more than came sees a transfer's end only by a short packet: both
// sides send transfers of transfer_bytes(), so that none ends with a full packet, and no zero-length packets
// are needed. After every (re)connection both sides begin their frame decoder anew, and stale bytes of the
// connection before are dropped by the job link's session.

#include <cstddef>
#include <cstdint>

namespace kinebus::usb_ids {

inline constexpr std::uint16_t kVendor = 0x1D6B;   ///< Linux Foundation
inline constexpr std::uint16_t kProduct = 0x0104;  ///< multifunction composite gadget
inline constexpr std::uint16_t kRelease = 0x0100;  ///< bcdDevice, 1.00

// bInterfaceClass, SubClass, Protocol of the job link.
inline constexpr std::uint8_t kLinkClass = 0xFF;  ///< vendor specific
inline constexpr std::uint8_t kLinkSubclass = 0x4B;
inline constexpr std::uint8_t kLinkProtocol = 0x01;  ///< counts incompatible changes of the endpoints' use

// Endpoint descriptors as the gadget asks for them; the controller may renumber them, a host reads them from
// the descriptors: the interface has exactly one bulk OUT and one bulk IN.
inline constexpr std::uint8_t kBulkOutAddress = 0x01;
inline constexpr std::uint8_t kBulkInAddress = 0x82;
inline constexpr std::uint16_t kFullSpeedPacket = 64;
inline constexpr std::uint16_t kHighSpeedPacket = 512;
inline constexpr std::uint16_t kSuperSpeedPacket = 1024;
/// Transfers of this size reach full speed on both sides.
inline constexpr std::size_t kTransferBytes = 65'536;

/// How many of `waiting` bytes (> 0) the next transfer takes.
constexpr std::size_t transfer_bytes(std::size_t waiting) {
  const std::size_t bytes = waiting < kTransferBytes ? waiting : kTransferBytes;
  // Every packet size is a multiple of the smallest.
  return bytes % kFullSpeedPacket == 0 ? bytes - 1 : bytes;
}

inline constexpr const char* kManufacturer = "Kinebus";
inline constexpr const char* kProductName = "Kinebus gateway";
inline constexpr const char* kLinkName = "Kinebus job link";  ///< string of the interface
inline constexpr const char* kConfigurationName = "Job link and serial port";

// Windows binds WinUSB to the interface by itself (Microsoft OS 1.0 descriptors).
inline constexpr const char* kMicrosoftSignature = "MSFT100";
inline constexpr std::uint8_t kMicrosoftVendorCode = 0xCD;
inline constexpr const char* kMicrosoftCompatibleId = "WINUSB";
/// Device interface GUID under which Windows programs find the link.
inline constexpr const char* kMicrosoftInterfaceGuid = "{6B1F2C0E-5A37-4E0B-9C58-4B494E454255}";

}  // namespace kinebus::usb_ids
