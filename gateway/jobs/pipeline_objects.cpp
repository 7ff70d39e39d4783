// Objects of the print that are left out while the job runs: what is read from then on is without them.

#include "gateway/jobs/job_pipeline.hpp"

namespace kinebus {

std::span<const gcode::PrintObject> JobPipeline::objects() const {
  if (!interpreter_ || source_ == nullptr) return {};
  return interpreter_->state().objects;
}

Result<LeftOut, Sentence> JobPipeline::leave_out(const std::string& name) {
  if (!interpreter_ || source_ == nullptr) return Error<Sentence>(say("no job is read"));
  if (const auto done = interpreter_->exclude_object(name); !done) return Error<Sentence>(done.error());
  return LeftOut{steps_read(), name};
}

/// As the reading before this one had it.
void JobPipeline::leave_out_again() {
  for (; !left_out_.empty() && left_out_.front().step <= steps_read(); left_out_.pop_front())
    static_cast<void>(interpreter_->exclude_object(left_out_.front().name));
}

}  // namespace kinebus
