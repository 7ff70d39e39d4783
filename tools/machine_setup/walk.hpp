#pragma once
// The whole set-up, from boards as they come to a machine file that was tested motor by motor.

#include <filesystem>
#include <string>

#include "tools/machine_setup/setup_state.hpp"

namespace kinebus {

struct WalkOptions {
  std::filesystem::path file = "machine.toml";
  std::string interface = "can0";
  bool anew = false;  ///< forgets the answers of an earlier, interrupted one
};

/// Process exit status: 0 finished, 1 something is wrong, which was said; 130 interrupted, to be gone on
/// with.
int walk(SetupHost& host, const WalkOptions& options);

}  // namespace kinebus
