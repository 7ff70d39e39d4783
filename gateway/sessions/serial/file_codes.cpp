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
    case 20:
      say("Begin file list");
      for (const SerialFiles::Entry& entry : files_.list())
        say(entry.name + " " + std::to_string(entry.bytes));
      say("End file list");
      return Done::kYes;
    case 21:
      say("SD card ok");
      return Done::kYes;
    case 22:
      return Done::kYes;
    case 23:
    case 32: {
      const std::string name = file_name(argument);
      const auto opened = files_.open(name);
      if (!opened) {
        say("open failed, File: " + name + ". " + opened.error());
        return Done::kYes;
      }
      selected_ = name;
      selected_bytes_ = (*opened)->size().value_or(0);
      say("File opened: " + name + " Size: " + std::to_string(selected_bytes_));
      say("File selected");
      return number == 32 ? start_file() : Done::kYes;
    }
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
      const std::string error =
          written_.size() > options_.longest_file ? "the file is too long" : files_.store(writing_, written_);
      writing_.clear();
      written_ = std::string();
      if (!error.empty()) return refuse("Error writing to file: " + error);
      say("Done saving file.");
      return Done::kYes;
    }
    case 30: {
      const std::string name = file_name(argument);
      if (name.empty()) return to_machine(line);  // M30 alone ends a program
      const std::string error = files_.remove(name);
      say(error.empty() ? "File deleted:" + name : "Deletion failed, File: " + name + ". " + error);
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

MarlinSession::Done MarlinSession::start_file() {
  if (selected_.empty()) return refuse("no file selected: M23 name");
  if (mine_) {
    gateway_.close_lines();
    mine_ = false;
  }
  if (gateway_.state() == MachineState::kRunning && !file_runs_ && gateway_.status().job == options_.name)
    return Done::kWaiting;  // the lines before it are still being moved
  if (const std::string error = files_.run(selected_); !error.empty()) return refuse(error);
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
