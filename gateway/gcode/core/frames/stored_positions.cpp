// G28 finds the switches. Where G28.1 or G30.1 has kept a position, G28 and G30 go back to it as on mills; on
// printers G30 probes (printer/levelling.cpp).

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

bool Core::home() {
  ModalState& m = state_.modal;
  unsigned axes = 0;
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis) {
    const char letter = kAxisLetters[axis];
    if (!has(letter)) continue;
    // G28 X0 is common; an intermediate point as in RS274/NGC has no meaning when home is a switch.
    if (!block_.is_bare(letter) && block_[letter] != 0)
      return fail(block_.column_of(letter), say("G28 finds the home switches: name axes without a number"));
    pass_over(letter);
    axes |= 1U << axis;
  }
  // G28 W: without bed levelling, which is never done here. G28 O: only where it is needed; a machine that
  // knows its position goes to its reference without looking for switches, whatever the word says.
  for (const char letter : {'W', 'O'})
    if (block_.is_bare(letter)) pass_over(letter);
  pass_over('R');  // how high other machines lift before it
  Pose machine = in_frame(m.position, m.frame, Frame::kMachine);
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis)
    if (axes == 0 || (axes >> axis & 1U) != 0) machine[axis] = options_.home[axis];
  m.lifted_mm = 0;
  m.position = in_frame(machine, Frame::kMachine, m.frame);
  refresh();
  emit(canonical::Home{static_cast<std::uint8_t>(axes), m.position, m.frame});
  return true;
}

}  // namespace kinebus::gcode
