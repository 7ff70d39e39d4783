#pragma once
// The file that tells an agent which gateways it serves.

#include <string>
#include <string_view>
#include <vector>

#include "gateway/fleet/job.hpp"
#include "gateway/result.hpp"
#include "tools/cli/client.hpp"

namespace kinebus::fleet {

struct ServedGateway {
  Machine machine{};
  Reach reach{};
};

/// Of a machine, a group or a node: it is part of a topic of MQTT, and of Home Assistant's ids.
bool is_name(std::string_view name);
inline constexpr const char* kNameRule = "letters without accents, digits, - and _ alone";

/// [[gateway]] tables: name; socket, or tcp with fingerprint and token_file; kind, material, nozzle_mm.
/// Error: place and rule, in words.
kinebus::Result<std::vector<ServedGateway>, std::string> read_gateways(std::string_view toml);

}  // namespace kinebus::fleet
