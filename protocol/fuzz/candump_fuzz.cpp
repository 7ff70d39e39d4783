// Any text: what is read as a frame must be written and read back as the same frame.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "protocol/can/bit_length.hpp"
#include "protocol/can/candump.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto line = kinebus::parse_candump(text)) {
    if (kinebus::parse_frame(kinebus::to_text(line->frame)) != line->frame) std::abort();
    const auto again = kinebus::parse_candump(kinebus::to_candump(*line));
    if (line->interface.size() <= 16 && (!again || !(again->frame == line->frame))) std::abort();
    const int bits = kinebus::bit_length(line->frame);
    if (bits < 47 || bits > kinebus::max_bit_length(8, true)) std::abort();
  }
  return 0;
}
