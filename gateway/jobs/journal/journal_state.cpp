#include "gateway/jobs/journal/journal_state.hpp"

namespace kinebus::journal {
namespace {

struct Taker {
  State& s;
  void operator()(const Epoch& r) const { s.epoch = r.epoch; }
  void operator()(const JobBegin& r) const {
    const auto epoch = s.epoch;
    s = State{};
    s.epoch = epoch;
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
  void operator()(const Thermal& r) const { s.thermal = r; }
  void operator()(const Progress& r) const { s.progress = r; }
  void operator()(const Interrupted& r) const {
    s.interrupted = r;
    s.run.reset();
  }
  void operator()(const Found& r) const { s.found = r.tau; }
  void operator()(const JobEnd&) const {
    const auto epoch = s.epoch;
    s = State{};
    s.epoch = epoch;
  }
};

}  // namespace

void State::take(const Record& record) {
  // Without a job's beginning the rest means nothing.
  const bool always = std::holds_alternative<Epoch>(record) || std::holds_alternative<JobBegin>(record);
  if (always || job) std::visit(Taker{*this}, record);
}

std::vector<Record> State::records() const {
  std::vector<Record> all;
  if (epoch) all.emplace_back(Epoch{*epoch});
  if (!job) return all;
  all.emplace_back(*job);
  for (const FeedScale& scale : scales) all.emplace_back(Scale{scale});
  if (waits_done > 0) all.emplace_back(WaitsDone{waits_done});
  if (override_ratio) all.emplace_back(Override{*override_ratio});
  if (thermal) all.emplace_back(*thermal);
  if (run) all.emplace_back(*run);
  if (progress) all.emplace_back(*progress);
  if (found) all.emplace_back(Found{*found});
  if (interrupted) all.emplace_back(*interrupted);
  return all;
}

}  // namespace kinebus::journal
