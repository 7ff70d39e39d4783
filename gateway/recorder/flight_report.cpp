#include "gateway/recorder/flight_report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "gateway/status/alarm.hpp"
#include "gateway/status/event.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/emcy.hpp"

namespace kinebus {
namespace {

constexpr std::int64_t kKept_ns = 60'000'000'000;

CanFrame frame_of(const FlightRing::Frame& row) {
  CanFrame frame{.id = row.id, .length = std::min<std::uint8_t>(row.length, 8)};
  frame.extended = (row.flags & 1) != 0;
  frame.remote = (row.flags & 2) != 0;
  frame.data = row.data;
  return frame;
}

std::int64_t newest(const FlightRing& ring) {
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  const auto look = [&](const auto& row) { last = std::max(last, row.when_ns); };
  FlightRing::each(ring.frames, ring.frame_count, look);
  FlightRing::each(ring.samples, ring.sample_count, look);
  FlightRing::each(ring.events, ring.event_count, look);
  return last;
}

void add_text(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) out += c;
  }
  out += '"';
}

void add_number(std::string& out, double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", std::isfinite(value) ? value : 0.0);
  out += text;
}

/// One object of a JSON list, field by field.
class Object {
 public:
  explicit Object(std::string& out, bool first) : out_(out) { out_ += first ? "\n    {" : ",\n    {"; }
  ~Object() { out_ += '}'; }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  void number(std::string_view key, double value) {
    begin(key);
    add_number(out_, value);
  }
  void text(std::string_view key, std::string_view value) {
    begin(key);
    add_text(out_, value);
  }
  template <typename Values>
  void list(std::string_view key, const Values& values, std::size_t count) {
    begin(key);
    out_ += '[';
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) out_ += ", ";
      add_number(out_, values[i]);
    }
    out_ += ']';
  }

 private:
  void begin(std::string_view key) {
    if (!first_) out_ += ", ";
    first_ = false;
    add_text(out_, key);
    out_ += ": ";
  }
  std::string& out_;
  bool first_ = true;
};

constexpr std::string_view kKinds[] = {"state", "alarm", "message", "problem", "finished"};

void add_event(std::string& out, bool first, const FlightRing::Event& row, double s) {
  Object object(out, first);
  object.number("s", s);
  object.text("kind", row.kind < std::size(kKinds) ? kKinds[row.kind] : "other");
  if (row.code != 0) object.number("code", row.code);
  if (row.node != 0) object.number("node", row.node);
  if (row.line != 0) object.number("line", row.line);
  object.text("words", FlightRing::get(row.words));
  if (row.advice[0] != 0) object.text("advice", FlightRing::get(row.advice));
}

void add_sample(std::string& out, bool first, const FlightRing::Sample& row, double s) {
  Object object(out, first);
  object.number("s", s);
  object.text("state", row.state < kMachineStates ? to_string(static_cast<MachineState>(row.state)) : "?");
  object.number("path_time_s", row.path_time_s);
  object.number("rate", row.rate);
  object.number("line", row.line);
  object.number("progress", row.progress);
  object.number("sync_error_us", row.sync_error_us);
  object.number("positions_known", row.positions_known);
  object.list("joints", row.joints, std::min<std::size_t>(row.joint_count, FlightRing::kJoints));
  object.list("measured", row.measured, std::min<std::size_t>(row.joint_count, FlightRing::kJoints));
  object.list("pose", row.pose, row.pose.size());
}

}  // namespace

std::string flight_log(const FlightRing& ring, std::string_view interface) {
  std::string out;
  const std::int64_t from = newest(ring) - kKept_ns;
  FlightRing::each(ring.frames, ring.frame_count, [&](const FlightRing::Frame& row) {
    if (row.when_ns < from) return;
    const std::chrono::microseconds time{(row.when_ns + ring.unix_offset_ns) / 1000};
    out += to_candump({time, interface, frame_of(row)}).view();
    out += '\n';
  });
  return out;
}

std::string flight_json(const FlightRing& ring, std::string_view cause, std::string_view log_name) {
  const std::int64_t end = newest(ring), from = end - kKept_ns;
  const auto before_end = [&](std::int64_t when_ns) { return static_cast<double>(when_ns - end) * 1e-9; };
  std::string out = "{\n  \"machine\": ";
  add_text(out, FlightRing::get(ring.machine));
  out += ",\n  \"job\": ";
  add_text(out, FlightRing::get(ring.job));
  out += ",\n  \"cause\": ";
  add_text(out, cause);
  out += ",\n  \"frames\": ";
  add_text(out, log_name);
  out += ",\n  \"end_unix_s\": ";
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", static_cast<double>(end + ring.unix_offset_ns) * 1e-9);
  out += text;

  out += ",\n  \"events\": [";
  bool first = true;
  FlightRing::each(ring.events, ring.event_count, [&](const FlightRing::Event& row) {
    if (row.when_ns < from) return;
    add_event(out, first, row, before_end(row.when_ns));
    first = false;
  });
  out += "\n  ],\n  \"emergencies\": [";
  first = true;
  FlightRing::each(ring.frames, ring.frame_count, [&](const FlightRing::Frame& row) {
    if (row.when_ns < from) return;
    const auto emergency = decode_emcy(frame_of(row));
    if (!emergency || emergency->code == 0) return;
    const AlarmText words = describe_emergency(*emergency);
    Object object(out, first);
    first = false;
    object.number("s", before_end(row.when_ns));
    object.number("node", emergency->node);
    object.number("code", emergency->code);
    object.number("stops", (emergency->vendor[0] & 0x7F) != 0 ? 1 : 0);
    object.text("words", words.words);
    object.text("advice", words.advice);
  });
  out += "\n  ],\n  \"samples\": [";
  first = true;
  FlightRing::each(ring.samples, ring.sample_count, [&](const FlightRing::Sample& row) {
    if (row.when_ns < from) return;
    add_sample(out, first, row, before_end(row.when_ns));
    first = false;
  });
  out += "\n  ]\n}\n";
  return out;
}

}  // namespace kinebus
