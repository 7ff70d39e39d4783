#pragma once
// The engine behind `kinebus plan`: a whole job through the gateway's core, from text to frames, against
// ideal nodes in virtual time; checked on the way. Memory is bounded, whatever the job's length.

#include <cstdint>
#include <vector>

#include "gateway/jobs/bus_load.hpp"
#include "gateway/jobs/ideal_nodes.hpp"
#include "gateway/jobs/preflight.hpp"
#include "gateway/stream/stream_group.hpp"

namespace kinebus {

struct PlanReport : JobReport {
  double job_time_s = 0;        ///< on the bus clock: motion at the rate that the bus allows, and dwells
  std::uint64_t segments = 0;   ///< streamed to all nodes
  std::uint64_t frames = 0;     ///< all: records, checkpoints, SYNC, stamps, status, heartbeats
  double bus_load_mean = 0;     ///< fraction of 1 Mbit/s
  double bus_load_peak_1s = 0;  ///< busiest second
  double lowest_rate = 1;       ///< below 1: the path was slowed for the bus
  double cpu_s = 0;             ///< filled by the caller, who may read a clock
  double peak_rss_mb = 0;       ///< the same
};

class JobPlan {
 public:
  /// `source` at its beginning; must outlive this. The job starts at the bed reference.
  JobPlan(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& source);

  /// Works on about `lines` lines. True: done.
  bool step(int lines);

  const PlanReport& report() const { return report_; }
  const ProblemList& problems() const { return check_.problems(); }
  std::uint64_t bytes() const { return pipeline_.bytes(); }

 private:
  /// Bus frames of fixed rate: how often and how long.
  struct Background {
    BusTime period, due;
    std::int64_t bits;
  };

  bool take(JobPipeline::Step step);
  void stream(const Phase& phase);
  void end_run();
  void run_until_wanted();
  void tick();
  void pass(BusTime duration);
  void count(std::int64_t bits);
  void fail(const StreamError& error);
  void finish();

  JobPipeline pipeline_;
  JobCheck check_;
  StreamGroup group_;
  std::vector<IdealNode> nodes_;
  std::vector<Background> background_;
  BusLoad load_;
  PlanReport report_;
  std::int64_t status_bits_ = 0;
  BusTime now_{0};
  BusTime next_rate_{0};
  double tau_ticks_ = 0, rate_ = 1;
  bool in_run_ = false;  ///< phases of this run are being streamed
  bool released_ = false;
  bool streaming_ = true;  ///< false after a problem: the rest is only checked
};

}  // namespace kinebus
