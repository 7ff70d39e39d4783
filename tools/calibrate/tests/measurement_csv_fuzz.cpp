// Any text as a measurement file: an answer, never a crash.

#include <cstddef>
#include <cstdint>

#include "tools/calibrate/readings.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const kinebus::MachineDescription machine = kinebus::default_m1();
  const auto csv = kinebus::Csv::parse({reinterpret_cast<const char*>(data), size});
  if (!csv) return 0;
  static_cast<void>(kinebus::rail_samples(*csv, machine));
  static_cast<void>(kinebus::geometry_readings(*csv));
  return 0;
}
