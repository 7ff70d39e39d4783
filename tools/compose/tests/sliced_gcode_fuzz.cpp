// Any text as a piece's G-code: moves or a clear refusal, and every move's numbers are finite.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "tools/compose/sliced_gcode.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus::compose;
  try {
    const SlicedGcode read = read_sliced({reinterpret_cast<const char*>(data), size}, "fuzz.gcode");
    for (const SlicedItem& item : read.items)
      if (const auto* move = std::get_if<SlicedMove>(&item))
        if (move->to_mm[0] && !std::isfinite(*move->to_mm[0])) std::abort();
  } catch (const std::runtime_error& error) {
    if (std::string_view(error.what()).substr(0, 11) != "fuzz.gcode:") std::abort();
  }
  return 0;
}
