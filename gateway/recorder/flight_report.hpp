#pragma once
// A flight recorder's memory as files: a candump log of the frames, and one JSON with everything else.

#include <string>
#include <string_view>

#include "gateway/recorder/flight_ring.hpp"

namespace kinebus {

/// The last 60 s of frames, as `candump -l` writes them.
std::string flight_log(const FlightRing& ring, std::string_view interface);

/// Samples, events and what the nodes' EMCYs said, with times in s before the newest row (negative).
/// `cause`: why it is written, in words. `log_name`: of the candump log beside it.
std::string flight_json(const FlightRing& ring, std::string_view cause, std::string_view log_name);

}  // namespace kinebus
