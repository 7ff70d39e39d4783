#include "gateway/machine/gateway.hpp"

#include "gateway/machine/core.hpp"

namespace kinebus {

Gateway::Gateway(const MachineDescription& machine) : Gateway(machine, Options{}) {}
Gateway::Gateway(const MachineDescription& machine, Options options)
    : core_(std::make_unique<Core>(machine, options, std::nullopt)) {}
Gateway::Gateway(const MachineDescription& machine, Options options, Devices devices)
    : core_(std::make_unique<Core>(machine, options, std::move(devices))) {}
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
BusTime Gateway::sync_due() const {
  return core_->sync_due();
}
void Gateway::on_stall(BusTime now, BusTime length, const Sentence& why) {
  core_->on_stall(now, length, why);
}
void Gateway::on_bus_failure(BusTime now, std::string_view what) {
  core_->on_bus_failure(now, what);
}

Result<void, Refusal> Gateway::carry_out(Command command) {
  return core_->carry_out(std::move(command));
}
Result<void, Refusal> Gateway::may(CommandKind command) const {
  return core_->may(command);
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
void Gateway::leave_lines() {
  core_->leave_lines();
}
void Gateway::skip_heating() {
  core_->skip_heating();
}
HotendTargets Gateway::hotends_found() const {
  return core_->hotends_found();
}
const gcode::WorkOffsets& Gateway::work_offsets() const {
  return core_->work_offsets();
}
const BedLevel& Gateway::bed() const {
  return core_->bed();
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
void Gateway::watch_currents() {
  core_->watch_currents();
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
