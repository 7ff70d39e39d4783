#include "tools/compose/strands.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "tools/compose/tool_path.hpp"

namespace kinebus::compose {
namespace {

constexpr double kChord_mm = 1, kLayer_mm = 0.02;

/// For every line of the job (index = line number) whether what it lays is seen from outside.
std::vector<bool> outside_lines(std::string_view text) {
  constexpr std::string_view kType = ";TYPE:";
  std::vector<bool> out{true};
  bool outside = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    if (line.starts_with(kType)) {
      const std::string_view type = line.substr(kType.size());
      outside = type.starts_with("External") || type.starts_with("Overhang") || type.starts_with("Top");
    }
    out.push_back(outside);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  }
  return out;
}

class Collector {
 public:
  explicit Collector(const JoinedJob& job) : job_(job), outside_(outside_lines(job.text)) {}

  void take(const canonical::Line& line) {
    if (const auto* set = std::get_if<canonical::SetPosition>(&line.command)) here_ = set->pose;
    if (const auto* move = std::get_if<canonical::Traverse>(&line.command)) here_ = move->target;
    if (const auto* move = std::get_if<canonical::Feed>(&line.command)) go(line.line, move->target, nullptr);
    if (const auto* arc = std::get_if<canonical::Arc>(&line.command)) go(line.line, arc->target, arc);
  }

  std::vector<Strand> strands;

 private:
  void go(std::uint32_t line, const Pose& target, const canonical::Arc* arc) {
    const Vector from = tip_of(here_), to = tip_of(target);
    const bool feeds = target[5] > here_[5] + 1e-9;
    here_ = target;
    const double length = length_of(from, to, arc);
    if (!feeds || length < 1e-6) return;
    while (piece_ + 1 < job_.pieces.size() && static_cast<int>(line) > job_.pieces[piece_].last) {
      ++piece_;
      layer_ = -1;
    }
    const Vector up(std::sin(target[4]) * std::sin(target[3]), std::cos(target[4]) * std::sin(target[3]),
                    std::cos(target[3]));
    const double height = up.dot(to);
    if (layer_ < 0 || std::abs(height - height_) > kLayer_mm) {
      ++layer_;
      height_ = height;
    }
    const int parts = arc == nullptr ? 1 : std::max(1, static_cast<int>(std::ceil(length / kChord_mm)));
    for (int k = 0; k < parts; ++k)
      strands.push_back({tip_between(from, to, arc, static_cast<double>(k) / parts),
                         tip_between(from, to, arc, static_cast<double>(k + 1) / parts), target[3], target[4],
                         static_cast<int>(piece_), layer_,
                         outside_[std::min<std::size_t>(line, outside_.size() - 1)]});
  }

  const JoinedJob& job_;
  std::vector<bool> outside_;
  Pose here_{};
  std::size_t piece_ = 0;
  int layer_ = -1;
  double height_ = 0;
};

}  // namespace

std::vector<Strand> strands_of(const JoinedJob& job, const MachineDescription& machine) {
  const auto kinematics = make_kinematics(machine);
  if (!kinematics) throw std::runtime_error(kinematics.error().what);
  const Pose start = (*kinematics)->bed_reference();
  gcode::Interpreter interpreter(interpreter_options(machine, start, start));
  gcode::JobReader reader(interpreter);
  gcode::CommandBuffer commands;
  if (const auto read = reader.read(job.text, commands); !read || !reader.finish(commands))
    throw std::runtime_error("the job cannot be read back");
  Collector collector(job);
  for (const canonical::Line& line : commands) collector.take(line);
  return collector.strands;
}

}  // namespace kinebus::compose
