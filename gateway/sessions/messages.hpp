#pragma once
// The gateway's values as messages of the job link. Values only: no state, no time.

#include <string>
#include <string_view>

#include "gateway/description/machine_description.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/jobs/preflight.hpp"
#include "gateway/jobs/store/job_store.hpp"
#include "gateway/machine/gateway.hpp"
#include "gateway/sentence.hpp"
#include "gateway/status/event.hpp"
#include "gateway/status/status.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

/// Nothing moves and nothing will by itself.
bool at_rest(MachineState state);

joblink::Status to_message(const MachineStatus& status, const MachineDescription& machine);
joblink::Event to_message(const MachineEvent& event);
joblink::MachineInfo to_message(const MachineDescription& machine, const Pose& bed_reference);
joblink::Job to_message(const StoredJob& job);
joblink::JobRun to_message(const StoredRun& run);
joblink::PreflightSummary to_message(const StoredPreflight& found);
joblink::PreflightResult to_message(const JobReport& report, const ProblemList& problems);
joblink::MachineFileCheck to_message(const MachineFileErrors& errors);

void set_pose(joblink::Pose& message, const Pose& pose);
Pose pose_of(const joblink::Pose& message);

/// Text from a job may hold bytes that are no UTF-8, which a message cannot carry: they are shown as '?'.
std::string clean(std::string_view text);
joblink::Sentence to_message(const Sentence& sentence);
joblink::Problem problem(joblink::ErrorCode code, const std::string& place, const Sentence& rule,
                         const Sentence& expected = {});
joblink::Problem problem(const Refusal& refusal);
joblink::Problem problem(const StoreError& error);

}  // namespace kinebus
