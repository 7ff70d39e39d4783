#pragma once
// Where in a job the machine is, by what does not depend on time: reading the same job again leads to the
// same place, to the last bit.

#include <cstdint>
#include <string>

namespace kinebus {

/// Between two waits, or within a phase of the motion that the pipeline plans.
struct JobPlace {
  std::uint64_t phase = 0;  ///< phases of the job that are done
  double phase_s = 0;       ///< planned time into the next one, s
  friend bool operator==(const JobPlace&, const JobPlace&) = default;
};

/// A feed override above 100 % changes what is planned: from this motion command on.
struct FeedScale {
  std::uint64_t move = 0;  ///< motion commands planned before
  double scale = 1;
  friend bool operator==(const FeedScale&, const FeedScale&) = default;
};

/// An object of the print that was left out while the job ran.
struct LeftOut {
  std::uint64_t step = 0;  ///< lines and recorded lines carried out before
  std::string name;
  friend bool operator==(const LeftOut&, const LeftOut&) = default;
};

}  // namespace kinebus
