#pragma once
// What a board is, as it says of itself: written once when it is first put to use, in memory that no program
// and no update changes. Records are appended, each in a slot of 32 bytes that is programmed once; the last
// whole one counts.
//
// In words: kMagic | hardware | revision | serial number | three times FFFF FFFFh | CRC-32 of those before

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus {

struct BoardRecord {
  static constexpr std::size_t kSlot = 32, kWords = kSlot / 4;
  using Words = std::array<std::uint32_t, kWords>;

  std::uint32_t hardware = 0;  ///< as BoardFacts has it: chip and pin map
  std::uint32_t revision = 0;  ///< tenths: 11 is v1.1
  std::uint32_t serial = 0;    ///< 1018h:4 of the board's first node
};

namespace board_record {

inline constexpr std::uint32_t kMagic = 0x5242'424B;  // "KBBR"
inline constexpr std::uint32_t kBlank = 0xFFFF'FFFF;

constexpr BoardRecord::Words encode(const BoardRecord& record) {
  BoardRecord::Words words{kMagic, record.hardware, record.revision, record.serial, kBlank, kBlank, kBlank};
  std::array<std::uint8_t, BoardRecord::kSlot - 4> bytes{};
  for (std::size_t i = 0; i + 1 < words.size(); ++i) put_u32_le(std::span(bytes).subspan(4 * i), words[i]);
  Crc32 crc;
  crc.add(bytes);
  words.back() = crc.value();
  return words;
}
/// `memory`: whole slots. nullopt: the board says nothing.
constexpr std::optional<BoardRecord> find(std::span<const std::uint8_t> memory) {
  std::optional<BoardRecord> found;
  for (; memory.size() >= BoardRecord::kSlot; memory = memory.subspan(BoardRecord::kSlot)) {
    const auto word = [&](std::size_t i) { return get_u32_le(memory.subspan(4 * i)); };
    if (word(0) != kMagic) continue;
    const BoardRecord record{word(1), word(2), word(3)};
    if (encode(record).back() == word(BoardRecord::kWords - 1)) found = record;
  }
  return found;
}
/// The first slot in which nothing was ever written; nullopt: none is left.
constexpr std::optional<std::size_t> free_slot(std::span<const std::uint8_t> memory) {
  for (std::size_t at = 0; at + BoardRecord::kSlot <= memory.size(); at += BoardRecord::kSlot) {
    bool blank = true;
    for (const std::uint8_t byte : memory.subspan(at, BoardRecord::kSlot)) blank = blank && byte == 0xFF;
    if (blank) return at;
  }
  return std::nullopt;
}
/// A program for `hardware` may drive the board: it says nothing, or just that.
constexpr bool is_own(std::span<const std::uint8_t> memory, std::uint32_t hardware) {
  const auto record = find(memory);
  return !record || record->hardware == hardware;
}

}  // namespace board_record
}  // namespace kinebus
