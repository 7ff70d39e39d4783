#include "gateway/jobs/journal/journal_state.hpp"

#include <utility>

namespace kinebus::journal {
namespace {

struct Taker {
  State& s;
  void operator()(const Epoch& r) const { s.epoch = r.epoch; }
  void operator()(const JobBegin& r) const {
    forget_job();
    s.job = r;
  }
  void operator()(const RunBegin& r) const {
    s.run = r;
    s.interrupted.reset();
    s.progress.reset();
    s.found.reset();
  }
  void operator()(const WaitsDone& r) const { s.waits_done = r.count; }
  void operator()(const Scale& r) const { s.scales.push_back(r.scale); }
  void operator()(const Override& r) const { s.override_ratio = r.ratio; }
  void operator()(const Thermal& r) const {
    Heat& heat = s.heat.emplace();
    heat.heater(kFirstHotend) = r.hotend_celsius;
    heat.heater(kFirstBed) = r.bed_celsius;
    heat.fan(0) = r.fan;
    heat.spindle_rpm = r.spindle_rpm;
  }
  void operator()(const Heat& r) const { s.heat = r; }
  void operator()(const Progress& r) const { s.progress = r; }
  void operator()(const JobTime& r) const { s.time = r; }
  void operator()(const Interrupted& r) const {
    s.interrupted = r;
    s.run.reset();
  }
  void operator()(const Found& r) const { s.found = r.tau; }
  void operator()(const JobEnd&) const { forget_job(); }
  void operator()(const Offsets& r) const {
    std::erase_if(s.offsets, [&](const Offsets& old) { return old.machine == r.machine; });
    if (s.offsets.size() == State::kMachines) s.offsets.erase(s.offsets.begin());
    s.offsets.push_back(r);
  }

  void forget_job() const {
    State kept;
    kept.epoch = s.epoch;
    kept.offsets = std::move(s.offsets);
    s = std::move(kept);
  }
};

}  // namespace

void State::take(const Record& record) {
  // Without a job's beginning the rest means nothing.
  const bool always = std::holds_alternative<Epoch>(record) || std::holds_alternative<JobBegin>(record) ||
                      std::holds_alternative<Offsets>(record);
  if (always || job) std::visit(Taker{*this}, record);
}

gcode::WorkOffsets State::offsets_of(const std::string& machine) const {
  for (const Offsets& known : offsets)
    if (known.machine == machine) return known.offsets;
  return {};
}

std::vector<Record> State::records() const {
  std::vector<Record> all;
  if (epoch) all.emplace_back(Epoch{*epoch});
  for (const Offsets& machine : offsets) all.emplace_back(machine);
  if (!job) return all;
  all.emplace_back(*job);
  for (const FeedScale& scale : scales) all.emplace_back(Scale{scale});
  if (waits_done > 0) all.emplace_back(WaitsDone{waits_done});
  if (override_ratio) all.emplace_back(Override{*override_ratio});
  if (heat) all.emplace_back(*heat);
  if (time) all.emplace_back(*time);
  if (run) all.emplace_back(*run);
  if (progress) all.emplace_back(*progress);
  if (found) all.emplace_back(Found{*found});
  if (interrupted) all.emplace_back(*interrupted);
  return all;
}

}  // namespace kinebus::journal
