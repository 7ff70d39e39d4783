#include "tools/simulation/planned_phases.hpp"

#include "gateway/jobs/job_pipeline.hpp"

namespace kinebus {

void for_each_phase(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& text,
                    double limit_s, const std::function<void(const Phase&)>& take) {
  JobPipeline pipeline(machine, kinematics);
  pipeline.start_job(text, kinematics.bed_reference());
  double time_s = 0;
  for (;;) {
    int budget = 1000;
    const JobPipeline::Step step = pipeline.next(budget);
    if (step == JobPipeline::Step::kEnd) return;
    if (step != JobPipeline::Step::kPhase) continue;
    take(pipeline.phase());
    time_s += pipeline.phase().duration_s;
    if (limit_s > 0 && time_s > limit_s) return;
  }
}

}  // namespace kinebus
