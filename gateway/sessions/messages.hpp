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
#include "protocol/joblink/frame_codec.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

/// Nothing moves and nothing will by itself.
bool at_rest(MachineState state);

joblink::Status to_message(const MachineStatus& status);
joblink::Event to_message(const MachineEvent& event);
joblink::MachineInfo to_message(const MachineDescription& machine, const Pose& bed_reference);
joblink::Job to_message(const StoredJob& job);
joblink::JobList to_message(const JobListing& listing);
joblink::JobRun to_message(const StoredRun& run);
joblink::PreflightSummary to_message(const StoredPreflight& found);
joblink::PreflightResult to_message(const JobReport& report, const ProblemList& problems);
joblink::MachineFileCheck to_message(const MachineFileErrors& errors);

void set_pose(joblink::Pose& message, const Pose& pose);
Pose pose_of(const joblink::Pose& message);

/// Texts that are not the gateway's own go through shown() (protocol/joblink/shown_text.hpp), here and
/// nowhere else.
joblink::Sentence to_message(const Sentence& sentence);
joblink::Problem problem(joblink::ErrorCode code, const std::string& place, const Sentence& rule,
                         const Sentence& expected = {});
joblink::Problem problem(const Refusal& refusal);
joblink::Problem problem(const StoreError& error);

/// What one reply takes of a long list: elements until they would fill more than this with what else is in
/// it.
class ListRoom {
 public:
  static constexpr std::size_t kBytes = joblink::kMaxMessageBytes * 3 / 4;
  /// False: no room, neither for it nor for what follows.
  bool take(const google::protobuf::MessageLite& element) {
    used_bytes_ += element.ByteSizeLong() + 8;
    return used_bytes_ <= kBytes;
  }

 private:
  std::size_t used_bytes_ = 0;
};

}  // namespace kinebus
