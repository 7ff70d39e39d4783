#include "gateway/description/default_machine_file.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "gateway/description/commented_file.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/shipped_machines.hpp"

namespace kinebus {

std::string default_machine_file() {
  const auto all = shipped_machines();
  const auto m1 =
      std::find_if(all.begin(), all.end(), [](const ShippedMachine& m) { return m.name == "m1"; });
  if (m1 == all.end()) throw std::logic_error("no shipped machine m1");
  const std::array<std::string_view, 2> examples{m1->text, key_remarks()};
  return with_comments(
      write_machine(default_m1()), examples,
      {.header =
           "# The default machine: M1, a printer with a four-leg parallel mechanism (x, y, z and tilt A) and "
           "a\n"
           "# rotary table C on its platform. Make geometry, limits and connections this machine's.\n"
           "#\n"
           "# Lengths are mm, angles deg, times as the key says. A key that is unknown, missing or out of "
           "range is refused\n"
           "# with its line and the allowed range. What may be left out has a default or means \"no "
           "limit\".\n\n",
       .tables = {}});
}

}  // namespace kinebus
