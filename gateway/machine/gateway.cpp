#include "gateway/machine/gateway.hpp"

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

std::deque<NodeLink> make_links(const std::vector<NodeAxes>& axes) {
  std::deque<NodeLink> links;
  for (const NodeAxes& node : axes) links.emplace_back(node.node_id);
  return links;
}

/// A description whose geometry no machine can have leaves the default machine's kinematics, for show only.
std::unique_ptr<Kinematics> machine_kinematics(const MachineDescription& machine, Sentence& defect) {
  auto made = make_kinematics(machine);
  if (made) return std::move(*made);
  defect = say("the machine file's geometry cannot work: %1", made.error().what);
  return std::move(*make_m1_kinematics(M1Geometry{}));
}

SimulatedThermal::Model heat_model(const HeaterDescription& heater) {
  return {.rise_celsius = heater.sim_power_w / heater.sim_loss_w_per_k,
          .time_constant_s = heater.sim_heat_capacity_j_per_k / heater.sim_loss_w_per_k,
          .band_celsius = heater.window_c};
}

}  // namespace

Gateway::Core::Core(const MachineDescription& machine, Options options)
    : machine_(machine),
      options_(options),
      kinematics_(machine_kinematics(machine_, defect_)),
      axes_(node_axes(machine_)),
      links_(make_links(axes_)),
      rate_({.stop_ramp = machine_.stop.ramp}),
      sync_({.period = machine_.bus.sync_period, .epoch = options.epoch}),
      group_(*kinematics_, axes_, stream_options(machine_)),
      thermal_({.ambient_celsius = machine_.thermal.ambient_c,
                .hotend = heat_model(machine_.thermal.hotend),
                .bed = heat_model(machine_.thermal.bed),
                .spindle_rpm_per_s = machine_.spindle.sim_rpm_per_s}),
      bring_up_(machine_, links_, rate_),
      homing_(machine_, links_),
      standstill_(machine_, links_),
      hand_(machine_, *kinematics_, group_, rate_, thermal_, events_, journal_),
      print_(machine_, *kinematics_, group_, rate_, thermal_, events_, journal_),
      positions_(axes_.size()),
      live_lines_(machine_, *kinematics_) {
  if (!options_.journal) return;
  journal_.enable();
  journal_.push(journal::Epoch{options_.epoch});
}

Gateway::Gateway(const MachineDescription& machine) : Gateway(machine, Options{}) {}
Gateway::Gateway(const MachineDescription& machine, Options options)
    : core_(std::make_unique<Core>(machine, options)) {}
Gateway::~Gateway() = default;

void Gateway::on_frame(BusTime when, const CanFrame& frame) {
  core_->on_frame(when, frame);
}
void Gateway::on_frame_sent(BusTime when, const CanFrame& frame) {
  core_->on_frame_sent(when, frame);
}
void Gateway::on_time(BusTime now) {
  core_->on_time(now);
}
std::optional<CanFrame> Gateway::next_frame(BusTime now) {
  return core_->next_frame(now);
}
BusTime Gateway::next_deadline() const {
  return core_->next_deadline();
}
void Gateway::on_bus_failure(BusTime now, std::string_view what) {
  core_->on_bus_failure(now, what);
}

Result<void, Refusal> Gateway::bring_up() {
  return core_->bring_up();
}
Result<void, Refusal> Gateway::home() {
  return core_->home();
}
Result<void, Refusal> Gateway::go_to_reference() {
  return core_->go_to_reference();
}
Result<void, Refusal> Gateway::jog(const JogRequest& request) {
  return core_->jog(request);
}
Result<void, Refusal> Gateway::run(std::unique_ptr<ByteSource> job, std::string name) {
  return core_->run(std::move(job), std::move(name));
}
Result<void, Refusal> Gateway::hold() {
  return core_->hold();
}
Result<void, Refusal> Gateway::resume() {
  return core_->resume();
}
Result<void, Refusal> Gateway::cancel() {
  return core_->cancel();
}
Result<void, Refusal> Gateway::stop() {
  return core_->stop(say("stop by command"));
}
Result<void, Refusal> Gateway::clear() {
  return core_->clear();
}
Result<void, Refusal> Gateway::set_feed_override(double ratio) {
  return core_->set_feed_override(ratio);
}
Result<void, Refusal> Gateway::motors_off() {
  return core_->motors_off();
}
Result<void, Refusal> Gateway::set_temperature(bool bed, double celsius) {
  return core_->set_temperature(bed, celsius);
}
Result<void, Refusal> Gateway::open_lines(std::string name) {
  return core_->open_lines(std::move(name));
}
Result<void, Refusal> Gateway::take_line(std::string_view line, std::uint32_t number) {
  return core_->take_line(line, number);
}
std::size_t Gateway::line_room() const {
  return core_->line_room();
}
bool Gateway::lines_open() const {
  return core_->lines_open();
}
bool Gateway::lines_idle() const {
  return core_->lines_idle();
}
void Gateway::close_lines() {
  core_->close_lines();
}
const gcode::WorkOffsets& Gateway::work_offsets() const {
  return core_->work_offsets();
}
void Gateway::forget_line_modes() {
  core_->forget_line_modes();
}
Result<std::string, Refusal> Gateway::text_line(std::string_view line) {
  return core_->text_line(line);
}

std::optional<journal::Record> Gateway::next_journal_record() {
  return core_->next_journal_record();
}
void Gateway::on_journal_stored(std::uint64_t count) {
  core_->on_journal_stored(count);
}
Result<void, Refusal> Gateway::recover(journal::State state, std::unique_ptr<ByteSource> job) {
  return core_->recover(std::move(state), std::move(job));
}

MachineState Gateway::state() const {
  return core_->state();
}
MachineStatus Gateway::status() const {
  return core_->status();
}
std::optional<MachineEvent> Gateway::next_event() {
  return core_->next_event();
}
PathTime Gateway::path_time(BusTime at) const {
  return core_->path_time(at);
}
std::optional<PlannedPose> Gateway::planned_pose(PathTime tau) const {
  return core_->planned_pose(tau);
}

}  // namespace kinebus
