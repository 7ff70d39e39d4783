#pragma once
// gs_usb: what Linux's driver of that name (drivers/net/can/usb/gs_usb.c) says to a USB device that is a CAN
// controller, and hears from it. All words are little-endian. The ids 1d50:606f are the protocol's own, made
// for such devices (OpenMoko's list): the kernel binds by them to interface 0, and finds the endpoints by
// their numbers, 1 in and 2 out.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "node_firmware/usb/usb_control.hpp"

namespace kinebus::gs_usb {

/// bRequest of vendor requests to the interface; wValue is the channel.
enum class Breq : std::uint8_t {
  kHostFormat = 0,
  kBitTiming = 1,
  kMode = 2,
  kBtConst = 4,
  kDeviceConfig = 5,
  kTimestamp = 6,
  kGetState = 14,
};
inline constexpr std::uint16_t kToDevice = 0x4100, kToHost = 0xC100;  // usb::Request::what, without bRequest

inline constexpr std::uint32_t kByteOrder = 0xBEEF;  // of the words, as the host says first
inline constexpr std::uint32_t kModeReset = 0, kModeStart = 1;
inline constexpr std::uint32_t kTimestamps = 1u << 4, kState = 1u << 13;  // features; flags of kModeStart
/// Never the id of an echo: a frame that the host has not sent.
inline constexpr std::uint32_t kNoEcho = 0xFFFF'FFFF;
/// Frames were lost before this one.
inline constexpr std::uint8_t kOverflow = 1;
// can_id, as in linux/can.h.
inline constexpr std::uint32_t kExtended = 1u << 31, kRemote = 1u << 30, kError = 1u << 29;
// Error classes of linux/can/error.h, and bits of the error frame's byte 1 for the controller's state.
inline constexpr std::uint32_t kErrorController = 0x004, kErrorNoAck = 0x020, kErrorBusOff = 0x040,
                               kErrorRestarted = 0x100, kErrorCounters = 0x200;
inline constexpr std::uint8_t kNowWarning = 0x0C, kNowPassive = 0x30, kNowActive = 0x40;

/// From the host: echo id, can_id, length, channel, flags, 0, 8 bytes of data.
inline constexpr std::size_t kHostFrameBytes = 20;
/// To the host: the same and a time stamp in microseconds, when that was asked for.
inline constexpr std::size_t kDeviceFrameBytes = 24;
/// The host waits for the echoes of so many frames at most.
inline constexpr std::size_t kMostEchoes = 10;

inline constexpr std::uint8_t kDataIn = 0x81, kDataOut = 0x02;
inline constexpr std::uint16_t kVendor = 0x1D50, kProduct = 0x606F;

// clang-format off
inline constexpr std::array<std::uint8_t, 18> kDeviceDescriptor{
    18, usb::kDevice, 0x00, 0x02,  // USB 2.0
    0, 0, 0,                       // each interface says what it is
    usb::kPacketBytes,             // of endpoint 0
    kVendor & 0xFF, kVendor >> 8, kProduct & 0xFF, kProduct >> 8,
    0x00, 0x01,                    // release 1.00
    usb::kManufacturerString, usb::kProductString, usb::kSerialString,
    1};                            // configuration

inline constexpr std::array<std::uint8_t, 32> kConfigurationDescriptor{
    9, usb::kConfiguration, 32, 0, 1, 1, 0,
    0xC0, 0,                       // self-powered: nothing is drawn from the cable
    9, usb::kInterface, 0, 0, 2, 0xFF, 0xFF, 0xFF, 0,
    7, usb::kEndpoint, kDataIn, 2, usb::kPacketBytes, 0, 0,
    7, usb::kEndpoint, kDataOut, 2, usb::kPacketBytes, 0, 0};
// clang-format on
inline constexpr std::array<std::uint8_t, 2> kEndpoints{kDataOut, kDataIn};
inline constexpr usb::Facts kFacts{.device = kDeviceDescriptor,
                                   .configuration = kConfigurationDescriptor,
                                   .manufacturer = "Kinebus",
                                   .product = "Kinebus board on CAN",
                                   .interfaces = 1,
                                   .endpoints = kEndpoints};

}  // namespace kinebus::gs_usb
