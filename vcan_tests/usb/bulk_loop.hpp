#pragma once
// A bare bulk loop, for comparison: nothing but transfers, the device throws the bytes away.

#include <cstddef>
#include <string>

namespace kinebus {

/// The device's side, on a FunctionFS folder: takes bytes until the gadget goes. 0: done.
int bulk_sink(const std::string& folder);
/// The host's side: `mib` MiB in transfers as the job link's; prints the speed.
int bulk_loop(std::size_t mib);

}  // namespace kinebus
