#pragma once
// Journal records as bytes, one after the other. A file that was cut, or whose end was never written, is read
// up to its last whole record: what comes out is always what was noted, only perhaps a little earlier.
//
//   record: 0x4B, kind (1), length of the payload (2), number (4), payload, CRC-32 of all before (4);
//   little-endian

#include <cstdint>
#include <span>
#include <vector>

#include "gateway/jobs/journal/journal_state.hpp"

namespace kinebus::journal {

/// Longest record: a job's name is cut to 1000 bytes.
inline constexpr std::size_t kMaxRecordBytes = 2800;

/// Appends `record`, with `number` (counted from 0 in each file).
void encode(const Record& record, std::uint32_t number, std::vector<std::uint8_t>& out);

struct Decoded {
  State state;
  std::uint32_t records = 0;  ///< whole ones
  std::size_t bytes = 0;      ///< that they take; what comes behind is a torn end, or nothing
};
/// Reads up to the first byte that is not part of a whole record with the next number.
Decoded decode(std::span<const std::uint8_t> bytes);

/// FNV-1a, 64 bits, continued from `hash`.
inline constexpr std::uint64_t kHashStart = 0xCBF2'9CE4'8422'2325u;
constexpr std::uint64_t fnv1a64(std::span<const char> bytes, std::uint64_t hash = kHashStart) {
  for (const char c : bytes) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x0000'0100'0000'01B3u;
  return hash;
}

}  // namespace kinebus::journal
