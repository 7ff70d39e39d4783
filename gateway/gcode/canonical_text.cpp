#include "gateway/gcode/canonical_text.hpp"

#include <array>
#include <cstdio>
#include <numbers>
#include <string_view>

namespace kinebus::canonical {
namespace {

constexpr double kDegreesPerRad = 180 / std::numbers::pi;
constexpr std::array<char, 6> kAxisLetters = {'x', 'y', 'z', 'a', 'c', 'e'};

std::string number(double value) {
  std::array<char, 40> text{};
  // Rounding residue such as cos(90 deg) is 0 to a reader; + 0.0 turns -0 into 0.
  const double shown = value > -5e-10 && value < 5e-10 ? 0.0 : value + 0.0;
  std::snprintf(text.data(), text.size(), "%.9g", shown);
  return text.data();
}

std::string_view frame_name(Frame frame) {
  return frame == Frame::kPart ? "part" : "machine";
}

std::string pose_text(const Pose& pose, Frame frame) {
  std::string text(frame_name(frame));
  for (std::size_t axis = 0; axis < pose.size(); ++axis) {
    text += ' ';
    text += kAxisLetters[axis];
    text += number(axis == 3 || axis == 4 ? pose[axis] * kDegreesPerRad : pose[axis]);
  }
  return text;
}

std::string feed_text(double feed_per_s, double inverse_time_s) {
  return inverse_time_s > 0 ? " time" + number(inverse_time_s) : " f" + number(feed_per_s);
}

std::string vector_text(const std::array<double, 3>& v) {
  return number(v[0]) + "," + number(v[1]) + "," + number(v[2]);
}

std::string axes_text(std::uint8_t axes) {
  if (axes == 0) return "all";
  std::string text;
  for (std::size_t axis = 0; axis < kAxisLetters.size(); ++axis)
    if ((axes >> axis & 1U) != 0) text += kAxisLetters[axis];
  return text;
}

void append_limits(std::string& text, std::string_view name, const std::array<double, 6>& values) {
  for (std::size_t axis = 0; axis < values.size(); ++axis) {
    if (values[axis] == 0) continue;
    text += ' ';
    text += name;
    text += '_';
    text += kAxisLetters[axis];
    text += number(axis == 3 || axis == 4 ? values[axis] * kDegreesPerRad : values[axis]);
  }
}

struct Writer {
  std::string operator()(const Traverse& c) const {
    return "traverse " + pose_text(c.target, c.frame) +
           (c.speed_per_s > 0 ? feed_text(c.speed_per_s, 0) : "");
  }
  std::string operator()(const Feed& c) const {
    return "feed " + pose_text(c.target, c.frame) + feed_text(c.feed_per_s, c.inverse_time_s);
  }
  std::string operator()(const Arc& c) const {
    return "arc " + pose_text(c.target, c.frame) + " centre" + vector_text(c.centre_mm) + " normal" +
           vector_text(c.normal) + " sweep" + number(c.sweep_rad * kDegreesPerRad) +
           feed_text(c.feed_per_s, c.inverse_time_s);
  }
  std::string operator()(const Dwell& c) const { return "dwell " + number(c.seconds); }
  std::string operator()(const PathMode& c) const {
    if (c.exact) return "path exact";
    return "path blend tolerance" + number(c.tolerance_mm) + " merge" +
           (c.merge ? number(c.merge_tolerance_mm) : " off");
  }
  std::string operator()(const SetPosition& c) const { return "position " + pose_text(c.pose, c.frame); }
  std::string operator()(const Limits& c) const {
    std::string text = "limits";
    append_limits(text, "speed", c.axis_speed_per_s);
    append_limits(text, "accel", c.axis_accel_per_s2);
    if (c.print_accel_mm_per_s2 != 0) text += " print" + number(c.print_accel_mm_per_s2);
    if (c.travel_accel_mm_per_s2 != 0) text += " travel" + number(c.travel_accel_mm_per_s2);
    if (c.retract_accel_mm_per_s2 != 0) text += " retract" + number(c.retract_accel_mm_per_s2);
    return text;
  }
  std::string operator()(const Thermal& c) const {
    static constexpr std::array<std::string_view, 5> kNames = {"hotend", "bed", "fan", "chamber", "output"};
    std::string text(kNames[static_cast<std::size_t>(c.what)]);
    text += std::to_string(c.index) + " " + number(c.value);
    if (c.wait) text += c.wait_cooling ? " wait_both" : " wait";
    return text;
  }
  std::string operator()(const Tool& c) const { return "tool " + std::to_string(c.hotend); }
  std::string operator()(const Spindle& c) const { return "spindle " + number(c.rpm); }
  std::string operator()(const SpindleSync& c) const {
    if (!(c.rpm > 0)) return "sync off";
    const std::string text = "sync " + number(c.rpm) + feed_text(c.feed_per_s, 0);
    return c.turns_back_mm > 0 ? text + " back " + number(c.turns_back_mm) : text;
  }
  std::string operator()(const FeedPerTurn& c) const {
    return c.rpm > 0 ? "per_turn " + number(c.rpm) : "per_turn off";
  }
  std::string operator()(const ProbePin& c) const {
    static constexpr std::array<std::string_view, 4> kNames = {"out", "in", "self_test", "reset"};
    return std::string("probe_pin ").append(kNames[static_cast<std::size_t>(c.what)]);
  }
  std::string operator()(const AwaitInput& c) const {
    static constexpr std::array<std::string_view, 5> kNames = {"read", "rises", "falls", "on", "off"};
    std::string text = "input" + std::to_string(c.index) + " ";
    text += kNames[static_cast<std::size_t>(c.until)];
    if (c.until != AwaitInput::Until::kNow) text += " within" + number(c.seconds);
    return text;
  }
  std::string operator()(const Home& c) const {
    return "home " + axes_text(c.axes) + " to " + pose_text(c.afterwards, c.frame);
  }
  std::string operator()(const Pause& c) const { return c.optional ? "pause optional" : "pause"; }
  std::string operator()(const MotorsOff& c) const { return "motors_off " + axes_text(c.axes); }
  std::string operator()(const MotorsOn&) const { return "motors_on"; }
  std::string operator()(const WaitIdle&) const { return "wait_idle"; }
  std::string operator()(const Override& c) const {
    std::string text = "override";
    if (c.feed != 0) text += " feed" + number(c.feed);
    if (c.flow != 0) text += " flow" + number(c.flow);
    return text;
  }
  std::string operator()(const Message& c) const { return "message " + c.text; }
  std::string operator()(const Query& c) const {
    static constexpr std::array<std::string_view, 5> kNames = {"position", "firmware", "switches",
                                                               "temperature", "settings"};
    return std::string("query ").append(kNames[static_cast<std::size_t>(c.what)]);
  }
  std::string operator()(const EmergencyStop&) const { return "emergency_stop"; }
  std::string operator()(const StoredJob& c) const {
    static constexpr std::array<std::string_view, 12> kNames = {
        "list",         "init",   "release",     "select",    "start",  "pause",
        "set_position", "status", "begin_write", "end_write", "delete", "run"};
    std::string text("stored_job ");
    text += kNames[static_cast<std::size_t>(c.what)];
    if (c.what == StoredJob::What::kSetPosition) text.append(" ").append(std::to_string(c.position));
    if (!c.name.empty()) text.append(" ").append(c.name);
    return text;
  }
  std::string operator()(const Settings& c) const {
    static constexpr std::array<std::string_view, 4> kNames = {"store", "load", "reset", "report"};
    return std::string("settings ").append(kNames[static_cast<std::size_t>(c.what)]);
  }
  std::string operator()(const End&) const { return "end"; }
  std::string operator()(const PressureAdvance& c) const {
    std::string text = "pressure_advance";
    if (c.advance_s >= 0) text += " k" + number(c.advance_s);
    if (c.smooth_s >= 0) text += " smooth" + number(c.smooth_s);
    return text;
  }
  std::string operator()(const InputShaping& c) const {
    static constexpr std::array<std::string_view, 9> kNames = {"none",  "zv",    "mzv",  "zvd",  "ei",
                                                               "2hump", "3hump", "zvdd", "zvddd"};
    std::string text = "input_shaping";
    for (std::size_t i = 0; i < c.axes.size(); ++i) {
      const InputShaping::Axis& axis = c.axes[i];
      if (!axis.asks()) continue;
      (text += ' ') += "xyz"[i];
      if (axis.shaper) text.append(" ").append(kNames[static_cast<std::size_t>(*axis.shaper)]);
      if (axis.frequency_hz >= 0) text += " f" + number(axis.frequency_hz);
      if (axis.damping_ratio >= 0) text += " d" + number(axis.damping_ratio);
    }
    return text;
  }
  std::string operator()(const Probe& c) const {
    return "probe " + pose_text(c.target, c.frame) + feed_text(c.feed_per_s, 0) + (c.away ? " away" : "") +
           (c.must ? " must" : "");
  }
  std::string operator()(const Mesh& c) const {
    static constexpr std::array<std::string_view, 10> kNames = {
        "begin", "end", "on", "off", "keep", "forget", "fade", "point", "tell", "tell_probe"};
    std::string text = "mesh ";
    text += kNames[static_cast<std::size_t>(c.what)];
    if (!c.name.empty()) text += " " + c.name;
    if (c.what == Mesh::What::kBegin || c.what == Mesh::What::kEnd || c.what == Mesh::What::kPoint)
      text += " " + std::to_string(c.points[0]) + "," + std::to_string(c.points[1]);
    if (c.what == Mesh::What::kBegin || c.what == Mesh::What::kEnd)
      text += " x" + number(c.from_mm[0]) + ".." + number(c.to_mm[0]) + " y" + number(c.from_mm[1]) + ".." +
              number(c.to_mm[1]);
    if (c.what == Mesh::What::kPoint) text += (c.adds ? " add" : " z") + number(c.value_mm);
    if (c.fade_mm >= 0) text += " fade" + number(c.fade_mm);
    return text;
  }
};

}  // namespace

std::string to_text(const Line& line) {
  return std::to_string(line.line) + " " + std::visit(Writer{}, line.command);
}

}  // namespace kinebus::canonical
