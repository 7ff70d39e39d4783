#include "tools/cli/gcode_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "gateway/gcode/words/codes.hpp"

namespace kinebus {

void add_gcode_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("gcode", "Print what a G-code means here, or all of them");
  auto code = std::make_shared<std::string>();
  command->add_option("code", *code, "G81, M104, SET_VELOCITY_LIMIT, while, _x ...");
  command->callback([=, &exit_code] {
    if (code->empty()) return fmt::print("{}", gcode::reference());
    const std::string entry = gcode::reference_entry(*code);
    if (entry.empty()) {
      fmt::print(stderr, "kinebus: {} is unknown\n", *code);
      exit_code = 1;
      return;
    }
    fmt::print("{}\n", entry);
  });
}

}  // namespace kinebus
