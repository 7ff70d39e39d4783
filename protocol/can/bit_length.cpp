#include "protocol/can/bit_length.hpp"

namespace kinebus {
namespace {

constexpr unsigned kCrcPolynomial = 0x4599;  // CRC-15-CAN

constexpr auto kCrcTable = [] {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned crc = byte << 7;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x4000u) != 0 ? (crc << 1) ^ kCrcPolynomial : crc << 1;
    table[byte] = static_cast<std::uint16_t>(crc & 0x7FFFu);
  }
  return table;
}();

// State of the stuffer: level of the last bit, and how many in a row had it (1..4; a fifth brings the stuff
// bit, and with it a run of one): level * 4 + run - 1.
constexpr int kStates = 8;
struct Step {
  std::uint8_t state = 0;
  std::uint8_t stuffed = 0;
};
constexpr auto kStuffTable = [] {
  std::array<std::array<Step, 256>, kStates> table{};
  for (unsigned state = 0; state < kStates; ++state) {
    for (unsigned byte = 0; byte < 256; ++byte) {
      unsigned level = state / 4, run = state % 4 + 1;
      Step step;
      for (int bit = 7; bit >= 0; --bit) {
        const unsigned next = (byte >> bit) & 1u;
        run = next == level ? run + 1 : 1;
        level = next;
        if (run == 5) {
          ++step.stuffed;
          level ^= 1u;
          run = 1;
        }
      }
      step.state = static_cast<std::uint8_t>(level * 4 + run - 1);
      table[state][byte] = step;
    }
  }
  return table;
}();

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

  unsigned crc = 0;
  const auto crc_add = [&](unsigned byte) {
    crc = ((crc << 8) & 0x7FFFu) ^ kCrcTable[((crc >> 7) ^ byte) & 0xFFu];
  };
  for (int i = header_bytes - 1; i >= 0; --i) crc_add(static_cast<unsigned>(header >> (8 * i)) & 0xFFu);
  for (unsigned i = 0; i < data_bytes; ++i) crc_add(frame.data[i]);

  unsigned state = 0;
  int stuffed = 0;
  const auto stuff = [&](unsigned byte) {
    const Step step = kStuffTable[state][byte & 0xFFu];
    state = step.state;
    stuffed += step.stuffed;
  };
  // The first byte holds the header's 3 (7 if extended) odd bits behind a padding that ends recessive.
  const int odd = header_bits % 8;
  const unsigned padding = frame.extended ? 0x80u : 0xA8u;
  stuff(padding | static_cast<unsigned>(header >> (header_bits - odd)));
  for (int i = header_bytes - 2; i >= 0; --i) stuff(static_cast<unsigned>(header >> (8 * i)));
  for (unsigned i = 0; i < data_bytes; ++i) stuff(frame.data[i]);
  // The CRC, and one bit to fill the byte: unlike the last, so that it completes no run.
  stuff(crc >> 7);
  stuff((crc << 1) | ((crc & 1u) ^ 1u));
  return header_bits + static_cast<int>(8 * data_bytes) + 15 + stuffed + 13;
}

}  // namespace kinebus
