#pragma once
// The person at the machine, in virtual time: brings it up, homes, prints; after a stop lifts it when its
// cause has gone, goes on if the machine offers it, else begins anew until the machine is ready.

#include <functional>
#include <memory>
#include <string>

#include "gateway/jobs/byte_source.hpp"
#include "tools/simulation/simulation.hpp"

namespace kinebus {

class Operator {
 public:
  /// `begins_again`: a job that was stopped before its first line is run once more.
  Operator(std::string job, bool begins_again) : job_(std::move(job)), begins_again_(begins_again) {}

  /// Every millisecond. `cause_over`: there is nothing to wait for before a stop is lifted and a job goes on.
  void on_time(BusTime now, Gateway& gateway, bool cause_over);
  const std::string& job() const { return job_; }
  bool job_begun() const { return job_begun_; }   ///< run() was accepted
  bool job_running() const { return job_runs_; }  ///< it moves: bed reference and print
  bool job_finished() const { return job_done_; }
  bool job_lost() const { return job_lost_; }
  bool homed_again() const { return homed_again_; }
  int lifted() const { return lifted_; }
  int resumed() const { return resumed_; }
  int begun_again() const { return begun_again_; }
  /// Nothing left to do: the job is done, or it is lost and the machine is ready again.
  bool content() const { return content_; }
  void on_event(const MachineEvent& event);
  /// The job is left as it is.
  void give_up() { content_ = true; }

 private:
  bool go_on(Gateway& gateway);
  void act(BusTime now, Gateway& gateway, bool cause_over);

  std::string job_;
  bool begins_again_;
  BusTime next_{0};
  bool ever_ready_ = false, job_begun_ = false, job_runs_ = false, job_done_ = false, job_lost_ = false,
       homed_again_ = false, content_ = false;
  int lifted_ = 0, resumed_ = 0, begun_again_ = 0, lift_attempts_ = 0;
};

}  // namespace kinebus
