#include "protocol/can/bit_length.hpp"

#include <algorithm>
#include <utility>

namespace kinebus {
namespace {

constexpr unsigned kCrcPolynomial = 0x4599;  // CRC-15-CAN

constexpr std::size_t kMostBytes = 5 + 8;  // of header and data

/// [bytes behind it][byte]: what a byte leaves in the CRC.
constexpr auto kCrcTable = [] {
  std::array<std::array<std::uint16_t, 256>, kMostBytes> table{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    unsigned crc = static_cast<unsigned>(byte) << 7;
    for (std::size_t behind = 0; behind < kMostBytes; ++behind) {
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x4000u) != 0 ? (crc << 1) ^ kCrcPolynomial : crc << 1;
      crc &= 0x7FFFu;
      table[behind][byte] = static_cast<std::uint16_t>(crc);
    }
  }
  return table;
}();

// State of the stuffer: level of the last bit, and how many in a row had it (1..4; a fifth brings the stuff
// bit, and with it a run of one): level * 4 + run - 1.
// A byte's word has a byte for each state before it: state behind it * 8 (six bits), which is how far the
// next byte's word is to be shifted, and above that how many stuff bits it brings (at most 2).
constexpr unsigned kStates = 8, kShiftMask = 0x3F, kStuffedMask = 0xC0, kStuffedShift = 6;
constexpr auto kStuffTable = [] {
  std::array<std::uint64_t, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    for (unsigned state = 0; state < kStates; ++state) {
      unsigned level = state / 4, run = state % 4 + 1, stuffed = 0;
      for (int bit = 7; bit >= 0; --bit) {
        const unsigned next = (byte >> bit) & 1u;
        run = next == level ? run + 1 : 1;
        level = next;
        if (run == 5) {
          ++stuffed;
          level ^= 1u;
          run = 1;
        }
      }
      const std::uint64_t step = (level * 4 + run - 1) * 8 | stuffed << kStuffedShift;
      table[byte] |= step << (8 * state);
    }
  }
  return table;
}();

// What the bytes of header and data leave in the CRC and in the stuffer.
struct Passed {
  unsigned crc = 0;
  std::uint64_t step = 0;  ///< its low byte counts
  unsigned stuffed = 0;    ///< stuff bits, shifted

  void stuff(unsigned byte) {
    step = kStuffTable[byte & 0xFFu] >> (step & kShiftMask);
    stuffed += static_cast<unsigned>(step) & kStuffedMask;
  }
};

/// `first`: the first byte as the stuffer sees it.
inline Passed pass(const std::uint8_t* bytes, std::size_t count, unsigned first) {
  Passed passed;
  passed.crc = kCrcTable[count - 1][bytes[0]];
  passed.stuff(first);
  for (std::size_t i = 1; i < count; ++i) {
    passed.crc ^= kCrcTable[count - 1 - i][bytes[i]];
    passed.stuff(bytes[i]);
  }
  return passed;
}

/// The same of a number of bytes that is known beforehand, without a loop.
template <std::size_t... kRest>
Passed pass(const std::uint8_t* bytes, unsigned first, std::index_sequence<kRest...>) {
  constexpr std::size_t kCount = sizeof...(kRest) + 1;
  Passed passed;
  passed.crc = (kCrcTable[kCount - 1][bytes[0]] ^ ... ^ kCrcTable[kCount - 2 - kRest][bytes[kRest + 1]]);
  passed.stuff(first);
  (passed.stuff(bytes[kRest + 1]), ...);
  return passed;
}

}  // namespace

int bit_length(const CanFrame& frame) {
  // Start of frame to DLC. The bits in front are zeros to the CRC and 1,0,1,.. to the stuffer: neither counts
  // them.
  const unsigned dlc = frame.length & 0xFu;
  const unsigned remote = frame.remote ? 1u : 0u;
  const std::uint64_t header =
      frame.extended
          ? (static_cast<std::uint64_t>((frame.id >> 18) & 0x7FFu) << 27) | (std::uint64_t{3} << 25) |
                (static_cast<std::uint64_t>(frame.id & 0x3FFFFu) << 7) | (remote << 6) | dlc
          : (static_cast<std::uint64_t>(frame.id & 0x7FFu) << 7) | (remote << 6) | dlc;
  const int header_bits = frame.extended ? 39 : 19;
  const int header_bytes = frame.extended ? 5 : 3;
  const unsigned data_bytes = frame.remote ? 0u : (frame.length < 8u ? frame.length : 8u);

  std::array<std::uint8_t, kMostBytes> bytes{};
  for (int i = 0; i < header_bytes; ++i)
    bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(header >> (8 * (header_bytes - 1 - i)));
  std::copy_n(frame.data.begin(), data_bytes, bytes.begin() + header_bytes);
  // The first byte holds the header's 3 (7 if extended) odd bits behind a padding that ends recessive.
  const unsigned first = (frame.extended ? 0x80u : 0xA8u) | bytes[0];
  constexpr std::size_t kUsual = 3 + 8;
  const std::size_t count = static_cast<std::size_t>(header_bytes) + data_bytes;
  Passed passed = count == kUsual ? pass(bytes.data(), first, std::make_index_sequence<kUsual - 1>{})
                                  : pass(bytes.data(), count, first);
  // The CRC, and one bit to fill the byte: unlike the last, so that it completes no run.
  passed.stuff(passed.crc >> 7);
  passed.stuff((passed.crc << 1) | ((passed.crc & 1u) ^ 1u));
  const int stuffed = static_cast<int>(passed.stuffed >> kStuffedShift);
  return header_bits + static_cast<int>(8 * data_bytes) + 15 + stuffed + 13;
}

}  // namespace kinebus
