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
  void operator()(const ObjectLeftOut& r) const { s.left_out.push_back(r.object); }
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
  /// A part only grows: who reads its job again notes it again from below.
  void operator()(const Printed& r) const {
    if (!s.printed || s.printed->top_mm < r.top_mm) s.printed = r;
  }
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

  /// It rests there: no path time before means anything to the job.
  void operator()(const Learned& r) const {
    s.learned.push_back(r);
    const double shift_mm = s.run           ? s.run->extruder_shift_mm
                            : s.interrupted ? s.interrupted->extruder_shift_mm
                                            : 0;
    s.interrupted = Interrupted{{r.phases, 0}, shift_mm};
    s.run.reset();
    s.progress.reset();
    s.found.reset();
  }
  void operator()(const Mesh& r) const {
    std::erase_if(s.meshes, [&](const Mesh& old) { return old.machine == r.machine && old.name == r.name; });
    if (r.grid.height_mm.empty()) return;
    if (s.meshes.size() == State::kMeshes) s.meshes.erase(s.meshes.begin());
    s.meshes.push_back(r);
  }
  void operator()(const MeshInForce& r) const {
    std::erase_if(s.meshes_in_force, [&](const MeshInForce& old) { return old.machine == r.machine; });
    if (r.name.empty()) return;
    if (s.meshes_in_force.size() == State::kMachines) s.meshes_in_force.erase(s.meshes_in_force.begin());
    s.meshes_in_force.push_back(r);
  }

  void forget_job() const {
    State kept;
    kept.epoch = s.epoch;
    kept.meshes = std::move(s.meshes);
    kept.meshes_in_force = std::move(s.meshes_in_force);
    kept.offsets = std::move(s.offsets);
    s = std::move(kept);
  }
};

}  // namespace

void State::take(const Record& record) {
  // Without a job's beginning the rest means nothing.
  const bool always = std::holds_alternative<Epoch>(record) || std::holds_alternative<JobBegin>(record) ||
                      std::holds_alternative<Offsets>(record) || std::holds_alternative<Mesh>(record) ||
                      std::holds_alternative<MeshInForce>(record);
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
  for (const Mesh& mesh : meshes) all.emplace_back(mesh);
  for (const MeshInForce& machine : meshes_in_force) all.emplace_back(machine);
  if (!job) return all;
  all.emplace_back(*job);
  for (const Learned& each : learned) all.emplace_back(each);
  for (const FeedScale& scale : scales) all.emplace_back(Scale{scale});
  for (const LeftOut& object : left_out) all.emplace_back(ObjectLeftOut{object});
  if (waits_done > 0) all.emplace_back(WaitsDone{waits_done});
  if (override_ratio) all.emplace_back(Override{*override_ratio});
  if (heat) all.emplace_back(*heat);
  if (time) all.emplace_back(*time);
  if (printed) all.emplace_back(*printed);
  if (run) all.emplace_back(*run);
  if (progress) all.emplace_back(*progress);
  if (found) all.emplace_back(Found{*found});
  if (interrupted) all.emplace_back(*interrupted);
  return all;
}

}  // namespace kinebus::journal
