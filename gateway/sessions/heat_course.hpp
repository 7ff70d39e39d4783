#pragma once
// What heaters and fans did, for clients that come later: the last ten minutes second by second, and the
// whole of the job that was begun last, as finely as fits. Its memory is taken once, however long a job
// takes.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/status/status.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

class HeatCourse {
 public:
  static constexpr BusTime kPeriod = std::chrono::seconds{1};
  static constexpr std::size_t kRecent = 600;
  /// A job's samples beyond this are thinned by half.
  static constexpr std::size_t kMostOfJob = 1200;

  /// Once in kPeriod. The first one says which heaters and fans there are.
  void take(const MachineStatus& status);
  joblink::HeatCourse message() const;

 private:
  /// Samples in a row of places, the oldest anywhere.
  struct Course {
    std::vector<double> time_s;
    std::vector<std::int16_t> values;  ///< of each time: actual, target, power of each heater; the fans
    std::size_t first = 0, count = 0;
  };
  void make_room(const MachineStatus& status);
  void put(Course& course, const MachineStatus& status);
  void take_job(const MachineStatus& status);
  void thin_job();
  std::size_t width() const { return 3 * heaters_.size() + fans_.size(); }
  joblink::HeatSamples message(const Course& course) const;

  std::vector<std::string> heaters_, fans_;
  Course recent_, job_;
  double job_period_s_ = to_seconds(kPeriod), job_elapsed_s_ = 0;
  std::string job_name_;
};

}  // namespace kinebus
