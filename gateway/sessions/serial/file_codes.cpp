// M20 to M32: the stored jobs, as an SD card would be used.

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/sessions/serial/marlin_session.hpp"

namespace kinebus {
namespace {

std::string file_name(std::string_view argument) {
  while (!argument.empty() && (argument.front() == '/' || argument.front() == '!' || argument.front() == ' '))
    argument.remove_prefix(1);
  while (!argument.empty() && (argument.back() == '#' || argument.back() == ' ')) argument.remove_suffix(1);
  return std::string(argument);
}

}  // namespace

MarlinSession::Done MarlinSession::file_code(const serial::Line& line, int number) {
  const std::string_view argument = serial::argument(line.text);
  switch (number) {
    case 20: {
      const auto found = asked([&](const auto& answer) { files_.list(answer); });
      if (!found) return Done::kWaiting;
      say("Begin file list");
      for (const SerialFiles::Entry& entry : found->entries)
        say(entry.name + " " + std::to_string(entry.bytes));
      say("End file list");
      return Done::kYes;
    }
    case 21:
      say("SD card ok");
      return Done::kYes;
    case 22:
      return Done::kYes;
    case 23:
    case 32:
      return select_file(file_name(argument), number == 32);
    case 24:
      if (gateway_.state() == MachineState::kHeld) {
        if (const auto resumed = gateway_.carry_out(command::Resume{}); !resumed)
          return refuse(resumed.error().words);
        return Done::kYes;
      }
      return start_file();
    case 25:
      if (const auto held = gateway_.carry_out(command::Hold{}); !held) return refuse(held.error().words);
      return Done::kYes;
    case 26:
      if (serial::word(line.text, 'S').value_or(0) != 0)
        return refuse("a job is run from its beginning: M26 takes S0 only");
      return Done::kYes;
    case 27:
      if (const auto s = serial::word(line.text, 'S')) {
        progress_period_ = LocalTime{static_cast<std::int64_t>(std::clamp(*s, 0.0, 3600.0) * 1e9)};
        next_progress_ = now_ + progress_period_;
        return Done::kYes;
      }
      say(file_progress());
      return Done::kYes;
    case 28:
      writing_ = file_name(argument);
      written_.clear();
      if (writing_.empty()) return refuse("M28 needs a name");
      say("Writing to file: " + writing_);
      return Done::kYes;
    case 29: {
      if (writing_.empty()) return Done::kYes;
      const bool too_long = written_.size() > options_.longest_file;
      const auto stored =
          too_long ? std::make_shared<SerialFiles::Answer>(SerialFiles::Answer{true, "the file is too long"})
                   : asked([&](const auto& answer) {
                       files_.store(answer, writing_, std::exchange(written_, std::string()));
                     });
      if (!stored) return Done::kWaiting;
      writing_.clear();
      written_ = std::string();
      if (!stored->refused.empty()) {
        say("Error:Error writing to file: " + stored->refused);
        return Done::kYes;
      }
      say("Done saving file.");
      return Done::kYes;
    }
    case 30: {
      const std::string name = file_name(argument);
      if (name.empty()) return to_machine(line);  // M30 alone ends a program
      const auto removed = asked([&](const auto& answer) { files_.remove(answer, name); });
      if (!removed) return Done::kWaiting;
      const std::string& why = removed->refused;
      say(why.empty() ? "File deleted:" + name : "Deletion failed, File: " + name + ". " + why);
      return Done::kYes;
    }
    case 31: {
      const auto elapsed = static_cast<long>(gateway_.status().elapsed_s);
      say("echo:Print time: " + std::to_string(elapsed / 60) + "m " + std::to_string(elapsed % 60) + "s");
      return Done::kYes;
    }
    case 524:
      if (const auto cancelled = gateway_.carry_out(command::Cancel{}); !cancelled)
        return refuse(cancelled.error().words);
      return Done::kYes;
    default:
      return Done::kYes;
  }
}

template <typename Ask>
SerialFiles::Asked MarlinSession::asked(const Ask& ask) {
  if (!asked_) {
    asked_ = std::make_shared<SerialFiles::Answer>();
    ask(asked_);
  }
  return asked_->done ? std::exchange(asked_, nullptr) : nullptr;
}

MarlinSession::Done MarlinSession::select_file(const std::string& name, bool start) {
  if (starts_) return start_file();
  const auto found = asked([&](const auto& answer) { files_.size(answer, name); });
  if (!found) return Done::kWaiting;
  if (!found->refused.empty() || found->entries.empty()) {
    say("open failed, File: " + name + ". " + found->refused);
    return Done::kYes;
  }
  selected_ = name;
  selected_bytes_ = found->entries.front().bytes;
  say("File opened: " + name + " Size: " + std::to_string(selected_bytes_));
  say("File selected");
  starts_ = start;
  return start ? start_file() : Done::kYes;
}

MarlinSession::Done MarlinSession::start_file() {
  if (selected_.empty()) return refuse("no file selected: M23 name");
  if (mine_) {
    gateway_.close_lines();
    mine_ = false;
  }
  if (gateway_.state() == MachineState::kRunning && !file_runs_ && gateway_.status().job == options_.name)
    return Done::kWaiting;  // the lines before it are still being moved
  const auto begun = asked([&](const auto& answer) { files_.run(answer, selected_); });
  if (!begun) return Done::kWaiting;
  starts_ = false;
  if (!begun->refused.empty()) return refuse(begun->refused);
  file_runs_ = true;
  return Done::kYes;
}

void MarlinSession::write_line(const serial::Line& line) {
  if (written_.size() <= options_.longest_file) written_ += line.text + "\n";
}

std::string MarlinSession::file_progress() const {
  const MachineStatus s = gateway_.status();
  if (s.job.empty() || s.job == options_.name) return "Not SD printing";
  const auto done =
      static_cast<std::uint64_t>(std::llround(s.progress * static_cast<double>(selected_bytes_)));
  return "SD printing byte " + std::to_string(done) + "/" + std::to_string(selected_bytes_);
}

}  // namespace kinebus
