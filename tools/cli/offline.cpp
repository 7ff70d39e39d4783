#include "tools/cli/offline.hpp"

#include <fstream>
#include <stdexcept>

namespace kinebus {

MachineDescription read_machine(const std::string& path) {
  if (path.empty()) return default_m1();
  auto machine = load_machine(path);
  if (!machine) throw std::runtime_error(to_string(machine.error()));
  return *machine;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace kinebus
