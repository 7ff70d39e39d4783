#pragma once
// A dissector in Lua for Wireshark and tshark: every frame of every board, by the object tables, the records'
// fields, and the words that alarms, states and abort codes have elsewhere in Kinebus.

#include <string>

namespace kinebus {

/// One file for Wireshark's folder of Lua plugins. The same text for the same tables.
std::string wireshark_text();

}  // namespace kinebus
