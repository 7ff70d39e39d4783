#pragma once
// The gateway's values as messages of the job link. Values only: no state, no time.

#include "gateway/jobs/preflight.hpp"
#include "gateway/jobs/store/job_store.hpp"
#include "gateway/machine/description/machine_description.hpp"
#include "gateway/machine/description/machine_file.hpp"
#include "gateway/machine/event.hpp"
#include "gateway/machine/gateway.hpp"
#include "gateway/machine/status.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

/// Nothing moves and nothing will by itself.
bool at_rest(MachineState state);

joblink::Status to_message(const MachineStatus& status, const MachineDescription& machine);
joblink::Event to_message(const MachineEvent& event);
joblink::MachineInfo to_message(const MachineDescription& machine, const PoseVector& bed_reference);
joblink::Job to_message(const StoredJob& job);
joblink::JobRun to_message(const StoredRun& run);
joblink::PreflightSummary to_message(const StoredPreflight& found);
joblink::PreflightResult to_message(const JobReport& report, const ProblemList& problems);
joblink::MachineFileCheck to_message(const MachineFileErrors& errors);

void set_pose(joblink::Pose& message, const PoseVector& pose);
PoseVector pose_of(const joblink::Pose& message);

joblink::Problem problem(joblink::ErrorCode code, std::string place, std::string rule,
                         std::string expected = {});
joblink::Problem problem(const Refusal& refusal);
joblink::Problem problem(const StoreError& error);

}  // namespace kinebus
