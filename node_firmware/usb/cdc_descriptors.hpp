#pragma once
// What the node says of itself on USB: one serial port (CDC ACM) at full speed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "node_firmware/usb/usb_control.hpp"

namespace kinebus::cdc {

using namespace usb;

inline constexpr std::size_t kNotificationBytes = 16;

// Endpoint addresses, as the descriptors and requests name them.
inline constexpr std::uint8_t kDataOut = 0x01, kDataIn = 0x81, kNotifyIn = 0x82;

// STMicroelectronics' ids of a serial port made with one of its processors, as the chip's own DFU has
// 0483:df11.
inline constexpr std::uint16_t kVendor = 0x0483, kProduct = 0x5740;
inline constexpr std::string_view kManufacturerName = "Kinebus", kProductName = "Kinebus node";

// clang-format off
inline constexpr std::array<std::uint8_t, 18> kDeviceDescriptor{
    18, kDevice, 0x00, 0x02,  // USB 2.0
    0x02, 0, 0,               // communication
    kPacketBytes,             // of endpoint 0
    kVendor & 0xFF, kVendor >> 8, kProduct & 0xFF, kProduct >> 8,
    0x00, 0x01,               // release 1.00
    kManufacturerString, kProductString, kSerialString,
    1};                       // configuration

inline constexpr std::array<std::uint8_t, 67> kConfigurationDescriptor{
    9, kConfiguration, 67, 0, 2, 1, 0,
    0xC0, 0,                           // self-powered: nothing is drawn from the cable
    // Control: abstract control model; no AT commands, so that no modem program takes it for one.
    9, kInterface, 0, 0, 1, 0x02, 0x02, 0x00, 0,
    5, kFunctional, 0x00, 0x10, 0x01,  // CDC 1.10
    5, kFunctional, 0x01, 0x00, 1,     // no call management
    4, kFunctional, 0x02, 0x02,        // line coding and line state
    5, kFunctional, 0x06, 0, 1,        // interface 0 controls interface 1
    7, kEndpoint, kNotifyIn, 3, kNotificationBytes, 0, 16,
    // Data.
    9, kInterface, 1, 0, 2, 0x0A, 0, 0, 0,
    7, kEndpoint, kDataOut, 2, kPacketBytes, 0, 0,
    7, kEndpoint, kDataIn, 2, kPacketBytes, 0, 0};
// clang-format on

/// 115200 8N1: means nothing on this line, and is kept for who asks.
inline constexpr std::array<std::uint8_t, 7> kDefaultLineCoding{0x00, 0xC2, 0x01, 0, 0, 0, 8};

/// SERIAL_STATE: carrier and data set are there.
inline constexpr std::array<std::uint8_t, 10> kSerialState{0xA1, 0x20, 0, 0, 0, 0, 2, 0, 3, 0};

inline constexpr std::array<std::uint8_t, 3> kEndpoints{kDataOut, kDataIn, kNotifyIn};
inline constexpr Facts kFacts{.device = kDeviceDescriptor,
                              .configuration = kConfigurationDescriptor,
                              .manufacturer = kManufacturerName,
                              .product = kProductName,
                              .interfaces = 2,
                              .endpoints = kEndpoints};

// A reply that ends with a full packet, and is shorter than asked for, would need an empty one after it.
static_assert(kDeviceDescriptor.size() % kPacketBytes != 0 &&
              kConfigurationDescriptor.size() % kPacketBytes != 0);

}  // namespace kinebus::cdc
