#include "gateway/gcode/interpreter.hpp"

#include <numbers>
#include <utility>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {

Interpreter::Interpreter(Options options) : core_(std::make_unique<Core>(std::move(options))) {}
Interpreter::~Interpreter() = default;
Interpreter::Interpreter(Interpreter&&) noexcept = default;
Interpreter& Interpreter::operator=(Interpreter&&) noexcept = default;

Result<void, ParseError> Interpreter::execute(std::string_view line, std::uint32_t line_number,
                                              CommandBuffer& out) {
  const bool done = core_->in_profile() ? core_->execute_in_profile(line, line_number, out)
                                        : core_->execute(line, line_number, out);
  if (done) return {};
  return Error<ParseError>(core_->error());
}

Result<void, ParseError> Interpreter::cut_profile(CommandBuffer& out) {
  if (core_->cut_profile(out)) return {};
  return Error<ParseError>(core_->error());
}

void Interpreter::drop_profile() {
  core_->drop_profile();
}

void Interpreter::finish(std::uint32_t line_number, CommandBuffer& out) {
  core_->finish(line_number, out);
}

bool Interpreter::compensates() const {
  const CutterSide side = state().modal.cutter;
  return side == CutterSide::kLeft || side == CutterSide::kRight;
}

const State& Interpreter::state() const {
  return core_->state();
}
void Interpreter::restore(const State& state) {
  core_->restore(state);
}
void Interpreter::set_position(const Pose& pose, Frame frame) {
  core_->set_position(pose, frame);
}

void Interpreter::set_input(double value) {
  core_->set_input(value);
}

void Interpreter::set_probed(const ProbeResult& result) {
  core_->set_probed(result);
}

Result<void, Sentence> Interpreter::set_work_offset(int system, const Pose& offset, bool here) {
  if (core_->set_work_offset(system, offset, here)) return {};
  return Error<Sentence>(core_->error().message);
}

Result<void, Sentence> Interpreter::exclude_object(std::string_view name) {
  if (core_->exclude_object(name)) return {};
  return Error<Sentence>(core_->error().message);
}

std::span<const Note> Interpreter::notes() const {
  return core_->notes();
}
void Interpreter::clear_notes() {
  core_->notes().clear();
}

bool Interpreter::evaluate(std::string_view line, std::size_t& at, double& value, SyntaxError& error) const {
  Cursor cursor{line.data(), line.data() + at, line.data() + line.size()};
  ValueReader values(state(), cursor, error);
  if (!values.read_value(value)) return false;
  at = static_cast<std::size_t>(cursor.p - line.data());
  return true;
}

void Interpreter::swap_locals(Locals& locals) {
  core_->swap_locals(locals);
}

void Interpreter::end_subroutine() {
  core_->end_subroutine();
}
Result<void, ParseError> Interpreter::run_meta(const MetaLine& line, CommandBuffer& out) {
  if (core_->meta_command(line, out)) return {};
  return Error<ParseError>(core_->error());
}
Result<bool, ParseError> Interpreter::meta_condition(const MetaLine& line) {
  bool holds = false;
  if (core_->meta_condition(line, holds)) return holds;
  return Error<ParseError>(core_->error());
}
void Interpreter::set_iterations(double done) {
  core_->set_iterations(done);
}
bool Interpreter::takes_meta() const {
  const Dialect dialect = state().modal.dialect;
  return dialect == Dialect::kGeneral || dialect == Dialect::kRepRapFirmware;
}
void Interpreter::set_returned(double value, bool given) {
  core_->set_returned(value, given);
}
const Options& Interpreter::options() const {
  return core_->options();
}
Result<void, ParseError> Interpreter::read_header(std::string_view comment, std::uint32_t line_number) {
  if (core_->read_header(comment, line_number)) return {};
  return Error<ParseError>(core_->error());
}
const Macro* Interpreter::find_macro(std::string_view name) const {
  return core_->find_macro(name);
}
const ProgramCall& Interpreter::call() const {
  return core_->call();
}
ProgramCall Interpreter::take_call() {
  return core_->take_call();
}

Pose Interpreter::program_position() const {
  Pose pose = state().modal.program;
  pose[kAxisA] *= 180 / std::numbers::pi;
  pose[kAxisC] *= 180 / std::numbers::pi;
  return pose;
}

std::string Interpreter::modal_codes() const {
  const ModalState& m = state().modal;
  static constexpr std::array kMotions = {"G80", "G0", "G1", "G2", "G3"};
  static constexpr std::array kPlanes = {"G17", "G18", "G19"};
  static constexpr std::array kSystems = {"G54", "G55",   "G56",   "G57",  "G58",
                                          "G59", "G59.1", "G59.2", "G59.3"};
  std::string text = kMotions[static_cast<std::size_t>(m.motion)];
  const auto add = [&text](const char* code) {
    text += ' ';
    text += code;
  };
  add(kPlanes[static_cast<std::size_t>(m.plane)]);
  if (m.cutter == CutterSide::kLeft) add("G41");
  if (m.cutter == CutterSide::kRight) add("G42");
  add(m.inches ? "G20" : "G21");
  add(m.incremental ? "G91" : "G90");
  add(m.absolute_centre ? "G90.1" : "G91.1");
  add(m.inverse_time ? "G93" : "G94");
  add(kSystems[static_cast<std::size_t>(m.coordinate_system)]);
  add(m.tool_centre_point ? "G43.4" : m.tool_length_mm != 0 ? "G43" : "G49");
  add(m.exact_path ? "G61" : "G64");
  add(m.tilted ? "G68.2" : "G69");
  add(m.g92_active ? "G92" : "G92.1");
  add(m.incremental_e ? "M83" : "M82");
  return text;
}

}  // namespace kinebus::gcode
