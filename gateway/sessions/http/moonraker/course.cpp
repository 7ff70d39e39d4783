#include "gateway/sessions/http/moonraker/course.hpp"

#include <utility>

namespace kinebus::http {

void TemperatureCourse::add(const std::string& sensor, Value value) {
  auto& course = courses_[sensor];
  course.push_back(value);
  if (course.size() > kValues) course.pop_front();
}

void ConsoleCourse::add(bool is_command, double unix_s, std::string_view text) {
  lines_.push_back({++newest_, is_command, unix_s, std::string(text)});
  bytes_ += text.size();
  while (lines_.size() > kLines || (bytes_ > kBytes && lines_.size() > 1)) {
    bytes_ -= lines_.front().text.size();
    lines_.pop_front();
  }
}

}  // namespace kinebus::http
