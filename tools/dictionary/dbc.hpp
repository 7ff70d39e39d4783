#pragma once
// The bus of a machine (gateway and nodes 1 to 3 of one board) as a DBC file, for any CAN viewer: PDOs as the
// board's object table maps them by default, the gateway's broadcasts, EMCY, NMT, heartbeat, SYNC and SDO.

#include <string>

#include "protocol/canopen/boards/all.hpp"

namespace kinebus {

inline constexpr int kDbcNodes = 3;

std::string dbc_text(const BoardDescription& board);

}  // namespace kinebus
