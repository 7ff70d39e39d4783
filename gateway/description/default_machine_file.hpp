#pragma once
// The machine file that kinebusd begins with where there is none.

#include <string>

namespace kinebus {

/// The default machine with a comment at each key's first place. Post-condition: parse_machine() of it gives
/// default_m1().
std::string default_machine_file();

}  // namespace kinebus
