#pragma once
// The bus of a default machine (gateway and nodes 1 to 3) as a DBC file, for any CAN viewer: PDOs as the
// object table maps them by default, the gateway's broadcasts, EMCY, NMT, heartbeat, SYNC and SDO.

#include <string>

namespace kinebus {

inline constexpr int kDbcNodes = 3;

std::string dbc_text();

}  // namespace kinebus
