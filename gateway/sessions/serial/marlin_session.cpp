#include "gateway/sessions/serial/marlin_session.hpp"

#include <algorithm>
#include <utility>

#include "gateway/sessions/serial/line_control.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

using serial::Line;
using serial::Urgent;

/// Lines kept; a host that waits for "ok" never has so many under way.
constexpr std::size_t kMostLines = 256;
constexpr std::size_t kMostOutput = 256U << 10U;
/// Longer ones are cut: hosts read lines into buffers of their own.
constexpr std::size_t kMostLine = 4096;
/// How often a waiting line is asked again.
constexpr LocalTime kPoll = std::chrono::milliseconds{4};

}  // namespace

MarlinSession::MarlinSession(Gateway& gateway, SerialFiles& files, Options options)
    : gateway_(gateway), files_(files), options_(std::move(options)) {
  say("start");
  say("echo:Kinebus gateway on a serial line, Marlin's dialect");
}

MarlinSession::~MarlinSession() {
  leave();
}

// Output
// -------------------------------------------------------------------------------------------------------

void MarlinSession::say(std::string_view line) {
  if (out_.size() - out_sent_ > kMostOutput) {
    // Nobody reads: what is old is of no use to the next who does.
    out_.clear();
    out_sent_ = 0;
    temperature_period_ = progress_period_ = LocalTime{0};
  }
  out_ += shown_lines(line, kMostLine);
  out_ += '\n';
}

void MarlinSession::say_ok(const Line& line) {
  std::string text = "ok";
  if (line.number) text += " N" + std::to_string(*line.number);
  const std::size_t room = mine_ ? gateway_.line_room() : Gateway::kLineRoom;
  const std::size_t waiting = lines_.empty() ? 0 : lines_.size() - 1;
  text += " P" + std::to_string(room) + " B" +
          std::to_string(options_.line_buffer - std::min(options_.line_buffer, waiting));
  say(text);
}

std::span<const std::uint8_t> MarlinSession::next_bytes() {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(out_.data());
  return {begin + out_sent_, out_.size() - out_sent_};
}

void MarlinSession::on_bytes_sent(std::size_t count) {
  out_sent_ += std::min(count, out_.size() - out_sent_);
  if (out_sent_ < out_.size()) return;
  out_.clear();
  out_sent_ = 0;
}

// Input
// --------------------------------------------------------------------------------------------------------

bool MarlinSession::wants_bytes() const {
  return lines_.size() < kMostLines;
}

void MarlinSession::on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) {
  now_ = std::max(now_, now);
  reader_.on_bytes(now_, bytes);
  work(now_);
}

void MarlinSession::see_urgent(LocalTime now, Urgent what, const std::string& text) {
  switch (what) {
    case Urgent::kNone:
      return;
    case Urgent::kEmergencyStop:
      lines_.clear();
      stop_waiting();
      halted_ = true;
      static_cast<void>(gateway_.carry_out(
          command::Stop{.why = kinebus::say("M112 of the print host"), .heaters_off = true}));
      say("Error:Printer halted. kill() called!");
      return;
    case Urgent::kQuickStop:
      lines_.clear();
      stop_waiting();
      if (mine_) static_cast<void>(gateway_.carry_out(command::Cancel{}));
      mine_ = false;
      return;
    case Urgent::kGoOn:
      if (wait_ == Wait::kHeater) stop_waiting();
      if (mine_) gateway_.skip_heating();
      if (gateway_.state() == MachineState::kHeld && may_command())
        static_cast<void>(gateway_.carry_out(command::Resume{}));
      next_busy_ = now + options_.keep_alive;
      return;
    case Urgent::kHeaterOff:
      // Of a program that was sent ahead it is a line like others: what stands before it is to be printed
      // hot.
      if (only_heat_waits() && may_command()) static_cast<void>(gateway_.text_line(text));
      return;
  }
}

void MarlinSession::stop_waiting() {
  wait_ = Wait::kNone;
  homing_ = heats_ = starts_ = false;
  asked_.reset();
}

void MarlinSession::on_time(LocalTime now) {
  now_ = std::max(now_, now);
  reader_.on_time(now_);
  work(now_);
  report(now_);
}

LocalTime MarlinSession::next_deadline() const {
  LocalTime due = reader_.next_deadline();
  if (!lines_.empty()) due = std::min(due, now_ + kPoll);
  if (mine_ || file_runs_) due = std::min(due, now_ + std::chrono::milliseconds{50});
  if (temperature_period_ > LocalTime{0} || heats_) due = std::min(due, next_temperature_);
  if (progress_period_ > LocalTime{0}) due = std::min(due, next_progress_);
  if (client_ != 0 && idle())
    due = std::min(
        {due, last_line_ + options_.gone_after, has_control() ? last_command_ + options_.close_after : due});
  return due;
}

void MarlinSession::work(LocalTime now) {
  watch_others();
  while (auto line = reader_.next()) {
    ++counters_.lines;
    last_line_ = now;
    heard();
    if (lines_.empty()) next_busy_ = now + options_.keep_alive;
    const Urgent what = line->error.empty() && !line->repeated && writing_.empty()
                            ? serial::urgent(line->text)
                            : Urgent::kNone;
    see_urgent(now, what, line->text);
    lines_.push_back(std::move(*line));
  }
  while (!lines_.empty()) {
    const Done done = wait_ != Wait::kNone ? wait_over() : carry_out(lines_.front());
    if (done == Done::kWaiting) break;
    if (done == Done::kYes) say_ok(lines_.front());
    if (serial::changes_machine(serial::code_of(lines_.front().text))) last_command_ = now;
    lines_.pop_front();
    last_line_ = now;
    next_busy_ = now + options_.keep_alive;
  }
  if (!lines_.empty() && options_.keep_alive > LocalTime{0} && now >= next_busy_) {
    next_busy_ = now + options_.keep_alive;
    say(gateway_.state() == MachineState::kHeld ? "echo:busy: paused for user" : "echo:busy: processing");
  }
  if (mine_ && lines_.empty() && now - last_command_ >= options_.close_after && gateway_.lines_idle()) {
    gateway_.close_lines();
    mine_ = false;
  }
  come_and_go();
}

/// Others hold, cancel or stop what this session's lines move; its host is told.
void MarlinSession::watch_others() {
  const MachineState state = gateway_.state();
  if (file_runs_ && (state == MachineState::kReady || machine_stopped())) {
    file_runs_ = false;
    if (state == MachineState::kReady) say("Done printing file");
  }
  if (!mine_) return;
  const bool held = state == MachineState::kHeld || state == MachineState::kHolding;
  if (held != held_told_) say(held ? "//action:paused" : "//action:resumed");
  held_told_ = held;
  if (gateway_.lines_open()) return;
  // M2 and M30 end the program: the next line opens it again.
  const bool ended = state == MachineState::kReady || state == MachineState::kRunning;
  mine_ = false;
  if (ended) return;
  stop_waiting();
  dropped_ = true;
  if (!halted_) say("//action:cancel");
}

void MarlinSession::report(LocalTime now) {
  const LocalTime period = heats_ ? kHeatReport : temperature_period_;
  if (period > LocalTime{0} && now >= next_temperature_) {
    next_temperature_ = now + period;
    say(" " + temperatures());
  }
  if (progress_period_ > LocalTime{0} && now >= next_progress_) {
    next_progress_ = now + progress_period_;
    say(file_progress());
  }
}

void MarlinSession::on_closed(LocalTime now, std::string_view) {
  now_ = std::max(now_, now);
  lines_.clear();
  stop_waiting();
  // What was taken is still moved, as far as the lead goes; then the machine rests, at a place of the path.
  if (mine_) gateway_.leave_lines();
  mine_ = false;
  leave();
}

void MarlinSession::on_event(const MachineEvent& event) {
  switch (event.kind) {
    case MachineEvent::Kind::kMessage:
      say("echo:" + event.words);
      break;
    case MachineEvent::Kind::kProblem:
      if (file_runs_) say("echo:line " + std::to_string(event.line) + ": " + event.words);
      break;
    case MachineEvent::Kind::kAlarm:
      say("Error:" + event.words + (event.advice.empty() ? "" : " " + event.advice));
      break;
    case MachineEvent::Kind::kFinished:
      if (file_runs_) say("echo:" + event.words);
      break;
    case MachineEvent::Kind::kState:
      break;
  }
}

}  // namespace kinebus
