#include "gateway/machine/lines/line_desk.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {
constexpr double kLargestOffset = 1e6;  // mm
}  // namespace

LineDesk::LineDesk(const MachineDescription& machine, const Kinematics& kinematics, journal::Queue& journal,
                   const bodies::PrintedPart* printed)
    : machine_(machine), journal_(journal), lines_(machine, kinematics, printed) {}

const gcode::CommandBuffer& LineDesk::open(const Pose& pose, const HotendTargets& hotends) {
  commands_.clear();
  lines_.begin(pose, hotends, commands_);
  closing_ = false;
  give_up_from_.reset();
  return commands_;
}

Result<std::span<const canonical::Line>, Refusal> LineDesk::take(std::optional<Sentence> still,
                                                                 std::string_view line,
                                                                 std::uint32_t number) {
  if (still) lines_.end(*std::move(still));
  commands_.clear();
  const gcode::WorkOffsets before = lines_.work_offsets();
  if (const auto taken = lines_.take(line, number, commands_); !taken) return refused(taken.error().words);
  note_offsets(before);
  return std::span<const canonical::Line>(commands_);
}

Result<void, Refusal> LineDesk::set_work_offset(std::uint32_t system, const Pose& offset, bool here,
                                                const std::optional<Pose>& where) {
  if (system < 1 || system > std::uint32_t{gcode::kCoordinateSystems})
    return refused(say("a work coordinate system is 1 (G54) to 9 (G59.3)"));
  if (!std::all_of(offset.begin(), offset.end(),
                   [](double v) { return std::isfinite(v) && std::abs(v) < kLargestOffset; }))
    return refused(say("a work offset needs numbers below 1000 m"));
  const gcode::WorkOffsets before = lines_.work_offsets();
  if (const auto set = lines_.set_work_offset(static_cast<int>(system) - 1, offset, here, where); !set)
    return refused(set.error());
  note_offsets(before);
  return {};
}

void LineDesk::note_offsets(const gcode::WorkOffsets& before) {
  if (lines_.work_offsets() != before)
    journal_.push(journal::Offsets{identity(machine_), lines_.work_offsets()});
}

}  // namespace kinebus
