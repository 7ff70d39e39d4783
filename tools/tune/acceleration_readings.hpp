#pragma once
// What an accelerometer on the tool has recorded.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/result.hpp"

namespace kinebus {

/// At even times. Where they come from: a file, or the simulated accelerometer; boards of the tool that
/// record by themselves would fill the same.
struct AccelerationReadings {
  double period_s = 0;
  std::vector<std::array<double, 3>> mm_per_s2;  ///< X Y Z, gravity and all
};

/// Lines of "time_s,x,y,z" with mm/s^2, as Klipper's ACCELEROMETER_MEASURE writes them; lines that begin with
/// # are passed over. Error: the line, and what is wrong with it: no four numbers, times that do not rise
/// evenly (gaps of more than a tenth of a second), fewer than 1000 readings, or a rate below 400 a second.
Result<AccelerationReadings, std::string> read_acceleration(std::string_view text);

}  // namespace kinebus
