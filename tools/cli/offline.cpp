#include "tools/cli/offline.hpp"

#include <fstream>
#include <stdexcept>

#include "gateway/description/shipped_machines.hpp"

namespace kinebus {

MachineDescription read_machine(const std::string& path) {
  if (path.empty()) return default_m1();
  auto machine = machine_of(path);
  if (!machine) throw std::runtime_error(machine.error());
  return *machine;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace kinebus
