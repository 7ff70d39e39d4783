#include "tools/cli/status_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "tools/cli/encoder_rows.hpp"
#include "tools/cli/job_watch.hpp"
#include "tools/cli/message_json.hpp"

namespace kinebus {
namespace {

using joblink::Status;
using Options = std::shared_ptr<MachineOptions>;
constexpr double kRadians = 0.017453292519943295;

std::string pose_words(const joblink::Pose& pose) {
  // Rounded first: a coordinate of -1e-9 is shown as 0.000, not as -0.000.
  const auto tidy = [](double value) { return std::round(value * 1000) / 1000 + 0.0; };
  return fmt::format("X {:.3f}  Y {:.3f}  Z {:.3f} mm   A {:.3f}  C {:.3f} deg   E {:.3f} mm",
                     tidy(pose.x_mm()), tidy(pose.y_mm()), tidy(pose.z_mm()), tidy(pose.a_rad() / kRadians),
                     tidy(pose.c_rad() / kRadians), tidy(pose.e_mm()));
}

bool measures(const joblink::HeaterTuning& tuning) {
  return tuning.stage() != joblink::TUNING_NONE && tuning.stage() != joblink::TUNING_DONE &&
         tuning.stage() != joblink::TUNING_FAILED;
}

void print_devices(const Status& s) {
  std::string words;
  for (const joblink::Heater& heater : s.heaters())
    words += measures(heater.tuning())
                 ? fmt::format("{} {:.1f} C, measured now   ", heater.name(), heater.actual_celsius())
                 : fmt::format("{} {:.1f} / {:.0f} C{}   ", heater.name(), heater.actual_celsius(),
                               heater.target_celsius(),
                               heater.has_measured() && !heater.measured() ? " (never measured)" : "");
  for (const joblink::Output& fan : s.fans())
    words += fmt::format("fan {} {:.0f} %   ", fan.name(), 100 * fan.ratio());
  for (const joblink::Output& output : s.outputs())
    words += fmt::format("{} {:.0f} %   ", output.name(), 100 * output.ratio());
  for (const joblink::Input& input : s.inputs())
    words += fmt::format("input {} {}   ", input.name(),
                         !input.has_on() ? "unknown"
                         : input.on()    ? "on"
                                         : "off");
  for (const joblink::Sensor& sensor : s.sensors())
    words += fmt::format("{} {:.1f} C   ", sensor.name(), sensor.celsius());
  constexpr std::array kConditions{"in order", "out", "stands", "slips"};
  for (const joblink::FilamentSensor& filament : s.filament_sensors())
    words += fmt::format(
        "filament {} {}   ", filament.name(),
        kConditions[std::min(static_cast<std::size_t>(filament.condition()), kConditions.size() - 1)]);
  if (s.has_probe_touches()) words += s.probe_touches() ? "probe touches   " : "probe free   ";
  constexpr std::array kPins{"", "moves", "in", "out", "not where it should be", "tests itself"};
  if (const auto pin = static_cast<std::size_t>(s.probe_pin()); pin > 0 && pin < kPins.size())
    words += fmt::format("pin {}   ", kPins[pin]);
  if (words.empty()) return;
  words.resize(words.find_last_not_of(' ') + 1);
  fmt::print("devices   {}\n", words);
}

void print_status(const Status& s) {
  fmt::print("{}: {}\n", s.state_words(), s.doing());
  if (s.positions_known())
    fmt::print("tool      {}\n", pose_words(s.tool()));
  else
    fmt::print("tool      position unknown: home first\n");
  if (!s.job().empty())
    fmt::print("job       {}  line {}  {:.1f} %  {} to go\n", s.job(), s.line(), 100 * s.progress(),
               time_words(s.remaining_s()));
  if (s.interrupted())
    fmt::print("          interrupted: 'kinebus resume' goes on from its place, 'kinebus cancel' drops it\n");
  print_devices(s);
  if (s.spindle_rpm() != 0 || s.spindle_target_rpm() != 0)
    fmt::print("spindle   {:.0f} / {:.0f} rpm\n", s.spindle_rpm(), s.spindle_target_rpm());
  fmt::print("path      rate {:.2f}   override {:.0f} %   bus {:.1f} % (peak {:.1f} %)\n", s.rate(),
             100 * s.feed_override(), 100 * s.bus_load(), 100 * s.bus_load_peak());
}

/// What the linear scales say, axis by axis; `s`: at rest, else they say nothing.
void print_scales(const Status& s, const joblink::MachineInfo& machine) {
  for (int i = 0; i < std::min(machine.joints_size(), s.joints_size()); ++i)
    if (const joblink::AxisStatus* axis = axis_of(s, machine.joints(i));
        axis != nullptr && axis->has_by_scale_mm())
      fmt::print("{:9} {:.4f}, by its scale {:.4f} ({:+.4f})\n", machine.joints(i).name(), s.joints(i),
                 axis->by_scale_mm(), axis->by_scale_mm() - s.joints(i));
}

void print_position(const Status& s) {
  fmt::print("part      {}\n", pose_words(s.tool()));
  fmt::print("machine   {}\n", pose_words(s.machine()));
  fmt::print("joints   ");
  for (const double joint : s.joints()) fmt::print(" {:.4f}", joint);
  fmt::print("\n");
  // What the encoders say, axis by axis.
  for (const joblink::NodeStatus& node : s.nodes())
    for (int axis = 0; axis < node.axes_size(); ++axis)
      if (node.axes(axis).has_off_course())
        fmt::print("node {} {}  measured {:+.4f} from its command\n", node.id(), axis == 0 ? "A" : "B",
                   -node.axes(axis).off_course());
}

void print_nodes(const Status& s) {
  fmt::print("node  present  nmt  statusword A/B  queue  sync error  records sent  EMCY\n");
  for (const joblink::NodeStatus& n : s.nodes())
    fmt::print("{:4}  {:7}  {:3}     {:04X} / {:04X}  {:5}  {:7.0f} us  {:12}  {:4}\n", n.id(),
               n.present() ? "yes" : "no", n.nmt_state(), n.axes_size() > 0 ? n.axes(0).statusword() : 0,
               n.axes_size() > 1 ? n.axes(1).statusword() : 0, n.queue_records(), n.sync_error_s() * 1e6,
               n.records_sent(), n.emergencies());
  for (const joblink::NodeStatus& n : s.nodes())
    for (int axis = 0; axis < n.axes_size(); ++axis) {
      const joblink::AxisStatus& a = n.axes(axis);
      const std::string measured = a.has_current_a() ? fmt::format("{:.2f}", a.current_a()) : "-";
      fmt::print("node {} {}  current {} A measured, {:.2f} A configured\n", n.id(), axis == 0 ? "A" : "B",
                 measured, a.configured_current_a());
    }
}

void print_bus(const Status& s) {
  fmt::print("load {:.2f} % in the last second, peak {:.2f} %\n", 100 * s.bus_load(),
             100 * s.bus_load_peak());
  const joblink::Counters& counters = s.counters();
  const auto& values = *counters.GetReflection();
  for (int i = 0; i < counters.GetDescriptor()->field_count(); ++i) {
    const auto& field = *counters.GetDescriptor()->field(i);
    const bool wide = field.cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_UINT64;
    fmt::print("{:20} {}\n", field.name(),
               wide ? values.GetUInt64(counters, &field) : values.GetUInt32(counters, &field));
  }
}

void print_clients(const Status& s) {
  for (const joblink::ClientInfo& client : s.clients())
    fmt::print("{:4}  {}  {:20} {}\n", client.id(), client.id() == s.controller() ? "control" : "watches",
               client.transport(), client.name());
}

/// `fields`: of the status, what the view is about; none: all of them.
void add_view(CLI::App& app, const Options& options, const std::string& name, const std::string& help,
              void (*print)(const Status&), const std::vector<std::string>& fields = {}) {
  app.add_subcommand(name, help)->callback([=] {
    Client client(options->reach);
    const Status status = print == print_nodes ? with_currents(client) : client.status();
    if (options->json) return fmt::print("{}", to_json_text(status, fields));
    print(status);
    if (print != print_status && print != print_position) return;
    joblink::ClientMessage ask_machine;
    ask_machine.mutable_get_machine();
    print_scales(status, client.ask(std::move(ask_machine)).machine());
  });
}

}  // namespace

Status with_currents(Client& client) {
  const auto all_read = [](const Status& s) {
    for (const joblink::NodeStatus& n : s.nodes())
      for (const joblink::AxisStatus& a : n.axes())
        if (a.enabled() && !a.has_current_a()) return false;
    return true;
  };
  Status status = client.status();
  for (int i = 0; i < 10 && !all_read(status); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{150});
    status = client.status();
  }
  return status;
}

void add_views(CLI::App& app, const Options& options) {
  add_view(app, options, "status", "What the machine does now", print_status);
  add_view(app, options, "position", "Tool and joint positions", print_position,
           {"positions_known", "tool", "machine", "joints", "nodes"});
  add_view(app, options, "nodes", "The nodes on the bus", print_nodes, {"nodes"});
  add_view(app, options, "bus", "Bus load and everything that was counted", print_bus,
           {"bus_load", "bus_load_peak", "counters"});
  add_view(app, options, "clients", "Who is connected, and who has control", print_clients,
           {"clients", "controller"});
}

}  // namespace kinebus
