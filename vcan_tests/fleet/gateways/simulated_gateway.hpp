#pragma once
// A gateway as far as a fleet sees it: store, history, one job at a time that takes its time and moves
// nothing. The rules of the history are JobStore's; it is a file that outlives the process.

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "protocol/joblink/kinebus.pb.h"
#include "protocol/time.hpp"

namespace kinebus::fleet {

class SimulatedGateway {
 public:
  /// Takes up what `file` tells of before.
  SimulatedGateway(const std::string& file, LocalTime job_time);

  joblink::Reply answer(LocalTime now, const joblink::ClientMessage& request);
  void on_time(LocalTime now);

 private:
  void status(LocalTime now, joblink::Status& status) const;
  void history(const joblink::GetHistory& request, joblink::History& history) const;
  void upload(const joblink::UploadBegin& begin, joblink::UploadState& state);
  void start(LocalTime now, const std::string& name, joblink::Reply& reply);
  void begin(const std::string& name, const std::string& hash, double unix_s);
  void end(joblink::JobResult result, double duration_s);
  bool running() const { return run_until_ != LocalTime::max(); }

  std::ofstream file_;
  LocalTime job_time_, run_until_ = LocalTime::max();
  std::vector<joblink::JobRun> runs_;
  std::map<std::string, std::string> stored_;  ///< hash by name
  joblink::UploadBegin open_{};
};

}  // namespace kinebus::fleet
