// M906 of a text session: the motors' currents, told and set. Letters name motors where an axis has one of
// its own; on a parallel mechanism motors are joints, and have numbers.

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>

#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

constexpr std::string_view kAxisNames = "XYZACE";
constexpr double kMoves = 1e-9;  // mm or rad of a joint for one of an axis

struct CurrentWords {
  std::array<std::optional<double>, 26> value{};
  Sentence wrong;

  explicit CurrentWords(std::string_view text) {
    while (!text.empty() && text.front() != ';' && text.front() != '(') {
      const int letter = std::toupper(static_cast<unsigned char>(text.front()));
      text.remove_prefix(1);
      if (letter == ' ' || letter == '\t' || letter == '\r') continue;
      const std::string rest(text.substr(0, 24));
      char* end = nullptr;
      const double number = std::strtod(rest.c_str(), &end);
      if (letter < 'A' || letter > 'Z' || end == rest.c_str() || !std::isfinite(number)) {
        wrong = say("M906 takes letters with numbers, as M906 X800 H400 or M906 I1 S800");
        return;
      }
      value[static_cast<std::size_t>(letter - 'A')] = number;
      text.remove_prefix(static_cast<std::size_t>(end - rest.c_str()));
    }
  }
  std::optional<double> operator[](char letter) const {
    return value[static_cast<std::size_t>(letter - 'A')];
  }
};

}  // namespace

std::optional<std::size_t> Gateway::Core::motor_of_axis(std::size_t axis) const {
  JointVector joints{};
  std::array<double, static_cast<std::size_t>(kMaxJoints) * kPoseAxes> matrix{};
  const auto rows = static_cast<std::size_t>(kinematics_->joint_count());
  if (!kinematics_->jacobian(Frame::kMachine, kinematics_->bed_reference(), joints,
                             std::span(matrix).first(rows * kPoseAxes)))
    return std::nullopt;
  const auto moves = [&](std::size_t joint, std::size_t by) {
    return std::abs(matrix[joint * kPoseAxes + by]) > kMoves;
  };
  std::optional<std::size_t> own;
  for (std::size_t joint = 0; joint < std::min(rows, machine_.joints.size()); ++joint) {
    bool alone = moves(joint, axis);
    for (std::size_t other = 0; other < kPoseAxes; ++other)
      alone = alone && (other == axis || !moves(joint, other));
    if (!alone) continue;
    if (own) return std::nullopt;
    own = joint;
  }
  return own;
}

std::string Gateway::Core::currents_text() const {
  std::string text;
  const MachineStatus s = status();
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
    const JointDescription& joint = machine_.joints[j];
    std::array<char, 96> line{};
    std::snprintf(line.data(), line.size(), "I%u: run %u mA, hold %u mA", static_cast<unsigned>(j + 1),
                  static_cast<unsigned>(joint.run_current_ma), static_cast<unsigned>(joint.hold_current_ma));
    text += (text.empty() ? "" : "\n") + joint.name + " " + line.data();
    for (const NodeStatus& node : s.nodes)
      if (const auto& measured = node.current_a[joint.axis & 1u]; node.id == joint.node_id && measured) {
        std::snprintf(line.data(), line.size(), ", measured %.0f mA", 1000 * *measured);
        text += line.data();
      }
  }
  return text;
}

Result<std::string, Refusal> Gateway::Core::set_currents(std::string_view text) {
  const CurrentWords words(text);
  if (!words.wrong.empty()) return refused(words.wrong);
  command::SetMotorCurrents asked;
  for (std::size_t axis = 0; axis < kAxisNames.size(); ++axis) {
    const char letter = kAxisNames[axis];
    const auto run = words[letter];
    if (!run) continue;
    const auto joint = motor_of_axis(axis);
    if (!joint)
      return refused(
          say("no motor moves %1 alone on this machine: name a joint by its number, as M906 I1 S800 "
              "for %2",
              std::string(1, letter), machine_.joints.front().name));
    asked.motors.push_back({.joint = *joint, .run_ma = *run, .hold_ma = words['H']});
  }
  const auto index = words['I'];
  if (asked.motors.empty() && index) {
    const auto joints = static_cast<double>(machine_.joints.size());
    if (!(*index >= 1 && *index <= joints) || *index != std::floor(*index))
      return refused(say("I is the number of a joint, 1 to %1", machine_.joints.size()));
    if (!words['S'] && !words['H'])
      return refused(say("M906 I needs the run current S or the hold current H"));
    asked.motors.push_back(
        {.joint = static_cast<std::size_t>(*index) - 1, .run_ma = words['S'], .hold_ma = words['H']});
  } else if (words['S'] || (asked.motors.empty() && words['H'])) {
    return refused(say("S and H need the joint I"));
  } else if (index && *index != 0) {
    // Marlin's I: which of an axis' motors. Here each has one.
    return refused(say("M906 takes axes or the joint I, not both"));
  }
  if (asked.motors.empty()) return currents_text();
  if (auto done = carry_out(std::move(asked)); !done) return Error<Refusal>(done.error());
  const bool rests = state_.idle() || state_.is(MachineState::kHeld) || lines_idle();
  return std::string(rests ? "" : "echo:the currents are set when the machine stands still");
}

}  // namespace kinebus
