// Lines of a text session (serial terminal, print host): queries and commands that need no job, Marlin's way.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "gateway/machine/core.hpp"
#include "gateway/status/temperature_text.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

constexpr double kDegrees = 57.29577951308232;

/// "M104 S205" -> 'M', 104; letters' values by word().
struct Words {
  char letter = 0;
  int number = -1;
  std::string_view rest;

  explicit Words(std::string_view line) {
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    if (line.empty()) return;
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(line.front())));
    line.remove_prefix(1);
    int value = 0, digits = 0;
    while (!line.empty() && line.front() >= '0' && line.front() <= '9' && digits < 5) {
      value = value * 10 + (line.front() - '0');
      ++digits;
      line.remove_prefix(1);
    }
    if (digits > 0) number = value;
    rest = line;
  }
  std::optional<double> word(char wanted) const {
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (rest[i] == ';') break;
      if (std::toupper(static_cast<unsigned char>(rest[i])) != wanted) continue;
      const std::string text(rest.substr(i + 1, 24));
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      if (end != text.c_str() && std::isfinite(value)) return value;
    }
    return std::nullopt;
  }
};

template <typename... Values>
std::string print(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

Result<std::string, Refusal> reply(Result<void, Refusal> done) {
  if (!done) return Error<Refusal>(done.error());
  return std::string();
}

/// No "-0.000".
double tidy3(double value) {
  return std::abs(value) < 5e-4 ? 0.0 : value;
}
double tidy(double value) {
  return std::abs(value) < 5e-5 ? 0.0 : value;
}

std::string switches(const MachineStatus& s, const MachineDescription& machine) {
  std::string text = "Reporting endstop status";
  for (const JointDescription& joint : machine.joints) {
    if (!joint.homing || joint.homing->switch_input == 0) continue;
    for (const NodeStatus& node : s.nodes)
      if (node.id == joint.node_id)
        text += "\n" + joint.name + ": " +
                ((node.inputs >> (joint.homing->switch_input - 1)) & 1u ? "TRIGGERED" : "open");
  }
  return text;
}

/// "M203 X300.00 Y300.00", the axes' values in a line's units; those without a limit of their own left out.
std::string axis_values(const char* code, const Pose& values) {
  constexpr const char* kLetters = "XYZACE";
  std::string text = std::string("\necho:  ") + code;
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
    const double unit = axis == kA || axis == kC ? kDegrees : 1;
    if (values[axis] > 0 && std::isfinite(values[axis]))
      text += print(" %c%.2f", kLetters[axis], values[axis] * unit);
  }
  return text;
}

}  // namespace

/// In the coordinates of the lines: where those taken lead; else where the tool is. Hosts read X Y Z E up to
/// "Count".
std::string Gateway::Core::position_text() {
  const MachineStatus s = status();
  std::optional<Pose> where;
  if (const auto pose = machine_pose(); pose && !lines_open() && s.positions_known) where = *pose;
  Pose at = lines_.program_position(where);
  if (!s.positions_known) {
    at = s.pose;
    at[kA] *= kDegrees;
    at[kC] *= kDegrees;
  }
  std::string text = print("X:%.3f Y:%.3f Z:%.3f E:%.4f Count A:%.4f C:%.4f", tidy3(at[kX]), tidy3(at[kY]),
                           tidy3(at[kZ]), tidy(at[kE]), tidy(at[kA]), tidy(at[kC]));
  for (int joint = 0; joint < s.joint_count; ++joint)
    text += print(" %d:%.4f", joint + 1, s.joints[static_cast<std::size_t>(joint)]);
  return text + (s.positions_known ? "" : " (not homed)");
}

/// The machine's limits as the lines that would set them. They are the machine file's: nothing is stored.
std::string Gateway::Core::settings_text() const {
  const PathDescription& path = machine_.path;
  std::string text = "echo:; limits of the machine file; M500 to M502 change nothing\necho:  G21";
  text += axis_values("M203", path.axis_speed_per_s);
  text += axis_values("M201", path.axis_accel_per_s2);
  text += print("\necho:  M204 P%.2f R%.2f T%.2f", path.tool_accel_mm_per_s2, path.tool_accel_mm_per_s2,
                path.tool_accel_mm_per_s2);
  text += print("\necho:  M207 S%.2f F%.2f Z%.2f", machine_.gcode.retract_mm,
                machine_.gcode.retract_mm_per_s * 60, machine_.gcode.retract_lift_mm);
  text += print("\necho:  M220 S%.0f\necho:  M221 S%.0f", 100 * lines_.feed_ratio() * override_,
                100 * lines_.flow_ratio());
  for (std::size_t system = 0; system < lines_.work_offsets().size(); ++system) {
    const Pose& offset = lines_.work_offsets()[system];
    if (offset == Pose{}) continue;
    text += print("\necho:  G10 L2 P%d X%.3f Y%.3f Z%.3f A%.4f C%.4f", static_cast<int>(system) + 1,
                  offset[kX], offset[kY], offset[kZ], offset[kA] * kDegrees, offset[kC] * kDegrees);
    if (const double turn_rad = offset[gcode::kSystemTurn]; turn_rad != 0)
      text += print(" R%.4f", turn_rad * kDegrees);
  }
  return text;
}

/// The heights as hosts read them: rows from Y's least, columns from X's least; then what is kept.
std::string Gateway::Core::mesh_text() const {
  const MeshGrid* const mesh = bed_.in_force();
  std::string text = "echo:Bed Leveling ";
  text += mesh != nullptr ? "ON" : "OFF";
  if (mesh != nullptr) {
    text += print("\necho:Fade Height %.2f\n", mesh->fade_mm) + "Mesh " + bed_.name();
    text += print(": X %.3f to %.3f, Y %.3f to %.3f, %.3f to %.3f mm\nBilinear Leveling Grid:\n ",
                  mesh->from_mm[0], mesh->to_mm[0], mesh->from_mm[1], mesh->to_mm[1], mesh->lowest_mm(),
                  mesh->highest_mm());
    for (int column = 0; column < mesh->points[0]; ++column) text += print("%9d", column);
    for (int row = 0; row < mesh->points[1]; ++row) {
      text += print("\n%2d", row);
      for (int column = 0; column < mesh->points[0]; ++column)
        text += print(" %+8.3f", static_cast<double>(mesh->at_mm(column, row)));
    }
  }
  for (const journal::Mesh& kept : bed_.kept()) {
    const auto when = static_cast<std::time_t>(kept.unix_s);
    std::tm utc{};
    std::array<char, 32> date{};
    if (kept.unix_s > 0 && gmtime_r(&when, &utc) != nullptr)
      std::strftime(date.data(), date.size(), ", %Y-%m-%d %H:%M UTC", &utc);
    text += "\nkept: " + kept.name + print(", %d x %d points", kept.grid.points[0], kept.grid.points[1]) +
            date.data() + (bed_.fits(kept) ? "" : ", of another geometry: not used");
  }
  return text;
}

Result<std::string, Refusal> Gateway::Core::text_line(std::string_view line) {
  const Words words(line);
  const auto index = [&](char letter) {
    return static_cast<std::uint8_t>(std::clamp(words.word(letter).value_or(0), 0.0, 255.0));
  };
  const auto temperature = [&](HeaterKind kind, char letter) -> Result<std::string, Refusal> {
    const auto celsius = words.word('S');
    if (!celsius) return Error<Refusal>(Refusal{say("a temperature needs S")});
    return reply(carry_out(command::SetTemperature{{kind, index(letter)}, *celsius}));
  };
  if (words.letter == 0 || words.letter == ';') return std::string();
  if (words.letter == 'G' && words.number == 28)
    return reply(state_.is(MachineState::kReady) ? carry_out(command::GoToReference{})
                                                 : carry_out(command::Home{}));
  if (words.letter == 'M') {
    switch (words.number) {
      case 17:
        return reply(carry_out(command::BringUp{}));
      case 18:
      case 84:
        return reply(carry_out(command::MotorsOff{}));
      case 24:
        return reply(carry_out(command::Resume{}));
      case 25:
        return reply(carry_out(command::Hold{}));
      case 27: {
        const MachineStatus s = status();
        if (s.job.empty()) return std::string("Not SD printing");
        return print("SD printing line %u, %.1f %%", static_cast<unsigned>(s.line), 100 * s.progress);
      }
      case 104:
        return temperature(HeaterKind::kHotend, 'T');
      case 140:
        return temperature(HeaterKind::kBed, 'P');
      case 141:
        return temperature(HeaterKind::kChamber, 'P');
      case 105:
        return temperature_text(status());
      case 106:
        return reply(carry_out(
            command::SetFan{std::clamp(words.word('S').value_or(255) / 255, 0.0, 1.0), index('P')}));
      case 107:
        return reply(carry_out(command::SetFan{0, index('P')}));
      case 112:
        return reply(carry_out(command::Stop{.why = say("M112 of the session"), .heaters_off = true}));
      case 410:
        return reply(carry_out(command::Stop{.why = say("stop by the session")}));
      case 114:
        return position_text();
      case 115:
        return "FIRMWARE_NAME:Kinebus PROTOCOL_VERSION:1.0 MACHINE_TYPE:" + machine_.name +
               " EXTRUDER_COUNT:" + std::to_string(machine_.tools());
      case 119:
        return switches(status(), machine_);
      case 220:
        if (!words.word('S')) return print("FR:%.0f%%", 100 * lines_.feed_ratio() * override_);
        return reply(carry_out(command::SetFeedOverride{*words.word('S') / 100}));
      case 221:
        return print("echo:E0 Flow: %.0f%%", 100 * lines_.flow_ratio());
      case 420:
        // With S or Z it is a line like others.
        if (words.word('S') || words.word('Z')) break;
        return mesh_text();
      case 503:
        return settings_text();
      case 524:
        return reply(carry_out(command::Cancel{}));
      case 303:
        return measure_heater(words.rest);
      case 906:
        return set_currents(words.rest);
      case 956:
        return vibration(words.word('S'));
      case 999:
        return reply(carry_out(command::Clear{}));
      default:
        break;
    }
  }
  return Error<Refusal>(
      Refusal{say("not a command of a session: %1; send motion as a job", cut_text(line, 60))});
}

}  // namespace kinebus
