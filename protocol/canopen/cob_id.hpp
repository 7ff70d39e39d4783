#pragma once
// COB-IDs of the pre-defined connection set (CiA 301) and of LSS (CiA 305).

#include <cstdint>

namespace kinebus::cob_id {

inline constexpr std::uint32_t kNmt = 0x000, kSync = 0x080, kEmcy = 0x080, kTime = 0x100, kSdoReply = 0x580,
                               kSdoRequest = 0x600, kHeartbeat = 0x700, kLssReply = 0x7E4,
                               kLssRequest = 0x7E5;

/// `number`: 1..4.
constexpr std::uint32_t tpdo(int number, std::uint8_t node) {
  return 0x080u + 0x100u * static_cast<std::uint32_t>(number) + node;
}
constexpr std::uint32_t rpdo(int number, std::uint8_t node) {
  return 0x100u + 0x100u * static_cast<std::uint32_t>(number) + node;
}

/// Identifiers that no PDO, SYNC or EMCY may be moved to (CiA 301, "restricted CAN-IDs").
constexpr bool is_restricted(std::uint32_t id) {
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) ||
         (id >= 0x601 && id <= 0x67F) || (id >= 0x6E0 && id <= 0x6FF) || (id >= 0x701 && id <= 0x7FF);
}

/// The node in an identifier of the pre-defined set, when `id` is within 1..127 of `base`; 0: it is not.
constexpr std::uint8_t node_of(std::uint32_t id, std::uint32_t base) {
  return id > base && id <= base + 127 ? static_cast<std::uint8_t>(id - base) : std::uint8_t{0};
}

}  // namespace kinebus::cob_id
