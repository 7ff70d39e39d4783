// G28 and G30 as mills have them: back to the position that G28.1 or G30.1 has kept. Without one G28 is
// homing (offsets.cpp), and on printers G30 probes (levelling.cpp).

#include <numbers>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

// #5161 to #5169 and #5181 to #5189: X Y Z A B C U V W in the machine's coordinates, mm and degrees.
constexpr std::size_t kFirstOfG28 = 5161, kFirstOfG30 = 5181;
constexpr std::array<std::size_t, 5> kSlotOf = {0, 1, 2, 3, 5};  // of X Y Z A C
constexpr double kDegrees = 180 / std::numbers::pi;

double scale_of(std::size_t axis) {
  return axis == kAxisA || axis == kAxisC ? kDegrees : 1;
}

}  // namespace

bool Core::is_stored(Code code) const {
  const ModalState& m = state_.modal;
  return code.number == 280 ? m.g28_stored : m.g30_stored;
}

bool Core::store_position(Code code) {
  if (!check_leftovers()) return false;
  ModalState& m = state_.modal;
  const bool g28 = code.number == 281;
  (g28 ? m.g28_stored : m.g30_stored) = true;
  const Pose machine = in_frame(m.position, m.frame, Frame::kMachine);
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis)
    state_.parameters.numbered[(g28 ? kFirstOfG28 : kFirstOfG30) + kSlotOf[axis]] =
        machine[axis] * scale_of(axis);
  return true;
}

/// Over the point of the line's words, then the axes that it names, or all.
bool Core::go_to_stored(Code code) {
  ModalState& m = state_.modal;
  if (m.frame != Frame::kMachine)
    return fail(code.column, say("%1 needs G49 and G69: machine coordinates do not turn with the part",
                                 g_name(code.number)));
  unsigned named = 0;
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis)
    if (has(kAxisLetters[axis])) named |= 1U << axis;
  Pose program = m.program;
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis)
    if (block_.is_bare(kAxisLetters[axis])) pass_over(kAxisLetters[axis]);
  program_target(program);
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis) pass_over(kAxisLetters[axis]);
  const Pose over = canonical_pose(program);
  if (over != m.position) emit(canonical::Traverse{over, m.frame});
  Pose target = over;
  target[kAxisE] = m.position[kAxisE];
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis) {
    if (named != 0 && (named >> axis & 1U) == 0) continue;
    const std::size_t first = code.number == 280 ? kFirstOfG28 : kFirstOfG30;
    target[axis] = state_.parameters.numbered[first + kSlotOf[axis]] / scale_of(axis);
  }
  if (target != over) emit(canonical::Traverse{target, m.frame});
  m.position = target;
  refresh();
  return true;
}

}  // namespace kinebus::gcode
