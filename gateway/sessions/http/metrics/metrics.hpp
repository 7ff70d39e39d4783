#pragma once
// What Prometheus asks for: the machine's state as numbers.

#include <string>

#include "gateway/jobs/store/job_store.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::http {

/// What is not in the machine's status.
struct MetricsBeside {
  std::string version;
  JobListing listing;
  RunTotals runs;
};

/// The page of GET /metrics: SI units but for degrees Celsius, as Prometheus names them.
std::string metrics_page(const joblink::Status& status, const joblink::MachineInfo& machine,
                         const MetricsBeside& beside);

}  // namespace kinebus::http
