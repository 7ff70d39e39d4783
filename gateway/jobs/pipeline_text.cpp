// The text of a job, read line by line, and which line of it each place of the order is.

#include <algorithm>
#include <cstring>
#include <iterator>

#include "gateway/jobs/job_pipeline.hpp"

namespace kinebus {

void JobPipeline::read_text(int& budget) {
  commands_.clear();
  next_command_ = 0;
  leave_out_again();
  if (reader_->busy()) {
    const auto read = reader_->read({}, commands_);
    number_commands();
    --budget;
    if (read) return;
    refuse(read.error().line, read.error().column, read.error().message);
    return reader_->skip_refused();
  }
  char* const begin = text_.data();
  const char* end_of_line =
      static_cast<const char*>(std::memchr(begin + text_at_, reader_->line_end(), text_end_ - text_at_));
  Result<void, gcode::ParseError> read{};
  if (const std::size_t length =
          (end_of_line ? static_cast<std::size_t>(end_of_line + 1 - begin) : text_end_) - text_at_;
      length > 0) {
    // Without an end: the front of a line that the reader keeps.
    read = reader_->read({begin + text_at_, length}, commands_);
    text_at_ += reader_->taken();
    bytes_ += reader_->taken();
  }
  if (!end_of_line && read && source_->waits()) {
    budget = 0;
  } else if (!end_of_line && read) {
    text_at_ = 0;
    text_end_ = source_->read(text_);
    if (text_end_ == 0) {
      read = reader_->finish(commands_);
      text_done_ = read.has_value() && !reader_->busy();
      if (text_done_ && reader_->untold() > 0)
        refuse(reader_->lines(), 0,
               say("%1 more lines are refused for reasons named above", reader_->untold()));
    }
  }
  lines_ = reader_->lines();
  number_commands();
  --budget;
  if (!read) {
    refuse(read.error().line, read.error().column, read.error().message);
    reader_->skip_refused();
  }
}

/// Gives the commands of one line the place of that line.
void JobPipeline::number_commands() {
  if (reader_->steps() == 0 || commands_.empty()) return;
  const auto place = static_cast<std::uint32_t>(steps_read());
  places_.push_back({place, commands_.back().line});
  for (canonical::Line& command : commands_) command.line = place;
}

/// The line of the text. Places are asked for in rising order, but for those not yet given out.
std::uint32_t JobPipeline::line_of(std::uint32_t place) {
  if (places_.empty() || place < places_.front().place) return place;
  const auto after = std::upper_bound(places_.begin(), places_.end(), place,
                                      [](std::uint32_t wanted, const Place& p) { return wanted < p.place; });
  return std::prev(after)->line;
}

std::vector<gcode::Note> JobPipeline::take_notes() {
  if (!interpreter_ || interpreter_->notes().empty()) return {};
  std::vector<gcode::Note> notes(interpreter_->notes().begin(), interpreter_->notes().end());
  interpreter_->clear_notes();
  return notes;
}

}  // namespace kinebus
