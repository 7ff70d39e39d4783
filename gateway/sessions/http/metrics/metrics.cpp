#include "gateway/sessions/http/metrics/metrics.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/routes.hpp"
#include "gateway/sessions/http/wire/exposition.hpp"

namespace kinebus::http {
namespace {

using joblink::MachineInfo;
using joblink::NodeStatus;
using joblink::Status;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// NMT's "operational" (CiA 301, table 39).
constexpr std::uint32_t kOperational = 5;

/// "STATE_BRING_UP" is "bring_up".
template <typename Names>
std::string word_of(int value, std::string_view prefix, Names name) {
  std::string word = name(value).substr(prefix.size());
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

double number(bool yes) {
  return yes ? 1 : 0;
}

void machine(Exposition& out, const Status& s, const MachineInfo& info, const std::string& version) {
  out.gauge("kinebus_info", "Always 1; what runs, and which machine it drives")
      .sample(1, {{"version", version},
                  {"machine", info.name()},
                  {"kinematics", info.kinematics()},
                  {"bus", info.bus()}});
  out.gauge("kinebus_state", "1 for the state that the machine is in, 0 for all others");
  for (int state = joblink::State_MIN; state <= joblink::State_MAX; ++state)
    out.sample(number(state == s.state()), {{"state", word_of(state, "STATE_", [](int n) {
                                               return joblink::State_Name(static_cast<joblink::State>(n));
                                             })}});
  out.gauge("kinebus_at_rest", "1: nothing moves and nothing will by itself").sample(number(s.at_rest()));
  out.gauge("kinebus_positions_known", "1: the machine knows where its joints are")
      .sample(number(s.positions_known()));
  out.gauge("kinebus_rate_ratio", "Path time by time: 1 is as planned, 0 stands").sample(s.rate());
  out.gauge("kinebus_feed_override_ratio", "What the operator has set, 1 is as programmed")
      .sample(s.feed_override());
  out.gauge("kinebus_spindle_hertz", "Turns a second, clockwise above 0").sample(s.spindle_rpm() / 60);
  out.gauge("kinebus_tool_position_meters", "Tool along the machine's axes; absent while it is not known");
  if (s.positions_known())
    for (const auto& [axis, mm] : {std::pair("x", s.machine().x_mm()), std::pair("y", s.machine().y_mm()),
                                   std::pair("z", s.machine().z_mm())})
      out.sample(mm / 1e3, {{"axis", axis}});
  out.gauge("kinebus_clients", "Who is connected to the gateway").sample(s.clients_size());
  out.gauge("kinebus_controlled", "1: a client has control").sample(number(s.controller() != 0));
}

void job(Exposition& out, const Status& s) {
  const bool there = job_is_there(s);
  out.gauge("kinebus_job", "1 while a job is under way or waits to be gone on with")
      .sample(number(there), {{"job", s.job()}});
  out.gauge("kinebus_job_interrupted", "1: it waits for resume or cancel").sample(number(s.interrupted()));
  out.gauge("kinebus_job_progress_ratio", "Of the job's time; absent without a job")
      .sample(there ? s.progress() : kUnknown);
  out.gauge("kinebus_job_elapsed_seconds", "Since it began").sample(there ? s.elapsed_s() : kUnknown);
  out.gauge("kinebus_job_remaining_seconds", "At the present override")
      .sample(there ? s.remaining_s() : kUnknown);
  out.gauge("kinebus_job_line", "Of its text, now").sample(there ? s.line() : kUnknown);
}

void store(Exposition& out, const MetricsBeside& beside) {
  static constexpr std::array kResults{
      std::pair(RunResult::kRunning, "running"),     std::pair(RunResult::kComplete, "complete"),
      std::pair(RunResult::kCancelled, "cancelled"), std::pair(RunResult::kRefused, "refused"),
      std::pair(RunResult::kFailed, "failed"),       std::pair(RunResult::kInterrupted, "interrupted")};
  out.counter("kinebus_runs_begun_total", "Jobs begun since the store was made")
      .sample(static_cast<double>(beside.runs.begun));
  out.gauge("kinebus_runs", "Jobs of the history (the last 10,000) by how they ended");
  for (const auto& [result, word] : kResults)
    out.sample(static_cast<double>(beside.runs.of(result).count), {{"result", word}});
  out.gauge("kinebus_runs_seconds", "Their time together");
  for (const auto& [result, word] : kResults)
    out.sample(beside.runs.of(result).duration_s, {{"result", word}});
  out.gauge("kinebus_store_used_bytes", "Of stored jobs")
      .sample(static_cast<double>(beside.listing.used_bytes));
  out.gauge("kinebus_store_quota_bytes", "What they may take")
      .sample(static_cast<double>(beside.listing.quota_bytes));
  out.gauge("kinebus_store_free_bytes", "Of the disk").sample(static_cast<double>(beside.listing.free_bytes));
}

void heat(Exposition& out, const Status& s) {
  out.gauge("kinebus_heater_celsius", "Measured");
  for (const auto& h : s.heaters()) out.sample(h.actual_celsius(), {{"heater", h.name()}});
  out.gauge("kinebus_heater_target_celsius", "0: off");
  for (const auto& h : s.heaters()) out.sample(h.target_celsius(), {{"heater", h.name()}});
  out.gauge("kinebus_heater_power_ratio",
            "Of full power at the nominal supply; absent: its node does not tell");
  for (const auto& h : s.heaters()) out.sample(h.has_power() ? h.power() : kUnknown, {{"heater", h.name()}});
  out.gauge("kinebus_sensor_celsius", "Sensors that no heater has");
  for (const auto& sensor : s.sensors()) out.sample(sensor.celsius(), {{"sensor", sensor.name()}});
  out.gauge("kinebus_fan_ratio", "As commanded");
  for (const auto& fan : s.fans()) out.sample(fan.ratio(), {{"fan", fan.name()}});
  out.gauge("kinebus_output_ratio", "As commanded");
  for (const auto& output : s.outputs()) out.sample(output.ratio(), {{"output", output.name()}});
  out.gauge("kinebus_filament_in_order", "0: it is out, stands or slips");
  for (const auto& sensor : s.filament_sensors())
    out.sample(number(sensor.condition() == joblink::FILAMENT_IN_ORDER), {{"sensor", sensor.name()}});
}

void bus(Exposition& out, const Status& s) {
  const joblink::Counters& c = s.counters();
  out.gauge("kinebus_bus_load_ratio", "Share of the bus in the last second").sample(s.bus_load());
  out.gauge("kinebus_bus_load_peak_ratio", "The busiest second so far").sample(s.bus_load_peak());
  out.counter("kinebus_frames_sent_total", "CAN frames").sample(static_cast<double>(c.frames_sent()));
  out.counter("kinebus_frames_received_total", "CAN frames").sample(static_cast<double>(c.frames_received()));
  out.counter("kinebus_segments_sent_total", "Records of motion")
      .sample(static_cast<double>(c.segments_sent()));
  out.counter("kinebus_malformed_frames_total", "Frames that are not what their identifier says")
      .sample(c.malformed_frames());
  out.counter("kinebus_foreign_frames_total", "Frames of nobody that the machine file knows")
      .sample(c.foreign_frames());
  out.counter("kinebus_sequence_errors_total", "Records that a node missed").sample(c.sequence_errors());
  out.counter("kinebus_underruns_total", "Nodes that ran out of records in motion").sample(c.underruns());
  out.counter("kinebus_checkpoint_errors_total", "Nodes that were not where the gateway had them")
      .sample(c.checkpoint_errors());
  out.counter("kinebus_sdo_aborts_total", "Requests that a node refused").sample(c.sdo_aborts());
  out.counter("kinebus_sdo_timeouts_total", "Requests that a node did not answer").sample(c.sdo_timeouts());
  out.counter("kinebus_bus_slowdowns_total", "Times the path was slowed for the bus")
      .sample(c.bus_slowdowns());
  out.counter("kinebus_starvation_holds_total", "Times the motion waited for the planner")
      .sample(c.starvation_holds());
}

/// One family of samples, one a node.
template <typename Value>
void of_nodes(Exposition& out, const Status& s, Value value) {
  for (const NodeStatus& node : s.nodes()) out.sample(value(node), {{"node", std::to_string(node.id())}});
}

void nodes(Exposition& out, const Status& s) {
  out.gauge("kinebus_node_present", "1: it is heard");
  of_nodes(out, s, [](const NodeStatus& n) { return number(n.present()); });
  out.gauge("kinebus_node_operational", "1: NMT operational");
  of_nodes(out, s, [](const NodeStatus& n) { return number(n.nmt_state() == kOperational); });
  out.gauge("kinebus_node_synchronised", "1: its clock follows the gateway's");
  of_nodes(out, s, [](const NodeStatus& n) { return number(n.synchronised()); });
  out.gauge("kinebus_node_clock_error_seconds", "Bound of the error of its clock's estimate");
  of_nodes(out, s, [](const NodeStatus& n) { return n.synchronised() ? n.sync_error_s() : kUnknown; });
  out.gauge("kinebus_node_queue_ratio", "Records that wait in it, of its room");
  of_nodes(out, s, [](const NodeStatus& n) {
    return n.queue_capacity() == 0 ? kUnknown : static_cast<double>(n.queue_records()) / n.queue_capacity();
  });
  out.gauge("kinebus_node_stopped", "1: it has stopped on the path");
  of_nodes(out, s, [](const NodeStatus& n) { return number(n.stopped()); });
  out.counter("kinebus_node_emergencies_total", "EMCY messages of it");
  of_nodes(out, s, [](const NodeStatus& n) { return static_cast<double>(n.emergencies()); });
}

/// One family of samples, one an axis of a node: A, B, as the machine file counts them.
template <typename Value>
void of_axes(Exposition& out, const Status& s, Value value) {
  for (const NodeStatus& node : s.nodes())
    for (int axis = 0; axis < node.axes_size(); ++axis)
      out.sample(value(node.axes(axis)), {{"node", std::to_string(node.id())},
                                          {"axis", std::string(1, static_cast<char>('A' + axis))}});
}

void axes(Exposition& out, const Status& s) {
  using joblink::AxisStatus;
  out.gauge("kinebus_axis_enabled", "1: its motor has power");
  of_axes(out, s, [](const AxisStatus& a) { return number(a.enabled()); });
  out.gauge("kinebus_axis_fault", "1: CiA 402's fault");
  of_axes(out, s, [](const AxisStatus& a) { return number(a.fault()); });
  out.gauge("kinebus_axis_current_amperes", "Amplitude that its node measures; absent: not read");
  of_axes(out, s, [](const AxisStatus& a) { return a.has_current_a() ? a.current_a() : kUnknown; });
  out.gauge("kinebus_axis_stage_celsius", "Its power stage; absent: not read, or no sensor");
  of_axes(out, s, [](const AxisStatus& a) { return a.has_stage_celsius() ? a.stage_celsius() : kUnknown; });
}

void get(Session& session, std::string_view) {
  session.beside(
      [](JobStore& store) { return std::pair(store.list({}, 1), store.run_totals()); },
      [&session](const std::pair<Result<JobListing, StoreError>, Result<RunTotals, StoreError>>& found) {
        const auto& [listing, runs] = found;
        if (!listing) return session.refuse(500, listing.error().words);
        if (!runs) return session.refuse(500, runs.error().words);
        session.answer({.body = metrics_page(machine_status(session), machine_info(session),
                                             {session.server().link().options().version, *listing, *runs}),
                        .type = "text/plain; version=0.0.4; charset=utf-8"});
      });
}

}  // namespace

std::string metrics_page(const Status& status, const MachineInfo& info, const MetricsBeside& beside) {
  Exposition out;
  machine(out, status, info, beside.version);
  job(out, status);
  store(out, beside);
  heat(out, status);
  bus(out, status);
  nodes(out, status);
  axes(out, status);
  return out.take();
}

std::span<const Route> metrics_routes() {
  static constexpr std::array kRoutes{Route{"GET", "metrics", get}};
  return kRoutes;
}

}  // namespace kinebus::http
