// Any text: refused with messages, or a machine that reads back from what is written of it.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gateway/description/machine_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  const auto machine = parse_machine({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  if (!machine) {
    if (machine.error().empty() || to_string(machine.error()).empty()) std::abort();
    return 0;
  }
  const auto again = parse_machine(write_machine(*machine), "written.toml");
  if (!again || !(*again == *machine)) std::abort();
  return 0;
}
