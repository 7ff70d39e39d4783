#pragma once
// All records of a journal together: what is known of the job that was under way.

#include <optional>
#include <vector>

#include "gateway/jobs/journal/journal_record.hpp"

namespace kinebus::journal {

struct State {
  std::optional<std::uint8_t> epoch;
  std::optional<JobBegin> job;  ///< none: nothing to take up
  std::optional<RunBegin> run;  ///< none: the job stands at `interrupted`, or has not moved
  std::optional<Interrupted> interrupted;
  std::optional<PathTime> found;  ///< counts for `run`
  std::uint64_t waits_done = 0;
  std::vector<FeedScale> scales;
  std::optional<double> override_ratio;
  std::optional<Thermal> thermal;
  std::optional<Progress> progress;
  friend bool operator==(const State&, const State&) = default;

  void take(const Record& record);
  /// The fewest records that lead to this state.
  std::vector<Record> records() const;
};

}  // namespace kinebus::journal
