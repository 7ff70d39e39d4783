#include "tools/simulation/checkers/path_checker.hpp"

#include <algorithm>
#include <cstring>
#include <variant>

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

// The moves of a loop come when its last line is read, which is behind the one in motion.
constexpr std::size_t kMovesAhead = 16;

}  // namespace

PathChecker::PathChecker(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& source,
                         const Pose& start)
    : kinematics_(kinematics), source_(source), text_(std::size_t{64} * 1024) {
  const Pose home = kinematics.bed_reference();
  interpreter_ = std::make_unique<gcode::Interpreter>(interpreter_options(machine, start, home));
  reader_ = std::make_unique<gcode::JobReader>(*interpreter_);
}

PathChecker::~PathChecker() = default;

void PathChecker::take(const canonical::Line& line) {
  Frame frame = frames_.empty() ? Frame::kMachine : frames_.back().second;
  if (const auto* home = std::get_if<canonical::Home>(&line.command)) {
    distance_.add({line.line, canonical::Traverse{home->afterwards, home->frame}});
    frame = home->frame;
  } else if (const auto* probe = std::get_if<canonical::Probe>(&line.command)) {
    distance_.add({line.line, canonical::Feed{probe->target, probe->frame, probe->feed_per_s, 0}});
    if (probe_line_ == 0) probe_line_ = line.line;
  } else {
    distance_.add(line);
    if (const auto* set = std::get_if<canonical::SetPosition>(&line.command)) frame = set->frame;
  }
  if (frames_.empty() || frames_.back().second != frame) frames_.emplace_back(line.line, frame);
}

void PathChecker::read_ahead(std::uint32_t line) {
  while (!ended_ && (reader_->lines() < line || distance_.ahead() < kMovesAhead)) {
    if (text_at_ == text_end_) {
      text_at_ = 0;
      text_end_ = source_.read(text_);
    }
    commands_.clear();
    if (text_end_ == 0) {
      ended_ = true;
      static_cast<void>(reader_->finish(commands_));
    } else {
      const char* from = text_.data() + text_at_;
      const auto* end = static_cast<const char*>(std::memchr(from, '\n', text_end_ - text_at_));
      const std::size_t length =
          end != nullptr ? static_cast<std::size_t>(end + 1 - from) : text_end_ - text_at_;
      static_cast<void>(reader_->read({from, length}, commands_));
      text_at_ += length;
    }
    for (const canonical::Line& command : commands_) take(command);
  }
}

void PathChecker::on_sample(const Sample& sample) {
  if (!sample.planned || sample.line == 0) return;
  read_ahead(sample.line);
  if (probe_line_ != 0 && sample.line > probe_line_) return;
  while (frames_.size() > 1 && frames_[1].first <= sample.line) frames_.pop_front();
  Pose pose = sample.pose;
  if (!frames_.empty() && frames_.front().second == Frame::kMachine && (pose[kA] != 0 || pose[kC] != 0))
    if (const auto converted = convert_pose(kinematics_, Frame::kPart, pose, Frame::kMachine))
      pose = *converted;
  // No farther than the line in motion: a later line that crosses here is not where the tool should be.
  last_um_ = 1000 * distance_.distance_mm(pose, sample.line);
  squares_um2_ += last_um_ * last_um_;
  ++samples_;
  if (last_um_ > max_um_) {
    max_um_ = last_um_;
    worst_time_s_ = to_seconds(sample.time);
    worst_line_ = sample.line;
  }
}

}  // namespace kinebus
